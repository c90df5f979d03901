"""Solids by membership: what stands for a CAD kernel in the tests. A solid is a function from a point to a bool."""

import math


def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def subtract(a, b):
    return tuple(x - y for x, y in zip(a, b))


def scale(a, s):
    return tuple(x * s for x in a)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def norm(a):
    return math.sqrt(dot(a, a))


class Rotation:
    """A unit quaternion x, y, z, w."""

    def __init__(self, x=0, y=0, z=0, w=1):
        length = math.sqrt(x * x + y * y + z * z + w * w)
        self.v, self.w = (x / length, y / length, z / length), w / length

    def turn(self, point):
        t = scale(cross(self.v, point), 2)
        return add(add(point, scale(t, self.w)), cross(self.v, t))

    def back(self, point):
        return Rotation(*scale(self.v, -1), self.w).turn(point)

    def times(self, other):
        v = add(add(scale(other.v, self.w), scale(self.v, other.w)), cross(self.v, other.v))
        return Rotation(*v, self.w * other.w - dot(self.v, other.v))


def about(axis, degrees):
    half = math.radians(degrees) / 2
    return Rotation(*scale(axis, math.sin(half) / norm(axis)), math.cos(half))


def box(x, y, z):
    """From the origin on, as both programs have it."""
    return lambda p: 0 <= p[0] <= x and 0 <= p[1] <= y and 0 <= p[2] <= z


def sphere(radius, lowest=-90, highest=90):
    low, high = radius * math.sin(math.radians(lowest)), radius * math.sin(math.radians(highest))
    return lambda p: norm(p) <= radius and low <= p[2] <= high


def cone(bottom, top, height):
    if bottom == top:
        raise ValueError("the kernel refuses cones with parallel sides")
    return lambda p: 0 <= p[2] <= height and math.hypot(p[0], p[1]) <= bottom + (top - bottom) * p[2] / height


def cylinder(radius, height):
    return lambda p: 0 <= p[2] <= height and math.hypot(p[0], p[1]) <= radius


def torus(major, minor):
    if minor >= major:
        raise ValueError("the kernel refuses tori without a hole")
    return lambda p: math.hypot(math.hypot(p[0], p[1]) - major, p[2]) <= minor


def triangles_of(polygons):
    return [(polygon[0], b, c) for polygon in polygons for b, c in zip(polygon[1:], polygon[2:])]


def signed_volume(polygons):
    return sum(dot(a, cross(b, c)) for a, b, c in triangles_of(polygons)) / 6


def check_closed(polygons):
    edges = {}
    for polygon in polygons:
        for a, b in zip(polygon, polygon[1:] + polygon[:1]):
            edges[a, b] = edges.get((a, b), 0) + 1
    if any(count != 1 or (b, a) not in edges for (a, b), count in edges.items()):
        raise ValueError("the shell is not closed")


def is_over(triangle, x, y):
    """Whether a vertical line goes through: of two triangles at an edge, through one."""
    crossings = 0
    for (ax, ay, _), (bx, by, _) in zip(triangle, triangle[1:] + triangle[:1]):
        if (ay > y) != (by > y):
            # From the lower end on, so that both triangles at the edge find the same.
            if ay > by:
                ax, ay, bx, by = bx, by, ax, ay
            crossings += x < ax + (y - ay) / (by - ay) * (bx - ax)
    return crossings % 2 == 1


def height_at(triangle, x, y):
    a, b, c = triangle
    n = cross(subtract(b, a), subtract(c, a))
    return a[2] - (n[0] * (x - a[0]) + n[1] * (y - a[1])) / n[2]


def polyhedron(polygons):
    """Inside by how many faces are above, whichever way they turn."""
    check_closed(polygons)
    triangles = triangles_of(polygons)
    corners = [corner for polygon in polygons for corner in polygon]
    low, high = ([extreme(corner[axis] for corner in corners) for axis in range(3)] for extreme in (min, max))

    def inside(point):
        if not all(a <= x <= b for a, x, b in zip(low, point, high)):
            return False
        x, y, z = point
        return sum(is_over(t, x, y) and height_at(t, x, y) > z for t in triangles) % 2 == 1

    return inside


def moved(inside, position, rotation):
    return lambda p: inside(rotation.back(subtract(p, position)))


def arc_through(a, b, c, steps=64):
    """Points of the arc from a to c through b, without c, all in one plane of coordinates."""
    ab, ac = subtract(b, a), subtract(c, a)
    n = cross(ab, ac)
    to_centre = scale(cross(subtract(scale(ab, dot(ac, ac)), scale(ac, dot(ab, ab))), n), -0.5 / dot(n, n))
    centre = add(a, to_centre)
    u = subtract(a, centre)
    v = cross(scale(n, 1 / norm(n)), u)
    last = subtract(c, centre)
    angle = math.atan2(dot(last, v), dot(last, u)) % (2 * math.pi)
    turns = (angle * k / steps for k in range(steps))
    return [add(centre, add(scale(u, math.cos(t)), scale(v, math.sin(t)))) for t in turns]


def is_in_paths(paths, x, y):
    """Whether an odd number of paths, lists of corners, are around a place."""
    return sum(is_over([(a, b, 0) for a, b in path], x, y) for path in paths) % 2 == 1


def extrusion(wires, height):
    """Upward from the wires' plane."""
    low = wires[0][0][2]
    paths = [[(x, y) for x, y, _ in wire] for wire in wires]
    return lambda p: low <= p[2] <= low + height and is_in_paths(paths, p[0], p[1])


def revolution(wires, degrees):
    """About z from x towards y, of wires in the plane of x and z."""
    assert all(y == 0 and x >= 0 for wire in wires for x, y, _ in wire)
    paths = [[(x, z) for x, _, z in wire] for wire in wires]

    def inside(p):
        turn = math.degrees(math.atan2(p[1], p[0])) % 360
        return turn <= degrees and is_in_paths(paths, math.hypot(p[0], p[1]), p[2])
    return inside

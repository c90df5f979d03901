"""The part of FreeCAD's Part that macros use, by membership."""

import fake_solids as solids


class Shell(list):
    def sewShape(self):
        pass


class Shape:
    def __init__(self, inside, volume):
        self.inside, self.Volume = inside, volume

    def reverse(self):
        self.Volume = -self.Volume

    def fuse(self, other):
        return Shape(lambda p: self.inside(p) or other.inside(p), None)

    def cut(self, other):
        assert other.Volume > 0
        return Shape(lambda p: self.inside(p) and not other.inside(p), None)


def makePolygon(points):
    assert points[0].p == points[-1].p
    return [point.p for point in points[:-1]]


class Curve:
    """As the points on it, without the last."""

    def __init__(self, points):
        self.points = points

    def toShape(self):
        return self.points


def LineSegment(start, end):
    return Curve([start.p])


def Arc(start, middle, end):
    return Curve(solids.arc_through(start.p, middle.p, end.p))


def Wire(edges):
    return [point for edge in edges for point in edge]


class FaceOfWires:
    def __init__(self, wires):
        self.wires = wires

    def extrude(self, direction):
        assert direction.p[:2] == (0, 0) and direction.p[2] > 0
        return Shape(solids.extrusion(self.wires, direction.p[2]), None)

    def revolve(self, base, axis, angle):
        assert (base.p, axis.p) == ((0, 0, 0), (0, 0, 1))
        return Shape(solids.revolution(self.wires, angle), None)


def Face(outline):
    """Of a polygon, or of a list of wires."""
    return FaceOfWires(outline) if isinstance(outline[0], list) else outline


def makeShell(faces):
    return Shell(faces)


def Solid(shell):
    return Shape(solids.polyhedron(shell), solids.signed_volume(shell))

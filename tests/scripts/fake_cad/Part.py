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


def Face(wire):
    return wire


def makeShell(faces):
    return Shell(faces)


def Solid(shell):
    return Shape(solids.polyhedron(shell), solids.signed_volume(shell))

"""The part of CadQuery's API that scripts use, with its signatures and defaults, by membership."""

import fake_solids as solids


class Vector:
    def __init__(self, x, y, z):
        self.p = (float(x), float(y), float(z))

    def dot(self, other):
        return solids.dot(self.p, other.p)

    def cross(self, other):
        return Vector(*solids.cross(self.p, other.p))


class Location:
    def __init__(self, translation, axis, degrees):
        self.position, self.rotation = translation.p, solids.about(axis.p, degrees)


class Shape:
    def __init__(self, inside):
        self.inside = inside

    def moved(self, location):
        return Shape(solids.moved(self.inside, location.position, location.rotation))

    def fuse(self, *others):
        assert others
        return Shape(lambda p: self.inside(p) or any(other.inside(p) for other in others))

    def cut(self, *others):
        assert others
        return Shape(lambda p: self.inside(p) and not any(other.inside(p) for other in others))

    def intersect(self, *others):
        """As the kernel has it: with what the others have together."""
        assert others
        return Shape(lambda p: self.inside(p) and any(other.inside(p) for other in others))


ORIGIN, UP = Vector(0, 0, 0), Vector(0, 0, 1)


def _at(inside, pnt, dir):
    assert dir.p == UP.p
    return Shape(solids.moved(inside, pnt.p, solids.Rotation()))


class Solid:
    @staticmethod
    def makeBox(length, width, height, pnt=ORIGIN, dir=UP):
        return _at(solids.box(length, width, height), pnt, dir)

    @staticmethod
    def makeSphere(radius, pnt=ORIGIN, dir=UP, angleDegrees1=0, angleDegrees2=90, angleDegrees3=360):
        assert angleDegrees3 == 360
        return _at(solids.sphere(radius, angleDegrees1, angleDegrees2), pnt, dir)

    @staticmethod
    def makeCylinder(radius, height, pnt=ORIGIN, dir=UP, angleDegrees=360):
        assert angleDegrees == 360
        return _at(solids.cylinder(radius, height), pnt, dir)

    @staticmethod
    def makeCone(radius1, radius2, height, pnt=ORIGIN, dir=UP, angleDegrees=360):
        assert angleDegrees == 360
        return _at(solids.cone(radius1, radius2, height), pnt, dir)

    @staticmethod
    def makeTorus(radius1, radius2, pnt=ORIGIN, dir=UP, angleDegrees1=0, angleDegrees2=360):
        assert (angleDegrees1, angleDegrees2) == (0, 360)
        return _at(solids.torus(radius1, radius2), pnt, dir)

    @staticmethod
    def extrudeLinear(outerWire, innerWires, vecNormal, taper=0):
        assert vecNormal.p[:2] == (0, 0) and vecNormal.p[2] > 0
        return Shape(solids.extrusion([outerWire, *innerWires], vecNormal.p[2]))

    @staticmethod
    def revolve(outerWire, innerWires, angleDegrees, axisStart, axisEnd):
        assert (axisStart.p, axisEnd.p) == (ORIGIN.p, UP.p)
        return Shape(solids.revolution([outerWire, *innerWires], angleDegrees))

    @staticmethod
    def makeSolid(shell):
        return Shape(solids.polyhedron(shell))


class Edge:
    """As the points on it, without the last."""

    @staticmethod
    def makeLine(v1, v2):
        return [v1.p]

    @staticmethod
    def makeThreePointArc(v1, v2, v3):
        return solids.arc_through(v1.p, v2.p, v3.p)


class Wire:
    @staticmethod
    def assembleEdges(listOfEdges):
        return [point for edge in listOfEdges for point in edge]

    @staticmethod
    def makePolygon(listOfVertices, forConstruction=False, close=False):
        assert close
        return [vertex.p for vertex in listOfVertices]


class Face:
    @staticmethod
    def makeFromWires(outerWire):
        return outerWire


class Shell:
    @staticmethod
    def makeShell(listOfFaces):
        return list(listOfFaces)

"""The part of FreeCAD that macros use, by membership: documents of objects with the properties that FreeCAD has."""

import fake_solids as solids

GuiUp = 0
ActiveDocument = None


class Vector:
    def __init__(self, x=0, y=0, z=0):
        self.p = (float(x), float(y), float(z))


class Rotation(solids.Rotation):
    pass


class Placement:
    def __init__(self, base=None, rotation=None):
        self.base, self.rotation = (base or Vector()).p, rotation or Rotation()

    def multiply(self, other):
        place = Placement()
        place.base = solids.add(self.base, self.rotation.turn(other.base))
        place.rotation = self.rotation.times(other.rotation)
        return place


SIZES = {
    "Part::Box": ("Length", "Width", "Height"),
    "Part::Sphere": ("Radius",),
    "Part::Cylinder": ("Radius", "Height"),
    "Part::Cone": ("Radius1", "Radius2", "Height"),
    "Part::Torus": ("Radius1", "Radius2"),
    "Part::Feature": ("Shape",),
    "Part::MultiFuse": ("Shapes",),
    "Part::MultiCommon": ("Shapes",),
    "Part::Cut": ("Base", "Tool"),
}
MAKERS = {
    "Part::Box": solids.box,
    "Part::Sphere": solids.sphere,
    "Part::Cylinder": solids.cylinder,
    "Part::Cone": solids.cone,
    "Part::Torus": solids.torus,
}


class Object:
    def __init__(self, kind, name):
        assert name.isidentifier() and name.isascii()
        self.__dict__.update(kind=kind, Label=name, Placement=Placement(), Visibility=True)

    def __setattr__(self, name, value):
        if name not in SIZES[self.kind] + ("Label", "Placement", "Visibility"):
            raise AttributeError(f"{self.kind} has no property {name}")
        self.__dict__[name] = value

    def inside(self, point):
        values = [getattr(self, name) for name in SIZES[self.kind]]
        if self.kind in MAKERS:
            inside = MAKERS[self.kind](*values)
        elif self.kind == "Part::Feature":
            inside = self.Shape.inside
        elif self.kind == "Part::MultiFuse":
            return any(operand.inside(point) for operand in values[0])
        elif self.kind == "Part::MultiCommon":
            assert len(values[0]) == 2, "of more, it depends on the version"
            return all(operand.inside(point) for operand in values[0])
        else:
            return values[0].inside(point) and not values[1].inside(point)
        return solids.moved(inside, self.Placement.base, self.Placement.rotation)(point)


class Document:
    def __init__(self):
        self.Objects = []

    def addObject(self, kind, name):
        assert kind in SIZES, kind
        self.Objects.append(Object(kind, name))
        return self.Objects[-1]

    def recompute(self):
        pass


def newDocument(name):
    global ActiveDocument
    ActiveDocument = Document()
    return ActiveDocument

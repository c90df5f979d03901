"""Option classes: all fields of the library's, by name."""
import copy
import pickle
import re

import pytest

import cloud2csg

CLASSES = [value for name, value in vars(cloud2csg).items()
           if isinstance(value, type) and (name.endswith("Options") or name == "SampleCounts")]
# Structs of library parts that Python does not have.
LEFT_OUT = {"CellOptions", "FamilyOptions", "FitOptions", "OverlapOptions", "PaperOptions",
            "PointPassOptions", "ResultComparisonOptions", "ScalingOptions"}
# Fields that view the caller's memory.
LEFT_OUT_FIELDS = {("CloudWriteOptions", "colours")}


def structs(root):
    """Name and fields of each options struct in the public headers."""
    for header in sorted((root / "include/cloud2csg").rglob("*.hpp")):
        text = re.sub(r"//[^\n]*", "", header.read_text(encoding="utf-8"))
        for name, body in re.findall(r"struct (\w+Options|SampleCounts) \{(.*?)\n\};", text, flags=re.DOTALL):
            # A member: type, name, maybe a value, up to the semicolon; members in one declaration share the type.
            members = []
            while re.search(r"\{[^{}]*\}", body):
                body = re.sub(r"\{[^{}]*\}", "", body)
            for statement in body.split(";"):
                declared = re.sub(r"=[^,]*", "", statement.strip())
                if declared:
                    members += [part.split()[-1] for part in re.sub(r"<[^<>]*>", "", declared).split(",")]
            yield name, [member for member in members if (name, member) not in LEFT_OUT_FIELDS]


def test_every_struct_has_its_class(root):
    found = dict(structs(root))
    assert len(found) > 20
    assert set(found) - LEFT_OUT == {kind.__name__ for kind in CLASSES}


def test_every_field_is_there(root):
    for name, members in structs(root):
        if name not in LEFT_OUT:
            assert list(getattr(cloud2csg, name).__annotations__) == members, name


@pytest.mark.parametrize("kind", CLASSES)
def test_values(kind):
    options = kind()
    assert options == kind() and options != 3
    assert options == eval(repr(options), vars(cloud2csg))
    assert options == pickle.loads(pickle.dumps(options)) == copy.copy(options) == copy.deepcopy(options)
    for name, annotation in kind.__annotations__.items():
        doc = getattr(kind, name).__doc__
        assert doc.startswith(f"{annotation}, default ") and len(doc.split(". ", 1)[1]) > 3
        assert f"\n{name} : " in kind.__doc__
    with pytest.raises(TypeError, match=f"{kind.__name__} has no field 'no_such'"):
        kind(no_such=1)


def numbers():
    for kind in CLASSES:
        for name, annotation in kind.__annotations__.items():
            if annotation.split(" ")[0] in ("int", "float"):
                yield pytest.param(kind, name, id=f"{kind.__name__}.{name}")


@pytest.mark.parametrize("kind, name", numbers())
def test_each_number_is_one_of_its_own(kind, name):
    """A keyword, an attribute and replace() set the field that they name, and no other."""
    changed = kind(**{name: 7})
    assert getattr(changed, name) == 7
    others = [other for other in kind.__annotations__ if other != name]
    assert all(getattr(changed, other) == getattr(kind(), other) for other in others)
    assert changed != kind()
    assert kind().replace(**{name: 7}) == changed
    assigned = kind()
    setattr(assigned, name, 7)
    assert assigned == changed
    with pytest.raises(TypeError, match=rf"{kind.__name__}\.{name}: expected {kind.__annotations__[name][:3]}"):
        setattr(assigned, name, "seven")


def test_options_within_options_are_references():
    options = cloud2csg.ReconstructOptions()
    options.extraction.search.population = 11
    assert options.extraction.search.population == 11
    assert cloud2csg.ReconstructOptions().extraction.search.population != 11
    with pytest.raises(TypeError, match="expected GaOptions"):
        options.extraction.search = cloud2csg.SampleOptions()
    with pytest.raises(TypeError, match="ExtractOptions.search: expected GaOptions, found None"):
        cloud2csg.ExtractOptions(search=None)


def test_optional_fields_take_none():
    options = cloud2csg.DetectOptions(distance_tolerance=0.5)
    options.distance_tolerance = None
    assert options == cloud2csg.DetectOptions()


def test_choices_are_texts():
    options = cloud2csg.ExtractOptions(strategy="cells", precision="full")
    assert (options.strategy, options.precision, options.parallel) == ("cells", "full", "both")
    with pytest.raises(TypeError, match=r"ExtractOptions\.strategy: expected Literal\['auto', 'cells'.*found 'best'"):
        options.strategy = "best"
    assert cloud2csg.ExtractOptions.paper().strategy == "partition"


def test_none_is_no_truth_value():
    with pytest.raises(TypeError, match="GaOptions.seeds: expected bool, found None"):
        cloud2csg.GaOptions(seeds=None)


def test_negative_counts_are_refused():
    with pytest.raises(TypeError, match="SampleOptions.count: expected int"):
        cloud2csg.SampleOptions(count=-1)


def test_ranges_are_the_library_s_to_check(plate):
    with pytest.raises(cloud2csg.Error, match="noise"):
        cloud2csg.sample(plate, noise=-1)
    with pytest.raises(cloud2csg.Error, match="noise"):
        cloud2csg.sample(plate.mesh(resolution=8), noise=-1)


def test_options_of_exports_are_checked(plate, tmp_path):
    options = cloud2csg.ExportOptions(meshing=cloud2csg.MeshingOptions(resolution=1))
    with pytest.raises(cloud2csg.Error, match=r"meshing\.resolution: expected"):
        plate.write(tmp_path / "part.stl", options)
    assert not list(tmp_path.iterdir())


def test_options_refine_known_primitives(plate):
    cloud = cloud2csg.sample(plate, count=4000, noise=0.005)
    options = cloud2csg.ReconstructOptions(refine=cloud2csg.RefineOptions())
    assert cloud2csg.extract(cloud, plate, options=options).statistics["refine"] is not None
    options.refine = cloud2csg.RefineOptions(rounds=0)
    with pytest.raises(cloud2csg.Error, match="rounds"):
        cloud2csg.extract(cloud, plate, options=options)

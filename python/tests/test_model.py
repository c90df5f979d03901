"""Models: primitives, fields, files, pages."""
import html
import html.parser
import json
import pickle

import numpy as np
import pytest

import cloud2csg
from cloud2csg import Leaf

POINTS = np.random.default_rng(2).uniform(-3, 3, size=(40_000, 3))


def test_primitives_are_what_was_given():
    shapes = {
        "box": cloud2csg.Box((1, 2, 3)), "sphere": cloud2csg.Sphere(2), "cylinder": cloud2csg.Cylinder(1, 2),
        "cone": cloud2csg.Cone(1, 0, 2), "torus": cloud2csg.Torus(2, 0.5), "half_space": cloud2csg.HalfSpace(),
        "polytope": cloud2csg.Polytope([[2, 0, 0, 2], [-1, 0, 0, 1], [0, 1, 0, 1], [0, -1, 0, 1], [0, 0, 1, 1],
                                        [0, 0, -1, 1]]),
        "extrusion": cloud2csg.Extrusion([[(0, 0), (2, 0, 1), (2, 1), (0, 1)], [(1, 0.5, 1), (1.2, 0.5, 1)]], height=3),
        "revolution": cloud2csg.Revolution(profile=[[(0, 0), (1, 0), (0, 2, 0)]], angle_deg=90),
        "expression": cloud2csg.Expression("sqrt(x^2 + y^2 + z^2) - 1", (-1, -1, -1), (1, 1, 1)),
    }
    primitives = [cloud2csg.Primitive(name, shape, (1, 2, 3), (0, 2, 0, 0)) for name, shape in shapes.items()]
    model = cloud2csg.Model.from_json(cloud2csg.Model(primitives).to_json())
    for primitive, (name, shape) in zip(model.primitives, shapes.items()):
        assert primitive.id == primitive.type == name and type(primitive.shape) is type(shape)
        assert primitive.position.tolist() == [1, 2, 3] and primitive.quaternion.tolist() == [0, 1, 0, 0]
        assert repr(primitive.shape) == repr(shape) and primitive.displacement_frequency is None
    np.testing.assert_allclose(model.primitives[6].shape.planes[0], [1, 0, 0, 1])
    assert model.primitives[7].shape.profile[0][:2] == [[0, 0, 0], [2, 0, 1]] and model.primitives[7].shape.height == 3
    assert model.primitives[8].shape.angle_deg == 90 and cloud2csg.Revolution([[(0, 0), (1, 0), (0, 2)]]).angle_deg == 360
    assert cloud2csg.Primitive("a", cloud2csg.Box((1, 1, 1)), displacement_frequency=2).displacement_frequency == 2


def test_profiles_that_make_no_solid_are_refused():
    with pytest.raises(cloud2csg.Error, match="segment 0 of path 0"):
        cloud2csg.Primitive("bow", cloud2csg.Extrusion([[(0, 0), (1, 1), (1, 0), (0, 1)]], 1))
    with pytest.raises(ValueError, match="found 1 numbers in corner 1 of path 0"):
        cloud2csg.Revolution([[(0, 0), (1,), (0, 1)]])


def test_primitive_fields():
    sphere = cloud2csg.Primitive("ball", cloud2csg.Sphere(1), position=(0, 0, 1))
    centred = POINTS - [0, 0, 1]
    distance = np.linalg.norm(centred, axis=1)
    np.testing.assert_allclose(sphere.distance(POINTS), distance - 1, atol=1e-12)
    np.testing.assert_allclose(sphere.gradient(POINTS), centred / distance[:, None], atol=1e-12)
    np.testing.assert_array_equal(sphere.bounds, [[-1, -1, 0], [1, 1, 2]])


def test_distance_follows_the_formula(plate):
    by_id = {primitive.id: primitive for primitive in plate.primitives}
    values = {name: primitive.distance(POINTS) for name, primitive in by_id.items()}
    expected = np.maximum(np.minimum(values["plate"], values["boss"]), -values["bore"])
    distance = plate.distance(POINTS)
    np.testing.assert_array_equal(distance, expected)
    gradient = plate.gradient(POINTS)
    of_bore = (expected == -values["bore"]) & (expected != values["plate"]) & (expected != values["boss"])
    assert of_bore.any()
    np.testing.assert_array_equal(gradient[of_bore], -by_id["bore"].gradient(POINTS)[of_bore])


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("layout", [np.ascontiguousarray, np.asfortranarray, lambda a: np.repeat(a, 2, 1)[:, ::2]])
def test_fields_do_not_depend_on_layout_blocks_or_threads(plate, layout, threads):
    distance, gradient = plate.distance(POINTS), plate.gradient(POINTS)
    points = layout(POINTS)
    np.testing.assert_array_equal(plate.distance(points, threads=threads), distance)
    np.testing.assert_array_equal(plate.gradient(points, threads=threads), gradient)
    np.testing.assert_array_equal(np.concatenate([plate.distance(part) for part in np.split(POINTS, 80)]), distance)
    assert plate.distance(points[:0]).shape == (0,) and plate.gradient(points[:0]).shape == (0, 3)


def test_wrong_points(plate):
    with pytest.raises(ValueError, match="points: expected finite numbers"):
        plate.distance([[0, 0, np.nan]])
    with pytest.raises(ValueError, match=r"points: expected an array of shape \(n, 3\)"):
        plate.gradient(np.zeros((2, 4)))
    with pytest.raises(ValueError, match="threads"):
        plate.distance(POINTS, threads=-1)


def test_measures(plate):
    assert (plate.size, plate.leaf_count, plate.depth) == (5, 3, 2)
    assert plate.bounds.shape == (2, 3) and plate.bounds[0].tolist() == [-2, -1.5, -0.5]
    twice = cloud2csg.Model(plate.primitives, plate.tree | plate.tree)
    assert twice.simplified().tree == plate.tree


def test_pictures(plate, tmp_path):
    picture = plate.picture(width=60, height=40)
    assert picture.shape == (40, 60, 3) and picture.dtype == np.uint8
    assert (picture != picture[:1]).any(axis=2).mean() > 0.1  # the background is constant along a row
    with_cloud = plate.picture(cloud2csg.sample(plate, count=500), height=40, azimuth_deg=30)
    assert with_cloud.shape == (40, 80, 3)
    plate.write(tmp_path / "plate.png")
    assert (tmp_path / "plate.png").read_bytes().startswith(b"\x89PNG")
    with pytest.raises(cloud2csg.Error, match="height"):
        plate.picture(height=0)


def test_without_a_tree(plate):
    primitives = cloud2csg.Model(plate)
    assert primitives.tree is None and primitives.primitives[0].id == "plate"
    for use in (lambda: primitives.distance(POINTS), primitives.to_scad, primitives.mesh, lambda: primitives.size):
        with pytest.raises(cloud2csg.Error, match="expected a model with a tree"):
            use()
    assert primitives._repr_html_() == "<pre>cloud2csg.Model: 3 primitives, no tree</pre>"


def test_equality_and_pickles(plate):
    assert pickle.loads(pickle.dumps(plate)) == plate
    assert plate != cloud2csg.Model(plate.primitives, "plate") and plate != "plate"


def test_wrong_models(plate):
    ball = cloud2csg.Primitive("ball", cloud2csg.Sphere(1))
    with pytest.raises(cloud2csg.Error, match="primitives/1/id"):
        cloud2csg.Model([ball, ball])
    with pytest.raises(TypeError, match="primitives: expected Primitive, found 3"):
        cloud2csg.Model([3])
    with pytest.raises(cloud2csg.Error, match="radius"):
        cloud2csg.Primitive("ball", cloud2csg.Sphere(-1))
    with pytest.raises(ValueError, match="quaternion"):
        cloud2csg.Primitive("ball", cloud2csg.Sphere(1), quaternion=(0, 0, 0, 0))
    with pytest.raises(cloud2csg.Error) as raised:
        cloud2csg.Model.from_json(plate.to_json().replace('"radius": 1', '"radius": "1"'))
    assert raised.value.where == "/primitives/1/radius"


@pytest.mark.parametrize("ending", [".json", ".scad", ".csg", ".FCMacro", ".py", ".stl", ".off", ".obj", ".dot", ".step", ".brep", ".html"])
def test_files(tmp_path, plate, ending):
    if ending in (".step", ".brep") and not cloud2csg.has_brep() or ending == ".html" and not cloud2csg.has_viewer():
        pytest.skip("not in this build")
    file = tmp_path / f"plate{ending}"
    report = plate.write(file)
    assert file.stat().st_size > 100 and report.cut_at is None
    if ending in (".step", ".brep"):
        assert report.brep.is_valid and report.brep.solids == 1 and report.brep.volume_difference < 0.01
    if ending in (".json", ".stl", ".off", ".obj"):
        assert cloud2csg.compare(plate, file, surface_samples=2000, resolution=64).intersection_over_union > 0.99


def test_unknown_ending(tmp_path, plate):
    with pytest.raises(cloud2csg.Error, match="expected a file ending in"):
        plate.write(tmp_path / "plate.doc")
    assert list(tmp_path.iterdir()) == []


def test_a_file_of_another_kind_is_not_overwritten(tmp_path, plate):
    theirs = tmp_path / "theirs.scad"
    theirs.write_text("cube(1);\n")
    with pytest.raises(cloud2csg.Error, match="already exists and is no OpenSCAD script of cloud2csg"):
        plate.write(theirs)
    assert theirs.read_text() == "cube(1);\n"
    for _ in range(2):
        plate.write(tmp_path / "ours.scad")


def test_unbounded_solids_are_cut(tmp_path):
    model = cloud2csg.Model([cloud2csg.Primitive("below", cloud2csg.HalfSpace())], Leaf("below"))
    assert model.write(tmp_path / "below.scad").cut_at.shape == (2, 3)


def test_texts(plate):
    scad = plate.to_scad(cloud2csg.OpenScadOptions(facets=12, comment="mine"))
    assert scad.startswith("// mine\n$fn = 12;") and "module bore()" in scad
    assert plate.to_text() == "(plate | boss) - bore" and plate.to_graphviz().startswith("digraph")
    assert json.loads(plate.to_json())["tree"]["op"] == "difference"


class Tags(html.parser.HTMLParser):
    """The elements of a page, with their attributes."""

    def __init__(self, text):
        super().__init__()
        self.found = []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.found.append((tag, dict(attrs)))


HOSTILE = "\"></iframe><script>alert('x')</script><b id=\"&quot;"


def test_page_in_a_notebook(plate):
    shown = plate._repr_html_()
    if not cloud2csg.has_viewer():
        assert shown.startswith("<pre>") and "viewer" in shown
        return
    assert shown.isascii()
    (tag, attributes), = Tags(shown).found
    assert tag == "iframe" and attributes["sandbox"] == "allow-scripts allow-downloads"
    assert "allow-same-origin" not in attributes["sandbox"]
    assert attributes["srcdoc"].lstrip().lower().startswith("<!doctype html>")


def test_hostile_names_stay_texts():
    ball = cloud2csg.Primitive(HOSTILE, cloud2csg.Sphere(1))
    with_tree = cloud2csg.Model([ball], Leaf(HOSTILE), description=HOSTILE)
    for model in (with_tree, cloud2csg.Model([ball], description=HOSTILE)):
        assert [tag for tag, _ in Tags(model._repr_html_()).found] in (["iframe"], ["pre"])
    if cloud2csg.has_viewer():
        page = with_tree.report(title=HOSTILE)
        assert "alert('x')" not in page
        assert page == Tags(f'<iframe srcdoc="{html.escape(page)}">').found[0][1]["srcdoc"]


def test_empty_solids_have_a_text(plate):
    nothing = cloud2csg.Model(plate.primitives, cloud2csg.Empty())
    assert np.all(np.isposinf(nothing.distance(POINTS[:5])))
    assert [tag for tag, _ in Tags(nothing._repr_html_()).found][0] in ("iframe", "pre")

"""sample, scan, detect, extract, compare."""
import numpy as np
import pytest

import cloud2csg


@pytest.fixture(scope="module")
def cloud(m0):
    return cloud2csg.sample(m0, count=20_000, noise=0.01, seed=3)


def test_sample_takes_options_and_fields(plate):
    by_fields = cloud2csg.sample(plate, count=500, noise=0.1, seed=5)
    by_options = cloud2csg.sample(plate, cloud2csg.SampleOptions(count=500, noise=0.1, seed=5))
    both = cloud2csg.sample(plate, cloud2csg.SampleOptions(count=7, noise=0.1), count=500, seed=5, threads=1)
    assert len(by_fields) == 500
    np.testing.assert_array_equal(by_fields.positions, by_options.positions)
    np.testing.assert_array_equal(by_fields.positions, both.positions)
    exact = cloud2csg.sample(plate, count=500)
    assert np.abs(plate.distance(exact.positions)).max() < 1e-9
    with pytest.raises(TypeError, match="SampleOptions has no field 'points'"):
        cloud2csg.sample(plate, points=3)
    with pytest.raises(TypeError, match="expected a Model or a TriangleMesh"):
        cloud2csg.sample(3)


def test_errors_have_the_warnings_before_them():
    across = np.arange(60.0)
    sheet = np.array([(x, y, 0) for x in across for y in across])
    wrong = np.tile((1.0, 0.0, 0.0), (len(sheet), 1))
    with pytest.raises(cloud2csg.Error) as raised:
        cloud2csg.extract(cloud2csg.PointCloud(sheet, wrong))
    assert any("normals" in warning for warning in raised.value.warnings)


def test_sample_of_a_mesh(plate):
    mesh = plate.mesh(resolution=48)
    assert len(cloud2csg.sample(mesh, count=100, noise=0.01)) == 100
    with pytest.raises(cloud2csg.Error, match="density"):
        cloud2csg.sample(mesh, density=3.0)


def test_scan(plate):
    scan = cloud2csg.scan(plate, count=3000, views=6)
    assert scan.normals is None and scan.sensor_positions.shape == scan.positions.shape
    assert len(np.unique(scan.sensor_positions, axis=0)) <= 6
    clean = cloud2csg.ScanOptions(count=3000, with_normals=True).without_defects()
    scan = cloud2csg.scan(plate.mesh(resolution=64), clean)
    assert np.abs(plate.distance(scan.positions)).max() < 0.05 and scan.normals is not None


def test_known_primitives(m0, cloud):
    result = cloud2csg.extract(cloud, m0, seed=4)
    assert cloud2csg.compare(m0, result).intersection_over_union > 0.999
    assert result.statistics["seed"] == 4 and result.complete and result.cloud is cloud
    assert [p.id for p in result.model.primitives] == [p.id for p in m0.primitives]
    assert result.warnings == result.statistics["warnings"]
    some = cloud2csg.extract(cloud, list(m0.primitives), cloud2csg.ExtractOptions(seed=4), threads=1)
    assert some.model.tree == result.model.tree
    unexplained = result.unexplained_points()
    assert unexplained.dtype == np.uint32 and len(unexplained) < 0.1 * len(cloud)
    strict = cloud2csg.SegmentationOptions(distance_tolerance=0.01)
    result = cloud2csg.extract(cloud, m0, cloud2csg.ExtractOptions(segmentation=strict))
    assert len(result.unexplained_points()) == result.statistics["fit"]["unexplained_points"] > len(unexplained)


def test_options_reach_the_search(m0, cloud):
    options = cloud2csg.ExtractOptions.paper()
    options.search.population = 20
    options.search.generation_limit = 2
    result = cloud2csg.extract(cloud, m0, options)
    assert result.statistics["strategy"] == "partition"
    with pytest.raises(cloud2csg.Error, match="population"):
        cloud2csg.extract(cloud, m0, cloud2csg.ExtractOptions(search=cloud2csg.GaOptions(population=-1)))


def test_raw_cloud(plate):
    raw = cloud2csg.sample(plate, count=30_000, noise=0.005, seed=2)
    positions = raw.positions
    result = cloud2csg.extract(positions, seed=2)
    assert cloud2csg.compare(plate, result).intersection_over_union > 0.97
    assert result.cloud.normals is not None and result.statistics["finding"]["normals_estimated"]
    again = cloud2csg.extract(positions, options=cloud2csg.ReconstructOptions(), seed=2, threads=1)
    assert again.model == result.model


def test_refined_primitives(plate):
    cloud = cloud2csg.sample(plate, count=20_000, noise=0.005)
    moved = [cloud2csg.Primitive(p.id, p.shape, p.position + (0.03, 0, 0)) for p in plate.primitives]
    rough = cloud2csg.extract(cloud, moved)
    fine = cloud2csg.extract(cloud, moved, refine=True)
    distance = [cloud2csg.compare(plate, result).mean_distance for result in (rough, fine)]
    assert distance[1] < 0.2 * distance[0]
    limited = cloud2csg.extract(cloud, moved, refine=cloud2csg.RefineOptions(rounds=1))
    assert limited.statistics["refine"]["rounds"] == 1
    with pytest.raises(TypeError, match="refine"):
        cloud2csg.extract(cloud, moved, refine="yes")


def test_detect(plate):
    found = cloud2csg.detect(cloud2csg.sample(plate, count=30_000, noise=0.005))
    cylinders = [surface for surface in found.surfaces if surface.type == "cylinder"]
    bore = next(surface for surface in cylinders if surface.concave)
    assert bore.radius == pytest.approx(0.5, abs=0.01) and abs(bore.axis[2]) == pytest.approx(1, abs=1e-3)
    assert np.sqrt(np.mean(bore.distance(found.cloud.positions[bore.points]) ** 2)) == pytest.approx(bore.rms, rel=0.01)
    finding = found.statistics["finding"]
    assert finding["noise"] == pytest.approx(0.005, rel=0.5) and not finding["normals_estimated"]
    assert np.shares_memory(bore.points, bore.points) and bore.points.dtype == np.uint32
    assert found.model.tree is not None and 1 <= len(found.model.primitives) <= 3
    assert finding["unexplained_points"] < 0.05 * len(found.cloud) and found.warnings == []


def test_verdict(plate):
    cloud = cloud2csg.sample(plate, count=20_000, noise=0.002)
    result = cloud2csg.extract(cloud, plate)
    assert result.verdict == result.statistics["verdict"]
    assert result.verdict["grade"] == "good" and result.verdict["text"].startswith("good: ")
    assert result.verdict["regions"] == [] and 0.9 < result.verdict["share_within"] <= 1
    lacking = cloud2csg.extract(cloud, [plate.primitives[0]])
    assert lacking.verdict["grade"] != "good" and lacking.verdict["doubts"]


def test_exact_points_are_told(tmp_path, plate):
    plate.mesh(resolution=48).write(tmp_path / "plate.stl")
    cloud = cloud2csg.read_cloud(tmp_path / "plate.stl", mesh_points=20_000)
    assert cloud.is_exact and cloud2csg.detect(cloud).cloud.is_exact


def test_compare(tmp_path, plate, m0):
    same = cloud2csg.compare(plate, plate, surface_samples=1000, resolution=64)
    assert (same.intersection_over_union, same.size_ratio) == (1, 1)
    cloud = cloud2csg.compare(plate, cloud2csg.sample(plate, count=5000), surface_samples=1000)
    assert cloud.intersection_over_union is None and cloud.volume_result is None and cloud.mean_distance < 0.1
    mesh = cloud2csg.compare(plate, plate.mesh(), cloud2csg.CompareOptions(surface_samples=1000, resolution=64))
    assert mesh.intersection_over_union > 0.99 and mesh.size_ratio is None
    with pytest.raises(TypeError, match="compare: expected a Model"):
        cloud2csg.compare(plate, 3)


def test_clouds_of_no_use(m0):
    with pytest.raises(cloud2csg.Error, match="normals"):
        cloud2csg.extract(np.zeros((100, 3)), m0)
    with pytest.raises(ValueError, match="positions"):
        cloud2csg.extract(np.zeros((100, 2)))
    with pytest.raises(cloud2csg.Error):
        cloud2csg.detect(np.zeros((3, 3)))


def test_result_files(tmp_path, m0, cloud):
    result = cloud2csg.extract(cloud, m0)
    result.write(tmp_path / "m0.scad")
    assert "module" in (tmp_path / "m0.scad").read_text()
    if cloud2csg.has_viewer():
        result.write(str(tmp_path / "m0.html"))
        assert (tmp_path / "m0.html").stat().st_size > len(m0.report())
        assert result._repr_html_().startswith("<iframe srcdoc=")

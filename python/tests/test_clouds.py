"""Arrays in and out."""
import copy
import gc
import pickle

import numpy as np
import pytest

import cloud2csg

POINTS = np.random.default_rng(1).normal(size=(50, 3))
NORMALS = POINTS / np.linalg.norm(POINTS, axis=1, keepdims=True)


@pytest.mark.parametrize("values", [
    POINTS, np.asfortranarray(POINTS), np.repeat(POINTS, 2, axis=0)[::2], POINTS.astype(">f8"), POINTS.tolist(),
    np.frombuffer(b"x" + POINTS.tobytes(), dtype=np.uint8)[1:].view("f8").reshape(-1, 3)])
def test_any_layout_gives_the_same_points(values):
    cloud = cloud2csg.PointCloud(values)
    np.testing.assert_array_equal(cloud.positions, POINTS)
    assert cloud.positions.dtype == np.float64 and cloud.positions.flags.c_contiguous
    assert len(cloud) == 50 and cloud.normals is None and cloud.normal_columns is None


def test_single_precision_is_converted():
    cloud = cloud2csg.PointCloud(POINTS.astype(np.float32))
    np.testing.assert_array_equal(cloud.positions, POINTS.astype(np.float32).astype(np.float64))


def test_columns_are_the_memory_of_the_cloud():
    cloud = cloud2csg.PointCloud(POINTS, NORMALS)
    x, y, z = cloud.position_columns
    assert x.base is cloud and np.shares_memory(x, cloud.position_columns[0])
    np.testing.assert_array_equal(np.column_stack([x, y, z]), POINTS)
    with pytest.raises(ValueError, match="read-only"):
        x[0] = 1
    nx = cloud.normal_columns[0]
    del cloud, x, y, z
    gc.collect()
    np.testing.assert_allclose(nx, NORMALS[:, 0], rtol=1e-15)


def test_rows_are_made_once():
    cloud = cloud2csg.PointCloud(POINTS)
    assert cloud.positions is cloud.positions
    with pytest.raises(ValueError, match="read-only"):
        cloud.positions[0] = 0


def test_a_cloud_does_not_follow_the_array_it_was_made_of():
    values = POINTS.copy()
    cloud = cloud2csg.PointCloud(values)
    values[:] = 0
    np.testing.assert_array_equal(cloud.positions, POINTS)


def test_normals_get_unit_length():
    cloud = cloud2csg.PointCloud(POINTS, 3 * NORMALS)
    np.testing.assert_allclose(cloud.normals, NORMALS, rtol=1e-15)


@pytest.mark.parametrize("arguments, message", [
    ({"positions": [[0, 1]]}, r"positions: expected an array of shape \(n, 3\), found one of shape \(1, 2\)"),
    ({"positions": [0.0, 1.0, 2.0]}, r"shape \(n, 3\), found one of shape \(3,\)"),
    ({"positions": [[0, 1, "x"]]}, "positions: expected numbers"),
    ({"positions": [[0, 0, 0], [0, np.nan, 0]]}, r"expected finite numbers, found \(0, nan, 0\) in row 1"),
    ({"positions": [[0, 0, np.inf]]}, "in row 0"),
    ({"positions": POINTS, "normals": NORMALS[:-1]}, "normals: expected as many rows as positions, 50, found 49"),
    ({"positions": POINTS, "normals": 0 * NORMALS}, "normals: expected directions, found length 0 in row 0"),
    ({"positions": POINTS, "sensor_positions": [[np.nan] * 3]}, "sensor_positions: expected finite"),
])
def test_wrong_arrays_are_named(arguments, message):
    with pytest.raises(ValueError, match=message):
        cloud2csg.PointCloud(**arguments)


@pytest.mark.parametrize("ending", [".ply", ".pcd", ".xyzn"])
def test_files_keep_every_bit(tmp_path, ending):
    cloud = cloud2csg.PointCloud(POINTS, NORMALS)
    file = tmp_path / f"cloud{ending}"
    cloud.write(file)
    read = cloud2csg.read_cloud(file)
    np.testing.assert_array_equal(read.positions, POINTS)
    np.testing.assert_array_equal(read.normals, cloud.normals)
    assert read.warnings == [] and not read.is_exact


def test_sensor_positions_are_kept(tmp_path):
    cloud = cloud2csg.PointCloud(POINTS, sensor_positions=POINTS + 5)
    cloud.write(str(tmp_path / "scan.ply"), cloud2csg.CloudWriteOptions(binary=False))
    np.testing.assert_array_equal(cloud2csg.read_cloud(tmp_path / "scan.ply").sensor_positions, POINTS + 5)


def test_a_file_of_the_wrong_kind_is_told_which_function_takes_it(tmp_path):
    model = tmp_path / "part.json"
    cloud2csg.Model([cloud2csg.Primitive("ball", cloud2csg.Sphere(1))], "ball").write(model)
    with pytest.raises(cloud2csg.Error, match=r"found a model; read it with Model.read\(\)") as raised:
        cloud2csg.read_cloud(model)
    assert "Model.read()" in raised.value.remedy
    cloud2csg.PointCloud(POINTS).write(tmp_path / "scan.ply")
    with pytest.raises(cloud2csg.Error, match=r"expected a mesh, found a point cloud; read it with read_cloud\(\)"):
        cloud2csg.read_mesh(tmp_path / "scan.ply")


def test_missing_file_is_an_error_with_parts(tmp_path):
    file = tmp_path / "none.ply"
    with pytest.raises(cloud2csg.Error) as raised:
        cloud2csg.read_cloud(file)
    assert raised.value.file == str(file) and str(file) in str(raised.value)
    assert isinstance(raised.value, Exception) and raised.value.expected


def test_invalid_points_are_left_out_with_a_warning(tmp_path):
    file = tmp_path / "holes.xyz"
    file.write_text("0 0 0\nnan nan nan\n1 0 0\n")
    cloud = cloud2csg.read_cloud(file)
    assert len(cloud) == 2 and len(cloud.warnings) == 1


def test_selected_points_keep_their_normals():
    cloud = cloud2csg.PointCloud(POINTS, NORMALS)
    part = cloud.select([3, 1])
    np.testing.assert_array_equal(part.positions, POINTS[[3, 1]])
    np.testing.assert_array_equal(part.normals, cloud.normals[[3, 1]])
    with pytest.raises(IndexError):
        cloud.select([50])


def test_pickle_keeps_a_cloud():
    cloud = cloud2csg.PointCloud(POINTS, NORMALS, POINTS + 1, is_exact=True)
    again = pickle.loads(pickle.dumps(cloud))
    np.testing.assert_array_equal(again.positions, POINTS)
    np.testing.assert_array_equal(again.normals, cloud.normals)
    np.testing.assert_array_equal(again.sensor_positions, POINTS + 1)
    assert again.is_exact and copy.copy(cloud).is_exact


def test_meshes(tmp_path, plate):
    mesh = plate.mesh(resolution=48)
    assert mesh.is_watertight and mesh.triangles.dtype == np.uint32 and mesh.triangles.shape[1] == 3
    assert np.shares_memory(mesh.triangles, mesh.triangles)
    again = cloud2csg.TriangleMesh(mesh.vertices, mesh.triangles)
    assert again.volume == mesh.volume
    mesh.write(tmp_path / "plate.stl")
    assert cloud2csg.read_mesh(tmp_path / "plate.stl").volume == pytest.approx(mesh.volume, rel=1e-5)
    drawn = cloud2csg.read_cloud(tmp_path / "plate.stl", mesh_points=2000)
    assert drawn.is_exact and len(drawn) == 2000
    with pytest.raises(ValueError, match="indices of vertices, found 9"):
        cloud2csg.TriangleMesh(POINTS[:3], [[0, 1, 9]])


CORNERS = "0 0 0\n1 0 0\n0 1 0\n"
PLY = (
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n" + CORNERS
)


@pytest.mark.parametrize(
    "name, content",
    [
        ("index.off", "OFF\n3 1 0\n" + CORNERS + "3 0 1 3\n"),
        ("negative.off", "OFF\n3 1 0\n" + CORNERS + "3 0 1 -1\n"),
        ("cut.off", "OFF\n3 1 0\n0 0 0\n1 0"),
        ("count.off", "OFF\n4294967295 4294967295 0\n"),
        ("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -9\n"),
        ("index.ply", PLY + "3 0 1 3\n"),
        ("negative.ply", PLY + "3 0 1 -1\n"),
        ("cut.ply", PLY[:-9]),
        ("count.stl", " " * 80 + "\xff\xff\xff\xff"),
        ("nothing.3mf", ""),
        ("zip.3mf", "PK\x03\x04"),
        ("head.glb", "glTF\x02\x00\x00\x00\xff\xff\xff\xff\xff\xff\xff\xffJSON{}"),
    ],
)
def test_damaged_meshes_raise(tmp_path, name, content):
    file = tmp_path / name
    file.write_bytes(content.encode("latin-1"))
    for read in (cloud2csg.read_mesh, cloud2csg.read_cloud):
        with pytest.raises(cloud2csg.Error) as raised:
            read(file)
        assert str(file) in str(raised.value) and "\n" not in str(raised.value)


def test_any_cut_raises_or_reads(tmp_path, plate):
    for ending in (".stl", ".off", ".obj", ".3mf"):
        file = tmp_path / f"plate{ending}"
        plate.mesh(resolution=8).write(file)
        whole = file.read_bytes()
        refused = 0
        for share in range(100):
            file.write_bytes(whole[: len(whole) * share // 100])
            try:
                cloud2csg.read_mesh(file)
            except cloud2csg.Error:
                refused += 1
        assert refused >= (1 if ending == ".obj" else 100), ending  # a truncated .obj may be valid

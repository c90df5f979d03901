"""The package outside of the build folder: as a wheel, and as `make install` puts it."""
import os
import pathlib
import subprocess
import sys
import zipfile

import pytest

BUILD = pathlib.Path(os.environ.get("CLOUD2CSG_BUILD_FOLDER", "build/release"))
USE = """
import pathlib, sys, tempfile
import cloud2csg
assert pathlib.Path(cloud2csg.__file__).is_relative_to(sys.argv[1]), cloud2csg.__file__
model = cloud2csg.Model.read(sys.argv[2])
result = cloud2csg.extract(cloud2csg.sample(model, count=5000), model)
with tempfile.TemporaryDirectory() as folder:
    if cloud2csg.has_brep():
        assert cloud2csg.Model([cloud2csg.Primitive("b", cloud2csg.Box((1, 1, 1)))], "b").write(
            pathlib.Path(folder, "b.step")).brep.is_valid
print("brep", cloud2csg.has_brep(), "nodes", result.model.size)
"""


def run(*command, **settings):
    return subprocess.run([str(part) for part in command], check=True, capture_output=True, text=True, **settings).stdout


def use(folder, root):
    """What the package in the folder says, without the build folder in the path."""
    return run(sys.executable, "-c", USE, folder, root / "data/models/m0.json",
                env={"PATH": os.environ["PATH"], "PYTHONPATH": str(folder)}, cwd=folder)


@pytest.fixture(scope="module")
def here(root):
    sys.path.insert(0, str(root / "python/packaging"))
    import cloud2csg
    yield f"brep {cloud2csg.has_brep()} nodes "
    sys.path.remove(str(root / "python/packaging"))


def test_wheel(root, tmp_path, here):
    import wheel_backend
    name = wheel_backend.build_wheel(tmp_path, {"build-folder": str(BUILD)})
    with zipfile.ZipFile(tmp_path / name) as wheel:
        assert wheel.testzip() is None
        names = wheel.namelist()
        assert {"cloud2csg/__init__.py", "cloud2csg/tree.py", "cloud2csg/py.typed", "cloud2csg/_native.pyi"} < set(names)
        record = wheel.read(next(n for n in names if n.endswith("/RECORD"))).decode()
        assert [line.split(",")[0] for line in record.splitlines()] == names
        wheel.extractall(tmp_path / "unpacked")
    assert use(tmp_path / "unpacked", root).startswith(here)


@pytest.mark.skipif(subprocess.run([sys.executable, "-m", "pip", "--version"], capture_output=True).returncode != 0,
                    reason="pip is not installed")
def test_pip_installs_it(root, tmp_path, here):
    run(sys.executable, "-m", "pip", "wheel", root, "--no-deps", "--no-build-isolation", "--no-index", "-w", tmp_path,
        f"--config-settings=build-folder={BUILD}", env={**os.environ, "PIP_NO_CACHE_DIR": "1"})
    wheel, = tmp_path.glob("cloud2csg-*.whl")
    run(sys.executable, "-m", "pip", "install", "--target", tmp_path / "site", "--no-deps", "--no-index", wheel)
    assert use(tmp_path / "site", root).startswith(here)


def test_make_install(root, tmp_path, here):
    prefix = tmp_path / "usr"
    run("cmake", "--install", BUILD, "--prefix", prefix)
    package, = prefix.rglob("cloud2csg/__init__.py")
    place = package.parent.parent
    # Debian's interpreter searches this folder below /usr/local and /usr.
    assert place == prefix / f"lib/python{sys.version_info[0]}.{sys.version_info[1]}/dist-packages"
    assert use(place, root).startswith(here)
    assert str(BUILD.resolve()) not in run("readelf", "-d", package.with_name(next(package.parent.glob("_native*.so")).name))

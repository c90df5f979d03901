"""Build backend of the wheel (PEP 517): CMake builds and installs the package, this packs it.

    python3 -m pip wheel . --no-deps --no-build-isolation

builds in build/wheel; --config-settings build-folder=build/release takes what another build has made. The wheel needs
the machine's shared libraries (TBB, fmt, Embree...), so it is for machines like the one that built it.
"""
import base64
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import sysconfig
import tempfile
import tomllib
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
OPTIONS = ["--preset", "release", "-DCLOUD2CSG_PYTHON=ON", "-DCLOUD2CSG_BUILD_TESTS=OFF",
           "-DCLOUD2CSG_BUILD_BENCHMARKS=OFF"]


def version():
    return re.search(r"project\(cloud2csg VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1)


def metadata():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    lines = ["Metadata-Version: 2.1", f"Name: {project['name']}", f"Version: {version()}",
             f"Summary: {project['description']}", f"License: {project['license']['text']}",
             f"Requires-Python: {project['requires-python']}"]
    lines += [f"Requires-Dist: {name}" for name in project["dependencies"]]
    return "\n".join(lines) + "\n"


def tag():
    python = f"cp{sys.version_info[0]}{sys.version_info[1]}"
    return f"{python}-{python}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"


def installed_package(stage, build_folder):
    """The folder `cloud2csg` as CMake installs it, complete in itself."""
    build = pathlib.Path(build_folder or ROOT / "build/wheel")
    if build_folder is None:
        subprocess.run(["cmake", *OPTIONS, "-B", build, f"-DPython_EXECUTABLE={sys.executable}"], cwd=ROOT, check=True)
        # As in the preset, so that builds share the compiler's cache.
        cached = {**os.environ, "CCACHE_BASEDIR": str(ROOT), "CCACHE_NOHASHDIR": "1"}
        subprocess.run(["cmake", "--build", build, "--target", "cloud2csg_package"], env=cached, check=True)
    for component in ("Python", "Wheel"):
        subprocess.run(["cmake", "--install", build, "--prefix", stage, "--component", component, "--strip"],
                       check=True)
    return next(pathlib.Path(stage).rglob("cloud2csg/__init__.py")).parent


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    name = f"cloud2csg-{version()}"
    wheel = pathlib.Path(wheel_directory, f"{name}-{tag()}.whl")
    info = f"{name}.dist-info"
    with tempfile.TemporaryDirectory() as stage:
        package = installed_package(stage, (config_settings or {}).get("build-folder"))
        files = {str(file.relative_to(package.parent)): file.read_bytes()
                 for file in sorted(package.rglob("*")) if file.is_file()}
    files[f"{info}/METADATA"] = metadata().encode()
    files[f"{info}/WHEEL"] = (f"Wheel-Version: 1.0\nGenerator: cloud2csg\nRoot-Is-Purelib: false\n"
                              f"Tag: {tag()}\n").encode()
    record = ""
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for path, content in files.items():
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).decode().rstrip("=")
            record += f"{path},sha256={digest},{len(content)}\n"
            archive.writestr(path, content)
        archive.writestr(f"{info}/RECORD", f"{record}{info}/RECORD,,\n")
    return wheel.name

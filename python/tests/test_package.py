"""What belongs to a package: names, docstrings, types."""
import ast
import inspect
import pathlib
import subprocess
import sys

import pytest

import cloud2csg
from cloud2csg import _native

STUB = pathlib.Path(_native.__file__).with_name("_native.pyi")


def members(kind):
    """Public members that a class defines itself."""
    return {name: value for name, value in vars(kind).items() if not name.startswith("_")}


def stubs():
    """By name: the functions, and the classes with the names within them."""
    found = {}
    for node in ast.parse(STUB.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.FunctionDef):
            found[node.name] = node
        elif isinstance(node, ast.ClassDef):
            found[node.name] = {getattr(part, "name", None) or part.target.id: part for part in node.body
                                if isinstance(part, (ast.FunctionDef, ast.AnnAssign))}
    return found


def public():
    return {name: value for name, value in vars(_native).items() if not name.startswith("_")}


def test_the_package_has_what_the_module_has():
    of_tree = {"Complement", "Difference", "Empty", "Full", "Intersection", "Leaf", "Node", "Union"}
    assert set(public()) | of_tree | {"__version__"} == set(cloud2csg.__all__)
    assert all(hasattr(cloud2csg, name) for name in cloud2csg.__all__)


def test_every_name_has_a_docstring():
    for name in cloud2csg.__all__:
        value = getattr(cloud2csg, name)
        if name != "__version__":
            assert inspect.getdoc(value), name
            for member, part in members(value).items() if isinstance(value, type) else ():
                if callable(part) or isinstance(part, (property, staticmethod)):
                    assert inspect.getdoc(part), f"{name}.{member}"
    assert cloud2csg.__doc__ and cloud2csg.tree.__doc__


def test_functions_say_what_arrays_and_units_they_take():
    for text in (cloud2csg.Model.distance.__doc__, cloud2csg.Model.gradient.__doc__, cloud2csg.extract.__doc__,
                 cloud2csg.detect.__doc__, cloud2csg.PointCloud.__doc__):
        assert "shape (n, 3)" in text


def test_every_name_has_a_stub():
    typed = stubs()
    assert set(public()) == set(typed)
    for name, value in public().items():
        if isinstance(value, type):
            written = {member for member in typed[name] if not member.startswith("__")}
            assert written - {"_repr_html_"} == set(members(value)), name


def test_keywords_of_functions_are_those_of_the_stubs():
    """pybind11 puts the signature into the docstring's first line."""
    typed = stubs()
    checked = 0
    for name, value in public().items():
        pairs = [(typed[name], value)] if not isinstance(value, type) else [
            (part, getattr(value, member)) for member, part in typed[name].items()
            if isinstance(part, ast.FunctionDef) and not part.decorator_list and not member.startswith("__")]
        for stub, function in pairs:
            line = function.__doc__.splitlines()[0]
            arguments = [*stub.args.posonlyargs, *stub.args.args, *stub.args.kwonlyargs]
            if name.endswith("Options") or "Overloaded" in line:
                continue
            for argument in arguments:
                is_field = "**kwargs" in line and argument in stub.args.kwonlyargs
                assert f"{argument.arg}: " in line or is_field, f"{name}: {argument.arg} not in {line}"
            checked += 1
    assert checked > 20


@pytest.mark.skipif(subprocess.run([sys.executable, "-c", "import mypy"], stderr=subprocess.DEVNULL).returncode != 0,
                    reason="mypy is not installed")
def test_types_hold(tmp_path):
    code = tmp_path / "use.py"
    code.write_text("import cloud2csg\n"
                    "model = cloud2csg.Model.read('m0.json')\n"
                    "options = cloud2csg.ExtractOptions(strategy='cells', time_limit_seconds=None)\n"
                    "options.search.population = 3\n"
                    "result = cloud2csg.extract(cloud2csg.sample(model, count=3), model, options, seed=3)\n"
                    "size: int = result.model.size\n"
                    "tree: cloud2csg.Node | None = model.tree\n"
                    "cloud2csg.ExtractOptions(strategy='best')\n"
                    "model.distance(3, threads='all')\n", encoding="utf-8")
    ran = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--cache-dir", tmp_path / "cache", code],
                         capture_output=True, text=True, check=False, cwd=tmp_path)
    errors = [line for line in ran.stdout.splitlines() if ": error:" in line]
    assert [line.split(":")[1] for line in errors] == ["8", "9"], ran.stdout

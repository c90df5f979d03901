"""The examples and the documents run as they are written."""
import ast
import doctest
import json
import os
import subprocess
import sys

import pytest

import cloud2csg


def test_script(root, tmp_path):
    output = tmp_path / "out.scad"
    ran = subprocess.run([sys.executable, root / "examples/extract.py", "-n", "20000", "-o", output], check=True,
                         capture_output=True, text=True)
    assert "module bore()" in output.read_text()
    assert "20000 points, 18 primitives: 35 nodes, 18 leaves" in ran.stdout
    assert "intersection_over_union=0.999" in ran.stdout or "intersection_over_union=1" in ran.stdout


def test_script_says_what_is_wrong(root, tmp_path):
    ran = subprocess.run([sys.executable, root / "examples/extract.py", tmp_path / "none.json"], check=False,
                         capture_output=True, text=True)
    assert ran.returncode == 1 and ran.stderr.startswith("error: ") and len(ran.stderr.splitlines()) == 1


def show(cell):
    """Runs a cell as Jupyter does: what its last expression is gets shown."""
    body = ast.parse(cell).body
    last = ast.Expression(body.pop().value) if isinstance(body[-1], ast.Expr) else None
    return compile(ast.Module(body, []), "cell", "exec"), last and compile(last, "cell", "eval")


def test_notebook(root, monkeypatch):
    notebook = json.loads((root / "examples/tour.ipynb").read_text(encoding="utf-8"))
    assert notebook["nbformat"] == 4
    monkeypatch.chdir(root / "examples")
    names = {}
    shown = []
    for cell in notebook["cells"]:
        if cell["cell_type"] == "code":
            statements, last = show("".join(cell["source"]))
            exec(statements, names)
            shown.append(eval(last, names) if last else None)
    pages = [value._repr_html_() for value in shown if hasattr(value, "_repr_html_")]
    assert len(pages) == 2 and all(page.startswith("<iframe" if cloud2csg.has_viewer() else "<pre") for page in pages)
    comparison = next(value for value in shown if isinstance(value, cloud2csg.Comparison))
    assert comparison.intersection_over_union > 0.97
    assert names["result"].model.tree == names["part"].simplified().tree


def test_notebook_is_valid(root):
    nbformat = pytest.importorskip("nbformat")
    nbformat.validate(nbformat.read(root / "examples/tour.ipynb", as_version=4))


def test_document(root, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    os.symlink(root / "data", tmp_path / "data")
    failed, run = doctest.testfile(str(root / "docs/python.md"), module_relative=False,
                                   optionflags=doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE)
    assert failed == 0 and run > 20


@pytest.mark.parametrize("module", [cloud2csg, cloud2csg.tree])
def test_docstrings(root, module, monkeypatch):
    monkeypatch.chdir(root)
    failed, run = doctest.testmod(module)
    assert failed == 0 and run > 3

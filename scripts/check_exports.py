#!/usr/bin/env python3
"""Checks what cloud2csg exports with the programs that read it, and prints a table.

    scripts/check_exports.py [--cloud2csg PROGRAM] [--noise SIGMA] FILE...

Each FILE, a model (.json) or a mesh, is extracted to .step, .scad, .html and .json; a model is sampled first, with noise. Then
FreeCAD (freecadcmd, which reads by OpenCASCADE) tells whether the .step file is valid and of what volume, which must be within
0.1 % of the tree's, and OpenSCAD renders the .scad file, without warnings. Exit code 1 if something is wrong.
"""

import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile

VOLUME_TOLERANCE = 1e-3
TIME_LIMIT_S = 900

FREECAD_SCRIPT = """import Part
shape = Part.Shape()
shape.read("result.step")
print("SEEN", shape.isValid(), repr(shape.Volume))
"""


def run(folder, *command):
    """Exit code and all that the program said."""
    try:
        done = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              errors="replace", timeout=TIME_LIMIT_S, env={**os.environ, "HOME": str(folder)})
    except FileNotFoundError:
        sys.exit(f"check_exports: {command[0]}: expected a program, found none; install it, or name it by an option")
    except subprocess.TimeoutExpired:
        return 1, f"no end after {TIME_LIMIT_S} s"
    return done.returncode, done.stdout


def last_line(text):
    lines = text.strip().splitlines()
    return lines[-1] if lines else "no output"


def prepared(program, file, folder, noise):
    """What is to be extracted: a mesh itself, points of a model."""
    if file.suffix != ".json":
        return file
    points = folder / "points.ply"
    code, text = run(folder, program, "sample", str(file), "-o", str(points), "--noise", str(noise))
    if code != 0:
        raise RuntimeError(f"sample: {last_line(text)}")
    return points


def tree_volume(program, folder):
    code, text = run(folder, program, "compare", "result.json", "result.json")
    found = re.search(r"^volume of the truth\s+(\S+)", text, re.MULTILINE)
    if code != 0 or not found:
        raise RuntimeError(f"compare: expected a line 'volume of the truth', found: {last_line(text)}")
    return float(found[1])


def check(arguments, file, folder):
    """A row of the table, and whether all is well."""
    source = prepared(arguments.cloud2csg, file, folder, arguments.noise)
    outputs = [option for end in ("step", "scad", "html", "json") for option in ("-o", f"result.{end}")]
    code, text = run(folder, arguments.cloud2csg, "extract", str(source), *outputs)
    missing = [end for end in ("step", "scad", "html", "json") if not (folder / f"result.{end}").is_file()]
    if code not in (0, 3) or missing:  # 3: doubtful, but written
        raise RuntimeError(f"extract: {last_line(text)}")
    (folder / "read.py").write_text(FREECAD_SCRIPT, encoding="utf-8")
    _, seen = run(folder, arguments.freecad, "read.py")
    found = re.search(r"SEEN (True|False) (\S+)", seen)
    if not found:
        raise RuntimeError(f"FreeCAD: {last_line(seen)}")
    ratio = float(found[2]) / tree_volume(arguments.cloud2csg, folder)
    code, rendered = run(folder, arguments.openscad, "-o", "result.stl", "result.scad")
    complaints = [line for line in rendered.splitlines() if line.startswith(("WARNING", "ERROR", "DEPRECATED"))]
    is_right = found[1] == "True" and abs(ratio - 1) <= VOLUME_TOLERANCE and code == 0 and not complaints
    return [found[1], f"{ratio:.5f}", str(len(complaints)) if code == 0 else "fails"], is_right


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", type=pathlib.Path, metavar="FILE")
    parser.add_argument("--cloud2csg", default="build/release/cloud2csg")
    parser.add_argument("--freecad", default="freecadcmd")
    parser.add_argument("--openscad", default="openscad")
    parser.add_argument("--noise", type=float, default=0.01, help="of points of models, in their units")
    arguments = parser.parse_args()
    if os.sep in arguments.cloud2csg:
        arguments.cloud2csg = str(pathlib.Path(arguments.cloud2csg).resolve())
    print(f"{'model':24} {'step valid':>10} {'volume ratio':>12} {'scad warnings':>13}")
    is_all_right = True
    for file in arguments.files:
        with tempfile.TemporaryDirectory() as folder:
            try:
                cells, is_right = check(arguments, file.resolve(), pathlib.Path(folder))
                print(f"{file.name:24} {cells[0]:>10} {cells[1]:>12} {cells[2]:>13}", flush=True)
            except RuntimeError as failure:
                print(f"{file.name:24} {failure}", flush=True)
                is_right = False
        is_all_right = is_all_right and is_right
    sys.exit(0 if is_all_right else 1)


if __name__ == "__main__":
    main()

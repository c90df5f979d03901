#!/usr/bin/env python3
"""From meshes to trees, judged outside: how good and how fast `cloud2csg extract` is on a folder of meshes.

    bench/inversecsg.py FOLDER [--program build/release/cloud2csg] [--variants clean noise scan]

For each mesh of the folder, or .scad file, which OpenSCAD makes a mesh of: 100 000 points without noise, with noise of 0.2 % of
the diagonal, and a virtual scan from 20 viewpoints without normals; with the variant "table" such a scan from above only, of a
part that lies on a table. The tree is written as .scad, rendered by OpenSCAD, and that mesh is compared with the input. Prints a
table; nothing is known of a model but its mesh.
"""

import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

ENDINGS = (".off", ".stl", ".obj", ".ply", ".scad")
STAGES = ("read", "clean", "detect", "solids", "extraction")
RENDER_SECONDS = 900
DOUBTFUL = 3  # exit status of `extract`; the files are written


def run(command, seconds=None, accepted=(0,)):
    result = subprocess.run(command, capture_output=True, text=True, timeout=seconds)
    if result.returncode not in accepted:
        raise RuntimeError(((result.stderr.strip() or result.stdout.strip()).splitlines() or ["failed"])[-1])
    return result.stdout


def make_mesh(script, folder):
    """OpenSCAD's mesh of a script, its corners and triangles sorted: their order differs from run to run, and samples with it."""
    mesh = folder / f"{script.stem}.off"
    run(["openscad", "-o", mesh, script], RENDER_SECONDS)
    head, *lines = (line.split() for line in mesh.read_text().split("\n") if line.strip())
    count = int((head[1:] or lines.pop(0))[0])
    corners, faces = lines[:count], [[int(k) for k in line[1:]] for line in lines[count:]]
    order = sorted(range(count), key=lambda k: [float(x) for x in corners[k]])
    place = {corner: k for k, corner in enumerate(order)}
    turned = []
    for face in ([place[k] for k in face] for face in faces):
        first = face.index(min(face))
        turned.append([len(face), *face[first:], *face[:first]])
    rows = [corners[k] for k in order] + sorted(turned)
    mesh.write_text(f"OFF\n{count} {len(turned)} 0\n" + "\n".join(" ".join(map(str, row)) for row in rows) + "\n")
    return mesh


def make_cloud(program, mesh, variant, points, seed, folder):
    """What `extract` is given: the mesh itself, or a cloud made of it."""
    cloud = folder / f"{variant}.ply"
    if variant == "clean":
        run([program, "sample", mesh, "-n", str(points), "--seed", str(seed), "-o", cloud, "-q"])
    elif variant == "noise":
        run([program, "sample", mesh, "-n", str(points), "--seed", str(seed), "--relative-noise", "0.002",
             "-o", cloud, "-q"])
    else:
        above = ["--on-table"] if variant == "table" else []
        run([program, "scan", mesh, "--seed", str(seed), *above, "-o", cloud, "-q"])
    return cloud


def judge(program, openscad, mesh, tree, folder):
    """The tree's solid against the mesh: rendered by OpenSCAD, or, without it, as the program itself sees it."""
    if openscad:
        rendered = folder / "rendered.off"
        run([openscad, "-o", rendered, tree.with_suffix(".scad")], RENDER_SECONDS)
        tree = rendered
    return json.loads(run([program, "compare", mesh, tree, "--json", "-q"]))


def measure(program, openscad, mesh, variant, arguments):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        if mesh.suffix == ".scad":
            mesh = make_mesh(mesh, folder)
        cloud = make_cloud(program, mesh, variant, arguments.points, arguments.seed, folder)
        scad, tree, stats = folder / "tree.scad", folder / "tree.json", folder / "stats.json"
        begin = time.monotonic()
        run([program, "extract", cloud, "-o", scad, "-o", tree, "--stats", stats, "-q"], 600, (0, DOUBTFUL))
        seconds = time.monotonic() - begin
        values = json.loads(stats.read_text())
        compared = judge(program, openscad, mesh, tree, folder)
        if arguments.keep:
            keep = pathlib.Path(arguments.keep)
            keep.mkdir(parents=True, exist_ok=True)
            (keep / f"{mesh.stem}_{variant}.scad").write_text(scad.read_text())
        return {
            "model": mesh.stem, "variant": variant, "points": values["points"],
            "surfaces": values["finding"]["surfaces"], "leaves": values["tree"]["leaves"],
            "price": values["tree"]["price"], "verdict": values["verdict"]["grade"],
            "iou": compared["intersection_over_union"], "mean": compared["mean_distance"],
            "hausdorff": compared["hausdorff_distance"], "seconds": seconds,
            "stages": {stage: values["seconds"].get(stage, 0) for stage in STAGES},
        }


def row(cells, widths):
    return "| " + " | ".join(str(cell).rjust(width) for cell, width in zip(cells, widths)) + " |"


def print_table(rows):
    head = ["model", "variant", "points", "surfaces", "leaves", "price", "verdict", "IoU", "mean", "Hausdorff", "s", *STAGES]
    lines = []
    for r in rows:
        if "error" in r:
            lines.append([r["model"], r["variant"], r["error"][:60]] + [""] * (len(head) - 3))
            continue
        lines.append([r["model"], r["variant"], r["points"], r["surfaces"], r["leaves"], f"{r['price']:.1f}", r["verdict"],
                      f"{r['iou']:.4f}", f"{r['mean']:.4f}", f"{r['hausdorff']:.3f}", f"{r['seconds']:.2f}",
                      *(f"{r['stages'][stage]:.2f}" for stage in STAGES)])
    widths = [max(len(str(line[k])) for line in [head, *lines]) for k in range(len(head))]
    print(row(head, widths))
    print("|" + "|".join("-" * (width + 1) + ":" for width in widths) + "|")
    for line in lines:
        print(row(line, widths))


def print_summary(rows, variants):
    for variant in variants:
        done = [r for r in rows if r["variant"] == variant]
        iou = [r.get("iou", 0) for r in done]
        seconds = [r["seconds"] for r in done if "seconds" in r]
        print(f"\n{variant}: {len(done)} models, IoU >= 0.99 on {sum(x >= 0.99 for x in iou)}, >= 0.97 on "
              f"{sum(x >= 0.97 for x in iou)}, >= 0.95 on {sum(x >= 0.95 for x in iou)}, least {min(iou, default=0):.4f}; "
              f"seconds: median {statistics.median(seconds) if seconds else 0:.2f}, most {max(seconds, default=0):.2f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--program", default="build/release/cloud2csg")
    parser.add_argument("--openscad", default="openscad", help="the program; '' to judge without it, which is faster")
    parser.add_argument("--variants", nargs="+", choices=["clean", "noise", "scan", "table"],
                        default=["clean", "noise", "scan"])
    parser.add_argument("--models", nargs="+", help="only these, by the file's name without its ending")
    parser.add_argument("--points", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", help="a folder for the .scad files")
    parser.add_argument("--json", help="a file for the rows")
    arguments = parser.parse_args()
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

    meshes = sorted(path for path in arguments.folder.iterdir() if path.suffix in ENDINGS)
    # A script with the name of a mesh is the source of that mesh.
    made = {path.stem for path in meshes if path.suffix != ".scad"}
    meshes = [path for path in meshes if path.suffix != ".scad" or path.stem not in made]
    if arguments.models:
        meshes = [path for path in meshes if path.stem in arguments.models]
    if not meshes:
        sys.exit(f"{arguments.folder}: no meshes ({', '.join(ENDINGS)})")
    rows = []
    for mesh in meshes:
        for variant in arguments.variants:
            try:
                rows.append(measure(arguments.program, arguments.openscad, mesh, variant, arguments))
            except (RuntimeError, subprocess.TimeoutExpired) as error:
                rows.append({"model": mesh.stem, "variant": variant, "error": str(error)})
            print(f"{mesh.stem} {variant}: {rows[-1].get('iou', rows[-1].get('error'))}", file=sys.stderr)
    print_table(rows)
    print_summary(rows, arguments.variants)
    if arguments.json:
        pathlib.Path(arguments.json).write_text(json.dumps(rows, indent=1))


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""From meshes to trees, judged outside: how good and how fast `cloud2csg extract` is on a folder of meshes.

    bench/inversecsg.py FOLDER [--program build/release/cloud2csg] [--variants clean noise scan]

For each mesh of the folder, or .scad file, which OpenSCAD makes a mesh of: 100 000 points without noise, with noise of 0.2 % of
the diagonal, and a virtual scan from 20 viewpoints without normals. The tree is written as .scad, rendered by OpenSCAD, and that
mesh is compared with the input. Prints a table; nothing is known of a model but its mesh. "beyond" is how far the solid leaves
the bounds of the mesh, in tolerances of the detection. More variants:

    table            a scan from above only, of a part that lies on a table
    noise=PERCENT    noise of so much of the diagonal
    normals=KIND     noise of 0.2 %, and normals that are wrong: none, inward, patches, halfspace, up, noisy or random
"""

import argparse
import json
import math
import os
import pathlib
import random
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


def flipped_if(wrong, normal):
    return [-x for x in normal] if wrong else normal


def blurred(normal, amount, chance):
    """The normal, and `amount` times an error of deviation 1 in each coordinate."""
    values = [x + amount * chance.gauss(0, 1) for x in normal]
    length = math.hypot(*values)
    return [x / length for x in values]


def damage(kind, diagonal, chance):
    """A function that damages the normal of a place."""
    if kind == "patches":
        waves = [[chance.gauss(0, 12 / diagonal) for _ in range(3)] + [chance.uniform(0, 6)] for _ in range(3)]
        return lambda place, normal: flipped_if(
            math.prod(math.sin(sum(w * x for w, x in zip(wave, [*place, 1]))) for wave in waves) < 0, normal)
    return {
        "inward": lambda _, normal: flipped_if(True, normal),
        "halfspace": lambda _, normal: flipped_if(sum(normal) < 0, normal),
        "up": lambda _, normal: flipped_if(normal[2] < 0, normal),
        "noisy": lambda _, normal: blurred(normal, 0.6, chance),
        "random": lambda _, normal: blurred([0, 0, 0], 1, chance),
    }[kind]


NORMALS = ("none", "inward", "patches", "halfspace", "up", "noisy", "random")


def damage_normals(cloud, kind, seed):
    """The cloud, an .xyzn file, with normals of that kind, or without any."""
    rows = [[float(x) for x in line.split()] for line in cloud.read_text().splitlines()]
    if kind == "none":
        lines = [row[:3] for row in rows]
    else:
        sides = [max(axis) - min(axis) for axis in zip(*(row[:3] for row in rows))]
        wrong = damage(kind, math.hypot(*sides), random.Random(seed))
        lines = [row[:3] + wrong(row[:3], row[3:6]) for row in rows]
    result = cloud.with_name("damaged.xyz" if kind == "none" else "damaged.xyzn")
    result.write_text("".join(" ".join(f"{x:.9g}" for x in line) + "\n" for line in lines))
    return result


def make_cloud(program, mesh, variant, points, seed, folder):
    """What `extract` is given: the mesh itself, or a cloud made of it."""
    name, _, value = variant.partition("=")
    cloud = folder / f"{name}.{'xyzn' if name == 'normals' else 'ply'}"
    if name in ("scan", "table"):
        above = ["--on-table"] if name == "table" else []
        run([program, "scan", mesh, "--seed", str(seed), *above, "-o", cloud, "-q"])
        return cloud
    percent = {"clean": 0, "noise": value or 0.2, "normals": 0.2}[name]
    run([program, "sample", mesh, "-n", str(points), "--seed", str(seed), "--relative-noise", str(float(percent) / 100),
         "-o", cloud, "-q"])
    return damage_normals(cloud, value, seed) if name == "normals" else cloud


def variant_of(text):
    """Refuses variants that there are not."""
    name, _, value = text.partition("=")
    known = text in ("clean", "noise", "scan", "table") or (name == "normals" and value in NORMALS)
    if not known and not (name == "noise" and float(value) >= 0):
        raise ValueError
    return text


def judge(program, openscad, mesh, tree, folder):
    """The tree's solid against the mesh: rendered by OpenSCAD, or, without it, as the program itself sees it."""
    if openscad:
        rendered = folder / "rendered.off"
        run([openscad, "-o", rendered, tree.with_suffix(".scad")], RENDER_SECONDS)
        tree = rendered
    return json.loads(run([program, "compare", mesh, tree, "--json", "-q"]))


def beyond(program, tree, mesh, folder):
    """How far points on the tree's solid leave the bounds of the mesh."""
    points = folder / "points.ply"
    run([program, "sample", tree, "-n", "100000", "-o", points, "-q"])
    (low, high), (least, most) = (json.loads(run([program, "info", f, "--json"]))["bounds"] for f in (points, mesh))
    return max(0, *(a - b for a, b in zip(least, low)), *(b - a for a, b in zip(most, high)))


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
            "beyond": beyond(program, tree, mesh, folder) / values["finding"]["tolerance"],
            "stages": {stage: values["seconds"].get(stage, 0) for stage in STAGES},
        }


def row(cells, widths):
    return "| " + " | ".join(str(cell).rjust(width) for cell, width in zip(cells, widths)) + " |"


def print_lines(head, lines):
    widths = [max(len(str(line[k])) for line in [head, *lines]) for k in range(len(head))]
    print(row(head, widths))
    print("|" + "|".join("-" * (width + 1) + ":" for width in widths) + "|")
    for line in lines:
        print(row(line, widths))


def print_table(rows):
    head = ["model", "variant", "points", "surfaces", "leaves", "price", "verdict", "IoU", "mean", "Hausdorff", "beyond", "s", *STAGES]
    lines = []
    for r in rows:
        if "error" in r:
            lines.append([r["model"], r["variant"], r["error"][:60]] + [""] * (len(head) - 3))
            continue
        lines.append([r["model"], r["variant"], r["points"], r["surfaces"], r["leaves"], f"{r['price']:.1f}", r["verdict"],
                      f"{r['iou']:.4f}", f"{r['mean']:.4f}", f"{r['hausdorff']:.3f}", f"{r['beyond']:.2f}",
                      f"{r['seconds']:.2f}",
                      *(f"{r['stages'][stage]:.2f}" for stage in STAGES)])
    print_lines(head, lines)


def print_summary(rows, variants):
    by_variant = {variant: {r["model"]: r.get("iou", 0) for r in rows if r["variant"] == variant} for variant in variants}
    for variant, ious in by_variant.items():
        iou = list(ious.values())
        seconds = [r["seconds"] for r in rows if r["variant"] == variant and "seconds" in r]
        print(f"\n{variant}: {len(iou)} models, mean IoU {statistics.mean(iou):.4f}, >= 0.99 on {sum(x >= 0.99 for x in iou)}, "
              f">= 0.97 on {sum(x >= 0.97 for x in iou)}, >= 0.95 on {sum(x >= 0.95 for x in iou)}, least {min(iou):.4f}; "
              f"seconds: median {statistics.median(seconds) if seconds else 0:.2f}, most {max(seconds, default=0):.2f}")
        farthest = max((r["beyond"] for r in rows if r["variant"] == variant and "beyond" in r), default=0)
        print(f"    farthest beyond the mesh's bounds: {farthest:.2f} tolerances")
        without = by_variant.get("normals=none") if variant.startswith("normals=") else None
        if without:
            worst = min(ious, key=lambda model: ious[model] - without[model])
            kept = sum(ious[model] >= without[model] - 0.005 for model in ious)
            print(f"    at most 0.005 below normals=none on {kept}, the worst {worst}: {ious[worst] - without[worst]:+.4f}")


def meshes_in(folder, names=None):
    """The meshes of a folder, and the scripts that are no mesh's source; of these names only, if there are any."""
    meshes = sorted(path for path in folder.iterdir() if path.suffix in ENDINGS)
    made = {path.stem for path in meshes if path.suffix != ".scad"}
    meshes = [path for path in meshes if path.suffix != ".scad" or path.stem not in made]
    if names:
        meshes = [path for path in meshes if path.stem in names]
    if not meshes:
        sys.exit(f"{folder}: no meshes ({', '.join(ENDINGS)})")
    return meshes


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--program", default="build/release/cloud2csg")
    parser.add_argument("--openscad", default="openscad", help="the program; '' to judge without it, which is faster")
    parser.add_argument("--variants", nargs="+", type=variant_of, default=["clean", "noise", "scan"])
    parser.add_argument("--models", nargs="+", help="only these, by the file's name without its ending")
    parser.add_argument("--points", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", help="a folder for the .scad files")
    parser.add_argument("--json", help="a file for the rows")
    arguments = parser.parse_args()
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

    meshes = meshes_in(arguments.folder, arguments.models)
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

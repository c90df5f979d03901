#!/usr/bin/env python3
"""Halves and doubles every constant of some source folders in turn, and prints what that does to results.

    bench/constants.py [src/raw/prepare src/raw/detect ...] [--only NAME] [--output build/constants/table.jsonl]

Works in a copy of the sources under build/constants; a change is one edited line and one compiled file. Each build reconstructs
some parts of bench/parts from scans, and from noisy samples whose normals it estimates (OpenSCAD makes their meshes), and runs
two parts of bench_detection.
Four figures a build: surfaces found by bench_detection as a share of all that it asks for, mean intersection over union, mean
leaves, CPU seconds. `--seeds N` repeats the unchanged build with other clouds for the last three: differences below their
spread mean nothing. The first is always of the same clouds, one a row of the tables.

A share x above one half is changed by its distance from 1, which is halved ("double" of .9 is .95) or doubled (at most 1). A run
that was stopped goes on where it was, unless the sources changed since.
"""

import argparse
import hashlib
import json
import pathlib
import re
import resource
import shutil
import statistics
import tempfile

from inversecsg import DOUBTFUL, make_mesh, run

ROOT = pathlib.Path(__file__).resolve().parent.parent
COPY = ROOT / "build" / "constants"
CONSTANT = re.compile(r"^(\s*(?:inline )?constexpr (?:double|int|std::size_t) )(k_\w+) = ([\d.'e-]+)(;.*)$")
SCANNED = ("bracket", "elbow", "flange", "nozzle", "tubes", "cup")
SAMPLED = ("gear", "countersunk")
DETECTION = ("steps", "outliers")
POINTS = 20_000


def constants_in(folders):
    """(file, line, name, text of the value), from the copy, which nobody else edits."""
    for folder in folders:
        for file in sorted((COPY / folder).glob("*.[ch]pp")):
            for line, text in enumerate(file.read_text().splitlines()):
                if match := CONSTANT.match(text):
                    yield file.relative_to(COPY), line, match[2], match[3]


def scaled(text, factor):
    """The value as text, or none where it stays the same. See the description for shares."""
    value = float(text.replace("'", ""))
    is_whole = re.fullmatch(r"[\d']+", text)
    if is_whole:
        changed = max(1, round(value * factor))
        return None if changed == value else str(changed)
    changed = max(0.0, 1 - (1 - value) / factor) if 0.5 < value < 1 else value * factor
    return f"{changed:.6g}"


def build():
    run(["cmake", "--build", COPY / "build", "--target", "cloud2csg", "bench_detection"])
    return COPY / "build" / "cloud2csg", COPY / "build" / "bench" / "bench_detection"


def prepare_copy():
    """The sources as they are, without unity builds: so a changed constant compiles little. Returns a digest of
    all that figures depend on."""
    digest = hashlib.sha256()
    for name in run(["git", "-C", ROOT, "ls-files"]).splitlines():
        source, target = ROOT / name, COPY / name
        content = source.read_bytes()
        if not name.startswith(("docs/", "tests/")) and not name.endswith(".md"):
            digest.update(name.encode() + content)
        if target.exists() and target.read_bytes() == content:
            continue  # its build stays valid
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(source, target)
    run(["cmake", "-S", COPY, "-B", COPY / "build", "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_UNITY_BUILD=OFF",
         "-DCLOUD2CSG_BUILD_TESTS=OFF", "-DCLOUD2CSG_OPENCASCADE=OFF", "-DCLOUD2CSG_PYTHON=OFF"])
    return digest.hexdigest()[:12]


def make_clouds(program, seed):
    """(mesh, cloud) of each part; the unchanged program makes them once for all builds."""
    folder = COPY / f"clouds_{seed}"
    folder.mkdir(exist_ok=True)
    pairs = []
    for name in SCANNED + SAMPLED:
        mesh, cloud = folder / f"{name}.off", folder / f"{name}.ply"
        pairs.append((mesh, cloud))
        if cloud.exists():
            continue
        make_mesh(ROOT / "bench" / "parts" / f"{name}.scad", folder)
        common = ["-n", str(POINTS), "--seed", str(seed), "-o", cloud, "-q"]
        run([program, "scan", mesh, *common] if name in SCANNED else [program, "sample", mesh, "--relative-noise", "0.002", *common])
    return pairs


def child_seconds():
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime


def reconstruct(program, mesh, cloud, seed):
    with tempfile.TemporaryDirectory() as name:
        tree, stats = pathlib.Path(name) / "tree.json", pathlib.Path(name) / "stats.json"
        normals = ["--estimate-normals"] if mesh.stem in SAMPLED else []
        before = child_seconds()
        try:
            run([program, "extract", cloud, "-o", tree, "--stats", stats, "--threads", "1", "--seed", str(seed), "-q", *normals],
                accepted=(0, DOUBTFUL))
        except RuntimeError:
            return 0.0, 0, child_seconds() - before
        seconds = child_seconds() - before
        compared = json.loads(run([program, "compare", mesh, tree, "--json", "-q"]))
        return compared["intersection_over_union"], json.loads(stats.read_text())["tree"]["leaves"], seconds


def share_found(bench_detection):
    """Mean of the column "found" of all tables, in per cent."""
    shares = []
    for part in DETECTION:
        lines = run([bench_detection, "--part", part, "--seeds", "1", "--threads", "1"]).splitlines()
        rows = [[cell.strip() for cell in line.strip("| ").split("|")] for line in lines if line.startswith("|")]
        place = rows[0].index("found")
        shares += [float(row[place].rstrip(" %")) for row in rows[2:] if len(row) > place and row[place].endswith("%")]
    return statistics.mean(shares)


def measure(seed=1):
    program, bench_detection = build()
    results = [reconstruct(program, mesh, cloud, seed) for mesh, cloud in make_clouds(program, seed)]
    return {"found": share_found(bench_detection), "iou": statistics.mean(r[0] for r in results),
            "leaves": statistics.mean(r[1] for r in results), "seconds": sum(r[2] for r in results),
            "each": [round(r[0], 4) for r in results]}


def measure_changed(file, line, name, value):
    """The figures with another value in one line; the line is restored."""
    copied = COPY / file
    text = copied.read_text()
    lines = text.splitlines(keepends=True)
    lines[line] = CONSTANT.sub(rf"\g<1>{name} = {value}\g<4>", lines[line].rstrip("\n")) + "\n"
    copied.write_text("".join(lines))
    try:
        return measure()
    except (RuntimeError, ValueError) as error:
        return {"error": str(error)}
    finally:
        copied.write_text(text)


def row(name, value, base, figures):
    if "error" in figures:
        return f"| {name} | {value} | {figures['error']} | | | |"
    return (f"| {name} | {value} | {figures['found'] - base['found']:+.1f} | {figures['iou'] - base['iou']:+.4f} | "
            f"{figures['leaves'] - base['leaves']:+.1f} | {figures['seconds'] / base['seconds']:.2f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="*", default=["src/raw/prepare", "src/raw/detect"])
    parser.add_argument("--only", help="constants whose file:name contains this")
    parser.add_argument("--seeds", type=int, default=3, help="clouds of the unchanged build, to see their spread")
    parser.add_argument("--output", type=pathlib.Path, default=COPY / "table.jsonl")
    arguments = parser.parse_args()
    COPY.mkdir(parents=True, exist_ok=True)
    digest = prepare_copy()
    done = {}
    if arguments.output.exists():
        done = {entry["key"]: entry["figures"] for entry in map(json.loads, arguments.output.read_text().splitlines())}

    def figures_of(key, work):
        key = f"{digest} {key}"
        if key not in done:
            done[key] = work()
            with arguments.output.open("a") as file:
                file.write(json.dumps({"key": key, "figures": done[key]}) + "\n")
        return done[key]

    base = figures_of("unchanged", measure)
    print(f"Unchanged: found {base['found']:.1f} %, IoU {base['iou']:.4f}, {base['leaves']:.1f} leaves.\n", flush=True)
    print("| constant | value | found | IoU | leaves | CPU |\n|---|--:|--:|--:|--:|--:|")
    for seed in range(2, arguments.seeds + 1):
        print(row(f"unchanged, clouds of seed {seed}", "", base, figures_of(f"seed {seed}", lambda s=seed: measure(s))), flush=True)
    for file, line, name, text in constants_in(arguments.folders):
        if arguments.only and arguments.only not in f"{file}:{name}":
            continue
        for factor in (0.5, 2):
            if value := scaled(text, factor):
                figures = figures_of(f"{file}:{name} {value}", lambda f=file, i=line, n=name, v=value: measure_changed(f, i, n, v))
                print(row(f"{file.name}: {name} = {text}", value, base, figures), flush=True)


if __name__ == "__main__":
    main()

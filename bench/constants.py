#!/usr/bin/env python3
"""Halves and doubles every constant of some source folders in turn, and prints what that does to results.

    bench/constants.py [src/raw/prepare src/raw/detect ...] [--only NAME] [--output build/constants/table.jsonl]

Builds the program once, from a copy of the sources under build/constants whose constants can be set in the environment. Each run
reconstructs some parts of bench/parts from scans, and from noisy samples whose normals it estimates (OpenSCAD makes their
meshes), and runs two parts of bench_detection. Three figures a run: surfaces found by bench_detection as a share of all that it
asks for, mean intersection over union, mean leaves. `--seeds N` repeats the unchanged run with other clouds for the last two:
differences below their spread mean nothing. The first is always of the same clouds, one a row of the tables.

A share x above one half is changed by its distance from 1, which is halved ("double" of .9 is .95) or doubled (at most 1). A
sweep that was stopped goes on where it was, unless the sources changed since.
"""

import argparse
import hashlib
import json
import pathlib
import os
import re
import statistics
import tempfile
from concurrent.futures import ThreadPoolExecutor

from inversecsg import DOUBTFUL, make_mesh, run

ROOT = pathlib.Path(__file__).resolve().parent.parent
COPY = ROOT / "build" / "constants"
CONSTANT = re.compile(r"^( *)(?:inline )?constexpr (double|int|std::size_t) (k_\w+) = ([\d.'e-]+);", re.MULTILINE)
SCANNED = ("bracket", "elbow", "flange", "nozzle", "tubes", "cup")
SAMPLED = ("gear", "countersunk")
DETECTION = ("steps", "outliers")
POINTS = 20_000


def constants_in(folders):
    """(key, text of the value) of each constant; the key is FILE_NAME."""
    for folder in folders:
        for file in sorted((ROOT / folder).glob("*.[ch]pp")):
            for match in CONSTANT.finditer(file.read_text()):
                yield f"{file.stem}_{match[3]}", match[4]


def settable(source, stem):
    """The source with constants that take their values from the environment, where it has any."""
    def replaced(match):
        indent, kind, name, value = match.groups()
        key = f"{stem}_{name}"
        return (f"{indent}static const {kind} {name} = [] {{ const char* set = std::getenv(\"{key}\"); "
                f"return static_cast<{kind}>(set ? std::atof(set) : {value}); }}();")
    changed = CONSTANT.sub(replaced, source)
    return changed if changed == source else "#include <cstdlib>\n" + changed


def scaled(text, factor):
    """The value as text, or none where it stays the same. See the description for shares."""
    value = float(text.replace("'", ""))
    is_whole = re.fullmatch(r"[\d']+", text)
    if is_whole:
        changed = max(1, round(value * factor))
        return None if changed == value else str(changed)
    changed = max(0.0, 1 - (1 - value) / factor) if 0.5 < value < 1 else value * factor
    return f"{changed:.6g}"


def build(folders):
    """@returns the programs, and a digest of all that figures depend on"""
    digest = hashlib.sha256()
    for name in run(["git", "-C", ROOT, "ls-files"]).splitlines():
        source, target = ROOT / name, COPY / name
        content = source.read_bytes()
        if not name.startswith(("docs/", "tests/")) and not name.endswith(".md"):
            digest.update(name.encode() + content)
        if os.path.dirname(name) in folders and source.suffix in (".cpp", ".hpp"):
            content = settable(content.decode(), source.stem).encode()
        if target.exists() and target.read_bytes() == content:
            continue  # its build stays valid
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(content)
        target.chmod(source.stat().st_mode)
    run(["cmake", "-S", COPY, "-B", COPY / "build", "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DCLOUD2CSG_BUILD_TESTS=OFF",
         "-DCLOUD2CSG_OPENCASCADE=OFF", "-DCLOUD2CSG_PYTHON=OFF", "-DCLOUD2CSG_WARNINGS_AS_ERRORS=OFF"])
    run(["cmake", "--build", COPY / "build", "--target", "cloud2csg", "bench_detection"])
    return COPY / "build" / "cloud2csg", COPY / "build" / "bench" / "bench_detection", digest.hexdigest()[:12]


def make_clouds(program, seed):
    """(mesh, cloud) of each part; made once for all runs."""
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


def reconstruct(program, mesh, cloud, seed, environment):
    with tempfile.TemporaryDirectory() as name:
        tree, stats = pathlib.Path(name) / "tree.json", pathlib.Path(name) / "stats.json"
        normals = ["--estimate-normals"] if mesh.stem in SAMPLED else []
        try:
            run(["env", *environment, program, "extract", cloud, "-o", tree, "--stats", stats, "--threads", "1",
                 "--seed", str(seed), "-q", *normals], accepted=(0, DOUBTFUL))
        except RuntimeError:
            return 0.0, 0
        compared = json.loads(run([program, "compare", mesh, tree, "--threads", "1", "--json", "-q"]))
        return compared["intersection_over_union"], json.loads(stats.read_text())["tree"]["leaves"]


def share_found(bench_detection, environment):
    """Mean of the column "found" of all tables, in per cent."""
    shares = []
    for part in DETECTION:
        lines = run(["env", *environment, bench_detection, "--part", part, "--seeds", "1", "--threads", "1"]).splitlines()
        rows = [[cell.strip() for cell in line.strip("| ").split("|")] for line in lines if line.startswith("|")]
        place = rows[0].index("found")
        shares += [float(row[place].rstrip(" %")) for row in rows[2:] if len(row) > place and row[place].endswith("%")]
    return statistics.mean(shares)


def measure(programs, seed=1, environment=()):
    """The figures with some constants set, as FILE_NAME=VALUE."""
    program, bench_detection = programs
    results = [reconstruct(program, mesh, cloud, seed, environment) for mesh, cloud in make_clouds(program, seed)]
    return {"found": share_found(bench_detection, environment), "iou": statistics.mean(r[0] for r in results),
            "leaves": statistics.mean(r[1] for r in results)}


def cells(base, figures):
    return (f"{figures['found'] - base['found']:+.1f} | {figures['iou'] - base['iou']:+.4f} | "
            f"{figures['leaves'] - base['leaves']:+.1f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="*", default=["src/raw/prepare", "src/raw/detect"])
    parser.add_argument("--only", default="", help="constants whose FILE_NAME contains this")
    parser.add_argument("--seeds", type=int, default=3, help="clouds of the unchanged program, to see their spread")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--output", type=pathlib.Path, default=COPY / "table.jsonl")
    arguments = parser.parse_args()
    folders = [os.path.normpath(folder) for folder in arguments.folders]
    COPY.mkdir(parents=True, exist_ok=True)
    *programs, digest = build(folders)
    done = {}
    if arguments.output.exists():
        done = {entry["key"]: entry["figures"] for entry in map(json.loads, arguments.output.read_text().splitlines())}

    def figures_of(environment, seed=1):
        key = f"{digest} {environment} {seed}"
        if key not in done:
            done[key] = measure(programs, seed, [environment] if environment else [])
            with arguments.output.open("a") as file:
                file.write(json.dumps({"key": key, "figures": done[key]}) + "\n")
        return done[key]

    def row(entry):
        key, text = entry
        values = [scaled(text, factor) for factor in (0.5, 2)]
        halves = []
        for value in values:
            try:
                halves.append(cells(base, figures_of(f"{key}={value}")) if value else "| |")
            except RuntimeError as error:
                halves.append(f"{error} | |")
        file, name = key.split("_k_")
        return f"| `k_{name}` ({file}) = {text} | " + " | ".join(halves) + " |"

    for seed in range(1, arguments.seeds + 1):
        make_clouds(programs[0], seed)
    base = figures_of("")
    print(f"Unchanged: found {base['found']:.1f} %, IoU {base['iou']:.4f}, {base['leaves']:.1f} leaves.\n", flush=True)
    print("| constant | half: found | IoU | leaves | double: found | IoU | leaves |\n|---|--:|--:|--:|--:|--:|--:|")
    for seed in range(2, arguments.seeds + 1):
        print(f"| other clouds (seed {seed}) | {cells(base, figures_of('', seed))} | | | |", flush=True)
    swept = [entry for entry in constants_in(folders) if arguments.only in entry[0]]
    with ThreadPoolExecutor(arguments.jobs) as pool:
        for line in pool.map(row, swept):
            print(line, flush=True)


if __name__ == "__main__":
    main()

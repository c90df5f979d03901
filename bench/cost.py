#!/usr/bin/env python3
"""What a change costs: CPU seconds and memory of `extract` from two builds of the program, as ratios on a folder of meshes.

    bench/cost.py OLD NEW FOLDER [--points 100000] [--variants clean noise]

For each mesh and variant (those of bench/inversecsg.py), both run in turn on one thread, `--rounds` times each; the least counts.
"""

import argparse
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

from inversecsg import DOUBTFUL, ENDINGS, make_cloud, variant_of


def cost(program, cloud, folder):
    """CPU seconds, and MiB at the peak."""
    command = [program, "extract", cloud, "-o", folder / "tree.json", "--threads", "1", "-q"]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode not in (0, DOUBTFUL):
        raise RuntimeError(f"{program} failed on {cloud}")
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def compare(arguments, mesh, variant):
    """The least of OLD and of NEW."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        cloud = make_cloud(arguments.old, mesh, variant, arguments.points, arguments.seed, folder)
        rounds = [[cost(p, cloud, folder) for p in (arguments.old, arguments.new)] for _ in range(arguments.rounds)]
    return [tuple(map(min, zip(*one))) for one in zip(*rounds)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--points", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--variants", nargs="+", type=variant_of, default=["clean", "noise"])
    parser.add_argument("--rounds", type=int, default=2)
    arguments = parser.parse_args()
    meshes = sorted(p for p in arguments.folder.iterdir() if p.suffix in ENDINGS and p.suffix != ".scad")
    if not meshes:
        sys.exit(f"{arguments.folder}: no meshes ({', '.join(ENDINGS[:-1])})")
    seconds, memory = [], []
    print("| model | variant | CPU s | ratio | MiB | ratio |\n| --- | --- | --- | --- | --- | --- |")
    for mesh in meshes:
        for variant in arguments.variants:
            old, new = compare(arguments, mesh, variant)
            seconds.append(new[0] / old[0])
            memory.append(new[1] / old[1])
            print(f"| {mesh.stem} | {variant} | {old[0]:.2f} -> {new[0]:.2f} | {seconds[-1]:.2f} "
                  f"| {old[1]:.0f} -> {new[1]:.0f} | {memory[-1]:.2f} |", flush=True)
    print(f"\nCPU: median {statistics.median(seconds):.2f}, least {min(seconds):.2f}, most {max(seconds):.2f}; "
          f"memory: median {statistics.median(memory):.2f}, most {max(memory):.2f}")


if __name__ == "__main__":
    main()

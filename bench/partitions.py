#!/usr/bin/env python3
"""Ways to a tree over given solids: cells, the paper's partitions, and the decision list that found solids come with.

    bench/partitions.py FOLDER [--program build/release/cloud2csg]

For each mesh of the folder: 100 000 points without noise, and the solids that `extract` finds in them. Then these solids are
given: only the tree over them is searched, by cells, by cliques of the overlap graph, and by a decision list, which may add
solids. At most `--limit` seconds each. Prints a table.
"""

import argparse
import json
import pathlib
import statistics
import tempfile

from inversecsg import DOUBTFUL, make_cloud, make_mesh, meshes_in, print_lines, run

STRATEGIES = {"cells": ["--strategy", "cells"], "partition": ["--strategy", "partition"], "list": ["--detect-rest"]}


def search(program, mesh, cloud, solids, strategy, limit, folder):
    """IoU, leaves and milliseconds of the tree over given solids; how many cliques, and the size of the largest. A failed search,
    which writes nothing, has an IoU of 0."""
    tree, stats = folder / f"{strategy}.json", folder / "stats.json"
    command = [program, "extract", cloud, "--primitives", solids, *STRATEGIES[strategy], "--threads", "1"]
    try:
        run([*command, "--time-limit", str(limit), "-o", tree, "--stats", stats, "-q"], 600, (0, DOUBTFUL))
    except RuntimeError:
        return {"iou": 0, "leaves": 0, "ms": 1000 * limit}
    values = json.loads(stats.read_text())
    iou = json.loads(run([program, "compare", mesh, tree, "--json", "-q"]))["intersection_over_union"]
    cliques = values["clique_histogram"]
    return {"solids": values["primitives"], "cliques": sum(cliques), "largest": len(cliques), "iou": iou,
            "leaves": values["tree"]["leaves"], "ms": 1000 * sum(values["seconds"][s] for s in ("solids", "extraction"))}


def measure(program, mesh, points, seed, limit):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        if mesh.suffix == ".scad":
            mesh = make_mesh(mesh, folder)
        cloud = make_cloud(program, mesh, "clean", points, seed, folder)
        solids = folder / "solids.json"
        run([program, "extract", cloud, "-o", solids, "-q"], 600, (0, DOUBTFUL))
        return [search(program, mesh, cloud, solids, strategy, limit, folder) for strategy in STRATEGIES]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--program", default="build/release/cloud2csg")
    parser.add_argument("--points", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--limit", type=float, default=30)
    arguments = parser.parse_args()
    rows = []
    lines = []
    for mesh in meshes_in(arguments.folder):
        by_strategy = measure(arguments.program, mesh, arguments.points, arguments.seed, arguments.limit)
        rows.append(by_strategy)
        first = by_strategy[0]
        lines.append([mesh.stem, first["solids"], first["cliques"], first["largest"],
                      *(text for r in by_strategy for text in (f"{r['iou']:.4f}", r["leaves"], f"{r['ms']:.0f}"))])
    head = ["model", "solids", "cliques", "largest"] + [f"{s}: {w}" for s in STRATEGIES for w in ("IoU", "leaves", "ms")]
    print_lines(head, lines)
    for k, strategy in enumerate(STRATEGIES):
        ms = statistics.median(r[k]["ms"] for r in rows)
        print(f"\n{strategy}: mean IoU {statistics.mean(r[k]['iou'] for r in rows):.4f}, least "
              f"{min(r[k]['iou'] for r in rows):.4f}, {sum(r[k]['leaves'] for r in rows)} leaves, median {ms:.0f} ms")


if __name__ == "__main__":
    main()

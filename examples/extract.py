#!/usr/bin/env python3
"""From a noisy cloud to an OpenSCAD program: samples a model, extracts its tree from the points, and says how right it is.

    python3 examples/extract.py [MODEL.json] [-n COUNT] [--noise SIGMA] [-o OUT.scad]
"""
import argparse
import pathlib
import sys

import cloud2csg


def show(stage, done, total):
    """A line on the standard error that is written over and over."""
    share = f"{100 * done / total:3.0f} %" if total else f"{done}"
    print(f"\r{stage:<12} {share:<12}", end="", file=sys.stderr)


def main():
    shipped = pathlib.Path(__file__).resolve().parents[1] / "data/models/m3.json"
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("model", nargs="?", default=shipped, help="model file with a tree")
    parser.add_argument("-n", "--count", type=int, default=30_000, help="points")
    parser.add_argument("--noise", type=float, default=0.01, help="standard deviation of each coordinate")
    parser.add_argument("-o", "--output", default="extracted.scad", help=".scad .json .step .stl .html ...")
    arguments = parser.parse_args()

    truth = cloud2csg.Model.read(arguments.model)
    cloud = cloud2csg.sample(truth, count=arguments.count, noise=arguments.noise)
    result = cloud2csg.extract(cloud, truth.primitives, progress=show)
    print(file=sys.stderr)
    print(result.verdict["text"])
    for warning in result.warnings:
        print("warning:", warning, file=sys.stderr)
    result.write(arguments.output)

    model = result.model
    print(f"{len(cloud)} points, {len(model.primitives)} primitives: {model.size} nodes, {model.leaf_count} leaves")
    print(cloud2csg.compare(truth, result, surface_samples=20_000))
    print("wrote", arguments.output)


if __name__ == "__main__":
    try:
        main()
    except cloud2csg.Error as error:
        sys.exit(f"error: {error}")

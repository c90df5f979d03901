#!/usr/bin/env python3
"""Detects the surfaces of point clouds, in the form that a score of segmentations reads.

    PYTHONPATH=build/release/python bench/fit4cad.py CLOUDS RESULTS

For each NAME.xyz.gz of the folder CLOUDS (Fit4CAD: Romanengo et al. 2021) it writes RESULTS/NAME.json: the seconds, and the
surfaces with their parameters and the indices of their points. Two patches of one plane are two surfaces here, as in the truth:
each surface is split into connected pieces. Needs python3-numpy and python3-scipy.
"""

import argparse
import gzip
import json
import pathlib
import time

import numpy as np
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

import cloud2csg

# Points of one piece are linked within so many spacings. At half, sparse pieces fall apart; at double, faces across a
# narrow slot become one.
LINK_SPACINGS = 3
EXACT = 1e-5  # of the diagonal: the clouds have no noise, and files give six digits
LEAST_POINTS = 5  # smaller pieces are points at an edge that belong to a neighbour


def pieces_of(points, spacing):
    """Lists of indices into `points`, one a connected piece."""
    tree = cKDTree(points)
    links = tree.sparse_distance_matrix(tree, LINK_SPACINGS * spacing)
    count, label = connected_components(links, directed=False)
    pieces = [np.flatnonzero(label == k) for k in range(count)]
    return [piece for piece in pieces if len(piece) >= min(LEAST_POINTS, len(points))]


def with_edges(surface, piece, positions, tree, spacing, exact):
    """The piece and the points beside it that lie on the surface, too: in the truth, an edge belongs to both its faces."""
    beside = np.unique(np.concatenate(tree.query_ball_point(positions[piece], LINK_SPACINGS * spacing)).astype(int))
    on = beside[np.abs(surface.distance(positions[beside])) <= max(3 * surface.rms, exact)]
    return np.union1d(piece, on)


def surfaces_of(result, positions):
    """One a piece, with indices into `positions`. Cleaning moves no point; points added on unseen sides are left out."""
    tree = cKDTree(positions)
    spacing = np.median(tree.query(positions, k=2)[0][:, 1])
    exact = EXACT * np.linalg.norm(np.ptp(positions, axis=0))
    distance, original = tree.query(result.cloud.positions)
    for surface in result.surfaces:
        measured = surface.points[distance[surface.points] == 0]
        if not len(measured):
            continue
        own = np.unique(original[measured])
        for piece in pieces_of(positions[own], spacing):
            yield {"type": surface.type, "position": surface.position.tolist(), "axis": surface.axis.tolist(),
                   "radius": surface.radius, "minor_radius": surface.minor_radius, "half_angle": surface.half_angle,
                   "points": with_edges(surface, own[piece], positions, tree, spacing, exact).tolist()}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("clouds", type=pathlib.Path)
    parser.add_argument("results", type=pathlib.Path)
    parser.add_argument("--threads", type=int, default=0)
    arguments = parser.parse_args()
    arguments.results.mkdir(parents=True, exist_ok=True)
    for file in sorted(arguments.clouds.glob("*.xyz.gz")):
        with gzip.open(file, "rt") as text:
            positions = np.loadtxt(text)[:, :3]
        start = time.process_time()
        try:
            result = cloud2csg.detect(cloud2csg.PointCloud(positions), threads=arguments.threads)
        except cloud2csg.Error as error:
            print(f"{file.name}: {error}")
            continue
        seconds = time.process_time() - start
        surfaces = list(surfaces_of(result, positions))
        name = file.name.removesuffix(".xyz.gz")
        (arguments.results / f"{name}.json").write_text(json.dumps({"seconds": seconds, "surfaces": surfaces}))
        print(f"{name}: {len(positions)} points, {len(surfaces)} surfaces, {seconds:.2f} s of the processor")


if __name__ == "__main__":
    main()

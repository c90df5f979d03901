#!/usr/bin/env bash
# The main job on a shipped cloud: points and fitted primitives in, an editable tree out.
set -euo pipefail
cd "$(dirname "$0")/.."
rm -rf out/demo
mkdir -p out/demo
exec build/release/cloud2csg extract data/demo/bearing_block.ply --primitives data/demo/bearing_block_primitives.json \
  -o out/demo/bearing_block.json -o out/demo/bearing_block.scad -o out/demo/bearing_block.dot \
  -o out/demo/bearing_block.stl --stats out/demo/statistics.json

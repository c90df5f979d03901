#!/usr/bin/env bash
# Makes the pictures of parts in docs/images. Needs a release build.
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
program=build/release/cloud2csg
wide=(--picture-width 1100 --picture-height 440 --quiet)

"$program" extract data/demo/bearing_block.ply --primitives data/demo/bearing_block_primitives.json \
  -o docs/images/overview.png --picture-width 940 --picture-height 380 --quiet

# docs/raw.md, docs/tutorial.md
"$program" scan data/models/m3.json -n 60000 -o "$folder/scan.ply" --quiet
"$program" extract "$folder/scan.ply" -o docs/images/raw.png "${wide[@]}"
"$program" detect "$folder/scan.ply" -o docs/images/points.png --picture-width 640 --picture-height 440 --quiet >/dev/null

# docs/method.md
"$program" sample data/models/m0.json -n 40000 --noise 0.01 -o "$folder/m0.ply" --quiet
"$program" extract "$folder/m0.ply" --primitives data/models/m0.json -o docs/images/m0.png "${wide[@]}"
python3 - data/models/m0.json "$folder/all.json" <<'PYTHON'
# All solids at once: what is subtracted shows, too.
import json, sys
model = json.load(open(sys.argv[1]))
model["tree"] = {"op": "union", "children": [{"primitive": p["id"]} for p in model["primitives"]]}
json.dump(model, open(sys.argv[2], "w"))
PYTHON
"$program" convert "$folder/all.json" -o docs/images/m0_primitives.png --picture-width 480 --picture-height 440 --quiet
ls -l docs/images/*.png

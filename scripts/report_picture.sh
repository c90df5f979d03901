#!/usr/bin/env bash
# Makes docs/images/report.png: a report on model M0, as a browser shows it. Needs a release build with the page, and
# chromium.
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
program=build/release/cloud2csg
"$program" sample data/models/m0.json -n 100000 --noise 0.01 -o "$folder/m0.ply" --quiet
"$program" extract "$folder/m0.ply" --primitives data/models/m0.json \
  -o "$folder/m0.html" -o "$folder/m0.scad" --quiet
node viewer/scripts/picture.mjs build/release/src/viewer "$folder/m0.html" docs/images/report.png
ls -l docs/images/report.png

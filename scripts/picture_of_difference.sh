#!/usr/bin/env bash
# Draws what a result has wrong: the truth in grey, what the result lacks in red, what it has too much in blue.
#   scripts/picture_of_difference.sh TRUTH.json RESULT.json OUT.png
# Both are model files with a tree. Needs a release build, openscad and, without a display, xvfb-run.
set -euo pipefail
cd "$(dirname "$0")/.."
[ $# -eq 3 ] || { echo "usage: $0 TRUTH.json RESULT.json OUT.png" >&2; exit 2; }
program=build/release/cloud2csg
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# "A less B" and "B less A" as models of their own, the primitives of the second renamed.
python3 - "$1" "$2" "$folder" <<'PYTHON'
import json, sys
truth, result = (json.load(open(name)) for name in sys.argv[1:3])

def renamed(node):
    if "primitive" in node: return {"primitive": node["primitive"] + " of the result"}
    return {**node, "children": [renamed(child) for child in node["children"]]}

others = [{**p, "id": p["id"] + " of the result"} for p in result["primitives"]]
trees = truth["tree"], renamed(result["tree"])
for name, children in ("lacks", trees), ("surplus", trees[::-1]):
    model = {"format": "cloud2csg", "version": 1, "primitives": truth["primitives"] + others,
             "tree": {"op": "difference", "children": list(children)}}
    json.dump(model, open(f"{sys.argv[3]}/{name}.json", "w"))
PYTHON
"$program" convert "$1" -o "$folder/truth.stl" --resolution 160 --quiet
for part in lacks surplus; do
  # Nothing at all has no mesh.
  "$program" convert "$folder/$part.json" -o "$folder/$part.stl" --resolution 160 --quiet 2>"$folder/$part.log" || true
done
{
  for part in lacks:red surplus:blue; do
    [ -s "$folder/${part%:*}.stl" ] && echo "color(\"${part#*:}\") import(\"${part%:*}.stl\");"
  done
  echo 'color([0.75, 0.75, 0.75, 0.35]) import("truth.stl");'
} >"$folder/picture.scad"
view=(openscad -o "$folder/picture.png" --imgsize 900,700 --viewall --autocenter --preview --colorscheme Tomorrow
      "$folder/picture.scad")
[ -n "${DISPLAY:-}" ] || view=(xvfb-run -a "${view[@]}")
"${view[@]}" >"$folder/openscad.log" 2>&1 || { cat "$folder/openscad.log" >&2; exit 1; }
mv "$folder/picture.png" "$3"

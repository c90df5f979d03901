#!/usr/bin/env bash
# Writes the references into build/reference: of C++ (cpp/index.html) by Doxygen out of the public headers, and of Python
# (python.md) out of the type stubs of the built package, if it is built.
set -euo pipefail
cd "$(dirname "$0")/.."
mkdir -p build/reference
rm -rf build/reference/cpp
doxygen Doxyfile
echo "build/reference/cpp/index.html"
stubs=build/release/python/cloud2csg/_native.pyi
if [ -f "$stubs" ]; then
  scripts/python_reference.py "$stubs" python/cloud2csg/tree.py >build/reference/python.md
  echo "build/reference/python.md"
else
  echo "no Python package in build/release: its reference is left out" >&2
fi

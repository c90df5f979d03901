#!/usr/bin/env bash
# Prints the project's figures, and keeps them in out/bench.
set -euo pipefail
cd "$(dirname "$0")/.."
mkdir -p out/bench
for name in overlap evaluation extraction recovery; do
  echo
  "build/release/bench/bench_$name" | tee "out/bench/$name.md"
done

#!/usr/bin/env bash
# Prints the project's figures, and keeps them in out/bench, out/paper and out/scaling. The last two are long: they say
# how far they are, and go on where they were interrupted (`make clean` to measure anew).
set -euo pipefail
cd "$(dirname "$0")/.."
program=build/release/cloud2csg
step() { printf '\n== %s (%d s)\n' "$1" "$SECONDS" >&2; }

mkdir -p out/bench
for name in micro overlap evaluation extraction recovery preparation orientation brep; do
  step "bench_$name, to out/bench/$name.md"
  "build/release/bench/bench_$name" | tee "out/bench/$name.md"
done
# The baseline takes half an hour more: bench_quality without options.
step "bench_quality, to out/bench/quality.md"
build/release/bench/bench_quality --strategies auto,paper | tee out/bench/quality.md
for name in paper scaling; do
  step "cloud2csg bench $name, to out/$name"
  "$program" bench "$name" -o "out/$name"
done
step "done"

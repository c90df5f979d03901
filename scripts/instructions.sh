#!/usr/bin/env bash
# Counts the instructions of each step of the extraction (bench/instructions.cpp, under callgrind) and holds them
# against those in bench/instructions.csv. Fails when a step takes much more, twice: a loss of speed that no other
# load of the machine can explain.
#   instructions.sh           compare
#   instructions.sh record    write what was counted to bench/instructions.csv, to be committed with the change that is
#                             the reason
set -euo pipefail
cd "$(dirname "$0")/.."
record=bench/instructions.csv
if [ "$(uname -m)" != x86_64 ]; then
  echo "instructions: recorded for x86_64, not counted on $(uname -m)"
  exit 0
fi
scripts/install_dependencies.sh instructions
cmake --preset release >/dev/null  # may have been configured without valgrind
cmake --build --preset release --target bench_instructions >/dev/null

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# A dump a section; each says its name and its total. All symbols are bound at the start, so that no section pays for
# being the first to call a function.
count() {
  rm -f "$folder"/counts*
  LD_BIND_NOW=1 valgrind --quiet --tool=callgrind --instr-atstart=no --callgrind-out-file="$folder/counts" \
    build/release/bench/bench_instructions >"$folder/results"
  echo section,instructions
  awk '/^desc: Trigger: Client Request: / { name = $NF } /^totals: / { if (name) print name "," $2; name = "" }' \
    $(ls -v "$folder"/counts.*)
}

count >"$folder/now.csv"
if [ "${1:-}" = record ]; then
  cp "$folder/now.csv" "$record"
  echo "instructions: recorded in $record"
  exit 0
fi
scripts/compare_counts.sh "$record" "$folder/now.csv" && exit 0
echo "instructions: counting again"
count >"$folder/now.csv"
scripts/compare_counts.sh "$record" "$folder/now.csv" && exit 0
echo "instructions: some step takes many more than recorded. Where that is meant: make instructions RECORD=1" >&2
exit 1

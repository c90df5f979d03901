#!/usr/bin/env bash
# compare_counts_test.sh COMPARE_COUNTS.sh: tests which counts pass.
set -euo pipefail
compare=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# expect STATUS MEASURED...: checks the exit status for these counts against a,1000 and b,2000.
printf 'section,instructions\na,1000\nb,2000\n' >"$folder/recorded.csv"
expect() {
  local status=$1 got=0
  shift
  { echo section,instructions; printf '%s\n' "$@"; } >"$folder/measured.csv"
  "$compare" "$folder/recorded.csv" "$folder/measured.csv" >"$folder/output" || got=$?
  [ "$got" = "$status" ] || { echo "expected status $status, got $got for: $*" >&2; cat "$folder/output" >&2; exit 1; }
}

expect 0 a,1000 b,2000
expect 0 a,1149 b,2000
expect 1 a,1000 b,2302
expect 0 a,10 b,20
expect 1 a,1000
expect 1 a,1000 b,2000 c,1
got=0
"$compare" "$folder/recorded.csv" "$folder/nowhere.csv" 2>/dev/null || got=$?
[ "$got" = 2 ]

# The output names the offender.
expect 1 a,1000 b,2400
grep -qF '+20.0 % | more than allowed' "$folder/output" || { cat "$folder/output" >&2; exit 1; }

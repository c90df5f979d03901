#!/usr/bin/env bash
# compare_counts.sh RECORDED.csv MEASURED.csv [PERCENT]
# Prints the counts of two files, a "name,count" a line, side by side. Fails when one grew by more than PERCENT (15), or
# is in one file only.
set -euo pipefail
recorded=$1 measured=$2 most=${3:-15}
for file in "$recorded" "$measured"; do
  [ -r "$file" ] || { echo "compare_counts: cannot read $file" >&2; exit 2; }
done
awk -F, -v most="$most" '
  FNR == 1 { next }  # the title
  NR == FNR { before[$1] = $2; next }
  FNR == 2 { printf "| %-16s | %15s | %15s | %9s |\n|%s|%s|%s|%s|\n", "section", "recorded", "now", "change",
             "------------------", "-----------------", "-----------------", "-----------" }
  {
    after[$1] = $2
    if (!($1 in before)) { printf "| %-16s | %15s | %15d | %9s |\n", $1, "not recorded", $2, ""; failed = 1; next }
    change = 100 * ($2 / before[$1] - 1)
    printf "| %-16s | %15d | %15d | %+7.1f %% |%s\n", $1, before[$1], $2, change, (change > most ? " more than allowed" : "")
    if (change > most) failed = 1
  }
  END {
    for (name in before) if (!(name in after)) { printf "| %-16s | %15d | %15s | %9s |\n", name, before[name], "missing", ""; failed = 1 }
    exit failed
  }' "$recorded" "$measured"

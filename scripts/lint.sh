#!/usr/bin/env bash
# clang-format and clang-tidy over all of our sources; any finding is an error. Configures build/debug, where every source
# is compiled by itself.
# LINT_SECONDS=N: as many as that lets, those that changed last first.
set -euo pipefail
cd "$(dirname "$0")/.."
mapfile -t all < <(git ls-files '*.cpp' '*.hpp')
[ ${#all[@]} -gt 0 ] || { echo 'lint: git lists no sources' >&2; exit 1; }
clang-format --dry-run -Werror "${all[@]}"
[ -f build/debug/build.ninja ] || cmake --preset debug >build/configure.log 2>&1 || { cat build/configure.log; exit 1; }
# The log of git names what changed last first, and what is gone, too.
mapfile -t sources < <(
  git log --format= --name-only -- 'src/*.cpp' 'apps/*.cpp' 'bench/*.cpp' 'python/*.cpp' | awk '!seen[$0]++' |
    while read -r source; do if [ -f "$source" ]; then echo "$source"; fi; done)
scripts/tidy.py --seconds "${LINT_SECONDS:-inf}" build/debug "${sources[@]}" >build/lint.log ||
  { grep -E -A4 'error:|warning:|^tidy:' build/lint.log | head -200; exit 1; }
tail -1 build/lint.log
echo "lint: ${#all[@]} files formatted, nothing found in the sources that were looked at"

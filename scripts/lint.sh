#!/usr/bin/env bash
# clang-format and clang-tidy over all of our sources; any finding is an error. Needs a configured release build.
set -euo pipefail
cd "$(dirname "$0")/.."
mapfile -t all < <(git ls-files '*.cpp' '*.hpp')
[ ${#all[@]} -gt 0 ] || { echo 'lint: git lists no sources' >&2; exit 1; }
clang-format --dry-run -Werror "${all[@]}"
mapfile -t sources < <(git ls-files 'src/*.cpp' 'apps/*.cpp' 'bench/*.cpp' 'python/*.cpp')
scripts/tidy.py build/release "${sources[@]}" >build/lint.log ||
  { grep -E -A4 'error:|warning:|^tidy:' build/lint.log | head -200; exit 1; }
tail -1 build/lint.log
echo "lint: ${#all[@]} files formatted, ${#sources[@]} sources checked, nothing found"

#!/usr/bin/env bash
# clang-format over all of our C++ files, clang-tidy over all sources but tests and bench/peers (which needs CGAL), and the sizes
# of files; any finding is an error. Configures build/debug, where every source is compiled by itself.
set -euo pipefail
cd "$(dirname "$0")/.."
mapfile -t all < <(git ls-files '*.cpp' '*.hpp')
[ ${#all[@]} -gt 0 ] || { echo 'lint: git lists no sources' >&2; exit 1; }
clang-format --dry-run -Werror "${all[@]}"
wc -l "${all[@]}" | awk '$2 != "total" && $1 > 400 { print "lint: " $2 " has " $1 " lines: at most 400"; long = 1 } END { exit long }'
# Each time: sources may have come since.
cmake --preset debug >build/configure.log 2>&1 || { cat build/configure.log; exit 1; }
mapfile -t sources < <(git ls-files 'src/*.cpp' 'apps/*.cpp' 'bench/*.cpp' ':!bench/peers' 'python/*.cpp')
scripts/tidy.py build/debug "${sources[@]}" >build/lint.log ||
  { grep -E -A4 'error:|warning:|^tidy:' build/lint.log | head -200; exit 1; }
tail -1 build/lint.log

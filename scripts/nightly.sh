#!/usr/bin/env bash
# What takes too long before a landing: the analyzer, the slow tests with sanitizers, many new cases of every property, mutants
# of files, each source compiled by itself, coverage, the packages in a clean Debian. Hours on two cores. Goes on
# after a failure, and names all of them at the end. As root for the last step.
set -uo pipefail
cd "$(dirname "$0")/.."
scripts/install_dependencies.sh lint
scripts/install_dependencies.sh nightly
mkdir -p build

failed=()
step() {
  local name=$1
  shift
  printf '\n== %s (%d s)\n' "$name" "$SECONDS"
  "$@" || failed+=("$name")
}
build() { cmake --preset "$1" >build/configure.log && cmake --build --preset "$1"; }
# tests PRESET RC_PARAMS CTEST_OPTION...: all but what needs programs of others, where nothing else is said.
tests() {
  local preset=$1 cases=$2
  shift 2
  RC_PARAMS=$cases LSAN_OPTIONS=suppressions=$PWD/tests/lsan.supp:print_suppressions=0 \
    TSAN_OPTIONS=suppressions=$PWD/tests/tsan.supp \
    ctest --test-dir "build/$preset" --output-on-failure --timeout 7200 -j "$(nproc)" "$@"
}
new_cases="seed=$RANDOM"

step "lint" make lint
step "analyzer" make analyze
step "release build" build release
step "release, many cases ($new_cases)" tests release "$new_cases max_success=5000"
if [ -x build/release/tests/fuzz_files ]; then
  step "mutants" build/release/tests/fuzz_files --mutants 20000
fi
step "asan build" build asan
step "asan, slow tests too ($new_cases)" tests asan "$new_cases max_success=500" -L 'fast|slow'
step "tsan build" build tsan
step "tsan, slow tests too" tests tsan "$new_cases max_success=100" -L threads
step "clang build" build clang
step "clang" tests clang "seed=2018" -LE external
step "each source by itself" build debug
step "coverage build" build coverage
step "coverage tests" tests coverage "seed=2018" -LE external
step "coverage" gcovr --root . --filter src/ --filter include/ --print-summary --output build/coverage.txt build/coverage
step "packages in a clean Debian" scripts/try_deb.sh library

printf '\n== done (%d s)\n' "$SECONDS"
[ ${#failed[@]} -eq 0 ] || { printf 'failed: %s\n' "${failed[@]}"; exit 1; }

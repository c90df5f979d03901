#!/usr/bin/env bash
# embed_test.sh BUILD EXAMPLE MODEL CMAKE_OPTION...: the example of a program that uses the installed library, by CMake
# and by pkg-config.
set -euo pipefail
build=$1 example=$2 model=$3
shift 3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fail() { echo "embed_test: $*" >&2; exit 1; }

cmake --install "$build" --prefix "$folder/there" >"$folder/install.log" || { cat "$folder/install.log" >&2; exit 1; }
# What was installed may be moved.
mv "$folder/there" "$folder/here"
here=$folder/here
"$here/bin/cloud2csg" doctor || fail "the installed program is broken"
"$here/bin/cloud2csg" sample "$model" -n 8000 --noise 0.005 -o "$folder/cloud.ply" --quiet

# No header but the public ones.
(cd "$(dirname "$example")/../include" && find cloud2csg -type f) | sort >"$folder/public"
(cd "$here/include" && find . -type f) | sed 's|^\./||' | sort | diff "$folder/public" - || fail "other headers"

# judge NAME PROGRAM: it writes the tree of the cloud, and exact solids where they are built in.
judge() {
  "$2" "$folder/cloud.ply" "$folder/$1.scad"
  grep -q 'cube\|cylinder\|sphere' "$folder/$1.scad" || fail "$1 wrote no solids"
  if "$here/bin/cloud2csg" --version | grep -qF '+step'; then
    "$2" "$folder/cloud.ply" "$folder/$1.step"
    grep -q MANIFOLD_SOLID_BREP "$folder/$1.step" || fail "$1 wrote no exact solid"
  fi
}

log=$folder/embed.log
{ cmake -S "$example" -B "$folder/embed" -D CMAKE_PREFIX_PATH="$here" "$@" && cmake --build "$folder/embed"; } \
  >"$log" 2>&1 || { cat "$log" >&2; exit 1; }
judge by_cmake "$folder/embed/embed"

PKG_CONFIG_PATH=$(dirname "$(find "$here" -name cloud2csg.pc)")
export PKG_CONFIG_PATH
read -ra flags <<<"$(pkg-config --cflags --libs cloud2csg)"
"${CXX:-c++}" -std=c++20 "$example/main.cpp" "${flags[@]}" -o "$folder/by_pkg_config"
judge by_pkg_config "$folder/by_pkg_config"

#!/usr/bin/env bash
# deb_test.sh BUILD MODEL: the .deb of the program, unpacked somewhere, runs from there and is complete.
set -euo pipefail
build=$1 model=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fail() { echo "deb_test: $*" >&2; exit 1; }

# Fast rather than small.
cpack --config "$build/CPackConfig.cmake" -B "$folder/packages" -D CPACK_DEBIAN_COMPRESSION_TYPE=gzip \
  >"$folder/log" 2>&1 || { cat "$folder/log" >&2; exit 1; }
program=$(echo "$folder"/packages/cloud2csg_*.deb)
library=$(echo "$folder"/packages/libcloud2csg-dev_*.deb)

# has FIELD PATTERN: the package says so.
has() { dpkg-deb --field "$program" "$1" | grep -q "$2" || fail "$1: $(dpkg-deb --field "$program" "$1")"; }
has Depends 'libc6 (>= '
has Depends 'libtbb12'
dpkg-deb --field "$program" Depends | grep -q libocct && fail "OpenCASCADE is required, not recommended"
dpkg-deb --field "$library" Depends | grep -q libceres-dev || fail "the library does not name what it links"

root=$folder/root
dpkg-deb --extract "$program" "$root"
for file in share/man/man1/cloud2csg.1 share/man/man1/cloud2csg-bench-paper.1 \
  share/bash-completion/completions/cloud2csg share/zsh/vendor-completions/_cloud2csg \
  share/fish/vendor_completions.d/cloud2csg.fish share/cloud2csg/models/m0.json share/doc/cloud2csg/copyright; do
  [ -s "$root/usr/$file" ] || fail "no $file"
done
[ ! -e "$root/usr/include" ] || fail "headers in the package of the program"

cloud2csg=$root/usr/bin/cloud2csg
readelf --dynamic "$cloud2csg" "$root"/usr/lib/cloud2csg/*.so | grep -F "$build" && fail "it names the folder of the build"
"$cloud2csg" doctor || fail "broken"
"$cloud2csg" sample "$model" -n 8000 --noise 0.005 -o "$folder/cloud.ply" --quiet
outputs=(-o "$folder/part.scad" -o "$folder/part.json")
if "$cloud2csg" --version | grep -qF '+step'; then
  has Recommends 'libocct-data-exchange'
  "$cloud2csg" doctor | grep -qF "OpenCASCADE: $root" || fail "another module than the package's"
  outputs+=(-o "$folder/part.step")
fi
"$cloud2csg" extract "$folder/cloud.ply" "${outputs[@]}" --quiet
for output in "$folder"/part.*; do [ -s "$output" ] || fail "$output is empty"; done

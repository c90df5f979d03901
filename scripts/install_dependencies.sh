#!/usr/bin/env bash
# Installs the Debian packages that building and testing need, those that are missing only. Uses sudo when not root.
set -euo pipefail

packages=(
  g++ make cmake ninja-build pkg-config ccache
  libeigen3-dev libtbb-dev libhwy-dev libboost-dev libboost-graph-dev libccd-dev libmuparser-dev libzip-dev libpugixml-dev
  libceres-dev libembree-dev libnanoflann-dev nlohmann-json3-dev libvalijson-dev libcli11-dev libtomlplusplus-dev libfmt-dev
  libocct-data-exchange-dev zlib1g-dev libpng-dev libmeshoptimizer-dev libcpp-httplib-dev
  pybind11-dev python3-dev python3-numpy python3-pytest
  libgtest-dev librapidcheck-dev libbenchmark-dev openscad freecad-python3 gnuplot-nox chromium groff-base zsh fish
)
# The page of reports is built by Node.js. One that is there already, from wherever, is used; Debian's npm is large.
command -v node >/dev/null || packages+=(nodejs)
command -v npm >/dev/null || packages+=(npm)
case "${1:-}" in
  lint) packages+=(git clang clang-format clang-tidy python3) ;;
  instructions) packages+=(valgrind) ;;
  reference) packages=(doxygen python3) ;;
  clean-debian) packages=(debootstrap) ;;
esac

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$status" = installed ] || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

if ! command -v apt-get >/dev/null; then
  echo "cloud2csg: these packages are missing, and there is no apt-get to install them: ${missing[*]}" >&2
  exit 1
fi
as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "cloud2csg: install as root: ${missing[*]}" >&2; exit 1; }
  as_root=(sudo)
fi
echo "installing ${#missing[@]} packages: ${missing[*]}" >&2
log=$(mktemp)
trap 'rm -f "$log"' EXIT
export DEBIAN_FRONTEND=noninteractive
if ! { "${as_root[@]}" apt-get update &&
       "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
         apt-get install --yes --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
  cat "$log" >&2
  exit 1
fi

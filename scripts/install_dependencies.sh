#!/usr/bin/env bash
# Installs the Debian packages that building and testing need, those that are missing only. Uses sudo when not root.
#   install_dependencies.sh                what `make` and `make test` need
#   install_dependencies.sh lint           besides, clang: its sanitizers, linters, and headers to build a plugin with
#   install_dependencies.sh instructions   besides, valgrind
#   install_dependencies.sh nightly        only what scripts/nightly.sh needs besides all these
#   install_dependencies.sh reference      only what writes the references
#   install_dependencies.sh clean-debian   only what makes a clean Debian (scripts/try_deb.sh)
# Everything is named that a minimal Debian 12 lacks, also what most machines happen to have.
set -euo pipefail

packages=(
  g++ make cmake ninja-build pkg-config ccache lld git
  libeigen3-dev libtbb-dev libhwy-dev libboost-dev libboost-graph-dev libccd-dev libmuparser-dev libzip-dev libpugixml-dev
  libceres-dev libembree-dev libnanoflann-dev nlohmann-json3-dev libvalijson-dev libcli11-dev libtomlplusplus-dev libfmt-dev
  libocct-data-exchange-dev zlib1g-dev libpng-dev libmeshoptimizer-dev libcpp-httplib-dev
  pybind11-dev python3-dev python3-numpy
  # Tests, and the programs that they run.
  libgtest-dev librapidcheck-dev libbenchmark-dev
  python3-pytest python3-mypy python3-nbformat python3-pip python3-setuptools python3-wheel
  openscad freecad-python3 gnuplot-nox chromium groff-base zsh fish dpkg-dev
)
# The page of reports is built by Node.js, whose packages come by https. One that is there already, from wherever, is used;
# Debian's npm is large.
command -v node >/dev/null || packages+=(nodejs)
command -v npm >/dev/null || packages+=(npm ca-certificates)
case "${1:-}" in
  "") ;;
  lint) packages+=(clang clang-format clang-tidy libclang-rt-dev libclang-dev llvm-dev python3) ;;
  instructions) packages+=(valgrind) ;;
  reference) packages=(git doxygen python3) ;;
  nightly) packages=(gcovr debootstrap) ;;
  clean-debian) packages=(debootstrap) ;;
  *) echo "install_dependencies: $1 is none of lint, instructions, nightly, reference, clean-debian" >&2; exit 2 ;;
esac

installed=" $(dpkg-query --show --showformat='${Package}:${db:Status-Status} ' "${packages[@]}" 2>/dev/null || true)"
missing=()
for package in "${packages[@]}"; do
  [[ $installed == *" $package:installed "* ]] || missing+=("$package")
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

#!/usr/bin/env bash
# try_deb.sh [library]: installs the package of the program in a clean Debian with nothing else in it, and runs it there; with
# `library`, builds examples/embed against that package as well, which downloads a compiler. Needs root and the network.
set -euo pipefail
cd "$(dirname "$0")/.."
[ "$(id -u)" -eq 0 ] || { echo "try_deb: run it as root: it installs a Debian in a temporary folder" >&2; exit 1; }
scripts/install_dependencies.sh clean-debian

packages=build/packages
mirror=${DEBIAN_MIRROR:-http://deb.debian.org/debian}
clean=$(mktemp -d)
# In a namespace of its own, what is mounted there goes with the last process.
inside() { unshare --mount --pid --fork chroot "$clean" sh -c "mount -t proc proc /proc; $1"; }
trap 'rm -rf --one-file-system "$clean"' EXIT

make --silent deb
echo "a clean Debian from $mirror"
debootstrap --variant=minbase bookworm "$clean" "$mirror" >"$clean.log" 2>&1 || { cat "$clean.log" >&2; exit 1; }
rm "$clean.log"
cp "$packages"/*.deb data/models/m0.json "$clean/root"
cp -r examples/embed "$clean/root"

install="DEBIAN_FRONTEND=noninteractive apt-get install --yes --quiet"
# Without what is only recommended first: everything but STEP is there.
inside "cd /root && $install --no-install-recommends ./cloud2csg_*.deb >log 2>&1 || { cat log; exit 1; }
  set -e
  cloud2csg sample m0.json -n 20000 --noise 0.01 -o m0.ply --quiet
  cloud2csg extract m0.ply -o m0.scad -o m0.html -o part.json --quiet
  cloud2csg compare m0.json part.json"
recommended=$(inside "dpkg-query --show --showformat='\${Recommends}' cloud2csg" | sed 's/([^)]*)//g' | tr -d ',')
inside "cd /root && $install $recommended >log 2>&1 || { cat log; exit 1; }
  set -e
  cloud2csg doctor
  cloud2csg convert part.json -o part.step
  grep -c MANIFOLD_SOLID_BREP part.step"
[ "${1:-}" = library ] || exit 0
inside "cd /root && $install g++ cmake make ./libcloud2csg-dev_*.deb >log 2>&1 || { cat log; exit 1; }
  set -e
  cmake -S embed -B embed/build >log && cmake --build embed/build >log && ls embed/build"

#!/usr/bin/env bash
# Installs the Debian 12 packages that are missing: setup.sh [--build-only]. With --build-only just
# what the library and the command line need. Returns at once when nothing is missing.
set -euo pipefail

packages=(g++ cmake ninja-build pkgconf ccache git python3 libhwy-dev libtbb-dev libqhull-dev
  libcli11-dev libfmt-dev nlohmann-json3-dev libpng-dev libopenexr-dev libzip-dev)
development=(clang clang-format clang-tidy libclang-rt-14-dev libgtest-dev librapidcheck-dev
  libboost-dev libcgal-dev libbenchmark-dev libembree-dev python3-numpy
  gnuplot-nox chromium)
case "${1:-}" in
  --build-only) ;;
  "") packages+=("${development[@]}") ;;
  *) echo "usage: setup.sh [--build-only]" >&2; exit 2 ;;
esac

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2> /dev/null || true)
  [ "$status" = installed ] || missing+=("$package")
done
if [ ${#missing[@]} -eq 0 ]; then
  echo "setup: all ${#packages[@]} packages are there"
  exit 0
fi

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo > /dev/null || { echo "setup: need root or sudo for: ${missing[*]}" >&2; exit 1; }
  as_root=(sudo)
fi
echo "setup: installing ${missing[*]}"
"${as_root[@]}" apt-get update -q
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get install -y -q --no-install-recommends "${missing[@]}"

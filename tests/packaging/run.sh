#!/usr/bin/env bash
# Installs a finished build into a temporary folder, moves the installation elsewhere (it must be
# relocatable), and builds and runs the three kinds of consumers against it: run.sh <build folder>.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
build=$(cd "$1" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cmake --install "$build" --prefix "$work/staged" > /dev/null
mv "$work/staged" "$work/prefix"

cmake_consumer() {
  local kind=$1
  shift
  cmake -S "$here/$kind" -B "$work/$kind" -G Ninja "$@" > "$work/log" || { cat "$work/log"; return 1; }
  cmake --build "$work/$kind" -j2 > "$work/log" || { cat "$work/log"; return 1; }
  "$work/$kind/consumer"
  echo "packaging: $kind works"
}

cmake_consumer find_package -DCMAKE_PREFIX_PATH="$work/prefix"
# The whole library again: without optimisation, which is faster to compile.
cmake_consumer add_subdirectory -DSTRAHL_SOURCE_DIR="$here/../.." -DCMAKE_BUILD_TYPE=Debug

pc_file=$(find "$work/prefix" -name strahl.pc)
PKG_CONFIG_PATH=$(dirname "$pc_file") "$here/pkg_config/build.sh" "$work/pkg_config_consumer"
"$work/pkg_config_consumer"
echo "packaging: pkg_config works"

#!/usr/bin/env bash
# From a fresh clone to a picture: demo.sh [SCENE]. Builds the command line, then prints a table of
# statistics, renders and queries a scene: a file, or the standard scene gen:balls:4.
set -euo pipefail
scene=${1:-gen:balls:4}
if [ -e "$scene" ]; then scene=$(realpath "$scene"); fi
cd "$(dirname "$0")/.."

scripts/setup.sh --build-only
cmake --preset release -DSTRAHL_BUILD_TESTS=OFF -DSTRAHL_BUILD_BENCH=OFF > /dev/null
cmake --build --preset release --target strahl_cli -j "$(nproc)"
strahl=build/release/bin/strahl

name=$(basename "${scene#gen:}")
name=${name%.*}
name=${name//[^A-Za-z0-9_-]/_}
mkdir -p demo_out

echo "== $scene: statistics"
"$strahl" info "$scene" --structure bvh
echo "== picture"
"$strahl" render "$scene" -o "demo_out/$name.png"
echo "== closest hits of 64 rays through the scene"
"$strahl" info "$scene" --json > demo_out/info.json
python3 tools/demo_rays.py demo_out/info.json demo_out/rays.npy
"$strahl" query "$scene" --rays demo_out/rays.npy -o demo_out/hits.npz --json
echo
echo "picture: $PWD/demo_out/$name.png"
echo "hits:    $PWD/demo_out/hits.npz (arrays for numpy.load)"

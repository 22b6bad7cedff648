#!/usr/bin/env bash
# Runs clang-tidy over the tracked sources: run_tidy.sh [BUILD], BUILD being a configured clang build
# (default build/clang).
set -euo pipefail
cd "$(dirname "$0")/.."
build=${1:-build/clang}
[ -f "$build/compile_commands.json" ] || cmake --preset clang > /dev/null
mapfile -t files < <(git ls-files 'src/*.cpp' 'apps/*.cpp' ':!*_test.cpp')
printf '%s\n' "${files[@]}" | xargs -d '\n' -P 2 -n 4 clang-tidy -p "$build" --quiet
echo "tidy: ${#files[@]} files clean"

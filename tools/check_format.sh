#!/usr/bin/env bash
# Fails when a tracked C++ file is not formatted as .clang-format says.
set -euo pipefail
cd "$(dirname "$0")/.."
mapfile -t files < <(git ls-files '*.h' '*.cpp')
printf '%s\n' "${files[@]}" | xargs -d '\n' -P 2 -n 32 clang-format --dry-run -Werror
echo "format: ${#files[@]} files formatted"

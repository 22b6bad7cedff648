#!/usr/bin/env bash
# Does CONTRIBUTING's "add a structure" literally on a copy of the tree: one folder and one line must
# be all it takes for the build, the catalogue and the conformance suite to know the structure.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

mkdir "$work/tree"
tar -C "$root" -cf - CMakeLists.txt cmake src tests bench | tar -C "$work/tree" -xf -
(cd "$work/tree" && find . -type f | sort | xargs sha256sum) > "$work/before"

"$root/tools/new_structure.py" toy_list ToyList "a box around a list" --root "$work/tree"

(cd "$work/tree" && find . -type f | sort | xargs sha256sum) > "$work/after"
changed=$({ diff "$work/before" "$work/after" || true; } | sed -n 's/^> [0-9a-f]*  //p' | sort | tr '\n' ' ')
expected="./src/strahl/catalog/structures.def "
for file in README.md toy_list.cpp toy_list.h toy_list_test.cpp; do
  expected+="./src/strahl/structures/toy_list/$file "
done
if [ "$changed" != "$expected" ]; then
  echo "toy structure: changed '$changed', expected '$expected'" >&2
  exit 1
fi

# The folders and flags of the release preset: with ccache only what the structure changes is compiled.
build="$work/tree/build/release"
cmake -S "$work/tree" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DSTRAHL_BUILD_BENCH=OFF \
  -DSTRAHL_BUILD_TOOLS=OFF > /dev/null
CCACHE_BASEDIR="$work/tree" cmake --build "$build" -j2 \
  --target strahl_test_conformance strahl_test_structures > "$work/log" || { tail -40 "$work/log"; exit 1; }

# passes <test> <filter> <least number of tests>
passes() {
  "$build/tests/$1" --gtest_filter="$2" --gtest_brief=1 | tee "$work/log"
  [ "$(sed -n 's/.*PASSED *\] \([0-9]*\) test.*/\1/p' "$work/log")" -ge "$3" ]
}
passes strahl_test_structures 'ToyList.*' 1
passes strahl_test_conformance \
  '*EveryPair*toy_list_cube:*DefaultsAnd*toy_list_flat:*ThreadsAnd*toy_list_slivers' 3

#!/usr/bin/env bash
# All checks of the project: test.sh [--full]. Without --full what every change must pass, within
# 25 minutes on 2 cores from a bare machine; with it all compilers, sanitizers, clang-tidy and
# fuzzers, within 4 hours. Fails when over the time, too.
set -euo pipefail
cd "$(dirname "$0")/.."
case "${1:-}" in
  "") full=no budget=$((25 * 60)) ;;
  --full) full=yes budget=$((4 * 3600)) ;;
  *) echo "usage: test.sh [--full]" >&2; exit 2 ;;
esac
jobs=$(nproc)
# What one build folder has compiled serves the others, the copies that tests make included.
export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1
tested=()

# step <title> <command...>: runs a command under a heading that shows the time so far.
step() {
  printf '\n== [%s] %s\n' "$(clock $SECONDS)" "$1"
  "${@:2}"
}

clock() { printf '%d:%02d' $(($1 / 60)) $(($1 % 60)); }

configure() { cmake --preset "$1" "${@:2}" > build/configure.log || { cat build/configure.log; return 1; }; }

# run_preset <preset> [<regex>]: builds and runs the tests whose name matches; all without a regex.
run_preset() {
  local preset=$1 regex=${2:-.} targets=()
  configure "$preset"
  if [ "$regex" != . ]; then
    mapfile -t targets < <(ctest --preset "$preset" -N -R "$regex" | sed -n 's/.*Test *#[0-9]*: //p')
    targets=(--target "${targets[@]}")
  fi
  cmake --build --preset "$preset" -j "$jobs" "${targets[@]}"
  rm -rf "build/$preset/test_results"
  ctest --preset "$preset" -R "$regex"
  tested+=("build/$preset")
}

check_sources() {
  tools/check_layers.py
  tools/check_format.sh
  tools/check_headers.py
}

# wide_bvh on another processor: NEON, under qemu-user.
test_neon() {
  scripts/setup_arm64.sh
  configure neon
  cmake --build --preset neon -j "$jobs" --target strahl_cli strahl_test_conformance
  rm -rf build/neon/test_results
  GTEST_FILTER='*WideKernels*:*WideCompact*:*wide_bvh*' ctest --preset neon -R conformance
  tested+=(build/neon)
}

# strahl_of <preset> <argument...>: runs the command line of that build.
strahl_of() {
  local emulator=()
  [ "$1" != neon ] || emulator=(qemu-aarch64 -L build/arm64-sysroot)
  "${emulator[@]}" "build/$1/bin/strahl" "${@:2}"
}

# The files that different builds write for the same rays must be the same bytes.
compare_builds() {
  local scene spec preset out=build/compare
  mkdir -p $out
  for scene in gen:balls:2 gen:tetra:4 gen:teapot:3; do
    build/release/bin/strahl info $scene --json > $out/info.json
    tools/demo_rays.py $out/info.json $out/rays.npy 20000
    for spec in brute_force grid kd_tree bvh wide_bvh; do
      for preset in "$@"; do
        strahl_of "$preset" query $scene --rays $out/rays.npy --structure $spec --threads 2 \
          -o "$out/$preset.npz" > /dev/null
        cmp "$out/$preset.npz" "$out/$1.npz"
      done
    done
  done
  echo "compare: builds $* give the same bytes"
}

fuzz() {
  local target name folders options broken_files=${STRAHL_SHARED:-../shared}/scenes/bad
  configure fuzz
  cmake --build --preset fuzz -j "$jobs"
  build/release/bin/strahl list --json | tools/spec_dictionary.py > build/fuzz/spec.dict
  for target in build/fuzz/bin/*_fuzz; do
    name=$(basename "$target")
    folders=("build/fuzz/corpus/$name")
    mkdir -p "${folders[0]}"
    options=()
    if [ "$name" = spec_fuzz ]; then
      options=(-max_len=256 -dict=build/fuzz/spec.dict)
    elif [ -d "$broken_files" ]; then
      folders+=("$broken_files")
    fi
    echo "-- $name"
    "$target" -max_total_time=60 -timeout=10 -rss_limit_mb=2048 -verbosity=0 -print_final_stats=1 \
      -artifact_prefix=build/fuzz/ "${options[@]}" "${folders[@]}"
  done
}

mkdir -p build
step "setup" scripts/setup.sh
step "layers, format, headers" check_sources
step "release build and tests" run_preset release
step "counters cost nothing when off" tools/check_counters.py
if [ $full = no ]; then
  step "address and undefined-behaviour sanitizers" \
    run_preset asan-ubsan '^strahl_test_(base|math|geometry|io|catalog)$'
else
  step "address and undefined-behaviour sanitizers" run_preset asan-ubsan
  step "conformance, whole matrix" env STRAHL_CONFORMANCE=full ctest --preset release -R "conformance|regression"
  step "dev build and tests (g++)" run_preset dev
  step "release build and tests (clang)" run_preset clang
  step "dev build and tests (clang)" run_preset clang-dev
  step "thread sanitizer" run_preset tsan
  step "wide_bvh on ARM" test_neon
  step "builds compared" compare_builds release dev clang clang-dev neon
  step "clang-tidy" tools/run_tidy.sh
  step "fuzzers, 60 s each" fuzz
fi
step "summary" tools/test_summary.py "${tested[@]}"

echo "time: $(clock $SECONDS) of $(clock $budget)"
if [ $SECONDS -gt $budget ]; then
  echo "test.sh: over its time budget" >&2
  exit 1
fi

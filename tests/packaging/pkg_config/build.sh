#!/usr/bin/env bash
# Builds the consumer with nothing but a compiler and pkg-config: build.sh <output>.
set -euo pipefail
cd "$(dirname "$0")"
read -ra flags <<< "$(pkg-config --cflags strahl)"
read -ra libraries <<< "$(pkg-config --libs strahl)"
"${CXX:-c++}" -std=c++20 "${flags[@]}" ../main.cpp -o "$1" "${libraries[@]}"

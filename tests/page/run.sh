#!/usr/bin/env bash
# The page of `strahl compare` in headless Chromium: run.sh <path of strahl>. Every picture must be
# shown, the console must stay silent, and the screenshot must be full of colour.
set -euo pipefail
strahl=$1 here=$(dirname "$(realpath "$0")")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$strahl" compare gen:balls:2 gen:tetra:4 --structures bvh,grid,kd_tree --workloads random,shadow \
  --rays 2000 --min-rays 500 --repeat 2 --maps 64x48 -o "$work" --quiet > /dev/null
pictures=$(grep -c '<img ' "$work/compare.html")

# A copy that tells in its title how many pictures were decoded.
sed 's|</body>|<script>addEventListener("load", () => { const all = [...document.images];\
document.title = all.filter(i => i.naturalWidth > 0).length + " pictures shown"; });</script></body>|' \
  "$work/compare.html" > "$work/counted.html"
browse() {
  timeout 120 chromium --headless=new --no-sandbox --disable-gpu --user-data-dir="$work/profile" \
    --window-size=900,1400 --enable-logging=stderr --v=0 "$@" 2> "$work/log"
}
browse --dump-dom "file://$work/counted.html" > "$work/dom.html"
if ! grep -q "<title>$pictures pictures shown</title>" "$work/dom.html"; then
  echo "page: $pictures pictures expected, got: $(grep -o '<title>[^<]*' "$work/dom.html")" >&2
  exit 1
fi
browse --screenshot="$work/page.png" "file://$work/compare.html" > /dev/null
if grep 'CONSOLE' "$work/log"; then echo "page: messages on the console" >&2; exit 1; fi
"$here/colours.py" "$work/page.png"
echo "page: $pictures pictures shown"

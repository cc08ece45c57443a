#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A build with MIEN_BUILD_COMPILER=OFF does what the full one does with baked files, and says what it
# lacks; its headers need nothing of the rest.
# Usage: check.sh FULL_BUILD SLIM_BUILD WORK    (WORK is emptied)
set -euo pipefail

full=$1/bin/mien
slim=$2/bin/mien
work=$3
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
rm -rf "$work"
mkdir -p "$work"

die() {
  echo "$*" >&2
  exit 1
}

# The same names are exported; the program needs no other library of ours.
python3 "$root/tests/check_exports.py" "$2/lib/libmien.so"
if [[ $(uname -m) = x86_64 && $(readelf -p .comment "$2/lib/libmien.so") = *"GCC: "*" 12."* ]]; then
  python3 "$root/tests/check_sizes.py" --slim "$2/lib/libmien.so"
fi
[ ! -e "$2/lib/libmien-author.so" ] || die "the slim build makes libmien-author"

frames='{"frames": [{}]}'
posed='{"frames": [{"raw": {"jawOpen": 0.5, "mouthSmileLeft": 1}}]}'

# Baked by the full build, evaluated and drawn by both: the same bytes.
"$full" demo-head -o "$work/head.dna"
"$full" gen --preset large --ml -o "$work/large.dna"
"$full" gen --preset body -o "$work/body.dna"
for rig in head large body; do
  "$full" bake "$work/$rig.dna" -o "$work/$rig.baked"
  for program in full slim; do
    "${!program}" eval "$work/$rig.baked" --input - <<<"$frames" >"$work/$rig-$program.json"
  done
  cmp "$work/$rig-full.json" "$work/$rig-slim.json"
done
for program in full slim; do
  "${!program}" eval "$work/head.baked" --input - --lod all <<<"$posed" >"$work/posed-$program.json"
done
cmp "$work/posed-full.json" "$work/posed-slim.json"
for lod in 0 3; do
  for program in full slim; do
    "${!program}" render "$work/head.baked" --lod $lod --set jawOpen=0.5 --size 160x160 \
      -o "$work/head-$lod-$program.png"
  done
  cmp "$work/head-$lod-full.png" "$work/head-$lod-slim.png"
done
if cmp -s "$work/head-0-full.png" "$work/head-3-full.png"; then die "LODs look alike"; fi
if cmp -s "$work/posed-full.json" "$work/head-full.json"; then die "the pose is not evaluated"; fi

# refused COMMAND...: fails, and the message names the reason.
refused() {
  if "$slim" "$@" >"$work/refused.log" 2>&1; then die "the slim build can: $*"; fi
  grep -q MIEN_BUILD_COMPILER "$work/refused.log" || die "$*: $(cat "$work/refused.log")"
}
refused gen -o "$work/none.dna"
refused demo-head -o "$work/none.dna"
refused info "$work/head.dna"
refused eval "$work/head.dna" --input <(echo "$frames")
refused render "$work/head.dna" -o "$work/none.png"
refused validate "$work/head.dna"
refused convert "$work/head.dna" -o "$work/none.dna"
refused bake "$work/head.dna" -o "$work/none.baked"
refused export "$work/head.dna" -o "$work/none.glb"

# The headers of compiled data and of what works on it compile in a tree without the others.
tree=$work/tree
mkdir -p "$tree/runtime"
cp -r "$root/simd" "$tree"
for room in base rig eval anim mix pose solve deform probe baked; do
  cp -r "$root/runtime/$room" "$tree/runtime"
done
(cd "$tree" && find runtime -name '*.h' | sort | sed 's/.*/#include "&"/') >"$work/headers.cpp"
"${CXX:-c++}" -std=c++17 -fsyntax-only -I"$tree" "$work/headers.cpp"

strip -o "$work/libmien.so" "$2/lib/libmien.so"
echo "$(grep -c . "$work/headers.cpp") headers; libmien.so: $(stat -c %s "$work/libmien.so") bytes, stripped"

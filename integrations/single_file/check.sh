#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The single-file form, compiled by several compilers, gives the bits of the library.
# Usage: check.sh BUILD WORK    (WORK is emptied)
set -euo pipefail

build=$(cd "$1" && pwd)
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$here/../..
rm -rf "$2"
mkdir -p "$2"
work=$(cd "$2" && pwd)

python3 "$here/amalgamate.py" "$work/source"
xsimd=$(sed -n 's/^MIEN_XSIMD_INCLUDE_DIR:[A-Z]*=//p' "$build/CMakeCache.txt")
# Only xsimd itself: its folder is often that of the system's headers.
mkdir "$work/include"
ln -s "$xsimd/xsimd" "$work/include/xsimd"

cd "$work"
"$build/bin/mien" demo-head -q -o head.dna
"$build/bin/mien" bake head.dna -q --arithmetic portable -o head.baked
"$build/bin/mien" play "$root/examples/scene.json" head.dna -q -o take.clip

gcc -std=c11 -DMIEN_SHARED_LIBRARY -I"$root/capi/include" "$here/play.c" -L"$build/lib" -lmien \
  -Wl,-rpath,"$build/lib" -o play-library

# same NAME ISA COMMAND...: what the library computes with this instruction set.
same() {
  local name=$1 expected found
  expected=$(MIEN_ISA=$2 ./play-library head.baked take.clip)
  shift 2
  found=$("$@" head.baked take.clip)
  [ "$found" = "$expected" ] || { echo "$name: $found; the library: $expected" >&2; exit 1; }
  echo "$name: the same bits, $(stat -c %s "$name") bytes"
}

options=(-std=c++17 -ffp-contract=off -fno-exceptions -fno-rtti -ffunction-sections -fdata-sections -fvisibility=hidden
  -Wall -Wextra -isystem include)
# compile NAME C C++ FLAGS...
compile() {
  local name=$1 c=$2 cxx=$3
  shift 3
  $cxx "${options[@]}" "$@" -c source/mien_runtime.cpp -o "$name.o"
  $c -std=c11 -Wall -Wextra -Isource -O1 -c "$here/play.c" -o "$name-play.o"
}

compile gcc gcc g++ -O2
g++ gcc.o gcc-play.o -Wl,--gc-sections -s -o gcc
case $(uname -m) in x86_64) isa=sse2 ;; aarch64) isa=neon ;; *) isa=scalar ;; esac
same gcc $isa ./gcc

if command -v clang++ >/dev/null; then
  compile clang clang clang++ -O1 -DMIEN_SCALAR
  clang++ clang.o clang-play.o -o clang
  same clang scalar ./clang
else
  echo "NOT TESTED: the single-file form by clang; it is not installed"
fi
if command -v em++ >/dev/null && command -v node >/dev/null; then
  export NODE_PATH=/usr/share/nodejs
  compile emscripten emcc em++ -O1 -msimd128 -msse2
  em++ emscripten.o emscripten-play.o -O1 -sNODERAWFS=1 -sALLOW_MEMORY_GROWTH=1 -o emscripten.js
  mv emscripten.wasm emscripten
  sed -i 's/emscripten\.wasm/emscripten/' emscripten.js
  same emscripten scalar node --no-experimental-fetch emscripten.js
else
  echo "NOT TESTED: the single-file form for WebAssembly; there is no emscripten or no node"
fi
if command -v x86_64-w64-mingw32-g++-posix >/dev/null; then
  compile mingw x86_64-w64-mingw32-gcc-posix x86_64-w64-mingw32-g++-posix -O1
  x86_64-w64-mingw32-g++-posix mingw.o mingw-play.o -static -o mingw.exe
  if command -v wine64 >/dev/null; then same mingw.exe scalar wine64 mingw.exe; fi
else
  echo "NOT TESTED: the single-file form for Windows; there is no MinGW-w64 (./dev platforms installs it)"
fi

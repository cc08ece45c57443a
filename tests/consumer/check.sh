#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs BUILD, moves what was installed, and uses it as other projects would: through
# find_package() in C and in C++, and through pkg-config; shared and static each time.
# Usage: check.sh BUILD WORK    (WORK is emptied)
set -euo pipefail

build=$1
work=$2
here=$(cd "$(dirname "$0")" && pwd)
cmake=${CMAKE:-cmake}
cc=${CC:-cc}

rm -rf "$work"
mkdir -p "$work"
"$cmake" --install "$build" --prefix "$work/installed" --component mien >"$work/install.log"
# Nothing of it may remember where it was installed.
mv "$work/installed" "$work/moved"
prefix=$work/moved
libdir=$(dirname "$(find "$prefix" -name libmien.so)")

run() {
  echo "-- $1"
  LD_LIBRARY_PATH=$libdir "$1"
}

for languages in OFF ON; do
  out=$work/cmake-cxx-$languages
  "$cmake" -S "$here" -B "$out" -DCMAKE_PREFIX_PATH="$prefix" -DWITH_CXX=$languages >"$out.log"
  "$cmake" --build "$out" >>"$out.log"
  run "$out/c_shared"
  run "$out/c_static"
done
run "$out/cxx_shared"
run "$out/cxx_static"

export PKG_CONFIG_PATH=$libdir/pkgconfig
warnings=(-std=c11 -pedantic -Wall -Wextra -Werror)
read -ra flags <<<"$(pkg-config --cflags --libs mien)"
"$cc" "${warnings[@]}" "$here/main.c" "${flags[@]}" -o "$work/pc_shared"
read -ra flags <<<"$(pkg-config --static --cflags --libs mien)"
"$cc" "${warnings[@]}" -static "$here/main.c" "${flags[@]}" -o "$work/pc_static"
run "$work/pc_shared"
run "$work/pc_static"

# The program finds its library by where it lies itself.
if [ -x "$prefix/bin/mien" ]; then
  "$prefix/bin/mien" gen --preset tiny -o "$work/tiny.dna"
  "$prefix/bin/mien" info "$work/tiny.dna" >/dev/null
fi

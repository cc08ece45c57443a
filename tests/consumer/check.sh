#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs BUILD, moves what was installed, and uses it as other projects would.
# Usage: check.sh BUILD WORK    (WORK is emptied)
set -euo pipefail

build=$1
work=$2
# shellcheck source=tests/consumer/use.sh
source "$(dirname "$0")/use.sh"

rm -rf "$work"
mkdir -p "$work"
# By component, which leaves the manifest of a real installation, read by `uninstall`, as it is.
for component in mien_runtime mien_author_runtime mien_solve_runtime mien_development mien_program; do
  "$cmake" --install "$build" --prefix "$work/installed" --component $component >>"$work/install.log"
done
# Nothing of it may remember where it was installed.
mv "$work/installed" "$work/moved"
prefix=$work/moved
libdir=$(dirname "$(find "$prefix" -name libmien.so)")

export PKG_CONFIG_PATH=$libdir/pkgconfig
use "$prefix" "$libdir" "$work"

# refused COMPONENT REASON: find_package() fails for that reason.
refused() {
  local log=$work/refused-$1.log
  if "$cmake" -S "$here" -B "$work/refused-$1" -DCMAKE_PREFIX_PATH="$prefix" -DCOMPONENTS="$1" \
    >"$log" 2>&1; then
    echo "a project found the component $1" >&2
    exit 1
  fi
  # CMake breaks lines.
  tr -s ' \n' '  ' <"$log" | grep -qF "$2" || { cat "$log" >&2; exit 1; }
  echo "-- refused: $2"
}
refused dynamic "no component is named dynamic"
mv "$libdir/libmien.a" "$work/libmien.a"
refused static "the static library is not installed: no $libdir/libmien.a"
mv "$work/libmien.a" "$libdir/libmien.a"

# The program finds its library by where it lies itself.
if [ -x "$prefix/bin/mien" ]; then
  "$prefix/bin/mien" gen --preset tiny -o "$work/tiny.dna"
  "$prefix/bin/mien" info "$work/tiny.dna" >/dev/null
fi

#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Unpacks the .deb packages into a root of their own, looks at what is in them, and uses them as
# other projects would. lintian is asked if it is there.
# Usage: check_packages.sh DIRECTORY WORK    (WORK is emptied)
set -euo pipefail

packages=("$1"/*.deb)
work=$(realpath -m "$2")
# shellcheck source=tests/consumer/use.sh
source "$(dirname "$0")/use.sh"
root=$work/root

rm -rf "$work"
mkdir -p "$root"
[ ${#packages[@]} -eq 5 ] || { echo "not five packages: ${packages[*]}" >&2; exit 1; }
for package in "${packages[@]}"; do
  dpkg-deb --extract "$package" "$root"
done
libdir=$(dirname "$(find "$root" -name libmien.so)")

# Each exported name has its release, and no other name has one.
python3 "$here/../check_exports.py" "$libdir/libmien.so" "$libdir/libmien-author.so" "$libdir/libmien-solve.so"
for library in mien mien-author mien-solve; do
  soname=$(basename "$(readlink "$libdir/lib$library.so")")
  runtime=$(printf '%s\n' "${packages[@]}" | grep "/lib$library${soname##*.so.}_")
  dpkg-deb --ctrl-tarfile "$runtime" | tar -xO ./symbols >"$work/symbols"
  sed -n 's/^ \(mien_[a-z0-9_]*\)@.*/\1/p' "$work/symbols" >"$work/symbols.names"
  sed -n 's/^ *\(mien_[a-z0-9_]*\);.*/\1/p' "$here"/../../*/"${library/-/_}.map" |
    LC_ALL=C sort >"$work/map.names"
  diff "$work/map.names" "$work/symbols.names"
done

# As for another machine: the packages' own root stands before the paths that they name.
export PKG_CONFIG_LIBDIR=$libdir/pkgconfig PKG_CONFIG_SYSROOT_DIR=$root
export PKG_CONFIG_ALLOW_SYSTEM_CFLAGS=1 PKG_CONFIG_ALLOW_SYSTEM_LIBS=1
use "$root/usr" "$libdir" "$work"

run "$libdir" "$root/usr/bin/mien" gen --preset tiny -o "$work/tiny.dna"
[ -s "$libdir/mien/view_server.so" ] || { echo "no web server of mien view" >&2; exit 1; }
for file in share/man/man1/mien.1.gz share/bash-completion/completions/mien \
  share/zsh/vendor-completions/_mien share/fish/vendor_completions.d/mien.fish; do
  [ -s "$root/usr/$file" ] || { echo "no $file" >&2; exit 1; }
done

if [ -e "$here/../../build/web/viewer/index.html" ]; then
  for file in index.html viewer.js mien/mien.wasm three/three.module.min.js; do
    [ -s "$root/usr/share/mien/viewer/$file" ] || { echo "no $file in the page of the viewer" >&2; exit 1; }
  done
else
  echo "NOT TESTED: the page of the viewer in the Debian package; ./dev web build has not made it"
fi

if command -v lintian >/dev/null; then
  lintian --allow-root --fail-on error,warning "${packages[@]}"
  echo "lintian has nothing to say"
else
  echo "NOT TESTED: the Debian packages by lintian; it is not installed"
fi

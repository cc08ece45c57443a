# SPDX-License-Identifier: MIT
# Uses an installed Mien as other projects would: through find_package() in C and in C++, and
# through pkg-config; shared and static each time. To be sourced.

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cmake=${CMAKE:-cmake}
cc=${CC:-cc}

# run LIBDIR PROGRAM [ARGUMENTS]
run() {
  echo "-- $2"
  LD_LIBRARY_PATH=$1 "${@:2}"
}

# use PREFIX LIBDIR WORK: pkg-config is told of the place by the caller's environment.
use() {
  local prefix=$1 libdir=$2 work=$3 languages out flags
  for languages in OFF ON; do
    out=$work/cmake-cxx-$languages
    "$cmake" -S "$here" -B "$out" -DCMAKE_PREFIX_PATH="$prefix" -DWITH_CXX=$languages >"$out.log"
    "$cmake" --build "$out" >>"$out.log"
    run "$libdir" "$out/c_shared"
    run "$libdir" "$out/c_static"
  done
  run "$libdir" "$out/cxx_shared"
  run "$libdir" "$out/cxx_static"

  local warnings=(-std=c11 -pedantic -Wall -Wextra -Werror)
  read -ra flags <<<"$(pkg-config --cflags --libs mien)"
  "$cc" "${warnings[@]}" "$here/main.c" "${flags[@]}" -o "$work/pc_shared"
  read -ra flags <<<"$(pkg-config --static --cflags --libs mien)"
  "$cc" "${warnings[@]}" -static "$here/main.c" "${flags[@]}" -o "$work/pc_static"
  run "$libdir" "$work/pc_shared"
  run "$libdir" "$work/pc_static"
}

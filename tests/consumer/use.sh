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
  local prefix=$1 libdir=$2 work=$3 languages out flags way programs
  local dna=$work/consumer.dna
  for languages in OFF ON; do
    out=$work/cmake-cxx-$languages
    "$cmake" -S "$here" -B "$out" -DCMAKE_PREFIX_PATH="$prefix" -DWITH_CXX=$languages >"$out.log"
    "$cmake" --build "$out" >>"$out.log"
    # The first ones write the file that the others read.
    programs=(c_author_shared c_author_static c_shared c_static)
    if [ $languages = ON ]; then
      programs+=(cxx_author_shared cxx_author_static cxx_shared cxx_static)
    fi
    for way in "${programs[@]}"; do run "$libdir" "$out/$way" "$dna"; done
  done

  local warnings=(-std=c11 -pedantic -Wall -Wextra -Werror)
  for way in mien mien-author; do
    [ $way = mien ] || warnings+=(-DMAKES_FILES)
    read -ra flags <<<"$(pkg-config --cflags --libs $way)"
    "$cc" "${warnings[@]}" "$here/main.c" "${flags[@]}" -o "$work/pc_shared"
    read -ra flags <<<"$(pkg-config --static --cflags --libs $way)"
    "$cc" "${warnings[@]}" -static "$here/main.c" "${flags[@]}" -o "$work/pc_static"
    run "$libdir" "$work/pc_shared" "$dna"
    run "$libdir" "$work/pc_static" "$dna"
  done
  # Programs that make no files need libmien alone.
  if readelf -d "$work/cmake-cxx-ON/c_shared" | grep "NEEDED.*mien-author"; then exit 1; fi
}

#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tests the crates against the libraries of BUILD; downloads nothing. Each test builds the crates anew, so:
#   check.sh BUILD                        their tests, shared; the example, shared and static, by pkg-config
#   check.sh --attack BUILD               clippy, the documentation, safe code that attacks with a sanitizer
#   check.sh --slow BUILD ASAN_BUILD      their tests, static; pointer rules; the library with the address sanitizer
#   check.sh --threads BUILD TSAN_BUILD   tests/threads.rs with the thread sanitizer
# Everything that is built lies in BUILD/rust.
set -euo pipefail

part=--tests
if [[ $1 = --* ]]; then
  part=$1
  shift
fi
build=$(realpath "$1")
sanitized=${2:+$(realpath "$2")}
cd "$(dirname "${BASH_SOURCE[0]}")"
unset MIEN_LIB_DIR MIEN_STATIC RUSTFLAGS
export CARGO_NET_OFFLINE=true
target=$build/rust/target

# One directory for each way to link: cargo would build everything anew at each change.
run() {
  local way=$1
  shift
  echo "-- $way: $*"
  CARGO_TARGET_DIR=$target/$way "$@"
}

host=$(rustc -vV | sed -n 's/^host: //p')
has_nightly() { cargo +nightly --version >/dev/null 2>&1; }

check_threads() {
  if ! has_nightly; then
    echo "NOT TESTED: threads of the Rust crates with a sanitizer; there is no nightly compiler"
    return
  fi
  # The sanitizer fails on some address layouts of newer kernels.
  local layout=()
  if setarch -R true 2>/dev/null; then layout=(setarch -R); fi
  MIEN_LIB_DIR=$sanitized/lib MIEN_STATIC=1 RUST_TEST_THREADS=1 TSAN_OPTIONS="suppressions=$PWD/tsan.supp" \
    RUSTFLAGS="-Zsanitizer=thread -Cunsafe-allow-abi-mismatch=sanitizer -Clink-arg=-lstdc++" \
    run threads "${layout[@]}" cargo +nightly test --quiet --locked --target "$host" -p mien --test threads
}

check_attack() {
  export MIEN_LIB_DIR=$build/lib
  if cargo clippy --version >/dev/null 2>&1; then
    # What every clippy calls wrong; of matters of taste each version has its own.
    run shared cargo clippy --quiet --locked --all-targets -- \
      -D clippy::correctness -D clippy::suspicious -D clippy::incompatible_msrv
  else
    echo "NOT TESTED: the Rust crates by clippy; it is not installed"
  fi
  # Without any library, as docs.rs does.
  (unset MIEN_LIB_DIR; MIEN_DOCS=1 RUSTDOCFLAGS="-D warnings" run docs cargo doc --quiet --locked --no-deps)
  if has_nightly; then
    RUSTFLAGS="-Zsanitizer=address -Cunsafe-allow-abi-mismatch=sanitizer" ASAN_OPTIONS=allocator_may_return_null=1 \
      run sanitized cargo +nightly test --quiet --locked --target "$host" -p mien --test attack
  else
    echo "NOT TESTED: attacks on the Rust crates with a sanitizer; there is no nightly compiler"
  fi
}

check_slow() {
  export MIEN_LIB_DIR=$build/lib
  MIEN_STATIC=1 run static cargo test --quiet --locked --tests
  # What is written for Miri, with Miri where there is one; else at least that it compiles and runs.
  if cargo +nightly miri --version >/dev/null 2>&1; then
    run miri cargo +nightly miri test --quiet --locked --test aliasing
  else
    echo "NOT TESTED: pointer rules of the Rust crates; there is no Miri"
    RUSTFLAGS="--cfg miri --cap-lints allow" \
      run without-library cargo test --quiet --locked --test aliasing
  fi
  # Programs without the sanitizer have to load it before the library that needs it.
  local runtime
  runtime=$(clang -print-file-name="libclang_rt.asan-$(uname -m).so")
  export "CARGO_TARGET_$(tr 'a-z-' 'A-Z_' <<<"$host")_RUNNER=env LD_PRELOAD=$runtime ASAN_OPTIONS=allocator_may_return_null=1"
  MIEN_LIB_DIR=$sanitized/lib RUSTFLAGS="-C link-arg=-Wl,--allow-shlib-undefined" \
    run asan cargo test --quiet --locked --tests
}

check_tests() {
  if cargo fmt --version >/dev/null 2>&1; then
    cargo fmt --all --check
  else
    echo "NOT TESTED: format of the Rust crates; there is no rustfmt"
  fi
  MIEN_LIB_DIR=$build/lib run shared cargo test --quiet --locked
  MIEN_LIB_DIR=$build/lib LD_LIBRARY_PATH=$build/lib run shared cargo run --quiet --locked --example batch_matrices

  # The example prints what the one in C prints, whichever way it is linked.
  local expected component features printed
  expected=$("$build/tests/example_c")
  rm -rf "$build/rust/installed"
  for component in mien_runtime mien_author_runtime mien_solve_runtime mien_development; do
    cmake --install "$build" --prefix "$build/rust/installed" --component $component >/dev/null
  done
  PKG_CONFIG_PATH=$(dirname "$(find "$build/rust/installed" -name mien.pc)")
  export PKG_CONFIG_PATH
  for features in "" mien/static; do
    printed=$(run "pkg-config${features:+-static}" cargo run --quiet --locked \
      --example evaluate --features "$features" | tail -n 1)
    echo "$printed"
    [ "$printed" = "$expected" ] || { echo "C prints: $expected" >&2; exit 1; }
  done
}

cargo --version
rustc --version
case $part in
  --tests) check_tests ;;
  --attack) check_attack ;;
  --slow) check_slow ;;
  --threads) check_threads ;;
  *) echo "unknown: $part; see the head of this script" >&2; exit 1 ;;
esac

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that nothing leaks out of the kernel objects.

An inline function compiled in two objects with different instruction sets is one symbol to the
linker, which keeps either copy: code that should run anywhere may come to use AVX-512. So each
kernels_<isa>.*.o may export one strong symbol, its table, and weak ones only if they carry the name
of the instruction set.

    check_isa_objects.py [--nm NM] kernels_scalar.cpp.o kernels_avx2.cpp.o ...
    check_isa_objects.py --self-test c++
"""
import argparse
import os
import re
import subprocess
import sys
import tempfile


# What sanitizers add: a marker beside each global of AddressSanitizer, and clang's descriptions of
# function types (data, the same in every object; -fno-rtti leaves no others).
SANITIZER_NAMES = re.compile(r"_*odr_asan|_ZT[IS]F")


def read_symbols(nm, path):
    """Pairs of nm's type letter and the mangled name, for symbols that other objects can see."""
    text = subprocess.run([nm, "--format=posix", path], check=True, text=True,
                          stdout=subprocess.PIPE).stdout
    pairs = [line.split()[:2] for line in text.splitlines()]
    # Lower case is local or a reference, except u: unique among all libraries of the process.
    return [(kind, name) for name, kind in pairs
            if (kind == "u" or (kind.isupper() and kind not in "UN"))
            and not SANITIZER_NAMES.match(name)]


def find_faults(nm, path):
    match = re.fullmatch(r"kernels_([a-z0-9]+)\..*", os.path.basename(path))
    if not match:
        return ["not named kernels_<isa>.*"]
    isa = match.group(1)
    table = f"_ZN4mien{len(isa)}{isa}6kTableE"
    faults, tables = [], 0
    for kind, name in read_symbols(nm, path):
        if name in (table, "_" + table):  # Mach-O puts an underscore before each name
            tables += 1
        elif isa not in name:
            faults.append(f"{kind} {name}: exported without '{isa}' in its name")
        elif kind not in "uVW":
            faults.append(f"{kind} {name}: a strong symbol beside the table")
    if tables != 1:
        faults.append(f"does not export its table {table}")
    return faults


def check(nm, paths):
    fault_count = 0
    for path in paths:
        for fault in find_faults(nm, path):
            print(f"{path}: {fault}")
            fault_count += 1
    print(f"{len(paths)} kernel objects, {fault_count} faults")
    return fault_count == 0


def self_test(nm, compiler):
    """Each kind of leak, compiled for real, must be found, and a clean object must pass."""
    table = "namespace mien::avx2 { extern const int kTable; const int kTable = 1; }\n"
    cases = [
        ("clean", 0, table + "namespace { int f() { return 1; } } static int x = f();"),
        ("weak function with the name", 0,
         table + "namespace mien_xsimd_avx2 { template <class T> __attribute__((noinline)) T f(T a)"
         " { return a; } template int f(int); }"),
        ("inline function", 1, table + "inline int f() { return 1; } int (*p)() = f;"),
        ("template static", 1,
         table + "template <class T> struct S { static T t; }; template <class T> T S<T>::t;"
         " template struct S<int>;"),
        ("strong function", 1, table + "int f() { return 1; }"),
        ("strong function with the name", 1,
         table + "namespace mien::avx2 { int f() { return 1; } }"),
        ("no table", 1, "static int x; int *f_avx2() { return &x; }"),
        ("table of another", 1, table.replace("avx2", "avx512")),
    ]
    failed = 0
    with tempfile.TemporaryDirectory() as directory:
        path = os.path.join(directory, "kernels_avx2.cpp.o")
        for title, should_fail, source in cases:
            subprocess.run([compiler, "-std=c++17", "-w", "-x", "c++", "-c", "-", "-o", path],
                           input=source, text=True, check=True)
            faults = find_faults(nm, path)
            if bool(faults) != bool(should_fail):
                print(f"self-test '{title}': faults {faults}")
                failed += 1
    print(f"self-test: {len(cases)} cases, {failed} failed")
    return failed == 0


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--nm", default=os.environ.get("NM", "nm"))
    parser.add_argument("--self-test", metavar="COMPILER")
    parser.add_argument("objects", nargs="*")
    arguments = parser.parse_args()
    if not arguments.self_test and not arguments.objects:
        parser.error("no objects")
    good = True
    if arguments.self_test:
        good = self_test(arguments.nm, arguments.self_test)
    if arguments.objects:
        good = check(arguments.nm, arguments.objects) and good
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The library that opens baked files, as two files: mien_runtime.h and mien_runtime.cpp. See README.md.

    amalgamate.py FOLDER
"""
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PUBLIC = ROOT / "capi" / "include"
# What the slim library is made of (capi/CMakeLists.txt, runtime/CMakeLists.txt).
ROOMS = ("base", "rig", "eval", "anim", "mix", "pose", "solve", "deform", "derive", "probe", "baked")
NEEDS_COMPILER = ("dna.cpp", "dna_report.cpp", "rig_compile.cpp")
# Instruction sets from best to plainest, and what compilers say of them.
ISAS = (
    ("avx512", "defined(__AVX512F__) && defined(__AVX512CD__) && defined(__AVX512DQ__) && "
     "defined(__AVX512BW__) && defined(__AVX512VL__) && defined(__FMA__) && defined(__F16C__)"),
    ("avx2", "defined(__AVX2__) && defined(__FMA__) && defined(__F16C__)"),
    ("sse2", "defined(__SSE2__)"),
    ("neon", "defined(__aarch64__)"),
)
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"')
SYSTEM = re.compile(r"^\s*#\s*include\s+<(mien[\w/]*\.h)>")
MACRO = re.compile(r"^\s*#\s*define\s+(MIEN_\w+)")


def text_of(path):
    return path.read_text().splitlines()


def find(name, folder):
    for base in (ROOT, PUBLIC, folder):
        if (base / name).is_file():
            return (base / name).resolve()
    sys.exit(f"amalgamate.py: {folder} includes {name}, which is nowhere")


def expand(path, seen):
    """The lines of a file, with those of our own that it includes: each file once, without public headers."""
    if path in seen:
        return []
    seen.add(path)
    lines = []
    for line in text_of(path):
        included = INCLUDE.match(line) or SYSTEM.match(line)
        if included:
            other = find(included.group(1), path.parent)
            if PUBLIC not in other.parents:
                lines += expand(other, seen)
        elif line.strip() not in ("#pragma once", "// SPDX-License-Identifier: MIT"):
            lines.append(line)
    return lines


def header():
    lines = ["/* SPDX-License-Identifier: MIT */",
             "/* mien.h and its chapters, for mien_runtime.cpp. Made by integrations/single_file/amalgamate.py. */",
             "#ifndef MIEN_STATIC", "#define MIEN_STATIC", "#endif"]
    seen = set()

    def add(path):
        if path in seen:
            return
        seen.add(path)
        for line in text_of(path):
            included = INCLUDE.match(line)
            if included:
                add(find(included.group(1), path.parent))
            elif line.strip() != "/* SPDX-License-Identifier: MIT */":
                lines.append(line)

    add(PUBLIC / "mien.h")
    return lines


def kernels(seen):
    """One table: of the best instruction set that the compiler may use."""
    # Headers first, outside of what is chosen.
    table = (ROOT / "simd" / "kernel_table.inl").resolve()
    bodies, shared = [], []

    def walk(path):
        if path in seen:
            return
        seen.add(path)
        for line in text_of(path):
            included = INCLUDE.match(line)
            if included:
                other = find(included.group(1), path.parent)
                if other.suffix == ".h":
                    shared.extend(expand(other, seen))
                else:
                    walk(other)
            elif line.strip() not in ("#pragma once", "// SPDX-License-Identifier: MIT"):
                bodies.append(line)

    walk(table)
    lines = ["// The instruction set", ""]
    for number, (isa, condition) in enumerate(ISAS):
        lines += [f"#{'elif' if number else 'if'} !defined(MIEN_SCALAR) && ({condition})",
                  f"#define MIEN_KERNEL_ISA {isa}", f"#define MIEN_KERNEL_{isa.upper()} 1",
                  f"#define MIEN_BUILT_{isa.upper()}"]
    lines += ["#else", "#define MIEN_KERNEL_ISA scalar", "#define MIEN_KERNEL_SCALAR 1",
              "#define MIEN_BUILT_SCALAR", "#endif", "",
              "#if defined(__FAST_MATH__)",
              "#error Mien needs the arithmetic of the standard: compile this file without -ffast-math", "#endif",
              "#if !defined(MIEN_KERNEL_SCALAR) && defined(__has_include)",
              "#if !__has_include(<xsimd/xsimd.hpp>)",
              "#error xsimd is not there: name its folder with -I, or define MIEN_SCALAR to do without",
              "#endif", "#endif", ""]
    return lines + shared + ["#define xsimd mien_xsimd  // apart from that of other files"] + bodies + ["#undef xsimd"]


def source():
    seen = set()
    lines = ["// SPDX-License-Identifier: MIT",
             "// The library that opens baked files. Made by integrations/single_file/amalgamate.py.",
             "#if defined(__clang__)  // constants of headers are now those of a source",
             '#pragma clang diagnostic ignored "-Wunused-const-variable"',
             '#pragma clang diagnostic ignored "-Wunneeded-internal-declaration"', "#endif",
             "#define MIEN_BUILD", "#define MIEN_EXPERIMENTAL", '#include "mien_runtime.h"', ""]
    lines += kernels(seen)
    files = [ROOT / "simd" / "cpu_features.cpp", ROOT / "simd" / "dispatch.cpp"]
    for room in ROOMS:
        files += sorted((ROOT / "runtime" / room).glob("*.cpp"))
    files.append(ROOT / "capi" / "arguments" / "arguments.cpp")
    files += [file for file in sorted((ROOT / "capi").glob("*.cpp")) if file.name not in NEEDS_COMPILER]
    for file in files:
        lines += ["", f"// {file.relative_to(ROOT)}"] + expand(file.resolve(), seen)
    return lines


def main(folder):
    folder.mkdir(parents=True, exist_ok=True)
    for name, lines in (("mien_runtime.h", header()), ("mien_runtime.cpp", source())):
        path = folder / name
        path.write_text("\n".join(lines) + "\n")
        print(f"{path}: {len(lines)} lines, {path.stat().st_size} bytes")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(Path(sys.argv[1]))

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What a header declares, what its map lists and what the library exports are the same names.

Usage: check_exports.py [--nm NM] [--objdump OBJDUMP] LIBRARY...

A library is libmien.so, libmien-author.so, libmien-solve.so, or one of them as a DLL, which objdump reads.
"""
import argparse
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# Of a library: its headers and its map.
HEADERS = {"mien": ["mien.h", "mien/*.h"], "mien_author": ["mien_author.h", "mien_author/*.h"],
           "mien_solve": ["mien_solve.h"]}
MAPS = {"mien": "capi/mien.map", "mien_author": "author/mien_author.map",
        "mien_solve": "solve/mien_solve.map"}


def without_comments(text):
    return re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)


def declared(stem, mark):
    """Functions marked MIEN_API or MIEN_CHECKED; of mien_author.h, MIEN_AUTHOR_..."""
    files = [file for pattern in HEADERS[stem] for file in sorted((ROOT / "capi" / "include").glob(pattern))]
    text = "\n".join(file.read_text(encoding="utf-8") for file in files)
    text = re.sub(r"^[ \t]*#(.*\\\n)*.*$", "", without_comments(text), flags=re.MULTILINE)
    names = re.findall(rf"\b{mark}_(?:API|CHECKED)\b[^;()]*?\b(\w+)\s*\(", text)
    if not names or len(names) != len(re.findall(r"\bMIEN_(?:\w+_)?(?:API|CHECKED)\b", text)):
        sys.exit(f"{stem}.h: a {mark}_API that is no function, or that this check cannot read")
    return names


def listed(file):
    """Names under `global:`, and the name of the version itself."""
    version, body = re.fullmatch(
        r"\s*(\w+)\s*\{\s*global:(.*?)local:\s*\*;\s*\};\s*",
        without_comments(file.read_text(encoding="utf-8")), re.DOTALL
    ).groups()
    names = [name.strip() for name in body.split(";") if name.strip()]
    for name in names:
        if not re.fullmatch(r"\w+", name):
            sys.exit(f"{file.name}: {name!r}: each name is written out, without patterns")
    return version, names


def exported(nm, library):
    """(name, type letter) of each defined dynamic symbol."""
    output = subprocess.run(
        [nm, "--dynamic", "--defined-only", "--format=posix", library],
        check=True, capture_output=True, text=True,
    ).stdout
    rows = [line.split() for line in output.splitlines()]
    return [(re.sub(r"@.*", "", row[0]), row[1]) for row in rows]


def exported_by_dll(objdump, library):
    """The same for a DLL, whose table has names only."""
    output = subprocess.run([objdump, "-p", library], check=True, capture_output=True, text=True).stdout
    table = re.search(r"^\[Ordinal/Name Pointer\] Table.*\n((?:\s*\[.*\n)+)", output, re.MULTILINE)
    return [(line.split()[-1], "T") for line in table.group(1).splitlines()] if table else []


def problems_of(nm, objdump, library):
    name = Path(library).name
    stem = "mien_author" if "mien-author" in name else "mien_solve" if "mien-solve" in name else "mien"
    version_script = ROOT / MAPS[stem]
    in_header = declared(stem, stem.upper())
    version, in_script = listed(version_script)

    for where, names in ((f"{stem}.h", in_header), (version_script.name, in_script)):
        for name in sorted({name for name in names if names.count(name) > 1}):
            yield f"{where} has {name} more than once"
    in_library = set()
    is_dll = library.endswith(".dll")
    for name, kind in exported_by_dll(objdump, library) if is_dll else exported(nm, library):
        if name == version and kind == "A":
            continue
        in_library.add(name)
        if kind != "T":
            yield f"{library} exports {name}, which is no plain function (nm: {kind})"

    sets = {f"{stem}.h": in_header, version_script.name: in_script, library: in_library}
    for where, names in sets.items():
        for other, wanted in sets.items():
            yield from (f"{where} lacks {name} of {other}"
                        for name in sorted(set(wanted) - set(names)))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("libraries", nargs="+", metavar="LIBRARY")
    parser.add_argument("--nm", default="nm")
    parser.add_argument("--objdump", default="objdump")
    args = parser.parse_args()
    problems = [problem for library in args.libraries
                for problem in problems_of(args.nm, args.objdump, library)]
    print("\n".join(problems) if problems else "the same names in headers, maps and libraries")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())

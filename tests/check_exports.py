#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What mien.h declares, what mien.map lists and what libmien.so exports are the same names.

Usage: check_exports.py [--nm NM] LIBRARY
"""
import argparse
import re
import subprocess
import sys
from pathlib import Path

CAPI = Path(__file__).resolve().parent.parent / "capi"


def without_comments(text):
    return re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)


def declared(header):
    """Functions marked MIEN_API or MIEN_CHECKED."""
    text = re.sub(r"^[ \t]*#(.*\\\n)*.*$", "", without_comments(header), flags=re.MULTILINE)
    names = re.findall(r"\bMIEN_(?:API|CHECKED)\b[^;()]*?\b(\w+)\s*\(", text)
    if len(names) != len(re.findall(r"\bMIEN_(?:API|CHECKED)\b", text)):
        sys.exit("mien.h: a MIEN_API that is no function, or that this check cannot read")
    return names


def listed(version_script):
    """Names under `global:`, and the name of the version itself."""
    version, body = re.fullmatch(
        r"\s*(\w+)\s*\{\s*global:(.*?)local:\s*\*;\s*\};\s*", without_comments(version_script), re.DOTALL
    ).groups()
    names = [name.strip() for name in body.split(";") if name.strip()]
    for name in names:
        if not re.fullmatch(r"\w+", name):
            sys.exit(f"mien.map: {name!r}: each name is written out, without patterns")
    return version, names


def exported(nm, library):
    """(name, type letter) of each defined dynamic symbol."""
    output = subprocess.run(
        [nm, "--dynamic", "--defined-only", "--format=posix", library],
        check=True, capture_output=True, text=True,
    ).stdout
    rows = [line.split() for line in output.splitlines()]
    return [(re.sub(r"@.*", "", row[0]), row[1]) for row in rows]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("library")
    parser.add_argument("--nm", default="nm")
    args = parser.parse_args()

    header = declared((CAPI / "mien.h").read_text(encoding="utf-8"))
    version, script = listed((CAPI / "mien.map").read_text(encoding="utf-8"))
    symbols = exported(args.nm, args.library)

    problems = []
    for where, names in (("mien.h", header), ("mien.map", script)):
        for name in sorted({name for name in names if names.count(name) > 1}):
            problems.append(f"{where} has {name} more than once")
    library = set()
    for name, kind in symbols:
        if name == version and kind == "A":
            continue
        library.add(name)
        if kind != "T":
            problems.append(f"the library exports {name}, which is no plain function (nm: {kind})")

    def compare(left, right, text):
        problems.extend(text.format(name) for name in sorted(set(left) - set(right)))

    compare(header, script, "mien.map lacks {} of mien.h")
    compare(script, header, "mien.map has {}, which mien.h does not declare")
    compare(header, library, "the library does not export {} of mien.h")
    compare(library, header, "the library exports {}, which mien.h does not declare")

    print("\n".join(problems) if problems else f"{len(header)} names, in header, list and library")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())

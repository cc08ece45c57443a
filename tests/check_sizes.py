#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The sizes of libraries in docs/architecture.md, "The libraries", are those of the libraries that were built.

    check_sizes.py [--self-test] LIBRARY ...         of a full build
    check_sizes.py [--self-test] --slim LIBRARY ...

Libraries are stripped first. A size may be off by 5 %, so that not every commit changes the document.
"""
import re
import subprocess
import sys
import tempfile
from pathlib import Path

DOCUMENT = Path(__file__).resolve().parent.parent / "docs" / "architecture.md"
TOLERANCE = 0.05


def documented(text):
    """{what the first column says: KB}"""
    rows = re.findall(r"^\| `(lib[\w-]+\.so)`(, slim)? \| (\d+) \|$", text, re.MULTILINE)
    sizes = {name + slim: int(size) for name, slim, size in rows}
    if len(sizes) != len(rows) or not sizes:
        sys.exit(f"check_sizes.py: {DOCUMENT.name} has no table of sizes, or a library twice")
    return sizes


def stripped_size(library):
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "stripped"
        subprocess.run(["strip", "-o", out, library], check=True)
        return out.stat().st_size


def problem(name, size, sizes):
    if name not in sizes:
        return f"{DOCUMENT.name} does not have {name}: {size / 1000:.0f} KB"
    if abs(size / 1000 - sizes[name]) > TOLERANCE * sizes[name]:
        return f"{name} has {size / 1000:.0f} KB, but {DOCUMENT.name} says {sizes[name]} KB"
    return None


def self_test():
    sizes = documented("| `libmien.so` | 1000 |\n| `libmien.so`, slim | 500 |\n| other | 3 |\n")
    assert sizes == {"libmien.so": 1000, "libmien.so, slim": 500}
    assert problem("libmien.so", 1049000, sizes) is None
    assert problem("libmien.so", 951000, sizes) is None
    assert "1051 KB" in problem("libmien.so", 1051000, sizes)
    assert "500 KB" in problem("libmien.so, slim", 470000, sizes)
    assert "does not have" in problem("libother.so", 1, sizes)


def main(arguments):
    if "--self-test" in arguments:
        arguments.remove("--self-test")
        self_test()
    suffix = ""
    if "--slim" in arguments:
        arguments.remove("--slim")
        suffix = ", slim"
    if not arguments:
        sys.exit(__doc__)
    sizes = documented(DOCUMENT.read_text(encoding="utf-8"))
    found = [problem(re.sub(r"\.so.*", ".so", Path(library).name) + suffix, stripped_size(library), sizes)
             for library in arguments]
    if any(found):
        sys.exit("\n".join(filter(None, found)))


if __name__ == "__main__":
    main(sys.argv[1:])

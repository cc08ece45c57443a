#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Puts together the UPM package: the package's own files, the C# layer, and libmien and libmien-author if they are given.

    make_package.py OUT [LIBRARY...]
"""
import pathlib
import shutil
import sys

HERE = pathlib.Path(__file__).resolve().parent


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    out = pathlib.Path(sys.argv[1])
    if out.exists():
        sys.exit(f"{out} exists: remove it first")
    shutil.copytree(HERE / "package", out)
    shutil.copytree(HERE.parent / "csharp" / "Mien", out / "Runtime" / "Mien")
    shutil.copy(HERE.parent.parent / "LICENSE", out / "LICENSE")
    shutil.copy(HERE / "README.md", out / "README.md")
    plugins = out / "Runtime" / "Plugins"
    for library in map(pathlib.Path, sys.argv[2:]):
        plugins.mkdir(exist_ok=True)
        shutil.copy(library.resolve(), plugins / library.name)


if __name__ == "__main__":
    main()

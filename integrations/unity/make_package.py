#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Puts together the UPM package: the package's own files, the C# layer, and libmien if it is given.

    make_package.py OUT [LIBRARY]
"""
import pathlib
import shutil
import sys

HERE = pathlib.Path(__file__).resolve().parent


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    out = pathlib.Path(sys.argv[1])
    if out.exists():
        sys.exit(f"{out} exists: remove it first")
    shutil.copytree(HERE / "package", out)
    shutil.copytree(HERE.parent / "csharp" / "Mien", out / "Runtime" / "Mien")
    shutil.copy(HERE.parent.parent / "LICENSE", out / "LICENSE")
    shutil.copy(HERE / "README.md", out / "README.md")
    if len(sys.argv) == 3:
        plugins = out / "Runtime" / "Plugins"
        plugins.mkdir()
        shutil.copy(pathlib.Path(sys.argv[2]).resolve(), plugins / pathlib.Path(sys.argv[2]).name)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Mien.csproj, which only dotnet can build, is well-formed and names the files and the version that are there."""
import json
import pathlib
import re
import sys
import xml.etree.ElementTree as ElementTree

HERE = pathlib.Path(__file__).resolve().parent.parent
ROOT = HERE.parent.parent


def main():
    project = ElementTree.parse(HERE / "Mien.csproj").getroot()
    files = {file for item in project.iter("Compile") for file in HERE.glob(item.get("Include"))}
    header = (ROOT / "capi/include/mien/base.h").read_text()
    version = ".".join(re.search(rf"#define MIEN_VERSION_{part} +(\d+)", header)[1]
                       for part in ("MAJOR", "MINOR", "PATCH"))
    wrong = []
    if not files or files != set((HERE / "Mien").rglob("*.cs")):
        wrong.append(f"it compiles {sorted(file.name for file in files)}")
    if project.findtext(".//Version") != version:
        wrong.append(f"its version is {project.findtext('.//Version')}, not {version}")
    if project.findtext(".//TargetFramework") != "netstandard2.0" or project.findtext(".//AllowUnsafeBlocks") != "true":
        wrong.append("it is not for netstandard2.0 with unsafe code")
    package = json.loads((ROOT / "integrations/unity/package/package.json").read_text())
    if package["version"] != version:
        wrong.append(f"the package for Unity has version {package['version']}")
    for text in wrong:
        print("Mien.csproj:", text)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Mien.csproj, which only dotnet can build, is well-formed and names the files and the version that are there. With mcs
and mono, what it describes is compiled with its own settings, and uses only what surface/netstandard20.txt lists.

    project_test.py [MCS MONO]
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

HERE = pathlib.Path(__file__).resolve().parent.parent
ROOT = HERE.parent.parent


def files_of(project):
    return {file for item in project.iter("Compile") for file in HERE.glob(item.get("Include"))}


def check_project(project):
    header = (ROOT / "capi/include/mien/base.h").read_text()
    version = ".".join(re.search(rf"#define MIEN_VERSION_{part} +(\d+)", header)[1]
                       for part in ("MAJOR", "MINOR", "PATCH"))
    files = files_of(project)
    wrong = []
    if not files or files != set((HERE / "Mien").rglob("*.cs")):
        wrong.append(f"it compiles {sorted(file.name for file in files)}")
    if project.findtext(".//Version") != version:
        wrong.append(f"its version is {project.findtext('.//Version')}, not {version}")
    if project.findtext(".//TargetFramework") != "netstandard2.0":
        wrong.append("it is not for netstandard2.0")
    package = json.loads((ROOT / "integrations/unity/package/package.json").read_text())
    if package["version"] != version:
        wrong.append(f"the package for Unity has version {package['version']}")
    return wrong


def check_surface(project, mcs, mono):
    """Compiles as the project says. mcs knows C# up to 7.2, so it is a little stricter than a project with 7.3."""
    assert project.findtext(".//LangVersion") == "7.3" and project.findtext(".//GenerateDocumentationFile") == "true"
    ignored = ";".join(item.text for item in project.iter("NoWarn")).replace("CS", "")
    unsafe = ["-unsafe"] if project.findtext(".//AllowUnsafeBlocks") == "true" else []
    with tempfile.TemporaryDirectory() as name:
        library, program = pathlib.Path(name) / "Mien.dll", pathlib.Path(name) / "ListSurface.exe"
        # 219 is mcs's own: it warns of variables that only a fixed statement uses.
        subprocess.run([mcs, "-nologo", "-langversion:7.2", "-target:library", "-warnaserror", f"-nowarn:{ignored};219", *unsafe,
                        f"-doc:{library.with_suffix('.xml')}", f"-out:{library}", *sorted(files_of(project))], check=True)
        subprocess.run([mcs, "-nologo", "-warnaserror", f"-out:{program}", HERE / "surface" / "ListSurface.cs"], check=True)
        used = set(subprocess.run([mono, program, library], check=True, stdout=subprocess.PIPE, text=True).stdout.splitlines())
    known = {line for line in (HERE / "surface" / "netstandard20.txt").read_text().splitlines() if not line.startswith("#")}
    assert len(used) > 50, "nothing was listed"
    wrong = [f"it uses {line}: if .NET Standard 2.0 has it, add it to surface/netstandard20.txt" for line in sorted(used - known)]
    return wrong + [f"it no longer uses {line}: remove it from surface/netstandard20.txt" for line in sorted(known - used)]


def main(mcs="", mono=""):
    project = ElementTree.parse(HERE / "Mien.csproj").getroot()
    wrong = check_project(project)
    if mcs and mono:
        wrong += check_surface(project, mcs, mono)
    else:
        print("NOT TESTED: what Mien.csproj uses of .NET; there is no mcs and mono")
    for text in wrong:
        print("Mien.csproj:", text)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))

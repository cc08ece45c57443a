#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The descriptor of the plugin for Unreal Engine names the modules that are there, with what the header tool asks of them;
with mcs and mono, the Build.cs files run, for an installation of BUILD.

    plugin_test.py BUILD [MCS MONO]
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
PLUGIN = HERE.parent / "Mien"
ROOT = HERE.parent.parent.parent


def check_descriptor():
    descriptor = json.loads((PLUGIN / "Mien.uplugin").read_text())
    header = (ROOT / "capi/include/mien/base.h").read_text()
    version = ".".join(re.search(rf"#define MIEN_VERSION_{part} +(\d+)", header)[1]
                       for part in ("MAJOR", "MINOR", "PATCH"))
    assert descriptor["VersionName"] == version, descriptor["VersionName"]
    types = {module["Name"]: module["Type"] for module in descriptor["Modules"]}
    assert types == {"MienFace": "Runtime", "MienFaceEditor": "UncookedOnly"}, types
    assert set(types) == {folder.name for folder in (PLUGIN / "Source").iterdir()}
    for name in types:
        folder = PLUGIN / "Source" / name
        assert f"class {name} : ModuleRules" in (folder / f"{name}.Build.cs").read_text(), name
        modules = [file for file in folder.rglob("*.cpp") if f"IMPLEMENT_MODULE(FDefaultModuleImpl, {name})" in file.read_text()]
        assert len(modules) == 1, f"{name}: {modules}"
        for file in folder.rglob("*.h"):
            check_header(file, f"{name.upper()}_API")


def check_header(file, export):
    """What the header tool wants: the generated header last, and GENERATED_BODY() in each class that it reads."""
    text = file.read_text()
    includes = re.findall(r'#include ["<](.+)[">]', text)
    assert includes[-1] == f"{file.stem}.generated.h", file
    declared = re.findall(r"^U(?:CLASS|STRUCT)\(.*\)\n(?:class|struct) (\w+) [AUF](\w+) : public \w+ \{\n  GENERATED_BODY\(\)",
                          text, re.MULTILINE)
    assert declared == [(export, file.stem)], f"{file}: {declared}"


def run_rules(build, mcs, mono):
    with tempfile.TemporaryDirectory() as name:
        plugin = pathlib.Path(name) / "Mien"
        shutil.copytree(PLUGIN, plugin)
        for component in ("mien_runtime", "mien_development"):
            subprocess.run(["cmake", "--install", build, "--prefix", plugin / "ThirdParty" / "mien", "--component", component],
                           check=True, stdout=subprocess.DEVNULL)
        program = pathlib.Path(name) / "rules.exe"
        subprocess.run([mcs, "-nologo", "-warnaserror", f"-out:{program}", HERE / "stubs" / "UnrealBuildTool.cs",
                        *sorted(plugin.rglob("*.Build.cs"))], check=True)
        subprocess.run([mono, "--debug", program, plugin], check=True)


def main(build, mcs="", mono=""):
    check_descriptor()
    if mcs and mono:
        run_rules(build, mcs, mono)
    else:
        print("NOT TESTED: the Build.cs files; there is no mcs and mono")


if __name__ == "__main__":
    main(*sys.argv[1:])

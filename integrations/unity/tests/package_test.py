#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The package for Unity, as make_package.py puts it together: its assemblies have what they refer to, and editor code and
tests are not in games.

    package_test.py LIBMIEN
"""
import json
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
UNITY = {"UnityEngine.TestRunner", "UnityEditor.TestRunner"}


def check(package, library):
    description = json.loads((package / "package.json").read_text())
    assert {"name", "version", "displayName", "unity"} <= set(description), description
    assemblies = {}
    for file in package.rglob("*.asmdef"):
        assembly = json.loads(file.read_text())
        assert file.stem == assembly["name"] and assembly["name"] not in assemblies, file
        assemblies[assembly["name"]] = (file.parent, assembly)
    assert set(assemblies) == {"Mien", "Mien.Editor", "Mien.Tests"}
    used = set()
    for name, (folder, assembly) in assemblies.items():
        assert set(assembly.get("references", [])) <= set(assemblies) | UNITY, name
        sources = list(folder.rglob("*.cs"))
        assert sources, name
        used.update(sources)
        if name != "Mien":
            assert assembly["includePlatforms"] == ["Editor"] and "Mien" in assembly["references"], name
    assert used == set(package.rglob("*.cs")), "a source of no assembly"
    runtime, assembly = assemblies["Mien"]
    assert assembly["allowUnsafeCode"] and not assembly.get("includePlatforms")
    assert not any("UnityEditor" in source.read_text() for source in runtime.rglob("*.cs"))
    tests = assemblies["Mien.Tests"][1]
    assert "UNITY_INCLUDE_TESTS" in tests["defineConstraints"] and "nunit.framework.dll" in tests["precompiledReferences"]
    assert "[Test]" in (package / "Tests/Editor/MienFaceTests.cs").read_text()
    assert (package / "Runtime/Plugins" / library.name).read_bytes() == library.read_bytes()
    assert (package / "Runtime/Mien/Native.cs").exists() and (package / "LICENSE").exists()


def main(library):
    with tempfile.TemporaryDirectory() as name:
        package = pathlib.Path(name) / "com.mien.face"
        subprocess.run([sys.executable, HERE.parent / "make_package.py", package, library], check=True)
        check(package, pathlib.Path(library))


if __name__ == "__main__":
    main(*sys.argv[1:])

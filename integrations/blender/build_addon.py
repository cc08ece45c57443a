#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Packs the Blender add-on, with the Python binding and the libraries in it, in both forms:

    mien_blender-VERSION-PLATFORM.zip            add-on, for Blender 3.4 and later
    mien_blender-VERSION-PLATFORM-extension.zip  extension, for Blender 4.2 and later

    build_addon.py [--library FILE] [--output DIRECTORY]

libmien is --library, or the file named in MIEN_LIBRARY, or that of build/release; the other libraries lie beside it. Needs
the standard library of Python 3.9 only.
"""
import argparse
import io
import json
import re
import sys
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(HERE.parent / "python"))
import build_wheel  # noqa: E402

NAME = "mien_blender"
RUNTIME = "mien_blender_runtime"  # extensions share one place for packages: this name is nobody else's
PLATFORMS = {"linux": "linux-x64", "win": "windows-x64", "macosx": "macos-arm64"}

MANIFEST = """\
schema_version = "1.0.0"
id = "{id}"
version = "{version}"
name = "Mien: facial rigs"
tagline = "Facial rigs in DNA files, live"
maintainer = "The Mien authors"
type = "add-on"
tags = ["Rigging", "Animation", "Import-Export"]
blender_version_min = "4.2.0"
license = ["SPDX:MIT"]
platforms = ["{platform}"]
wheels = ["./wheels/{wheel}"]

[permissions]
files = "Read rig files, write baked files"
"""


def expression_sets():
    """The sets of `mien export --bake`, from the table of the program: names -> rows of name and ways."""
    text = (ROOT / "integrations/program/gltf/expression_tables.h").read_text(encoding="utf-8")
    text = re.sub(r"//[^\n]*", "", text)
    strings = r'"((?:[^"\\]|\\.)*)"'
    arkit = re.search(r"kArkitNames\[\] = \{(.*?)\};", text, re.DOTALL).group(1)
    sets = {"arkit": [[name, f"{name} 1"] for name in re.findall(strings, arkit)]}
    names = dict((variable, name) for name, variable in re.findall(rf"table_of\({strings}, (k\w+)\)", text))
    for variable, rows in re.findall(r"ExpressionRow (k\w+)\[\] = \{(.*?)\n\};", text, re.DOTALL):
        found = []
        for row in re.findall(rf"\{{((?:\s*{strings}\s*,?)+)\}}", rows):
            # The name, then one string, which may be written in several parts.
            name, _, ways = row[0].partition(",")
            found.append([re.search(strings, name).group(1), "".join(re.findall(strings, ways))])
        sets[names[variable]] = found
    return sets


def runtime_files(libraries):
    """(path, bytes) of the binding and the libraries."""
    sources = sorted((HERE.parent / "python/mien").glob("*.py"))
    return [(file.name, file.read_bytes()) for file in sources if file.name != "bench.py"] + \
        [(name, file.read_bytes()) for name, file in libraries]


def addon_files():
    files = [(str(file.relative_to(HERE / NAME)), file.read_bytes()) for file in sorted((HERE / NAME).rglob("*.py"))
             if "_mien" not in file.parts]
    tables = json.dumps(expression_sets(), indent=0)
    return files + [("expression_sets.json", tables.encode()), ("LICENSE", (ROOT / "LICENSE").read_bytes())]


def pack(files):
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for path, data in files:
            entry = zipfile.ZipInfo(path, build_wheel.DATE)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o100644 << 16
            archive.writestr(entry, data)
    return out.getvalue()


def wheel(libraries, tag):
    """A wheel of the binding under its private name."""
    version = build_wheel.version()
    info = f"{RUNTIME}-{version}.dist-info"
    files = [(f"{RUNTIME}/{path}", data) for path, data in runtime_files(libraries)]
    files.append((f"{info}/METADATA", f"Metadata-Version: 2.1\nName: {RUNTIME}\nVersion: {version}\n"
                  "Summary: Mien for its Blender add-on\nLicense: MIT\n".encode()))
    files.append((f"{info}/WHEEL", f"Wheel-Version: 1.0\nGenerator: mien\nRoot-Is-Purelib: false\n"
                  f"Tag: py3-none-{tag}\n".encode()))
    record = "".join(f"{path},,\n" for path, _ in files) + f"{info}/RECORD,,\n"
    return f"{RUNTIME}-{version}-py3-none-{tag}.whl", pack([*files, (f"{info}/RECORD", record.encode())])


def build(output, library=None):
    """Writes both files and returns their paths."""
    version, libraries = build_wheel.version(), build_wheel.library_files(library)
    tag = build_wheel.platform_tag([file for _, file in libraries])
    platform = next((name for start, name in PLATFORMS.items() if tag.startswith(start)), "linux-x64")
    if tag.endswith("aarch64"):
        platform = "linux-arm64"
    files = addon_files()
    output = Path(output)
    output.mkdir(parents=True, exist_ok=True)
    addon = output / f"{NAME}-{version}-{platform}.zip"
    addon.write_bytes(pack([(f"{NAME}/{path}", data) for path, data in files] +
                           [(f"{NAME}/_mien/{path}", data) for path, data in runtime_files(libraries)]))
    name, data = wheel(libraries, tag)
    extension = output / f"{NAME}-{version}-{platform}-extension.zip"
    manifest = MANIFEST.format(id=NAME, version=version, platform=platform, wheel=name)
    extension.write_bytes(pack(files + [("blender_manifest.toml", manifest.encode()), (f"wheels/{name}", data)]))
    return addon, extension


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--library", help="libmien to put into it, with the other libraries beside it")
    parser.add_argument("--output", default=".", help="directory; default: this one")
    args = parser.parse_args()
    for file in build(args.output, args.library):
        print(f"{file}: {file.stat().st_size} bytes")


if __name__ == "__main__":
    main()

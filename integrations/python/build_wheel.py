#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes the wheel: the package, and the libraries beside it, so that no variable has to tell where
they are. Needs the standard library of Python 3.9 only, and no network.

    build_wheel.py [--library FILE] [--platform TAG] [--output DIRECTORY]

It is also the build backend that pyproject.toml names (PEP 517). libmien is --library, or the file
named in MIEN_LIBRARY, or that of build/release in the source tree; libmien-author and libmien-solve lie beside it.
"""
import argparse
import base64
import hashlib
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
# A fixed date, so that the same sources give the same bytes: the first that a zip file can hold.
DATE = (1980, 1, 1, 0, 0, 0)


def version():
    text = (HERE / "mien" / "_api.py").read_text(encoding="utf-8")
    return re.search(r'^VERSION = [\'"](.+)[\'"]$', text, re.MULTILINE).group(1)


def project(name):
    """A value of pyproject.toml; Python 3.9 has no reader for it."""
    text = (HERE / "pyproject.toml").read_text(encoding="utf-8")
    return re.search(rf'^{re.escape(name)} = "(.+)"$', text, re.MULTILINE).group(1)


def classifiers():
    text = (HERE / "pyproject.toml").read_text(encoding="utf-8")
    return re.findall(r'"(.+)"', re.search(r"classifiers = \[(.*?)\]", text, re.DOTALL).group(1))


def metadata():
    lines = ["Metadata-Version: 2.1", "Name: mien", f"Version: {version()}",
             f"Summary: {project('description')}", "License: MIT",
             f"Requires-Python: {project('requires-python')}", "Provides-Extra: arrays",
             'Requires-Dist: numpy; extra == "arrays"']
    lines += [f"Classifier: {line}" for line in classifiers()]
    lines += ["Description-Content-Type: text/markdown", ""]
    return "\n".join(lines) + "\n" + (HERE / "README.md").read_text(encoding="utf-8")


def library_files(given=None):
    """(name in the package, file) of all libraries."""
    mien = Path(given or os.environ.get("MIEN_LIBRARY") or ROOT / "build/release/lib/libmien.so")
    files = []
    for stem, found in (("mien", mien), ("mien-author", mien.parent / built_name("mien-author")),
                        ("mien-solve", mien.parent / built_name("mien-solve"))):
        if not found.exists():
            sys.exit(f"no library at {found}: build it (./dev build), or name libmien in "
                     "MIEN_LIBRARY")
        files.append((packaged_name(stem), found.resolve()))
    return files


def built_name(stem):
    return {"win32": f"{stem}.dll", "darwin": f"lib{stem}.dylib"}.get(sys.platform, f"lib{stem}.so")


def packaged_name(stem):
    """The name by which the other libraries ask for libmien."""
    return {"win32": f"{stem}.dll", "darwin": f"lib{stem}.0.dylib"}.get(sys.platform,
                                                                       f"lib{stem}.so.0")


# The first C library with which each version of the C++ library was released: those of the
# manylinux policies (PEP 600).
CXX_NEEDS = [((3, 4, 19), 17), ((3, 4, 22), 24), ((3, 4, 24), 27), ((3, 4, 28), 31),
             ((3, 4, 29), 34), ((3, 4, 30), 35), ((3, 4, 32), 38)]


def platform_tag(libraries):
    """The tag of this platform; on Linux with glibc, the manylinux tag that the libraries' symbols
    allow, so that pip installs them on every system that can run them."""
    plain = re.sub(r"[-.]", "_", sysconfig.get_platform())
    if not plain.startswith("linux_") or not shutil.which("objdump"):
        return plain
    symbols = subprocess.run(["objdump", "-p", *libraries], capture_output=True, text=True).stdout
    c = [int(minor) for minor in re.findall(r"\bGLIBC_2\.(\d+)", symbols)]
    cxx = max([tuple(map(int, found.split("."))) for found in
               re.findall(r"\bGLIBCXX_([\d.]+)", symbols)], default=(0, 0, 0))
    needed = [minor for version, minor in CXX_NEEDS if version >= cxx]
    if not c or not needed:  # another C library, or a newer C++ library than the table knows
        return plain
    return f"manylinux_2_{max(c + needed[:1])}_{plain[len('linux_'):]}"


def write(directory, library=None, tag=None):
    """Writes the wheel and returns its name."""
    stem = f"mien-{version()}"
    info = f"{stem}.dist-info"
    libraries = library_files(library)
    tag = f"py3-none-{tag or platform_tag([file for _, file in libraries])}"
    files = [(f"mien/{file.name}", file.read_bytes()) for file in sorted((HERE / "mien").iterdir())
             if file.suffix == ".py" or file.name == "py.typed"]
    files += [(f"mien/{name}", file.read_bytes()) for name, file in libraries]
    files.append((f"{info}/METADATA", metadata().encode()))
    files.append((f"{info}/LICENSE", (ROOT / "LICENSE").read_bytes()))
    files.append((f"{info}/WHEEL", (
        "Wheel-Version: 1.0\nGenerator: mien\nRoot-Is-Purelib: false\n"
        f"Tag: {tag}\n").encode()))

    record = []
    name = f"{stem}-{tag}.whl"
    with zipfile.ZipFile(Path(directory) / name, "w", zipfile.ZIP_DEFLATED) as wheel:
        executable = [f"mien/{name}" for name, _ in libraries]

        def add(path, data):
            entry = zipfile.ZipInfo(path, DATE)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o100755 if path in executable else 0o100644) << 16
            wheel.writestr(entry, data)

        for path, data in files:
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            record.append(f"{path},sha256={digest},{len(data)}")
            add(path, data)
        record.append(f"{info}/RECORD,,")
        add(f"{info}/RECORD", ("\n".join(record) + "\n").encode())
    return name


# ---- what pip calls ------------------------------------------------------------------------------

def get_requires_for_build_wheel(config_settings=None):
    return []


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    return write(wheel_directory)


def build_sdist(sdist_directory, config_settings=None):
    raise NotImplementedError("the package alone cannot build the library: use the repository")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--library", help="libmien to put into it, with the other libraries beside it")
    parser.add_argument("--platform", help="platform tag; default: that of the libraries")
    parser.add_argument("--output", default=".", help="directory; default: this one")
    args = parser.parse_args()
    Path(args.output).mkdir(parents=True, exist_ok=True)
    print(Path(args.output) / write(args.output, args.library, args.platform))


if __name__ == "__main__":
    main()

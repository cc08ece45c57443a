# SPDX-License-Identifier: MIT
"""What the generators of all languages share: the data, types behind aliases, names, writing and checking."""
import json
import re
import sys
from pathlib import Path


def load():
    """The interface as data; README.md describes it."""
    return json.loads((Path(__file__).resolve().parent / "mien_api.json").read_text(encoding="utf-8"))


def plain(kind):
    """A type without its aliases."""
    while kind["kind"] == "alias":
        kind = kind["of"]
    return kind


def short_name(enum, value):
    """Name of a value inside its enum: MIEN_ERROR_LOD -> LOD, MIEN_STORAGE_16 -> _16."""
    name = value["short_name"]
    if enum["name"] == "MienStatusCode":
        name = re.sub(r"^ERROR_", "", name)
    return name if name.isidentifier() else "_" + name


def type_name(c_name):
    """MienRigInfo -> RigInfo; the enum of statuses is Status."""
    return "Status" if c_name == "MienStatusCode" else c_name[len("Mien"):]


def write_or_check(texts):
    """Writes the files, {path: text}; with --check it fails if one of them has another text."""
    for path, text in texts.items():
        if "--check" not in sys.argv[1:]:
            path.write_text(text, encoding="utf-8")
        elif not path.exists() or path.read_text(encoding="utf-8") != text:
            sys.exit(f"{path} is not what mien_api.json says: run ./dev api")

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The headers as data: writes mien_api.json, which the bindings of other languages are made from.

    dump_api.py            write mien_api.json
    dump_api.py --check    fail if it is not what the headers say
    dump_api.py --print    write to the standard output instead

README.md describes the result, and the conventions that the headers keep.
"""
import argparse
import json
import sys
from pathlib import Path

from c_header import HeaderError, Interface, with_included
from conventions import Conventions

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
HEADERS = ROOT / "capi" / "include"
# Library, its header, its linker script. A header knows the types of those before it.
LIBRARIES = (("mien", "mien.h", ROOT / "capi" / "mien.map"),
             ("mien-author", "mien_author.h", ROOT / "author" / "mien_author.map"),
             ("mien-solve", "mien_solve.h", ROOT / "solve" / "mien_solve.map"))
OUTPUT = HERE / "mien_api.json"


def read(change=lambda name, text: text):
    """The interface as data. `change` may edit the text of a header first, for tests."""
    seen = set()
    texts = [(library, name, change(name, text)) for library, header, _ in LIBRARIES
             for name, text in with_included(HEADERS, header, seen)]
    maps = [script.read_text(encoding="utf-8") for _, _, script in LIBRARIES]
    interface = Interface(texts)
    Conventions(interface, maps)
    version = ".".join(str(interface.values[f"MIEN_VERSION_{part}"])
                       for part in ("MAJOR", "MINOR", "PATCH"))
    headers = ", ".join(f"capi/include/{header}" for _, header, _ in LIBRARIES)
    return {
        "made_by": f"integrations/api/dump_api.py from {headers}",
        "version": version, "data_model": "LP64", "libraries": interface.libraries,
        "handles": list(interface.handles.values()), "aliases": list(interface.aliases.values()),
        "callbacks": list(interface.callbacks.values()), "constants": interface.constants,
        "enums": interface.enums, "structs": list(interface.structs.values()),
        "functions": interface.functions,
    }


def dump(data):
    """JSON with a line for each function, struct and other entry, so that a change shows as what it is."""
    def entry(key, value):
        if not isinstance(value, list):
            return f"{json.dumps(key)}: {json.dumps(value, ensure_ascii=False)}"
        lines = ",\n".join("  " + json.dumps(item, ensure_ascii=False, separators=(",", ":")) for item in value)
        return f"{json.dumps(key)}: [\n{lines}\n ]"
    return "{\n" + ",\n".join(" " + entry(key, value) for key, value in data.items()) + "\n}\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--print", action="store_true")
    args = parser.parse_args()

    try:
        text = dump(read())
    except HeaderError as error:
        sys.exit(str(error))
    if args.print:
        sys.stdout.write(text)
    elif not args.check:
        OUTPUT.write_text(text, encoding="utf-8")
    elif not OUTPUT.exists() or OUTPUT.read_text(encoding="utf-8") != text:
        sys.exit("mien_api.json is not what the headers say: run ./dev api")
    else:
        print("mien_api.json is what the headers say")


if __name__ == "__main__":
    main()

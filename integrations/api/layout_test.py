#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Whether a C compiler agrees with every number in mien_api.json: sizes, offsets, constants.

Usage: layout_test.py CC
"""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent


def claims(api):
    """(C expression, what it should be)"""
    for constant in api["constants"]:
        yield f"(uint64_t){constant['name']}", f"{constant['value']}u"
    for enum in api["enums"]:
        for value in enum["values"]:
            yield value["name"], value["value"]
    for struct in api["structs"]:
        name = struct["name"]
        yield f"sizeof({name})", struct["size"]
        yield f"_Alignof({name})", struct["alignment"]
        end = 0
        for field in struct["fields"]:
            yield f"offsetof({name}, {field['name']})", field["offset"]
            yield f"sizeof((({name}*)0)->{field['name']})", field["size"]
            # The header promises structs without holes.
            yield f"/* end of what stands before {name}.{field['name']} */ {end}", field["offset"]
            end = field["offset"] + field["size"]
        yield f"/* end of the last field of {name} */ {end}", struct["size"]


def main():
    api = json.loads((HERE / "mien_api.json").read_text(encoding="utf-8"))
    lines = ["#include <mien.h>"]
    lines += [f'_Static_assert({expression} == {value}, "{expression} is not {value}");'
              for expression, value in claims(api)]
    with tempfile.TemporaryDirectory() as directory:
        source = Path(directory) / "layout.c"
        source.write_text("\n".join(lines) + "\n", encoding="utf-8")
        command = sys.argv[1:] + ["-std=c11", "-DMIEN_EXPERIMENTAL", "-fsyntax-only", f"-I{HERE.parent.parent / 'capi'}"]
        if subprocess.run(command + [source]).returncode:
            sys.exit("mien_api.json has other sizes, offsets or values than the compiler")
    print(f"the compiler agrees with {len(lines) - 1} sizes, offsets and values")


if __name__ == "__main__":
    main()

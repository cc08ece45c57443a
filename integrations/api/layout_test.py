#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Whether a C compiler agrees with every number in mien_api.json: sizes, offsets, constants.

Usage: layout_test.py [--32] CC...    --32: the sizes and offsets of 32-bit machines
"""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent


def claims(api, bits):
    """(C expression, what it should be); `bits` is the end of the keys: "" or "_32"."""
    for constant in api["constants"]:
        yield f"(uint64_t){constant['name']}", f"{constant['value']}u"
    for enum in api["enums"]:
        for value in enum["values"]:
            yield value["name"], value["value"]
    for struct in api["structs"]:
        name = struct["name"]
        yield f"sizeof({name})", struct["size" + bits]
        yield f"_Alignof({name})", struct["alignment" + bits]
        end = 0
        for field in struct["fields"]:
            offset, size = field["offset" + bits], field["size" + bits]
            yield f"offsetof({name}, {field['name']})", offset
            yield f"sizeof((({name}*)0)->{field['name']})", size
            if not bits:  # there the header promises structs without holes
                yield f"/* end of what stands before {name}.{field['name']} */ {end}", offset
            end = offset + size
        if not bits:
            yield f"/* end of the last field of {name} */ {end}", struct["size"]


def main():
    arguments = sys.argv[1:]
    bits = "_32" if arguments[:1] == ["--32"] else ""
    compiler = arguments[1:] if bits else arguments
    api = json.loads((HERE / "mien_api.json").read_text(encoding="utf-8"))
    lines = ["#include <mien_author.h>", "#include <mien_solve.h>"]
    lines += [f'_Static_assert({expression} == {value}, "{expression} is not {value}");'
              for expression, value in claims(api, bits)]
    with tempfile.TemporaryDirectory() as directory:
        source = Path(directory) / "layout.c"
        source.write_text("\n".join(lines) + "\n", encoding="utf-8")
        command = compiler + ["-std=c11", "-DMIEN_EXPERIMENTAL", "-DMIEN_STATIC", "-ffreestanding",
                              "-fsyntax-only", f"-I{HERE.parent.parent / 'capi' / 'include'}"]
        if subprocess.run(command + [source]).returncode:
            sys.exit("mien_api.json has other sizes, offsets or values than the compiler")
    print(f"the compiler agrees with {len(lines) - 2} sizes, offsets and values")


if __name__ == "__main__":
    main()

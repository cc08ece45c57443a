#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Lists the records of a golden file; read() returns them. README.md describes the format.

    read_golden.py NAME.golden.bin
"""
import struct
import sys
from array import array


def read(path):
    data = open(path, "rb").read()
    assert data[:8] == b"RIGGOLD1", "not a golden file"
    (count,) = struct.unpack_from("<I", data, 8)
    pos, out = 12, {}
    for _ in range(count):
        (n,) = struct.unpack_from("<H", data, pos)
        name = data[pos + 2 : pos + 2 + n].decode("ascii")
        pos += 2 + n
        kind, rank = data[pos], data[pos + 1]
        dims = struct.unpack_from("<%dI" % rank, data, pos + 2)
        pos += 2 + 4 * rank
        total = 1
        for d in dims:
            total *= d
        size = (4, 2, 4, 1)[kind]
        chunk = data[pos : pos + total * size]
        pos += total * size
        if kind == 3:
            value = chunk.decode("utf-8")
        else:
            value = array({0: "f", 1: "H", 2: "I"}[kind])
            value.frombytes(chunk)
            if sys.byteorder == "big":
                value.byteswap()
            value = value.tolist()
        out[name] = (dims, value)
    assert pos == len(data)
    return out


if __name__ == "__main__":
    for name, (dims, value) in read(sys.argv[1]).items():
        if isinstance(value, str):
            print("%-22s %s" % (name, value))
        else:
            nz = sum(1 for x in value if x != 0)
            big = max((abs(x) for x in value), default=0)
            print("%-22s %-14s nonzero %6.1f%%  max %.6g" % (name, list(dims), 100.0 * nz / max(1, len(value)), big))

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The kept inputs of the fuzzers: for each a file tests/fuzz/corpus/NAME.xz.

    corpus.py unpack FOLDER          writes the inputs of each fuzzer into FOLDER/NAME
    corpus.py replay NAME COMMAND    runs COMMAND on those of one fuzzer

A packed file is an LZMA container, as xz makes, of inputs in the order of their bytes, each behind its
size (u32, little-endian). They are generated data, made by the fuzzers from files of their own.
"""
import hashlib
import lzma
import pathlib
import struct
import subprocess
import sys
import tempfile

FOLDER = pathlib.Path(__file__).resolve().parent / "corpus"
LARGEST = 5 << 20  # bytes, of all packed files


def unpack(name, into):
    into.mkdir(parents=True, exist_ok=True)
    packed = FOLDER / f"{name}.xz"
    if not packed.exists():
        return 0
    data = lzma.decompress(packed.read_bytes())
    at = count = 0
    while at < len(data):
        (size,) = struct.unpack_from("<I", data, at)
        entry = data[at + 4 : at + 4 + size]
        (into / hashlib.sha1(entry).hexdigest()).write_bytes(entry)
        at += 4 + size
        count += 1
    return count


def pack(name, folder):
    """Bytes of the packed file."""
    entries = sorted(path.read_bytes() for path in folder.iterdir())
    data = b"".join(struct.pack("<I", len(entry)) + entry for entry in entries)
    packed = lzma.compress(data, preset=9 | lzma.PRESET_EXTREME)
    FOLDER.mkdir(exist_ok=True)
    (FOLDER / f"{name}.xz").write_bytes(packed)
    return len(packed)


def replay(name, command):
    total = sum(path.stat().st_size for path in FOLDER.glob("*.xz"))
    if total > LARGEST:
        sys.exit(f"{FOLDER} has {total} bytes, more than {LARGEST}")
    with tempfile.TemporaryDirectory() as folder:
        if not unpack(name, pathlib.Path(folder)):
            sys.exit(f"no inputs for {name} in {FOLDER}")
        result = subprocess.run([*command, folder], check=False, stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, text=True, errors="replace")
    print(result.stdout[-3000:])
    if result.returncode:
        sys.exit(f"{name}: the last input above broke a promise; corpus.py unpack writes it to a file")


def main():
    if len(sys.argv) >= 4 and sys.argv[1] == "replay":
        replay(sys.argv[2], sys.argv[3:])
    elif len(sys.argv) == 3 and sys.argv[1] == "unpack":
        for path in sorted(FOLDER.glob("*.xz")):
            count = unpack(path.stem, pathlib.Path(sys.argv[2]) / path.stem)
            print(f"{path.stem}: {count} inputs")
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()

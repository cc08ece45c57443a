#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`mien extract`: DNA files inside other files, and commands that take such files.

    extract_test.py path/to/mien [unittest options]      (or MIEN_BIN=path/to/mien)

The files around the DNA are made here: the tag of an Unreal package, bytes that look like nothing, payloads.
"""
import json
import os
import random
import resource
import struct
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "tests", "support"))
from program import FILE, INVALID, ProgramTest, main, make, make_folder, path, read, write  # noqa: E402

PACKAGE = b"\xc1\x83\x2a\x9e" + bytes(range(1, 60))
NOISE = random.Random(5).randbytes(5000)


def setUpModule():
    make_folder()
    for preset in ("tiny", "small"):
        make("gen", "-o", path(preset + ".dna"), "--preset", preset)
    for version in ("2.1", "2.2", "2.5"):
        make("convert", path("tiny.dna"), "-o", path("v%s.dna" % version), "--version", version)


def compressed(method):
    """A payload as Unreal stores compressed bulk data: magic, CRC-32, method, and the rest of its header."""
    return b"\xb7ucb" + struct.pack(">IB", 0x12345678, method) + bytes(55) + NOISE[:400]


class Extract(ProgramTest):
    def streams(self, name):
        return self.json("extract", path(name), "--json")["streams"]

    def test_a_stream_at_any_offset(self):
        for version in ("2.1", "2.2", "2.5"):
            dna = read("v%s.dna" % version)
            # Near the ends of the blocks that are read, too.
            for offset in (0, 1, 63, 4096, (1 << 20) - 20, (1 << 20) - 16, (1 << 20) - 3, 1 << 20):
                before = (PACKAGE + NOISE * 250)[:offset]
                asset = write("x.uasset", before + dna + NOISE)
                found = self.streams("x.uasset")
                self.assertEqual([(s["offset"], s["size"], s["version"], s["problem"]) for s in found],
                                 [(offset, len(dna), version, None)])
                self.ok("extract", asset, "-o", path("out.dna"))
                self.assertEqual(read("out.dna"), dna)

    def test_two_streams(self):
        tiny, small = read("tiny.dna"), read("small.dna")
        asset = write("two.uasset", PACKAGE + tiny + NOISE + small + NOISE)
        found = self.streams("two.uasset")
        self.assertEqual([(s["offset"], s["size"]) for s in found],
                         [(len(PACKAGE), len(tiny)), (len(PACKAGE) + len(tiny) + len(NOISE), len(small))])
        listed = self.ok("extract", asset, "--list").stdout.decode().splitlines()
        self.assertEqual(len(listed), 3)
        self.fails(INVALID, "extract", asset, "-o", path("no.dna"), says=("2 DNA streams", "--index"))
        self.fails(INVALID, "extract", asset, "-o", path("no.dna"), "--index", "2", says="no stream 2")
        for index, dna in enumerate((tiny, small)):
            self.ok("extract", asset, "-o", path("out.dna"), "--index", str(index))
            self.assertEqual(read("out.dna"), dna)
        self.fails(INVALID, "info", asset, says=("2 DNA streams", "mien extract"))

    def test_a_stream_inside_a_stream_is_not_another(self):
        # An unknown layer that holds a whole DNA file.
        outer, inner = read("tiny.dna"), read("v2.5.dna")
        count = struct.unpack_from(">I", outer, 7)[0]
        head, body = outer[:7], outer[11 + 16 * count:]
        entries = [struct.unpack_from(">4sIII", outer, 11 + 16 * i) for i in range(count)]
        moved = [(code, version, offset + 16, size) for code, version, offset, size in entries]
        moved.append((b"zzzz", 1 << 16, len(outer) + 16, len(inner)))
        index = b"".join(struct.pack(">4sIII", *entry) for entry in moved)
        nested = head + struct.pack(">I", count + 1) + index + body + inner
        write("nested.bin", NOISE + nested)
        self.assertEqual([(s["offset"], s["size"], s["problem"]) for s in self.streams("nested.bin")],
                         [(len(NOISE), len(nested), None)])

    def test_truncated(self):
        dna = read("small.dna")
        for cut in (len(dna) - 1, len(dna) // 2, 300):
            asset = write("cut.uasset", PACKAGE + dna[:cut])
            found = self.streams("cut.uasset")
            self.assertEqual([(s["offset"], s["truncated"]) for s in found], [(len(PACKAGE), True)])
            self.assertTrue(found[0]["problem"])
            self.fails(INVALID, "extract", asset, "-o", path("no.dna"), says=("byte %d" % len(PACKAGE),))
            self.fails(INVALID, "info", asset, says=("byte %d" % len(PACKAGE),))

    def test_what_the_reader_refuses_is_written_with_a_note(self):
        dna = bytearray(read("tiny.dna"))
        count = struct.unpack_from(">I", dna, 7)[0]
        first = 11 + 16 * count
        dna[first:first + 4] = b"\xff\xff\xff\xff"  # the length of the name
        asset = write("broken.uasset", PACKAGE + bytes(dna))
        found = self.streams("broken.uasset")
        self.assertTrue(found[0]["problem"])
        done = self.ok("extract", asset, "-o", path("out.dna"))
        self.assertIn("refuses", done.stderr)
        self.assertEqual(read("out.dna"), bytes(dna))
        self.fails(INVALID, "info", asset, says="broken.uasset")

    def test_none(self):
        for content in (b"", b"D", PACKAGE + NOISE, b"DNA\0\2\0\5" + NOISE, b"DNA\0\2\0\1" + NOISE,
                        b"DNA\0\2\0\5" * 500):
            asset = write("none.uasset", content)
            self.fails(INVALID, "extract", asset, "--list", says="no DNA stream")
            self.fails(INVALID, "extract", asset, "-o", path("no.dna"), says="no DNA stream")

    def test_compressed_payloads_are_named(self):
        asset = write("oodle.uasset", PACKAGE + compressed(3) + compressed(4) + compressed(0))
        self.fails(INVALID, "extract", asset, "--list", says=("1 Oodle", "1 LZ4"))
        self.fails(INVALID, "info", asset, says=("1 Oodle", "not a DNA file"))
        stored = write("stored.uasset", PACKAGE + compressed(3) + compressed(0) + read("tiny.dna"))
        listed = self.json("extract", stored, "--json")
        self.assertEqual(listed["compressed_payloads"], {"oodle": 1, "lz4": 0})
        self.assertEqual(len(listed["streams"]), 1)

    def test_commands_take_such_files(self):
        asset = write("head.uasset", PACKAGE + read("small.dna") + NOISE)
        plain = self.json("info", path("small.dna"), "--json")
        found = self.json("info", asset, "--json")
        for key in ("counts", "layers", "version"):
            self.assertEqual(found[key], plain[key])
        with open(asset, "rb") as file:
            piped = self.json("info", "-", "--json", stdin=file.read())
        self.assertEqual(piped["counts"], plain["counts"])
        self.assertTrue(self.json("validate", asset, "--json")["valid"])
        self.ok("convert", asset, "-o", path("converted.dna"))
        self.assertEqual(read("converted.dna"), read("small.dna"))
        self.ok("bake", asset, "-o", path("a.baked"))
        self.ok("bake", path("small.dna"), "-o", path("b.baked"))
        self.assertEqual(read("a.baked"), read("b.baked"))
        frames = json.dumps({"frames": [{"raw": {}}]}).encode()
        for rig in (asset, path("small.dna")):
            self.ok("eval", rig, "--input", "-", "-o", path("%s.json" % len(rig)), stdin=frames)
        self.ok("export", asset, "-o", path("a.glb"))
        self.ok("export", path("small.dna"), "-o", path("b.glb"))
        self.assertEqual(len(read("a.glb")), len(read("b.glb")))

    def test_pipes(self):
        dna = read("tiny.dna")
        out = self.ok("extract", "-", "-o", "-", stdin=NOISE + dna).stdout
        self.assertEqual(out, dna)

    def test_wrong_use(self):
        asset = write("one.uasset", PACKAGE + read("tiny.dna"))
        self.fails(INVALID, "extract", asset, says="-o")
        self.fails(FILE, "extract", path("nowhere.uasset"), "--list", says="nowhere.uasset")
        self.fails(1, "extract", asset, "-o", path("x.dna"), "--index", "-1", says="--index")
        self.fails(1, "extract", asset, "-o", asset, says="one.uasset")

    def test_hostile_files_take_time_and_memory_of_their_size(self):
        # Signatures everywhere, each with an index that is long and wrong at its end.
        count = 4000
        entries = b"".join(struct.pack(">4sIII", b"abcd", 1, 11 + 16 * count, 0) for _ in range(count - 1))
        one = b"DNA\0\2\0\5" + struct.pack(">I", count) + entries + bytes(16)
        asset = write("hostile.bin", one * 60 + b"DNA\0\2\0\5\0\0\x0f\xa0" * 20000)
        best = None
        for _ in range(3):
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            self.fails(INVALID, "extract", asset, "--list", says="no DNA stream")
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            spent = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
            best = spent if best is None else min(best, spent)
        self.assertLess(best, 10.0)


if __name__ == "__main__":
    main()

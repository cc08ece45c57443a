# SPDX-License-Identifier: MIT
"""Clips: built, opened, read, played, bound to a rig."""
import io
import os
import tempfile
import unittest
from fractions import Fraction

import mien

from support import needs_numpy, numpy, rig_of

NAMES = ["jawOpen", "nobody", "joy"]
ROWS = [[0.0, 1.0, 0.25], [0.5, 1.0, 0.75], [0.75, 1.0, 0.1]]
FLAT = [value for row in ROWS for value in row]
FRAME = mien.TICKS_PER_SECOND // 60


def built(**options):
    return mien.Clip.build(NAMES, FLAT, **options)


def flat(values):
    return [float(value) for value in (values.ravel() if numpy is not None else values)]


def rounded(values):
    return [round(value, 6) for value in flat(values)]


class ClipTest(unittest.TestCase):
    def test_rows_come_back(self):
        clip = built(rate=30)
        self.assertEqual((clip.info.rate_numerator, clip.info.frame_count), (30, 3))
        self.assertEqual(clip.channels, NAMES)
        self.assertEqual(rounded(clip.read()), FLAT)
        self.assertEqual(rounded(clip.read(1, 1)), ROWS[1])
        self.assertEqual(clip.find("joy"), 2)
        clip.verify()
        for again in (mien.Clip.from_bytes(clip.to_bytes()),
                      mien.Clip.from_stream(io.BytesIO(clip.to_bytes()))):
            self.assertEqual(rounded(again.read()), FLAT)
            self.assertEqual(again.to_bytes(), clip.to_bytes())

    @needs_numpy
    def test_arrays_have_shapes(self):
        rows = numpy.random.default_rng(1).random((70, 3)).astype("f")
        clip = mien.Clip.build(NAMES, rows)
        self.assertEqual(clip.read(3, 5).shape, (5, 3))
        self.assertTrue((clip.read() == rows).all())
        wide = numpy.zeros((70, 6))
        wide[:, ::2] = rows
        self.assertTrue((mien.Clip.build(NAMES, wide[:, ::2]).read() == rows).all())
        with self.assertRaises(mien.ArgumentError):
            mien.Clip.build(NAMES, rows.T)

    def test_files(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "take.clip")
            built().save(path)
            for access in mien.FileAccess:
                with mien.Clip.open(path, access) as clip:
                    self.assertEqual(rounded(clip.read()), FLAT)
                    self.assertEqual(clip.info.is_mapped, access == mien.FileAccess.MAP)
            with self.assertRaises(mien.FileError):
                mien.Clip.open(os.path.join(folder, "none"))

    def test_choices(self):
        clip = built(rate=Fraction(30000, 1001), snap=2 ** -9, looping=mien.Looping.WRAP,
                     is_delta=True)
        self.assertEqual((clip.info.rate_numerator, clip.info.rate_denominator), (30000, 1001))
        self.assertEqual(clip.info.snap, 2 ** -9)
        self.assertEqual(clip.info.looping, mien.Looping.WRAP)
        self.assertTrue(clip.info.is_delta)
        self.assertGreater(clip.channel(2).max_error, 0)
        self.assertEqual(built(snap=[0, 0, 2 ** -10]).info.snap, 2 ** -10)

    def test_wrong_takes(self):
        wrong = [(mien.ClipError, dict(values=[float("nan")] * 3)),
                 (mien.ArgumentError, dict(snap=0.1)), (mien.ArgumentError, dict(snap=[0, 0])),
                 (mien.ArgumentError, dict(rate=0)), (mien.ArgumentError, dict(values=[1.0] * 4)),
                 (mien.UnknownNameError, dict(names=["a", "a", "b"])),
                 (mien.ArgumentError, dict(looping=7)),
                 (mien.ArgumentError, dict(events=[(FRAME * 3, "late", 0)]))]
        for error, options in wrong:
            with self.subTest(options), self.assertRaises(error):
                mien.Clip.build(**{**dict(names=NAMES, values=FLAT), **options})
        damaged = bytearray(built().to_bytes())
        damaged[-20] ^= 255
        with self.assertRaises(mien.ClipError):
            mien.Clip.from_bytes(damaged).verify()
        with self.assertRaises(mien.ClipError):
            mien.Clip.from_bytes(b"no clip")
        for call in (lambda: built().read(0, 4), lambda: built().read(4), lambda: built().channel(3)):
            with self.assertRaises(mien.OutOfRangeError):
                call()
        with self.assertRaises(mien.UnknownNameError):
            built().find("none")

    def test_playing(self):
        events = [(0, "start", 1.0), (FRAME * 2, "end", 0.5)]
        clip = built(events=events)
        self.assertEqual(clip.events, [mien.ClipEvent(*event) for event in events])
        player = clip.player()
        clip.close()
        self.assertEqual(rounded(player.sample()), ROWS[0])
        self.assertEqual([event.name for event in player.advance(FRAME // 2)], ["start"])
        self.assertEqual(rounded(player.sample()), [0.25, 1.0, 0.5])
        self.assertEqual([event.name for event in player.advance(FRAME * 9)], ["end"])
        self.assertEqual(player.info.tick, FRAME * 2)
        player.seek(FRAME)
        player.set_speed(Fraction(-1, 2))
        player.advance(FRAME)
        self.assertEqual(rounded(player.sample())[0], 0.25)
        kept = player.sample()
        player.close()
        self.assertEqual(rounded(kept)[0], 0.25)
        with self.assertRaises(mien.ClosedError):
            player.advance(1)

    def test_binding(self):
        rig = mien.Rig(mien.Dna.generate(mien.Preset.HEAD))
        face = rig.instance()
        clip = built()
        binding = clip.bind(rig, [("joy", "mouthSmileLeft", 0.5), ("grief", "jawOpen", 1)])
        self.assertEqual(binding.missing_channels, [1])
        self.assertEqual(binding.missing_entries, 1)
        self.assertEqual(len(binding.controls) + len(binding.extra_controls),
                         rig.count(mien.Kind.RAW_CONTROL))
        player = clip.player(start=FRAME)
        binding.apply(player.sample(), face)
        self.assertEqual(face["jawOpen"], 0.5)
        self.assertEqual(face["mouthSmileLeft"], 0.375)
        with self.assertRaises(mien.ArgumentError):
            binding.apply([1.0], face)

    def test_the_table_of_arkit_binds(self):
        matrix = mien.arkit_matrix()
        self.assertIn(("mouthSmileLeft", "mouthCornerPullL", 1.0), matrix)
        clip = mien.Clip.build(["mouthSmileLeft"], [0.5])
        clip.bind(rig_of(mien.Preset.SMALL), matrix)


if __name__ == "__main__":
    unittest.main()

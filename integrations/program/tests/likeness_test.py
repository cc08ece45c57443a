#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What pictures of the generated head look like, by structural similarity: coarse LODs look like the fine
one, expressions are seen, persons differ, and the pictures of the README are those that the program draws.

    likeness_test.py path/to/mien [unittest options]      (or MIEN_BIN=path/to/mien)
"""
import os
import sys
from pathlib import Path

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "..", "tests", "support"))
from picture import Picture, similarity  # noqa: E402
from program import ProgramTest, main, make, make_folder, path  # noqa: E402

GALLERY = os.path.join(HERE, "..", "render", "gallery")


def setUpModule():
    make_folder()
    for seed in ("0", "3"):
        make("demo-head", "-o", path("head%s.dna" % seed), "--seed", seed, "--textures", path("skin" + seed))


class Measure(ProgramTest):
    ROWS = [[(x * 37 + y * 91) % 200 + 20.0 for x in range(32)] for y in range(24)]

    def changed(self, change):
        return similarity(self.ROWS, [[change(x, y, v) for x, v in enumerate(row)] for y, row in enumerate(self.ROWS)])

    def test_equal_pictures_have_one(self):
        self.assertEqual(self.changed(lambda x, y, v: v), 1)

    def test_it_falls_with_what_is_lost(self):
        brighter = self.changed(lambda x, y, v: v + 10)
        noisy = self.changed(lambda x, y, v: v + (40 if (x + y) % 2 else -40))
        negative = self.changed(lambda x, y, v: 255 - v)
        self.assertGreater(brighter, 0.95)
        self.assertLess(noisy, 0.9)
        self.assertLess(negative, 0)


class Likeness(ProgramTest):
    SIZE = "160"

    def drawn(self, *arguments, head="head0.dna", shrink=1):
        self.ok("render", path(head), "-o", path("out.png"), "--force", "-q", *arguments)
        return Picture(Path(path("out.png")).read_bytes()).luma(shrink)

    def face(self, *arguments, **more):
        return self.drawn("--size", self.SIZE, "--target", "face", *arguments, **more)

    def test_coarse_lods_look_like_the_finest(self):
        finest = self.drawn("--size", self.SIZE)
        likeness = [similarity(finest, self.drawn("--size", self.SIZE, "--lod", str(lod))) for lod in (1, 2, 4, 7)]
        for found, least in zip(likeness, (0.93, 0.91, 0.87, 0.79)):
            self.assertGreater(found, least, likeness)
        self.assertEqual(likeness, sorted(likeness, reverse=True))

    def test_expressions_are_seen_where_they_act(self):
        neutral = self.face()
        half = len(neutral) // 2
        for control, upper in (("jawOpen", False), ("mouthPucker", False), ("eyeBlinkLeft", True), ("browInnerUp", True)):
            posed = self.face("--set", control + "=1")
            above, below = similarity(neutral[:half], posed[:half]), similarity(neutral[half:], posed[half:])
            there, elsewhere = (above, below) if upper else (below, above)
            self.assertLess(there, 0.985, control)
            self.assertGreater(elsewhere, 0.985, control)

    def test_another_seed_is_another_face(self):
        self.assertLess(similarity(self.face(), self.face(head="head3.dna")), 0.85)

    def test_pictures_of_the_readme_are_those_that_the_program_draws(self):
        with open(os.path.join(GALLERY, "turntable.png"), "rb") as file:
            shown = Picture(file.read()).luma(2)
        found = similarity(shown, self.drawn("--turntable", "8", "--size", "200", shrink=2))
        self.assertGreater(found, 0.98, "draw it anew: mien demo-head -o head.dna --textures textures; "
                           "mien render head.dna --turntable 8 --size 200")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The recipes of docs/mixing.md: the scene and the C of each give the same rows, and these keep what
the recipe promises.

    recipes_test.py path/to/mien path/to/libmien [unittest options]
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
RECIPE = re.compile(r"### ([^\n]+)\n(?:(?!###)[\s\S])*?```json\n([\s\S]*?)```\s*```c\n([\s\S]*?)```")
CONTROLS = ["jawOpen", "mouthSmileLeft", "browInnerUp", "eyeBlinkLeft"]
CURVES = 72  # of the head

BEFORE = r"""
#include <mien.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
enum { CURVES = %d };
static MienError error = {.struct_size = sizeof error};
static MienRig* rig;
static MienDeformer* deformer;
static MienMixer* mixer;
static MienClip *talk, *tracking;
static MienClipBinding *bind_talk, *bind_tracking;
static int frame = 0;
static void check(MienStatus status) {
    if (status == MIEN_OK) return;
    fprintf(stderr, "%%s: %%s\n", mien_status_name(status), error.message);
    exit(1);
}
static uint16_t curve(const char* name) {
    uint32_t index;
    check(mien_rig_find(rig, MIEN_KIND_RAW_CONTROL, name, &index));
    return (uint16_t)index;
}
static MienStringView name(uint32_t control) {
    MienStringView found;
    check(mien_rig_name(rig, MIEN_KIND_RAW_CONTROL, control, &found));
    return found;
}
static int begins(MienStringView text, const char* with) {
    return text.count >= strlen(with) && strncmp(text.data, with, strlen(with)) == 0;
}
static int64_t seconds(double s) { return (int64_t)(s * MIEN_TICKS_PER_SECOND + 0.5); }
static int64_t now = 0;
static void step_to(int64_t tick) {
    check(mien_mixer_step(mixer, tick - now, NULL));
    now = tick;
}
/* Prints the frames before `time`; what follows acts at that time. */
static void until(double time) {
    static const char* const shown[] = {%s};
    MienFloatView row;
    for (; frame < (int)(time * 60 + 0.5); ++frame) {
        step_to(seconds(frame / 60.0));
        check(mien_mixer_row(mixer, &row));
        for (size_t i = 0; i < sizeof shown / sizeof *shown; ++i)
            printf("%%.9g ", (double)row.data[curve(shown[i])]);
        printf("\n");
    }
    step_to(seconds(time));
}
static void open_clip(const char* path, MienClip** clip, MienClipBinding** binding) {
    check(mien_clip_open_file(path, NULL, clip, &error));
    check(mien_clip_binding_create(*clip, rig, NULL, binding, &error));
}
"""


def recipes():
    text = (ROOT / "docs" / "mixing.md").read_text(encoding="utf-8")
    section = text[text.index("## 7. Recipes"):text.index("### A complete scene")]
    return {match.group(1): (json.loads(match.group(2)), match.group(3))
            for match in RECIPE.finditer(section)}


RECIPE_FUNCTION = """
static void recipe_%d(void) {
    MienMixDesc desc = mien_mix_desc_default();
    MienPlayDesc play = mien_play_desc_default();
    play.transition = MIEN_TRANSITION_CUT;
    desc.deformer = deformer;
    %s
    desc.layers = layers;
    desc.layer_count = sizeof layers / sizeof *layers;
    %s
    MienMix* mix;
    check(mien_mix_create(rig, &desc, &mix, &error));
    check(mien_mixer_create(mix, NULL, &mixer, &error));
    mien_mix_destroy(mix);
    frame = 0;
    now = 0;
    %s
    until(2.01);
    mien_mixer_destroy(mixer);
}
"""

MAIN = """
int main(int argc, char** argv) {
    MienDna* dna;
    check(argc == 4 ? mien_dna_open_file(argv[1], NULL, &dna, &error) : MIEN_ERROR_FILE_OPEN);
    check(mien_rig_create(dna, NULL, &rig, &error));
    check(mien_deformer_create(dna, rig, NULL, &deformer, &error));
    open_clip(argv[2], &talk, &bind_talk);
    open_clip(argv[3], &tracking, &bind_tracking);
    %s
    return 0;
}
"""


def program_of(blocks):
    """All recipes in C, one after the other."""
    text = BEFORE % (CURVES, ", ".join(f'"{name}"' for name in CONTROLS))
    for number, block in enumerate(blocks):
        description, actions = block.split("\n\n", 1)
        poses = "desc.poses = poses;\n    desc.pose_count = sizeof poses / sizeof *poses;" \
            if "poses[]" in description else ""
        text += RECIPE_FUNCTION % (number, description, poses, actions)
    return text + MAIN % "\n    ".join(f"recipe_{i}();" for i in range(len(blocks)))


class Recipes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="mien-recipes-")
        cls.run_mien("demo-head", "-o", cls.path("head.dna"))
        # "mama mama", and a tracked face that moves everything.
        talk = [0 if k % 30 < 10 else (k % 30 - 10) * (29 - k % 30) / 100 for k in range(121)]
        cls.clip("talk", {"jawOpen": talk})
        wave = [0.5 + 0.4 * (-1) ** (k // 20) * (k % 20) * (20 - k % 20) / 100 for k in range(121)]
        cls.clip("tracking", {name: wave for name in CONTROLS})
        cls.talk, cls.tracking = talk, wave
        cls.recipes = recipes()
        cls.scenes = {name: cls.play(scene) for name, (scene, _) in cls.recipes.items()}

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder, name)

    @classmethod
    def run_mien(cls, *arguments):
        return subprocess.run([mien, *arguments], capture_output=True, check=True).stdout

    @classmethod
    def clip(cls, name, curves):
        rows = [",".join(["time", *curves])]
        for k, values in enumerate(zip(*curves.values())):
            rows.append(",".join(repr(value) for value in (k / 60, *values)))
        Path(cls.path(name + ".csv")).write_text("\n".join(rows) + "\n", encoding="utf-8")
        cls.run_mien("clip", "build", cls.path(name + ".csv"), "-o", cls.path(name + ".clip"))

    @classmethod
    def play(cls, scene):
        """{control: values} of the frames."""
        Path(cls.path("scene.json")).write_text(json.dumps(scene), encoding="utf-8")
        played = json.loads(cls.run_mien("play", cls.path("scene.json"), cls.path("head.dna")))
        return {name: [frame["raw"][played["controls"].index(name)] for frame in played["frames"]]
                for name in CONTROLS}

    def of(self, name):
        return self.scenes[name]

    def test_all_are_there(self):
        self.assertEqual(list(self.recipes), [
            "Mood must yield to speech", "Upper face from tracking, mouth from visemes",
            "An expression that blocks, scales or yields",
            "The expression comes back after speech", "Release without a snap"])

    def test_c_gives_the_rows_of_the_scenes(self):
        if not shutil.which("cc"):
            self.skipTest("NOT TESTED: there is no cc")
        source = Path(self.path("recipes.c"))
        source.write_text(program_of([block for _, block in self.recipes.values()]),
                          encoding="utf-8")
        directory = os.path.dirname(library)
        subprocess.run(["cc", "-std=c11", "-Wall", "-Wextra", "-Wpedantic", "-Werror",
                        "-Wno-unused", f"-I{ROOT / 'capi' / 'include'}", source, library,
                        f"-Wl,-rpath,{directory}", "-o", self.path("recipes")], check=True)
        printed = subprocess.run([self.path("recipes"), self.path("head.dna"),
                                  self.path("talk.clip"), self.path("tracking.clip")],
                                 capture_output=True, text=True, check=True).stdout
        rows = [[float(value) for value in line.split()] for line in printed.splitlines()]
        frames = [row for scene in self.scenes.values() for row in zip(*scene.values())]
        self.assertEqual(len(rows), len(frames))
        for c, scene in zip(rows, frames):
            for a, b in zip(c, scene):
                self.assertAlmostEqual(a, b, 6)

    def test_mood_yields_to_speech(self):
        rows = self.of("Mood must yield to speech")
        for frame in range(5, 121):
            if frame % 30 in range(5, 10):  # m
                self.assertLess(rows["jawOpen"][frame], 0.03, frame)
            self.assertGreater(rows["mouthSmileLeft"][frame], 0.75)
        self.assertGreater(max(rows["jawOpen"]), 0.8)
        scene, _ = self.recipes["Mood must yield to speech"]
        free = self.play({**scene, "guards": []})
        self.assertGreater(free["jawOpen"][38], 0.25)  # so the test can fail

    def test_curves_have_one_source(self):
        rows = self.of("Upper face from tracking, mouth from visemes")
        for frame in range(121):
            self.assertAlmostEqual(rows["jawOpen"][frame], self.talk[frame], 6)
            self.assertAlmostEqual(rows["browInnerUp"][frame], self.tracking[frame], 6)
            self.assertEqual(rows["mouthSmileLeft"][frame], 0)

    def test_expressions_block_scale_and_yield(self):
        rows = self.of("An expression that blocks, scales or yields")
        for frame in range(121):
            jaw, talk = rows["jawOpen"][frame], self.talk[frame]
            if frame <= 30:
                self.assertAlmostEqual(jaw, talk, 6)
            elif 36 <= frame <= 60:
                self.assertAlmostEqual(jaw, 0.3 * talk, 6)
            elif frame >= 66:
                self.assertAlmostEqual(jaw, 0.7, 6)
            self.assertGreaterEqual(rows["browInnerUp"][frame], 0.2 - 1e-6)
        self.assertEqual(rows["browInnerUp"][120], 1)

    def test_the_expression_comes_back(self):
        smile = self.of("The expression comes back after speech")["mouthSmileLeft"]
        self.assertAlmostEqual(smile[10], 0.9, 6)
        for frame in range(24, 73):
            self.assertAlmostEqual(smile[frame], 0.9 * 0.33, 6)
        self.assertAlmostEqual(smile[110], 0.9, 6)
        steps = [abs(b - a) for a, b in zip(smile, smile[1:])]
        self.assertLess(max(steps), 1.1 * 1.875 * 0.9 * 0.67 / 12)  # the fade of 0.2 s

    def test_release_without_a_snap(self):
        jaw = self.of("Release without a snap")["jawOpen"]
        speech = max(abs(b - a) for a, b in zip(self.talk, self.talk[1:]))
        steps = [abs(b - a) for a, b in zip(jaw, jaw[1:])]
        self.assertLess(max(steps), 1.1 * speech)
        self.assertEqual(set(jaw[109:]), {jaw[120]})
        self.assertAlmostEqual(jaw[120], 0.05, 7)
        self.assertGreater(max(jaw[40:80]), 0.3)


if __name__ == "__main__":
    mien, library = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])

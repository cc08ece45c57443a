#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The class for Godot 3, run by Godot 3: its editor imports rigs, then a script plays them. Bones, blend shapes and
positions are those of the library.

    godot3_test.py LIBRARY_OF_THE_CLASS LIBMIEN     (needs godot3-server, mien for Python)
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import numpy as np

import mien

HERE = pathlib.Path(__file__).resolve().parent
PROJECT = """config_version=4

[application]

config/name="mien"

[editor_plugins]

enabled=PoolStringArray( "%s" )
"""


def run_godot(folder, *arguments):
    """What Godot printed. Its own complaints about a machine without a screen are among it."""
    environment = dict(os.environ, HOME=str(folder / "home"), LANG="en_US.UTF-8", XDG_DATA_HOME=str(folder / "home"))
    done = subprocess.run(["godot3-server", "--path", str(folder / "project"), *arguments], env=environment, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=60, check=False)
    return done.stdout


def make_project(folder, library, libmien):
    project = folder / "project"
    shutil.copytree(HERE.parent / "godot3" / "addons", project / "addons")
    addon = project / "addons" / "mien"
    shutil.copy(library, addon / "libmien_godot3.so")
    shutil.copy(libmien, addon / "libmien.so.0")
    (folder / "home").mkdir()
    # 3.2 has plugins by their folders, later versions by their files.
    (project / "project.godot").write_text(PROJECT % "mien")
    shutil.copy(HERE / "godot3" / "run.gd", project)
    return project


def wanted_of(face, pose, mesh):
    """Numbers as run.gd prints them: origin and two columns of the basis of each joint."""
    transforms = pose.local_transforms
    joints = []
    for t, q, s in zip(transforms[:, :3], transforms[:, 3:7], transforms[:, 7:]):
        x, y, z, w = (float(value) for value in q)
        first = [1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)]
        second = [2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)]
        joints.append([*t, *(value * s[0] for value in first), *(value * s[1] for value in second)])
    pose.deform(mesh, mien.Normals.NONE)
    return np.array(joints), np.array(face.blend_shapes), np.array(pose.positions(mesh)).ravel()


def main(library, libmien):
    if not shutil.which("godot3-server"):
        print("NOT TESTED: the class for Godot 3; there is no godot3-server")
        return 77
    failures = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        project = make_project(folder, library, libmien)
        mien.Dna.generate(mien.Preset.SMALL, seed=5).save(project / "head.dna")
        with mien.Dna.open(project / "head.dna", system="godot") as dna:
            rig = mien.Rig(dna)
            deformer = mien.Deformer(dna, rig)
            rig.bake(project / "baked.rig", deformer)
        (project / "asset.uasset").write_bytes(bytes(100) + (project / "head.dna").read_bytes() + bytes(100))
        (project / "broken.dna").write_bytes((project / "head.dna").read_bytes()[:1000])
        face, pose = rig.instance(), deformer.instance()
        controls = {name: 0.25 + 0.5 * (index % 2) for index, name in enumerate(list(face)[:12])}
        face.update(controls)
        face.evaluate()
        pose.update(face)
        mesh = deformer.meshes[0]
        wanted = {"joints": rig.names(mien.Kind.JOINT), "channels": rig.names(mien.Kind.BLEND_SHAPE_CHANNEL), "controls": controls, "mesh": mesh.name}
        (project / "wanted.json").write_text(json.dumps(wanted))

        printed = run_godot(folder, "--editor", "--quit")
        printed += run_godot(folder, "--script", "res://run.gd")
        marks = [line for line in printed.splitlines() if line.startswith(("PASS ", "FAIL ", "DONE"))]
        failures += [line for line in marks if line.startswith("FAIL ")]
        if "DONE" not in marks:
            failures.append("the script did not end")
        if (project / "values.json").exists():
            got = json.loads((project / "values.json").read_text())
            joints, weights, positions = wanted_of(face, pose, mesh.index)
            for what, left, right in (("bones of the DNA file", got["dna"], joints),
                                      ("bones of the baked file", got["baked"], joints),
                                      ("weights", got["weights"], weights),
                                      ("positions", got["positions"], positions)):
                left = np.array(left)
                if left.shape != right.shape or not np.allclose(left, right, rtol=1e-4, atol=1e-5):
                    failures.append(f"{what} differ")
            if not np.any(weights) or np.allclose(joints, wanted_of(rig.instance(), deformer_at_rest(rig, deformer),
                                                                    mesh.index)[0]):
                failures.append("the controls move nothing: nothing was compared")
    for line in failures:
        print(line)
    if failures:
        print(printed)
    print(f"{len(marks) - len(failures)} passed, {len(failures)} failed")
    return 1 if failures else 0


def deformer_at_rest(rig, deformer):
    pose, rest = deformer.instance(), rig.instance()
    rest.evaluate()
    pose.update(rest)
    return pose


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))

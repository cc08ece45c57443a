# SPDX-License-Identifier: MIT
"""Performances, expressions, poses and the auto-rig."""
import os
import re
import shutil
import subprocess
import sys
import unittest

sys.path.insert(0, os.path.dirname(__file__))
from support import *  # noqa: E402,F403

TOLERANCE = 1e-5
PROGRAM = os.path.join(os.environ.get("MIEN_REPOSITORY", ""), "build/release/bin/mien")


def written(name, text):
    path = os.path.join(FOLDER, name)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


class Performances(unittest.TestCase):
    def setUp(self):
        empty_scene()
        self.rig = import_rig(generated("small"), shape_keys=False, all_lods=False)
        self.names = live.file_of(self.rig).controls

    def key(self, name, frame):
        bpy.context.scene.frame_set(int(frame), subframe=frame - int(frame))
        return self.rig[name]

    def test_csv_with_times(self):
        first, second = self.names[:2]
        path = written("take.csv", f"time,{first},nobody,{second}\n0,0.25,9,1\n0.5,0.75,9,1\n1.0,0.5,9,1\n")
        bpy.ops.mien.import_take(filepath=path, start=10)
        rate = bpy.context.scene.render.fps
        self.assertEqual([round(self.key(first, 10 + s * rate), 6) for s in (0, 0.25, 0.5, 1)], [0.25, 0.5, 0.75, 0.5])
        self.assertEqual(self.key(second, 15), 1)
        self.assertEqual(bpy.context.scene.frame_end, 10 + rate)
        self.assertEqual(self.rig.animation_data.action.name, "take")

    def test_live_link_face(self):
        short = [name.rpartition(".")[2] for name in self.names]
        if "jawOpen" not in short:
            self.fail("the generated rig has no jawOpen")
        name = self.names[short.index("jawOpen")]
        path = written("face.csv", "Timecode,BlendShapeCount,EyeBlinkLeft,JawOpen,HeadYaw\n"
                       "23:59:59:58.0,61,0,0.5,0.1\n23:59:59:59.0,61,0,0.75,0.1\n00:00:00:00.0,61,0,1,0.1\n")
        bpy.context.scene.render.fps = 60
        bpy.ops.mien.import_take(filepath=path, start=1)
        self.assertEqual([round(self.key(name, frame), 5) for frame in (1, 2, 3)], [0.5, 0.75, 1])

    def test_wrong_files(self):
        for name, text, word in (("a.csv", "x,y\n1,2\n", "first column"), ("b.csv", "time,jawOpen\n0,1\n0,1\n", "not later"),
                                 ("c.csv", "time,jawOpen\n0\n", "columns"), ("d.csv", "time,jawOpen\n0,nan\n", "finite"),
                                 ("e.csv", "time,nothing\n0,1\n", "none of"), ("f.json", "{", "JSON"),
                                 ("g.json", "{\"frames\": []}", "frames"), ("h.csv", "", "no frames"),
                                 ("i.csv", "time,jawOpen\n0,x\n", "row 2")):
            with self.assertRaises(RuntimeError) as caught:
                bpy.ops.mien.import_take(filepath=written(name, text))
            self.assertIn(word, str(caught.exception))

    def test_clip_json_and_export(self):
        rows = np.random.default_rng(1).random((5, len(self.names))).astype(np.float32)
        rig_names = live.file_of(self.rig).rig.names(mien.Kind.RAW_CONTROL)
        clip = os.path.join(FOLDER, "take.clip")
        mien.Clip.build(rig_names, rows, rate=24).save(clip)
        frames = [{"time": i / 24, "raw": dict(zip(rig_names, map(float, row)))} for i, row in enumerate(rows)]
        import json
        for path in (clip, written("take.json", json.dumps({"rate": 24, "frames": frames}))):
            bpy.context.scene.render.fps = 24
            bpy.ops.mien.import_take(filepath=path)
            for i, row in enumerate(rows):
                found = [self.key(name, 1 + i) for name in self.names[:9]]
                self.assertLess(np.abs(found - row[:9]).max(), 1e-6)
        out = os.path.join(FOLDER, "out.csv")
        bpy.context.scene.frame_end = 5
        bpy.ops.mien.export_take(filepath=out)
        take = module("takes").read(out)
        self.assertEqual(take.names, rig_names)
        self.assertLess(np.abs(take.rows - rows).max(), 1e-6)

    def test_to_the_face_board(self):
        names = live.file_of(self.rig).rig.names(mien.Kind.RAW_CONTROL)
        rows = np.random.default_rng(2).random((3, len(names))).astype(np.float32)
        path = written("board.csv", "\n".join(",".join(map(repr, row)) for row in
                                              [["time", *names], *([i / 24, *map(float, row)] for i, row in enumerate(rows))])
                       .replace("'", ""))
        bpy.context.scene.render.fps = 24
        bpy.ops.mien.import_take(filepath=path, to_board=True)
        locations = []
        for i, row in enumerate(rows):
            bpy.context.scene.frame_set(1 + i)
            raw = live.raw_controls(self.rig, bpy.context.evaluated_depsgraph_get())
            self.assertLess(np.abs(raw - row).max(), 1e-5)
            locations.append([tuple(bone.location) for bone in self.rig.mien.board.pose.bones])
        self.assertGreater(np.abs(np.subtract(locations[0], locations[1])).max(), 0.1)

    def test_scene(self):
        if not os.path.exists(PROGRAM):
            print("NOT TESTED: scenes in Blender; the program mien is not built")
            return
        name = self.names[3]
        scene = written("scene.json", '{"rate": 24, "seconds": 0.25, "layers": [{"name": "a", "source": {"poses": {"p": {"'
                        + name + '": 0.5}}, "weights": {"p": 1}}}]}')
        bpy.context.preferences.addons[ADDON].preferences.program = PROGRAM
        bpy.ops.mien.import_take(filepath=scene)
        self.assertAlmostEqual(self.key(name, 3), 0.5, 6)
        bpy.context.preferences.addons[ADDON].preferences.program = "/nowhere/mien"
        with self.assertRaises(RuntimeError):
            bpy.ops.mien.import_take(filepath=scene)


class Expressions(unittest.TestCase):
    def setUp(self):
        empty_scene()
        # Named as exported characters are.
        self.path = generated("archetype")
        self.rig = import_rig(self.path, all_lods=False, face_board=False, shape_keys=False)

    def test_tables_are_those_of_the_program(self):
        with open(os.path.join(os.environ["MIEN_REPOSITORY"], "integrations/program/gltf/expression_tables.h"),
                  encoding="utf-8") as file:
            rows = sum(line.startswith('    {"') for line in file)
        sets = module("expressions").sets()
        self.assertEqual(sum(map(len, sets.values())), rows + 52)
        self.assertEqual(len(sets["arkit"]), 52)

    def test_shape_keys_are_the_rig_at_full_value(self):
        self.assertEqual(bpy.ops.mien.bake_shapes(sets={"arkit", "emotions"}), {"FINISHED"})
        baked = next(c for c in bpy.data.collections if c.name.endswith("arkit emotions"))
        reference, found = Reference(self.path), 0
        expressions, _ = module("expressions").on_rig(reference.rig, "arkit")
        more, _ = module("expressions").on_rig(reference.rig, "emotions")
        wanted = {name: (plus, minus) for name, plus, minus in expressions + more}
        self.assertGreater(len(wanted), 50)
        for thing in baked.objects:
            mesh = next(name for name in reference.meshes if thing.name.startswith(name))
            initial = np.array(reference.rig.initial_raw_controls)
            neutral = reference.vertices(initial, mesh)
            for key in list(thing.data.shape_keys.key_blocks)[1:]:
                plus, minus = wanted[key.name]
                posed = []
                for side in (plus, minus):
                    controls = initial.copy()
                    for control, value in side:
                        controls[control] = min(1, controls[control] + value)
                    posed.append(reference.vertices(controls, mesh))
                points = np.zeros(3 * len(key.data), np.float32)
                key.data.foreach_get("co", points)
                most = np.abs(points.reshape(-1, 3) - (neutral + posed[0] - posed[1])).max()
                self.assertLess(most / reference.diagonal, TOLERANCE)
                found += 1
        self.assertGreater(found, 50)

    def test_moves_are_those_of_the_program(self):
        """The largest move of each expression, as `mien export --bake` prints it."""
        if not os.path.exists(PROGRAM):
            print("NOT TESTED: expressions against the program; it is not built")
            return
        for path, name in ((self.path, "unified"), (generated("small"), "arkit")):
            result = subprocess.run([PROGRAM, "export", path, "-o", os.path.join(FOLDER, "baked.glb"), "--bake", name,
                                     "--force"], capture_output=True, text=True, check=True)
            printed = dict(re.findall(r"^(\w+) +(\d+\.\d+) +\d", result.stdout, re.MULTILINE))
            empty_scene()
            import_rig(path, all_lods=False, face_board=False, shape_keys=True)
            bpy.ops.mien.bake_shapes(sets={name})
            baked = next(c for c in bpy.data.collections if c.name.endswith(name))
            moves = {}
            for thing in baked.objects:
                blocks = thing.data.shape_keys.key_blocks
                points = np.zeros((len(blocks), 3 * len(thing.data.vertices)), np.float32)
                for block, row in zip(blocks, points):
                    block.data.foreach_get("co", row)
                for block, row in list(zip(blocks, points))[1:]:
                    move = float(np.linalg.norm((row - points[0]).reshape(-1, 3), axis=1).max())
                    moves[block.name] = max(moves.get(block.name, 0), 1000 * move)
            self.assertGreater(len(printed), 20, result.stdout[:500] + result.stderr[:500])
            for expression, move in moves.items():
                self.assertAlmostEqual(move, float(printed[expression]), 2, expression)
            self.assertEqual({e for e, move in printed.items() if float(move) > 0.01} - moves.keys(), set())

    def test_pose_library(self):
        rig_file = live.file_of(self.rig)
        first, second = rig_file.controls[:2]
        set_controls(self.rig, {first: 0.5, second: 1})
        bpy.ops.mien.store_pose(name="grin")
        bpy.ops.mien.reset()
        self.assertEqual(self.rig[first], 0)
        bpy.ops.mien.apply_pose(index=0)
        self.assertEqual((self.rig[first], self.rig[second]), (0.5, 1))
        bpy.ops.mien.reset()
        bpy.ops.mien.apply_pose(index=0, amount=0.5)
        self.assertEqual((self.rig[first], self.rig[second]), (0.25, 0.5))
        bpy.ops.mien.store_set(set="emotions")
        self.assertGreater(len(self.rig.mien.poses), 5)
        bpy.ops.mien.remove_pose(index=0)
        self.assertNotIn("grin", [pose.name for pose in self.rig.mien.poses])
        with self.assertRaises(RuntimeError):
            bpy.ops.mien.apply_pose(index=99)


def egg():
    """A mesh object: an egg with a nose that looks along -y, with two shape keys."""
    rows, columns = 24, 28
    v = np.repeat(np.linspace(0.03, 0.97, rows), columns) * np.pi
    u = np.tile(np.arange(columns) / columns, rows) * 2 * np.pi
    points = np.stack([0.07 * np.sin(v) * np.sin(u), -0.085 * np.sin(v) * np.cos(u), 0.10 * np.cos(v)], 1)
    front = points[:, 1] < -0.04
    points[:, 1] -= 0.02 * front * np.exp(-(points[:, 0] ** 2 + points[:, 2] ** 2) / 4e-4)
    cell = np.arange((rows - 1) * columns)
    beside = cell - cell % columns + (cell + 1) % columns
    mesh = bpy.data.meshes.new("egg")
    mesh.from_pydata(points.tolist(), [], np.stack([cell, cell + columns, beside + columns, beside], 1).tolist())
    thing = bpy.data.objects.new("egg", mesh)
    bpy.context.scene.collection.objects.link(thing)
    bpy.context.view_layer.objects.active = thing
    thing.shape_key_add(name="Basis")
    shapes = {}
    for name, at, by in (("smile", 0.03, (0.002, 0.002, 0.005)), ("puff", 0.04, (0.003, -0.004, 0))):
        x, z = np.abs(points[:, 0]) - at, points[:, 2] + 0.04
        shapes[name] = (np.exp(-(x * x + z * z) / 5e-4) * front)[:, None] * by
        thing.shape_key_add(name=name).data.foreach_set("co", (points + shapes[name]).astype(np.float32).ravel())
    return thing, points, shapes


class AutoRig(unittest.TestCase):
    def setUp(self):
        empty_scene()

    def test_a_mesh_with_shape_keys_becomes_a_character(self):
        thing, points, shapes = egg()
        path = os.path.join(FOLDER, "egg.dna")
        self.assertEqual(bpy.ops.mien.auto_rig(filepath=path, joints=30, lods=2), {"FINISHED"})
        rig_object = live.rig_of(bpy.context.object)
        self.assertEqual(set(live.file_of(rig_object).controls), set(shapes))
        set_controls(rig_object, {"smile": 1})
        made = next(t for t in shown_meshes(rig_object))
        found = vertices(made)
        # Loose vertices may be dropped, and the order is kept.
        self.assertEqual(len(found), len(points))
        self.assertLess(np.abs(found - (points + shapes["smile"])).max(), 5e-4)
        self.assertGreater(np.abs(shapes["smile"]).max(), 3e-3)

    def test_cancel_writes_nothing(self):
        thing, _, _ = egg()
        auto_rig = module("auto_rig")
        path = os.path.join(FOLDER, "canceled.dna")
        arguments = auto_rig.head_of(thing, bpy.context.scene)
        arguments.update(up=mien.MeshAxis.Z, front=mien.MeshAxis.MINUS_Y, facial_joints=200)
        job = auto_rig.Job.__new__(auto_rig.Job)
        import queue
        import threading
        job.arguments, job.path, job.error, job.report = arguments, path, None, None
        job.progress, job.canceled = queue.SimpleQueue(), threading.Event()
        job.canceled.set()
        job._work()
        self.assertFalse(os.path.exists(path))
        self.assertIsNone(job.report)
        self.assertFalse(job.progress.empty())

    def test_a_mesh_without_shape_keys_is_refused(self):
        mesh = bpy.data.meshes.new("plain")
        bpy.context.view_layer.objects.active = None
        thing = bpy.data.objects.new("plain", mesh)
        bpy.context.scene.collection.objects.link(thing)
        bpy.context.view_layer.objects.active = thing
        self.assertFalse(bpy.ops.mien.auto_rig.poll())
        with self.assertRaises(ValueError):
            module("auto_rig").head_of(thing, bpy.context.scene)


if __name__ == "__main__":
    result = unittest.TextTestRunner(stream=sys.stdout, verbosity=1).run(
        unittest.defaultTestLoader.loadTestsFromModule(sys.modules["__main__"]))
    if not result.wasSuccessful():
        raise SystemExit(1)

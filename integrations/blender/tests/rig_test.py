# SPDX-License-Identifier: MIT
"""Import, and the live rig: vertices equal Mien's, in every way in which Blender evaluates a scene."""
import os
import shutil
import sys
import time
import unittest

sys.path.insert(0, os.path.dirname(__file__))
from support import *  # noqa: E402,F403

TOLERANCE = 1e-5  # of the diagonal


def random_controls(random, count, share=0.3):
    return (random.random(count) * (random.random(count) < share)).astype(np.float32)


def plausible_controls(random, reference):
    """Random, but quaternions have unit length."""
    names = reference.rig.names(mien.Kind.RAW_CONTROL)
    controls = random_controls(random, len(names))
    for i, name in enumerate(names):
        if name.endswith(".qx"):
            quaternion = np.append(random.normal(0, 0.2, 3), 1)
            controls[i:i + 4] = quaternion / np.linalg.norm(quaternion)
    return controls


def animate(rig_object, frames=(1, 12, 24), seed=5, share=0.3):
    """Random keys for all controls. Returns their values, [frame, control]."""
    random = np.random.default_rng(seed)
    names = live.file_of(rig_object).controls
    rows = []
    for frame in frames:
        row = random_controls(random, len(names), share)
        for name, value in zip(names, row):
            rig_object[name] = float(value)
            rig_object.keyframe_insert(live.control_path(name), frame=frame)
        rows.append(row)
    return np.array(rows)


class Import(unittest.TestCase):
    def setUp(self):
        empty_scene()

    def test_everything_of_the_file_is_there(self):
        path = generated("small")
        rig_object = import_rig(path)
        reference = Reference(path)
        rig, deformer = reference.rig, reference.deformer
        self.assertEqual([b.name for b in rig_object.data.bones if b.name not in rig.names(mien.Kind.JOINT)], [])
        self.assertEqual(len(rig_object.data.bones), rig.count(mien.Kind.JOINT))
        for joint, parent in enumerate(rig.joint_parents):
            bone = rig_object.data.bones[rig.name(mien.Kind.JOINT, joint)]
            self.assertEqual(bone.parent.name if bone.parent else None,
                             rig.name(mien.Kind.JOINT, int(parent)) if parent != joint else None)
        self.assertEqual({thing.name for thing in live.meshes_of(rig_object)}, set(rig.names(mien.Kind.MESH)))
        for part in deformer.meshes:
            thing = bpy.data.objects[part.name]
            mesh = thing.data
            self.assertEqual(len(mesh.vertices), part.position_count)
            self.assertEqual(sum(len(p.vertices) - 2 for p in mesh.polygons), part.triangle_count)
            keys = [key.name for key in mesh.shape_keys.key_blocks][1:] if mesh.shape_keys else []
            channels = module("rig_file").blender_names(rig.names(mien.Kind.BLEND_SHAPE_CHANNEL))
            self.assertEqual(keys, [channels[c] for c in part.target_channels])
            self.assertEqual(len(mesh.materials), 1)
            lods = {c["mien_lod"] for c in thing.users_collection if "mien_lod" in c}
            self.assertEqual(lods, set(part.lods))
        for name, initial in zip(rig.names(mien.Kind.RAW_CONTROL), rig.initial_raw_controls):
            self.assertEqual(rig_object[name], initial)

    def test_weights_faces_uvs_and_normals(self):
        path = generated("small")
        rig_object, reference = import_rig(path), Reference(path)
        part = reference.deformer.meshes[0]
        thing = bpy.data.objects[part.name]
        names = [group.name for group in thing.vertex_groups]
        for position in range(0, part.position_count, 7):
            joints, weights = reference.deformer.influences(0, position)
            expected = {reference.rig.name(mien.Kind.JOINT, int(j)): float(w) for j, w in zip(joints, weights) if w > 0}
            found = {names[g.group]: g.weight for g in thing.data.vertices[position].groups}
            self.assertEqual(found.keys(), expected.keys())
            for name, weight in found.items():
                self.assertAlmostEqual(weight, expected[name], 6)
        mesh = thing.data
        if hasattr(mesh, "calc_normals_split"):
            mesh.calc_normals_split()
        sizes, vertices = module("rig_file").read_faces(live.file_of(rig_object), 0)
        corners = np.zeros(len(mesh.loops), np.int32)
        mesh.loops.foreach_get("vertex_index", corners)
        self.assertTrue(np.array_equal(corners, part.vertex_position_indices[vertices]))
        normals = np.array([loop.normal for loop in mesh.loops])
        x, y, z = part.normals[vertices].T
        self.assertLess(np.abs(normals - np.stack([x, -z, y], 1)).max(), 1e-3)
        uvs = np.zeros(2 * len(corners), np.float32)
        mesh.uv_layers[0].data.foreach_get("uv", uvs)
        self.assertTrue(np.array_equal(uvs.reshape(-1, 2), part.texture_coordinates[vertices]))

    def test_only_what_is_asked_for(self):
        rig_object = import_rig(generated("small"), all_lods=False, shape_keys=False, face_board=False)
        self.assertTrue(all(0 in module("rig_file").open_file(generated("small")).deformer.mesh(t.name).lods
                            for t in live.meshes_of(rig_object)))
        self.assertEqual(live.keys_of(rig_object), [])
        self.assertIsNone(rig_object.mien.board)

    def test_files_that_are_no_rigs(self):
        for name, data in (("empty.dna", b""), ("text.dna", b"hello"), ("cut.dna", open(generated("tiny"), "rb").read()[:999]),
                           ("none.uasset", bytes(5000))):
            path = os.path.join(FOLDER, name)
            with open(path, "wb") as file:
                file.write(data)
            with self.assertRaises(RuntimeError) as caught:
                bpy.ops.mien.import_rig(filepath=path)
            self.assertIn(name, str(caught.exception))
        with self.assertRaises(RuntimeError):
            bpy.ops.mien.import_rig(filepath=os.path.join(FOLDER, "absent.dna"))
        self.assertEqual(len(bpy.data.objects), 0)

    def test_uasset(self):
        dna = open(generated("tiny"), "rb").read()
        path = os.path.join(FOLDER, "one.uasset")
        with open(path, "wb") as file:
            file.write(b"\xc1\x83\x2a\x9e" + bytes(4096) + b"DNA\x00\x02\x00" + bytes(99) + dna + bytes(77))
        rig_object = import_rig(path)
        self.assertEqual(len(rig_object.data.bones), Reference(generated("tiny")).rig.count(mien.Kind.JOINT))
        with open(path, "ab") as file:
            file.write(dna)
        with self.assertRaises(RuntimeError) as caught:
            bpy.ops.mien.import_rig(filepath=path)
        self.assertIn("2 DNA files", str(caught.exception))


class Live(unittest.TestCase):
    def setUp(self):
        empty_scene()
        bpy.context.scene.frame_end = 24

    def test_fifty_poses_of_a_large_head(self):
        path = generated("metahuman_head")
        start, begin = time.perf_counter(), time.process_time()
        rig_object = import_rig(path)
        print(f"MEASURED import of the large head: {time.perf_counter() - start:.1f} s, "
              f"{time.process_time() - begin:.1f} s of CPU time")
        reference, random = Reference(path), np.random.default_rng(1)
        most = largest_error(rig_object, reference, reference.rig.initial_raw_controls)
        for _ in range(50):
            controls = random_controls(random, len(reference.face.raw_controls))
            set_controls(rig_object, controls)
            most = max(most, largest_error(rig_object, reference, controls))
        print(f"MEASURED largest distance to Mien's vertices in 51 poses: {most:.1e} of the diagonal")
        self.assertLess(most, TOLERANCE)

    def test_golden_rigs(self):
        """Of every version, with quaternion joints, RBF solvers, twists, swings and networks. Parts of rotations have the
        values that they have in the axes of the file."""
        folder = os.path.join(os.environ["MIEN_REPOSITORY"], "tests/golden")
        for name in ("body", "ml", "small_rot", "tiny_v21", "tiny_v24", "tiny_v27"):
            empty_scene()
            path = os.path.join(folder, name + ".dna")
            rig_object, reference = import_rig(path, all_lods=False), Reference(path)
            random = np.random.default_rng(11)
            for _ in range(3):
                controls = plausible_controls(random, reference)
                set_controls(rig_object, controls)
                self.assertLess(largest_error(rig_object, reference, controls), TOLERANCE, name)

    def test_every_lod(self):
        path = generated("small")
        rig_object, reference = import_rig(path), Reference(path)
        controls = random_controls(np.random.default_rng(2), len(reference.face.raw_controls))
        for lod in range(reference.rig.lod_count):
            rig_object.mien.lod = lod
            set_controls(rig_object, controls)
            shown = {t.name for t in shown_meshes(rig_object)}
            self.assertTrue(all(lod in reference.deformer.mesh(name).lods for name in shown))
            self.assertTrue(shown)
            self.assertLess(largest_error(rig_object, reference, controls), TOLERANCE)

    def test_face_board(self):
        path = generated("small")
        rig_object, reference = import_rig(path), Reference(path)
        board, rig_file = rig_object.mien.board, live.file_of(rig_object)
        slider_of, random = module("face_board").slider_of, np.random.default_rng(4)
        for _ in range(5):
            gui = random.random(len(rig_file.gui_controls)).astype(np.float32)
            for name, value in zip(rig_file.gui_controls, gui):
                bone, axis = slider_of(name)
                board.pose.bones[bone].location[axis] = value
            bpy.context.view_layer.update()
            self.assertLess(largest_error(rig_object, reference, reference.rig.initial_raw_controls, gui), TOLERANCE)
        # Properties are added to what the board gives.
        bpy.ops.object.select_all(action="DESELECT")
        bpy.context.view_layer.objects.active = board
        bpy.ops.mien.reset()
        bpy.context.view_layer.update()
        self.assertLess(largest_error(rig_object, reference, reference.rig.initial_raw_controls), TOLERANCE)

    def test_frames_in_any_order(self):
        path = generated("small")
        rig_object, reference = import_rig(path), Reference(path)
        rows = animate(rig_object, frames=(1, 2, 3))
        for frame in (3, 1, 2, 1, 3, 2):
            bpy.context.scene.frame_set(frame)
            self.assertLess(largest_error(rig_object, reference, rows[frame - 1]), TOLERANCE)

    def test_renders_are_not_a_frame_late(self):
        """The evaluated pose in the graph of the render, which a handler after the frame's evaluation sees."""
        rig_object, reference = import_rig(generated("small")), Reference(generated("small"))
        rows = animate(rig_object, frames=(1, 2, 3, 4))
        scene = bpy.context.scene
        scene.render.engine, scene.frame_end = "CYCLES", 4
        scene.cycles.samples, scene.cycles.device, scene.cycles.use_denoising = 1, "CPU", False
        scene.render.resolution_x = scene.render.resolution_y = 8
        scene.render.filepath = os.path.join(FOLDER, "render")
        camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
        scene.collection.objects.link(camera)
        scene.camera = camera
        found, joint = {}, len(rig_object.pose.bones) // 2
        name = live.file_of(rig_object).joints[joint]

        def look(scene, depsgraph):
            bone = rig_object.evaluated_get(depsgraph).pose.bones[name]
            found.setdefault(scene.frame_current, []).append((depsgraph.mode, np.array(bone.matrix)))

        bpy.app.handlers.frame_change_post.append(look)
        try:
            bpy.ops.render.render(animation=True)
        finally:
            bpy.app.handlers.frame_change_post.remove(look)
        self.assertTrue(any(mode == "RENDER" for mode, _ in found[3]))
        for frame in range(1, 5):
            scene.frame_set(frame)
            matrix = np.array(rig_object.evaluated_get(bpy.context.evaluated_depsgraph_get()).pose.bones[name].matrix)
            for _, seen in found[frame]:
                self.assertLess(np.abs(matrix - seen).max(), 1e-6)
        moved = [found[frame][0][1] for frame in range(1, 5)]
        self.assertGreater(np.abs(moved[0] - moved[1]).max(), 1e-6)
        self.assertEqual(len(rows), 4)

    def test_cloth_is_not_a_frame_late(self):
        """A cloth that hangs from the face, baked with the live rig and with baked keys, is the same."""
        rig_object = import_rig(generated("small"))
        animate(rig_object, frames=(1, 6, 12), share=1)
        bpy.context.scene.frame_end = 12
        cloth = hanging_cloth(rig_object)
        live_run = baked_cloth(cloth, 12)
        self.assertEqual(bpy.ops.mien.bake_keys(), {"FINISHED"})
        keys_run = baked_cloth(cloth, 12)
        self.assertGreater(np.abs(live_run - live_run[0]).max(), 0.01)
        most = np.abs(live_run - keys_run).max()
        print(f"MEASURED cloth of the live rig against cloth of baked keys: {most:.1e} m at most")
        self.assertLess(most, 1e-4)

    def test_baked_keys_play_without_the_rig(self):
        path = generated("small")
        rig_object, reference = import_rig(path), Reference(path)
        rows = animate(rig_object, frames=(1, 2, 3))
        bpy.context.scene.frame_end = 3
        bpy.ops.mien.bake_keys()
        self.assertFalse(module("bake_keys").is_live(rig_object))
        with self.assertRaises(RuntimeError):
            bpy.ops.mien.bake_keys()
        for frame in (2, 1, 3):
            bpy.context.scene.frame_set(frame)
            self.assertLess(largest_error(rig_object, reference, rows[frame - 1]), TOLERANCE)
        bpy.ops.mien.make_live()
        bpy.context.scene.frame_set(2)
        self.assertLess(largest_error(rig_object, reference, rows[1]), TOLERANCE)

    def test_save_and_reload(self):
        """Also by a user whose settings forbid scripts in files."""
        path = generated("small")
        rig_object, reference = import_rig(path), Reference(path)
        rows = animate(rig_object, frames=(1, 2, 3))
        saved = os.path.join(FOLDER, "saved.blend")
        bpy.ops.wm.save_as_mainfile(filepath=saved)
        for use_scripts in (True, False):
            bpy.ops.wm.open_mainfile(filepath=saved, use_scripts=use_scripts)
            rig_object = next(o for o in bpy.data.objects if o.mien.path)
            for frame in (2, 3):
                bpy.context.scene.frame_set(frame)
                self.assertLess(largest_error(rig_object, reference, rows[frame - 1]), TOLERANCE)

    def test_undo(self):
        path = generated("small")
        import_rig(path)
        reference, random = Reference(path), np.random.default_rng(8)
        states = []
        for _ in range(4):
            controls = random_controls(random, len(reference.face.raw_controls))
            set_controls(next(o for o in bpy.data.objects if o.mien.path), controls)
            bpy.ops.ed.undo_push(message="pose")
            states.append(controls)
        for controls in reversed(states[:-1]):
            bpy.ops.ed.undo()
            rig_object = next(o for o in bpy.data.objects if o.mien.path)
            bpy.context.view_layer.update()
            self.assertLess(largest_error(rig_object, reference, controls), TOLERANCE)
        for controls in states[1:]:
            bpy.ops.ed.redo()
            rig_object = next(o for o in bpy.data.objects if o.mien.path)
            bpy.context.view_layer.update()
            self.assertLess(largest_error(rig_object, reference, controls), TOLERANCE)

    def test_missing_file(self):
        path = os.path.join(FOLDER, "moves.dna")
        shutil.copy(generated("small"), path)
        rig_object, reference = import_rig(path), Reference(generated("small"))
        saved = os.path.join(FOLDER, "missing.blend")
        bpy.ops.wm.save_as_mainfile(filepath=saved)
        elsewhere = os.path.join(FOLDER, "elsewhere.dna")
        shutil.move(path, elsewhere)
        bpy.ops.wm.open_mainfile(filepath=saved)
        rig_object = next(o for o in bpy.data.objects if o.mien.path)
        controls = random_controls(np.random.default_rng(3), len(reference.face.raw_controls))
        for name, value in zip(reference.rig.names(mien.Kind.RAW_CONTROL), controls):
            rig_object[name] = float(value)
        rig_object.update_tag()
        bpy.context.view_layer.update()
        self.assertIn("moves.dna", live.message_of(rig_object))
        with self.assertRaises(RuntimeError):
            bpy.ops.mien.locate(filepath=generated("tiny"))  # another rig
        self.assertEqual(bpy.ops.mien.locate(filepath=elsewhere), {"FINISHED"})
        bpy.context.view_layer.update()
        self.assertEqual(live.message_of(rig_object), "")
        self.assertLess(largest_error(rig_object, reference, controls), TOLERANCE)

    def test_two_characters_and_a_duplicate(self):
        first, second = import_rig(generated("small")), import_rig(generated("tiny"))
        references = {first.name: Reference(generated("small")), second.name: Reference(generated("tiny"))}
        random = np.random.default_rng(6)
        bpy.ops.object.select_all(action="DESELECT")
        for thing in (first, *live.meshes_of(first), first.mien.board, *first.mien.board.children):
            thing.select_set(True)
        bpy.context.view_layer.objects.active = first
        bpy.ops.object.duplicate()
        copy = bpy.context.view_layer.objects.active
        self.assertNotEqual(copy, first)
        self.assertNotEqual(copy.mien.board, first.mien.board)
        references[copy.name] = references[first.name]
        for _ in range(3):
            wanted = {}
            for rig_object in (first, second, copy):
                face = references[rig_object.name].face
                wanted[rig_object] = random_controls(random, len(face.raw_controls))
                set_controls(rig_object, wanted[rig_object])
            for rig_object, controls in wanted.items():
                self.assertLess(largest_error(rig_object, references[rig_object.name], controls), TOLERANCE)

    def test_linked_from_another_file(self):
        import_rig(generated("small"))
        saved = os.path.join(FOLDER, "library.blend")
        bpy.ops.wm.save_as_mainfile(filepath=saved)
        empty_scene()
        with bpy.data.libraries.load(saved, link=True) as (there, here):
            here.collections = [name for name in there.collections if "LOD" not in name and name != "Collection"]
        linked = here.collections[0]
        bpy.context.scene.collection.children.link(linked)
        override = linked.override_hierarchy_create(bpy.context.scene, bpy.context.view_layer)
        rig_object = next(o for o in override.all_objects if o.mien.path)
        reference = Reference(generated("small"))
        controls = random_controls(np.random.default_rng(9), len(reference.face.raw_controls))
        set_controls(rig_object, controls)
        self.assertLess(largest_error(rig_object, reference, controls), TOLERANCE)


def hanging_cloth(rig_object):
    """A strip of cloth, one end of which is bound to the joint that moves most."""
    scene = bpy.context.scene
    names, pose = live.file_of(rig_object).joints, []
    for frame in (1, 6, 12):
        scene.frame_set(frame)
        evaluated = rig_object.evaluated_get(bpy.context.evaluated_depsgraph_get())
        pose.append([evaluated.pose.bones[name].matrix.translation[:] for name in names])
    joint = int(np.abs(np.diff(pose, axis=0)).sum((0, 2)).argmax())
    x, y, z = pose[0][joint]
    rows, columns = 10, 4
    points = [(x + 0.05 * c, y, z - 0.05 * r) for r in range(rows) for c in range(columns)]
    faces = [(r * columns + c, r * columns + c + 1, (r + 1) * columns + c + 1, (r + 1) * columns + c)
             for r in range(rows - 1) for c in range(columns - 1)]
    mesh = bpy.data.meshes.new("cloth")
    mesh.from_pydata(points, [], faces)
    cloth = bpy.data.objects.new("cloth", mesh)
    scene.collection.objects.link(cloth)
    cloth.vertex_groups.new(name=names[joint]).add(range(len(points)), 1, "REPLACE")
    cloth.vertex_groups.new(name="pinned").add(range(columns), 1, "REPLACE")
    cloth.modifiers.new("Armature", "ARMATURE").object = rig_object
    modifier = cloth.modifiers.new("Cloth", "CLOTH")
    modifier.settings.vertex_group_mass = "pinned"
    modifier.point_cache.frame_start, modifier.point_cache.frame_end = 1, 12
    return cloth


def baked_cloth(cloth, last):
    """float64 (frames, n, 3) of a new bake."""
    bpy.ops.ptcache.free_bake_all()
    bpy.context.scene.frame_set(1)
    bpy.ops.ptcache.bake_all(bake=True)
    frames = []
    for frame in range(1, last + 1):
        bpy.context.scene.frame_set(frame)
        frames.append(vertices(cloth))
    return np.array(frames)


if __name__ == "__main__":
    result = unittest.TextTestRunner(stream=sys.stdout, verbosity=1).run(
        unittest.defaultTestLoader.loadTestsFromModule(sys.modules["__main__"]))
    if not result.wasSuccessful():
        raise SystemExit(1)

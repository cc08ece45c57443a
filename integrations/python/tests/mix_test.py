# SPDX-License-Identifier: MIT
"""Mixes, mixers, gazes and solvers: rows reach instances, what they refer to stays alive, and wrong
calls raise."""
import gc
import pathlib
import tempfile
import threading
import unittest

import mien

from support import dna_of, needs_numpy, numpy, rig_of

HEAD = mien.Preset.HEAD
FRAME = mien.ticks(1 / 60)
NO_FADE = dict(transition=mien.Transition.CUT)


def deformer_of():
    return mien.Deformer(dna_of(HEAD), rig_of(HEAD))


def speech():
    rows = [[i / 128, 0.5] for i in range(61)]
    return mien.Clip.build(["jawOpen", "mouthPucker"], [v for row in rows for v in row],
                           events=[(10 * FRAME, "word", 0.5)])


def scene(**options):
    layers = [
        mien.MixLayer.clip(mien.LayerGroup.SPEECH),
        mien.MixLayer.poses([{"mouthSmileLeft": 0.5, "wonder": 1.0}]),
        mien.MixLayer.stream(["browInnerUp"]),
        mien.MixLayer.generator(mien.Generator.BLINK, {"eyeBlinkLeft": 1, "eyeBlinkRight": 1},
                                mien.ticks(4), mode=mien.BlendMode.MAX),
    ]
    dazzled = mien.Reaction([mien.Stroke({"eyeSquintLeft": 1.0}, mien.BlendMode.SCREEN,
                                         attack=FRAME, release=FRAME, is_held=True,
                                         is_scaled=True)], level_on=0.5, level_off=0.25)
    return mien.Mix(rig_of(HEAD), layers, [dazzled], variables=["wonder"], **options)


class MixTest(unittest.TestCase):
    def test_files_give_back_the_mix(self):
        mix, rig = scene(), rig_of(HEAD)
        data = mix.to_bytes()
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "scene.mix"
            mix.save(path)
            same = mien.Mix.open(path, rig, variables=["wonder"])
            with self.assertRaises(mien.FileError):
                mix.save(pathlib.Path(folder) / "no" / "scene.mix")
        self.assertEqual(same.to_bytes(), data)
        self.assertEqual(mien.Mix.from_bytes(data, None).to_bytes(), data)
        self.assertIn("poses.0.value mouthSmileLeft 0.5\n", same.to_text().replace(
            "CTRL_expressions.", ""))
        mixer = same.mixer()
        mixer.set_pose_weight(1, 0, 1.0)
        mixer.set_variable("wonder", 0.0)
        mixer.step(FRAME)
        self.assertEqual(mixer.row[-1], 1.0)
        with self.assertRaises(mien.MixError):
            mien.Mix.from_bytes(data[:-1], rig)
        with self.assertRaises(mien.UnknownNameError):
            mien.Mix.from_bytes(data, rig_of(mien.Preset.SMALL))

    def test_layers_reach_the_instance(self):
        face, clip = rig_of(HEAD).instance(), speech()
        mix = scene()
        self.assertEqual((mix.info.layer_count, mix.info.variable_count), (4, 1))
        mixer = mix.mixer(seed=3, stages=True)
        mixer.play(0, clip, clip.bind(rig_of(HEAD)), **NO_FADE)
        mixer.set_pose_weight(1, 0, 1.0)
        mixer.set_variable("wonder", 0.0)
        self.assertEqual(mixer.step(9 * FRAME, face), [])
        self.assertEqual(mixer.step(FRAME, face), [mien.MixEvent(0, 10 * FRAME, "word", 0.5)])
        self.assertEqual(face["jawOpen"], 10 / 128)
        self.assertEqual(face["mouthPucker"], 0.5)
        self.assertEqual(face["mouthSmileLeft"], 0.5)
        self.assertEqual(mixer.row[-1], 1.0)
        self.assertEqual(mixer.stage(0)[-1], 0.0)
        self.assertEqual(mixer.info.tick, 10 * FRAME)
        self.assertTrue(mixer.push(2, 11 * FRAME, [0.75]))
        self.assertFalse(mixer.push(2, 0, [0.75]))
        mixer.trigger(0, 1.0, -1)
        mixer.step(mien.ticks(1), face)
        self.assertEqual(face["eyeSquintLeft"], 1.0)
        mixer.release(0)
        for level, wanted in ((0.49, 0.0), (0.5, 0.5), (0.25, 0.25), (0.24, 0.0)):
            mixer.set_level(0, level)
            mixer.step(mien.ticks(2), face)
            self.assertEqual(face["eyeSquintLeft"], wanted)
        mixer.set_weight(1, 0.0, FRAME)
        mixer.stop(0)
        mixer.step(mien.ticks(1), face)
        for name in ("eyeSquintLeft", "mouthSmileLeft", "jawOpen"):
            self.assertEqual(face[name], 0.0)

    def test_snapshots_continue(self):
        clip = speech()
        bound = clip.bind(rig_of(HEAD))
        one, other = scene().mixer(1), scene().mixer(2)
        one.play(0, clip, bound, clip_id=7)
        one.step(5 * FRAME)
        saved = one.snapshot()
        self.assertEqual(len(saved), one.mix.info.snapshot_bytes)
        with self.assertRaises(mien.ArgumentError):
            other.restore(saved)
        other.restore(saved, {7: (clip, bound)})
        for _ in range(60):
            one.step(FRAME)
            other.step(FRAME)
            self.assertEqual(bytes(one.row), bytes(other.row))
        for wrong in (saved[:-1], b"", b"x" * len(saved)):
            with self.assertRaises(mien.ArgumentError):
                other.restore(wrong, {7: (clip, bound)})

    def test_clips_live_as_long_as_they_are_read(self):
        mixer = scene().mixer()
        for _ in range(8):  # each in memory of its own, which goes with it
            clip = mien.Clip.from_bytes(speech().to_bytes())
            binding = clip.bind(rig_of(HEAD))
            mixer.play(0, clip, binding, transition=mien.Transition.CROSSFADE)
            clip.close()
            binding.close()
            del clip, binding
            gc.collect()
            mixer.step(FRAME)
        self.assertLessEqual(len(mixer._playing[0]), 2)
        again = speech()
        bound = again.bind(rig_of(HEAD))
        source = scene().mixer()
        source.play(0, again, bound)
        source.step(FRAME)
        mixer.restore(source.snapshot(), {0: (again, bound)})
        del again, bound
        gc.collect()
        mixer.step(FRAME)
        row = mixer.row
        mixer.close()
        self.assertGreaterEqual(row[0], 0)  # still memory
        with self.assertRaises(mien.ClosedError):
            mixer.step(1)

    def test_batches_are_single_steps(self):
        rig, clip = rig_of(HEAD), speech()
        bound = clip.bind(rig)
        mix = scene()
        with mix:
            together, alone = ([mix.mixer(i) for i in range(3)] for _ in range(2))
        faces = [rig.instance() for _ in range(3)]
        for mixer in together + alone:
            mixer.play(0, clip, bound)
        events = mien.step_mixers(together, 12 * FRAME, faces)
        self.assertEqual([len(found) for found in events], [1, 1, 1])
        for mixer, single, face in zip(together, alone, faces):
            single.step(12 * FRAME)
            self.assertEqual(bytes(mixer.row), bytes(single.row))
            self.assertEqual(bytes(face.raw_controls), bytes(single.row)[:-4])
        with self.assertRaises(mien.BusyError):
            mien.step_mixers([together[0]] * 2, 1)
        with self.assertRaises(mien.ArgumentError):
            mien.step_mixers(together, 1, faces[:2])

    def test_streams_are_pushed_from_another_thread(self):
        mixer, stop = scene().mixer(), threading.Event()
        taken = []

        def push():
            for i in range(1, 400):
                taken.append(mixer.push(2, i * FRAME, [i / 400]))
                if stop.wait(0.0005):
                    return

        producer = threading.Thread(target=push)
        producer.start()
        for _ in range(200):
            mixer.step(FRAME)
        stop.set()
        producer.join()
        self.assertTrue(taken[0])

    def test_guards_measure_the_rig(self):
        deformer = deformer_of()
        mix = mien.Mix(rig_of(HEAD), [
            mien.MixLayer.clip(mien.LayerGroup.SPEECH),
            mien.MixLayer.poses([{"jawOpen": 0.6, "mouthSmileLeft": 0.8}]),
        ], guards=mien.Guard.LIPS, deformer=deformer)
        deformer.close()
        self.assertGreaterEqual(mix.info.guard_count, 3)
        closed = mien.Clip.build(["jawOpen"], [0.0] * 30)
        mixer, face = mix.mixer(), rig_of(HEAD).instance()
        mixer.play(0, closed, closed.bind(rig_of(HEAD)), **NO_FADE)
        mixer.set_pose_weight(1, 0, 1.0)
        for _ in range(30):
            mixer.step(FRAME, face)
        self.assertLess(face["jawOpen"], 0.1)
        self.assertGreater(face["mouthSmileLeft"], 0.5)
        states = [mixer.guard(g) for g in range(mix.info.guard_count)]
        self.assertIn("lips center", [state.name for state in states])
        for state in states:
            self.assertEqual(state.kind, mien.Guard.LIPS)
            self.assertGreater(state.wanted, state.limit)
            self.assertLess(state.distance, state.limit + 0.01)
            self.assertIn(rig_of(HEAD).raw_control("jawOpen"), state.controls)
        with self.assertRaises(mien.OutOfRangeError):
            mixer.guard(mix.info.guard_count)
        for guard in range(mix.info.guard_count):
            mixer.set_guard(guard, 0)
        for _ in range(30):
            mixer.step(FRAME, face)
        self.assertAlmostEqual(face["jawOpen"], 0.6, 5)

    def test_tables(self):
        rig, deformer = rig_of(HEAD), deformer_of()
        pairs = mien.Mix.find_antagonists(rig)
        self.assertIn((rig.raw_control("eyeBlinkLeft"), rig.raw_control("eyeWideLeft")),
                      [(pair.first, pair.second) for pair in pairs])
        count = rig.count(mien.Kind.RAW_CONTROL) + 1
        mirror = mien.Mix.find_mirror(deformer, count)
        self.assertEqual(mirror[rig.raw_control("mouthSmileLeft")],
                         rig.raw_control("mouthSmileRight"))
        mask = mien.Mix.find_mask(rig, range(rig.count(mien.Kind.JOINT_GROUP)), count, 0.25)
        self.assertEqual(mask[count - 1], 0.25)
        mix = scene(antagonists=pairs, mirror=mirror, limits=(0, [1.0] * count))
        mixer, clip = mix.mixer(), mien.Clip.build(["mouthSmileLeft"], [0.5, 0.5])
        mixer.play(0, clip, clip.bind(rig), mirrored=True, **NO_FADE)
        mixer.step(FRAME)
        self.assertEqual(mixer.row[rig.raw_control("mouthSmileRight")], 0.5)
        self.assertEqual(mixer.row[rig.raw_control("mouthSmileLeft")], 0.0)
        for call in (lambda: mien.Mix.find_mirror(deformer, 3),
                     lambda: mien.Mix.find_mask(rig, [99], count)):
            with self.assertRaises(mien.Error):
                call()

    def test_masks(self):
        rig = rig_of(HEAD)
        count = rig.count(mien.Kind.RAW_CONTROL)
        by_number = [0.0] * count
        by_number[rig.raw_control("jawOpen")] = 0.5
        masks = [{"jawOpen": 0.5}, by_number] + \
            ([numpy.array(by_number)] if numpy is not None else [])
        for mask in masks:
            layers = [mien.MixLayer.poses([{"jawOpen": 1.0, "mouthPucker": 1.0}], mask=mask)]
            mixer = mien.Mix(rig, layers).mixer()
            mixer.set_pose_weight(0, 0, 1.0)
            mixer.step(1)
            self.assertEqual(mixer.row[rig.raw_control("jawOpen")], 0.5)
            self.assertEqual(mixer.row[rig.raw_control("mouthPucker")], 0.0)
        with self.assertRaises(TypeError):
            mien.Mix(rig, [mien.MixLayer.clip(mask="jawOpen")])

    def test_wrong_mixes(self):
        rig = rig_of(HEAD)
        pose = mien.MixLayer.poses
        for error, make in (
                (mien.UnknownNameError, lambda: mien.Mix(rig, [pose([{"nose": 1.0}])])),
                (mien.OutOfRangeError, lambda: mien.Mix(rig, [pose([{999: 1.0}])])),
                (mien.ArgumentError, lambda: mien.Mix(rig, [pose([{}], weight=2)])),
                (mien.ArgumentError, lambda: mien.Mix(rig, [mien.MixLayer.clip()] * 17)),
                (mien.ArgumentError, lambda: mien.Mix(rig, [], guards=mien.Guard.LIPS)),
                (mien.ArgumentError, lambda: mien.Mix(rig, [], limits=(0, [1.0]))),
                (mien.ArgumentError, lambda: mien.Mix(rig, [], mirror=[0])),
                (mien.ArgumentError, lambda: scene().mixer(seed=-1))):
            with self.subTest(error), self.assertRaises(error):
                make()
        mixer, clip = scene().mixer(), speech()
        bound = clip.bind(rig)
        for error, call in (
                (mien.OutOfRangeError, lambda: mixer.play(1, clip, bound)),
                (mien.ArgumentError, lambda: mixer.play(0, clip, bound, transition=9)),
                (mien.ArgumentError, lambda: mixer.play(0, clip, bound, mirrored=True)),
                (mien.OutOfRangeError, lambda: mixer.set_weight(9, 0.5)),
                (mien.ArgumentError, lambda: mixer.set_weight(0, float("nan"))),
                (mien.UnknownNameError, lambda: mixer.set_variable("nobody", 1)),
                (mien.OutOfRangeError, lambda: mixer.trigger(1)),
                (mien.OutOfRangeError, lambda: mixer.set_level(1, 1.0)),
                (mien.ArgumentError, lambda: mixer.set_level(0, 1.5)),
                (mien.ArgumentError, lambda: mixer.push(2, 0, [1.0, 2.0])),
                (mien.ArgumentError, lambda: mixer.stage(0)),
                (mien.ArgumentError, lambda: mixer.step(-1)),
                (mien.ArgumentError, lambda: mixer.step(1, rig_of().instance()))):
            with self.subTest(error), self.assertRaises(error):
                call()

    def test_gaze(self):
        rig, deformer = rig_of(HEAD), deformer_of()
        gaze, face = mien.Gaze(deformer), rig.instance()
        deformer.close()
        left, right = gaze.eyes
        self.assertAlmostEqual(left[0], -right[0], 3)
        rest = gaze.look_at((100.0, 1700.0, 1000.0), face)
        self.assertGreater(face["eyeLookOutLeft"], 0.0)
        self.assertEqual(len(rest), 2)
        with self.assertRaises(mien.ArgumentError):
            gaze.look_at((float("nan"), 0, 1), face)
        with self.assertRaises(mien.UnknownNameError):
            mien.Gaze(deformer_of(), left_eye="nobody")

    def test_gaze_layers_look_at_pose_variables(self):
        rig, face = rig_of(HEAD), rig_of(HEAD).instance()
        gaze = mien.Gaze(deformer_of())
        mix = mien.Mix(rig, [mien.MixLayer.gaze(["x", "y", "z"], {"turn": 1.0, "nod": 1.0})],
                       variables=["x", "y", "z", "turn", "nod"], gaze=gaze)
        mixer = mix.mixer()
        for name, value in zip("xyz", (200.0, 1700.0, 1000.0)):
            mixer.set_variable(name, value)
        mixer.step(FRAME)
        gaze.look_at((200.0, 1700.0, 1000.0), face)
        self.assertEqual(bytes(mixer.row)[:len(bytes(face.raw_controls))],
                         bytes(face.raw_controls))
        with self.assertRaises(mien.ArgumentError):
            mien.Mix(rig, [mien.MixLayer.gaze([0, 1, 2])])

    def test_guards_of_ones_own_tell_what_they_held(self):
        rig = rig_of(HEAD)
        joints = [mien.Landmark([rig.find(mien.Kind.JOINT, name)])
                  for name in ("C_TeethUpper", "C_TeethLower")]
        mix = mien.Mix(rig, [mien.MixLayer.poses([{"jawOpen": 0.5}])], deformer=deformer_of(),
                       custom_guards=[mien.CustomGuard(*joints, f_on=4.0)])
        guard = mix.guard(0)
        self.assertEqual(guard.curves[0], rig.raw_control("jawOpen"))
        self.assertGreater(guard.gains[0], 1)
        mixer = mix.mixer()
        mixer.set_pose_weight(0, 0, 1.0)
        mixer.step(mien.ticks(1))
        step = mixer.guard(0)
        self.assertEqual(step.activation, 1.0)
        self.assertEqual((step.name, step.kind, list(step.controls)), ("custom", 0, guard.curves))
        self.assertGreater(step.wanted, step.limit)
        self.assertAlmostEqual(step.distance, step.limit, 3)
        for error, call in ((mien.OutOfRangeError, lambda: mix.guard(1)),
                            (mien.OutOfRangeError, lambda: mixer.guard(1)),
                            (mien.ArgumentError, lambda: mien.glare([]))):
            with self.assertRaises(error):
                call()
        dazzled = mien.glare([{"eyeBlinkLeft": 1.0}, {}, {}, {}, {}])
        self.assertEqual(dazzled.strokes[0].delay, mien.ticks(0.06))
        self.assertEqual([s.is_scaled for s in dazzled.strokes], [False, True, False, True, False])
        self.assertEqual((dazzled.level_on, dazzled.level_off), (0.5, mien.glare([{}] * 5).level_off))
        self.assertAlmostEqual(dazzled.level_off, 0.35)
        mixer = mien.Mix(rig, [], [dazzled]).mixer()
        mixer.trigger(0)
        mixer.step(mien.ticks(0.13))
        self.assertEqual(mixer.row[rig.raw_control("eyeBlinkLeft")], 1.0)


class SolverTest(unittest.TestCase):
    def setUp(self):
        self.deformer = deformer_of()
        self.body = self.deformer.instance()
        rig = rig_of(HEAD)
        self.jaw = rig.find(mien.Kind.JOINT, "C_Jaw") if "C_Jaw" in rig.names(
            mien.Kind.JOINT) else rig.info.joint_count - 1

    def step(self, solver, row=None, **options):
        stack = mien.SolverStack(self.deformer, [solver], curve_count=0 if row is None else len(row),
                                 check_writes=True)
        state = stack.state()
        stack.close()
        self.body.update_from_values()
        state.step(self.body, FRAME, row, **options)
        return state

    def matrix(self, joint):
        return self.body.joint_matrices[joint]

    @needs_numpy
    def test_each_kind_moves_its_joint(self):
        joint = self.jaw
        neutral = self.deformer.bind_matrices[joint].copy()
        target = neutral[:3, 3] + [0, 0, 100]
        kinds = (
            (mien.AimSolver(joint, (1, 0, 0), target_curve=1, up_axis=(0, 1, 0)), [0, *target]),
            (mien.SpringSolver(joint, 2, 0.5, rest_offset=(1, 0, 0)), None),
            (mien.CustomSolver(lambda poses, ticks: poses[0].locals.__setitem__(
                (joint, 1), 3), [joint]), None))
        for solver, row in kinds:
            with self.subTest(type(solver).__name__):
                state = self.step(solver, row)
                if isinstance(solver, mien.SpringSolver):
                    self.body.update_from_values()
                    state.step(self.body, mien.ticks(9))
                self.assertFalse(numpy.allclose(self.matrix(joint), neutral))
                self.assertEqual(state.undeclared, "")
        for solver in (mien.SpaceSolver(joint, [mien.NO_JOINT, 0], 0),
                       mien.TwistSolver(0, (1, 0, 0), [joint], [0.5]),
                       mien.CopySolver(0, joint, True)):
            self.step(solver, [1.0])
        self.assertEqual(state.transforms.shape, (self.deformer.info.joint_count, 10))

    @needs_numpy
    def test_custom_solvers_keep_state_and_publish(self):
        seen = []

        def solve(poses, ticks):
            for pose in poses:
                pose.state[0] += 1
                pose.outputs[:] = pose.state[0]
                pose.locals[self.jaw, 0] += pose.row[1]
                seen.append((ticks, pose.lod, pose.is_reset, pose.previous.shape, pose))

        solver = mien.CustomSolver(solve, [self.jaw], [self.jaw], [self.jaw], 1, 2, "hat")
        state = self.step(solver, [0.0, 2.0])
        self.body.update_from_values()
        state.step(self.body, 5, [0.0, 2.0], lod=1)
        self.assertEqual([s[:4] for s in seen],
                         [(FRAME, 0, True, (1, 16)), (5, 1, False, (1, 16))])
        self.assertEqual(list(state.outputs(0)), [2.0, 2.0])
        kept = seen[0][4].locals
        state.close()
        self.body.close()
        del state
        gc.collect()
        self.assertEqual(kept.shape[1], 10)  # still memory
        self.assertTrue(numpy.isfinite(kept).all())

    def test_what_a_solver_raises_comes_out(self):
        def wrong(poses, ticks):
            raise RuntimeError("no")

        with self.assertRaisesRegex(RuntimeError, "no"):
            self.step(mien.CustomSolver(wrong, [self.jaw]))

    def test_writes_are_checked(self):
        def careless(poses, ticks):
            for i in range(len(poses[0].locals)):
                if numpy is None:
                    poses[0].locals[i] += 1
                else:
                    poses[0].locals[i, 0] += 1

        state = self.step(mien.CustomSolver(careless, [self.jaw], name="hat"))
        self.assertEqual(state.undeclared, "hat")

    def test_wrong_calls(self):
        jaw = self.jaw
        for error, solver in (
                (mien.OutOfRangeError, mien.SpringSolver(60000, 1, 1)),
                (mien.ArgumentError, mien.SpringSolver(jaw, 0, 1)),
                (mien.ArgumentError, mien.AimSolver(jaw, (0, 0, 0), 0)),
                (mien.OutOfRangeError, mien.AimSolver(jaw, (1, 0, 0))),
                (mien.ArgumentError, mien.TwistSolver(jaw, (1, 0, 0), [0], [0.5, 1])),
                (mien.ArgumentError, mien.CustomSolver(print, []))):
            with self.subTest(solver), self.assertRaises(error):
                mien.SolverStack(self.deformer, [solver])
        with self.assertRaises(TypeError):
            mien.SolverStack(self.deformer, ["spring"])
        stack = mien.SolverStack(self.deformer, [mien.SpringSolver(jaw, 1, 1)], curve_count=2)
        state = stack.state()
        with self.assertRaises(mien.ArgumentError):
            state.step(self.body, 1, [0.0])
        with self.assertRaises(mien.ArgumentError):
            state.undeclared
        with self.assertRaises(mien.OutOfRangeError):
            state.outputs(1)
        with self.assertRaises(mien.BusyError):
            mien.step_states([state, state], [self.body, self.deformer.instance()], 1,
                             [[0.0] * 2] * 2)
        state.close()
        with self.assertRaises(mien.ClosedError):
            state.step(self.body, 1)


if __name__ == "__main__":
    unittest.main()

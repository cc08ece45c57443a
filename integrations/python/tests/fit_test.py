# SPDX-License-Identifier: MIT
"""Derivatives and fits: products agree with differences and with each other, known controls come back, and
wrong arguments raise."""
import gc
import threading
import unittest
import weakref

import mien
from support import dna_of, needs_numpy, numpy, pattern, rig_of, run

RAW, JOINTS, POSITIONS = mien.Point.RAW, mien.Point.JOINTS, mien.Point.POSITIONS


def deformer_of():
    return mien.Deformer(dna_of(), rig_of())


def posed(phase=0):
    face = rig_of().instance()
    face.raw_controls = [0.05 + 0.9 * value for value in pattern(len(face.raw_controls), phase)]
    face.evaluate()
    return face


@needs_numpy
class Products(unittest.TestCase):
    def setUp(self):
        self.deformer, self.face = deformer_of(), posed()
        self.derivatives = mien.Derivatives(rig_of(), self.deformer)
        self.derivatives.linearize(self.face)
        self.random = numpy.random.default_rng(5)

    def test_directions_agree_with_differences(self):
        direction = self.random.normal(size=len(self.face.raw_controls))
        found = self.derivatives.jvp(direction)
        before, step = self.face.raw_controls.copy(), 1e-3
        values = []
        for sign in (1, -1):
            self.face.raw_controls = before + sign * step * direction
            self.face.evaluate()
            values.append(self.face.joints.astype("d").reshape(-1))
        wanted = (values[0] - values[1]) / (2 * step)
        numpy.testing.assert_allclose(found, wanted, atol=0.02 * abs(wanted).max())

    def test_gradients_are_the_transposed(self):
        for to in (JOINTS, POSITIONS):
            u = self.random.normal(size=(3, self.derivatives.size(RAW))).astype("f")
            v = self.random.normal(size=(3, self.derivatives.size(to))).astype("f")
            forward, reverse = self.derivatives.jvp(u, to=to), self.derivatives.vjp(v, to=to)
            norms = numpy.linalg.norm(forward, axis=1) * numpy.linalg.norm(v, axis=1)
            numpy.testing.assert_array_less(
                abs((forward * v).sum(1) - (u * reverse).sum(1)), 1e-4 * norms + 1e-6)
            numpy.testing.assert_array_equal(self.derivatives.jvp(u[1], to=to), forward[1])

    def test_a_rig_multiplies_at_a_pose(self):
        rig, raw = rig_of(), self.face.raw_controls.copy()
        u = self.random.normal(size=(3, len(raw))).astype("f")
        numpy.testing.assert_array_equal(rig.jvp(raw, u), self.derivatives.jvp(u))
        numpy.testing.assert_array_equal(rig.jvp(raw, u[1]), self.derivatives.jvp(u[1]))
        for to in (JOINTS, POSITIONS):
            v = self.random.normal(size=(2, self.derivatives.size(to))).astype("f")
            numpy.testing.assert_array_equal(rig.vjp(raw, v, self.deformer, to), self.derivatives.vjp(v, to=to))
            self.assertEqual(rig.vjp(raw, v[0], self.deformer, to).shape, raw.shape)
        # Another pose, and the first one again.
        other = posed(3)
        self.derivatives.linearize(other)
        numpy.testing.assert_array_equal(rig.jvp(other.raw_controls, u), self.derivatives.jvp(u))
        self.derivatives.linearize(self.face)
        expected = self.derivatives.jvp(u)
        results = [None] * 4

        def multiply(i):
            results[i] = [rig.jvp(raw, u) for _ in range(5)]
        threads = [threading.Thread(target=multiply, args=(i,)) for i in range(len(results))]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for result in results:
            for found in result:
                numpy.testing.assert_array_equal(found, expected)

    def test_a_rig_refuses_wrong_products(self):
        raw = self.face.raw_controls.copy()
        rig = mien.Rig(dna_of())
        rig.jvp(raw, raw)
        with self.assertRaises(mien.Error):
            rig.jvp(raw, raw, self.deformer, POSITIONS)  # of another rig
        for wrong in (lambda: rig.jvp(raw[:-1], raw), lambda: rig.jvp(raw, raw[:-1]),
                      lambda: rig.vjp(raw, raw), lambda: rig.jvp(raw, raw, to=RAW)):
            with self.assertRaises((mien.ArgumentError, ValueError)):
                wrong()
        with self.assertRaises(mien.OutOfRangeError):
            rig.jvp(raw, raw, to=POSITIONS)  # without a deformer
        self.assertEqual(rig.jvp(raw, raw).shape, (self.derivatives.size(JOINTS),))
        rig.close()
        with self.assertRaises(mien.ClosedError):
            rig.jvp(raw, raw)
        collected = mien.Rig(dna_of())
        collected.jvp(raw, raw)
        alive = weakref.ref(collected)
        del collected
        gc.collect()
        self.assertIsNone(alive())

    def test_the_matrix(self):
        whole = mien.Jacobian(self.derivatives)
        self.assertEqual(whole.shape, (self.derivatives.size(JOINTS), self.derivatives.size(RAW)))
        self.assertLessEqual(whole.directions, whole.shape[1])
        self.assertFalse(whole.rows.flags.writeable)
        values = self.derivatives.jacobian(whole)
        identity = numpy.eye(self.derivatives.size(RAW), dtype="f")
        numpy.testing.assert_array_equal(whole.dense(values), self.derivatives.jvp(identity).T)
        part = mien.Jacobian(self.derivatives, inputs=[3, 1], outputs=[0, 4, 9])
        numpy.testing.assert_array_equal(part.dense(self.derivatives.jacobian(part)),
                                         whole.dense(values)[[0, 4, 9]][:, [3, 1]])
        # Of another pose, by derivatives of their own, into an array that is there.
        other, out = mien.Derivatives(rig_of(), self.deformer), values.copy()
        other.linearize(posed(3))
        wanted = numpy.arange(whole.shape[1]) % 3 == 0
        self.assertIs(other.jacobian(whole, wanted=wanted, out=out), out)
        moved = wanted[whole.columns]
        numpy.testing.assert_array_equal(out[moved], other.jacobian(whole)[moved])
        numpy.testing.assert_array_equal(out[~moved], values[~moved])
        rows = whole.rows
        whole.close()
        self.assertGreater(rows.max(), 0)
        with self.assertRaises(mien.ClosedError):
            self.derivatives.jacobian(whole)

    def test_wrong_matrices(self):
        jacobian = mien.Jacobian(self.derivatives)
        for wrong in ({"inputs": [10 ** 6]}, {"to": POSITIONS, "mesh": 99}, {"lod": 40}):
            with self.assertRaises(mien.OutOfRangeError):
                mien.Jacobian(self.derivatives, **wrong)
        for wrong in ({"outputs": [4, 4]}, {"of": JOINTS, "to": RAW}):
            with self.assertRaises(mien.ArgumentError):
                mien.Jacobian(self.derivatives, **wrong)
        for wrong in ({"wanted": [True]}, {"out": numpy.zeros(3, "f")}, {"out": [0.0] * jacobian.rows.size}):
            with self.assertRaises(mien.ArgumentError):
                self.derivatives.jacobian(jacobian, **wrong)
        with self.assertRaises(mien.ArgumentError):
            mien.Derivatives(rig_of(), self.deformer).jacobian(jacobian)
        with self.assertRaises(mien.Error):
            mien.Derivatives(rig_of()).jacobian(jacobian)

    def test_wrong_arguments(self):
        with self.assertRaisesRegex(mien.ArgumentError, "rows of"):
            self.derivatives.jvp([1, 2, 3])
        with self.assertRaisesRegex(mien.ArgumentError, "rows of"):
            self.derivatives.vjp(numpy.zeros((2, 5)))
        with self.assertRaises(mien.ArgumentError):
            self.derivatives.jvp(numpy.zeros(self.derivatives.size(JOINTS)), of=JOINTS, to=RAW)
        with self.assertRaises(mien.OutOfRangeError):
            self.derivatives.size(POSITIONS, mesh=99)
        with self.assertRaises(mien.OutOfRangeError):
            mien.Derivatives(rig_of()).size(POSITIONS)
        with self.assertRaises(mien.ArgumentError):
            mien.Derivatives(rig_of()).jvp(numpy.zeros(self.derivatives.size(RAW)))
        self.derivatives.close()
        with self.assertRaises(mien.ClosedError):
            self.derivatives.size(RAW)


@needs_numpy
class Fits(unittest.TestCase):
    def test_joints(self):
        faces = [posed(phase) for phase in range(3)]
        found = mien.solve(rig_of(), joints=[face.joints for face in faces], max_iterations=200)
        seen = mien.Fit(rig_of()).observability > 0.05
        for face, row in zip(faces, found):
            numpy.testing.assert_allclose(row[seen], face.raw_controls[seen], atol=0.01)

    def test_points_moved_as_a_whole(self):
        deformer, face = deformer_of(), rig_of().instance()
        face.raw_controls = numpy.where(numpy.arange(len(face.raw_controls)) % 5 == 0, 0.6, 0)
        face.evaluate()
        pose = deformer.instance()
        pose.update(face)
        pose.deform(0)
        targets = pose.positions(0) + numpy.array([1, 2, 3], "f")
        targets[7] = numpy.nan
        result = mien.Fit(rig_of(), deformer).solve(points=targets, rigid=True, max_iterations=200)
        self.assertEqual(result.missing_points, 1)
        self.assertLess(result.point_residual, 0.02 * numpy.ptp(pose.positions(0)))
        numpy.testing.assert_allclose(result.rotation @ result.rotation.T, numpy.eye(3), atol=1e-4)
        some = numpy.arange(0, len(targets), 3)
        triangles = numpy.repeat(some[:, None], 3, 1)
        shares = numpy.tile([0.5, 0.25, 0.25], (len(some), 1))
        for chosen in (dict(positions=some), dict(positions=triangles, weights=shares)):
            fit = mien.Fit(rig_of(), deformer, **chosen)
            again = fit.solve(points=pose.positions(0)[some], max_iterations=200)
            self.assertLess(again.point_residual, 0.02 * numpy.ptp(pose.positions(0)))

    def test_bounds_and_controls_that_may_move(self):
        face = posed()
        count = len(face.raw_controls)
        fit = mien.Fit(rig_of(), controls=[2, 5], upper=0.25)
        row = fit.solve(joints=face.joints).controls
        moved = numpy.flatnonzero(row)
        self.assertTrue(set(moved) <= {2, 5}, moved)
        self.assertLessEqual(row.max(), 0.25)
        for wrong in (dict(controls=[5, 2]), dict(controls=[count]), dict(lower=2), dict(joint_weights=[1]),
                      dict(positions=[0]), dict(symmetric=[1])):
            with self.assertRaises(mien.Error, msg=wrong):
                mien.Fit(rig_of(), **wrong)

    def test_images(self):
        deformer = deformer_of()
        mesh = deformer.mesh(0)
        size = float(numpy.ptp(mesh.positions))
        camera = mien.FitCamera((500, 500), (320, 240), translation=(0, 0, 10 * size))
        fit = mien.Fit(rig_of(), deformer)
        placed = mesh.positions + numpy.array(camera.translation, "f")
        images = 500 * placed[:, :2] / placed[:, 2:] + numpy.array(camera.center, "f")
        result = fit.solve(images=images, camera=camera)
        self.assertLess(result.point_residual, 0.5)
        self.assertEqual(result.image_residual, result.point_residual)
        mixed = fit.solve(images=images + 50, camera=camera, points=mesh.positions, image_weight=1e-12)
        self.assertLess(mixed.point_residual, 1e-3 * size)
        self.assertGreater(mixed.image_residual, 40)
        with self.assertRaises(mien.ArgumentError):
            fit.solve(images=images)

    def test_points_on_several_meshes(self):
        deformer, face = deformer_of(), posed()
        pose = deformer.instance()
        pose.update(face)
        for mesh in (0, 1):
            pose.deform(mesh)
        meshes, positions = [1, 0, 1, 0], [0, 1, 2, 3]
        targets = numpy.array([pose.positions(mesh).reshape(-1, 3)[p] for mesh, p in zip(meshes, positions)])
        with mien.Fit(rig_of(), deformer, mesh=meshes, positions=positions) as fit:
            self.assertLess(fit.solve(points=targets, start=face.raw_controls).point_worst, 1e-4)
        for wrong in ([0, 1], [[0, 1, 0, 1]], [0, 1, 0, -1], [0, 1, 0, 0.5], [0, 1, 0, 99], 2**32):
            with self.assertRaises(mien.Error, msg=wrong):
                mien.Fit(rig_of(), deformer, mesh=wrong, positions=positions)

    def test_surfaces(self):
        deformer, face = deformer_of(), posed()
        pose = deformer.instance()
        pose.update(face)
        pose.deform(0)
        mesh = deformer.mesh(0)
        corners = mesh.vertex_position_indices[mesh.triangles].reshape(-1, 3)
        # Positions in another order.
        order = numpy.random.default_rng(5).permutation(mesh.position_count)
        places = numpy.empty(len(order), "uint32")
        places[order] = numpy.arange(len(order), dtype="uint32")
        surface = mien.FitSurface(pose.positions(0).reshape(-1, 3)[order], places[corners])
        with mien.Fit(rig_of(), deformer) as fit:
            # From the pose itself, nothing is left to do.
            result = fit.solve(surface=surface, start=face.raw_controls)
            self.assertLess(result.point_worst, 1e-3)
            numpy.testing.assert_allclose(result.controls, face.raw_controls, atol=1e-3)
            # Points of another pose draw from it, as much as they weigh; a surface that nothing is drawn to does not.
            points = mesh.positions
            mixed = fit.solve(surface=surface, points=points, start=face.raw_controls)
            self.assertGreater(mixed.surface_residual, result.surface_residual)
            self.assertGreater(mixed.point_residual, 0)
            self.assertEqual(mixed.image_residual, 0)
            alone = fit.solve(surface=surface, points=points, surface_weights=numpy.zeros(len(points)))
            self.assertEqual(alone.surface_residual, 0)
            self.assertLess(alone.point_residual, mixed.point_residual)
            with self.assertRaises(mien.ArgumentError):
                fit.solve(surface=surface, surface_weights=[1])
        for positions, triangles in (([1, 2, 3], [[0, 0, 0]]), ([[1, 2, 3]], [[0, 0, 1.5]]), ([[1, 2, 3]], [[0, 0, -1]]),
                                     ([[1, 2, 3]], [[0, 0, 2**32]]), ([[1, 2, 3]], [0, 0, 0])):
            with self.assertRaises(mien.ArgumentError):
                mien.FitSurface(positions, triangles)
        with self.assertRaises(mien.Error):
            mien.FitSurface([[1, 2, 3]], [[0, 0, 1]])

    def test_another_persons_points(self):
        """Points that are elsewhere at rest, by as much as is told."""
        deformer, face = deformer_of(), posed()
        pose = deformer.instance()
        pose.update(face)
        pose.deform(0)
        points = numpy.array(pose.positions(0))
        offsets = numpy.random.default_rng(4).uniform(-1, 1, points.shape)
        with mien.Fit(rig_of(), deformer) as fit:
            told = fit.solve(points=points + offsets, point_offsets=offsets, start=face.raw_controls)
            plain = fit.solve(points=points + offsets, start=face.raw_controls)
            self.assertLess(told.point_worst, 1e-3)
            self.assertGreater(plain.point_residual, 0.1)
            with self.assertRaises(mien.ArgumentError):
                fit.solve(points=points, point_offsets=offsets[1:])
            with self.assertRaises(mien.ArgumentError):
                fit.solve(points=points, point_offsets=offsets * numpy.nan)

    def test_constraints_and_stages(self):
        rig = rig_of()
        fit = mien.Fit(rig, deformer_of(), positions=[0, 1, 2])
        apart = fit.solve(points=numpy.full((3, 3), numpy.nan), constraints=[
            mien.FitConstraint(mien.FitConstraintKind.POINT_DISTANCE, points=(0, 1), distances=(0, 1e6))])
        self.assertEqual(apart.constraint_residual, 0)
        self.assertFalse(apart.jumped)
        nearer = [fit.solve(prior_weight=1e-3, constraints=[mien.FitConstraint(
            mien.FitConstraintKind.JOINT_POSITION, joint=1, target=(0, 0, 0), weight=weight)])
            for weight in (1, 100)]
        self.assertLessEqual(nearer[1].constraint_worst, nearer[0].constraint_worst + 1e-4)
        stages = numpy.arange(len(nearer[0].controls)) % 2
        staged = fit.solve(prior_weight=1e-3, stages=stages, constraints=[
            mien.FitConstraint(mien.FitConstraintKind.JOINT_AIM, joint=1, target=(0, 0, 10))])
        self.assertGreater(staged.constraint_worst, 0)
        for wrong in ({"stages": stages + 16}, {"constraints": [mien.FitConstraint(99)]}):
            with self.assertRaises(mien.Error):
                fit.solve(prior_weight=1, **wrong)
        with self.assertRaises(mien.Error):
            fit.solve(stages=[0])

    def test_frames_of_a_motion(self):
        faces = [posed(phase) for phase in (0, 0.1, 0.2)]
        joints = numpy.stack([numpy.array(face.joints, "f").reshape(-1) for face in faces])
        fit = mien.Fit(rig_of())
        found = fit.solve_frames(3, joints=joints)
        start = None
        for f, result in enumerate(found):
            one = fit.solve(joints=joints[f], start=start)
            start = one.controls
            self.assertLess(abs(result.controls - one.controls).max(), 0.05)
            self.assertLess(result.joint_residual, one.joint_residual + 0.01)
        self.assertEqual(fit.solve_frames(0), [])
        raised = []

        def stop():
            raised.append(1)
            raise ZeroDivisionError("zero")
        with self.assertRaisesRegex(ZeroDivisionError, "zero"):
            fit.solve_frames(3, joints=joints, canceled=stop)
        self.assertEqual(len(raised), 1)
        for count, wrong in ((3, dict(joints=joints[:, 1:])), (2, dict(joints=joints)), (3, dict(joints=joints, start=[0])),
                             (-1, {}), (3, dict(joints=joints, smooth_weight=-1))):
            with self.assertRaises(mien.Error, msg=wrong):
                fit.solve_frames(count, **wrong)
        with self.assertRaises(TypeError):
            fit.solve_frames(3, joint=joints)

    def test_frames_of_points(self):
        deformer = deformer_of()
        rows = []
        for phase in (0, 0.2):
            pose = deformer.instance()
            pose.update(posed(phase))
            pose.deform(0)
            rows.append(numpy.array(pose.positions(0)).reshape(-1, 3))
        fit = mien.Fit(rig_of(), deformer)
        first, second = fit.solve_frames(2, points=numpy.stack(rows))
        one = fit.solve(points=rows[0])
        self.assertTrue((first.controls == one.controls).all())
        self.assertTrue((second.controls == fit.solve(points=rows[1], start=one.controls).controls).all())

    def test_deformers_of_some_positions(self):
        whole, face = deformer_of(), posed()
        some = whole.subset(0, [1, 3])
        rows = []
        for deformer in (whole, some):
            pose = deformer.instance()
            pose.update(face)
            pose.deform(0)
            rows.append(numpy.array(pose.positions(0)))
        self.assertTrue((rows[1] == rows[0][[1, 3]]).all())
        for wrong in ([3, 1], [10 ** 9]):
            with self.assertRaises(mien.Error):
                whole.subset(0, wrong)

    def test_stops(self):
        fit, face = mien.Fit(rig_of()), posed()
        self.assertEqual(fit.solve(joints=face.joints, canceled=lambda: True).status, mien.FitStatus.CANCELED)
        self.assertEqual(fit.solve().status, mien.FitStatus.NO_DATA)
        with self.assertRaisesRegex(ZeroDivisionError, "zero"):
            fit.solve(joints=face.joints, canceled=lambda: 1 / 0)
        for wrong in (dict(joints=[1]), dict(joints=face.joints, start=[1]), dict(sparse_weight=-1, joints=face.joints),
                      dict(points=[1, 2, 3])):
            with self.assertRaises(mien.ArgumentError, msg=wrong):
                fit.solve(**wrong)

    def test_one_thread_at_a_time(self):
        fit, face, raised = mien.Fit(rig_of()), posed(), []

        def other():
            try:
                fit.solve()
            except mien.BusyError as error:
                raised.append(error)

        def ask():
            thread = threading.Thread(target=other)
            thread.start()
            thread.join()
            return True
        fit.solve(joints=face.joints, canceled=ask)
        self.assertEqual(len(raised), 1)

    def test_rigs_may_be_closed(self):
        with mien.Dna.generate(mien.Preset.TINY) as dna:
            rig = mien.Rig(dna)
        fit = mien.Fit(rig)
        count = rig.instance().joints.shape
        rig.close()
        del rig
        gc.collect()
        self.assertEqual(fit.solve(joints=numpy.zeros(count)).status, mien.FitStatus.CONVERGED)

    def test_keys(self):
        curve = numpy.concatenate([numpy.linspace(0, 1, 20), numpy.linspace(1, 0.5, 30)[1:]])
        keys = mien.reduce_keys(curve, 1e-4)
        self.assertEqual(keys.tolist(), [0, 19, 48])
        bent = numpy.sin(numpy.arange(200) / 20)
        keys = mien.reduce_keys(bent, 0.01)
        self.assertLess(len(keys), 40)
        numpy.testing.assert_allclose(numpy.interp(numpy.arange(200), keys, bent[keys]), bent, atol=0.0101)
        self.assertEqual(mien.reduce_keys([3], 0).tolist(), [0])
        self.assertEqual(mien.reduce_keys([], 0).tolist(), [])
        for wrong in (([1, float("nan")], 0), ([1, 2], -1), ([1, 2], float("inf"))):
            with self.assertRaises(mien.ArgumentError):
                mien.reduce_keys(*wrong)


class WithoutNumpy(unittest.TestCase):
    def test_it_says_so(self):
        self.assertIn("NumPy", run(
            "import mien\ntry:\n  mien.Fit(mien.Rig(mien.Dna.generate(mien.Preset.TINY)))\n"
            "except ImportError as error:\n  print(error)", without_numpy=True))


if __name__ == "__main__":
    unittest.main()

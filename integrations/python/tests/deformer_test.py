# SPDX-License-Identifier: MIT
"""Deformers and poses: shapes, lifetimes, misuse, threads."""
import copy
import functools
import gc
import pickle
import threading
import unittest
import weakref
from concurrent.futures import ThreadPoolExecutor

import mien
from support import dna_of, fresh_rig, needs_numpy, numpy, pattern, rig_of, run


@functools.lru_cache(maxsize=None)
def deformer_of(preset=mien.Preset.SMALL):
    return mien.Deformer(dna_of(preset), rig_of(preset))


def posed(preset=mien.Preset.SMALL, phase=0):
    """A character that shows something, and its pose."""
    face = rig_of(preset).instance()
    face.raw_controls = pattern(len(face.raw_controls), phase)
    face.evaluate()
    pose = deformer_of(preset).instance()
    pose.update(face)
    return face, pose


class Values(unittest.TestCase):
    @needs_numpy
    def test_shapes(self):
        deformer, rig = deformer_of(), rig_of()
        joints = rig.count(mien.Kind.JOINT)
        face, pose = posed()
        self.assertEqual(deformer.info.mesh_count, rig.count(mien.Kind.MESH))
        for mesh in deformer.meshes:
            self.assertEqual(mesh.name, rig.name(mien.Kind.MESH, mesh.index))
            self.assertTrue(mesh.lods)
            self.assertEqual(mesh.positions.shape, (mesh.position_count, 3))
            self.assertEqual(mesh.normals.shape, (mesh.vertex_count, 3))
            self.assertEqual(mesh.texture_coordinates.shape, (mesh.vertex_count, 2))
            self.assertEqual(mesh.vertex_position_indices.shape, (mesh.vertex_count,))
            self.assertEqual(mesh.triangles.shape, (mesh.triangle_count, 3))
            self.assertEqual(mesh.target_channels.shape, (mesh.target_count,))
            self.assertLess(mesh.vertex_position_indices.max(), mesh.position_count)
            self.assertLess(mesh.triangles.max(), mesh.vertex_count)
            pose.deform(mesh.index)
            self.assertEqual(pose.positions(mesh.index).shape, mesh.positions.shape)
            self.assertEqual(pose.normals(mesh.index).shape, mesh.normals.shape)
            who, weights = deformer.influences(mesh.index, 0)
            self.assertEqual((who.shape, who.dtype), (weights.shape, numpy.uint16))
            if mesh.target_count:
                self.assertEqual(deformer.target(mesh.index, 0).shape, mesh.positions.shape)
        small = mien.Deformer(dna_of(), rig_of(), storage=mien.Storage.BIT_16, delta_error=0.001)
        self.assertLess(small.info.deformer_bytes, deformer.info.deformer_bytes)
        for exact, mesh in zip(deformer.meshes, small.meshes):
            numpy.testing.assert_array_equal(mesh.triangles, exact.triangles)
            numpy.testing.assert_allclose(mesh.texture_coordinates, exact.texture_coordinates, atol=1e-5)
        for matrices in (deformer.bind_matrices, deformer.inverse_bind_matrices,
                         pose.joint_matrices, pose.skin_matrices):
            self.assertEqual(matrices.shape, (joints, 4, 4))
            numpy.testing.assert_array_equal(matrices[:, 3], [[0, 0, 0, 1]] * joints)
        self.assertEqual(pose.local_transforms.shape, (joints, 10))

    @needs_numpy
    def test_matrices_multiply_as_they_are(self):
        face, pose = posed()
        deformer = pose.deformer
        numpy.testing.assert_allclose(deformer.bind_matrices @ deformer.inverse_bind_matrices,
                                      numpy.eye(4)[None].repeat(len(face.joints), 0), atol=1e-3)
        numpy.testing.assert_allclose(pose.joint_matrices @ deformer.inverse_bind_matrices,
                                      pose.skin_matrices, atol=1e-3)

    @needs_numpy
    def test_ways_to_the_same_positions(self):
        for preset in (mien.Preset.SMALL, mien.Preset.LARGE):
            face, pose = posed(preset)
            pose.deform(0)
            wanted, normals = pose.positions(0).copy(), pose.normals(0).copy()
            self.assertTrue((wanted != pose.deformer.mesh(0).positions).any())
            others = [pose.deformer.instance([0]) for _ in range(3)]
            wide = numpy.zeros((len(face.joints), 18))
            wide[:, ::2] = face.joints
            others[0].update_from_values(wide[:, ::2], face.blend_shapes.astype(">f8"))
            others[1].update_from_values(face.joints.ravel().tolist(), list(face.blend_shapes))
            others[2].update(face)
            mien.deform_batch(others, 0)
            with ThreadPoolExecutor(4) as threads:
                pose.deform(0, threads=threads)
                mien.deform_batch(others + [pose], 0, threads=threads)
            for other in others + [pose]:
                numpy.testing.assert_array_equal(other.positions(0), wanted)
                numpy.testing.assert_array_equal(other.normals(0), normals)
        pose.update_from_values()
        pose.deform(0, mien.Normals.NONE)
        numpy.testing.assert_array_equal(pose.normals(0), normals)
        numpy.testing.assert_allclose(pose.positions(0), pose.deformer.mesh(0).positions, atol=1e-4)

    @needs_numpy
    def test_vertices_in_arrays_of_the_caller(self):
        dna, rig = dna_of(mien.Preset.SMALL), rig_of(mien.Preset.SMALL)
        deformer = mien.Deformer(dna, rig, with_tangents=True)
        face, _ = posed()
        instances = [deformer.instance() for _ in range(2)]
        mesh = deformer.mesh(0)
        self.assertEqual(mesh.tangents.shape, (mesh.vertex_count, 4))
        vertex = numpy.dtype([("position", "f4", 3), ("normal", "u4"), ("tangent", "i2", 4),
                              ("color", "u4")])
        buffers = [numpy.full(mesh.vertex_count + 1, 7, vertex) for _ in instances]
        fields = [tuple(buffer[name] for name in ("position", "normal", "tangent"))
                  for buffer in buffers]
        for instance in instances:
            instance.update(face)
        instances[0].write_vertices(0, *fields[0])
        expected = instances[0].positions(0)[mesh.vertex_position_indices]
        numpy.testing.assert_array_equal(buffers[0]["position"][:-1], expected)
        words = buffers[0]["normal"][:-1]
        normals = numpy.stack([(words << (22 - 10 * k)).astype("i4") >> 22 for k in range(3)], 1)
        numpy.testing.assert_allclose(normals / 511, instances[0].normals(0), atol=0.51 / 511)
        self.assertEqual(set(abs(buffers[0]["tangent"][:-1, 3])), {32767})
        self.assertEqual(set(buffers[0]["color"]), {7})
        self.assertEqual(buffers[0][-1]["normal"], 7)
        with ThreadPoolExecutor(2) as threads:
            mien.write_vertices_batch(instances, 0, fields, threads=threads)
        self.assertEqual(buffers[0].tobytes(), buffers[1].tobytes())
        wide = numpy.zeros((mesh.vertex_count, 4), "f4")
        instances[0].write_vertices(0, tangents=wide, mode=mien.Normals.SKINNED)
        numpy.testing.assert_allclose((wide[:, :3] ** 2).sum(1), 1, atol=1e-5)

    @needs_numpy
    def test_arrays_that_are_no_vertices(self):
        deformer = deformer_of()
        instance, count = deformer.instance(), deformer.mesh(0).vertex_count
        good = numpy.zeros((count, 3), "f4")
        frozen = good.copy()
        frozen.flags.writeable = False
        for wrong in (good.astype("f8"), good.astype(">f4"), good[:, :2], good[:-1], good[::-1],
                      good.ravel(), good.T.copy().T, frozen, numpy.zeros((), "f4"),
                      numpy.zeros((count, 4), "i2"), numpy.zeros(count, "u4")):
            with self.assertRaises(mien.ArgumentError):
                instance.write_vertices(0, wrong)
        with self.assertRaises(mien.ArgumentError):
            instance.write_vertices(0)
        with self.assertRaises(mien.ArgumentError):  # the deformer has none
            instance.write_vertices(0, tangents=numpy.zeros((count, 4), "f4"))
        with self.assertRaises(mien.ArgumentError):
            instance.write_vertices(0, good, good)
        with self.assertRaises(mien.ArgumentError):
            mien.write_vertices_batch([instance], 0, [])
        with self.assertRaises(TypeError):
            instance.write_vertices(0, [1, 2, 3])
        instance.write_vertices(0, good)

    def test_without_numpy(self):
        run("""
import mien
dna = mien.Dna.generate(mien.Preset.SMALL)
rig = mien.Rig(dna)
deformer = mien.Deformer(dna, rig)
face, pose = rig.instance(), deformer.instance()
face.raw_controls = 0.5
face.evaluate()
pose.update(face)
pose.deform(0)
wanted = bytes(pose.positions(0))
pose.update_from_values(face.joints, face.blend_shapes)
pose.deform(0)
assert bytes(pose.positions(0)) == wanted
assert len(pose.positions(0)) == deformer.mesh(0).position_count * 3
assert len(pose.local_transforms) == len(pose.joint_matrices) // 16 * 10
count = deformer.mesh(0).vertex_count
memory = bytearray(count * 12)
pose.write_vertices(0, memoryview(memory).cast("f", (count, 3)))
assert bytes(pose.positions(0))[:12] in memory
""", without_numpy=True)


class Lifetime(unittest.TestCase):
    @needs_numpy
    def test_arrays_survive_everything(self):
        with mien.Dna.generate(mien.Preset.SMALL) as dna:
            rig = mien.Rig(dna)
            deformer = mien.Deformer(dna, rig)
        face, pose = rig.instance(), deformer.instance()
        face.raw_controls = 0.5
        face.evaluate()
        pose.update(face)
        pose.deform(0)
        mesh, positions, matrices = deformer.mesh(0), pose.positions(0), pose.skin_matrices[3]
        triangles, wanted = mesh.triangles, (positions.copy(), matrices.copy())
        for thing in (rig, face, deformer):
            thing.close()
        pose.deform(0)  # needs nothing of these any more
        for thing in (pose, pose, deformer):
            thing.close()
        del rig, face, deformer, pose, thing, mesh
        gc.collect()
        fresh_rig(mien.Preset.SMALL).batch(9).evaluate()
        numpy.testing.assert_array_equal(positions, wanted[0])
        numpy.testing.assert_array_equal(matrices, wanted[1])
        self.assertLess(triangles.max(), 10**6)

    def test_everything_raises_after_close(self):
        with mien.Dna.generate() as dna:
            rig = mien.Rig(dna)
            deformer = mien.Deformer(dna, rig)
        face, pose, other = rig.instance(), deformer.instance(), deformer.instance()
        pose.close()
        for use in (lambda: pose.update(face), lambda: pose.update_from_values(),
                    lambda: pose.deform(0), lambda: pose.positions(0), lambda: pose.normals(0),
                    lambda: pose.joint_matrices, lambda: pose.local_transforms,
                    lambda: mien.deform_batch([other, pose], 0), pose.__enter__):
            with self.assertRaises(mien.ClosedError):
                use()
        other.deform(0)  # the batch that failed let go of it
        face.close()
        with self.assertRaises(mien.ClosedError):
            other.update(face)
        deformer.close()
        for use in (lambda: deformer.mesh(0), lambda: deformer.instance(),
                    lambda: deformer.target(0, 0),
                    lambda: deformer.bind_matrices, lambda: deformer.influences(0, 0),
                    lambda: mien.Deformer(dna, rig)):
            with self.assertRaises(mien.ClosedError):
                use()
        other.deform(0)

    def test_memory_is_released_at_once(self):
        with mien.Dna.generate() as dna:
            deformer = mien.Deformer(dna, mien.Rig(dna))
        pose = deformer.instance()
        handles = weakref.ref(pose._handle), weakref.ref(deformer._handle)
        array = pose.positions(0)
        pose.close()
        deformer.close()
        self.assertEqual([handle() is None for handle in handles], [False, True])
        del array
        self.assertIsNone(handles[0]())

    def test_addresses_do_not_travel(self):
        for thing in (deformer_of(), deformer_of().instance()):
            for travel in (pickle.dumps, copy.copy, copy.deepcopy):
                with self.assertRaises(TypeError):
                    travel(thing)


class Misuse(unittest.TestCase):
    @needs_numpy
    def test_values(self):
        face, pose = posed()
        joints, weights = face.joints, face.blend_shapes
        for wrong in (joints[1:], joints.T, joints[:, :8], joints.ravel()[1:], joints[None],
                      numpy.zeros(0), 1.0):
            with self.assertRaises(mien.ArgumentError):
                pose.update_from_values(wrong, weights)
        for wrong in (weights[1:], weights[None], numpy.zeros((0, 3)), 0):
            with self.assertRaises(mien.ArgumentError):
                pose.update_from_values(joints, wrong)
        for wrong in ("text", joints.astype(complex), numpy.array([None] * 9), object()):
            with self.assertRaises(TypeError):
                pose.update_from_values(wrong)
        for array in (pose.positions(0), pose.joint_matrices, deformer_of().mesh(0).positions):
            with self.assertRaises(ValueError):
                array[0] = 1
            with self.assertRaises(ValueError):
                array.flags.writeable = True

    def test_numbers(self):
        face, pose = posed()
        deformer = pose.deformer
        for mesh in (deformer.info.mesh_count, -1, 2**32):
            for use in (pose.deform, pose.positions, pose.normals, deformer.mesh,
                        lambda mesh: deformer.influences(mesh, 0),
                        lambda mesh: deformer.target(mesh, 0),
                        lambda mesh: mien.deform_batch([pose], mesh)):
                with self.assertRaises(mien.OutOfRangeError):
                    use(mesh)
        for use in (lambda: deformer.target(0, 10**6), lambda: deformer.influences(0, 10**9)):
            with self.assertRaises(mien.OutOfRangeError):
                use()
        for use in (lambda: pose.deform(0, 99),
                    lambda: mien.Deformer(dna_of(), rig_of(), compose=9),
                    lambda: mien.Deformer(dna_of(), rig_of(), weights=9), lambda: deformer.instance([]),
                    lambda: deformer.instance([64])):
            with self.assertRaises(mien.ArgumentError):
                use()
        mien.deform_batch([], 0)

    def test_strangers(self):
        stranger = fresh_rig()
        pose = deformer_of().instance()
        for use in (lambda: pose.update(stranger.instance()),
                    lambda: mien.Deformer(dna_of(), stranger),
                    lambda: mien.deform_batch([pose, mien.Deformer(dna_of(), rig_of()).instance()], 0)):
            with self.assertRaises(mien.ArgumentError) as caught:
                use()
            self.assertEqual(caught.exception.status, mien.Status.MISMATCH)
        with self.assertRaises(mien.BusyError):
            mien.deform_batch([pose, pose], 0)
        pose.deform(0)
        bare = mien.Dna.from_bytes(dna_of().to_bytes(), layers=mien.Layer.BEHAVIOR)
        with self.assertRaises(mien.DnaError) as caught:
            mien.Deformer(bare, mien.Rig(bare))
        self.assertEqual(caught.exception.status, mien.Status.DNA_LAYER)
        small = deformer_of(mien.Preset.LARGE).instance([7])
        with self.assertRaises(mien.OutOfRangeError):
            small.deform(0)


class Threads(unittest.TestCase):
    @needs_numpy
    def test_a_pool_that_was_shut_down(self):
        face, pose = posed(mien.Preset.LARGE)
        pose.deform(0)
        wanted = pose.positions(0).copy()
        pool = ThreadPoolExecutor(2)
        pool.shutdown()
        with self.assertRaises(RuntimeError):
            pose.deform(0, threads=pool)
        numpy.testing.assert_array_equal(pose.positions(0), wanted)

    def test_an_interrupt_while_the_library_runs(self):
        """Ctrl-C ends the waiting; the library goes on in its thread, and the pose stays busy."""
        run("""
import _thread, mien, signal, time
from concurrent.futures import ThreadPoolExecutor
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background jobs ignore it
class Interrupting(ThreadPoolExecutor):
    def submit(self, function, *arguments):
        def job():
            time.sleep(0.2)  # the main thread waits by now
            if function.__name__ == "job":
                _thread.interrupt_main()
                time.sleep(0.2)
            return function(*arguments)
        return super().submit(job)
dna = mien.Dna.generate(mien.Preset.LARGE)
deformer = mien.Deformer(dna, mien.Rig(dna))
pose = deformer.instance()
pool = Interrupting(3)
for _ in range(2):
    try:
        pose.deform(0, threads=pool)
        time.sleep(1)
        raise AssertionError("not interrupted")
    except KeyboardInterrupt:
        pass
deformer.close()
array = pose.positions(0)
pose.close()
pool.shutdown()
assert bytes(array)
""")

    @needs_numpy
    def test_eight_threads_on_one_deformer(self):
        wanted = []
        for i in range(8):
            face, pose = posed(phase=i)
            pose.deform(0)
            wanted.append(pose.positions(0).copy())
        failures = []

        def work(i):
            try:
                for _ in range(10):
                    face, pose = posed(phase=i)
                    pose.deform(0)
                    numpy.testing.assert_array_equal(pose.positions(0), wanted[i])
            except BaseException as error:
                failures.append(error)

        threads = [threading.Thread(target=work, args=(i,)) for i in range(8)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(failures, [])

    def test_eight_threads_on_one_pose(self):
        face, pose = posed(mien.Preset.LARGE)
        done, failures = [0] * 8, []

        def work(i):
            for turn in range(30):
                try:
                    (pose.deform(0) if turn % 3 else pose.update(face))
                    done[i] += 1
                except mien.BusyError:
                    pass
                except BaseException as error:
                    failures.append(error)

        threads = [threading.Thread(target=work, args=(i,)) for i in range(8)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(failures, [])
        self.assertGreater(sum(done), 0)


if __name__ == "__main__":
    unittest.main()

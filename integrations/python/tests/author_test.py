# SPDX-License-Identifier: MIT
"""Rigs from arrays: what goes in, what comes out, and every wrong array."""
import os
import subprocess
import sys
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import mien
from support import needs_numpy, numpy, run

EXAMPLE = Path(__file__).resolve().parents[3] / "examples" / "author.py"
ROWS, COLUMNS = 24, 28


def egg():
    """Positions and quads of an egg with a nose, and two shapes of it."""
    v = numpy.repeat(numpy.linspace(0.03, 0.97, ROWS), COLUMNS) * numpy.pi
    u = numpy.tile(numpy.arange(COLUMNS) / COLUMNS, ROWS) * 2 * numpy.pi
    positions = numpy.stack([7 * numpy.sin(v) * numpy.sin(u), 10 * numpy.cos(v),
                             8.5 * numpy.sin(v) * numpy.cos(u)], 1)
    front = positions[:, 2] > 4
    positions[:, 2] += 2 * front * numpy.exp(-(positions[:, :2] ** 2).sum(1) / 4)
    cell = numpy.arange((ROWS - 1) * COLUMNS)
    beside = cell - cell % COLUMNS + (cell + 1) % COLUMNS
    # From the top down, columns to the left: counterclockwise from outside.
    faces = numpy.stack([cell, cell + COLUMNS, beside + COLUMNS, beside], 1)
    shapes = {}
    for name, at, by in (("smile", 3, (0.2, 0.5, -0.2)), ("puff", 4, (0.3, 0, 0.4))):
        x, y = abs(positions[:, 0]) - at, positions[:, 1] + 4
        shapes[name] = (numpy.exp(-(x * x + y * y) / 5) * front)[:, None] * by
    return positions, faces, shapes


FEW = {"facial_joints": 12, "lods": 1}


@needs_numpy
class Author(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.positions, cls.faces, cls.shapes = egg()

    def make(self, *arguments, **options):
        return mien.author_rig(*(arguments or (self.positions, self.faces)), **{**FEW, **options})

    def refused(self, message, *arguments, exception=mien.ArgumentError, **options):
        with self.assertRaisesRegex(exception, message):
            self.make(*arguments, **options)

    def test_a_mesh_with_shapes_becomes_a_rig_that_makes_them(self):
        steps = []
        dna, report = self.make(shapes=self.shapes, facial_joints=30,
                                progress=lambda step, share: steps.append((step, share)))
        self.assertEqual(mien.validate(dna.to_bytes()), [])
        self.assertEqual(set(report["fit"]["per_shape"]), set(self.shapes))
        self.assertEqual([share for _, share in steps], sorted(share for _, share in steps))
        self.assertTrue(all(step for step, _ in steps))
        rig = mien.Rig(dna)
        self.assertEqual(list(rig.names(mien.Kind.RAW_CONTROL)), list(self.shapes))
        face, deformer = rig.instance(), mien.Deformer(dna, rig)
        pose = deformer.instance()
        for name, shape in self.shapes.items():
            face.reset()
            face[name] = 1
            face.evaluate()
            pose.update(face)
            pose.deform(0)
            left = pose.positions(0) - (self.positions + shape)
            self.assertLess((left ** 2).sum() / (shape ** 2).sum(), 0.2 ** 2)

    def test_all_ways_to_give_the_same_mesh_give_the_same_bytes(self):
        expected = self.make(shapes=self.shapes).dna.to_bytes()
        sparse = {name: (numpy.flatnonzero(shape.any(1)), shape[shape.any(1)])
                  for name, shape in self.shapes.items()}
        strided = numpy.zeros((len(self.positions), 6))[:, ::2]
        strided[:] = self.positions
        for positions, faces, shapes in (
                (self.positions.tolist(), self.faces.tolist(), self.shapes),
                (strided, self.faces.astype("int16"), sparse),
                (numpy.asfortranarray(self.positions), self.faces.astype("uint64"), self.shapes),
                (self.positions.astype(">f8"), [tuple(face) for face in self.faces], sparse)):
            self.assertEqual(self.make(positions, faces, shapes=shapes).dna.to_bytes(), expected)
        with ThreadPoolExecutor(2) as pool:
            self.assertEqual(self.make(shapes=self.shapes, executor=pool).dna.to_bytes(), expected)

    def test_bones_and_weights_of_the_caller_are_taken(self):
        bones = [mien.AuthorBone("root", (0, 0, 0), 0, mien.BoneKind.ROOT),
                 mien.AuthorBone("head", (0, -5, 0), 0, mien.BoneKind.HEAD),
                 mien.AuthorBone("left", (4, 0, 7), 1), mien.AuthorBone("right", (-4, 0, 7), 1)]
        dna, report = self.make(bones=bones)
        self.assertTrue(report["own_bones"] and not report["own_weights"])
        rig = mien.Rig(dna)
        self.assertEqual(list(rig.names(mien.Kind.JOINT)), [bone.name for bone in bones])
        joints = numpy.zeros((len(self.positions), 2), int)
        joints[:] = numpy.where(self.positions[:, :1] > 0, (2, 1), (3, 1))
        weights = numpy.full(joints.shape, (0.75, 0.25))
        dna, report = self.make(bones=bones, weights=(joints, weights))
        self.assertTrue(report["own_weights"])
        numpy.testing.assert_array_equal(dna["geom.meshes[0].skinWeights[0].weights"],
                                         numpy.float32([0.75, 0.25]))
        self.refused(r"weights\[0\] has the shape", bones=bones, weights=(joints[1:], weights[1:]))
        self.refused(r"weights\[1\] has the shape", bones=bones, weights=(joints, weights[:, :1]))
        self.refused(r"weights\[0\] holds float64", bones=bones, weights=(weights, weights))
        self.refused(r"weights\[0\] holds -1", bones=bones, weights=(joints - 2, weights))
        self.refused("influences", bones=bones, weights=(joints, weights), influences=8)
        self.refused("bone", bones=bones, weights=(joints + 3, weights), exception=mien.AuthorError)
        self.refused("with bones", weights=(joints, weights))
        self.refused("bone 'left'", bones=bones[:2] + [bones[2]._replace(position=(1, 2))])

    def test_each_stage_takes_the_result_of_the_caller(self):
        count, front = len(self.positions), self.positions[:, 2]
        mask = (front > 5) & (self.positions[:, 1] > -6)
        _, report = self.make(mask=mask)
        self.assertEqual(report["mask"], numpy.flatnonzero(mask).tolist())
        groups = numpy.where(front > 6, 0, numpy.where(front > -3, 1, 2))
        _, report = self.make(depth_groups=groups)
        self.assertEqual(sum(report["groups"]["counts"]), report["mesh"]["vertices"])
        self.assertEqual(report["groups"]["counts"], numpy.bincount(groups).tolist())
        self.assertEqual(report["groups"]["borders"], [])
        _, report = self.make(lods=0, lod_joints=[12, 7, 4], symmetry=mien.Symmetry.OFF)
        self.assertEqual([lod["facial_joints"] for lod in report["lods"]], [12, 7, 4])

        bones = [mien.AuthorBone("root", (0, 0, 0), 0, mien.BoneKind.ROOT),
                 mien.AuthorBone("left", (4, 0, 7)), mien.AuthorBone("right", (-4, 0, 7))]
        motions = {"smile": [[0] * 6, [0.5, 1, 0, 0, 0, 10], [-0.5, 1, 0, 0, 0, -10]]}
        dna, report = self.make(shapes=self.shapes, bones=bones, bone_groups=[0, 7, 3],
                                bone_motions=motions)
        self.assertEqual(report["joint_groups"]["groups"], 2)
        rig = mien.Rig(dna)
        face = rig.instance()
        face["smile"] = 1
        face.evaluate()
        numpy.testing.assert_array_equal(
            numpy.asarray(face.joints).reshape(3, -1)[:, :6], numpy.float32(motions["smile"]))
        face.reset()
        face["puff"] = 1
        face.evaluate()
        self.assertFalse(numpy.any(face.joints))
        shapes = {**self.shapes, "grin": self.shapes["smile"]}
        dna, report = self.make(shapes=shapes, overlap_correctives=5)
        self.assertEqual(report["fit"]["correctives"], 1)

        self.refused("mask has the shape", mask=mask[1:])
        self.refused("depth_groups holds 0 to 300", depth_groups=[300] + [0] * (count - 1))
        self.refused("group 3", depth_groups=[3] * count, exception=mien.AuthorError)
        self.refused("0 of 672", mask=[False] * count, exception=mien.AuthorError)
        self.refused("lod_joints", lods=0, lod_joints=[5, 6])
        self.refused("lod_joints has 2 LODs, not 1", lod_joints=[5, 6])
        self.refused("with bones", bone_groups=[])
        self.refused("bone_groups has the shape", bones=bones, bone_groups=[0, 1])
        self.refused("joint group 256", bones=bones, bone_groups=[0, 1, 256],
                     exception=mien.AuthorError)
        self.refused("'frown', which is no shape", shapes=self.shapes, bones=bones,
                     bone_motions={"frown": motions["smile"]})
        self.refused("bone 0 moves", shapes=self.shapes, bones=bones,
                     bone_motions={"smile": numpy.ones((3, 6))}, exception=mien.AuthorError)
        self.refused("joint_groups", joint_groups=25)

    def test_further_lods_keep_the_share_of_triangles_that_is_asked_for(self):
        triangles = [[lod["triangles"] for lod in
                      self.make(lods=3, lod_triangles=share).report["lods"]]
                     for share in (0.5, 0.25, 1)]
        for counts, share in zip(triangles, (0.5, 0.25, 1)):
            self.assertAlmostEqual(counts[1] / counts[0], share, delta=0.01)
            self.assertAlmostEqual(counts[2] / counts[1], share, delta=0.03)
        for wrong in (-0.5, 1.5, float("nan")):
            self.refused("lod_triangles", lod_triangles=wrong)

    def test_meshes_of_lods_are_those_of_the_caller(self):
        corners = self.faces.size
        triangles = self.faces[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
        half, few = triangles[::2], triangles[:20]
        dna, report = self.make(lods=0, lod_meshes=[half, few])
        self.assertTrue(report["own_lod_meshes"])
        self.assertEqual([lod["triangles"] for lod in report["lods"]],
                         [len(triangles), len(half), len(few)])
        self.assertGreater(report["lods"][2]["surface_max"], 1)
        layouts = dna["geom.meshes[2].faces[7].layoutIndices"]
        positions = numpy.stack([dna[f"geom.meshes[2].positions.{k}"] for k in ("xs", "ys", "zs")], 1)
        numpy.testing.assert_allclose(
            positions[dna["geom.meshes[2].layouts.positions"][layouts].astype(int)],
            self.positions[few[7]], rtol=1e-6)
        uvs = numpy.arange(few.size).reshape(few.shape) % 2
        dna, _ = self.make(lods=2, lod_meshes=[(few, uvs)], uvs=[[0, 0.25], [1, 0.5]],
                           corner_uvs=numpy.zeros(corners, int))
        self.assertEqual(sorted(dna["geom.meshes[1].textureCoordinates.vs"]), [0.25, 0.5])

        self.refused("3 LODs beside the first, not 2", lods=3, lod_meshes=[half, half, few])
        self.refused(r"lod_meshes\[1\] has the shape", lods=0, lod_meshes=[half, few[:, :2]])
        self.refused(r"lod_meshes\[0\] holds float64", lods=0, lod_meshes=[half * 1.0])
        self.refused("UVs of", lods=0, lod_meshes=[(half, half[1:])])
        refused = mien.AuthorError
        self.refused("names position 672", lods=0, lod_meshes=[[[0, 1, 672]]], exception=refused)
        self.refused("LOD 2 has 0 corners", lods=0, lod_meshes=[half, []], exception=refused)
        self.refused("the mesh has none", lods=0, lod_meshes=[(few, uvs)], exception=refused)

    def test_objects_and_uvs_arrive(self):
        corners = self.faces.size
        dna, report = self.make(objects=[("skin", len(self.faces) - 20), ("cap", 20)],
                                uvs=[[0, 0], [1, 1]], corner_uvs=numpy.arange(corners) % 2)
        self.assertEqual(report["mesh"]["objects"], 2)
        names = mien.Rig(dna).names(mien.Kind.MESH)
        self.assertEqual([name.split("_")[0] for name in names], ["skin", "cap"])
        self.refused("corner_uvs has the shape", uvs=[[0, 0]], corner_uvs=[0])
        self.refused("uvs has the shape", uvs=[[0, 0, 0]], corner_uvs=numpy.zeros(corners, int))
        self.refused("go together", uvs=[[0, 0]])
        self.refused("face", objects=[("skin", 5)], exception=mien.AuthorError)

    def test_wrong_arrays_are_named(self):
        positions, faces = self.positions, self.faces
        self.refused(r"positions has the shape \(672, 2\)", positions[:, :2], faces)
        self.refused("positions has the shape", positions.ravel(), faces)
        self.refused("positions holds", [["a", "b", "c"]], faces)
        self.refused("positions holds complex128", positions * 1j, faces)
        self.refused("faces holds float64", positions, faces.astype(float))
        self.refused("faces holds -1", positions, faces - 1)
        self.refused("faces has the shape", positions, faces.ravel())
        self.refused("faces holds 0 to 4294967296", positions, [[0, 1, 2 ** 32]])
        self.refused("shape 'smile' has the shape", shapes={"smile": self.shapes["smile"][1:]})
        self.refused("shape 'smile' holds", shapes={"smile": self.shapes["smile"] > 0})
        self.refused("shape 'smile' has the shape", shapes={"smile": ([1, 2], [[0, 0, 1]])})
        refused = mien.AuthorError
        self.refused("position", positions, faces + 1, exception=refused)
        self.refused("finite", positions * numpy.nan, faces, exception=refused)
        self.refused("flat", positions * (1, 1, 0), faces, exception=refused)
        self.refused("face", positions, [], exception=refused)
        self.refused("shape", shapes={"smile": ([9999], [[0, 0, 1]])}, exception=refused)
        self.refused("name", shapes={"": self.shapes["smile"]}, exception=refused)
        self.refused("lods", lods=9)
        self.refused("lods -1", lods=-1, exception=mien.OutOfRangeError)
        self.refused("axis", up=mien.MeshAxis.X, front=mien.MeshAxis.MINUS_X)

    def test_progress_cancels_and_may_raise(self):
        with self.assertRaises(mien.AuthorError) as caught:
            self.make(progress=lambda step, share: share > 0.1)
        self.assertEqual(caught.exception.status, mien.Status.AUTHOR_CANCELED)

        def fail(step, share):
            raise KeyError(step)
        self.assertRaises(KeyError, self.make, progress=fail)
        with ThreadPoolExecutor(2) as pool:
            self.assertRaises(KeyError, self.make, progress=fail, executor=pool)

    def test_the_example_writes_a_valid_rig(self):
        with tempfile.TemporaryDirectory() as folder:
            out = os.path.join(folder, "head.dna")
            told = subprocess.run([sys.executable, str(EXAMPLE), out], check=True, capture_output=True,
                                  text=True, env={**os.environ, "MIEN_LIBRARY": mien.library_path}).stdout
            self.assertRegex(told, r"^\d+ joints, \d+\.\d % off$")
            self.assertEqual(mien.validate(out), [])


class WithoutNumPy(unittest.TestCase):
    def test_the_error_says_what_is_missing(self):
        told = run("import mien\ntry:\n  mien.author_rig([], [])\nexcept ImportError as e: print(e)",
                   without_numpy=True)
        self.assertIn("NumPy", told)


if __name__ == "__main__":
    unittest.main()

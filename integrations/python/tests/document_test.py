# SPDX-License-Identifier: MIT
"""Documents: fields, marks, operations with names and arrays, and the recipes of docs/editing.md."""
import os
import re
import tempfile
import unittest
from pathlib import Path

import mien
from mien import Kind
from support import dna_of, needs_numpy, numpy

PAGE = Path(__file__).resolve().parents[3] / "docs" / "editing.md"


def document(preset=mien.Preset.SMALL):
    return mien.Document(dna_of(preset))


class Fields(unittest.TestCase):
    def test_reads_as_a_file_does(self):
        def plain(value):
            if isinstance(value, dict):
                return {key: plain(member) for key, member in value.items()}
            if isinstance(value, list):
                return [plain(member) for member in value]
            return value.tolist() if hasattr(value, "tolist") else value
        with document() as doc:
            self.assertEqual(doc.fields(), dna_of().fields())
            for layer in doc.fields():
                self.assertEqual(plain(doc[layer]), plain(dna_of()[layer]), layer)
            self.assertEqual(doc.field("defn.jointNames").count, len(doc.names(Kind.JOINT)))

    def test_writes_every_type(self):
        with document() as doc:
            doc["desc.name"] = "Ada é"
            doc["desc.age"] = 33
            doc["defn.neutralJointTranslations.xs"] = [1.5] * \
                doc.field("defn.jointNames").count
            doc["desc.metadata"] = [{"key": "a", "value": "b"}]
            doc["desc.coordinateSystem"] = {"xAxis": 1}
            self.assertEqual((doc["desc.name"], doc["desc.age"]), ("Ada é", 33))
            self.assertEqual(set(doc["defn.neutralJointTranslations.xs"]), {1.5})
            self.assertEqual(doc["desc.metadata"], [{"key": "a", "value": "b"}])
            self.assertEqual(doc["desc.coordinateSystem"]["xAxis"], 1)
            self.assertEqual(doc.raw_bytes("desc.name"), "Ada é".encode())

    def test_layers_are_listed_anew(self):
        with document() as doc:
            known = doc.layers()
            self.assertEqual((doc.version, len(known), known[0].code), (8, 11, "desc"))
            doc.add_layer("note", 1, 2, b"a\0b")
            with mien.Document(doc.to_dna()) as again:
                self.assertEqual(again.layers()[-1], ("note", 1, 2, b"a\0b"))
            with self.assertRaises(mien.ArgumentError):
                doc.add_layer("note", 1, 2)
            doc.clear_layers()
            self.assertEqual((doc.layers(), doc.version), ([], 8))
            for layer in known:
                doc.add_layer(*layer)
            self.assertEqual(doc.to_bytes(), document().to_bytes())

    def test_controls_are_removed(self):
        with document() as doc:
            raw = doc.names(Kind.RAW_CONTROL)
            doc.remove(Kind.RAW_CONTROL, raw[:2])
            doc.remove(Kind.PSD_CONTROL, "psd0")
            self.assertEqual(doc.names(Kind.RAW_CONTROL), raw[2:])
            self.assertEqual(doc.validate(), [])

    def test_a_list_of_names_may_be_reversed(self):
        with document() as doc:
            names = doc.names(Kind.JOINT)
            doc["defn.jointNames"] = names[::-1]
            self.assertEqual(doc.names(Kind.JOINT), names[::-1])

    def test_a_write_that_fails_changes_nothing(self):
        with document() as doc:
            before = doc.to_bytes()
            for path, value, error in (
                    ("desc.metadata", [{"key": "a", "value": "b"}, {"key": 1}], AttributeError),
                    ("desc.age", 1 << 40, mien.ArgumentError), ("desc.age", 1.5, mien.ArgumentError),
                    ("desc.nothing", 1, mien.UnknownNameError), ("defn.jointNames[9999]", "a", mien.OutOfRangeError)):
                with self.assertRaises(error):
                    doc[path] = value
                self.assertEqual(doc.to_bytes(), before, path)

    def test_marks(self):
        with document() as doc:
            original = doc.to_bytes()
            doc.rename(Kind.JOINT, 0, "first")
            mark, renamed = doc.mark(), doc.to_bytes()
            doc.remove(Kind.MESH, 0)
            doc.undo(mark)
            self.assertEqual(doc.to_bytes(), renamed)
            doc.undo()
            self.assertEqual(doc.to_bytes(), original)
            with self.assertRaises(mien.OutOfRangeError):
                doc.undo(mark)

    def test_lists_and_arrays_change_their_length(self):
        with document() as doc:
            count = doc.field("desc.metadata").count
            doc.resize("desc.metadata", count + 1)
            self.assertEqual(doc["desc.metadata"][count], {"key": "", "value": ""})
            doc.splice("desc.metadata", 0, count + 1, 0)
            self.assertEqual(doc["desc.metadata"], [])

    def test_an_empty_document_and_closing(self):
        empty = mien.Document()
        self.assertEqual(empty.names(Kind.JOINT), [])
        empty.close()
        self.assertIn("closed", repr(empty))
        with self.assertRaises(mien.ClosedError):
            empty.fields()

    def test_what_is_not_valid_is_found(self):
        with document() as doc:
            self.assertEqual(doc.validate(), [])
            doc["defn.jointHierarchy"] = [9999] * doc.field("defn.jointNames").count
            self.assertTrue(doc.validate())
            with self.assertRaises(mien.DnaError):
                doc.to_dna()


class Operations(unittest.TestCase):
    def test_names(self):
        with document() as doc:
            joints = doc.names(Kind.JOINT)
            doc.rename(Kind.JOINT, joints[1], "jaw")
            self.assertEqual(doc.find(Kind.JOINT, "jaw"), 1)
            with self.assertRaises(mien.ArgumentError):
                doc.rename(Kind.JOINT, "jaw", joints[2])
            with self.assertRaises(mien.UnknownNameError):
                doc.find(Kind.JOINT, joints[1])
            doc.remove(Kind.JOINT, ["jaw", joints[2]])
            self.assertEqual(doc.names(Kind.JOINT), joints[:1] + joints[3:])
            self.assertEqual(doc.validate(), [])

    def test_joints(self):
        with document() as doc:
            doc.set_neutral(2, [1, 2, 3], [10, 20, 30])
            self.assertEqual(doc["defn.neutralJointTranslations.zs"][2], 3)
            self.assertEqual(doc["defn.neutralJointRotations.ys"][2], 20)
            doc.clear_joints(doc.names(Kind.JOINT)[1])
            doc.clear(Kind.JOINT)
            self.assertEqual(doc.validate(), [])
            with self.assertRaises(mien.ArgumentError):
                doc.set_neutral(0, [1, 2])

    @needs_numpy
    def test_meshes(self):
        with document() as doc:
            places = doc.positions(0)
            doc.set_positions(0, places * 2)
            self.assertTrue((doc.positions(0) == places * 2).all())
            with self.assertRaises(mien.ArgumentError):
                doc.set_positions(0, places[:-1])
            doc.set_target(0, 0, [[1, 2, 3], [0, 0, 0.001]], [4, 6])
            self.assertEqual(doc.prune_targets(0.01).deltas > 0, True)
            target = next(t for t in doc["geom.meshes[0].blendShapeTargets"] if t["blendShapeChannelIndex"] == 0)
            self.assertEqual(list(target["vertexIndices"]), [4])
            count = len(places)
            doc.set_weights(0, numpy.tile([0, 1], (count, 1)), numpy.tile([0.5, 0.5], (count, 1)))
            doc.smooth_weights(0)
            doc.limit_influences(0, 1)
            doc.normalize_weights(0)
            self.assertEqual({tuple(row["weights"]) for row in doc["geom.meshes[0].skinWeights"]}, {(1.0,)})
            with self.assertRaises(mien.ArgumentError):
                doc.set_weights(0, numpy.zeros((count, 1)), numpy.ones((count, 1)))  # not whole numbers
            self.assertEqual(doc.validate(), [])

    def test_whole_characters(self):
        with document() as doc:
            ys = list(doc["geom.meshes[0].positions.ys"])
            doc.place(translation=(0, 1, 0))
            self.assertAlmostEqual(doc["geom.meshes[0].positions.ys"][0], ys[0] + 1, places=4)
            doc.convert("unreal")
            self.assertEqual(doc.validate(), [])
            self.assertGreaterEqual(doc.prune_joints(1e-6, 1e-6, 1e-6).entry_count, 1)
            doc.keep_lods([0])
            with doc.to_dna() as dna:
                self.assertEqual(dna.info.lod_count, 1)

    def test_parts_of_other_documents(self):
        with document() as doc, document() as other:
            before = doc.to_bytes()
            doc.copy_layers(other, mien.Layer.GEOMETRY)
            doc.merge_joints(other)
            doc.split_joints(other)
            self.assertEqual(doc.to_bytes(), before)
            other.place(scale=2)
            self.assertEqual(doc.copy_mesh(other, 0), 0)
            self.assertEqual(list(doc["geom.meshes[0].positions.xs"]), list(other["geom.meshes[0].positions.xs"]))

    def test_shapes_follow(self):
        with document(mien.Preset.HEAD) as doc, document(mien.Preset.HEAD) as rig:
            self.assertGreaterEqual(doc.make_lod(2, 0), 0)
            self.assertGreaterEqual(doc.project("head_lod3_mesh", "head_lod0_mesh", mien.Match.UV), 0)
            found = doc.transplant(rig)
            self.assertEqual(len(found), rig.field("defn.rawControlNames").count)
            self.assertEqual(doc.validate(), [])


@needs_numpy
class Recipes(unittest.TestCase):
    """Each `python` block of the page, run as it is."""

    @classmethod
    def setUpClass(cls):
        cls.text = PAGE.read_text(encoding="utf-8")
        cls.recipes = dict(re.findall(r"### ([^\n]+)\n(?:(?!###)[\s\S])*?```python\n([\s\S]*?)```", cls.text))
        cls.before = os.getcwd()
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        os.chdir(cls.folder.name)
        cls.addClassCleanup(os.chdir, cls.before)
        cls.head = dna_of(mien.Preset.HEAD)
        cls.head.save("head.dna")

    def made(self, recipe, name):
        code = self.recipes[recipe]
        lines = [line for line in code.splitlines() if line and not line.startswith("import")]
        self.assertLessEqual(len(lines), 10)
        exec(code, {})  # pylint: disable=exec-used
        self.assertEqual(mien.validate(name), [])
        return mien.Dna.open(name)

    def test_there_are_five(self):
        self.assertEqual(len(self.recipes), 5)
        first = re.search(r"```python\n([\s\S]*?)```", self.text).group(1)
        exec(first, {})  # pylint: disable=exec-used

    def test_rename(self):
        with self.made("Rename joints for an engine", "engine.dna") as made:
            names = {"C_Head": "head", "C_Jaw": "jaw", "L_Eye": "eye_l", "R_Eye": "eye_r"}
            self.assertEqual(made["defn.jointNames"], [names.get(n, n) for n in self.head["defn.jointNames"]])

    def test_lods(self):
        with self.made("Keep LODs 2 to 7 for mobile", "mobile.dna") as made:
            self.assertEqual(made.info.lod_count, 6)
            self.assertEqual(made.to_bytes(), mien.Dna.open("head.dna", lods=range(2, 8)).to_bytes())

    def test_nose(self):
        with self.made("Give the head a new nose bridge", "bridge.dna") as made:
            joint = made["defn.jointNames"].index("C_NoseTip")
            moved = [made[f"defn.neutralJointTranslations.{axis}"][joint] -
                     self.head[f"defn.neutralJointTranslations.{axis}"][joint] for axis in ("xs", "ys", "zs")]
            self.assertGreater(sum(value * value for value in moved) ** 0.5, 0.1)

    def test_strip(self):
        with self.made("Strip blend shapes", "light.dna") as made:
            self.assertEqual(made.info.blend_shape_channel_count, 0)
            self.assertLess(os.path.getsize("light.dna"), os.path.getsize("head.dna"))

    def test_units(self):
        with self.made("Convert units and axes", "unreal.dna") as made:
            with mien.Dna.open("head.dna", system="unreal") as plain:
                self.assertEqual(made.info.axes, plain.info.axes)
                big, small = (numpy.asarray(dna["geom.meshes[0].positions.xs"]) for dna in (made, plain))
                self.assertTrue(numpy.allclose(big, small * 1.05, atol=1e-5))


if __name__ == "__main__":
    unittest.main()

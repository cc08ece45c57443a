#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`mien edit` and `mien diff`, on rigs of `mien gen`. What an edit did is looked up in the file with the
Python binding, and compared with results of `mien eval`.

    edit_test.py path/to/mien [path/to/libmien] [unittest options]
"""
import json
import os
import random
import re
import shlex
import struct
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "..", "tests", "support"))
sys.path.insert(0, os.path.join(HERE, "..", "..", "python"))
import edit_scripts  # noqa: E402
from program import FILE, USAGE, INVALID, ProgramTest, main, make, make_folder, path, read, run, write  # noqa: E402

mien = None  # the binding

SMALL = "small.dna"


def setUpModule():
    make_folder()
    make("gen", "-o", path(SMALL), "--preset", "small")
    make("demo-head", "-o", path("head.dna"))


def save_npy(name, rows):
    """An array of 2 dimensions in the format of NumPy."""
    header = "{'descr': '<f4', 'fortran_order': False, 'shape': (%d, %d), }" % (len(rows), len(rows[0]))
    header = header.ljust(117) + "\n"
    return write(name, b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode() +
                 b"".join(struct.pack("<%df" % len(row), *row) for row in rows))


class EditTest(ProgramTest):
    def edit(self, *options, rig=SMALL, to="out.dna"):
        done = self.ok("edit", path(rig), *options, "-o", path(to))
        self.assertTrue(self.json("validate", path(to), "--json")["valid"])
        return done

    def field(self, name, field):
        if mien is None:
            self.skipTest("NOT TESTED: fields of edited files; no libmien was given")
        with mien.Dna.open(path(name)) as dna:
            found = dna.read(field)
            return list(found) if hasattr(found, "tolist") else found

    def positions(self, name, mesh):
        of = [self.field(name, "geom.meshes[%d].positions.%s" % (mesh, axis)) for axis in ("xs", "ys", "zs")]
        return [list(position) for position in zip(*of)]

    def all_fields(self, name):
        """Of the known layers: {path: value}."""
        if mien is None:
            self.skipTest("NOT TESTED: fields of edited files; no libmien was given")
        found = {}

        def walk(at, value):
            if isinstance(value, dict):
                for key, member in value.items():
                    walk(at + "." + key, member)
            elif isinstance(value, list):
                found[at] = len(value)
                for i, member in enumerate(value):
                    walk("%s[%d]" % (at, i), member)
            else:
                found[at] = value.tolist() if hasattr(value, "tolist") else value

        with mien.Dna.open(path(name)) as dna:
            for layer in dna.fields():
                walk(layer, dna.read(layer))
        return found

    def changed_fields(self, before, after):
        old, new = self.all_fields(before), self.all_fields(after)
        return {key for key in {**old, **new} if old.get(key) != new.get(key)}


class Edits(EditTest):
    def test_without_edits_the_bytes_stay(self):
        self.edit()
        self.assertEqual(read("out.dna"), read(SMALL))
        done = self.ok("edit", "-", "-o", "-", stdin=read(SMALL))
        self.assertEqual(done.stdout, read(SMALL))

    def test_renaming_changes_the_name_alone(self):
        for kind, listed, field in (("joint", "joints", "defn.jointNames"), ("mesh", "meshes", "defn.meshNames"),
                                    ("blend-shape", "channels", "defn.blendShapeChannelNames"),
                                    ("animated-map", "maps", "defn.animatedMapNames"),
                                    ("raw", "raw", "defn.rawControlNames"),
                                    ("gui", "gui", "defn.guiControlNames")):
            names = self.names(SMALL, listed)
            self.edit("--rename", "%s:%s=other name" % (kind, names[1]))
            self.assertEqual(self.names("out.dna", listed), [names[0], "other name"] + names[2:])
            self.assertEqual(self.changed_fields(SMALL, "out.dna"), {field + "[1]"})
            # And back.
            self.ok("edit", path("out.dna"), "--rename", "%s:other name=%s" % (kind, names[1]), "-o", path("back.dna"))
            self.assertEqual(read("back.dna"), read(SMALL))

    def test_edits_apply_in_their_order(self):
        first = self.names(SMALL, "joints")[2]
        self.edit("--rename", "joint:%s=a" % first, "--rename", "joint:a=b", "--rename", "joint:b=c")
        self.assertIn("c", self.names("out.dna", "joints"))
        self.fails(INVALID, "edit", path(SMALL), "--rename", "joint:a=b", "--rename", "joint:%s=a" % first,
                   "-o", path("no.dna"), says='there is no joint "a"')

    def test_a_removed_joint_leaves_the_others_as_they_were(self):
        joints, controls = self.names(SMALL, "joints"), {name: 0.5 for name in self.names(SMALL, "raw")}
        gone = joints[len(joints) // 2]
        self.edit("--remove", "joint:" + gone)
        left = self.names("out.dna", "joints")
        self.assertEqual(left, [name for name in joints if name != gone])
        before, after = (self.evaluate_one(rig, {"raw": controls})["joints"] for rig in (SMALL, "out.dna"))
        for i, name in enumerate(left):
            k = joints.index(name)
            self.assertEqual(after[9 * i:9 * i + 9], before[9 * k:9 * k + 9], name)

    def test_joints_whose_rotations_are_ordered_anew_are_named(self):
        rig = "turning.dna"
        write(rig, read(os.path.join(HERE, "..", "..", "..", "tests", "golden", "small_rot.dna")))
        done = self.edit("--remove", "joint:JNT_13", rig=rig)
        named = re.findall('"([^"]+)"', done.stderr.split("groups of their own")[1])
        self.assertGreater(len(named), 1)
        controls = {"raw": {name: 0.25 + 0.5 * (i % 2) for i, name in enumerate(self.names(rig, "raw"))}}
        joints, left = self.names(rig, "joints"), self.names("out.dna", "joints")
        before, after = (self.evaluate_one(of, controls)["joints"] for of in (rig, "out.dna"))
        for i, name in enumerate(left):
            k = joints.index(name)
            was, now = before[9 * k:9 * k + 9], after[9 * i:9 * i + 9]
            if name in named:
                for a, b in zip(was, now):
                    self.assertAlmostEqual(a, b, delta=1e-2, msg=name)
            else:
                self.assertEqual(was, now, name)

    def test_a_removed_mesh_and_blend_shape(self):
        meshes, channels = self.names(SMALL, "meshes"), self.names(SMALL, "channels")
        self.edit("--remove", "mesh:" + meshes[0], "--remove", "blend-shape:" + channels[1])
        self.assertEqual(self.names("out.dna", "meshes"), meshes[1:])
        self.assertEqual(self.names("out.dna", "channels"), [channels[0]] + channels[2:])
        self.assertEqual(self.positions("out.dna", 0), self.positions(SMALL, 1))

    def test_clearing(self):
        self.edit("--clear", "blend-shapes")
        self.assertEqual(self.names("out.dna", "channels"), [])
        targets = [value for key, value in self.all_fields("out.dna").items() if key.endswith(".blendShapeTargets")]
        self.assertEqual(targets, [0] * len(targets))
        self.edit("--clear", "animated-maps")
        self.assertEqual(self.names("out.dna", "maps"), [])
        controls = {name: 1 for name in self.names(SMALL, "raw")}
        self.edit("--clear", "joint-animation")
        moved = self.evaluate_one("out.dna", {"raw": controls})["joints"]
        self.assertFalse(any(moved))
        before = self.evaluate_one(SMALL, {"raw": controls})["joints"]
        joint = next(i for i in range(len(before) // 9) if any(before[9 * i:9 * i + 9]))
        self.edit("--clear", "joint-animation:" + self.names(SMALL, "joints")[joint])
        after = self.evaluate_one("out.dna", {"raw": controls})["joints"]
        self.assertFalse(any(after[9 * joint:9 * joint + 9]))
        self.assertEqual(after[:9 * joint] + after[9 * joint + 9:], before[:9 * joint] + before[9 * joint + 9:])

    def test_neutral_transforms(self):
        name = self.names(SMALL, "joints")[3]
        self.edit("--neutral", name + ":1,-2.5,3e-1")
        for axis, value in (("xs", 1), ("ys", -2.5), ("zs", struct.unpack("f", struct.pack("f", 0.3))[0])):
            field = "defn.neutralJointTranslations." + axis
            old, new = self.field(SMALL, field), self.field("out.dna", field)
            self.assertEqual(new[3], value)
            self.assertEqual(new[:3] + new[4:], old[:3] + old[4:])
        self.edit("--neutral", name + ":0,0,0,10,20,30")
        self.assertEqual(self.field("out.dna", "defn.neutralJointRotations.zs")[3], 30)

    def test_scale_and_translate(self):
        self.edit("--scale", "2", "--translate", "0,10,-1")
        for old, new in zip(self.positions(SMALL, 0), self.positions("out.dna", 0)):
            self.assertEqual(new, [2 * old[0], struct.unpack("f", struct.pack("f", 2 * old[1] + 10))[0],
                                   struct.unpack("f", struct.pack("f", 2 * old[2] - 1))[0]])
        self.edit("--rotate", "0,90,0")
        for old, new in zip(self.positions(SMALL, 0), self.positions("out.dna", 0)):
            for a, b in zip(new, (old[2], old[1], -old[0])):
                self.assertAlmostEqual(a, b, places=3)

    def test_lods(self):
        count = self.json("info", path(SMALL), "--json")["lod_count"]
        self.edit("--lods", "1-%d" % (count - 1))
        self.ok("convert", path(SMALL), "--lods", "1-%d" % (count - 1), "-o", path("converted.dna"))
        self.assertEqual(read("out.dna"), read("converted.dna"))

    def test_another_system(self):
        self.edit("--system", "unreal")
        self.ok("convert", path(SMALL), "--system", "unreal", "-o", path("converted.dna"))
        self.assertEqual(read("out.dna"), read("converted.dna"))

    def test_name_metadata_version(self):
        self.edit("--name", "Ada", "--metadata", "owner=me = you", "--metadata", "empty=", "--version", "2.4")
        info = self.json("info", path("out.dna"), "--json")
        self.assertEqual((info["name"], info["version"]), ("Ada", "2.4"))
        pairs = {pair["key"]: pair["value"] for pair in self.field("out.dna", "desc.metadata")}
        self.assertEqual((pairs["owner"], pairs["empty"]), ("me = you", ""))
        self.ok("edit", path("out.dna"), "--metadata", "owner=another", "-o", path("again.dna"))
        again = {pair["key"]: pair["value"] for pair in self.field("again.dna", "desc.metadata")}
        self.assertEqual(again, {**pairs, "owner": "another"})


class Arrays(EditTest):
    def test_positions_of_each_kind_of_file(self):
        mesh = self.names(SMALL, "meshes")[0]
        rows = [[x + 1, y, z * 0.5] for x, y, z in self.positions(SMALL, 0)]
        rows = [list(struct.unpack("3f", struct.pack("3f", *row))) for row in rows]
        write("p.obj", "".join("v %.9g %.9g %.9g\n" % tuple(row) for row in rows) + "f 1 2 3\n")
        write("p.json", json.dumps(rows))
        save_npy("p.npy", rows)
        for name in ("p.obj", "p.json", "p.npy"):
            self.edit("--positions", mesh + "=" + path(name))
            self.assertEqual(self.positions("out.dna", 0), rows, name)
            self.assertEqual({key.split(".")[2] for key in self.changed_fields(SMALL, "out.dna")}, {"positions"})

    def test_targets(self):
        mesh, channel = self.names(SMALL, "meshes")[0], self.names(SMALL, "channels")[0]
        places = self.positions(SMALL, 0)
        deltas = [[0.0, 0.0, 0.0] for _ in places]
        deltas[2], deltas[5] = [1.0, 2.0, 3.0], [0.0, -1.0, 0.0]
        write("t.json", json.dumps(deltas))
        save_npy("t.npy", deltas)
        for name in ("t.json", "t.npy"):
            self.edit("--targets", "%s/%s=%s" % (mesh, channel, path(name)))
            targets = self.field("out.dna", "geom.meshes[0].blendShapeTargets")
            target = next(t for t in targets if t["blendShapeChannelIndex"] == 0)
            self.assertEqual(list(target["vertexIndices"]), [2, 5])
            self.assertEqual(list(target["deltas"]["ys"]), [2, -1])
        posed = [[a + b for a, b in zip(*both)] for both in zip(places, deltas)]
        write("t.obj", "".join("v %.17g %.17g %.17g\n" % tuple(row) for row in posed) + "f 1 2 3\n")
        self.edit("--targets", "%s/%s=%s" % (mesh, channel, path("t.obj")))
        target = next(t for t in self.field("out.dna", "geom.meshes[0].blendShapeTargets")
                      if t["blendShapeChannelIndex"] == 0)
        self.assertTrue({2, 5} <= set(target["vertexIndices"]))
        self.edit("--prune-targets", "1000")
        self.assertEqual(self.field("out.dna", "geom.meshes[0].blendShapeTargets"), [])

    def test_skin_weights(self):
        mesh, joints = self.names(SMALL, "meshes")[0], self.names(SMALL, "joints")
        count = len(self.positions(SMALL, 0))
        write("w.json", json.dumps([[[joints[1], 0.25], [2, 0.75]] if i % 2 else [[0, 1]] for i in range(count)]))
        dense = [[0.0] * len(joints) for _ in range(count)]
        for i, row in enumerate(dense):
            if i % 2:
                row[1], row[2] = 0.25, 0.75
            else:
                row[0] = 1.0
        save_npy("w.npy", dense)
        for name in ("w.json", "w.npy"):
            self.edit("--skin-weights", mesh + "=" + path(name))
            rows = self.field("out.dna", "geom.meshes[0].skinWeights")
            self.assertEqual([list(row["jointIndices"]) for row in rows[:2]], [[0], [1, 2]])
            self.assertEqual(list(rows[1]["weights"]), [0.25, 0.75])
        self.edit("--limit-influences", "1")
        self.assertTrue(all(len(row["weights"]) <= 1 for row in self.field("out.dna", "geom.meshes[0].skinWeights")))

    def test_conforming_to_a_moved_mesh_moves_the_joints(self):
        mesh = self.names("head.dna", "meshes")[0]
        rows = [[x, y + 2, z] for x, y, z in self.positions("head.dna", 0)]
        write("c.json", json.dumps(rows))
        self.edit("--conform", mesh + "=" + path("c.json"), rig="head.dna")
        old, new = (self.field(name, "defn.neutralJointTranslations.ys") for name in ("head.dna", "out.dna"))
        parents = self.field("head.dna", "defn.jointHierarchy")
        for i, parent in enumerate(parents):
            self.assertAlmostEqual(new[i] - old[i], 2 if parent == i else 0, places=3)

    def test_a_lod_made_from_a_finer_one(self):
        done = self.edit("--make-lod", "2", "--from", "0", rig="head.dna")
        self.assertIn("made LOD 2 from LOD 0", done.stderr)
        self.assertEqual(self.positions("out.dna", 0), self.positions("head.dna", 0))
        surface = read("out.dna")
        self.edit("--make-lod", "2", "--from", "0", "--match", "surface", rig="head.dna")
        self.assertEqual(read("out.dna"), surface)
        self.assertIn("texture", self.edit("--make-lod", "2", "--from", "0", "--match", "uv", rig="head.dna").stderr)
        if mien is not None:  # the same by default
            with mien.Document.open(path("head.dna")) as head:
                head.make_lod(2, 0)
                self.assertEqual(head.to_bytes(), surface)

    def test_removed_controls(self):
        raw, gui = self.names(SMALL, "raw"), self.names(SMALL, "gui")
        self.edit("--remove", "raw:" + raw[1], "--remove", "gui:" + gui[0], "--remove", "psd:psd0")
        self.assertEqual(self.names("out.dna", "raw"), raw[:1] + raw[2:])
        self.assertEqual(self.names("out.dna", "gui"), gui[1:])
        values = {name: 0.5 for name in raw if name != raw[1]}
        self.edit("--remove", "raw:" + raw[1], to="less.dna")
        before, after = (self.evaluate_one(rig, {"raw": {**values, **more}})["joints"]
                         for rig, more in ((SMALL, {raw[1]: 0}), ("less.dna", {})))
        self.assertEqual(before, after)
        for kind, says in (("ml", "there is no ML control"), ("rbf", "there is no RBF control"),
                           ("psd", "there is no PSD control")):
            self.fails(INVALID, "edit", path(SMALL), "--remove", kind + ":none", "-o", path("no.dna"), says=says)

    def test_normal_and_smooth_weights(self):
        mesh = self.names(SMALL, "meshes")[0]
        count = len(self.positions(SMALL, 0))
        write("halves.json", json.dumps([[[0, 0.25], [1, 0.25]]] * count))
        self.edit("--skin-weights", mesh + "=" + path("halves.json"), "--normalize-weights", mesh)
        rows = self.field("out.dna", "geom.meshes[0].skinWeights")
        self.assertEqual([list(row["weights"]) for row in rows], [[0.5, 0.5]] * count)
        write("ends.json", json.dumps([[[i % 2, 1]] for i in range(count)]))
        self.edit("--skin-weights", mesh + "=" + path("ends.json"), "--smooth-weights", mesh + "=3")
        rows = self.field("out.dna", "geom.meshes[0].skinWeights")
        self.assertTrue(any(len(row["weights"]) == 2 for row in rows))
        self.assertTrue(all(abs(sum(row["weights"]) - 1) < 1e-6 for row in rows))
        self.edit("--normalize-weights", "all", "--smooth-weights", "all=1")

    def test_layers_of_another_file(self):
        self.edit("--name", "other", "--scale", "2", to="large.dna")
        self.edit("--copy-layers", "descriptor=" + path("large.dna"))
        self.assertEqual(self.field("out.dna", "desc.name"), "other")
        self.assertEqual(self.positions("out.dna", 0), self.positions(SMALL, 0))
        self.edit("--copy-layers", "descriptor,geometry=" + path("large.dna"))
        self.assertEqual(self.positions("out.dna", 0), self.positions("large.dna", 0))

    def test_parts_of_other_files(self):
        mesh = self.names(SMALL, "meshes")[0]
        for option in ("--merge-joints", "--split-joints"):
            self.edit(option, path(SMALL))
            self.assertEqual(read("out.dna"), read(SMALL), option)
        joints = self.names(SMALL, "joints")
        self.edit("--remove", "joint:" + joints[-1], to="fewer.dna")
        self.edit("--split-joints", path("fewer.dna"))
        self.assertEqual(self.names("out.dna", "joints"), joints[:-1])
        self.edit("--merge-joints", path(SMALL), rig="fewer.dna")
        self.assertEqual(self.names("out.dna", "joints"), joints)
        self.edit("--scale", "2", to="large.dna")
        self.edit("--copy-mesh", mesh + "=" + path("large.dna"))
        self.assertEqual(self.positions("out.dna", 0), self.positions("large.dna", 0))
        self.assertEqual(self.positions("out.dna", 1), self.positions(SMALL, 1))
        self.fails(INVALID, "edit", path(SMALL), "--copy-mesh", "none=" + path("large.dna"), "-o", path("no.dna"),
                   says=["large.dna", "no mesh"])

    def test_a_transplant_tells_how_controls_differ(self):
        done = self.edit("--transplant", path("head.dna"), rig="head.dna")
        self.assertIn("gave the character the rig of", done.stderr)
        self.assertEqual(self.names("out.dna", "raw"), self.names("head.dna", "raw"))

    def test_pruning_the_joint_matrix(self):
        done = self.edit("--prune-joints", "1e9,1e9,1e9")
        self.assertIn("positions move by at most", done.stderr)
        self.assertFalse(any(self.evaluate_one("out.dna", {"raw": {name: 1 for name in self.names(SMALL, "raw")}})
                             ["joints"]))

    def test_wrong_arrays(self):
        mesh = self.names(SMALL, "meshes")[0]
        for name, content, says in (
                ("short.json", "[[1, 2, 3]]", "1 rows"), ("flat.json", "[1, 2, 3]", "row 0"),
                ("text.json", '[["a", 2, 3]]', "not a finite float"), ("object.json", "{}", "not a list"),
                ("huge.json", "[[1e300, 0, 0]]", "row 0"), ("broken.json", "[[1, 2", "byte"),
                ("short.npy", b"\x93NUMPY\x01\x00\xff\xff{", "begin"), ("cut.npy", b"\x93NUMPY\x01\x00\xff\xff{   ", "cut"),
                ("a.txt", "1 2 3", ".npy"), ("few.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "3 positions")):
            write(name, content)
            self.fails(INVALID, "edit", path(SMALL), "--positions", mesh + "=" + path(name), "-o", path("no.dna"),
                       says=[name, says])
        save_npy("nan.npy", [[float("nan"), 0, 0]])
        self.fails(INVALID, "edit", path(SMALL), "--positions", mesh + "=" + path("nan.npy"), "-o", path("no.dna"),
                   says="not finite")


class Scripts(EditTest):
    def test_a_script_is_the_same_as_its_options(self):
        joint = self.names(SMALL, "joints")[1]
        edits = [["--rename", "joint:%s=jaw" % joint], ["--scale", "2", "--name", "Ada"]]
        script = write("script.json", json.dumps(edits))
        self.edit("--script", script)
        self.edit(*[word for words in edits for word in words], to="options.dna")
        self.assertEqual(read("out.dna"), read("options.dna"))

    def test_nothing_is_written_if_one_edit_fails(self):
        self.edit(to="kept.dna")
        script = write("bad.json", json.dumps([["--scale", "2"], ["--remove", "joint:nobody"]]))
        self.fails(INVALID, "edit", path(SMALL), "--script", script, "-o", path("kept.dna"), says="nobody")
        self.assertEqual(read("kept.dna"), read(SMALL))

    def test_wrong_scripts(self):
        for content, says in (("{}", "list"), ('["--scale", "2"]', "command 0"), ('[["--scale"]]', "command 0"),
                              ('[["--scale", 2]]', "command 0"), ('[["--scael", "2"]]', "--scale"),
                              ('[["--scale", "x"]]', "--scale x"), ('[["--make-lod", "1"]]', "--from"),
                              ("[[", "byte"),
                              ('[["--script", "a.json"]]', "no edit")):
            write("wrong.json", content)
            self.fails(INVALID, "edit", path(SMALL), "--script", path("wrong.json"), "-o", path("no.dna"), says=says)

    def test_a_dry_run_tells_and_writes_nothing(self):
        joint = self.names(SMALL, "joints")[1]
        before = sorted(os.listdir(os.path.dirname(path(SMALL))))
        done = self.ok("edit", path(SMALL), "--dry-run", "--rename", "joint:%s=jaw" % joint)
        self.assertEqual(sorted(os.listdir(os.path.dirname(path(SMALL)))), before)
        text = done.stdout.decode()
        self.assertIn('renamed joint "%s" to "jaw"' % joint, text)
        self.assertIn('joints: renamed "%s" to "jaw"' % joint, text)


class WrongUsage(EditTest):
    def test_values(self):
        for option, value, says in (
                ("--rename", "joint", "KIND:OLD=NEW"), ("--rename", "joint:a", "KIND:OLD=NEW"),
                ("--rename", "jiont:a=b", 'did you mean "joint"'), ("--remove", "joint", "KIND:NAME"),
                ("--clear", "blend-shape", "blend-shapes"), ("--neutral", "root:1,2", "3 or 6"),
                ("--neutral", "root:1,2,x", "numbers"), ("--scale", "0", "above 0"), ("--scale", "nan", "finite"),
                ("--scale", "1e60", "finite"), ("--translate", "1,2", "3 numbers"), ("--lods", "40", "LOD"),
                ("--version", "3.0", "2.8"), ("--system", "maja", "maya"), ("--metadata", "=x", "KEY=VALUE"),
                ("--prune-targets", "-1", "below 0"), ("--make-lod", "1", "--from"), ("--from", "1", "--make-lod"),
                ("--limit-influences", "0", "needs one"), ("--limit-influences", "x", "--limit-influences"),
                ("--translate", "1,2,3,4", "not 4")):
            self.fails(USAGE, "edit", path(SMALL), option, value, "-o", path("no.dna"), says=says)
        self.fails(USAGE, "edit", path(SMALL), "--name", "x", says="--dry-run")

    def test_what_the_file_lacks(self):
        joints = self.names(SMALL, "joints")
        for option, value, says in (
                ("--rename", "joint:%s=%s" % (joints[1], joints[2]), joints[2]),
                ("--rename", "joint:%sx=y" % joints[1], "did you mean"), ("--remove", "mesh:none", "no mesh"),
                ("--remove", "raw:none", "no raw control"), ("--remove", "psd:none", "psd0, psd1"),
                ("--lods", "30", "LOD"), ("--positions", "none=a.obj", "no mesh")):
            self.fails(INVALID, "edit", path(SMALL), option, value, "-o", path("no.dna"), says=says)


class Json(EditTest):
    def back(self, name):
        """The JSON of a file, which gives the same file."""
        self.ok("edit", path(name), "--to-json", "-o", path("text.json"))
        self.ok("edit", path("text.json"), "--from-json", "-o", path("back.dna"))
        self.assertEqual(read("back.dna"), read(name), name)
        return json.loads(read("text.json"))

    def test_files_come_back_byte_for_byte(self):
        golden = os.path.join(HERE, "..", "..", "..", "tests", "golden")
        rigs = sorted(name for name in os.listdir(golden) if name.endswith(".dna"))
        self.assertGreater(len(rigs), 5)
        for name in rigs:
            with open(os.path.join(golden, name), "rb") as file:
                write("golden.dna", file.read())
            if run("validate", path("golden.dna")).returncode:
                continue
            self.ok("convert", path("golden.dna"), "-o", path("canonical.dna"))
            self.back("canonical.dna")
        make("gen", "-o", path("body.dna"), "--preset", "tiny", "--seed", "7")
        for name in (SMALL, "head.dna", "body.dna"):
            self.back(name)

    def test_the_text_is_what_the_page_says(self):
        text = self.back("head.dna")
        self.assertEqual(list(text)[:3], ["dna", "layers", "desc"])
        self.assertEqual([layer[0] for layer in text["layers"]],
                         [layer["code"] for layer in self.json("info", path("head.dna"), "--json")["layers"]])
        self.assertEqual(text["defn"]["jointNames"], self.names("head.dna", "joints"))

    def test_unknown_layers_odd_names_and_numbers(self):
        if mien is None:
            self.skipTest("NOT TESTED: unknown layers as JSON; no libmien was given")
        with mien.Document.open(path(SMALL)) as small:
            small.add_layer("note", 3, 4, bytes(range(256)) * 3)
            small["desc.name"] = b"a\"\\\n\x7f \xff".decode("utf-8", "surrogateescape")
            small["desc.dbName"] = "\u20ac \U0001f600"
            values = [-0.0, 1e-45, 3.4028235e38, 0.1, 16777216.0, -1e10, 1 / 3, 1e30]
            small["geom.meshes[0].positions.xs"] = values + list(small["geom.meshes[0].positions.xs"])[len(values):]
            small.save(path("odd.dna"))
        text = self.back("odd.dna")
        self.assertEqual(text["layers"][-1][:2], ["note", "3.4"])
        self.assertEqual(bytes.fromhex("".join(text["layers"][-1][2])), bytes(range(256)) * 3)

    def test_edits_on_the_way(self):
        self.ok("edit", path(SMALL), "--scale", "2", "--to-json", "-o", path("text.json"))
        self.ok("edit", path("text.json"), "--from-json", "--name", "Ada", "-o", path("back.dna"))
        self.edit("--scale", "2", "--name", "Ada")
        self.assertEqual(read("back.dna"), read("out.dna"))
        done = self.ok("edit", path("text.json"), "--from-json", "--name", "Ada", "--dry-run")
        self.assertIn(b"desc.name", done.stdout)
        self.fails(USAGE, "edit", path(SMALL), "--to-json", "--version", "2.5", "-o", path("no.json"), says="--version")

    def test_wrong_texts(self):
        for text, says in (
                ("", "byte"), ("[]", "not an object"), ("3", "not an object"), ('{"dna": "2.8"', "byte"),
                ('{"desc": {}}', "first member"), ('{"dna": "3.0"}', "version"), ('{"dna": 2.8}', "dna"),
                ('{"dna": "2.8", "none": {}}', "none"), ('{"dna": "2.8", "desc": {"none": 1}}', "desc.none"),
                ('{"dna": "2.8", "desc": {"name": 1}}', "desc.name"), ('{"dna": "2.8", "desc": {"age": "x"}}', "desc.age"),
                ('{"dna": "2.8", "desc": {"age": 1.5}}', "1.5"), ('{"dna": "2.8", "desc": {"age": 70000}}', "65535"),
                ('{"dna": "2.8", "desc": {"age": [1]}}', "desc.age"), ('{"dna": "2.8", "desc": {"age": null}}', "null"),
                ('{"dna": "2.8", "desc": {"name": {"hex": "0"}}}', "hexadecimal"),
                ('{"dna": "2.8", "defn": {"jointNames": [["a"]]}}', "jointNames"),
                ('{"dna": "2.8", "defn": {"jointNames": ["a", "a"]}}', "already named"),
                ('{"dna": "2.8", "defn": {"jointHierarchy": [1, "x"]}}', "jointHierarchy"),
                ('{"dna": "2.8", "defn": {"neutralJointRotations": {"xs": [1e39]}}}', "float"),
                ('{"dna": "2.8", "layers": [["desc"]]}', "layer"), ('{"dna": "2.8", "layers": [["desc", "1.1", ["00"]]]}', "known"),
                ('{"dna": "2.8", "layers": [["note", "1.1", ["0x"]]]}', "hexadecimal"), ('{"dna": "2.8", "layers": 1}', "layers"),
                ('{"dna": "2.8", "defn": {"jointHierarchy": [7]}}', "joint")):
            write("wrong.json", text)
            self.fails(INVALID, "edit", path("wrong.json"), "--from-json", "-o", path("no.dna"), says=says)
        self.fails(FILE, "edit", path("none.json"), "--from-json", "-o", path("no.dna"), says="none.json")


class RandomScripts(EditTest):
    """Each is done, or refused with a line that says why; a file that is written is valid."""

    def test_many_of_them(self):
        make("gen", "-o", path("tiny.dna"), "--preset", "tiny")
        positions = len(self.positions_of_json("tiny.dna"))
        write("p.json", json.dumps([[i % 7, i % 5, i % 3] for i in range(positions)]))
        names = edit_scripts.element_names(self.json("info", path("tiny.dna"), "--json", "--names", "all"))
        draw = random.Random(5)
        done = 0
        count = 300 if os.environ.get("MIEN_LONG_TESTS") else 40
        for _ in range(count):
            text = edit_scripts.random_script(draw, names, path("tiny.dna"), path("p.json"))
            write("script.json", text)
            if os.path.exists(path("made.dna")):
                os.remove(path("made.dna"))
            tried = run("edit", path("tiny.dna"), "--quiet", "--script", path("script.json"), "-o", path("made.dna"))
            self.assertIn(tried.returncode, (0, INVALID, FILE), (text, tried.stderr))
            self.assertEqual(os.path.exists(path("made.dna")), tried.returncode == 0, text)
            if tried.returncode:
                self.assertEqual(len(tried.stderr.splitlines()), 1, (text, tried.stderr))
                continue
            done += 1
            self.assertTrue(self.json("validate", path("made.dna"), "--json")["valid"], text)
        self.assertGreater(done, count / 8)

    def positions_of_json(self, name):
        text = self.ok("edit", path(name), "--to-json", "-o", "-").stdout
        return json.loads(text)["geom"]["meshes"][0]["positions"]["xs"]


class Recipes(EditTest):
    def test_every_line_of_the_page_runs(self):
        with open(os.path.join(HERE, "..", "..", "..", "docs", "editing.md"), encoding="utf-8") as page:
            text = page.read()
        lines = re.findall(r"^    mien (.*)$", text, re.MULTILINE)
        self.assertGreaterEqual(len(lines), 8)
        write("sculpt.obj", "".join("v %r %r %r\n" % (x, y, 1.05 * z) for x, y, z in self.positions("head.dna", 0)) + "f 1 2 3\n")
        count = len(self.positions("head.dna", 0))
        write("weights.json", json.dumps([[[0, 1]]] * count))
        write("edits.json", re.search(r"```json\n(.*?)```", text, re.DOTALL).group(1))
        self.edit("--remove", "joint:C_Jaw", rig="head.dna", to="body.dna")
        shown = self.ok("help", "edit").stdout.decode()
        missing = [name for name in re.findall(r"^  (?:-., ?)?(--[a-z-]+)", shown, re.MULTILINE)
                   if not any(name in line.split() for line in lines)]
        self.assertEqual(sorted(set(missing) - {"--help", "--force", "--quiet", "--output"}), [])
        for line in lines:
            words = [re.sub(r"\b[a-z]+\.(dna|json|obj)$", lambda found: path(found.group()), word)
                     for word in shlex.split(line)]
            self.ok(*words)
            if words[-2] == "-o" and words[-1].endswith(".dna"):
                self.assertTrue(self.json("validate", words[-1], "--json")["valid"], line)
        self.assertEqual(self.json("info", path("mobile.dna"), "--json")["lod_count"], 6)
        self.assertEqual(self.names("light.dna", "channels"), [])
        self.assertIn("jaw", self.names("engine.dna", "joints"))
        self.assertIn("C_Jaw", self.names("whole.dna", "joints"))
        self.assertNotIn("C_Jaw", self.names("again.dna", "joints"))


class Diff(EditTest):
    def diff(self, after, before=SMALL):
        return self.json("diff", path(before), path(after), "--json")

    def test_the_same_file(self):
        found = self.diff(SMALL)
        self.assertEqual((found["same"], found["names"], found["fields"], found["controls"]), (True, [], [], []))
        self.assertEqual(self.ok("diff", path(SMALL), path(SMALL)).stdout, b"")

    def test_names(self):
        joints, meshes = self.names(SMALL, "joints"), self.names(SMALL, "meshes")
        self.edit("--rename", "joint:%s=jaw" % joints[1], "--remove", "mesh:" + meshes[0])
        names = {entry["kind"]: entry for entry in self.diff("out.dna")["names"]}
        self.assertEqual(names["joints"]["renamed"], [[joints[1], "jaw"]])
        self.assertEqual(names["meshes"]["removed"], [meshes[0]])
        self.assertEqual(set(names), {"joints", "meshes"})
        back = {entry["kind"]: entry for entry in self.diff(SMALL, "out.dna")["names"]}
        self.assertEqual(back["meshes"]["added"], [meshes[0]])

    def test_a_renamed_joint_moves_as_before(self):
        self.edit("--rename", "joint:%s=jaw" % self.names(SMALL, "joints")[1])
        found = self.diff("out.dna")
        self.assertEqual((found["evaluated"], found["controls"]), (True, []))
        self.assertEqual([field["path"] for field in found["fields"]], ["defn.jointNames[1]"])

    def test_fields_and_their_largest_difference(self):
        mesh = self.names(SMALL, "meshes")[0]
        rows = self.positions(SMALL, 0)
        rows[4][1] += 0.5
        write("d.json", json.dumps(rows))
        self.edit("--positions", mesh + "=" + path("d.json"))
        (field,) = self.diff("out.dna")["fields"]
        self.assertEqual((field["path"], field["changed"]), ("geom.meshes[0].positions.ys", 1))
        self.assertAlmostEqual(field["largest"], 0.5, places=5)

    def test_controls_that_evaluate_differently(self):
        joints, raw = self.names(SMALL, "joints"), self.names(SMALL, "raw")
        def alone(rig, name):
            return self.evaluate_one(rig, {"raw": {name: 1}})["joints"]
        moved = {name: alone(SMALL, name) for name in raw}
        joint = max(range(len(joints)), key=lambda j: sum(any(m[9 * j:9 * j + 9]) for m in moved.values()))
        self.edit("--clear", "joint-animation:" + joints[joint])
        found = self.diff("out.dna")
        self.assertEqual(found["compared_controls"], len(raw))
        expected = {name for name in raw if moved[name] != alone("out.dna", name)}
        self.assertTrue(expected)
        self.assertEqual({entry["control"] for entry in found["controls"]}, expected)
        for entry in found["controls"]:
            of = moved[entry["control"]][9 * joint:9 * joint + 9]
            for key, first in (("translation", 0), ("rotation", 3), ("scale", 6)):
                self.assertAlmostEqual(entry[key], max(map(abs, of[first:first + 3])), places=6)
            self.assertEqual(entry["joint"], joints[joint])
        text = self.ok("diff", path(SMALL), path("out.dna")).stdout.decode()
        self.assertIn("%d of %d raw controls evaluate differently" % (len(expected), len(raw)), text)


if __name__ == "__main__":
    if len(sys.argv) > 2 and os.path.exists(sys.argv[2]):
        os.environ["MIEN_LIBRARY"] = os.path.abspath(sys.argv.pop(2))
        import mien
    main()

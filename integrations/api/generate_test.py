#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What generate.py and model.py give to templates: types by patterns, names, structs by direction, failures; and a
language that is added as a file."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from shutil import copy, copytree
from types import SimpleNamespace

import model

HERE = Path(__file__).resolve().parent
API = model.load()
STRUCTS = {struct.name: struct for struct in API.structs}
FUNCTIONS = {function.name: function for function in API.functions}

TOY = '''
from model import comment, spell
TYPES = {"uint32_t": "int", "*": "address"}
def write(api):
    for function in api.functions:
        if function.name in ("mien_version", "mien_isa_name"):
            yield "".join(comment(function.documentation, ";"))
            parameters = " ".join(spell(p.type, TYPES) for p in function.parameters)
            yield f"{function.name} {parameters} -> {spell(function.returns, TYPES)}\\n"
FILES = {"toy/mien.toy": (";", write)}
'''


def scalar(name):
    return SimpleNamespace(kind="scalar", name=name)


def pointer(to, const=False):
    return SimpleNamespace(kind="pointer", const=const, to=to)


class ModelTest(unittest.TestCase):
    def test_types_are_spelled_by_the_closest_pattern(self):
        rig = SimpleNamespace(kind="handle", name="MienRig")
        status = SimpleNamespace(kind="alias", name="MienStatus", of=scalar("int32_t"))
        types = {"int32_t": "i32", "char": "i8", "handle*": "{title}Handle", "handle": "{name}", "*": "mut {to}",
                 "const*": "const {to}", "array": "[{of}; {count}]"}
        for kind, text in ((pointer(rig, True), "RigHandle"), (pointer(pointer(rig)), "mut RigHandle"),
                           (pointer(scalar("int32_t"), True), "const i32"), (pointer(status), "mut i32"),
                           (pointer(scalar("char"), True), "const i8"),
                           (SimpleNamespace(kind="array", count=3, of=status), "[i32; 3]")):
            self.assertEqual(model.spell(kind, types), text)
        self.assertEqual(model.spell(pointer(scalar("char"), True), {**types, "char const*": "text"}), "text")
        self.assertEqual(model.spell(pointer(scalar("char")), {**types, "char const*": "text"}), "mut i8")
        self.assertEqual(model.spell(status, {**types, "alias": "{title}"}), "Status")
        with self.assertRaisesRegex(KeyError, "uint8_t"):
            model.spell(scalar("uint8_t"), types)

    def test_names(self):
        self.assertEqual([model.pascal(name) for name in ("raw_control_count", "SNORM10_10_10_2")],
                         ["RawControlCount", "Snorm10_10_10_2"])
        self.assertEqual(model.camel("raw_control_count"), "rawControlCount")
        names = model.references(API, "::")
        self.assertEqual((names["MIEN_ERROR_LOD"], names["MIEN_KIND_MESH"], names["MIEN_KIND_..."]),
                         ("Status::LOD", "Kind::MESH", "Kind"))
        self.assertEqual(model.comment("One.\n\nTwo.\n", "  //"), ["  // One.\n", "  //\n", "  // Two.\n"])

    def test_structs_that_callers_and_functions_fill_in(self):
        for name, given, filled in (("MienRigDesc", True, False), ("MienRigInfo", False, True),
                                    ("MienAllocator", True, False), ("MienError", False, False)):
            self.assertEqual((STRUCTS[name].is_input, STRUCTS[name].is_output), (given, filled), name)

    def test_failures_leave_out_what_bindings_prevent(self):
        failures = {value.short: condition for value, condition in FUNCTIONS["mien_rig_create"].failures}
        self.assertEqual(failures["MEMORY"], "memory runs out")
        self.assertIn("instruction set", failures["ISA"])
        self.assertFalse({"NULL_ARGUMENT", "HANDLE", "STRUCT_SIZE"} & set(failures))


class ProgramTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.api = Path(folder.name) / "api"
        copytree(HERE / "templates", self.api / "templates")
        for file in ("generate.py", "model.py", "mien_api.json"):
            copy(HERE / file, self.api / file)
        (self.api / "templates" / "toy.py").write_text(TOY)
        (self.api.parent / "toy").mkdir()

    def run_program(self, *arguments):
        return subprocess.run([sys.executable, self.api / "generate.py", *arguments], capture_output=True, text=True)

    def test_a_language_is_a_template(self):
        self.assertIn("toy: toy/mien.toy", self.run_program("--list").stdout)
        self.assertIn("run ./dev api", self.run_program("--check", "toy").stderr)  # not there yet
        self.assertEqual(self.run_program("toy").returncode, 0)
        written = self.api.parent / "toy" / "mien.toy"
        text = written.read_text()
        self.assertTrue(text.startswith("; SPDX"))
        self.assertIn("\nmien_isa_name int -> address\n", text)
        self.assertEqual(self.run_program("--check", "toy").returncode, 0)
        written.write_text(text.replace("int", "long"))
        self.assertIn("run ./dev api", self.run_program("--check", "toy").stderr)

    def test_wrong_calls_and_templates(self):
        for arguments in ((), ("cobol",)):
            self.assertIn("lua", self.run_program(*arguments).stderr)
        (self.api / "templates" / "toy.py").write_text(TOY.replace('"*": "address"', ""))
        self.assertIn("the template of toy", self.run_program("toy").stderr)


if __name__ == "__main__":
    unittest.main()

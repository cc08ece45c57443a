#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""mien_api.json follows the headers: each change of a header changes what it should, or is an error.

Usage: conventions_test.py
"""
import unittest

import dump_api
from c_header import HeaderError


def by_name(entries, name):
    return next(entry for entry in entries if entry["name"] == name)


def edited(*pairs):
    """The interface after replacing text of mien.h and what it includes; each text occurs there exactly once."""
    found = {old: 0 for old, _ in pairs}

    def change(header, text):
        for old, new in pairs if header not in ("mien_author.h", "mien_solve.h") else ():
            found[old] += text.count(old)
            text = text.replace(old, new)
        return text
    try:
        return dump_api.read(change)
    finally:
        for old, count in found.items():
            if count != 1:
                raise AssertionError(f"{count} times in mien.h: {old!r}")


# A function of its own, to be declared in ways that are wrong and right.
END = "#ifdef __cplusplus\n}\n#endif\n\n#endif /* MIEN_NAMES_H */"


def with_function(comment, declaration):
    return edited((END, f"/* {comment} */\nMIEN_CHECKED MienStatus {declaration};\n\n{END}"))


def function(comment, declaration):
    functions = with_function(comment, declaration)["functions"]
    return [found for found in functions if found["library"] == "mien"][-1]


def parameter(comment, declaration, name):
    return by_name(function(comment, declaration)["parameters"], name)


class Functions(unittest.TestCase):
    def refused(self, reason, comment, declaration):
        with self.assertRaisesRegex(HeaderError, reason):
            with_function(comment, declaration)

    def test_without_a_comment(self):
        with self.assertRaisesRegex(HeaderError, "mien_new.*has no comment"):
            edited((END, f"MIEN_CHECKED MienStatus mien_new(void);\n\n{END}"))

    def test_enums_of_parameters(self):
        by_type = parameter("Counts.", "mien_new(uint32_t kind)", "kind")
        self.assertEqual((by_type["role"], by_type["enum"]), ("enum", "MienKind"))
        said = parameter("`what` is a MIEN_STAGE_....", "mien_new(uint32_t what)", "what")
        self.assertEqual((said["role"], said["enum"]), ("enum", "MienStage"))
        index = parameter("Draws `what`.", "mien_new(uint32_t what)", "what")
        self.assertEqual((index["role"], index["enum"]), ("index", None))
        self.refused("name an enum", "Does it.", "mien_new(uint32_t what)")

    def test_counts(self):
        found = function("Adds.", "mien_new(const float* weights, size_t weight_count)")
        self.assertEqual(found["parameters"][0]["count"], "weight_count")
        self.assertEqual(found["parameters"][0]["role"], "array")
        self.refused("which parameter has its count", "Adds.", "mien_new(const float* weights)")
        text = parameter("Finds.", "mien_new(const char* name)", "name")
        self.assertEqual((text["role"], text["count"]), ("text", None))
        text = parameter("Finds.", "mien_new(const char* name, size_t name_count)", "name")
        self.assertEqual(text["count"], "name_count")
        said = parameter("`out_values` gets `row_count` rows.",
                         "mien_new(float* out_values, uint32_t row_count)", "out_values")
        self.assertEqual(said["count"], "row_count")

    def test_two_calls_for_a_size(self):
        found = function("Writes. `buffer` may be NULL.",
                         "mien_new(void* buffer, size_t capacity, size_t* out_size)")
        self.assertEqual(found["size_query"], "out_size")
        self.assertEqual(found["parameters"][0]["count"], "capacity")

    def test_null(self):
        declaration = "mien_new(const MienParallelFor* parallel)"
        self.assertTrue(parameter("`parallel`\n * may be NULL.", declaration, "parallel")["nullable"])
        self.assertTrue(parameter("Runs `parallel`, which\n * may be NULL.", declaration, "parallel")["nullable"])
        self.assertFalse(parameter("Runs `parallel`.", declaration, "parallel")["nullable"])
        self.refused("may be NULL", "Runs `parallel`, and it may be NULL.", declaration)
        declaration = "mien_new(const MienBatchDesc* desc)"
        self.assertTrue(parameter("Does it.", declaration, "desc")["nullable"])
        self.assertFalse(parameter("`desc` is required.", declaration, "desc")["nullable"])

    def test_views(self):
        declaration = "mien_new(const MienInstance* instance, MienFloatView* out_view)"
        text = "Gives 3 floats per joint. Contents change with mien_instance_reset()."
        view = parameter(text, declaration, "out_view")
        self.assertEqual(view["row"], {"widths": [3], "per": "joint"})
        self.assertEqual(view["view"], {"of": "instance", "valid_until": "mien_instance_destroy",
                                        "changes_with": ["mien_instance_reset"]})
        self.refused("not immutable", "Gives 3 floats per joint.", declaration)
        self.refused("width of a row", "Contents change with mien_instance_reset().", declaration)
        self.refused("no such function", text.replace("_reset", "_rest"), declaration)

    def test_ownership(self):
        declaration = "mien_new(const MienDna* dna, MienRig** out_rig)"
        self.refused("must outlive", "Packs.", declaration)
        self.assertEqual(parameter("`dna` may be closed.", declaration, "dna")["lifetime"], "call")
        self.assertEqual(parameter("`dna` must outlive it.", declaration, "dna")["lifetime"], "object")

    def test_threads(self):
        self.assertEqual(function("Looks.", "mien_new(const MienRig* rig)")["threads"], "shared")
        declaration = "mien_new(MienInstance* instance)"
        self.assertEqual(function("Moves.", declaration)["threads"], "exclusive")
        beside = "One thread may call this while another one uses the instance."
        self.assertEqual(function(beside, declaration)["threads"], "one_more")

    def statuses(self, comment, declaration="mien_new(const MienRig* rig)"):
        found = function(comment, declaration)["statuses"]
        return {s["name"][len("MIEN_ERROR_"):]: s["condition"] for s in found}

    def test_statuses(self):
        self.assertEqual(self.statuses("Looks."), {"NULL_ARGUMENT": None, "HANDLE": None})
        self.assertEqual(
            self.statuses("Looks.\n * Fails with MIEN_ERROR_LOD if there is none, MIEN_ERROR_INDEX or\n"
                          " * MIEN_ERROR_NAME if it is\n * past the end.\n * See docs/numbers.md."),
            {"NULL_ARGUMENT": None, "HANDLE": None, "LOD": "there is none",
             "INDEX": "it is past the end", "NAME": "it is past the end"})
        self.assertEqual(
            self.statuses("Looks.\n * Fails like mien_rig_find(), but not with MIEN_ERROR_NAME, and with\n"
                          " * MIEN_ERROR_LOD if it is dark."),
            {"NULL_ARGUMENT": None, "HANDLE": None, "INVALID_ARGUMENT": "`kind` has no names",
             "LOD": "it is dark"})

    def test_wrong_statuses(self):
        declaration = "mien_new(const MienRig* rig)"
        for reason, comment in (
                ("outside of the sentence", "Looks. MIEN_ERROR_LOD: there is none."),
                ("no \"if", "Looks.\n * Fails with MIEN_ERROR_LOD."),
                ("expected", "Looks.\n * Fails with MIEN_ERROR_LOD when there is none."),
                ("there is no MIEN_ERROR_DARK", "Looks.\n * Fails with MIEN_ERROR_DARK if so."),
                ("there is no mien_old", "Looks.\n * Fails like mien_old()."),
                ("does not fail with", "Looks.\n * Fails like mien_rig_find(), but not with "
                                       "MIEN_ERROR_LOD.")):
            self.refused(reason, comment, declaration)


class Structs(unittest.TestCase):
    def field(self, text, name, old="    uint32_t tasks;", struct="MienBatchDesc"):
        api = edited((old, text + "\n" + old))
        return by_name(by_name(api["structs"], struct)["fields"], name)

    def test_enums_booleans_and_numbers(self):
        self.assertEqual(self.field("    uint32_t mode; /* MIEN_ISA_... */", "mode")["enum"], "MienIsa")
        self.assertTrue(self.field("    uint32_t on; /* boolean: it is on */", "on")["boolean"])
        found = self.field("    uint32_t rows; /* rows: 1 to 2^10. 0: 32 */", "rows")
        self.assertEqual(found["range"], [1, 1024])
        self.assertEqual(found["sentinels"], [{"value": 0, "meaning": "32"}])
        with self.assertRaisesRegex(HeaderError, "no enum"):
            self.field("    uint32_t mode; /* MIEN_NOTHING_... */", "mode")

    def test_pointers(self):
        found = self.field("    const float* weights; /* one float per row. NULL: all 1 */\n"
                           "    uint64_t row_count;", "weights")
        self.assertTrue(found["nullable"])
        self.assertEqual((found["count"], found["row"]), ("row_count", {"widths": [1], "per": "row"}))
        self.assertFalse(self.field("    const float* weights; /* of rows */", "weights")["nullable"])

    def test_layouts(self):
        struct = by_name(edited()["structs"], "MienBatchDesc")
        self.assertEqual((struct["size"], struct["size_32"]), (24, 16))
        struct = by_name(edited(("    uint32_t tasks;", "    uint64_t more; /* rows */\n"
                                                        "    uint32_t tasks;"))["structs"],
                         "MienBatchDesc")
        self.assertEqual((struct["size"], struct["size_32"]), (40, 24))
        self.assertEqual(by_name(struct["fields"], "more")["offset_32"], 8)

    def test_a_sized_struct_needs_its_default(self):
        with self.assertRaisesRegex(HeaderError, "MIEN_DEFAULT"):
            edited(("MIEN_DEFAULT(MienBatchDesc, mien_batch_desc_default)\n", ""))

    def test_since(self):
        self.assertEqual(self.field("    uint32_t rows; /* Since 0.3.0. */", "rows")["since"], "0.3.0")
        self.assertEqual(by_name(edited()["functions"], "mien_rig_create")["since"], "0.1.0")


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What the headers offer is there for users of each language, beyond the generated declarations: every
function, every field of the structs that functions are given, every enum with all its values, and the
statuses of each function in the documentation.

What a language does without, for good or for now, is named in WITHOUT with the reason.
Usage: check_bindings.py [--self-test]
"""
import copy
import functools
import json
import re
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
INTEGRATIONS = HERE.parent

# Where users' calls come from, by language; what is generated is not counted.
SOURCES = {
    "C++": ["cpp/*.hpp"],
    "Python": ["python/mien/[a-z]*.py", "python/mien/_[!a]*.py"],
    "Rust": ["rust/mien/src/**/*.rs"],
    "JavaScript": ["web/mien/*.js"],
    "Lua": ["lua/mien/*.lua"],
    "C#": ["csharp/Mien/*.cs"],
    "Go": ["go/*[!t].go", "go/author/*.go"],
}
GENERATED = {"Python": "python/mien/_api.py", "Rust": "rust/mien/src/generated.rs",
             "JavaScript": "web/mien/api.js", "Lua": "lua/mien/api.lua",
             "C#": "csharp/Mien/Native.cs", "Go": "go/api.go"}

# "mien_noun_verb", "MienDesc.field", "MienEnum" or, of a field of all structs, "field": {language: why}
WITHOUT = {
    "allocator": {"C#": "memory is that of the library, released by handles",
                  "Go": "memory is that of the library, released by Close()",
                  "Lua": "memory is that of the library, released by the garbage collector",
                  "Python": "memory of the library is not Python's",
                  "JavaScript": "memory is the module's",
                  "Rust": "an allocator is given where objects are many: instances, batches, reports"},
    "mien_rig_evaluate": {"C#": "Evaluate() takes stages", "Go": "EvaluateStages() with all stages"},
    "MienBatchDesc.tasks": {"C#": "callbacks from C are not offered", "Go": "callbacks from C are not offered"},
    "MienClipDesc.frame_stride": {"C#": "rows are arrays", "Go": "rows are slices", "Python": "rows are arrays", "Rust": "rows are a slice"},
    "MienClipPlayerDesc.speed_numerator": {"Rust": "ClipPlayer::set_speed()"},
    "MienClipPlayerDesc.speed_denominator": {"Rust": "ClipPlayer::set_speed()"},
    "MienClipPlayerDesc.start_tick": {"Rust": "ClipPlayer::seek()"},
    "MienAuthorDesc.progress_user": {"Python": "functions keep what they need"},
    "MienVertexFormat": {"Python": "the type of an array says it"},
    "file_access": {"JavaScript": "there is no file system"},
    **{name: {"C#": "callbacks from C are not offered", "Go": "callbacks from C are not offered",
              "Lua": "callbacks from C into Lua cost more than reading the bytes"} for name in (
        "mien_dna_open_stream", "mien_baked_open_stream", "mien_clip_open_stream")},
    **{name: {"JavaScript": "there is no file system"} for name in (
        "mien_dna_open_file", "mien_dna_write_file", "mien_dna_validate_file", "mien_bake_file",
        "mien_baked_open_file", "mien_clip_open_file", "mien_clip_write_file",
        "mien_mix_open_file", "mien_mix_write_file", "mien_document_open_file", "mien_document_write_file")},
    **{"mien_document_write_stream": {language: "files and memory are written" for language in (
        "Python", "Rust", "JavaScript")}},
    **{name: {"JavaScript": "a stream reads the caller's bytes, without a copy that has to be kept"}
       for name in ("mien_dna_open_memory", "mien_baked_open_memory", "mien_clip_open_memory")},
    "mien_derivatives_bytes": {"Python": "memory of the library is not Python's"},
    "MienFitFrame.user": {"Python": "functions keep what they need"},
    **{name: {"JavaScript": "one by one, each on several threads if it is large"} for name in (
        "mien_deformer_instance_deform_batch", "mien_deformer_instance_write_vertices_batch")},
}
# Families of names that languages have not yet: what they begin with. Users call these by the C interface, which Rust has
# in mien-sys, Lua by its FFI, C# as Mien.Native.Functions, and Go as cgo.
_DERIVATIVES = ("MienDerivatives", "MienJacobian", "mien_derivatives_", "mien_jacobian_")
_SOLVING = (*_DERIVATIVES, "mien_deformer_create_subset", "MienFitDesc", "MienFitFrame", "MienFitSurface", "mien_fit_")
LATER_IN_ALL = (
    "MienAuthorDesc", "MienAuthorMesh", "MienDocument", "MienPlacement",
    "MienProject", "MienPrune", "MienSolver", "MienTransplant", "MienValidate", "mien_author_", "mien_batch_bytes",
    "mien_clip_binding_snaps", "mien_clip_channel", "mien_clip_event", "mien_clip_find_", "mien_clip_verify",
    "mien_control_name", "mien_coordinate_system_name", "mien_deformer_instance_deform_batch",
    "mien_deformer_instance_write_vertices_batch", "mien_dna_child_", "mien_dna_layer",
    "mien_dna_validate_", "mien_document_", "mien_instance_ml_controls", "mien_instance_psd_", "mien_instance_rbf_",
    "mien_instance_statistics", "mien_isa_", "mien_mix_glare", "mien_mix_guard", "mien_mix_mask",
    "mien_mixer_step_batch", "mien_report_", "mien_rig_evaluate_joint_group", "mien_rig_evaluate_rbf_",
    "mien_rig_evaluate_twist_", "mien_rig_initial_", "mien_rig_psd_", "mien_rig_statistics", "mien_rig_variable_",
    "mien_solver_", *_SOLVING)
LATER = {
    "Rust": _DERIVATIVES, "JavaScript": _DERIVATIVES,
    "Lua": LATER_IN_ALL + ("mien_deformer_bind_", "mien_deformer_influences", "mien_deformer_instance_local_",
                           "mien_deformer_inverse_", "mien_deformer_target"),
    "Go": LATER_IN_ALL + ("MienCoordinateSystem.", "MienMixDesc.custom_", "MienVertexOutput.tangents",
                          "mien_deformer_bind_", "mien_deformer_influences", "mien_deformer_instance_local_",
                          "mien_deformer_inverse_", "mien_deformer_target"),
    "C#": LATER_IN_ALL + ("MienCoordinateSystem.", "MienMixDesc.custom_"),
}
# Functions whose own statuses cannot reach a user, who finds no list of them either.
SILENT = {
    "mien_coordinate_system_name": {"Python", "Rust"},
    "mien_clip_event": {"Python"}, "mien_mixer_event": {"Python"}, "mien_dna_layer": {"Python"},
    "mien_report_finding": {"Python"},
    "mien_deformer_instance_local_transforms": {"Python"},
    "mien_rig_map_gui_to_raw": {"Python"}, "mien_rig_map_raw_to_gui": {"Python"},
    # Documented where the same method calls another function too.
    "mien_rig_evaluate": {"Python"}, "mien_dna_read_floats": {"Python"},
    "mien_dna_read_integers": {"Python"}, "mien_dna_read_string": {"Python"},
}


def without_comments(text, suffix):
    if suffix == ".lua":
        return re.sub(r"--[^\n]*", "", text)
    if suffix == ".py":
        return re.sub(r'""".*?"""|#[^\n]*', "", text, flags=re.DOTALL)
    return re.sub(r"/\*.*?\*/|//[^\n]*", "", text, flags=re.DOTALL)


def braced(text, start):
    """From `start`, just behind an opening bracket, to the closing one."""
    depth, end = 1, start
    while depth and end < len(text):
        depth += {"(": 1, "{": 1, ")": -1, "}": -1}.get(text[end], 0)
        end += 1
    return text[start:end - 1]


class Binding:
    """The sources of a language."""

    def __init__(self, language, text, generated=""):
        self.language, self.text, self.generated = language, text, generated
        self.without_underscores = generated.replace("_", "")
        self.names = set(re.findall(r"\bmien_\w+\b", text))
        if language == "C#":  # handles are released by generated classes; fields have names such as RawControlCount
            for handle in re.findall(r"new (\w+)Handle\(taken", text):
                released = re.search(rf"class {handle}Handle : .*?Functions\.(\w+)\(taken\)", generated, re.DOTALL)
                self.names.add(released.group(1))
        # Lua releases handles of classes by a generated table.
        for handle in re.findall(r'object\.class\("\w+", "(\w+)"\)', text):
            self.names |= set(re.findall(rf'^  {handle} = "(\w+)"', generated, re.MULTILINE))

    @functools.lru_cache(maxsize=None)
    def fields_of(self, struct):
        """Names of the fields that are set, or None for all of them."""
        if self.language == "C++":
            given = rf"Sized<{struct}>|Span<const {struct}>|const {struct}\b"
            return None if re.search(given, self.text) else set()
        if f"for sys::{struct}" in self.generated:
            return None  # a struct of its own, with every field
        if self.language == "JavaScript":
            return self.javascript_fields(struct)
        if self.language == "Lua":  # tables of users name the fields
            return None if f'"{struct}"' in self.text else set()
        if self.language == "C#":  # parameters are whole structs; else fields are set one by one
            if f"default({struct})" in self.text:
                return None
            if not re.search(rf"\b{struct}\b", self.text):
                return set()
            return {re.sub("(?<!^)([A-Z])", r"_\1", field).lower()
                    for field in re.findall(r"\b([A-Z]\w+) = ", self.text)}
        if self.language == "Go":  # structs of Go are copied whole; else fields are set one by one, in literals or lists
            if f"(*C.{struct})(unsafe.Pointer(&desc))" in self.text or f"(*C.{struct})(unsafe.Pointer(&m.play))" in self.text:
                return None
            if not re.search(rf"\bC\.{struct}\b", self.text):
                return set()
            return set(re.findall(r"\b(?:desc|output)\.(\w+)", self.text)) | set(re.findall(r"\b(\w+): ", self.text))
        found = set(re.findall(r"\.(\w+) = ", self.text))
        for match in re.finditer(rf"\b{struct}(?:\(| \{{)", self.text):
            inside = braced(self.text, match.end())
            if "**" in inside:
                return None
            # Python: field=value; Rust: field: value, or the field alone.
            found |= set(re.findall(r"(?:^|[,\s(])(?:r#)?(\w+)(?==[^=]|:[^:]|\s*(?:,|$))", inside))
        return found

    def javascript_fields(self, struct):
        """Names of the fields in the generated layout, if an object of the caller is written to it."""
        name = struct[len("Mien"):]
        layout = re.search(rf"^  {name}: {{(.*?)^  }} }}", self.generated, re.DOTALL | re.MULTILINE)
        if not layout or not re.search(rf'"\*?{name}"', self.text + self.generated):
            return set()
        return {re.sub("([A-Z])", r"_\1", field).lower()
                for field in re.findall(r"^    (\w+): \[", layout.group(1), re.MULTILINE)}

    def has_enum(self, name, enum):
        """Whether users can name the enum; the generators write all its values."""
        if self.language == "C++":
            return True  # mien.hpp includes mien.h
        if self.language == "JavaScript":
            return f"export const {name} =" in self.generated
        if self.language == "Lua":
            return f"\napi.{name} = {{" in self.generated
        if self.language == "C#":
            return f"public enum {name} : " in self.generated
        if self.language == "Go":
            return f"\ntype {name} " in self.generated
        if not re.search(rf"\bclass {name}\(|\bstruct {name}\(", self.generated):
            return False
        if self.language == "Rust":
            return "pub use generated::*" in self.text
        return f'"{name}"' in self.text

    @functools.lru_cache(maxsize=None)
    def has_value(self, enum_name, short, number):
        """Whether the generated enum has the value, which the header calls MIEN_..._SHORT."""
        if enum_name == "MienStatusCode":
            short = re.sub("^ERROR_", "", short)
        if self.language == "Go":
            short = "".join(part.capitalize() for part in short.split("_"))
            return re.search(rf"^const \w+{short} \w+ = {number}$", self.without_underscores, re.MULTILINE) is not None
        if self.language == "C#":
            short = "".join(part.capitalize() for part in short.split("_"))
            return f" {short} = {number}," in self.without_underscores
        return self.language == "C++" or \
            re.search(rf"\b_?{short}\b.*\b{number}\b", self.generated) is not None

    def documents(self, function):
        if self.language in ("JavaScript", "Lua", "C#", "Go") or self.language in SILENT.get(function, ()):
            return True  # their generated files or cgo have the comments of the header
        if self.language == "Python":
            return re.search(rf'@raises\([^)]*"{function}(_n)?"', self.text) is not None
        return self.language != "Rust" or f"errors!({function})" in self.text


def safe_name(language, enum):
    """What a language calls an enum: StatusCode is Status, flags of Rust are plural."""
    name = {"MienStatusCode": "Status"}.get(enum["name"], enum["name"][len("Mien"):])
    return {"Layer": "Layers", "Stage": "Stages"}.get(name, name) if language == "Rust" else name


def problems_of(api, binding):
    language = binding.language
    functions = [function["name"] for function in api["functions"]]

    def missing(name, what, is_there, plain=None):
        later = name.startswith(LATER.get(language, ()))
        excused = later or language in WITHOUT.get(name, {}) or language in WITHOUT.get(plain, {})
        if not is_there and not excused:
            yield f"{language} has no {what}"
        # Fields are found by their names alone, so those of another struct may look like them.
        if is_there and (later and "." not in name or language in WITHOUT.get(name, {})):
            yield f"{language} has a {what}, though WITHOUT says not"

    for function in api["functions"]:
        # A function that takes text, and its sibling that takes a length: one of them will do.
        name = function["name"]
        sibling = name[:-2] if name.endswith("_n") else name + "_n"
        if name not in binding.names and sibling in functions and sibling in binding.names:
            continue
        yield from missing(name, f"binding of {name}", name in binding.names)
        special = [s for s in function["statuses"] if not s["general"]]
        if special and name in binding.names and not name.endswith("_n") and \
                not binding.documents(name):
            yield f"{language} does not document the statuses of {name}"
    given = {p["type"]["to"]["name"] for f in api["functions"] for p in f["parameters"]
             if p["role"] in ("struct", "array") and p["direction"] == "in"
             and p["type"]["to"]["kind"] == "struct"}
    for struct in api["structs"]:
        if struct["name"] not in given or not struct["sized"]:
            continue
        fields = binding.fields_of(struct["name"])
        for field in struct["fields"]:
            if field["name"] in ("struct_size", "reserved"):
                continue
            name = f"{struct['name']}.{field['name']}"
            yield from missing(name, f"way to set {name}",
                               fields is None or field["name"] in fields, field["name"])
    for enum in api["enums"]:
        name = safe_name(language, enum)
        there = binding.has_enum(name, enum)
        yield from missing(enum["name"], f"enum {name}", there)
        for value in enum["values"]:
            if there and not binding.has_value(enum["name"], value["short_name"], value["value"]):
                yield f"{language} has no {value['name']}"


def bindings():
    for language, patterns in SOURCES.items():
        files = sorted({file for pattern in patterns for file in INTEGRATIONS.glob(pattern)})
        if not files:
            print(f"NOT TESTED: there is no binding for {language}")
            continue
        generated = INTEGRATIONS / GENERATED.get(language, "")
        files = [file for file in files if file != generated]
        text = "\n".join(without_comments(file.read_text(encoding="utf-8"), file.suffix)
                         for file in files)
        yield Binding(language, text, generated.read_text(encoding="utf-8")
                      if language in GENERATED else "")


def self_test(api, found):
    """Each kind of thing that is added to the interface is missed in each language that lacks it."""
    def added(change):
        new = copy.deepcopy(api)
        change(new)
        return [problem for binding in found for problem in problems_of(new, binding)]

    def add_function(new):
        new["functions"].append(dict(new["functions"][0], name="mien_added", statuses=[]))

    def add_status(new):
        entry = next(f for f in new["functions"] if f["name"] == "mien_rig_count")
        entry["statuses"].append({"name": "MIEN_ERROR_LOD", "condition": "?", "general": False})

    def add_field(new):
        struct = next(s for s in new["structs"] if s["name"] == "MienRigDesc")
        struct["fields"].append(dict(struct["fields"][1], name="added"))

    def add_enum(new):
        new["enums"].append({"name": "MienAdded", "values": []})

    def add_value(new):
        enum = next(e for e in new["enums"] if e["name"] == "MienIsa")
        enum["values"].append({"name": "MIEN_ISA_ADDED", "short_name": "ADDED", "value": 77})

    both = ["Python", "Rust"]
    all_others = both + ["JavaScript", "Lua", "C#", "Go"]
    for change, languages, what in (
            (lambda new: None, [], ""),
            (add_function, ["C++"] + all_others, "has no binding of mien_added"),
            (add_status, both, "does not document the statuses of mien_rig_count"),
            (add_field, both + ["JavaScript"], "has no way to set MienRigDesc.added"),
            (add_enum, all_others, "has no enum Added"),
            (add_value, all_others, "has no MIEN_ISA_ADDED")):
        problems, expected = added(change), [f"{language} {what}" for language in languages]
        assert problems == expected, (problems, expected)


def main():
    api = json.loads((HERE / "mien_api.json").read_text(encoding="utf-8"))
    found = list(bindings())
    problems = [problem for binding in found for problem in problems_of(api, binding)]
    known = {f["name"] for f in api["functions"]} | {e["name"] for e in api["enums"]} | \
        {f"{s['name']}.{f['name']}" for s in api["structs"] for f in s["fields"]} | \
        {f["name"] for s in api["structs"] for f in s["fields"]}
    problems += [f"WITHOUT or SILENT names {name}, which mien.h does not declare"
                 for name in sorted(set(WITHOUT) | set(SILENT)) if name not in known]
    if sys.argv[1:] == ["--self-test"] and not problems:
        self_test(api, found)
    print("\n".join(problems) if problems else
          f"{len(api['functions'])} functions, {len(api['enums'])} enums and the fields of structs, "
          f"each in {', '.join(binding.language for binding in found)}")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())

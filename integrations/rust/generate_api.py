#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The parts of the Rust crates that follow from mien.h, written from ../api/mien_api.json.

    generate_api.py            write mien-sys/src/bindings.rs, mien-sys/tests/layout.rs and
                               mien/src/generated.rs
    generate_api.py --check    fail if one of them is not what the data says

They are committed, one item a line: a crate has to build without Python, and docs.rs and editors show their
documentation and source to users.
"""
import re
import sys
import textwrap
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "api"))
from generator import load, short_name, write_or_check  # noqa: E402

HEAD = "// SPDX-License-Identifier: MIT\n// Written by generate_api.py from mien.h. Do not edit.\n"

SCALARS = {
    "char": "c_char", "int8_t": "i8", "uint8_t": "u8", "int16_t": "i16", "uint16_t": "u16",
    "int32_t": "i32", "uint32_t": "u32", "int64_t": "i64", "uint64_t": "u64", "size_t": "usize",
    "float": "f32", "double": "f64",
}
KEYWORDS = {"type", "move", "loop", "match", "ref", "use", "where", "in", "box", "final", "override"}

# Rust calls what combines flags by the plural, and the numbers of MienStatus after the type.
NAMES = {"MienStatusCode": "Status", "MienLayer": "Layers", "MienStage": "Stages"}
# Names that are words of Rust's own.
FIELDS = {"type": "field_type"}


def word(name):
    return f"r#{name}" if name in KEYWORDS else name


def rust_name(name):
    return NAMES.get(name, name[len("Mien"):])


# ---- documentation -----------------------------------------------------------------------------------


def prose(text, api=None):
    """Names as code; with `api`, constants under their names in the safe crate."""
    constants = {}
    for enum in api["enums"] if api else ():
        constants[enum["prefix"] + "..."] = rust_name(enum["name"])
        for value in enum["values"]:
            constants[value["name"]] = f"{rust_name(enum['name'])}::{short_name(enum, value)}"

    def replace(match):
        name = match.group()
        if re.fullmatch(r"[\[\]<>*_|]", name):
            return "\\" + name
        return f"`{constants.get(name, name)}`" if name[0] != "`" else name

    pattern = r"`[^`]*`|\bMIEN_\w*(?:\.\.\.)?|\bmien_\w+(?:\(\))?|\b[a-z]+(?:_[a-z0-9]+)+\b|[\[\]<>*_|]"
    return re.sub(pattern, replace, text)


def sentence(text):
    """Starts and ends like one, unless it starts with a name."""
    if not text:
        return text
    if re.match("[a-z]+[ ,;:.]", text):
        text = text[0].upper() + text[1:]
    return text if text[-1] in ".:;" else text + "."


def doc(text, indent, fallback=None, api=None):
    """Comment lines. What is indented in the header is laid out by hand: it stays as it is."""
    text = text or fallback
    if not text:
        return ""
    # What it fails with, and where to read on, in paragraphs of their own.
    text = re.sub(r"\n(?=(?:Fails (?:with|like)|Contents change with|See docs/))", "\n\n", text)
    blocks = []  # [laid out, lines]
    for line in text.split("\n"):
        laid_out = line.startswith("  ")
        if not line:
            blocks.append([False, []])
        elif blocks and blocks[-1][1] and blocks[-1][0] == laid_out:
            blocks[-1][1].append(line)
        else:
            blocks.append([laid_out, [line]])
    lines = []
    for laid_out, block in blocks:
        if not block:
            continue
        lines += [""] if lines else []
        if laid_out:
            lines += ["```text"] + [line.rstrip() for line in textwrap.dedent("\n".join(block)).split("\n")] + ["```"]
        else:
            lines += textwrap.wrap(prose(" ".join(block), api), 95 - len(indent), break_on_hyphens=False)
    return "".join(f"{indent}/// {line}".rstrip() + "\n" for line in lines)


# ---- mien-sys ------------------------------------------------------------------------------------------


def sys_type(type_):
    kind = type_["kind"]
    if kind == "scalar":
        return SCALARS[type_["name"]]
    if kind in ("alias", "handle", "struct", "callback"):
        return type_["name"]
    if kind == "void":
        return "c_void"
    if kind == "pointer":
        return ("*const " if type_["const"] else "*mut ") + sys_type(type_["to"])
    if kind == "array":
        return f"[{sys_type(type_['of'])}; {type_['count']}]"
    if kind == "function":
        return f"Option<{function_pointer(type_)}>"
    sys.exit(f"generate_api.py: no Rust for {type_}")


def function_pointer(type_):
    parameters = ", ".join(
        f"{word(p['name']) if p.get('name') else '_'}: {sys_type(p['type'])}" for p in type_["parameters"])
    return f'unsafe extern "C" fn({parameters}){returns(type_)}'


def returns(function):
    if function["returns"]["kind"] == "void":
        return ""
    return f" -> {sys_type(function['returns'])}"


def sys_struct(struct):
    out = doc(struct["documentation"], "")
    out += "#[repr(C)]\n#[derive(Clone, Copy)]\n"
    out += f"pub struct {struct['name']} {{\n"
    for field in struct["fields"]:
        out += doc(sentence(field["documentation"]), "    ")
        out += f"    pub {word(field['name'])}: {sys_type(field['type'])},\n"
    out += "}\n\n"
    size = "        zero.struct_size = size_of::<Self>();\n" if struct["sized"] else ""
    what = "All zero but `struct_size`: every field has its default." if size else "All zero."
    out += f"impl Default for {struct['name']} {{\n    /// {what}\n    fn default() -> Self {{\n"
    out += "        // SAFETY: numbers, pointers and optional functions may be zero.\n"
    if size:
        out += f"        let mut zero: Self = unsafe {{ zeroed() }};\n{size}        zero\n"
    else:
        out += "        unsafe { zeroed() }\n"
    return out + "    }\n}\n"


def bindings(api):
    parts = [HEAD + "\nuse crate::{c_char, c_void, size_of, zeroed, Opaque};\n"]
    for alias in api["aliases"]:
        parts.append(f"{doc(alias['documentation'], '')}pub type {alias['name']} = {sys_type(alias['type'])};\n")
    for callback in api["callbacks"]:
        text = doc(callback["documentation"], "")
        parts.append(f"{text}pub type {callback['name']} = Option<{function_pointer(callback)}>;\n")
    constants = ""
    for constant in api["constants"]:
        type_ = "u64" if constant["value"] > 0xFFFFFFFF else "u32"
        constants += doc(sentence(constant["documentation"]), "")
        constants += f"pub const {constant['name']}: {type_} = {constant['value']};\n"
    parts.append(constants)
    for enum in api["enums"]:
        type_ = "MienStatus" if enum["name"] == "MienStatusCode" else "u32"
        text = f"// enum {enum['name']}\n"
        for value in enum["values"]:
            text += doc(sentence(value["documentation"]), "")
            text += f"pub const {value['name']}: {type_} = {value['value']};\n"
        parts.append(text)
    for handle in api["handles"]:
        text = doc(handle["documentation"], "") + "#[repr(C)]\n"
        parts.append(f"{text}pub struct {handle['name']} {{\n    _size: [u8; 0],\n    _opaque: Opaque,\n}}\n")
    parts += [sys_struct(struct) for struct in api["structs"]]
    text = 'extern "C" {\n'
    for index, function in enumerate(api["functions"]):
        text += "\n" if index else ""
        note = function["documentation"]
        if not note and function["documented_with"]:
            note = f"See `{function['documented_with']}`."
        text += doc(note, "    ")
        signature = ", ".join(f"{word(p['name'])}: {sys_type(p['type'])}" for p in function["parameters"])
        text += f"    pub fn {function['name']}({signature}){returns(function)};\n"
    parts.append(text + "}\n")
    return "\n".join(parts)


def layout(api):
    out = HEAD + """//! The compiler lays out every struct as the C compiler does.
#![cfg(target_pointer_width = "64")]

use std::mem::{align_of, size_of, MaybeUninit};
use std::ptr::addr_of;

/// Of each struct its name, size and alignment, then its fields and where they begin.
macro_rules! layouts {
    ($($type:ident $size:literal $alignment:literal: $($field:ident $offset:literal)*;)*) => {$({
        use mien_sys::$type as S;
        let name = stringify!($type);
        assert_eq!((size_of::<S>(), align_of::<S>()), ($size, $alignment), "{name}");
        let place = MaybeUninit::<S>::uninit();
        let start = place.as_ptr();
        $(
            // SAFETY: the address of a field is taken, nothing is read.
            let at = unsafe { addr_of!((*start).$field) as usize - start as usize };
            assert_eq!(at, $offset, "{name}.{}", stringify!($field));
        )*
        let _ = start;
    })*};
}

#[test]
fn structs_are_laid_out_as_in_c() {
    layouts! {
"""
    for struct in api["structs"]:
        fields = "".join(f" {word(field['name'])} {field['offset']}" for field in struct["fields"])
        text = f"{struct['name']} {struct['size']} {struct['alignment']}:{fields};"
        out += textwrap.fill(text, 100, initial_indent=" " * 8, subsequent_indent=" " * 12) + "\n"
    return out + "    }\n}\n"


# ---- mien ----------------------------------------------------------------------------------------------


def safe_enum(enum, api):
    name, status = rust_name(enum["name"]), enum["name"] == "MienStatusCode"
    type_ = "i32" if status else "u32"
    text = sentence(enum["documentation"]) or f"What C calls `{enum['prefix']}...`."
    if status:
        text = "Why a call failed. The numbers are never used again for something else."
    out = doc(text + "\n\nA later library may give numbers that have no name here.", "", api=api)
    default = ", Default" if any(value["value"] == 0 for value in enum["values"]) else ""
    out += f"#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash{default})]\n"
    out += f"#[repr(transparent)]\npub struct {name}(pub {type_});\n\n"
    out += f"impl {name} {{\n"
    for value in enum["values"]:
        short = short_name(enum, value)
        out += doc(sentence(value["documentation"]), "    ", f"`{value['name']}` in C.", api)
        out += f"    pub const {short}: Self = Self({value['value']});\n"
    names = ", ".join(f'({value["value"]}, "{short_name(enum, value)}")' for value in enum["values"])
    out += "}\n\n"
    macro = "flags" if enum["flags"] else "numbers"
    out += f"{macro}!({name}, {type_}, [{names}]);\n"
    if status:
        out += "\npub(crate) fn describe(status: Status) -> &'static str {\n    match status.0 {\n"
        for value in enum["values"]:
            if value["documentation"]:
                text = value["documentation"].replace('"', '\\"').replace("\n", " ")
                out += f'        {value["value"]} => "{text}",\n'
        out += '        _ => "",\n    }\n}\n'
    return out


def is_plain(type_):
    if type_["kind"] == "array":
        type_ = type_["of"]
    return type_["kind"] in ("scalar", "alias")


def plain_outputs(api):
    """Structs of numbers alone that functions fill in."""
    outputs = set()
    for function in api["functions"]:
        for parameter in function["parameters"]:
            type_ = parameter["type"]
            if (parameter["name"].startswith("out_") and type_["kind"] == "pointer"
                    and type_["to"]["kind"] == "struct"):
                outputs.add(type_["to"]["name"])
    for struct in api["structs"]:
        if struct["sized"] and struct["name"] in outputs and all(is_plain(f["type"]) for f in struct["fields"]):
            yield struct


def safe_field(struct, field):
    """(type, value read from `c`) of a field, or None for one that says nothing."""
    name, type_ = field["name"], field["type"]
    if name in ("struct_size",) or name.startswith("reserved"):
        return None
    value = f"c.{word(name)}"
    if field["boolean"]:
        return "bool", f"{value} != 0"
    if "MIEN_NO_OFFSET" in field["documentation"]:
        return "Option<u64>", f"offset({value})"
    if field["enum"]:
        wrapper = rust_name(field["enum"])
        if type_["kind"] == "array":
            return f"[{wrapper}; {type_['count']}]", f"{value}.map({wrapper})"
        return wrapper, f"{wrapper}({value})"
    if type_["kind"] == "array":
        if type_["of"]["name"] == "char":
            return "String", f"text(&{value})"
        return f"[{SCALARS[type_['of']['name']]}; {type_['count']}]", value
    if type_["kind"] == "scalar" and type_["name"] == "uint32_t" and name.endswith("_count"):
        return "usize", f"{value} as usize"
    return SCALARS[(type_ if type_["kind"] == "scalar" else type_["of"])["name"]], value


def safe_struct(struct, api):
    name = rust_name(struct["name"])
    fields = [(field, safe_field(struct, field)) for field in struct["fields"]]
    fields = [(field, safe) for field, safe in fields if safe]
    out = doc(struct["documentation"], "", f"`{struct['name']}` in C.", api)
    copy = "" if any(safe[0] == "String" for _, safe in fields) else ", Copy"
    floats = any(re.search(r"\bf(32|64)\b", safe[0]) for _, safe in fields)
    out += f"#[derive(Clone{copy}, Debug, PartialEq{'' if floats else ', Eq'})]\n#[non_exhaustive]\n"
    out += f"pub struct {name} {{\n"
    for field, (type_, _) in fields:
        text = field["documentation"].replace("MIEN_NO_OFFSET", "`None`")
        if re.fullmatch(r"MIEN_\w*\.\.\.", text):
            text = ""  # the type says so
        out += doc(sentence(text), "    ", f"{field['name'].replace('_', ' ').capitalize()}.", api)
        out += f"    pub {FIELDS.get(field['name'], field['name'])}: {type_},\n"
    out += f"}}\n\nimpl From<sys::{struct['name']}> for {name} {{\n"
    out += f"    fn from(c: sys::{struct['name']}) -> Self {{\n        Self {{\n"
    for field, (_, value) in fields:
        out += f"            {FIELDS.get(field['name'], field['name'])}: {value},\n"
    out += "        }\n    }\n}\n"
    if struct["name"] in inputs(api):
        out += f"\nimpl From<&{name}> for sys::{struct['name']} {{\n"
        out += f"    fn from(safe: &{name}) -> Self {{\n        Self {{\n"
        for field, (type_, _) in fields:
            out += f"            {word(field['name'])}: {raw_value(field, type_)},\n"
        out += "            ..Default::default()\n        }\n    }\n}\n"
    return out


def inputs(api):
    """Structs that functions are given, by themselves or by the address in another struct."""
    types = [field["type"] for struct in api["structs"] for field in struct["fields"]]
    types += [p["type"] for function in api["functions"] for p in function["parameters"]]
    return {type_["to"]["name"] for type_ in types
            if type_["kind"] == "pointer" and type_["const"] and type_["to"]["kind"] == "struct"}


def raw_value(field, type_):
    value = f"safe.{FIELDS.get(field['name'], field['name'])}"
    if field["enum"]:
        return f"{value}.map(|value| value.0)" if type_[0] == "[" else f"{value}.0"
    if type_ in ("bool", "usize"):
        return f"{value} as u32"
    if type_ in ("Option<u64>", "String"):
        sys.exit(f"generate_api.py: {field['name']} of a struct that functions are given: {type_}")
    return value


# What arguments of the safe crate cannot be: NULL, of another kind, of a wrong size.
IMPOSSIBLE = ("MIEN_ERROR_NULL_ARGUMENT", "MIEN_ERROR_HANDLE", "MIEN_ERROR_STRUCT_SIZE")
GENERAL = {"MIEN_ERROR_INVALID_ARGUMENT": "an argument is outside its range",
           "MIEN_ERROR_MEMORY": "the allocator has no memory",
           "MIEN_ERROR_UNSUPPORTED": "this build of libmien opens baked files only"}


def errors(api):
    """A macro that gives the `# Errors` section of what calls a function."""
    status_of = {value["name"]: short_name(enum, value) for enum in api["enums"]
                 if enum["name"] == "MienStatusCode" for value in enum["values"]}
    out = "/// The `# Errors` section of what calls a function of the C interface.\n"
    out += "macro_rules! errors {\n"
    for function in api["functions"]:
        if function["returns"].get("name") != "MienStatus":
            continue
        lines = []
        for status in function["statuses"]:
            if status["name"] not in IMPOSSIBLE:
                name = status_of[status["name"]]
                condition = status["condition"]
                if not condition or function["size_query"] and status["name"] in GENERAL:
                    condition = GENERAL[status["name"]]  # the buffer is never too small here
                condition = prose(condition, api)
                lines.append(f"- [`Status::{name}`](crate::Status::{name}) if {condition}")
        lines = [line.replace("\\", "\\\\").replace('"', '\\"') for line in lines]
        text = "\\n\\\n         ".join(lines or ["- none with valid arguments"])
        out += f'    ({function["name"]}) => {{\n        "{text}"\n    }};\n'
    return out + "}\n"


def generated(api):
    parts = [HEAD + "\nuse crate::convert::{flags, numbers, offset, text};\nuse mien_sys as sys;\n"]
    parts += [safe_enum(enum, api) for enum in api["enums"]]
    parts += [safe_struct(struct, api) for struct in plain_outputs(api)]
    parts.append(errors(api))
    return "\n".join(parts)


if __name__ == "__main__":
    data = load()
    write_or_check({HERE / "mien-sys/src/bindings.rs": bindings(data),
                    HERE / "mien-sys/tests/layout.rs": layout(data),
                    HERE / "mien/src/generated.rs": generated(data)})

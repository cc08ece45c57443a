# SPDX-License-Identifier: MIT
"""The parts of the Rust crates that follow from the headers: mien-sys, its test of layouts, and in mien what the safe
crate says of enums, results and errors. They are committed: a crate has to build without Python."""
import re
import textwrap

from model import references, spell

TYPES = {
    "char": "c_char", "int8_t": "i8", "uint8_t": "u8", "int16_t": "i16", "uint16_t": "u16",
    "int32_t": "i32", "uint32_t": "u32", "int64_t": "i64", "uint64_t": "u64", "size_t": "usize",
    "float": "f32", "double": "f64", "void": "c_void", "array": "[{of}; {count}]",
    "alias": "{name}", "handle": "{name}", "struct": "{name}", "callback": "{name}",
    "*": "*mut {to}", "const*": "*const {to}",
    "function": lambda kind: f"Option<{function_pointer(kind)}>",
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


def prose(text, names):
    """Names as code; `names` has those of constants in the safe crate, and is empty for mien-sys."""
    def replace(match):
        name = match.group()
        if re.fullmatch(r"[\[\]<>*_|]", name):
            return "\\" + name
        return f"`{names.get(name, name)}`" if name[0] != "`" else name

    pattern = r"`[^`]*`|\bMIEN_\w*(?:\.\.\.)?|\bmien_\w+(?:\(\))?|\b[a-z]+(?:_[a-z0-9]+)+\b|[\[\]<>*_|]"
    return re.sub(pattern, replace, text)


def sentence(text):
    """Starts and ends like one, unless it starts with a name."""
    if not text:
        return text
    if re.match("[a-z]+[ ,;:.]", text):
        text = text[0].upper() + text[1:]
    return text if text[-1] in ".:;" else text + "."


def doc(text, indent, fallback=None, names={}):
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
            lines += textwrap.wrap(prose(" ".join(block), names), 95 - len(indent), break_on_hyphens=False)
    return "".join(f"{indent}/// {line}".rstrip() + "\n" for line in lines)


# ---- mien-sys ------------------------------------------------------------------------------------------


def function_pointer(type_):
    parameters = ", ".join(
        f"{word(p.name) or '_'}: {spell(p.type, TYPES)}" for p in type_.parameters)
    return f'unsafe extern "C" fn({parameters}){returns(type_)}'


def returns(function):
    if function.returns.kind == "void":
        return ""
    return f" -> {spell(function.returns, TYPES)}"


def sys_struct(struct):
    out = doc(struct.documentation, "")
    out += "#[repr(C)]\n#[derive(Clone, Copy)]\n"
    out += f"pub struct {struct.name} {{\n"
    for field in struct.fields:
        out += doc(sentence(field.documentation), "    ")
        out += f"    pub {word(field.name)}: {spell(field.type, TYPES)},\n"
    out += "}\n\n"
    size = "        zero.struct_size = size_of::<Self>();\n" if struct.sized else ""
    what = "All zero but `struct_size`: every field has its default." if size else "All zero."
    out += f"impl Default for {struct.name} {{\n    /// {what}\n    fn default() -> Self {{\n"
    out += "        // SAFETY: numbers, pointers and optional functions may be zero.\n"
    if size:
        out += f"        let mut zero: Self = unsafe {{ zeroed() }};\n{size}        zero\n"
    else:
        out += "        unsafe { zeroed() }\n"
    return out + "    }\n}\n"


def write_bindings(api):
    parts = ["\nuse crate::{c_char, c_void, size_of, zeroed, Opaque};\n"]
    for alias in api.aliases:
        parts.append(f"{doc(alias.documentation, '')}pub type {alias.name} = {spell(alias.type, TYPES)};\n")
    for callback in api.callbacks:
        text = doc(callback.documentation, "")
        parts.append(f"{text}pub type {callback.name} = Option<{function_pointer(callback)}>;\n")
    constants = ""
    for constant in api.constants:
        type_ = "u64" if constant.value > 0xFFFFFFFF else "u32"
        constants += doc(sentence(constant.documentation), "")
        constants += f"pub const {constant.name}: {type_} = {constant.value};\n"
    parts.append(constants)
    for enum in api.enums:
        type_ = "MienStatus" if enum.is_status else "u32"
        text = f"// enum {enum.name}\n"
        for value in enum.values:
            text += doc(sentence(value.documentation), "")
            text += f"pub const {value.name}: {type_} = {value.value};\n"
        parts.append(text)
    for handle in api.handles:
        text = doc(handle.documentation, "") + "#[repr(C)]\n"
        parts.append(f"{text}pub struct {handle.name} {{\n    _size: [u8; 0],\n    _opaque: Opaque,\n}}\n")
    parts += [sys_struct(struct) for struct in api.structs]
    text = 'extern "C" {\n'
    for index, function in enumerate(api.functions):
        text += "\n" if index else ""
        note = function.documentation
        if not note and function.documented_with:
            note = f"See `{function.documented_with}`."
        text += doc(note, "    ")
        signature = ", ".join(f"{word(p.name)}: {spell(p.type, TYPES)}" for p in function.parameters)
        text += f"    pub fn {function.name}({signature}){returns(function)};\n"
    parts.append(text + "}\n")
    yield "\n".join(parts)


def write_layout(api):
    out = """//! The compiler lays out every struct as the C compiler does.
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
    for struct in api.structs:
        fields = "".join(f" {word(field.name)} {field.offset}" for field in struct.fields)
        text = f"{struct.name} {struct.size} {struct.alignment}:{fields};"
        out += textwrap.fill(text, 100, initial_indent=" " * 8, subsequent_indent=" " * 12) + "\n"
    yield out + "    }\n}\n"


# ---- mien ----------------------------------------------------------------------------------------------


def safe_enum(enum, names):
    name, status = rust_name(enum.name), enum.is_status
    type_ = "i32" if status else "u32"
    text = sentence(enum.documentation) or f"What C calls `{enum.prefix}...`."
    if status:
        text = "Why a call failed. The numbers are never used again for something else."
    out = doc(text + "\n\nA later library may give numbers that have no name here.", "", names=names)
    default = ", Default" if any(value.value == 0 for value in enum.values) else ""
    out += f"#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash{default})]\n"
    out += f"#[repr(transparent)]\npub struct {name}(pub {type_});\n\n"
    out += f"impl {name} {{\n"
    for value in enum.values:
        short = value.short
        out += doc(sentence(value.documentation), "    ", f"`{value.name}` in C.", names)
        out += f"    pub const {short}: Self = Self({value.value});\n"
    names = ", ".join(f'({value.value}, "{value.short}")' for value in enum.values)
    out += "}\n\n"
    macro = "flags" if enum.flags else "numbers"
    out += f"{macro}!({name}, {type_}, [{names}]);\n"
    if status:
        out += "\npub(crate) fn describe(status: Status) -> &'static str {\n    match status.0 {\n"
        for value in enum.values:
            if value.documentation:
                text = value.documentation.replace('"', '\\"').replace("\n", " ")
                out += f'        {value.value} => "{text}",\n'
        out += '        _ => "",\n    }\n}\n'
    return out


def plain_outputs(api):
    """Structs of numbers alone that functions fill in."""
    for struct in api.structs:
        types = [field.type.of if field.type.kind == "array" else field.type for field in struct.fields]
        if struct.sized and struct.is_output and all(type_.kind in ("scalar", "alias") for type_ in types):
            yield struct


def safe_field(struct, field):
    """(type, value read from `c`) of a field, or None for one that says nothing."""
    name, type_ = field.name, field.type
    if name in ("struct_size",) or name.startswith("reserved"):
        return None
    value = f"c.{word(name)}"
    if field.boolean:
        return "bool", f"{value} != 0"
    if "MIEN_NO_OFFSET" in field.documentation:
        return "Option<u64>", f"offset({value})"
    if field.enum:
        wrapper = rust_name(field.enum)
        if type_.kind == "array":
            return f"[{wrapper}; {type_.count}]", f"{value}.map({wrapper})"
        return wrapper, f"{wrapper}({value})"
    if type_.kind == "array":
        if type_.of.name == "char":
            return "String", f"text(&{value})"
    if type_.kind == "scalar" and type_.name == "uint32_t" and name.endswith("_count"):
        return "usize", f"{value} as usize"
    return spell(type_, TYPES), value


def safe_struct(struct, names):
    name = rust_name(struct.name)
    fields = [(field, safe_field(struct, field)) for field in struct.fields]
    fields = [(field, safe) for field, safe in fields if safe]
    out = doc(struct.documentation, "", f"`{struct.name}` in C.", names)
    copy = "" if any(safe[0] == "String" for _, safe in fields) else ", Copy"
    floats = any(re.search(r"\bf(32|64)\b", safe[0]) for _, safe in fields)
    out += f"#[derive(Clone{copy}, Debug, PartialEq{'' if floats else ', Eq'})]\n#[non_exhaustive]\n"
    out += f"pub struct {name} {{\n"
    for field, (type_, _) in fields:
        text = field.documentation.replace("MIEN_NO_OFFSET", "`None`")
        if re.fullmatch(r"MIEN_\w*\.\.\.", text):
            text = ""  # the type says so
        out += doc(sentence(text), "    ", f"{field.name.replace('_', ' ').capitalize()}.", names)
        out += f"    pub {FIELDS.get(field.name, field.name)}: {type_},\n"
    out += f"}}\n\nimpl From<sys::{struct.name}> for {name} {{\n"
    out += f"    fn from(c: sys::{struct.name}) -> Self {{\n        Self {{\n"
    for field, (_, value) in fields:
        out += f"            {FIELDS.get(field.name, field.name)}: {value},\n"
    out += "        }\n    }\n}\n"
    if struct.is_input:
        out += f"\nimpl From<&{name}> for sys::{struct.name} {{\n"
        out += f"    fn from(safe: &{name}) -> Self {{\n        Self {{\n"
        for field, (type_, _) in fields:
            out += f"            {word(field.name)}: {raw_value(field, type_)},\n"
        out += "            ..Default::default()\n        }\n    }\n}\n"
    return out


def raw_value(field, type_):
    value = f"safe.{FIELDS.get(field.name, field.name)}"
    if field.enum:
        return f"{value}.map(|value| value.0)" if type_[0] == "[" else f"{value}.0"
    if type_ in ("bool", "usize"):
        return f"{value} as u32"
    if type_ in ("Option<u64>", "String"):
        raise KeyError(f"{field.name} of a struct that functions are given: {type_}")
    return value


def errors(api, names):
    """A macro that gives the `# Errors` section of what calls a function."""
    out = "/// The `# Errors` section of what calls a function of the C interface.\n"
    out += "macro_rules! errors {\n"
    for function in api.functions:
        if not function.is_status:
            continue
        lines = [f"- [`Status::{value.short}`](crate::Status::{value.short}) if {prose(condition, names)}"
                 for value, condition in function.failures]
        lines = [line.replace("\\", "\\\\").replace('"', '\\"') for line in lines]
        text = "\\n\\\n         ".join(lines or ["- none with valid arguments"])
        out += f'    ({function.name}) => {{\n        "{text}"\n    }};\n'
    return out + "}\n"


def write_safe(api):
    parts = ["\nuse crate::convert::{flags, numbers, offset, text};\nuse mien_sys as sys;\n"]
    names = references(api, "::", rust_name)
    parts += [safe_enum(enum, names) for enum in api.enums]
    parts += [safe_struct(struct, names) for struct in plain_outputs(api)]
    yield "\n".join(parts + [errors(api, names)])


FILES = {"rust/mien-sys/src/bindings.rs": ("//", write_bindings),
         "rust/mien-sys/tests/layout.rs": ("//", write_layout),
         "rust/mien/src/generated.rs": ("//", write_safe)}

# SPDX-License-Identifier: MIT
"""mien/api.js and mien/api.d.ts, the C interface as WebAssembly sees it: values of enums, layouts of structs, types of
functions. They are committed: the package works from a checkout, and editors show the comments of api.d.ts."""
import json

from model import camel, plain, spell, type_name

VIEWS = {
    "MienFloatView": ("f32s", "Float32Array"), "MienMutableFloatView": ("f32s", "Float32Array"),
    "MienIndex16View": ("u16s", "Uint16Array"), "MienIndex32View": ("u32s", "Uint32Array"),
    "MienStringView": ("string", "string"),
}
ARRAYS = {"i8": "Int8Array", "u8": "Uint8Array", "i16": "Int16Array", "u16": "Uint16Array",
          "i32": "Int32Array", "u32": "Uint32Array", "f32": "Float32Array", "f64": "Float64Array"}
# What JavaScript neither gives nor gets: memory and files are the module's.
HIDDEN = {"struct_size", "reserved", "allocator", "file_access"}
# Numbers for "none"; classes take null or nothing instead, so types do not have them.
NOTHING = {"MIEN_NO_MESH", "MIEN_NO_CONTROL", "MIEN_NO_JOINT"}
INTERNAL = set(VIEWS) | {"MienAllocator", "MienParallelFor", "MienStream", "MienByteSink"}


def struct_kind(kind):
    return VIEWS[kind.name][0] if kind.name in VIEWS else type_name(kind.name)


# How memory.js reads and writes fields; for pointers *, and what they point to.
TYPES = {
    "char": "i8", "int8_t": "i8", "uint8_t": "u8", "int16_t": "i16", "uint16_t": "u16",
    "int32_t": "i32", "uint32_t": "u32", "int64_t": "i64", "uint64_t": "u64", "size_t": "u32",
    "float": "f32", "double": "f64", "array": "{of}", "*": "*{to}", "char const*": "*text",
    "void*": "u32", "function": "u32", "handle*": "handle", "struct": struct_kind,
    "struct*": lambda kind: "u32" if kind.to.name in INTERNAL - set(VIEWS) else "*" + struct_kind(kind.to),
}
# Of the parameters of functions: p addresses, u and i of 32 bits, U and I of 64, f.
LETTERS = {**dict.fromkeys(TYPES, "p"), "uint32_t": "u", "size_t": "u", "int32_t": "i", "uint64_t": "U",
           "int64_t": "I", "float": "f", "double": "f"}
# In declarations of functions.
NUMBERS = {**dict.fromkeys(TYPES, "number"), "int64_t": "bigint", "uint64_t": "bigint", "void": "void"}


def fields_of(struct):
    return [field for field in struct.fields if field.name not in HIDDEN]


def field_kind(field):
    if field.terminated and field.type.kind == "array":
        return "text"
    if field.boolean:
        return "bool"
    return "offset" if "MIEN_NO_OFFSET" in str(field.sentinels) else spell(field.type, TYPES)


def write_script(api):
    yield f"\nexport const VERSION = {json.dumps(api.version)};\n"
    for constant in api.constants:
        if constant.name == "MIEN_TICKS_PER_SECOND" or constant.name in NOTHING:
            yield f"export const {constant.short} = {constant.value};\n"
    for enum in api.enums:
        values = "".join(f"  {v.short}: {v.value},\n" for v in enum.values)
        yield f"\nexport const {enum.title} = Object.freeze({{\n{values}}});\n"
    yield "\n// Of each struct the size, whether it begins with struct_size, and of each field its offset,\n"
    yield "// kind, and the length of an array or the field that counts what a pointer points to.\n"
    yield "export const layouts = {\n"
    for struct in api.structs:
        if struct.name in INTERNAL:
            continue
        yield f"  {struct.title}: {{ size: {struct.size_32}, "
        yield f"sized: {json.dumps(struct.sized)}, fields: {{\n"
        for field in fields_of(struct):
            entry = [field.offset_32, field_kind(field)]
            if field.type.kind == "array":
                entry.append(field.type.count)
            elif field.type.kind == "pointer" and field.count:
                entry.append(camel(field.count))
            yield f"    {camel(field.name)}: {json.dumps(entry)},\n"
        yield "  } },\n"
    yield "};\n"
    yield "\n// Parameters of each function that has numbers: p addresses, u and i of 32 bits, U and I of 64, f.\n"
    yield "export const calls = {\n"
    for function in api.functions:
        letters = "".join(spell(p.type, LETTERS) for p in function.parameters)
        if letters.strip("p") and not function.name.endswith("_file"):
            yield f'  {function.name}: "{letters}",\n'
    yield "};\n"


def comment(text, indent=""):
    text = text.replace("*/", "* /").strip()
    if not text:
        return ""
    if "\n" not in text and len(text) < 84:
        return f"{indent}/** {text} */\n"
    lines = "".join(f"{indent} * {line}".rstrip() + "\n" for line in text.split("\n"))
    return f"{indent}/**\n{lines}{indent} */\n"


def field_type(field):
    kind, declared = field_kind(field), plain(field.type)
    if kind in ("text", "string", "*text"):
        return "string"
    if kind == "bool":
        return "boolean"
    if kind == "offset":
        return "number | null"
    if kind == "*string":
        return "readonly string[]"
    for view, script in VIEWS.values():
        if kind == view:
            return script
    if kind == "handle":
        return "{ readonly handle: number }"
    if kind.startswith("*"):
        to = kind[1:]
        if to in ARRAYS:
            return ARRAYS[to] + " | readonly number[]"
        return f"readonly {to}[]" if field.count else to
    if declared.kind == "array":
        return "readonly number[]"
    if declared.kind == "struct":
        return kind
    return type_name(field.enum) if field.enum else "number"


def write_types(api):
    yield "\nexport declare const VERSION: string;\n"
    yield "/** Times of clips and mixers are integers, in ticks. */\n"
    yield "export declare const TICKS_PER_SECOND: 705600000;\n"
    for enum in api.enums:
        name = enum.title
        yield "\n" + comment(enum.documentation)
        yield f"export declare const {name}: {{\n"
        for value in enum.values:
            yield comment(value.documentation, "  ")
            yield f"  readonly {value.short}: {value.value};\n"
        yield "};\n"
        yield f"export type {name} = " + (
            "number;\n" if enum.flags else f"(typeof {name})[keyof typeof {name}];\n")
    for struct in api.structs:
        if struct.name in INTERNAL:
            continue
        optional = "?" if struct.is_input else ""
        yield "\n" + comment(struct.documentation)
        yield f"export interface {struct.title} {{\n"
        for field in fields_of(struct):
            yield comment(field.documentation, "  ")
            readonly = "" if optional else "readonly "
            yield f"  {readonly}{camel(field.name)}{optional}: {field_type(field)};\n"
        yield "}\n"
    yield "\n" + comment("The functions of the WebAssembly module: the C interface. Pointers and handles "
                         "are numbers.\nThe classes of this package call them; use them yourself where a "
                         "class lacks something.")
    yield "export interface Exports {\n  readonly memory: WebAssembly.Memory;\n"
    yield "  malloc(size: number): number;\n  free(address: number): void;\n"
    for function in api.functions:
        if function.name.endswith("_file"):
            continue
        parameters = ", ".join(f"{p.name}: {spell(p.type, NUMBERS)}" for p in function.parameters)
        yield comment(function.documentation, "  ")
        yield f"  {function.name}({parameters}): {spell(function.returns, NUMBERS)};\n"
    yield "}\n"


FILES = {"web/mien/api.js": ("//", write_script), "web/mien/api.d.ts": ("//", write_types)}

# SPDX-License-Identifier: MIT
"""api.go, the enums, constants and plain structs of the C interface, and handles.h. cgo reads the functions and the
other structs from the header itself."""
from model import comment, pascal, plain, spell, type_name

TYPES = {"int8_t": "int8", "uint8_t": "uint8", "int16_t": "int16", "uint16_t": "uint16", "int32_t": "int32",
         "uint32_t": "uint32", "int64_t": "int64", "uint64_t": "uint64", "size_t": "uint64", "float": "float32",
         "double": "float64", "char": "uint8", "array": "[{count}]{of}"}


def lines(text, indent=""):
    # gofmt sets code in comments after a tab.
    return [line.replace("//     ", "//\t", 1) for line in comment(text, indent + "//")]


def documented(text, declaration):
    """A declaration of one line; gofmt wants an empty line before a comment."""
    return (["\n"] + lines(text) if text.strip() else []) + [declaration]


def write_enum(enum):
    yield from ["\n"] + lines(enum.documentation)
    yield f"type {enum.title} {'int32' if enum.is_status else 'uint32'}\n"
    yield "" if enum.values[0].documentation.strip() else "\n"
    for value in enum.values:
        declaration = f"const {enum.title}{pascal(value.short)} {enum.title} = {value.value}\n"
        yield from documented(value.documentation, declaration)


def is_plain(struct):
    """Whether Go can have the struct as its own: numbers, and the allocator, which stays nil."""
    return struct.sized and struct.name != "MienError" and all(
        plain(field.type).kind in ("scalar", "array") or field.name == "allocator" for field in struct.fields)


def name_and_type(field):
    if field.name == "struct_size":
        return "structSize", "uint64"
    if field.name == "allocator":
        return "allocator", "unsafe.Pointer"
    types = {**TYPES, "uint32_t": type_name(field.enum)} if field.enum else TYPES
    return "reserved" if field.name == "reserved" else pascal(field.name), spell(field.type, types)


def write_fields(struct):
    """Fields in the columns of gofmt, which a comment interrupts."""
    run = []

    def aligned():
        width = max((len(name) for name, _ in run), default=0)
        return [f"\t{name:<{width}} {kind}\n" for name, kind in run]

    for field in struct.fields:
        said = lines(field.documentation, "\t") if field.name != "struct_size" else []
        if said:
            yield from aligned() + said
            run = []
        run.append(name_and_type(field))
    yield from aligned()


def write(api):
    structs = [struct for struct in api.structs if is_plain(struct)]
    yield '\npackage mien\n\nimport "unsafe"\n\n'
    for constant in api.constants:
        yield from documented(constant.documentation, f"const {pascal(constant.short)} = {constant.value}\n")
    for enum in api.enums:
        yield from write_enum(enum)
    for struct in structs:
        yield from ["\n"] + lines(struct.documentation) + [f"type {struct.title} struct {{\n"]
        yield from write_fields(struct)
        yield "}\n"
    yield "\n// Bytes of each struct in C, to compare with unsafe.Sizeof.\nvar structSizes = [][2]uintptr{\n"
    for struct in structs:
        yield f"\t{{unsafe.Sizeof({struct.title}{{}}), {struct.size}}},\n"
    yield "}\n"


def write_handles(api):
    yield """\
//
// Gives the opaque structs of mien.h a body. cgo allocates memory whenever it passes a pointer to a struct without
// one.
#include <mien.h>

"""
    for handle in api.handles:
        if handle.name not in ("MienAuthorReport", "MienDocument"):  # of mien_author.h
            yield f"struct {handle.name} {{\n  char unused;\n}};\n"


FILES = {"go/api.go": ("//", write), "go/handles.h": ("//", write_handles)}

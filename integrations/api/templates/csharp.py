# SPDX-License-Identifier: MIT
"""Mien/Native.cs, the C interface for C#."""
from xml.sax.saxutils import escape

from model import is_pointer_to, pascal, plain, spell, type_name

START = """\
// The enums, structs and functions of mien.h and mien_author.h, with their comments.
using System;
using System.Runtime.InteropServices;

namespace Mien {
"""

TYPES = {"int8_t": "sbyte", "uint8_t": "byte", "int16_t": "short", "uint16_t": "ushort", "int32_t": "int",
         "uint32_t": "uint", "int64_t": "long", "uint64_t": "ulong", "size_t": "UIntPtr", "float": "float",
         "double": "double", "char": "byte", "void": "void", "struct": "{name}", "*": "{to}*",
         "handle*": "IntPtr", "handle**": "IntPtr*", "function": "IntPtr", "callback": "IntPtr"}
PARAMETERS = {**TYPES, "handle*": "{title}Handle"}
RESULTS = {**TYPES, "*": "IntPtr", "alias": "Status"}
KEYWORDS = {"as", "base", "event", "in", "is", "lock", "object", "out", "params", "ref", "string", "this"}

CREATE = """
    /// <summary>All fields zero but StructSize.</summary>
    public static {0} Create() {{
      return new {0} {{ StructSize = (UIntPtr)sizeof({0}) }};
    }}
"""
HANDLE = """\
  public sealed class {0}Handle : Handle {{
    /// <summary>For parameters that may be NULL.</summary>
    public static readonly {0}Handle Null = new {0}Handle(IntPtr.Zero);

    internal {0}Handle(IntPtr taken, params Handle[] kept) : base(taken, kept) {{ }}

    protected override void Destroy(IntPtr taken) {{ Functions.{1}(taken); }}
  }}
"""


def summary(text, indent):
    if not text.strip():
        return ""
    lines = f"<summary>{escape(text.strip())}</summary>".splitlines()
    return "".join(f"{indent}/// {line}".rstrip() + "\n" for line in lines)


def write_enum(enum):
    yield "\n" + summary(enum.documentation, "  ")
    if enum.flags:
        yield "  [Flags]\n"
    yield f"  public enum {enum.title} : {'int' if enum.is_status else 'uint'} {{\n"
    for value in enum.values:
        yield summary(value.documentation, "    ") + f"    {pascal(value.short)} = {value.value},\n"
    yield "  }\n"


def write_constant(constant):
    kind = "ulong" if constant.value >= 2**32 else "uint" if constant.value >= 2**31 else "int"
    yield summary(constant.documentation, "    ")
    yield f"    public const {kind} {pascal(constant.short)} = {constant.value};\n"


def write_field(field):
    kind, name = plain(field.type), pascal(field.name)
    yield summary(field.documentation, "    ")
    if kind.kind == "array":
        yield f"    public fixed {spell(kind.of, TYPES)} {name}[{kind.count}];\n"
    else:
        yield f"    public {type_name(field.enum) if field.enum else spell(kind, TYPES)} {name};\n"


def write_struct(struct):
    yield "\n" + summary(struct.documentation, "  ")
    yield f"  [StructLayout(LayoutKind.Sequential)]\n  public unsafe struct {struct.name} {{\n"
    for field in struct.fields:
        yield from write_field(field)
    yield (CREATE.format(struct.name) if struct.sized else "") + "  }\n"


def parameter_type(parameter, flags):
    enum = parameter.enum
    if enum in flags and not parameter.name.endswith("s"):
        enum = None  # the index of a layer or stage of a mix, not a set of those of DNA files
    if parameter.role == "object":
        return "out IntPtr"
    if enum:
        return type_name(enum) + ("*" if is_pointer_to(parameter.type, "scalar") else "")
    return spell(parameter.type, PARAMETERS)


def write_function(function, flags):
    yield "\n" + summary(function.documentation, "    ")
    parameters = ", ".join(
        ("IntPtr" if function.is_destroy else parameter_type(p, flags)) + " " + "@" * (p.name in KEYWORDS) + p.name
        for p in function.parameters)
    yield f'    [DllImport("{function.library}", CallingConvention = CallingConvention.Cdecl)]\n'
    yield f"    public static extern {spell(function.returns, RESULTS)} {function.name}({parameters});\n"


def write(api):
    flags = {enum.name for enum in api.enums if enum.flags}
    yield START
    for enum in api.enums:
        yield from write_enum(enum)
    yield "}\n\nnamespace Mien.Native {\n\n  public static class Constants {\n"
    for constant in api.constants:
        yield from write_constant(constant)
    yield "\n    // Bytes of each struct where pointers have 64 bits, to compare with sizeof.\n"
    yield "    internal static unsafe readonly int[][] Sizes = {\n"
    for struct in api.structs:
        yield f"      new[] {{ sizeof({struct.name}), {struct.size} }},\n"
    yield "    };\n  }\n"
    for struct in api.structs:
        yield from write_struct(struct)
    for handle in api.handles:
        yield "\n" + summary(handle.documentation, "  ") + HANDLE.format(handle.title, handle.destroy)
    yield "\n  /// <summary>The C functions.</summary>\n  public static unsafe class Functions {\n"
    for function in api.functions:
        yield from write_function(function, flags)
    yield "  }\n}\n"


FILES = {"csharp/Mien/Native.cs": ("//", write)}

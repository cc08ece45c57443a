# SPDX-License-Identifier: MIT
"""mien/api.lua, the C interface for the FFI of LuaJIT."""
START = """\
-- The declarations and comments of mien.h and mien_author.h, and their enums as tables.
local ffi = require("ffi")
local api = {}

ffi.cdef [[
"""


def declare(kind, name=""):
    """A C declaration; what is const stands before the star."""
    if kind.kind == "pointer":
        return f"{declare(kind.to)}{' const' if kind.const else ''}* {name}".rstrip()
    if kind.kind == "array":
        return f"{declare(kind.of)} {name}[{kind.count}]"
    if kind.kind == "function":
        return f"{declare(kind.returns)} (*{name})({parameters(kind)})"
    return f"{'void' if kind.kind == 'void' else kind.name} {name}".rstrip()


def parameters(function):
    return ", ".join(declare(p.type, p.name) for p in function.parameters) or "void"


def comment(text):
    return f"/* {text.replace('*/', '* /').strip()} */\n" if text.strip() else ""


def write_struct(struct):
    yield "\n" + comment(struct.documentation) + f"typedef struct {struct.name} {{\n"
    for field in struct.fields:
        yield f"    {declare(field.type, field.name)}; {comment(field.documentation)}".rstrip() + "\n"
    yield f"}} {struct.name};\n"


def write(api):
    yield START
    for alias in api.aliases:
        yield f"typedef {declare(alias.type, alias.name)};\n"
    for handle in api.handles:
        yield f"typedef struct {handle.name} {handle.name};\n"
    for callback in api.callbacks:
        yield f"typedef {declare(callback.returns)} (*{callback.name})({parameters(callback)});\n"
    for struct in api.structs:
        yield from write_struct(struct)
    yield "]]\n\nffi.cdef [[\n"
    for function in api.functions:
        yield "\n" + comment(function.documentation)
        yield f"{declare(function.returns)} {function.name}({parameters(function)});\n"
    yield f']]\n\napi.VERSION = "{api.version}"\n'
    for constant in api.constants:
        if not constant.short.startswith("VERSION"):
            yield f"api.{constant.short} = {constant.value}{'ULL' if constant.value >= 2**53 else ''}\n"
    for enum in api.enums:
        values = "".join(f"  {value.short} = {value.value},\n" for value in enum.values)
        yield f"\napi.{enum.title} = {{\n{values}}}\n"
    yield "\n-- Bytes of each struct where pointers have 64 bits, to compare with ffi.sizeof().\napi.sizes = {\n"
    for struct in api.structs:
        yield f"  {struct.name} = {struct.size},\n"
    yield "}\n\n-- The function that releases a handle.\napi.destroy = {\n"
    for handle in api.handles:
        yield f'  {handle.name} = "{handle.destroy}",\n'
    yield "}\n\nreturn api\n"


FILES = {"lua/mien/api.lua": ("--", write)}

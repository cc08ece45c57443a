# SPDX-License-Identifier: MIT
"""mien/_api.py, the C interface for ctypes."""
import json
import re
import textwrap

from model import plain, references, spell, type_name

TYPES = {
    "char": "c_char", "int8_t": "c_int8", "uint8_t": "c_uint8", "int16_t": "c_int16",
    "uint16_t": "c_uint16", "int32_t": "c_int32", "uint32_t": "c_uint32", "int64_t": "c_int64",
    "uint64_t": "c_uint64", "size_t": "c_size_t", "float": "c_float", "double": "c_double",
    "void": "None", "struct": "{name}", "callback": "{name}", "array": "{of} * {count}",
    "handle*": "{name}", "handle**": "POINTER({name})", "struct*": "POINTER({name})",
    # Addresses: Python has no use for what pointers to numbers point to.
    "*": "c_void_p",
    "function": lambda kind: f"CFUNCTYPE({', '.join(signature(kind))})",
}
PARAMETERS = {**TYPES, "char const*": "c_char_p"}  # text that has to be terminated
RESULTS = {**TYPES, "*": "c_char_p"}

PREAMBLE = '''\
# mypy: ignore-errors
"""The C interface as ctypes sees it: enums, structs, handles and the types of functions.

Nothing here owns or checks anything; the rest of the package does. `mien.h` is the manual.
"""
from __future__ import annotations

import ctypes
from ctypes import (CFUNCTYPE, POINTER, Structure, c_char, c_char_p, c_double, c_float, c_int8,
                    c_int16, c_int32, c_int64, c_size_t, c_uint8, c_uint16, c_uint32, c_uint64,
                    c_void_p)
from enum import IntEnum, IntFlag
from typing import Any, Dict, NamedTuple, Optional, Tuple, Type, TypeVar

VERSION = {version!r}

_E = TypeVar("_E", bound=IntEnum)


def _enum(kind: Type[_E], value: int) -> _E:
    """A number that a newer library may give stays a number."""
    try:
        return kind(value)
    except ValueError:
        return value


def text(view: Any) -> str:
    """Copy of a MienStringView. Bytes that are no UTF-8 survive a way back through str.encode()."""
    return ctypes.string_at(view.data, view.count).decode("utf-8", "surrogateescape") \\
        if view.count else ""
'''


words = None  # set by write()


def in_python(api):
    """What gives documentation of the header in the words of Python."""
    names = {**references(api, "."), "MIEN_NO_OFFSET": "None"}

    def replace(match):
        name = match.group()
        return names.get(re.sub(r"\.+$", "...", name) if name.endswith(".") else name, name)

    return lambda text: re.sub(r"\bMIEN_[A-Z0-9_]*_\.{3,4}|\bMIEN_[A-Z0-9_]+\b", replace, text)


def reflow(text):
    """Paragraphs of plain lines, to the width there is; drawings stay as they are."""
    for paragraph in text.split("\n\n"):
        drawing = any(line.startswith(" ") for line in paragraph.split("\n"))
        yield paragraph if drawing else textwrap.fill(paragraph, 92, break_on_hyphens=False)


def docstring(text, indent="    "):
    text = "\n\n".join(reflow(words(text)))
    text = text.replace("\\", "\\\\").replace('"""', "'''").strip()
    lines = [(indent + line).rstrip() for line in text.split("\n")]
    body = "\n".join(lines).strip()
    if "\n" not in body and len(indent) + len(body) + 6 <= 100:
        return f'{indent}"""{body}"""\n'
    return f'{indent}"""{body}\n{indent}"""\n'


def signature(function):
    """Result and parameters."""
    return [spell(kind, TYPES) for kind in [function.returns] + [p.type for p in function.parameters]]


def write_enum(enum):
    base = "IntFlag" if enum.flags else "IntEnum"
    yield f"class {enum.title}({base}):\n"
    yield docstring(enum.documentation or f"Values of enum {enum.name} of the C interface.")
    yield "\n"
    for value in enum.values:
        if value.documentation:
            text = textwrap.wrap(words(value.documentation), 92)
            yield "".join(f"    #: {line}\n" for line in text)
        yield f"    {value.short} = {value.value}\n"


def write_struct(struct):
    yield f"class {struct.name}(Structure):\n"
    fields = [f"(\"{field.name}\", {spell(field.type, TYPES)})" for field in struct.fields]
    yield "    _fields_ = [\n" + "".join(f"        {field},\n" for field in fields) + "    ]\n"
    for field in struct.fields:
        yield f"    {field.name}: Any\n"
    if not struct.sized:
        return
    if not struct.is_input:
        yield "\n    def __init__(self) -> None:\n"
        yield f"        super().__init__({struct.size})\n"
        return
    # Every field by its name, and none else: ctypes takes any name, and any number.
    given = [f for f in struct.fields if f.name not in ("struct_size", "reserved")]
    yield "\n    def __init__(self, *"
    for field in given:
        yield f",\n                 {field.name}: {annotation_of(field)} = {default_of(field)}"
    yield ") -> None:\n"
    yield f"        super().__init__({struct.size})\n"
    for field in given:
        yield f"        self.{field.name} = {field.name}\n"


def annotation_of(field):
    kind = plain(field.type)
    if kind.kind == "array":
        item = "float" if plain(kind.of).name in ("float", "double") else "int"
        return f"Tuple[{', '.join([item] * kind.count)}]"
    if kind.kind == "scalar":
        return "bool" if field.boolean else "float" if kind.name in ("float", "double") else "int"
    return "Any"


def default_of(field):
    kind = plain(field.type)
    if kind.kind == "array":
        return f"({', '.join(['0'] * kind.count)})"
    if kind.kind == "scalar":
        return "False" if field.boolean else "0"
    return f"{kind.name}()" if kind.kind == "struct" else "None"


def is_text(kind):
    return kind.kind == "struct" and kind.name == "MienStringView"


def has_views(struct):
    """Of arrays, which need an owner: such a struct gets a class by hand."""
    return any(field.type.kind == "struct" and not is_text(field.type)
               for field in struct.fields)


def write_record(struct):
    """The struct as what Python gives out: an immutable copy."""
    name = struct.title
    fields = [f for f in struct.fields if f.name not in ("struct_size", "reserved")]
    yield f"class {name}(NamedTuple):\n"
    lines = [struct.documentation or f"Copy of a {struct.name}.", ""]
    for field in fields:
        if field.documentation:
            lines.append(textwrap.fill(f"  {field.name}: {words(field.documentation)}", 94,
                                       subsequent_indent="    "))
    yield docstring("\n".join(lines).strip())
    yield "\n"
    values = []
    for field in fields:
        value, kind = f"c.{field.name}", plain(field.type)
        inner = plain(kind.of) if kind.kind == "array" else kind
        enum = field.enum and type_name(field.enum)
        if is_text(kind):
            annotation, value = "str", f"text({value})"
        elif kind.kind == "array" and inner.name == "char":
            annotation, value = "str", f"{value}.decode('ascii', 'replace')"
        elif kind.kind == "array":
            item = enum or ("float" if inner.name in ("float", "double") else "int")
            annotation = f"Tuple[{', '.join([item] * kind.count)}]"
            value = f"tuple(_enum({enum}, v) for v in {value})" if enum else f"tuple({value})"
        elif kind.kind == "pointer":
            annotation = "int"
        elif field.name == "byte_offset":
            annotation = "Optional[int]"
            value = f"None if {value} == MIEN_NO_OFFSET else {value}"
        elif field.boolean:
            annotation, value = "bool", f"bool({value})"
        elif enum:
            annotation, value = enum, f"_enum({enum}, {value})"
        else:
            annotation = "float" if inner.name in ("float", "double") else "int"
        yield f"    {field.name}: {annotation}\n"
        values.append(value)
    yield f"\n    @classmethod\n    def _of(cls, c: {struct.name}) -> {name}:\n"
    yield textwrap.fill(f"return cls({', '.join(values)})", 100, initial_indent=" " * 8,
                        subsequent_indent=" " * 19, break_long_words=False) + "\n"


def write_statuses(api):
    """For errors.raises(), which adds them to the documentation of what calls a function."""
    yield "# Why functions fail, beyond what the package checks: (status, condition).\n"
    yield "STATUSES: Dict[str, Tuple[Tuple[Status, str], ...]] = {\n"
    for function in api.functions:
        if not function.is_status:
            continue
        yield f"    \"{function.name}\": ("
        for value, condition in function.failures:
            lines = textwrap.wrap(words(condition), 78, break_on_hyphens=False, drop_whitespace=False)
            pieces = "\n         ".join(json.dumps(line, ensure_ascii=False) for line in lines)
            yield f"\n        (Status.{value.short},\n         {pieces}),"
        yield "\n    ),\n" if function.failures else "),\n"
    yield "}\n"


# Library, its class, its table.
LIBRARIES = (("mien", "Library", "FUNCTIONS"), ("mien-author", "AuthorLibrary", "AUTHOR_FUNCTIONS"),
             ("mien-solve", "SolveLibrary", "SOLVE_FUNCTIONS"))


def write_functions(functions, library, class_name, table):
    yield f"# Name, result, parameters.\n{table}: Tuple[Tuple[str, Any, Tuple[Any, ...]], ...] = (\n"
    for function in functions:
        types = ", ".join(spell(p.type, PARAMETERS) for p in function.parameters)
        comma = "," if len(function.parameters) == 1 else ""
        line = f'("{function.name}", {spell(function.returns, RESULTS)}, ({types}{comma})),'
        yield textwrap.fill(line, 100, initial_indent="    ", subsequent_indent="     ") + "\n"
    yield ")\n\n\n"
    yield f'class {class_name}:\n    """Each function of lib{library}, by its name."""\n\n'
    for function in functions:
        yield f"    {function.name}: Any\n"
    yield f'''
    def __init__(self, library: ctypes.CDLL) -> None:
        for name, result, parameters in {table}:
            function = getattr(library, name)
            function.restype = result
            function.argtypes = parameters
            setattr(self, name, function)
'''


def write(api):
    global words
    words = in_python(api)
    blocks = [[PREAMBLE.replace("{version!r}", repr(api.version))]]
    blocks.append(f"{c.name} = {c.value}\n" for c in api.constants if not c.short.startswith("VERSION"))
    blocks += [write_enum(enum) for enum in api.enums]
    blocks += [f"class {handle.name}(c_void_p):\n    pass\n" for handle in api.handles]
    blocks += [f"{callback.name} = CFUNCTYPE({', '.join(signature(callback))})\n" for callback in api.callbacks]
    blocks += [write_struct(struct) for struct in api.structs]
    blocks += [write_record(struct) for struct in api.structs
               if struct.is_output and struct.sized and not has_views(struct)]
    blocks.append(write_statuses(api))
    for library, class_name, table in LIBRARIES:
        functions = [f for f in api.functions if f.library == library]
        blocks.append(write_functions(functions, library, class_name, table))
    yield "\n\n".join("".join(block) for block in blocks)


FILES = {"python/mien/_api.py": ("#", write)}

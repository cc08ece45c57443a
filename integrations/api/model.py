# SPDX-License-Identifier: MIT
"""The interface as templates of languages see it: the entries of mien_api.json, which README.md describes, as objects
with what every language asks of them."""
import json
import re
from pathlib import Path
from types import SimpleNamespace

# What bindings do not let happen: NULL, handles of another kind, structs of another size.
PREVENTED = {"MIEN_ERROR_NULL_ARGUMENT", "MIEN_ERROR_HANDLE", "MIEN_ERROR_STRUCT_SIZE"}
GENERAL_CONDITIONS = {"MIEN_ERROR_INVALID_ARGUMENT": "an argument is outside its range",
                      "MIEN_ERROR_MEMORY": "memory runs out",
                      "MIEN_ERROR_UNSUPPORTED": "this build of libmien opens baked files only"}


def load():
    """mien_api.json. Beyond its own keys entries have

    title        of handles, structs, enums: the name without Mien; that of statuses is Status
    short        of values: MIEN_ERROR_LOD -> LOD, MIEN_STORAGE_16 -> _16; of constants: without MIEN_
    is_status    of enums: it is that of statuses; of functions: they return one
    is_destroy   of functions: they release a handle
    failures     of functions that return a status: (value, condition) of those that bindings let happen
    is_input     of structs: callers fill them in, by themselves or in another struct
    is_output    of structs: functions fill them in; not MienError
    """
    path = Path(__file__).resolve().parent / "mien_api.json"
    api = json.loads(path.read_text(encoding="utf-8"), object_hook=lambda entry: SimpleNamespace(**entry))
    for enum in api.enums:
        enum.is_status = enum.name == "MienStatusCode"
        enum.title = "Status" if enum.is_status else enum.name[len("Mien"):]
        for value in enum.values:
            short = re.sub("^ERROR_", "", value.short_name) if enum.is_status else value.short_name
            value.short = short if short.isidentifier() else "_" + short
    for entry in api.handles + api.structs:
        entry.title = entry.name[len("Mien"):]
    for constant in api.constants:
        constant.short = constant.name[len("MIEN_"):]
    destroys = {handle.destroy for handle in api.handles}
    statuses = {value.name: value for enum in api.enums if enum.is_status for value in enum.values}
    for function in api.functions:
        function.is_destroy = function.name in destroys
        function.is_status = getattr(function.returns, "name", "") == "MienStatus"
        function.failures = [(statuses[status.name], condition_of(status, function))
                             for status in function.statuses if status.name not in PREVENTED]
    mark_structs(api)
    return api


def condition_of(status, function):
    # Of sizes that are asked for: the buffer of a binding is never too small.
    if not status.condition or function.size_query and status.name in GENERAL_CONDITIONS:
        return GENERAL_CONDITIONS[status.name]
    return status.condition


def mark_structs(api):
    pointers = [p for function in api.functions for p in function.parameters if is_pointer_to(p.type, "struct")]
    filled = {p.type.to.name for p in pointers if p.direction == "out" and p.role != "error"}
    structs = {struct.name: struct for struct in api.structs}
    read, found = set(), [p.type.to.name for p in pointers if p.direction == "in"]
    while found:
        name = found.pop()
        if name not in read:
            read.add(name)
            kinds = [getattr(field.type, "to", field.type) for field in structs[name].fields]
            found += [kind.name for kind in kinds if kind.kind == "struct"]
    for struct in api.structs:
        struct.is_input = struct.name in read
        struct.is_output = struct.name in filled


# ---- types -------------------------------------------------------------------------------------------


def plain(kind):
    """A type without its aliases."""
    while kind.kind == "alias":
        kind = kind.of
    return kind


def is_pointer_to(kind, what):
    return kind.kind == "pointer" and plain(kind.to).kind == what


def type_name(c_name):
    """The title of a struct, handle or enum, by its name in C."""
    return "Status" if c_name == "MienStatusCode" else c_name[len("Mien"):]


def spell(kind, types):
    """The name of a type in a language. `types` has a pattern, or a function of the type, for

        uint32_t ...                             each scalar of C
        alias                                    if it is missing, what is behind the alias
        handle, struct, callback, function, void
        array                                    {of}, {count}
        *, const*                                {to}, of a pointer to what is not constant, to what is
        handle*, handle**, struct*, char const*  if they are there, instead of *

    with {name} for the name in C and {title} for the title of what has one, behind all pointers.
    """
    if kind.kind == "alias" and "alias" not in types:
        return spell(kind.of, types)
    keys = [kind.kind] if kind.kind != "scalar" else [kind.name]
    named = kind
    if kind.kind == "pointer":
        to, stars = plain(kind.to), "*"
        while to.kind == "pointer":
            to, stars = plain(to.to), stars + "*"
        named = to
        what = "char const" if getattr(to, "name", "") == "char" and kind.const else to.kind
        keys = [what + stars, "const*" if kind.const else "*", "*"]
    pattern = next((types[key] for key in keys if key in types), None)
    if pattern is None:
        raise KeyError(f"no pattern for {' or '.join(keys)}")
    if callable(pattern):
        return pattern(kind)
    name = getattr(named, "name", "")
    parts = {"name": name, "title": type_name(name)}
    if "{to}" in pattern:
        parts["to"] = spell(kind.to, types)
    if "{of}" in pattern:
        parts["of"] = spell(kind.of, types)
    return pattern.format(count=getattr(kind, "count", 0), **parts)


# ---- words -------------------------------------------------------------------------------------------


def pascal(name):
    """raw_control_count -> RawControlCount, RAW_CONTROL -> RawControl, SNORM10_10_10_2 -> Snorm10_10_10_2."""
    return "".join(("_" if part[:1].isdigit() else "") + part[:1].upper() + part[1:].lower()
                   for part in name.split("_"))


def camel(name):
    """raw_control_count -> rawControlCount."""
    return re.sub(r"_(\w)", lambda match: match.group(1).upper(), name)


def references(api, between, titles=type_name):
    """What to call values of enums in documentation: MIEN_ERROR_LOD -> Status.LOD, MIEN_KIND_... -> Kind. `titles`
    names an enum by its name in C."""
    names = {}
    for enum in api.enums:
        names.setdefault(enum.prefix + "...", titles(enum.name))
        for value in enum.values:
            names[value.name] = titles(enum.name) + between + value.short
    return names


def comment(text, before):
    """Lines of a comment, each after `before`; nothing without a text."""
    return [f"{before} {line}".rstrip() + "\n" for line in text.strip().splitlines()]

# SPDX-License-Identifier: MIT
"""What names, types and comments of the headers say beyond C: enums, counts, ownership, statuses.
README.md lists the conventions. A declaration that leaves something open is an error.
"""
import json
import re

from c_header import HeaderError, POINTER_SIZES, joined

VIEWS = {"MienStringView", "MienFloatView", "MienMutableFloatView", "MienIndex16View",
         "MienIndex32View"}
CALLBACKS = {"MienParallelFor", "MienStream", "MienByteSink", "MienAllocator"}
NUMBERS = {"count", "size", "capacity", "first", "value", "numerator", "denominator", "tick", "ticks",
           "stride", "mark", "lods", "weight", "strength", "level", "activation", "tolerance"}
FIRST_RELEASE = "0.1.0"
# The statuses of wrong arguments, which the introduction of mien.h explains for all functions.
GENERAL = ("MIEN_ERROR_NULL_ARGUMENT", "MIEN_ERROR_INVALID_ARGUMENT", "MIEN_ERROR_STRUCT_SIZE",
           "MIEN_ERROR_HANDLE", "MIEN_ERROR_MEMORY", "MIEN_ERROR_UNSUPPORTED")
RELEASE = re.compile(r"_(destroy|close)$")
ROW = re.compile(r"\b(one|\d+)(?: or (\d+))? \w+ per ((?:[A-Za-z]+ )*?[A-Za-z]+)"
                 r"(?=[,.:;)]| \(| of | in | and |$)")


def fail(name, why):
    raise HeaderError(f"{name}: {why}; integrations/api/README.md has the conventions")


def number(text):
    base, _, power = text.partition("^")
    return int(base) ** int(power or 1)


def row_of(text):
    """{"widths": [3], "per": "position"} of "3 floats per position"."""
    match = ROW.search(text)
    if not match:
        return None
    widths = [1 if w == "one" else int(w) for w in match.group(1, 2) if w]
    return {"widths": widths, "per": match.group(3)}


def snake(name):
    return re.sub(r"(?<!^)([A-Z])", r"_\1", name[len("Mien"):]).lower()


class Conventions:
    """Adds to the entries of an Interface what it finds. `map_files` are the texts of the linker
    scripts, which name the release that brought a function."""

    def __init__(self, interface, map_files):
        self.api = interface
        self.structs = interface.structs
        self.enum_of = {v["name"]: e["name"] for e in interface.enums for v in e["values"]}
        self.enum_of_prefix = {e["prefix"]: e["name"] for e in reversed(interface.enums)}
        self.enum_named = {snake(e["name"]): e["name"] for e in interface.enums}
        self.since_of = {}
        for text in map_files:
            self.since_of.update(re.findall(r"\b(mien_\w+);[ \t]*/\* (\d+\.\d+\.\d+) \*/", text))
        self.functions = {f["name"]: f for f in interface.functions}
        for struct in self.structs.values():
            self.describe_struct(struct)
        self.describe_handles()
        for function in interface.functions:
            self.describe_function(function)
        for function in interface.functions:  # once the statuses of all are known
            self.describe_statuses(function)
        for entries in (interface.handles.values(), interface.aliases.values(), interface.enums,
                        interface.callbacks.values(), interface.constants, self.structs.values()):
            for entry in entries:
                entry["since"] = self.since(entry["documentation"])

    def since(self, text):
        match = re.search(r"\bSince (\d+\.\d+\.\d+)\b", text)
        return match.group(1) if match else FIRST_RELEASE

    def enum_in(self, text):
        """The enum of "MIEN_ISA_..." or of one of its values."""
        match = re.match(r"(MIEN_[A-Z0-9_]+?)(_\.\.\.|\b)", text)
        if not match:
            return None
        return self.enum_of.get(match.group(1)) or self.enum_of_prefix.get(match.group(1) + "_")

    # ---- structs -------------------------------------------------------------------------------

    def describe_struct(self, struct):
        name, layouts = struct["name"], struct.pop("layouts")
        if struct["sized"] and not struct["default"]:
            fail(name, "begins with struct_size, so it needs MIEN_DEFAULT")
        struct["size"], struct["alignment"] = layouts["LP64"]["size"], layouts["LP64"]["alignment"]
        struct["size_32"] = layouts["ILP32"]["size"]
        struct["alignment_32"] = layouts["ILP32"]["alignment"]
        for field in struct["fields"]:
            field["offset"], field["size"] = layouts["LP64"]["fields"][field["name"]]
            field["offset_32"], field["size_32"] = layouts["ILP32"]["fields"][field["name"]]
            self.describe_field(struct, field)

    def describe_field(self, struct, field):
        name, kind, text = field["name"], field["type"], field["documentation"]
        where = f"{struct['name']}.{name}"
        number_type = kind["of"] if kind["kind"] == "array" else kind
        field["enum"] = None
        if number_type.get("name") == "MienStatus":
            field["enum"] = "MienStatusCode"
        elif number_type == {"kind": "scalar", "name": "uint32_t"}:
            field["enum"] = self.enum_in(text)
            if text.startswith("MIEN_") and not field["enum"]:
                fail(where, f"there is no enum of {text.split()[0]}")
        sentinels = re.findall(r"(?:^|[.;] )(-?\d+|NULL|MIEN_[A-Z0-9_]+): ([^.;]+)", text)
        field["sentinels"] = [{"value": int(v) if re.fullmatch(r"-?\d+", v) else v, "meaning": m}
                              for v, m in sentinels]
        bounds = re.match(r"(?:[^.;]*?: )?(-?\d+(?:\^\d+)?) to (-?\d+(?:\^\d+)?)\b", text)
        field["range"] = [number(b) for b in bounds.groups()] if bounds else None
        least = re.search(r"\bat least (Mien\w+\.\w+|\d+)", text)
        field["minimum"] = least.group(1) if least else None
        field["row"] = row_of(text)
        pointer = kind["kind"] in ("pointer", "function")
        field["nullable"] = pointer and (name in ("allocator", "user")
                                         or struct["name"] in VIEWS or "may be NULL" in text
                                         or any(v == "NULL" for v, _ in sentinels))
        field["count"] = self.count_of_field(struct, field) if pointer else None
        field["terminated"] = None
        if number_type == {"kind": "scalar", "name": "char"} and kind["kind"] == "array":
            field["terminated"] = "terminated" in text
        field["since"] = self.since(text)
        if field["type"]["kind"] == "function" and text == "" and struct["name"] != "MienAllocator":
            fail(where, "has no comment")
        if kind.get("name") in ("MienFloatView", "MienMutableFloatView") and not field["row"]:
            fail(where, "say the width of a row, such as \"3 floats per position\"")

    def count_of_field(self, struct, field):
        """The field with the number of elements that a pointer leads to."""
        to = field["type"].get("to", {})
        if field["type"]["kind"] != "pointer" or field["name"] == "user" or \
                to.get("name") in CALLBACKS or to["kind"] == "handle":
            return None
        names = [f["name"] for f in struct["fields"]]
        per = field["row"]["per"].replace(" ", "_") if field["row"] else ""
        for wanted in (re.sub("(?<=sh)es$|s$", "", field["name"]) + "_count", per + "_count", "count"):
            if wanted in names:
                return wanted
        return None

    # ---- handles -------------------------------------------------------------------------------

    def handle_of(self, parameter):
        """Name of the handle that a parameter is, else None."""
        to = parameter["type"].get("to", {})
        return to["name"] if to.get("kind") == "handle" else None

    def describe_handles(self):
        for handle in self.api.handles.values():
            name = handle["name"]
            takers = [(f, p) for f in self.api.functions for p in f["parameters"]
                      if self.handle_of(p) == name]
            enders = [f["name"] for f, _ in takers
                      if RELEASE.search(f["name"]) and len(f["parameters"]) == 1]
            if len(enders) != 1:
                fail(name, f"{len(enders)} functions release it")
            handle["destroy"] = enders[0]
            handle["immutable"] = all(p["type"]["const"] for f, p in takers
                                      if f["name"] != enders[0])
            if handle["documentation"] == "":
                fail(name, "has no comment")

    # ---- functions -----------------------------------------------------------------------------

    def describe_function(self, function):
        name, text = function["name"], function["documentation"]
        if text == "":
            fail(name, "has no comment")
        plain = joined(text)
        parameters = function["parameters"]
        for parameter in parameters:
            self.describe_parameter(function, parameter, plain)
        if len(re.findall(r"\bmay be NULL", plain)) != sum(may_be_null(p, plain) for p in parameters):
            fail(name, "of which parameter does \"may be NULL\" speak?")
        result = next((p for p in parameters if p["role"] == "object"), None)
        for parameter in parameters:
            parameter["lifetime"] = self.lifetime(function, parameter, result, plain)
        handles = [p for p in parameters if self.handle_of(p)]
        exclusive = any(not p["type"]["const"] for p in handles) or \
            any(p["role"] == "array" and p["direction"] == "inout" for p in parameters)
        beside = "One thread may call this while another one uses" in plain
        function["threads"] = "one_more" if beside else "exclusive" if exclusive else "shared"
        function["size_query"] = next((p["name"] for p in parameters if p["name"] == "out_size" and any(
            q["role"] == "buffer" and q["direction"] == "out" for q in parameters)), None)
        function["allocates"] = "Does not allocate or lock" not in plain
        stack = re.search(r"Uses up to (\d+) KiB of stack", plain)
        function["stack_bytes"] = int(stack.group(1)) * 1024 if stack else None
        function["see"] = re.findall(r"\bdocs/[\w-]+\.md(?:, \d[\d.]*)?(?: \"[^\"]+\")?", plain)
        mapped, said = self.since_of.get(name, FIRST_RELEASE), self.since(text)
        if said not in (mapped, FIRST_RELEASE):
            fail(name, f"is since {said}, but since {mapped} by the linker script")
        function["since"] = mapped

    def describe_parameter(self, function, parameter, text):
        name, kind = parameter["name"], parameter["type"]
        where = f"{function['name']}(), `{name}`"
        names = [p["name"] for p in function["parameters"]]
        to = kind.get("to", {})
        parameter["direction"] = direction(parameter)
        parameter["nullable"] = nullable(function["name"], parameter, text)
        parameter.update(enum=None, count=None, row=None)
        views = [p for p in function["parameters"] if p["type"].get("to", {}).get("name") in VIEWS
                 or p["name"].startswith("out_") and "count" in names]
        if kind["kind"] != "pointer":
            parameter["role"] = self.role_of_number(where, parameter, text)
        elif name == "error":
            parameter["role"] = "error"
        elif to["kind"] == "handle":
            parameter["role"] = "handle"
        elif to["kind"] == "pointer" and not kind["const"]:
            parameter["role"] = "object"
        elif to == {"kind": "scalar", "name": "char"}:
            parameter["role"] = "text"
            parameter["count"] = name + "_count" if name + "_count" in names else None
        elif to.get("name") in VIEWS:
            parameter["role"] = "view"
            parameter["row"] = self.row(parameter, views, text)
            self.describe_view(function, parameter, where, text)
        elif to.get("name") in CALLBACKS:
            parameter["role"] = "callbacks"
        else:
            parameter["count"] = self.count_of(where, parameter, names, text)
            if parameter["count"]:
                parameter["role"] = "buffer" if to["kind"] == "void" else "array"
                parameter["row"] = self.row(parameter, views, text)
            elif to["kind"] == "struct":
                parameter["role"] = "struct"
            elif name.startswith("out_"):
                parameter["role"] = "result"
            else:
                fail(where, "which parameter has its count?")

    def role_of_number(self, where, parameter, text):
        """enum, lod, count, index or number."""
        name, kind = parameter["name"], parameter["type"]
        if kind.get("name") == "MienStatus":
            parameter["enum"] = "MienStatusCode"
            return "enum"
        said = re.search(rf"`{name}` is (?:an? )?(MIEN_\w+_\.\.\.)", text)
        parameter["enum"] = self.enum_in(said.group(1)) if said else \
            self.enum_named.get(name) or self.enum_named.get(re.sub("s$", "", name))
        if parameter["enum"]:
            return "enum"
        if name == "lod":
            return "lod"
        if name.split("_")[-1] in NUMBERS or name.startswith("first_"):
            return "number"
        if kind == {"kind": "scalar", "name": "uint32_t"} and \
                re.search(rf"`{name}`|\b{name}\b", text):
            return "index"
        fail(where, "name an enum after its type, or explain the parameter in the comment")

    def count_of(self, where, parameter, names, text):
        """The parameter that holds the number of elements, if there may be several."""
        name, to = parameter["name"], parameter["type"]["to"]
        said = re.search(rf"`{name}` (?:gets|has) `(\w+)` ", text)
        if said:
            return said.group(1)
        wanted = [re.sub("s$", "", name) + "_count"]
        if to["kind"] == "void":
            wanted += ["size", "capacity"]
        elif to["kind"] == "struct":
            wanted += ["count"] if name.endswith("s") and "out_" not in name else []
        elif not re.search(r"_(size|bytes|count|index|found|errors|warnings)$", name):
            wanted += ["count"]
        found = [n for n in wanted if n in names]
        return found[0] if found else None

    def row(self, parameter, views, text):
        """Width of a row, from the part of the comment that is about the parameter."""
        name = parameter["name"]
        named = re.search(rf"`{name}`(.*?)(?=`out_|$)", text)
        if len(views) > 1 or named and row_of(named.group(1)):
            return row_of(named.group(1)) if named else None
        return row_of(text)

    def describe_view(self, function, parameter, where, text):
        owner = next((p for p in function["parameters"] if self.handle_of(p)), None)
        static = owner is None or "The string is static" in text
        view = {"of": None, "valid_until": None, "changes_with": []}
        if not static:
            handle = self.api.handles[self.handle_of(owner)]
            view.update(of=owner["name"], valid_until=handle["destroy"])
            changes = re.search(r"Contents change with (.*?)\.(?: |$)", text)
            if not handle["immutable"] and not changes:
                fail(where, "say \"Contents change with mien_...()\": its handle is not immutable")
            if changes:
                view["changes_with"] = self.changing(where, changes.group(1))
        parameter["view"] = view
        if parameter["type"]["to"]["name"] in ("MienFloatView", "MienMutableFloatView") and \
                not parameter["row"]:
            fail(where, "say the width of a row, such as \"16 floats per joint\"")

    def changing(self, where, text):
        found = re.findall(r"\b(mien_\w+)\(\)", text)
        if re.search(r"\bevaluation\b", text):
            found = [n for n in self.functions if n.startswith("mien_rig_evaluate")] + found
        if "their batches" in text:
            found += [n + "_batch" for n in found if n + "_batch" in self.functions]
        unknown = [n for n in found if n not in self.functions]
        if unknown or not found:
            fail(where, f"contents change with {text!r}: there is no such function")
        return found

    def lifetime(self, function, parameter, result, text):
        """call: needed until the call returns; object: until what it makes is released."""
        if result is None or parameter["role"] not in ("handle", "buffer"):
            return "call"
        name = parameter["name"]
        if re.search(rf"`{name}` must outlive\b", text):
            return "object"
        if not re.search(rf"`{name}` may be (closed|destroyed|released)\b", text):
            fail(f"{function['name']}(), `{name}`",
                 "say either \"must outlive ...\" or \"may be closed afterwards\" (or destroyed, "
                 "released)")
        return "call"

    # ---- statuses ------------------------------------------------------------------------------

    def describe_statuses(self, function):
        if "statuses" in function:
            return
        function["statuses"] = []
        if function["returns"].get("name") != "MienStatus":
            return
        name = function["name"]
        said = self.said_statuses(function)
        general = {status: None for status in self.general_statuses(function)}
        order = [value["name"] for enum in self.api.enums if enum["name"] == "MienStatusCode"
                 for value in enum["values"]]
        for status in said:
            if status not in order:
                fail(name, f"there is no {status}")
        function["statuses"] = [
            {"name": status, "condition": said.get(status), "general": status not in said}
            for status in order if status in said or status in general]

    def general_statuses(self, function):
        parameters = function["parameters"]
        if any(p["type"]["kind"] == "pointer" and not p["nullable"] for p in parameters):
            yield "MIEN_ERROR_NULL_ARGUMENT"
        if any(p["role"] == "handle" or p["role"] == "array" and
               p["type"]["to"]["kind"] == "pointer" for p in parameters):
            yield "MIEN_ERROR_HANDLE"
        structs = [self.structs[p["type"]["to"]["name"]] for p in parameters
                   if p["type"].get("to", {}).get("kind") == "struct"]
        if any(struct["sized"] for struct in structs):
            yield "MIEN_ERROR_STRUCT_SIZE"
        inputs = [self.structs[p["type"]["to"]["name"]] for p in parameters
                  if p["type"].get("to", {}).get("kind") == "struct" and p["type"]["const"]]
        if any(p["enum"] for p in parameters) or any(
                field["enum"] or field["boolean"] or field["type"]["kind"] in ("function", "pointer")
                or field["range"] for struct in inputs for field in struct["fields"]):
            yield "MIEN_ERROR_INVALID_ARGUMENT"
        if any(p["role"] == "object" for p in parameters):
            yield "MIEN_ERROR_MEMORY"
        if any("MienDna" in json.dumps(p["type"]) or "MienReport" in json.dumps(p["type"])
               for p in parameters if p["role"] in ("handle", "object")):
            yield "MIEN_ERROR_UNSUPPORTED"

    def said_statuses(self, function):
        """{status: condition} of the sentence "Fails with MIEN_ERROR_X if ..., MIEN_ERROR_Y if ..."."""
        name, text = function["name"], function["documentation"]
        sentence = re.search(r"^Fails (?:with|like) (?:.|\n)*?(?=\nSee |\n\n|\Z)", text, re.MULTILINE)
        rest = text.replace(sentence.group(), "") if sentence else text
        stray = re.search(r"\bMIEN_ERROR_\w+", rest)
        if stray:
            fail(name, f"{stray.group()} stands outside of the sentence \"Fails with ... if ...\", "
                       "which begins a line")
        if not sentence:
            return {}
        said, plain = {}, joined(sentence.group())
        like = re.match(r"Fails like (mien_\w+)\(\)", plain)
        if like:
            other = self.functions.get(like.group(1)) or fail(name, f"there is no {like.group(1)}()")
            self.describe_statuses(other)
            said = {s["name"]: s["condition"] for s in other["statuses"] if not s["general"]}
            plain = plain[like.end():]
            without = re.search(r", but not with ([^,.]*)", plain)
            if without:
                for status in re.findall(r"MIEN_ERROR_\w+", without.group(1)):
                    if said.pop(status, self) is self:
                        fail(name, f"{like.group(1)}() does not fail with {status} either")
                plain = plain.replace(without.group(), "")
        found = list(re.finditer(r"MIEN_ERROR_\w+", plain))
        waiting = []
        for match, after in zip(found, found[1:] + [None]):
            clause = plain[match.end():after.start() if after else len(plain)]
            clause = re.sub(r"[\s,.]*(\b(or|and with|and)\s*)?$", "", clause).strip()
            waiting.append(match.group())
            if clause.startswith("if "):
                condition = clause[len("if "):]
                said.update({s: f"{said[s]}; or {condition}" if said.get(s) and s not in waiting[:-1]
                             and like else condition for s in waiting})
                waiting = []
            elif clause.strip(" ,"):
                fail(name, f"{match.group()}{clause}: expected \"{match.group()} if ...\"")
        if waiting:
            fail(name, f"{waiting[0]} has no \"if ...\"")
        return said


def direction(parameter):
    """in: read; out: written; inout: a mutable handle, or a list of them."""
    kind = parameter["type"]
    if kind["kind"] != "pointer":
        return "in"
    to = kind["to"]
    if to["kind"] == "handle" and not kind["const"]:
        return "inout"
    if kind["const"]:  # of handles that are not const, a list that is
        many = to["kind"] == "pointer" and to["to"]["kind"] == "handle" and not to["const"]
        return "inout" if many else "in"
    if "out" in parameter["name"].split("_") or parameter["name"] in ("error", "buffer"):
        return "out"
    return "inout"


def may_be_null(parameter, text):
    return re.search(rf"`{parameter['name']}`(, which)? may be NULL", text) is not None


def nullable(function, parameter, text):
    """By the rules of mien.h, or because the comment says so."""
    if parameter["type"]["kind"] != "pointer":
        return False
    if f"`{parameter['name']}` is required" in text:
        return False
    return parameter["name"] in ("desc", "allocator", "error") \
        or RELEASE.search(function) is not None \
        or may_be_null(parameter, text)

# SPDX-License-Identifier: MIT
"""Reads C headers as they are written here: plain declarations, one per statement, documented by the
comment right above them (or, for fields and constants, behind or above them). What cannot be read is an
error with a line number, never left out. dump_api.py uses this; conventions.py adds what follows from
names and comments.
"""
import re

SCALARS = {
    "char": 1, "int8_t": 1, "uint8_t": 1, "int16_t": 2, "uint16_t": 2, "int32_t": 4, "uint32_t": 4,
    "int64_t": 8, "uint64_t": 8, "size_t": None, "float": 4, "double": 8,
}
# Size of a pointer and of size_t by data model. LP64: Linux and macOS on 64-bit machines. ILP32:
# 32-bit machines that align 64-bit numbers to 8, such as WebAssembly and ARM, but not x86.
# layout_test.py asks compilers whether the layouts hold.
POINTER_SIZES = {"LP64": 8, "ILP32": 4}

# Macros for compilers, not for bindings.
MACROS = ("MIEN_API", "MIEN_CHECKED", "MIEN_CALLBACK", "MIEN_ZERO", "MIEN_AUTHOR_API",
          "MIEN_AUTHOR_CHECKED", "MIEN_SOLVE_API", "MIEN_SOLVE_CHECKED")
API = ("MIEN_API", "MIEN_AUTHOR_API", "MIEN_SOLVE_API")
CHECKED = ("MIEN_CHECKED", "MIEN_AUTHOR_CHECKED", "MIEN_SOLVE_CHECKED")

TOKEN = re.compile(
    r"(?P<comment>/\*.*?\*/)|(?P<directive>^[ \t]*\#(?:[^\n\\]|\\.|\\\n)*)|(?P<space>\s+)"
    r"|(?P<string>\"[^\"]*\")|(?P<word>\w+)|(?P<sign><<|>>|[-+*/|&~(){}\[\];,=:.?<>!])",
    re.DOTALL | re.MULTILINE)


class Token:
    def __init__(self, kind, text, line):
        self.kind, self.text, self.line = kind, text, line
        self.last_line = line + text.count("\n")


class HeaderError(Exception):
    """What is wrong with a header, and where."""


reading = ""  # the header, for messages


def fail(line, why):
    raise HeaderError(f"{reading}:{line}: {why}")


def tokens_of(text):
    position, line = 0, 1
    while position < len(text):
        match = TOKEN.match(text, position)
        if not match:
            fail(line, f"cannot read {text[position:position + 20]!r}")
        if match.lastgroup != "space":
            yield Token(match.lastgroup, match.group(), line)
        line += match.group().count("\n")
        position = match.end()


def prose(comment):
    """Text of a comment, without its frame; lines and their indentation stay."""
    lines = comment[2:-2].split("\n")
    lines = [lines[0].strip()] + [re.sub(r"^\s*\*? ?", "", line).rstrip() for line in lines[1:]]
    return "\n".join(lines).strip("\n").rstrip()


def joined(text):
    """Text of a comment behind a field or constant: one paragraph."""
    return re.sub(r"\s+", " ", text).strip()


def with_included(folder, name, seen):
    """(file name, text) of a header and of those that it includes from its folder, each once and before
    what needs it. An umbrella, which has nothing but includes, comes first: its comment is the library's.
    So does a header before chapters that it includes behind its own declarations."""
    if name in seen:
        return []
    seen.add(name)
    text = (folder / name).read_text(encoding="utf-8")
    parent = name.rpartition("/")[0]
    before, behind = [], []
    for match in re.finditer(r'^#include "([^"]+)"$', text, re.MULTILINE):
        path = f"{parent}/{match.group(1)}" if parent else match.group(1)
        declared = re.search(r"^(enum|typedef)\b", text[:match.start()], re.MULTILINE)
        (behind if declared or "MIEN_API" not in text else before).extend(with_included(folder, path, seen))
    return before + [(name, text)] + behind


class Interface:
    """Reads headers from top to bottom; what they declare collects in the lists. `headers` are
    (library, file name, text); a header knows the types of those before it, and the first of a library
    documents it."""

    def __init__(self, headers):
        self.libraries = []
        self.handles, self.aliases, self.callbacks = {}, {}, {}
        self.constants, self.enums, self.structs, self.functions = [], [], {}, []
        self.values = {}  # of constants and macros, for expressions
        self.experimental = False  # between #ifdef MIEN_EXPERIMENTAL and its #endif
        global reading
        for library, name, text in headers:
            reading = name
            self.tokens = list(tokens_of(text))
            self.position = 0
            self.section = ""
            self.first = library not in [known["name"] for known in self.libraries]
            if self.first:
                self.libraries.append({"name": library, "header": name, "documentation": ""})
            self.read()

    # ---- tokens --------------------------------------------------------------------------------

    def peek(self, skip_comments=True):
        position = self.position
        while skip_comments and position < len(self.tokens) and \
                self.tokens[position].kind == "comment":
            position += 1
        return self.tokens[position] if position < len(self.tokens) else None

    def next(self):
        """The next token that is no comment."""
        while self.position < len(self.tokens):
            self.position += 1
            token = self.tokens[self.position - 1]
            if token.kind != "comment":
                return token
        fail(self.tokens[-1].line, "the header ends within a declaration")

    def expect(self, text):
        token = self.next()
        if token.text != text:
            fail(token.line, f"expected {text!r}, found {token.text!r}")
        return token

    def take(self, text):
        token = self.peek()
        if token and token.text == text:
            self.next()
            return True
        return False

    def word(self):
        token = self.next()
        if token.kind != "word":
            fail(token.line, f"expected a name, found {token.text!r}")
        return token.text

    # ---- the file ------------------------------------------------------------------------------

    def read(self):
        above = None  # the comment that touches what follows
        group_end = 0  # last line of the comment, then of the declarations that share it
        self.owner = None  # the function that the comment stands above
        while self.position < len(self.tokens):
            token = self.tokens[self.position]
            if token.kind == "comment":
                self.position += 1
                heading = re.fullmatch(r"/\* ---- (.+?) -+ \*/", token.text)
                if heading:
                    self.section, above = heading.group(1), None
                    continue
                text = prose(token.text)
                if text.startswith("SPDX-License-Identifier"):
                    if self.first:
                        self.libraries[-1]["documentation"] = text.partition("\n")[2].strip("\n")
                    continue
                above, group_end, self.owner = text, token.last_line, None
                continue
            # Declarations without a blank line between them share the comment above the first.
            if above is not None and token.line > group_end + 1:
                above = None
            first = token.line
            if token.kind == "directive":
                self.position += 1
                self.directive(token, above or "")
            elif token.text == "typedef":
                self.typedef(above or "")
            elif token.text == "enum":
                self.enum(above or "")
            elif token.text in API + CHECKED:
                self.function(above or "")
            elif token.text == "MIEN_DEFAULT":
                self.default()
            elif token.text == "extern" or token.text == "}":
                while self.next().kind != "string" and token.text == "extern":
                    pass
                if token.text == "extern":
                    self.expect("{")
                    continue
            else:
                fail(first, f"cannot read a declaration that begins with {token.text!r}")
            if token.kind != "directive":
                group_end = self.tokens[self.position - 1].line

    def where(self, above):
        """What every entry has."""
        return {"section": self.section, "documentation": above, "experimental": self.experimental}

    def directive(self, token, above):
        if re.fullmatch(r"#\s*ifdef\s+MIEN_EXPERIMENTAL\s*", token.text):
            self.experimental = True
        elif re.match(r"#\s*endif", token.text):
            self.experimental = False
        match = re.fullmatch(r"\s*#\s*define\s+(MIEN_\w+)[ \t]+(\S.*)", token.text, re.DOTALL)
        if not match or match.group(1) in MACROS or match.group(1).endswith("_H"):
            return
        name, text = match.groups()
        value = self.evaluate(text, token.line)
        self.values[name] = value
        self.constants.append({"name": name, "value": value, **self.where(above)})

    def evaluate(self, text, line):
        """An integer expression of literals and constants that were declared before."""
        text = re.sub(r"\bUINT(8|16|32|64)_MAX\b", lambda m: str(2 ** int(m.group(1)) - 1), text)
        text = re.sub(r"\b(0[xX][0-9a-fA-F]+|\d+)[uUlL]*\b", r"\1", text)
        text = re.sub(r"\b[A-Za-z]\w*", lambda m: str(self.values.get(m.group(), m.group())), text)
        if not re.fullmatch(r"[\s\dxXa-fA-F()|&~+*<>-]+", text):
            fail(line, f"not an integer expression: {text!r}")
        return eval(text, {"__builtins__": {}})  # digits and operators alone, as just checked

    # ---- types ---------------------------------------------------------------------------------

    def base_type(self):
        """`const`, a type name, and the stars behind it."""
        const = self.take("const")
        self.take("struct") or self.take("enum")
        line, name = self.peek().line, self.word()
        const = self.take("const") or const
        if name == "void":
            kind = {"kind": "void"}
        elif name in SCALARS:
            kind = {"kind": "scalar", "name": name}
        elif name in self.aliases:
            kind = {"kind": "alias", "name": name, "of": self.aliases[name]["type"]}
        elif name in self.callbacks:
            kind = {"kind": "callback", "name": name}
        elif name in self.handles:
            kind = {"kind": "handle", "name": name}
        elif name in self.structs:
            kind = {"kind": "struct", "name": name}
        else:
            fail(line, f"unknown type {name}")
        return self.stars(kind, const)

    def stars(self, kind, const):
        while self.take("*"):
            kind = {"kind": "pointer", "const": const, "to": kind}
            const = self.take("const")
        return kind

    def declarator(self, kind):
        """What follows a type: NAME, NAME[COUNT] or (MIEN_CALLBACK* NAME)(PARAMETERS)."""
        if self.take("("):
            self.expect("MIEN_CALLBACK")
            self.expect("*")
            name = self.word()
            self.expect(")")
            self.expect("(")
            return name, {"kind": "function", "returns": kind, "parameters": self.parameters()}
        name = self.word()
        if self.take("["):
            line, text = self.peek().line, ""
            while not self.take("]"):
                text += self.next().text + " "
            kind = {"kind": "array", "count": self.evaluate(text, line), "of": kind}
        return name, kind

    def parameters(self):
        """Up to and including the closing parenthesis."""
        found = []
        if self.peek().text == "void":
            position = self.position
            self.next()
            if self.take(")"):
                return found
            self.position = position
        while True:
            name, kind = self.declarator(self.base_type())
            if kind["kind"] == "array":  # an array parameter is a pointer
                kind = {"kind": "pointer", "const": False, "to": kind["of"]}
            found.append({"name": name, "type": kind})
            if self.take(")"):
                return found
            self.expect(",")

    # ---- declarations --------------------------------------------------------------------------

    def typedef(self, above):
        self.expect("typedef")
        line = self.peek().line
        where = self.where(above)
        if self.peek().text == "enum":
            fail(line, "enums are plain, without typedef: their values travel as fixed-width numbers")
        if self.peek().text == "struct":
            self.next()
            tag = self.word()
            if self.peek().text == "{":
                self.struct(tag, where)
            else:
                name = self.word()
                self.expect(";")
                if tag not in self.structs:
                    self.handles[name] = {"name": name, **where}
            return
        name, kind = self.declarator(self.base_type())
        self.expect(";")
        if kind["kind"] == "function":
            self.callbacks[name] = {"name": name, **kind, **where}
            del self.callbacks[name]["kind"]
        else:
            self.aliases[name] = {"name": name, "type": kind, **where}

    def members(self, read_one, end_of_one):
        """(member, documentation): a comment belongs to the member on whose line it begins, or,
        on a line of its own, to the member that follows."""
        self.expect("{")
        found, above, line = [], "", 0
        while True:
            token = self.peek(skip_comments=False)
            if token.kind == "comment":
                self.position += 1
                text = joined(prose(token.text))
                if found and token.line == line:
                    found[-1][1] = joined(found[-1][1] + " " + text)
                else:
                    above = joined(above + " " + text)
                continue
            if self.take("}"):
                return found
            for member in read_one():
                found.append([member, above])
            above, line = "", self.tokens[self.position - 1].line
            if self.peek().text in end_of_one:
                line = self.peek().line
                position = self.position  # a comment may stand before the comma
                while self.tokens[position].kind == "comment":
                    found[-1][1] = joined(prose(self.tokens[position].text))
                    position += 1
                self.next()

    def struct(self, name, where):
        def field():
            base = self.base_type()
            fields = [self.declarator(base)]
            while self.take(","):
                fields.append(self.declarator(base))
            return fields

        fields = []
        for (field_name, kind), documentation in self.members(field, ";"):
            fields.append({"name": field_name, "type": kind,
                           "boolean": documentation.startswith("boolean"),
                           "documentation": re.sub("^boolean:? ?", "", documentation)})
        self.expect(name)
        self.expect(";")
        struct = {"name": name, "sized": fields[0]["name"] == "struct_size", "default": None,
                  "fields": fields, "layouts": {}, **where}
        for model in POINTER_SIZES:
            offsets, end, alignment = {}, 0, 1
            for entry in fields:
                size, align = self.layout(entry["type"], model)
                end = -(-end // align) * align
                offsets[entry["name"]] = [end, size]
                end, alignment = end + size, max(alignment, align)
            struct["layouts"][model] = {"size": -(-end // alignment) * alignment,
                                        "alignment": alignment, "fields": offsets}
        self.structs[name] = struct

    def layout(self, kind, model):
        """(size, alignment) of a type."""
        if kind["kind"] in ("pointer", "function", "callback"):
            return POINTER_SIZES[model], POINTER_SIZES[model]
        if kind["kind"] == "array":
            size, align = self.layout(kind["of"], model)
            return size * kind["count"], align
        if kind["kind"] == "alias":
            return self.layout(kind["of"], model)
        if kind["kind"] == "struct":
            layout = self.structs[kind["name"]]["layouts"][model]
            return layout["size"], layout["alignment"]
        size = SCALARS[kind["name"]] or POINTER_SIZES[model]
        return size, size

    def default(self):
        """MIEN_DEFAULT(MienRigDesc, mien_rig_desc_default)"""
        line = self.expect("MIEN_DEFAULT").line
        self.expect("(")
        name = self.word()
        self.expect(",")
        function = self.word()
        self.expect(")")
        wanted = re.sub(r"(?<!^)([A-Z])", r"_\1", name).lower() + "_default"
        if name not in self.structs or not self.structs[name]["sized"] or function != wanted:
            fail(line, f"MIEN_DEFAULT is for sized structs: MIEN_DEFAULT({name}, {wanted})")
        self.structs[name]["default"] = function

    def enum(self, above):
        line = self.expect("enum").line
        name = None if self.peek().text == "{" else self.word()
        state = {"next": 0}

        def value():
            line, constant = self.peek().line, self.word()
            if self.take("="):
                text = ""
                while self.peek().text not in (",", "}"):
                    text += self.next().text + " "
                state["next"] = self.evaluate(text, line)
            self.values[constant] = state["next"]
            state["next"] += 1
            return [constant]

        members = self.members(value, ",")
        self.expect(";")
        names = [constant for constant, _ in members]
        prefix = common_prefix(names)
        # Bindings need a name: without one, MIEN_DARK_BLUE and MIEN_DARK_RED make a MienDark.
        name = name or "".join(word.capitalize() for word in prefix.split("_"))
        if name == "Mien" or name in [enum["name"] for enum in self.enums]:
            fail(line, f"this enum needs a name, and not {name}")
        values = [{"name": constant, "value": self.values[constant],
                   "short_name": short_name(constant[len(prefix):]),
                   "documentation": documentation}
                  for constant, documentation in members]
        self.enums.append({"name": name, "prefix": prefix, "flags": are_flags(values),
                           "values": values, **self.where(above)})

    def function(self, above):
        checked = self.next()
        returns = self.base_type()
        name = self.word()
        has_status = returns.get("name") == "MienStatus"
        if has_status != (checked.text in CHECKED):
            fail(checked.line, f"{name}: MIEN_CHECKED is for what returns a MienStatus")
        self.expect("(")
        parameters = self.parameters()
        self.expect(";")
        # What is said of creating does not describe the release that stands below it.
        shared = self.owner is not None and above != ""
        if shared and re.search(r"_(destroy|close)$", name):
            shared, above = False, ""
        self.functions.append({"name": name, "library": self.libraries[-1]["name"],
                               "returns": returns, "parameters": parameters,
                               **self.where(above),
                               "documented_with": self.owner if shared else None})
        self.owner = self.owner or name


def short_name(rest):
    """A name that is valid by itself in any language: 32_BIT is BIT_32."""
    return re.sub(r"^(\d+)_(\w+)$", r"\2_\1", rest)


def common_prefix(names):
    """What all names begin with, up to an underscore."""
    words = [name.split("_") for name in names]
    count = 0
    while all(len(w) > count + 1 for w in words) and len({w[count] for w in words}) == 1:
        count += 1
    return "".join(word + "_" for word in words[0][:count])


def are_flags(values):
    """Bits to be combined: powers of two with gaps, besides 0 and sums."""
    numbers = {value["value"] for value in values}
    bits = {n for n in numbers if n > 0 and n & (n - 1) == 0}
    return max(bits, default=0) >= 4 and 3 not in numbers and \
        all(n == 0 or n in bits or n & ~sum(bits) == 0 for n in numbers)

# SPDX-License-Identifier: MIT
"""USD text as Python values: a small parser of the grammar, strict about what it knows."""
import json
import re

TOKEN = re.compile(r'''(?:\s|\#[^\n]*)*(?P<token>"(?:[^"\\\n]|\\.)*"|<[^>\n]*>|@[^@\n]*@|[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?'''
                   r'''|[A-Za-z_][A-Za-z0-9_:.]*(?:\[\])?|[(){}\[\]=,;:])''')
NUMBERS = re.compile(r"[-+0-9.eE,() \n]+")
ESCAPE = re.compile(r"\\(x[0-9a-fA-F]{2}|.)")


class Prim:
    def __init__(self, kind, name):
        self.kind, self.name = kind, name
        self.metadata, self.attributes, self.children = {}, {}, []
        self.types, self.samples, self.details = {}, {}, {}  # of attributes; details: their metadata

    def child(self, name):
        found = [prim for prim in self.children if prim.name == name]
        assert len(found) == 1, (self.name, name, [prim.name for prim in self.children])
        return found[0]

    def walk(self, path=""):
        here = path + "/" + self.name if self.name else ""
        yield here, self
        for prim in self.children:
            yield from prim.walk(here)


class Parser:
    def __init__(self, text):
        assert text.startswith("#usda 1.0\n"), text[:20]
        self.text, self.at = text, 0
        self.next = None
        self.step()

    def step(self):
        token, self.skipped = self.next, False
        while True:
            match = TOKEN.match(self.text, self.at)
            if match:
                self.next, self.at = match.group("token"), match.end()
                return token
            rest = re.match(r"\s*(#[^\n]*)?\s*", self.text[self.at:])
            assert self.at + rest.end() >= len(self.text), self.text[self.at:self.at + 60]
            self.next = None
            return token

    def take(self, token):
        assert self.next == token, "expected %r, found %r before %r" % (token, self.next, self.text[self.at:self.at + 50])
        return self.step()

    def value(self):
        token = self.step()
        if token[0] == '"':
            return ESCAPE.sub(lambda m: chr(int(m[1][1:], 16)) if m[1][0] == "x" else m[1], token[1:-1])
        if token[0] in "<@":
            return token
        if token == "[" and NUMBERS.match(self.next):
            values = self.numbers()
            if values is not None:
                return values
        if token in "([":
            close, values = {"(": ")", "[": "]"}[token], []
            while self.next != close:
                values.append(self.value())
                if self.next != close:
                    self.take(",")
            self.step()
            return tuple(values) if close == ")" else values
        if token == "{":  # a dictionary with types, or samples by time code
            values = {}
            while self.next != "}":
                if re.match(r"[-+.\d]", self.next):
                    time = float(self.step())
                    self.take(":")
                    values[time] = self.value()
                    self.take(",")
                else:
                    self.step()
                    name = self.step()
                    self.take("=")
                    values[name] = self.value()
            self.step()
            return values
        if re.match(r"[-+.\d]", token):
            return float(token) if re.search(r"[.eE]", token) else int(token)
        assert token in ("true", "false"), token
        return token == "true"

    def numbers(self):
        """A list of numbers or tuples of them, which most of a file is, or None: by the parser of JSON, whose grammar
        for them is a part of this one."""
        begin = self.at - len(self.next)
        end = self.text.find("]", begin)
        part = self.text[begin:end]
        if end < 0 or not NUMBERS.fullmatch(part):
            return None
        def as_tuple(value):
            return tuple(map(as_tuple, value)) if isinstance(value, list) else value
        values = list(map(as_tuple, json.loads("[" + part.replace("(", "[").replace(")", "]") + "]")))
        self.at = end
        self.step()
        self.step()
        return values

    def metadata(self):
        values = {}
        if self.next != "(":
            return values
        self.step()
        while self.next != ")":
            name = self.step()
            if name == "prepend":
                name = self.step()
            self.take("=")
            values[name] = self.value()
        self.step()
        return values

    def prim(self):
        self.take("def")
        prim = Prim(self.step(), self.value())
        assert re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", prim.name), prim.name
        prim.metadata = self.metadata()
        self.take("{")
        while self.next != "}":
            if self.next == "def":
                prim.children.append(self.prim())
            else:
                self.attribute(prim)
        self.step()
        names = [child.name for child in prim.children]
        assert len(set(names)) == len(names), names
        return prim

    def attribute(self, prim):
        kind = self.step()
        if kind == "uniform":
            kind += " " + self.step()
        name = self.step()
        value = None
        if self.next == "=":
            self.step()
            value = self.value()
        for end, where in ((".timeSamples", prim.samples), (".connect", prim.attributes)):
            if name.endswith(end):
                where[name[:-len(end)]] = value
                prim.types[name[:-len(end)]] = kind
                return
        prim.types[name] = kind
        if value is not None:
            assert name not in prim.attributes, name
            prim.attributes[name] = value
        prim.details[name] = self.metadata()


def read(text):
    """The stage: a prim without a name, whose metadata are those of the layer."""
    parser = Parser(text)
    stage = Prim("", "")
    stage.metadata = parser.metadata()
    while parser.next is not None:
        stage.children.append(parser.prim())
    return stage

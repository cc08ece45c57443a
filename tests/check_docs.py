#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Documents and what refers to them agree.

  - Comments cite documents by file, number and heading: docs/rig-evaluation.md, 4.8 "Joints
    represented by quaternions". File, number and heading have to exist and to belong together.
  - Relative links and anchors in *.md lead somewhere.
  - Paths, tests (`Suite.Name`), functions (`mien_...()`) and constants (`MIEN_...`) in the inline
    code of *.md exist.

Usage: check_docs.py [--self-test] [PROJECT_DIRECTORY]
"""
import re
import sys
import tempfile
from pathlib import Path

SKIPPED = {"build", ".git", ".cache", "__pycache__", "node_modules", "target"}
SUFFIXES = {".h", ".hpp", ".c", ".cpp", ".inl", ".py", ".rs", ".cmake", ".txt", ".toml", ".sh",
            ".map"}
# Named before they exist.
NOT_YET = {"capi/mien_abi.json"}
AREAS = ("author", "bench", "capi", "docs", "examples", "integrations", "runtime", "simd", "solve", "tests")

HEADING = re.compile(r"^(#{1,6})\s+(.*?)\s*#*$")
NUMBERED = re.compile(r"(\d+(?:\.\d+)*)\.?\s+(.*)")
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)(?:\s+\"[^\"]*\")?\)")
CODE = re.compile(r"`([^`\n]+)`")
PATH = re.compile(rf"(?:{'|'.join(AREAS)})/[\w./*-]*\w[*]?/?")
TEST = re.compile(r"^\s*TEST(?:_F|_P)?\((\w+),\s*(\w+)\)", re.MULTILINE)
TEST_NAME = re.compile(r"[A-Z]\w+\.[A-Z]\w+")
FUNCTION = re.compile(r"\bmien_[a-z0-9_]+(?=\()")
CONSTANT = re.compile(r"\bMIEN_[A-Z0-9_]+")

# A document, then the sections that are meant: numbers, headings, or both.
DOCUMENT = re.compile(r"(?<![\w/.-])((?:[\w.-]+/)*[\w-]+\.md)\b(?!\))")
SECTION = re.compile(r'(?:, (?:and )?| and | to )(?:(\d+(?:\.\d+)*)(?![\d%])(?: "([^"]+)")?|"([^"]+)")')
COMMENT_BREAK = re.compile(r"\s*\n[ \t]*(?://[/!]?|\*(?!/)|#)?[ \t]*")


class Document:
    """Headings of a Markdown file, and its text without code blocks."""

    def __init__(self, text):
        self.sections, self.titles, self.anchors = {}, set(), set()
        self.prose = []
        fenced = False
        for number, line in enumerate(text.splitlines(), 1):
            if line.lstrip().startswith("```"):
                fenced = not fenced
            elif not fenced and not line.startswith("    "):
                self.prose.append((number, line))
                heading = HEADING.match(line)
                if heading:
                    self.add(heading.group(2))

    def add(self, heading):
        plain = CODE.sub(r"\1", re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading))
        numbered = NUMBERED.fullmatch(plain)
        if numbered:
            self.sections[numbered.group(1)] = numbered.group(2)
        self.titles.add(numbered.group(2) if numbered else plain)
        anchor = re.sub(r"[^\w\- ]", "", plain.lower()).replace(" ", "-")
        copies = sum(1 for a in self.anchors if re.fullmatch(re.escape(anchor) + r"(-\d+)?", a))
        self.anchors.add(f"{anchor}-{copies}" if copies else anchor)


def walk(root):
    for path in sorted(root.iterdir()):
        if path.is_dir():
            if path.name not in SKIPPED:
                yield from walk(path)
        elif path.is_file():
            yield path


class Checker:
    def __init__(self, root):
        self.root = root
        files = [f for f in walk(root) if f.resolve() != Path(__file__).resolve()]
        self.documents = {f: Document(f.read_text(encoding="utf-8"))
                          for f in files if f.suffix == ".md"}
        self.sources = {f: f.read_text(encoding="utf-8", errors="replace")
                        for f in files if f.suffix in SUFFIXES or f == root / "dev"}
        # Names of one common word are left out.
        self.stems = "|".join(f.stem for f in self.documents
                              if f.parent == root / "docs" and "-" in f.stem) or "-"
        self.tests = {f"{suite}.{name}" for f, text in self.sources.items()
                      if f.name.endswith("_test.cpp") for suite, name in TEST.findall(text)}
        text = "\n".join(text for file, text in self.sources.items()
                         if (root / "capi" / "include") in file.parents)
        self.functions = set(FUNCTION.findall(text))
        self.functions.update(re.findall(r"^MIEN_DEFAULT\(\w+, (\w+)\)$", text, re.MULTILINE))
        self.names = set(CONSTANT.findall("\n".join(self.sources.values())))
        self.citations = self.links = 0
        self.problems = []

    def problem(self, file, line, text):
        self.problems.append(f"{file.relative_to(self.root).as_posix()}:{line}: {text}")

    def find_document(self, file, name):
        for place in (file.parent / name, self.root / name, self.root / "docs" / name):
            if place.resolve() in self.documents:
                return self.documents[place.resolve()]
        return None

    # Citations ------------------------------------------------------------------------------------

    def check_citations(self, file, text, line_of):
        for match in DOCUMENT.finditer(text):
            name = match.group(1)
            document = self.find_document(file, name)
            line = line_of(match.start())
            if document is None:
                # Documents of other folders, such as shared data, are not ours to check.
                if any((place / name).parent.is_dir() for place in (self.root, file.parent)):
                    self.problem(file, line, f"there is no {name}")
                continue
            self.citations += 1
            at = match.end()
            while section := SECTION.match(text, at):
                self.check_section(file, line, name, document, *section.groups())
                at = section.end()
        old = re.compile(rf"\b(?:{self.stems})(?:,| section)? \d|\bspec/[\w-]+\.md")
        for match in old.finditer(text):
            self.problem(file, line_of(match.start()),
                         f'"{match.group()}": cite docs/FILE.md, NUMBER "HEADING"')

    def check_section(self, file, line, name, document, number, heading, title):
        if title is not None:
            if title not in document.titles:
                self.problem(file, line, f'{name} has no heading "{title}"')
        elif number not in document.sections:
            self.problem(file, line, f"{name} has no section {number}")
        elif heading is not None and heading != document.sections[number]:
            self.problem(file, line, f'{name}, {number} is "{document.sections[number]}", '
                                     f'not "{heading}"')

    def check_source(self, file, text):
        # Comments go on behind the mark of the next line.
        pieces, breaks, at, length = [], [(0, 1)], 0, 0
        for match in COMMENT_BREAK.finditer(text):
            pieces += [text[at:match.start()], " "]
            length += match.start() - at + 1
            at = match.end()
            breaks.append((length, 1 + text.count("\n", 0, at)))
        flat = "".join(pieces) + text[at:]

        def line_of(offset):
            return max(line for start, line in breaks if start <= offset)
        self.check_citations(file, flat, line_of)

    # Markdown -------------------------------------------------------------------------------------

    def check_document(self, file, document):
        lines = [re.sub(r"[*_]{2}", "", LINK.sub(self.cited, line)) for _, line in document.prose]
        starts, at = [], 0
        for (number, _), line in zip(document.prose, lines):
            starts.append((at, number))
            at += len(line) + 1
        self.check_citations(file, " ".join(lines),
                             lambda offset: max(n for start, n in starts if start <= offset))
        for number, line in document.prose:
            for target in LINK.findall(CODE.sub("", line)):
                self.check_link(file, number, document, target)
            for code in CODE.findall(line):
                self.check_code(file, number, code)

    @staticmethod
    def cited(link):
        """[rig-evaluation.md](rig-evaluation.md) reads as rig-evaluation.md."""
        return link.group(1) if link.group().startswith(f"[{link.group(1)}]") else link.group()

    def check_link(self, file, line, document, target):
        if re.match(r"[a-z]+:", target):
            return
        self.links += 1
        path, _, anchor = target.partition("#")
        found = (file.parent / path).resolve() if path else file
        if not found.exists():
            return self.problem(file, line, f"the link {target} leads nowhere")
        linked = self.documents.get(found, document if not path else None)
        if anchor and linked and anchor not in linked.anchors:
            self.problem(file, line, f"the link {target} leads to no heading")

    def check_code(self, file, line, code):
        if PATH.fullmatch(code) and code.rstrip("/") not in NOT_YET:
            if not any(any(folder.glob(code)) for folder in (self.root, file.parent)):
                self.problem(file, line, f"there is no {code}")
        if TEST_NAME.fullmatch(code) and code not in self.tests:
            self.problem(file, line, f"there is no test {code}")
        for name in FUNCTION.findall(code):
            # mien_thing_...() means all that begin so.
            if name not in self.functions and not code.endswith("..."):
                self.problem(file, line, f"no header has {name}()")
        for name in CONSTANT.findall(code):
            begins = name.endswith("_") and any(n.startswith(name) for n in self.names)
            if name not in self.names | NOT_YET and not begins:
                self.problem(file, line, f"nothing is named {name}")

    def run(self):
        for file, text in self.sources.items():
            self.check_source(file, text)
        for file, document in self.documents.items():
            self.check_document(file, document)
        return self.problems


# Proof that each check can fail --------------------------------------------------------------------

GOOD = {
    "README.md": "# Top\n\n[form](docs/a-form.md#2-the-second-part) [top](#top) `capi/include/mien.h`\n"
                 "`mien_open()` `MIEN_OK` `MIEN_...` `Suite.Passes` `tests/*_test.cpp`\n"
                 "Form: docs/a-form.md, 1 and 2.\n",
    "docs/a-form.md": "# Form\n\n## 1. First\n\n## 2. The second part\n\n    ## 9. Code, no heading\n",
    "capi/include/mien.h": '/* docs/a-form.md, 1 "First". */\nint mien_open(int);\n#define MIEN_OK 0\n',
    "tests/a_test.cpp": '// As told (docs/a-form.md, 2 "The\n// second part"; a-form.md, "First").\n'
                        "TEST(Suite, Passes) {}\n",
}
BROKEN = [  # file, what stands there, what is put there instead, what has to be said
    ("capi/include/mien.h", "a-form.md, 1", "other.md, 1", "there is no docs/other.md"),
    ("capi/include/mien.h", "form.md, 1", "form.md, 3", "no section 3"),
    ("capi/include/mien.h", "form.md, 1", "form.md, 9", "no section 9"),
    ("capi/include/mien.h", '"First"', '"Last"', 'is "First", not "Last"'),
    ("capi/include/mien.h", "docs/a-form.md, 1", "a-form 1", "cite docs/FILE.md"),
    ("tests/a_test.cpp", "// second part", "// third part", 'is "The second part"'),
    ("tests/a_test.cpp", '"First"', '"Last"', 'no heading "Last"'),
    ("tests/a_test.cpp", "Passes", "Fails", "no test Suite.Passes"),
    ("docs/a-form.md", "## 2.", "## 3.", "leads to no heading"),
    ("README.md", "docs/a-form.md#", "docs/from.md#", "leads nowhere"),
    ("README.md", "#top", "#bottom", "leads to no heading"),
    ("README.md", "1 and 2", "1 and 4", "no section 4"),
    ("README.md", "capi/include/mien.h", "capi/mine.h", "there is no capi/mine.h"),
    ("README.md", "*_test.cpp", "*_text.cpp", "there is no tests/*_text.cpp"),
    ("README.md", "mien_open()", "mien_close()", "no header has mien_close()"),
    ("README.md", "`MIEN_OK`", "`MIEN_KO`", "nothing is named MIEN_KO"),
]


def problems_of(files):
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder).resolve()
        for name, text in files.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text, encoding="utf-8")
        return Checker(root).run()


def self_test():
    found = problems_of(GOOD)
    assert not found, f"self-test: good files have problems: {found}"
    for name, old, new, expected in BROKEN:
        assert old in GOOD[name], (name, old)
        found = problems_of({**GOOD, name: GOOD[name].replace(old, new)})
        assert any(expected in p for p in found), f"self-test: {name}, {new!r}: {found}"
    print(f"self-test: {len(BROKEN)} mistakes found")


def main():
    arguments = sys.argv[1:]
    if "--self-test" in arguments:
        arguments.remove("--self-test")
        self_test()
    checker = Checker(Path(arguments[0] if arguments else Path(__file__).parent.parent).resolve())
    problems = checker.run()
    if not checker.documents:
        problems.append(f"{checker.root}: no documents found")
    print("\n".join(problems) if problems else
          f"{len(checker.documents)} documents, {checker.citations} citations and "
          f"{checker.links} links in order")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())

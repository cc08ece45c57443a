#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Parameters of the C functions have one name, in the header and where the function is defined.

A message of an error names the parameter, and a reader of the source looks it up in the header. A parameter that
a definition does not use may have no name.
Usage: check_parameters.py [--self-test] [PROJECT_DIRECTORY]
"""
import json
import re
import sys
from pathlib import Path

FOLDERS = ("capi", "author/capi")
DEFINITION = re.compile(r"^(?!static\b)[A-Za-z_][\w :*&<>]*?\b(mien_\w+)\(([^{};]*)\)\s*\{", re.M)
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.S)


def split(parameters):
    """The parameters of a list, of which function pointers have commas of their own."""
    parts, depth = [""], 0
    for character in parameters:
        depth += (character in "(<[") - (character in ")>]")
        if character == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += character
    return [part.strip() for part in parts if part.strip() not in ("", "void")]


def name_of(parameter):
    """Its name, or None."""
    pointer = re.search(r"\(\s*[\w ]*\*\s*(\w+)\s*\)", parameter)
    if pointer:
        return pointer.group(1)
    words = re.findall(r"\w+", re.sub(r"\[[^\]]*\]", "", parameter))
    types = {"const", "unsigned", "int", "char", "void", "float", "double", "bool", "struct"}
    if len(words) < 2 or words[-1] in types or parameter.rstrip().endswith(("*", "&")):
        return None
    return None if words[:-1] == ["const"] else words[-1]


def definitions(text):
    """(line, function, names of its parameters) of a source."""
    text = COMMENT.sub(lambda match: re.sub(r"[^\n]", " ", match.group()), text)
    for match in DEFINITION.finditer(text):
        line = text.count("\n", 0, match.start(1)) + 1
        yield line, match.group(1), [name_of(parameter) for parameter in split(match.group(2))]


def compare(where, text, declared):
    """What is wrong with a source, and how many functions it defines."""
    wrong, count = [], 0
    for line, function, names in definitions(text):
        if function not in declared:
            continue
        count += 1
        expected = declared[function]
        if len(names) != len(expected):
            wrong.append(f"{where}:{line}: {function} has {len(names)} parameters, {len(expected)} in the header")
            continue
        for name, header in zip(names, expected):
            if name and name != header:
                wrong.append(f"{where}:{line}: {function}: {name} is called {header} in the header; take that name")
    return wrong, count


def self_test():
    declared = {"mien_a": ["rig", "out_count"], "mien_b": ["read", "values"], "mien_c": []}
    good = """MienStatus mien_a(const MienRig* rig,  // of a file
                  uint32_t* out_count) {\n}\nvoid mien_b(int (*read)(void*, int), float values[2]) {\n}
uint32_t mien_c(void) { return mien_a(x, y); }\nMienStatus mien_a(const MienRig*, uint32_t* out_count) {\n"""
    assert compare("x", good, declared) == ([], 4), compare("x", good, declared)
    wrong, _ = compare("x", "\nMienStatus mien_a(const MienRig* handle, uint32_t* out_count) {\n", declared)
    assert wrong == ["x:2: mien_a: handle is called rig in the header; take that name"], wrong
    wrong, _ = compare("x", "void mien_b(int (*get)(void*, int)) {", declared)
    assert wrong == ["x:1: mien_b has 1 parameters, 2 in the header"], wrong


def main():
    arguments = sys.argv[1:]
    if "--self-test" in arguments:
        arguments.remove("--self-test")
        self_test()
    root = Path(arguments[0]) if arguments else Path(__file__).resolve().parent.parent
    api = json.loads((root / "integrations/api/mien_api.json").read_text(encoding="utf-8"))
    declared = {f["name"]: [p["name"] for p in f["parameters"]] for f in api["functions"]}
    wrong, count = [], 0
    for folder in FOLDERS:
        for file in sorted((root / folder).glob("*.cpp")):
            found, defined = compare(file.relative_to(root), file.read_text(encoding="utf-8"), declared)
            wrong += found
            count += defined
    if count < len(declared):
        wrong.append(f"only {count} definitions of the {len(declared)} functions were found; mend this check")
    print("\n".join(wrong) or f"The parameters of {count} definitions have the names of the header.")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

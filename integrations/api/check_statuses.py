#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The statuses that functions return are those that their comments name.

Follows the calls within capi/ from each public function. Every status written there has to be in
mien_api.json; every status that a comment names has to be written there, unless the function also
passes on errors of the runtime.

Usage: check_statuses.py [--self-test]
"""
import json
import re
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent

DEFINITION = re.compile(r"^[\w:<>*&\[\] ]+?\b(\w+)\((?:[^;{}()]|\([^()]*\))*\) (?:const )?\{",
                        re.MULTILINE)
LITERAL = re.compile(r"\bMIEN_ERROR_[A-Z_]+\b")
# How an error of the runtime is passed on.
PASSED_ON = re.compile(r"\bgive_(?:error\(detail|object\(|status\()")

# What a function cannot return, though a function that it calls can.
NEVER = {
    ("mien_clip_build", "MIEN_ERROR_MISMATCH"): "its compare_names() is that of the runtime",
    ("mien_rig_evaluate", "MIEN_ERROR_INVALID_ARGUMENT"): "its stages are constant",
    ("mien_deformer_instance_deform", "MIEN_ERROR_MISMATCH"): "there is one instance",
    ("mien_deformer_instance_write_vertices", "MIEN_ERROR_MISMATCH"): "there is one instance",
}


def functions_in(text):
    """{name: body} of the definitions in a file, without comments and strings."""
    text = re.sub(r'//[^\n]*|"(?:[^"\\\n]|\\.)*"', "", text)
    text = re.sub(r"static_cast<void>\(\s*\w+\(", "", text)  # whatever it returns goes no farther
    found = {}
    for match in DEFINITION.finditer(text):
        depth, end = 1, match.end()
        while depth and end < len(text):
            depth += {"{": 1, "}": -1}.get(text[end], 0)
            end += 1
        found[match.group(1)] = found.get(match.group(1), "") + text[match.end():end]
    return found


def reachable(name, bodies, seen):
    """Text of a function and of all that it calls here."""
    if name in seen or name not in bodies:
        return ""
    seen.add(name)
    calls = dict.fromkeys(re.findall(r"\b(\w+)(?:<\w+>)?\(", bodies[name]))
    return bodies[name] + "".join(reachable(call, bodies, seen) for call in calls)


def problems_of(functions, bodies):
    without_status = [f["name"] for f in functions if f["returns"].get("name") != "MienStatus"]
    for function in functions:
        name = function["name"]
        if function["returns"].get("name") != "MienStatus":
            continue
        if name not in bodies:
            yield f"{name}: this check does not find its definition in capi/"
            continue
        text = reachable(name, bodies, set(without_status))
        written = {s for s in LITERAL.findall(text) if (name, s) not in NEVER}
        told = {status["name"]: status["general"] for status in function["statuses"]}
        for status in sorted(written - set(told)):
            yield f"{name} returns {status}, its comment does not say when"
        for status, general in told.items():
            if status not in written and not general and not PASSED_ON.search(text):
                yield f"{name} does not return {status}, which its comment names"
            if status not in written and general and status != "MIEN_ERROR_MEMORY":
                yield f"{name} does not return {status}, which follows from its parameters"


def self_test():
    bodies = functions_in('MienStatus check(int x) { return x ? MIEN_OK : MIEN_ERROR_INDEX; }\n'
                          'MienStatus mien_a(int x) {\n  // MIEN_ERROR_NAME\n'
                          '  if (x) { return check(x); }\n  return MIEN_ERROR_LOD;\n}\n')

    def found(*statuses):
        said = [{"name": f"MIEN_ERROR_{status}", "general": False} for status in statuses]
        return list(problems_of([{"name": "mien_a", "returns": {"name": "MienStatus"},
                                  "statuses": said}], bodies))

    assert found("INDEX", "LOD") == []
    assert found("INDEX") == ["mien_a returns MIEN_ERROR_LOD, its comment does not say when"]
    assert found("LOD") == ["mien_a returns MIEN_ERROR_INDEX, its comment does not say when"]
    assert found("INDEX", "LOD", "NAME") == [
        "mien_a does not return MIEN_ERROR_NAME, which its comment names"]


def main():
    if sys.argv[1:] == ["--self-test"]:
        self_test()
    api = json.loads((HERE / "mien_api.json").read_text(encoding="utf-8"))
    bodies = {}
    for file in (file for folder in (ROOT / "capi", ROOT / "capi" / "arguments", ROOT / "author" / "capi", ROOT / "solve")
                 for pattern in ("*.cpp", "*.h") for file in sorted(folder.glob(pattern))):
        for name, body in functions_in(file.read_text(encoding="utf-8")).items():
            bodies[name] = bodies.get(name, "") + body
    problems = list(problems_of(api["functions"], bodies))
    print("\n".join(problems) if problems else
          f"{len(api['functions'])} functions return the statuses that their comments name")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Every function of mien.h is there for users of each language, beyond the generated declarations.

A function that a language does without, for good or for now, is named in WITHOUT with the reason.
Usage: check_bindings.py
"""
import json
import re
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
INTEGRATIONS = HERE.parent

# Where users' calls come from, by language; what is generated is not counted.
SOURCES = {
    "C++": ["cpp/*.hpp"],
    "Python": ["python/mien/[a-z]*.py", "python/mien/_[!a]*.py"],
    "Rust": ["rust/mien/src/**/*.rs"],
}

WITHOUT = {
    # "mien_noun_verb": {"Rust": "why not"},
}


def without_comments(text, suffix):
    if suffix == ".py":
        return re.sub(r'""".*?"""|#[^\n]*', "", text, flags=re.DOTALL)
    return re.sub(r"/\*.*?\*/|//[^\n]*", "", text, flags=re.DOTALL)


def main():
    api = json.loads((HERE / "mien_api.json").read_text(encoding="utf-8"))
    functions = [function["name"] for function in api["functions"]]
    problems, languages = [], []
    for language, patterns in SOURCES.items():
        files = sorted({file for pattern in patterns for file in INTEGRATIONS.glob(pattern)})
        if not files:
            print(f"NOT TESTED: there is no binding for {language}")
            continue
        languages.append(language)
        text = "\n".join(without_comments(file.read_text(encoding="utf-8"), file.suffix)
                         for file in files)
        used = set(re.findall(r"\bmien_\w+\b", text))
        for name in functions:
            # A function that takes text, and its sibling that takes a length: one of them will do.
            sibling = name[:-2] if name.endswith("_n") else name + "_n"
            if sibling in functions and sibling in used:
                continue
            excused = language in WITHOUT.get(name, {})
            if name not in used and not excused:
                problems.append(f"{language} has no binding of {name}")
            if name in used and excused:
                problems.append(f"{language} has a binding of {name}, though WITHOUT says not")
    problems += [f"WITHOUT names {name}, which mien.h does not declare"
                 for name in WITHOUT if name not in functions]
    print("\n".join(problems) if problems else
          f"{len(functions)} functions, each in {', '.join(languages)}")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())

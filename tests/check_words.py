#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""One word for one thing: American spelling, and the terms of the glossary in docs/architecture.md.

Prints FILE:LINE: WORD -> REPLACEMENT for each word that is not.

Usage: check_words.py [--self-test] [PROJECT_DIRECTORY]
"""
import fnmatch
import re
import shutil
import subprocess
import sys
from pathlib import Path

# This file holds the words; the others are not ours, not text or made from headers.
SKIPPED = ["tests/check_words.py", "integrations/api/mien_api.json", "LICENSE", "*.lock", "*package-lock.json",
           "*.dna", "*.bin", "*.png", "*.jpg", "*.svg", "bench/results/*"]

WORD = re.compile(r"[A-Z]?[a-z]+")

# Whole words in lower case, the replacement, an example. Identifiers are split into their words.
SPELLING = [
    (r"behaviour\w*", "behavior", "behaviours"),
    (r"colour\w*", "color", "colour"),
    (r"(?:neighbour|flavour|favour|honour)\w*", "neighbor, flavor, favor, honor", "neighbours"),
    (r"licences?", "license", "licence"),
    (r"(?:initial|normal|optim|organ|recogn|serial|real|util|minim|maxim|quant|synchron|triangul|emphas|"
     r"summar|parametr|vector|general|special|custom|final|visual|linear|synthes|categor|priorit|standard|"
     r"author|penal)is(?:e|es|ed|ing|er|ers|ation|ations)", "-ize, -ization", "parametrisation"),
    (r"analys(?:e|ed|ing)", "analyze", "analyse"),
    (r"centres?|centred", "center", "centre"),
    (r"(?:centi|milli)?metres?", "meter", "centimetres"),
    (r"grey(?:s|ed|ish)?", "gray", "grey"),
    (r"(?:cancel|label|travel|model|signal|unlabel)l(?:ed|ing|er)", "one l: canceled, labeled, modeling", "cancelled"),
    (r"programmes?|defence|artefacts?|whilst|catalogues?|judgement",
     "program, defense, artifact, while, catalog, judgment", "whilst"),
]

# Where, a pattern, the term of the glossary, an example.
EVERYWHERE = ["*"]
FOR_USERS = ["*.md", "capi/include/*.h", "capi/debian/*", "dev", "examples/*", "integrations/program/[!t]*.cpp",
             "integrations/cpp/*.hpp", "integrations/python/mien/*.py", "integrations/rust/*/src/*.rs"]
GLOSSARY = [
    (EVERYWHERE, r"[Jj]oint[ _]outputs?|JointOutputs?", "joint values", "mien_instance_joint_outputs"),
    (FOR_USERS, r"\bjoint rows?\b", "joint values", "the joint rows of a LOD"),
    (FOR_USERS, r"\b[Bb]lendshapes?\b(?![\"'-])", "blend shape", "drives blendshapes"),
    (EVERYWHERE, r"\b[Cc]rowds?\b", "instance packet, many instances, batch", "a crowd of characters"),
    (FOR_USERS, r"(?<!machine-)(?<!Machine-)\b[Ll]earned behavior\b", "machine-learned behavior",
     "learned behavior"),
]


def matches(path, patterns):
    return any(fnmatch.fnmatchcase(path, pattern) for pattern in patterns)


# Names of other interfaces, in their own spelling.
FOREIGN = ("MonoBehaviour",)


def find_words(path, text):
    """Problems of one file, in the order of its lines."""
    found = []
    for name in FOREIGN:
        text = text.replace(name, "_" * len(name))

    def add(match, new):
        found.append((text.count("\n", 0, match.start()) + 1, match.group(0), new))

    wrong = {}
    for word in set(WORD.findall(text)):
        for pattern, new, _ in SPELLING:
            if re.fullmatch(pattern, word.lower()):
                wrong[word] = new
    if wrong:
        for match in WORD.finditer(text):
            if match.group(0) in wrong:
                add(match, wrong[match.group(0)])
    for places, pattern, new, _ in GLOSSARY:
        if matches(path, places):
            for match in re.finditer(pattern, text):
                add(match, new)
    return [f"{path}:{number}: {word} -> {new}" for number, word, new in sorted(found)]


def project_files(root):
    """Tracked files, or all outside of build/ where there is no Git."""
    if shutil.which("git"):
        done = subprocess.run(["git", "-C", str(root), "ls-files", "-co", "--exclude-standard"],
                              capture_output=True, text=True)
        if done.returncode == 0:
            return [path for path in done.stdout.splitlines() if (root / path).is_file()]
    return [file.relative_to(root).as_posix() for file in sorted(root.rglob("*"))
            if file.is_file() and not {"build", ".git"} & set(file.relative_to(root).parts)]


def self_test():
    """Every rule finds its example, in its places only; good text passes."""
    for pattern, new, example in SPELLING:
        assert re.fullmatch(pattern, example), f"{pattern} does not find: {example}"
        assert find_words("a.cpp", f"x\nint {example}_count;") == [f"a.cpp:2: {example} -> {new}"]
        assert find_words("a.cpp", new) == [], f"{pattern} finds its replacement: {new}"
    for places, pattern, new, example in GLOSSARY:
        assert len(find_words("README.md", example)) == 1, f"{pattern} does not find: {example}"
        assert find_words("README.md", new) == [], f"{pattern} finds its replacement: {new}"
        assert len(find_words("simd/a.inl", example)) == (places is EVERYWHERE), example
    assert find_words("a.cpp", "normaliseColour(); Centre") == [
        "a.cpp:1: Centre -> center", "a.cpp:1: Colour -> color", "a.cpp:1: normalise -> -ize, -ization"]
    assert find_words("a.cs", "class Face : MonoBehaviour") == []
    assert find_words("a.cpp", "The noise of a promise rises, otherwise piecewise; lo_message_deserialise") == []


def main():
    arguments = sys.argv[1:]
    if "--self-test" in arguments:
        arguments.remove("--self-test")
        self_test()
    root = Path(arguments[0] if arguments else Path(__file__).parent.parent).resolve()
    problems, count = [], 0
    for path in project_files(root):
        if matches(path, SKIPPED):
            continue
        try:
            text = (root / path).read_text(encoding="utf-8")
        except UnicodeDecodeError:
            continue
        count += 1
        problems += find_words(path, text)
    if count == 0:
        problems.append(f"{root}: no files found")
    print("\n".join(problems) if problems else f"{count} files, spelled as in the glossary")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())

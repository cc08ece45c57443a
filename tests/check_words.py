#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""One word for one thing. Finds words that the glossary of docs/architecture.md replaced.

Prints FILE:LINE: WORD -> REPLACEMENT for each. Words are looked for in up to three places:

    code    every source and document of the project: identifiers, comments, prose
    public  what users read: public headers, documents, help texts, documentation of the bindings
    layers  the library itself (runtime, simd, capi) and docs/: words that are right elsewhere

Usage: check_words.py [--self-test] [PROJECT_DIRECTORY]
"""
import fnmatch
import re
import shutil
import subprocess
import sys
from pathlib import Path

CODE, PUBLIC, LAYERS = "code", "public", "layers"

PLACES = {
    CODE: ["*"],
    PUBLIC: ["*.md", "capi/include/*.h", "capi/debian/*", "dev", "examples/*", "integrations/program/[!t]*.cpp",
             "integrations/cpp/*.hpp", "integrations/python/mien/*.py",
             "integrations/rust/*/src/*.rs"],
    LAYERS: ["author/*", "runtime/*", "simd/*", "capi/*", "docs/*", "README.md"],
}
# This file holds the words; the others are not ours, not text or made from headers.
SKIPPED = ["tests/check_words.py", "integrations/api/mien_api.json", "LICENSE", "*.lock", "*package-lock.json", "*.dna", "*.bin",
           "*.png", "*.svg", "bench/results/*"]

# Place, pattern, replacement, an example that must be found. Patterns know upper and lower case
# apart; words with capitals are identifiers.
RULES = [
    # Joints and their values
    (CODE, r"[Tt]urned[ _]joints?|TurnedJoint\w*", "quaternion joint", "a turned joint"),
    (CODE, r"[Jj]oint[ _]outputs?|JointOutputs?", "joint values", "mien_instance_joint_outputs"),
    (PUBLIC, r"\bjoint rows?\b", "joint values", "the joint rows of a LOD"),
    (PUBLIC, r"\bstill joints?\b", "joint without a delta", "a still joint"),
    # The joint matrix
    (LAYERS, r"\b[Cc]hunks? of (?:rows|the matrix|the joint matrix)|\b[Jj]ointChunk\w*|\b\w+_chunks\b",
     "row panel", "a chunk of rows"),
    (LAYERS, r"\bpieces? of (?:the|a) (?:matrix|column)\b|\bstored pieces?\b", "block",
     "the stored pieces"),
    # Names that changed
    (CODE, r"\bMienPose\b|\bmien_pose_(?:create|destroy)\b", "MienDeformerInstance",
     "MienPose* pose"),
    (CODE, r"\bvertex_positions\b(?=\s*(?:\[|indices))", "vertex_position_indices",
     "vertex_positions[i]"),
    (CODE, r"\bmost_[a-z]\w*|\bkMost[A-Z]\w*", "max_..., kMax...", "kMostLods"),
    (CODE, r"\bplaces?_of\b|\bplace_of_\w+", "sorted index", "place_of[i]"),
    (CODE, r"\bseen_(?:behind|[a-z]+_behind)\b|\bStagesBehind\w*", "previous_..., ...After...",
     "StagesBehindMl"),
    (CODE, r"\b(?!kLife\b)\w+Life\b", "exercise_...", "DnaLife"),
    (CODE, r"\bTogether[A-Z]\w*|\b(?!Lips)\w+Together\b(?!\))", "shared columns", "ColumnsTogether"),
    (CODE, r"\bDoBetter\d+", "a name that tells the behavior", "TEST(DoBetter7, Stays)"),
    # Several characters
    (CODE, r"\b[Cc]rowds?\b|\bthrongs?\b", "instance packet, many instances, batch",
     "a crowd of characters"),
    (PUBLIC, r"\b\d+ alike\b", "N instances, same active controls", "64 alike"),
    (PUBLIC, r"\b\d+ speaking\b", "N instances, 8 % active", "512 speaking"),
    # Baked files
    (CODE, r"\b[Rr]ig[ _]images?\b|\bRigImage\w*|\bmien_rig_(?:save|image)\w*",
     "baked file, bake, open", "RigImage"),
    (PUBLIC, r"\b(?:saved? (?:a|the) rigs?|rigs? (?:is|are|was) saved)\b", "bake, baked",
     "save the rig"),
    # Machine learning, correctives
    (PUBLIC, r"(?<!machine-)(?<!Machine-)\b[Ll]earned behavior\b", "machine-learned behavior",
     "learned behavior"),
    # The program
    # An option of `mien author` has the name.
    (PUBLIC, r"(?<!--)\b[Pp]ictures?\b", "image, render", "look at the pictures"),
    (CODE, r"\bsubjects?\.(?:h|cpp)\b|\blooks\.(?:h|cpp)\b|\bpictures\.(?:h|cpp)\b",
     "posed_scene, mesh_appearance, render_output", "looks.h"),
    (CODE, r"\bsystem_\w+\.(?:cpp|h)\b", "coordinate conversion", "system_axes.cpp"),

    # Words for people where the subject is code
    (PUBLIC, r"\b(?:[Ww]hoever|[Nn]obody|[Ss]omebody|[Ss]omeone|[Hh]imself)\b",
     "name the caller, the thread, the code", "whoever holds it"),
    (PUBLIC, r"\b(?:to be had|has the say|it takes to|wants? its place|hold us to|in its way)\b",
     "a plain sentence", "what is to be had"),
    (PUBLIC, r"\bwhich hand they are of|what cannot follow is refused", "a plain sentence",
     "which hand they are of follows"),
    (PUBLIC, r"\bfor ever\b", "forever, permanently", "kept for ever"),
    (PUBLIC, r"\bno more\b(?! than)", "no longer",
     "valid no more"),
    (PUBLIC, r"\b(?:incumbent|OpenRigLogic's own)\b", "a neutral statement", "the incumbent"),

    # American spelling
    (CODE, r"[Bb]ehaviour\w*", "behavior", "behaviour"),
    (CODE, r"[Cc]olour\w*", "color", "make_colours"),
    (CODE, r"\b[Ll]icences?\b", "license", "the licence"),
    (CODE, r"(?:[Nn]eighbour|[Ff]avour|[Hh]onour)\w*", "neighbor, favor, honor", "neighbours"),
    (CODE, r"(?<!lo_message_de)(?:[Ii]nitial|[Nn]ormal|[Oo]ptim|[Oo]rgan|[Rr]ecogn|[Ss]erial|[Rr]eal|[Uu]til|"
           r"[Mm]inim|[Mm]axim|[Qq]uant|[Ss]ynchron|[Tt]riangul|[Ee]mphas|[Ss]ummar|[Pp]arametr|"
           r"[Vv]ector|[Gg]eneral|[Ss]pecial|[Cc]ustom|[Ff]inal|[Vv]isual|[Ll]inear|[Ss]ynthes|"
           r"[Cc]ategor|[Pp]riorit|[Ss]tandard|[Aa]uthor|[Pp]enal)"
           r"is(?:e|es|ed|ing|er|ers|ation|ations)\b", "-ize, -ization", "parametrisation"),
    (CODE, r"\b[Aa]nalys(?:e|ed|ing)\b", "analyze", "analyse it"),
    (CODE, r"\b[Cc]entres?\b|\b[Cc]entred\b", "center", "the centre"),
    (CODE, r"\b(?:[Cc]enti|[Mm]illi)?metres?\b", "meter", "centimetres"),
    (CODE, r"\b[Gg]rey(?:s|ed|ish)?\b", "gray", "grey"),
    (CODE, r"\b(?:[Cc]ancel|[Ll]abel|[Tt]ravel|[Mm]odel|[Ss]ignal|[Uu]nlabel)l(?:ed|ing|er)\b",
     "one l: canceled, labeled, modeling", "cancelled"),
    (CODE, r"\b(?:[Pp]rogrammes?|[Dd]efence|[Aa]rtefacts?|[Ww]hilst|[Cc]atalogues?|[Jj]udgement)\b",
     "program, defense, artifact, while, catalog, judgment", "whilst"),
]
COMPILED = [(place, re.compile(pattern), new, example) for place, pattern, new, example in RULES]


def matches(path, patterns):
    return any(fnmatch.fnmatchcase(path, pattern) for pattern in patterns)


def rules_for(path):
    return [(pattern, new) for place, pattern, new, _ in COMPILED if matches(path, PLACES[place])]


def find_words(path, text):
    """Problems of one file, in the order of its lines."""
    found = []
    for pattern, new in rules_for(path):
        for match in pattern.finditer(text):
            found.append((text.count("\n", 0, match.start()) + 1, match.group(0), new))
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
    """Every rule finds its example, in each of its places only; good text passes."""
    for place, pattern, new, example in COMPILED:
        assert pattern.search(example), f"{pattern.pattern} does not find: {example}"
        assert not pattern.search(new), f"{pattern.pattern} finds its replacement: {new}"
    assert find_words("README.md", "one\nlook at the pictures\n") == [
        "README.md:2: pictures -> image, render"]
    assert find_words("runtime/eval/batch.cpp", "// a behaviour\n") == [
        "runtime/eval/batch.cpp:1: behaviour -> behavior"]
    # "tile" is an image of a sheet in the program, "chunk" a part of a GLB file.
    assert find_words("integrations/program/render.cpp", "tile, chunk") == []
    assert len(find_words("simd/kernels.h", "joint_chunks, turned joint")) == 2
    assert find_words("capi/include/mien.h", "No more than 8. The noise of a promise rises, otherwise "
                      "piecewise. Accumulator tile: an accumulator tile. vertex_positions") == []


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
    print("\n".join(problems) if problems else f"{count} files, no old words")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Includes follow the graph of directories below, which has no circle and no edge that nobody uses.

Every directory of the library with C or C++ files has to be named, so that none is forgotten.
Usage: check_layers.py [PROJECT_DIRECTORY]
"""
import re
import sys
from pathlib import Path

# What each directory may include, beyond itself. A directory that is not a key is an error. simd is for
# those that call kernels or have arrays in the layout that kernels read; each includes the headers of simd
# that it uses itself.
GRAPH = {
    "simd": [],
    "runtime/base": [],
    # The slim library: compiled data and what works on it. None of it knows DNA files or compilers.
    "runtime/rig": ["runtime/base", "simd"],
    "runtime/pose": ["runtime/base", "simd", "runtime/rig"],
    "runtime/eval": ["runtime/base", "simd", "runtime/rig"],
    "runtime/deform": ["runtime/base", "simd", "runtime/pose"],
    "runtime/derive": ["runtime/base", "simd", "runtime/eval", "runtime/pose", "runtime/deform"],
    "runtime/anim": ["runtime/base", "simd", "runtime/rig"],
    "runtime/mix": ["runtime/base", "simd", "runtime/rig", "runtime/anim"],
    "runtime/solve": ["runtime/base", "runtime/anim", "runtime/pose", "runtime/deform"],
    "runtime/probe": ["runtime/base", "runtime/eval", "runtime/anim", "runtime/mix", "runtime/deform"],
    "runtime/baked": ["runtime/base", "simd", "runtime/rig", "runtime/deform"],
    # What the full library adds. DNA files: what a file is; what is wrong with it; what becomes of it; all
    # of it in order. Then DNA -> compiled data.
    "runtime/load/dna/format": ["runtime/base"],
    "runtime/load/dna/check": ["runtime/base", "runtime/load/dna/format"],
    "runtime/load/dna/convert": ["runtime/base", "runtime/load/dna/format"],
    "runtime/load/dna": ["runtime/base", "runtime/load/dna/format", "runtime/load/dna/check",
                         "runtime/load/dna/convert"],
    "runtime/load/compile": ["runtime/base", "simd", "runtime/load/dna/format", "runtime/rig",
                             "runtime/deform"],
    "runtime/load/report": ["runtime/base", "runtime/load/dna", "runtime/load/compile"],
    # libmien-author makes DNA files: generated ones, and from a mesh to a rig. What its stages hand to
    # each other; bones; weights; motion; the file; reports as text.
    "author/text": [],
    "author/base": ["runtime/base", "runtime/load/dna/format"],
    "author/generate/head": ["runtime/base", "runtime/load/dna/format", "author/base", "author/mesh"],
    "author/generate/synthetic": ["runtime/base", "runtime/load/dna/format", "author/base"],
    "author/mesh": ["runtime/base", "author/base"],
    "author/place": ["runtime/base", "author/base", "author/mesh"],
    "author/weights": ["runtime/base", "author/base", "author/mesh", "author/place"],
    "author/fit": ["runtime/base", "author/base", "author/mesh", "author/weights"],
    "author/rig_dna": ["runtime/load/dna/format", "author/base", "author/mesh", "author/fit"],
    # A file that is changed.
    "author/document": ["runtime/base", "runtime/load/dna/format", "runtime/load/dna/check",
                        "runtime/load/dna/convert", "runtime/load/dna", "author/base", "author/mesh",
                        "author/fit"],
    "author/rigging": ["runtime/base", "author/base", "author/mesh", "author/place", "author/weights", "author/fit",
                       "author/rig_dna", "author/text"],
    # The C interface: the headers; what both libraries read their arguments with; each of them. capi looks
    # up the instruction set that a caller asks for: its simd.
    "capi/include": ["capi/include/mien", "capi/include/mien_author"],
    "capi/include/mien": [],
    "capi/include/mien_author": [],
    "capi/arguments": ["runtime/base", "runtime/load/dna/format", "capi/include"],
    "author/capi": ["capi/include", "capi/arguments", "runtime/base", "runtime/load/dna/format", "author/rigging",
                    "author/generate/head", "author/generate/synthetic", "author/document"],
    # libmien-solve stands on the headers, as programs do, and on what libraries read their arguments with.
    "solve": ["capi/include", "capi/arguments", "runtime/base"],
    "capi": ["capi/arguments", "runtime/base", "simd", "runtime/eval", "runtime/anim", "runtime/mix",
             "runtime/solve", "runtime/deform", "runtime/derive", "runtime/probe", "runtime/baked", "runtime/load/dna/format",
             "runtime/load/dna/check", "runtime/load/dna", "runtime/load/compile", "runtime/load/report"],
}
PUBLIC_HEADERS = ("capi/include/mien.h", "capi/include/mien_author.h", "capi/include/mien_solve.h")

# The rooms of the program: the same, and no room sees the libraries but through their headers. author/text is headers
# that need the standard library only.
PROGRAM = "integrations/program"
PROGRAM_GRAPH = {
    "math": [],
    "render": ["math"],                           # meshes -> images: knows nothing of rigs
    "io": ["mien.h", "math", "author/text"],      # files, frames, JSON, output
    "gltf": ["mien.h", "math", "io"],             # rigs -> GLB, OBJ
    "model": [],                                  # a rig in double precision, from the formulas alone
    "accept": ["mien.h", "math", "io", "model"],  # the checks of `mien accept`
    "scene": ["mien.h", "math", "io", "render"],  # a rig in a pose
    "live": ["mien.h", "io", "gltf"],  # packets of live sources -> rows of controls
    "mesh": ["mien.h", "io"],          # meshes and shapes from files, for `mien author`
    "diff": ["mien.h", "io"],          # what differs between two DNA files
    "edit": ["mien.h", "mien_author.h", "io", "mesh"],  # DNA files that are changed
    "reduce": ["mien.h", "mien_author.h", "io"],        # rigs within a tolerance of others
    "speech": ["mien.h", "io", "gltf"],          # text, sound and phonemes -> takes
    "play": ["mien.h", "io", "gltf", "speech"],  # scenes of `mien play`
    "baseline": [],                    # the sparse matrix that `mien bench` compares with
    "tests": ["mien.h", "mien_author.h", "io", "live"],
    "tests/gltf": ["gltf"],
    "tests/reduce": ["mien.h", "mien_author.h", "io", "reduce"],
    "tests/render": ["render"],
    "tests/speech": ["mien.h", "mien_author.h", "io", "speech"],
    "view": ["io"],                    # the page of the viewer, served on this machine
    "commands": ["mien.h", "mien_author.h", "mien_solve.h", "accept", "math", "io", "render", "gltf", "scene", "mesh", "play", "live",
                 "speech", "view", "edit", "diff", "reduce", "baseline"],
    "": ["mien.h", "mien_author.h", "io", "reduce", "commands"],  # main.cpp, without_author.cpp
}

# Everything else outside sees the public headers and its own files. Tests and benchmarks see
# everything.
OUTSIDE = "integrations"

SUFFIXES = {".h", ".hpp", ".cpp", ".c", ".inl"}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
# An inline function of a C++ header, compiled for AVX2, may be the copy that the linker keeps for
# CPUs without. C headers have none; <utility> is for index_sequence, a type.
KERNEL_HEADERS = re.compile(r"(std\w+|string|math|float|assert|limits|arm_neon|immintrin|wasm_simd128)\.h|utility")


def layer_of(path):
    """Layer of a path relative to the project, or None."""
    directory = path.rsplit("/", 1)[0]
    return directory if directory in GRAPH else None


def includes(file):
    """(line number, quoted, path) of every include of a file."""
    for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
        match = INCLUDE.match(line)
        if match:
            yield number, match.group(1) == '"', match.group(2)


def resolve(root, file, target):
    """An include path as a path relative to the project, or None if it is not of the project."""
    for directory in (root, file.parent, root / "capi" / "include"):
        found = directory / target
        if found.is_file():
            return found.resolve().relative_to(root).as_posix()
    return None


def is_kernel(path):
    """Files compiled for one instruction set."""
    name = path.rsplit("/", 1)[-1]
    return path.startswith("simd/") and (name.endswith(".inl") or name.startswith("kernels_"))


def is_in_kernels(path):
    """The same, and the headers that they include."""
    return is_kernel(path) or (path.startswith("simd/") and path.endswith(".h"))


def program_room(path):
    """The room of a file of the program, or None."""
    if not path.startswith(PROGRAM + "/"):
        return None
    return path[len(PROGRAM) + 1:].rpartition("/")[0]


def check_program_include(path, resolved):
    """Why a file of the program may not include this one, or None."""
    own, other = program_room(path), program_room(resolved)
    if own not in PROGRAM_GRAPH:
        return "a room that this check does not know"
    if other is None:
        other = resolved[len("capi/include/"):] if resolved in PUBLIC_HEADERS else layer_of(resolved) or resolved
    if other == own or other in PROGRAM_GRAPH[own]:
        return None
    return f"{own or 'main'} knows nothing of {other}: see PROGRAM_GRAPH"


def check_include(path, quoted, target, resolved):
    """Why a file may not include this, or None."""
    if resolved is None:
        # Those of an engine are found in its own folders.
        if quoted and not is_kernel(path) and not path.startswith("integrations/unreal/"):
            return "there is no such file in the project"
        if is_in_kernels(path) and not (target.startswith("xsimd") or KERNEL_HEADERS.fullmatch(target)):
            return "kernel files and headers of simd include C headers and xsimd only"
        if path.startswith("simd/") and not is_kernel(path) and target.startswith("xsimd"):
            return "only kernel files include xsimd"
        if path.startswith(("author/", "runtime/", "solve/", "capi/")) and target.startswith("xsimd"):
            return "only kernel files include xsimd"
        return None

    own = layer_of(path)
    if own is None and path.startswith(PROGRAM + "/"):
        return check_program_include(path, resolved)
    if own is None:
        own_directory = "/".join(path.split("/")[:2]) + "/"
        if resolved not in PUBLIC_HEADERS and not resolved.startswith(own_directory):
            return "integrations include the public headers and their own files only"
        return None

    other = layer_of(resolved)
    if other is None:
        return "the library includes nothing from outside of it"
    if other == own:
        if is_kernel(resolved) and not is_kernel(path):
            return "only kernel files include kernel bodies"
        return None
    if own == "simd":
        return "simd knows nothing of the rest"
    if other == "simd" and (is_kernel(resolved) or not resolved.endswith(".h")):
        return "outside simd, its headers are all there is"
    if other not in GRAPH[own]:
        return f"{own} knows nothing of {other}: see GRAPH"
    return None


def find_circles():
    """Problems of the graph itself: each directory may only see those above it in GRAPH or others
    that do not lead back."""
    def reaches(graph, start, goal, seen):
        for other in graph.get(start, ()):
            if other == goal or (other not in seen and reaches(graph, other, goal, seen | {other})):
                return True
        return False
    return [f"GRAPH: {name or 'main'} includes itself through others"
            for graph in (GRAPH, PROGRAM_GRAPH) for name in graph
            if reaches(graph, name, name, set())]


def sources(root):
    for area in ("author", "runtime", "simd", "solve", "capi", OUTSIDE):
        for file in sorted((root / area).rglob("*")):
            if file.suffix in SUFFIXES and file.is_file():
                yield file


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent).resolve()
    problems = find_circles()
    unused = {(own, other) for own in GRAPH for other in GRAPH[own]}
    count = 0
    for file in sources(root):
        path = file.relative_to(root).as_posix()
        count += 1
        if path.startswith(("author/", "runtime/")) and layer_of(path) is None:
            problems.append(f"{path}: a directory that this check does not know")
            continue
        for number, quoted, target in includes(file):
            resolved = resolve(root, file, target)
            unused.discard((layer_of(path), layer_of(resolved) if resolved else None))
            reason = check_include(path, quoted, target, resolved)
            if reason:
                problems.append(f"{path}:{number}: includes {target}: {reason}")
    problems += [f"GRAPH: no file of {own} includes one of {other}" for own, other in sorted(unused)]
    if count == 0:
        problems.append(f"{root}: no sources found")
    print("\n".join(problems) if problems else f"{count} files, includes in order")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())

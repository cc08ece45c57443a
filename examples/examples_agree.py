#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The examples of all languages do the same job: they have to print the same.

Usage: examples_agree.py --python INTERPRETER --cargo CARGO_OR_NOTHING --luajit LUAJIT_OR_NOTHING
                         --mcs MCS_OR_NOTHING --mono MONO_OR_NOTHING --go GO_OR_NOTHING
                         --programs DIRECTORY [--web PACKAGE_OR_NOTHING]
The programs in C and C++ are DIRECTORY/example_c, _cpp, _mix_c, _mix_cpp and _solve_cpp.
The library is found by the environment: MIEN_LIBRARY (Python, Lua), MIEN_LIB_DIR (Rust),
LD_LIBRARY_PATH (C#, Go), CGO_CFLAGS and CGO_LDFLAGS (Go). PACKAGE is the npm package that `./dev web build` makes.
"""
import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent


def run(command, arguments):
    """(whether it succeeded, what it printed)"""
    result = subprocess.run(command + arguments, capture_output=True, text=True)
    if result.returncode not in (0, 1):
        sys.exit(f"{command} ended with {result.returncode}\n{result.stderr}")
    if not arguments and result.returncode:
        sys.exit(f"{command} failed\n{result.stderr}")
    return result.returncode == 0, result.stdout


def near(one, other):
    """Whether all numbers of two texts differ by at most one unit of the last digit that is printed."""
    words, others = one.split(), other.split()
    return len(words) == len(others) and all(
        a == b or ("." in a and "." in b and len(a) == len(b)
                   and abs(float(a) - float(b)) < 1.5 * 10.0 ** -len(a.split(".")[1]))
        for a, b in zip(words, others))


def mixes_differ(programs):
    """Whether they say something else while the head speaks, smiles and is dazzled."""
    printed = {name: run(command, [])[1] for name, command in programs.items()}
    print(printed["C"], end="")
    rows = [line.split() for line in printed["C"].splitlines()]
    column = {name: rows[0].index(name) + 1 for name in ("jaw", "smile", "lids", "squint")}
    of = {int(row[0]): {name: float(row[at]) for name, at in column.items()} for row in rows}
    # Lips close for the m although joy opens the jaw by 0.16; lids close for the flashlight alone.
    if not (of[60]["jaw"] < 0.02 and of[50]["jaw"] > 0.5 and of[60]["smile"] == 0.72
            and of[90]["lids"] == 0 and of[100]["lids"] == 1 and of[150]["squint"] == 0):
        sys.exit("the mix does not do what its comments say")
    # A rig is compiled with the mathematical functions of WebAssembly's library, so what guards measure may differ by a
    # step of rounding.
    if near(printed.get("JavaScript", printed["C"]), printed["C"]):
        printed.pop("JavaScript", None)
    return len(set(printed.values())) != 1


def solves_differ(programs):
    """Whether they find other controls than those that the head was posed with."""
    printed = {name: run(command, [])[1] for name, command in programs.items()}
    print(printed["C++"], end="")
    found = dict(line.split() for line in printed["C++"].splitlines()[1:])
    if found != {"jawOpen": "0.40", "mouthSmileLeft": "0.70", "browInnerUp": "0.50"}:
        sys.exit("the solve does not find the controls of the pose")
    return len(set(printed.values())) != 1


def csharp(mcs, mono, name, directory):
    """The command of an example in C#, which is compiled to `directory`."""
    sources = sorted((HERE.parent / "integrations" / "csharp" / "Mien").glob("*.cs"))
    program = directory / f"{name}.exe"
    subprocess.run([mcs, "-unsafe", "-langversion:latest", f"-out:{program}", *sources, HERE / f"{name}.cs"], check=True)
    return [mono, program]


def golang(go, name, directory):
    """The command of an example in Go, which is compiled to `directory`."""
    subprocess.run([go, "build", "-o", directory / f"{name}_go", HERE / f"{name}.go"],
                   cwd=HERE.parent / "integrations" / "go", check=True)
    return [directory / f"{name}_go"]


def javascript(package, directory):
    """The folder of the examples in JavaScript, from where they find the package by its name."""
    (directory / "node_modules").mkdir()
    (directory / "node_modules" / "mien").symlink_to(package.resolve(), target_is_directory=True)
    for name in ("evaluate.mjs", "mix.mjs"):
        shutil.copy(HERE / name, directory)
    return directory


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--programs", type=Path, required=True)
    parser.add_argument("--python", default=sys.executable)
    parser.add_argument("--cargo", default="")
    parser.add_argument("--luajit", default="")
    parser.add_argument("--go", default="")
    parser.add_argument("--mcs", default="")
    parser.add_argument("--mono", default="")
    parser.add_argument("--web", default="")
    args = parser.parse_args()

    programs = {"C": ["example_c"], "C++": ["example_cpp"]}
    mixing = {"C": ["example_mix_c"], "C++": ["example_mix_cpp"]}
    solving = {"C++": ["example_solve_cpp"]}
    for commands in (programs, mixing, solving):
        commands.update({name: [args.programs / command[0]] for name, command in commands.items()})
    if subprocess.run([args.python, "-c", "import numpy"], stderr=subprocess.DEVNULL).returncode:
        print(f"NOT TESTED: the example in Python; {args.python} has no NumPy")
    else:
        programs["Python"] = [args.python, HERE / "evaluate.py"]
        mixing["Python"] = [args.python, HERE / "mix.py"]
    manifest = HERE.parent / "integrations" / "rust" / "mien" / "Cargo.toml"
    if not args.cargo or not manifest.exists():
        print("NOT TESTED: the example in Rust; there is no " + ("crate" if args.cargo else "cargo"))
    else:
        cargo = [args.cargo, "run", "--quiet", "--offline", "--manifest-path", manifest, "--example"]
        programs["Rust"] = cargo + ["evaluate", "--"]
        mixing["Rust"] = cargo + ["mix"]
        solving["Rust"] = cargo + ["solve"]
    if not args.luajit:
        print("NOT TESTED: the example in Lua; there is no luajit")
    else:
        os.environ["LUA_PATH"] = f"{HERE.parent / 'integrations' / 'lua'}/?.lua"
        programs["Lua"] = [args.luajit, HERE / "evaluate.lua"]
        mixing["Lua"] = [args.luajit, HERE / "mix.lua"]

    compiled = tempfile.TemporaryDirectory()
    if not args.mcs or not args.mono:
        print("NOT TESTED: the example in C#; there is no mcs and mono")
    else:
        programs["C#"] = csharp(args.mcs, args.mono, "evaluate", Path(compiled.name))
        mixing["C#"] = csharp(args.mcs, args.mono, "mix", Path(compiled.name))
    if not args.go:
        print("NOT TESTED: the example in Go; there is no go")
    else:
        programs["Go"] = golang(args.go, "evaluate", Path(compiled.name))
        mixing["Go"] = golang(args.go, "mix", Path(compiled.name))
    node = shutil.which("node")
    if not args.web or not node:
        print("NOT TESTED: the example in JavaScript; " +
              ("there is no node" if args.web else
               "here there is no npm package: './dev test --all' makes it and runs this again with --web"))
    else:
        folder = javascript(Path(args.web), Path(compiled.name))
        programs["JavaScript"] = [node, folder / "evaluate.mjs"]
        mixing["JavaScript"] = [node, folder / "mix.mjs"]
        os.environ["MIEN_ISA"] = "scalar"  # the bits of WebAssembly

    readme = (HERE.parent / "README.md").read_text(encoding="utf-8")
    if readme.split("```c\n")[1].split("```")[0] not in (HERE / "evaluate.c").read_text(encoding="utf-8"):
        sys.exit("the example of README.md is not from evaluate.c")
    failures = mixes_differ(mixing) + solves_differ(solving)
    with tempfile.TemporaryDirectory() as directory:
        broken = Path(directory) / "broken.dna"
        broken.write_bytes(b"DNA, but not for long")
        written = Path(directory) / "head.dna"
        subprocess.run([args.python, "-c", "import mien, sys; "
                        f"mien.Dna.generate(mien.Preset.MEDIUM, 5).save({str(written)!r})"], check=True)
        head = Path(directory) / "person.dna"
        subprocess.run([args.python, "-c", "import mien; "
                        f"mien.Dna.generate(mien.Preset.HEAD).save({str(head)!r})"], check=True)
        for arguments in ([], [head], [head, "mouthSmileLeft"], [written], [written, "CTRL_expressions.jawOpen"],
                          [written, "missing"], [broken]):
            results = {name: run(command, [str(argument) for argument in arguments])
                       for name, command in programs.items()}
            for name, (succeeded, text) in results.items():
                print(f"{name:<11}{text.strip() if succeeded else 'fails'}")
            failures += len(set(results.values())) != 1
            if results["C"][0] == (arguments[-1:] in (["missing"], [broken])):
                sys.exit(f"C with {arguments}: {results['C']}")
    if failures:
        sys.exit(f"they differ in {failures} cases")
    print(f"{', '.join(programs)} agree")


if __name__ == "__main__":
    main()

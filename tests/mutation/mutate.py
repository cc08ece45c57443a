#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Plants faults, one at a time, into what reads, checks and converts files, and tells which of them no test
notices.

    mutate.py BUILD [--count N] [--first K] [--seed S]    faults K ... K + N - 1 of the shuffled list
    mutate.py BUILD --show NUMBER                         one fault as a difference

BUILD is a build with its tests. Neither it nor the sources are changed: a changed source is compiled aside
and linked in front of what it replaces. Faults: comparisons, logic, sums, numbers, and checks that are left
out. Some change nothing that anybody could see; the others ask for a test.
"""
import argparse
import os
import pathlib
import random
import re
import shlex
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = ["runtime/dna", "runtime/rig"]
# In the order in which they find most in the shortest time.
TESTS = ["dna_tests", "compile_tests", "baked_tests", "capi_tests", "eval_tests"]
# What else the machine does must not count as noticing.
TIMED = "--gtest_filter=-*Fast*"
SWAPS = {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "==", "&&": "||", "||": "&&",
         "+": "-", "-": "+", "+=": "-=", "true": "false", "false": "true"}
OPERATOR = re.compile(r"(?<= )(<=|>=|==|!=|&&|\|\||\+=|<|>|\+|-)(?= )|\b(true|false)\b")
NUMBER = re.compile(r"(?<![\w.])(\d+)(?![\w.])")
CHECK = re.compile(r"^\s*if \(.*\) (return\b.*|continue|break);$")


def code_of(line):
    """The line without what stands in strings and comments, in its columns."""
    line = re.sub(r'"(\\.|[^"\\])*"', lambda m: '"' + " " * (len(m[0]) - 2) + '"', line)
    return re.sub(r"//.*", lambda m: " " * len(m[0]), line)


def faults():
    """(file, line number, new line, kind), all there are."""
    found = []
    paths = sorted(p for folder in FOLDERS for p in (ROOT / folder).rglob("*.cpp"))
    for path in paths:
        for number, line in enumerate(path.read_text().splitlines()):
            code = code_of(line)
            if re.match(r"\s*(#|template|using|static_assert|namespace)", code):
                continue
            for match in OPERATOR.finditer(code):
                new = line[: match.start()] + SWAPS[match[0]] + line[match.end():]
                found.append((path, number, new, f"{match[0]} -> {SWAPS[match[0]]}"))
            for match in NUMBER.finditer(code):
                new = line[: match.start()] + str(int(match[0]) + 1) + line[match.end():]
                found.append((path, number, new, f"{match[0]} -> {int(match[0]) + 1}"))
            if CHECK.match(code):
                found.append((path, number, "", "no check"))
    return found


def command_of(build, target):
    commands = subprocess.run(["ninja", "-C", build, "-t", "commands", target], check=True,
                              stdout=subprocess.PIPE, text=True).stdout.splitlines()
    return commands[-1]


def object_of(build, path):
    listed = subprocess.run(["ninja", "-C", build, "-t", "targets", "all"], check=True,
                            stdout=subprocess.PIPE, text=True).stdout
    name = str(path.relative_to(ROOT / "runtime"))
    match = re.search(rf"^(runtime/\S*{re.escape(name)}\.o):", listed, re.MULTILINE)
    return match and match[1]


def compile_fault(build, folder, path, number, new):
    """The object of the changed source, or None: some faults do not compile."""
    target = object_of(build, path)
    if not target:
        return None
    lines = path.read_text().splitlines()
    lines[number] = new
    # Beside the original for the sake of relative includes there are none: all begin at the root.
    source = folder / "mutant.cpp"
    source.write_text("\n".join(lines) + "\n")
    words = shlex.split(command_of(build, target))
    if os.path.basename(words[0]) == "ccache":
        words = words[1:]
    out = folder / "mutant.o"
    words[words.index("-o") + 1] = str(out)
    words[words.index("-c") + 1] = str(source)
    if "-MF" in words:
        words[words.index("-MF") + 1] = str(folder / "mutant.d")
    words = [word for word in words if word != "-Werror"] + ["-w", "-O1"]
    done = subprocess.run(words, cwd=build, check=False, stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL)
    return out if done.returncode == 0 else None


def link(build, folder, test, mutant):
    command = command_of(build, f"tests/{test}").replace(": && ", "", 1)
    command = re.sub(r" && :$", "", command)
    words = shlex.split(command)
    at = words.index("-o")
    words[at + 1] = str(folder / test)
    words[at:at] = ["-Wl,--allow-multiple-definition", str(mutant)]
    subprocess.run(words, cwd=build, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return folder / test


def killer(build, folder, mutant, seconds):
    """The test that notices, or None."""
    environment = dict(os.environ, LLVM_PROFILE_FILE="/dev/null")
    for test in TESTS:
        if not (build / "tests" / test).exists():
            continue
        program = link(build, folder, test, mutant)
        try:
            result = subprocess.run([program, "--gtest_fail_fast", "--gtest_brief=1", TIMED], check=False,
                                    env=environment, timeout=seconds, cwd=folder,
                                    stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                    errors="replace")
        except subprocess.TimeoutExpired:
            return f"{test}, which does not end"
        finally:
            program.unlink()
        if result.returncode:
            failed = re.search(r"\[  FAILED  \] ([\w./]+)", result.stdout)
            return failed[1] if failed else f"{test} ends with {result.returncode}"
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=12)
    parser.add_argument("--seconds", type=int, default=900)
    parser.add_argument("--show", type=int)
    arguments = parser.parse_args()
    build = arguments.build.resolve()
    shuffled = faults()
    random.Random(arguments.seed).shuffle(shuffled)
    if arguments.show is not None:
        path, number, new, kind = shuffled[arguments.show]
        print(f"{path.relative_to(ROOT)}:{number + 1} {kind}")
        print("-", path.read_text().splitlines()[number])
        print("+", new)
        return 0
    planted = survived = 0
    for i, (path, number, new, kind) in enumerate(shuffled):
        if i < arguments.first or planted == arguments.count:
            continue
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            mutant = compile_fault(build, folder, path, number, new)
            if not mutant:
                continue
            planted += 1
            noticed = killer(build, folder, mutant, arguments.seconds)
        survived += noticed is None
        print(f"{i} {path.relative_to(ROOT)}:{number + 1} {kind}: {noticed or 'SURVIVED: ' + new.strip()}",
              flush=True)
    print(f"{planted} faults, {planted - survived} noticed, {survived} survived")
    return 0


if __name__ == "__main__":
    sys.exit(main())

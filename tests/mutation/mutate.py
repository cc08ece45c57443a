#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Plants faults, one at a time, into what reads, checks and converts files, and tells which of them no test
notices.

    mutate.py BUILD [--count N] [--first K] [--seed S]    N faults of the shuffled list, from K on
    mutate.py BUILD --plant PLACE FAULT                   one, such as dna/dna_reader.cpp:557 "0 -> 1"
    mutate.py BUILD --show NUMBER                         one fault as a difference

BUILD is a build with its tests. Neither it nor the sources are changed: a changed source is compiled aside
and linked in front of what it replaces. Faults: comparisons, logic, sums, numbers, and checks that are left
out. Some change nothing that anybody could see; the others ask for a test. The slow tests, of damage byte
by byte and of generated rigs, run with --slow only. survivors.md tells what came of it.
"""
import argparse
import os
import pathlib
import random
import re
import resource
import shlex
import signal
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = ["runtime/dna", "runtime/rig"]
# In the order in which they find most in the shortest time.
TESTS = ["dna_tests", "compile_tests", "eval_tests", "baked_tests", "capi_tests"]
SLOW = ("*EveryByteOf*:*SomeBytesOf*:*AnyChange*:FiniteInputs.*:LodSelection*.*Generated*:HostileFilesMemory.*:"
        "BakedRig.NetworksBodies*:BakedDeformer.HeadsAnd*:MixProbes.*:CapiClip.*:OutOfMemory.*:ReportTest.*")
CPU_SECONDS = 60
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
    words = [word for word in words if word != "-Werror"] + ["-w", "-O0"]
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


def limit():
    # Time of the processor: what else the machine does must not count as noticing.
    resource.setrlimit(resource.RLIMIT_CPU, (CPU_SECONDS, CPU_SECONDS))


def killer(build, folder, mutant, slow):
    """The test that notices, or None."""
    environment = dict(os.environ, LLVM_PROFILE_FILE="/dev/null")
    for chosen in [f"-{SLOW}", SLOW][: 1 + slow]:
        for test in TESTS:
            program = folder / test
            if not program.exists():
                link(build, folder, test, mutant)
            result = subprocess.run([program, "--gtest_fail_fast", "--gtest_brief=1",
                                     f"--gtest_filter={chosen}"], check=False, env=environment, cwd=folder,
                                    preexec_fn=limit, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                    text=True, errors="replace")
            if result.returncode:
                failed = re.search(r"\[  FAILED  \] ([\w./]+)", result.stdout)
                if failed:
                    return failed[1]
                if -result.returncode in (signal.SIGXCPU, signal.SIGKILL):
                    return f"{test} does not end"
                return f"{test} ends with {result.returncode}"
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=12)
    parser.add_argument("--show", type=int)
    parser.add_argument("--plant", nargs=2, metavar=("PLACE", "FAULT"))
    parser.add_argument("--slow", action="store_true")
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
    if arguments.plant:
        place, wanted = arguments.plant
        shuffled = [fault for fault in shuffled
                    if f"{fault[0].relative_to(ROOT)}:{fault[1] + 1}".endswith(place) and fault[3] == wanted]
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
            noticed = killer(build, folder, mutant, arguments.slow)
        survived += noticed is None
        print(f"{i} {path.relative_to(ROOT)}:{number + 1} {kind}: {noticed or 'SURVIVED: ' + new.strip()}",
              flush=True)
    print(f"{planted} faults, {planted - survived} noticed, {survived} survived")
    return 0


if __name__ == "__main__":
    sys.exit(main())

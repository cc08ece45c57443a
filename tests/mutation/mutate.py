#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Changes the code that reads, checks and converts files, one small fault at a time, and lists the faults that no
test notices.

    mutate.py BUILD [--count N] [--first K] [--seed S]    N faults of the shuffled list, from K on
    mutate.py BUILD --headers [...]                       the same in headers, which takes longer
    mutate.py BUILD --plant PLACE FAULT                   one, such as dna/dna_reader.cpp:557 "0 -> 1"
    mutate.py BUILD --show NUMBER                         one fault as a difference

BUILD is a build with its tests. Neither it nor the sources are modified: a changed source, or each source that
includes a changed header, is compiled in a separate directory and linked ahead of the original. Faults: changed
comparisons, logic, sums and numbers, and removed checks. Some have no visible effect; the others need a test. The
slow tests (damage to every byte, generated rigs) only run with --slow. survivors.md has the results.
"""
import argparse
import concurrent.futures
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
FOLDERS = ["runtime/load/dna", "runtime/rig"]
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


def faults(kind):
    """(file, line number, new line, kind), all there are in files of this kind, cpp or h."""
    found = []
    paths = sorted(p for folder in FOLDERS for p in (ROOT / folder).rglob(f"*.{kind}"))
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


def objects_of(build, path):
    """Objects of the library: of this source, or of all that include this header."""
    if path.suffix == ".cpp":
        listed = subprocess.run(["ninja", "-C", build, "-t", "targets", "all"], check=True,
                                stdout=subprocess.PIPE, text=True).stdout
        name = str(path.relative_to(ROOT / "runtime"))
        return re.findall(rf"^(runtime/\S*{re.escape(name)}\.o):", listed, re.MULTILINE)
    listed = subprocess.run(["ninja", "-C", build, "-t", "deps"], check=True, stdout=subprocess.PIPE,
                            text=True).stdout
    name = str(path.relative_to(ROOT))
    return [entry.split(":")[0] for entry in listed.split("\n\n")
            if entry.startswith(("runtime/", "capi/")) and "author" not in entry.split(":")[0]
            and re.search(rf"/{re.escape(name)}$", entry, re.MULTILINE)]


def compile_one(build, folder, target, source, out):
    words = shlex.split(command_of(build, target))
    if os.path.basename(words[0]) == "ccache":
        words = words[1:]
    words[words.index("-o") + 1] = str(out)
    if source:
        words[words.index("-c") + 1] = str(source)
    if "-MF" in words:
        words[words.index("-MF") + 1] = f"{out}.d"
    words[1:1] = [f"-I{folder}"]
    words = [word for word in words if word != "-Werror"] + ["-w", "-O0"]
    return subprocess.run(words, cwd=build, check=False, stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL).returncode == 0


def compile_fault(build, folder, path, number, new):
    """The objects of what is changed, or none: some faults do not compile."""
    lines = path.read_text().splitlines()
    lines[number] = new
    # Includes begin at the root, so a changed header goes before the one of the sources.
    changed = folder / (path.relative_to(ROOT) if path.suffix == ".h" else "mutant.cpp")
    changed.parent.mkdir(parents=True, exist_ok=True)
    changed.write_text("\n".join(lines) + "\n")
    source = changed if path.suffix == ".cpp" else None
    made = []
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        tasks = []
        for i, target in enumerate(objects_of(build, path)):
            made.append(folder / f"mutant{i}.o")
            tasks.append(pool.submit(compile_one, build, folder, target, source, made[-1]))
        return made if all([task.result() for task in tasks]) else []


def link(build, folder, test, mutants):
    command = command_of(build, f"tests/{test}").replace(": && ", "", 1)
    command = re.sub(r" && :$", "", command)
    words = shlex.split(command)
    words[words.index("-o") + 1] = str(folder / test)
    # In front of the tests too, which have the inline functions of headers.
    words[1:1] = ["-Wl,--allow-multiple-definition", *map(str, mutants)]
    subprocess.run(words, cwd=build, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def limit():
    # Time of the processor: what else the machine does must not count as noticing.
    resource.setrlimit(resource.RLIMIT_CPU, (CPU_SECONDS, CPU_SECONDS))


def killer(build, folder, mutants, slow):
    """The test that notices, or None."""
    environment = dict(os.environ, LLVM_PROFILE_FILE="/dev/null")
    for chosen in [f"-{SLOW}", SLOW][: 1 + slow]:
        for test in TESTS:
            program = folder / test
            if not program.exists():
                link(build, folder, test, mutants)
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
    parser.add_argument("--headers", action="store_true")
    arguments = parser.parse_args()
    build = arguments.build.resolve()
    shuffled = faults("h" if arguments.headers else "cpp")
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
            mutants = compile_fault(build, folder, path, number, new)
            if not mutants:
                continue
            planted += 1
            noticed = killer(build, folder, mutants, arguments.slow)
        survived += noticed is None
        print(f"{i} {path.relative_to(ROOT)}:{number + 1} {kind}: {noticed or 'SURVIVED: ' + new.strip()}",
              flush=True)
    print(f"{planted} faults, {planted - survived} noticed, {survived} survived")
    return 0


if __name__ == "__main__":
    sys.exit(main())

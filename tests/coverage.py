#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Measures branch coverage of the code that reads, checks, converts and compiles. `./dev coverage` runs it.

    coverage.py BUILD [--no-run]

BUILD is a build by clang with MIEN_COVERAGE. Runs the test programs below, then prints for each file the number
of branches (two per condition: true and false) and how many were taken, summed over all instances of a template.
The others are listed in BUILD/branches.txt, and printed unless tests/coverage.md gives a reason. Fails below 95 %,
and if a reason in tests/coverage.md no longer applies.
"""
import argparse
import collections
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
FOLDERS = ["runtime/load/dna", "runtime/rig", "runtime/load/compile", "runtime/baked"]
PROGRAMS = ["base_tests", "dna_tests", "compile_tests", "baked_tests", "eval_tests", "capi_tests",
            "golden_tests"]
LEAST = 95
REASON = re.compile(r"^- `([^`]+)`, `([^`]+)`: \S", re.MULTILINE)


def tool(name):
    found = shutil.which(f"{name}-14") or shutil.which(name)
    return found or sys.exit(f"{name} is needed; on Debian 12 it is in the package llvm")


def run_programs(build, profiles):
    shutil.rmtree(profiles, ignore_errors=True)
    profiles.mkdir()
    for name in PROGRAMS:
        environment = dict(os.environ, LLVM_PROFILE_FILE=f"{profiles}/{name}-%p.profraw")
        result = subprocess.run([build / "tests" / name, "--gtest_brief=1"], check=False, env=environment,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                errors="replace")
        if result.returncode:
            sys.exit(f"{name} fails:\n{result.stdout[-4000:]}")


def branches(build, profiles):
    """{file: {(line, column, end line, end column): [times true, times false]}}"""
    merged = profiles / "all.profdata"
    subprocess.run([tool("llvm-profdata"), "merge", "-sparse", *profiles.glob("*.profraw"), "-o", merged],
                   check=True)
    counts = collections.defaultdict(lambda: collections.defaultdict(lambda: [0, 0]))
    # Each program by itself: they have different copies of inline functions.
    for name in PROGRAMS:
        export = subprocess.run(
            [tool("llvm-cov"), "export", f"-instr-profile={merged}", build / "tests" / name,
             "-skip-expansions"],
            check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        for function in json.loads(export.stdout)["data"][0]["functions"]:
            # With ccache they lead through the build directory.
            paths = [os.path.relpath(os.path.normpath(path), ROOT) for path in function["filenames"]]
            for *place, yes, no, file, _, _ in function["branches"]:
                path = paths[file]
                if path.startswith(tuple(folder + "/" for folder in FOLDERS)):
                    taken = counts[path][tuple(place)]
                    taken[0] += yes
                    taken[1] += no
    return counts


def text_at(lines, place):
    line, column, last, end = place
    if line == last:
        return lines[line - 1][column - 1 : end - 1]
    parts = [lines[line - 1][column - 1 :], *lines[line : last - 1], lines[last - 1][: end - 1]]
    return " ".join(part.strip() for part in parts)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--no-run", action="store_true", help="counts of the last run")
    arguments = parser.parse_args()
    build = arguments.build.resolve()
    profiles = build / "profiles"
    if not arguments.no_run:
        run_programs(build, profiles)
    counts = branches(build, profiles)

    reasons = set(REASON.findall((ROOT / "tests/coverage.md").read_text()))
    unused = set(reasons)
    missing, unexplained = [], []
    taken_of_all = all_branches = 0
    width = max(len(path) for path in counts)
    print(f"{'file':{width}} branches  taken       %")
    for path in sorted(counts):
        lines = (ROOT / path).read_text().splitlines()
        count = taken = 0
        for place, ways in sorted(counts[path].items()):
            code = text_at(lines, place)
            # Conditions of templates that the compiler knows are counted by it as one way only.
            for way, times in zip(("true", "false"), ways):
                count += 1
                taken += times != 0
                if times == 0:
                    entry = f"{path}:{place[0]}: `{code}` is never {way}"
                    missing.append(entry)
                    unused.discard((path, code))
                    if (path, code) not in reasons:
                        unexplained.append(entry)
        taken_of_all += taken
        all_branches += count
        print(f"{path:{width}} {count:8} {taken:6} {100 * taken / max(count, 1):7.2f}")
    percent = 100 * taken_of_all / all_branches
    print(f"{'all':{width}} {all_branches:8} {taken_of_all:6} {percent:7.2f}")
    (build / "branches.txt").write_text("\n".join(missing) + "\n")
    print(f"{len(missing)} not taken ({build}/branches.txt), {len(unexplained)} of them without a reason in "
          "tests/coverage.md:", *unexplained, sep="\n")
    for path, code in sorted(unused):
        print(f"tests/coverage.md: `{code}` in {path} is taken both ways, or does not exist")
    if percent < LEAST:
        print(f"less than {LEAST} %")
    return percent < LEAST or bool(unused)


if __name__ == "__main__":
    sys.exit(main())

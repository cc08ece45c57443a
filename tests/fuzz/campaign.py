#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs fuzzers one after the other, in rounds, and keeps their numbers. `./dev fuzz` calls it.

    campaign.py BUILD SECONDS [--round SECONDS] [--numbers FILE]
        Fuzzers of BUILD/tests, each for a share of SECONDS, in rounds of at most the given length.
        They start from tests/fuzz/corpus and continue with what earlier runs found, in BUILD/corpus.
        Inputs that break a promise, take too long or too much memory are kept in BUILD/findings.
    campaign.py BUILD --merge
        Writes the smallest set of inputs that reaches the same edges into tests/fuzz/corpus.

Numbers are appended to BUILD/numbers.tsv: build, fuzzer, executions, seconds, edges, features, findings.
"""
import argparse
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import corpus  # noqa: E402

# Of one input, by the clock: what else the machine does counts too. The fuzzers measure their own time.
LIMITS = ["-timeout=100", "-rss_limit_mb=2048", "-malloc_limit_mb=1024"]
# Its weighing of inputs takes longer than running them.
PACE = ["-entropic=0"]
# Larger inputs find little more, and the corpus has to stay small.
LARGEST_KEPT = 24 * 1024


def fuzzers_of(build):
    found = sorted(p for p in (build / "tests").glob("fuzz_*") if p.is_file())
    if not found:
        sys.exit(f"no fuzzers in {build}/tests")
    return found


def run_one(fuzzer, build, seconds, seeds):
    """(executions, edges, features, findings) of one run."""
    own = build / "corpus" / fuzzer.name
    findings = build / "findings"
    own.mkdir(parents=True, exist_ok=True)
    findings.mkdir(exist_ok=True)
    before = set(findings.iterdir())
    with tempfile.TemporaryFile("w+") as log:
        subprocess.run([fuzzer, f"-max_total_time={seconds}", *LIMITS, *PACE, "-print_final_stats=1",
                        "-report_slow_units=5", f"-artifact_prefix={findings}/{fuzzer.name}-", own,
                        *seeds], stdout=log, stderr=log, check=False)
        log.seek(0)
        text = log.read()
    new = sorted(set(findings.iterdir()) - before)
    executed = re.search(r"number_of_executed_units: (\d+)", text)
    # A run that ends with a finding prints no statistics of its own if the process died.
    last = re.findall(r"^#(\d+)\t.*? cov: (\d+) ft: (\d+)", text, re.MULTILINE)
    if not last:
        sys.exit(f"{fuzzer.name} did not run:\n{text[-4000:]}")
    executions = int(executed.group(1)) if executed else int(last[-1][0])
    if new:
        print(text[-3000:])
    return executions, int(last[-1][1]), int(last[-1][2]), new


def run(build, seconds, round_seconds, numbers):
    fuzzers = fuzzers_of(build)
    share = max(1, seconds // len(fuzzers))
    spent = {fuzzer: 0 for fuzzer in fuzzers}
    findings = []
    with tempfile.TemporaryDirectory() as folder:
        seeds = {}
        for fuzzer in fuzzers:
            into = pathlib.Path(folder) / fuzzer.name
            corpus.unpack(fuzzer.name, into)
            seeds[fuzzer] = [into]
        while any(spent[f] < share for f in fuzzers):
            for fuzzer in fuzzers:
                length = min(round_seconds, share - spent[fuzzer])
                if length <= 0:
                    continue
                executions, edges, features, new = run_one(fuzzer, build, length, seeds[fuzzer])
                spent[fuzzer] += length
                findings += new
                row = (build.name, fuzzer.name, executions, length, edges, features, len(new))
                print("{1}: {2} executions in {3} s, {4} edges, {5} features, {6} findings".format(*row),
                      flush=True)
                with open(numbers, "a", encoding="utf-8") as out:
                    print(*row, sep="\t", file=out)
    for finding in findings:
        print(f"finding: {finding}")
    # A slow input is told of, and is no failure: machines differ.
    return any("slow-unit" not in finding.name for finding in findings)


def merge(build):
    for fuzzer in fuzzers_of(build):
        with tempfile.TemporaryDirectory() as folder:
            old = pathlib.Path(folder) / "old"
            new = pathlib.Path(folder) / "new"
            new.mkdir()
            corpus.unpack(fuzzer.name, old)
            own = build / "corpus" / fuzzer.name
            own.mkdir(parents=True, exist_ok=True)
            for path in own.iterdir():
                if path.stat().st_size <= LARGEST_KEPT:
                    shutil.copy(path, old)
            result = subprocess.run([fuzzer, "-merge=1", "-use_counters=0", *LIMITS, new, old], check=False,
                                    stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            if result.returncode:
                sys.exit(f"{fuzzer.name} -merge=1:\n{result.stdout[-4000:]}")
            size = corpus.pack(fuzzer.name, new)
            print(f"{fuzzer.name}: {len(list(new.iterdir()))} inputs, {size} bytes packed")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("seconds", type=int, nargs="?")
    parser.add_argument("--round", type=int, default=600)
    parser.add_argument("--numbers", type=pathlib.Path)
    parser.add_argument("--merge", action="store_true")
    arguments = parser.parse_args()
    build = arguments.build.resolve()
    if arguments.merge:
        merge(build)
        return 0
    if not arguments.seconds:
        parser.error("give a number of seconds")
    return run(build, arguments.seconds, arguments.round, arguments.numbers or build / "numbers.tsv")


if __name__ == "__main__":
    sys.exit(main())

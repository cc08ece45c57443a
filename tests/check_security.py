#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""SECURITY.md has numbers of this release: its heading names the version of mien.h, its table has a row for
each fuzzer whose inputs are kept, the sum below is that of the rows, and planted faults are those of the list.

    check_security.py [--self-test]
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
HEADING = re.compile(r"^### Numbers of (\d+\.\d+\.\d+)$", re.MULTILINE)


def version_of(header):
    return ".".join(re.search(rf"#define MIEN_VERSION_{part} +(\d+)", header)[1]
                    for part in ("MAJOR", "MINOR", "PATCH"))


def mistakes(text, version, fuzzers, faults):
    found = []
    heading = HEADING.search(text)
    if not heading:
        return ["SECURITY.md: no heading '### Numbers of VERSION'"]
    if heading[1] != version:
        found.append(f"SECURITY.md has numbers of {heading[1]}, this is {version}: measure them again "
                     "(./dev fuzz --hours N)")
    for fuzzer in fuzzers:
        if not re.search(rf"^\| `{fuzzer}` \| *[\d,]+ \|", text, re.MULTILINE):
            found.append(f"SECURITY.md: no row of executions for `{fuzzer}`")
    rows = re.findall(r"^\| `fuzz_\w+` \| *([\d,]+) \|", text, re.MULTILINE)
    millions = f"{sum(int(row.replace(',', '')) for row in rows) / 1e6:.1f}"
    if f"These are {millions} million" not in text:
        found.append(f"SECURITY.md: the rows add up to {millions} million executions")
    if not re.search(rf"\d+ of {faults} were noticed", text):
        found.append(f"SECURITY.md: tests/mutation/faults.tsv has {faults} planted faults")
    return found


def self_test():
    text = ("80 of 90 were noticed\n\n### Numbers of 1.2.3\n\n| fuzzer | executions |\n|---|---|\n"
            "| `fuzz_a` | 1,100,000 |\n\nThese are 1.1 million.\n")
    assert not mistakes(text, "1.2.3", ["fuzz_a"], 90)
    assert len(mistakes(text, "1.2.4", ["fuzz_a"], 90)) == 1
    assert len(mistakes(text, "1.2.3", ["fuzz_a", "fuzz_b"], 90)) == 1
    assert len(mistakes(text, "1.2.3", ["fuzz_a"], 91)) == 1
    assert len(mistakes(text.replace("1.1 m", "1.2 m"), "1.2.3", ["fuzz_a"], 90)) == 1
    assert len(mistakes("", "1.2.3", [], 90)) == 1


def main():
    if "--self-test" in sys.argv:
        self_test()
    version = version_of((ROOT / "capi/include/mien/base.h").read_text())
    fuzzers = sorted(path.stem for path in (ROOT / "tests/fuzz/corpus").glob("*.xz"))
    faults = len((ROOT / "tests/mutation/faults.tsv").read_text().splitlines()) - 1
    found = mistakes((ROOT / "SECURITY.md").read_text(), version, fuzzers, faults)
    for mistake in found:
        print(mistake)
    if not found:
        print(f"SECURITY.md has numbers of {version}")
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())

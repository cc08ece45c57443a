#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""SECURITY.md has numbers of this release: its heading names the version of mien.h, its table has a row for
each fuzzer whose inputs are kept, the sum below is that of the rows, and planted faults are those of the list.
The tests that it names for the bounds of the program's readers exist.

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
    if f"In total {millions} million inputs" not in text:
        found.append(f"SECURITY.md: the rows add up to {millions} million executions")
    if not re.search(rf"\d+ of {faults} were noticed", text):
        found.append(f"SECURITY.md: tests/mutation/faults.tsv has {faults} planted faults")
    return found


def missing_tests(text, sources):
    """`sources`: by name of a test file, its text. A row of bounds ends with a file and a test in it."""
    rows = re.findall(r"^  \| (.*?) \| .* \| (.*) \|$", text, re.MULTILINE)
    found = [] if rows else ["SECURITY.md: no table of the bounds of readers"]
    for reader, test in rows:
        named = re.fullmatch(r"`(\w+\.py)`, `(test_\w+)`", test)
        if reader != "bytes" and (not named or f"def {named[2]}(" not in sources.get(named[1], "")):
            found.append(f"SECURITY.md: no test of the bounds of {reader}: {test}")
    return found


def self_test():
    text = ("80 of 90 were noticed\n\n### Numbers of 1.2.3\n\n| fuzzer | executions |\n|---|---|\n"
            "| `fuzz_a` | 1,100,000 |\n\nIn total 1.1 million inputs.\n")
    assert not mistakes(text, "1.2.3", ["fuzz_a"], 90)
    assert len(mistakes(text, "1.2.4", ["fuzz_a"], 90)) == 1
    assert len(mistakes(text, "1.2.3", ["fuzz_a", "fuzz_b"], 90)) == 1
    assert len(mistakes(text, "1.2.3", ["fuzz_a"], 91)) == 1
    assert len(mistakes(text.replace("1.1 m", "1.2 m"), "1.2.3", ["fuzz_a"], 90)) == 1
    assert len(mistakes("", "1.2.3", [], 90)) == 1
    table = "  | bytes | bound | test |\n  |---|---|---|\n  | OBJ | few | `a_test.py`, `test_few` |\n"
    assert not missing_tests(table, {"a_test.py": "    def test_few(self):"})
    assert len(missing_tests(table, {"a_test.py": "    def test_fewer(self):"})) == 1
    assert len(missing_tests(table, {})) == 1
    assert len(missing_tests("", {})) == 1


def main():
    if "--self-test" in sys.argv:
        self_test()
    version = version_of((ROOT / "capi/include/mien/base.h").read_text())
    fuzzers = sorted(path.stem for path in (ROOT / "tests/fuzz/corpus").glob("*.xz"))
    faults = len((ROOT / "tests/mutation/faults.tsv").read_text().splitlines()) - 1
    text = (ROOT / "SECURITY.md").read_text()
    tests = (ROOT / "integrations/program/tests").glob("*_test.py")
    found = mistakes(text, version, fuzzers, faults)
    found += missing_tests(text, {path.name: path.read_text() for path in tests})
    for mistake in found:
        print(mistake)
    if not found:
        print(f"SECURITY.md has numbers of {version}")
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())

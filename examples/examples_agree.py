#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The examples of all languages do the same job: they have to print the same.

Usage: examples_agree.py --python INTERPRETER --cargo CARGO_OR_NOTHING C_PROGRAM CPP_PROGRAM
The library is found by the environment: MIEN_LIBRARY (Python), MIEN_LIB_DIR (Rust).
"""
import argparse
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


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("c")
    parser.add_argument("cpp")
    parser.add_argument("--python", default=sys.executable)
    parser.add_argument("--cargo", default="")
    args = parser.parse_args()

    programs = {"C": [args.c], "C++": [args.cpp]}
    if subprocess.run([args.python, "-c", "import numpy"], stderr=subprocess.DEVNULL).returncode:
        print(f"NOT TESTED: the example in Python; {args.python} has no NumPy")
    else:
        programs["Python"] = [args.python, HERE / "evaluate.py"]
    manifest = HERE.parent / "integrations" / "rust" / "mien" / "Cargo.toml"
    if not args.cargo or not manifest.exists():
        print("NOT TESTED: the example in Rust; there is no " + ("crate" if args.cargo else "cargo"))
    else:
        programs["Rust"] = [args.cargo, "run", "--quiet", "--offline", "--manifest-path", manifest,
                            "--example", "evaluate", "--"]

    code = (HERE / "evaluate.c").read_text(encoding="utf-8").split("\n", 1)[1]
    if code not in (HERE.parent / "README.md").read_text(encoding="utf-8"):
        sys.exit("the example of README.md is not evaluate.c")
    failures = 0
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
                print(f"{name:<8}{text.strip() if succeeded else 'fails'}")
            failures += len(set(results.values())) != 1
            if results["C"][0] == (arguments[-1:] in (["missing"], [broken])):
                sys.exit(f"C with {arguments}: {results['C']}")
    if failures:
        sys.exit(f"they differ in {failures} cases")
    print(f"{', '.join(programs)} agree")


if __name__ == "__main__":
    main()

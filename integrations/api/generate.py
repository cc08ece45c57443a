#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the low level of bindings from mien_api.json: enums, structs, functions and their comments.

    generate.py all                   write the files of all languages
    generate.py go rust               of some
    generate.py --check LANGUAGE...   fail if a file is not what the JSON says
    generate.py --list                print the languages and their files

A language is a template, templates/LANGUAGE.py. Its FILES has for each file, by its path in integrations/, what begins
a line of a comment and a function that gives the text behind the heading, in pieces.
"""
import argparse
import importlib
import sys
from pathlib import Path

import model

HERE = Path(__file__).resolve().parent
# Tools of Go take "Code generated ... DO NOT EDIT." for the mark of such files.
HEADING = ("{0} SPDX-License-Identifier: MIT\n"
           "{0} Code generated from integrations/api/mien_api.json by generate.py; run ./dev api. DO NOT EDIT.\n")


def files_of(language):
    """{path: (what begins a comment, function that gives the text)}"""
    files = importlib.import_module("templates." + language).FILES
    return {HERE.parent / path: file for path, file in files.items()}


def texts_of(language, api):
    """{path: text}"""
    try:
        return {path: HEADING.format(mark) + "".join(write(api)) for path, (mark, write) in files_of(language).items()}
    except KeyError as error:
        sys.exit(f"generate.py: the template of {language}: {error}")


def main():
    languages = sorted(path.stem for path in (HERE / "templates").glob("*.py"))
    parser = argparse.ArgumentParser(description="Writes the low level of bindings from mien_api.json.")
    parser.add_argument("languages", nargs="*", metavar="LANGUAGE", help=", ".join(languages) + " or all")
    parser.add_argument("--check", action="store_true", help="write nothing; fail if a file is not what the JSON says")
    parser.add_argument("--list", action="store_true", help="print the languages and their files")
    args = parser.parse_args()
    unknown = set(args.languages) - {*languages, "all"}
    if unknown or not (args.languages or args.list):
        parser.error(f"give all, or some of {', '.join(languages)}")
    if args.list:
        for language in languages:
            print(f"{language}: {', '.join(str(path.relative_to(HERE.parent)) for path in files_of(language))}")
        return
    api = model.load()
    for language in languages if "all" in args.languages else args.languages:
        for path, text in texts_of(language, api).items():
            if not args.check:
                path.write_text(text, encoding="utf-8")
            elif not path.exists() or path.read_text(encoding="utf-8") != text:
                sys.exit(f"{path} is not what mien_api.json says: run ./dev api")


if __name__ == "__main__":
    main()

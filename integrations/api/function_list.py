#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The public functions as a table for the tests in C++: its name and whether it may return MIEN_ERROR_MEMORY.

Usage: function_list.py OUTPUT
"""
import sys
from pathlib import Path

import dump_api


def main():
    rows = []
    for function in dump_api.read()["functions"]:
        takes_memory = any(status["name"] == "MIEN_ERROR_MEMORY" for status in function["statuses"])
        rows.append(f'{{"{function["name"]}", {"true" if takes_memory else "false"}}},\n')
    Path(sys.argv[1]).write_text("".join(rows), encoding="utf-8")


if __name__ == "__main__":
    main()

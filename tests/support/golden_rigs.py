# SPDX-License-Identifier: MIT
"""The golden rigs of tests/golden/README.md: where they are."""
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
PROJECT = os.path.dirname(os.path.dirname(HERE))
FOLDER = os.path.join(PROJECT, "tests", "golden")
SHARED = os.path.join(os.environ.get("MIEN_SHARED") or os.path.join(PROJECT, "..", "shared"), "golden")


def rigs():
    """NAME -> path of NAME.dna. `head` is too large for the repository and may be missing."""
    found = {name[:-4]: os.path.join(FOLDER, name) for name in sorted(os.listdir(FOLDER)) if name.endswith(".dna")}
    assert len(found) >= 13, "golden rigs are missing in %s: only %s" % (FOLDER, ", ".join(found))
    head = os.path.normpath(os.path.join(SHARED, "head.dna"))
    if os.path.isfile(head):
        found["head"] = head
    else:
        print("NOT TESTED: the golden rig of production size; there is no %s" % head, file=sys.stderr, flush=True)
    return found

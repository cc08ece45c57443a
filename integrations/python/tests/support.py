# SPDX-License-Identifier: MIT
"""What the tests share: rigs made once, and child processes."""
import functools
import os
import subprocess
import sys
import unittest
from pathlib import Path

import mien

try:
    import numpy
except ImportError:
    numpy = None

PACKAGE = Path(__file__).resolve().parent.parent
needs_numpy = unittest.skipIf(numpy is None, "NOT TESTED: this interpreter has no NumPy")


@functools.lru_cache(maxsize=None)
def dna_of(preset=mien.Preset.SMALL):
    return mien.Dna.generate(preset, seed=7)


@functools.lru_cache(maxsize=None)
def rig_of(preset=mien.Preset.SMALL, **desc):
    return mien.Rig(dna_of(preset), **desc)


def fresh_rig(preset=mien.Preset.TINY):
    with mien.Dna.generate(preset) as dna:
        return mien.Rig(dna)


def pattern(count, phase=0):
    """Control values that differ from each other, some of them 0."""
    return [((i * 7 + phase * 3) % 11) / 10 if i % 3 else 0.0 for i in range(count)]


def run(code, without_numpy=False, **environment):
    """Runs Python code in a process of its own; returns what it printed. A crash is an error."""
    if without_numpy:
        code = "import sys; sys.modules['numpy'] = None\n" + code
    result = subprocess.run(
        [sys.executable, "-X", "faulthandler", "-c", code], capture_output=True, text=True,
        env={**os.environ, "PYTHONPATH": str(PACKAGE), "MIEN_LIBRARY": mien.library_path,
             **environment})
    if result.returncode:
        raise AssertionError(f"exit code {result.returncode}\n{result.stdout}{result.stderr}")
    return result.stdout

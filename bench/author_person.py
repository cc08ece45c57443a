#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The head of `mien demo-head --seed SEED`, rigged once more by `mien author` from its mesh and its expressions: joints
alone, with MetaHuman's names. Positions keep their numbers, so bench_names can compare both with another demo head.

    bench/author_person.py MIEN SEED OUT.dna
"""
import os
import subprocess
import sys
import tempfile

mien, seed, out = sys.argv[1:]


def run(*arguments):
    return subprocess.run([mien, *arguments], check=True, stdout=subprocess.PIPE, encoding="utf-8").stdout


with tempfile.TemporaryDirectory() as folder:
    head = os.path.join(folder, "head.dna")
    run("demo-head", "--seed", seed, "-o", head, "-q")
    names = [name for name in run("info", head, "--names", "raw").split() if name.strip()]
    shapes = os.path.join(folder, "shapes")
    os.mkdir(shapes)
    run("export", head, "-o", os.path.join(folder, "head.obj"), "--lod", "0", "-q")
    for name in names:
        run("export", head, "-o", os.path.join(shapes, name.rpartition(".")[2] + ".obj"), "--lod", "0", "--set",
            name + "=1", "-q")
    run("author", os.path.join(folder, "head.obj"), "--shapes", shapes, "--preset", "metahuman", "--residual", "off",
        "--lods", "1", "-o", out, "--force", "-q")

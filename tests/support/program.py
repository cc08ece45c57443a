# SPDX-License-Identifier: MIT
"""The `mien` program as tests use it: it runs in their own folder, and fails with one clear line.

A test calls `main()` last and `make_folder()` in its `setUpModule()`.
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

DONE, USAGE, INVALID, FILE, INTERNAL = range(5)

mien = os.environ.get("MIEN_BIN", "")
# What takes long for what it shows: ./dev test --slow runs it.
long_form = unittest.skipUnless(os.environ.get("MIEN_LONG_TESTS"), "long; MIEN_LONG_TESTS=1 runs it")
folder = ""


def main():
    """Runs the tests of the script: `script path/to/mien [unittest options]`, or MIEN_BIN=path/to/mien."""
    global mien
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-") and os.path.exists(sys.argv[1]):
        mien = sys.argv.pop(1)
    if not mien:
        sys.exit(f"usage: {os.path.basename(sys.argv[0])} path/to/mien (or MIEN_BIN)")
    mien = os.path.abspath(mien)
    unittest.main()


def make_folder():
    """For the files of one module; removed after its last test."""
    global folder
    folder = tempfile.mkdtemp(prefix="mien-test-")
    unittest.addModuleCleanup(shutil.rmtree, folder)


def path(name):
    return os.path.join(folder, name)


def read(name):
    with open(path(name), "rb") as file:
        return file.read()


def write(name, content):
    with open(path(name), "wb") as file:
        file.write(content if isinstance(content, bytes) else content.encode())
    return path(name)


def run(*arguments, stdin=b"", env=None, **more):
    """The finished process: output in bytes, errors as text. `env` adds to the environment."""
    more.setdefault("stdout", subprocess.PIPE)
    done = subprocess.run([mien, *arguments], input=stdin, stderr=subprocess.PIPE, timeout=800, check=False,
                          env={**os.environ, **(env or {})}, **more)
    done.stderr = done.stderr.decode()
    return done


def cost(*arguments, runs=3, stdin=None, **more):
    """CPU seconds and peak bytes of the best of some runs. Memory counts from what Python takes up."""
    seconds, peak = [], []
    for _ in range(runs):
        process = subprocess.Popen([mien, *arguments], stdin=stdin, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL, **more)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        seconds.append(usage.ru_utime + usage.ru_stime)
        peak.append(usage.ru_maxrss * 1024)
    return min(seconds), min(peak)


def growth(small, large, **more):
    """How many times the CPU time of one command another takes. What the program takes to start is no part of it, and
    below 50 ms differences are those of the machine."""
    start = cost("--version")[0]
    return (cost(*large, **more)[0] - start) / max(cost(*small, **more)[0] - start, 5e-2)


def make(*arguments):
    """A file that tests start from."""
    done = run(*arguments)
    assert done.returncode == DONE, done.stderr
    return done


class ProgramTest(unittest.TestCase):
    def skipTest(self, reason):
        print(reason, file=sys.stderr)  # unittest itself does not tell, and ./dev collects these lines
        super().skipTest(reason)

    def ok(self, *arguments, **more):
        done = run(*arguments, **more)
        self.assertEqual(done.returncode, DONE, done.stderr)
        return done

    def fails(self, code, *arguments, says=(), **more):
        """Fails with that code and one line that names what it should, and leaves nothing behind."""
        before = sorted(os.listdir(folder))
        done = run(*arguments, **more)
        self.assertEqual(done.returncode, code, (arguments, done.stderr, done.stdout))
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertTrue(done.stderr.startswith("mien: "), done.stderr)
        for word in [says] if isinstance(says, str) else says:
            self.assertIn(word, done.stderr)
        self.assertEqual(sorted(os.listdir(folder)), before)
        return done

    def json(self, *arguments, **more):
        def refuse(name):
            raise AssertionError("not a number of JSON: " + name)
        return json.loads(self.ok(*arguments, **more).stdout, parse_constant=refuse)

    def names(self, rig, kind):
        """Of a file in the folder."""
        return self.ok("info", path(rig), "--names", kind).stdout.decode().splitlines()

    def evaluate(self, rig, frames, *options):
        return self.json("eval", path(rig), "--input", "-", "--quiet", *options,
                         stdin=json.dumps({"frames": frames}).encode())

    def evaluate_one(self, rig, frame, lod=0):
        return self.evaluate(rig, [frame], "--lod", str(lod))["frames"][0]["lods"][0]

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs the tests of the add-on in Blender: builds the add-on, installs it for a user without settings, starts Blender.

    run.py [--library FILE] [--blender FILE] [--window] [FILE.py...]

Without files: all *_test.py here, a check in a window if there is an xvfb-run, and the extension.
"""
import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import build_addon  # noqa: E402

INSTALL = """
import bpy
bpy.ops.preferences.addon_install(filepath={path!r})
assert bpy.ops.preferences.addon_enable(module="mien_blender") == {{"FINISHED"}}
bpy.ops.wm.save_userpref()
"""

# As Blender 4.2 installs an extension: the add-on in a folder, its wheels where all extensions find them.
EXTENSION = """
import os, sys
import bpy
assert bpy.ops.preferences.addon_enable(module="mien_blender") == {"FINISHED"}
binding = sys.modules["mien_blender.binding"].mien
assert binding.__name__ == "mien_blender_runtime", binding
path = os.path.join(os.environ["MIEN_TEST_FOLDER"], "tiny.dna")
binding.Dna.generate(binding.Preset.TINY).save(path)
assert bpy.ops.mien.import_rig(filepath=path) == {"FINISHED"}
assert "mien" not in sys.modules
"""


def environment(folder):
    made = {key: value for key, value in os.environ.items() if key not in ("PYTHONPATH", "PYTHONHOME", "MIEN_LIBRARY")}
    made.update(BLENDER_USER_CONFIG=str(folder / "config"), BLENDER_USER_SCRIPTS=str(folder / "scripts"),
                MIEN_TEST_FOLDER=str(folder), MIEN_REPOSITORY=str(build_addon.ROOT), HOME=str(folder))
    # Debian's Blender takes the first python3 on the path as its own.
    made["PATH"] = "/usr/bin:/bin:" + made.get("PATH", "")
    for name in ("config", "scripts"):
        (folder / name).mkdir(parents=True, exist_ok=True)
    return made


def run(blender, folder, *arguments):
    command = [blender, "--background", "--python-exit-code", "1", *map(str, arguments)]
    return subprocess.run(command, env=environment(folder), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          timeout=3600)


def check(result):
    # Blender ends with 0 if it cannot read a script at all.
    bad = result.returncode != 0 or re.search(r"Traceback|Error in PyDriver|Dependency cycle|Error: Python", result.stdout)
    if bad:
        lines = [line for line in result.stdout.splitlines() if not line.startswith("Fra:")]
        print("\n".join(lines)[-6000:])
        sys.exit(f"Blender ended with {result.returncode}")
    return result.stdout


def install(blender, folder, addon):
    folder.mkdir(parents=True, exist_ok=True)
    script = folder / "install.py"
    script.write_text(INSTALL.format(path=str(addon)))
    check(run(blender, folder, "--python", script))


def test_window(blender, folder):
    """In a window: that of the desktop, or one of Xvfb."""
    if not shutil.which("xvfb-run"):
        print("NOT TESTED: the Blender add-on in a window; xvfb-run is not installed (Debian package: xvfb)")
        return
    made = environment(folder)
    made["LIBGL_ALWAYS_SOFTWARE"] = "1"
    command = ["xvfb-run", "-a", "-s", "-screen 0 1000x700x24 +extension GLX", blender, "--window-geometry", "0", "0",
               "1000", "700", "--python-exit-code", "1", "--python", str(HERE / "window_check.py")]
    result = subprocess.run(command, env=made, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=900)
    if "WINDOW OK" not in check(result):
        print(result.stdout[-3000:])
        sys.exit("Blender ended before the check in a window did")
    print("works in a window")


def test_extension(blender, folder, extension):
    home = folder / "scripts/addons/mien_blender"
    with zipfile.ZipFile(extension) as archive:
        archive.extractall(home)
    (wheel,) = (home / "wheels").iterdir()
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder / "scripts/addons/modules")
    script = folder / "extension.py"
    script.write_text(EXTENSION)
    check(run(blender, folder, "--python", script))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--library", default=None)
    parser.add_argument("--blender", default=shutil.which("blender"))
    parser.add_argument("--window", action="store_true", help="also with FILE: the check in a window")
    parser.add_argument("files", nargs="*", type=Path, help="default: all *_test.py here")
    args = parser.parse_args()
    if not args.blender:
        print("NOT TESTED: the Blender add-on; Blender is not installed (Debian package: blender)")
        return
    with tempfile.TemporaryDirectory(prefix="mien-blender-") as made:
        folder = Path(made)
        addon, extension = build_addon.build(folder / "dist", args.library)
        install(args.blender, folder / "user", addon)
        for file in args.files or sorted(HERE.glob("*_test.py")):
            output = check(run(args.blender, folder / "user", "--python", file.resolve()))
            print(*(line for line in output.splitlines() if re.match(r"Ran \d|OK|MEASURED|NOT TESTED", line)), sep="\n")
        if not args.files or args.window:
            test_window(args.blender, folder / "user")
        if not args.files:
            test_extension(args.blender, folder / "extension", extension)
            print("the extension loads its wheel")


if __name__ == "__main__":
    main()

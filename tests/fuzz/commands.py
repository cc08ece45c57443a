#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs the commands of the program on damaged files. `./dev fuzz --commands SECONDS` calls it.

    commands.py PROGRAM SECONDS [--plain] [--seed N] [--jobs N] [--only COMMAND,...] [--findings DIR]

PROGRAM is one with sanitizers, or any other with --plain. Each run damages one input of a command, now and then also
an option.
What must hold: the exit code is 0 to 4; no sanitizer speaks, and no signal ends the program; messages
hold no control characters; within a minute of CPU time and 2 GiB it is done; without success nothing is written, and
nothing but the outputs ever is. The inputs and the command line of a finding are kept. Exits with 1 if
there are any.
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import random
import re
import shlex
import shutil
import struct
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import edit_scripts  # noqa: E402

SCENE = pathlib.Path(__file__).resolve().parents[2] / "examples" / "scene.json"
WRONG = ("Sanitizer", "runtime error", "out of memory", "internal error")  # in messages
SECONDS_AT_MOST = 60  # of CPU time; by the clock ten times that
ENVIRONMENT = dict(os.environ, ASAN_OPTIONS="allocator_may_return_null=1:hard_rss_limit_mb=2048",
                   UBSAN_OPTIONS="halt_on_error=1")
FRAMES = """{"frames": [{"raw": {"0": 0.5, "3": 1}}, {"raw": {"1": 0.25}}, {"gui": {"0": 1}}]}"""
TABLE = "time,jawOpen,eyeBlinkL,a,b\n" + "".join(
    f"{i / 60:.6f},{i / 50:.4f},{i % 3 / 4},{1 / (i + 1):.5f},0\n" for i in range(40))

# Arguments of commands; {NAME} is an input, {out:ENDING} an output.
COMMANDS = [
    "info {rig} --json", "info {rig} --names all --lods 0-1", "info {baked}", "info {clip}",
    "validate {rig}", "validate {baked} {rig} --json",
    "eval {rig} -i {frames} -o {out:json} --lod all", "eval {baked} -i {frames} -o {out:csv} --format csv",
    "extract {asset} -o {out:dna}", "extract {asset} --json", "info {asset}", "validate {asset}",
    "convert {rig} -o {out:dna} --version 2.2 --unknown drop", "convert {rig} -o {out:dna} --lods 1-2",
    "convert {rig} -o {out:dna} --system unreal --layers behavior,geometry",
    "export {rig} -o {out:glb} --animation {frames}", "export {rig} -o {out:glb} --quantize --lod all",
    "export {rig} -o {out:obj} --set 0=1", "export {rig} -o {out:glb} --influences 8 --no-uvs",
    "render {rig} -o {out:png} --size 64 --samples 1", "render {baked} -o {out:png} --size 40 --sheet",
    "render {rig} -o {out:png} --size 32 --frames {frames} --wireframe",
    "inspect {rig} jawOpen", "inspect {rig} 1 -o {out:png} --size 32 --json",
    "bake {rig} -o {out:rig} --storage f16", "bake {rig} -o {out:rig} --system unity --no-geometry",
    "clip build {table} -o {out:clip}", "clip build {table} -o {out:clip} --resample --snap 1/2048",
    "clip build {frames} -o {out:clip} --loop wrap", "clip info {clip}", "clip verify {clip}",
    "clip export {clip} -o {out:csv}",
    "play {scene} {rig} -o {out:json} -o {out:svg} --seconds 0.5 --rate 20",
    "play {scene} {baked} -o {out:clip} -o {out:csv} --seconds 0.3",
    "author {obj} -o {out:dna} --joints 12 --lods 2 --report {out:json}",
    "author {glb} -o {out:dna} --joints 8 --lods 1", "author {obj} --shapes {glb} -o {out:dna} --joints 9",
    "edit {rig} --script {script} -o {out:dna}", "edit {rig} --script {script} --dry-run",
    "edit {rig} --transplant {template} -o {out:dna}", "edit {rig} --merge-joints {template} -o {out:dna}",
    "edit {rig} --to-json -o {out:json}", "edit {text} --from-json -o {out:dna}", "diff {rig} {template} --json",
]
ENDINGS = {"obj": "obj", "glb": "glb", "array": "json"}  # of inputs; others do not matter
SCRIPT_READS = ["template", "array"]
NUMBERS = ["0", "-1", "1", "2", "255", "65535", "65536", "4294967295", "1e30", "1e-30", "nan", "1e999", ""]
WORDS = [0, 1, 2, 0x7F, 0xFF, 0x7FFF, 0xFFFF, 0x10000, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 0x7FC00000,
         0x7F800000, 0x3F800000]


def make_inputs(program, folder):
    """Files of each kind, made by the program itself."""
    def run(*arguments):
        subprocess.run([program, "-q", *map(str, arguments)], check=True, env=ENVIRONMENT)
    inputs = {kind: [] for kind in "rig asset baked frames table clip scene obj glb template script array text".split()}
    for name, options in (("plain", []), ("networks", ["--ml"]), ("body", ["--preset", "body"])):
        rig = folder / f"{name}.dna"
        run("gen", "-o", rig, *options)
        run("bake", rig, "-o", folder / f"{name}.rig")
        inputs["rig"].append(rig)
        inputs["template"].append(rig)
        asset = folder / f"{name}.uasset"
        asset.write_bytes(b"\xc1\x83\x2a\x9e" + bytes(500) + rig.read_bytes() + bytes(100))
        inputs["asset"].append(asset)
        inputs["baked"].append(folder / f"{name}.rig")
    run("export", folder / "plain.dna", "-o", folder / "face.obj")
    run("export", folder / "plain.dna", "-o", folder / "face.glb")
    (folder / "frames.json").write_text(FRAMES)
    (folder / "table.csv").write_text(TABLE)
    run("clip", "build", folder / "table.csv", "-o", folder / "table.clip")
    for kind, name in (("frames", "frames.json"), ("table", "table.csv"), ("clip", "table.clip"),
                       ("obj", "face.obj"), ("glb", "face.glb")):
        inputs[kind].append(folder / name)
    inputs["scene"].append(SCENE)
    run("edit", folder / "plain.dna", "--to-json", "-o", folder / "plain.json")
    inputs["text"].append(folder / "plain.json")
    made = {kind: [path.read_bytes() for path in paths] for kind, paths in inputs.items()}
    return {**made, **make_edits(program, folder / "plain.dna", folder / "plain.json")}


def make_edits(program, rig, text):
    """Scripts for a rig, which read other files in the folder of the run, and an array of positions."""
    info = subprocess.run([program, "info", rig, "--json", "--names", "all"], check=True, env=ENVIRONMENT,
                          capture_output=True).stdout
    names = edit_scripts.element_names(json.loads(info))
    draw = random.Random(5)
    scripts = [edit_scripts.random_script(draw, names, "template.in", "array.json").encode() for _ in range(2000)]
    count = len(json.loads(text.read_bytes())["geom"]["meshes"][0]["positions"]["xs"])
    return {"script": scripts, "array": [json.dumps([[i % 7, i % 5, i % 3] for i in range(count)]).encode()]}


def damage_text(rng, text):
    tokens = re.findall(rb"[A-Za-z_]+|[-+.0-9e]+|\s+|.", text, re.DOTALL)
    for _ in range(rng.choice((1, 1, 2, 5))):
        at = rng.randrange(len(tokens))
        tokens[at] = rng.choice([
            lambda: rng.choice(NUMBERS).encode(), lambda: b"", lambda: tokens[at] * rng.choice((2, 300)),
            lambda: rng.choice(tokens), lambda: bytes(rng.randrange(256) for _ in range(4)),
            lambda: rng.choice((b"\x1b[31m", b"\xff", b"\0", b"[" * 5000, b"{", b'"', b"\n"))])()
    return b"".join(tokens)


def damage_binary(rng, data, others):
    data = bytearray(data)
    for _ in range(rng.choice((1, 1, 1, 2, 4, 16))):
        # Half of the damage to where counts and offsets lie.
        at = rng.randrange(min(len(data), rng.choice((512, len(data)))) or 1)
        way = rng.randrange(7)
        if way == 0:
            data[at:at + 1] = bytes([rng.randrange(256)])
        elif way == 1:
            data[at:at + 4] = struct.pack(rng.choice("<>") + "I", rng.choice(WORDS))
        elif way == 2:
            data[at:at + 2] = struct.pack(rng.choice("<>") + "H", rng.choice(WORDS) & 0xFFFF)
        elif way == 3:
            del data[at:]
        elif way == 4:
            del data[at:at + rng.choice((1, 2, 4, 100))]
        elif way == 5:
            data[at:at] = data[at:at + rng.choice((1, 4, 64))]
        else:
            other = rng.choice(others)
            data[at:at + 64] = other[at:at + 64]
        if not data:
            break
    return bytes(data)


def one_run(limits, program, commands, inputs, seed, scratch, findings):
    """The finding, or nothing."""
    rng = random.Random(seed)
    folder = pathlib.Path(tempfile.mkdtemp(dir=scratch))
    command = rng.choice(commands)
    places = re.findall(r"{(?:out:)?(\w+)}", command)
    if "script" in places:
        places += SCRIPT_READS
    damaged = rng.choice([p for p in places if p in inputs and ("{" + p + "}" in command or p in SCRIPT_READS)])
    outputs = set()

    def fill(match):
        kind = match.group(1)
        if kind.startswith("out:"):
            outputs.add(f"out.{kind[4:]}")
            return f"out.{kind[4:]}"
        data = rng.choice(inputs[kind])
        if kind == damaged:
            binary = kind in ("rig", "baked", "clip", "glb", "template")
            data = damage_binary(rng, data, inputs[kind]) if binary else damage_text(rng, data)
        name = f"{kind}.{ENDINGS.get(kind, 'in')}"
        (folder / name).write_bytes(data)
        return name
    if "script" in places:
        for kind in SCRIPT_READS:
            fill(re.match("(.*)", kind))
    arguments = shlex.split(re.sub(r"{([\w:]+)}", fill, command))
    if rng.random() < 0.1:
        numbers = [i for i, a in enumerate(arguments) if i > 1 and re.fullmatch(r"[\d./-]+", a)]
        if numbers:
            arguments[rng.choice(numbers)] = rng.choice(NUMBERS)
    before = {path.name for path in folder.iterdir()}
    what = ""
    try:
        done = subprocess.run(["prlimit", f"--cpu={SECONDS_AT_MOST}", *limits, program, *arguments], cwd=folder,
                              env=ENVIRONMENT, capture_output=True, timeout=10 * SECONDS_AT_MOST,
                              stdin=subprocess.DEVNULL, check=False)
    except subprocess.TimeoutExpired:
        what = f"not done within {10 * SECONDS_AT_MOST} s"
    else:
        errors = done.stderr.decode("utf-8", "replace")
        written = {path.name for path in folder.iterdir()} - before
        # Materials beside an OBJ file, and beside a rig that is made from one.
        surplus = written - outputs - {"out.mtl", "out.materials.json"}
        if done.returncode not in range(5) or any(word in errors for word in WRONG):
            what = f"exit code {done.returncode}\n{errors}"
        elif re.search(r"[\0-\x08\x0b-\x1f\x7f]", errors):
            what = f"control characters in a message\n{errors!r}"
        elif done.returncode and not errors.startswith("mien: ") and "validate" not in arguments:
            what = f"exit code {done.returncode} without a message\n{errors}"
        elif surplus or (done.returncode and written):
            what = f"exit code {done.returncode}, but left {sorted(surplus or written)}\n{errors}"
    if what:
        kept = findings / f"{seed}"
        shutil.copytree(folder, kept, dirs_exist_ok=True)
        what = f"mien {shlex.join(arguments)}\n{what}"
        (kept / "finding.txt").write_text(what)
        what = f"{kept}: {what}"
    shutil.rmtree(folder)
    return command.split()[0], what


def main():
    parser = argparse.ArgumentParser(description="Runs the program on damaged files.")
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("seconds", type=int)
    parser.add_argument("--plain", action="store_true", help="the program has no sanitizers")
    parser.add_argument("--seed", type=int, default=int(time.time()))
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--only", default="", metavar="COMMAND,...", help="these commands of the program")
    parser.add_argument("--findings", type=pathlib.Path, default=pathlib.Path("build/findings"))
    options = parser.parse_args()
    program = options.program.resolve()
    options.findings.mkdir(parents=True, exist_ok=True)
    limits = ["--as=2147483648"] if options.plain else []  # sanitizers have a limit of their own
    only = options.only.split(",") if options.only else [command.split()[0] for command in COMMANDS]
    commands = [command for command in COMMANDS if command.split()[0] in only]
    if not commands:
        parser.error(f"--only {options.only}: there is no such command here")
    runs, found = {command.split()[0]: 0 for command in commands}, []
    with tempfile.TemporaryDirectory() as scratch:
        made = pathlib.Path(scratch) / "inputs"
        made.mkdir()
        inputs = make_inputs(program, made)
        end = time.monotonic() + options.seconds
        seeds = iter(range(options.seed * 1000000, 1 << 62))

        def counts():
            return f"{sum(runs.values())} runs, seed {options.seed}: " + ", ".join(
                f"{command} {count}" for command, count in sorted(runs.items()))

        def work():
            while time.monotonic() < end and len(found) < 20:
                command, what = one_run(limits, program, commands, inputs, next(seeds), scratch, options.findings)
                runs[command] += 1
                if what:
                    found.append(what)
                    print(what[:3000], flush=True)
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            workers = [pool.submit(work) for _ in range(options.jobs)]
            while concurrent.futures.wait(workers, timeout=60).not_done:
                print(counts(), flush=True)
            for worker in workers:
                worker.result()
    print(f"{counts()}; {len(found)} findings")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()

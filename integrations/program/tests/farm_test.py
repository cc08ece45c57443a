#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`mien farm`: the same bytes for any cut, bad takes, killed workers, full disks, --resume by content, submissions.

    cli_farm_test.py path/to/mien [unittest options]      (or MIEN_BIN=path/to/mien)
"""
import hashlib
import json
import os
import resource
import shutil
import signal
import subprocess
import sys
import time
import unittest
import xml.etree.ElementTree as ElementTree

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "tests", "support"))
import program  # noqa: E402
from program import USAGE, INVALID, FILE, ProgramTest, main, make, make_folder, path, read, write  # noqa: E402

TAKES = 6
FRAMES = 20


def setUpModule():
    make_folder()
    make("gen", "--preset", "small", "--seed", "3", "-o", path("ada.dna"))
    make("gen", "--preset", "tiny", "--seed", "4", "-o", path("bob.dna"))
    make("bake", path("ada.dna"), "-o", path("ada.rig"))
    names = program.run("info", path("bob.dna"), "--names", "raw").stdout.decode().split()
    for take in range(TAKES):
        rows = "\n".join(f"{f / 30}," + ",".join(str((take + f + c) % 7 / 7) for c in range(len(names)))
                         for f in range(FRAMES))
        write(f"line_{take}.csv", "time," + ",".join(names) + "\n" + rows + "\n")
        make("clip", "build", path(f"line_{take}.csv"), "-o", path(f"line_{take}.clip"))


def job(name, outputs, rigs=("ada.dna", "bob.dna"), takes=("line_*.clip",), **more):
    content = {"rigs": list(rigs), "takes": list(takes),
               "outputs": [dict(output, path=f"{name}/" + output["path"]) for output in outputs], **more}
    return write(f"{name}.json", json.dumps(content))


JOINTS = {"kind": "joints", "path": "{rig}/{take}.npy"}
VERTICES = {"kind": "vertices", "path": "{rig}/{take}.points.npy"}
GLB = {"kind": "glb", "path": "{rig}/{take}.glb"}
PNG = {"kind": "png", "path": "{rig}/{take}.{frame}.png", "size": "16", "samples": "1", "meshes": "*"}


def tree(name):
    """The files of an output folder and their contents."""
    files = {}
    for folder, _, names in os.walk(path(name)):
        for file in names:
            whole = os.path.join(folder, file)
            with open(whole, "rb") as stream:
                files[os.path.relpath(whole, path(name))] = hashlib.sha256(stream.read()).hexdigest()
    return files


def lines(name):
    """Lines of all records of a job."""
    found = []
    for file in os.listdir(path(f"{name}.farm")):
        with open(path(f"{name}.farm/{file}")) as stream:
            found += [json.loads(line) for line in stream]
    return found


class FarmTest(ProgramTest):
    def test_files_are_the_same_for_any_cut(self):
        outputs = [JOINTS, VERTICES, GLB]
        self.ok("farm", job("whole", outputs))
        cut = job("cut", outputs)
        for piece in (4, 2, 5, 1, 3):
            self.ok("farm", cut, "--piece", f"{piece}/5")
        whole = tree("whole")
        self.assertEqual(len(whole), 2 * TAKES * 3)
        self.assertEqual(whole, tree("cut"))

    def test_frames_are_cut_too(self):
        outputs = [PNG, dict(JOINTS, path="{rig}/{take}.{frame}.npy")]
        self.ok("farm", job("images", outputs, takes=["line_0.clip"], block=20))
        cut = job("image_cut", outputs, takes=["line_0.clip"], block=6)
        for piece in range(1, 4):
            self.ok("farm", cut, "--piece", f"{piece}/3")
        self.assertEqual(len(tree("images")), 2 * FRAMES * 2)
        self.assertEqual(tree("images"), tree("image_cut"))

    def test_results_are_those_of_eval_and_of_baked_rigs(self):
        self.ok("farm", job("plain", [JOINTS], rigs=["ada.dna"], isa="best"))
        self.ok("farm", job("baked", [JOINTS], rigs=["ada.rig"], isa="best"))
        self.assertEqual(tree("plain"), tree("baked"))
        self.ok("clip", "export", path("line_2.clip"), "-o", path("line_2.json"))
        self.ok("eval", path("ada.dna"), "--input", path("line_2.json"), "-o", path("line_2.npy"))
        self.assertEqual(read("plain/ada/line_2.npy"), read("line_2.npy"))

    def test_files_are_the_same_on_other_machines(self):
        outputs = [JOINTS, VERTICES, GLB, PNG]
        takes = ["line_0.csv"]
        self.ok("farm", job("here", outputs, takes=takes))
        # The variable is what a machine without other instruction sets would choose.
        self.ok("farm", job("elsewhere", outputs, takes=takes), env={"MIEN_ISA": "scalar"})
        self.assertEqual(tree("here"), tree("elsewhere"))
        self.ok("farm", job("scalar", outputs, takes=takes, isa="scalar"))
        self.assertEqual(tree("here"), tree("scalar"))
        if b"fma" not in (read("/proc/cpuinfo") if os.path.exists("/proc/cpuinfo") else b""):
            self.skipTest("NOT TESTED: that the fastest kernels give other bits; this CPU has no FMA")
        self.ok("farm", job("fastest", outputs, takes=takes, isa="best"))
        self.assertNotEqual(tree("here"), tree("fastest"))

    @unittest.skipUnless(shutil.which("qemu-x86_64"), "NOT TESTED: a farm with an older CPU; there is no qemu-x86_64")
    def test_files_are_the_same_on_an_older_cpu(self):
        outputs = [JOINTS, VERTICES, GLB, PNG]
        self.ok("farm", job("new_cpu", outputs, rigs=["bob.dna"], takes=["line_0.csv"]))
        older = job("old_cpu", outputs, rigs=["bob.dna"], takes=["line_0.csv"])
        done = subprocess.run(["qemu-x86_64", "-cpu", "Nehalem", program.mien, "farm", older], capture_output=True,
                              check=False, timeout=120)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(tree("new_cpu"), tree("old_cpu"))

    def test_takes_are_resampled(self):
        self.ok("farm", job("rate", [JOINTS], rigs=["ada.dna"], takes=["line_1.csv", "line_2.clip"], rate=60))
        self.ok("farm", job("own_rate", [JOINTS], rigs=["ada.dna"], takes=["line_1.csv", "line_2.clip"]))
        for take in ("line_1", "line_2"):
            self.assertIn(b"(%d," % (2 * FRAMES - 1), read(f"rate/ada/{take}.npy")[:128])
            self.assertIn(b"(%d," % FRAMES, read(f"own_rate/ada/{take}.npy")[:128])

    def test_bad_takes_do_not_stop_the_others(self):
        write("line_bad.clip", b"not a clip")
        self.addCleanup(os.remove, path("line_bad.clip"))
        takes = ["line_0.clip", "line_bad.clip", "line_missing.clip", "line_1.clip"]
        done = program.run("farm", job("bad", [JOINTS], rigs=["ada.dna"], takes=takes))
        self.assertEqual(done.returncode, FILE)  # the worst: one is missing
        self.assertIn("2 of 4 tasks failed", done.stderr)
        self.assertEqual(sorted(tree("bad")), ["ada/line_0.npy", "ada/line_1.npy"])
        errors = {os.path.basename(line["take"]): line["error"] for line in lines("bad") if "error" in line}
        self.assertEqual(sorted(errors), ["line_bad.clip", "line_missing.clip"])
        self.assertIn("cannot open clip", errors["line_bad.clip"])

    def test_resume_does_what_is_missing_or_changed(self):
        def kept(name):
            done = self.ok("farm", path(f"{name}.json"), "--resume").stdout.decode()
            return int(done.split(" already there")[0].split()[-1])

        self.ok("farm", job("resume", [JOINTS], rigs=["ada.dna"]))
        before = tree("resume")
        self.assertEqual(kept("resume"), TAKES)
        os.remove(path("resume/ada/line_0.npy"))
        with open(path("resume/ada/line_3.npy"), "r+b") as file:  # the size stays
            file.seek(200)
            file.write(b"\xff")
        self.assertEqual(kept("resume"), TAKES - 2)
        self.assertEqual(tree("resume"), before)
        # Another take of the same name, then other settings.
        original = read("line_4.clip")
        self.addCleanup(write, "line_4.clip", original)
        write("line_4.clip", read("line_5.clip"))
        self.assertEqual(kept("resume"), TAKES - 1)
        self.assertNotEqual(tree("resume"), before)
        job("resume", [JOINTS], rigs=["ada.dna"], rate=60)
        self.assertEqual(kept("resume"), 0)
        # Half a line, as a killed worker leaves it.
        write("resume.farm/torn.jsonl", '{"rig": "ada')
        self.assertEqual(kept("resume"), TAKES)

    def test_a_killed_worker_loses_what_it_was_at(self):
        slow = job("killed", [dict(PNG, size="256", samples="4")], rigs=["ada.dna"], block=2)
        worker = subprocess.Popen([program.mien, "farm", slow], stdout=subprocess.DEVNULL)
        while not os.path.isdir(path("killed/ada")) or len(os.listdir(path("killed/ada"))) < 5:
            self.assertIsNone(worker.poll())
            time.sleep(0.01)
        worker.send_signal(signal.SIGKILL)
        worker.wait()
        there = len(tree("killed"))
        self.assertLess(there, TAKES * FRAMES)
        self.assertGreaterEqual(2 * len(lines("killed")), there - 3)
        for name in os.listdir(path("killed/ada")):  # whole files only
            self.assertTrue(read(f"killed/ada/{name}").endswith(b"IEND\xaeB`\x82"), name)

    def test_a_full_disk_leaves_no_parts(self):
        rigs, takes = ["ada.dna", "bob.dna"], ["line_0.clip"]
        self.ok("farm", job("roomy", [JOINTS], rigs=rigs, takes=takes))
        small, large = (os.path.getsize(path(f"roomy/{rig}/line_0.npy")) for rig in ("bob", "ada"))
        self.assertLess(small + 2000, large)

        def limit():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (large - 1000, large - 1000))

        full = job("full", [JOINTS], rigs=rigs, takes=takes)
        done = subprocess.run([program.mien, "farm", full], capture_output=True, preexec_fn=limit)
        self.assertEqual(done.returncode, FILE)
        self.assertEqual(sorted(tree("full")), ["bob/line_0.npy"])  # the small one fits
        self.assertFalse(any(os.scandir(path("full/ada"))))

    def test_a_disk_that_is_really_full(self):
        """A file system of a few pages, which only the commands below see."""
        rigs, takes = ["ada.dna", "bob.dna"], ["line_0.clip"]
        self.ok("farm", job("large_disk", [JOINTS], rigs=rigs, takes=takes))
        pages = os.path.getsize(path("large_disk/bob/line_0.npy")) // 4096 + 1
        self.assertGreater(os.path.getsize(path("large_disk/ada/line_0.npy")), 4096 * pages)
        os.makedirs(path("small_disk"))

        def mounted(script):
            words = ["unshare", "--map-root-user", "--mount", "sh", "-ec",
                     f"mount -t tmpfs -o size={4096 * pages} none {path('small_disk')}\n{script}"]
            return subprocess.run(words, capture_output=True, check=False, text=True, timeout=60)

        if not shutil.which("unshare") or mounted("true").returncode != 0:
            self.skipTest("NOT TESTED: a farm on a full file system; unshare and mount are not permitted")
        farm = f"'{program.mien}' farm '{job('small_disk', [JOINTS], rigs=rigs, takes=takes)}'"
        done = mounted(f"cd {path('small_disk')}\n{farm} || echo \"code $?\"\nfind . -name '*line_0*' -o -name '.mien*'\n"
                       f"mount -o remount,size=1m .\n{farm} --resume\nsha256sum */line_0.npy")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("No space left on device", done.stderr)
        lines_there = done.stdout.splitlines()
        self.assertIn(f"code {FILE}", lines_there)
        self.assertIn("./bob/line_0.npy", lines_there)  # it fits once the part of the other one is gone
        self.assertFalse([line for line in lines_there if ".mien" in line or line == "./ada/line_0.npy"])
        self.assertIn("1 done, 1 already there, 0 failed", done.stdout)
        self.assertEqual({line.split()[1]: line.split()[0] for line in lines_there[-2:]}, tree("large_disk"))

    def test_captured_takes_are_solved(self):
        self.ok("farm", job("captured", [JOINTS], rigs=["bob.dna"], takes=["line_0.clip"]))
        solved = {"kind": "clip", "solve": "joints", "path": "{rig}/{take}.clip"}
        self.ok("farm", job("solved", [solved], rigs=["bob.dna"], takes=["captured/bob/line_0.npy"]))
        self.ok("solve", path("bob.dna"), path("captured/bob/line_0.npy"), "--kind", "joints", "-o",
                    path("one.clip"))
        self.assertEqual(read("solved/bob/line_0.clip"), read("one.clip"))

    def test_ranks_of_mpi_are_pieces(self):
        ranks = job("ranks", [JOINTS])
        for names in (("OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"), ("PMI_RANK", "PMI_SIZE"),
                      ("SLURM_PROCID", "SLURM_NTASKS")):
            shutil.rmtree(path("ranks"), ignore_errors=True)
            for rank in range(3):
                environment = dict(os.environ, **{names[0]: str(rank), names[1]: "3"})
                subprocess.run([program.mien, "farm", ranks, "--piece", "mpi"], env=environment, check=True,
                               stdout=subprocess.DEVNULL)
            self.assertEqual(len(tree("ranks")), 2 * TAKES)
        self.fails(USAGE, "farm", ranks, "--piece", "mpi")

    def test_plan(self):
        write("line_bad.clip", b"not a clip")
        self.addCleanup(os.remove, path("line_bad.clip"))
        planned = job("planned", [JOINTS, VERTICES])
        plan = json.loads(self.ok("farm", planned, "--plan", "--json", "--pieces", "4").stdout)
        self.assertEqual((plan["rigs"], plan["takes"], plan["tasks"]), (2, TAKES + 1, 2 * (TAKES + 1)))
        self.assertEqual(plan["frames"], 2 * TAKES * FRAMES)
        self.assertEqual([os.path.basename(take) for take in plan["bad_takes"]], ["line_bad.clip"])
        self.assertEqual(sum(piece["tasks"] for piece in plan["pieces"]), plan["tasks"])
        self.assertEqual(sum(piece["frames"] for piece in plan["pieces"]), plan["frames"])
        self.assertGreater(plan["sample"]["cpu_seconds"], 0)
        self.assertFalse(os.path.exists(path("planned")))
        self.assertIn("pieces of about", self.ok("farm", planned, "--plan").stdout.decode())

    def test_wrong_jobs(self):
        def wrong(text, *what, **more):
            name = job("wrong", *what, **more)
            self.fails(INVALID, "farm", name, says=text)

        wrong("{rig}", [dict(JOINTS, path="{take}.npy")])
        wrong("{take}", [dict(JOINTS, path="{rig}.npy")])
        wrong("{frame}", [dict(PNG, path="{rig}/{take}.png")])
        wrong("{shot}", [dict(JOINTS, path="{rig}/{take}.{shot}.npy")])
        wrong("same path", [JOINTS, JOINTS])
        wrong("did you mean \"joints\"", [dict(JOINTS, kind="joint")])
        wrong("camera", [dict(JOINTS, camera="front")])
        wrong("two jobs", [JOINTS, {"kind": "clip", "path": "{rig}/{take}.clip"}])
        wrong("no file matches", [JOINTS], takes=["nothing_*.clip"])
        wrong("two files are named", [JOINTS], rigs=["ada.dna", "ada.rig"])
        wrong("frames per second", [JOINTS], rate="fast")
        wrong("from 0 to 32", [JOINTS], lod=99)
        self.fails(INVALID, "farm", write("broken.json", '{"rigs": ['))
        self.fails(FILE, "farm", path("none.json"))
        right = job("right", [JOINTS])
        for piece in ("0/4", "5/4", "4", "a/b", "1/0"):
            self.fails(USAGE, "farm", right, "--piece", piece)
        self.fails(USAGE, "farm", right, "--engine", "slurm")
        self.fails(USAGE, "farm", right, "--write", path("submit"))
        self.fails(USAGE, "farm", right, "--json")


class SubmissionTest(ProgramTest):
    """What is written for schedulers starts every piece once; ctest farm_engines runs some of them."""

    def submit(self, engine):
        name = job(f"for {engine}", [JOINTS])
        folder = path(f"submit_{engine}")
        self.ok("farm", name, "--engine", engine, "--write", folder, "--pieces", "3")
        return {file: read(f"submit_{engine}/{file}").decode() for file in os.listdir(folder)}, name

    def assert_all_done(self, name):
        self.assertEqual(len(tree(os.path.splitext(os.path.basename(name))[0])), 2 * TAKES)

    def test_slurm(self):
        files, name = self.submit("slurm")
        script = files["slurm_farm.sh"]
        self.assertIn("#SBATCH --array=1-3\n", script)
        for piece in range(1, 4):
            subprocess.run(["sh", path("submit_slurm/slurm_farm.sh")], check=True, stdout=subprocess.DEVNULL,
                           env=dict(os.environ, SLURM_ARRAY_TASK_ID=str(piece)))
        self.assert_all_done(name)

    def test_opencue(self):
        files, name = self.submit("opencue")
        spec = ElementTree.fromstring(files["opencue_job.xml"])
        # As the DTD of the job specification orders them.
        self.assertEqual([part.tag for part in spec], ["facility", "show", "shot", "user", "uid", "job"])
        self.assertEqual([part.tag for part in spec.find("job")], ["paused", "maxretries", "layers"])
        layer = spec.find("job/layers/layer")
        self.assertEqual([part.tag for part in layer], ["cmd", "range", "chunk", "cores", "services"])
        self.assertEqual(layer.get("type"), "Render")
        self.assertRegex(spec.find("job").get("name"), r"^[\w.-]+$")
        first, last = map(int, layer.findtext("range").split("-"))
        for piece in range(first, last + 1):
            subprocess.run(layer.findtext("cmd").replace("#IFRAME#", str(piece)), shell=True, check=True,
                           stdout=subprocess.DEVNULL)
        self.assert_all_done(name)

    def test_deadline(self):
        files, name = self.submit("deadline")
        info = dict(line.split("=", 1) for line in files["job_info.txt"].splitlines())
        plugin = dict(line.split("=", 1) for line in files["plugin_info.txt"].splitlines())
        self.assertEqual((info["Plugin"], info["Frames"], info["ChunkSize"]), ("CommandLine", "1-3", "1"))
        for piece in range(1, 4):
            words = plugin["Arguments"].replace("<STARTFRAME>", str(piece)).replace("<QUOTE>", '"')
            subprocess.run(f'"{plugin["Executable"]}" {words}', shell=True, check=True, stdout=subprocess.DEVNULL)
        self.assert_all_done(name)

    def test_openjd(self):
        files, name = self.submit("openjd")
        template = json.loads(files["template.json"])
        self.assertEqual(template["specificationVersion"], "jobtemplate-2023-09")
        step, = template["steps"]
        parameter, = step["parameterSpace"]["taskParameterDefinitions"]
        self.assertEqual(parameter, {"name": "Piece", "type": "INT", "range": "1-3"})
        run = step["script"]["actions"]["onRun"]
        for piece in range(1, 4):
            words = [word.replace("{{Task.Param.Piece}}", str(piece)) for word in run["args"]]
            subprocess.run([run["command"]] + words, check=True, stdout=subprocess.DEVNULL)
        self.assert_all_done(name)

    def test_flamenco(self):
        files, name = self.submit("flamenco")
        submitted = json.loads(files["job.json"])
        self.assertEqual(submitted["type"], "mien-farm")
        if not shutil.which("node"):
            self.skipTest("NOT TESTED: the job type of Flamenco; there is no node")
        # The two constructors that Flamenco gives to job types.
        host = ("const author = {Task: (name, type) => ({name, type, commands: [], addCommand(c) "
                "{ this.commands.push(c); }}), Command: (name, parameters) => ({name, parameters})};\n"
                "const tasks = [];\n" + files["mien-farm.js"] +
                "\ncompileJob({settings: %s, addTask: (task) => tasks.push(task)});\n"
                "console.log(JSON.stringify({tasks, type: JOB_TYPE}));" % json.dumps(submitted["settings"]))
        made = json.loads(subprocess.run(["node", "-e", host], check=True, capture_output=True).stdout)
        self.assertEqual({setting["key"] for setting in made["type"]["settings"]}, set(submitted["settings"]))
        for task in made["tasks"]:
            command, = task["commands"]
            self.assertEqual(command["name"], "exec")
            subprocess.run([command["parameters"]["exe"]] + command["parameters"]["args"], check=True,
                           stdout=subprocess.DEVNULL)
        self.assert_all_done(name)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`mien farm` under schedulers that really run: an array job of Slurm on this machine, Dask with two processes.

    farm_engines.py path/to/mien [unittest options]

Slurm wants munged, slurmctld, slurmd and the rights of root (Debian: slurmctld slurmd slurm-client munge), Dask
python3-distributed. What is missing is told and skipped.
"""
import os
import shutil
import subprocess
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "tests", "support"))
import farm_test  # noqa: E402
from program import ProgramTest, main, path, write  # noqa: E402

setUpModule = farm_test.setUpModule
SECONDS = 60  # until a daemon answers


def wait_for(what, *command):
    for _ in range(SECONDS * 5):
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode == 0 and what in done.stdout:
            return
        time.sleep(0.2)
    raise AssertionError(f"{command}: {done.stdout}{done.stderr}")


class EnginesTest(ProgramTest):
    def submit(self, engine):
        name = farm_test.job(engine, [farm_test.JOINTS, farm_test.VERTICES])
        self.ok("farm", name, "--engine", engine, "--write", path(f"submit_{engine}"), "--pieces", "3")
        whole = farm_test.job("whole", [farm_test.JOINTS, farm_test.VERTICES])
        self.ok("farm", whole)
        return farm_test.tree("whole")

    def start(self, *command):
        log = open(path(os.path.basename(command[0]) + ".log"), "wb")
        daemon = subprocess.Popen(command, stdout=log, stderr=log, env=dict(os.environ, SLURM_CONF=path("slurm.conf")))
        log.close()
        self.addCleanup(daemon.wait)
        self.addCleanup(daemon.terminate)

    def test_slurm_array(self):
        tools = [tool for tool in ("munged", "slurmctld", "slurmd", "sbatch")
                 if not shutil.which(tool, path="/usr/sbin:/usr/bin:" + os.environ["PATH"])]
        if tools or os.geteuid() != 0:
            self.skipTest("NOT TESTED: an array job of Slurm; " +
                          ("there is no " + ", ".join(tools) if tools else "its daemons need root"))
        wanted = self.submit("slurm")
        host = os.uname().nodename
        os.chmod(path(""), 0o755)
        os.makedirs(path("munge"), 0o755, exist_ok=True)
        os.makedirs(path("spool"), exist_ok=True)
        with open(path("munge/key"), "wb") as key:
            os.chmod(path("munge/key"), 0o400)
            key.write(os.urandom(128))
        socket = path("munge/socket")
        write("slurm.conf", f"""ClusterName=mien
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort=27817
SlurmdPort=27818
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={socket}
CredType=cred/munge
StateSaveLocation={path("spool")}
SlurmdSpoolDir={path("spool")}
SlurmctldPidFile={path("slurmctld.pid")}
SlurmdPidFile={path("slurmd.pid")}
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
SchedulerParameters=sched_interval=1
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes={host} Default=YES State=UP
""")
        self.start("/usr/sbin/munged", "--foreground", "--force", "--socket", socket, "--key-file", path("munge/key"),
                   "--pid-file", path("munge/pid"), "--seed-file", path("munge/seed"), "--log-file", path("munge/log"))
        while not os.path.exists(socket):
            time.sleep(0.05)
        self.start("/usr/sbin/slurmctld", "-D", "-f", path("slurm.conf"))
        self.start("/usr/sbin/slurmd", "-D", "-N", host, "-f", path("slurm.conf"))
        os.environ["SLURM_CONF"] = path("slurm.conf")
        self.addCleanup(os.environ.pop, "SLURM_CONF")
        wait_for("idle", "sinfo", "--noheader", "--format=%t")
        done = subprocess.run(["sbatch", "--wait", f"--output={path('array-%a.log')}", path("submit_slurm/slurm_farm.sh")],
                              capture_output=True, text=True, timeout=120, cwd=path(""))
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual(farm_test.tree("slurm"), wanted)
        self.assertEqual(len(os.listdir(path("slurm.farm"))), 3)  # a record of each piece

    def test_dask(self):
        if subprocess.run([sys.executable, "-c", "import distributed"], capture_output=True).returncode != 0:
            self.skipTest("NOT TESTED: a cluster of Dask; there is no python3-distributed")
        wanted = self.submit("dask")
        done = subprocess.run([sys.executable, path("submit_dask/dask_farm.py")], capture_output=True, text=True,
                              timeout=120, cwd=path(""))
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual(done.stdout.count(": done"), 3)
        self.assertEqual(farm_test.tree("dask"), wanted)


if __name__ == "__main__":
    main()

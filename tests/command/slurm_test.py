#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""scripts/farm_slurm on a Slurm of two nodes that runs on this machine, in process numbers of its own: they end with the test, whatever
happens. Needs root."""
import os
import secrets
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

from farm_test import Farm
from support import FRAGTRACE, SCENES, main

BALL = SCENES / "room-ball.gltf"
PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol")
PRIVATE = ("unshare", "--pid", "--mount-proc", "--fork", "--kill-child")
NODES = ("farm-a", "farm-b")
# Short times, where Slurm would notice a dead node, or begin a job again, after minutes.
CONF = """ClusterName=farm
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthInfo=socket={folder}/munge.socket,cred_expire=5
SlurmctldPort={ports[0]}
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/%n.pid
SlurmdSpoolDir={folder}/%n
StateSaveLocation={folder}/state
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SchedulerParameters=sched_interval=1,bf_interval=1
SlurmdTimeout=8
ReturnToService=2
NodeName={nodes[0]} NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[1]} CPUs=1
NodeName={nodes[1]} NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[2]} CPUs=1
PartitionName=all Nodes=ALL Default=YES State=UP
"""


def free_ports(count):
    held = [socket.socket() for _ in range(count)]
    for one in held:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in held]
    for one in held:
        one.close()
    return ports


def why_not():
    """Why there can be no Slurm here; empty where there can be."""
    missing = [name for name in PROGRAMS if shutil.which(name) is None]
    if missing:
        return f"Slurm is not installed ({', '.join(missing)}): scripts/setup slurm"
    if os.geteuid() != 0:
        return "only root can start a Slurm"
    tried = subprocess.run([*PRIVATE, "true"], capture_output=True, text=True)
    return f"no process numbers of our own: {tried.stderr.strip()}" if tried.returncode else ""


def parent(process):
    return int(Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[1])


class FarmSlurm(Farm):
    WORDS = ("render", BALL, "-o", "x.exr", "--quiet", "--resolution", "100,80", "--spp", 1500, "--checkpoint", 0.2)

    @classmethod
    def setUpClass(cls):
        reason = why_not()
        if reason:
            raise unittest.SkipTest(reason)
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.slurm = Path(folder.name)
        (cls.slurm / "munge.key").write_bytes(secrets.token_bytes(1024))
        (cls.slurm / "munge.key").chmod(0o400)
        for name in ("state", *NODES):
            (cls.slurm / name).mkdir()
        host = socket.gethostname().split(".")[0]
        (cls.slurm / "slurm.conf").write_text(CONF.format(host=host, folder=cls.slurm, ports=free_ports(3), nodes=NODES))
        os.environ["SLURM_CONF"] = str(cls.slurm / "slurm.conf")
        os.environ.pop("SBATCH", None)
        cls.daemon("munged", "--foreground", "--force", *(f"--{kind}={cls.slurm}/{name}" for kind, name in (
            ("key-file", "munge.key"), ("socket", "munge.socket"), ("pid-file", "munged.pid"), ("seed-file", "munged.seed"))))
        cls.wait(lambda: (cls.slurm / "munge.socket").exists(), "munged")
        cls.daemon("slurmctld", "-D")
        for node in NODES:
            cls.daemon("slurmd", "-D", "-N", node)
        for node in NODES:
            cls.wait(lambda: cls.ask("sinfo", "-h", "-n", node, "-o", "%t") == "idle", node)

    @classmethod
    def daemon(cls, *words):
        log = open(cls.slurm / f"{words[0]}.log", "ab")
        cls.addClassCleanup(log.close)
        process = subprocess.Popen(words, stdout=log, stderr=log)
        cls.addClassCleanup(process.wait)
        cls.addClassCleanup(process.kill)
        return process

    @classmethod
    def ask(cls, *words):
        return subprocess.run(words, capture_output=True, text=True, timeout=60).stdout.strip()

    @classmethod
    def wait(cls, condition, what, seconds=60):
        deadline = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > deadline:
                logs = "\n".join(log.read_text() for log in sorted(cls.slurm.glob("*.log")))
                raise AssertionError(f"{what}: not within {seconds} s\n{logs}")
            time.sleep(0.2)

    def farm(self, *words):
        return self.script("farm_slurm", "--wait", *words)

    def states(self):
        return {path.stem: path.read_text() for path in self.folder.glob("farm-*/*.state")}

    def logs(self):
        return "\n".join(f"{path.name}:\n{path.read_text()}" for path in sorted(self.folder.glob("farm-*/*.log")))

    def finishes(self, process):
        out, error = process.communicate(timeout=240)
        self.assertEqual(process.returncode, 0, out + error + self.logs())
        self.assertFalse((self.folder / "x.exr.parts").exists())
        self.assertEqual({name: state.split()[0] for name, state in self.states().items()},
                         {name: "finished" for name in ("0000", "0001", "0002", "merge")})
        self.assertIn("3 parts, 1500 samples per pixel", (next(self.folder.glob("farm-*")) / "merge.log").read_text())
        return (self.folder / "x.exr").read_bytes()

    def unbroken(self):
        (self.folder / "x.exr").unlink()
        for line in self.parts(3, *self.WORDS):
            subprocess.run(line, shell=True, check=True, cwd=self.folder, stdout=subprocess.DEVNULL)
        return (self.folder / "x.exr").read_bytes()

    def test_a_worker_that_is_killed_begins_again(self):
        process = self.farm(3, *self.WORDS)
        os.kill(self.worker(), signal.SIGKILL)
        second = self.farm(3, *self.WORDS)
        self.assertIn("in the queue already", second.communicate(timeout=60)[1])
        self.assertEqual(second.returncode, 1)
        picture = self.finishes(process)
        self.assertIn("queued again after status 137", self.logs())
        self.assertEqual(picture, self.unbroken())

    def test_a_node_that_dies_costs_nothing_but_time(self):
        process = self.farm(3, *self.WORDS)
        worker = self.worker()
        node = self.states()["0001"].split()[-1].strip(")")
        step = parent(parent(worker))  # slurmstepd
        for entry in Path("/proc").glob("[0-9]*"):
            words = (entry / "cmdline").read_bytes().split(b"\0")
            if words[0].endswith(b"slurmd") and node.encode() in words:
                os.kill(int(entry.name), signal.SIGKILL)
        os.kill(step, signal.SIGKILL)
        # Stopped only now: the system hangs up on stopped processes whose group loses its last parent in the session.
        self.wait(lambda: parent(parent(worker)) != step, "the step's end")
        os.kill(worker, signal.SIGSTOP)
        # The renderer lives on, stopped, while Slurm begins the part elsewhere: the two must not write one file.
        try:
            self.wait(lambda: "waits for an earlier run" in self.states()["0001"], "the second run", 120)
        except AssertionError as error:
            stopped = Path(f"/proc/{worker}/status")
            alive = stopped.read_text() if stopped.exists() else "it is gone"
            raise AssertionError(f"{error}\n{self.states()}\nthe stopped worker: {alive}\n{self.logs()}") from None
        os.kill(worker, signal.SIGKILL)
        picture = self.finishes(process)
        self.daemon("slurmd", "-D", "-N", node)
        self.wait(lambda: self.ask("sinfo", "-h", "-n", node, "-o", "%t") == "idle", node)
        self.assertEqual(picture, self.unbroken())

    def test_a_part_that_fails_for_good_ends_all_and_goes_on_later(self):
        words = (2, "render", "scene.gltf", "-o", "x.exr", "--quiet", "--resolution", "16,16", "--spp", 4)
        process = self.farm(*words)
        error = process.communicate(timeout=120)[1]
        self.assertEqual(process.returncode, 1)
        self.assertIn("0000: failed for good with status 3", error)
        self.assertIn("merge: queued", error)
        self.assertFalse((self.folder / "x.exr").exists())
        for path in SCENES.glob("furnace*"):
            (self.folder / path.name.replace("furnace.gltf", "scene.gltf")).write_bytes(path.read_bytes())
        process = self.farm(*words)
        out, error = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 0, out + error + self.logs())
        self.assertTrue((self.folder / "x.exr").exists())

    def test_words_that_cannot_be_submitted(self):
        for options, says in (("--partition=none", "sbatch failed"), ("--no-such-option", "sbatch failed")):
            process = self.script("farm_slurm", 2, *self.WORDS, SBATCH=options)
            self.assertIn(says, process.communicate(timeout=60)[1])
            self.assertEqual(process.returncode, 1)
        process = self.script("farm_slurm", 2, "render", BALL)
        self.assertIn("-o OUTPUT is missing", process.communicate(timeout=60)[1])
        self.assertEqual(process.returncode, 2)


def as_first_process():
    """Runs the tests in a child. The first process takes over what others leave behind; with it all others end."""
    tests = os.fork()
    if tests == 0:
        main()
    while True:
        process, status = os.wait()
        if process == tests:
            os._exit(os.waitstatus_to_exitcode(status) & 255)


if __name__ == "__main__":
    if os.getpid() == 1:
        as_first_process()
    if why_not():
        main()
    os.execvp(PRIVATE[0], [*PRIVATE, sys.executable, *sys.argv])

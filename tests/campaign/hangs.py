# SPDX-License-Identifier: MIT
"""Starts of the whole command on small files, while eight busy loops compete for the processors, with random delays at the program's starts of
other programs, sockets, locks, reads and writes. A start hangs when its processes used no processor for 10 s and are not done; the
backtraces of all its threads are kept, where gdb is there."""
import atexit
import random
import resource
import shutil
import subprocess
import sys
import time

from common import Finding, Run, Stopped, must, preloaded, processor_seconds, run, session_of, stop

ASKED = {"starts": 20000}
REPEATS = 100  # of a finding, before it counts as mended
JOBS = 6  # most of a start waits for a processor
LOOPS = 8
PATIENCE = 10.0  # seconds without processor time
DELAY = 3000  # microseconds
ADDRESSES = 6 << 30  # bytes, for every third start: the setting of the one that was seen


def commands(ground):
    box, textured = (ground.scenes / f"{name}.gltf" for name in ("cornell-box", "sphere-textured"))
    tiny = "--resolution 32,32 --spp 1 --quiet".split()
    return [["info", textured], ["info", "--json", box], *(["render", scene, "-o", f"x.{kind}", *tiny] for scene in (box, textured) for kind in ("pfm", "png", "exr")),
            ["render", box, "-o", "x.png", *tiny, "--denoise", "variance"], ["merge", ground.folder / "a.exr", ground.folder / "b.exr", "-o", "x.exr"],
            ["diff", ground.scenes / "graticule.png", ground.scenes / "graticule.png"]]


def prepare(ground):
    for i, name in enumerate(("a.exr", "b.exr")):
        must(run(ground, ["render", ground.scenes / "cornell-box.gltf", "-o", name, "--resolution", "32,32", "--spp", "1", "--quiet", "--sample-offset", i],
                 ground.folder), 0)
    # They end with this process, whatever ends it.
    text = "import os\nwhile os.getppid() != 1:\n for _ in range(1000000): pass"
    loops = [subprocess.Popen([sys.executable, "-c", text], start_new_session=True) for _ in range(2 if ground.brief else LOOPS)]
    atexit.register(done, loops)
    return loops


def done(loops):
    for loop in loops:
        loop.kill()
        loop.wait()


def backtraces(pids, folder):
    """Writes the stacks of all threads of all processes into files that are kept with the finding."""
    for pid in pids:
        if shutil.which("gdb"):
            with open(folder / f"backtrace-{pid}", "wb") as file:
                subprocess.run(["gdb", "-p", str(pid), "-batch", "-ex", "thread apply all bt"], stdout=file, stderr=subprocess.STDOUT, timeout=120)


def limited():
    resource.setrlimit(resource.RLIMIT_AS, (ADDRESSES, ADDRESSES))


def watched(process, folder):
    """Waits for the end, or for a hang."""
    used, moved = -1.0, time.monotonic()
    while process.process.poll() is None:
        if stop.is_set():
            raise Stopped
        time.sleep(0.05)
        pids = session_of(process.pid)
        now = processor_seconds(pids)
        if now != used:
            used, moved = now, time.monotonic()
        elif time.monotonic() - moved > PATIENCE:
            backtraces(pids, folder)
            raise Finding(f"hangs after {used:.2f} s of processor time: {' '.join(process.words)}; backtraces of {pids} are kept")
    return process.result()


def case(ground, _, number, folder):
    dice = random.Random(f"hangs {number}")
    words = dice.choice(commands(ground))
    environment = preloaded(ground, delay=f"{number},{DELAY}") if number % 2 else None
    with Run(words, folder, environment, ground.fragtrace, limited if number % 3 == 0 else None) as process:
        must(watched(process, folder), 0)
        process.leaves_nobody()
    return {"starts": 1}

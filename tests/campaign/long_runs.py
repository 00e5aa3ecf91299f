# SPDX-License-Identifier: MIT
"""Long runs whose memory, handles and objects of OpenGL are watched: sequences of a thousand pictures, a thousand loads in one process
(tests/probe/load_rounds.cpp), and the viewer under random events (tests/viewer/random_events_test.py) for ten minutes each."""
import os
import re
import statistics
import subprocess
import time
from pathlib import Path

from common import Finding, Run, Stopped, build_target, must, stop, view

ASKED = {"frames": 100_000, "loads": 10_000, "seconds of the viewer": 28_800}
BRIEF = False
JOBS = 1
FRAMES, LOADS, SECONDS = 1000, 1000, 700
MOST_GROWTH = 5.0  # MiB, from the first quarter of the frames on
SCENES = ("cornell-box", "sphere-textured", "room-ball", "foggy")


def prepare(ground):
    build_target(ground, "release", "load_rounds")


def target(link):
    try:
        return os.readlink(link)
    except OSError:  # closed meanwhile
        return ""


def held(pid, folder):
    """MiB and open files of a process that runs, without the picture that it writes into the folder."""
    try:
        resident = re.search(r"VmRSS:\s*(\d+)", Path(f"/proc/{pid}/status").read_text())
        files = [target(link) for link in Path(f"/proc/{pid}/fd").iterdir()]
        return int(resident[1]) / 1024, sum(not name.startswith(f"{folder}/") and name != "" for name in files)
    except (OSError, TypeError):
        return None


def sequence(ground, number, folder):
    scene = ground.scenes / f"{SCENES[number % len(SCENES)]}.gltf"
    words = ["render", scene, "-o", "x.####.pfm", "--turntable", FRAMES, "--resolution", "8,8", "--spp", "1", "--quiet"]
    seen = []
    with Run(words, folder, program=ground.fragtrace) as process:
        while process.process.poll() is None:
            if stop.is_set():
                raise Stopped
            time.sleep(0.1)
            if (now := held(process.pid, folder)) is not None:
                seen.append((len(os.listdir(folder)), *now))
        must(process.result(), 0)
    if len(os.listdir(folder)) != FRAMES:
        raise Finding(f"{len(os.listdir(folder))} pictures of {FRAMES}")
    second, fourth = ([one for one in seen if first <= one[0] < first + FRAMES / 4] for first in (FRAMES / 4, 3 * FRAMES / 4))
    if not second or not fourth:
        return {"frames": FRAMES}
    growth = statistics.median(one[1] for one in fourth) - statistics.median(one[1] for one in second)
    files = max(one[2] for one in fourth) - max(one[2] for one in second)
    if growth > MOST_GROWTH or files > 0:
        raise Finding(f"{scene.name}: {growth:.1f} MiB more and {files} files more in the fourth quarter of {FRAMES} frames than in the second")
    return {"frames": FRAMES}


def loads(ground, folder):
    scenes = [ground.scenes / f"{name}.gltf" for name in ("cornell-box", "sphere-textured", "many-lights")]
    with Run([ground.build / "load_rounds", *scenes], folder, {**os.environ, "FRAGTRACE_LIBRARY_PATH": str(ground.build)}) as process:
        result = process.wait(3600)
    if result.status != 0:
        raise Finding(f"load_rounds: status {result.status}: {result.output}{result.error}")
    return {"loads": LOADS}


def case(ground, _, number, folder):
    """Of 15 cases ten are sequences, four the viewer and one loads, so that all reach what is asked for at about the same time."""
    place = number % 15
    if place % 4 == 2:
        settings = {"random_seconds": SECONDS, "random_seed": number, "random_log": folder / "memory.log"}
        seen = view(ground, ("random_events_test.py", "RandomEvents"), folder, SECONDS + 600, **settings)
        return {"seconds of the viewer": SECONDS if seen else 0}
    return loads(ground, folder) if place == 7 else sequence(ground, number, folder)

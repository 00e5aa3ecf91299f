# SPDX-License-Identifier: MIT
"""Signals at random moments. Every output is then whole, the old one or the new one, and at most one part file is left, which the next run
removes. Every 50th case sends them to the viewer while it saves (tests/viewer/killed_test.py). Every second one of the others delays the
program's own calls of the system, and in half of these the moment is counted from the first change of a file, so that more moments lie within
the writing of one."""
import os
import random
import signal
import time
from pathlib import Path

from common import Finding, Run, check_whole, contents, must, parts_in, preloaded, run, view

ASKED = {"signals": 1000, "signals to the viewer": 500}
VIEWED = 50  # every so many cases the viewer
KILLS = 20
REPEATS = 100  # of a finding, before it counts as mended
ENDING = (signal.SIGTERM, signal.SIGINT, signal.SIGHUP)
SIGNALS = (signal.SIGKILL, signal.SIGKILL, *ENDING, signal.SIGSTOP)
OLD = b"what was there before\n" * 100
WHOLE = "--resolution 64,48 --spp 2 --quiet".split()
DELAY = 20000  # microseconds
BRIEF_ONES = ("render pfm", "merge", "bench")
WRITING = 0.2  # seconds that a delayed program writes for
HELD = 0.2  # seconds of a process that is stopped


def commands(ground):
    """Name: its words, and the files that it writes. A checkpoint's own file is not there before."""
    box = ground.scenes / "cornell-box.gltf"
    inputs = [ground.folder / name for name in ("a.exr", "b.exr")]
    drawn = {f"render {kind}": (["render", box, "-o", f"x.{kind}", *WHOLE], [f"x.{kind}"]) for kind in ("pfm", "png", "exr")}
    return drawn | {
        "render with statistics": (["render", box, "-o", "x.exr", "--stats", "s.json", *WHOLE], ["x.exr", "s.json"]),
        "merge": (["merge", *inputs, "-o", "x.exr"], ["x.exr"]),
        "denoise": (["denoise", inputs[0], "-o", "x.exr", "--denoise", "variance"], ["x.exr"]),
        "checkpoint": (["render", box, "-o", "x.exr", "--checkpoint", "0.1", "--resolution", "70,56", "--spp", "400", "--quiet"], ["x.exr"]),
        "sequence": (["render", box, "-o", "x.#.exr", "--turntable", "4", *WHOLE], [f"x.{k}.exr" for k in range(4)]),
        "bench": (["bench", "frame", box, "--resolution", "16,16", "--rounds", "1", "--round-time", "0.05", "--configs", "default", "--json", "j.json",
                   "--quiet"], ["j.json"]),
    }


def prepare(ground):
    """For each command its files after an unbroken run, and how long that takes, without delays and with them."""
    box = ground.scenes / "cornell-box.gltf"
    for i, name in enumerate(("a.exr", "b.exr")):
        must(run(ground, ["render", box, "-o", name, "--resolution", "64,48", "--spp", "4", "--sample-offset", 4 * i, "--aov", "denoising", "--quiet"],
                 ground.folder), 0)
    made = {}
    for name, (words, outputs) in commands(ground).items():
        if ground.brief and name not in BRIEF_ONES:
            continue
        folder = ground.folder / name.replace(" ", "-")
        folder.mkdir(exist_ok=True)
        for _ in range(2):  # the second one finds the driver's shaders in its cache
            began = time.monotonic()
            must(run(ground, [*words], folder), 0)
            seconds = time.monotonic() - began
        files = contents(folder)
        if set(files) != set(outputs):
            raise Finding(f"{name} writes {sorted(files)}, not {outputs}")
        made[name] = (files, seconds)
    return made


def catches(pid, number):
    """Returns true if a process has a handler for that signal."""
    for line in Path(f"/proc/{pid}/status").read_text().splitlines():
        if line.startswith("SigCgt:"):
            return bool(int(line.split()[1], 16) >> (number - 1) & 1)
    return False


def looks(folder):
    """Names, sizes and times of the files in a folder that changes."""
    found = {}
    for entry in os.scandir(folder):
        try:
            found[entry.name] = (entry.stat().st_size, entry.stat().st_mtime_ns)
        except FileNotFoundError:
            pass
    return found


def await_change(process, folder, before):
    """Waits until the program has touched a file."""
    while process.process.poll() is None and looks(folder) == before:
        time.sleep(0.002)


def broken(process, which, moment):
    """Sends the signal at that moment; the statuses that may follow."""
    deadline = time.monotonic() + moment
    while time.monotonic() < deadline and process.process.poll() is None:
        time.sleep(max(0.0, min(0.01, deadline - time.monotonic())))
    if process.process.poll() is not None:
        return (0,)
    if which == signal.SIGKILL:
        process.process.kill()
        return (0, -signal.SIGKILL)
    # Before the program has begun, the system's own answer holds.
    caught = catches(process.pid, which)
    process.process.send_signal(which)
    if which == signal.SIGSTOP:
        time.sleep(HELD)
        process.process.send_signal(signal.SIGCONT)
        return (0,)
    return (0, 130) if caught else (0, 130, -which)


def check_files(found, outputs, new, which):
    """Whole files, the old or the new ones, and one part at most."""
    parts = parts_in(found)
    if len(parts) > 1 or (parts and which != signal.SIGKILL):
        raise Finding(f"parts are left after {which.name}: {parts}")
    for name, data in found.items():
        if name in parts or data == OLD:
            continue
        if name not in outputs and not name.endswith(".checkpoint"):
            raise Finding(f"{name} is left after {which.name}")
        if name in outputs and (which in ENDING or name.endswith(".json")):
            check_whole(name, data)
        elif name in outputs and data != new[name]:
            raise Finding(f"{name} is neither the old file nor the new one after {which.name}: {len(data)} bytes, of the new one {len(new[name])}")


def check_next(ground, name, words, outputs, new, folder):
    """The next run brings the whole files, and leaves nothing else."""
    if name == "checkpoint":
        (folder / "x.exr").unlink(missing_ok=True)
        words = [*words, "--resume"]
    must(run(ground, words, folder), 0)
    after = contents(folder)
    if set(after) != set(outputs):
        raise Finding(f"the next run leaves {sorted(after)}")
    for output, data in after.items():
        if output.endswith(".json"):
            check_whole(output, data)
        elif data != new[output]:
            raise Finding(f"the next run's {output} differs from that of an unbroken one")


def case(ground, made, number, folder):
    if number % VIEWED == VIEWED - 1 and not ground.brief:
        seen = view(ground, ("killed_test.py", "Killed"), folder, 600, kills=KILLS, kills_seed=number)
        return {"signals to the viewer": KILLS if seen else 0}
    dice = random.Random(f"kills {number}")
    every = commands(ground)
    name = dice.choice(sorted(every))
    if name not in made:
        return {}
    words, outputs = every[name]
    new, seconds = made[name]
    which = dice.choice(SIGNALS)
    delayed = number % 2 == 1
    for output in outputs:
        (folder / output).write_bytes(OLD)
    before = looks(folder)
    environment = preloaded(ground, delay=f"{number},{DELAY}") if delayed else None
    with Run(words, folder, environment, ground.fragtrace) as process:
        if delayed and number % 4 == 1:
            await_change(process, folder, before)
            seconds = WRITING / 3
        statuses = broken(process, which, dice.random() * seconds * (3 if delayed else 1.05))
        result = must(process.wait(120), *statuses)
        process.leaves_nobody()
    found = contents(folder)
    try:
        check_files(found, outputs, new, which)
        if result.status == 0 and any(data == OLD for data in found.values()):
            raise Finding("status 0, but a file is the old one")
        if "nothing is written" in result.error and any(found[output] != OLD for output in outputs):
            raise Finding(f"says {result.error.strip()!r}, but a file is new")
        if parts_in(found) or name == "checkpoint" or dice.random() < 0.1:
            check_next(ground, name, words, outputs, new, folder)
    except Finding as finding:
        raise Finding(f"{name}{', delayed' if delayed else ''}, {which.name}, status {result.status}: {finding}") from None
    return {"signals": 1}

# SPDX-License-Identifier: MIT
"""Damaged files. In process: scenes, and the fuzz targets of scripts/fuzz, whose executions are counted, under sanitizers. Through the real command line:
files that are damaged by a case's number (damage.py). The status is a documented one, there is one message, it takes at most 10 s of processor
time, it ends in limited memory, and no file outside is touched."""
import os
import random
import re
import resource
import subprocess
import sys
import threading

import damage
from common import Finding, Run, build_target, contents, stop

ASKED = {"inputs": 1_000_000, "through the command line": 5000}
KINDS = ("gltf", "gltf", "gltf", "glb", "bin", "png", "jpg", "hdr", "exr", "webp", "pfm", "nvdb", "config", "checkpoint", "part.exr")
STATUSES = {"config": (0, 2, 3), "checkpoint": (0, 2, 3), "part.exr": (0, 1, 2, 3)}  # 2: of another render, or without what is asked for
SECONDS = 10  # of processor time, of all processes together
ADDRESSES = 6 << 30  # bytes
FUZZED = 100  # every so many cases there is a minute of the fuzz targets; half-way between, a batch of scenes in process
BATCH = 1000  # scenes
fuzzing = threading.Lock()


def prepare(ground):
    sys.path.insert(0, str(ground.source / "tests/fuzz"))
    if not ground.brief:
        build_target(ground, "sanitize", "loader_fuzz")
    return damage.seeds(ground)


def limited():
    resource.setrlimit(resource.RLIMIT_AS, (ADDRESSES, ADDRESSES))
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS + 1))


def fuzz(ground, seconds):
    """scripts/fuzz, whose logs tell the executions."""
    result = subprocess.run([ground.source / "scripts/fuzz", str(seconds)], capture_output=True, text=True)
    logs = [path.read_text(errors="replace") for path in (ground.source / "build-fuzz").glob("*.log")]
    if result.returncode != 0 and not stop.is_set():
        raise Finding(f"scripts/fuzz: {result.stderr[-3000:]}")
    return {"inputs": sum(int(count) for log in logs for count in re.findall(r"stat::number_of_executed_units: (\d+)", log))}


def in_process(ground, files, number, folder):
    """Damaged scenes, loaded, made into a tree and packed under sanitizers (tests/fuzz/loader_fuzz.cpp)."""
    dice = random.Random(f"scenes {number}")
    for i in range(BATCH):
        (folder / str(i)).write_bytes(damage.damaged(dice.choice(("gltf", "glb")), files, dice))
    build = ground.source / "build-sanitize"
    words = [build / "loader_fuzz", "-timeout=10", "-rss_limit_mb=4096", *(str(i) for i in range(BATCH))]
    with Run(words, folder, {**os.environ, "FRAGTRACE_LIBRARY_PATH": str(build)}) as process:
        result = process.wait(1800)
    if result.status != 0:
        last = result.error.rpartition("Running: ")[2].partition("\n")[0]
        raise Finding(f"scene {last} of batch {number}: status {result.status}: {result.error[-3000:]}")
    return {"inputs": BATCH}


def words_of(ground, kind, data, folder):
    """Writes the damaged file, and the command that reads it."""
    box = ground.scenes / "cornell-box.gltf"
    tiny = damage.TINY
    if kind == "bin":
        (folder / "x.bin").write_bytes(data[1])
        data = damage.json.dumps(data[0] | {"buffers": [{"byteLength": data[0]["buffers"][0]["byteLength"], "uri": "x.bin"}]}).encode()
        kind = "gltf"
    name = {"config": "x.json", "checkpoint": "o.exr.checkpoint"}.get(kind, f"x.{kind}")
    (folder / name).write_bytes(data)
    if kind in ("gltf", "glb"):
        return ["render", name, "-o", "o.pfm", *tiny, "--memory-limit", "500MB", "--animation-time", "0.5"]
    if kind == "nvdb":
        return ["render", box, "-o", "o.pfm", *tiny, "--volume", name, "--memory-limit", "500MB"]
    if kind == "config":
        return ["render", box, "-o", "o.pfm", "--config", name, "--resolution", "8,8", "--spp", "1", "--quiet"]
    if kind == "checkpoint":
        return ["render", box, "-o", "o.exr", "--resolution", "8,8", "--spp", "1000000", "--quiet", "--resume", "--time", "0.2"]
    if kind == "part.exr":
        return ["merge", name, ground.folder / "d.exr", "-o", "o.exr"] if len(data) % 2 else ["merge", name, name, "-o", "o.exr"]
    return ["diff", name, name] if len(data) % 2 else ["render", box, "-o", "o.pfm", *tiny, "--hdri-file", name]


def case(ground, files, number, folder):
    if number % FUZZED == 0 and not ground.brief and fuzzing.acquire(blocking=False):
        try:
            return fuzz(ground, 30)
        finally:
            fuzzing.release()
    if number % FUZZED == FUZZED // 2 and not ground.brief:
        return in_process(ground, files, number, folder)
    dice = random.Random(f"inputs {number}")
    kind = dice.choice(KINDS)
    words = words_of(ground, kind, damage.damaged(kind, files, dice), folder)
    before = set(contents(folder))
    with Run(words, folder, program=ground.fragtrace, limits=limited) as process:
        result = process.wait(180)
        process.leaves_nobody()
    said = f"{kind}: {' '.join(map(str, words))}: "
    if result.status not in STATUSES.get(kind, (0, 3)):
        raise Finding(f"{said}status {result.status}: {result.error.strip()[:1000]}")
    if "crashed" in result.error or "terminate" in result.error:
        raise Finding(f"{said}{result.error.strip()[:1000]}")
    if result.status != 0 and len(lines := [line for line in result.error.splitlines() if ": warning: " not in line]) != 1:
        raise Finding(f"{said}{len(lines)} lines: {result.error.strip()[:1000]}")
    new = set(contents(folder)) - before
    if new - {"o.pfm", "o.exr", "o.exr.checkpoint"} or {path.name for path in folder.parent.iterdir()} != {"work", "stdout", "stderr"}:
        raise Finding(f"{said}wrote {sorted(new)}")
    return {"inputs": 1, "through the command line": 1}

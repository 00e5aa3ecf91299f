# SPDX-License-Identifier: MIT
"""A system that fails: the n-th call of each kind that our own code makes fails once (tests/faults/failing_system.cpp), for every n of small
runs; disks that are full, files that may not grow, folders that may not be written, calls that are interrupted everywhere, and disks that
lose what they were not told to keep. The program
ends with a documented status and one message, the old file stays, and no part is left; or it does without what failed, and the file is whole."""
import os
import random
import resource
import shutil
import struct
import subprocess
from pathlib import Path

from common import Finding, Run, contents, must, parts_in, preloaded, run

ASKED = {"faults": 2000}
KINDS = ("open", "read", "write", "fsync", "rename", "mmap", "spawn", "thread", "memory", "socket")  # as in failing_system.cpp
PROGRAMS = ("fragtrace", "fragtrace_worker")
OLD = b"what was there before\n" * 100
SURROUNDINGS = ("interrupted", "power cut", "full disk", "file limit", "read-only")
LARGE = "--resolution 160,120 --spp 1 --quiet".split()
TINY = "--resolution 16,12 --spp 1 --quiet".split()
ROOM = 64 << 10  # of the disk that is full, and of the largest file


def commands(ground):
    """Name: words, files that it writes, and as large ones (more than 64 KiB)."""
    box, textured = (ground.scenes / f"{name}.gltf" for name in ("cornell-box", "sphere-textured"))
    inputs = [ground.folder / name for name in ("a.exr", "b.exr")]
    render = {f"render {kind}": (["render", scene, "-o", f"x.{kind}", *TINY], [f"x.{kind}"], LARGE)
              for kind, scene in (("pfm", box), ("png", textured), ("exr", box))}
    return render | {
        "render checkpoint": (["render", box, "-o", "x.pfm", "--checkpoint", "0.1", "--resume", *TINY], ["x.pfm"], LARGE),
        "info": (["info", "--missing-textures", "refuse", textured], [], []),
        "merge": (["merge", *inputs, "-o", "x.exr"], ["x.exr"], []),
        "denoise": (["denoise", inputs[0], "-o", "x.exr", "--denoise", "variance"], ["x.exr"], []),
    }


def counted(ground, words, folder, program):
    """Counts the calls of each kind that a program makes, and keeps the files of an unbroken run."""
    counts = folder.parent / f"counts-{program}"
    counts.unlink(missing_ok=True)
    result = must(run(ground, words, folder, environment=preloaded(ground, program=program, counts=counts)), 0)
    if not counts.exists():
        return dict.fromkeys(KINDS, 0), result
    return dict(zip(KINDS, struct.unpack(f"<{len(KINDS)}Q", counts.read_bytes()))), result


def prepare(ground):
    """All faults, in an order that begins with those of which there are few; memory's, of which there are thousands, are shuffled."""
    box = ground.scenes / "cornell-box.gltf"
    for i, name in enumerate(("a.exr", "b.exr")):
        must(run(ground, ["render", box, "-o", name, "--quiet", "--resolution", "40,30", "--spp", "4", "--sample-offset", 4 * i,
                          "--aov", "denoising"], ground.folder), 0)
    few, many, made = [], [], {}
    for name, (words, _, _) in commands(ground).items():
        if ground.brief and name not in ("render pfm", "info"):
            continue
        folder = ground.folder / name.replace(" ", "-")
        folder.mkdir(exist_ok=True)
        few += [(name, "fragtrace", kind, 0) for kind in SURROUNDINGS]
        for program in PROGRAMS:
            counts, result = counted(ground, words, folder, program)
            made[name] = (contents(folder), result.output)
            for kind, count in counts.items():
                (many if kind == "memory" else few).extend((name, program, kind, n) for n in range(1, count + 1))
    random.Random("faults").shuffle(many)
    if ground.brief:
        random.Random("brief").shuffle(few)
    return few + many, made


def last(data):
    return len(data[0])


def limited():
    resource.setrlimit(resource.RLIMIT_FSIZE, (ROOM, ROOM))


def mounted(folder):
    """A disk of 64 KiB; false: only root may have one."""
    return os.geteuid() == 0 and subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={ROOM}", "fragtrace", folder], capture_output=True).returncode == 0


def enlarged(words, large):
    return [*words[:-len(TINY)], *large] if large else words


def surrounded(ground, words, large, folder, kind):
    """The run in such surroundings, and whether it must fail."""
    if kind in ("interrupted", "power cut"):
        environment = preloaded(ground, **({"eintr": 1} if kind == "interrupted" else {"power_cut": 1}))
        return run(ground, words, folder, environment=environment), False
    words = enlarged(words, large)
    if kind == "file limit":
        with Run(words, folder, program=ground.fragtrace, limits=limited) as process:
            return process.wait(120), bool(large)
    if kind == "read-only" and os.geteuid() == 0:
        # Root may write everywhere but on a disk that is read-only.
        subprocess.run(["mount", "--bind", folder, folder], check=True)
        try:
            subprocess.run(["mount", "-o", "remount,ro,bind", folder], check=True)
            return run(ground, words, folder), True
        finally:
            subprocess.run(["umount", "-l", folder], check=True)
    folder.chmod(0o555)
    try:
        return run(ground, words, folder), True
    finally:
        folder.chmod(0o755)


def check(name, kind, result, found, outputs, made, must_fail):
    """Either all is as without the fault, or a message says what failed and nothing has changed."""
    files, output = made
    if result.status == 0:
        if must_fail and outputs:
            raise Finding("status 0")
        if found != files or (name == "info" and result.output != output):
            raise Finding(f"status 0, but files or output differ: {sorted(found)} {result.error.strip()}")
        return
    must(result, 1, 3, 4)
    lines = result.error.strip().splitlines()
    if len(lines) != 1 or not lines[0].startswith("fragtrace: "):
        raise Finding(f"status {result.status} with {len(lines)} lines: {result.error.strip()[:1000]}")
    if "crashed" in lines[0]:
        raise Finding(f"a crash: {lines[0]}")
    rescued = [other for other in found if other not in outputs and other.endswith(".pfm") and other in lines[0]]
    left = [other for other in found if other not in outputs and other not in rescued]
    if left:
        raise Finding(f"{'parts are' if parts_in(left) else 'files are'} left: {left} ({lines[0]})")
    # An allocation may fail when the file is replaced and the last words are composed.
    may_be_new = kind == "memory"
    for output in outputs:
        if found.get(output) != OLD and not (may_be_new and found.get(output) == files[output]):
            raise Finding(f"{output} is no longer the old file ({lines[0]})")


def case(ground, data, number, folder):
    faults, made = data
    name, program, kind, n = faults[number % len(faults)]
    words, outputs, large = commands(ground)[name]
    full = kind == "full disk" and mounted(folder)
    try:
        for output in outputs:
            (folder / output).write_bytes(OLD)
        if kind == "full disk":
            if not full:
                return {}
            result, must_fail = run(ground, enlarged(words, large), folder), bool(large)
        elif kind in SURROUNDINGS:
            result, must_fail = surrounded(ground, words, large, folder, kind)
        else:
            result, must_fail = run(ground, words, folder, environment=preloaded(ground, program=program, fail=f"{kind},{n}")), False
        found = contents(folder)
    finally:
        if full:
            subprocess.run(["umount", "-l", folder], check=True)
    try:
        if kind in ("full disk", "file limit") and result.status == 0:
            return {"faults": 1}  # what it writes has room
        check(name, kind, result, found, outputs, made[name], must_fail)
    except Finding as finding:
        raise Finding(f"{name}, {program}: {kind} {n or ''}: {finding}") from None
    return {"faults": 1}

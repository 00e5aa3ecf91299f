# SPDX-License-Identifier: MIT
"""Functions that the campaigns share: they start, watch and end processes, compare folders, and check pictures."""
import json
import os
import re
import shutil
import signal
import struct
import subprocess
import sys
import threading
import time
import zlib
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from exr import Exr  # noqa: E402

over = threading.Event()  # no further case begins
stop = threading.Event()  # those that run are given up
SKIPPED = 77  # the status of a test that cannot run here
TICKS = os.sysconf("SC_CLK_TCK")


class Finding(Exception):
    """The program did what it must not do; the text says what."""


class Stopped(Exception):
    """A case that was given up half-way, and does not count."""


class Absent(Exception):
    """A campaign that cannot run here; the text says why."""


@dataclass
class Ground:
    """Holds the programs and folders that a campaign uses."""
    fragtrace: Path  # the program
    source: Path  # the repository
    folder: Path  # for inputs that all cases of the campaign read
    brief: bool  # a few seconds, as in CI

    @property
    def build(self):
        return self.fragtrace.parent

    @property
    def scenes(self):
        return self.source / "scenes"


@dataclass
class Result:
    status: int
    output: str
    error: str


def build_target(ground, preset, target):
    """Builds what a campaign runs besides the program; Absent where that is not possible, with the compiler or without it."""
    if preset != "release":
        subprocess.run([ground.source / "scripts/setup", "fuzz"])
        if not shutil.which("clang++"):
            raise Absent("clang++ is not installed (scripts/setup fuzz)")
    if subprocess.run([ground.source / "scripts/build", preset, target]).returncode != 0:
        raise Absent(f"scripts/build {preset} {target} failed")


def preloaded(ground, **settings):
    """The environment with tests/faults/failing_system.cpp, told what to do."""
    told = {f"FRAGTRACE_SYSTEM_{name.upper()}": str(value) for name, value in settings.items()}
    return {**os.environ, **told, "LD_PRELOAD": str(ground.build / "libfailing_system.so")}


def fields_of(pid):
    """Returns the words of /proc/PID/stat behind the program's name: state, parent, group, session, ...; none if the process is gone."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return []


def session_of(leader):
    """Processes of a session that are not zombies."""
    found = []
    for entry in os.listdir("/proc"):
        if entry.isdigit():
            fields = fields_of(entry)
            if fields and int(fields[3]) == leader and fields[0] not in "ZX":
                found.append(int(entry))
    return found


def processor_seconds(pids):
    return sum(int(fields[11]) + int(fields[12]) for fields in map(fields_of, pids) if fields) / TICKS


def end_session(leader):
    for pid in session_of(leader):
        try:
            os.kill(pid, signal.SIGKILL)
        except ProcessLookupError:
            pass


class Run:
    """A command in a session of its own. Its streams go to files next to its folder, so that nothing waits for who reads them."""

    def __init__(self, words, folder, environment=None, program=None, limits=None):
        self.words = [str(word) for word in words]
        self.paths = [folder.parent / name for name in ("stdout", "stderr")]
        with open(self.paths[0], "wb") as output, open(self.paths[1], "wb") as error:
            self.process = subprocess.Popen(self.words if program is None else [str(program), *self.words], cwd=folder, stdin=subprocess.DEVNULL,
                                            stdout=output, stderr=error, start_new_session=True, env=environment, preexec_fn=limits)
        self.pid = self.process.pid

    def __enter__(self):
        return self

    def __exit__(self, *_):
        end_session(self.pid)
        self.process.wait()

    def wait(self, seconds):
        """Returns the result; a Finding where it takes longer, Stopped where the campaign ends before."""
        deadline = time.monotonic() + seconds
        while True:
            try:
                self.process.wait(0.2)
                return self.result()
            except subprocess.TimeoutExpired:
                if stop.is_set():
                    raise Stopped from None
                if time.monotonic() > deadline:
                    raise Finding(f"not done after {seconds} s: {' '.join(self.words)}") from None

    def result(self):
        output, error = (path.read_text(errors="replace") for path in self.paths)
        return Result(self.process.returncode, output, error)

    def leaves_nobody(self, seconds=20):
        deadline = time.monotonic() + seconds
        while left := session_of(self.pid):
            if time.monotonic() > deadline:
                raise Finding(f"processes {left} outlive the program by {seconds} s")
            time.sleep(0.02)


def run(ground, words, folder, seconds=120, **options):
    with Run(words, folder, program=ground.fragtrace, **options) as started:
        return started.wait(seconds)


def view(ground, test, folder, seconds, **settings):
    """Runs a class of tests/viewer, told by FRAGTRACE_ variables what to do. Returns False where it was skipped, without a display."""
    environment = {**os.environ, **{f"FRAGTRACE_{name.upper()}": str(value) for name, value in settings.items()}}
    file, case = test
    with Run(["/usr/bin/python3", ground.source / "tests/viewer" / file, ground.fragtrace, ground.source, case], folder, environment) as process:
        result = process.wait(seconds)
    if result.status not in (0, SKIPPED):
        told = " ".join(f"{name} {value}" for name, value in settings.items())
        raise Finding(f"{file}, {told}: status {result.status}: {result.error[-3000:]}")
    return result.status == 0


def must(result, *statuses):
    if result.status not in statuses:
        raise Finding(f"status {result.status}, not {' or '.join(map(str, statuses))}: {result.error.strip()[:2000]}")
    return result


def contents(folder):
    """Bytes of the files in a folder, by name."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def parts_in(names):
    return [name for name in names if name.endswith(".part")]


def check_whole(name, data):
    """A Finding unless a picture, a checkpoint or JSON lines are whole."""
    try:
        kind = name.rpartition(".")[2]
        if kind == "pfm":
            header = re.match(rb"PF\n(\d+) (\d+)\n-1\.0*\n", data)
            assert len(data) == header.end() + 12 * int(header[1]) * int(header[2]), "its size"
        elif kind == "png":
            check_png(data)
        elif kind == "exr":
            check_exr(data)
        elif kind == "json":
            lines = data.decode().splitlines()
            assert lines, "it is empty"
            try:
                json.loads(data)
            except ValueError:
                list(map(json.loads, lines))
    except Exception as error:  # any way to be broken
        raise Finding(f"{name} is not whole ({len(data)} bytes): {error!r}") from error


def check_png(data):
    assert data[:8] == b"\x89PNG\r\n\x1a\n", "its beginning"
    at, kind = 8, b""
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        assert zlib.crc32(data[at + 4:at + 8 + size]) == struct.unpack_from(">I", data, at + 8 + size)[0], "a chunk's sum"
        at += 12 + size
    assert kind == b"IEND" and at == len(data), "its end"


def check_exr(data):
    """Checks that all blocks lie in the file, to the last byte (Exr reads their values)."""
    path = Path(f"/dev/shm/fragtrace-{os.getpid()}-{threading.get_ident()}.exr")
    try:
        path.write_bytes(data)
        for rows in Exr(path).layers.values():
            assert None not in rows, "its rows"
    finally:
        path.unlink(missing_ok=True)


def same_or(old, new, data):
    return data == old or data == new


def kept(folder, place):
    """Copies what a case has left to where findings are kept."""
    shutil.rmtree(place, ignore_errors=True)
    shutil.copytree(folder, place, symlinks=True)

# SPDX-License-Identifier: MIT
"""Functions that all tests of the command line share: they run it and read the pictures that it writes.

A test file is run as FILE FRAGTRACE SOURCE_FOLDER [unittest arguments].
"""
import atexit
import ctypes.util
import fcntl
import functools
import json
import math
import os
import pty
import re
import select
import shutil
import signal
import statistics
import struct
import subprocess
import sys
import tempfile
import termios
import threading
import time
import unittest
from array import array
from pathlib import Path

PARENTS = Path(__file__).resolve().parents
sys.path[:0] = [str(PARENTS[1]), str(PARENTS[2] / "scenes")]
from exr import WEIGHTS, Exr, write_exr, write_parts  # noqa: E402, F401
from gltf_file import SQUARE, TWO_TRIANGLES, Gltf, data_uri, png, quad  # noqa: E402, F401
from picture_files import read_png, write_pfm, write_png  # noqa: E402, F401
from skips import EXTENDED, at_length, main  # noqa: E402, F401

FRAGTRACE = Path(sys.argv[1]).resolve()
SCENES = Path(sys.argv[2]).resolve() / "scenes"
# The shaders that the program draws with: tests/mutants/fragtrace has others.
SHADERS = Path(os.environ.get("MUTANT_SHADERS", SCENES.parent / "shaders"))
# The software back ends that are installed: Mesa 25.1 and later have no OSMesa.
BACKENDS = ("egl", "osmesa") if ctypes.util.find_library("OSMesa") else ("egl",)
SMALL = ["--resolution", "16,16", "--spp", "2", "--quiet"]
# A white world: what absorbs nothing is not seen in it.
WHITE = ["--default-light", "white", "--background-color", "1,1,1", "--bounces", "unlimited"]


class Server:
    """The process that tests/command/fork_server.cpp describes."""

    def __init__(self):
        self.folder = tempfile.TemporaryDirectory()
        self.files = [Path(self.folder.name) / name for name in ("stdout", "stderr")]
        self.process = subprocess.Popen([FRAGTRACE.parent / "fork_server"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, start_new_session=True)
        atexit.register(self.end)

    def end(self):
        os.killpg(self.process.pid, signal.SIGKILL)
        self.process.communicate()
        self.folder.cleanup()

    def run(self, words, timeout):
        self.process.stdin.write(json.dumps([*map(str, self.files), *words]) + "\n")
        self.process.stdin.flush()
        if not select.select([self.process.stdout], [], [], timeout)[0]:
            atexit.unregister(self.end)
            self.end()
            server_of.cache_clear()
            raise subprocess.TimeoutExpired(words, timeout)
        return subprocess.CompletedProcess(words, int(self.process.stdout.readline()), *(path.read_text() for path in self.files))


@functools.cache
def server_of(thread):
    return Server() if (FRAGTRACE.parent / "fork_server").exists() else None


def server():
    """The thread's own: it answers one request at a time."""
    return server_of(threading.get_ident())


def run(*arguments, timeout=600, alone=False, **options):
    """Runs a command and returns what it prints and its status. alone: the program is started, which options need."""
    words = list(map(str, arguments))
    if server() and not alone and not options:
        return server().run(words, timeout)
    return subprocess.run([FRAGTRACE, *words], capture_output=True, text=True, timeout=timeout, **options)


def shown(*words, columns=120):
    """Returns what a command shows on a terminal of so many columns."""
    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    with subprocess.Popen([FRAGTRACE, *map(str, words)], stdout=theirs) as process:
        os.close(theirs)
        text = b""
        while True:
            try:
                part = os.read(ours, 4096)
            except OSError:  # the end, of a terminal
                break
            if not part:
                break
            text += part
    os.close(ours)
    assert process.returncode == 0
    return text.decode().replace("\r\n", "\n")


def told(said):
    """The lines of stderr but the one that says who lights the picture."""
    return [line for line in said.splitlines() if not re.fullmatch("fragtrace: .* lights? it", line)]


def floats(data):
    values = array("f", data)
    if sys.byteorder == "big":
        values.byteswap()
    return values


def read_pfm(path):
    kind, size, _, body = Path(path).read_bytes().split(b"\n", 3)
    width, height = map(int, size.split())
    values = struct.unpack("<%df" % (width * height * 3), body)
    rows = [values[y * width * 3:(y + 1) * width * 3] for y in range(height)]
    return [[row[3 * x:3 * x + 3] for x in range(width)] for row in reversed(rows)]


def luminances(picture):
    """Returns the luminances of a picture of read_pfm, in one list."""
    return [sum(w * c for w, c in zip(WEIGHTS, pixel)) for row in picture for pixel in row]


def mean(picture, channel=0):
    """Returns the mean of a channel of a picture of read_pfm."""
    return statistics.fmean(pixel[channel] for row in picture for pixel in row)


class Case(unittest.TestCase):
    """Has a folder of its own. Every .pfm and .exr that a test leaves there must be finite throughout."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def tearDown(self):
        for path in self.folder.glob("**/*.pfm"):
            self.finite(path, floats(path.read_bytes().split(b"\n", 3)[3]))
        for path in self.folder.glob("**/*.exr"):
            exr = Exr(path)
            for name in exr.layers:
                self.finite(f"{path} {name}", exr.values(name))

    def finite(self, what, values):
        # Finite floats have a finite sum in double precision, and no other values have.
        self.assertTrue(math.isfinite(sum(values)), f"{what} holds a value that is not finite")

    def fails(self, status, *arguments, says=(), **options):
        """Gives that status, one line on stderr and no picture besides those that were there."""
        pictures = lambda: {p for p in self.folder.iterdir() if p.suffix in (".png", ".exr", ".pfm", ".part")}
        before = pictures()
        result = run(*arguments, **options)
        self.assertEqual(result.returncode, status, result.stderr)
        for text in says:
            self.assertIn(str(text), result.stderr)
        self.assertEqual(len(told(result.stderr)), 1, result.stderr)
        self.assertEqual(pictures(), before)
        return result

    def shaders_of_short_draws(self):
        """Returns a copy of the shaders whose paths take many draws."""
        folder = self.folder / "shaders"
        shutil.copytree(SHADERS, folder)
        text = (folder / "trace.glsl").read_text()
        self.assertIn("int budget = frame.stepBudget;", text)
        (folder / "trace.glsl").write_text(text.replace("int budget = frame.stepBudget;", "int budget = min(frame.stepBudget, 6);"))
        return folder

    def interrupts(self, *arguments, within=10):
        """Ctrl-C after some seconds ends it within so many more, on a busy machine, with status 130 and one line; the folder holds what it held before."""
        files = set(self.folder.iterdir())
        process = subprocess.Popen([FRAGTRACE, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        time.sleep(2)
        began = time.monotonic()
        process.send_signal(signal.SIGINT)
        output, error = process.communicate(timeout=20)
        self.assertLess(time.monotonic() - began, within)
        self.assertEqual((process.returncode, output), (130, ""))
        self.assertEqual(len(error.splitlines()), 1, error)
        self.assertEqual(set(self.folder.iterdir()), files)

    # Of assert_mean: standard errors, what is off besides them, and the largest of them, as parts of the mean.
    ERRORS, BESIDE, KNOWN = 6, 1e-4, 0.005

    def assert_mean(self, seen, wanted, what, beside=None, known=None):
        """Holds the mean of what pictures of several seeds show against a number. Returns its standard error, as a part."""
        error, ratio = statistics.stdev(seen) / math.sqrt(len(seen)) / wanted, statistics.fmean(seen) / wanted
        print(f"{what}: {ratio - 1:+.4%}, standard error {error:.4%}")
        self.assertLess(abs(ratio - 1), self.ERRORS * error + (self.BESIDE if beside is None else beside), what)
        self.assertLess(error, known or self.KNOWN, what)
        return error

    def assert_near(self, seen, wanted, what, within=0.01):
        print(f"{what}: {seen / wanted - 1:+.4%}")
        self.assertLess(abs(seen / wanted - 1), within, what)

    def assert_same_light(self, picture, wanted, what, known=0.005):
        """Holds the mean of a picture's pixels against that of others, of another seed or exact. Each pixel draws its own random numbers, so that their
        differences tell the standard error; the means lie within 4.5 of them (chance: 1e-5). known: its largest, as a part."""
        whole, apart = math.fsum(wanted), [a - b for a, b in zip(picture, wanted, strict=True)]
        ratio, error = math.fsum(apart) / whole, math.sqrt(math.fsum(d * d for d in apart)) / whole
        print(f"{what}: {ratio:+.4%}, standard error {error:.4%}")
        self.assertLess(abs(ratio), 4.5 * error, what)
        self.assertLess(error, known, what)

    def renders(self, *arguments, **options):
        result = run("render", *arguments, **options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def written(self, name, document):
        """Writes JSON into the folder, such as a glTF file, and returns its path."""
        path = self.folder / name
        path.write_text(json.dumps(document))
        return path

    def picture(self, scene, name, *options):
        """Renders quietly into the folder and reads what was written: a list of rows, or an Exr."""
        path = self.folder / name
        self.renders(SCENES / (scene + ".gltf"), "-o", path, "--quiet", *options)
        return read_pfm(path) if path.suffix == ".pfm" else Exr(path)

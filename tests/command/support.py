# SPDX-License-Identifier: MIT
"""Functions that all tests of the command line share: they run it and read the pictures that it writes.

A test file is run as FILE FRAGTRACE SOURCE_FOLDER [unittest arguments].
"""
import ctypes.util
import math
import signal
import statistics
import struct
import subprocess
import sys
import tempfile
import time
import unittest
import zlib
from array import array
from itertools import accumulate
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from skips import EXTENDED, at_length, main  # noqa: E402, F401

FRAGTRACE = Path(sys.argv[1]).resolve()
SCENES = Path(sys.argv[2]).resolve() / "scenes"
# The software back ends that are installed: Mesa 25.1 and later have no OSMesa.
BACKENDS = ("egl", "osmesa") if ctypes.util.find_library("OSMesa") else ("egl",)
SMALL = ["--resolution", "16,16", "--spp", "2", "--quiet"]
WEIGHTS = (0.2126, 0.7152, 0.0722)  # weights of luminance
# A white world: what absorbs nothing is not seen in it.
WHITE = ["--default-light", "white", "--background-color", "1,1,1", "--bounces", "unlimited"]
TURNED = bytes(i ^ 128 for i in range(256))


def run(*arguments, timeout=600, **options):
    return subprocess.run([FRAGTRACE, *map(str, arguments)], capture_output=True, text=True, timeout=timeout, **options)


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


def unzipped(data, size):
    """One block of a ZIP-compressed OpenEXR file (openexr.com, "OpenEXR File Layout")."""
    if len(data) == size:
        return data
    # Each byte is a difference from the one before, plus 128: the low bytes of running sums, every other one with its high bit turned.
    sums = array("Q", accumulate(zlib.decompress(data))).tobytes()
    turned = bytearray(sums[::8] if sys.byteorder == "little" else sums[7::8])
    turned[1::2] = turned[1::2].translate(TURNED)
    result = bytearray(size)
    result[0::2], result[1::2] = turned[:(size + 1) // 2], turned[(size + 1) // 2:]
    return bytes(result)


class Exr:
    """Scan lines of floats of 32 or 16 bits, uncompressed or ZIP: `layers` by name, rows from the top; `texts`: the string attributes;
    `numbers`: those that are floats, matrices or chromaticities;    `windows`: of data and display, each left, top, right, bottom."""

    def __init__(self, path):
        data = Path(path).read_bytes()
        assert data[:4] == struct.pack("<I", 20000630) and data[4:8] == struct.pack("<I", 2), path
        self.texts, self.numbers, at, header = {}, {}, 8, {}
        while data[at]:
            name, kind, rest = data[at:].split(b"\0", 2)
            at += len(name) + len(kind) + 2
            size = struct.unpack_from("<I", data, at)[0]
            header[name.decode()] = data[at + 4:at + 4 + size]
            if kind in (b"float", b"m44f", b"chromaticities"):
                self.numbers[name.decode()] = struct.unpack(f"<{size // 4}f", data[at + 4:at + 4 + size])
            if kind == b"string":
                self.texts[name.decode()] = data[at + 4:at + 4 + size].decode()
            at += 4 + size
        names, sizes, channels = [], [], header["channels"]
        while channels != b"\0":
            name, channels = channels.split(b"\0", 1)
            kind = struct.unpack_from("<I", channels)[0]
            assert kind in (1, 2), f"{path}: {name} is not of floats"
            names.append(name.decode())
            sizes.append(2 * kind)
            channels = channels[16:]
        self.windows = {name: struct.unpack("<4i", header[name]) for name in ("dataWindow", "displayWindow")}
        left, top, right, bottom = self.windows["dataWindow"]
        self.width, self.height = right - left + 1, bottom - top + 1
        lines = {0: 1, 2: 1, 3: 16}[header["compression"][0]]
        self.layers = {name: [None] * self.height for name in names}
        for block in range(-(-self.height // lines)):
            place = struct.unpack_from("<Q", data, at + 1 + 8 * block)[0]
            y, size = struct.unpack_from("<iI", data, place)
            rows = range(y - top, min(y - top + lines, self.height))
            line = self.width * sum(sizes)
            body = unzipped(data[place + 8:place + 8 + size], line * len(rows))
            for i, row in enumerate(rows):
                for c, (name, size) in enumerate(zip(names, sizes)):
                    first = i * line + self.width * sum(sizes[:c])
                    self.layers[name][row] = struct.unpack_from(f"<{self.width}{' ef'[size // 2]}", body, first)

    def pixel(self, x, y, *names):
        return tuple(self.layers[name][y][x] for name in names)

    def values(self, name):
        return [value for row in self.layers[name] for value in row]

    def luminances(self):
        return [sum(w * c for w, c in zip(WEIGHTS, pixel)) for pixel in zip(*map(self.values, "RGB"))]


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
        """Gives that status, one line on stderr and no picture beside those that were there."""
        pictures = lambda: {p for p in self.folder.iterdir() if p.suffix in (".png", ".exr", ".pfm", ".part")}
        before = pictures()
        result = run(*arguments, **options)
        self.assertEqual(result.returncode, status, result.stderr)
        for text in says:
            self.assertIn(str(text), result.stderr)
        self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
        self.assertEqual(pictures(), before)
        return result

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

    def renders(self, *arguments, **options):
        result = run("render", *arguments, **options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def picture(self, scene, name, *options):
        """Renders quietly into the folder and reads what was written: a list of rows, or an Exr."""
        path = self.folder / name
        self.renders(SCENES / (scene + ".gltf"), "-o", path, "--quiet", *options)
        return read_pfm(path) if path.suffix == ".pfm" else Exr(path)

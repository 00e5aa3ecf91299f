# SPDX-License-Identifier: MIT
"""Reads OpenEXR files by the standard library alone."""
import struct
import sys
import zlib
from array import array
from itertools import accumulate
from pathlib import Path

WEIGHTS = (0.2126, 0.7152, 0.0722)  # weights of luminance
TURNED = bytes(i ^ 128 for i in range(256))


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
    `numbers`: those that are floats, matrices or chromaticities; `windows`: of data and display, each left, top, right, bottom."""

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

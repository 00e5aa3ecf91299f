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


def write_exr(path, width, height, layers, **more):
    """Writes uncompressed scan lines of floats; a value of a layer is a number, or a list of all pixels."""
    return write_parts(path, (width, height), [{"layers": layers, **more}])


def write_parts(path, size, parts):
    """Writes parts of a picture of that size: `layers`, and perhaps a `name`, a `window` (left, top, right, bottom) and `chromaticities`."""
    text = lambda s: s.encode() + b"\0"
    attribute = lambda name, kind, data: text(name) + text(kind) + struct.pack("<I", len(data)) + data
    headers, bodies = b"", []
    for part in parts:
        names = sorted(part["layers"])
        left, top, right, bottom = part.get("window", (0, 0, size[0] - 1, size[1] - 1))
        width, height = right - left + 1, bottom - top + 1
        attributes = [
            ("channels", "chlist", b"".join(text(name) + struct.pack("<iiii", 2, 0, 1, 1) for name in names) + b"\0"),
            ("compression", "compression", b"\0"), ("dataWindow", "box2i", struct.pack("<4i", left, top, right, bottom)),
            ("displayWindow", "box2i", struct.pack("<4i", 0, 0, size[0] - 1, size[1] - 1)), ("lineOrder", "lineOrder", b"\0"),
            ("pixelAspectRatio", "float", struct.pack("<f", 1)), ("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
            ("screenWindowWidth", "float", struct.pack("<f", 1))]
        if "chromaticities" in part:
            attributes.append(("chromaticities", "chromaticities", struct.pack("<8f", *part["chromaticities"])))
        if "name" in part:
            attributes += [("name", "string", part["name"].encode()), ("type", "string", b"scanlineimage"), ("chunkCount", "int", struct.pack("<i", height))]
        headers += b"".join(attribute(*one) for one in attributes) + b"\0"
        value = lambda name, i: part["layers"][name] if isinstance(part["layers"][name], (int, float)) else part["layers"][name][i]
        bodies.append([struct.pack("<iI", top + y, 4 * width * len(names)) + b"".join(struct.pack("<f", value(n, y * width + x)) for n in names for x in range(width))
                       for y in range(height)])
    several = len(parts) > 1
    data = struct.pack("<II", 20000630, 2 | 0x1000 * several) + headers + b"\0" * several
    blocks = [(struct.pack("<I", p) if several else b"") + line for p, lines in enumerate(bodies) for line in lines]
    place = len(data) + 8 * len(blocks)
    for block in blocks:
        data += struct.pack("<Q", place)
        place += len(block)
    Path(path).write_bytes(data + b"".join(blocks))
    return path

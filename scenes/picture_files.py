# SPDX-License-Identifier: MIT
"""Writes the pictures the scenes need: PNG textures and PFM environments."""

import struct
import zlib
from pathlib import Path


def encode_srgb(linear):
    """The sRGB byte of a linear value in [0, 1] (IEC 61966-2-1)."""
    linear = min(max(linear, 0.0), 1.0)
    value = 12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055
    return round(255 * value)


def write_png(path, width, height, texel):
    """Writes an 8-bit PNG; texel(x, y) gives 3 or 4 bytes, row 0 is the top."""
    channels = len(texel(0, 0))
    rows = bytearray()
    for y in range(height):
        rows.append(0)
        for x in range(width):
            rows.extend(texel(x, y))

    def chunk(tag, data):
        return struct.pack(">I", len(data)) + tag + data + struct.pack(">I", zlib.crc32(tag + data))

    header = struct.pack(">IIBBBBB", width, height, 8, {3: 2, 4: 6}[channels], 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header)
                     + chunk(b"IDAT", zlib.compress(bytes(rows), 9)) + chunk(b"IEND", b""))


def write_pfm(path, width, height, radiance):
    """Writes linear radiance; radiance(x, y) gives 3 floats, row 0 is the top (PFM stores the bottom row first)."""
    body = bytearray()
    for y in reversed(range(height)):
        for x in range(width):
            body.extend(struct.pack("<3f", *radiance(x, y)))
    path.write_bytes(b"PF\n%d %d\n-1.0\n" % (width, height) + bytes(body))


def read_png(path):
    """RGB or RGBA of 8 or 16 bits: width, height, rows of bytes, bytes a pixel (www.w3.org/TR/png)."""
    data = Path(path).read_bytes()
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height, depth, color = struct.unpack_from(">IIBB", body)
            assert depth in (8, 16) and color in (2, 6), path
        elif kind == b"IDAT":
            packed += body
        at += size + 12
    step = (3 if color == 2 else 4) * depth // 8
    raw, stride, rows = zlib.decompress(packed), step * width, []
    before = bytearray(stride)
    for y in range(height):
        kind, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for x in range(stride):
            a, b = (line[x - step] if x >= step else 0), before[x]
            c = before[x - step] if x >= step else 0
            if kind == 1:
                line[x] = (line[x] + a) & 255
            elif kind == 2:
                line[x] = (line[x] + b) & 255
            elif kind == 3:
                line[x] = (line[x] + (a + b) // 2) & 255
            elif kind == 4:
                p, da, db, dc = a + b - c, abs(b - c), abs(a - c), abs(a + b - 2 * c)
                line[x] = (line[x] + (a if da <= db and da <= dc else b if db <= dc else c)) & 255
        rows.append(bytes(line))
        before = line
    return width, height, rows, step

# SPDX-License-Identifier: MIT
"""Writes the pictures the scenes need: PNG textures and PFM environments."""

import struct
import zlib


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

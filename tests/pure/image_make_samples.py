#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes samples/, the tiny encoded pictures of image_samples.h. PNG by hand, the rest by Pillow, so that none
of them comes from the library under test."""

import io
import pathlib
import struct
import zlib

from PIL import Image


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(width, height, depth, colour_type, rows, extra=()):
    raw = b"".join(b"\0" + row for row in rows)
    header = struct.pack(">IIBBBBB", width, height, depth, colour_type, 0, 0, 0)
    chunks = [chunk(b"IHDR", header), *extra, chunk(b"IDAT", zlib.compress(raw, 9)), chunk(b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunks)


def pillow(mode, size, colour, form, **options):
    stream = io.BytesIO()
    Image.new(mode, size, colour).save(stream, form, **options)
    return stream.getvalue()


def gradient(form, **options):
    picture = Image.new("RGB", (32, 32))
    picture.putdata([(x * 8, y * 8, (x * 37 + y * 91) % 256) for y in range(32) for x in range(32)])
    stream = io.BytesIO()
    picture.save(stream, form, **options)
    return stream.getvalue()


GREY, RGB, PALETTE, GREY_ALPHA, RGBA = 0, 2, 3, 4, 6
SAMPLES = [
    ("rgba8.png", "(200, 100, 50, 128), (10, 20, 30, 0)",
     png(2, 1, 8, RGBA, [bytes([200, 100, 50, 128, 10, 20, 30, 0])])),
    ("rgb16.png", "(0x0001, 0x1234, 0xffff), (0x8000, 0xabcd, 0x00ff)",
     png(2, 1, 16, RGB, [struct.pack(">6H", 0x0001, 0x1234, 0xFFFF, 0x8000, 0xABCD, 0x00FF)])),
    ("grey16.png", "0x1234, 0xfedc", png(2, 1, 16, GREY, [struct.pack(">2H", 0x1234, 0xFEDC)])),
    ("grey8.png", "top row 0, 128; bottom row 255, 1", png(2, 2, 8, GREY, [bytes([0, 128]), bytes([255, 1])])),
    ("grey1.png", "one bit: white, black", png(2, 1, 1, GREY, [bytes([0b10000000])])),
    ("grey-alpha8.png", "(200, 64), (100, 255)", png(2, 1, 8, GREY_ALPHA, [bytes([200, 64, 100, 255])])),
    ("palette.png", "indices 1, 0 of (255, 128, 0), (7, 8, 9)",
     png(2, 1, 8, PALETTE, [bytes([1, 0])], [chunk(b"PLTE", bytes([255, 128, 0, 7, 8, 9]))])),
    ("palette-alpha.png", "the same, (255, 128, 0) having alpha 51",
     png(2, 1, 8, PALETTE, [bytes([1, 0])],
         [chunk(b"PLTE", bytes([255, 128, 0, 7, 8, 9])), chunk(b"tRNS", bytes([51]))])),
    ("bad-profile.png", "(1, 2, 3) with a wrong gAMA and a broken iCCP",
     png(1, 1, 8, RGB, [bytes([1, 2, 3])], [chunk(b"gAMA", struct.pack(">I", 0)), chunk(b"iCCP", b"x\0\0xyz")])),
    ("huge.png", "claims 2^30 x 2^30 pixels", png(1 << 30, 1 << 30, 8, RGB, [bytes(3)])),
    ("gradient.png", "32 x 32: (8 x, 8 y, noise)", gradient("PNG")),
    ("gradient.jpg", "the same", gradient("JPEG", quality=80)),
    ("progressive.jpg", "the same", gradient("JPEG", quality=80, progressive=True)),
    ("grey.jpg", "8 x 8 of 100", pillow("L", (8, 8), 100, "JPEG", quality=95)),
    ("cmyk.jpg", "8 x 8 of cyan 0.2, magenta 0.4, yellow 0.6, black 26 / 255 (stored inverted, as Adobe does)",
     pillow("CMYK", (8, 8), (51, 102, 153, 26), "JPEG", quality=95)),
    ("rgba.webp", "2 x 1, lossless, of (200, 100, 50, 128)",
     pillow("RGBA", (2, 1), (200, 100, 50, 128), "WEBP", lossless=True, exact=True)),
]

for name, _, data in SAMPLES:
    (pathlib.Path(__file__).with_name("samples") / name).write_bytes(data)

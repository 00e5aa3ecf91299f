#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Compares pictures of real glTF files by others with those in tests/assets. Skipped without the files.

FRAGTRACE_ASSETS=FOLDER: another folder of assets than /work/shared/assets.
assets_test.py FRAGTRACE SOURCE_FOLDER --remake [NAME...] makes the pictures again; each is to be looked at before it is kept."""
import os
import statistics
import struct
import subprocess
import sys
import unittest
import zlib
from pathlib import Path

from support import FRAGTRACE, SCENES, WEIGHTS, Case, Exr, main

FOLDER = Path(os.environ.get("FRAGTRACE_ASSETS", "/work/shared/assets")) / "scenes"
PICTURES = SCENES.parent / "tests/assets"
SIDE = 48
SPP, REFERENCE_SPP = 256, 4096
# Significance of a picture's whole comparison, two-sided, shared between blocks of both sizes (Bonferroni).
SIGNIFICANCE = 1e-3
ROUNDING = 1e-3  # half floats, and drivers that round otherwise
MEAN_BIAS = 0.01

FRONT = ("--camera-orbit", "0,0")
# Name of the picture: file, options. Light is the repository's sky, and what the files bring.
PLACES = {
    "AlphaBlendModeTest": ("AlphaBlendModeTest/AlphaBlendModeTest.glb", *FRONT),
    "Avocado": ("Avocado/Avocado.gltf", *FRONT),
    "BoomBoxWithAxes": ("BoomBoxWithAxes/BoomBoxWithAxes.gltf", *FRONT),
    "Cameras-0": ("Cameras/Cameras.gltf", "--camera-index", 0),
    "Cameras-1": ("Cameras/Cameras.gltf", "--camera-index", 1),
    "CornellBox": ("CornellBox/CornellBox.glb", *FRONT),
    "FlightHelmet": ("FlightHelmet/FlightHelmet.gltf", *FRONT),
    "Fox-1s": ("Fox/Fox.glb", "--animation-time", 1, *FRONT),
    "GlassVaseFlowers": ("GlassVaseFlowers/GlassVaseFlowers.glb", *FRONT),
    "LightsPunctualLamp": ("LightsPunctualLamp/LightsPunctualLamp.gltf", "--lamp-units", "photometric", *FRONT),
    "MetalRoughSpheresNoTextures": ("MetalRoughSpheresNoTextures/MetalRoughSpheresNoTextures.glb", *FRONT),
    "MultiUVTest": ("MultiUVTest/MultiUVTest.gltf",),
    "NormalTangentTest": ("NormalTangentTest/NormalTangentTest.glb", *FRONT),
    "SimpleSparseAccessor": ("SimpleSparseAccessor/SimpleSparseAccessor.gltf", *FRONT),
    "Suzanne": ("Suzanne/Suzanne.gltf", *FRONT),
    "TextureSettingsTest": ("TextureSettingsTest/TextureSettingsTest.glb", *FRONT),
    "ToyCar": ("ToyCar/ToyCar.gltf",),
    "TransmissionTest": ("TransmissionTest/TransmissionTest.glb",),
    "TwoSidedPlane": ("TwoSidedPlane/TwoSidedPlane.gltf", "--camera-orbit", "0,90"),
    "VertexColorTest": ("VertexColorTest/VertexColorTest.gltf", *FRONT),
    "WaterBottle": ("WaterBottle/WaterBottle.gltf", *FRONT),
}


def command(name, path, *options):
    scene, *own = PLACES[name]
    return ["render", FOLDER / scene, "-o", path, "--quiet", "--hdri-file", SCENES / "sky.pfm", "--resolution", f"{SIDE},{SIDE}", *own, *options]


def write_half_exr(path, picture, names):
    """Layers of it, named in alphabetical order, as half floats, in ZIP blocks of 16 lines (openexr.com, "OpenEXR File Layout")."""
    attribute = lambda name, kind, data: name + b"\0" + kind + b"\0" + struct.pack("<I", len(data)) + data
    channels = b"".join(name.encode() + b"\0" + struct.pack("<IIII", 1, 0, 1, 1) for name in names) + b"\0"
    window = struct.pack("<4i", 0, 0, picture.width - 1, picture.height - 1)
    header = struct.pack("<II", 20000630, 2) + b"".join([
        attribute(b"channels", b"chlist", channels), attribute(b"compression", b"compression", b"\3"),
        attribute(b"dataWindow", b"box2i", window), attribute(b"displayWindow", b"box2i", window), attribute(b"lineOrder", b"lineOrder", b"\0"),
        attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1)), attribute(b"screenWindowCenter", b"v2f", struct.pack("<ff", 0, 0)),
        attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1))]) + b"\0"
    blocks = []
    for first in range(0, picture.height, 16):
        lines = range(first, min(first + 16, picture.height))
        data = b"".join(struct.pack(f"<{picture.width}e", *picture.layers[c][y]) for y in lines for c in names)
        halves = data[0::2] + data[1::2]
        deltas = bytes([halves[0]]) + bytes((b - a + 128) & 255 for a, b in zip(halves, halves[1:]))
        packed = zlib.compress(deltas, 9)
        packed = packed if len(packed) < len(data) else data
        blocks.append(struct.pack("<ii", first, len(packed)) + packed)
    places, at = [], len(header) + 8 * len(blocks)
    for block in blocks:
        places.append(at)
        at += len(block)
    path.write_bytes(header + struct.pack(f"<{len(places)}Q", *places) + b"".join(blocks))


def remake(names):
    for name in names or PLACES:
        path = PICTURES / (name + ".whole.exr")
        subprocess.run([FRAGTRACE, *map(str, command(name, path, "--spp", REFERENCE_SPP, "--seed", 2, "--aov", "variance"))], check=True)
        picture = Exr(path)
        # The deviation is that of one sample. From few samples, the brightness of the rare ones would not be known.
        picture.layers["deviation.Y"] = [[(v * REFERENCE_SPP) ** 0.5 for v in row] for row in picture.layers["variance.Y"]]
        write_half_exr(PICTURES / (name + ".exr"), picture, ["B", "G", "R", "deviation.Y"])
        path.unlink()
        print(name, flush=True)


def blocks(values, side):
    """Sums over blocks of so many pixels per side."""
    sums = [0.0] * (SIDE // side) ** 2
    for i, value in enumerate(values):
        sums[i // SIDE // side * (SIDE // side) + i % SIDE // side] += value
    return sums


@unittest.skipUnless(FOLDER.is_dir(), f"{FOLDER} is absent")
class AssetScenes(Case):
    def worst(self, drawn, reference, variances, side):
        """In standard errors, of blocks; both pictures are lists of luminances."""
        floor = 0.1 * sum(reference) / len(reference)
        differences = blocks([a - b for a, b in zip(drawn, reference)], side)
        slack = blocks([ROUNDING * (b + floor) for b in reference], side)
        return max(max(0.0, abs(d) - s) / (v + 1e-20) ** 0.5 for d, s, v in zip(differences, slack, blocks(variances, side)))

    def test_every_scene_shows_what_its_picture_shows(self):
        for name in PLACES:
            with self.subTest(name):
                path = self.folder / (name + ".exr")
                self.renders(*command(name, path, "--spp", SPP, "--seed", 1, "--aov", "variance")[1:])
                drawn, reference = Exr(path), Exr(PICTURES / (name + ".exr"))
                # A rare bright sample may have been met by either picture alone.
                variances = [max(v, d * d / SPP) + d * d / REFERENCE_SPP
                             for v, d in zip(drawn.values("variance.Y"), reference.values("deviation.Y"))]
                noise = sum(variances) ** 0.5 / SIDE ** 2
                figures = []
                for side in (1, 4):
                    limit = statistics.NormalDist().inv_cdf(1 - SIGNIFICANCE / 4 / (SIDE // side) ** 2)
                    worst = self.worst(drawn.luminances(), reference.luminances(), variances, side)
                    figures.append(f"{worst:.2f} of {limit:.2f}")
                    self.assertLessEqual(worst, limit, f"blocks of {side} x {side}")
                for channel, weight in zip("RGB", WEIGHTS):
                    a, b = (statistics.fmean(picture.values(channel)) for picture in (drawn, reference))
                    # A channel's noise is at most the luminance's over its weight.
                    self.assertLessEqual(abs(a - b), MEAN_BIAS * b + 4 * noise / weight, channel)
                print(f"{name}: worst pixel and block {', '.join(figures)} standard errors", flush=True)

    def test_every_scene_is_there(self):
        """A folder that is not drawn would be missed."""
        drawn = {place[0].split("/")[0] for place in PLACES.values()}
        self.assertEqual(drawn, {entry.name for entry in FOLDER.iterdir() if entry.is_dir()})


if __name__ == "__main__":
    if "--remake" in sys.argv:
        remake(sys.argv[sys.argv.index("--remake") + 1:])
    else:
        main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes a scene with large PNG textures: eight urns with 24 of 4096 x 4096, or a hall with 70 of 2048 x 2048. Needs numpy; 0.6 and 0.5 GB.
usage: scenes/large_textures.py urns|hall FOLDER [SIDE]"""
import math
import struct
import sys
import zlib
from pathlib import Path

import numpy as np

from geometry import quad
from gltf_writer import GltfWriter

KINDS = ("color", "normal", "rough")
SCENES = {"urns": (24, 4096), "hall": (70, 2048)}  # textures, and their side
URN = ((0.0, 0.0), (0.22, 0.0), (0.24, 0.06), (0.16, 0.14), (0.34, 0.45), (0.38, 0.7), (0.3, 0.95), (0.18, 1.08), (0.26, 1.2))
COLUMN = ((0.5, 0.0), (0.5, 0.25), (0.34, 0.4), (0.34, 3.4), (0.52, 3.6), (0.52, 3.9))


def png(rgb):
    """A PNG of 8 bits, each row minus the one above it."""
    side = len(rgb)
    rows = np.zeros((side, 1 + 3 * side), np.uint8)
    rows[:, 0] = 2
    flat = rgb.reshape(side, -1)
    rows[0, 1:], rows[1:, 1:] = flat[0], flat[1:] - flat[:-1]

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    header = struct.pack(">IIBBBBB", side, side, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 1)) + chunk(b"IEND", b"")


def value_noise(side, cells, random):
    """Numbers of 0 to 1 that repeat at the borders."""
    grid = random.random((cells, cells), np.float32)
    x = np.arange(side, dtype=np.float32) * cells / side
    first = x.astype(int)
    part = (x - first) ** 2 * (3 - 2 * (x - first))
    second = (first + 1) % cells
    rows = grid[:, first] * (1 - part) + grid[:, second] * part
    return rows[first] * (1 - part)[:, None] + rows[second] * part[:, None]


def pictures(side, seed):
    """Bricks, tiles or discs under noise: colour, normal and roughness."""
    random = np.random.default_rng(seed)
    height = sum(value_noise(side, cells, random) * weight for cells, weight in ((5, 0.4), (20, 0.3), (80, 0.2), (side // 4, 0.1)))
    at = np.arange(side, dtype=np.float32) / side
    rows = 4 + seed % 5
    y, x = np.meshgrid(at * rows, at * rows / (1 + seed % 2), indexing="ij")
    x = x + (seed % 2) * 0.5 * (np.floor(y) % 2)
    x, y = abs(x % 1 - 0.5), abs(y % 1 - 0.5)
    raised = np.hypot(x, y) < 0.4 if seed % 3 == 2 else np.maximum(x, y) < 0.46
    height += 0.5 * raised
    dark, bright = random.uniform(0.1, 0.5, 3), random.uniform(0.4, 0.95, 3)
    grain = random.integers(-6, 7, (side, side, 1))
    color = (dark + (bright - dark) * height[..., None] / 1.5) * 255 + grain
    slope = [(np.roll(height, 1, axis) - np.roll(height, -1, axis)) * side / 400 for axis in (1, 0)]
    length = np.sqrt(1 + slope[0] ** 2 + slope[1] ** 2)
    normal = np.stack((slope[0] / length, -slope[1] / length, 1 / length), -1) * 127.5 + 127.5
    rough = np.stack((np.full_like(height, 255), 255 * (0.9 - 0.4 * height / 1.5), np.zeros_like(height)), -1) + grain / 2
    for picture in (color, normal, rough):
        yield np.clip(picture, 0, 255).astype(np.uint8)


def add_materials(scene, count, side):
    """Adds materials with three textures each, and fewer for the last one. Returns their indices."""
    materials = []
    for number in range((count + 2) // 3):
        textures = {}
        for kind, picture in list(zip(KINDS, pictures(side, number)))[:count - 3 * number]:
            name = f"{kind}{number}.png"
            (scene.folder / name).write_bytes(png(picture))
            textures[kind] = {"index": scene.add_texture(name)}
        materials.append(scene.add_material(f"material{number}", texture=textures["color"]))
        entry = scene.root["materials"][-1]
        if "normal" in textures:
            entry["normalTexture"] = textures["normal"]
        if "rough" in textures:
            entry["pbrMetallicRoughness"]["metallicRoughnessTexture"] = textures["rough"]
    return materials


def turned(profile, material, scene, segments=96):
    """A primitive: a profile of radius and height that turns about the y axis."""
    rings = [tuple(a + (b - a) * k / 8 for a, b in zip(p, q)) for p, q in zip(profile, profile[1:]) for k in range(8)] + [profile[-1]]
    positions, uvs, indices = [], [], []
    for radius, y in rings:
        for i in range(segments + 1):
            angle = 2 * math.pi * i / segments
            positions.append((radius * math.sin(angle), y, radius * math.cos(angle)))
            uvs.append((2 * i / segments, -y))
    row = segments + 1
    for j in range(len(rings) - 1):
        for i in range(segments):
            a, b = j * row + i, j * row + i + 1
            indices += [a, b, b + row, a, b + row, a + row]
    return scene.primitive(positions, indices, material, uvs=uvs, index_component="I")


def panel(name, scene, material, origin, right, up):
    """A parallelogram whose picture repeats every two metres."""
    u, v = (math.hypot(*side) / 2 for side in (right, up))
    scene.place_mesh(name, scene.primitive(quad(origin, right, up), [0, 1, 2, 0, 2, 3], material, uvs=[(0, v), (u, v), (u, 0), (0, 0)]))


def place_urns(scene, materials):
    for i, material in enumerate(materials):
        scene.place_mesh(f"urn{i}", turned(URN, material, scene), translation=[i % 4 * 0.9 - 1.35, 0, -0.9 * (i // 4)])
    scene.add_camera("camera", (0.6, 1.9, 3.4), (0, 0.5, -0.4), 35, 1.5)


def place_hall(scene, materials):
    """Five bays of two storeys between columns, open at the top."""
    of = iter(range(10 ** 6))

    def material():
        return materials[next(of) % len(materials)]

    for bay in range(5):
        z = -4.0 * bay
        panel(f"floor{bay}", scene, material(), (-4, 0, z), (8, 0, 0), (0, 0, -4))
        for storey in range(2):
            panel(f"left{bay}{storey}", scene, material(), (-4, 4 * storey, z), (0, 0, -4), (0, 4, 0))
            panel(f"right{bay}{storey}", scene, material(), (4, 4 * storey, z - 4), (0, 0, 4), (0, 4, 0))
        for x in (-2.6, 2.6):
            scene.place_mesh(f"column{bay}{x}", turned(COLUMN, material(), scene), translation=[x, 0, z - 2])
    panel("end", scene, material(), (-4, 0, -20), (8, 0, 0), (0, 8, 0))
    scene.add_camera("camera", (0, 1.8, 0), (0, 2.4, -10), 60, 1.5)


def main(kind, folder, side=None):
    count, usual = SCENES[kind]
    Path(folder).mkdir(parents=True, exist_ok=True)
    scene = GltfWriter(Path(folder), kind)
    {"urns": place_urns, "hall": place_hall}[kind](scene, add_materials(scene, count, int(side or usual)))
    scene.add_light("sun", "directional", 3.0, direction=(-0.4, -1, -0.5))
    scene.write()


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4) or sys.argv[1] not in SCENES:
        sys.exit(__doc__)
    main(*sys.argv[1:])

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes a scene of long thin triangles at all angles: prisms of 24 sides, beams of a turned lattice, or hanging wires. Needs numpy.
usage: scenes/long_triangles.py prisms|beams|wires FOLDER [COUNT]"""
import json
import math
import sys
from pathlib import Path

import numpy as np

COUNTS = {"prisms": 20000, "beams": 8, "wires": 400}
LENGTH, RADIUS = 0.5, 0.004  # of a prism in a cube of side 2
TURN = np.radians(30)  # of the lattice


def frames(directions):
    """Two directions across each direction."""
    aside = np.where(np.abs(directions[:, :1]) < 0.6, [[1.0, 0, 0]], [[0, 1.0, 0]])
    u = np.cross(directions, aside)
    u /= np.linalg.norm(u, axis=1, keepdims=True)
    return u, np.cross(directions, u)


def rods(begins, ends, radius, sides):
    """Positions and indices of closed prisms."""
    along = ends - begins
    u, v = frames(along / np.linalg.norm(along, axis=1, keepdims=True))
    angles = np.arange(sides) * 2 * math.pi / sides
    ring = radius * (np.cos(angles)[None, :, None] * u[:, None] + np.sin(angles)[None, :, None] * v[:, None])
    positions = np.concatenate([begins[:, None] + ring, ends[:, None] + ring], axis=1)
    i, j = np.arange(sides), (np.arange(sides) + 1) % sides
    fan = np.arange(1, sides - 1)
    zero = 0 * fan
    one = np.concatenate([np.stack([i, j, sides + j], 1), np.stack([i, sides + j, sides + i], 1), np.stack([zero, fan + 1, fan], 1),
                          sides + np.stack([zero, fan, fan + 1], 1)])
    indices = one[None] + 2 * sides * np.arange(len(begins))[:, None, None]
    return positions.reshape(-1, 3), indices.reshape(-1)


def prisms(count, random):
    middles = random.uniform(-1, 1, (count, 3))
    directions = random.normal(size=(count, 3))
    half = 0.5 * LENGTH * directions / np.linalg.norm(directions, axis=1, keepdims=True)
    return rods(middles - half, middles + half, RADIUS, 24)


def beams(count, random):
    """A lattice of beams as long as the cube, with diagonals, turned about two axes."""
    line = np.linspace(-1, 1, count + 1)
    a, b = (x.reshape(-1, 1) for x in np.meshgrid(line, line))
    one = np.ones_like(a)
    begins = np.concatenate([np.hstack([-one, a, b]), np.hstack([a, -one, b]), np.hstack([a, b, -one]), np.hstack([-one, -one, a])])
    ends = np.concatenate([np.hstack([one, a, b]), np.hstack([a, one, b]), np.hstack([a, b, one]), np.hstack([one, one, b])])
    cosine, sine = np.cos(TURN), np.sin(TURN)
    turn = np.array([[cosine, 0, sine], [0, 1, 0], [-sine, 0, cosine]]) @ np.array([[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]])
    return rods(begins @ turn.T, ends @ turn.T, 0.02, 4)


def wires(count, random):
    """Cables between random points of two walls, each of 16 straight parts that sag."""
    left, right = random.uniform(-1, 1, (2, count, 3))
    left[:, 0], right[:, 0] = -1, 1
    part = np.linspace(0, 1, 17)[None, :, None]
    points = left[:, None] * (1 - part) + right[:, None] * part
    points[:, :, 1] -= 0.6 * (part * (1 - part))[:, :, 0]
    return rods(points[:, :-1].reshape(-1, 3), points[:, 1:].reshape(-1, 3), 0.003, 6)


def main():
    kind, folder = sys.argv[1], Path(sys.argv[2])
    count = int(sys.argv[3]) if len(sys.argv) > 3 else COUNTS[kind]
    positions, indices = {"prisms": prisms, "beams": beams, "wires": wires}[kind](count, np.random.default_rng(1))
    positions = positions.astype("<f4")
    folder.mkdir(parents=True, exist_ok=True)
    name = f"{kind}-{count}"
    (folder / f"{name}.bin").write_bytes(positions.tobytes() + indices.astype("<u4").tobytes())
    views = [{"buffer": 0, "byteOffset": 0, "byteLength": positions.nbytes}, {"buffer": 0, "byteOffset": positions.nbytes, "byteLength": 4 * len(indices)}]
    gltf = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
            "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 5]}],
            "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}}],
            "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 1, "baseColorFactor": [0.7, 0.7, 0.7, 1]}}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(positions), "type": "VEC3", "min": positions.min(0).tolist(),
                           "max": positions.max(0).tolist()},
                          {"bufferView": 1, "componentType": 5125, "count": len(indices), "type": "SCALAR"}],
            "bufferViews": views, "buffers": [{"uri": f"{name}.bin", "byteLength": sum(view["byteLength"] for view in views)}]}
    (folder / f"{name}.gltf").write_text(json.dumps(gltf) + "\n")
    print(f"{folder / name}.gltf: {len(indices) // 3} triangles")


if __name__ == "__main__":
    main()

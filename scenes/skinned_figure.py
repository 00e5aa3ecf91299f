#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes a skinned, animated figure as .glb: a column that bows and turns. usage: scenes/skinned_figure.py FILE [TRIANGLES]"""
import json
import math
import struct
import sys

JOINTS = 6
HEIGHT = 2.0
SECONDS = 2.0


def figure(triangles=60000):
    side = round(math.sqrt(triangles / 2))
    positions, normals, joints, weights, indices = [], [], [], [], []
    for j in range(side + 1):
        y = HEIGHT * j / side
        radius = 0.25 + 0.08 * math.sin(9.0 * y)
        slope = 0.72 * math.cos(9.0 * y)
        place = min(y / HEIGHT * (JOINTS - 1), JOINTS - 1.001)
        joint, part = int(place), place - int(place)
        for i in range(side + 1):
            angle = 2.0 * math.pi * i / side
            length = math.hypot(1.0, slope)
            positions += [radius * math.cos(angle), y, radius * math.sin(angle)]
            normals += [math.cos(angle) / length, -slope / length, math.sin(angle) / length]
            joints += [joint, joint + 1, 0, 0]
            weights += [1.0 - part, part, 0.0, 0.0]
    for j in range(side):
        for i in range(side):
            a, b = j * (side + 1) + i, (j + 1) * (side + 1) + i
            indices += [a, b, a + 1, a + 1, b, b + 1]
    step = HEIGHT / (JOINTS - 1)
    inverse = [v for j in range(JOINTS) for v in (1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -step * j, 0, 1)]
    times = [SECONDS * k / 4 for k in range(5)]
    turns = [v for k in range(5) for v in (0.0, 0.0, math.sin(0.25 * math.sin(0.5 * math.pi * k)), math.cos(0.25 * math.sin(0.5 * math.pi * k)))]
    arrays = [("f", positions, 3, "VEC3", 5126), ("f", normals, 3, "VEC3", 5126), ("B", joints, 4, "VEC4", 5121), ("f", weights, 4, "VEC4", 5126),
              ("I", indices, 1, "SCALAR", 5125), ("f", inverse, 16, "MAT4", 5126), ("f", times, 1, "SCALAR", 5126), ("f", turns, 4, "VEC4", 5126)]
    data, views, accessors = b"", [], []
    for code, values, width, kind, component in arrays:
        packed = struct.pack(f"<{len(values)}{code}", *values)
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(packed)})
        accessors.append({"bufferView": len(views) - 1, "componentType": component, "count": len(values) // width, "type": kind})
        data += packed + b"\0" * (-len(packed) % 4)
    for index, width in ((0, 3), (6, 1)):
        values = arrays[index][1]
        accessors[index]["min"] = [min(values[c::width]) for c in range(width)]
        accessors[index]["max"] = [max(values[c::width]) for c in range(width)]
    nodes = [{"translation": [0, step if j else 0, 0], **({"children": [j + 1]} if j + 1 < JOINTS else {})} for j in range(JOINTS)]
    nodes.append({"mesh": 0, "skin": 0})
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, JOINTS]}], "nodes": nodes,
        "skins": [{"joints": list(range(JOINTS)), "inverseBindMatrices": 5}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "JOINTS_0": 2, "WEIGHTS_0": 3}, "indices": 4, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.45, 0.3, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.5}}],
        "animations": [{"name": "bow", "samplers": [{"input": 6, "output": 7}],
                        "channels": [{"sampler": 0, "target": {"node": j, "path": "rotation"}} for j in range(1, JOINTS)]}],
        "buffers": [{"byteLength": len(data)}], "bufferViews": views, "accessors": accessors}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    return struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(data), len(text), 0x4E4F534A) + text + struct.pack("<II", len(data), 0x004E4942) + data


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    with open(sys.argv[1], "wb") as file:
        file.write(figure(*map(int, sys.argv[2:])))

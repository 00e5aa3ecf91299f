#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A field of bumpy balls that are one mesh: instanced_scene.py FOLDER NAME INSTANCES TRIANGLES."""

import math
import random
import sys
from pathlib import Path

from gltf_writer import GltfWriter, normalize


def bumpy_ball(triangles):
    """Positions, normals and indices of a closed ball of 2 C (R - 1) triangles, R = C / 2 + 1, as near to that number as it goes."""
    columns = max(4, round(math.sqrt(triangles)))
    rings = columns // 2 + 1

    def point(ring, column):
        theta, phi = math.pi * ring / rings, 2 * math.pi * (column % columns) / columns
        direction = (math.sin(theta) * math.cos(phi), math.cos(theta), math.sin(theta) * math.sin(phi))
        radius = 1 + 0.15 * math.sin(theta) ** 2 * math.sin(5 * phi) * math.cos(3 * theta)
        return tuple(radius * x for x in direction)

    positions = [(0, 1, 0)] + [point(r, c) for r in range(1, rings) for c in range(columns)] + [(0, -1, 0)]
    place = lambda r, c: 1 + (r - 1) * columns + c % columns
    indices = []
    for c in range(columns):
        indices += [0, place(1, c + 1), place(1, c), len(positions) - 1, place(rings - 1, c), place(rings - 1, c + 1)]
        for r in range(1, rings - 1):
            indices += [place(r, c), place(r, c + 1), place(r + 1, c), place(r, c + 1), place(r + 1, c + 1), place(r + 1, c)]
    return positions, [normalize(p) for p in positions], indices


def write_field(folder, name, instances, triangles, uneven=False, normal_map=None):
    """Balls on a jittered grid over a floor, under a sun; `uneven`: scaled differently along each axis, every third one mirrored; normal_map: a
    picture next to the scene."""
    dice = random.Random(1)
    writer = GltfWriter(Path(folder), name)
    side = math.ceil(math.sqrt(instances))
    mapped = {"normalTexture": {"index": writer.add_texture(normal_map)}} if normal_map else {}
    clay = writer.add_lambert("clay", (0.8, 0.45, 0.3), **mapped)
    floor = writer.add_lambert("floor", (0.5, 0.5, 0.5))
    positions, normals, indices = bumpy_ball(triangles)
    uvs = [(x, y) for x, y, _ in positions] if normal_map else None
    ball = writer.add_mesh("ball", writer.primitive(positions, indices, clay, normals, uvs, index_component="I"))
    places, turns, sizes = [], [], []
    for i in range(instances):
        x, z = i % side - side / 2 + 0.5, i // side - side / 2 + 0.5
        size = dice.uniform(0.3, 0.45)
        sizes.append(tuple(size * (dice.uniform(0.6, 1.0) if uneven else 1) for _ in range(3)))
        if uneven and i % 3 == 0:
            sizes[-1] = (-sizes[-1][0], *sizes[-1][1:])
        places.append((x + dice.uniform(-0.1, 0.1), max(map(abs, sizes[-1])), z + dice.uniform(-0.1, 0.1)))
        turns.append(normalize(tuple(dice.gauss(0, 1) for _ in range(4))))
    attributes = {"TRANSLATION": writer.add_accessor(places, target=None), "ROTATION": writer.add_accessor(turns, target=None),
                  "SCALE": writer.add_accessor(sizes, target=None)}
    writer.extensions_used.add("EXT_mesh_gpu_instancing")
    writer.add_node("field", mesh=ball, extensions={"EXT_mesh_gpu_instancing": {"attributes": attributes}})
    reach = 0.6 * side
    writer.place_mesh("floor", writer.primitive([(-reach, 0, -reach), (-reach, 0, reach), (reach, 0, reach), (reach, 0, -reach)],
                                                [0, 1, 2, 0, 2, 3], floor))
    writer.add_light("sun", "directional", 3.0, direction=normalize((-0.5, -1, -0.3)))
    writer.add_camera("camera", (0, 0.35 * side + 0.5, 0.75 * side + 0.5), (0, 0, 0.05 * side), 40, aspect=16 / 9)
    writer.write()


if __name__ == "__main__":
    write_field(sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4]))

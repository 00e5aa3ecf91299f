# SPDX-License-Identifier: MIT
"""Scenes of thousands of lamps: corridor.gltf and city.gltf."""

import geometry
from geometry import box_faces, quad
from scene_parts import place_faces, place_quad, scene


def mixed(*numbers):
    """Evenly spread over 0 to 1, the same each time."""
    x = 0
    for n in numbers:
        x = ((x ^ (n * 0x9E3779B1 & 0xFFFFFFFF)) * 0x85EBCA6B + 0xC2B2AE35) & 0xFFFFFFFF
        x ^= x >> 15
    return x / 2 ** 32


@scene("corridor")
def corridor(gltf):
    """A corridor of 150 m, 10,000 lamps of two centimetres on its ceiling and walls; their powers are 1 to 100."""
    length, half, high = 150, 1.5, 2.6
    walls = gltf.add_lambert("walls", (0.62, 0.6, 0.56))
    for name, face in zip("abcdef", box_faces((-half, 0, -length), (half, high, 0))):
        place_quad(gltf, "wall-" + name, geometry.flip(face), walls)
    for k in range(30):
        side = -1 if k % 2 else 1
        low, top = (side * 0.9 - 0.35, 0, -5 * k - 3.4), (side * 0.9 + 0.35, 0.6 + mixed(k) * 0.9, -5 * k - 2.6)
        place_faces(gltf, "block-%d" % k, box_faces(low, top), gltf.add_lambert("block-%d" % k, (0.3 + 0.5 * mixed(k, 1), 0.4, 0.75 - 0.5 * mixed(k, 1))))
    steps = 9
    corners = [[] for _ in range(steps)]
    for k in range(10000):
        z, size = -length * (k + 0.5) / 10000, 0.02
        # A bright one is rare: as many lamps have a tenth of the power as have a hundredth.
        step = min(steps - 1, int(steps * mixed(k, 2) ** 3))
        x = -half + 0.05 + (2 * half - 0.1) * mixed(k, 3)
        if k % 4:
            points = [(x - size, high - 0.01, z), (x + size, high - 0.01, z), (x, high - 0.01, z + size)]
        else:
            side, y = (-1, 1)[k // 4 % 2], 1.2 + 1.3 * mixed(k, 4)
            points = [(side * (half - 0.01), y - size, z), (side * (half - 0.01), y + size, z), (side * (half - 0.01), y, z + size * -side)]
        corners[step] += [tuple(round(c, 6) for c in point) for point in points]
    for step, points in enumerate(corners):
        power = 100 ** (step / (steps - 1))
        radiance = [round(12 * power * c, 6) for c in ((1, 0.85, 0.6), (0.8, 0.9, 1), (1, 0.6, 0.4))[step % 3]]
        gltf.place_mesh("lamps-%d" % step, gltf.primitive(points, material=gltf.add_lamp("lamp-%d" % step, radiance)))
    gltf.add_camera("camera", (0.3, 1.6, -1), (0, 1.1, -12), 60)


@scene("city")
def city(gltf):
    """Towers along streets at night: a third of their windows is lit. A street in the middle is seen from above."""
    place_quad(gltf, "ground", geometry.ground(130, 130), gltf.add_lambert("ground", (0.35, 0.35, 0.37)))
    stone = [gltf.add_lambert("stone-%d" % i, (0.45 + 0.1 * i, 0.45 + 0.06 * i, 0.45)) for i in range(3)]
    colors = ((1, 0.8, 0.5), (1, 0.92, 0.75), (0.7, 0.85, 1), (1, 0.65, 0.35))
    windows = [[] for _ in range(8)]
    for row in range(10):
        for column in range(10):
            x, z, half = 22 * column - 99, 22 * row - 99, 6
            floors = 3 + int(13 * mixed(row, column) ** 2)
            place_faces(gltf, "tower-%d-%d" % (row, column), box_faces((x - half, 0, z - half), (x + half, 3 * floors + 1, z + half)), stone[(row + 2 * column) % 3])
            for k in range(floors * 20):
                wall, place, floor = k % 4, k // 4 % 5, k // 20
                if mixed(row, column, k) > 0.33:
                    continue
                along, out, y = -half + 1.2 + 2.4 * place - 0.5, half + 0.02, 3 * floor + 1.2
                start, right = {0: ((x + along, y, z + out), (1, 0, 0)), 1: ((x - along, y, z - out), (-1, 0, 0)),
                                2: ((x + out, y, z - along), (0, 0, -1)), 3: ((x - out, y, z + along), (0, 0, 1))}[wall]
                pane = quad(start, right, (0, 1.4, 0))
                windows[int(8 * mixed(row, column, k, 1))].append([tuple(round(c, 4) for c in corner) for corner in pane])
    for i, panes in enumerate(windows):
        radiance = [round(c * (1.5 if i < 4 else 6), 6) for c in colors[i % 4]]
        positions, indices = geometry.join_quads(panes)
        gltf.place_mesh("windows-%d" % i, gltf.primitive(positions, indices, gltf.add_lamp("window-%d" % i, radiance)))
    gltf.add_camera("camera", (3, 26, 52), (-1, 6, 6), 50)

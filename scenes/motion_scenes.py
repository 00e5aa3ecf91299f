# SPDX-License-Identifier: MIT
"""Scenes that move."""

import math

from geometry import box_faces, ground
from gltf_writer import rotation_about
from scene_parts import place_faces, place_quad, scene


def torus(around, along, ring, tube):
    """A torus round z with smooth normals."""
    positions, normals, indices = [], [], []
    for i in range(along):
        a = 2 * math.pi * i / along
        for j in range(around):
            b = 2 * math.pi * j / around
            normal = (math.cos(b) * math.cos(a), math.cos(b) * math.sin(a), math.sin(b))
            positions.append((ring * math.cos(a) + tube * normal[0], ring * math.sin(a) + tube * normal[1], tube * normal[2]))
            normals.append(normal)
            p, q = i * around + j, i * around + (j + 1) % around
            r, s = (i + 1) % along * around + j, (i + 1) % along * around + (j + 1) % around
            indices += [p, r, q, q, r, s]
    return positions, normals, indices


def animate(gltf, node, path, times, values):
    animations = gltf.root.setdefault("animations", [{"name": "roll", "samplers": [], "channels": []}])
    samplers = animations[0]["samplers"]
    samplers.append({"input": gltf.add_accessor(times, target=None, bounds=True), "output": gltf.add_accessor(values, target=None)})
    animations[0]["channels"].append({"sampler": len(samplers) - 1, "target": {"node": node, "path": path}})


@scene("wheel")
def wheel(gltf):
    """A wheel that rolls to the right, a turn in half a second, with a light on its rim; two cameras, one of which follows it."""
    place_quad(gltf, "ground", ground(8, 4), gltf.add_lambert("grey", (0.5, 0.5, 0.5)))
    lamp = gltf.add_lamp("lamp", (12, 11, 10))
    place_faces(gltf, "lamp", box_faces((-1.5, 4, -0.5), (1.5, 4.1, 1.5)), lamp)
    radius, tube, seconds = 1.0, 0.12, 0.5
    roll = gltf.add_node("roll", translation=[-1.8, radius, 0])
    spin = gltf.add_node("spin", parent=roll)
    positions, normals, indices = torus(12, 48, radius - tube, tube)
    tyre = gltf.primitive(positions, indices, gltf.add_material("rubber", (0.05, 0.05, 0.06), roughness=0.5), normals)
    gltf.place_mesh("tyre", tyre, parent=spin)
    colors = [(0.8, 0.1, 0.05), (0.85, 0.6, 0.1), (0.1, 0.5, 0.15), (0.1, 0.3, 0.8)]
    for i, color in enumerate(colors):
        place_faces(gltf, f"spoke-{i}", box_faces((0.1, -0.06, -0.04), (0.82, 0.06, 0.04)),
                    gltf.add_material(f"paint-{i}", color, roughness=0.4), parent=spin, rotation=rotation_about((0, 0, 1), 90 * i))
    place_faces(gltf, "light", box_faces((0.62, -0.07, 0.1), (0.76, 0.07, 0.14)), gltf.add_lamp("glow", (60, 40, 15)), parent=spin,
                rotation=rotation_about((0, 0, 1), 45))
    place_faces(gltf, "hub", box_faces((-0.1, -0.1, -0.1), (0.1, 0.1, 0.1)), gltf.add_material("steel", (0.8, 0.8, 0.8), metallic=1, roughness=0.3),
                parent=spin)
    gltf.add_camera("camera", (0, 1.7, 6), (0, 1, 0), 38, 16 / 9)
    follower = gltf.add_camera("follower", (-1.8, 1.4, 5), (-1.8, 1, 0), 38, 16 / 9)
    way = 2 * math.pi * radius
    animate(gltf, roll, "translation", [0, seconds], [(-1.8, radius, 0), (-1.8 + way, radius, 0)])
    animate(gltf, spin, "rotation", [seconds * k / 4 for k in range(5)], [tuple(rotation_about((0, 0, 1), -90 * k)) for k in range(5)])
    animate(gltf, follower, "translation", [0, seconds], [(-1.8, 1.4, 5), (-1.8 + way, 1.4, 5)])

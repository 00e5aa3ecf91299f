#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Materials, normals and angles at their extremes, on the driver: no sample that is not finite, none below zero. (tests/pure/shader_sweep_test.cpp sweeps
each lobe in C++; this sees what textures, vertices, lights and the driver's own rounding add.)"""
import json
import math
import random
import struct

from support import BACKENDS, SCENES, SQUARE, TWO_TRIANGLES, Case, Gltf, data_uri, main, png

COLUMNS, ROWS = 16, 12
LENGTHS = (0, 1e-38, 1e-20, 1, 1, 1, 1e18, 3e38)  # lengths of normals


def extreme(draw):
    return draw.choice((0, 1, 10**draw.uniform(-8, 0), 1 - 10**draw.uniform(-8, 0), draw.random()))


def color(draw):
    return [extreme(draw)] * 3 if draw.random() < 0.5 else [extreme(draw) for _ in range(3)]


def material(draw):
    """Returns a random mixture of all extensions."""
    extensions = {
        "ior": {"ior": draw.choice((1, 1.0004, 1.33, 1.5, 2.5))},
        "specular": {"specularFactor": extreme(draw), "specularColorFactor": color(draw)},
        "sheen": {"sheenColorFactor": color(draw), "sheenRoughnessFactor": extreme(draw)},
        "clearcoat": {"clearcoatFactor": extreme(draw), "clearcoatRoughnessFactor": extreme(draw)},
        "anisotropy": {"anisotropyStrength": extreme(draw), "anisotropyRotation": 7 * extreme(draw)},
        "iridescence": {"iridescenceFactor": extreme(draw), "iridescenceIor": 1 + extreme(draw), "iridescenceThicknessMaximum": 1200 * extreme(draw)},
        "diffuse_transmission": {"diffuseTransmissionFactor": extreme(draw), "diffuseTransmissionColorFactor": color(draw)},
        "transmission": {"transmissionFactor": extreme(draw)},
        "volume": {"thicknessFactor": draw.choice((0, 1)), "attenuationDistance": 10**draw.uniform(-6, 6), "attenuationColor": color(draw)},
    }
    kept = {"KHR_materials_" + name: values for name, values in extensions.items() if draw.random() < 0.5}
    return {"pbrMetallicRoughness": {"baseColorFactor": color(draw) + [1], "metallicFactor": extreme(draw), "roughnessFactor": extreme(draw)},
            "extensions": kept, "normalTexture": {"index": 0, "scale": draw.choice((0, 1, 1, 1, -1, 1e-8, 1e8))}, "doubleSided": draw.random() < 0.5}


def scene(seed):
    """A wall of squares, tilted up to its edge; normals of all lengths, some that look away; a point light and a mirror of all kinds next to it."""
    draw = random.Random(seed)
    gltf = Gltf()
    indices, uvs = gltf.accessor(TWO_TRIANGLES, "H"), gltf.accessor([(0, 1), (1, 1), (1, 0), (0, 0)])
    corners = gltf.accessor([(x / 2, y / 2, z) for x, y, z in SQUARE])
    materials = []
    for k in range(COLUMNS * ROWS):
        normals = []
        for _ in range(4):
            n = [draw.gauss(0, 1) * draw.choice((0, 1, 1)) for _ in range(2)] + [draw.choice((0, 1e-6, 1, 1, -1))]
            normals.append([c * draw.choice(LENGTHS) / max(1, math.hypot(*n)) for c in n])
        materials.append(material(draw))
        mesh = gltf.mesh(indices, position=corners, texcoord_0=uvs, normal=gltf.accessor(normals), material=k)
        tilt = draw.choice((0, 0, 1.5, 1.57)) / 2
        gltf.node(mesh=mesh, translation=[k % COLUMNS - COLUMNS / 2 + 0.5, k // COLUMNS - ROWS / 2 + 0.5, 0], rotation=[0, math.sin(tilt), 0, math.cos(tilt)])
    light = {"extensions": {"KHR_lights_punctual": {"light": 0}}}
    for node in ({"translation": [0, 0, 2], **light}, {"translation": [3, 2, 1e-4], **light}, {"camera": 0, "translation": [0, 0, 9]}):
        gltf.node(**node)
    # Directions of all kinds, blue below a half among them: they look into the surface.
    texels = [255 * draw.choice((0, 0.5, 1, draw.random())) for _ in range(4 * 64)]
    names = sorted({name for m in materials for name in m["extensions"]} | {"KHR_lights_punctual"})
    gltf.root |= {"extensionsUsed": names, "materials": materials, "textures": [{"source": 0}],
                  "images": [{"uri": data_uri("image/png", png(8, 8, list(map(int, texels))))}],
                  "cameras": [{"type": "orthographic", "orthographic": {"xmag": COLUMNS / 2, "ymag": ROWS / 2, "zfar": 20, "znear": 0.1}}],
                  "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 30}]}}}
    return gltf.document()


class Extremes(Case):
    def check(self, seed, samples, *options):
        path = self.written(f"extremes-{seed}.gltf", scene(seed))
        stats = self.folder / "s.json"
        self.renders(path, "-o", self.folder / "x.pfm", "--quiet", "--resolution", "192,144", "--spp", samples, "--hdri-file", SCENES / "sky.pfm", "--stats", stats, *options)
        self.assertEqual(json.loads(stats.read_text())["nonfinite_pixels"], 0, f"seed {seed}, {options}")
        lowest = min(struct.unpack(f"<{3 * 192 * 144}f", (self.folder / "x.pfm").read_bytes().split(b"\n", 3)[3]))
        self.assertGreaterEqual(lowest, 0, f"seed {seed}, {options}")

    def test_path_tracing(self):
        self.check(1, 16)

    def test_the_stages_before(self):
        self.check(2, 4, "--stage", "normal-maps")


class ExtremesAtLength(Extremes):
    """Extended: many walls, on both back ends."""

    def test_path_tracing(self):
        for seed in range(10, 30):
            self.check(seed, 256, "--rendering-backend", BACKENDS[seed % len(BACKENDS)])

    def test_the_stages_before(self):
        for seed in range(30, 36):
            for stage in ("flat", "phong", "shadows", "reflections", "refraction", "normal-maps"):
                self.check(seed, 16, "--stage", stage)


if __name__ == "__main__":
    main()

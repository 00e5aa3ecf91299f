#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Squares under one directional light, seen straight on: each has one colour, which is a formula of glTF 2.0's appendix B or of an extension, within 3e-4."""
import json
import math
import struct

from materials_test import data_uri
from support import Case, main

ANGLE = 0.3  # of the light to the normal
LIGHT = (math.sin(ANGLE), 0, math.cos(ANGLE))
HALF = (math.sin(ANGLE / 2), 0, math.cos(ANGLE / 2))
IRRADIANCE = 2 * math.cos(ANGLE)
BLACK = {"KHR_materials_specular": {"specularFactor": 0}}
COLOR = [0.8, 0.5, 0.3]
CORNERS = ((0.9, 0.2, 0.4), (0.5, 0.7, 0.1), (0.1, 0.9, 0.8), (0.6, 0.3, 0.2))  # vertex colours
SIDE = 16  # pixels of a square


def schlick(f0, cosine):
    return f0 + (1 - f0) * (1 - cosine)**5


def facets(along, across):
    """Value of the specular lobe that reflects all, for facets of these widths in x and y."""
    def smith(v):
        return (math.sqrt(1 + ((along * v[0])**2 + (across * v[1])**2) / v[2]**2) - 1) / 2

    distribution = 1 / (math.pi * along * across * ((HALF[0] / along)**2 + (HALF[1] / across)**2 + HALF[2]**2)**2)
    return distribution / ((1 + smith((0, 0, 1)) + smith(LIGHT)) * 4 * LIGHT[2])


def velvet(alpha):
    """Value of white sheen (Estevez and Kulla, 2017)."""
    def fit(x):
        t = (1 - alpha)**2
        a, b, c, d, e = (t * p + (1 - t) * q for p, q in ((25.3245, 21.5473), (3.32435, 3.82987), (0.16801, 0.19823), (-1.27393, -1.97760), (-4.85967, -4.32054)))
        return a / (1 + b * x**c) + d * x + e

    smith = lambda cosine: math.exp(fit(cosine)) if cosine < 0.5 else math.exp(2 * fit(0.5) - fit(1 - cosine))
    distribution = (2 + 1 / alpha) * HALF[0]**(1 / alpha) / (2 * math.pi)
    return distribution / ((1 + smith(1) + smith(LIGHT[2])) * 4 * LIGHT[2])


def base(metallic, roughness, color=(0, 0, 0), **extensions):
    return {"pbrMetallicRoughness": {"baseColorFactor": [*color, 1], "metallicFactor": metallic, "roughnessFactor": roughness},
            "extensions": {"KHR_materials_" + name: values for name, values in extensions.items()}}


def expected_base(metallic, roughness, specular=1.0, ior=1.5, tint=(1, 1, 1)):
    lobe = facets(roughness**2, roughness**2)
    f0 = [min(1, ((ior - 1) / (ior + 1))**2 * t) * specular for t in tint]
    dielectric = [f + (specular - f) * (1 - HALF[2])**5 for f in f0]
    return [IRRADIANCE * (metallic * schlick(c, HALF[2]) * lobe + (1 - metallic) * (d * lobe + (1 - max(dielectric)) * c / math.pi))
            for c, d in zip(COLOR, dielectric)]


def squares():
    """Materials and the colours that they show."""
    none = {"specularFactor": 0}
    stretched = (0.09 + 0.91 * 0.6**2, 0.09)
    coat = 0.9 * 0.04  # seen straight on
    absorbed = [math.exp(math.log(c) * 0.5 / 0.7) for c in COLOR]  # half a metre, of 0.7 in which COLOR is left
    return [
        (base(1, 0.3, COLOR), expected_base(1, 0.3)),
        (base(0.4, 0.4, COLOR, specular={"specularFactor": 0.8, "specularColorFactor": [1, 0.5, 0.7]}, ior={"ior": 1.8}),
         expected_base(0.4, 0.4, 0.8, 1.8, (1, 0.5, 0.7))),
        (base(0, 1, specular=none, clearcoat={"clearcoatFactor": 0.9, "clearcoatRoughnessFactor": 0.3}), 3 * [IRRADIANCE * coat * facets(0.09, 0.09)]),
        (base(0, 1, COLOR, specular=none, clearcoat={"clearcoatFactor": 0.9}), [IRRADIANCE * (1 - coat) * c / math.pi for c in COLOR]),
        (base(0, 1, specular=none, sheen={"sheenColorFactor": COLOR, "sheenRoughnessFactor": 0.8}), [IRRADIANCE * c * velvet(0.64) for c in COLOR]),
        (base(1, 0.3, COLOR, anisotropy={"anisotropyStrength": 0.6}), [IRRADIANCE * schlick(c, HALF[2]) * facets(*stretched) for c in COLOR]),
        (base(0, 1, COLOR, specular=none, diffuse_transmission={"diffuseTransmissionFactor": 0.3, "diffuseTransmissionColorFactor": [0, 0, 0]}), [IRRADIANCE * 0.7 * c / math.pi for c in COLOR]),
        (base(0, 1, (1, 1, 1), unlit={}), [sum(c[i] for c in CORNERS[:3]) / 6 + (CORNERS[0][i] + CORNERS[2][i] + CORNERS[3][i]) / 6 for i in range(3)]),
        (base(0, 0, (1, 1, 1), ior={"ior": 1.0}, transmission={"transmissionFactor": 1}, specular=none,
              volume={"thicknessFactor": 1, "attenuationColor": COLOR, "attenuationDistance": 0.7}), absorbed),
    ]


class KnownSurfaces(Case):
    def scene(self, materials):
        corners = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
        data = b"".join(struct.pack("<3f", *c) for c in corners) + b"".join(struct.pack("<2f", *t) for t in ((0, 1), (1, 1), (1, 0), (0, 0)))
        data += b"".join(struct.pack("<3f", *c) for c in CORNERS) + struct.pack("<6H", 0, 1, 2, 0, 2, 3)
        parts = ((48, 4, "VEC3", 5126), (32, 4, "VEC2", 5126), (48, 4, "VEC3", 5126), (12, 6, "SCALAR", 5123))
        views = [{"buffer": 0, "byteOffset": sum(part[0] for part in parts[:i]), "byteLength": part[0]} for i, part in enumerate(parts)]
        accessors = [{"bufferView": i, "count": count, "type": kind, "componentType": component} for i, (_, count, kind, component) in enumerate(parts)]
        accessors[0] |= {"min": [-1, -1, 0], "max": [1, 1, 0]}
        count = len(materials)
        shapes = [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 3, "material": i} for i in range(count)]
        shapes[-2]["attributes"]["COLOR_0"] = 2
        nodes = [{"mesh": i, "translation": [2 * i - count + 1, 0, 0]} for i in range(count)]
        # The last is a slab half a metre thick, with an unlit white square behind it.
        nodes.append({"mesh": count - 1, "translation": [count - 1, 0, -0.5], "rotation": [0, 1, 0, 0]})
        nodes.append({"mesh": count, "translation": [count - 1, 0, -1]})
        shapes.append({"attributes": {"POSITION": 0}, "indices": 3, "material": count - 2})
        nodes.append({"camera": 0, "translation": [0, 0, 5]})
        nodes.append({"rotation": [0, math.sin(ANGLE / 2), 0, math.cos(ANGLE / 2)], "extensions": {"KHR_lights_punctual": {"light": 0}}})
        return {"asset": {"version": "2.0"}, "materials": materials, "meshes": [{"primitives": [shape]} for shape in shapes], "nodes": nodes,
                "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}], "bufferViews": views, "accessors": accessors,
                "buffers": [{"byteLength": len(data), "uri": data_uri("application/octet-stream", data)}],
                "cameras": [{"type": "orthographic", "orthographic": {"xmag": count, "ymag": 1, "zfar": 10, "znear": 0.1}}],
                "extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 2}]}}}

    def test_each(self):
        known = squares()
        path = self.folder / "squares.gltf"
        path.write_text(json.dumps(self.scene([material for material, _ in known])))
        picture = self.picture(str(path.with_suffix("")), "x.pfm", "--resolution", f"{len(known) * SIDE},{SIDE}", "--spp", 16, "--bounces", 3,
                               "--energy-compensation", "off")
        for i, (material, colors) in enumerate(known):
            for c, color in enumerate(colors):
                seen = sum(row[SIDE * i + x][c] for row in picture for x in range(SIDE)) / SIDE**2
                self.assertAlmostEqual(seen / color, 1, delta=3e-4, msg=material)


if __name__ == "__main__":
    main()

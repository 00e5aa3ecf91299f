#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A texture of one colour is a factor: squares under one directional light, each once with the texture and once with the product."""
import copy
import math

from support import Case, main, png, quad

COLOURS = {"baseColorTexture", "emissiveTexture", "specularColorTexture", "sheenColorTexture"}  # sRGB
SIDE = 8  # pixels of a square
ANGLE = 1.0  # angle between light and normal


def linear(key, texel):
    """The texel as light, or as the number that it is."""
    x = texel / 255
    if key in COLOURS:
        x = x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055)**2.4
    return x


def material(extension, color=(0, 0, 0), metallic=0, roughness=0.5, **more):
    """Makes a material whose light comes from the given values alone; the rest is black. A texture is given as its only
    texel."""
    base = {"baseColorFactor": [*color, 1], "metallicFactor": metallic, "roughnessFactor": roughness}
    return {"pbrMetallicRoughness": base, "extensions": {"KHR_materials_specular": {"specularFactor": 0}, "KHR_materials_" + extension: more}}


WHITE = [0.9, 0.8, 0.7]
MATERIALS = [
    {"pbrMetallicRoughness": {"baseColorFactor": [*WHITE, 1], "baseColorTexture": 150, "metallicFactor": 0}},
    {"pbrMetallicRoughness": {"baseColorFactor": [*WHITE, 1], "metallicFactor": 0.9, "roughnessFactor": 0.8, "metallicRoughnessTexture": 150}},
    material("transmission", WHITE, roughness=0, transmissionFactor=0.9, transmissionTexture=150),
    material("specular", specularFactor=0.9, specularTexture=150),
    material("specular", specularColorFactor=WHITE, specularColorTexture=150),
    material("clearcoat", clearcoatFactor=0.9, clearcoatTexture=150, clearcoatRoughnessFactor=0.3),
    material("clearcoat", clearcoatFactor=1, clearcoatRoughnessFactor=0.9, clearcoatRoughnessTexture=150),
    material("sheen", sheenColorFactor=WHITE, sheenColorTexture=150, sheenRoughnessFactor=0.5),
    material("sheen", sheenColorFactor=WHITE, sheenRoughnessFactor=0.9, sheenRoughnessTexture=150),
    material("iridescence", (0.5, 0.5, 0.5), 1, 0.4, iridescenceFactor=0.9, iridescenceTexture=150, iridescenceThicknessMaximum=400),
    material("iridescence", (0.5, 0.5, 0.5), 1, 0.4, iridescenceFactor=1, iridescenceThicknessMinimum=0, iridescenceThicknessMaximum=400,
             iridescenceThicknessTexture=150),
    material("diffuse_transmission", WHITE, diffuseTransmissionFactor=0.9, diffuseTransmissionTexture=150),
]


def multiplied(values, _):
    """Multiplies each texture's texel into the factor beside it, in the objects of a material."""
    for key in [key for key in values if key.endswith("Texture")]:
        texel = linear(key, values.pop(key))
        names = {"metallicRoughnessTexture": ["metallicFactor", "roughnessFactor"],
                 "iridescenceThicknessTexture": ["iridescenceThicknessMaximum"]}.get(key, [key.removesuffix("Texture") + "Factor"])
        for name in names:
            times = lambda c: c * texel
            values[name] = [*map(times, values[name][:3]), *values[name][3:]] if isinstance(values[name], list) else times(values[name])


def pictured(values, images):
    for key in [key for key in values if key.endswith("Texture")]:
        images.append(png(1, 1, [values[key]] * 3 + [values[key] if key not in COLOURS else 255]))
        values[key] = {"index": len(images) - 1}


class TextureFactors(Case):
    def means(self, change):
        """Returns the mean of each square and channel. The pictures with textures and those without are separate, since
        a shader for textures reads white where there is none."""
        images, materials = [], copy.deepcopy(MATERIALS)
        for m in materials:
            for values in [m["pbrMetallicRoughness"], *m.get("extensions", {}).values()]:
                change(values, images)
        gltf = quad(materials[0], images=images)
        count = len(materials)
        gltf["materials"] = materials
        gltf["meshes"] = [{"primitives": [dict(gltf["meshes"][0]["primitives"][0], material=i)]} for i in range(count)]
        gltf["nodes"] = [{"mesh": i, "translation": [2 * i - count + 1, 0, 0]} for i in range(count)] + [
            {"camera": 0, "translation": [0, 0, 5]},
            {"rotation": [0, math.sin(ANGLE / 2), 0, math.cos(ANGLE / 2)], "extensions": {"KHR_lights_punctual": {"light": 0}}}]
        gltf["scenes"] = [{"nodes": list(range(count + 2))}]
        gltf["cameras"] = [{"type": "orthographic", "orthographic": {"xmag": count, "ymag": 1, "zfar": 10, "znear": 0.1}}]
        gltf["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 2}]}}
        path = self.written("factors.gltf", {key: value for key, value in gltf.items() if value})
        picture = self.picture(str(path.with_suffix("")), "x.pfm", "--resolution", f"{count * SIDE},{SIDE}", "--spp", 4, "--bounces", 0)
        return [sum(row[SIDE * i + x][c] for row in picture for x in range(SIDE)) for i in range(count) for c in range(3)]

    def test_emission(self):
        image = png(1, 1, [200] * 3 + [255])
        gltf = quad({"emissiveFactor": WHITE, "emissiveTexture": {"index": 0}, "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}}, images=[image])
        gltf = {key: value for key, value in gltf.items() if value}
        path = self.written("emission.gltf", gltf)
        pixel = self.picture(str(path.with_suffix("")), "x.pfm", "--resolution", "8,8", "--spp", 1)[4][4]
        for seen, factor in zip(pixel, WHITE):
            self.assertAlmostEqual(seen / factor, linear("emissiveTexture", 200), delta=1e-6)

    def test_each_slot(self):
        """Within 2e-5: a texel is exact."""
        for i, (one, other) in enumerate(zip(self.means(multiplied), self.means(pictured))):
            self.assertAlmostEqual(other / one, 1, delta=2e-5, msg=MATERIALS[i // 3])


if __name__ == "__main__":
    main()

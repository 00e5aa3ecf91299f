#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A texture of one colour is a factor: each slot on a sphere of its own, drawn once with the texture and once with the product, by the same random numbers."""
import copy
import json

from materials_test import Materials, data_uri, png
from support import SCENES, Case, main

COLOURS = {"baseColorTexture", "emissiveTexture", "specularColorTexture", "sheenColorTexture", "diffuseTransmissionColorTexture"}  # sRGB
SIDE = 16  # pixels of a sphere


def linear(key, texel):
    x = texel / 255
    if key not in COLOURS:
        return x
    return x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055)**2.4


def material(extension=None, color=(0, 0, 0), metallic=0, roughness=0.5, **more):
    """All that is not asked for is black. A texture is given as its one texel."""
    extensions = {"KHR_materials_specular": {"specularFactor": 0}}
    if extension:
        extensions["KHR_materials_" + extension] = more
    base = {"baseColorFactor": [*color, 1], "metallicFactor": metallic, "roughnessFactor": roughness}
    return {"pbrMetallicRoughness": base, "extensions": extensions} | ({} if extension else more)


WHITE = [0.9, 0.8, 0.7]
MATERIALS = [
    {"pbrMetallicRoughness": {"baseColorFactor": [*WHITE, 1], "baseColorTexture": 150, "metallicFactor": 0}},
    {"pbrMetallicRoughness": {"baseColorFactor": [*WHITE, 1], "metallicFactor": 0.9, "roughnessFactor": 0.8, "metallicRoughnessTexture": 150}},
    material(emissiveFactor=WHITE, emissiveTexture=200),
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
    material("diffuse_transmission", diffuseTransmissionFactor=0.9, diffuseTransmissionColorFactor=WHITE, diffuseTransmissionColorTexture=150),
]


def multiplied(values):
    """Of the objects of a material, those with textures: the factor beside each has the texel in it."""
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
    spheres = Materials.spheres

    def means(self, change):
        materials = copy.deepcopy(MATERIALS)
        for m in materials:
            for values in [m, m["pbrMetallicRoughness"], *m.get("extensions", {}).values()]:
                change(values)
        gltf = self.spheres(materials)
        if self.images:
            gltf |= {"images": [{"uri": data_uri("image/png", image)} for image in self.images], "textures": [{"source": i} for i in range(len(self.images))]}
        path = self.folder / "factors.gltf"
        path.write_text(json.dumps(gltf))
        picture = self.picture(str(path.with_suffix("")), "x.pfm", "--resolution", f"{len(materials) * SIDE},{SIDE}", "--spp", 16, "--bounces", 2,
                               "--hdri-file", SCENES / "sky.pfm", "--light-sampling", "bsdf")
        return [sum(row[SIDE * i + x][c] for row in picture for x in range(SIDE)) for i in range(len(materials)) for c in range(3)]

    def test_each_slot(self):
        """Within 1e-3, where a texel that counts 2 % too much makes more. The random numbers are the same."""
        self.images = []
        factors = self.means(multiplied)
        for i, (one, other) in enumerate(zip(factors, self.means(lambda values: pictured(values, self.images)))):
            self.assertAlmostEqual(other / one, 1, delta=1e-3, msg=MATERIALS[i // 3])


if __name__ == "__main__":
    main()

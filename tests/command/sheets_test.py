#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Stacks of sheets whose picture is a closed form of their alphas: means of a million samples, within 5 standard errors, which faults of 2 % exceed."""
import math

from support import Case, main, quad

NARROW = ["--camera-view-angle", 1, "--bounces", "unlimited"]
SPECULAR = {"KHR_materials_specular": {"specularFactor": 0}}


def sheet(color=(0, 0, 0), alpha=1.0, **more):
    return {"pbrMetallicRoughness": {"baseColorFactor": [*color, alpha], "metallicFactor": 0}, "doubleSided": True, "extensions": SPECULAR, **more}


class Sheets(Case):
    def stack(self, sheets, *options, size=128, spp=64):
        """The picture's mean colour, of quads (material, z, width) before a camera at z = 2.2."""
        gltf = quad(sheets[0][0])
        primitive = gltf["meshes"][0]["primitives"][0]
        gltf["materials"] = [material for material, _, _ in sheets]
        gltf["meshes"] = [{"primitives": [dict(primitive, material=i)]} for i in range(len(sheets))]
        gltf["nodes"] = [gltf["nodes"][1]] + [{"mesh": i, "translation": [0, 0, z], "scale": [width, width, 1]} for i, (_, z, width) in enumerate(sheets)]
        gltf["nodes"].append({"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [0, 0, 9]})
        gltf["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 1}]}}
        gltf["scenes"] = [{"nodes": list(range(len(gltf["nodes"])))}]
        path = self.written("stack.gltf", {key: value for key, value in gltf.items() if value})
        picture = self.picture(str(path.with_suffix("")), "x.pfm", "--resolution", f"{size},{size}", "--spp", spp, *options)
        return [sum(pixel[c] for row in picture for pixel in row) / size**2 for c in range(3)]

    def assert_share(self, seen, share, samples, light=1.0):
        """A part `share` of the samples see `light`."""
        self.assertAlmostEqual(seen, share * light, delta=5 * light * math.sqrt(share * (1 - share) / samples) + 1e-6)

    def test_each_sheet_covers_its_alpha_of_what_the_ones_before_leave(self):
        # So close together that a ray that goes on 2 % of the way behind one misses all.
        alphas = (0.5, 0.4, 0.6)
        colors = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
        sheets = [(sheet(color, alpha, alphaMode="BLEND"), -0.01 * i, 3) for i, (color, alpha) in enumerate(zip(colors, alphas))]
        left = 1.0
        for seen, alpha in zip(self.stack(sheets, "--stage", "flat"), alphas):
            self.assert_share(seen, left * alpha, 128 * 128 * 64)
            left *= 1 - alpha

    def test_light_through_sheets_is_what_their_alphas_leave(self):
        """A white ground, and between it and the lamp black sheets that the camera does not see."""
        sheets = [(sheet((1, 1, 1)), 0, 3), (sheet(alpha=0.5, alphaMode="BLEND"), 3, 9), (sheet(alpha=0.4, alphaMode="BLEND"), 3.01, 9)]
        for seen in self.stack(sheets):
            self.assert_share(seen, 0.5 * 0.6, 128 * 128 * 64, 1 / math.pi)

    def test_a_cutoff_a_hundredth_from_the_alpha_decides(self):
        masked = lambda cutoff, *color: (sheet(color, 0.5, alphaMode="MASK", alphaCutoff=cutoff), 0.1 * cutoff, 3)
        self.assertEqual(self.stack([masked(0.505, 1, 0, 0), masked(0.495, 0, 1, 0)], "--stage", "flat", size=8, spp=1), [0, 1, 0])

    def test_glass_that_is_half_there_lets_half_through_before_gi(self):
        """The glass has an index of 1, and lies over black and before white."""
        glass = {"KHR_materials_transmission": {"transmissionFactor": 0.5}, "KHR_materials_ior": {"ior": 1}}
        sheets = [({"pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 1], "metallicFactor": 0, "roughnessFactor": 0}, "extensions": SPECULAR | glass}, 0, 3),
                  (sheet((1, 1, 1)) | {"extensions": {"KHR_materials_unlit": {}}}, -1, 9)]
        # The opaque share is lit: it is white under a light of pi and the ambient light.
        for seen in self.stack(sheets, "--stage", "refraction"):
            self.assert_share(seen - (0.03 + 1 / math.pi), 0.5, 128 * 128 * 64, 1 - 0.03 - 1 / math.pi)

    def test_a_screen_close_before_a_lamp_lets_nothing_through(self):
        """Nor does a roof let the other light through."""
        lamp = sheet(emissiveFactor=[1, 1, 1])
        self.assertEqual(self.stack([(sheet((1, 1, 1)), 0, 3), (sheet(), 3.96, 2), (lamp, 4, 1), (sheet(), 5, 30)], size=16, spp=64), [0, 0, 0])

    def test_fog_behind_a_sheet_is_that_before_it_once_more(self):
        """Beer's law goes on behind a sheet that half of the light passes, and takes no flight twice."""
        black = sheet(alpha=0.5, alphaMode="BLEND")
        for seen in self.stack([(black, 0, 3)], *NARROW, "--background-color", "1,1,1", "--fog-density", 0.8, "--fog-color", "0,0,0", "--fog-distance", 1, size=64):
            self.assert_share(seen, 0.5 * math.exp(-0.8 * 2), 64 * 64 * 64)


if __name__ == "__main__":
    main()

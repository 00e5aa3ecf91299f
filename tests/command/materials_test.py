#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Extensions of materials through the command line: a picture made with one is the picture made without it."""
import math
import random

from support import Case, main, png, quad


def noise(width, height, seed=1):
    return png(width, height, random.Random(seed).randbytes(4 * width * height))


class Materials(Case):
    def picture_of(self, gltf, *options):
        gltf = {k: v for k, v in gltf.items() if v}
        path = self.written("scene.gltf", gltf)
        return self.picture(str(path.with_suffix("")), "x.pfm", "--resolution", "32,32", *options)

    def assert_same(self, one, other, delta):
        for row, expected in zip(one, other):
            for pixel, wanted in zip(row, expected):
                for a, b in zip(pixel, wanted):
                    self.assertAlmostEqual(a, b, delta=delta)

    def test_an_encoded_environment_is_decoded(self):
        path = self.folder / "grey.hdr"  # its bytes decide
        path.write_bytes(png(4, 2, [128, 128, 128, 7] * 8))
        corner = self.picture("environment-diffuse", "x.pfm", "--resolution", "16,16", "--spp", "1", "--hdri-file", path)[0][0]
        for channel in corner:
            self.assertAlmostEqual(channel, ((128 / 255 + 0.055) / 1.055)**2.4, delta=1e-3)

    def test_a_transformed_texture_is_read_where_transformed_coordinates_say(self):
        angle, (sx, sy), (ox, oy) = 0.5, (1.5, -0.75), (0.2, 0.6)

        def transformed(u, v):
            c, s = math.cos(angle), math.sin(angle)
            return c * sx * u + s * sy * v + ox, -s * sx * u + c * sy * v + oy

        image = [noise(4, 8)]
        uvs = ((0, 1), (1, 1), (1, 0), (0, 0))
        transform = {"offset": [ox, oy], "rotation": angle, "scale": [sx, sy]}
        plain = {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}
        moved = {"pbrMetallicRoughness": {"baseColorTexture": {
            "index": 0, "extensions": {"KHR_texture_transform": transform}}}}
        options = ("--stage", "flat", "--spp", "1")
        expected = self.picture_of(quad(plain, [transformed(*uv) for uv in uvs], image), *options)
        self.assert_same(self.picture_of(quad(moved, uvs, image), *options), expected, 2e-4)
        unmoved = self.picture_of(quad(plain, uvs, image), *options)
        self.assertGreater(max(abs(a[0] - b[0]) for a, b in zip(unmoved[16], expected[16])), 0.1)

    def test_specular_glossiness_is_the_dielectric_that_reflects_as_much(self):
        def white(alpha):
            return png(1, 1, [255, 255, 255, alpha])

        glossy = {"extensions": {"KHR_materials_pbrSpecularGlossiness": {
            "diffuseFactor": [0.6, 0.4, 0.2, 1], "specularFactor": [0.04, 0.04, 0.04], "glossinessFactor": 0.6,
            "specularGlossinessTexture": {"index": 0}}}}
        rough = {"pbrMetallicRoughness": {
            "baseColorFactor": [0.6 * 0.96, 0.4 * 0.96, 0.2 * 0.96, 1], "metallicFactor": 0,
            "roughnessFactor": 1 - 0.6 * 51 / 255}}
        expected = self.picture_of(quad(rough), "--spp", "4")
        self.assertGreater(expected[16][16][0], 0.1)
        # The tolerance is for the texture's alpha, a half float.
        self.assert_same(self.picture_of(quad(glossy, images=[white(51)]), "--spp", "4"), expected, 1e-3)

    def spheres(self, materials):
        """Makes spheres in a row. Each fills a square of the picture, seen from far away."""
        count = len(materials)
        nodes = [{"extras": {"shape": 0, "material": i}, "translation": [2 * i - count + 1, 0, 0]} for i in range(count)]
        nodes.append({"camera": 0, "translation": [0, 0, 5]})
        return {
            "asset": {"version": "2.0"}, "materials": materials, "nodes": nodes,
            "extensions": {"KHR_implicit_shapes": {"shapes": [{"type": "sphere", "sphere": {"radius": 1}}]}},
            "cameras": [{"type": "orthographic", "orthographic": {"xmag": count, "ymag": 1, "zfar": 10, "znear": 0.1}}],
            "scenes": [{"nodes": list(range(count + 1))}], "scene": 0,
        }

    def test_white_surfaces_vanish_in_white_surroundings(self):
        def white(metallic=0, roughness=0.0, **extensions):
            return {"pbrMetallicRoughness": {"metallicFactor": metallic, "roughnessFactor": roughness},
                    "extensions": {"KHR_materials_" + name: e for name, e in extensions.items()}}

        lambertian = {"specular": {"specularFactor": 0}}
        solid = {"transmission": {"transmissionFactor": 1}, "volume": {"thicknessFactor": 1}}
        materials = [
            white(**lambertian, clearcoat={"clearcoatFactor": 1}),
            white(1, 0.3, clearcoat={"clearcoatFactor": 0.5}),
            white(**lambertian, diffuse_transmission={"diffuseTransmissionFactor": 0.6}),
            white(**lambertian, diffuse_transmission={"diffuseTransmissionFactor": 1}, volume={"thicknessFactor": 1}),
            white(**solid, dispersion={"dispersion": 5}),
            white(1, 0.3),
            white(1, 0.9, anisotropy={"anisotropyStrength": 1}),
        ]
        count, size = len(materials), 16
        gltf = self.spheres(materials)
        path = self.written("furnace.gltf", gltf)
        picture = self.picture(str(path.with_suffix("")), "x.pfm", "--resolution", f"{count * size},{size}", "--spp", "256", "--bounces", "200",
                               "--default-light", "white")
        for i in range(count):
            pixels = [picture[y][i * size + x] for y in range(4, 12) for x in range(4, 12)]
            for c in range(3):
                self.assertAlmostEqual(sum(p[c] for p in pixels) / len(pixels), 1, delta=0.02, msg=f"material {i}")

    def test_a_rough_pane_loses_no_light(self):
        """1,024 directional lights all round a wall without thickness, seen at 60 degrees: all of their light is scattered. Light samples alone find them,
        so the value of the lobe that energy compensation adds counts."""
        count = 1024
        gltf = quad({"pbrMetallicRoughness": {"metallicFactor": 0}, "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}}})
        gltf["nodes"][0]["rotation"] = [math.sin(math.pi / 6), 0, 0, math.cos(math.pi / 6)]
        gltf["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 4 * math.pi / count}]}}
        for i in range(count):
            z, turn = 1 - (2 * i + 1) / count, math.pi * (3 - math.sqrt(5)) * i
            # The shortest rotation from -z to the direction in which the light shines.
            quaternion = [math.sqrt(1 - z * z) * math.sin(turn), -math.sqrt(1 - z * z) * math.cos(turn), 0.0, 1 - z]
            gltf["nodes"].append({"rotation": [q / math.hypot(*quaternion) for q in quaternion], "extensions": {"KHR_lights_punctual": {"light": 0}}})
        gltf["scenes"] = [{"nodes": list(range(len(gltf["nodes"])))}]
        pixels = [p[0] for row in self.picture_of(gltf, "--spp", 4096, "--bounces", 0, "--light-selection", "uniform")[12:20] for p in row[12:20]]
        self.assertAlmostEqual(sum(pixels) / len(pixels), 1, delta=0.005)

    def test_clearcoat_darkens_what_shines_under_it(self):
        lamp = {"emissiveFactor": [1, 1, 1], "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]},
                "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 0.5}}}
        pixel = self.picture_of(quad(lamp), "--spp", "4")[16][16]
        for channel in pixel:
            self.assertAlmostEqual(channel, 1 - 0.5 * 0.04, delta=1e-3)

    def test_a_coated_lamp_lights_a_room_alike_found_by_chance_or_chosen(self):
        lamp = {"emissiveFactor": [1, 1, 1], "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1}}}
        gltf = quad({"pbrMetallicRoughness": {"metallicFactor": 0}}) | {}
        gltf["materials"].append(lamp)
        gltf["meshes"].append({"primitives": [dict(gltf["meshes"][0]["primitives"][0], material=1)]})
        # The second quad stands next to the first one, upright, and faces it at a grazing angle.
        gltf["nodes"].append({"mesh": 1, "translation": [-1, 0, 1], "rotation": [0, 0.70710678, 0, 0.70710678]})
        gltf["scenes"][0]["nodes"].append(2)
        means = []
        for switch in ("--enable", "--disable"):
            picture = self.picture_of(gltf, "--spp", "512", switch, "light-sampling", "--stage", "gi")
            pixels = [p[0] for row in picture[8:24] for p in row[20:28]]
            means.append(sum(pixels) / len(pixels))
        self.assertAlmostEqual(means[0] / means[1], 1, delta=0.02)



if __name__ == "__main__":
    main()

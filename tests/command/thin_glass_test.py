#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Light through smooth walls of thickness 0, on matt ground under a pane wide enough to be all that is above it. With --bounces 1
nothing comes back from the pane, so that irradiance is the integral of the light times what one or two walls let through."""
import math
import statistics

from known_light_test import MATT, SPECULAR, over_ground
from support import SCENES, Case, main, quad

IOR = 1.5
PANE = 2.6    # metres above the ground, and above the camera
WIDE = 400    # half of the width of both
TINT = [0.9, 0.7, 0.5, 1]


def passed(cosine, walls=1, ior=IOR):
    """Returns the share of light that passes thin walls at an angle, without their tint: each wall has two parallel
    interfaces (docs/design/surfaces.md)."""
    refracted = math.sqrt(ior**2 - 1 + cosine**2)
    single = 0.5 * (((ior**2 * cosine - refracted) / (ior**2 * cosine + refracted))**2 + ((cosine - refracted) / (cosine + refracted))**2)
    return (1 - 2 * single / (1 + single))**walls


class ThinGlass(Case):
    def scene(self, panes, lights=(), lamps=(), **material):
        """Makes a scene of ground under panes of clear glass. `panes` are heights, `lights` the angles of directional
        lights to the vertical, `lamps` places, half widths and radiances."""
        glass = {"pbrMetallicRoughness": MATT | {"roughnessFactor": 0, "baseColorFactor": TINT},
                 "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}}}
        glass["pbrMetallicRoughness"] |= material.pop("surface", {})
        if "mode" in material:
            glass["alphaMode"] = material.pop("mode")
        glass["extensions"] |= material
        gray = [material.pop("ground", 1)] * 3 + [1]
        gltf = quad({"pbrMetallicRoughness": MATT | {"baseColorFactor": gray}, "extensions": SPECULAR})
        gltf["nodes"][0]["scale"] = [WIDE, WIDE, 1]
        primitive = gltf["meshes"][0]["primitives"][0]

        def place(material, **node):
            gltf["materials"].append(material)
            gltf["meshes"].append({"primitives": [dict(primitive, material=len(gltf["materials"]) - 1)]})
            gltf["nodes"].append({"mesh": len(gltf["meshes"]) - 1} | node)

        for height in panes:
            place(glass, translation=[0, 0, height], scale=[WIDE, WIDE, 1])
        for where, half, radiance in lamps:
            place({"pbrMetallicRoughness": MATT | {"baseColorFactor": [0, 0, 0, 1]}, "emissiveFactor": [1, 1, 1],
                   "extensions": SPECULAR | {"KHR_materials_emissive_strength": {"emissiveStrength": radiance}}},
                  translation=where, rotation=[1, 0, 0, 0], scale=[half, half, 1])
        for i, angle in enumerate(lights):
            gltf["nodes"].append({"rotation": [math.sin(angle / 2), 0, 0, math.cos(angle / 2)],
                                  "extensions": {"KHR_lights_punctual": {"light": i}}})
        if lights:
            gltf["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": math.pi} for _ in lights]}}
        gltf["scenes"] = [{"nodes": list(range(len(gltf["nodes"])))}]
        return str(self.written("panes.gltf", {key: value for key, value in gltf.items() if value}).with_suffix(""))

    def seen(self, scene, *options, spp=1, side=16):
        return self.picture(scene, "x.pfm", "--resolution", f"{side},{side}", "--spp", spp, "--no-default-light", *options)

    def channel(self, picture, index=0):
        return statistics.fmean(pixel[index] for row in picture for pixel in row)

    def assert_everywhere(self, picture, wanted, part=1e-5):
        for row in picture:
            for pixel in row:
                for value, expected in zip(pixel, wanted):
                    self.assertAlmostEqual(value, expected, delta=part * max(expected, 1))

    def test_each_wall_takes_its_share_once(self):
        """A directional light is one direction, so that each pixel is exact."""
        for angle, panes in ((0, [PANE]), (0.9, [PANE]), (1.4, [PANE, PANE + 0.5]), (0.9, [PANE, PANE, PANE + 1])):
            wanted = [math.cos(angle) * passed(math.cos(angle), len(panes)) * tint**len(panes) for tint in TINT[:3]]
            self.assert_everywhere(self.seen(self.scene(panes, [angle]), "--bounces", 1), wanted)

    def test_what_the_material_says_counts(self):
        """A transmission of 0.5 halves the light. Clearcoat and the index of refraction change it. A solid blocks
        shadow rays."""
        angle = 0.6
        cosine = math.cos(angle)
        plain = [cosine * passed(cosine) * tint for tint in TINT[:3]]

        def light(**material):
            return self.seen(self.scene([PANE], [angle], **material), "--bounces", 1)

        self.assert_everywhere(light(KHR_materials_transmission={"transmissionFactor": 0.5}), [0.5 * value for value in plain])
        self.assert_everywhere(light(KHR_materials_ior={"ior": 2}), [cosine * passed(cosine, ior=2) * tint for tint in TINT[:3]])
        coat = 0.6 * (0.04 + 0.96 * (1 - cosine)**5)
        self.assert_everywhere(light(KHR_materials_clearcoat={"clearcoatFactor": 0.6}), [(1 - coat) * value for value in plain])
        # The ground lies within its thickness: it is no pane.
        self.assert_everywhere(light(KHR_materials_volume={"thicknessFactor": 3}), [0, 0, 0])

    def test_a_pane_that_covers_in_part(self):
        """BLEND: where the pane is, as much as its alpha, it is glass. Ground so dark that what comes back from the pane is nothing."""
        angle, alpha, dark = 0.6, 0.4, 0.01
        cosine = math.cos(angle)
        scene = self.scene([PANE], [angle], surface={"baseColorFactor": TINT[:3] + [alpha]}, mode="BLEND", ground=dark)
        picture = self.seen(scene, "--bounces", 1, spp=256)
        for i, tint in enumerate(TINT[:3]):
            glass = passed(cosine) * tint
            error = dark * cosine * (1 - glass) * math.sqrt(alpha * (1 - alpha) / (256 * 16 * 16))
            self.assertAlmostEqual(self.channel(picture, i), dark * cosine * (1 - alpha + alpha * glass), delta=5 * error)

    def test_a_wall_counts_as_a_bounce(self):
        self.assert_everywhere(self.seen(self.scene([PANE], [0.5]), "--bounces", 0), [0, 0, 0])
        bare = self.seen(self.scene([], [0.5]), "--bounces", 0)
        self.assert_everywhere(bare, [math.cos(0.5)] * 3)

    def test_light_straight_through_is_not_clamped(self):
        scene = self.scene([PANE], [0.5], [((0.3, 0, 3.2), 0.8, 3)])
        free, clamped = (self.seen(scene, "--bounces", 1, *options, spp=16) for options in ([], ["--clamp-indirect", 1e-3]))
        self.assertEqual(free, clamped)

    def test_before_global_illumination(self):
        lit, through = (self.seen(self.scene(panes, [0.5]), "--stage", "refraction")[8][8] for panes in ([], [PANE]))
        for with_pane, without, tint in zip(through, lit, TINT):  # 0.03 of both is ambient light
            self.assertAlmostEqual((with_pane - 0.03) / (without - 0.03), passed(math.cos(0.5)) * tint, delta=1e-5)

    def lamp_light(self, x, y, lamp, parts=24):
        (cx, cy, cz), half, radiance = lamp
        total = 0.0
        for i in range(parts):
            for j in range(parts):
                px, py = (c + half * (2 * (k + 0.5) / parts - 1) for c, k in ((cx, i), (cy, j)))
                squared = (px - x)**2 + (py - y)**2 + cz**2
                cosine = cz / math.sqrt(squared)
                total += cosine**2 / squared * passed(cosine)
        return radiance * total * (2 * half / parts)**2

    def test_a_lamp_by_light_samples_and_by_paths(self):
        """Both ways are weighed against one another: a density that one of them gets wrong would show."""
        lamp = ((0.4, -0.2, 3.0), 1.2, 2.0)
        wanted = over_ground(lambda x, y: self.lamp_light(x, y, lamp) / math.pi) * TINT[0]
        scene = self.scene([PANE], lamps=[lamp])
        for options, spp, part in (([], 64, 2e-3), (["--disable", "light-sampling"], 1024, 6e-3)):
            seeds = [self.channel(self.seen(scene, "--bounces", 1, "--seed", seed, *options, spp=spp, side=32)) for seed in range(4)]
            error = statistics.stdev(seeds) / 2
            print(f"{options}: {statistics.fmean(seeds) / wanted - 1:+.4%}, standard error {error / wanted:.4%}")
            self.assertLess(5 * error / wanted, part)
            self.assertAlmostEqual(statistics.fmean(seeds) / wanted, 1, delta=part)

    def test_a_sky(self):
        """The mean over the cosine-weighted hemisphere."""
        steps = 4096
        angles = [math.pi / 2 * (i + 0.5) / steps for i in range(steps)]
        wanted = TINT[0] * sum(2 * math.sin(a) * math.cos(a) * passed(math.cos(a)) for a in angles) * math.pi / 2 / steps
        path = self.folder / "white.pfm"
        path.write_bytes(b"PF\n4 2\n-1.0\n" + b"\0\0\x80\x3f" * 24)
        for options in ([], ["--disable", "light-sampling"]):
            seen = self.channel(self.seen(self.scene([PANE]), "--bounces", 1, "--hdri-file", path, *options, spp=256, side=32))
            print(f"{options}: {seen / wanted - 1:+.4%}")
            self.assertAlmostEqual(seen / wanted, 1, delta=2e-3)

    def test_glass_that_lies_on_the_ground(self):
        """A pane, and a slab that bends light: both let through what two parallel interfaces do, and the rest comes back. What the ground sends up is b:
        b = albedo (through + (1 - through) b) of the mean over the hemisphere."""
        albedo, steps, place = 0.5, 4096, (3.3, -1.7, 5.1)
        angles = [math.pi / 2 * (i + 0.5) / steps for i in range(steps)]
        through = sum(2 * math.sin(a) * math.cos(a) * passed(math.cos(a)) for a in angles) * math.pi / 2 / steps
        ground = albedo * through / (1 - albedo * (1 - through))
        wanted = over_ground(lambda x, y: 1 - (1 - ground) * passed(2.2 / math.sqrt(x * x + y * y + 2.2**2)))
        sky = self.folder / "white.pfm"
        sky.write_bytes(b"PF\n4 2\n-1.0\n" + b"\0\0\x80\x3f" * 24)
        for thickness, heights, wide in ((0, [0], WIDE), (1, [0.5, 0], WIDE), (1, [0.5, 0], 300)):
            gltf = quad({"pbrMetallicRoughness": MATT | {"baseColorFactor": [albedo] * 3 + [1]}, "extensions": SPECULAR})
            gltf["materials"].append({"pbrMetallicRoughness": MATT | {"roughnessFactor": 0},
                                      "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1},
                                                     "KHR_materials_volume": {"thicknessFactor": thickness}}})
            gltf["nodes"][0]["scale"] = [WIDE, WIDE, 1]
            gltf["meshes"].append({"primitives": [dict(gltf["meshes"][0]["primitives"][0], material=1)]})
            gltf["nodes"] += [{"mesh": 1, "scale": [wide, wide, 1], "translation": [0, 0, z]} | ({"rotation": [1, 0, 0, 0]} if thickness and not z else {})
                              for z in heights]
            for turned in ({}, {"rotation": [0.18, 0.36, -0.27, 0.875], "translation": place}):
                gltf["nodes"].append({"children": list(range(len(heights) + 2))} | turned)
                gltf["scenes"] = [{"nodes": [len(gltf["nodes"]) - 1]}]
                path = self.written("lying.gltf", gltf)
                seen = self.channel(self.picture(str(path.with_suffix("")), "x.pfm", "--resolution", "32,32", "--spp", 256, "--hdri-file", sky))
                gltf["nodes"].pop()
                print(f"thickness {thickness}, {wide} wide, {turned}: {seen / wanted - 1:+.4%}")
                self.assertAlmostEqual(seen / wanted, 1, delta=3e-3)


if __name__ == "__main__":
    main()

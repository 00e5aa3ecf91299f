#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""--add-light: a lamp of one's own, by the light that it must bring."""
import json
import math

from support import Case, main, quad, read_pfm, run

FLOOR = ["--resolution", "1,1", "--camera-type", "orthographic", "--camera-parallel-scale", "1e-3", "--camera-position", "0,1,0", "--camera-focal-point", "0,0,0",
         "--camera-view-up", "0,0,-1", "--bounces", "0", "--default-light", "none", "--quiet"]
ALBEDO = 0.5


class AddLight(Case):
    def floor(self):
        """A matt floor in the plane y = 0 around the origin."""
        root = quad({"pbrMetallicRoughness": {"baseColorFactor": [ALBEDO] * 3 + [1], "metallicFactor": 0, "roughnessFactor": 1}, "doubleSided": True,
                     "extensions": {"KHR_materials_specular": {"specularFactor": 0}}})
        root["nodes"][0]["rotation"] = [-math.sqrt(0.5), 0, 0, math.sqrt(0.5)]
        root["extensionsUsed"] = ["KHR_materials_specular"]
        return self.written("floor.gltf", root)

    def radiance(self, *lights, spp=64):
        words = [word for light in lights for word in ("--add-light", light)]
        return self.pixel(self.floor(), "--spp", spp, *words)

    def pixel(self, scene, *options):
        self.renders(scene, "-o", self.folder / "x.pfm", *FLOOR, *options)
        return read_pfm(self.folder / "x.pfm")[0][0]

    def test_a_sun_brings_its_irradiance_times_the_cosine(self):
        for elevation, color in ((90, (1, 1, 1)), (30, (1, 0.5, 0.25))):
            found = self.radiance(f"sun from=20,{elevation} strength=4 color={','.join(map(str, color))}")
            for c in range(3):
                self.assertAlmostEqual(found[c], ALBEDO / math.pi * 4 * math.sin(math.radians(elevation)) * color[c], delta=1e-3)

    def test_an_area_brings_what_its_power_gives(self):
        """A small one of power P at the distance d above: P / (pi d^2) on the floor."""
        found = self.radiance("area at=0,3,0 size=0.1 power=50", spp=256)
        self.assertAlmostEqual(found[0] / (ALBEDO / math.pi * 50 / (math.pi * 9)), 1, delta=0.02)
        aside = self.radiance("area at=3,3,0 to=0,0,0 size=0.1,0.1 power=50 color=2,1,0", spp=256)
        self.assertAlmostEqual(aside[1] / (ALBEDO / math.pi * 50 / (math.pi * 18) * math.sqrt(0.5)), 1, delta=0.02)
        self.assertAlmostEqual(aside[0] / aside[1], 2, delta=1e-3)
        self.assertEqual(self.radiance("area at=0,3,0 to=0,9,0 size=0.1 power=50")[0], 0)  # it shines on one side

    def test_several_add_up(self):
        one, two = "sun from=0,90 strength=1", "sun from=0,90 strength=2"
        self.assertAlmostEqual(self.radiance(one, two)[0], self.radiance("sun from=0,90 strength=3")[0], delta=1e-3)

    def test_a_turned_scene_has_it_where_the_picture_has(self):
        scene, sun = self.floor(), ["--add-light", "area at=0,3,0 size=0.1 power=50"]
        root = json.loads(scene.read_text())
        root["nodes"][0]["rotation"] = [0, 0, 0, 1]  # level where z is up
        turned = self.pixel(self.written("turned.gltf", root), "--spp", 64, "--up", "z", *sun)
        self.assertAlmostEqual(turned[0] / self.radiance(sun[1])[0], 1, delta=0.02)

    def test_what_is_wrong_is_named(self):
        for text, says in (("lamp", "'lamp' is none of area, sun"), ("area", "its place is missing"), ("sun stregth=1", "did you mean strength?"), ("sun from=1", "from takes 2 numbers, not 1"),
                           ("sun strength=0", "strength: is not above 0"), ("area at=0,1,x", "at: 'x' is no number"), ("area at=0,1,0 to=0,1,0", "is the place of the light itself"),
                           ("sun from=1,91", "the elevation is not between"), ("sun color=0,0,0", "is black"), ("sun strength=", "its value is missing")):
            self.fails(2, "render", self.floor(), "-o", self.folder / "x.png", "--add-light", text, says=["--add-light: ", says])

    def test_info_knows_it(self):
        text = run("info", self.floor(), "--add-light", "sun").stdout
        self.assertIn('  lamps       1: 0 "added sun 1" (directional, 3 lx)\n', text)
        self.assertIn("  light       its own: 1 lamp\n", text)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""--caustics: metal and glass that are not quite smooth. Light paths bring what camera paths alone do, as caustics_test.py says of them."""
import json
import math

import caustics_test
from caustics_test import INTENSITY, LAMP, MIRROR, TURN
from support import main

POINT = [({"type": "point", "intensity": INTENSITY}, {"translation": caustics_test.POINT})]


class GlossyCaustics(caustics_test.Case):
    scene = caustics_test.Caustics.scene
    luminances, seen = caustics_test.Caustics.luminances, caustics_test.Caustics.seen
    assert_alike = caustics_test.Caustics.assert_alike
    lamp = staticmethod(caustics_test.Caustics.lamp)

    @staticmethod
    def metal(roughness):
        return {"pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.8, 0.7, 1], "metallicFactor": 1, "roughnessFactor": roughness}}

    def wall(self, roughness):
        return self.metal(roughness), {"translation": [-MIRROR, 0, 0.45], "rotation": TURN, "scale": [1.2, 1.2, 1]}

    def told(self, scene, *options):
        path = self.folder / "stats.json"
        self.picture(scene, "x.pfm", "--resolution", "16,16", *caustics_test.ON, "--spp", 8, "--bounces", 1, "--stats", path, *options)
        return json.loads(path.read_text())["caustics"]

    def test_a_brushed_wall_and_metal_that_the_camera_sees(self):
        """The metal throws the light of the wall at the camera, with a lobe that is narrow, or wide."""
        tilt = [0, -math.sin(math.pi / 8), 0, math.cos(math.pi / 8)]
        for roughness in (0.1, 0.3):
            seen = self.metal(roughness), {"translation": [0.3, 0, 0.35], "rotation": tilt, "scale": [0.4, 0.4, 1]}
            scene = self.scene("brushed", self.wall(0.3), seen, lights=POINT)
            self.assert_alike(scene, f"brushed {roughness}", 1024, 512, bounces=3)

    def test_a_frosted_pane(self):
        """It stands beside the picture, before the light."""
        glass = {"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.3}, "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}}}
        pane = glass, {"translation": [-1.2, 0, 0.5], "rotation": TURN, "scale": [0.5, 0.8, 1]}
        scene = self.scene("pane", pane, lights=[(POINT[0][0], {"translation": [-2.2, 0.1, 1.1]})])
        self.assert_alike(scene, "pane", 1024, 384, bounces=3, known=0.006)

    def test_rougher_metal_and_wide_lamps_have_none(self):
        for what, scene, some in (("some", self.scene("some", self.wall(0.3), lights=POINT), True),
                                  ("rough", self.scene("rough", self.wall(0.31), lights=POINT), False),
                                  ("wide", self.scene("wide", self.wall(0.3), self.lamp(LAMP)), False)):
            self.assertEqual(self.told(scene)["light_paths"] > 0, some, what)

    def test_the_variance_of_each_kind_of_path_is_told(self):
        """The lamp that faces away from the ground lights it by the mirror alone, which light paths draw."""
        lamp, mirror = caustics_test.Caustics.lamp(caustics_test.UP, [0, 0, 0, 1]), caustics_test.Caustics.above(0.9, 1.0)
        scene = self.scene("up", mirror, lamp)
        self.assertEqual(self.told(scene)["variance_share"], 1)
        self.assertEqual(self.told(scene, "--caustics", "off")["variance_share"], 0)
        both = self.told("caustics")
        self.assertTrue(0.01 < both["variance_share"] < 0.99, both)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Caustics that the camera sees through glass and in mirrors: camera paths find them by guiding (shaders/caustics/guiding.glsl)."""
import json

import caustics_test
from support import SCENES, Case, main

LAMP = ((-0.7, -0.1, 1.1), 0.02, 2000.0)  # as that of caustics_test, and small
PARALLEL = ("--camera-parallel-scale", 1.0)
# A thin pane seen at a right angle, with the reflections in it. It mirrors hardly any light back to the ground.
INDEX = 1.1
THROUGH_PANE = 2 * INDEX / (INDEX * INDEX + 1)
PANE = ({"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0}, "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": INDEX}}},
        {"translation": [0, 0, 2], "scale": [3, 3, 1]})


class Guiding(Case):
    scene, luminances = caustics_test.Caustics.scene, caustics_test.Caustics.luminances
    lamp, mirror = staticmethod(caustics_test.Caustics.lamp), staticmethod(caustics_test.Caustics.mirror)

    def test_a_mirrors_light_seen_through_a_pane(self):
        open_air, behind = (self.luminances(self.scene("guided", self.mirror(), self.lamp(LAMP), *things), *PARALLEL, "--seed", len(things), spp=512)
                            for things in ((), (PANE,)))
        # Without guiding the error is many times as large.
        self.assert_same_light(behind, [THROUGH_PANE * value for value in open_air], "behind the pane", 0.005)

    def test_the_first_sample_waits_for_no_guiding(self):
        def guiding_ms(spp):
            path = self.folder / "s.json"
            self.renders(SCENES / "caustic-ball.gltf", "-o", self.folder / "x.pfm", "--resolution", "32,32", *caustics_test.ON, "--spp", spp, "--stats", path, "--quiet")
            return json.loads(path.read_text())["caustics"]["guiding_ms"]
        self.assertEqual(guiding_ms(1), 0)
        self.assertGreater(guiding_ms(2), 0)


if __name__ == "__main__":
    main()

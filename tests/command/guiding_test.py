#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Caustics that the camera sees through glass and in mirrors: camera paths find them by guiding (shaders/caustics/guiding.glsl)."""
import json
import statistics

import caustics_test
from caustics_test import SEEDS
from support import SCENES, Case, main

LAMP = ((-0.7, -0.1, 1.1), 0.02, 2000.0)  # as that of caustics_test, and small
PARALLEL = ("--camera-parallel-scale", 1.0)
# A thin pane seen at a right angle, with the reflections in it. It mirrors hardly any light back to the ground.
INDEX = 1.1
THROUGH_PANE = 2 * INDEX / (INDEX * INDEX + 1)
PANE = ({"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0}, "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": INDEX}}},
        {"translation": [0, 0, 2], "scale": [3, 3, 1]})


class Guiding(Case):
    scene, seen = caustics_test.Caustics.scene, caustics_test.Caustics.seen
    lamp, mirror = staticmethod(caustics_test.Caustics.lamp), staticmethod(caustics_test.Caustics.mirror)

    def means(self, *things, spp):
        return self.seen(self.scene("guided", *things), *PARALLEL, spp=spp)

    def test_a_mirrors_light_seen_through_a_pane(self):
        open_air = self.means(self.mirror(), self.lamp(LAMP), spp=256)
        behind = self.means(self.mirror(), self.lamp(LAMP), PANE, spp=256)
        wanted = THROUGH_PANE * statistics.fmean(open_air)
        ratio = statistics.fmean(behind) / wanted
        spread = [statistics.stdev(values) / statistics.fmean(values) for values in (open_air, behind)]
        error = sum(s * s / len(SEEDS) for s in spread)**0.5
        print(f"behind the pane: {ratio - 1:+.4%}, standard error {error:.4%}, a seed {spread[1]:.3%}")
        self.assertLess(abs(ratio - 1), 6 * error)
        # Without guiding a seed is 8 times as far off.
        self.assertLess(spread[1], 0.01)

    def test_parts_and_regions_and_schedules_are_what_the_whole_is(self):
        scene, size = str(SCENES / "caustics"), ("--resolution", "64,48")
        whole = self.picture(scene, "a.pfm", *size, "--spp", 6, "--schedule", "megakernel")
        self.assertEqual(whole, self.picture(scene, "b.pfm", *size, "--spp", 6, "--schedule", "wavefront"))
        region = self.picture(scene, "c.pfm", *size, "--spp", 6, "--region", "10,20,30,17", "--schedule", "megakernel")
        self.assertEqual([row[10:40] for row in whole[20:37]], region)

    def test_the_first_sample_waits_for_no_guiding(self):
        def guiding_ms(spp):
            path = self.folder / "s.json"
            self.renders(SCENES / "caustic-ball.gltf", "-o", self.folder / "x.pfm", "--resolution", "32,32", "--spp", spp, "--stats", path, "--quiet")
            return json.loads(path.read_text())["caustics"]["guiding_ms"]
        self.assertEqual(guiding_ms(1), 0)
        self.assertGreater(guiding_ms(2), 0)


if __name__ == "__main__":
    main()

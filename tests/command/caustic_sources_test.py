#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""--caustics: lamps with alpha, and surfaces between a lamp and what makes its caustic; scenes without light paths. Light paths
bring what camera paths do, as caustics_test.py says."""
import json

import caustics_test
import glossy_caustics_test
from caustics_test import INTENSITY, MIRROR, OVER, TURN, UP
from support import main

ALPHA = 0.25


class CausticSources(caustics_test.Case):
    scene = caustics_test.Caustics.scene
    luminances, seen = caustics_test.Caustics.luminances, caustics_test.Caustics.seen
    assert_alike = caustics_test.Caustics.assert_alike

    def lamp(self, like, rotation, **more):
        """A lamp with these members of its material."""
        material, place = caustics_test.Caustics.lamp(like, rotation)
        color = material["pbrMetallicRoughness"] | {"baseColorFactor": [0, 0, 0, ALPHA]}
        return (material | {"pbrMetallicRoughness": color} | more, place)

    def test_a_lamp_shines_as_much_as_its_alpha_says(self):
        """Most of its rays pass through it if alpha is small, so it is as dim for light samples and light paths."""
        mirror = caustics_test.Caustics.above(0.9, 1.0)
        for what, like, turn, things in (("caustic", UP, [0, 0, 0, 1], [mirror]), ("light sample", caustics_test.LAMP, OVER, [])):
            seen = {}
            for seed, (mode, more) in enumerate((("OPAQUE", {}), ("BLEND", {}), ("MASK", {"alphaCutoff": 0.5}))):
                scene = self.scene("alpha", *things, self.lamp(like, turn, alphaMode=mode, **more))
                seen[mode] = self.luminances(scene, "--seed", seed, spp=384)
            self.assert_same_light(seen["BLEND"], [ALPHA * value for value in seen["OPAQUE"]], what, 0.025)
            self.assertEqual(max(seen["MASK"]), 0, what)

    def test_light_passes_the_backs_of_unlit_cards(self):
        """The card is seen from below, by the lamp. Camera paths come from above, where it is not there."""
        mirror = caustics_test.Caustics.above(0.9, 1.0)
        card = ({"extensions": {"KHR_materials_unlit": {}}, "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}},
                {"translation": [1.5, 0, 0.6], "rotation": OVER, "scale": [0.5, 0.5, 1]})
        bare = self.assert_alike(self.scene("bare", mirror, self.lamp(UP, [0, 0, 0, 1])), "bare", 768, 1536, known=0.01)
        held = self.assert_alike(self.scene("card", mirror, self.lamp(UP, [0, 0, 0, 1]), card), "card", 768, 1536, known=0.011)
        self.assertGreater(held, 0.5 * bare)

    def test_a_range_ends_behind_a_thin_pane(self):
        """It counts from the light to the metal, as without the pane, which reflects nothing here."""
        light = {"type": "point", "intensity": INTENSITY, "range": 0.55}
        pane = ({"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0}, "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1}}},
                {"translation": [-0.75, 0, 0.9], "rotation": TURN, "scale": [0.9, 0.9, 1]})
        wall = glossy_caustics_test.GlossyCaustics.metal(0.3), {"translation": [-MIRROR, 0, 0.9], "rotation": TURN, "scale": [0.9, 0.9, 1]}
        scene = self.scene("range", wall, pane, lights=[(light, {"translation": [-0.7, 0.1, 0.9]})])
        self.assert_alike(scene, "range", 2304, 768, bounces=4, known=0.02)

    def test_where_they_hardly_land_camera_paths_alone_draw_all_parts(self):
        """A wide mirror throws the light of a wide lamp over a ground of which the camera sees a hundredth."""
        mirror = ({"pbrMetallicRoughness": {"metallicFactor": 1, "roughnessFactor": 0}}, {"translation": [-3, 0, 0], "rotation": TURN, "scale": [9, 9, 1]})
        lamp = caustics_test.Caustics.lamp(((4, 0, 5), 2.5, 20.0))
        scene = self.scene("wide", mirror, lamp, ground=30)

        def drawn(*options, spp=6):
            stats = self.folder / "stats.json"
            return self.picture(scene, "x.pfm", *caustics_test.SMALL, "--spp", spp, "--stats", stats, *options), json.loads(stats.read_text())["caustics"]
        # A goal of noise that few samples reach leaves the picture's limit: four million paths.
        goal = ("--noise", 0.9)
        whole, told = drawn(*goal, spp=4096)
        self.assertEqual((told["light_paths"], told["pixels_per_path"], told["reason"]), (0, 0, "camera paths alone are less noisy"))
        self.assertEqual(drawn(*goal, "--caustics", "off", spp=4096)[0], whole)
        self.assertGreater(drawn("--caustics", "on")[1]["light_paths"], 0)
        # Of few paths nothing is measured: no program of light paths is compiled.
        whole, told = drawn()
        self.assertEqual((told["light_paths"], told["casters"], told["reason"]), (0, 0, "few paths find the light of such wide lamps, too"))
        self.assertEqual(drawn("--caustics", "off")[0], whole)
        self.assertEqual([row[4:20] for row in whole[3:20]], drawn("--region", "4,3,16,17")[0])
        for options in (("--seed", 9), ("--sample-offset", 5)):
            self.assertEqual(drawn(*options, spp=1)[1]["light_paths"], 0, options)
        # A small lamp, and a punctual light, are not left to chance.
        for name, things, lights in (("small", (caustics_test.Caustics.lamp(((4, 0, 5), 0.1, 2000.0)),), ()),
                                     ("point", (lamp,), (({"type": "point", "intensity": 5}, {"translation": [2, 0, 4]}),))):
            scene = self.scene(name, mirror, *things, lights=lights, ground=30)
            self.assertGreater(drawn()[1]["light_paths"], 0, name)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Tests of --bounces: the light that it limits, the light that it does not limit, and the light that it reports as
cut."""
import json
import os
import statistics
import unittest
from pathlib import Path

from support import BACKENDS, SCENES, Case, Exr, main, read_pfm

ASSETS = Path(os.environ.get("FRAGTRACE_ASSETS", "/work/shared/assets"))


def nested_glass(count, index):
    """White spheres of clear glass in one another, seen by an orthographic camera whose every ray meets all."""
    glass = {"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0},
             "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": index},
                            "KHR_materials_volume": {"thicknessFactor": 1}}}
    names = ["KHR_implicit_shapes", *glass["extensions"]]
    nodes = [{"extras": {"shape": i, "material": 0}} for i in range(count)]
    return {"asset": {"version": "2.0"}, "extensionsUsed": names, "materials": [glass],
            "extensions": {"KHR_implicit_shapes": {"shapes": [{"type": "sphere", "sphere": {"radius": 1 - 0.02 * i}} for i in range(count)]}},
            "nodes": [*nodes, {"camera": 0, "translation": [0, 0, 5]}], "scenes": [{"nodes": list(range(count + 1))}], "scene": 0,
            "cameras": [{"type": "orthographic", "orthographic": {"xmag": 0.4, "ymag": 0.4, "zfar": 10, "znear": 0.1}}]}


class Bounces(Case):
    def write(self, scene):
        return self.written("scene.gltf", scene)

    def draw(self, scene, *options):
        """Mean of the red channel, statistics and what was said."""
        picture, stats = self.folder / "x.pfm", self.folder / "s.json"
        result = self.renders(scene, "-o", picture, "--resolution", "16,16", "--stats", stats, *options)
        return statistics.fmean(p[0] for row in read_pfm(picture) for p in row), json.loads(stats.read_text()), result.stderr

    def assert_white(self, count, index, *options):
        mean, stats, said = self.draw(self.write(nested_glass(count, index)), "--default-light", "white", *options)
        self.assertAlmostEqual(mean, 1, delta=0.005, msg=(count, options))
        self.assertEqual(stats["cut_share"], 0)
        self.assertNotIn("cut_share", said)

    def test_nested_glass_spheres_vanish_in_white_surroundings(self):
        for backend in BACKENDS:
            for count in (2, 20):
                self.assert_white(count, 1.1, "--rendering-backend", backend, "--spp", 64)
        # Before gi, where roulette decides at glass alone; and where the user wants none.
        self.assert_white(20, 1.1, "--spp", 64, "--stage", "refraction")
        self.assert_white(20, 1.1, "--spp", 16, "--rr-depth", 100000, "--bounces", 0)

    def test_what_is_cut_is_counted_and_said(self):
        """A closed room of albedo 1/2: after N + 1 scatterings 2^-(N + 1) is left; and as much is missing from its radiance, 1."""
        room = json.loads((SCENES / "closed-furnace.gltf").read_text())
        # Alpha that hides nothing makes the tracer a state machine.
        blended = json.loads(json.dumps(room))
        for material in blended["materials"]:
            material["alphaMode"] = "BLEND"
        for backend in BACKENDS:
            for scene in (room, blended):
                path = self.write(scene)
                options = ["--rendering-backend", backend, "--spp", 16, "--rr-depth", 1000]
                mean, stats, said = self.draw(path, *options, "--bounces", 3)
                self.assertAlmostEqual(stats["cut_share"], 0.5 ** 4, delta=1e-4)
                self.assertAlmostEqual(mean, 1 - 0.5 ** 5, delta=0.02)
                self.assertIn("--bounces 3 cut", said)
        _, stats, said = self.draw(path, *options, "--bounces", 16)
        self.assertAlmostEqual(stats["cut_share"], 0.5 ** 17, delta=2e-6)
        self.assertNotIn("cut_share", said)

    def test_mirrors_and_rough_glass_count(self):
        rough = nested_glass(4, 1.3)
        rough["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = 0.3
        _, stats, said = self.draw(self.write(rough), "--spp", 16, "--bounces", 2)
        self.assertGreater(stats["cut_share"], 0.5)
        self.assertIn("cut_share", said)


@unittest.skipUnless((ASSETS / "scenes").is_dir(), f"{ASSETS} is absent")
class GlassAssets(Case):
    """Takes minutes."""

    def test_the_rim_of_a_thick_vase(self):
        pictures = []
        for options in (["--seed", 1], ["--bounces", "unlimited", "--seed", 2]):
            path = self.folder / "x.exr"
            self.renders(ASSETS / "scenes/GlassVaseFlowers/GlassVaseFlowers.glb", "-o", path, "--quiet", "--resolution", "48,32", "--spp", 1024,
                         "--hdri-file", ASSETS / "env/lightroom_14b.hdr", "--camera-position", "0.11,0.2,0.2", "--camera-focal-point",
                         "0.11,0.17,0", "--camera-view-angle", 30, "--aov", "variance", *options)
            pictures.append(Exr(path))
        one, other = (p.luminances() for p in pictures)
        rmse = statistics.fmean((a - b) ** 2 for a, b in zip(one, other)) ** 0.5
        noise = statistics.fmean(v for p in pictures for v in p.values("variance.Y")) ** 0.5 * 2 ** 0.5
        print(f"close-up of the rim: rmse {rmse:.4f} against unlimited bounces, of which noise {noise:.4f}")
        self.assertLess(rmse, 1.5 * noise + 0.005)

    def test_twenty_spheres_of_thick_glass(self):
        path = self.folder / "scene.gltf"
        for count in (2, 5, 10, 20):
            path.write_text(json.dumps(nested_glass(count, 1.5)))
            picture = self.picture(str(path.with_suffix("")), "x.pfm", "--resolution", "16,16", "--spp", 8192, "--default-light", "white")
            self.assertAlmostEqual(statistics.fmean(p[0] for row in picture for p in row), 1, delta=0.005, msg=count)


if __name__ == "__main__":
    main()

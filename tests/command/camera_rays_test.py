#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Samples of several camera rays (--camera-rays): all bring what they see and one light sample, the last alone goes on."""
import json
import statistics

from support import SCENES, Case, luminances, main, run

SIZE = ("--resolution", "32,24")
SEEDS = range(1, 7)


class CameraRays(Case):
    def stats(self, scene, *options):
        path = self.folder / "stats.json"
        told = self.renders(SCENES / f"{scene}.gltf", "-o", self.folder / "x.pfm", *SIZE, "--spp", 1, "--stats", path, *options)
        return json.loads(path.read_text()), told.stderr

    def test_the_same_light(self):
        """Every kind of surface may be the first one."""
        for scene in ("cornell-box", "many-lights", "lobes", "rough-glass", "glass-sphere", "thin-glass", "coverage", "sun-sky"):
            spp, rays = 1024 if scene == "many-lights" else 512, 3 if scene == "lobes" else 4
            one, several = (luminances(self.picture(scene, "x.pfm", *SIZE, "--seed", count, "--spp", samples, "--camera-rays", count, "--caustics", "on"))
                            for count, samples in ((1, spp), (rays, spp // 4)))
            self.assert_same_light(several, one, f"{scene}, {rays} rays", 0.003)

    def test_alpha_is_the_share_of_the_rays_that_meet_a_surface(self):
        one = self.picture("coverage", "a.exr", *SIZE, "--spp", 1024, "--no-background")
        several = self.picture("coverage", "b.exr", *SIZE, "--spp", 256, "--no-background", "--camera-rays", 4)
        self.assertTrue(any(0.1 < a < 0.9 for a in one.values("A")))
        for a, b in zip(one.values("A"), several.values("A")):
            self.assertAlmostEqual(a, b, delta=0.02)
        self.assertEqual(max(several.values("A")), 1)

    def test_every_schedule_draws_the_same(self):
        for scene in ("many-lights", "thin-glass", "caustic-ground"):
            a, b = (self.picture(scene, "x.pfm", "--resolution", "64,48", "--spp", 3, "--camera-rays", 4, "--schedule", schedule)
                    for schedule in ("megakernel", "wavefront"))
            self.assertEqual(a, b, scene)

    def test_samples_that_take_many_draws_are_the_same(self):
        folder = self.shaders_of_short_draws()
        size = ("--resolution", "24,18", "--spp", 2, "--camera-rays", 4, "--schedule", "megakernel", "--traversal", "front-to-back",
                "--no-background")
        first = self.picture("many-lights", "a.exr", *size)
        again = self.picture("many-lights", "b.exr", *size, "--shader-folder", folder)
        self.assertEqual([first.values(c) for c in "RGBA"], [again.values(c) for c in "RGBA"])

    def test_parts_merge_to_the_whole(self):
        size = (*SIZE, "--camera-rays", 4)
        whole = self.picture("many-lights", "whole.exr", *size, "--spp", 8)
        self.picture("many-lights", "a.exr", *size, "--spp", 4)
        self.picture("many-lights", "b.exr", *size, "--spp", 4, "--sample-offset", 4)
        merged = self.folder / "merged.exr"
        self.assertEqual(run("merge", self.folder / "a.exr", self.folder / "b.exr", "-o", merged).returncode, 0)
        self.assertEqual(run("diff", self.folder / "whole.exr", merged, "--metric", "max", "--threshold", "1e-5").returncode, 0)
        self.assertGreater(sum(whole.values("R")), 0)

    def test_the_scene_chooses_the_number(self):
        self.assertEqual(self.stats("many-lights")[0]["camera_rays"], 4)
        self.assertEqual(self.stats("many-lights", "--light-selection", "power")[0]["camera_rays"], 1)
        self.assertEqual(self.stats("many-lights", "--camera-rays", 1)[0]["camera_rays"], 1)
        self.assertEqual(self.stats("lights")[0]["camera_rays"], 1)  # light samples vary only 1.7 times less
        self.assertEqual(self.stats("cornell-box", "--camera-rays", 3)[0]["camera_rays"], 3)
        for options in (("--fog-density", "0.1"), ("--light-reuse", "candidates"), ("--stage", "shadows")):
            stats, said = self.stats("many-lights", "--camera-rays", 4, *options)
            self.assertEqual(stats["camera_rays"], 1)
            self.assertIn("--camera-rays: one per sample", said)
        self.fails(2, "render", SCENES / "cornell-box.gltf", "-o", self.folder / "y.pfm", "--camera-rays", 9, says=["--camera-rays"])

    def test_many_lamps_have_less_noise(self):
        def noise(rays):
            pictures = [luminances(self.picture("many-lights", "x.pfm", *SIZE, "--spp", 8, "--seed", seed, "--camera-rays", rays)) for seed in SEEDS]
            return statistics.fmean(statistics.variance(pixel) for pixel in zip(*pictures))
        self.assertLess(noise(4), 0.8 * noise(1))


if __name__ == "__main__":
    main()

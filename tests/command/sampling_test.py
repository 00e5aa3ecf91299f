#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Options that may change how noisy a picture is, or how sharp, but not how bright; and --clamp-indirect, which may."""
import json
import math

from support import SCENES, TWO_TRIANGLES, Case, Gltf, main, quad, read_pfm

BOX = SCENES / "cornell-box.gltf"
# Largest |z| of a mean that is taken as unbiased: two-sided, 1 in 16,000 by chance. Seeds are fixed, so it happens now or never.
LARGEST_Z = 4
# No pixel of this view sees the lamp, whose edges would add more noise than all the rest.
FLOOR = ["--camera-position", "0,0,0.9", "--camera-focal-point", "0,-0.6,-1", "--camera-view-angle", 50]


class Means(Case):
    def mean(self, scene, *options):
        """The picture's mean luminance, and the variance of that."""
        exr = self.picture(scene, "x.exr", "--aov", "variance", *options)
        count = exr.width * exr.height
        return sum(exr.luminances()) / count, sum(exr.values("variance.Y")) / count**2

    def agree(self, scene, changed, *options):
        # With sobol the true variance is below the one stated.
        common = ["--resolution", "16,16", "--disable", "sobol", *options]
        expected, variance = self.mean(scene, *common)
        mean, more = self.mean(scene, *(changed if "sobol" in changed else ["--disable", "sobol", *changed]),
                               "--resolution", "16,16", *options, "--seed", 1)
        z = (mean - expected) / math.sqrt(variance + more)
        print(f"{scene} {' '.join(map(str, changed))}: {expected:.5f}, {mean:.5f}, z {z:+.2f}")
        self.assertLess(abs(z), LARGEST_Z)
        # The test sees a bias of 3 %.
        self.assertLess(LARGEST_Z * math.sqrt(variance + more), 0.03 * expected)

    def test_samplers(self):
        self.agree("cornell-box", ["--enable", "sobol"], "--spp", 1024, *FLOOR)

    def test_the_right_share_of_a_pixels_samples_passes_alpha(self):
        """Of one sheet within a sample, of two of them independently of each other: no pixel sees the same in both."""
        alpha, spp = 0.37, 16
        sheet = {"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, alpha]}}
        options = ["--resolution", "16,16", "--spp", spp, "--no-background", "--camera-position", "0,0,0.1", "--camera-focal-point", "0,0,-1"]
        for schedule in ("megakernel", "wavefront"):
            for count in (1, 2):
                model = quad(sheet)
                model["nodes"] = [{"mesh": 0, "translation": [4, 0, -i - 1], "scale": [9, 9, 9]} for i in range(count)]  # one triangle of each
                model["scenes"] = [{"nodes": list(range(count))}]
                exr = self.picture(str(self.written("sheet.gltf", model).with_suffix("")), "x.exr", *options, "--schedule", schedule, "--traversal", "front-to-back")
                right = 1 - (1 - alpha)**count
                covered = exr.values("A")
                with self.subTest(schedule=schedule, count=count):
                    self.assertLess(max(abs(a - right) for a in covered), 1 / spp if count == 1 else 4 / spp)
                    self.assertAlmostEqual(sum(covered) / len(covered), right, delta=0.01)

    def test_light_found_by_scattered_rays_only(self):
        self.agree("cornell-box", ["--disable", "light-sampling"], "--spp", 8192, *FLOOR)
        self.agree("environment-diffuse", ["--disable", "light-sampling"], "--spp", 1024, "--hdri-file", SCENES / "sky.pfm")
        self.agree("glass-sphere", ["--disable", "light-sampling"], "--spp", 4096)

    def test_pixel_filters_spread_light_but_lose_none(self):
        """The body is so far from the picture's edge that no filter reaches over it."""
        for name in ("gaussian", "blackman-harris"):
            self.agree("furnace", ["--pixel-filter", name], "--spp", 1024)

    def test_russian_roulette(self):
        self.agree("cornell-box", ["--rr-depth", "1"], "--spp", 1024, *FLOOR)

    def test_adaptive_pictures(self):
        self.agree("cornell-box", ["--noise", "0.05"], "--spp", 4096, *FLOOR)


class ClampedLight(Case):
    COMMON = ["--resolution", "16,16", "--spp", 256]

    def mean(self, *options):
        picture = self.picture("cornell-box", "x.pfm", *self.COMMON, *options)
        return sum(sum(sum(pixel) for pixel in row) for row in picture)

    def test_it_takes_light_away_and_only_indirect_light(self):
        free, some, most = self.mean(), self.mean("--clamp-indirect", "0.3"), self.mean("--clamp-indirect", "0.05")
        direct = self.mean("--bounces", 0)
        self.assertLess(some, 0.99 * free)
        self.assertLess(most, 0.95 * some)
        self.assertGreater(most, direct)
        self.assertEqual(self.mean("--bounces", 0, "--clamp-indirect", "0.001"), direct)
        self.assertAlmostEqual(self.mean("--clamp-indirect", "1e30") / free, 1, delta=1e-6)

    def test_it_is_said_and_in_the_statistics(self):
        stats = self.folder / "s.json"
        options = ["-o", self.folder / "x.pfm", *self.COMMON, "--stats", stats]
        result = self.renders(BOX, *options, "--clamp-indirect", "2.5")
        self.assertIn("--clamp-indirect", result.stderr)
        self.assertIn("biased", result.stderr)
        self.assertEqual(json.loads(stats.read_text())["clamp_indirect"], 2.5)
        for extra in ([], ["--clamp-indirect", "2.5", "--stage", "shadows"]):
            result = self.renders(BOX, *options, *extra)
            self.assertNotIn("biased", result.stderr)
            self.assertNotIn("clamp_indirect", json.loads(stats.read_text()))
        for value in ("0", "-1", "nan", "inf"):
            self.fails(2, "render", BOX, "-o", self.folder / "x.exr", "--clamp-indirect", value, says=["--clamp-indirect"])


def blackman_harris(t):
    """Part of the window of Blackman and Harris (four terms, 92 dB) that lies below t of its width."""
    x = 2 * math.pi * t
    return t - (0.48829 * math.sin(x) - 0.14128 / 2 * math.sin(2 * x) + 0.01168 / 3 * math.sin(3 * x)) / (2 * math.pi * 0.35875)


# Part of a filter's samples that lie left of a place x, in pixels from the middle.
BELOW = {"box": lambda x: min(max(x + 0.5, 0), 1),
         "gaussian": lambda x: 0.5 * (1 + math.erf(x / (0.5 * math.sqrt(2)))),
         "blackman-harris": lambda x: blackman_harris(min(max(x / 3 + 0.5, 0), 1))}


class Filters(Case):
    def half_plane(self, edge):
        """A scene that is white where x > edge. Its camera shows 1 m per pixel in a picture of 16 x 16."""
        gltf = Gltf(cameras=[{"type": "orthographic", "orthographic": {"xmag": 8, "ymag": 8, "znear": 0.1, "zfar": 100}}])
        position = gltf.accessor([(edge, -100, 0), (100, -100, 0), (100, 100, 0), (edge, 100, 0)])
        gltf.node(mesh=gltf.mesh(gltf.accessor(TWO_TRIANGLES, "H"), position=position))
        gltf.node(camera=0, translation=[0, 0, 10])
        return gltf.write(self.folder / "half.gltf")

    def test_an_edge_is_blurred_as_the_density_says(self):
        spp = 4096
        for name, below in BELOW.items():
            for edge in (0, 0.3):
                for up in ("0,1,0", "1,0,0"):  # the edge upright, and lying with the white half above
                    self.renders(self.half_plane(edge), "-o", self.folder / "x.pfm", "--quiet", "--stage", "flat", "--default-light", "white", "--resolution", "16,16",
                                 "--spp", spp, "--pixel-filter", name, "--camera-view-up", up)
                    picture = read_pfm(self.folder / "x.pfm")
                    for column in range(16):
                        pixels = [row[column] for row in picture] if up == "0,1,0" else picture[15 - column]
                        seen = sum(pixel[0] for pixel in pixels) / 16
                        expected = 1 - below(edge - (column + 0.5 - 8))
                        # 16 pixels of sobol points; the Gaussian is cut off at 4 deviations, which hold all but 6e-5 on a side.
                        self.assertAlmostEqual(seen, expected, delta=1e-3, msg=(name, edge, up, column))

    def test_unknown_ones_are_refused(self):
        self.fails(2, "render", BOX, "-o", self.folder / "x.exr", "--pixel-filter", "tent", says=["tent", "blackman-harris"])


if __name__ == "__main__":
    main()

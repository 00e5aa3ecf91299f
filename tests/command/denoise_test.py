#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`render --denoise variance`: how much error it takes away, what it leaves alone, and what becomes of the noisy picture."""
import json
import statistics
import unittest

from support import BACKENDS, SCENES, Case, Exr, main, quad, read_pfm, run

BOX = SCENES / "cornell-box.gltf"
SIZE = ["--resolution", "96,96"]
FILTER = ["--denoise", "variance"]
COLORS = ("R", "G", "B")


class Denoised(Case):
    size = SIZE

    def draw(self, name, *options, scene=BOX):
        path = self.folder / name
        self.renders(scene, "-o", path, "--quiet", *options)
        return path

    def relmse(self, picture, reference):
        result = run("diff", picture, reference, "--metric", "relmse")
        self.assertEqual(result.returncode, 0, result.stderr)
        return float(result.stdout)

    def less_error_and_the_same_light(self, name, parts):
        """The aims are 0.5 of the noisy picture's error at 4 samples and 0.3 at 16 (0.7 and 0.5 of glass), and 0.3 % of the light at 16."""
        scene = SCENES / (name + ".gltf")
        reference = self.draw("r.pfm", *self.size, "--spp", 512, "--seed", 9, scene=scene)
        for spp, part in parts.items():
            with self.subTest(scene=name, spp=spp):
                picture = self.draw("d.exr", *self.size, "--spp", spp, *FILTER, scene=scene)
                noisy = self.draw("n.exr", *self.size, "--spp", spp, scene=scene)
                self.assertLess(self.relmse(picture, reference), part * self.relmse(noisy, reference))
                light, before = (sum(Exr(p).luminances()) for p in (picture, noisy))
                self.assertAlmostEqual(light / before, 1, delta=0.003 if spp == 16 else 0.01)


class DenoisingGain(Denoised):
    """The aims are those of larger pictures, whose pixels are more alike: of 96 x 96, corner-diffuse keeps 0.30 to 0.33 at 16 samples, of these 0.25 to 0.30."""
    size = ["--resolution", "128,128"]

    def test_less_error_and_the_same_light(self):
        self.less_error_and_the_same_light("corner-diffuse", {4: 0.5, 16: 0.3})
        self.less_error_and_the_same_light("rough-glass", {4: 0.7, 16: 0.5})


class Denoising(Denoised):
    def test_less_error_and_the_same_light(self):
        self.less_error_and_the_same_light("cornell-box", {4: 0.5, 16: 0.3})

    def test_one_sample_leaves_no_woven_pattern(self):
        """Odd and even pixels that never meet differ by rows of five in turn: in the middle by 42 and 15 thousandths of their light, now by 28 and 10."""
        for name, most in (("cornell-box", 0.035), ("corner-diffuse", 0.0125)):
            picture = self.draw("d.exr", "--resolution", "96,72", "--spp", 1, *FILTER, scene=SCENES / (name + ".gltf"))
            light = list(Exr(picture).luminances())
            fives = [light[y * 96 + x:y * 96 + x + 5] for y in range(72) for x in range(92)]
            parts = [abs(a - 2 * b + 2 * c - 2 * d + e) / 8 / ((a + b + c + d + e) / 5) for a, b, c, d, e in fives if a + b + c + d + e > 0]
            self.assertLess(statistics.median(parts), most, name)

    @unittest.skipUnless("osmesa" in BACKENDS, "libOSMesa is not installed")
    def test_both_backends_filter_alike(self):
        pictures = [Exr(self.draw("x.exr", *SIZE, "--spp", 4, *FILTER, "--rendering-backend", backend)) for backend in BACKENDS]
        for a, b in zip(*(p.luminances() for p in pictures)):
            self.assertAlmostEqual(a, b, delta=1e-4 * max(a, 0.01))

    def test_the_noisy_picture_and_the_layers_asked_for_stay(self):
        options = [*SIZE, "--spp", 4, "--aov", "albedo,samples"]
        raw, filtered = Exr(self.draw("n.exr", *options)), Exr(self.draw("d.exr", *options, *FILTER))
        self.assertEqual(set(filtered.layers) - set(raw.layers), {"noisy.R", "noisy.G", "noisy.B"})
        for color in COLORS:
            self.assertEqual(raw.values(color), filtered.values("noisy." + color))
            self.assertNotEqual(raw.values(color), filtered.values(color))
        for layer in ("albedo.R", "albedo.G", "albedo.B", "samples.Y"):
            self.assertEqual(raw.values(layer), filtered.values(layer))
        self.assertRegex(filtered.texts["fragtrace:denoise"], r"^variance \d+$")

    def test_merge_joins_what_was_drawn(self):
        def joined(*options):
            parts = [self.draw(f"{first}.exr", *SIZE, "--spp", 2, "--sample-offset", first, *options) for first in (0, 2)]
            self.assertEqual(run("merge", *parts, "-o", self.folder / "m.exr").returncode, 0)
            return (self.folder / "m.exr").read_bytes()
        self.assertEqual(joined(), joined(*FILTER))

    def test_merge_joins_what_was_observed(self):
        parts = [self.draw(f"{first}.exr", *SIZE, "--spp", 4, "--sample-offset", first, "--aov", "denoising") for first in (0, 4)]
        self.assertEqual(run("merge", *parts, "-o", self.folder / "m.exr").returncode, 0)
        first, second, both = (Exr(path).values("denoising.observed.Y") for path in (*parts, self.folder / "m.exr"))
        self.assertGreater(sum(both), 0)
        for a, b, joined in zip(first, second, both):
            self.assertAlmostEqual((a + b) / 4, joined, delta=1e-6 * joined)

    def test_merge_names_the_layer_that_one_part_lacks(self):
        parts = [self.draw(f"{first}.exr", *SIZE, "--spp", spp, "--sample-offset", first, "--aov", "denoising") for first, spp in ((0, 3), (3, 4))]
        self.fails(3, "merge", *parts, "-o", self.folder / "m.exr", says=["only one of them has denoising.observed.Y"])

    def test_guides_are_of_what_stands_behind_smooth_glass_and_mirrors(self):
        """Albedo is that of wall and floor, as seen through the glass sphere and in the mirror sphere. Depth is that of
        the spheres."""
        wall, floor = (0.3, 0.45, 0.65), (0.65, 0.5, 0.35)
        for scene, pixel, albedo in (("glass-sphere", (24, 33), wall), ("glass-sphere", (24, 12), floor), ("mirror-sphere", (24, 36), floor)):
            with self.subTest(scene=scene, pixel=pixel):
                options = ["--resolution", "50,50", "--spp", 4, "--aov", "denoising,albedo,depth"]
                picture = Exr(self.draw("g.exr", *options, scene=SCENES / f"{scene}.gltf"))
                seen = picture.pixel(*pixel, *("denoising.albedo." + c for c in "RGB"))
                for a, b in zip(seen, albedo):
                    self.assertAlmostEqual(a, b, delta=1e-3)
                self.assertNotEqual(seen, picture.pixel(*pixel, *("albedo." + c for c in "RGB")))
                self.assertEqual(picture.pixel(*pixel, "denoising.depth.Z"), picture.pixel(*pixel, "depth.Z"))

    def test_guides_see_what_alpha_shows_without_chance(self):
        """A red sheet of alpha 0.25 above, 1 m before a blue wall that is half as wide."""
        def matt(color, **more):
            return {"pbrMetallicRoughness": {"baseColorFactor": color, "metallicFactor": 0}, **more}
        gltf = quad(matt([1, 0, 0, 0.25], alphaMode="BLEND"))
        gltf["materials"].append(matt([0, 0, 1, 1]))
        gltf["meshes"].append({"primitives": [gltf["meshes"][0]["primitives"][0] | {"material": 1}]})
        gltf["nodes"] = [{"mesh": 0}, {"mesh": 1, "scale": [0.5, 1, 1], "translation": [0, 0, -1]}]
        gltf["scenes"] = [{"nodes": [0, 1]}]
        path = self.written("sheet.gltf", gltf)
        view = ["--camera-position", "0,0,3", "--camera-focal-point", "0,0,0", "--camera-parallel-scale", 1]
        exr = Exr(self.draw("g.exr", *view, "--resolution", "16,16", "--spp", 1, "--aov", "denoising", scene=path))
        names = [*("denoising.albedo." + c for c in "RGBA"), "denoising.normal.Z", "denoising.depth.Z"]
        for x, expected in ((8, (0.25, 0, 0.75, 1, 1, 0.25 * 3 + 0.75 * 4)), (1, (0.25, 0, 0, 0.25, 0.25, 0.25 * 3))):
            for name, seen, there in zip(names, exr.pixel(x, 8, *names), expected):
                self.assertAlmostEqual(seen, there, delta=1e-5, msg=f"{name} at {x}")

    def test_what_has_no_noise_is_left_alone_and_says_so(self):
        for options, reason in ((["--stage", "shadows"], "stages before gi"), (["--debug-view", "normal"], "debug view")):
            raw = self.draw("n.exr", *SIZE, "--spp", 2, *options).read_bytes()
            stats = self.folder / "s.json"
            self.assertEqual(raw, self.draw("n.exr", *SIZE, "--spp", 2, *options, *FILTER, "--stats", stats).read_bytes())
            self.assertIn(reason, json.loads(stats.read_text())["denoise"]["skipped"])

    def test_alpha_stays(self):
        options = [*SIZE, "--spp", 4, "--no-background"]
        scene = SCENES / "sphere-textured.gltf"
        raw, filtered = (Exr(self.draw("x.exr", *options, *more, scene=scene)) for more in ([], FILTER))
        self.assertEqual(raw.values("A"), filtered.values("A"))

    def test_pictures_of_any_size_and_number_of_samples(self):
        for size in ("1,1", "1,70", "3000,1"):
            for spp in (1, 2):
                picture = read_pfm(self.draw("x.pfm", "--resolution", size, "--spp", spp, *FILTER))
                self.finite(size, [value for row in picture for pixel in row for value in pixel])


if __name__ == "__main__":
    main()

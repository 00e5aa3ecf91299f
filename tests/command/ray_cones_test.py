#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Ray cones read textures at the level that a pixel sees: the mean of what is far away, and every texel of what is near."""
import math
import random
import statistics

from support import SQUARE, TWO_TRIANGLES, Case, Gltf, data_uri, luminances, main, mean, png

READS = ("words", "arrays")
WRAPS = {"repeat": 10497, "clamp": 33071, "mirror": 33648}
CONES = ("--texture-filter", "cones")
HALF = ((188 / 255 + 0.055) / 1.055)**2.4  # the number of 8 bits next to the mean of black and white


def grey(values):
    return [n for v in values for n in (v, v, v, 255)]


def checkers(width, height, side=1):
    return png(width, height, grey(255 * ((x // side + y // side) % 2) for y in range(height) for x in range(width)))


class RayCones(Case):
    def square(self, image, name="x.pfm", *options, pixels=4, uv=(0, 1), sampler=None, material=None, reads="words"):
        """Draws a square that fills the picture, whose texture coordinates go from the first to the last."""
        gltf = Gltf(materials=[{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}, **(material or {})}], textures=[{"source": 0, "sampler": 0}],
                    samplers=[sampler or {}], images=[{"uri": data_uri("image/png", image)}],
                    cameras=[{"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "zfar": 10, "znear": 0.1}}])
        first, last = uv
        uvs = gltf.accessor([(first, last), (last, last), (last, first), (first, first)])
        gltf.node(mesh=gltf.mesh(gltf.accessor(TWO_TRIANGLES, "H"), position=gltf.accessor(SQUARE), texcoord_0=uvs, material=0))
        gltf.node(camera=0, translation=[0, 0, 5])
        path = gltf.write(self.folder / "square.gltf")
        return self.picture(str(path.with_suffix("")), name, "--resolution", f"{pixels},{pixels}", "--spp", 1, "--stage", "flat", "--texture-reads", reads, *options)

    def test_a_checkerboard_far_away_is_grey(self):
        """One sample of a pixel that sees 1,024 texels is their mean; without cones it is one of them."""
        for reads in READS:
            for size in ((128, 128), (130, 126)):
                near = luminances(self.square(checkers(*size), reads=reads, sampler={"magFilter": 9728}))
                far = luminances(self.square(checkers(*size), "x.pfm", *CONES, reads=reads))
                self.assertGreater(statistics.pstdev(near), 0.3)
                for pixel in far:
                    self.assertLess(abs(pixel - HALF), 0.012 if size[0] == 128 else 0.05, (reads, size))

    def test_texels_as_large_as_pixels_stay(self):
        """At 1:1 and nearer a picture keeps its bits; at 2:1 each pixel is the mean of four texels."""
        numbers = random.Random(5)
        values = [numbers.randrange(256) for _ in range(32 * 32)]
        image = png(32, 32, grey(values))
        for reads in READS:
            for pixels in (32, 64):
                near = self.square(image, reads=reads, pixels=pixels)
                self.assertEqual(self.square(image, "x.pfm", *CONES, reads=reads, pixels=pixels), near)
            halved = self.square(image, "x.pfm", *CONES, reads=reads, pixels=16, sampler={"magFilter": 9728})
            light = [v / 255 / 12.92 if v <= 10 else ((v / 255 + 0.055) / 1.055)**2.4 for v in values]
            for y in range(16):
                for x in range(16):
                    four = statistics.fmean(light[32 * (2 * y + v) + 2 * x + u] for u in (0, 1) for v in (0, 1))
                    self.assertLess(abs(halved[y][x][0] - four), 0.005, (reads, x, y))

    def test_wraps_and_odd_sizes(self):
        """The mean over the square is that of many samples without cones."""
        numbers = random.Random(6)
        for width, height, bits in ((37, 23, 8), (64, 64, 16)):
            one = 2**bits - 1
            values = [min(one, int(one * (0.1 + 0.4 * x / width + 0.2 * numbers.random()))) for _ in range(height) for x in range(width)]
            image = png(width, height, [n for v in values for n in (v, v, v, one)], bits)
            for wrap, mode in WRAPS.items():
                options = {"sampler": {"wrapS": mode, "wrapT": mode}, "uv": (-0.9, 1.3), "pixels": 8}
                exact = self.square(image, "x.pfm", "--spp", 256, **options)
                for reads in READS:
                    cones = self.square(image, "x.pfm", "--spp", 64, *CONES, reads=reads, **options)
                    self.assertLess(abs(mean(cones) / mean(exact) - 1), 0.05 if wrap == "clamp" else 0.02, (width, height, bits, wrap, reads))
                    apart = statistics.fmean(abs(a - b) for a, b in zip(luminances(cones), luminances(exact)))
                    self.assertLess(apart / mean(exact), 0.3 if wrap == "clamp" else 0.12, (width, height, bits, wrap, reads))

    def test_what_alpha_hides_has_no_colour(self):
        """Transparent green between opaque red does not show in the red, and covers as much as without cones."""
        image = png(64, 64, [n for y in range(64) for x in range(64) for n in ((255, 0, 0, 255) if (x // 4 + y // 4) % 2 else (0, 255, 0, 0))])
        for mode in ("MASK", "BLEND"):
            exact, cones = (self.square(image, "x.pfm", "--spp", 64, "--background-color", "1,1,1", *filters, material={"alphaMode": mode}) for filters in ((), CONES))
            self.assertLess(mean(cones, 1) - mean(cones, 2), 0.03, mode)
            self.assertAlmostEqual(mean(cones, 2), mean(exact, 2), delta=1e-6)

    def lit(self, *options, side=1):
        """A floor of checkers to the horizon, seen also in a ball of metal."""
        gltf = Gltf(materials=[{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0}},
                               {"pbrMetallicRoughness": {"roughnessFactor": 0}}],
                    textures=[{"source": 0}], images=[{"uri": data_uri("image/png", checkers(256, 256, side))}],
                    cameras=[{"type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.1}}])
        floor = gltf.accessor([(-20, 0, -20), (20, 0, -20), (20, 0, 20), (-20, 0, 20)])
        uvs = gltf.accessor([(0, 0), (16, 0), (16, 16), (0, 16)])
        gltf.node(mesh=gltf.mesh(gltf.accessor([0, 2, 1, 0, 3, 2], "H"), position=floor, texcoord_0=uvs, material=0))
        steps = 24
        around = [(math.sin(math.pi * j / steps) * math.cos(math.tau * i / steps), math.cos(math.pi * j / steps), math.sin(math.pi * j / steps) * math.sin(math.tau * i / steps))
                  for j in range(steps + 1) for i in range(steps + 1)]
        corners = [n for j in range(steps) for i in range(steps) for a in [j * (steps + 1) + i] for n in (a, a + 1, a + steps + 2, a, a + steps + 2, a + steps + 1)]
        gltf.node(mesh=gltf.mesh(gltf.accessor(corners, "H"), position=gltf.accessor(around), normal=gltf.accessor(around), material=1), translation=[0, 1, 0])
        gltf.node(camera=0, translation=[0, 1.5, 5])
        path = gltf.write(self.folder / "floor.gltf")
        return self.picture(str(path.with_suffix("")), "x.pfm", "--resolution", "48,36", "--studio", *options)

    def test_mirrors_see_levels_too(self):
        """A sample is nearer to the mean of many, on the floor and in the ball."""
        surfaces = ("--stage", "reflections")
        # The ball makes its floor smaller: there, squares of 16 texels are as small as pixels.
        for part, side, rows, columns in (("floor", 1, slice(24, 36), slice(0, 14)), ("ball", 16, slice(23, 28), slice(21, 27))):
            light = lambda *options: luminances([row[columns] for row in self.lit(*surfaces, *options, side=side)[rows]])
            reference = light("--spp", 256)
            errors = [statistics.fmean((a - b)**2 for a, b in zip(light("--spp", 1, *filters), reference)) for filters in ((), CONES)]
            print(f"{part}: squared error of a sample {errors[0]:.5f}, with cones {errors[1]:.5f}")
            self.assertLess(errors[1], 0.05 * errors[0], part)

    def test_a_file_says_which_filter_drew_it(self):
        for filters, says in (((), False), (CONES, True)):
            settings = self.picture_settings(*filters)
            self.assertEqual("ray-cones" in settings, says)

    def picture_settings(self, *options):
        self.square(checkers(8, 8), "x.pfm")
        path = self.folder / "x.exr"
        self.renders(self.folder / "square.gltf", "-o", path, "--quiet", "--resolution", "4,4", "--spp", 1, *options)
        return path.read_bytes().decode("latin-1")

    def test_both_schedules_draw_the_same(self):
        pictures = [self.lit("--spp", 2, *CONES, "--schedule", schedule, "--dispatch", "compute") for schedule in ("megakernel", "wavefront")]
        self.assertEqual(*pictures)


if __name__ == "__main__":
    main()

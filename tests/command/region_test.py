#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Parts of a picture: `--region`, and pictures that are too large for one film. Both have the bits of the whole."""
import json
import statistics
import struct

from support import SCENES, Case, Exr, main, read_pfm, read_png, run

BOX = SCENES / "cornell-box.gltf"
SIZE = (60, 45)


class Cut(Case):
    def drawn(self, name, *options, scene=BOX, size=SIZE):
        """Returns the path of the file, and the statistics."""
        path, stats = self.folder / name, self.folder / "s.json"
        self.renders(scene, "-o", path, "--quiet", "--resolution", "%d,%d" % size, "--stats", stats, *options)
        return path, json.loads(stats.read_text())


class Regions(Cut):
    REGION = (13, 8, 30, 21)

    def same(self, scene, *options):
        whole = read_pfm(self.drawn("whole.pfm", *options, scene=scene)[0])
        x, y, width, height = self.REGION
        path, stats = self.drawn("part.pfm", *options, "--region", "%d,%d,%d,%d" % self.REGION, scene=scene)
        self.assertEqual(read_pfm(path), [row[x:x + width] for row in whole[y:y + height]], (scene, options))
        self.assertEqual((stats["width"], stats["height"], stats["region"]), (width, height, list(self.REGION)))

    def test_the_bits_of_the_whole(self):
        self.same(BOX, "--spp", 5)
        self.same(BOX, "--spp", 3, "--traversal", "literals")
        self.same(BOX, "--spp", 3, "--dispatch", "compute", "--pixel-filter", "gaussian", "--disable", "sobol")
        self.same(SCENES / "transforms.gltf", "--camera-index", 1, "--stage", "phong", "--spp", 2)

    def test_the_bits_of_the_whole_by_the_wavefront(self):
        self.same(SCENES / "room-ball.gltf", "--spp", 3, "--schedule", "wavefront")

    def test_an_exr_says_where_in_the_whole_it_is(self):
        layers = ["--aov", "albedo,depth,samples,variance", "--spp", 4]
        whole = Exr(self.drawn("whole.exr", *layers)[0])
        path = self.drawn("part.exr", *layers, "--region", "%d,%d,%d,%d" % self.REGION)[0]
        part = Exr(path)
        x, y, width, height = self.REGION
        self.assertEqual(part.windows, {"dataWindow": (x, y, x + width - 1, y + height - 1), "displayWindow": (0, 0, SIZE[0] - 1, SIZE[1] - 1)})
        self.assertEqual(set(part.layers), set(whole.layers))
        for name, rows in whole.layers.items():
            self.assertEqual(part.layers[name], [row[x:x + width] for row in rows[y:y + height]], name)
        # A program that reads the file as a picture sees the whole, with black around the part.
        black = self.folder / "black.pfm"
        black.write_bytes(b"PF\n%d %d\n-1\n" % SIZE + bytes(12 * SIZE[0] * SIZE[1]))
        inside = sum(v * v for c in "RGB" for v in part.values(c))
        result = run("diff", path, black, "--metric", "mse")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertAlmostEqual(float(result.stdout), inside / (3 * SIZE[0] * SIZE[1]), delta=1e-6 * inside)

    def test_parts_of_a_region_merge_to_a_region(self):
        region = ["--region", "%d,%d,%d,%d" % self.REGION]
        parts = [self.drawn(f"{first}.exr", "--spp", 2, "--sample-offset", first, *region)[0] for first in (0, 2)]
        result = run("merge", *parts, "-o", self.folder / "m.exr")
        self.assertEqual(result.returncode, 0, result.stderr)
        whole, merged = Exr(self.drawn("w.exr", "--spp", 4, *region)[0]), Exr(self.folder / "m.exr")
        self.assertEqual(merged.windows, whole.windows)
        for a, b in zip(merged.values("G"), whole.values("G")):
            self.assertAlmostEqual(a, b, delta=1e-6 * max(1, b))
        # Nor do regions join that are not the same.
        other = self.drawn("o.exr", "--spp", 2, "--sample-offset", 2, "--region", "14,8,30,21")[0]
        self.fails(3, "merge", parts[0], other, "-o", self.folder / "n.exr", says=["settings", "region"])

    def test_a_filtered_region_stays_one(self):
        path = self.drawn("d.exr", "--spp", 4, "--aov", "denoising", "--region", "%d,%d,%d,%d" % self.REGION)[0]
        filtered = self.folder / "f.exr"
        self.assertEqual(run("denoise", path, "-o", filtered, "--denoise", "variance").returncode, 0)
        self.assertEqual(Exr(filtered).windows, Exr(path).windows)

    def test_boxes_of_the_tree_are_where_they_are_in_the_whole(self):
        options = ["--spp", 1, "--tree-level", 1, "--stage", "flat"]
        whole = self.drawn("whole.png", *options)[0]
        corner = self.drawn("corner.png", *options, "--region", "20,10,40,35")[0]
        step, rows = read_png(whole)[3], read_png(whole)[2]
        self.assertEqual(read_png(corner)[2], [row[20 * step:] for row in rows[10:]])
        self.assertTrue(bytes([255, 140, 26]) in b"".join(rows), "no line")

    def test_regions_that_are_none(self):
        for region, says in (("40,0,21,10", "is not inside the picture of 60 x 45 pixels"), ("0,45,1,1", "is not inside"), ("0,0,0,4", "no pixel"),
                             ("0,0,4", "--region"), ("-1,0,4,4", "--region"), ("a,0,4,4", "--region")):
            self.fails(2, "render", BOX, "-o", self.folder / "x.pfm", "--resolution", "60,45", "--region", region, says=[says])
            self.assertFalse((self.folder / "x.pfm").exists())


class DrawnInParts(Cut):
    def test_the_bits_of_one_film(self):
        """A film of 1,000,000 pixels takes 176 MB."""
        options = ["--spp", 1, "--aov", "albedo,samples", "--stage", "phong"]
        whole, stats = self.drawn("whole.exr", *options, size=(700, 500))
        self.assertNotIn("parts", stats)
        parts, stats = self.drawn("parts.exr", *options, "--memory-limit", "80MB", size=(700, 500))
        self.assertGreater(stats["parts"], 2)
        self.assertEqual(whole.read_bytes(), parts.read_bytes())
        self.assertEqual(stats["samples_per_pixel"], 1)

    def test_pictures_beyond_what_a_driver_draws(self):
        options = ["--spp", 1, "--stage", "flat"]
        path, stats = self.drawn("long.pfm", *options, size=(17000, 2))
        self.assertEqual(stats["parts"], 2)
        end = self.drawn("end.pfm", *options, "--region", "16000,0,1000,2", size=(17000, 2))[0]
        width = struct.calcsize("<3f") * 17000
        rows, last = (p.read_bytes().split(b"\n", 3)[3] for p in (path, end))
        self.assertEqual(b"".join(rows[(y + 1) * width - 12000:(y + 1) * width] for y in range(2)), last)

    def test_adaptive_parts_reach_the_noise_each(self):
        path, stats = self.drawn("a.exr", "--noise", 0.3, "--memory-limit", "30MB", size=(300, 300))
        self.assertGreater(stats["parts"], 1)
        self.assertGreaterEqual(stats["adaptive"]["share_under_noise"], 0.95)
        counts = Exr(path).values("samples.Y")
        self.assertGreater(min(counts), 0)

    def test_time_is_shared_among_the_parts(self):
        path, stats = self.drawn("a.exr", "--time", 3, "--memory-limit", "30MB", size=(300, 300))
        self.assertGreater(stats["parts"], 1)
        self.assertGreater(stats["fewest_samples"], 0)
        # No part gets what others leave. Its rows may still take a doubling more or less.
        rows = [statistics.fmean(row) for row in Exr(path).layers["samples.Y"]]
        self.assertLess(max(rows), 4 * min(rows))

    def test_what_cannot_be_drawn_in_parts_is_refused(self):
        refused = ["render", BOX, "-o", self.folder / "x.png", "--resolution", "700,500", "--spp", 1, "--memory-limit", "50MB"]
        self.fails(2, *refused, "--debug-view", "samples", says=["in parts", "debug view"])
        self.fails(2, "render", BOX, "-o", self.folder / "x.png", "--resolution", "17000,2", "--denoise", "variance", says=["--denoise variance"])


if __name__ == "__main__":
    main()

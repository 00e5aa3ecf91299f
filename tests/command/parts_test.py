#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Parts of a picture: `--region`, and pictures that are too large for one film. Both have the bits of the whole."""
import json
import random
import re
import signal
import statistics
import struct
import subprocess
import time

from support import FRAGTRACE, SCENES, Case, Exr, at_length, main, read_pfm, read_png, run

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


# Parts of a render (--sample-offset) and `merge`, which joins them into what one run gives.
MERGE_SIZE = ["--resolution", "16,12"]
LAYERS = ["--aov", "albedo,normal,depth,samples,variance"]
ATTRIBUTES = ("fragtrace:settings", "fragtrace:seed", "fragtrace:sampleOffset", "fragtrace:samples", "fragtrace:uniform")


class Parts(Case):
    def part(self, name, first, samples, *options, scene=BOX, size="16,12"):
        path = self.folder / name
        self.renders(scene, "-o", path, "--quiet", "--resolution", size, "--sample-offset", first, "--spp", samples, *options)
        return path

    def merged(self, name, *parts):
        path = self.folder / name
        result = run("merge", *parts, "-o", path)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertRegex(result.stdout, f"^{re.escape(str(path))}: {len(parts)} parts?, [0-9]+ .*samples per pixel[^\n]*\n$")
        self.said = result.stdout
        return path


class Merging(Parts):
    def compare(self, whole, merged, limit):
        self.assertEqual((whole.width, whole.height, list(whole.layers)), (merged.width, merged.height, list(merged.layers)))
        for name in whole.layers:
            largest = max(map(abs, whole.values(name)))
            for a, b in zip(whole.values(name), merged.values(name)):
                # The limit is relative to the pixel, or to the largest value if a sum of both signs is nearly zero and
                # mostly rounding.
                self.assertLessEqual(abs(a - b), limit[name.partition(".")[0] if "." in name else ""] * max(abs(a), 0.01 * largest),
                                     name)

    def test_parts_give_what_one_run_gives_in_every_layer(self):
        for options in ([], ["--pixel-filter", "blackman-harris", "--disable", "sobol", "--no-background"]):
            with self.subTest(options):
                whole = Exr(self.part("whole.exr", 0, 64, *LAYERS, *options))
                one, two = self.part("a.exr", 0, 24, *LAYERS, *options), self.part("b.exr", 24, 40, *LAYERS, *options)
                merged = Exr(self.merged("m.exr", one, two))
                limit = dict.fromkeys(("", "albedo", "normal", "depth", "samples"), 1e-6)
                # The film sums squares in floats, one after the other.
                limit["variance"] = 5e-6
                self.compare(whole, merged, limit)
                self.assertEqual(set(merged.values("samples.Y")), {64})
                for name in ATTRIBUTES:
                    self.assertEqual(merged.texts[name], whole.texts[name])
                # Not because all parts are alike: the mean of both alone is no better than noise.
                first, second = Exr(one).luminances(), Exr(two).luminances()
                self.assertGreater(max(abs(a - b) for a, b in zip(first, second)), 0.01)

    def test_samples_with_more_or_fewer_light_paths_count_the_same(self):
        """The first four have one light path for four pixels, the others one for more or fewer."""
        stats, size = self.folder / "stats.json", "64,48"
        for name in ("caustics", "caustic-ground"):
            scene = SCENES / f"{name}.gltf"
            whole = Exr(self.part("whole.exr", 0, 16, "--stats", stats, scene=scene, size=size))
            self.assertNotIn(json.loads(stats.read_text())["caustics"]["pixels_per_path"], (0, 4))
            parts = [self.part(f"{first}.exr", first, samples, scene=scene, size=size) for first, samples in ((0, 6), (6, 10))]
            self.compare(whole, Exr(self.merged("m.exr", *parts)), {"": 2e-5})

    def test_the_order_of_the_parts_changes_no_byte(self):
        a, b, c = (self.part(f"{n}.exr", 8 * n, 8, *LAYERS) for n in range(3))
        expected = self.merged("m.exr", a, b, c).read_bytes()
        for i, order in enumerate(((c, b, a), (b, c, a), (a, c, b))):
            self.assertEqual(self.merged(f"m{i}.exr", *order).read_bytes(), expected)

    def test_what_was_merged_can_be_merged_again(self):
        a, b, c = (self.part(f"{n}.exr", 100 + 8 * n, 8, *LAYERS) for n in range(3))
        once = Exr(self.merged("all.exr", a, b, c))
        twice = Exr(self.merged("again.exr", c, self.merged("ab.exr", a, b)))
        self.compare(once, twice, dict.fromkeys(("", "albedo", "normal", "depth", "samples", "variance"), 1e-6))
        self.assertEqual((twice.texts["fragtrace:sampleOffset"], twice.texts["fragtrace:samples"]), ("100", "24"))
        self.assertEqual(once.texts, twice.texts)

    def test_one_part_alone_stays_as_it_is(self):
        part = self.part("a.exr", 3, 5, *LAYERS)
        self.compare(Exr(part), Exr(self.merged("m.exr", part)), dict.fromkeys(("", "albedo", "normal", "depth", "samples", "variance"), 1e-6))

    def test_colour_alone_is_enough(self):
        whole = self.part("whole.exr", 0, 16)
        merged = self.merged("m.exr", self.part("a.exr", 0, 8), self.part("b.exr", 8, 8))
        self.compare(Exr(whole), Exr(merged), {"": 1e-6})

    def test_the_attributes_say_how_the_picture_was_made(self):
        texts = Exr(self.part("a.exr", 7, 5, "--seed", "4294967295", "--bounces", "3")).texts
        self.assertEqual([texts[name] for name in ATTRIBUTES[1:]], ["4294967295", "7", "5", "1"])
        settings = json.loads(texts["fragtrace:settings"])
        self.assertEqual((settings["scene"], settings["width"], settings["height"], settings["bounces"]),
                         ("cornell-box.gltf", 16, 12, 3))


class RefusedMerges(Parts):
    def setUp(self):
        super().setUp()
        self.first = self.part("first.exr", 0, 4)

    def refuses(self, other, *says):
        for parts in ((self.first, other), (other, self.first)):
            self.fails(3, "merge", *parts, "-o", self.folder / "m.exr", says=says)
            self.assertFalse((self.folder / "m.exr").exists())

    def test_samples_that_overlap(self):
        for first, says in ((3, "sample 3 of seed 0 twice"), (0, "sample 0 of seed 0 twice")):
            other = self.part("other.exr", first, 4)
            self.refuses(other, self.first, other, says)
        self.fails(3, "merge", self.first, self.first, "-o", self.folder / "m.exr", says=["overlap"])
        # Two of three parts overlap, and they are not adjacent in the list.
        parts = [self.part(f"{i}.exr", first, count, "--seed", 7) for i, (first, count) in enumerate(((0, 9), (20, 2), (4, 1)))]
        self.fails(3, "merge", *parts, "-o", self.folder / "m.exr", says=["0.exr", "2.exr", "sample 4 of seed 7 twice"])

    def test_an_adaptive_part_that_holds_the_same_samples(self):
        other = self.folder / "other.exr"
        self.renders(BOX, "-o", other, "--quiet", *MERGE_SIZE, "--noise", "0.5")
        self.refuses(other, self.first, other, "sample 0 of seed 0 twice")

    def test_ranges_that_are_none(self):
        """In a part of two ranges, the one attribute is replaced by something of the same length."""
        joined = self.folder / "two.exr"
        self.assertEqual(run("merge", self.first, self.part("b.exr", 8, 4), "-o", joined).returncode, 0)
        data, ranges = joined.read_bytes(), b"[[0,0,4],[0,8,4]]"
        self.assertEqual(data.count(ranges), 1)
        for bad in (b"[[0,0,4],[0,3,4]]", b"[[0,0,4],[0,8,0]]", b"[[0,0,4],[0,8,4 ]", b"[[0,0,4],[0,8]  ]", b'[[0,0,4],[0,"8",]'):
            joined.write_bytes(data.replace(ranges, bad))
            self.fails(3, "merge", joined, "-o", self.folder / "m.exr", says=[joined, "fragtrace:ranges"])

    def test_other_settings(self):
        for options in (["--bounces", "2"], ["--camera-position", "0,0,4"], ["--camera-view-angle", "30"], ["--disable", "light-sampling"],
                        ["--disable", "sobol"], ["--rr-depth", "5"], ["--clamp-indirect", "3"], ["--pixel-filter", "gaussian"],
                        ["--hdri-file", SCENES / "sky.pfm"]):
            with self.subTest(options):
                other = self.part("other.exr", 4, 4, *options)
                self.refuses(other, self.first, other, "settings")

    def test_of_shaders_only_what_differs_is_named(self):
        other = self.part("other.exr", 4, 4, "--light-reuse", "candidates")
        self.refuses(other, self.first, other, "variant none and light-candidates")

    def test_another_scene_even_of_the_same_name(self):
        scene = json.loads(BOX.read_text())
        scene["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = [0.1, 0.2, 0.3, 1]
        changed = self.written("cornell-box.gltf", scene)
        other = self.part("other.exr", 4, 4, scene=changed)
        self.refuses(other, self.first, other, "settings")

    def test_another_size_or_other_layers(self):
        for says, size, *options in (["differ in size", "16,13"], ["only one of them has variance.Y", "16,12", "--aov", "samples,variance"],
                                     ["only one of them has A", "16,12", "--no-background"]):
            with self.subTest(size=size, options=options):
                other = self.part("other.exr", 4, 4, *options, size=size)
                self.refuses(other, self.first, other, says)

    def test_an_adaptive_picture_has_no_offset(self):
        self.fails(2, "render", BOX, "-o", self.folder / "x.pfm", *MERGE_SIZE, "--noise", "0.5", "--sample-offset", "4", says=["--sample-offset"])

    def test_files_that_are_no_parts(self):
        foreign, text = self.folder / "p.pfm", self.folder / "text.exr"
        self.renders(BOX, "-o", foreign, "--quiet", *MERGE_SIZE, "--spp", "4")
        text.write_text("no picture")
        for other in (foreign, text, self.folder / "none.exr"):
            self.refuses(other, other)
        cut = self.folder / "cut.exr"
        cut.write_bytes(self.first.read_bytes()[:-40])
        self.refuses(cut, cut)
        cut.unlink()
        text.unlink()

    def test_attributes_that_are_no_numbers(self):
        data = self.first.read_bytes()
        other = self.folder / "other.exr"
        start = data.index(b"fragtrace:samples\0string\0") + len(b"fragtrace:samples\0string\0") + 4
        other.write_bytes(data[:start] + b"x" + data[start + 1:])
        self.refuses(other, other, "fragtrace:samples")

    def test_outputs_that_cannot_be_written_or_are_parts(self):
        other = self.part("other.exr", 4, 4)
        before = self.first.read_bytes(), other.read_bytes()
        self.fails(1, "merge", self.first, other, "-o", self.folder / "no/m.exr", says=["no/m.exr"])
        self.fails(2, "merge", self.first, other, "-o", self.folder / "m.pfm", says=["m.pfm"])
        for part in (self.first, other):
            self.fails(2, "merge", self.first, other, "-o", part, says=[part])
        self.fails(2, "merge", "-o", self.folder / "m.exr")
        self.assertEqual((self.first.read_bytes(), other.read_bytes()), before)

    def test_a_sample_beyond_the_last_there_is(self):
        self.fails(2, "render", BOX, "-o", self.folder / "x.exr", *MERGE_SIZE, "--sample-offset", 2**29, "--spp", 1,
                   says=["--sample-offset"])


class UnevenParts(Parts):
    """Parts of which pixels differ in samples, with gaps between them, of several seeds."""

    def weighted(self, merged, parts):
        """`merged` holds the parts' means, weighted by the samples of each pixel."""
        self.assertEqual(merged.values("samples.Y"), [sum(counts) for counts in zip(*(count for _, count in parts))])
        for color in "RGB":
            for pixel, mean in enumerate(merged.values(color)):
                expected = sum(exr.values(color)[pixel] * counts[pixel] for exr, counts in parts) / sum(counts[pixel] for _, counts in parts)
                self.assertAlmostEqual(mean, expected, delta=1e-6 * max(1, expected))

    def test_a_gap_is_said(self):
        a, b = self.part("a.exr", 0, 4), self.part("b.exr", 10, 2)
        merged = Exr(self.merged("m.exr", a, b))
        self.assertIn("2 parts, 6 samples per pixel; missing: samples 4 to 9", self.said)
        self.assertEqual([merged.texts["fragtrace:" + name] for name in ("samples", "uniform", "ranges")], ["6", "1", "[[0,0,4],[0,10,2]]"])
        # A part that fills the gap joins the ranges, so the picture has a single range again.
        whole = Exr(self.merged("w.exr", self.folder / "m.exr", self.part("c.exr", 4, 6)))
        self.assertNotIn("missing", self.said)
        self.assertNotIn("fragtrace:ranges", whole.texts)
        self.assertEqual(whole.texts["fragtrace:samples"], "12")

    def test_other_seeds(self):
        parts = [self.part(f"{seed}.exr", 0, 4 + seed, "--seed", seed, "--aov", "samples") for seed in range(3)]
        merged = Exr(self.merged("m.exr", *parts))
        self.assertIn("3 parts, 15 samples per pixel, of 3 sequences (seeds)", self.said)
        self.weighted(merged, [(exr, exr.values("samples.Y")) for exr in map(Exr, parts)])

    def test_adaptive_and_even_parts(self):
        adaptive = self.folder / "adaptive.exr"
        self.renders(BOX, "-o", adaptive, "--quiet", *MERGE_SIZE, "--noise", "0.2", "--aov", "variance")
        even = self.part("even.exr", 3, 8, "--seed", 5, "--aov", "variance")
        merged = Exr(self.merged("m.exr", adaptive, even))
        self.assertRegex(self.said, r"2 parts, \d+ to \d+ samples per pixel, [\d.]+ on average, of 3 sequences")
        self.assertEqual(merged.texts["fragtrace:uniform"], "0")
        counts = Exr(adaptive).values("samples.Y")
        self.assertGreater(max(counts), min(counts))
        self.weighted(merged, [(Exr(adaptive), counts), (Exr(even), [8] * len(counts))])
        # The joined mean of two varies less than the better one.
        self.assertLess(sum(merged.values("variance.Y")), sum(Exr(adaptive).values("variance.Y")))

    def test_a_part_without_numbers_of_samples_is_none(self):
        """Earlier versions wrote interrupted pictures like this one."""
        part = self.part("a.exr", 0, 4)
        data = part.read_bytes()
        place = data.index(b"fragtrace:uniform\0string\0") + len(b"fragtrace:uniform\0string\0") + 4
        part.write_bytes(data[:place] + b"0" + data[place + 1:])
        self.fails(3, "merge", part, "-o", self.folder / "m.exr", says=[part, "adaptive or interrupted", "samples.Y"])

    def test_an_interrupted_part(self):
        first, other = self.part("first.exr", 0, 4, size="100,100"), self.folder / "other.exr"
        process = subprocess.Popen([FRAGTRACE, "render", BOX, "-o", other, "--resolution", "100,100", "--spp", "1000000",
                                    "--sample-offset", "4", "--progress", "json"], stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        while json.loads(process.stderr.readline()).get("samples", 0) == 0:
            pass  # a file is written once there are samples
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(20), 130)
        exr = Exr(other)
        self.assertEqual(exr.texts["fragtrace:uniform"], "0")
        merged = Exr(self.merged("m.exr", other, first))
        self.weighted(merged, [(Exr(first), [4] * 10000), (exr, exr.values("samples.Y"))])


# `render --checkpoint` and `--resume`: a render that was killed or interrupted ends with the picture of an unbroken one.
BALL = SCENES / "room-ball.gltf"
CHECKPOINT_SIZE = ["--resolution", "70,56"]


class Broken(Case):
    def setUp(self):
        super().setUp()
        self.output = self.folder / "x.exr"
        self.checkpoint = self.folder / "x.exr.checkpoint"

    def arguments(self, *options, scene=BALL):
        return ["render", str(scene), "-o", str(self.output), "--quiet", *map(str, options)]

    def unbroken(self, *options, scene=BALL):
        started = time.monotonic()
        self.assertEqual(run(*self.arguments(*options, scene=scene)).returncode, 0)
        seconds = time.monotonic() - started
        picture = self.output.read_bytes()
        self.output.unlink()
        return picture, seconds

    def broken(self, seconds, *options, scene=BALL, by=signal.SIGKILL, written=False):
        """Starts a render and ends it by the signal `by` after so many seconds. With `written`, the seconds count from
        its first checkpoint: on a busy machine they would mean little otherwise. Returns the exit status."""
        before = self.checkpoint.stat().st_mtime_ns if self.checkpoint.exists() else 0
        process = subprocess.Popen([FRAGTRACE, *self.arguments("--checkpoint", 0.1, *options, scene=scene)], stderr=subprocess.PIPE)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        deadline = time.monotonic() + 60
        while written and process.poll() is None and time.monotonic() < deadline:
            written = not (self.checkpoint.exists() and self.checkpoint.stat().st_mtime_ns > before)
            time.sleep(0.005)
        try:
            process.wait(seconds)
        except subprocess.TimeoutExpired:
            process.send_signal(by)
        return process.wait(60)

    def interrupted_after_a_checkpoint(self, *options, scene=BOX):
        """Interrupts a render once it has written a checkpoint: on a busy machine a number of seconds would mean
        little."""
        process = subprocess.Popen([FRAGTRACE, *self.arguments("--checkpoint", 0.1, *options, scene=scene)])
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        deadline = time.monotonic() + 60
        while not self.checkpoint.exists() and time.monotonic() < deadline:
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        return process.wait(60)

    def resumed(self, *options, scene=BALL):
        result = run(*self.arguments("--resume", *options, scene=scene))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertFalse(self.checkpoint.exists())
        self.assertEqual([p.name for p in self.folder.iterdir()], ["x.exr"])
        return self.output.read_bytes()

    def equal_after_kills(self, kills, dice, *options, scene=BALL):
        """Each render is killed twice on its way; how many left a checkpoint that was not of an earlier one. More renders are, up to five, until one did:
        the machine may be more or less busy than it was."""
        whole, seconds = self.unbroken(*options, scene=scene)
        kept = rounds = 0
        while rounds < kills // 2 or (kept == 0 and rounds < 5):
            rounds += 1
            for resume in ([], ["--resume"]):
                written = dice.random() < 0.7
                after = dice.uniform(0.0, 0.4) if written else dice.uniform(0.2, 0.9)
                self.broken(after * seconds, *options, *resume, scene=scene, written=written)
                kept += self.checkpoint.exists()
            self.assertEqual(self.resumed(*options, scene=scene), whole)
            self.output.unlink()
        return kept


class Checkpoints(Broken):
    @at_length
    def test_killed_and_resumed(self):
        self.assertGreater(self.equal_after_kills(2, random.Random(3), *CHECKPOINT_SIZE, "--spp", 150), 0)

    def test_an_interrupted_render_writes_what_it_has_and_goes_on(self):
        options = [*CHECKPOINT_SIZE, "--spp", 80, "--aov", "denoising"]
        whole, _ = self.unbroken(*options)
        _, seconds = self.unbroken(*options)  # the first time it may compile

        def breaks_late(part):
            """The render is interrupted, and its film was read at a quarter of the samples before."""
            self.checkpoint.unlink(missing_ok=True)
            return self.broken(part * seconds, *options, by=signal.SIGINT) == 130 and min(Exr(self.output).values("samples.Y")) > 24
        # The machine may be more or less busy than it was.
        self.assertTrue(any(breaks_late(part) for part in (0.6, 0.8, 0.4, 0.95, 0.5, 0.7)))
        partly = Exr(self.output)
        self.assertEqual(partly.texts["fragtrace:interrupted"], "1")
        self.assertTrue(self.checkpoint.exists())
        self.fails(2, *self.arguments("--resume", *CHECKPOINT_SIZE, "--spp", 160, "--aov", "denoising"),
                   says=["cannot continue to more samples (spp 80 and 160): what --denoise reads was kept at a quarter"])
        self.assertEqual(self.resumed(*options), whole)
        self.assertNotIn("fragtrace:interrupted", Exr(self.output).texts)

    def test_adaptive(self):
        options = [*CHECKPOINT_SIZE, "--noise", 0.06]
        self.assertGreater(self.equal_after_kills(2, random.Random(5), *options, scene=BOX), 0)

    def test_drawn_in_parts(self):
        """Killed in the first part, and then in the second, whose checkpoint holds the first as a picture."""
        options = ["--resolution", "400,300", "--spp", 12, "--memory-limit", "30MB", "--aov", "albedo"]
        whole, _ = self.unbroken(*options, scene=BOX)
        for part in (0, 1):
            process = subprocess.Popen([FRAGTRACE, *self.arguments("--checkpoint", 0.1, "--resume", *options, scene=BOX)])
            self.addCleanup(process.wait)
            self.addCleanup(process.kill)
            wanted = b'"part":%d' % part
            while process.poll() is None and not (self.checkpoint.exists() and wanted in self.checkpoint.read_bytes()):
                time.sleep(0.02)
            self.assertIsNone(process.poll(), "it ended before it was killed")
            process.kill()
            process.wait()
        self.assertEqual(self.resumed(*options, scene=BOX), whole)

    def test_without_a_checkpoint_it_begins_anew_or_is_finished(self):
        options = ["--resolution", "16,16", "--spp", 2, "--resume"]
        said = run(*[a for a in self.arguments(*options, scene=BOX) if a != "--quiet"])
        self.assertEqual(said.returncode, 0)
        self.assertIn("there is no " + str(self.checkpoint) + ": the picture begins anew", said.stderr)
        before = self.output.stat()
        said = run(*[a for a in self.arguments(*options, scene=BOX) if a != "--quiet"])
        self.assertEqual((said.returncode, said.stdout), (0, ""))
        self.assertIn("x.exr is finished", said.stderr)
        self.assertEqual(self.output.stat().st_mtime_ns, before.st_mtime_ns)
        self.fails(2, *self.arguments("--resolution", "16,16", "--spp", 3, "--resume", scene=BOX), says=["--resume", "--spp 2, not 3"])
        self.fails(3, *self.arguments(*options, scene=self.folder / "none.gltf"), says=["none.gltf"])
        picture = self.folder / "x.png"
        for spp, said in ((1, "the picture begins anew"), (2, "x.png is finished.*does not say with how many samples, and nothing is drawn")):
            result = self.renders(BOX, "-o", picture, "--resolution", "16,16", "--spp", spp, "--resume")
            self.assertRegex(result.stderr, said)
        # A file that a crash of another program has left is not a picture.
        self.output.write_bytes(b"")
        self.assertEqual(run(*self.arguments(*options, scene=BOX)).returncode, 0)
        self.assertGreater(self.output.stat().st_size, 0)

    def test_a_part_that_a_killed_render_has_left_is_removed(self):
        (self.folder / ".x.exr.checkpoint.7-another.part").write_bytes(b"half of one")
        self.resumed("--resolution", "16,16", "--spp", 2, scene=BOX)

    def test_other_settings_are_named(self):
        settings = {"--resolution": "120,90", "--spp": 100000, "--bounces": 16, "--seed": 0}
        options = [word for setting in settings.items() for word in setting]
        self.assertEqual(self.interrupted_after_a_checkpoint(*options), 130)
        kept = self.checkpoint.read_bytes()
        for other, says in (({"--spp": 99999}, "spp 100000 and 99999"), ({"--bounces": 3}, "bounces 16 and 3"), ({"--seed": 5}, "seed 0 and 5"),
                            ({"--resolution": "90,120"}, "width 120 and 90"), ({"--noise": 0.1, "--spp": None}, "asked for): noise 0.0 and 0.1\n")):
            changed = [word for setting in (settings | other).items() if setting[1] is not None for word in setting]
            self.fails(2, *self.arguments(*changed, "--resume", scene=BOX), says=["--resume", self.checkpoint, "another render", says])
        self.fails(2, *self.arguments(*options, "--resume", scene=SCENES / "furnace.gltf"), says=["another render", "and \"furnace.gltf\", and ", " more settings\n"])
        self.assertEqual(self.checkpoint.read_bytes(), kept)

    def test_more_samples_than_at_first_are_drawn_on(self):
        size = ["--resolution", "24,18", "--spp"]
        whole, _ = self.unbroken(*size, 5000, scene=BOX)
        self.assertEqual(self.interrupted_after_a_checkpoint(*size, 4000), 130)
        said = run(*[a for a in self.arguments("--resume", *size, 5000, scene=BOX) if a != "--quiet"])
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertRegex(said.stderr, r"(?m)^fragtrace: --resume: continues after [\d.]+ of 5000 samples per pixel$")
        self.assertEqual(self.output.read_bytes(), whole)

    def test_broken_checkpoints_are_refused(self):
        options = ["--resolution", "20,10", "--spp", 1000000]
        self.assertEqual(self.interrupted_after_a_checkpoint(*options), 130)
        good = self.checkpoint.read_bytes()
        end = good.index(b"{")
        middle = len(good) // 2
        for bad in (b"", b"x", good[:-1], good[:middle] + bytes([good[middle] ^ 4]) + good[middle + 1:], good + b"x", good[:end + 20], good.replace(b"checkpoint 4", b"checkpoint 9"),
                    good.replace(b'"size":[20,10]', b'"size":[10,20]'), good.replace(b'"part":0', b'"part":7')):
            self.assertNotEqual(bad, good)
            self.checkpoint.write_bytes(bad)
            self.fails(3, *self.arguments(*options, "--resume", scene=BOX), says=[self.checkpoint])
        self.checkpoint.unlink()
        self.output.unlink()

    def test_one_that_cannot_be_written_on_the_way_does_not_end_the_render(self):
        """A folder takes the checkpoint's name while the picture is drawn."""
        process = subprocess.Popen([FRAGTRACE, *[a for a in self.arguments("--checkpoint", 0.1, *CHECKPOINT_SIZE, "--spp", 600, scene=BOX) if a != "--quiet"]],
                                   stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.kill)
        while not self.checkpoint.exists():
            time.sleep(0.01)
        self.checkpoint.unlink()
        self.checkpoint.mkdir()
        said = process.communicate(timeout=60)[1]
        self.assertTrue(self.output.exists(), said)
        self.assertEqual(said.count("the render continues"), 1, said)

    def test_a_checkpoint_that_is_not_asked_for_is_said(self):
        self.checkpoint.write_bytes(b"old")
        result = run(*[a for a in self.arguments("--resolution", "16,16", "--spp", 1, scene=BOX) if a != "--quiet"])
        self.assertEqual(result.returncode, 0)
        self.assertIn("is not used without --resume", result.stderr)

    def test_a_checkpoint_that_cannot_be_written_is_said_before_the_first_sample(self):
        self.output = self.folder / "none/x.exr"
        self.fails(1, *self.arguments("--checkpoint", 1, *CHECKPOINT_SIZE), says=["none"])
        self.fails(2, "render", BOX, "-o", self.folder / "x.exr", "--checkpoint", "0", says=["--checkpoint"])


class Kills(Broken):
    def test_twenty_kills(self):
        kept = self.equal_after_kills(20, random.Random(20), *CHECKPOINT_SIZE, "--spp", 300)
        print(f"{kept} of 20 killed renders left a checkpoint")
        self.assertGreater(kept, 10)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Parts of a render (--sample-offset) and `merge`, which joins them into what one run gives."""
import json
import re
import signal
import subprocess

from support import FRAGTRACE, SCENES, Case, Exr, main, run

BOX = SCENES / "cornell-box.gltf"
SIZE = ["--resolution", "16,12"]
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
        self.renders(BOX, "-o", other, "--quiet", *SIZE, "--noise", "0.5")
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
        self.fails(2, "render", BOX, "-o", self.folder / "x.pfm", *SIZE, "--noise", "0.5", "--sample-offset", "4", says=["--sample-offset"])

    def test_files_that_are_no_parts(self):
        foreign, text = self.folder / "p.pfm", self.folder / "text.exr"
        self.renders(BOX, "-o", foreign, "--quiet", *SIZE, "--spp", "4")
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
        self.fails(2, "render", BOX, "-o", self.folder / "x.exr", *SIZE, "--sample-offset", 2**29, "--spp", 1,
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
        self.renders(BOX, "-o", adaptive, "--quiet", *SIZE, "--noise", "0.2", "--aov", "variance")
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


if __name__ == "__main__":
    main()

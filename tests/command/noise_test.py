#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""--noise and --time: what they promise of the picture, and when they end."""
import json
import math
import signal
import statistics
import subprocess
import time

from support import FRAGTRACE, SCENES, TWO_TRIANGLES, Case, Exr, Gltf, luminances, main, read_pfm, run

BOX = SCENES / "cornell-box.gltf"


def quantile(values, part):
    return sorted(values)[max(0, math.ceil(part * len(values)) - 1)]


class Seeds:
    """Pictures of one scene that differ in their seed, and the standard errors that they show."""

    def __init__(self, case, scene, options, seeds):
        pictures = [luminances(case.picture(scene, "x.pfm", *options, "--seed", 1000 + 17 * s)) for s in range(seeds)]
        self.means = [statistics.fmean(pixel) for pixel in zip(*pictures)]
        self.mean = statistics.fmean(self.means)
        self.mean_error = statistics.stdev(map(statistics.fmean, pictures)) / math.sqrt(seeds) / self.mean
        errors = [statistics.stdev(pixel) / (mean + 0.01 * self.mean) for pixel, mean in zip(zip(*pictures), self.means)]
        self.p95 = quantile(errors, 0.95)
        self.rms = math.sqrt(statistics.fmean(e * e for e in errors))


class Noise(Case):
    def test_the_true_error_is_the_one_asked_for(self):
        for scene, noise, *options in (["cornell-box", 0.05], ["environment-diffuse", 0.02, "--hdri-file", SCENES / "sky.pfm"]):
            with self.subTest(scene):
                options += ["--resolution", "24,24"]
                seeds = Seeds(self, scene, [*options, "--noise", noise], 8)
                plain = statistics.fmean(luminances(self.picture(scene, "p.pfm", *options, "--spp", 4096)))
                bias = seeds.mean / plain - 1
                print(f"{scene}, noise {noise}: standard error, 95th percentile {seeds.p95:.4f}, rms {seeds.rms:.4f}; mean {bias:+.4f}")
                # The deviation of 8 pictures scatters by a quarter, which lifts the largest of 576.
                self.assertLess(seeds.p95, 1.25 * noise)
                # If sobol's samples were taken for independent ones, the second would come to 0.68 of its noise.
                self.assertGreater(seeds.p95, 0.75 * noise)
                self.assertLess(abs(bias), 0.005)

    def test_what_the_statistics_say_is_in_the_layers(self):
        stats = self.folder / "s.json"
        exr = self.picture("cornell-box", "x.exr", "--resolution", "24,20", "--noise", "0.1", "--aov", "samples,variance,normal", "--no-background",
                           "--stats", stats)
        stats = json.loads(stats.read_text())
        mean = statistics.fmean(exr.luminances())
        errors = [math.sqrt(v) / (l + 0.01 * mean) for v, l, alpha in
                  zip(exr.values("variance.Y"), exr.luminances(), exr.values("A")) if l > 0 and alpha > 0]
        self.assertAlmostEqual(stats["adaptive"]["error_p95"] / quantile(errors, 0.95), 1, delta=1e-4)
        self.assertLessEqual(stats["adaptive"]["error_p95"], 0.1)
        self.assertEqual(stats["adaptive"]["noise"], 0.1)
        under = sum(e <= 0.1 for e in errors) / len(errors)
        self.assertAlmostEqual(stats["adaptive"]["share_under_noise"], under, delta=1e-9)
        self.assertGreaterEqual(under, 0.95)
        samples = exr.values("samples.Y")
        self.assertEqual((min(samples), max(samples)), (stats["fewest_samples"], stats["most_samples"]))
        self.assertAlmostEqual(statistics.fmean(samples), stats["samples_per_pixel"], delta=1e-6)
        self.assertLess(min(samples), max(samples))
        self.assertTrue(stats["complete"])

    def test_the_same_seed_gives_the_same_bits(self):
        options = ["--resolution", "24,20", "--noise", "0.1"]
        one, two, other = (self.picture("cornell-box", "x.pfm", *options, "--seed", seed) for seed in (1, 1, 2))
        self.assertEqual(one, two)
        self.assertNotEqual(one, other)

    def test_spp_is_the_most(self):
        for most, reached in ((200, 200), (128, 128), (71, 70), (5, 4)):
            self.renders(BOX, "-o", self.folder / "x.pfm", "--quiet", "--resolution", "16,16", "--noise", "0.001", "--spp", most,
                         "--stats", self.folder / "s.json")
            stats = json.loads((self.folder / "s.json").read_text())
            self.assertEqual((stats["most_samples"], stats["spp"], stats["complete"]), (reached, most, True))
            self.assertGreater(stats["adaptive"]["error_p95"], 0.001)

    def test_of_a_black_picture_no_error_is_known(self):
        result = self.renders(SCENES / "furnace.gltf", "-o", self.folder / "x.pfm", "--resolution", "16,16", "--noise", "0.01",
                              "--no-default-light", "--stats", self.folder / "s.json")
        adaptive = json.loads((self.folder / "s.json").read_text())["adaptive"]
        self.assertEqual((adaptive["error_p95"], adaptive["share_under_noise"]), (None, 0))
        self.assertIn("error unknown", result.stdout)

    def test_what_is_not_known_is_said(self):
        where = ["-o", self.folder / "x.pfm", "--stats", self.folder / "s.json"]
        dark = self.renders(SCENES / "furnace.gltf", *where, "--resolution", "16,16", "--no-default-light", "--noise", "0.01")
        self.assertIn("nothing is known of its noise", dark.stderr)
        short = self.renders(BOX, *where, "--resolution", "16,16", "--noise", "0.001", "--spp", "64")
        self.assertIn("before the noise asked for", short.stderr)

    def test_one_pixel_is_not_taken_for_sure(self):
        # Two halves of 32 samples that happen to agree were taken for an error of 0.
        taken = []
        for seed in range(1000, 1012):
            self.renders(BOX, "-o", self.folder / "x.pfm", "--quiet", "--resolution", "1,1", "--noise", "0.1", "--seed", seed,
                         "--stats", self.folder / "s.json")
            taken.append(json.loads((self.folder / "s.json").read_text())["most_samples"])
        print(f"samples of one pixel: {taken}")
        self.assertGreater(min(taken), 64)
        self.assertGreater(statistics.median(taken), 500)

    def test_values_that_make_no_sense(self):
        for options in (["--noise", "0"], ["--noise", "-1"], ["--noise", "nan"], ["--time", "0"], ["--time", "-2"],
                        ["--noise", "0.1", "--spp", "3"]):
            self.fails(2, "render", BOX, "-o", self.folder / "x.pfm", *options, says=[options[-2]])


class Time(Case):
    def render(self, name, *options):
        """Returns the seconds on the clock, and the statistics."""
        began = time.monotonic()
        self.renders(BOX, "-o", self.folder / name, "--quiet", "--resolution", "100,100", "--stats", self.folder / "s.json", *options)
        return time.monotonic() - began, json.loads((self.folder / "s.json").read_text())

    def error(self, name):
        picture, reference = (luminances(read_pfm(self.folder / n)) for n in (name, "reference.pfm"))
        return statistics.fmean((a - b) ** 2 for a, b in zip(picture, reference))

    def test_it_takes_the_time_given_and_makes_use_of_it(self):
        self.render("reference.pfm", "--spp", 300, "--seed", 1)
        start, _ = self.render("short.pfm", "--time", "0.2")
        seconds, stats = self.render("long.pfm", "--time", "2")
        print(f"--time 0.2: {start:.2f} s, --time 2: {seconds:.2f} s on the clock, {stats['render_ms'] / 1000:.2f} s drawing")
        self.assertLess(seconds - start, 2.3)
        self.assertGreater(seconds - start, 1.3)
        self.assertLess(stats["render_ms"], 2300)
        self.assertGreater(stats["render_ms"], 1700)
        self.assertEqual((stats["adaptive"]["seconds"], stats["complete"]), (2, True))
        self.assertLess(self.error("long.pfm"), 0.5 * self.error("short.pfm"))

    def test_of_noise_and_time_the_first_to_be_reached_ends_it(self):
        seconds, stats = self.render("x.pfm", "--time", "60", "--noise", "0.5")
        self.assertLess(seconds, 20)
        self.assertGreaterEqual(stats["adaptive"]["share_under_noise"], 0.95)
        seconds, stats = self.render("x.pfm", "--time", "1", "--noise", "0.0001")
        self.assertLess(stats["render_ms"], 1500)
        self.assertLess(stats["adaptive"]["share_under_noise"], 0.95)
        self.assertTrue(stats["complete"])

    def test_too_little_time_for_a_sample_in_every_pixel_gives_a_picture_all_the_same(self):
        result = self.renders(BOX, "-o", self.folder / "x.exr", "--resolution", "1500,1500", "--time", "0.05", "--aov", "samples,variance",
                              "--stats", self.folder / "s.json")
        stats = json.loads((self.folder / "s.json").read_text())
        self.assertEqual(stats["fewest_samples"], 0)
        self.assertIn("first sample", result.stderr)


class AdaptiveInterruption(Case):
    def test_ctrl_c_writes_what_is_there(self):
        path = self.folder / "x.exr"
        process = subprocess.Popen([FRAGTRACE, "render", BOX, "-o", path, "--resolution", "128,128", "--noise", "0.0001", "--quiet",
                                    "--aov", "samples,variance,albedo", "--stats", self.folder / "s.json"])
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        time.sleep(4)
        began = time.monotonic()
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(20), 130)
        self.assertLess(time.monotonic() - began, 2)
        exr, stats = Exr(path), json.loads((self.folder / "s.json").read_text())
        self.assertFalse(stats["complete"])
        self.assertEqual((min(exr.values("samples.Y")), max(exr.values("samples.Y"))),
                         (stats["fewest_samples"], stats["most_samples"]))
        self.assertGreaterEqual(stats["fewest_samples"], 32)
        self.assertGreater(min(exr.pixel(64, 40, "albedo.R")), 0.5)


class NoisePromise(Case):
    """`--noise 0.01` leaves 95 % of the pixels a standard error below 1 %, on scenes of every kind, and is not biased."""

    SCENES = {"cornell-box": ["--resolution", "16,16"], "glass-sphere": ["--resolution", "16,16"],
              "mirror-sphere": ["--resolution", "16,16"], "corner-diffuse": ["--resolution", "16,16"],
              "environment-diffuse": ["--resolution", "16,16", "--hdri-file", SCENES / "sky.pfm"]}

    def test_five_scenes(self):
        for scene, options in self.SCENES.items():
            with self.subTest(scene):
                began = time.monotonic()
                seeds = Seeds(self, scene, [*options, "--noise", "0.01", "--stats", self.folder / "s.json"], 16)
                stats = json.loads((self.folder / "s.json").read_text())
                plain = self.picture(scene, "p.pfm", *options, "--spp", 32768, "--seed", 5)
                bias = seeds.mean / statistics.fmean(luminances(plain)) - 1
                print(f"{scene}: standard error, 95th percentile {100 * seeds.p95:.2f} %, rms {100 * seeds.rms:.2f} %; mean "
                      f"against plain {100 * bias:+.3f} % (standard error {100 * seeds.mean_error:.3f} %); last seed: estimated "
                      f"{100 * stats['adaptive']['error_p95']:.2f} %, {stats['samples_per_pixel']:.0f} samples per pixel, "
                      f"{stats['fewest_samples']} to {stats['most_samples']}; {time.monotonic() - began:.0f} s", flush=True)
                self.assertGreater(seeds.p95, 0.004)
                self.assertLess(seeds.p95, 0.012)
                self.assertLess(abs(bias), 0.003)


# `--noise` looks at the pixels that can be noisy, however few they are, and however rarely light is met there.
class Sketch(Gltf):
    """Quads and glass spheres, looked at from above by an orthographic camera that shows a square of 2 x `half` metres."""

    def __init__(self, half):
        super().__init__(extensionsUsed=["KHR_implicit_shapes"], materials=[],
                         cameras=[{"type": "orthographic", "orthographic": {"xmag": half, "ymag": half, "znear": 0.01, "zfar": 100}}])
        self.node(camera=0, translation=[0, 0, 50])

    def material(self, emission=0, color=0.8, **extensions):
        names = {"KHR_materials_" + name: e for name, e in extensions.items()}
        self.root["extensionsUsed"] = sorted({*self.root["extensionsUsed"], *names, "KHR_materials_emissive_strength"})
        self.root["materials"].append({
            "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0 if names else 1, "baseColorFactor": [color] * 3 + [1]},
            "emissiveFactor": [1 if emission else 0] * 3,
            "extensions": names or {"KHR_materials_emissive_strength": {"emissiveStrength": max(emission, 1)}}})
        return len(self.root["materials"]) - 1

    def quad(self, x, y, z, half, material, down=False):
        """Adds a square; `half` is the distance from its middle to each side. It looks up, or down."""
        position = self.accessor([(x + a, y + b, z) for a, b in ((-half, -half), (half, -half), (half, half), (-half, half))])
        indices = self.accessor((0, 2, 1, 0, 3, 2) if down else TWO_TRIANGLES, "H")
        self.node(mesh=self.mesh(indices, position=position, material=material))

    def ball(self, z, radius, material):
        self.root["extensions"] = {"KHR_implicit_shapes": {"shapes": [{"type": "sphere", "sphere": {"radius": radius}}]}}
        self.node(extras={"shape": 0, "material": material}, translation=[0, 0, z])


def small_object(pixels):
    """A quad of so many pixels per side in a picture of 64 x 64, black all round; its edges keep off the next pixels."""
    sketch = Sketch(32)
    sketch.quad(0, 0, 0, pixels / 2 - 0.001, sketch.material())
    sketch.quad(0, 40, 10, 6, sketch.material(500), down=True)
    return sketch


def lamp_in_the_dark():
    """A lamp, seen from behind, over a white patch on a ground that is black."""
    sketch = Sketch(32)
    sketch.quad(0, 0, 0, 40, sketch.material(color=0, specular={"specularFactor": 0}))
    sketch.quad(3, 5, 0.01, 4.999, sketch.material())
    sketch.quad(3, 5, 1.5, 0.75, sketch.material(20), down=True)
    return sketch


def caustic():
    """A glass ball hides a small lamp from all of the ground that is seen; one path of a thousand meets the lamp through it."""
    sketch = Sketch(0.3)
    sketch.quad(0, 0, 0, 4, sketch.material())
    sketch.ball(1.2, 0.5, sketch.material(transmission={"transmissionFactor": 1}, volume={"thicknessFactor": 1}))
    sketch.quad(0, 0, 6, 0.1, sketch.material(600), down=True)
    return sketch


# The 95th percentile of chi square over its degrees of freedom, here pictures: what root mean squares of so few scatter upwards by, squared.
SCATTER = {4: 9.488 / 4, 8: 15.507 / 8}


class Goal(Case):
    """The 95th percentile, over lit pixels that a camera sample hits, of the root mean square error of some seeds, against a picture of many samples,
    is at most 1.2 times the goal, besides what so few seeds scatter."""

    def check(self, sketch, goal, resolution, most, seeds=4):
        path = self.folder / "scene.gltf"
        sketch.write(path)
        common = ["--resolution", f"{resolution},{resolution}", "--no-background"]
        stem = str(path.with_suffix(""))
        reference = self.picture(stem, "r.exr", *common, "--spp", most, "--seed", 77)
        pictures = [self.picture(stem, "x.exr", *common, "--noise", goal, "--seed", 100 + s, "--stats", self.folder / "s.json") for s in range(seeds)]
        stats = json.loads((self.folder / "s.json").read_text())
        light = reference.luminances()
        floor = 0.01 * statistics.fmean(light)
        seen = [any(alpha) for alpha in zip(*(p.values("A") for p in pictures))]
        errors = [math.sqrt(statistics.fmean((x - r) ** 2 for x in pixel)) / (r + floor)
                  for pixel, r, s in zip(zip(*(p.luminances() for p in pictures)), light, seen) if s and r > 0]
        error = quantile(errors, 0.95)
        print(f"{len(errors)} of {len(light)} pixels: true error {error:.4f}, goal {goal}, {stats['samples_per_pixel']:.0f} samples per pixel", flush=True)
        self.assertGreaterEqual(stats["fewest_samples"], 32)
        self.assertLess(error, 1.2 * goal * math.sqrt(SCATTER[seeds]))


class NoiseGoal(Goal):
    def test_an_object_of_2_percent_of_the_picture(self):
        self.check(small_object(9), 0.02, 64, 4096)

    def test_an_object_of_a_thousandth_of_the_picture(self):
        self.check(small_object(2), 0.002, 64, 16384)

    def test_a_lamp_in_the_dark(self):
        self.check(lamp_in_the_dark(), 0.05, 64, 8192)


class NoiseGoalCaustic(Goal):
    def test_a_caustic_that_most_samples_miss(self):
        self.check(caustic(), 0.5, 16, 65536, seeds=8)

    def test_smaller_goals(self):
        self.check(small_object(9), 0.01, 64, 32768, seeds=8)
        self.check(lamp_in_the_dark(), 0.02, 64, 16384, seeds=8)


# --quality: what it sets, for which pictures it is the default, and that the time left is true.
SMALL = ["--resolution", "32,24", "--quiet"]
GOALS = {"draft": (0.2, 16), "good": (0.1, 512), "best": (0.03, 4096)}
RENDERS = ("cornell-box", "water-cube", "plastics", "caustic-ground", "many-lights", "sphere-plane-mirror", "rough-glass", "vitrine", "coverage",
           "environment-diffuse")


class Quality(Case):
    def settled(self, output, *options):
        """The noise asked for, the samples at most, and the filter, in the words of the statistics."""
        stats = self.folder / "s.json"
        self.renders(BOX, "-o", self.folder / output, *SMALL, "--stats", stats, *options)
        stats = json.loads(stats.read_text())
        return stats.get("adaptive", {}).get("noise"), stats["spp"], stats.get("denoise", {}).get("filter")

    def test_each_sets_noise_samples_and_filter(self):
        for name in ("draft", "good"):
            for output in ("x.png", "x.exr"):
                self.assertEqual(self.settled(output, "--quality", name), (*GOALS[name], "variance 5"))

    def test_good_is_the_default_of_pictures_for_the_eye(self):
        for output in ("x.png", "x.jpg"):
            self.assertEqual(self.settled(output), (*GOALS["good"], "variance 5"))
        for output in ("x.exr", "x.hdr", "x.pfm"):
            self.assertEqual(self.settled(output), (None, 64, None))
        for own, expected in (("--spp 4", (None, 4, None)), ("--noise 0.3", (0.3, 1 << 29, None)), ("--denoise none", (None, 64, None)),
                              ("--region 0,0,8,8", (None, 64, None)), ("--light-reuse spatial", (None, 64, None)), ("--quality none", (None, 64, None)),
                              ("--debug-view normal", (None, 64, None)), ("--stage shadows", (None, 64, None))):
            self.assertEqual(self.settled("x.png", *own.split()), expected, own)
        config = self.folder / "c.json"
        config.write_text(json.dumps({"spp": 4}))
        self.assertEqual(self.settled("x.png", "--config", config), (None, 4, None))

    def test_what_other_options_say_stays(self):
        self.assertEqual(self.settled("x.png", "--quality", "good", "--spp", 8), (0.1, 8, "variance 5"))
        self.assertEqual(self.settled("x.png", "--quality", "draft", "--noise", 0.5), (0.5, 16, "variance 5"))
        self.assertEqual(self.settled("x.png", "--quality", "draft", "--denoise", "none"), (0.2, 16, None))

    def test_the_picture_depends_on_the_seed_alone(self):
        first = self.folder / "a.png"
        second = self.folder / "b.png"
        self.renders(BOX, "-o", first, *SMALL)
        self.renders(BOX, "-o", second, *SMALL, "--noise", 0.1, "--spp", 512, "--denoise", "variance")
        self.assertEqual(first.read_bytes(), second.read_bytes())

    def test_a_goal_that_is_not_reached_is_said(self):
        said = self.renders(SCENES / "vitrine.gltf", "-o", self.folder / "x.png", "--resolution", "16,16", "--quality", "draft").stderr
        self.assertIn("some pixels are noisier than --quality draft asks for after 16 samples", said)
        self.assertNotIn("warning", said)


class TimeLeft(Case):
    def test_a_draft_that_its_limit_ends_was_near_its_end(self):
        # Large enough for a line each 100 ms to be near the end.
        said = run("render", BOX, "-o", self.folder / "x.png", "--resolution", "1200,800", "--quality", "draft", "--progress", "json").stderr
        told = [event["fraction"] for event in map(json.loads, said.splitlines()) if event.get("phase") == "rendering"]
        self.assertGreater(max(told), 0.75)

    def test_a_third_of_the_way_the_time_left_is_right(self):
        """Within 30 %, in the median of ten renders, and in eight of them within 60 %."""
        ratios = []
        for scene in RENDERS:
            command = [FRAGTRACE, "render", SCENES / f"{scene}.gltf", "-o", self.folder / "x.png", "--resolution", "320,240", "--progress", "json"]
            told = []
            with subprocess.Popen(list(map(str, command)), stderr=subprocess.PIPE, text=True) as process:
                for line in process.stderr:
                    event = json.loads(line)
                    if event.get("phase") == "rendering":
                        told.append((time.monotonic(), event["seconds_left"]))
                    end = time.monotonic()  # of the picture, which is filtered and written after its last sample
            self.assertEqual(process.returncode, 0)
            start = told[0][0]
            third, left = next(t for t in told if t[0] - start >= (end - start) / 3)
            ratios.append(left / (end - third))
            print(f"{scene}: {end - start:.1f} s, {left:.1f} s left at a third: {ratios[-1]:.2f} of the truth")
        self.assertTrue(0.7 < sorted(ratios)[5] < 1.3, ratios)
        self.assertGreaterEqual(sum(0.4 < r < 1.6 for r in ratios), 8, ratios)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`bench error`: what it measures, writes and refuses."""
import json
import math
import time

from support import SCENES, Case, main, run

BOX = SCENES / "cornell-box.gltf"
SIZE = ["--resolution", "8,8"]
SHORT = ["--quiet", "--repetitions", "1", "--spp", "2", *SIZE]


class Bench(Case):
    def bench(self, *arguments, timeout=120):
        """The result, and what --json holds, by configuration."""
        path = self.folder / "bench.json"
        result = run("bench", "error", BOX, "--json", path, *arguments, timeout=timeout)
        self.assertEqual(result.returncode, 0, result.stderr)
        report = json.loads(path.read_text())
        return result, report, {c["name"]: c for c in report["configurations"]}

    def refused(self, status, *arguments, says=()):
        self.fails(status, "bench", "error", *arguments, says=says)


class BenchMeasures(Bench):
    def test_the_reports_agree_and_hold_what_is_promised(self):
        # Large enough that the slope of the baseline, whose samples are seldom bright, is near its -1.
        result, report, found = self.bench("--resolution", "32,32", "--spp", 100, "--repetitions", 2, "--seed", 3, "--goal", "0.01", "--quiet")
        self.assertEqual(result.stderr, "")
        self.assertEqual((report["scene"], report["width"], report["height"], report["goal_relmse"]), ("cornell-box.gltf", 32, 32, 0.01))
        self.assertEqual(report["reference"], "6400 samples of 'default' with another seed")
        self.assertEqual(list(found), ["default", "random", "baseline"])
        self.assertEqual(found["baseline"]["options"], "--disable light-sampling,sobol")
        for name, entry in found.items():
            self.assertEqual(len(entry["repetitions"]), 2)
            self.assertNotEqual(*[[step["mse"] for step in steps] for steps in entry["repetitions"]])
            for steps in entry["repetitions"]:
                self.assertEqual([step["samples"] for step in steps], [1, 2, 4, 8, 16, 32, 64, 100])
                self.assertEqual([s["seconds"] for s in steps], sorted(s["seconds"] for s in steps))
                self.assertTrue(all(math.isfinite(value) and value > 0 for step in steps for value in step.values()))
            self.assertLess(entry["slope"], -0.5)
            self.assertIn(name, result.stdout)
        # One picture of 100 samples of 8 x 8 pixels says little, but the baseline needs many times more.
        self.assertNotIn("default_is", found["default"])
        for name in ("random", "baseline"):
            self.assertIn(f"default against {name}: ", result.stdout)
            self.assertEqual(set(found[name]["default_is"]), {"times_sooner", "times_fewer_samples"})
        gain = found["baseline"]["goal"]["samples"] / found["default"]["goal"]["samples"]
        self.assertAlmostEqual(found["baseline"]["default_is"]["times_fewer_samples"] / gain, 1, delta=1e-6)
        self.assertGreater(gain, 4)

    def test_the_steps_are_pictures_of_render_against_the_reference(self):
        reference, picture = self.folder / "r.pfm", self.folder / "p.pfm"
        self.renders(BOX, "-o", reference, "--quiet", *SIZE, "--spp", 512, "--seed", 99)
        _, report, found = self.bench("--quiet", *SIZE, "--spp", 6, "--seed", 7, "--repetitions", 2, "--configs", "default",
                                      "--reference", reference)
        self.assertEqual(report["reference"], "r.pfm")
        for number, steps in enumerate(found["default"]["repetitions"]):
            for step in steps:
                self.renders(BOX, "-o", picture, "--quiet", *SIZE, "--spp", int(step["samples"]), "--seed", 7 + number)
                for metric in ("mse", "relmse", "flip"):
                    # FLIP of a display picture; ours there has 8 bits.
                    value = float(run("diff", picture, reference, "--metric", metric).stdout)
                    self.assertAlmostEqual(value / step[metric], 1, delta=0.02 if metric == "flip" else 1e-5)

    def test_options_of_a_configuration_stand_before_those_for_all(self):
        own = ["few=--spp 2 --bounces 1 --camera-position -.5,0,3", "many=", "a,\"b\"=--spp 3", "size=--resolution 8,8"]
        _, _, found = self.bench("--quiet", "--resolution", "8,8", "--spp", 4, "--repetitions", 1, "--camera-position", "0,0,4",
                                 *(a for c in own for a in ("--config", c)))
        samples = {name: c["repetitions"][0][-1]["samples"] for name, c in found.items()}
        self.assertEqual(samples, {"default": 4, "few": 2, "many": 4, "a,\"b\"": 3, "size": 4})
        # Same options, same pictures; another camera, another picture.
        first = {name: c["repetitions"][0][0]["mse"] for name, c in found.items()}
        self.assertEqual(first["many"], first["size"])
        self.assertNotEqual(first["many"], first["few"])

    def test_adaptive_configurations_come_down_to_their_goal(self):
        _, _, found = self.bench("--quiet", *SIZE, "--spp", 16, "--repetitions", 1, "--configs", "default", "--config",
                                 "coarse=--noise 0.05 --spp 100000", "--config", "timed=--time 0.4 --spp 100000")
        for name, factor in (("coarse", 2), ("timed", 4)):
            steps = found[name]["repetitions"][0]
            self.assertEqual(len(steps), 6)
            self.assertGreater(steps[-1]["samples"], factor * steps[0]["samples"])
        self.assertGreater(found["coarse"]["repetitions"][0][-1]["samples"], 64)
        self.assertLess(found["timed"]["repetitions"][0][-1]["seconds"], 1.0)

    def test_denoised_steps_are_pictures_of_render_denoise(self):
        reference, picture = self.folder / "r.pfm", self.folder / "p.pfm"
        size = ["--resolution", "32,32"]
        self.renders(BOX, "-o", reference, "--quiet", *size, "--spp", 256, "--seed", 99)
        result, _, found = self.bench("--quiet", *size, "--spp", 6, "--seed", 7, "--repetitions", 2, "--configs", "default", "--reference", reference,
                                      "--denoise", "variance", "--goal", 0.3)
        drawn, denoised = found["default"], found["default"]["denoised"]
        self.assertRegex(denoised["filter"], r"variance \d")
        for number, (steps, before) in enumerate(zip(denoised["repetitions"], drawn["repetitions"])):
            self.assertEqual([step["samples"] for step in steps], [1, 2, 4, 6])
            self.assertEqual([step["samples"] for step in before], [1, 2, 4, 6])
            for step, noisy in zip(steps, before):
                # From four samples on the filter knows more, by looks at a quarter and a half of them.
                self.renders(BOX, "-o", picture, "--quiet", *size, "--spp", int(step["samples"]), "--seed", 7 + number, "--denoise", "variance")
                value = float(run("diff", picture, reference, "--metric", "relmse").stdout)
                self.assertAlmostEqual(value / step["relmse"], 1, delta=1e-4)
                self.assertLess(step["relmse"], 0.7 * noisy["relmse"])
            self.assertTrue(all(step["seconds"] > 0 for step in steps))
        gain = drawn["goal"]["samples"] / denoised["goal"]["samples"]
        self.assertAlmostEqual(denoised["denoised_is"]["times_fewer_samples"] / gain, 1, delta=1e-6)
        self.assertIn("default denoised", result.stdout)


class BenchDenoisedSeconds(Bench):
    def test_layers_and_filter_count(self):
        """They take longer than the few samples of such a picture."""
        reference, size = self.folder / "r.pfm", ["--resolution", "128,128"]
        self.renders(BOX, "-o", reference, "--quiet", *size, "--spp", 64, "--seed", 99)
        _, _, found = self.bench("--quiet", *size, "--spp", 2, "--configs", "default", "--reference", reference, "--denoise", "variance", "--repetitions", 3)
        raw, filtered = (min(sum(step["seconds"] for step in steps) for steps in part["repetitions"]) for part in (found["default"], found["default"]["denoised"]))
        self.assertGreater(filtered, 1.5 * raw)


class BenchRefusals(Bench):
    def test_options_that_make_no_sense(self):
        for options, says in ((["--configs", "fast"], "fast"), (["--config", "bounces 3"], "NAME=OPTIONS"),
                              (["--config", "=--bounces 3"], "NAME=OPTIONS"), (["--config", "a=--nonsense"], "nonsense"),
                              (["--config", "a=--spp 0"], "a"),
                              (["--config", "a=other.gltf"], "other.gltf"), (["--config", "a=--stage fast"], "fast"),
                              (["--config", "a=--spp 2", "--config", "a=--spp 3"], "twice"),
                              (["--config", "default=--spp 3"], "one of --configs"),
                              (["--configs", "random,random"], "twice"),
                              (["--repetitions", "0"], "repetitions"), (["--goal", "-1"], "goal"), (["--goal", "nan"], "goal"),
                              (["--stats", self.folder / "s.json"], "--stats"), (["--configs", "adaptive"], "--reference"),
                              (["--configs", "default", "--config", "wide=--resolution 9,8"], "wide"), (["--denoise", "fast"], "fast"),
                              (["--denoise", "variance", "--config", "flat=--stage flat"], "flat")):
            with self.subTest(options):
                self.refused(2, BOX, *SIZE, "--quiet", *options, says=[says])
        self.refused(2, says=["file"])
        self.fails(2, "bench", says=["needs a command"])

    def test_inputs_that_cannot_be_used(self):
        reference = self.folder / "r.pfm"
        self.renders(BOX, "-o", reference, "--quiet", "--resolution", "9,8", "--spp", 1)
        self.refused(3, BOX, *SHORT, "--reference", reference, says=[reference, "9 x 8", "8 x 8"])
        self.refused(3, BOX, *SHORT, "--reference", self.folder / "none.exr", says=["none.exr"])
        self.refused(3, self.folder / "none.gltf", *SHORT, says=["none.gltf"])

    def test_outputs_that_cannot_be_written_before_work(self):
        began = time.monotonic()
        # A reference of 64 x 2^20 samples would take minutes.
        self.refused(1, BOX, "--quiet", "--resolution", "512,512", "--spp", 2**20, "--json", self.folder / "no/b.json", says=["no/b.json"])
        self.assertLess(time.monotonic() - began, 20)

    def test_outputs_that_are_inputs(self):
        reference = self.folder / "r.pfm"
        self.renders(BOX, "-o", reference, "--quiet", *SIZE, "--spp", 1)
        before = reference.read_bytes()
        self.refused(2, BOX, *SHORT, "--reference", reference, "--json", reference)
        self.assertEqual(reference.read_bytes(), before)
        # A picture that the scene refers to.
        for name in ("sphere-textured.gltf", "graticule.png"):
            (self.folder / name).write_bytes((SCENES / name).read_bytes())
        picture = (self.folder / "graticule.png").read_bytes()
        self.refused(2, self.folder / "sphere-textured.gltf", *SHORT, "--json", self.folder / "graticule.png")
        self.assertEqual((self.folder / "graticule.png").read_bytes(), picture)


class BenchInterruption(Bench):
    def interrupt(self, *options):
        self.interrupts("bench", "error", BOX, "--quiet", "--resolution", "64,64", "--spp", 2**20,
                        "--json", self.folder / "b.json", *options, within=2)

    def test_ctrl_c_while_the_reference_is_drawn_writes_nothing_and_gives_130(self):
        self.interrupt()

    def test_ctrl_c_while_measuring_writes_nothing_and_gives_130(self):
        reference = self.folder / "r.pfm"
        self.renders(BOX, "-o", reference, "--quiet", "--resolution", "64,64", "--spp", 1)
        self.interrupt("--reference", reference)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`bench error`: what it measures, writes and refuses."""
import importlib.util
import json
import math
import os
import random
import shutil
import signal
import struct
import subprocess
import sys
import time
from pathlib import Path

from support import FRAGTRACE, SCENES, SHADERS, SMALL, Case, Gltf, main, run

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


BENCH = FRAGTRACE.with_name("fragtrace-bench")
# Prints its process and its words, and ends by a signal.
STAND_IN = '#!/bin/sh\nprintf "%s\\n" "$$" "$0" "$@"\nkill -TERM $$\n'


class BenchProgram(Case):
    """`fragtrace bench` becomes the program fragtrace-bench, which lies next to it."""

    def setUp(self):
        super().setUp()
        self.environment = {name: value for name, value in os.environ.items() if name != "FRAGTRACE_LIBRARY_PATH"}

    def program(self, path, *words):
        shutil.copy(path, self.folder / path.name)
        return subprocess.Popen([self.folder / path.name, *map(str, words)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                env=self.environment)

    def test_words_process_and_end_are_those_of_the_program(self):
        stand_in = self.folder / BENCH.name
        stand_in.write_text(STAND_IN)
        stand_in.chmod(0o755)
        for words, passed in ((["bench", "error", "a b", "--goal=1"], ["error", "a b", "--goal=1"]), (["bench"], []),
                              (["--help", "bench", "bench"], ["--help", "bench"])):
            with self.subTest(words=words), self.program(FRAGTRACE, *words) as process:
                self.assertEqual(process.communicate()[0].splitlines(), [str(process.pid), str(stand_in), *passed])
                self.assertEqual(process.returncode, -signal.SIGTERM)

    def test_a_missing_program_is_named(self):
        said = f"bench: the program fragtrace-bench is not in {self.folder}; the package fragtrace holds it, and scripts/build makes it"
        with self.program(FRAGTRACE, "bench", "stress") as process:
            self.assertEqual(process.communicate(), ("", f"fragtrace: {said}\n"))
            self.assertEqual(process.returncode, 1)
        with self.program(FRAGTRACE, "bench", "error", "--progress", "json") as process:
            self.assertEqual(json.loads(process.communicate()[1].splitlines()[0])["text"], said)
            self.assertEqual(process.returncode, 1)

    def test_a_start_needs_the_renderer(self):
        with self.program(BENCH, "start", SCENES / "cornell-box.gltf", "--quiet") as process:
            self.assertIn("bench start: the program fragtrace is not in", process.communicate()[1])
            self.assertEqual(process.returncode, 1)

    def test_it_speaks_as_the_command_does(self):
        for words in (["--help"], ["error", "--help"], [], ["foo"], ["stress", "--rowz"], ["error", "none.gltf", "--goal", "x"]):
            with self.subTest(words=words):
                own = subprocess.run([BENCH, *words], capture_output=True, text=True)
                command = run("bench", *words)
                self.assertEqual((own.returncode, own.stdout, own.stderr), (command.returncode, command.stdout, command.stderr))
                self.assertIn("fragtrace", own.stdout + own.stderr)
        self.assertEqual(run("--help", "bench", "error").stdout, run("bench", "error", "--help").stdout)


# bench/report.py, which repeats the report's table by `bench frame`, and bench/charts.py.
BENCH_REPORT_BENCH = SCENES.parent / "bench"
DATA = SCENES.parent / "docs/measurements/data"
sys.path.insert(0, str(BENCH_REPORT_BENCH))
import charts  # noqa: E402


class BenchReport(Case):
    def report(self, *arguments):
        return subprocess.run([sys.executable, BENCH_REPORT_BENCH / "report.py", FRAGTRACE, "--quiet", "--rounds", "2", "--round-time", "0.001", "--resolution", "16,16", *arguments],
                              capture_output=True, text=True)

    def test_rows_and_tables_have_the_reports_figures(self):
        path = self.folder / "r.json"
        result = self.report("--parts", "traversal,gi", "--json", path)
        self.assertEqual(result.returncode, 0, result.stderr)
        lines = [json.loads(line) for line in path.read_text().splitlines()]
        # Trees with a draw for each sample, too.
        self.assertEqual(len(lines), 2 + 2 * 4 + 1)
        self.assertTrue(all(line["picture"]["right"] for line in lines))
        for text in ("| 62,975 triangles | iterative | ", " | 226 |", " | 0.43 |", "| Cornell box | 128 samples | ", "iterative, 62,975 / 15,743"):
            self.assertIn(text, result.stdout)

    def test_an_error_of_bench_frame_ends_it(self):
        result = self.report("--parts", "gi", "--noise", "0.1")
        self.assertEqual(result.returncode, 2)
        self.assertIn("--noise", result.stderr)


class Charts(Case):
    def test_points_are_means_with_their_spread(self):
        step = lambda seconds, relmse: {"seconds": seconds, "relmse": relmse}
        curve = {"name": "a", "slope": None, "repetitions": [[step(1, 4), step(2, 2)], [step(3, 6), step(4, 1)]]}
        self.assertEqual(list(charts.error_series({"configurations": [curve]})), [("a (slope -)", [(2, 5, 4, 6), (3, 1.5, 1, 2)])])

    def test_the_charts_of_the_documents_can_be_made_again(self):
        if not importlib.util.find_spec("matplotlib"):
            self.skipTest("matplotlib is not installed")
        for name, words in (("report", ["Frame time", "bvh, report"]), ("denoise/glass-sphere-variance", ["Error against time", "default denoised"])):
            chart = self.folder / "chart.svg"
            charts.draw(DATA / f"{name}.json", chart)
            for word in words:
                self.assertIn(word, chart.read_text())

    def test_what_cannot_be_drawn_is_refused(self):
        (self.folder / "matplotlib.py").write_text("raise ImportError\n")
        told = subprocess.run([sys.executable, BENCH_REPORT_BENCH / "charts.py", "a.json", "a.svg"], capture_output=True, text=True, env={"PYTHONPATH": str(self.folder)})
        self.assertEqual((told.returncode, told.stderr), (1, "charts.py: matplotlib is not installed (Debian: python3-matplotlib; PyPI: matplotlib)\n"))
        with self.assertRaisesRegex(ValueError, "of no benchmark"):
            charts.chart_of("{}")


BENCH_MOTION_SHORT = ["--resolution", "32,24", "--pictures", "6", "--interval", "1", "--quiet"]


class BenchMotion(Case):
    """`bench motion`: its rows and checks on small pictures; a path from a file; what cannot be measured."""

    def motion(self, *arguments):
        path = self.folder / "motion.json"
        result = run("bench", "motion", *arguments, "--json", path)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout, json.loads(path.read_text())

    def test_each_mode_has_its_figures_and_its_error(self):
        table, report = self.motion(BOX, *BENCH_MOTION_SHORT, "--compare", 2, "--reference-spp", 64, "--modes", "raw,filtered,no-past")
        self.assertEqual((report["bench"], report["scene"], report["width"], report["height"]), ("motion", "cornell-box.gltf", 32, 24))
        self.assertEqual([row["mode"] for row in report["rows"]], ["raw", "filtered", "no-past"])
        for row in report["rows"]:
            self.assertIn(row["mode"], table)
            self.assertEqual((row["pictures"], len(row["gap_ms"]), row["compared"]), (6, 6, 2))
            self.assertTrue(0 < row["trace_cpu_ms"] and 0 < row["pixels"] <= 6 * 32 * 24, row)
            self.assertTrue(all(ms > 0 for ms in row["latency_ms"]), row)
            self.assertTrue(0 < row["flip"] < 0.3 and 0 < row["relmse"], row)
        # A picture may come before the next move of the camera.
        self.assertTrue(any(row["latency_ms"] for row in report["rows"]))

    def test_without_a_target_pictures_have_full_resolution(self):
        _, report = self.motion(BOX, *BENCH_MOTION_SHORT, "--target", 0, "--path", "dolly", "--stage", "phong")
        self.assertEqual(report["rows"][0]["pixels"], 6 * 32 * 24)

    def test_a_path_goes_through_the_places_of_a_file(self):
        path = self.folder / "path.txt"
        path.write_text("--camera-position 0,1,3 --camera-focal-point 0,1,0\n\n--camera-position 0.5,1,3 --camera-focal-point 0,1,0\n")
        self.motion(BOX, *BENCH_MOTION_SHORT, "--path", path)
        path.write_text("--camera-position 0,1,3\n--camera-position 1\n")
        self.fails(3, "bench", "motion", BOX, *BENCH_MOTION_SHORT, "--path", path, says=["path.txt:2", "--camera-position"])
        path.write_text("--camera-position 0,1,3\n")
        self.fails(3, "bench", "motion", BOX, *BENCH_MOTION_SHORT, "--path", path, says=["path.txt", "two places"])

    def test_a_sun_or_a_slider_that_moves_has_no_past(self):
        """So slowly that all pictures are alike: with the past of a camera at rest, whose noise is the same, the error would be ten times as large."""
        for scene, path, light in (("sun-sky", "sun", "--sky"), ("plastics", "color", "--studio")):
            with self.subTest(path=path):
                _, report = self.motion(SCENES / f"{scene}.gltf", *BENCH_MOTION_SHORT, "--warm-up", 4, light, "--path", path, "--period", 10000, "--target", 0, "--compare", 1,
                                        "--reference-spp", 64, "--modes", "filtered,no-past")
                with_past, without = (row["relmse"] for row in report["rows"])
                self.assertGreater(without, 0)
                self.assertLess(with_past, 3 * without)

    def test_what_cannot_be_measured_is_refused(self):
        self.fails(2, "bench", "motion", BOX, *BENCH_MOTION_SHORT, "--time", 1, says=["--time"])
        self.fails(2, "bench", "motion", BOX, *BENCH_MOTION_SHORT, "--modes", "blurred", says=["--modes"])
        self.fails(2, "bench", "motion", BOX, *BENCH_MOTION_SHORT, "--path", "sun", says=["--path sun: needs --sky"])
        self.fails(3, "bench", "motion", self.folder / "none.gltf", *BENCH_MOTION_SHORT, says=["none.gltf"])


# `bench start`: its rows; and that a picture of few paths, compiled without optimising, is the same bits.
TINY = ["--resolution", "8,8", "--spp", "1"]
PHASES = ["process", "scene", "light", "tree", "context", "program", "pack", "upload", "first draw", "draw", "write"]


class BenchStart(Case):
    def start(self, *arguments, status=0):
        path = self.folder / "start.json"
        result = run("bench", "start", *arguments, "--quiet", "--json", path)
        self.assertEqual(result.returncode, status, result.stderr)
        return result, json.loads(path.read_text()) if path.exists() else None

    def test_each_step_of_each_start_has_its_times(self):
        result, report = self.start(BOX, *TINY, "--starts", 2, "--stage", "flat", "--format", "pfm")
        self.assertEqual((report["schema"], report["bench"], report["scene"]), (1, "start", "cornell-box.gltf"))
        self.assertEqual((report["width"], report["height"]), (8, 8))
        self.assertEqual(sorted(phase["phase"] for phase in report["phases"]), sorted(PHASES))
        for phase in report["phases"]:
            self.assertIn(phase["phase"], result.stdout)
            self.assertEqual(phase["thread"], "second" if phase["phase"] == "pack" else "main")
            for begin, end, cpu in zip(phase["begin_ms"], phase["end_ms"], phase["cpu_ms"], strict=True):
                self.assertTrue(0 <= begin <= end, phase)
                self.assertGreaterEqual(cpu, 0)
        for written, ended, cpu in zip(report["written_ms"], report["ended_ms"], report["cpu_ms"], strict=True):
            self.assertTrue(0 < written <= ended and cpu > 0, report)
        self.assertEqual(len(report["written_ms"]), 2)
        self.assertIn("written after", result.stdout)

    def test_an_environment_is_read_beside_the_scene(self):
        _, report = self.start(SCENES / "environment-diffuse.gltf", *TINY, "--starts", 1, "--stage", "flat",
                               "--hdri-file", SCENES / "sky.pfm")
        threads = {phase["phase"]: phase["thread"] for phase in report["phases"]}
        self.assertEqual((threads["environment"], threads["scene"]), ("second", "main"))

    def test_the_tree_does_not_wait_for_the_environment(self):
        """Though the scene's textures are read by the same process."""
        self.renders(SCENES / "environment-diffuse.gltf", "-o", self.folder / "sky.hdr", *SMALL)
        _, report = self.start(SCENES / "sphere-textured.gltf", *TINY, "--starts", 1, "--stage", "flat", "--hdri-file", self.folder / "sky.hdr")
        phases = {phase["phase"]: phase for phase in report["phases"]}
        self.assertLess(phases["tree"]["begin_ms"][0], phases["environment"]["end_ms"][0])

    def test_nothing_is_left_behind(self):
        environment = dict(os.environ, TMPDIR=str(self.folder))
        result = run("bench", "start", BOX, *TINY, "--starts", 1, "--stage", "flat", "--quiet", env=environment)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_interrupted_it_ends_its_render_and_leaves_nothing(self):
        # Again and again, as a signal just before the wait is missed only sometimes.
        for signal_number in (signal.SIGINT, signal.SIGTERM) * 5:
            process = subprocess.Popen([FRAGTRACE, "bench", "start", BOX, "--resolution", "512,512", "--spp", "100000", "--quiet"], text=True,
                                       env=dict(os.environ, TMPDIR=str(self.folder)), stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            children = Path(f"/proc/{process.pid}/task/{process.pid}/children")
            while not children.read_text():
                pass
            render = children.read_text().split()[0]
            process.send_signal(signal_number)
            self.assertEqual(process.communicate(timeout=20), ("", "fragtrace: interrupted, nothing is written\n"))
            self.assertEqual(process.returncode, 130)
            self.assertFalse(Path("/proc", render).exists())
            self.assertEqual(list(self.folder.iterdir()), [])

    def test_what_cannot_be_measured_is_refused(self):
        self.fails(2, "bench", "start", BOX, "--time", 1, says=["--time"])
        self.fails(2, "bench", "start", BOX, "--stats", self.folder / "s.json", says=["--stats"])
        self.fails(2, "bench", "start", BOX, "--format", "gif", says=["--format"])
        self.fails(2, "bench", "start", BOX, "--json", BOX, says=["cornell-box"])
        for words, status, said in (([self.folder / "none.gltf"], 3, "none.gltf"), ([BOX, "--hide", "none"], 2, "--hide")):
            result = run("bench", "start", *words, *TINY, "--quiet")
            self.assertEqual(result.returncode, status)
            self.assertIn(said, result.stderr)
            self.assertIn("a start failed", result.stderr)


class QuickCompilation(Case):
    def picture(self, scene, *options, **environment):
        picture, statistics = self.folder / "p.pfm", self.folder / "s.json"
        result = subprocess.run([FRAGTRACE, "render", scene, "-o", picture, "--quiet", "--stats", statistics, *options],
                                capture_output=True, text=True, env=dict(os.environ, **environment))
        self.assertEqual(result.returncode, 0, result.stderr)
        return picture.read_bytes(), json.loads(statistics.read_text())["quick_compilation"]

    def test_few_paths_are_compiled_quickly_to_the_same_bits(self):
        for scene in (BOX, SCENES / "rough-glass.gltf", SCENES / "lobes.gltf"):
            with self.subTest(scene.name):
                few = ["--resolution", "16,16", "--spp", "2"]
                quick, was_quick = self.picture(scene, *few)
                optimised, was_not = self.picture(scene, *few, GALLIVM_PERF="")
                self.assertEqual((was_quick, was_not), (True, False))
                self.assertEqual(quick, optimised)

    def test_many_paths_are_not(self):
        self.assertFalse(self.picture(BOX, "--resolution", "513,512", "--spp", "1", "--stage", "flat")[1])
        self.assertTrue(self.picture(BOX, "--resolution", "512,512", "--spp", "1", "--stage", "flat")[1])
        self.assertFalse(self.picture(BOX, "--resolution", "257,256", "--spp", "2")[1])
        self.assertTrue(self.picture(BOX, "--resolution", "256,256", "--spp", "2")[1])
        self.assertFalse(self.picture(BOX, "--resolution", "8,8", "--time", "0.1", "--stage", "flat")[1])


class VectorWidth(Case):
    """The width of vectors in Mesa's software driver."""

    def setUp(self):
        super().setUp()
        if self.width("furnace", "--stage", "flat") is None:
            self.skipTest("the driver names no width of vectors")

    def width(self, scene, *options, **environment):
        stats = self.folder / "s.json"
        self.renders(SCENES / (scene + ".gltf"), *TINY, "--quiet", "-o", self.folder / "x.pfm", "--stats", stats, *options, env={**os.environ, **environment})
        return json.loads(stats.read_text()).get("vector_width")

    def test_each_width_draws_the_same_bits_and_is_told(self):
        for scene in ("cornell-box", "lobes"):
            pictures = []
            for width in (256, 512):
                self.assertEqual(self.width(scene, "--vector-width", width), width)
                pictures.append((self.folder / "x.pfm").read_bytes())
            self.assertEqual(*pictures, scene)

    def test_the_option_counts_more_than_the_environment(self):
        self.assertEqual(self.width("furnace", "--vector-width", 512, LP_NATIVE_VECTOR_WIDTH="256"), 512)
        self.assertEqual(self.width("furnace", LP_NATIVE_VECTOR_WIDTH="512"), 512)


# `bench traversal`: what it measures, writes and refuses; memory stated by `info` and `--stats`.
RAYS = ["--resolution", "64,48", "--rounds", 2, "--quiet"]
ROOM = SCENES / "room-ball.gltf"


class BenchTraversalBench(Case):
    def lines(self, *arguments):
        path = self.folder / "b.json"
        result = run("bench", *arguments, "--json", path)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return result, [json.loads(line) for line in path.read_text().splitlines()]

    def broken(self, name, old, new):
        """A folder of shaders in which one place is wrong."""
        folder = self.folder / "shaders"
        shutil.copytree(SHADERS, folder)
        text = (folder / name).read_text()
        self.assertEqual(text.count(old), 1, old)
        (folder / name).write_text(text.replace(old, new))
        return folder


class BenchTraversal(BenchTraversalBench):
    def test_each_kind_of_rays_is_timed_and_checked(self):
        result, rows = self.lines("traversal", ROOM, *RAYS)
        self.assertEqual([row["kind"] for row in rows], ["primary", "diffuse", "shadow"])
        for row in rows:
            self.assertEqual((row["schema"], row["bench"], row["scene"], row["triangles"]), (1, "traversal", "room-ball.gltf", 69326))
            self.assertEqual(len(row["ms"]), 2)
            self.assertAlmostEqual(row["mrays_per_s"] / (row["rays"] / min(row["ms"]) / 1000), 1, delta=1e-6)
            self.assertLessEqual(row["wrong"], 2)
            self.assertGreater(row["proved_by_all"], 50)
            self.assertIn(row["kind"], result.stdout)
        primary, diffuse, shadow = rows
        # The room is closed.
        self.assertEqual((primary["rays"], primary["hits"]), (64 * 48, 64 * 48))
        self.assertEqual((diffuse["rays"], diffuse["hits"]), (64 * 48, 64 * 48))
        self.assertTrue(0 < shadow["hits"] < shadow["rays"] < 64 * 48, shadow)
        self.assertEqual(primary["clock"], "wall clock")
        self.assertLess(primary["gpu_bytes_per_triangle"], 160)

    def test_spheres_and_open_scenes_are_traced_too(self):
        _, (primary, diffuse, _) = self.lines("traversal", SCENES / "sphere-plane.gltf", *RAYS, "--traversal", "bvh")
        self.assertTrue(0 < primary["hits"] < primary["rays"])
        self.assertEqual(diffuse["rays"], primary["hits"])
        self.assertIn("bvh", primary["variant"])

    def test_compute_traces_them_as_on_a_gpu(self):
        for kind in self.lines("traversal", ROOM, *RAYS, "--dispatch", "compute", "--tune", "gpu")[1]:
            self.assertIn("+compute+gpu", kind["variant"])
            self.assertLessEqual(kind["wrong"], 2)
            self.assertGreater(kind["hits"], 0)

    def test_long_triangles_in_pieces(self):
        """Rods of four sides at all angles. Their tree in pieces finds what double precision finds, at fewer steps than one of whole triangles:
        such is that of a file with an animation, whose poses refit it."""
        draw = random.Random(5)
        points, indices = [], []
        for _ in range(500):
            middle, along = ([draw.uniform(-1, 1) for _ in range(3)] for _ in range(2))
            across = [[0.004 * (axis == i) for axis in range(3)] for i in range(2)]
            first = len(points)
            points += [[m + end * a + u * c + v * d for m, a, c, d in zip(middle, along, *across)] for end in (-1, 1) for u in (-1, 1) for v in (-1, 1)]
            indices += [first + i for a, b, c, d in ((0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6)) for i in (a, b, c, a, c, d)]
        gltf = Gltf(materials=[{"doubleSided": True}])
        gltf.node(mesh=gltf.mesh(gltf.accessor(indices, "I"), position=gltf.accessor(points), material=0))
        gltf.node(name="nothing")
        view = ["--camera-position", "0,0,5", "--camera-focal-point", "0,0,0", "--resolution", "32,32", "--spp", 2, "--quiet", "--count-work"]

        def drawn(name):
            scene, stats = gltf.write(self.folder / f"{name}.gltf"), self.folder / "s.json"
            self.renders(scene, "-o", self.folder / f"{name}.pfm", *view, "--stats", stats)
            return scene, (self.folder / f"{name}.pfm").read_bytes(), json.loads(stats.read_text())

        scene, picture, told = drawn("pieces")
        gltf.moves(1, [0, 1], translation=[[0, 0, 0], [1, 0, 0]])
        _, same, whole = drawn("whole")
        self.assertEqual(picture == same, True)
        self.assertGreater(told["bvh"]["leaves"], 1.4 * whole["bvh"]["leaves"])
        self.assertLess(told["work"]["node_steps"], 0.9 * whole["work"]["node_steps"])
        for row in self.lines("traversal", scene, *RAYS)[1]:
            self.assertLessEqual(row["wrong"], 2)

    def test_the_plain_tracer_finds_the_same(self):
        result, rows = self.lines("traversal", ROOM, *RAYS, "--plain")
        for row in rows:
            self.assertEqual(len(row["plain_ms"]), 2)
            self.assertLessEqual(row["plain_wrong"], 2)
        self.assertEqual(result.stdout.count("by the plain tracer"), 3)
        self.fails(3, "bench", "traversal", SCENES / "sphere-plane.gltf", *RAYS, "--plain", says=["spheres"])
        folder = self.broken("entry/plain.glsl", "b >= 0.0 && ", "b >= 0.3 && ")
        self.fails(1, "bench", "traversal", ROOM, *RAYS, "--plain", "--shader-folder", folder, says=["rays hit something else"])

    def test_rays_are_written_for_others(self):
        path = self.folder / "rays"
        _, rows = self.lines("traversal", ROOM, *RAYS, "--rays", path)
        data = path.read_bytes()
        self.assertEqual(data[:8], b"FTRAYS1\0")
        triangles, rays = struct.unpack_from("<2I", data, 8)
        self.assertEqual((triangles, rays), (69326, 64 * 48))
        self.assertEqual(len(data), 16 + 36 * triangles + 3 * 32 * rays)
        for number, row in enumerate(rows):
            at = 16 + 36 * triangles + number * 32 * rays
            found = [struct.unpack_from("<8f", data, at + 32 * i) for i in range(rays)]
            there = [ray for ray in found if ray[3] > 0]
            self.assertEqual((len(there), sum(ray[7] >= 0 for ray in there)), (row["rays"], row["hits"]))
            for ray in there[:100]:
                self.assertAlmostEqual(math.hypot(*ray[4:7]), 1, delta=1e-5)
        self.fails(3, "bench", "traversal", SCENES / "sphere-plane.gltf", *RAYS, "--rays", path, says=["spheres"])

    def test_wrong_hits_fail(self):
        for name, old, new in (("tree/leaf.glsl", "bool hita = ", "bool hita = s.slot < 0 && "),
                               ("slab.glsl", "floatBitsToInt(far) + 32", "floatBitsToInt(0.9f * far)")):
            with self.subTest(new):
                folder = self.broken(name, old, new)
                self.fails(1, "bench", "traversal", ROOM, *RAYS, "--shader-folder", folder, says=["rays hit something else"])
                shutil.rmtree(folder)

    def test_refusals(self):
        self.fails(2, "bench", "traversal", ROOM, *RAYS, "--traversal", "iterative", says=["iterative"])
        self.fails(2, "bench", "traversal", ROOM, *RAYS, "--camera-index", 3, says=["--camera-index"])
        self.fails(3, "bench", "traversal", self.folder / "none.gltf", *RAYS, says=["none.gltf"])
        self.fails(1, "bench", "traversal", ROOM, *RAYS, "--rays", self.folder / "no" / "rays", says=["rays"])
        self.fails(2, "bench", "traversal", ROOM, *RAYS, "--json", ROOM, says=["room-ball"])


class GpuMemory(BenchTraversalBench):
    def test_bytes_a_triangle_are_stated(self):
        stats = self.folder / "s.json"
        self.renders(ROOM, "-o", self.folder / "p.pfm", *SMALL, "--stats", stats)
        told = json.loads(stats.read_text())
        info = json.loads(run("info", ROOM, "--json").stdout)
        # `render` may keep the largest triangles next to the tree.
        self.assertAlmostEqual(info["gpu_bytes_per_triangle"], told["gpu_bytes_per_triangle"], delta=0.1)
        self.assertTrue(60 < told["gpu_bytes_per_triangle"] < 160, told["gpu_bytes_per_triangle"])
        self.assertLessEqual(told["gpu_bytes_per_triangle"] * 69326, told["scene_bytes"])
        self.assertNotIn("buffer_reads_fallback", told)
        self.assertIn("bytes per triangle", run("info", ROOM, "--verbose").stdout)
        self.assertNotIn("bytes per triangle", run("info", SCENES / "sphere-black.gltf", "--verbose").stdout)
        self.renders(SCENES / "sphere-black.gltf", "-o", self.folder / "p.pfm", *SMALL, "--stats", stats)
        self.assertNotIn("gpu_bytes_per_triangle", json.loads(stats.read_text()))


if __name__ == "__main__":
    main()

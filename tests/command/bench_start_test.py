#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`bench start`: its rows; and that a picture of few paths, compiled without optimising, is the same bits."""
import json
import os
import signal
import subprocess
from pathlib import Path

from support import FRAGTRACE, SCENES, SMALL, Case, main, run

BOX = SCENES / "cornell-box.gltf"
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
        self.assertFalse(self.picture(BOX, "--resolution", "129,128", "--spp", "1", "--stage", "flat")[1])
        self.assertTrue(self.picture(BOX, "--resolution", "128,128", "--spp", "1", "--stage", "flat")[1])
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


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`bench frame`: what it measures, writes, compares and refuses."""
import json
import shutil
import math
import time

from support import SCENES, SHADERS, Case, main, run

BOX = SCENES / "cornell-box.gltf"
SIZE = ["--resolution", "16,16"]
QUICK = ["--quiet", "--rounds", "2", "--round-time", "0.001", *SIZE]


class Frame(Case):
    def frame(self, *arguments, status=0, scenes=(BOX,)):
        """Returns the result, and the lines of --json by scene and configuration."""
        path = self.folder / "frames.json"
        result = run("bench", "frame", *scenes, "--json", path, *arguments)
        self.assertEqual(result.returncode, status, result.stderr)
        lines = [json.loads(line) for line in path.read_text().splitlines()]
        return result, {(line["scene"], line["configuration"]): line for line in lines}


class FrameTimes(Frame):
    def test_the_lines_hold_what_is_promised(self):
        scenes = [BOX, SCENES / "sphere-plane.gltf"]
        result, found = self.frame("--quiet", "--rounds", 3, "--spp", 5, *SIZE, "--configs", "default,random", "--config",
                                   "tree=--traversal bvh", scenes=scenes)
        self.assertEqual(result.stderr, "")
        self.assertEqual(list(found), [(s.name, c) for s in scenes for c in ("default", "random", "tree")])
        for (scene, name), line in found.items():
            self.assertEqual((line["schema"], line["command"], line["width"], line["height"]), (1, "frame", 16, 16))
            self.assertEqual((line["rounds"], line["frames_per_round"], len(line["round_frame_ms"])), (3, 5, 3))
            self.assertIn(line["clock"], ("gpu timer", "wall clock"))
            if "llvmpipe" in line["gl_renderer"]:
                self.assertEqual(line["clock"], "wall clock")
            for key in ("compile_ms", "first_frame_ms", "mpaths_per_s", "mrays_per_s", "rays_per_path"):
                self.assertTrue(math.isfinite(line[key]) and line[key] > 0, key)
            times = line["frame_ms"]
            self.assertEqual(set(times), {"median", "mean", "stddev", "min", "p95"})
            self.assertLessEqual(times["min"], times["median"])
            self.assertLessEqual(times["median"], times["p95"])
            self.assertGreaterEqual(line["wall_frame_ms"]["median"], times["min"])
            self.assertAlmostEqual(line["mpaths_per_s"], 256 / times["median"] / 1000, delta=1e-9)
            self.assertEqual("ratio" in line, name != "default")
            self.assertTrue(line["picture"]["right"], line["picture"])
            self.assertEqual((line["budget_hits"], line["nonfinite_pixels"]), (0, 0))
            self.assertRegex(line["date"], r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ$")
            self.assertIn(name, result.stdout)
        self.assertEqual(found[BOX.name, "random"]["options"], "--disable sobol --resolution 16,16 --spp 5")
        self.assertEqual(found[BOX.name, "tree"]["ratio"]["to"], "default")
        self.assertIn("+bvh+", found[BOX.name, "tree"]["variant"])
        # The same samples give the same picture; random ones another, of the same light.
        self.assertLess(found[BOX.name, "tree"]["picture"]["differing_pixels"], 0.005)
        self.assertGreater(found[BOX.name, "random"]["picture"]["differing_pixels"], 0.5)

    def test_rounds_take_the_time_asked_for(self):
        _, short = self.frame("--quiet", "--rounds", 1, *SIZE, "--round-time", 0.1, "--stage", "flat")
        _, long = self.frame("--quiet", "--rounds", 1, *SIZE, "--round-time", 1.6, "--stage", "flat")
        self.assertGreater(long[BOX.name, "default"]["frames_per_round"], 2 * short[BOX.name, "default"]["frames_per_round"])

    def test_a_tree_is_many_times_faster_than_none(self):
        scene = SCENES / "mesh-15743.gltf"
        _, found = self.frame("--quiet", "--rounds", 3, "--round-time", 0.1, "--resolution", "64,64", "--stage", "flat", "--config", "loop=--traversal iterative",
                              scenes=[scene])
        self.assertGreater(found[scene.name, "loop"]["ratio"]["median"], 20)

    def test_samples_can_be_draws_of_their_own(self):
        _, found = self.frame(*QUICK, "--spp", 4, "--samples-per-draw", 1)
        self.assertEqual(found[BOX.name, "default"]["samples_per_draw"], 1)
        self.assertTrue(found[BOX.name, "default"]["picture"]["right"])

    def test_different_stages_are_different_pictures_and_both_are_right(self):
        _, found = self.frame(*QUICK, "--config", "flat=--stage flat", "--config", "heat=--debug-view visits",
                              "--config", "loop=--stage flat --traversal iterative")
        self.assertTrue(all(line["picture"]["right"] for line in found.values()))


class FramePictures(Frame):
    def test_a_reference_of_the_same_light_is_met_and_another_fails(self):
        size = ["--quiet", "--resolution", "64,64"]
        good, bad, layers = (self.folder / name for name in ("good.pfm", "bad.pfm", "layers.exr"))
        self.renders(BOX, "-o", good, *size, "--spp", 1024, "--seed", 9)
        self.renders(BOX, "-o", bad, *size, "--spp", 1024, "--seed", 9, "--bounces", 1)
        self.renders(BOX, "-o", layers, *size, "--spp", 64, "--seed", 9, "--aov", "samples,variance")
        for reference in (good, layers):
            _, found = self.frame(*size, "--rounds", 1, "--spp", 16, "--configs", "default,random", "--reference", reference)
            for line in found.values():
                self.assertEqual(line["picture"]["against"], reference.name)
        result, found = self.frame(*size, "--rounds", 1, "--spp", 16, "--config", "dark=--bounces 1", "--reference", bad, status=1)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        for text in ("wrong picture", "cornell-box.gltf, default", "bad.pfm"):
            self.assertIn(text, result.stderr)
        self.assertNotIn("dark", result.stderr)
        self.assertIn("WRONG", result.stdout)
        self.assertFalse(found[BOX.name, "default"]["picture"]["right"])
        self.assertTrue(found[BOX.name, "dark"]["picture"]["right"])

    def test_a_shader_that_loses_hits_in_one_traversal_fails_without_a_reference(self):
        shaders = self.folder / "shaders"
        shutil.copytree(SHADERS, shaders)
        text = (shaders / "integrators/camera.glsl").read_text()
        self.assertIn("Path hit(Path p) {", text)
        (shaders / "integrators/camera.glsl").write_text(
            text.replace("Path hit(Path p) {", "Path hit(Path p) {\n  if (kFrontToBack && p.hit.slot == 0) p.throughput *= 0.0;"))
        result, _ = self.frame(*QUICK, "--spp", 4, "--traversal", "front-to-back", "--shader-folder", shaders, status=1)
        self.assertIn("although their samples are the same", result.stderr)

    def test_references_that_cannot_be_used(self):
        small = self.folder / "small.pfm"
        self.renders(BOX, "-o", small, "--quiet", "--resolution", "9,8", "--spp", 1)
        self.fails(3, "bench", "frame", BOX, *QUICK, "--reference", small, says=["small.pfm", "default"])
        self.fails(3, "bench", "frame", BOX, *QUICK, "--reference", self.folder / "none.exr", says=["none.exr"])
        self.fails(2, "bench", "frame", BOX, SCENES / "sphere-phong.gltf", *QUICK, "--reference", small, says=["--reference"])
        # The command fails before it measures anything, which would take hours here.
        for bad in (small, self.folder / "none.exr"):
            self.fails(3, "bench", "frame", BOX, "--quiet", "--rounds", 100000, "--reference", bad, says=[bad.name], timeout=60)


class FrameBaseline(Frame):
    def baseline(self, found, factor):
        """A file in which all was faster by a factor."""
        path = self.folder / "before.json"
        for line in found.values():
            line["frame_ms"]["median"] /= factor
        path.write_text("".join(json.dumps(line) + "\n" for line in found.values()))
        return path

    def test_what_got_slower_is_said_and_gives_1(self):
        options = [*QUICK, "--spp", 4]
        _, found = self.frame(*options, "--configs", "default,random")
        result, _ = self.frame(*options, "--configs", "default", "--baseline", self.baseline(found, 100), status=1)
        self.assertIn("SLOWER", result.stdout)
        self.assertIn("--disable sobol --resolution 16,16 --spp 4: only in the baseline", result.stdout)
        result, _ = self.frame(*options, "--configs", "default", "--baseline", self.baseline(found, 1e-4))
        self.assertNotIn("SLOWER", result.stdout)
        result, _ = self.frame(*options, "--configs", "default", "--bounces", 2, "--baseline", self.baseline(found, 1e6), status=3)
        self.assertIn("not in the baseline", result.stdout)
        self.assertIn("none of these settings", result.stderr)

    def test_another_scene_of_the_same_name_and_lines_that_are_none(self):
        _, found = self.frame(*QUICK, "--spp", 4)
        for line in found.values():
            line["triangles"] += 1
        result, _ = self.frame(*QUICK, "--spp", 4, "--baseline", self.baseline(found, 1), status=3)
        self.assertIn("has another number of triangles", result.stdout)
        bad = self.folder / "bad.json"
        for text, says in (("{]", "line 1 is none of `bench frame --json`: no JSON from its character 2 on"),
                           ('{"schema": 1}', "a member is missing"), ('{"schema": 7}', 'its "schema" is not 1')):
            bad.write_text(text)
            self.fails(3, "bench", "frame", BOX, *QUICK, "--baseline", bad, says=[says])

    def test_a_tolerance_that_is_no_number_and_pictures_of_two_sizes(self):
        self.fails(2, "bench", "frame", BOX, *QUICK, "--tolerance", "nan", says=["--tolerance"])
        self.fails(2, "bench", "frame", BOX, *QUICK, "--config", "big=--resolution 9,9", says=["'big'", "size"])

    def test_files_that_are_no_baseline(self):
        for text in ("", "nonsense\n", "{\"schema\": 2}\n"):
            path = self.folder / "b.json"
            path.write_text(text)
            self.fails(3, "bench", "frame", BOX, *QUICK, "--baseline", path, says=["b.json"])
        self.fails(3, "bench", "frame", BOX, *QUICK, "--baseline", self.folder / "none.json", says=["none.json"])
        before = path.read_bytes()
        self.fails(2, "bench", "frame", BOX, *QUICK, "--baseline", path, "--json", path, says=["--json"])
        self.assertEqual(path.read_bytes(), before)


class FrameRefusals(Frame):
    def test_options_that_make_no_sense(self):
        for options, says in ((["--noise", "0.1"], "--noise"), (["--time", "1"], "default"), (["--configs", "adaptive"], "adaptive"),
                              (["--rounds", "0"], "rounds"), (["--round-time", "0"], "round-time"), (["--tolerance", "-1"], "tolerance"),
                              (["--samples-per-draw", "0"], "samples-per-draw"), (["--stats", self.folder / "s.json"], "--stats"),
                              (["--config", "a=--nonsense"], "nonsense")):
            with self.subTest(options):
                self.fails(2, "bench", "frame", BOX, *QUICK, *options, says=[says])
        self.fails(2, "bench", "frame", BOX, BOX, *QUICK, says=["twice"])
        self.fails(2, "bench", "frame", says=["scenes"])
        self.fails(3, "bench", "frame", self.folder / "none.gltf", *QUICK, says=["none.gltf"])

    def test_outputs_are_checked_before_work(self):
        began = time.monotonic()
        self.fails(1, "bench", "frame", BOX, "--quiet", "--rounds", 10000, "--json", self.folder / "no" / "b.json", says=["b.json"])
        self.assertLess(time.monotonic() - began, 20)
        picture = self.folder / "graticule.png"
        for name in ("sphere-textured.gltf", "graticule.png"):
            (self.folder / name).write_bytes((SCENES / name).read_bytes())
        before = picture.read_bytes()
        self.fails(2, "bench", "frame", self.folder / "sphere-textured.gltf", *QUICK, "--json", picture, says=["--json"])
        self.assertEqual(picture.read_bytes(), before)


class BenchFrameInterruption(Frame):
    def test_ctrl_c_writes_nothing_and_gives_130(self):
        for command in ("frame", "traversal"):
            self.interrupts("bench", command, BOX, "--quiet", "--resolution", "64,64", "--rounds", 10000, "--json", self.folder / "b.json")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Tests of a run's beginning and end: checks before the first sample, finished pictures that are not lost, standard streams, the
words of refusals, what `info` names, and what surrounds a scene."""
import json
import os
import re
import resource
import shutil
import signal
import struct
import subprocess
from pathlib import Path

from support import FRAGTRACE, SCENES, SMALL, Case, Gltf, main, read_pfm, run

BOX = SCENES / "cornell-box.gltf"
# A run that is not refused at once meets the time limit.
ENDLESS = ["--resolution", "64,64", "--spp", "500000000", "--quiet"]
WORKER = "fragtrace_worker"


class BeforeTheFirstSample(Case):
    def refused(self, name, *says, program=FRAGTRACE, **options):
        result = subprocess.run([program, "render", BOX, "-o", self.folder / name, *ENDLESS], capture_output=True, text=True,
                                timeout=30, **options)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        for text in (f"cannot write {self.folder / name}", *says):
            self.assertIn(text, result.stderr)
        self.assertFalse((self.folder / name).exists())

    def test_an_image_library_that_is_not_there_is_missed(self):
        shutil.copy(FRAGTRACE, self.folder / "fragtrace")
        environment = {k: v for k, v in os.environ.items() if k != "FRAGTRACE_LIBRARY_PATH"}
        self.refused("x.png", f"{WORKER} is not in", program=self.folder / "fragtrace", env=environment)

    def test_one_that_ends_is_seen(self):
        (self.folder / WORKER).write_text("#!/bin/sh\nexit 7\n")
        (self.folder / WORKER).chmod(0o755)
        self.refused("x.exr", "status 7", env={**os.environ, "FRAGTRACE_LIBRARY_PATH": str(self.folder)})

    def test_there_is_room_for_the_file(self):
        # Mesa's cache of shaders would not get its files either.
        environment = {**os.environ, "MESA_SHADER_CACHE_DISABLE": "true"}
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (10000, 10000))
        self.refused("x.png", "ulimit -f", preexec_fn=limit, env=environment)


class AtTheEnd(Case):
    def lost(self, name, *options):
        """A render of three seconds whose image library is gone when it ends."""
        for program in ("fragtrace", WORKER, "libfragtrace_pictures.so"):
            shutil.copy(FRAGTRACE.parent / program, self.folder / program)
        with subprocess.Popen([self.folder / "fragtrace", "render", BOX, "-o", self.folder / name, "--resolution", "16,12",
                               "--time", "3", *options], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                              env={**os.environ, "FRAGTRACE_LIBRARY_PATH": str(self.folder)}) as process:
            self.assertIn(" lights it", process.stderr.readline())
            self.assertIn("rendering", process.stderr.readline())
            (self.folder / WORKER).unlink()
            children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
            for child in children:
                os.kill(int(child), 9)
            self.assertEqual(len(children), 1)
            output, error = process.communicate(timeout=60)
        self.assertEqual((process.returncode, output), (1, ""))
        self.assertFalse((self.folder / name).exists())
        return error.splitlines()[-1]

    def test_a_finished_film_is_written_as_pfm_and_what_is_lost_is_said(self):
        (self.folder / "x.pfm").write_bytes(b"Pf\n1 1\n-1.0\n" + struct.pack("<f", 1))
        said = self.lost("x.exr", "--aov", "albedo,samples", "--no-background")
        for text in ("cannot write", "x.exr", "image library failed", "the radiance alone is in", "x-2.pfm", "albedo", "samples", "alpha", "merge"):
            self.assertIn(text, said)
        self.assertGreater(sum(map(sum, sum(read_pfm(self.folder / "x-2.pfm"), []))), 0)
        self.assertEqual((self.folder / "x.pfm").stat().st_size, 16)

    def test_a_folder_that_is_gone_is_said_once(self):
        folder = self.folder / "gone"
        folder.mkdir()
        with subprocess.Popen([FRAGTRACE, "render", BOX, "-o", folder / "x.exr", "--resolution", "16,12", "--time", "9"],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            self.assertIn(" lights it", process.stderr.readline())
            self.assertIn("rendering", process.stderr.readline())
            folder.rmdir()
            process.send_signal(signal.SIGINT)
            output, error = process.communicate(timeout=60)
        self.assertEqual((process.returncode, output), (1, ""))
        self.assertEqual(error.count("No such file or directory"), 1, error)
        self.assertIn("nor as .pfm", error)

    def test_layers_are_in_the_time_left(self):
        """Six layers of 64 samples take longer than what is left of two seconds."""
        layers = "albedo,normal,depth,geometric-normal,roughness,texcoords"
        with subprocess.Popen([FRAGTRACE, "render", BOX, "-o", self.folder / "x.exr", "--resolution", "1000,800", "--time", "2",
                               "--stage", "flat", "--aov", layers], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as process:
            said = re.fullmatch(r"rendering: \d+ %, (\d+):(\d\d) left\n", process.stderr.readline())
            process.kill()
        self.assertGreater(60 * int(said[1]) + int(said[2]), 2)

    def test_what_filters_read_is_in_the_time_left_with_its_few_samples(self):
        stats = self.folder / "s.json"
        said = self.renders(BOX, "-o", self.folder / "x.exr", "--resolution", "400,300", "--time", "1", "--denoise", "variance", "--progress", "json",
                            "--stats", stats).stderr
        events = [event for event in map(json.loads, said.splitlines()) if event.get("phase") == "rendering" and event["fraction"] < 1]
        taken = json.loads(stats.read_text())["feature_ms"] / 1000
        self.assertLess(events[-1]["seconds_left"] - (1 - events[-1]["fraction"]), 0.5 + 6 * taken)


class StandardStreams(Case):
    def test_closed_ones_take_nothing_from_the_picture(self):
        path = self.folder / "x.png"
        for closed in (">&-", "<&-", "<&- >&-", "<&- >&- 2>&-"):
            result = subprocess.run(["bash", "-c", f'exec "$0" "$@" {closed}', FRAGTRACE, "render", BOX, "-o", path, "--resolution",
                                     "16,16", "--spp", "1", "--quiet"], capture_output=True)
            self.assertEqual((result.returncode, result.stderr), (0, b""), closed)
            self.assertTrue(path.read_bytes().startswith(b"\x89PNG"))
            path.unlink()

    def test_a_result_for_a_closed_one_is_an_error(self):
        tiny = ["--resolution", "8,8", "--spp", "1", "--quiet"]
        for words in (["info", BOX], ["render", BOX, "-o", "-", "--format", "png", *tiny], ["render", BOX, "-o", self.folder / "x.pfm", *tiny, "--stats", "-"],
                      ["bench", "frame", BOX, "--stage", "flat", "--rounds", "1", "--round-time", "0.01", *tiny]):
            result = subprocess.run(["bash", "-c", 'exec "$0" "$@" >&-', FRAGTRACE, *words], capture_output=True, text=True)
            self.assertEqual(result.returncode, 1, words)
            self.assertIn("standard output", result.stderr)

    def test_statistics_go_to_standard_output_alone(self):
        result = self.renders(BOX, "-o", self.folder / "x.pfm", "--resolution", "16,16", "--spp", "1", "--stats", "-", cwd=self.folder)
        self.assertEqual(json.loads(result.stdout)["width"], 16)
        self.assertIn("16 x 16", result.stderr)
        self.assertEqual([path.name for path in self.folder.iterdir()], ["x.pfm"])

    def test_nothing_else_writes_a_file_of_that_name(self):
        for command in (["bench", "frame", BOX, "--json", "-"], ["bench", "stress", "--json", "-"], ["bench", "error", BOX, "--json", "-"],
                        ["view", BOX, "--status-file", "-"]):
            self.fails(2, *command, says=[command[-2], "'-'"], cwd=self.folder)
        self.assertEqual(list(self.folder.iterdir()), [])


class Words(Case):
    def refused(self, *options, says):
        self.fails(2, "render", BOX, "-o", self.folder / "x.pfm", *SMALL[:2], *options, says=says)

    def test_a_number_that_is_not_whole_is_quoted(self):
        for option in ("--spp", "--seed", "--rr-depth", "--camera-index", "--texture-limit"):
            self.refused(option, "1e3", says=[option, "'1e3'", "whole number"])

    def test_only_a_resolution_may_be_written_with_an_x(self):
        for option, word in (("--seed", "0x10"), ("--spp", "1x2")):
            self.refused(option, word, says=[f"{option}: '{word}' is no whole number"])
        self.fails(2, "diff", BOX, BOX, "--threshold", "nan", says=["--threshold", "not a finite number"])

    def test_a_memory_limit_says_the_least_that_is_possible(self):
        for size in ("0", "-5MB", "1", "nonsense", "999999"):
            self.refused("--memory-limit", size, says=["--memory-limit", f"'{size}'", "from 1MB on"])
        self.renders(BOX, "-o", self.folder / "x.pfm", *SMALL, "--memory-limit", "1MB")

    def test_a_memory_limit_bounds_the_film(self):
        self.fails(2, "render", BOX, "-o", self.folder / "x.pfm", "--resolution", "16384,2000", "--spp", "1", "--memory-limit", "1GB",
                   says=["16384 x 2000", "drawn in parts", "more than the 1000 MB of --memory-limit"])

    def test_an_option_that_is_not_there_is_named_with_the_one_that_was_meant(self):
        for wrong, meant in (("--samples", "--spp"), ("--sample-ofset", "--sample-offset"), ("--hdri=x", "--hdri-file")):
            self.refused(wrong, "16", says=[wrong.split("=")[0] + " is no option of render", f"did you mean {meant}?"])
        self.refused("--nonsense", says=["--nonsense is no option of render"])

    def test_a_command_that_is_not_there_is_named_with_those_that_are(self):
        self.fails(2, "bench", "foo", says=["'foo'", "error", "frame", "stress"])
        self.fails(2, "foo", says=["'foo'", "render", "bench"])
        self.fails(2, says=["fragtrace needs a command: render, view"])
        self.fails(2, "bench", says=["bench needs a command: error, frame"])

    def test_a_wrong_number_of_values_is_told(self):
        self.refused("--camera-position", "3", says=["--camera-position: takes 3 values, not 1"])
        self.refused("--seed", says=["--seed: its value is missing"])

    def test_a_size_in_a_config_file_may_be_written_as_people_do(self):
        config = self.folder / "c.json"
        for size in ("64x48", "64,48", [64, 48]):
            config.write_text(json.dumps({"resolution": size, "spp": 1}))
            self.renders(BOX, "-o", self.folder / "x.pfm", "--quiet", "--config", config)
            picture = read_pfm(self.folder / "x.pfm")
            self.assertEqual((len(picture[0]), len(picture)), (64, 48))

    def test_little_memory_is_what_is_said_to_have_run_out(self):
        for scene in (BOX, SCENES / "sphere-textured.gltf"):
            for kilobytes in (400000, 600000):  # the second may suffice; a thread more than there is room for may not
                result = subprocess.run(["bash", "-c", f'ulimit -v {kilobytes}; exec "$0" "$@"', FRAGTRACE, "render", scene, "-o",
                                         self.folder / "x.png", *SMALL], capture_output=True, text=True)
                if kilobytes == 600000 and result.returncode == 0:
                    continue
                self.assertIn(result.returncode, (1, 3), result.stderr)
                self.assertIn("memory", result.stderr)
                self.assertNotIn("signal", result.stderr)


class Parts(Case):
    """`info` names the parts of a scene, and a camera can be chosen by its name."""

    def setUp(self):
        super().setUp()
        scene = json.loads(BOX.read_text())
        scene["scenes"][0].pop("name", None)
        scene["scenes"][0]["nodes"].append(len(scene["nodes"]))
        scene["nodes"].append({"camera": 1, "translation": [0, 0, 4]})
        scene["cameras"][0]["name"] = "Front"
        scene["cameras"].append({"name": "2x2", "type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0.1, "zfar": 9}})
        gltf = Gltf(scene)
        gltf.moves(0, [0.25, 2.5], rotation=[(0, 0, 0, 1)] * 2)["name"] = "turn"
        self.scene = gltf.write(self.folder / "scene.gltf")

    def test_info_names_them_all(self):
        text = run("info", self.scene).stdout
        self.assertIn('cameras     2: 0 "Front" (perspective), 1 "2x2" (orthographic)', text)
        self.assertIn('animations  1: 0 "turn" (2.5 s: --frames 0:59)', text)
        self.assertIn("scenes      1: 0 unnamed", text)
        data = json.loads(run("info", "--json", self.scene).stdout)
        self.assertEqual(data["animations"], [{"name": "turn", "duration_s": 2.5}])
        self.assertEqual(data["cameras"], [{"name": "Front", "type": "perspective"}, {"name": "2x2", "type": "orthographic"}])

    def test_a_camera_may_be_named(self):
        def picture(*options):
            path = self.folder / "x.pfm"
            self.renders(self.scene, "-o", path, *SMALL, "--stage", "flat", *options)
            return path.read_bytes()
        self.assertEqual(picture("--camera", "2x2"), picture("--camera-index", 1))
        self.assertEqual(picture("--camera", "1"), picture("--camera-index", 1))
        self.assertEqual(picture("--camera", "Front"), picture())
        self.assertNotEqual(picture("--camera", "2x2"), picture())
        self.fails(2, "render", self.scene, "-o", self.folder / "y.pfm", *SMALL, "--camera", "Back",
                   says=["--camera", '"Back"', '0 "Front", 1 "2x2"'])
        self.fails(2, "render", self.scene, "-o", self.folder / "y.pfm", *SMALL, "--camera", "Front", "--camera-index", 1,
                   says=["--camera"])


class Surroundings(Case):
    SPHERE = SCENES / "environment-diffuse.gltf"

    def test_a_colour_beside_an_environment_is_what_camera_rays_see_and_lights_nothing(self):
        options = ["--hdri-file", SCENES / "sky.pfm", "--resolution", "32,32", "--spp", "4"]
        sky = self.picture("environment-diffuse", "sky.pfm", *options)
        colour = self.picture("environment-diffuse", "colour.pfm", *options, "--background-color", "0.25,0.5,1")
        none = self.picture("environment-diffuse", "none.exr", *options, "--no-background")
        seen = {0: 0, 1: 0}
        for y in range(32):
            for x in range(32):
                alpha = none.pixel(x, y, "A")[0]
                if alpha in seen:
                    seen[alpha] += 1
                    self.assertEqual(colour[y][x], sky[y][x] if alpha else (0.25, 0.5, 1))
        self.assertGreater(min(seen.values()), 50, seen)
        black = self.picture("environment-diffuse", "black.pfm", *options, "--background-color", "0,0,0")
        self.assertEqual(black[0][0], (0, 0, 0))

    def test_a_square_environment_is_warned_of(self):
        for width, is_said in ((4, True), (8, False), (1, False)):
            path = self.folder / "map.hdri"
            height = min(width, 4)
            path.write_bytes(b"PF\n%d %d\n-1.0\n" % (width, height) + struct.pack("<3f", 1, 1, 1) * width * height)
            result = self.renders(self.SPHERE, "-o", self.folder / "x.pfm", "--resolution", "16,16", "--spp", "1", "--hdri-file", path,
                                  "--stats", self.folder / "s.json")
            self.assertEqual("is square, and drawn as latitude and longitude" in result.stderr, is_said, result.stderr)
            self.assertEqual(len(json.loads((self.folder / "s.json").read_text())["warnings"]), int(is_said))


if __name__ == "__main__":
    main()

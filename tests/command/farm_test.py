#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Renders cut into parts: what scripts/farm_parts prints, and GNU parallel with a worker that is killed."""
import os
import shlex
import signal
import subprocess
import time
from pathlib import Path

from support import FRAGTRACE, SCENES, Case, Exr, main

SCRIPTS = SCENES.parent / "scripts"
BOX = SCENES / "cornell-box.gltf"


class Farm(Case):
    def script(self, name, *words, **environment):
        return subprocess.Popen([SCRIPTS / name, *map(str, words)], env={**os.environ, "FRAGTRACE": str(FRAGTRACE), **environment}, cwd=self.folder,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def parts(self, *words, status=0):
        process = self.script("farm_parts", *words)
        out, error = process.communicate(timeout=60)
        self.assertEqual(process.returncode, status, error)
        return out.splitlines() if status == 0 else error

    def worker(self):
        """The process of the second part of x.exr, once it has a checkpoint."""
        part = b"x.exr.parts/0001.exr"
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline:
            for entry in Path("/proc").iterdir():
                try:
                    words = (entry / "cmdline").read_bytes().split(b"\0") if entry.name.isdigit() else []
                    mine = entry.name.isdigit() and (entry / "cwd").resolve() == self.folder.resolve()
                except OSError:
                    continue
                if mine and words[0] == os.fsencode(FRAGTRACE) and b"render" in words and part in words:
                    if (self.folder / (os.fsdecode(part) + ".checkpoint")).exists():
                        return int(entry.name)
            time.sleep(0.02)
        self.fail("no worker")


class FarmParts(Farm):
    def test_a_picture_is_cut_into_ranges_of_samples(self):
        *lines, join = self.parts(3, "render", "a scene.gltf", "-o", "x.exr", "--spp=10", "--seed", 4, "--sample-offset", 100)
        ranges = []
        for number, line in enumerate(lines):
            words = shlex.split(line)
            self.assertEqual(words[:5], [str(FRAGTRACE), "render", "a scene.gltf", "--seed", "4"])
            option = dict(zip(words, words[1:]))
            self.assertEqual(option["-o"], f"x.exr.parts/{number:04}.exr")
            self.assertIn("--resume", words)
            ranges.append((int(option["--sample-offset"]), int(option["--spp"])))
        self.assertEqual(ranges, [(100, 3), (103, 3), (106, 4)])
        self.assertIn("merge x.exr.parts/0000.exr x.exr.parts/0001.exr x.exr.parts/0002.exr -o x.exr && rm", join)
        self.assertEqual(option["--checkpoint"], "30")
        self.assertIn("--checkpoint 5 ", self.parts(2, "render", "s", "-o", "x.exr", "--spp", 2, "--checkpoint=5")[0])
        # No part is empty.
        self.assertEqual(len(self.parts(9, "render", "s", "-o", "x.exr", "--spp", 2)), 3)

    def test_a_film_is_cut_into_ranges_of_frames(self):
        lines = self.parts(3, "render", "s.glb", "-o", "f.##.png", "--frames", "2:20:3", "--fps", 12)
        self.assertEqual([shlex.split(line)[-2] for line in lines[:-1]], ["2:5:3", "8:11:3", "14:20:3"])
        self.assertEqual(lines[-1], "true")
        self.assertTrue(all(shlex.split(line)[-1] == "--continue" for line in lines[:-1]))

        for frames, ranges in (([], ["0:2:1", "3:6:1"]), (["--frames", "2:5"], ["2:3:1", "4:5:1"])):
            lines = self.parts(2, "render", "s.glb", "-o", "f.##.png", "--turntable", 7, *frames)
            self.assertEqual([shlex.split(line)[-2] for line in lines[:-1]], ranges)
            self.assertTrue(all("--turntable 7 " in line for line in lines[:-1]))

    def test_what_cannot_be_cut(self):
        for words, says in (((0, "render", "s", "-o", "x.exr", "--spp", 4), "PARTS"), ((2, "render", "s", "-o", "x.exr"), "--spp"),
                            ((2, "render", "s", "--spp", 4), "-o"), ((2, "render", "s", "-o", "x.png", "--spp", 4), ".exr"),
                            ((2, "render", "s", "-o", "x.exr", "--spp", 4, "--noise", 0.1), "--noise"),
                            ((2, "render", "s", "-o", "x.##.exr", "--turntable", "x"), "turntable"), ((2, "render", "s", "-o", "x.exr", "--spp"), "--spp"),
                            ((2, "render", "s", "-o", "x.##.exr", "--frames", "4"), "--frames"), ((2, "view", "s", "-o"), "PARTS")):
            self.assertIn(says, self.parts(*words, status=2))
        self.assertEqual(list(self.folder.iterdir()), [])


class FarmParallel(Farm):
    SIZE = ["--resolution", "64,48", "--spp", 900]
    OFTEN = ["--checkpoint", 0.1]

    def test_a_worker_that_is_killed_costs_nothing_but_time(self):
        def joined(kill):
            process = self.script("farm_parallel", 3, "render", BOX, "-o", "x.exr", "--quiet", *self.SIZE, *self.OFTEN, JOBS="2")
            if kill:
                os.kill(self.worker(), signal.SIGKILL)
            out, error = process.communicate(timeout=120)
            self.assertEqual(process.returncode, 0, out + error)
            self.assertIn("3 parts, 900 samples per pixel", out)
            self.assertEqual([p.name for p in self.folder.iterdir()], ["x.exr"])
            return (self.folder / "x.exr").read_bytes()
        self.assertEqual(joined(True), joined(False))
        merged = Exr(self.folder / "x.exr")
        self.renders(BOX, "-o", self.folder / "whole.exr", "--quiet", *self.SIZE)
        for a, b in zip(merged.values("G"), Exr(self.folder / "whole.exr").values("G")):
            self.assertAlmostEqual(a, b, delta=2e-6 * max(1, b))

    def test_a_part_that_fails_is_said_and_goes_on_later(self):
        words = (2, "render", "scene.gltf", "-o", "x.exr", "--quiet", "--resolution", "16,16", "--spp", 4)
        process = self.script("farm_parallel", *words)
        self.assertIn("not all of 2 parts are finished", process.communicate(timeout=120)[1])
        self.assertEqual(process.returncode, 1)
        self.assertFalse((self.folder / "x.exr").exists())
        (self.folder / "scene.gltf").write_bytes((SCENES / "furnace.gltf").read_bytes())
        for path in SCENES.glob("furnace*"):
            (self.folder / path.name).write_bytes(path.read_bytes())
        process = self.script("farm_parallel", *words)
        out, error = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 0, out + error)
        self.assertTrue((self.folder / "x.exr").exists())


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`cmake --install` gives a program that runs from anywhere, and docs/options.md is what --help says."""
import os
import subprocess

from support import FRAGTRACE, SCENES, Case, main

BUILD = FRAGTRACE.parent


class Installed(Case):
    def test_it_draws_the_same_from_another_folder(self):
        prefix = self.folder / "usr"
        subprocess.run(["cmake", "--install", BUILD, "--prefix", prefix], check=True, capture_output=True)
        away = self.folder / "away"
        away.mkdir()
        options = [SCENES / "coverage.gltf", "--resolution", "16,16", "--spp", "1", "--quiet", "-o"]
        environment = {**os.environ, "PATH": f"{prefix}/bin:{os.environ['PATH']}"}
        subprocess.run(["fragtrace", "render", *options, "x.png"], cwd=away, env=environment, check=True)
        subprocess.run([FRAGTRACE, "render", *options, away / "y.png"], check=True)
        self.assertEqual((away / "x.png").read_bytes(), (away / "y.png").read_bytes())

    def test_its_folders_are_below_destdir(self):
        environment = {**os.environ, "DESTDIR": str(self.folder / "stage")}
        subprocess.run(["cmake", "--install", BUILD, "--prefix", "/usr"], check=True, capture_output=True, env=environment)
        program = self.folder / "stage/usr/bin/fragtrace"
        self.assertTrue(program.is_symlink())
        self.assertTrue(program.resolve().is_relative_to((self.folder / "stage").resolve()))
        version = subprocess.run([program, "--version"], check=True, capture_output=True, text=True).stdout
        self.assertRegex(version, r"^fragtrace \d+\.\d+\.\d+( \([0-9a-f]+(-dirty)?\))?\n$")


class OptionReference(Case):
    def test_it_is_what_the_help_says(self):
        result = subprocess.run([SCENES.parent / "scripts/option_reference", "--check", FRAGTRACE], capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)


if __name__ == "__main__":
    main()

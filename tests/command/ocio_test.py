#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Views of OpenColorIO configurations: against closed forms, and against OpenImageIO's own oiiotool where it is installed (apt-get install openimageio-tools), also for
the configurations that FRAGTRACE_OCIO_CONFIGS names, separated by ':'."""
import os
import re
import shutil
import struct
import subprocess
import unittest

from support import SCENES, Case, Exr, main, read_png, run, write_exr

# The table doubles values up to 0.5. "wide" has another name for linear Rec. 709 than the usual ones.
CONFIG = """ocio_profile_version: 2
search_path: luts
strictparsing: true
roles: {{default: plain, scene_linear: plain}}
displays:
  Screen:
    - !<View> {{name: Root, colorspace: root}}
    - !<View> {{name: Table, colorspace: table}}
    - !<View> {{name: Dim root, colorspace: root, looks: dim}}
  Print:
    - !<View> {{name: Plain, colorspace: plain}}
active_displays: [Screen, Print]
looks:
  - !<Look> {{name: dim, process_space: plain, transform: !<MatrixTransform> {{matrix: [0.25, 0, 0, 0, 0, 0.25, 0, 0, 0, 0, 0.25, 0, 0, 0, 0, 1]}}}}
colorspaces:
  - !<ColorSpace> {{name: plain{aliases}}}
  - !<ColorSpace> {{name: root, from_scene_reference: !<ExponentTransform> {{value: [0.5, 0.5, 0.5, 1]}}}}
  - !<ColorSpace> {{name: table, from_scene_reference: !<FileTransform> {{src: twice.spi1d}}}}
"""
TWICE = "Version 1\nFrom 0.0 0.5\nLength 2\nComponents 1\n{\n0.0\n1.0\n}\n"
PICTURE = ["--resolution", "24,16", "--spp", "4", "--quiet", "--exposure", "0"]
STEP = 1 / 65535  # of a .png of 16 bits


def clamped(value):
    return min(max(value, 0.0), 1.0)


def levels(path):
    """All values of a .png of 16 bits with three channels, in one list."""
    width, height, rows, step = read_png(path)
    assert step == 6, path
    return [value for row in rows for value in struct.unpack(f">{3 * width}H", row)]


def views_of(config):
    """Yields each view of a configuration, as oiiotool knows it: the name of linear Rec. 709, display, view."""
    said = subprocess.run(["oiiotool", "--colorconfig", config, "--help"], capture_output=True, text=True).stdout
    spaces = re.findall('"([^"]*)"', re.search("Known color spaces: (.*)", said)[1])
    space = next(name for name in ("plain", "Linear Rec.709", "Linear Rec.709 (sRGB)") if name in spaces)
    for display, views in re.findall(r'"([^"]*)"\*? \(views: ((?:"[^"]*"\*?(?:, )?)+)\)', re.search("Known displays: (.*)", said)[1]):
        yield from ((space, display, view) for view in re.findall('"([^"]*)"', views))


class OcioViews(Case):
    def config(self, aliases=", aliases: [lin_rec709]"):
        (self.folder / "luts").mkdir(exist_ok=True)
        (self.folder / "luts/twice.spi1d").write_text(TWICE)
        path = self.folder / "config.ocio"
        path.write_text(CONFIG.format(aliases=aliases))
        return path

    def linear(self, *options):
        path = self.folder / "linear.exr"
        if not path.exists():
            self.renders(SCENES / "room-ball.gltf", "-o", path, *PICTURE[:-2], *options)
        return path

    def shown(self, *options):
        """The levels of the picture as a view shows it."""
        path = self.folder / "shown.png"
        self.renders(SCENES / "room-ball.gltf", "-o", path, "--png-depth", "16", *PICTURE, *options)
        return levels(path)

    def is_map_of(self, options, curve):
        exr = Exr(self.linear())
        planes = [exr.values(name) for name in "RGB"]
        worst = max(abs(level * STEP - clamped(curve(planes[i % 3][i // 3]))) for i, level in enumerate(self.shown(*options)))
        self.assertLess(worst, 1.01 * STEP, options)

    def test_a_view_is_what_its_configuration_says(self):
        config = self.config()
        for options, curve in ((("Root",), lambda v: v ** 0.5), (("Table",), lambda v: 2 * min(v, 0.5)), (("Dim root",), lambda v: 0.5 * v ** 0.5),
                               (("Plain", "--ocio-display", "Print"), lambda v: v), (("Root", "--ocio-look", "dim"), lambda v: 0.5 * v ** 0.5),
                               (("Root", "--exposure", "-2"), lambda v: 0.5 * v ** 0.5)):
            self.is_map_of(["--ocio-config", config, "--ocio-view", *options], curve)

    def test_the_environment_names_a_configuration(self):
        shown = self.folder / "shown.png"
        words = [SCENES / "room-ball.gltf", "-o", shown, *PICTURE, "--ocio-view", "Root"]
        self.assertEqual(run("render", *words, env={**os.environ, "OCIO": str(self.config())}).returncode, 0)
        for value in ({}, {"OCIO": ""}):
            result = run("render", *words, env={**{k: v for k, v in os.environ.items() if k != "OCIO"}, **value})
            self.assertEqual(result.returncode, 3)
            self.assertIn("--ocio-view: no configuration is named (--ocio-config FILE, or $OCIO)", result.stderr)

    def test_another_name_of_linear_rec_709(self):
        config = self.config(aliases="")
        self.fails(3, "render", SCENES / "room-ball.gltf", "-o", self.folder / "a.png", *PICTURE, "--ocio-config", config, "--ocio-view", "Root",
                   says=["none of the usual names of linear Rec. 709 (--ocio-input)"])
        self.is_map_of(["--ocio-config", config, "--ocio-view", "Root", "--ocio-input", "plain"], lambda v: v ** 0.5)

    def test_names_that_are_not_there(self):
        """A message lists those that are, before anything is drawn; no file is written."""
        config, output = self.config(), self.folder / "a.png"
        broken = self.folder / "broken.ocio"
        broken.write_text("ocio_profile_version: 2\n}{")
        for words, says in ((["--ocio-view", "root"], "no view of the display 'Screen' called 'root'; it has: Root, Table, Dim root"),
                            (["--ocio-view", "Root", "--ocio-display", "TV"], "no display 'TV'; it has: Screen, Print"),
                            (["--ocio-view", "Root", "--ocio-look", "+dim, -x"], "no look 'x'; it has: dim"),
                            (["--ocio-view", "Root", "--ocio-input", "x"], "no colour space 'x'; it has: plain, root, table"),
                            (["--ocio-view", "Root", "--ocio-config", self.folder / "none.ocio"], "none.ocio"), (["--ocio-view", "Root", "--ocio-config", broken], "broken.ocio")):
            words = words if "--ocio-config" in words else [*words, "--ocio-config", config]
            self.fails(3, "render", SCENES / "room-ball.gltf", "-o", output, "--spp", "100000", *words, says=["--ocio-view: ", says])
            self.assertFalse(output.exists())
        (self.folder / "luts/twice.spi1d").unlink()
        self.fails(3, "render", SCENES / "room-ball.gltf", "-o", output, *PICTURE, "--ocio-config", config, "--ocio-view", "Table", says=["twice.spi1d"])

    def test_what_does_not_go_together(self):
        output, config = self.folder / "a.png", self.config()
        scene = SCENES / "room-ball.gltf"
        self.fails(2, "render", scene, "-o", output, "--ocio-display", "Screen", says=["--ocio-display: goes with --ocio-view"])
        self.fails(2, "diff", output, output, "--ocio-look", "dim", says=["--ocio-look: goes with --ocio-view"])
        self.fails(2, "diff", output, output, "--ocio-view", "Root", "--metric", "bias", says=["--ocio-view: --metric bias compares linear radiance"])
        self.fails(2, "render", scene, "-o", output, "--ocio-view", "Root", "--background-color", "white", says=["--ocio-view: not with --background-color"])
        view = ["--ocio-config", config, "--ocio-view", "Root"]
        result = self.renders(scene, "-o", output, *PICTURE[:4], "--tone-map", "agx", *view)
        self.assertIn("--tone-map: --ocio-view takes its place", result.stderr)
        result = self.renders(scene, "-o", self.folder / "a.exr", *PICTURE[:4], *view)
        self.assertIn("--ocio-view: changes .png and .jpg only", result.stderr)

    def test_alpha_stays(self):
        for view in ([], ["--ocio-config", self.config(), "--ocio-view", "Root"]):
            self.renders(SCENES / "sphere-plane.gltf", "-o", self.folder / "a.png", *PICTURE, "--no-background", "--png-depth", "16", *view)
            alpha = [row[at:at + 2] for row in read_png(self.folder / "a.png")[2] for at in range(6, len(row), 8)]
            self.assertEqual(alpha, first if view else alpha)
            first = alpha
        self.assertGreater(len(set(alpha)), 1)

    def test_a_denoised_picture(self):
        """What `denoise` shows of a picture is what `diff` shows of its .exr."""
        view = ["--ocio-config", self.config(), "--ocio-view", "Root"]
        noisy = self.linear("--aov", "denoising")
        for name in ("a.png", "a.exr"):
            result = run("denoise", noisy, "-o", self.folder / name, "--denoise", "variance", *(view if name == "a.png" else []), "--quiet")
            self.assertEqual(result.returncode, 0, result.stderr)
        result = run("diff", self.folder / "a.png", self.folder / "a.exr", *view, "--metric", "max")
        self.assertEqual((result.returncode, float(result.stdout.split()[0]), result.stderr), (0, 0.0, ""))
        plain = run("diff", self.folder / "a.png", self.folder / "a.exr", "--metric", "flip")
        self.assertGreater(float(plain.stdout.split()[0]), 0.01)
        self.assertEqual(float(run("diff", self.folder / "a.png", self.folder / "a.exr", *view, "--metric", "flip").stdout.split()[0]), 0.0)

    @unittest.skipUnless(shutil.which("oiiotool"), "there is no oiiotool")
    def test_as_oiiotool(self):
        """Each view of each display, of colours from dark to far beyond white."""
        colors = [tuple(2.0 ** (x - 7 + y * (c - 1)) for c in range(3)) for y in range(-3, 4) for x in range(14)]
        environment, shown, theirs = (self.folder / name for name in ("colors.exr", "shown.png", "theirs.png"))
        write_exr(environment, 14, 7, {name: [color[c] for color in colors] for c, name in enumerate("RGB")})
        scene = [SCENES / "sphere-plane.gltf", "--hdri-file", environment, "--stage", "flat", "--resolution", "28,14", "--spp", "1", "--camera-type", "panorama", "--quiet"]
        linear = self.folder / "linear.exr"
        self.renders(*scene, "-o", linear)
        for config in (str(self.config()), *filter(None, os.environ.get("FRAGTRACE_OCIO_CONFIGS", "").split(":"))):
            for space, display, view in views_of(config):
                subprocess.run(["oiiotool", "--colorconfig", config, linear, "--ch", "R,G,B", f"--ociodisplay:from={space}", display, view, "-d", "uint16", "-o", theirs],
                               check=True, capture_output=True)
                self.renders(*scene, "-o", shown, "--exposure", "0", "--png-depth", "16", "--ocio-config", config, "--ocio-display", display, "--ocio-view", view)
                self.assertLessEqual(max(abs(a - b) for a, b in zip(levels(shown), levels(theirs))), 1, (config, display, view))


if __name__ == "__main__":
    main()

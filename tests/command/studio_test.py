#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The built-in environment, and the backdrop that the camera sees instead of the environment map."""
import json
import math
import struct

from layers_test import View
from support import SCENES, Case, main, quad, read_pfm

MATT = {"pbrMetallicRoughness": {"metallicFactor": 0}, "extensions": {"KHR_materials_specular": {"specularFactor": 0}}}
EMPTY = ["--camera-position", "0,50,0", "--spp", "4"]  # far above the scene


class Studio(Case):
    def ground(self, *options):
        """Mean radiance of a white matt quad that faces +Z."""
        path = self.written("white.gltf", quad(MATT))
        rows = self.picture(str(path.with_suffix("")), "x.pfm", "--resolution", "16,16", "--spp", "64", "--studio", *options)
        return sum(pixel[1] for row in rows[6:10] for pixel in row[6:10]) / 16

    def test_a_white_surface_is_exposed_and_the_lights_turn(self):
        front = self.ground()
        self.assertAlmostEqual(front, 0.75, delta=0.03)
        self.assertLess(self.ground("--hdri-rotation", "180"), front - 0.03)

    def test_the_camera_sees_no_lamp(self):
        for towards in ("1,50.5,0", "-1,50.7,1", "0,50,-1", "0.3,51,0.5", "1,49.3,0.2"):
            rows = self.picture("sphere-plane", "x.pfm", "--studio", "--resolution", "16,16", *EMPTY, "--camera-focal-point", towards)
            values = [value for row in rows for pixel in row for value in pixel]
            self.assertLess(max(values), 0.35)
            self.assertGreater(min(values), 0.1)

    def test_it_can_be_hidden_and_is_told(self):
        stats = self.folder / "s.json"
        exr = self.picture("sphere-plane", "x.exr", "--studio", "--no-background", "--resolution", "16,16", "--spp", "1", "--stats", stats)
        self.assertEqual(exr.pixel(0, 0, "R", "A"), (0, 0))
        self.assertEqual(json.loads(exr.texts["fragtrace:settings"])["studio"], True)
        self.assertEqual(json.loads(stats.read_text())["default_light"], False)
        plain = self.picture("sphere-plane", "y.exr", "--resolution", "16,16", "--spp", "1")
        self.assertEqual(json.loads(plain.texts["fragtrace:settings"])["studio"], False)

    def test_it_lights_by_default_what_has_no_light_of_its_own(self):
        few = ["--resolution", "24,16", "--spp", "4"]
        for scene, option in (("furnace", "--studio"), ("cornell-box", None), ("furnace", "--no-default-light")):
            asked = ["--default-light", "studio"] if option != "--no-default-light" else ["--default-light", "none"]
            named = self.picture(scene, "named.pfm", *few, *([option] if option else []))
            self.assertEqual(named, self.picture(scene, "default.pfm", *few, *asked), (scene, option))
        by_default = self.picture("furnace", "x.exr", "--default-light", "studio", *few)
        self.assertEqual(json.loads(by_default.texts["fragtrace:settings"])["studio"], True)

    def test_refusals(self):
        scene = ["render", SCENES / "furnace.gltf", "-o", self.folder / "x.pfm", "--studio"]
        self.fails(2, *scene, "--hdri-file", SCENES / "sky.pfm", says=["--studio"])
        self.fails(2, *scene, "--background-blur", "3", says=["--background-blur"])


def linear_map(path, width=256):
    """Writes a map with green 1 + X and blue 1 + Y of the direction."""
    rows = []
    for y in reversed(range(width // 2)):
        polar = math.pi * (y + 0.5) / (width // 2)
        for x in range(width):
            around = 2 * math.pi * ((x + 0.5) / width - 0.5)
            rows += [1, 1 + math.sin(polar) * math.cos(around), 1 + math.cos(polar)]
    path.write_bytes(b"PF\n%d %d\n-1.0\n" % (width, width // 2) + struct.pack(f"<{len(rows)}f", *rows))
    return path


def mean_cosine(degrees, steps=20000):
    """Returns the factor by which a blur scales a function that is linear in the direction."""
    angles = [math.pi * (i + 0.5) / steps for i in range(steps)]
    weights = [math.exp(-0.5 * (angle / math.radians(degrees))**2) * math.sin(angle) for angle in angles]
    return sum(w * math.cos(angle) for w, angle in zip(weights, angles)) / sum(weights)


class BackgroundBlur(Case):
    def test_the_camera_sees_the_mean_by_angle(self):
        """With the rotation of the map; X of the map is seen along Z where it is turned by -90 degrees."""
        sky = linear_map(self.folder / "sky.pfm")
        scale = mean_cosine(25)
        for target in ((1, 50.4, 0.3), (0.2, 51, -0.4), (-1, 49.6, 0.5)):
            rows = self.picture("sphere-plane", "x.pfm", "--hdri-file", sky, "--hdri-rotation", "-90", "--background-blur", "25",
                                "--resolution", "12,12", *EMPTY, "--camera-focal-point", ",".join(map(str, target)), "--camera-view-angle", "40", "--camera-view-up", "0,1,0")
            view = View((0, 50, 0), target, 40, 12, 12)
            for y in range(12):
                for x in range(12):
                    d = view.through(x + 0.5, y + 0.5)
                    length = math.sqrt(sum(c * c for c in d))
                    for seen, expected in zip(rows[y][x], (1, 1 + scale * d[2] / length, 1 + scale * d[1] / length)):
                        self.assertAlmostEqual(seen, expected, delta=0.01)

    def test_the_light_stays_and_the_settings_tell(self):
        options = ["--hdri-file", SCENES / "sky.pfm", "--resolution", "24,24", "--spp", "4", "--aov", "albedo", "--no-background"]
        plain, blurred = (self.picture("environment-diffuse", f"{i}.exr", *options, *more) for i, more in enumerate(([], ["--background-blur", "9"])))
        for name in "RGBA":
            self.assertEqual(plain.layers[name], blurred.layers[name])
        self.assertEqual(json.loads(blurred.texts["fragtrace:settings"])["background_blur"], 9)
        shown = [self.picture("sphere-plane", f"{i}.pfm", "--hdri-file", SCENES / "sky.pfm", "--resolution", "24,24", "--spp", "4", *more)
                 for i, more in enumerate(([], ["--background-blur", "9"]))]
        self.assertNotEqual(shown[0][0], shown[1][0])
        self.assertEqual(shown[0][-1], shown[1][-1])  # the ground

    def test_refusals(self):
        for wrong in ("0.1", "nan", "100", "-1"):
            self.fails(2, "render", SCENES / "furnace.gltf", "-o", self.folder / "x.pfm", "--background-blur", wrong, says=["--background-blur"])


if __name__ == "__main__":
    main()

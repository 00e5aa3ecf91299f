#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""--f-stop: how wide a small lamp is blurred, and how much light stays, against the thin lens equation."""
import json
import math

from materials_test import quad
from support import SCENES, Case, main

ANGLE = 45
SIDE = 64
HALF = 0.2  # of the lamp, metres
DISTANCE = 4


class Lens(Case):
    def lamp(self, *options, spp=64):
        gltf = quad({"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}})
        gltf["materials"][0].update({"emissiveFactor": [1, 1, 1], "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 100}}})
        gltf["extensionsUsed"] = ["KHR_materials_emissive_strength"]
        gltf["nodes"][0]["scale"] = [HALF, HALF, 1]
        path = self.folder / "lamp.gltf"
        path.write_text(json.dumps(gltf))
        return self.picture(str(path.with_suffix("")), "x.pfm", "--resolution", f"{SIDE},{SIDE}", "--spp", spp, "--camera-position", f"0,0,{DISTANCE}",
                            "--camera-focal-point", "0,0,0", "--camera-view-angle", ANGLE, *options)

    def moments(self, picture):
        """Sum of red, its middle and its mean squared distance from there, pixels."""
        points = [(x + 0.5 - SIDE / 2, y + 0.5 - SIDE / 2, pixel[0]) for y, row in enumerate(picture) for x, pixel in enumerate(row)]
        total = sum(value for *_, value in points)
        middle = [sum(point[axis] * point[2] for point in points) / total for axis in (0, 1)]
        return total, middle, sum(((x - middle[0])**2 + (y - middle[1])**2) * value for x, y, value in points) / total

    def test_blur_and_light_are_those_of_a_thin_lens(self):
        sharp, middle, square = self.moments(self.lamp())
        stop, focus = 0.05, 2
        focal_length = 0.012 / math.tan(math.radians(ANGLE / 2))
        radius = 0.5 * focal_length / stop
        half_height = focus * math.tan(math.radians(ANGLE / 2))
        blur = radius * abs(DISTANCE - focus) / DISTANCE / half_height * SIDE / 2
        self.assertGreater(blur, 5)
        for blades, polar in ((0, 0.5), (4, 1 / 3), (6, 1 / 3 + 1 / 12)):
            options = ["--f-stop", stop, "--focus-distance", focus, *(["--aperture-blades", blades] if blades else [])]
            light, at, wide = self.moments(self.lamp(*options, spp=1024))
            print(f"{blades} blades: light {light / sharp - 1:+.3%}, square {(wide - square) / (polar * blur**2) - 1:+.3%}")
            # 60 pixels of lamp x 1,024 samples hit it, so that the standard errors are below 0.4 %, 0.7 % and 0.02 pixels.
            self.assertAlmostEqual(light / sharp, 1, delta=0.02)
            self.assertAlmostEqual((wide - square) / (polar * blur**2), 1, delta=0.02)
            self.assertLess(math.hypot(at[0] - middle[0], at[1] - middle[1]), 0.1)

    def test_what_is_in_focus_is_sharp(self):
        *_, square = self.moments(self.lamp())
        *_, same = self.moments(self.lamp("--f-stop", 0.05))  # the focal point is on the lamp
        self.assertAlmostEqual(same, square, delta=0.02)

    def test_a_wide_pinhole_is_no_lens(self):
        """At a huge f-number the picture is that of the pinhole, but for rounding."""
        plain, stopped = self.lamp(), self.lamp("--f-stop", "1e6")
        self.assertLess(max(abs(a[0] - b[0]) for one, other in zip(plain, stopped) for a, b in zip(one, other)), 0.02 * max(pixel[0] for row in plain for pixel in row))

    def test_wrong_use(self):
        scene = SCENES / "cornell-box.gltf"
        for options, text in ((["--focus-distance", "1"], "goes with --f-stop"), (["--aperture-blades", "5"], "goes with --f-stop"),
                              (["--f-stop", "0"], "--f-stop"), (["--f-stop", "nan"], "--f-stop"), (["--f-stop", "2", "--aperture-blades", "2"], "3 or more"),
                              (["--f-stop", "2", "--camera-parallel-scale", "1"], "orthographic")):
            self.fails(2, "render", scene, "-o", self.folder / "x.png", *options, says=[text])
        self.fails(2, "render", SCENES / "transforms.gltf", "-o", self.folder / "x.png", "--camera", "orthographic", "--f-stop", "2", says=["orthographic"])


if __name__ == "__main__":
    main()

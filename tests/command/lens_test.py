#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""--f-stop: how wide a small lamp is blurred, and how much light stays, against the thin lens equation."""
import math
import statistics

from support import SCENES, Case, main, quad

ANGLE = 45
SIDE = 64
HALF = 0.2  # half of the lamp's side, metres
DISTANCE = 4


class Lens(Case):
    def lamp(self, *options, spp=64):
        gltf = quad({"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}})
        gltf["materials"][0].update({"emissiveFactor": [1, 1, 1], "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 100}}})
        gltf["extensionsUsed"] = ["KHR_materials_emissive_strength"]
        gltf["nodes"][0]["scale"] = [HALF, HALF, 1]
        path = self.written("lamp.gltf", gltf)
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

    def test_the_depth_of_a_blurred_edge_is_the_mean_of_what_the_lens_sees(self):
        """A half-plane 3 m away hides a wall 4 m away, which is in focus: how much of the lens sees it is a segment of the aperture's disc."""
        gltf = quad({})
        gltf["nodes"] = [{"mesh": 0, "scale": [4, 4, 1]}, {"mesh": 0, "scale": [4, 4, 1], "translation": [-4, 0, 1]}]
        gltf["scenes"] = [{"nodes": [0, 1]}]
        path = self.written("edge.gltf", gltf)
        stop = 0.02
        radius = 0.5 * 0.012 / math.tan(math.radians(ANGLE / 2)) / stop
        def part_hidden(x):
            """Returns the hidden part of the lens, seen from the wall at x from the axis: its rays cross the edge at 3
            / 4 x + 1 / 4 of the lens."""
            at = min(max(-3 * x / radius, -1), 1)
            return 0.5 + (at * math.sqrt(1 - at * at) + math.asin(at)) / math.pi
        rows = self.picture(str(path.with_suffix("")), "x.exr", "--resolution", f"{SIDE},{SIDE}", "--spp", 64, "--camera-position", f"0,0,{DISTANCE}", "--camera-focal-point",
                            "0,0,0", "--camera-view-angle", ANGLE, "--f-stop", stop, "--stage", "flat", "--aov", "depth")
        depth = rows.values("depth.Z")
        pixel = 2 * math.tan(math.radians(ANGLE / 2)) * DISTANCE / SIDE
        seen = [statistics.fmean(depth[y * SIDE + x] for y in range(SIDE)) for x in range(SIDE)]
        wanted = []
        for x in range(SIDE):
            places = [(x + (k + 0.5) / 64 - SIDE / 2) * pixel for k in range(64)]
            wanted.append(DISTANCE - statistics.fmean(map(part_hidden, places)))
        self.assertGreater(sum(3.01 < depth < 3.99 for depth in wanted), 3)
        self.assertLess(max(abs(a - b) for a, b in zip(seen, wanted)), 0.02)

    def test_a_filter_keeps_what_is_out_of_focus(self):
        """Filtered, a picture that is out of focus has less error than before."""
        def picture(spp, seed, *options):
            rows = self.picture(str(SCENES / "cornell-box"), "x.pfm", "--resolution", "64,64", "--spp", spp, "--seed", seed, "--f-stop", 0.02, "--focus-distance", 1.5, *options)
            return [value for row in rows for pixel in row for value in pixel]
        truth = picture(2048, 9)
        error = lambda picture: sum((a - b)**2 / (b + 0.01)**2 for a, b in zip(picture, truth))
        plain, filtered = error(picture(16, 1)), error(picture(16, 1, "--denoise", "variance"))
        print(f"out of focus, filtered: {plain / filtered:.1f} times less squared error")
        self.assertLess(2 * filtered, plain)

    def test_a_focus_beyond_all_distances(self):
        """At the largest distance of the option, rays through the lens are parallel: the picture is the same as at a
        million metres."""
        near, far = (self.picture(str(SCENES / "cornell-box"), "x.pfm", "--resolution", "32,32", "--spp", 4, "--f-stop", 1, "--focus-distance", distance)
                     for distance in ("1e6", "1e30"))
        values = [[value for row in rows for pixel in row for value in pixel] for rows in (near, far)]
        self.assertGreater(statistics.fmean(values[0]), 0.05)
        self.assertLess(statistics.fmean(abs(a - b) for a, b in zip(*values)), 0.02 * statistics.fmean(values[0]))

    def test_a_wide_pinhole_is_no_lens(self):
        """At a huge f-number the picture is that of the pinhole, except for rounding."""
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

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A sky and its sun: shadows, light on the ground, how options place the sun, what is refused."""
import json
import math

from support import SCENES, Case, luminances, main
from gltf_writer import GltfWriter
from geometry import flip, ground, quad
from scene_parts import place_quad

FEW = ["--resolution", "16,16", "--spp", "1"]
RADIUS = math.radians(0.2665)
LIMB = 0.508


def lit_share(angle):
    """The part of the sun's light on the side of its middle of a straight edge, which is so far away from the middle in radians."""
    parts = [-1 + (i + 0.5) / 500 for i in range(1000)]
    strips = [(1 - y * y)**(0.5 * LIMB + 0.5) for y in parts]
    return sum(s for y, s in zip(parts, strips) if y * RADIUS > -angle) / sum(strips)


class Sky(Case):
    def test_a_shadow_has_the_penumbra_of_the_disc(self):
        """A roof 10 m above the ground, seen from below it; its edge is level and stands at a right angle to the sun."""
        gltf = GltfWriter(self.folder, "made")
        place_quad(gltf, "ground", ground(50, 50), gltf.add_lambert("ground", (1, 1, 1)))
        place_quad(gltf, "roof", flip(quad((-80, 10, 40), (80, 0, 0), (0, 0, -80))), gltf.add_lambert("roof", (0, 0, 0)))
        gltf.write()
        elevation, pixels, width = math.radians(30), 48, 0.6
        edge = -10 / math.tan(elevation)
        rows = self.picture(str(self.folder / "made"), "x.pfm", "--sky", "--sun-elevation", "30", "--sun-azimuth", "90", "--spp", "256", "--bounces", "1",
                            "--resolution", f"{pixels},4", "--camera-position", f"{edge},5,0", "--camera-focal-point", f"{edge},0,0", "--camera-view-up", "0,0,-1",
                            "--camera-parallel-scale", str(0.5 * width * 4 / pixels))
        seen = [sum(luminances([[row[x] for row in rows]])) for x in range(pixels)]
        dark, light = sum(seen[:4]) / 4, sum(seen[-4:]) / 4
        self.assertGreater(light, 3 * dark)
        errors = []
        for x, value in enumerate(seen):
            place = edge + ((x + 0.5) / pixels - 0.5) * width
            share = lit_share(math.atan2(10, -place) - elevation)
            errors.append((value - dark) / (light - dark) - share)
        self.assertLess(math.sqrt(sum(e * e for e in errors) / pixels), 0.02)
        self.assertLess(abs(sum(errors)), 0.02 * pixels)

    def test_white_ground_reflects_what_the_ground_of_the_sky_does(self):
        gltf = GltfWriter(self.folder, "made")
        place_quad(gltf, "ground", ground(1, 1), gltf.add_lambert("ground", (0.8, 0.8, 0.8)))
        gltf.write()
        options = ["--sky", "--sun-elevation", "35", "--ground-albedo", "0.4", "--resolution", "16,16"]
        near = self.picture(str(self.folder / "made"), "near.pfm", *options, "--spp", "256", "--camera-position", "0,1,0", "--camera-focal-point", "0,0,0.01", "--camera-view-angle", "20")
        far = self.picture(str(self.folder / "made"), "far.pfm", *options, "--spp", "1", "--camera-position", "0,50,0", "--camera-focal-point", "50,20,0", "--camera-view-angle", "5")
        for channel in range(3):
            mean = lambda rows: sum(pixel[channel] for row in rows for pixel in row) / 256
            self.assertAlmostEqual(mean(near) / mean(far), 2, delta=0.03)

    def test_time_and_place_put_the_sun_where_it_stands(self):
        """The values are those of Reda and Andreas, Solar Position Algorithm (2004), table A5.1."""
        place = ["--sun-time", "2003-10-17T12:30:30-07:00", "--sun-place", "39.742476,-105.1786"]
        stats = self.folder / "stats.json"
        rows = self.picture("sphere-plane", "x.exr", "--sky", *place, *FEW, "--stats", stats)
        stands = json.loads(stats.read_text())
        self.assertAlmostEqual(stands["sun_elevation"], 39.8884, delta=0.02)
        self.assertAlmostEqual(stands["sun_azimuth"], 194.3402, delta=0.02)
        settings = json.loads(rows.texts["fragtrace:settings"])
        self.assertEqual(settings["sun_time"], "2003-10-17T12:30:30-07:00")
        same = self.picture("sphere-plane", "y.exr", "--sky", "--sun-elevation", "39.8884", "--sun-azimuth", "194.3402", *FEW)
        other = self.picture("sphere-plane", "z.exr", "--sky", "--sun-elevation", "39.8884", "--sun-azimuth", "150", *FEW)
        off = lambda picture: sum(abs(a - b) for a, b in zip(rows.luminances(), picture.luminances())) / sum(rows.luminances())
        self.assertLess(off(same), 0.01)
        self.assertGreater(off(other), 0.02)

    def test_rotation_turns_sky_and_sun(self):
        turned = self.picture("sphere-plane", "x.pfm", "--sky", "--hdri-rotation", "40", *FEW)
        self.assertEqual(turned, self.picture("sphere-plane", "y.pfm", "--sky", "--sun-azimuth", "185", *FEW))
        self.assertNotEqual(turned, self.picture("sphere-plane", "z.pfm", "--sky", *FEW))

    def test_all_stages_and_parts_take_it(self):
        for options in (["--stage", "phong"], ["--stage", "flat"], ["--shadow-catcher", "bottom", "--fit"], ["--background-blur", "10"], ["--light-reuse", "spatial"]):
            with self.subTest(options=options):
                rows = self.picture("sphere-plane", "x.pfm", "--sky", "--sun-elevation", "-0.1", *options, *FEW)
                self.assertGreater(sum(luminances(rows)), 0)

    def test_it_is_told_and_night_is_dark(self):
        stats = self.folder / "s.json"
        result = self.renders(SCENES / "furnace.gltf", "-o", self.folder / "x.pfm", "--sky", "--sun-elevation", "-40", "--stats", stats, *FEW)
        self.assertIn("40 degrees below the horizon: it is night", result.stderr)
        self.assertIn("sky", [phase["name"] for phase in json.loads(stats.read_text())["phases"]])

    def test_refusals(self):
        scene = ["render", SCENES / "furnace.gltf", "-o", self.folder / "x.pfm", "--quiet"]
        place = ["--sun-place", "52.5,13.4"]
        for options, says in (
                (["--sky", "--hdri-file", SCENES / "sky.pfm"], "--sky: there is an --hdri-file, too"),
                (["--sky", "--studio"], "--sky: there is --studio, too"),
                (["--sky", "--sun-elevation", "91"], "--sun-elevation"),
                (["--sky", "--sky-turbidity", "0.5"], "--sky-turbidity"),
                (["--sky", "--ground-albedo", "1.5"], "--ground-albedo"),
                (["--sky", "--sun-time", "2026-06-21T12:00Z"], "--sun-time: goes with --sun-place"),
                (["--sky", *place], "--sun-place: goes with --sun-time"),
                (["--sky", "--sun-time", "2026-06-21T12:00", *place], "has no offset from universal time, as 2026-06-21T12:00+02:00 or"),
                (["--sky", "--sun-time", "2026-06-31T12:00Z", *place], "is no time with its offset"),
                (["--sky", "--sun-time", "2026-06-21T12:00Z", "--sun-place", "91,0"], "the latitude"),
                (["--sky", "--sun-time", "2026-06-21T12:00Z", *place, "--sun-elevation", "3"], "--sun-elevation: --sun-time says"),
        ):
            with self.subTest(options=options):
                self.fails(2, *scene, *options, says=[says])
        said = self.renders(SCENES / "furnace.gltf", "-o", self.folder / "x.pfm", "--sun-azimuth", "10", *FEW).stderr
        self.assertIn("--sun-azimuth: there is no --sky", said)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Points and lines: how many pixels they cover, in which colour, and that all that draws parts or sequences knows them."""
import json
import math

from support import Case, Exr, main, quad, read_pfm, run

RED = {"pbrMetallicRoughness": {"metallicFactor": 0, "baseColorFactor": [0.5, 0.25, 0.125, 1]}}
SIZE, HALF = 100, 1.25  # pixels of a side of the picture, and half of the metres that it shows
STRAIGHT = ["--camera-position", "0,0,5", "--camera-focal-point", "0,0,0", "--camera-parallel-scale", str(HALF), "--resolution", f"{SIZE},{SIZE}"]


class Strokes(Case):
    def file(self, mode, count=4, name="strokes"):
        """The corners of a square of 2 m."""
        gltf = quad(RED)
        primitive = gltf["meshes"][0]["primitives"][0]
        primitive["mode"] = mode
        del primitive["indices"], primitive["attributes"]["TEXCOORD_0"]
        gltf["accessors"][0]["count"] = count
        return self.written(f"{name}.gltf", gltf)

    def covered(self, path, width, *options):
        """Returns the covered area in pixels."""
        output = self.folder / "covered.exr"
        ran = run("render", path, "-o", output, *STRAIGHT, "--line-width", width, "--spp", "64", "--no-background", *options)
        self.assertEqual((ran.returncode, ran.stdout.count("\n")), (0, 1), ran.stderr)
        return sum(map(sum, Exr(output).layers["A"]))

    def test_a_point_covers_the_area_of_its_circle(self):
        for width in (2, 20):
            self.assertAlmostEqual(self.covered(self.file(0), width) / (4 * math.pi * width**2 / 4), 1, delta=0.01)

    def test_a_line_is_as_wide_as_asked(self):
        """The width of a hexagonal prism is 0.95 to 1.1 times that of its circle, by the side from which it is seen."""
        metre = SIZE / (2 * HALF)
        for mode, length in ((1, 4), (2, 8), (3, 6)):
            areas = [self.covered(self.file(mode), width) for width in (1, 4)]
            for width, area in zip((1, 4), areas):
                self.assertGreater(area, 0.94 * width * length * metre)
                self.assertLess(area, 1.11 * width * length * metre + 4 * width**2)
            self.assertAlmostEqual(areas[1] / areas[0], 4, delta=0.1)

    def test_without_normals_they_have_their_base_colour(self):
        output = self.folder / "colour.pfm"
        self.assertEqual(run("render", self.file(0), "-o", output, *STRAIGHT, "--line-width", "30", "--spp", "4", "--quiet").returncode, 0)
        corner = [round(SIZE / 2 - SIZE / (2 * HALF))] * 2
        self.assertEqual([round(c, 5) for c in read_pfm(output)[corner[1]][corner[0]]], [0.5, 0.25, 0.125])

    def test_info_and_statistics_count_them(self):
        info = run("info", self.file(2))
        self.assertIn("lines       0 points, 4 line segments", info.stdout)
        stats = self.folder / "stats.json"
        run("render", self.file(0), "-o", self.folder / "a.png", *STRAIGHT, "--spp", "1", "--quiet", "--stats", stats)
        scene = json.loads(stats.read_text())["scene"]
        self.assertEqual([scene[name] for name in ("points", "lines", "triangles")], [4, 0, 48])

    def test_layers_name_the_material_of_the_file(self):
        output = self.folder / "numbers.exr"
        run("render", self.file(2), "-o", output, *STRAIGHT, "--line-width", "6", "--spp", "1", "--quiet", "--aov", "object,material")
        layers = Exr(output).layers
        self.assertEqual({(o, m) for a, b in zip(layers["object.Y"], layers["material.Y"]) for o, m in zip(a, b)}, {(0, 0), (1, 1)})

    def test_fit_and_regions_show_the_same_lines(self):
        path = self.file(2)
        options = ["--camera-orbit", "30,20", "--fit", "--resolution", "60,40", "--spp", "4", "--quiet", "--no-background"]
        whole, part = self.folder / "whole.exr", self.folder / "part.exr"
        self.assertEqual(run("render", path, "-o", whole, *options).returncode, 0)
        self.assertEqual(run("render", path, "-o", part, *options, "--region", "10,5,30,20").returncode, 0)
        all_of_it, own = Exr(whole).layers["A"], Exr(part).layers["A"]
        self.assertGreater(sum(map(sum, all_of_it)), 60)
        self.assertEqual([list(row) for row in own], [list(row[10:40]) for row in all_of_it[5:25]])

    def test_what_makes_no_line_is_said(self):
        ran = run("render", self.file(1, 3), "-o", self.folder / "odd.png", *STRAIGHT, "--spp", "1")
        self.assertEqual(ran.returncode, 0)
        self.assertIn("/meshes/0/primitives/0: vertices that make no whole line are left out", ran.stderr)
        self.assertEqual(run("render", self.file(1), "-o", self.folder / "wide.png", "--line-width", "0").returncode, 2)


if __name__ == "__main__":
    main()

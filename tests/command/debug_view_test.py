#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Compares the pictures of --debug-view and --tree-level, and the layers behind them, with known facts of a scene."""
import json

from support import SCENES, TWO_TRIANGLES, Case, Exr, Gltf, data_uri, main, png, read_pfm, run

BOX = SCENES / "cornell-box.gltf"


def encoded(linear):
    """Returns the value that a display shows (IEC 61966-2-1)."""
    return 12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055


class DebugViews(Case):
    def card(self):
        """A card of 4 x 4 m at z = 0 that a picture 4 m high shows whole. Vertex normals lean by (0.6, 0, 0.8), u and v go from 0 to 2 (to
        the right and down), the roughness is half of a texture's 102 / 255 on the left and 204 / 255 on the right of each unit of u. Half of
        it, x < 0, lies 3 m behind."""
        places = [(x, y, 3 * i - 3, i) for i in range(2) for x, y in ((0, 0), (2, 0), (2, 4), (0, 4))]
        gltf = Gltf(textures=[{"source": 0, "sampler": 0}], samplers=[{"magFilter": 9728}],
                    images=[{"uri": data_uri("image/png", png(2, 1, [0, 102, 0, 255, 0, 204, 0, 255]))}],
                    materials=[{"pbrMetallicRoughness": {"baseColorFactor": [0.2, 0.4, 0.6, 1], "roughnessFactor": 0.5, "metallicRoughnessTexture": {"index": 0}}}])
        position = gltf.accessor([(x - 2 + 2 * i, y - 2, z) for x, y, z, i in places])
        normal, uv = gltf.accessor([(0.6, 0, 0.8)] * 8), gltf.accessor([((x + 2 * i) / 2, (4 - y) / 2) for x, y, _, i in places])
        indices = gltf.accessor([4 * i + k for i in range(2) for k in TWO_TRIANGLES], "H")
        gltf.node(mesh=gltf.mesh(indices, position=position, normal=normal, texcoord_0=uv, material=0))
        return gltf.write(self.folder / "card.gltf")

    def view(self, scale=2):
        return ["--camera-position", "0,0,5", "--camera-focal-point", "0,0,0", "--camera-parallel-scale", scale, "--resolution", "16,16",
                "--spp", 4, "--quiet"]

    def shown(self, view, *options, scale=2):
        """Returns display values, rows from the top."""
        path = self.folder / "x.pfm"
        self.renders(self.card(), "-o", path, *self.view(scale), "--debug-view", view, *options)
        return [[tuple(map(encoded, pixel)) for pixel in row] for row in read_pfm(path)]

    def close(self, pixel, expected, delta=1e-5):
        for a, b in zip(pixel, expected, strict=True):
            self.assertAlmostEqual(a, b, delta=delta, msg=f"{pixel} is not {expected}")

    def test_first_hits_are_shown_as_they_are(self):
        roughness = [0.5 * 102 / 255, 0.5 * 204 / 255]  # texels are linear half floats
        geometric, normal, albedo, rough, texcoords, depth = (
            self.shown(view) for view in ("geometric-normal", "normal", "albedo", "roughness", "texcoords", "depth"))
        for y in (0, 7, 15):
            for x in range(16):
                self.close(geometric[y][x], (0.5, 0.5, 1))
                self.close(normal[y][x], (0.8, 0.5, 0.9))
                self.close(albedo[y][x], map(encoded, (0.2, 0.4, 0.6)))
                self.close(rough[y][x], [roughness[x // 4 % 2]] * 3, 2e-4)
                self.close(depth[y][x], [0.1 if x < 8 else 1.0] * 3)
                # Four samples lie anywhere in an eighth of the unit.
                self.close(texcoords[y][x][:2], [(p + 0.5) / 8 % 1 for p in (x, y)], 0.0625)

    def test_the_layers_behind_them_are_numbers(self):
        path = self.folder / "x.exr"
        self.renders(self.card(), "-o", path, *self.view(), "--aov", "geometric-normal,roughness,texcoords")
        exr = Exr(path)
        self.assertEqual(sorted(n for n in exr.layers if "." in n), [
            "geometric-normal.X", "geometric-normal.Y", "geometric-normal.Z", "roughness.Y", "texcoords.U", "texcoords.V"])
        self.close(exr.pixel(3, 5, "geometric-normal.X", "geometric-normal.Y", "geometric-normal.Z"), (0, 0, 1), 1e-6)
        self.close(exr.pixel(3, 5, "roughness.Y"), (0.2,), 1e-4)
        self.close(exr.pixel(6, 5, "roughness.Y"), (0.4,), 2e-4)
        self.close(exr.pixel(12, 5, "texcoords.U", "texcoords.V"), (12.5 / 8, 5.5 / 8), 0.0625)

    def test_a_miss_is_black(self):
        picture = self.shown("normal", "--background-color", "1,1,1", scale=4)
        self.close(picture[0][8], (0, 0, 0))

    def test_only_what_the_view_needs_is_compiled(self):
        for view, there, absent in (("geometric-normal", "geometric-normal", ("texture", "vertex-normals", "texcoords")),
                                    ("roughness", "metal-and-roughness-texture", ("vertex-normals", "punctual")),
                                    ("depth", "depth", ("texture", "vertex-normals"))):
            self.shown(view, "--stats", self.folder / "s.json")
            variant = json.loads((self.folder / "s.json").read_text())["variant"]
            self.assertIn(there, variant)
            for name in (*absent, "gi+", "light"):
                self.assertNotIn(name, variant)

    def picture_of(self, name, *options):
        path = self.folder / name
        self.renders(BOX, "-o", path, "--quiet", "--resolution", "48,40", "--spp", 8, *options)
        return path

    def test_visits_are_a_heat_map_with_their_numbers_beside_it(self):
        """A traversal in a fixed order visits more nodes."""
        near, fixed = (Exr(self.picture_of("x.exr", "--debug-view", "visits", "--traversal", way)) for way in ("front-to-back", "bvh"))
        self.assertEqual(sorted(near.layers), ["B", "G", "R", "visits"])
        self.assertGreater(min(near.values("visits")[:1000]), 0)
        self.assertGreater(sum(fixed.values("visits")), sum(near.values("visits")))
        self.assertGreater(len(set(near.values("R"))), 10)

    def test_counts_are_drawn_from_the_samples_of_the_picture(self):
        """Uniform pictures are red all over (all are at the end of the scale); noise is where light comes seldom."""
        for pixel in read_pfm(self.picture_of("x.pfm", "--debug-view", "samples"))[0]:
            self.assertEqual(pixel, (1, 0, 0))
        variance = read_pfm(self.picture_of("x.pfm", "--debug-view", "variance"))
        self.assertGreater(len({pixel for row in variance[:20] for pixel in row}), 100)
        seeds = [self.picture_of("x.pfm", "--debug-view", "variance", "--seed", s).read_bytes() for s in (1, 1, 2)]
        self.assertEqual(seeds[0], seeds[1])
        self.assertNotEqual(seeds[0], seeds[2])

    def test_colours_are_not_exposed_and_layers_stay_beside_them(self):
        plain, exposed = (self.picture_of("x.png", "--debug-view", "albedo", *more).read_bytes() for more in ([], ["--exposure", 3, "--tone-map", "aces"]))
        self.assertEqual(plain, exposed)
        view = Exr(self.picture_of("x.exr", "--debug-view", "variance", "--aov", "variance,samples,depth"))
        radiance = Exr(self.picture_of("y.exr", "--aov", "variance,samples,depth"))
        self.assertEqual(view.values("variance.Y"), radiance.values("variance.Y"))
        self.assertEqual(view.values("depth.Z"), radiance.values("depth.Z"))
        self.assertNotEqual(view.values("R"), radiance.values("R"))
        # Colours are no sums of samples.
        self.fails(3, "merge", self.folder / "x.exr", self.folder / "y.exr", "-o", self.folder / "z.exr", says=["x.exr"])

    def test_a_name_that_is_none_is_refused(self):
        self.fails(2, "render", BOX, "-o", self.folder / "x.png", "--debug-view", "colour", says=["colour", "geometric-normal"])


class TreeBoxes(Case):
    def changed(self, level, *options):
        """Returns the pixels on which the boxes of a level are drawn: rows of booleans."""
        view = ["--quiet", "--resolution", "64,64", "--spp", 1, "--stage", "flat", "--camera-position", "0,0,8", "--camera-focal-point", "0,0,0", *options]
        plain, boxes, difference = (self.folder / name for name in ("plain.png", "boxes.png", "difference.pfm"))
        self.renders(BOX, "-o", plain, *view)
        self.renders(BOX, "-o", boxes, *view, "--tree-level", level)
        self.assertEqual(run("diff", boxes, plain, "--outfile", difference).returncode, 0)
        return [[sum(pixel) > 0 for pixel in row] for row in read_pfm(difference)]

    def test_the_root_is_the_box_of_the_scene(self):
        """x from -1 to 1, y from -0.987 to 0.987, z from -1.006 to 1.006, seen orthographically: 4 m are 64 pixels."""
        for options in (["--camera-parallel-scale", 2], ["--camera-parallel-scale", 2, "--traversal", "bvh"]):
            changed = self.changed(0, *options)
            columns = [x for x in range(64) if sum(row[x] for row in changed) > 10]
            rows = [y for y in range(64) if sum(changed[y]) > 10]
            self.assertEqual((rows, set(columns) <= {15, 16, 47, 48}, len(columns)), ([16, 47], True, 2))
            self.assertEqual(sum(map(sum, changed)), sum(changed[y][x] for y in range(64) for x in range(64) if y in rows or x in columns))

    def test_a_deeper_level_has_more_lines(self):
        counts = [sum(map(sum, self.changed(level))) for level in (0, 2)]
        self.assertEqual(counts, sorted(set(counts)))

    def test_a_level_that_is_not_there_is_said(self):
        result = run("render", BOX, "-o", self.folder / "x.png", "--resolution", "8,8", "--spp", 1, "--tree-level", 30)
        self.assertEqual(result.returncode, 0)
        self.assertIn("no level 30", result.stderr)
        self.fails(2, "render", BOX, "-o", self.folder / "x.png", "--tree-level", 33, says=["--tree-level"])
        self.fails(2, "render", BOX, "-o", self.folder / "x.exr", "--tree-level", 3, says=["--tree-level"])


if __name__ == "__main__":
    main()

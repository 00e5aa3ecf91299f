#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""However rays find triangles, and whichever way the shader runs and reads: the picture stays the same."""
import itertools
import json

from support import SCENES, Case, main, read_pfm

SIZE = ["--resolution", "48,48", "--spp", 8]


class Traversals(Case):
    def drawn(self, scene, *options, size=SIZE):
        picture, stats = self.folder / "x.pfm", self.folder / "x.json"
        self.renders(SCENES / (scene + ".gltf"), "-o", picture, "--quiet", "--stats", stats, *size, *options)
        return read_pfm(picture), json.loads(stats.read_text())["variant"].split("+")

    def same(self, scene, expected, *options, traversal="auto"):
        """A path may go another way where rounding decides, in one pixel of two hundred; all else is the same."""
        picture, variant = self.drawn(scene, *options, "--traversal", traversal)
        tree, plain = self.drawn(scene, *options, "--traversal", "front-to-back")
        self.assertIn(expected, variant)
        self.assertNotIn(expected, plain)
        self.assertIn("front-to-back", plain)
        apart = sum(max(abs(a - b) for a, b in zip(p, q)) > 1e-4 * (1 + max(q))
                    for p, q in zip(itertools.chain(*picture), itertools.chain(*tree)))
        print(f"{scene} {expected}: {apart} of {48 * 48} pixels apart")
        self.assertLessEqual(apart, 48 * 48 // 200)
        mean = lambda pixels: sum(map(sum, itertools.chain(*pixels)))
        self.assertAlmostEqual(mean(picture) / mean(tree), 1.0, delta=1e-3)

    def test_small_scenes_as_literals(self):
        self.same("cornell-box", "literals", traversal="literals")
        self.same("corner-diffuse", "literals", traversal="literals")
        self.same("closed-furnace", "literals", traversal="literals")

    def test_literals_with_vertex_attributes_keep_their_weights(self):
        self.same("mapped-plane", "literals", traversal="literals")
        self.same("mapped-plane-tangents", "literals", "--stage", "normal-maps", traversal="literals")

    def test_literals_with_alpha_glass_and_both_sides(self):
        self.same("coverage", "literals", traversal="literals")
        self.same("water-cube-plain", "literals", "--caustics", "off", traversal="literals")

    def test_the_heat_map_has_no_tree_to_count_in_literals(self):
        self.fails(2, "render", SCENES / "cornell-box.gltf", "-o", self.folder / "x.pfm", "--traversal", "literals", "--debug-view",
                   "visits", "--quiet", says=["--traversal literals"])

    def test_every_stage_with_literals(self):
        for stage in ("flat", "phong", "shadows", "reflections"):
            self.same("cornell-box", "literals", "--stage", stage, traversal="literals")

    def test_literals_are_chosen_where_drawing_takes_longer_than_compiling_them(self):
        for expected, size in (("front-to-back", SIZE), ("literals", ["--resolution", "256,256", "--spp", 8]),
                               ("literals", ["--resolution", "16,16", "--noise", 0.5])):
            self.assertIn(expected, self.drawn("cornell-box", size=size)[1])

    def test_the_largest_triangles_before_the_tree(self):
        self.same("room-ball", "large-first")
        self.same("room-ball", "large-first", "--stage", "shadows")

    def test_layers_of_first_hits_meet_the_largest_triangles(self):
        plain = ["--traversal", "front-to-back"]
        with_layers = [self.picture("room-ball", name, "--aov", "albedo,normal,depth", *SIZE, *options)
                       for name, options in (("a.exr", []), ("b.exr", plain))]
        for layer in ("albedo.R", "normal.X", "depth.Z"):
            for a, b in zip(*(exr.values(layer) for exr in with_layers)):
                self.assertAlmostEqual(a, b, delta=1e-3 * (1 + abs(b)))

    def test_what_cannot_be_literals_is_refused(self):
        for scene in ("sphere-plane", "mesh-15743"):
            self.fails(2, "render", SCENES / (scene + ".gltf"), "-o", self.folder / "x.pfm", "--quiet", *SIZE,
                       "--traversal", "literals", says=["--traversal literals"])


class Entries(Case):
    SCENES = ("cornell-box", ["--traversal", "front-to-back"]), ("coverage", [])

    def test_every_entry_and_every_read_draw_the_same_bits(self):
        for scene, options in self.SCENES:
            pictures = {}
            for dispatch, reads in itertools.product(("fragment", "compute"), ("image", "ssbo", "texel")):
                path, stats = self.folder / "x.pfm", self.folder / "x.json"
                self.renders(SCENES / (scene + ".gltf"), "-o", path, "--quiet", "--resolution", "33,21", "--spp", 4, "--stats", stats,
                             "--dispatch", dispatch, "--buffer-reads", reads, *options)
                variant = json.loads(stats.read_text())["variant"].split("+")
                self.assertTrue({dispatch, reads + "-reads"} <= set(variant), variant)
                pictures[dispatch, reads] = path.read_bytes()
            self.assertEqual(len(set(pictures.values())), 1, f"{scene} {options}")


class MoreEntries(Entries):
    SCENES = ("cornell-box", []), ("mapped-layers", []), ("glass-sphere", []), ("lights", ["--stage", "shadows"])


if __name__ == "__main__":
    main()

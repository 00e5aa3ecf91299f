#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""However rays find triangles, and whichever way the shader runs and reads: the picture stays the same."""
import itertools
import json
import os
import shutil
import subprocess

from support import EXTENDED, FRAGTRACE, SCENES, Case, Exr, main, read_pfm, run
from instanced_scene import write_field

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


# Both schedules draw the same picture, bit for bit (on llvmpipe), with the same rays; a message says why the wavefront
# does not draw.
SKY = ["--hdri-file", SCENES / "sky.pfm"]
ALPHA = ["--set", "*:alphaMode=BLEND", "--set", "*:baseColor=1,1,1,0.8"]
GLASS = ["--set", "*:transmission=1", "--set", "*:roughness=0"]
# Large triangles first; spheres and lamps; glass with absorption; alpha.
PICTURES = {
    "room-ball": [],
    "many-lights": ["--traversal", "front-to-back"],
    "rough-glass": [*SKY, "--bounces", "6"],
    "coverage": ["--traversal", "front-to-back"],
}
# All lobes, textures, thin walls.
MORE_PICTURES = {
    "lobes": [*SKY, "--traversal", "front-to-back"],
    "mapped-layers": [*SKY, "--traversal", "front-to-back"],
    "glass-sphere": [*SKY, "--traversal", "front-to-back", "--disable", "light-sampling"],
    "thin-glass": [*SKY, "--traversal", "front-to-back", "--rr-depth", "1"],
}


# The ways to draw, and what only some scenes and stages have: passes next to the picture, stages before gi, suspended paths, the catcher.
ENTRIES = (["--dispatch", "fragment"], ["--dispatch", "compute", "--schedule", "megakernel"], ["--schedule", "wavefront"])
TUNED = (("room-ball", []), ("cornell-box", ["--traversal", "literals"]), ("thin-glass", SKY), ("coverage", []), ("lobes", SKY))
TUNED_BY_FRAGMENTS = (("plastics", ["--stage", "refraction", *SKY]), ("many-lights", ["--light-reuse", "spatial"]), ("caustics", []), ("many-lights", ["--stage", "shadows"]),
                      ("coverage", ["--shadow-catcher", "bottom"]), ("sphere-textured", ["--debug-view", "texcoords"]), ("room-ball", ["--denoise", "variance"]))


class BothSchedules(Case):
    def drawn(self, scene, schedule, *options):
        """Returns the bytes of the file, and the statistics."""
        path, stats = self.folder / "x.pfm", self.folder / "s.json"
        asked = [] if "--schedule" in options else ["--schedule", schedule]
        self.renders(SCENES / (scene + ".gltf"), "-o", path, "--quiet", *asked, "--stats", stats, *options)
        return path.read_bytes(), json.loads(stats.read_text())

    def same(self, scene, *options):
        picture, stats = self.drawn(scene, "megakernel", *options)
        waves, other = self.drawn(scene, "wavefront", *options)
        self.assertEqual(other["schedule"], "wavefront", scene)
        self.assertEqual(stats["schedule_reason"], "--schedule")
        for name in ("rays", "samples_per_pixel", "budget_hits", "nonfinite_pixels"):
            self.assertEqual(stats[name], other[name], f"{scene}: {name}")
        self.assertAlmostEqual(stats["cut_share"], other["cut_share"], delta=1e-6, msg=scene)
        self.assertEqual(picture, waves, scene)


class Schedules(BothSchedules):
    def test_the_same_bits(self):
        for scene, options in PICTURES.items():
            self.same(scene, *options, "--resolution", "37,70", "--spp", 3)

    def test_instances(self):
        write_field(self.folder, "field", 64, 500)
        # The schedules agree without light sampling, too: then there are no shadow rays.
        for switch in ("--enable", "--disable"):
            self.same(str(self.folder / "field"), *SKY, "--instancing", "share", "--resolution", "37,40", "--spp", 2, switch, "light-sampling")

    def test_what_is_cut_into_many_draws(self):
        """Columns that end before a lane does, tiles next to each other, and more samples than the steps of a draw take."""
        self.same("room-ball", "--resolution", "150,261", "--spp", 1)
        self.same("room-ball", "--resolution", "8,40", "--spp", 200, "--sample-offset", 1000)

    def test_adaptive_targets(self):
        self.same("room-ball", "--resolution", "40,40", "--noise", 0.2, "--spp", 512)

    def test_auto_takes_the_wavefront_for_many_paths(self):
        """On a software rasteriser, which is what the tests have."""
        for scene, options, chosen in (("room-ball", ["--spp", 1], ("megakernel", "few paths")),
                                       ("room-ball", ["--spp", 65536, "--noise", 0.5], ("wavefront", None)),
                                       ("many-lights", ["--spp", 65536, "--noise", 0.5], ("megakernel", "a small tree")),
                                       ("city", ["--spp", 65536, "--noise", 0.5], ("megakernel", "lamps are chosen by a tree")),
                                       ("mesh-15743", ["--spp", 65536, "--noise", 0.5], ("megakernel", "paths end in the surroundings")),
                                       ("mesh-15743", [*ALPHA, "--spp", 65536, "--noise", 0.5], ("wavefront", None)),
                                       ("city", [*ALPHA, "--spp", 65536, "--noise", 0.5], ("wavefront", None)),
                                       ("room-ball", [*SKY, "--set", "clay:thickness=1", "--set", "clay:transmission=1", "--spp", 4096],
                                        ("wavefront", None)),
                                       ("mesh-15743", [*GLASS, *ALPHA, "--spp", 65536, "--noise", 0.5], ("megakernel", "paths end in the surroundings"))):
            stats = self.drawn(scene, "auto", "--resolution", "8,8", *options)[1]
            self.assertEqual((stats["schedule"], stats.get("schedule_reason")), chosen, (scene, options))

    def test_a_picture_that_is_stopped_is_even(self):
        stats = self.drawn("room-ball", "wavefront", "--resolution", "300,300", "--time", 3)[1]
        self.assertGreater(stats["fewest_samples"], 0)

    def test_who_asks_for_the_wavefront_is_told_why_not(self):
        result = self.renders(SCENES / "room-ball.gltf", "-o", self.folder / "x.pfm", "--schedule", "wavefront", "--stage", "flat", "--resolution", "8,8",
                              "--spp", 1)
        self.assertIn("--schedule wavefront: the megakernel draws: a stage before global illumination", result.stderr)
        stats = self.drawn("cornell-box", "wavefront", "--resolution", "16,16", "--noise", 0.5)[1]
        self.assertEqual(stats["schedule"], "wavefront")

    def test_why_it_is_the_megakernel(self):
        small = ["--resolution", "8,8", "--spp", 1]
        for why, scene, options in (("the scene is shader text", "cornell-box", ["--traversal", "literals"]),
                                    ("the tree is not walked front to back", "room-ball", ["--traversal", "bvh"]),
                                    ("a layer", "room-ball", ["--debug-view", "normal"]),
                                    ("the heat map", "room-ball", ["--debug-view", "visits"]),
                                    ("a stage before global illumination", "room-ball", ["--stage", "shadows"]),
                                    ("--dispatch fragment", "room-ball", ["--dispatch", "fragment"])):
            stats = self.drawn(scene, "wavefront", *small, *options)[1]
            self.assertEqual((stats["schedule"], stats.get("schedule_reason")), ("megakernel", why), scene)


class MoreSchedules(BothSchedules):
    def test_the_same_bits(self):
        for scene, options in MORE_PICTURES.items():
            self.same(scene, *options, "--resolution", "37,70", "--spp", 3)


class Tunes(BothSchedules):
    """The text for GPUs draws the same bits as that for software."""
    def same_tuned(self, scene, *options):
        small = ["--resolution", "37,30", "--spp", 3, *options]
        (picture, stats), (other, tuned) = (self.drawn(scene, "auto", *small, "--tune", tune) for tune in ("software", "gpu"))
        self.assertNotIn("+gpu", stats["variant"])
        self.assertIn("+gpu", tuned["variant"])
        for name in ("rays", "budget_hits", "nonfinite_pixels", "cut_share"):
            self.assertEqual(stats.get(name), tuned.get(name), f"{scene}: {name}")
        self.assertEqual(picture, other, (scene, options))

    def test_by_each_entry(self):
        for scene, options in TUNED if EXTENDED else TUNED[:2]:
            for entry in ENTRIES:
                self.same_tuned(scene, *options, *entry)

    def test_what_else_is_drawn(self):
        for scene, options in TUNED_BY_FRAGMENTS:
            self.same_tuned(scene, *options)

    def test_work_groups_of_several_squares(self):
        self.same_tuned("room-ball", "--resolution", "131,70", "--stage", "flat", "--dispatch", "compute")

    def test_verbose_says_which_stage_runs_the_tracer(self):
        for options, said in (([], "dispatch fragment: measured"), (["--dispatch", "compute"], "dispatch compute: --dispatch;"),
                              (["--schedule", "wavefront"], "dispatch compute: the wavefront")):
            result = self.renders(SCENES / "room-ball.gltf", "-o", self.folder / "x.pfm", "--resolution", "8,8", "--spp", 1, "--verbose", *options)
            self.assertIn(said, result.stderr)
            self.assertIn("`fragtrace bench frame FILE --config ", result.stderr)

    def test_stacks_of_paths_that_are_suspended(self):
        write_field(self.folder, "field", 64, 500)
        self.same_tuned(str(self.folder / "field"), *SKY, "--instancing", "share", "--dispatch", "compute")


# Meshes that stand in the scene many times: shared ones draw the picture of their copies, in memory of what is unique.
class Instancing(Case):
    def drawn(self, name, *options, size="96,54", layers=None):
        path, stats = self.folder / f"{name}.exr", self.folder / f"{name}.json"
        self.renders(self.folder / "field.gltf", "-o", path, "--quiet", "--resolution", size, "--stats", stats,
                     *(["--aov", layers] if layers else []), *options)
        return Exr(path), json.loads(stats.read_text())

    def both(self, *options, layers):
        shared, told = self.drawn("shared", "--instancing", "share", *options, layers=layers)
        flat, told_flat = self.drawn("flat", "--instancing", "flatten", *options, layers=layers)
        self.assertIn("instances", told["variant"].split("+"))
        self.assertNotIn("instances", told_flat["variant"].split("+"))
        self.assertEqual(told["budget_hits"], 0)
        self.assertEqual(told["scene"]["instancing"]["triangles_drawn"], told_flat["scene"]["triangles"])
        return shared, flat

    def same(self, shared, flat, layer, bound, apart=0):
        """All but so many pixels are no further apart than the bound."""
        values = zip(shared.values(layer), flat.values(layer))
        count = sum(abs(a - b) > bound * (1 + abs(b)) for a, b in values)
        self.assertLessEqual(count, apart, layer)

    def test_shared_meshes_draw_the_picture_of_their_copies(self):
        write_field(self.folder, "field", 64, 500)
        shared, flat = self.both("--spp", 2, layers="depth,geometric-normal")
        # Beyond rounding: rays at outlines and edges that meet another triangle.
        self.same(shared, flat, "depth.Z", 2e-5, 3)
        self.same(shared, flat, "geometric-normal.X", 2e-3, 25)
        self.same(shared, flat, "geometric-normal.Y", 2e-3, 25)
        mean = lambda exr: sum(exr.luminances()) / (96 * 54)
        self.assertAlmostEqual(mean(shared) / mean(flat), 1.0, delta=2e-3)

    def test_mirrored_and_unevenly_scaled_ones_too(self):
        write_field(self.folder, "field", 64, 500, uneven=True)
        shared, flat = self.both("--spp", 1, "--stage", "shadows", layers="depth,normal")
        self.same(shared, flat, "depth.Z", 2e-5, 3)
        # Normals are interpolated before or after they are transformed (docs/design/numerics.md).
        for layer in ("normal.X", "normal.Y", "normal.Z"):
            self.same(shared, flat, layer, 3e-2, 10)
        self.same(shared, flat, "R", 3e-2, 60)

    def test_mirrored_ones_with_normal_maps(self):
        shutil.copy(SCENES / "bricks-normal.png", self.folder)
        write_field(self.folder, "field", 64, 500, uneven=True, normal_map="bricks-normal.png")
        shared, flat = self.both("--spp", 1, "--stage", "normal-maps", layers="normal")
        for layer in ("normal.X", "normal.Y", "normal.Z"):
            self.same(shared, flat, layer, 3e-2, 10)
        self.same(shared, flat, "R", 3e-2, 20)

    def test_the_heat_map_and_the_other_way_through_the_tree(self):
        write_field(self.folder, "field", 64, 500)
        visits, told = self.drawn("visits", "--instancing", "share", "--spp", 1, "--debug-view", "visits")
        self.assertIn("instances", told["variant"].split("+"))
        self.assertGreater(max(visits.values("R")), 0)
        nearest, _ = self.drawn("nearest", "--instancing", "share", "--spp", 1, "--stage", "phong")
        fixed, _ = self.drawn("fixed", "--instancing", "share", "--spp", 1, "--stage", "phong", "--traversal", "bvh")
        self.same(nearest, fixed, "R", 0, 2)

    def test_what_walks_no_tree_gets_copies(self):
        write_field(self.folder, "field", 9, 32)
        for traversal in ("iterative", "literals"):
            result = run("render", self.folder / "field.gltf", "-o", self.folder / "x.pfm", "--spp", 1, "--resolution", "16,9",
                         "--instancing", "share", "--traversal", traversal)
            if traversal == "literals":
                self.assertEqual(result.returncode, 2)
                self.assertIn("triangles", result.stderr)
            else:
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertIn("warning: --instancing share: only trees hold shared meshes; all are copied", result.stderr)

    def test_a_name_that_is_no_choice_is_refused(self):
        write_field(self.folder, "field", 4, 32)
        self.fails(2, "info", self.folder / "field.gltf", "--instancing", "copy", says=["--instancing", "flatten"])


class ManyInstances(Case):
    def peak(self, *arguments):
        """Runs it, and returns what it held in memory at most, in MB."""
        process = subprocess.Popen([FRAGTRACE, *map(str, arguments)], stdout=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual(process.returncode, 0)
        return usage.ru_maxrss / 1000

    def test_ten_thousand_instances_of_ten_thousand_triangles(self):
        write_field(self.folder, "field", 10000, 10000)
        scene, stats = self.folder / "field.gltf", self.folder / "x.json"
        loaded = self.peak("info", scene)
        drawn = self.peak("render", scene, "-o", self.folder / "x.pfm", "--stage", "flat", "--spp", 1, "--resolution", "64,36",
                          "--quiet", "--stats", stats)
        told = json.loads(stats.read_text())
        print(f"peak {loaded:.0f} MB loaded, {drawn:.0f} MB drawn; loaded in {told['load_ms']:.0f} ms")
        self.assertEqual(told["scene"]["instancing"]["triangles_drawn"], 100_000_002)
        self.assertEqual(told["scene"]["instancing"]["instances"], 10000)
        self.assertLess(told["scene_bytes"], 4_000_000)
        self.assertLess(loaded, 80)  # the program, the file and some MB; copies would take 20 GB
        self.assertLess(drawn, 300)  # and the driver's compiler


if __name__ == "__main__":
    main()

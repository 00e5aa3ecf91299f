#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Both schedules draw the same picture, bit for bit (on llvmpipe), with the same rays; a message says why the wavefront
does not draw."""
import json

from support import EXTENDED, SCENES, Case, main
from instanced_scene import write_field

SKY = ["--hdri-file", SCENES / "sky.pfm"]
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


# The ways to draw, and what only some scenes and stages have: passes beside the picture, stages before gi, suspended paths, the catcher.
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
        """Columns that end before a lane does, tiles beside each other, and more samples than the steps of a draw take."""
        self.same("room-ball", "--resolution", "150,261", "--spp", 1)
        self.same("room-ball", "--resolution", "8,40", "--spp", 200, "--sample-offset", 1000)

    def test_adaptive_targets(self):
        self.same("room-ball", "--resolution", "40,40", "--noise", 0.2, "--spp", 512)

    def test_auto_takes_the_wavefront_for_many_paths(self):
        """On a software rasteriser, which is what the tests have."""
        for scene, options, chosen in (("room-ball", ["--spp", 1], ("megakernel", "few paths")),
                                       ("room-ball", ["--spp", 65536, "--noise", 0.5], ("wavefront", None)),
                                       ("many-lights", ["--spp", 65536, "--noise", 0.5], ("megakernel", "a small tree"))):
            stats = self.drawn(scene, "auto", "--resolution", "8,8", *options)[1]
            self.assertEqual((stats["schedule"], stats.get("schedule_reason")), chosen, scene)

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


if __name__ == "__main__":
    main()

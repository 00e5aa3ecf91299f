#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Meshes that stand in the scene many times: shared ones draw the picture of their copies, in memory of what is unique."""
import json
import os
import shutil
import subprocess

from support import FRAGTRACE, SCENES, Case, Exr, main, run
from instanced_scene import write_field


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

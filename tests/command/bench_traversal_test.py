#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`bench traversal`: what it measures, writes and refuses; memory stated by `info` and `--stats`."""
import json
import math
import random
import shutil
import struct

from support import SCENES, SHADERS, SMALL, Case, Gltf, main, run

RAYS = ["--resolution", "64,48", "--rounds", 2, "--quiet"]
ROOM = SCENES / "room-ball.gltf"


class Bench(Case):
    def lines(self, *arguments):
        path = self.folder / "b.json"
        result = run("bench", *arguments, "--json", path)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return result, [json.loads(line) for line in path.read_text().splitlines()]

    def broken(self, name, old, new):
        """A folder of shaders in which one place is wrong."""
        folder = self.folder / "shaders"
        shutil.copytree(SHADERS, folder)
        text = (folder / name).read_text()
        self.assertEqual(text.count(old), 1, old)
        (folder / name).write_text(text.replace(old, new))
        return folder


class BenchTraversal(Bench):
    def test_each_kind_of_rays_is_timed_and_checked(self):
        result, rows = self.lines("traversal", ROOM, *RAYS)
        self.assertEqual([row["kind"] for row in rows], ["primary", "diffuse", "shadow"])
        for row in rows:
            self.assertEqual((row["schema"], row["bench"], row["scene"], row["triangles"]), (1, "traversal", "room-ball.gltf", 69326))
            self.assertEqual(len(row["ms"]), 2)
            self.assertAlmostEqual(row["mrays_per_s"] / (row["rays"] / min(row["ms"]) / 1000), 1, delta=1e-6)
            self.assertLessEqual(row["wrong"], 2)
            self.assertGreater(row["proved_by_all"], 50)
            self.assertIn(row["kind"], result.stdout)
        primary, diffuse, shadow = rows
        # The room is closed.
        self.assertEqual((primary["rays"], primary["hits"]), (64 * 48, 64 * 48))
        self.assertEqual((diffuse["rays"], diffuse["hits"]), (64 * 48, 64 * 48))
        self.assertTrue(0 < shadow["hits"] < shadow["rays"] < 64 * 48, shadow)
        self.assertEqual(primary["clock"], "wall clock")
        self.assertLess(primary["gpu_bytes_per_triangle"], 160)

    def test_spheres_and_open_scenes_are_traced_too(self):
        _, (primary, diffuse, _) = self.lines("traversal", SCENES / "sphere-plane.gltf", *RAYS, "--traversal", "bvh")
        self.assertTrue(0 < primary["hits"] < primary["rays"])
        self.assertEqual(diffuse["rays"], primary["hits"])
        self.assertIn("bvh", primary["variant"])

    def test_compute_traces_them_as_on_a_gpu(self):
        for kind in self.lines("traversal", ROOM, *RAYS, "--dispatch", "compute", "--tune", "gpu")[1]:
            self.assertIn("+compute+gpu", kind["variant"])
            self.assertLessEqual(kind["wrong"], 2)
            self.assertGreater(kind["hits"], 0)

    def test_long_triangles_in_pieces(self):
        """Rods of four sides at all angles. Their tree in pieces finds what double precision finds, at fewer steps than one of whole triangles:
        such is that of a file with an animation, whose poses refit it."""
        draw = random.Random(5)
        points, indices = [], []
        for _ in range(500):
            middle, along = ([draw.uniform(-1, 1) for _ in range(3)] for _ in range(2))
            across = [[0.004 * (axis == i) for axis in range(3)] for i in range(2)]
            first = len(points)
            points += [[m + end * a + u * c + v * d for m, a, c, d in zip(middle, along, *across)] for end in (-1, 1) for u in (-1, 1) for v in (-1, 1)]
            indices += [first + i for a, b, c, d in ((0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6)) for i in (a, b, c, a, c, d)]
        gltf = Gltf(materials=[{"doubleSided": True}])
        gltf.node(mesh=gltf.mesh(gltf.accessor(indices, "I"), position=gltf.accessor(points), material=0))
        gltf.node(name="nothing")
        view = ["--camera-position", "0,0,5", "--camera-focal-point", "0,0,0", "--resolution", "32,32", "--spp", 2, "--quiet", "--count-work"]

        def drawn(name):
            scene, stats = gltf.write(self.folder / f"{name}.gltf"), self.folder / "s.json"
            self.renders(scene, "-o", self.folder / f"{name}.pfm", *view, "--stats", stats)
            return scene, (self.folder / f"{name}.pfm").read_bytes(), json.loads(stats.read_text())

        scene, picture, told = drawn("pieces")
        gltf.moves(1, [0, 1], translation=[[0, 0, 0], [1, 0, 0]])
        _, same, whole = drawn("whole")
        self.assertEqual(picture == same, True)
        self.assertGreater(told["bvh"]["leaves"], 1.4 * whole["bvh"]["leaves"])
        self.assertLess(told["work"]["node_steps"], 0.9 * whole["work"]["node_steps"])
        for row in self.lines("traversal", scene, *RAYS)[1]:
            self.assertLessEqual(row["wrong"], 2)

    def test_the_plain_tracer_finds_the_same(self):
        result, rows = self.lines("traversal", ROOM, *RAYS, "--plain")
        for row in rows:
            self.assertEqual(len(row["plain_ms"]), 2)
            self.assertLessEqual(row["plain_wrong"], 2)
        self.assertEqual(result.stdout.count("by the plain tracer"), 3)
        self.fails(3, "bench", "traversal", SCENES / "sphere-plane.gltf", *RAYS, "--plain", says=["spheres"])
        folder = self.broken("entry/plain.glsl", "b >= 0.0 && ", "b >= 0.3 && ")
        self.fails(1, "bench", "traversal", ROOM, *RAYS, "--plain", "--shader-folder", folder, says=["rays hit something else"])

    def test_rays_are_written_for_others(self):
        path = self.folder / "rays"
        _, rows = self.lines("traversal", ROOM, *RAYS, "--rays", path)
        data = path.read_bytes()
        self.assertEqual(data[:8], b"FTRAYS1\0")
        triangles, rays = struct.unpack_from("<2I", data, 8)
        self.assertEqual((triangles, rays), (69326, 64 * 48))
        self.assertEqual(len(data), 16 + 36 * triangles + 3 * 32 * rays)
        for number, row in enumerate(rows):
            at = 16 + 36 * triangles + number * 32 * rays
            found = [struct.unpack_from("<8f", data, at + 32 * i) for i in range(rays)]
            there = [ray for ray in found if ray[3] > 0]
            self.assertEqual((len(there), sum(ray[7] >= 0 for ray in there)), (row["rays"], row["hits"]))
            for ray in there[:100]:
                self.assertAlmostEqual(math.hypot(*ray[4:7]), 1, delta=1e-5)
        self.fails(3, "bench", "traversal", SCENES / "sphere-plane.gltf", *RAYS, "--rays", path, says=["spheres"])

    def test_wrong_hits_fail(self):
        for name, old, new in (("tree/leaf.glsl", "bool hita = ", "bool hita = s.slot < 0 && "),
                               ("slab.glsl", "floatBitsToInt(far) + 32", "floatBitsToInt(0.9f * far)")):
            with self.subTest(new):
                folder = self.broken(name, old, new)
                self.fails(1, "bench", "traversal", ROOM, *RAYS, "--shader-folder", folder, says=["rays hit something else"])
                shutil.rmtree(folder)

    def test_refusals(self):
        self.fails(2, "bench", "traversal", ROOM, *RAYS, "--traversal", "iterative", says=["iterative"])
        self.fails(2, "bench", "traversal", ROOM, *RAYS, "--camera-index", 3, says=["--camera-index"])
        self.fails(3, "bench", "traversal", self.folder / "none.gltf", *RAYS, says=["none.gltf"])
        self.fails(1, "bench", "traversal", ROOM, *RAYS, "--rays", self.folder / "no" / "rays", says=["rays"])
        self.fails(2, "bench", "traversal", ROOM, *RAYS, "--json", ROOM, says=["room-ball"])


class GpuMemory(Bench):
    def test_bytes_a_triangle_are_stated(self):
        stats = self.folder / "s.json"
        self.renders(ROOM, "-o", self.folder / "p.pfm", *SMALL, "--stats", stats)
        told = json.loads(stats.read_text())
        info = json.loads(run("info", ROOM, "--json").stdout)
        # `render` may keep the largest triangles beside the tree.
        self.assertAlmostEqual(info["gpu_bytes_per_triangle"], told["gpu_bytes_per_triangle"], delta=0.1)
        self.assertTrue(60 < told["gpu_bytes_per_triangle"] < 160, told["gpu_bytes_per_triangle"])
        self.assertLessEqual(told["gpu_bytes_per_triangle"] * 69326, told["scene_bytes"])
        self.assertNotIn("buffer_reads_fallback", told)
        self.assertIn("bytes per triangle", run("info", ROOM, "--verbose").stdout)
        self.assertNotIn("bytes per triangle", run("info", SCENES / "sphere-black.gltf", "--verbose").stdout)
        self.renders(SCENES / "sphere-black.gltf", "-o", self.folder / "p.pfm", *SMALL, "--stats", stats)
        self.assertNotIn("gpu_bytes_per_triangle", json.loads(stats.read_text()))


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Scenes without a camera: all of the object is in the picture, and part of it is seen; otherwise a message says so."""
import json
import math
import os
import unittest
from pathlib import Path

from support import BACKENDS, Case, Exr, Gltf, main, quad, run

ASSETS = Path(os.environ.get("FRAGTRACE_ASSETS", "/work/shared/assets")) / "scenes"


class FramingCase(Case):
    def alphas(self, scene, *options):
        """Rows of alpha, and what was said."""
        path = self.folder / "x.exr"
        result = self.renders(scene, "-o", path, "--stage", "flat", "--spp", 4, "--no-background", *options)
        return Exr(path).layers["A"], result.stderr

    def write(self, scale, rotation=(0, 0, 0, 1), double_sided=True):
        """Makes a quad of 2 x 2 m, scaled and then turned, without a camera."""
        gltf = quad({"doubleSided": double_sided})
        gltf["nodes"] = [{"mesh": 0, "scale": scale, "rotation": rotation}]
        gltf["scenes"] = [{"nodes": [0]}]
        for name in ("images", "textures", "cameras"):
            gltf.pop(name)
        return self.written("scene.gltf", gltf)

    def assert_inside(self, alphas):
        edge = [*alphas[0], *alphas[-1], *(row[0] for row in alphas), *(row[-1] for row in alphas)]
        self.assertEqual(max(edge), 0)
        self.assertGreater(max(map(max, alphas)), 0)


class Framing(FramingCase):
    def test_no_pixel_of_the_edge_shows_the_object(self):
        for scale in ((3, 1, 1), (1, 3, 1), (1, 1, 1)):
            for size in ("60,120", "120,60", "48,192"):
                for backend in BACKENDS if size == "60,120" else ("egl",):
                    alphas, said = self.alphas(self.write(scale), "--resolution", size, "--rendering-backend", backend)
                    self.assert_inside(alphas)
                    self.assertNotIn("shows nothing", said)

    def test_fit_leaves_a_narrow_margin(self):
        for scale, size in (((3, 1, 0.2), (60, 40)), ((0.1, 5, 1), (40, 60))):
            for options in (("--camera-orbit", "30,20"), ("--camera-orbit", "-100,-50,1"), ("--camera-parallel-scale", 1)):
                alphas, _ = self.alphas(self.write(scale), "--resolution", "%d,%d" % size, "--fit", *options)
                rows = [y for y, row in enumerate(alphas) if max(row) > 0]
                columns = [x for x in range(size[0]) if max(row[x] for row in alphas) > 0]
                margin = min(min(columns) / size[0], 1 - (max(columns) + 1) / size[0],
                             min(rows) / size[1], 1 - (max(rows) + 1) / size[1])
                self.assertGreaterEqual(margin, 0, (scale, options))
                self.assertLess(margin, 0.05, (scale, options))

    def test_what_lies_far_off_is_named(self):
        """The scene is a grid of 200 triangles, and a quad or a vertex of the grid far from it."""
        def write(vertex=0.0, quad_at=0.0, camera=False):
            gltf = Gltf(quad({}))
            places = [(x / 10, y / 10, 0.0) for y in range(11) for x in range(11)]
            places[60] = (*places[60][:2], vertex)
            corners = [c for y in range(10) for x in range(10) for a in [11 * y + x] for c in (a, a + 1, a + 12, a, a + 12, a + 11)]
            gltf.mesh(gltf.accessor(corners, "H"), position=gltf.accessor(places))
            gltf.root["nodes"] = [{"mesh": 0, "name": "dust", "translation": [quad_at, 0, 0]}, {"mesh": 1, "name": "model"}, {"camera": 0}]
            gltf.root["scenes"] = [{"nodes": [0, 1, 2] if camera else [0, 1]}]
            for name in ("images", "textures"):
                del gltf.root[name]
            return gltf.write(self.folder / "scene.gltf")

        tiny = ("--resolution", "8,8", "--spp", 1, "--stage", "flat")
        for options in ({}, {"quad_at": 50}):
            self.assertNotIn("reaches", run("info", write(**options)).stderr)
        for options, said in (({"quad_at": 500}, r'node "dust" reaches \d+ times .* framed; --hide 0 leaves the node out'),
                              ({"vertex": 500}, r'node "model" reaches \d+ times .* framed: a vertex of its mesh lies far off')):
            scene = write(**options)
            for stderr in (self.renders(scene, "-o", self.folder / "x.png", *tiny, "--fit").stderr, run("info", scene).stderr):
                self.assertRegex(stderr, f"{scene}: {said}")
        # One point in a hundred does not decide the default view.
        near = self.alphas(write(), "--resolution", "24,16")[0]
        stray, said = self.alphas(write(vertex=500), "--resolution", "24,16")
        self.assertIn("leaves out 1 point of the scene, far away from all others; --fit", said)
        self.assertNotIn("reaches", said)
        self.assertLess(abs(sum(map(sum, near)) - sum(map(sum, stray))), 0.15 * sum(map(sum, near)))
        said = self.renders(write(quad_at=500, camera=True), "-o", self.folder / "x.png", *tiny, "--fit").stderr
        self.assertIn("this view shows nothing of the scene; --camera-position", said)
        self.assertNotIn("reaches", run("info", write(quad_at=500), "--hide", 0).stderr)
        # A camera of the file frames nothing.
        self.assertNotIn("reaches", self.renders(write(quad_at=500, camera=True), "-o", self.folder / "x.png", *tiny).stderr)

    def test_a_part_is_framed_by_name(self):
        """Two quads of 2 m and 0.2 m, a node each, the smaller one below another node and with a material of its own."""
        gltf = Gltf(quad({"doubleSided": True, "name": "board"}))
        gltf.root["materials"].append({"name": "screw head", "doubleSided": True})
        small = json.loads(json.dumps(gltf.root["meshes"][0]))
        small["primitives"][0]["material"] = 1
        gltf.root["meshes"].append(small)
        gltf.root["nodes"] = [{"mesh": 0, "name": "wall"}, {"name": "Screws", "translation": [5, 0, 0], "children": [2]},
                              {"mesh": 1, "scale": [0.1, 0.1, 0.1]}, {"camera": 0}]
        gltf.root["scenes"] = [{"nodes": [0, 1, 3]}]
        for name in ("images", "textures"):
            gltf.root.pop(name, None)
        scene = gltf.write(self.folder / "scene.gltf")
        asked = ["--resolution", "40,40"]
        share = lambda *options: sum(map(sum, self.alphas(scene, *asked, *options)[0])) / 1600
        for name in ("wall", "Screws", "screws", "screw head", "board"):
            self.assertAlmostEqual(share("--fit-to", name), 0.95 ** 2, delta=0.03, msg=name)
            self.assertAlmostEqual(share("--fit-to", name, "--fill", 0.5), 0.25, delta=0.03, msg=name)
        self.assertLess(share("--fit"), 0.2)
        # An orbit looks at the part, and so does a turntable.
        self.assertGreater(share("--fit-to", "Screws", "--camera-orbit", "30,0"), 0.5)
        result = run("render", scene, "-o", self.folder / "x.png", "--fit-to", "bolt")
        self.assertEqual(result.returncode, 2)
        self.assertIn('--fit-to: "bolt" is no node and no material of the scene, which has "', result.stderr)
        result = run("render", scene, "-o", self.folder / "x.png", "--fit-to", "wall", "--hide", "wall")
        self.assertEqual(result.returncode, 2)
        self.assertIn("has nothing that is shown", result.stderr)

    def test_an_orbit_does_not_go_with_a_position(self):
        for options in (("--camera-position", "1,2,3"), ("--frames", "0:3", "--fit")):
            result = run("render", self.write((1, 1, 1)), "-o", self.folder / "x.##.png", "--camera-orbit", "1,2", *options)
            self.assertEqual(result.returncode, 2, result.stderr)

    def test_the_default_view_is_three_quarters_and_fills_the_frame(self):
        scene = self.write((1, 1, 0.2))
        asked = ["--resolution", "48,32"]
        default, _ = self.alphas(scene, *asked)
        self.assertEqual(default, self.alphas(scene, *asked, "--camera-orbit", "35,20", "--fit")[0])
        self.assertEqual(default, self.alphas(scene, *asked, "--fit")[0])
        angle = ["--camera-view-angle", 20]
        self.assertEqual(self.alphas(scene, *asked, *angle)[0], self.alphas(scene, *asked, *angle, "--camera-orbit", "35,20", "--fit")[0])
        # A point or a scale leaves nothing to fit.
        for own in (["--camera-focal-point", "0.5,0,0"], ["--camera-parallel-scale", 2]):
            self.assertEqual(self.alphas(scene, *asked, *own)[0], self.alphas(scene, *asked, *own, "--camera-orbit", "35,20")[0])

    def test_a_flat_object_is_not_seen_along_its_edge(self):
        """A floor, a wall, and a wall and a ceiling that hold the direction of the usual view, with a small thing on each."""
        half = 0.70710678
        azimuth = math.radians(125 / 2)
        slope = math.radians((90 + 19.4) / -2)
        for rotation in ((-half, 0, 0, half), (0, half, 0, half), (0, math.sin(azimuth), 0, math.cos(azimuth)), (math.sin(slope), 0, 0, -math.cos(slope))):
            scene = self.write((1, 1, 1), rotation)
            root = json.loads(scene.read_text())
            root["nodes"] += [{"mesh": 0, "scale": [0.04, 0.04, 0.04]}, {"mesh": 0, "scale": [0.04, 0.04, 0.04], "rotation": [-half, 0, 0, half]}]
            root["scenes"] = [{"nodes": [0, 1, 2]}]
            scene.write_text(json.dumps(root))
            alphas, said = self.alphas(scene, "--resolution", "48,48")
            self.assert_inside(alphas)
            self.assertGreater(sum(map(sum, alphas)), 0.12 * 48 * 48, rotation)
            self.assertNotIn("shows nothing", said)

    def test_a_default_view_that_shows_nothing_is_said(self):
        scene = self.write((1, 1, 1), (0, 1, 0, 0), double_sided=False)
        alphas, said = self.alphas(scene, "--resolution", "24,24")
        self.assertEqual(max(map(max, alphas)), 0)
        self.assertIn("default view shows nothing", said)
        _, said = self.alphas(scene, "--resolution", "24,24", "--camera-position", "0,0,9", "--camera-focal-point", "0,0,20")
        self.assertNotIn("default view", said)
        self.assertIn("this view shows nothing", said)


@unittest.skipUnless(ASSETS.is_dir(), f"{ASSETS} is absent")
class AssetFraming(FramingCase):
    def test_assets(self):
        for name, size in (("CornellBox/CornellBox.glb", "120,240"), ("TwoSidedPlane/TwoSidedPlane.gltf", "64,64")):
            alphas, said = self.alphas(ASSETS / name, "--resolution", size)
            self.assert_inside(alphas)
            self.assertNotIn("shows nothing", said)


if __name__ == "__main__":
    main()

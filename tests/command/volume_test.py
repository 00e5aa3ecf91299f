#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Grids of densities: closed forms, places, what is refused, and the same pictures by all ways to draw them."""
import json
import math
import random
import struct
import subprocess
import unittest
from pathlib import Path

from support import FRAGTRACE, SCENES, WHITE, Case, main, mean, run

# Beside the program, or in the build folder where a copy of it is tried.
MAKE_GRID = next((path for path in (FRAGTRACE.parent / "make_grid", SCENES.parent / "build/make_grid") if path.exists()), Path("/nowhere"))


@unittest.skipUnless(MAKE_GRID.exists(), "the program was built without the headers of NanoVDB")
class Volumes(Case):
    def grid(self, shape, *form, side=32):
        path = self.folder / f"{shape}{''.join(form)}{side}.nvdb"
        if not path.exists():
            subprocess.run([MAKE_GRID, shape, str(side), path, *form], check=True)
        return path

    def camera_alone(self, **extras):
        """Makes a scene of a camera 3 m before the origin, and a node with these extras."""
        gltf = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
                "cameras": [{"type": "perspective", "perspective": {"yfov": 0.6, "aspectRatio": 1, "znear": 0.01}}],
                "nodes": [{"camera": 0, "translation": [0, 0, 3]}, {"extras": extras} if extras else {"name": "empty"}]}
        return str(self.written(f"camera{len(list(self.folder.glob('camera*')))}.gltf", gltf).with_suffix(""))

    def seen(self, scene, *options, spp=64, size="16,16"):
        return self.picture(scene, "x.pfm", "--resolution", size, "--spp", spp, *options)

    def refused(self, reason, *options, status=3, scene=None):
        done = run("render", scene or self.camera_alone() + ".gltf", "-o", self.folder / "x.pfm", "--spp", 1, "--resolution", "8,8", *options)
        self.assertEqual(done.returncode, status, (options, done.stderr))
        self.assertIn(reason, done.stderr)
        self.assertEqual(sum(": warning: " not in line for line in done.stderr.splitlines()), 1, done.stderr)

    def test_a_grid_dims_by_its_depth(self):
        """Beer's law holds through the middle of a cube of 30 of 32 voxels, for two types and codecs."""
        for form in ((), ("zip", "fp8")):
            seen = self.seen(self.camera_alone(), *WHITE, "--volume", self.grid("box", *form), "--volume-density", 1.6, "--volume-color",
                             "0,0,0", "--camera-view-angle", 1, spp=4096)
            self.assertAlmostEqual(mean(seen) / math.exp(-1.6 * 30 / 32), 1, delta=0.002)

    def test_a_grid_that_only_scatters_is_not_seen_in_white_light(self):
        for anisotropy in (0, 0.7):
            seen = self.seen(self.camera_alone(), *WHITE, "--volume", self.grid("plume"), "--volume-density", 12, "--volume-anisotropy",
                             anisotropy, spp=256)
            self.assertAlmostEqual(mean(seen), 1, delta=0.002)

    def test_a_grid_glows_by_its_temperature(self):
        """A cube of one temperature that scatters nothing has (1 - exp(-depth)) of a black body's radiance."""
        def levels(density):
            seen = self.seen(self.camera_alone(), "--default-light", "none", "--background-color", "0,0,0", "--volume", self.grid("ember"),
                             "--volume-density", density, "--volume-color", "0,0,0", "--volume-emission", 1e-5, "--camera-view-angle", 1,
                             spp=1024)
            return [mean(seen, channel) for channel in range(3)]

        thin, thick = levels(1), levels(60)
        for channel in range(3):
            self.assertAlmostEqual(thin[channel] / thick[channel], 1 - math.exp(-30 / 32), delta=0.01)
        # The candela was once that of a black body at 2042 K: 600,000 cd/m^2.
        luminance = 0.2126 * thick[0] + 0.7152 * thick[1] + 0.0722 * thick[2]
        self.assertAlmostEqual(luminance / 6, 1, delta=0.03)

        # A cube as hot as its surroundings is invisible.
        equal = self.seen(self.camera_alone(), *WHITE, "--volume", self.grid("ember"), "--volume-density", 4, "--volume-color", "0.5,0.5,0.5",
                          "--volume-emission", 1e-5 / thick[0], spp=256)
        self.assertAlmostEqual(mean(equal), 1, delta=0.01)

    def test_place_and_scale(self):
        """A grid that is moved, scaled and made thinner for it looks as the one at the origin from as far away in proportion."""
        here = self.seen(self.camera_alone(), *WHITE, "--volume", self.grid("torus"), "--volume-density", 6, "--volume-color", "0.2,0.5,0.8",
                         spp=512)
        there = self.seen(self.camera_alone(), *WHITE, "--volume", self.grid("torus"), "--volume-density", 3, "--volume-color", "0.2,0.5,0.8",
                          "--volume-scale", 2, "--volume-position", "5,1,0", "--camera-position", "5,1,6", "--camera-focal-point", "5,1,0",
                          spp=512)
        for channel in range(3):
            self.assertAlmostEqual(mean(here, channel) / mean(there, channel), 1, delta=0.01)

    def test_a_node_brings_a_grid(self):
        grid = self.grid("ball")
        members = {"volume": grid.name, "density": 5, "color": [0.5, 0.25, 1], "anisotropy": 0.3, "position": [0.25, 0, 0], "scale": 0.5}
        of_node = self.seen(self.camera_alone(fragtrace_volume=members), *WHITE)
        of_options = self.seen(self.camera_alone(), *WHITE, "--volume", f"{grid}:density", "--volume-density", 5, "--volume-color",
                               "0.5,0.25,1", "--volume-anisotropy", 0.3, "--volume-position", "0.25,0,0", "--volume-scale", 0.5)
        self.assertEqual(of_node, of_options)
        told = json.loads(run("info", "--json", self.camera_alone(fragtrace_volume=members) + ".gltf").stdout)
        self.assertEqual(told["scene"]["bounds"], {"min": [0.0078125, -0.2421875, -0.2421875], "max": [0.5078125, 0.2578125, 0.2578125]})
        self.assertEqual(told["volume_bytes"], 8 * (5**3 + 128 * told["scene"]["volume_bricks"]))
        self.refused("/nodes/1/extras/fragtrace_volume/density", scene=self.camera_alone(fragtrace_volume={**members, "density": -1}) + ".gltf")
        self.refused("/nodes/1/extras/fragtrace_volume/volume",
                     scene=self.camera_alone(fragtrace_volume={**members, "volume": "../x.nvdb"}) + ".gltf")

        # Options change the numbers of a node, and stand for a file that is missing.
        changed = self.seen(self.camera_alone(fragtrace_volume={**members, "density": 1, "color": [1, 1, 1]}), *WHITE, "--volume-density", 5,
                            "--volume-color", "0.5,0.25,1")
        self.assertEqual(changed, of_options)
        missing = self.camera_alone(fragtrace_volume={"volume": "missing.nvdb"})
        self.refused("missing.nvdb", scene=missing + ".gltf")
        self.seen(missing, *WHITE, "--volume", grid, spp=1)

    def test_what_a_grid_does_not_do_is_said(self):
        def warns(reason, *options, **extras):
            scene = self.camera_alone(**({"fragtrace_volume": {"volume": self.grid("plume").name, **extras}} if extras else {}))
            done = run("render", scene + ".gltf", "-o", self.folder / "x.pfm", "--spp", 1, "--resolution", "8,8", *WHITE, *options)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(reason, done.stderr)

        warns("/nodes/1/extras/fragtrace_volume/densty: is no member of a volume", densty=14)
        warns("only stage gi has grids", "--stage", "phong", density=14)
        warns("only stage gi has grids", "--stage", "phong", "--volume", self.grid("plume"))
        warns("the color 1,1,1 absorbs none", emission=1e-5)
        flat = Path(self.camera_alone(fragtrace_volume={"volume": self.grid("plume").name}) + ".gltf")
        gltf = json.loads(flat.read_text())
        gltf["nodes"][1]["scale"] = [1, 0, 1]
        flat.write_text(json.dumps(gltf))
        self.assertIn("the grid's node has no size", run("render", flat, "-o", self.folder / "x.pfm", "--spp", 1, "--resolution", "8,8").stderr)
        warns("paths are long", "--volume-density", 500, density=1)
        self.refused("its plane stands in clear air, but the scene brings a grid", "--shadow-catcher", "bottom", status=2,
                     scene=self.camera_alone(fragtrace_volume={"volume": self.grid("plume").name}) + ".gltf")

    def test_the_camera_fits_it(self):
        """The box of a grid far away is in the picture."""
        seen = self.seen(self.camera_alone(), *WHITE, "--volume", self.grid("ball"), "--volume-position", "40,0,0", "--volume-color", "0,0,0",
                         "--volume-density", 100, "--camera-orbit", "0,0", "--fit", spp=4, size="32,32")
        self.assertLess(mean(seen), 0.8)
        self.assertAlmostEqual(seen[0][0][0], 1, delta=1e-3)

    def test_all_ways_to_draw_it(self):
        """The same bits by all entries, schedules and reads; a region is that of the whole picture."""
        options = ["--volume", self.grid("plume"), "--volume-density", 20, "--volume-color", "0.9,0.8,0.7", "--fog-density", 0.2, "--seed", 3]
        scene = self.camera_alone()
        whole = self.seen(scene, *options, spp=8)
        for way in (["--dispatch", "compute"], ["--schedule", "wavefront"], ["--tune", "gpu"], ["--buffer-reads", "ssbo"]):
            self.assertEqual(self.seen(scene, *options, *way, spp=8), whole, way)
        self.assertEqual(self.seen(scene, *options, "--region", "4,2,8,6", spp=8), [row[4:12] for row in whole[2:8]])

    def test_what_is_listed(self):
        done = run("info", self.grid("plume"))
        self.assertIn('grid        "density" (float), 22 x 30 x 22 voxels, 4708 active', done.stdout)
        grids = json.loads(run("info", "--json", self.grid("plume", "zip", "fp8")).stdout)["grids"]
        self.assertEqual([grid["name"] for grid in grids], ["density", "temperature"])
        self.assertTrue(all(grid["density"] for grid in grids))
        self.assertEqual(grids[0]["bounds"], {"min": [-0.484375] * 3, "max": [0.515625] * 3})
        self.assertAlmostEqual(grids[0]["largest"], 1.12, delta=0.01)

    def test_bad_grids(self):
        self.refused("is not finite", "--volume", self.grid("nan"))
        self.refused("is not finite", "--volume", self.grid("infinite"))
        self.refused("holds no densities (float, a level set)", "--volume", self.grid("levelset"))
        self.refused("has no grid 'heat', but 'density', 'temperature'", "--volume", f"{self.grid('plume')}:heat")
        self.refused("has no grid 'temperature'", "--volume", self.grid("ball"), "--volume-emission", 1)
        self.refused("--volume-density: goes with --volume, or with a scene", "--volume-density", 2, status=2)
        self.refused("is not glTF; --volume places it", scene=self.grid("plume"))
        self.refused("cannot be combined with --shadow-catcher", "--volume", self.grid("ball"), "--shadow-catcher", "bottom", status=2)
        self.refused("--volume-color: a colour is in the range 0 to 1", "--volume", self.grid("ball"), "--volume-color", "2,1,1", status=2)
        self.refused("missing.nvdb", "--volume", self.folder / "missing.nvdb")
        self.refused("box64.nvdb", "--volume", self.grid("box", side=64), "--memory-limit", "1MB")
        text = self.folder / "text.nvdb"
        text.write_text("this is no grid, but a text that is long enough to be one\n" * 20)
        self.refused("text.nvdb", "--volume", text)
        later = self.folder / "later.nvdb"
        data = bytearray(self.grid("ball").read_bytes())
        struct.pack_into("<I", data, 8, 37 << 21)  # the version, whose major number counts
        later.write_bytes(data)
        self.refused("against the newer version", "--volume", later)

    def test_grids_with_little_in_them(self):
        empty = run("render", self.camera_alone() + ".gltf", "-o", self.folder / "x.pfm", "--spp", 1, "--resolution", "8,8", "--volume",
                    self.grid("empty"))
        self.assertEqual(empty.returncode, 0)
        self.assertIn("the grid has no density above 0", empty.stderr)
        # A voxel of 1 is a tent of twice its width, of which a ray through the middle meets as much as the voxel is wide.
        seen = self.seen(self.camera_alone(), *WHITE, "--volume", self.grid("one", side=1), "--volume-color", "0,0,0", "--camera-view-angle",
                         0.05, spp=4096)
        self.assertAlmostEqual(mean(seen) / math.exp(-1), 1, delta=0.004)

    def test_damaged_files(self):
        """Cut, or with other bytes: drawn, or refused with the file's name, and nothing else."""
        draw = random.Random(5)
        whole = self.grid("plume", "none", "fp8").read_bytes()
        path = self.folder / "damaged.nvdb"
        for number in range(24):
            damaged = bytearray(whole)
            if number % 3 == 0:
                damaged = damaged[:draw.randrange(len(whole))]
            else:
                for _ in range(draw.choice((1, 4, 64))):
                    place = draw.randrange(len(whole) if number % 3 == 1 else 2000)
                    damaged[place] = draw.choice((0, 255, draw.randrange(256)))
            path.write_bytes(damaged)
            done = run("render", self.camera_alone() + ".gltf", "-o", self.folder / "x.pfm", "--spp", 1, "--resolution", "4,4", "--volume", path,
                       "--memory-limit", "1GB")
            self.assertIn(done.returncode, (0, 3), (number, done.stderr))
            if done.returncode == 3:
                self.assertIn("damaged.nvdb", done.stderr)


if __name__ == "__main__":
    main()

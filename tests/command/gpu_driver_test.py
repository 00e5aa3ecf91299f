#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The way of GPUs (timers, two draws in flight, storage buffers), by llvmpipe under another name (tests/faults/failing_egl.cpp)."""
import json
import os

from failing_driver_test import STAND_IN, real_egl
from support import SCENES, Case, main


class GpuDriver(Case):
    def setUp(self):
        super().setUp()
        paths = ":".join(filter(None, [str(STAND_IN), os.environ.get("LD_LIBRARY_PATH")]))
        self.gpu = {**os.environ, "LD_LIBRARY_PATH": paths, "FRAGTRACE_REAL_EGL": real_egl(), "FRAGTRACE_FAIL_KIND": "gpu"}

    def render(self, name, scene, *options, env=None):
        path, stats = self.folder / f"{name}.pfm", self.folder / f"{name}.json"
        self.renders(SCENES / scene, "-o", path, "--quiet", "--rendering-backend", "egl", "--stats", stats, *options, env=env)
        return path.read_bytes(), json.loads(stats.read_text())

    def test_it_draws_the_same_bits(self):
        for scene, options in (("room-ball.gltf", ["--light-reuse", "spatial"]), ("caustics.gltf", [])):
            options = [*options, "--resolution", "70,10", "--spp", "2"]
            right, _ = self.render("software", scene, "--tune", "gpu", "--buffer-reads", "ssbo", "--schedule", "megakernel", "--dispatch", "fragment", *options)
            found, stats = self.render("gpu", scene, *options, env=self.gpu)
            self.assertEqual(stats["gl_renderer"], "a GPU that is not there")
            self.assertEqual(found, right, scene)

    def test_a_tile_of_many_draws_takes_the_time_of_its_draws(self):
        """Each wait once slept for half the time of the whole tile: 64 samples took 95 s, and did nothing."""
        options = ["--resolution", "32,32", "--spp", "64", "--schedule", "wavefront"]
        _, software = self.render("software", "cornell-box.gltf", "--tune", "gpu", *options)
        _, stats = self.render("gpu", "cornell-box.gltf", *options, env=self.gpu)
        self.assertEqual(stats["schedule"], "wavefront")
        self.assertLess(stats["render_ms"], 1000 + 10 * software["render_ms"])


if __name__ == "__main__":
    main()

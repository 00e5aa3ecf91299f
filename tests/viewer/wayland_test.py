#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The viewer on native Wayland: weston in a window of the display, which hands on its keys; a compositor without a seat; none at all.

GLFW has Wayland from 3.4 on, which Debian 13 has; with an older one these tests are skipped.
"""
import ctypes
import shutil
import socket
import subprocess
import tempfile
import unittest
from pathlib import Path

from support import FRAGTRACE, SCENES, Case, Viewer, main, wait_for

FEW = ["--resolution", "320,240", "--spp", "2"]


def why_not():
    try:
        platform_supported = ctypes.CDLL("libglfw.so.3").glfwPlatformSupported
    except (OSError, AttributeError):
        return "GLFW has no Wayland before 3.4"
    if not platform_supported(0x00060003):  # GLFW_PLATFORM_WAYLAND
        return "this GLFW is built without Wayland"
    return "" if shutil.which("weston") else "weston is not installed"


@unittest.skipIf(why_not(), why_not())
class Wayland(Case):
    def compositor(self, backend):
        """The environment of a program that runs in a new weston."""
        runtime = tempfile.TemporaryDirectory()
        self.addCleanup(runtime.cleanup)
        environment = {**self.screen.environment, "XDG_RUNTIME_DIR": runtime.name}
        process = subprocess.Popen(["weston", f"--backend={backend}", "--no-config", "--idle-time=0", "--socket=tests", "--width=1000", "--height=700"],
                                   env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.terminate)
        self.weston = process
        wait_for((Path(runtime.name) / "tests").exists, 30, "no socket of weston")
        environment["WAYLAND_DISPLAY"] = "tests"
        del environment["DISPLAY"]
        return environment

    def ends(self, environment):
        result = subprocess.run([FRAGTRACE, "view", SCENES / "furnace.gltf", *FEW], env=environment, capture_output=True, text=True, timeout=60)
        self.assertEqual(result.returncode, 4, result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        return result.stderr

    def viewer(self):
        viewer = Viewer(self.screen, self.folder, "sphere-plane", *FEW, wait=False, environment=self.compositor("x11"))
        self.addCleanup(viewer.errors.close)
        self.addCleanup(viewer.process.wait)
        self.addCleanup(viewer.process.kill)
        return viewer

    def test_it_draws_takes_keys_and_ends(self):
        viewer = self.viewer()
        status = viewer.rest()
        self.assertEqual((status["width"], status["height"]), (320, 240))
        libraries = Path(f"/proc/{viewer.process.pid}/maps").read_text()
        self.assertIn("/libdecor-", libraries)
        self.assertRegex(libraries, r"/libdecor/.*\.so", "a plugin draws the title bar")
        viewer.key("3")
        viewer.until(lambda s: s["camera"] != status["camera"], "a key is taken")
        viewer.key("Escape", "Escape")
        self.ends_well(viewer, viewer.end())
        self.assertEqual(viewer.stderr(), "")

    def test_a_compositor_that_ends_is_4_and_said(self):
        viewer = self.viewer()
        viewer.rest()
        self.weston.kill()
        self.assertEqual(viewer.end(), 4, viewer.stderr())
        self.assertIn("the display is gone", viewer.stderr())

    def test_a_compositor_without_a_seat_is_4_and_says_so(self):
        self.assertIn("no seat", self.ends(self.compositor("headless")))

    def test_what_is_no_compositor_is_4_and_says_so(self):
        environment = {key: value for key, value in self.screen.environment.items() if key not in ("DISPLAY", "XDG_RUNTIME_DIR")}
        silent = self.folder / "silent"
        listener = socket.socket(socket.AF_UNIX)
        self.addCleanup(listener.close)
        listener.bind(str(silent))
        listener.listen()
        for name, says in (("nowhere", "XDG_RUNTIME_DIR is not set"), (self.folder / "nowhere", "no compositor"), (silent, "does not answer")):
            self.assertIn(says, self.ends({**environment, "WAYLAND_DISPLAY": str(name)}))


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The viewer on native Wayland: weston in a window of the display, which hands on its keys and the mouse; displays of many dots an inch; a
compositor without a seat; none at all.

GLFW has Wayland from 3.4 on, which Debian 13 has; with an older one these tests are skipped.
"""
import ctypes
import shutil
import socket
import subprocess
import tempfile
import unittest
from pathlib import Path

from support import FRAGTRACE, SCENES, Case, Viewer, main, pixels_of, wait_for

FEW = ["--resolution", "320,240", "--spp", "2"]
OUTPUTS = """
[output]
name=X1
mode=480x600
[output]
name=X2
mode=430x380
scale=2
"""


def why_not():
    try:
        platform_supported = ctypes.CDLL("libglfw.so.3").glfwPlatformSupported
    except (OSError, AttributeError):
        return "GLFW has no Wayland before 3.4"
    if not platform_supported(0x00060003):  # GLFW_PLATFORM_WAYLAND
        return "this GLFW is built without Wayland"
    return "" if shutil.which("weston") else "weston is not installed"


class InWeston(Viewer):
    """A viewer whose places are pixels of its own window in that of weston."""
    corner = (0, 0)

    def at(self, x, y):
        super().at(x + self.corner[0], y + self.corner[1])

    def leave(self):
        """Moves the mouse out of the viewer, to the panel of weston."""
        self.xdotool("mousemove", "--window", self.id, 1, 1)
        self.until(lambda s: s["mouse"] is None, "no mouse")

    def find(self, window):
        """Finds the viewer in a window of weston, by the red ball that it shows there."""
        self.id, self.corner = window, (0, 0)
        def ball():
            width, _, pixels = self.grab()
            red = [i for i, (r, g, b) in enumerate(pixels) if r > 120 and g < 90 and b < 70]
            return red and (red[len(red) // 2] % width, red[len(red) // 2] // width)
        point = self.wait(ball, 30, "no ball")
        self.leave()
        # GLFW tells no place when the mouse comes.
        self.at(point[0] + 1, point[1])
        self.until(lambda s: s["mouse"], "the mouse")
        self.at(*point)
        mouse = self.until(lambda s: any(s["mouse"] or ()), "the mouse")["mouse"]
        self.corner = point[0] - round(mouse[0]), point[1] - round(mouse[1])
        return round(mouse[0]), round(mouse[1])


@unittest.skipIf(why_not(), why_not())
class Wayland(Case):
    def compositor(self, backend, *words):
        """The environment of a program that runs in a new weston."""
        runtime = tempfile.TemporaryDirectory()
        self.addCleanup(runtime.cleanup)
        environment = {**self.screen.environment, "XDG_RUNTIME_DIR": runtime.name}
        process = subprocess.Popen(["weston", f"--backend={backend}", "--idle-time=0", "--socket=tests", *words],
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

    def viewer(self, environment=None):
        environment = environment or self.compositor("x11", "--no-config", "--width=1000", "--height=700")
        viewer = InWeston(self.screen, self.folder, "sphere-plane", *FEW, wait=False, environment=environment)
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

    def windows(self, count):
        """The windows of weston, one for each output, from left to right."""
        def found():
            return subprocess.run(["xdotool", "search", "--onlyvisible", "--class", "Weston Compositor"], env=self.screen.environment,
                                  capture_output=True, text=True).stdout.split()
        wait_for(lambda: len(found()) == count, 10, "the windows of weston")
        return [int(window) for window in found()]

    def lengths_are_pixels(self, scale):
        viewer = self.viewer(self.compositor("x11", "--no-config", "--width=600", "--height=450", f"--scale={scale}"))
        status = viewer.rest()
        self.assertEqual((status["width"], status["height"]), (320, 240))
        self.assertEqual(status["places"]["status"], [0, 240 + 28 * scale, 320, 24 * scale])
        ball = viewer.find(*self.windows(1))
        viewer.at(ball[0] - 50, ball[1] - 40)
        viewer.until(lambda s: s["mouse"] == [ball[0] - 50, ball[1] - 40], "the mouse")
        viewer.click("stage shadows")
        viewer.rest(lambda s: "gi" not in s["sides"][0]["stages"], "stages less")
        viewer.key("shift+F7")
        viewer.rest(lambda s: "gi" in s["sides"][0]["stages"], "all stages")
        viewer.leave()
        width, _, pixels = viewer.grab()
        rows = [pixels[width * y + viewer.corner[0]:width * y + viewer.corner[0] + 320] for y in range(viewer.corner[1], viewer.corner[1] + 240)]
        self.same([pixel for row in rows for pixel in row], pixels_of(self.render("sphere-plane", *FEW)), ties=100)
        viewer.key("Escape", "Escape")
        self.ends_well(viewer, viewer.end())

    def test_all_lengths_are_pixels(self):
        self.lengths_are_pixels(1)

    def test_all_lengths_are_pixels_where_there_are_many(self):
        self.lengths_are_pixels(2)

    def test_it_goes_to_a_screen_of_another_scale_and_back(self):
        """A window that lies on both has the larger scale."""
        config = self.folder / "weston.ini"
        config.write_text(OUTPUTS)
        environment = self.compositor("x11", f"--config={config}", "--output-count=2")
        first, second = self.windows(2)
        self.screen.call("xdotool", "windowmove", first, 0, 0, "windowmove", second, 500, 0, "mousemove", "--window", first, 240, 300)
        viewer = self.viewer(environment)
        status = viewer.rest()
        for places, width, scale in ((range(250, 500, 50), 640, 2), (range(400, 100, -50), 320, 1)):
            self.assertEqual(status["places"]["status"][3], 24 * (3 - scale))
            viewer.at(*viewer.find(first))
            viewer.xdotool("keydown", "Super_L", "mousedown", 1)
            for x in places:
                viewer.xdotool("mousemove", "--window", first, x, 300, "sleep", 0.05)
            viewer.xdotool("mouseup", 1, "keyup", "Super_L")
            status = viewer.rest(lambda s, width=width: s["width"] == width, "the other size")
            self.assertEqual(status["places"]["status"][2:], [width, 24 * scale])
        viewer.key("Escape", "Escape")
        self.ends_well(viewer, viewer.end())

    def test_a_compositor_that_ends_is_4_and_said(self):
        viewer = self.viewer()
        viewer.rest()
        self.weston.kill()
        self.assertEqual(viewer.end(), 4, viewer.stderr())
        self.assertIn("the display is gone", viewer.stderr())

    def test_a_compositor_without_a_seat_is_4_and_says_so(self):
        self.assertIn("no seat", self.ends(self.compositor("headless", "--no-config")))

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

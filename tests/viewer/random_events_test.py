#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The viewer under random events: keys, mouse, drops, sizes, reloads, lost contexts. It must stay, without an error of OpenGL.

FRAGTRACE_RANDOM_SECONDS and FRAGTRACE_RANDOM_SEED say how long and which; FRAGTRACE_RANDOM_LOG names a file for the memory over time:
resident, and in use on the heap. With AddressSanitizer: build with -DFRAGTRACE_SANITIZE=ON -DFRAGTRACE_SANITIZE_ALL=ON.
"""
import os
import random
import re
import statistics
import subprocess
import time
from pathlib import Path

from animation_test import animated
from support import FRAGTRACE, SCENES, Case, main
from xdnd import drop

SECONDS = float(os.environ.get("FRAGTRACE_RANDOM_SECONDS", "10"))
SEED = int(os.environ.get("FRAGTRACE_RANDOM_SEED", "1"))
KEYS = [*"fcrui123456789jklmnptvxz", "space", "Tab", "h", "F1", "question", "F2", "F3", "F4", "F5", "F6", "F7", "F8", "F9", "F10", "shift+F11",
        "shift+F2", "shift+F4", "shift+F7", "Return", "Page_Up", "Page_Down", "ctrl+0", "ctrl+7", "ctrl+c", "ctrl+v", "ctrl+z", "ctrl+y",
        "ctrl+shift+z", "g", "b", "bracketleft", "bracketright", "shift+l", "shift+v", "shift+n", "shift+p", "Up", "equal", "minus", "w", "a", "s",
        "d", "q", "e", "F11", "F12", "shift+F12", "ctrl+o"]
DROPS = ["sphere-plane.gltf", "cornell-box.gltf", "water-cube.gltf", "furnace.gltf", "sky.pfm", "README.md"]
MOST_GROWTH = 1.1  # limit of memory's growth from the tenth minute on


def resident_megabytes(pid):
    text = Path(f"/proc/{pid}/status").read_text()
    return int(re.search(r"VmRSS:\s*(\d+)", text).group(1)) / 1024


class RandomEvents(Case):
    def setUp(self):
        super().setUp()
        libraries = subprocess.run(["/sbin/ldconfig", "-p"], capture_output=True, text=True, check=True).stdout
        self.lose = self.folder / "lose"
        whole = dict(self.screen.environment)
        self.addCleanup(self.screen.environment.update, whole)
        paths = [str(FRAGTRACE.parent / "failing_egl"), os.environ.get("LD_LIBRARY_PATH")]
        self.screen.environment.update({
            "FRAGTRACE_REAL_EGL": re.search(r"libEGL\.so\.1 .*=> (\S+)", libraries).group(1),
            "FRAGTRACE_FAIL_WHEN": str(self.lose), "FRAGTRACE_HEAP_LOG": str(self.folder / "heap"),
            "LD_LIBRARY_PATH": ":".join(filter(None, paths))})

    def test_nothing_ends_it(self):
        self.random = random.Random(SEED)
        moving = animated(self.folder)
        broken = self.folder / "broken.gltf"
        broken.write_text("{")
        self.drops = [*(SCENES / name for name in DROPS), moving, broken]
        viewer = self.view("cornell-box", "--rendering-backend", "egl", "--resolution", "320,240", "--denoise", "variance", "--spp", "64", "--watch")
        acts = {self.press: 12, self.drag: 6, self.wheel: 3, self.click: 4, self.click_place: 6, self.drop: 2, self.resize: 1, self.lost: 0.3,
                self.type: 1, self.breathe: 1}
        began = time.monotonic()
        memory, done, asked, alive = [], 0, None, began
        while time.monotonic() - began < SECONDS:
            act = self.random.choices(list(acts), list(acts.values()))[0]
            try:
                act(viewer)
            except subprocess.CalledProcessError:
                time.sleep(1)  # without a window; whether the viewer has ended is seen below
            done += 1
            if viewer.status().get("asked") != asked:
                asked, alive = viewer.status().get("asked"), time.monotonic()
            self.assertLess(time.monotonic() - alive, 180, f"it no longer answers after {done} events of seed {SEED}")
            self.assertIsNone(viewer.process.poll(), f"ended with {viewer.process.returncode} after {done} events of seed {SEED}: {viewer.stderr()}")
            if not memory or time.monotonic() - began >= memory[-1][0] + 10:
                memory.append((time.monotonic() - began, resident_megabytes(viewer.process.pid), int((self.folder / "heap").read_text().split()[-1])))
                for picture in [*self.folder.glob("*.png"), *self.folder.glob("*.exr")]:
                    picture.unlink()
                self.log(f"{memory[-1][0]:.0f} s, {done} events, {memory[-1][1]:.0f} MB resident, {memory[-1][2]} MB in use, {viewer.status().get('state')}")
        self.assertEqual(viewer.status()["gl_errors"], [])
        self.assertNotIn("Sanitizer", viewer.stderr())
        every = max(1, len(memory) // 12)
        print(f"{done} events in {time.monotonic() - began:.0f} s; MB resident/in use " + ", ".join(f"{r:.0f}/{u}" for _, r, u in memory[::every]))
        settled = [m for m in memory if m[0] >= 600]
        half = len(settled) // 2
        for kind, what in ((1, "resident"), (2, "in use")):
            if half >= 20:
                first, last = (statistics.median(m[kind] for m in part) for part in (settled[:half], settled[half:]))
                self.assertLess(last, MOST_GROWTH * first, f"memory {what} grows")
        try:
            status = viewer.close()
        except AssertionError:
            status = viewer.close()  # numbers that it has set are asked for once
        self.assertEqual(status, 0, viewer.stderr())
        self.assertNotIn("Sanitizer", viewer.stderr())

    def log(self, line):
        if "FRAGTRACE_RANDOM_LOG" in os.environ:
            with open(os.environ["FRAGTRACE_RANDOM_LOG"], "a") as file:
                file.write(line + "\n")

    def place(self, viewer):
        """Somewhere in the window; next to it would be the desktop's menus."""
        geometry = self.screen.call("xdotool", "getwindowgeometry", viewer.id)
        width, height = map(int, re.search(r"Geometry: (\d+)x(\d+)", geometry).groups())
        return self.random.randrange(width), self.random.randrange(height)

    def press(self, viewer):
        keys = self.random.choices(KEYS, k=self.random.randint(1, 4))
        viewer.xdotool("key", "--delay", self.random.choice([0, 20]), *keys)

    def drag(self, viewer):
        modifier = self.random.choice([None, None, "shift", "ctrl"])
        if modifier:
            viewer.xdotool("keydown", modifier)
        viewer.drag(self.place(viewer), self.place(viewer), self.random.randint(1, 3), self.random.randint(1, 8))
        if modifier:
            viewer.xdotool("keyup", modifier)

    def wheel(self, viewer):
        held = self.random.choice([None, None, "ctrl", "w"])
        viewer.at(*self.place(viewer))
        if held:
            viewer.xdotool("keydown", held)
        viewer.xdotool("click", "--repeat", self.random.randint(1, 5), "--delay", 5, self.random.choice([4, 5]))
        if held:
            viewer.xdotool("keyup", held)

    def click(self, viewer):
        viewer.at(*self.place(viewer))
        viewer.xdotool("click", "--repeat", self.random.randint(1, 2), "--delay", 30, self.random.randint(1, 3))

    def click_place(self, viewer):
        places = viewer.status().get("places") or {}
        names = sorted(places)
        if names:
            x, y, width, height = places[self.random.choice(names)]
            viewer.at(max(0, round(x + self.random.random() * width)), max(0, round(y + self.random.random() * height)))
            time.sleep(0.05)
            viewer.xdotool("click", 1)

    def drop(self, viewer):
        drop(self.screen, viewer.id, *self.random.sample(self.drops, self.random.randint(1, 2)))

    def resize(self, viewer):
        viewer.xdotool("windowsize", viewer.id, self.random.randint(60, 1300), self.random.randint(60, 900))

    def lost(self, viewer):
        self.lose.touch()
        viewer.key("m")
        # This leaves time for a picture: the third loss without one between ends the program, as it should.
        time.sleep(1)

    def type(self, viewer):
        viewer.xdotool("type", "--delay", 5, "--", "".join(self.random.choices("abc 123.-é/", k=6)))

    def breathe(self, viewer):
        time.sleep(self.random.random() * 2)


if __name__ == "__main__":
    main()

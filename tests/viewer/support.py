# SPDX-License-Identifier: MIT
"""Real windows on a display of their own: Xvfb, openbox as window manager, keys and mouse by xdotool.

A test file is run as FILE FRAGTRACE SOURCE_FOLDER [unittest arguments].
"""
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import Xlib.display
from Xlib import X
from Xlib.protocol import event

FRAGTRACE = Path(sys.argv[1]).resolve()
SCENES = Path(sys.argv[2]).resolve() / "scenes"
sys.path[:0] = [str(SCENES), str(Path(__file__).resolve().parent.parent)]
from picture_files import read_png  # noqa: E402, F401
from skips import EXTENDED, at_length, main  # noqa: E402, F401


def pixels_of(path):
    """A list of (r, g, b), row by row."""
    width, height, rows, step = read_png(path)
    return [tuple(row[step * x:step * x + 3]) for row in rows for x in range(width)]


def largest_difference(a, b):
    assert len(a) == len(b), (len(a), len(b))
    return max(abs(u - v) for p, q in zip(a, b) for u, v in zip(p, q))


def covers(place, point):
    """A place is x, y, width and height, or None."""
    return place is not None and all(0 <= p - low < size for p, low, size in zip(point, place[:2], place[2:]))


class Screen:
    """An X server on a number that is free, with a window manager; `dpi` is what the user's desktop says."""

    def __init__(self, size="1400x1000", dpi=None):
        read, write = os.pipe()
        self.server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", size + "x24", "-nolisten", "tcp", "-noreset"],
                                       pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(write)
        number = b""
        while not number.endswith(b"\n"):
            byte = os.read(read, 1)
            if not byte:
                raise RuntimeError("Xvfb did not start")
            number += byte
        os.close(read)
        self.name = ":" + number.decode().strip()
        self.folder = tempfile.TemporaryDirectory()
        self.environment = {**os.environ, "DISPLAY": self.name, "XDG_STATE_HOME": self.folder.name}
        self.environment["DBUS_SESSION_BUS_ADDRESS"] = "disabled:"  # no dialog of the desktop that the tests run on
        self.environment.pop("WAYLAND_DISPLAY", None)
        if dpi:
            self.call("xprop", "-root", "-f", "RESOURCE_MANAGER", "8s", "-set", "RESOURCE_MANAGER", f"Xft.dpi:\t{dpi}\n")
        self.manager = subprocess.Popen(["openbox", "--sm-disable"], env=self.environment, stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL)
        self.display = Xlib.display.Display(self.name)
        # openbox announces itself before it manages windows, and loses what is mapped in between: only a window that it has shown proves it.
        wait_for(self.shows_a_window, 20, "no window manager")

    def shows_a_window(self):
        root = self.display.screen().root
        window = root.create_window(0, 0, 10, 10, 0, self.display.screen().root_depth)
        window.map()
        try:
            wait_for(lambda: window.get_attributes().map_state == X.IsViewable, 0.5, "not shown")
            managed = self.display.intern_atom("WM_STATE")
            return window.get_full_property(managed, X.AnyPropertyType) is not None
        except AssertionError:
            return False
        finally:
            window.destroy()
            self.display.sync()

    def call(self, *command):
        return subprocess.run(list(map(str, command)), env=self.environment, check=True, capture_output=True, text=True).stdout

    def close(self):
        self.display.close()
        self.folder.cleanup()
        for process in (self.manager, self.server):
            process.terminate()
            process.wait()


def wait_for(condition, seconds, what):
    end = time.monotonic() + seconds
    while True:
        value = condition()
        if value:
            return value
        if time.monotonic() > end:
            raise AssertionError(f"after {seconds} s: {what}")
        time.sleep(0.02)


class Viewer:
    """A running `fragtrace view`; its folder is where it writes."""

    def __init__(self, screen, folder, scene, *options, wait=True, environment=None):
        self.screen, self.folder = screen, Path(folder)
        self.status_file = self.folder / "status.json"
        scenes = [] if scene is None else [scene if isinstance(scene, Path) else SCENES / (scene + ".gltf")]
        # Most tests compare pictures with those of `render`, to the last bit. The viewer's own defaults are
        # tested separately.
        for option, value in (("--denoise", "none"), ("--default-light", "white")):
            if option not in options and f"no{option[1:]}" not in options:
                options += (option, value)
        environment = {**(environment or screen.environment), "XDG_STATE_HOME": str(self.folder / "state"), "XDG_CONFIG_HOME": str(self.folder / "config")}
        self.errors = open(self.folder / "stderr.txt", "w+")
        self.process = subprocess.Popen([FRAGTRACE, "view", *scenes, "--status-file", self.status_file, *map(str, options)],
                                        cwd=folder, env=environment, stdout=subprocess.DEVNULL, stderr=self.errors)
        if wait:
            self.window()
            self.rest()

    def stderr(self):
        self.errors.seek(0)
        return self.errors.read()

    def status(self):
        return json.loads(self.status_file.read_text()) if self.status_file.exists() else {"state": "starting"}

    def until(self, condition, what, seconds=120):
        """The first status that fulfils it."""
        def check():
            assert self.process.poll() is None, f"ended with {self.process.returncode}: {self.stderr()}"
            status = self.status()
            return status if condition(status) else None
        return self.wait(check, seconds, what)

    def wait(self, condition, seconds, what):
        """Does the same as wait_for; an error tells the viewer's own messages."""
        try:
            return wait_for(condition, seconds, what)
        except AssertionError as error:
            raise AssertionError(f"{error}\n{json.dumps(self.status(), indent=1)}\n{self.stderr()}") from None

    def rest(self, condition=lambda status: True, what="rest"):
        return self.until(lambda s: s["state"] == "resting" and condition(s), what)

    def window(self):
        def find():
            assert self.process.poll() is None, f"ended with {self.process.returncode}: {self.stderr()}"
            found = subprocess.run(["xdotool", "search", "--onlyvisible", "--name", "^fragtrace"], env=self.screen.environment,
                                   capture_output=True, text=True).stdout.split()
            return int(found[-1]) if found else None
        self.id = wait_for(find, 60, "no window")
        self.screen.call("xdotool", "windowactivate", "--sync", self.id)
        return self.id

    def xdotool(self, *arguments):
        self.screen.call("xdotool", *arguments)

    def key(self, *names):
        for name in names:
            self.xdotool("key", name)

    def keys_at_once(self, *names):
        """All in one frame of the window, as on a machine with much to do."""
        self.process.send_signal(signal.SIGSTOP)
        self.key(*names)
        self.process.send_signal(signal.SIGCONT)

    def at(self, x, y):
        self.xdotool("mousemove", "--window", self.id, x, y)

    def click(self, name):
        """Clicks the middle of the place with that name in the status file."""
        def middle(status):
            place = status.get("places", {}).get(name)
            return place and [round(place[0] + place[2] / 2), round(place[1] + place[3] / 2)]
        place = middle(self.until(middle, f"a place of {name}"))
        while True:
            self.at(*place)
            found = middle(self.until(lambda s: s["mouse"] == place and middle(s), f"the mouse at {name}"))
            if found == place:
                break
            place = found  # it moved until it had its size
        self.xdotool("click", 1)

    def drag(self, start, end, button=1, steps=8):
        """Drags once no message covers the start; in a small window, they would take the button."""
        self.until(lambda s: not covers(s.get("places", {}).get("messages"), start), "a start without messages")
        self.at(*start)
        self.xdotool("mousedown", button)
        for i in range(1, steps + 1):
            self.at(*(round(a + (b - a) * i / steps) for a, b in zip(start, end)))
            time.sleep(0.01)
        self.xdotool("mouseup", button)

    def picture(self):
        """Returns the window's content in the picture's place: width, height and a list of (r, g, b)."""
        status = self.status()
        width, height, pixels = self.grab()
        size = status["width"], status["height"]
        return *size, [pixel for y in range(size[1]) for pixel in pixels[width * y:width * y + size[0]]]

    def grab(self):
        """Returns the window's content: width, height and a list of (r, g, b)."""
        window = self.screen.display.create_resource_object("window", self.id)
        size = window.get_geometry()
        image = window.get_image(0, 0, size.width, size.height, X.ZPixmap, 0xffffffff)
        data = image.data if isinstance(image.data, bytes) else image.data.encode("latin1")
        return size.width, size.height, list(zip(data[2::4], data[1::4], data[0::4]))

    def press_for_file(self, key, extension):
        """Presses a key that writes a file, and waits for it."""
        before = set(self.folder.glob("*" + extension))
        self.key(key)
        return self.wait(lambda: next(iter(set(self.folder.glob("*" + extension)) - before), None), 60, f"no {extension} by {key}")

    def message(self, kind, data, target=None):
        display = self.screen.display
        window = display.create_resource_object("window", self.id)
        window.send_event(event.ClientMessage(window=window, client_type=display.intern_atom(kind), data=(32, data)))
        display.flush()

    def close(self):
        """Closes the window as its close button does."""
        display = self.screen.display
        self.message("WM_PROTOCOLS", [display.intern_atom("WM_DELETE_WINDOW"), X.CurrentTime, 0, 0, 0])
        return self.end()

    def end(self, seconds=20):
        try:
            return self.process.wait(seconds)
        except subprocess.TimeoutExpired:
            raise AssertionError(f"still there after {seconds} s: {self.status_file.read_text()}\n{self.stderr()}") from None

    def cpu_seconds(self, thread=None):
        """Of the process, or of one thread; the window's has the number of the process."""
        fields = Path(f"/proc/{self.process.pid}/{f'task/{thread}/' if thread else ''}stat").read_text().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


class Case(unittest.TestCase):
    screen_size = "1400x1000"
    dpi = None

    @classmethod
    def setUpClass(cls):
        cls.screen = Screen(cls.screen_size, cls.dpi)
        cls.addClassCleanup(cls.screen.close)

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def view(self, scene, *options, **keywords):
        viewer = Viewer(self.screen, self.folder, scene, *options, **keywords)
        def stop():
            if viewer.process.poll() is None:
                viewer.process.kill()
                viewer.process.wait()
            viewer.errors.close()
        self.addCleanup(stop)
        return viewer

    def ends_well(self, viewer, status):
        self.assertEqual(status, 0, viewer.stderr())
        self.assertNotIn("OpenGL", viewer.stderr())
        last = viewer.status()
        self.assertEqual(last["gl_errors"], [])
        self.assertFalse([m for m in last["messages"] if m.startswith("driver")], last["messages"])

    def same(self, picture, other, ties=0):
        """Compares two lists of pixels. With `ties`, so many may be a level apart, since the window rounds 32-bit
        floats and a file values of 64 bits."""
        self.assertEqual(len(picture), len(other))
        apart = sum(p != q for p, q in zip(picture, other))
        self.assertLessEqual(apart, ties if largest_difference(picture, other) == 1 else 0, f"of {len(picture)} pixels, by up to {largest_difference(picture, other)} levels")

    def render(self, scene, *options, name="rendered.png"):
        path = self.folder / "rendered" / name
        path.parent.mkdir(exist_ok=True)
        scene = scene if isinstance(scene, Path) else SCENES / (scene + ".gltf")
        if "--default-light" not in options:
            options += ("--default-light", "white")  # as in Viewer
        subprocess.run([FRAGTRACE, "render", scene, "-o", path, "--quiet", *map(str, options)], check=True, timeout=300)
        return path

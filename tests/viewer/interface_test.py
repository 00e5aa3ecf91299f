#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Tests of things drawn over the picture: lists, sheet, messages, long texts, the clipboard, small windows and fine
displays."""
import json
import shlex
import struct
import subprocess
import time

from clipboard import Clipboard, clipboard_text
from support import FRAGTRACE, SCENES, Case, main, pixels_of
from gltf_file import SQUARE, TWO_TRIANGLES, Gltf
from xdnd import drop

SMALL = ["--resolution", "160,120", "--spp", "2"]
WITH_PANEL = ["--resolution", "760,670", "--spp", "1", "--stage", "flat"]
LONG = 30000


class Escape(Case):
    def test_it_closes_what_is_open_and_then_the_viewer(self):
        viewer = self.view("furnace", *WITH_PANEL)
        before = viewer.status()
        for name in ("Tone map", "Background colour"):
            viewer.click(name)
            viewer.until(lambda s: s["focus"] == "popup", name)
            viewer.key("3", "w", "t", "ctrl+q", "Escape")  # what is behind the list gets none of them
            after = viewer.until(lambda s: s["focus"] == "picture", f"no {name}")
            self.assertEqual([after[what] for what in ("camera", "tone_map")], [before[what] for what in ("camera", "tone_map")])
        viewer.key("h")
        viewer.until(lambda s: s["sheet"], "the sheet")
        viewer.key("Escape")
        viewer.until(lambda s: not s["sheet"], "no sheet")
        viewer.key("Escape", "Escape")
        self.ends_well(viewer, viewer.end())
        self.assertEqual(viewer.status()["state"], "closed")


class Typing(Case):
    def test_typed_values_have_limits_and_the_keypad_works(self):
        viewer = self.view("furnace", *WITH_PANEL)
        for typed, taken in (("999", 8), ("-1e9", -8)):
            viewer.xdotool("keydown", "ctrl")
            viewer.click("Exposure")
            viewer.until(lambda s: s["focus"] == "text", "a field to type in")
            viewer.xdotool("keyup", "ctrl")
            viewer.xdotool("type", "--", typed)
            # Dear ImGui 1.86 does not see a key that goes down and up within one frame.
            viewer.xdotool("keydown", "KP_Enter")
            time.sleep(0.1)
            viewer.xdotool("keyup", "KP_Enter")
            viewer.until(lambda s: s["exposure"] == taken and s["focus"] == "picture", f"{typed} is {taken}")
        camera = viewer.status()["camera"]
        viewer.key("KP_7")
        viewer.until(lambda s: s["camera"] != camera, "from above")
        viewer.key("KP_Enter")
        viewer.until(lambda s: s["camera"] == camera, "the first camera")
        self.ends_well(viewer, viewer.close())


class Keyboards(Case):
    """Keys are pressed by X's number of their place: 24 is Q on a US keyboard, 25 W, 29 Y, 38 A, 52 Z."""

    def view_with(self, layout):
        self.screen.call("setxkbmap", layout)
        return self.view("furnace", *WITH_PANEL)

    def brighter(self, viewer, undo, redo):
        viewer.key("46")  # L
        viewer.until(lambda s: s["exposure"] == 0.5, "brighter")
        viewer.key(undo)
        viewer.until(lambda s: s["exposure"] == 0, f"{undo} undoes")
        if redo:
            viewer.key(redo)
            viewer.until(lambda s: s["exposure"] == 0.5, f"{redo} redoes")

    def test_german_keys_act_by_their_labels(self):
        viewer = self.view_with("de")
        self.brighter(viewer, "ctrl+29", "ctrl+52")
        viewer.click("section Histogram")
        viewer.click("section Stages")
        viewer.click("Bookmark name")
        viewer.until(lambda s: s["focus"] == "text", "a field to type in")
        viewer.key("38", "56", "ctrl+29")  # the field undoes by its label, too
        viewer.click("Keep view")
        viewer.until(lambda s: "view 0" in s["places"], "kept")
        self.assertNotIn('"ab"', (self.folder / "state/fragtrace/viewer.json").read_text())
        self.ends_well(viewer, viewer.close())

    def test_french_keys_fly_by_their_places(self):
        viewer = self.view_with("fr")
        self.brighter(viewer, "ctrl+25", "ctrl+shift+25")
        viewer.key("ctrl+24", "ctrl+52")  # Ctrl+A and Ctrl+W do nothing
        before = viewer.rest()
        viewer.key("25")  # Z is where W is on a US keyboard
        after = viewer.rest(lambda s: s["camera"] != before["camera"], "forwards")
        self.assertNotIn("figures0", after["places"])
        viewer.key("52")
        viewer.until(lambda s: "figures0" in s["places"], "W stands in for Z")
        viewer.key("ctrl+38")  # Ctrl+Q
        self.ends_well(viewer, viewer.end())

    def test_russian_keys_have_no_latin_labels_and_act_by_their_places(self):
        viewer = self.view_with("ru")
        self.brighter(viewer, "ctrl+52", "ctrl+29")
        viewer.key("ctrl+24")
        self.ends_well(viewer, viewer.end())


class Pasting(Case):
    def test_copied_commands_draw_the_same_and_come_back(self):
        viewer = self.view("sphere-phong", *SMALL, "--no-background", "--exposure", "0.5")
        asked = viewer.status()["asked"]
        viewer.drag((60, 60), (100, 75))
        viewer.key("F5", "shift+F11")
        status = viewer.rest(lambda s: s["asked"] > asked + 2, "rest after changes")
        shown = viewer.press_for_file("F12", ".png")
        viewer.key("ctrl+c")
        viewer.until(lambda s: any("copied" in m for m in s["messages"]), "copied")
        copied = clipboard_text(self.screen)
        command = shlex.split(copied)
        self.assertEqual(command[:2], ["fragtrace", "render"])
        subprocess.run([FRAGTRACE, *command[1:]], cwd=self.folder, check=True, timeout=120, capture_output=True)
        self.same(pixels_of(self.folder / "sphere-phong-2.png"), pixels_of(shown))

        # Another scene and another view; then back by the command alone.
        self.paste(viewer, f"build/fragtrace render '{SCENES}/furnace.gltf' -o x.png --disable shadows")
        status2 = viewer.rest(lambda s: s["scene"].endswith("furnace.gltf"), "the other scene")
        self.assertNotIn("shadows", status2["sides"][0]["stages"])
        self.assertEqual(status2["exposure"], 0)
        self.paste(viewer, copied)
        back = viewer.rest(lambda s: s["scene"].endswith("sphere-phong.gltf"), "the copied scene")
        self.assertEqual((back["camera"], back["exposure"]), (status["camera"], 0.5))
        self.same(pixels_of(viewer.press_for_file("F12", ".png")), pixels_of(shown))
        self.ends_well(viewer, viewer.close())

    def test_what_is_no_command_changes_nothing_and_is_said(self):
        viewer = self.view("furnace", *SMALL)
        viewer.drag((60, 60), (100, 75))
        moved = viewer.rest()["camera"]
        for text, said in (("", "empty"), ("--camera-index 0 one two", "not understood: one two"), ("--camera-index 7", "7"),
                           ("x" * 29000, "no command"), (None, "empty")):
            if text is None:  # nobody owns it
                time.sleep(0.2)
                viewer.key("ctrl+v")
            else:
                self.paste(viewer, text)
            viewer.until(lambda s: said in s["messages"][-1], f"{said} of {str(text)[:40]}")
            time.sleep(0.2)
            self.assertEqual(viewer.rest()["camera"], moved)
        self.ends_well(viewer, viewer.close())

    def paste(self, viewer, text):
        clipboard = Clipboard(self.screen, text)
        try:
            before = viewer.status()
            viewer.key("ctrl+v")
            viewer.until(lambda s: s["messages"] != before["messages"] or s["camera"] != before["camera"] or s["state"] == "loading",
                         "pasted")
        finally:
            clipboard.close()


class LongNames(Case):
    def test_names_of_any_length_are_shown(self):
        scene = json.loads((SCENES / "sphere-phong.gltf").read_text())
        for kind in ("nodes", "meshes", "materials", "cameras"):
            for thing in scene.get(kind, []):
                thing["name"] = "n" * LONG
        path = self.folder / ("f" * 240 + ".gltf")
        path.write_text(json.dumps(scene))
        viewer = self.view(path, *WITH_PANEL)
        viewer.at(200, 310)
        viewer.xdotool("click", 1)
        viewer.until(lambda s: any(len(line) > LONG for line in s["pick"] or []), "the node's name")
        viewer.click("Scene camera")
        viewer.until(lambda s: s["focus"] == "popup", "the list of cameras")
        viewer.key("Escape")
        viewer.press_for_file("F12", ".png")
        self.ends_well(viewer, viewer.close())


class Names(Case):
    # Polish, Turkish, Greek, Russian, Arabic, Chinese, Japanese
    NAMES = ["Żółw łąka", "ışık ğ", "Κύβος ς", "Кубик", "مكعبة", "立方体块", "サクラの木"]

    @staticmethod
    def lacking(name):
        """The name as a font with Latin-1 alone draws it."""
        return "".join(c if ord(c) < 256 else "?" for c in name)

    def test_every_script_is_drawn(self):
        gltf = Gltf()
        for name in self.NAMES + sorted(set(map(self.lacking, self.NAMES))):
            gltf.node(name=name, mesh=gltf.mesh(gltf.accessor(TWO_TRIANGLES, "H"), position=gltf.accessor(SQUARE)))
        viewer = self.view(gltf.write(self.folder / "立方体.gltf"), *WITH_PANEL)
        viewer.click("section Scene")
        places = viewer.rest(lambda s: f"node {self.NAMES[-1]}" in s["places"], "the names")["places"]
        time.sleep(0.5)
        width, _, pixels = viewer.grab()
        def row(name):
            x, y, w, h = map(int, places[f"node {name}"])
            return [pixels[width * j + i] for j in range(y, y + h) for i in range(x, x + w)]
        for name in self.NAMES:
            self.assertNotEqual(row(name), row(self.lacking(name)), name)
        self.ends_well(viewer, viewer.close())


class Messages(Case):
    def test_they_stand_once_and_can_be_closed(self):
        viewer = self.view("furnace", *SMALL, "--tree-level", "31")
        wait = "the tree has no level 31"
        viewer.until(lambda s: any(wait in m for m in s["messages"]), "what stderr says")
        for key in ("F3", "F3", "F4", "F4"):
            asked = viewer.status()["asked"]
            viewer.key(key)
            viewer.rest(lambda s: s["asked"] > asked, key)
        self.assertEqual(viewer.stderr().count(wait), 1, viewer.stderr())
        self.assertEqual(sum(wait in m for m in viewer.status()["messages"]), 1)
        written = viewer.press_for_file("F12", ".png")
        viewer.until(lambda s: f"wrote {written.resolve()}" in s["messages"], "the file with its folder")
        self.assertFalse([m for m in viewer.status()["messages"] if m.startswith("writing")])
        viewer.click("close messages")
        viewer.until(lambda s: "messages" not in s["places"], "closed")
        self.ends_well(viewer, viewer.close())

    def test_files_dropped_together_are_all_taken(self):
        viewer = self.view("furnace", *SMALL)
        drop(self.screen, viewer.id, SCENES / "sphere-plane.gltf", SCENES / "README.md", SCENES / "sky.pfm")
        viewer.rest(lambda s: s["scene"].endswith("sphere-plane.gltf") and s["environment"].endswith("sky.pfm"), "both")
        self.assertTrue(any("README.md" in m for m in viewer.status()["messages"]))
        self.ends_well(viewer, viewer.close())


class Overlaps(Case):
    scale = 1
    in_a_small_window = ("figures0",)

    def test_nothing_covers_anything(self):
        viewer = self.view("furnace", "--spp", "1", "--stage", "flat")
        viewer.at(200, 300)
        viewer.xdotool("click", 1)  # the message about it does not fade
        viewer.key("z")
        viewer.xdotool("windowsize", "--sync", viewer.id, 1280, 720)
        viewer.until(lambda s: s["places"].get("status", [0] * 4)[2] == 1280, "the size")
        self.everything(viewer, (1280, 720), ("figures0", "figures1"))
        self.assertEqual(self.panel_width, 352 * self.scale)
        viewer.xdotool("windowsize", "--sync", viewer.id, 480, 320)
        viewer.until(lambda s: s["height"] < 320, "a small window")
        self.everything(viewer, (480, 320), (), self.in_a_small_window)
        self.names_stay_in_their_pictures(viewer)
        self.ends_well(viewer, viewer.close())

    def names_stay_in_their_pictures(self, viewer):
        viewer.key("o")
        status = viewer.rest(lambda s: s["overview"] and sum(n.startswith("name ") for n in s["places"]) == 7, "all stages")
        cell = status["places"]["stages"][2] / 3
        for place in (place for name, place in status["places"].items() if name.startswith("name ")):
            self.assertEqual(place[0] // cell, (place[0] + place[2]) // cell, status["places"])
        viewer.key("o", "c")
        viewer.until(lambda s: "name B" in s["places"] and not s["overview"], "two sides")
        viewer.drag((240, 60), (40, 60))
        a, b = (viewer.until(lambda s: s["bar"] < 0.1, "the bar at the left")["places"].get(name) for name in ("name A", "name B"))
        self.assertGreaterEqual(b[0], 40)
        self.assertTrue(a is None or (a[0] >= 0 and a[0] + a[2] <= 48), a)

    def everything(self, viewer, size, sides, one=("figures0",)):
        if not viewer.status()["panel"]:
            viewer.key("Tab")
        self.panel_width = self.check(viewer, size, ("panel", "messages", "status"))["panel"][2]
        viewer.key("Tab")
        self.check(viewer, size, (*one, "messages", "status"))
        viewer.key("c")
        self.check(viewer, size, ("messages", *sides))
        viewer.key("c")

    def check(self, viewer, size, names):
        kinds = ("panel", "figures0", "figures1", "messages", "stages", "status")

        def apart(a, b):
            return a[0] + a[2] <= b[0] or b[0] + b[2] <= a[0] or a[1] + a[3] <= b[1] or b[1] + b[3] <= a[1]

        def settled(s):
            own = [s["places"][n] for n in kinds if n in s["places"]]
            return all(n in s["places"] for n in names) and all(a is b or apart(a, b) for a in own for b in own)
        time.sleep(0.2)  # windows take a few frames to find their size, and more on a busy machine
        viewer.until(settled, f"{names}, apart", 10)
        places = {n: p for n, p in viewer.status()["places"].items() if n in kinds}
        for name, (x, y, width, height) in places.items():
            self.assertTrue(x >= 0 and y >= 0 and x + width <= size[0] and y + height <= size[1], (name, places, size))
            self.assertGreater(height, 15 * self.scale, places)  # a line
            for other, place in places.items():
                self.assertTrue(name == other or apart((x, y, width, height), place), (name, other, places, size))
        return places


class OverlapsAt192Dpi(Overlaps):
    dpi = 192
    scale = 2
    in_a_small_window = ()


class LargeWindow(Case):
    screen_size = "3840x2160"

    def test_it_turns_compares_and_saves(self):
        viewer = self.view("sphere-phong", "--stage", "phong", "--spp", "1")
        viewer.xdotool("windowsize", viewer.id, 3840, 2160)
        # The window manager keeps its borders.
        status = viewer.rest(lambda s: s["width"] > 3400 and s["height"] > 2000, "the size")
        viewer.drag((1200, 1000), (1500, 1050))
        turned = viewer.rest(lambda s: s["camera"] != status["camera"] and s["sides"][0]["width"] == status["width"], "turned")
        viewer.key("c", "F3")
        viewer.rest(lambda s: s["split"] and "name B" in s["places"] and len(s["sides"]) == 2, "two sides")
        saved = viewer.press_for_file("F12", ".png").read_bytes()
        self.assertEqual(struct.unpack(">II", saved[16:24]), (turned["width"], turned["height"]))
        viewer.key("c", "o")
        viewer.rest(lambda s: s["overview"] and len(s["sides"]) == 7 and s["sides"][6]["samples"] == 1, "all stages")
        self.ends_well(viewer, viewer.close())


if __name__ == "__main__":
    main()

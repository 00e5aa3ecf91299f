#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Numbers of materials and lights that are set by eye, and the file that keeps them."""
import json
import shutil
import subprocess
import time
import unittest

from comfort_test import copied_command
from support import FRAGTRACE, SCENES, Case, main, pixels_of
from xdnd import drop

try:
    from fake_portal import CHOSEN, WHY_NOT, portal_for
except ImportError as error:
    WHY_NOT = f"{error} (Debian: python3-jeepney)"

PANEL = ["--resolution", "560,400", "--spp", "1", "--stage", "phong"]


def write_over(viewer, portal, scene):
    """Presses the keys after which the model is written over the file that is shown."""
    portal.answers = [(CHOSEN, f"file://{scene}")]
    viewer.key("ctrl+shift+s")


class Materials(Case):
    def start(self, name, *options, **keywords):
        self.scene = self.folder / "scene.gltf"
        shutil.copy(SCENES / (name + ".gltf"), self.scene)
        return self.view(self.scene, *PANEL, *options, **keywords)

    def start_with_portal(self, *arguments):
        self.portal, environment = portal_for(self)
        return self.start(*arguments, environment=environment)

    def is_asked_for(self, viewer):
        """Quitting asks what becomes of numbers that are not saved."""
        viewer.key("ctrl+q")
        self.settled(viewer, "Discard")

    def picture(self, viewer):
        return pixels_of(viewer.press_for_file("F12", ".png"))

    def save_over(self, viewer):
        """Writes the model over the file that is shown, which is read again."""
        write_over(viewer, self.portal, self.scene)
        return viewer.rest(lambda s: not s["set"], "read again")

    def settled(self, viewer, name):
        """The place of that name once it no longer moves. A scroll bar takes its part one frame later."""
        place, since = None, time.monotonic()
        while not place or time.monotonic() - since < 0.5:
            now = viewer.until(lambda s: s["places"].get(name), f"a place of {name}")["places"][name]
            if now != place:
                place, since = now, time.monotonic()
            time.sleep(0.05)
        return place

    def slide(self, viewer, name, part):
        """Presses on a slider at a part of its width, which ends before the button that goes back to the file's value."""
        x, y, width, height = self.settled(viewer, name)
        viewer.at(round(x + part * (width - height - 4)), round(y + height / 2))
        time.sleep(0.1)
        before = viewer.status()["set"]
        viewer.xdotool("click", 1)
        self.states = set()
        return viewer.until(lambda s: self.states.add(s["state"]) or (s["state"] == "resting" and s["set"] != before), "another number")["set"]

    def changed(self, before, after, file="changed.gltf"):
        """Writes the scene with one text replaced by another, and returns the path."""
        text = self.scene.read_text()
        self.assertEqual(text.count(before), 1)
        path = self.folder / file
        path.write_text(text.replace(before, after))
        return path

    def test_a_slider_draws_the_picture_of_a_file_with_that_number(self):
        viewer = self.start("plastics", environment={**self.screen.environment, "MESA_SHADER_CACHE_DISABLE": "true"})
        whole = self.picture(viewer)
        viewer.at(215, 215)
        viewer.xdotool("click", 1)
        self.assertIn("  roughness 0.1", viewer.rest(lambda s: s["pick"], "picked")["pick"])
        (place, [number]), = self.slide(viewer, "Roughness", 0.9).items()
        self.assertEqual(place, "/materials/4/pbrMetallicRoughness/roughnessFactor")
        self.assertAlmostEqual(number, 0.9, delta=0.05)
        self.assertIn(f"  roughness {number:.3g}", viewer.status()["pick"])
        self.assertNotIn("compiling", self.states)
        after = self.picture(viewer)
        self.assertNotEqual(after, whole)
        file = self.changed('"roughnessFactor": 0.1,', f'"roughnessFactor": {number},')
        self.same(after, pixels_of(self.render(file, *PANEL)))
        words = copied_command(self, viewer)
        words[words.index("--output") + 1] = str(self.folder / "command.png")
        self.assertEqual(words[words.index("--set") + 1], f"{place}={number}")
        # The whole change is one step.
        viewer.key("ctrl+z")
        self.assertIn("  roughness 0.1", viewer.rest(lambda s: not s["set"], "as in the file")["pick"])
        self.same(self.picture(viewer), whole)
        viewer.key("ctrl+shift+s")
        viewer.until(lambda s: "no number of a material or a light has been set" in s["messages"], "nothing to write")
        viewer.key("ctrl+y")
        viewer.rest(lambda s: s["set"], "again")
        self.is_asked_for(viewer)
        viewer.click("Cancel")
        viewer.until(lambda s: s["focus"] == "picture", "not quit")
        # So does opening another file.
        asks = lambda s: "messages" in s["places"] and "open again" in s["messages"][-1]
        viewer.key("ctrl+o")
        self.assertEqual(viewer.until(asks, "asked")["dialog"], "")
        viewer.click("close messages")
        viewer.until(lambda s: "messages" not in s["places"], "no question is seen")
        drop(self.screen, viewer.id, SCENES / "furnace.gltf")
        self.assertEqual(viewer.until(asks, "asked")["scene"], str(self.scene))
        viewer.key("ctrl+o")
        viewer.until(lambda s: "shows no dialog" in s["messages"][-1], "not asked again")
        viewer.key("ctrl+shift+s")  # without a dialog, the name is a free one
        written = self.folder / "scene-1.gltf"
        viewer.until(lambda s: f"wrote {written}" in s["messages"], "the model")
        self.assertEqual(written.read_bytes(), file.read_bytes())
        viewer.click("close messages")
        viewer.until(lambda s: "messages" not in s["places"], "no question is seen")
        self.ends_well(viewer, viewer.close())

    @unittest.skipIf(WHY_NOT, WHY_NOT)
    def test_lights_too_and_what_needs_another_program(self):
        viewer = self.start_with_portal("lights")
        whole = self.picture(viewer)
        viewer.click("section Scene")
        viewer.click("lights")
        viewer.click("light 1")
        (place, [number]), = self.slide(viewer, "Light intensity", 0.3).items()
        self.assertEqual(place, "/extensions/KHR_lights_punctual/lights/1/intensity")
        file = self.changed('"intensity": 9,', f'"intensity": {number},')
        self.same(self.picture(viewer), pixels_of(self.render(file, *PANEL)))
        viewer.click("light 1")
        viewer.click("lights")
        viewer.click("materials")
        viewer.click("material 0")
        # Metal, which the scene has not had.
        metal = self.slide(viewer, "Metallic", 0.9)["/materials/0/pbrMetallicRoughness/metallicFactor"][0]
        self.assertAlmostEqual(metal, 0.9, delta=0.05)
        file.write_text(file.read_text().replace('"metallicFactor": 0,', f'"metallicFactor": {metal},', 1))
        changed = self.picture(viewer)
        self.same(changed, pixels_of(self.render(file, *PANEL)))
        # Written over, and read again, the file has the numbers; undo takes them back, which is not saved.
        self.save_over(viewer)
        self.assertEqual(self.scene.read_text(), file.read_text())
        self.same(self.picture(viewer), changed)
        viewer.key("ctrl+z")
        self.assertEqual(viewer.rest(lambda s: s["set"], "undone")["set"], {"/materials/0/pbrMetallicRoughness/metallicFactor": [0]})
        viewer.key("ctrl+z")
        self.assertEqual(viewer.rest(lambda s: len(s["set"]) == 2, "undone")["set"][place], [9])
        self.same(self.picture(viewer), whole)
        self.is_asked_for(viewer)
        self.portal.answers = [(CHOSEN, f"file://{self.scene}")]
        viewer.click("Save...")
        self.ends_well(viewer, viewer.end())
        self.assertIn('"intensity": 9,', self.scene.read_text())

    def test_rows_go_back_to_the_file_and_colours_are_shown_as_a_display_shows_them(self):
        viewer = self.start("plastics")
        viewer.at(215, 215)
        viewer.xdotool("click", 1)
        viewer.rest(lambda s: s["pick"], "picked")
        self.slide(viewer, "Roughness", 0.9)
        viewer.click("reset Roughness")
        viewer.until(lambda s: not s["set"], "the file's value")
        x, y, width, height = self.settled(viewer, "Base colour")
        square = round(x + width - 1.5 * height - 4), round(y + height / 2)

        def is_shown(color):
            """The square has the linear colour's levels on a display, by the formula of IEC 61966-2-1."""
            levels = [255 * (12.92 * c if c <= 0.0031308 else 1.055 * c ** (1 / 2.4) - 0.055) for c in color]
            window_width, _, pixels = viewer.grab()
            for shown, level in zip(pixels[window_width * square[1] + square[0]], levels):
                self.assertAlmostEqual(shown, level, delta=1)
        is_shown(json.loads(self.scene.read_text())["materials"][4]["pbrMetallicRoughness"]["baseColorFactor"][:3])
        viewer.at(*square)
        viewer.xdotool("click", 1)
        viewer.until(lambda s: s["focus"] == "popup", "the picker")
        time.sleep(0.5)
        window_width, _, pixels = viewer.grab()
        top = round(y + height) + 10
        row = pixels[window_width * top:window_width * (top + 1)]
        white = next(i for i in range(1, window_width) if row[i - 1] == (28, 28, 28) and min(row[i]) > 240)  # the field's corner
        viewer.at(white, top + 110)  # a grey, at its left edge
        time.sleep(0.2)
        viewer.xdotool("click", 1)
        (_, [*grey, _]), = viewer.until(lambda s: s["set"], "a grey")["set"].items()
        self.assertEqual(len(set(grey)), 1)
        self.assertTrue(0.05 < grey[0] < 0.6, grey)
        viewer.key("Escape")
        viewer.until(lambda s: s["focus"] == "picture", "closed")
        time.sleep(0.5)
        is_shown(grey)
        viewer.message("WM_PROTOCOLS", [viewer.screen.display.intern_atom("WM_DELETE_WINDOW"), 0, 0, 0, 0])
        viewer.until(lambda s: "Discard" in s["places"], "asked")
        viewer.key("Escape")
        viewer.until(lambda s: s["focus"] == "picture", "Escape cancels")
        self.is_asked_for(viewer)
        viewer.click("Discard")
        self.ends_well(viewer, viewer.end())

    @unittest.skipIf(WHY_NOT, WHY_NOT)
    def test_what_is_set_by_name_is_drawn_and_saved(self):
        words = ["--set", "floor:color=0.1,0.5,0.9", "--set", "wa*:clearcoat=1", "--set", "post:doubleSided=true"]
        viewer = self.start_with_portal("lights", *words)
        shown = self.picture(viewer)
        self.same(shown, pixels_of(self.render(self.scene, *PANEL, *words)))
        write_over(viewer, self.portal, self.scene)
        viewer.until(lambda s: any(m.startswith("wrote ") for m in s["messages"]), "written")
        self.same(self.picture(viewer), shown)
        root = json.loads(self.scene.read_text())
        floor, wall, post = root["materials"]
        self.assertEqual(floor["pbrMetallicRoughness"]["baseColorFactor"], [0.1, 0.5, 0.9, 1])
        self.assertEqual(wall["extensions"]["KHR_materials_clearcoat"], {"clearcoatFactor": 1})
        self.assertIs(post["doubleSided"], True)
        self.assertIn("KHR_materials_clearcoat", root["extensionsUsed"])
        self.ends_well(viewer, viewer.close())

    @unittest.skipIf(WHY_NOT, WHY_NOT)
    def test_emission_that_is_set_leaves_the_studio_which_is_named(self):
        light = ["--default-light", "studio"]
        viewer = self.start_with_portal("furnace", *light, "--set", "/materials/0/emissiveFactor=0.1,0.05,0")
        shown = self.picture(viewer)
        words = copied_command(self, viewer)
        self.assertIn("--studio", words)
        command = self.folder / "command.png"
        words[words.index("--output") + 1] = str(command)
        subprocess.run([FRAGTRACE, *words[1:], "--quiet"], check=True)
        self.same(shown, pixels_of(command))
        said = self.save_over(viewer)["messages"]
        self.assertTrue(any("render it with Studio" in m for m in said), said)
        self.same(self.picture(viewer), shown)
        self.same(pixels_of(self.render(self.scene, *PANEL, "--studio")), shown)
        self.assertNotEqual(pixels_of(self.render(self.scene, *PANEL, *light)), shown)
        self.ends_well(viewer, viewer.close())


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The scene's parts in the panel, a picture from a file next to the one that is traced, and all stages side by side."""
import shutil
import subprocess
import time

from comfort_test import copied_command
from support import FRAGTRACE, SCENES, Case, largest_difference, main, pixels_of
from xdnd import drop
from geometry import quad  # noqa: E402
from gltf_writer import GltfWriter  # noqa: E402
from scene_parts import place_quad  # noqa: E402

PANEL = ["--resolution", "640,700", "--spp", "1", "--stage", "flat"]
SIZE = ["--resolution", "160,120"]


class Tree(Case):
    def test_a_node_is_selected_hidden_and_shown_again(self):
        viewer = self.view("plastics", *PANEL)
        first = viewer.rest()
        whole = pixels_of(viewer.press_for_file("F12", ".png"))
        nodes = subprocess.run([FRAGTRACE, "info", SCENES / "plastics.gltf", "--nodes"], capture_output=True, text=True, check=True).stdout
        name = next(line.split('"')[1] for line in nodes.splitlines() if line.endswith(", mesh"))
        viewer.click("section Scene")
        viewer.click(f"node {name}")
        box = viewer.rest(lambda s: s["selected"], "selected")["selected"]
        self.assertTrue(all(a <= b for a, b in zip(box, box[3:])))
        viewer.click(f"show {name}")
        hidden = viewer.rest(lambda s: s["hidden"], "hidden")
        self.assertEqual(len(hidden["hidden"]), 1)
        self.assertEqual(hidden["camera"], first["camera"])
        without = pixels_of(viewer.press_for_file("F12", ".png"))
        self.assertGreater(sum(a != b for a, b in zip(whole, without)), 1000)
        words = copied_command(self, viewer)
        self.assertEqual(words[words.index("--hide") + 1], hidden["hidden"][0])
        words[words.index("--output") + 1] = str(self.folder / "command.png")
        subprocess.run([FRAGTRACE, *words[1:], "--quiet"], check=True, cwd=self.folder, timeout=300)
        self.same(without, pixels_of(self.folder / "command.png"))
        viewer.key("ctrl+z")
        viewer.rest(lambda s: not s["hidden"], "shown again")
        self.same(whole, pixels_of(viewer.press_for_file("F12", ".png")))
        viewer.key("ctrl+y")
        viewer.rest(lambda s: s["hidden"], "hidden again")
        self.ends_well(viewer, viewer.close())

    def test_materials_histogram_and_intensity(self):
        viewer = self.view("plastics", *PANEL, "--hdri-file", SCENES / "sky.pfm")
        viewer.rest()
        viewer.click("section Scene")
        viewer.click("materials")
        viewer.click("material 0")
        viewer.click("section Scene")
        viewer.until(lambda s: "material 0" not in s["places"], "closed")
        viewer.click("section Histogram")
        viewer.until(lambda s: "histogram" in s["places"], "a histogram")
        x, y, width, height = viewer.status()["places"]["Intensity"]
        middle = round(y + height / 2)
        viewer.drag((round(x + 0.5 * width), middle), (round(x + 0.8 * width), middle))
        self.assertNotEqual(viewer.rest(lambda s: s["hdri_intensity"] != 1, "another intensity")["hdri_intensity"], 1)
        words = copied_command(self, viewer)
        self.assertIn("--hdri-intensity", words)
        # The whole drag is one step.
        viewer.key("ctrl+z")
        viewer.rest(lambda s: s["hdri_intensity"] == 1, "as before the drag")
        self.ends_well(viewer, viewer.close())


class Sun(Case):
    def test_it_is_dragged_and_drawn_as_by_the_command(self):
        viewer = self.view("sun-sky", *SIZE, "--spp", "2", "--sky", "--sun-elevation", "30")
        self.assertEqual(viewer.rest()["sun"], [30, 225])
        # The panel makes no step of undo.
        viewer.key("Tab")
        viewer.until(lambda s: "Sun from" in s["places"], "the panel")
        viewer.key("ctrl+z")
        viewer.until(lambda s: "there is nothing to undo" in s["messages"], "no step")
        viewer.key("Tab")
        viewer.until(lambda s: not s["panel"], "without the panel")
        before = pixels_of(viewer.press_for_file("F12", ".png"))
        viewer.xdotool("keydown", "shift")
        viewer.drag((60, 50), (90, 40), button=3)
        viewer.xdotool("keyup", "shift")
        elevation, azimuth = viewer.rest(lambda s: s["sun"] != [30, 225], "the sun elsewhere")["sun"]
        self.assertGreater(elevation, 33)
        self.assertLess(azimuth % 360, 215)
        words = copied_command(self, viewer)
        self.assertAlmostEqual(float(words[words.index("--sun-elevation") + 1]), elevation)
        words[words.index("--output") + 1] = str(self.folder / "command.png")
        subprocess.run([FRAGTRACE, *words[1:], "--quiet"], check=True, cwd=self.folder, timeout=300)
        moved = pixels_of(viewer.press_for_file("F12", ".png"))
        self.same(moved, pixels_of(self.folder / "command.png"))
        self.assertGreater(sum(a != b for a, b in zip(before, moved)), 1000)
        viewer.key("ctrl+z")
        status = viewer.rest(lambda s: s["sun"] == [30, 225], "as before the drag")
        self.assertFalse(any("horizon" in m for m in status["messages"]))
        self.same(before, pixels_of(viewer.press_for_file("F12", ".png")))
        viewer.xdotool("keydown", "shift")
        viewer.drag((60, 20), (60, 110), button=3)
        viewer.xdotool("keyup", "shift")
        said = viewer.rest(lambda s: s["sun"][0] == -18, "night")["messages"]
        self.assertEqual([m for m in said if "horizon" in m], ["the sun is below the horizon: the sky gives little light, or none (Exposure)"])
        self.ends_well(viewer, viewer.close())

    def test_light_paths_begin_at_a_sun_that_rises(self):
        has_caustics = lambda status: "caustics" in status["sides"][0]["variant"].split("+")
        viewer = self.view("caustic-ball", *SIZE, "--spp", "1", "--hide", "lamp", "--hide", "lamp-back", "--sky", "--sun-elevation", "-10")
        self.assertFalse(has_caustics(viewer.rest()))
        viewer.xdotool("keydown", "shift")
        viewer.drag((60, 50), (60, 10), button=3)
        viewer.xdotool("keyup", "shift")
        self.assertTrue(has_caustics(viewer.rest(lambda s: s["sun"][0] > 5, "morning")))
        viewer.key("ctrl+z")
        self.assertFalse(has_caustics(viewer.rest(lambda s: s["sun"][0] == -10, "night again")))
        self.ends_well(viewer, viewer.close())


class Level(Case):
    def click(self, viewer, x, y, *modifiers):
        viewer.at(x, y)
        viewer.xdotool(*(word for m in modifiers for word in ("keydown", m)), "click", 1, *(word for m in modifiers for word in ("keyup", m)))

    def test_three_points_level_a_tilted_file(self):
        """Click, Shift+click, Ctrl+Shift+click; the camera stays upright and goes with what it looks at."""
        gltf = GltfWriter(self.folder, "tilted")
        right, front = (4, 1, 0.5), (0.3, 0.8, -4)
        place_quad(gltf, "floor", quad((3, 1, -1), right, front), gltf.add_lambert("white", (0.8, 0.8, 0.8)))
        gltf.write()
        middle = [a + 0.5 * (b + c) for a, b, c in zip((3, 1, -1), right, front)]
        viewer = self.view(self.folder / "tilted.gltf", "--resolution", "320,240", "--spp", "1", "--stage", "flat", "--camera-parallel-scale", "2.5",
                           "--camera-position", f"{middle[0]},{middle[1] + 3},{middle[2] + 4}", "--camera-focal-point", ",".join(map(str, middle)))
        before = viewer.rest()["camera"]
        tilted = pixels_of(viewer.press_for_file("F12", ".png"))
        self.click(viewer, 150, 150, "ctrl", "shift")
        viewer.until(lambda s: "click on a point and Shift+click on another one first" in s["messages"], "two points are missing", 8)
        self.click(viewer, 230, 100)
        viewer.until(lambda s: s["pick"], "the first point", 8)
        self.click(viewer, 180, 90, "shift")
        viewer.until(lambda s: s["measured"], "the second point")
        self.click(viewer, 130, 80, "ctrl", "shift")
        viewer.until(lambda s: any("lie on a line" in m for m in s["messages"]), "points on a line")
        self.click(viewer, 200, 140, "ctrl", "shift")
        turned = viewer.rest(lambda s: s["up"] != "y", "the turn")
        self.assertIn(f"the model is turned as --up {turned['up']} turns it", turned["messages"])
        up = [float(x) for x in turned["up"].split(",")]
        normal = [right[1] * front[2] - right[2] * front[1], right[2] * front[0] - right[0] * front[2], right[0] * front[1] - right[1] * front[0]]
        length = sum(n * n for n in normal)**0.5
        for found, expected in zip(up, normal, strict=True):
            self.assertAlmostEqual(found, expected / length, delta=2e-6)
        camera = turned["camera"]
        levelled = pixels_of(viewer.press_for_file("F12", ".png"))
        self.assertGreater(sum(a != b for a, b in zip(tilted, levelled)), 2000)
        words = copied_command(self, viewer)
        self.assertEqual([float(x) for x in words[words.index("--up") + 1].split(",")], up)
        words[words.index("--output") + 1] = str(self.folder / "command.png")
        subprocess.run([FRAGTRACE, *words[1:], "--quiet"], check=True, cwd=self.folder, timeout=300)
        self.same(levelled, pixels_of(self.folder / "command.png"))
        # The floor stays in the middle of the picture, and is level.
        place = lambda text, option: [float(x) for x in text.split(option + " ")[1].split()[0].split(",")]
        way = [a - b for a, b in zip(place(camera, "--camera-position"), place(camera, "--camera-focal-point"))]
        for a, b in zip(way, (0, 3, 4)):
            self.assertAlmostEqual(a, b, places=6)
        self.assertAlmostEqual(place(camera, "--camera-focal-point")[1], sum(u * m for u, m in zip(up, middle)), places=5)
        viewer.key("ctrl+z")
        self.assertEqual(viewer.rest(lambda s: s["up"] == "y", "as it was")["camera"].split(" --scene-origin")[0], before.split(" --scene-origin")[0])
        self.same(tilted, pixels_of(viewer.press_for_file("F12", ".png")))
        self.ends_well(viewer, viewer.close())


class Reference(Case):
    def reference(self, name, *options):
        return self.render("furnace", *SIZE, "--spp", 1, *options, name=name)

    def test_a_file_is_side_b(self):
        reference = self.reference("reference.exr")
        scene = self.folder / "scene.gltf"
        shutil.copy(SCENES / "furnace.gltf", scene)
        viewer = self.view(scene, "--spp", "4", "--reference", reference)
        status = viewer.rest(lambda s: s["reference"], "the reference")
        self.assertTrue(status["split"])
        self.assertEqual((status["width"], status["height"]), (160, 120))
        self.assertEqual(len(status["sides"]), 1)
        viewer.key("ctrl+z")
        viewer.until(lambda s: "there is nothing to undo" in s["messages"], "it is no step of undo")
        composite = pixels_of(viewer.press_for_file("F12", ".png"))
        left = pixels_of(self.render(scene, *SIZE, "--spp", 4))
        right = pixels_of(self.reference("right.png"))
        rows = [(left if x < 80 else right)[160 * y + x] for y in range(120) for x in range(160)]
        self.same(composite, rows)
        viewer.key("u")
        viewer.rest(lambda s: s["comparison"] == "difference", "difference")
        apart = pixels_of(viewer.press_for_file("F12", ".png"))
        self.assertNotEqual(apart, composite)
        viewer.key("i")
        # A picture dropped while two sides are shown replaces the reference.
        drop(self.screen, viewer.id, self.reference("other.pfm", "--exposure", 0))
        viewer.rest(lambda s: s["reference"].endswith("other.pfm"), "the other one")
        self.assertEqual(viewer.status()["environment"], "")
        self.ends_well(viewer, viewer.close())

    def test_a_picture_of_display_colours_is_side_b(self):
        """As it is in its file, whatever exposure and curve are; the difference is that of what is shown."""
        picture = self.reference("display.png")
        viewer = self.view("furnace", "--spp", "4", "--exposure", "-1", "--tone-map", "aces", "--reference", picture)
        viewer.rest(lambda s: s["reference"], "the reference")
        viewer.key("u")
        viewer.rest(lambda s: s["comparison"] == "difference", "difference")
        time.sleep(0.3)
        _, _, seen = viewer.picture()  # before a message covers it
        saved = pixels_of(viewer.press_for_file("F12", ".png"))
        left = pixels_of(self.render("furnace", *SIZE, "--spp", 4, "--exposure", -1, "--tone-map", "aces"))
        right = pixels_of(picture)
        middle = 160 * 50 + 60
        linear = abs(left[middle][0] - right[middle][0]) / 255
        for pixels in (seen, saved):
            self.assertAlmostEqual(pixels[middle][0] / 255, 1.055 * linear ** (1 / 2.4) - 0.055, delta=0.03)
        self.assertGreater(linear, 0.1)
        viewer.key("i")
        viewer.rest(lambda s: s["comparison"] == "bar", "the bar")
        composite = pixels_of(viewer.press_for_file("F12", ".png"))
        self.same(composite, [(left if x < 80 else right)[160 * y + x] for y in range(120) for x in range(160)])
        drop(self.screen, viewer.id, self.reference("other.jpg"))
        viewer.rest(lambda s: s["reference"].endswith("other.jpg"), "the other one")
        self.ends_well(viewer, viewer.close())

    def test_it_can_be_closed_and_must_be_a_picture(self):
        viewer = self.view("furnace", "--resolution", "640,700", "--spp", "1", "--stage", "flat", "--reference", self.reference("reference.pfm"))
        status = viewer.rest(lambda s: s["reference"], "the reference")
        self.assertTrue(any("scaled" in m for m in status["messages"]), status["messages"])
        viewer.click("close reference")
        status = viewer.rest(lambda s: not s["reference"] and len(s["sides"]) == 2, "side B is traced")
        self.ends_well(viewer, viewer.close())
        picture = self.folder / "broken.png"
        picture.write_text("no picture")
        result = subprocess.run([FRAGTRACE, "view", SCENES / "furnace.gltf", "--reference", picture], capture_output=True, text=True)
        self.assertEqual(result.returncode, 3)
        self.assertIn("broken.png", result.stderr)


class Overview(Case):
    def test_all_stages_side_by_side(self):
        viewer = self.view("plastics", "--resolution", "480,360", "--spp", "2", "--tone-map", "linear")
        viewer.key("o")
        stages = ["flat", "phong", "shadows", "reflections", "refraction", "normal-maps", "gi"]
        viewer.rest(lambda s: [side["stages"][:i + 1] == stages[:i + 1] and side["samples"] == 2 and side["width"] == 160
                               for i, side in enumerate(s["sides"])] == [True] * 7, "seven pictures")
        time.sleep(0.3)
        width, _, shown = viewer.grab()
        for i in (0, 6):  # below the labels
            rendered = pixels_of(self.render("plastics", "--resolution", "160,120", "--spp", 2, "--tone-map", "linear", "--stage", stages[i],
                                             name=f"{i}.png"))
            x, y = i % 3 * 160, i // 3 * 120
            cell = [shown[width * (y + v) + x + u] for v in range(40, 110) for u in range(160)]
            self.assertLessEqual(largest_difference(cell, rendered[160 * 40:160 * 110]), 1, stages[i])
        sheet = pixels_of(viewer.press_for_file("F12", ".png"))
        self.assertEqual(len(sheet), 480 * 360)
        for i in (0, 6):
            cell = [sheet[480 * (i // 3 * 120 + v) + i % 3 * 160 + u] for v in range(120) for u in range(160)]
            # Files are dithered by the places of their pixels.
            self.assertLessEqual(largest_difference(cell, pixels_of(self.folder / f"rendered/{i}.png")), 2, stages[i])
        self.assertEqual(set(sheet[480 * 240 + 160:480 * 240 + 480]), {(0, 0, 0)})  # no eighth and ninth
        for key in ("F3", "v"):
            viewer.key(key)
            viewer.until(lambda s: not s["overview"], f"{key} is of one picture")
            viewer.key("shift+" + key if key == "v" else key)
            viewer.key("o")
            viewer.rest(lambda s: s["overview"], "all stages again")
        viewer.click("All")
        viewer.until(lambda s: not s["overview"], "one picture")
        tip = viewer.until(lambda s: "tip" in s["places"], "a tip")["places"]["tip"]
        self.assertGreaterEqual(tip[0], 0)
        self.assertLessEqual(tip[0] + tip[2], width)
        viewer.key("o")
        viewer.rest(lambda s: s["overview"], "all stages again")
        viewer.at(400, 60)
        viewer.xdotool("click", 1)
        status = viewer.rest(lambda s: not s["overview"], "the stage that was clicked on")
        self.assertEqual([n for n in status["sides"][0]["stages"] if n in stages], stages[:3])
        self.ends_well(viewer, viewer.close())


if __name__ == "__main__":
    main()

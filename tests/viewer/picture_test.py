#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The window shows and writes the picture that `render` draws, for every toggle, camera, size and tone map."""
import math
import re
import shlex
import signal
import time

from support import EXTENDED, Case, largest_difference, main, pixels_of, read_png

SIZE = ["--resolution", "160,120"]
FEW = [*SIZE, "--spp", "4"]
# Keys, and the options of `render` that do the same. (F2 turns Blinn-Phong off, which gi does without.)
SWITCHES = {"F3": ["--disable", "shadows"], "F4": ["--disable", "reflections"], "F5": ["--disable", "refraction"],
            "F6": ["--disable", "normal-maps"], "F7": ["--disable", "gi"], "F8": ["--enable", "schlick"],
            "F9": ["--disable", "energy-compensation"], "F10": ["--disable", "sobol"], "shift+F11": ["--disable", "light-sampling"],
            "x": ["--debug-view", "visits"]}


class Toggles(Case):
    def test_each_toggle_gives_the_picture_that_render_gives(self):
        keys = ("F3", "F6", "F7", "x", "F4", "F5", "F8", "F10")
        self.toggle("water-cube", keys if EXTENDED else keys[:4])

    def test_so_do_those_of_light_and_roughness(self):
        self.toggle("plastics", ("F9", "shift+F11"))

    def toggle(self, scene, keys):
        # The window expects more paths, which choose literals; these round otherwise where they join faces.
        few = [*FEW, "--traversal", "front-to-back"]
        viewer = self.view(scene, *few)
        plain = pixels_of(viewer.press_for_file("F12", ".png"))
        self.same(plain, pixels_of(self.render(scene, *few)))
        for key in keys:
            options = SWITCHES[key]
            with self.subTest(key=key, options=options):
                asked = viewer.status()["asked"]
                viewer.key(key)
                status = viewer.rest(lambda s: s["asked"] > asked, f"rest after {key}")
                self.assertEqual(status["sides"][0]["samples"], 4)
                shown = pixels_of(viewer.press_for_file("F12", ".png"))
                self.same(shown, pixels_of(self.render(scene, *few, *options)))
                self.assertTrue(shown != plain)
                asked = viewer.status()["asked"]
                viewer.key(key)
                viewer.rest(lambda s: s["asked"] > asked, f"rest after {key} again")
        self.ends_well(viewer, viewer.close())


class Display(Case):
    def test_the_window_shows_what_render_writes_within_one_level(self):
        viewer = self.view("plastics", *FEW, "--exposure", "0.5", "--tone-map", "linear")
        for curve in ("linear", "reinhard", "aces", "agx", "neutral"):
            with self.subTest(curve=curve):
                viewer.until(lambda s: s["tone_map"] == curve, curve)
                time.sleep(0.3)  # messages of screenshots must be gone, and the frame must be shown
                rendered = pixels_of(self.render("plastics", *SIZE, "--spp", 4, "--exposure", "0.5", "--tone-map", curve))
                width, height, shown = viewer.picture()
                self.assertEqual((width, height), (160, 120))
                self.assertLessEqual(largest_difference(shown, rendered), 1)
            viewer.key("t")
        self.ends_well(viewer, viewer.close())

    def test_a_page_keeps_its_colour(self):
        """In the window, and in what F12 writes, as `render` does."""
        page = ["--background-color", "#80c0ff", "--exposure", "1", "--spp", "4"]
        viewer = self.view("sphere-phong", *SIZE, *page)
        viewer.rest()
        time.sleep(0.3)
        rendered = pixels_of(self.render("sphere-phong", *SIZE, *page))
        self.assertEqual(tuple(rendered[0][:3]), (0x80, 0xc0, 0xff))
        self.assertLessEqual(largest_difference(viewer.picture()[2], rendered), 1)
        self.same(pixels_of(viewer.press_for_file("F12", ".png")), rendered)
        self.ends_well(viewer, viewer.close())


class Camera(Case):
    def measures(self, viewer, picked):
        """Shift+click says how far it is from the point that was clicked, until the next click."""
        place = lambda lines: [float(x) for x in next(line for line in lines if line.startswith("at "))[3:].split(";")[0].split(",")]
        viewer.at(130, 50)  # next to the lines about the first
        viewer.xdotool("keydown", "shift", "click", 1, "keyup", "shift")
        said = viewer.until(lambda s: s["measured"], "the distance", 10)["measured"]
        self.assertEqual(viewer.status()["pick"], picked)  # the picked surface stays
        time.sleep(0.5)  # else it is a double click
        viewer.xdotool("click", 1)
        there = viewer.until(lambda s: s["pick"] and s["pick"] != picked, "the other point")
        self.assertIsNone(there["measured"])
        way = [b - a for a, b in zip(place(picked), place(there["pick"]))]
        numbers = [float(x) for x in re.findall(r"-?[\d.]+(?:e-\d+)?", said)]
        for found, expected in zip(numbers, [math.hypot(*way), *way], strict=True):
            self.assertAlmostEqual(found, expected, delta=2e-3)
        self.assertGreater(numbers[0], 0.1)

    def test_a_panorama_moves_and_is_rendered_by_its_options(self):
        viewer = self.view("plastics", *FEW, "--camera-type", "panorama", "--camera-position", "0,1,2")
        asked = viewer.status()["asked"]
        viewer.drag((60, 60), (110, 80), 1)
        status = viewer.rest(lambda s: s["asked"] > asked, "rest after a drag")
        self.assertIn("--camera-type panorama", status["camera"])
        self.same(pixels_of(viewer.press_for_file("F12", ".png")), pixels_of(self.render("plastics", "--spp", 4, *shlex.split(status["camera"]))))
        asked = status["asked"]
        viewer.key("5")
        status = viewer.rest(lambda s: s["asked"] > asked, "rest as a perspective")
        self.assertNotIn("--camera-type", status["camera"])
        self.same(pixels_of(viewer.press_for_file("F12", ".png")), pixels_of(self.render("plastics", "--spp", 4, *shlex.split(status["camera"]))))

    def test_an_orbited_view_is_rendered_exactly_by_its_options(self):
        viewer = self.view("plastics", *FEW)
        before = viewer.status()["camera"]
        for button, end in ((1, (110, 80)), (2, (90, 50)), (3, (70, 40))):
            asked = viewer.status()["asked"]
            viewer.drag((60, 60), end, button)
            viewer.rest(lambda s: s["asked"] > asked, "rest after a drag")
        asked = viewer.status()["asked"]
        viewer.key("w")
        status = viewer.rest(lambda s: s["asked"] > asked, "rest after flying")
        shown = viewer.press_for_file("F12", ".png")
        rendered = self.render("plastics", "--spp", 4, *shlex.split(status["camera"]))
        self.assertEqual(read_png(shown)[:2], (160, 120))
        self.same(pixels_of(shown), pixels_of(rendered))
        self.assertTrue(pixels_of(shown) != pixels_of(self.render("plastics", *SIZE, "--spp", 4)))

        viewer.click("close messages")  # the messages cover half of so small a picture
        viewer.until(lambda s: "messages" not in s["places"], "closed")
        viewer.at(80, 80)
        viewer.xdotool("click", 1)
        picked = viewer.until(lambda s: s["pick"], "what is under the cursor")["pick"]
        self.assertTrue(any("roughness" in line for line in picked), picked)
        self.measures(viewer, picked)
        viewer.keys_at_once("ctrl+c", "f")  # the first is done before the second
        viewer.rest(lambda s: s["camera"] != status["camera"], "framed")
        viewer.key("ctrl+v")
        viewer.rest(lambda s: s["camera"] == status["camera"], "pasted")
        viewer.key("Return")
        viewer.rest(lambda s: s["camera"] == before, "reset")
        self.ends_well(viewer, viewer.close())

    def test_a_picture_asked_for_while_the_camera_moves_is_of_all_samples(self):
        # So large that moving frames are coarse.
        viewer = self.view("plastics", "--resolution", "640,480", "--spp", "1")
        asked = viewer.status()["asked"]
        viewer.drag((300, 200), (340, 220))
        shown = viewer.press_for_file("F12", ".png")
        camera = viewer.rest(lambda s: s["asked"] > asked, "rest after a drag")["camera"]
        self.same(pixels_of(shown), pixels_of(self.render("plastics", "--spp", 1, *shlex.split(camera))))
        self.ends_well(viewer, viewer.close())

    def test_a_last_moving_frame_that_took_long_does_not_leave_a_coarse_picture(self):
        quick = self.view("plastics", "--resolution", "640,480", "--spp", "1")
        ms = quick.status()["sides"][0]["frame_ms"]
        quick.close()
        # The window is so large that frames of a third of the size are fast enough while the camera moves, and those of
        # half the size are not. A frame that takes long changes the size by one step.
        scale = min((600 / ms) ** 0.5, 1.8)
        viewer = self.view("plastics", "--resolution", f"{round(640 * scale)},{round(480 * scale)}", "--spp", "1")
        size = viewer.status()["width"]
        for i in range(0, 8, 2):
            asked = viewer.status()["asked"]
            viewer.at(300, 200)
            viewer.xdotool("mousedown", 1)
            viewer.at(320 + i, 220)
            time.sleep(0.015 * i)
            viewer.process.send_signal(signal.SIGSTOP)  # during the frame, in one of these drags
            time.sleep(0.5)
            viewer.process.send_signal(signal.SIGCONT)
            viewer.xdotool("mouseup", 1)
            status = viewer.rest(lambda s, before=asked: s["asked"] > before, "rest after a drag")
            self.assertEqual(status["sides"][0]["width"], size)
        self.ends_well(viewer, viewer.close())

    def test_a_picture_is_of_the_camera_when_its_key_was_pressed(self):
        viewer = self.view("plastics", "--resolution", "320,240", "--spp", "1")
        viewer.keys_at_once("3", "F12")
        status = viewer.rest(lambda s: any("wrote" in m for m in s["messages"]), "a picture")
        shown = next(self.folder.glob("*.png"))
        self.same(pixels_of(shown), pixels_of(self.render("plastics", "--spp", 1, *shlex.split(status["camera"]))))
        self.ends_well(viewer, viewer.close())


if __name__ == "__main__":
    main()

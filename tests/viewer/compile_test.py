#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Programs are compiled while others draw: the window answers meanwhile, and nothing that is written is of another program."""
import time

from support import Case, main, pixels_of

SIZE = ["--resolution", "320,240", "--spp", "1"]


class Compiles(Case):
    def start(self, *options, disabled=False):
        """Starts the viewer with an empty driver cache, or without one."""
        environment = {**self.screen.environment, "MESA_SHADER_CACHE_DIR": str(self.folder / "cache")}
        if disabled:
            environment["MESA_SHADER_CACHE_DISABLE"] = "true"
        viewer = self.view("vitrine", *SIZE, *options, environment=environment, wait=False)
        viewer.window()
        return viewer

    def test_without_a_cache_programs_are_compiled_where_they_draw_after_a_quick_picture(self):
        viewer = self.start(disabled=True)
        seen = []
        viewer.until(lambda s: seen.append(tuple(side["variant"] for side in s.get("sides", []))) or s["state"] == "resting", "rest")
        quick = [variants[0] for variants in seen if variants and variants[0]]
        self.assertIn("phong", quick[0])
        self.assertNotIn("gi", quick[0].split("+"))
        self.assertIn("gi", quick[-1].split("+"))
        self.same(pixels_of(viewer.press_for_file("F12", ".png")), pixels_of(self.render("vitrine", *SIZE)))
        self.ends_well(viewer, viewer.close())

    def test_a_preview_turns_while_the_picture_is_compiled(self):
        viewer = self.start()
        def previews(status):
            return status["state"] == "compiling" and status["sides"] and "gi" not in status["sides"][0]["variant"]
        first = viewer.until(lambda s: previews(s) and s["pictures"] > 0, "a preview")
        viewer.key("F12")
        viewer.key("4")
        viewer.until(lambda s: previews(s) and s["pictures"] > first["pictures"] and s["camera"] != first["camera"], "a turned preview")
        viewer.key("Return")
        written = viewer.wait(lambda: next(iter(self.folder.glob("*.png")), None), 60, "a picture")
        status = viewer.rest()
        self.assertIn("gi", status["sides"][0]["variant"])
        self.assertEqual(status["camera"], first["camera"])
        self.same(pixels_of(written), pixels_of(self.render("vitrine", *SIZE)))
        self.ends_well(viewer, viewer.close())

    def test_the_box_of_a_message_that_grew_fits_it(self):
        viewer = self.start()
        says = "(this is a preview in Blinn-Phong)"
        viewer.until(lambda s: s["state"] == "compiling" and s["pictures"] > 0 and "messages" in s["places"], "a preview")
        time.sleep(0.5)
        status = viewer.status()
        if status["state"] == "compiling":
            self.assertGreater(status["places"]["messages"][2], 6 * len(says), "pixels")
        viewer.close()

    def test_the_old_picture_moves_until_another_stage_is_compiled(self):
        viewer = self.start("--stage", "phong")
        before = viewer.rest()
        viewer.key("shift+F7")
        viewer.until(lambda s: s["state"] == "compiling", "compiling")
        viewer.key("4")
        viewer.until(lambda s: s["state"] == "compiling" and s["pictures"] > before["pictures"], "the old picture, turned")
        viewer.key("shift+F2")
        back = viewer.rest(lambda s: s["pictures"] > before["pictures"], "the stage before")
        self.assertNotIn("gi", back["sides"][0]["variant"])
        viewer.key("shift+F7")
        viewer.rest(lambda s: "gi" in s["sides"][0]["variant"], "the other stage")
        self.ends_well(viewer, viewer.close())

    def test_the_sun_moves_while_the_picture_is_compiled(self):
        viewer = self.start("--sky")
        viewer.until(lambda s: s["state"] == "compiling" and s["pictures"] > 0, "compiling")
        viewer.xdotool("keydown", "shift")
        viewer.drag((100, 100), (180, 140), button=3)
        viewer.xdotool("keyup", "shift")
        status = viewer.rest(lambda s: "gi" in s["sides"][0]["variant"], "the picture")
        self.assertEqual(status["error"], "")
        written = viewer.press_for_file("F12", ".png")
        self.assertTrue(pixels_of(written) != pixels_of(self.render("vitrine", *SIZE, "--sky")), "the sun has moved")
        self.ends_well(viewer, viewer.close())

    def test_a_moving_picture_reads_textures_by_cones_and_a_resting_one_does_not(self):
        options = (*SIZE, "--traversal", "front-to-back")
        viewer = self.view("mapped-plane", *options, environment=self.screen.environment)
        moves_by_cones = lambda s: "ray-cones" in s["sides"][0]["variant"]
        def moves():
            """Moves the mouse while a button is held."""
            self.place = 300 - self.place
            viewer.at(self.place, 100)
            return moves_by_cones(viewer.status())
        self.place = 100
        viewer.at(self.place, 100)
        viewer.xdotool("mousedown", 1)
        viewer.wait(moves, 60, "a picture by cones")
        viewer.xdotool("mouseup", 1)
        self.assertFalse(moves_by_cones(viewer.rest(lambda s: not moves_by_cones(s), "without cones")))
        viewer.key("Return")
        viewer.rest()
        self.same(pixels_of(viewer.press_for_file("F12", ".png")), pixels_of(self.render("mapped-plane", *options)))
        self.ends_well(viewer, viewer.close())

    def test_it_ends_while_it_compiles(self):
        viewer = self.start()
        viewer.until(lambda s: s["state"] == "compiling" and s["pictures"] > 0, "compiling")
        self.assertEqual(viewer.close(), 0, viewer.stderr())


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The window gets pictures on the device if it has the tracing thread's driver, and through the host otherwise. Both
ways show the same pictures."""
import time

from support import Case, main, pixels_of

SIZE = ["--resolution", "320,240", "--spp", "8", "--tone-map", "linear"]


class Sharing(Case):
    def test_shared_and_copied_pictures_are_those_of_render(self):
        rendered = pixels_of(self.render("cornell-box", *SIZE))
        for options, copied in (([], False), (["--rendering-backend", "egl"], True)):
            with self.subTest(copied=copied):
                viewer = self.view("cornell-box", *SIZE, "--denoise", "none", *options)
                viewer.rest(lambda s: s["sides"][0]["samples"] == 8)
                self.assertEqual(viewer.status()["sides"][0]["copied"], copied)
                self.same(viewer.picture()[2], rendered, ties=4)
                before = viewer.status()["pictures"]
                viewer.drag((60, 120), (260, 130))
                viewer.rest(lambda s: s["sides"][0]["samples"] == 8 and s["pictures"] > before)
                moved = viewer.picture()[2]
                self.assertNotEqual(moved, rendered)
                self.same(moved, pixels_of(viewer.press_for_file("F12", ".png")), ties=4)
                self.ends_well(viewer, viewer.close())

    def test_while_something_moves_the_window_is_drawn_for_new_pictures(self):
        viewer = self.view("cornell-box", "--resolution", "640,480", "--spp", "8")
        viewer.rest()
        viewer.at(100, 200)
        viewer.xdotool("mousedown", 1)
        began, before = time.monotonic(), viewer.status()
        for step in range(100):
            viewer.at(100 + 2 * step, 200)
        seconds, after = time.monotonic() - began, viewer.status()
        viewer.xdotool("mouseup", 1)
        came = after["pictures"] - before["pictures"]
        self.assertLessEqual(after["frames"] - before["frames"], came + 4 * seconds + 5)
        self.ends_well(viewer, viewer.close())

    def test_verbose_says_which(self):
        for options, said in (([], "pictures stay on the device: "), (["--rendering-backend", "egl"], "pictures are copied: they are drawn by ")):
            viewer = self.view("cornell-box", *SIZE, "--verbose", *options)
            viewer.until(lambda s, said=said: any(said in message for message in s["messages"]), said)
            self.ends_well(viewer, viewer.close())

    def test_two_sides_and_another_scene_give_textures_back(self):
        """More pictures than there are textures, of both sides, of sizes that change, and of a scene that is loaded
        again."""
        viewer = self.view("cornell-box", *SIZE, "--denoise", "variance")
        viewer.rest()
        viewer.key("c")
        viewer.until(lambda s: len(s["sides"]) == 2 and s["state"] == "resting", "two sides at rest")
        for turn in range(4):
            viewer.drag((60, 120), (200 + 10 * turn, 130))
            viewer.key("F5")
        viewer.until(lambda s: s["state"] == "resting" and all(side["samples"] == 8 for side in s["sides"]), "rest")
        left, right = viewer.picture()[2], viewer.press_for_file("F12", ".png")
        self.assertEqual(len(left), len(pixels_of(right)))
        self.assertEqual(viewer.status()["gl_errors"], [])
        self.ends_well(viewer, viewer.close())


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Animations in the viewer: played, paused, dragged to a time, and drawn as `render --animation-time` draws them."""
import json
import shlex
import subprocess

from support import FRAGTRACE, Case, main, pixels_of
from clipboard import clipboard_text
from gltf_file import SQUARE, TWO_TRIANGLES, Gltf

WIDTH = 640  # and so high that the panel shows the row of the time
FEW = ["--resolution", f"{WIDTH},520", "--spp", "2"]


def animated(folder, seconds=2.0):
    """A square that moves along x in the first clip, and along y in the second."""
    gltf = Gltf(materials=[{"pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.3, 0.1, 1], "metallicFactor": 0}, "doubleSided": True}])
    gltf.node(mesh=gltf.mesh(gltf.accessor(TWO_TRIANGLES, "H"), position=gltf.accessor(SQUARE), material=0))
    for name, x, y in (("across", 1, 0), ("up", 0, 1)):
        gltf.moves(0, [0, seconds], translation=[(-x, -y, 0), (x, y, 0)])["name"] = name
    return gltf.write(folder / "moving.gltf")


class Animation(Case):
    def playing(self, viewer, playing=True):
        return viewer.until(lambda s: s["animation"]["playing"] == playing, f"playing: {playing}")["animation"]

    def test_space_plays_and_pauses_and_the_picture_is_that_of_the_command(self):
        path = animated(self.folder)
        viewer = self.view(path, *FEW)
        first = viewer.status()
        self.assertEqual(first["animation"], {"index": 0, "playing": False, "length": 2.0, "time": None})
        viewer.key("space")
        self.playing(viewer)
        moved = viewer.until(lambda s: s["animation"]["time"] > 0.3 and s["answered"] >= first["answered"] + 3, "it moves")
        self.assertLess(moved["animation"]["time"], 2.0)
        away = path.rename(self.folder / "away")  # the document has been read
        moved = viewer.until(lambda s: s["error"] or s["answered"] >= moved["answered"] + 5, "it still moves")
        self.assertEqual(moved["error"], "")
        viewer.key("o")  # all stages stand still
        viewer.until(lambda s: s["overview"] and not s["animation"]["playing"], "all stages")
        viewer.key("space")
        viewer.until(lambda s: not s["overview"] and s["animation"]["playing"], "it goes on")
        viewer.key("space")
        time = self.playing(viewer, False)["time"]
        status = viewer.rest(lambda s: s["sides"][0]["samples"] == 2 and s["sides"][0]["width"] == WIDTH)
        self.assertEqual(status["animation"]["time"], time)
        away.rename(path)
        words = self.shows_the_copied_command(viewer)
        self.assertIn(f"{time:.17g}"[:6], words[words.index("--animation-time") + 1])
        self.assertEqual(status["error"], "")
        self.ends_well(viewer, viewer.close())

    def shows_the_copied_command(self, viewer):
        """Compares the window bit by bit with the copied command, and returns the command's words."""
        shown = pixels_of(viewer.press_for_file("F12", ".png"))
        viewer.key("ctrl+c")
        viewer.until(lambda s: any("copied" in m for m in s["messages"]), "copied")
        words = shlex.split(clipboard_text(self.screen))
        output = self.folder / "command.png"
        words[words.index("--output") + 1] = str(output)
        tree = [] if "--traversal" in words else ["--traversal", "front-to-back"]
        subprocess.run([FRAGTRACE, *words[1:], *tree, "--quiet"], check=True, cwd=self.folder, timeout=300)
        self.same(shown, pixels_of(output))
        return words

    def test_lines_have_their_width_again_when_the_camera_rests(self):
        path = animated(self.folder)
        gltf = json.loads(path.read_text())
        gltf["meshes"][0]["primitives"][0]["mode"] = 2
        del gltf["animations"]
        path.write_text(json.dumps(gltf))
        viewer = self.view(path, "--resolution", "900,700", "--spp", "2", "--line-width", "6")  # so large that moving frames are coarse
        before = viewer.status()
        viewer.at(450, 350)
        for _ in range(4):
            viewer.xdotool("click", 4)
        viewer.rest(lambda s: s["camera"] != before["camera"] and s["answered"] > before["answered"] and s["sides"][0]["width"] == 900)
        self.shows_the_copied_command(viewer)
        self.ends_well(viewer, viewer.close())

    def test_at_the_end_it_begins_again_or_stops(self):
        viewer = self.view(animated(self.folder, 0.5), *FEW)
        viewer.click("Play")
        seen = []
        viewer.until(lambda s: seen.append(s["animation"]["time"] or 0) or any(b < a for a, b in zip(seen, seen[1:])), "it begins again")
        viewer.click("Loop")
        self.assertEqual(self.playing(viewer, False)["time"], 0.5)
        viewer.key("space")
        self.assertLess(self.playing(viewer)["time"], 0.5)
        self.assertEqual(self.playing(viewer, False)["time"], 0.5)

    def test_a_time_and_a_clip_can_be_chosen(self):
        viewer = self.view(animated(self.folder), *FEW, "--stage", "flat", "--watch")
        viewer.key("space")
        self.playing(viewer)
        viewer.click("Time")
        chosen = self.playing(viewer, False)
        self.assertAlmostEqual(chosen["time"], 1.0, delta=0.1)
        before = viewer.rest()
        viewer.key("p")
        after = viewer.rest(lambda s: s["animation"]["index"] == 1)
        self.assertEqual(after["animation"]["time"], 0)
        self.assertGreater(after["answered"], before["answered"])
        viewer.key("shift+p")
        self.assertEqual(viewer.rest(lambda s: s["animation"]["index"] == 0)["animation"]["time"], 0)
        # Poses are those of the file that is watched, as it is now.
        animated(self.folder, 4.0)
        viewer.until(lambda s: s["animation"]["length"] == 4.0, "it is loaded again")
        viewer.click("Time")
        viewer.rest(lambda s: abs((s["animation"]["time"] or 0) - 2.0) < 0.2 and s["sides"][0]["samples"] == 2 and s["sides"][0]["width"] == WIDTH)
        self.shows_the_copied_command(viewer)

    def test_without_animations_nothing_plays(self):
        viewer = self.view("furnace", *FEW)
        self.assertIsNone(viewer.status()["animation"])
        viewer.key("space", "p")
        self.assertIsNone(viewer.rest()["animation"])


if __name__ == "__main__":
    main()

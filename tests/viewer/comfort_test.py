#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Tests of the viewer's comforts: the first picture, the docked panel, undo, views with a name, comparison, enlarged
pixels, help."""
import json
import shlex
import subprocess
import time

from Xlib import X

from animation_test import animated
from clipboard import clipboard_text
from support import FRAGTRACE, SCENES, Case, main, pixels_of, wait_for
from xdnd import drop

SIZE = ["--resolution", "160,120"]
FEW = [*SIZE, "--spp", "4"]
PANEL = ["--resolution", "640,700", "--spp", "1", "--stage", "flat"]


def copied_command(case, viewer):
    viewer.key("ctrl+c")
    viewer.until(lambda s: any("copied" in m for m in s["messages"]), "copied")
    return shlex.split(clipboard_text(case.screen))


class FirstPicture(Case):
    def test_a_model_alone_is_seen_from_the_side_in_the_studio_and_the_command_draws_the_same(self):
        viewer = self.view(animated(self.folder), *FEW, "--default-light", "studio")
        status = viewer.rest()
        self.assertIn("no light in the scene: the built-in studio lights it", status["messages"])
        position = [float(v) for v in shlex.split(status["camera"])[1].split(",")]
        self.assertGreater(position[0], 0)  # from the right,
        self.assertGreater(position[1], 0)  # and from above
        shown = pixels_of(viewer.press_for_file("F12", ".png"))
        words = copied_command(self, viewer)
        self.assertNotIn("--default-light", words)  # `render` lights the scene in the same way
        words[words.index("--output") + 1] = str(self.folder / "command.png")
        subprocess.run([FRAGTRACE, *words[1:], "--quiet"], check=True, cwd=self.folder, timeout=300)
        self.same(shown, pixels_of(self.folder / "command.png"))
        self.ends_well(viewer, viewer.close())

    def test_the_copied_command_says_every_option_that_was_given(self):
        said = ["--pixel-filter", "gaussian", "--line-width", "3", "--enable", "schlick", "--disable", "sobol", "--sample-offset", "3",
                "--seed", "7", "--bounces", "3", "--rr-depth", "2", "--clamp-indirect", "5", "--light-selection", "power",
                "--light-reuse", "candidates", "--caustics", "off", "--hdri-rotation", "10", "--hdri-intensity", "0.5",
                "--shadow-catcher", "-1.5", "--background-color", "0.5,0.25,1", "--default-light", "none", "--traversal", "bvh",
                "--instancing", "share", "--buffer-reads", "ssbo", "--dispatch", "compute", "--tune", "gpu", "--vector-width", "256",
                "--schedule", "megakernel", "--memory-limit", "1000000000", "--texture-limit", "512", "--missing-textures", "refuse",
                "--aov", "normal,samples", "--tree-level", "2", "--exposure", "1", "--tone-map", "aces", "--denoise", "variance",
                "--f-stop", "2", "--focus-distance", "3", "--aperture-blades", "5"]
        switches = ["--no-background", "--allow-external-files"]
        words = copied_command(self, self.view("cornell-box", *FEW, *said, *switches))
        pairs = set(zip(words, words[1:]))
        self.assertEqual([pair for pair in zip(said[::2], said[1::2]) if pair not in pairs], [])
        self.assertLessEqual(set(switches), set(words))

    def test_cameras_and_lights_of_the_file_stay(self):
        few = [*FEW, "--traversal", "front-to-back"]  # the window expects more paths, which choose literals
        viewer = self.view("lights", *few, "--default-light", "studio")
        words = copied_command(self, viewer)
        self.assertNotIn("--default-light", words)
        self.same(pixels_of(viewer.press_for_file("F12", ".png")), pixels_of(self.render("lights", *few)))
        self.ends_well(viewer, viewer.close())


class Panel(Case):
    def test_the_picture_has_what_the_panel_leaves(self):
        viewer = self.view("furnace", *PANEL)
        status = viewer.rest(lambda s: "panel" in s["places"])
        self.assertEqual((status["width"], status["height"]), (640, 700))
        left, _, width, _ = status["places"]["panel"]
        self.assertEqual(left, 640)
        viewer.drag((left + 2, 300), (left - 100, 300))
        status = viewer.rest(lambda s: s["places"]["panel"][2] == width + 100, "a wider panel")
        self.assertEqual(status["width"], 540)
        viewer.key("Tab")
        viewer.rest(lambda s: s["width"] == 640 + width, "all of the window")
        self.assertNotIn("panel", viewer.status()["places"])
        viewer.click("Panel")
        viewer.rest(lambda s: "panel" in s["places"], "the panel again")
        for size in ((420, 700), (300, 200)):
            viewer.xdotool("windowsize", "--sync", viewer.id, *size)
            status = viewer.rest(lambda s: s["width"] == size[0] and "panel" not in s["places"], f"a picture alone in {size}")
            for name in ("stage flat", "stage gi", "Panel"):
                x, y, w, h = status["places"][name]
                self.assertTrue(0 <= x and x + w <= size[0] and status["height"] <= y and y + h <= size[1], (name, status["places"]))
        viewer.xdotool("windowsize", "--sync", viewer.id, 1280, 800)
        viewer.rest(lambda s: "panel" in s["places"], "the panel with its room")
        self.ends_well(viewer, viewer.close())

    def test_presets_and_the_status_bar(self):
        viewer = self.view("furnace", *PANEL, "--fog-density", "0.1")
        cumulative = ["flat", "phong", "shadows", "reflections", "refraction", "normal-maps", "gi"]
        for name, last in (("Phong", 5), ("Path traced", 6), ("stage reflections", 3), ("stage gi", 6), ("Preview", 1)):
            viewer.click(name)
            status = viewer.rest(lambda s: [n for n in s["sides"][0]["stages"] if n in cumulative] == cumulative[:last + 1], name)
        # The last one clicked is still under the cursor; what explains it stands next to the panel.
        places = viewer.until(lambda s: "tip" in s["places"], "what it does")["places"]
        self.assertLessEqual(places["tip"][0] + places["tip"][2], places["panel"][0])
        self.assertIn("finished; 1 sample per pixel", status["status"])
        self.assertIn("640 x 700", status["status"])
        self.assertNotIn("0, 0: ", status["status"])  # before the pointer has been over the picture
        viewer.at(320, 350)
        status = viewer.until(lambda s: "320, 350: " in s["status"], "the pixel")
        viewer.click("Path traced")
        places = viewer.rest(lambda s: "gi" in s["sides"][0]["stages"], "fog")["places"]
        row, box = places["Fog"], places["Fog colour"]
        self.assertLessEqual(box[0] + box[2], row[0] + row[2])
        viewer.click("Fog colour")
        viewer.until(lambda s: s["focus"] == "popup", "its colour")
        viewer.key("Escape")
        viewer.until(lambda s: s["focus"] == "picture", "closed")
        viewer.at(row[0] + 40, row[1] + 5)
        viewer.until(lambda s: "tip" in s["places"], "what it is")
        viewer.key("v")
        status = viewer.rest(lambda s: "name view" in s["places"], "what the picture shows")
        viewer.key("shift+v")
        viewer.rest(lambda s: "name view" not in s["places"], "light")
        self.ends_well(viewer, viewer.close())

    def test_an_environment_is_chosen(self):
        viewer = self.view("furnace", *PANEL)
        before = viewer.rest()
        viewer.click("Environment")
        viewer.until(lambda s: s["focus"] == "popup", "the list")
        # The list has as many thumbnails as there are files next to the scene, and one of the studio.
        viewer.until(lambda s: s["thumbnails"] >= 1 + len(list(SCENES.glob("*.pfm"))), "pictures of them")
        viewer.click("environment sky.pfm")
        status = viewer.rest(lambda s: s["environment"].endswith("sky.pfm"), "chosen")
        self.assertEqual(status["camera"], before["camera"])
        viewer.key("ctrl+z")
        viewer.rest(lambda s: s["environment"] == "", "undone")
        viewer.key("ctrl+y")
        viewer.rest(lambda s: s["environment"].endswith("sky.pfm"), "done again")
        viewer.xdotool("keydown", "ctrl")
        viewer.click("Rotation")
        viewer.until(lambda s: s["focus"] == "text", "a number")
        viewer.xdotool("keyup", "ctrl")
        viewer.keys_at_once("ctrl+a", *"400", "Return")
        viewer.rest(lambda s: s["hdri_rotation"] == 40, "round and round")
        self.ends_well(viewer, viewer.close())


class Defaults(Case):
    def keeps(self, text):
        self.file = self.folder / "config/fragtrace/view.json"
        self.file.parent.mkdir(parents=True, exist_ok=True)
        self.file.write_text(text)

    def test_the_viewer_begins_with_them_and_render_does_not(self):
        self.keeps(json.dumps({"tone-map": "agx", "no-panel": True, "studio": True, "enable": "schlick"}))
        before = self.render("furnace", *FEW, name="before.png").read_bytes()
        rendered = self.folder / "a.png"
        subprocess.run([FRAGTRACE, "render", SCENES / "furnace.gltf", "-o", rendered, *FEW, "--quiet", "--default-light", "white"], check=True,
                       env={**self.screen.environment, "XDG_CONFIG_HOME": str(self.folder / "config")})
        self.assertEqual(rendered.read_bytes(), before)
        config = self.folder / "own.json"
        config.write_text(json.dumps({"tone-map": "aces", "disable": "sobol"}))
        for options, curve, panel, schlick in (([], "agx", False, True), (["--no-config"], "neutral", True, False), (["--tone-map", "linear"], "linear", False, True),
                                               (["--config", config], "aces", False, True), (["--sky"], "agx", False, True)):
            viewer = self.view("furnace", *PANEL, *options)
            status = viewer.rest()
            seen = status["tone_map"], status["panel"], "schlick" in status["sides"][0]["stages"]
            self.assertEqual(seen, (curve, panel, schlick), options)
            self.assertEqual(viewer.stderr().count("defaults"), 0)
            self.assertNotIn("--studio", copied_command(self, viewer), options)  # Viewer says who lights the scene
            self.ends_well(viewer, viewer.close())

    def test_a_file_that_cannot_be_used_is_a_warning(self):
        for text, says in (("{", "at line 1"), ("[]", "is no JSON object"), ('{"tone-map": "agx", "size": 3}', "view.json: /size: is no option"), ('{"bounces": "x"}', "/bounces"),
                           ('{"fog-density": 0.1, "shadow-catcher": "bottom"}', "view.json: /fog-density: cannot be combined")):
            self.keeps(text)
            viewer = self.view("furnace", *FEW)
            status = viewer.rest()
            message = next(m for m in status["messages"] if m.startswith("the viewer's defaults are left out: "))
            self.assertIn(says, message)
            self.assertIn("fragtrace: warning: the viewer's defaults are left out", viewer.stderr())
            self.assertEqual(status["tone_map"], "neutral")
            self.ends_well(viewer, viewer.close())
        broken = subprocess.run([FRAGTRACE, "view", SCENES / "furnace.gltf", "--bounces", "x"], capture_output=True, text=True,
                                env={**self.screen.environment, "XDG_CONFIG_HOME": str(self.folder / "config")})
        self.assertEqual((broken.returncode, "view.json" in broken.stderr), (2, False))

    def test_what_is_set_is_kept(self):
        self.keeps(json.dumps({"bounces": 3, "tone-map": "agx"}))
        viewer = self.view("sphere-phong", "--resolution", "640,920", "--spp", "1", "--stage", "flat", "--default-light", "white")
        drop(self.screen, viewer.id, SCENES / "sky.pfm")
        viewer.rest(lambda s: s["environment"].endswith("sky.pfm"), "an environment")
        viewer.key("t")
        viewer.rest(lambda s: s["tone_map"] == "neutral", "the next curve")
        viewer.click("section Camera")  # makes room in the panel
        viewer.rest(lambda s: "Projection" not in s["places"], "closed")
        time.sleep(0.5)  # without a bar to scroll by, buttons move
        viewer.click("Keep as default")
        viewer.until(lambda s: f"kept as default in {self.file}" in s["messages"], "kept")
        kept = json.loads(self.file.read_text())
        self.assertEqual(kept, {"bounces": 3, "denoise": "none", "hdri-file": str(SCENES / "sky.pfm")})
        self.assertEqual([path.name for path in self.file.parent.iterdir()], ["view.json"])
        self.file.write_text("{")
        viewer.click("Keep as default")
        viewer.until(lambda s: any(m.startswith("not kept: ") and "view.json" in m for m in s["messages"]), "not kept")
        self.assertEqual(self.file.read_text(), "{")
        self.ends_well(viewer, viewer.close())


class Focus(Case):
    def test_a_click_focuses_without_moving_the_camera(self):
        viewer = self.view("sphere-plane", "--resolution", "640,920", "--spp", "1", "--stage", "gi")
        before = viewer.rest()
        viewer.at(320, 460)
        viewer.xdotool("keydown", "ctrl", "click", 1, "keyup", "ctrl")
        status = viewer.rest(lambda s: any(m.startswith("sharp at ") for m in s["messages"]), "focused")
        distance = float(next(m for m in status["messages"] if m.startswith("sharp at ")).split()[2])
        words = shlex.split(status["camera"])
        self.assertNotIn("--focus-distance", shlex.split(before["camera"]))
        self.assertAlmostEqual(float(words[words.index("--focus-distance") + 1]), distance, delta=1e-3 * distance)
        options = dict(zip(words[::2], words[1::2]))
        for name, value in zip(*[iter(shlex.split(before["camera"]))] * 2):
            self.assertEqual(options[name], value)
        viewer.until(lambda s: {"Focus distance", "Focal length"} <= set(s["places"]), "their rows")
        shown = pixels_of(viewer.press_for_file("F12", ".png"))
        words = copied_command(self, viewer)
        words[words.index("--output") + 1] = str(self.folder / "command.png")
        subprocess.run([FRAGTRACE, *words[1:], "--quiet"], check=True, cwd=self.folder, timeout=300)
        self.same(shown, pixels_of(self.folder / "command.png"))
        self.ends_well(viewer, viewer.close())


class Parts(Case):
    def test_a_variant_and_a_scene_are_chosen(self):
        path = animated(self.folder)
        gltf = json.loads(path.read_text())
        gltf["extensionsUsed"] = ["KHR_materials_variants"]
        gltf["extensions"] = {"KHR_materials_variants": {"variants": [{"name": "red"}, {"name": "blue"}]}}
        gltf["materials"].append({"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 1, 1]}})
        gltf["meshes"][0]["primitives"][0]["extensions"] = {"KHR_materials_variants": {"mappings": [{"material": 1, "variants": [1]}]}}
        gltf["nodes"].append({"mesh": 0, "translation": [5, 0, 0]})
        gltf["scenes"].append({"nodes": [1], "name": "aside"})
        path.write_text(json.dumps(gltf))
        viewer = self.view(path, *PANEL)
        first = viewer.status()["camera"]
        viewer.drag((200, 300), (300, 350))
        turned = viewer.rest(lambda s: s["camera"] != first, "turned")["camera"].split(" --scene-origin")[0]
        for name, down, option in (("Variant", 2, ["--material-variant", "1"]), ("Scene", 2, ["--scene", "1"])):
            viewer.click(name)
            viewer.until(lambda s: s["focus"] == "popup", "the list")
            x, y, width, height = viewer.status()["places"][name]
            viewer.at(round(x + 40), round(y + height + 8 + 20 * down + 8))
            time.sleep(0.2)
            viewer.xdotool("click", 1)
            viewer.until(lambda s: s["focus"] == "picture", "chosen")
            viewer.rest()
            # The load may not have begun yet.
            words = viewer.wait(lambda option=option: next((w for w in [copied_command(self, viewer)] if option[0] in w), None), 20, option[0])
            self.assertEqual(words[words.index(option[0]) + 1], option[1])
            viewer.click("close messages")
            if name == "Variant":
                viewer.key("ctrl+z")
                viewer.rest(lambda s: s["variant"] == "", "none is undone")
                self.assertEqual(viewer.status()["camera"].split(" --scene-origin")[0], turned)
                viewer.key("ctrl+y")
                viewer.rest(lambda s: s["variant"] == "1", "chosen again")
        self.ends_well(viewer, viewer.close())


class Undo(Case):
    def test_camera_and_settings_go_back_and_forth(self):
        viewer = self.view("sphere-phong", *FEW)
        first = viewer.rest()
        viewer.drag((60, 60), (100, 75))
        turned = viewer.rest(lambda s: s["camera"] != first["camera"])
        viewer.key("F3")
        viewer.rest(lambda s: "shadows" not in s["sides"][0]["stages"], "no shadows")
        viewer.key("ctrl+z")
        viewer.rest(lambda s: "shadows" in s["sides"][0]["stages"] and s["camera"] == turned["camera"], "shadows again")
        viewer.key("ctrl+z")
        viewer.rest(lambda s: s["camera"] == first["camera"], "the first view")
        self.same(pixels_of(viewer.press_for_file("F12", ".png")), pixels_of(self.render("sphere-phong", *SIZE, "--spp", 4)))
        viewer.key("ctrl+z")
        viewer.until(lambda s: "nothing to undo" in s["messages"][-1], "no more")
        viewer.key("ctrl+y")
        viewer.rest(lambda s: s["camera"] == turned["camera"], "turned again")
        viewer.key("ctrl+shift+z")
        viewer.rest(lambda s: "shadows" not in s["sides"][0]["stages"], "no shadows again")
        self.ends_well(viewer, viewer.close())

    def test_reset_all_takes_back_what_is_loaded_too(self):
        viewer = self.view("sphere-phong", "--resolution", "640,920", "--spp", "1", "--stage", "flat")
        drop(self.screen, viewer.id, SCENES / "sky.pfm")
        viewer.rest(lambda s: s["environment"].endswith("sky.pfm"), "an environment")
        viewer.key("l")
        viewer.rest(lambda s: s["exposure"] > 0, "brighter")
        viewer.click("section Camera")  # makes room in the panel
        viewer.rest(lambda s: "Projection" not in s["places"], "closed")
        time.sleep(0.5)  # without a bar to scroll by, buttons move
        viewer.click("Reset all")
        status = viewer.rest(lambda s: s["environment"] == "", "the light of the start")
        self.assertEqual(status["exposure"], 0)
        viewer.key("ctrl+z")
        viewer.rest(lambda s: s["exposure"] > 0, "undone")
        self.ends_well(viewer, viewer.close())

    def test_views_with_a_name_are_kept(self):
        options = ["--resolution", "640,800", "--spp", "1", "--stage", "flat"]
        viewer = self.view("sphere-phong", *options)
        viewer.click("Bookmark name")
        viewer.until(lambda s: s["focus"] == "text", "a name")
        viewer.xdotool("type", "left ear")
        viewer.click("Keep view")
        kept = viewer.until(lambda s: "view 0" in s["places"], "kept")["camera"]
        self.assertIn("left ear", (self.folder / "state/fragtrace/viewer.json").read_text())
        self.ends_well(viewer, viewer.close())
        viewer = self.view("sphere-phong", *options)
        viewer.drag((200, 300), (300, 350))
        viewer.rest(lambda s: s["camera"] != kept, "moved")
        viewer.click("view 0")
        viewer.rest(lambda s: s["camera"] == kept, "back")
        viewer.click("forget view 0")
        viewer.until(lambda s: "view 0" not in s["places"], "forgotten")
        viewer.click("Bookmark name")
        viewer.until(lambda s: s["focus"] == "text", "a name")
        viewer.keys_at_once(*"ears", "Return")  # Enter counts, with all that was typed before it
        viewer.until(lambda s: "view 0" in s["places"], "kept")
        self.assertIn('"ears"', (self.folder / "state/fragtrace/viewer.json").read_text())
        viewer.click("forget view 0")
        viewer.until(lambda s: "view 0" not in s["places"], "forgotten")
        self.assertNotIn("left ear", (self.folder / "state/fragtrace/viewer.json").read_text())
        self.ends_well(viewer, viewer.close())


class Compare(Case):
    def test_one_side_the_other_and_their_difference(self):
        viewer = self.view("plastics", "--resolution", "640,480", "--spp", "4", "--tone-map", "linear")
        drawn = viewer.rest()["sides"][0]["seconds"]
        viewer.key("c")
        status = viewer.rest(lambda s: len(s["sides"]) == 2 and all(side["samples"] == 4 for side in s["sides"]), "both")
        self.assertEqual(status["sides"][0]["seconds"], drawn)  # it keeps its samples
        viewer.key("u")
        viewer.until(lambda s: s["comparison"] == "difference", "difference")
        self.assertEqual(self.middle(viewer), [(0, 0, 0)] * 400)
        viewer.key("r", "r")  # the right side is chosen with it
        viewer.until(lambda s: s["comparison"] == "right", "the right side")
        viewer.key("F9")
        viewer.rest(lambda s: len(s["sides"]) == 2 and "energy-compensation" not in s["sides"][1]["stages"], "it differs")
        pictures = {}
        for name in ("left", "right"):
            viewer.key("r")
            viewer.until(lambda s: s["comparison"] == name, name)
            pictures[name] = self.middle(viewer)
        self.assertNotEqual(*pictures.values())
        viewer.key("u")
        viewer.until(lambda s: s["comparison"] == "difference", "difference")
        viewer.at(50, 50)
        viewer.until(lambda s: "|A - B| 50, 50: " in s["status"], "the difference under the cursor")
        self.assertTrue(any(pixel != (0, 0, 0) for pixel in self.middle(viewer)))
        viewer.key("i")
        viewer.until(lambda s: s["comparison"] == "bar" and s["status"].split("; ")[1].startswith("B: "), "the bar, side B")
        viewer.at(100, 240)
        viewer.xdotool("click", 1)
        viewer.rest(lambda s: s["status"].split("; ")[1].startswith("A: "), "side A is chosen")
        time.sleep(0.5)  # or it would be a double click; and for what would be said of an object
        self.assertIsNone(viewer.status()["pick"])
        viewer.xdotool("click", 1)
        viewer.until(lambda s: s["pick"], "an object is selected on it")
        self.ends_well(viewer, viewer.close())

    def middle(self, viewer):
        """A part of the picture that nothing is written over."""
        time.sleep(0.3)
        width, _, pixels = viewer.picture()
        return [pixels[width * y + x] for y in range(230, 250) for x in range(90, 110)]  # pixels of a ball


class Pixels(Case):
    def test_they_are_enlarged_about_the_cursor(self):
        viewer = self.view("plastics", *FEW)
        time.sleep(0.3)
        width, height, plain = viewer.picture()
        viewer.at(80, 60)
        for _ in range(3):
            viewer.key("equal")
        viewer.until(lambda s: s["magnified"] == 8, "8 times")
        time.sleep(0.3)
        _, _, large = viewer.picture()
        for y in range(20, 100, 8):  # each pixel is a square of 8 by 8
            for x in range(0, 160, 8):
                self.assertEqual(large[width * y + x + 3], plain[width * (60 + (y - 60) // 8) + 80 + (x + 3 - 80) // 8], (x, y))
        viewer.key("Escape")
        viewer.until(lambda s: s["magnified"] == 1, "as before")
        self.ends_well(viewer, viewer.close())


class Wheel(Case):
    def test_it_zooms_to_the_cursor_and_sets_the_speed_of_flight(self):
        viewer = self.view("sphere-plane", *FEW)
        before = viewer.rest()
        viewer.at(100, 70)
        viewer.xdotool("click", 4)
        status = viewer.rest(lambda s: s["camera"] != before["camera"], "nearer")
        self.assertIn("--camera-focal-point", status["camera"])
        speed = status["fly_speed"]
        viewer.xdotool("keydown", "w")
        viewer.xdotool("click", 4)
        viewer.until(lambda s: s["fly_speed"] > speed, "faster")
        viewer.xdotool("keyup", "w")
        self.ends_well(viewer, viewer.close())


class Selection(Case):
    AMBER = (255, 194, 89)

    def amber(self, viewer, plain):
        """Pixels of about that colour, which were another before: the edges of lines blend with what is behind."""
        return sum(pixel != before and max(abs(a - b) for a, b in zip(pixel, self.AMBER)) < 60
                   for pixel, before in zip(viewer.picture()[2], plain))

    def test_what_was_clicked_on_is_boxed_and_framed(self):
        viewer = self.view("plastics", "--resolution", "640,480", "--spp", "1", "--stage", "flat")
        first = viewer.rest()
        time.sleep(0.3)
        plain = viewer.picture()[2]
        self.assertIsNone(first["selected"])
        viewer.at(60, 240)
        viewer.xdotool("click", 1)
        box = viewer.rest(lambda s: s["selected"], "selected")["selected"]
        self.assertTrue(all(a < b for a, b in zip(box, box[3:])))
        time.sleep(0.3)
        self.assertGreater(self.amber(viewer, plain), 100)
        viewer.key("f")
        framed = viewer.rest(lambda s: s["camera"] != first["camera"], "framed")
        self.assertEqual(framed["selected"], box)
        words = shlex.split(framed["camera"])
        focal = [float(v) for v in words[words.index("--camera-focal-point") + 1].split(",")]
        for axis in range(3):
            self.assertAlmostEqual(focal[axis], 0.5 * (box[axis] + box[axis + 3]), places=5)
        viewer.key("shift+f")
        viewer.rest(lambda s: s["camera"] != framed["camera"], "all of it")
        viewer.click("close messages")
        viewer.rest(lambda s: s["selected"] is None, "nothing is selected")
        time.sleep(0.3)
        viewer.key("Return")
        viewer.rest(lambda s: s["camera"] == first["camera"], "the first view")
        time.sleep(0.3)
        self.assertEqual(self.amber(viewer, plain), 0)
        self.ends_well(viewer, viewer.close())


class Help(Case):
    def test_the_sheet_is_searched_and_the_window_fills_the_screen(self):
        viewer = self.view("furnace", "--resolution", "500,300", "--spp", "1")
        for key in ("h", "F1", "question"):
            viewer.key(key)
            viewer.until(lambda s: s["sheet"], key)
            viewer.key(key)
            viewer.until(lambda s: not s["sheet"], f"{key} again")
        viewer.key("h")
        everything = viewer.until(lambda s: s["sheet_lines"] > 20, "all lines")["sheet_lines"]
        viewer.click("Search")
        viewer.until(lambda s: s["focus"] == "text", "a field to type in")
        viewer.xdotool("type", "TONE")
        viewer.until(lambda s: s["sheet_lines"] == 1, f"one of {everything} lines")
        viewer.at(5, 5)
        viewer.xdotool("click", 1)
        viewer.key("Escape")
        viewer.until(lambda s: not s["sheet"], "no sheet")
        viewer.key("alt+c", "super+c")
        viewer.key("F11")
        viewer.rest(lambda s: s["fullscreen"] and s["width"] == 1400, "all of the screen")
        other = self.screen.display.screen().root.create_window(0, 0, 50, 50, 0, self.screen.display.screen().root_depth)
        other.map()
        self.screen.display.sync()
        wait_for(lambda: other.get_attributes().map_state == X.IsViewable, 20, "the other window")
        self.screen.call("xdotool", "windowfocus", "--sync", other.id)
        time.sleep(0.5)
        window = self.screen.display.create_resource_object("window", viewer.id)
        self.assertEqual(window.get_attributes().map_state, X.IsViewable, "without the keyboard it went away")
        other.destroy()
        self.screen.display.sync()
        viewer.xdotool("windowactivate", "--sync", viewer.id)
        viewer.key("Escape")
        self.assertFalse(viewer.rest(lambda s: not s["fullscreen"] and s["width"] == 500, "a window again")["split"])
        self.ends_well(viewer, viewer.close())


if __name__ == "__main__":
    main()

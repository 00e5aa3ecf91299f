#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Tests of the command line's messages: about invalid values, unknown words, and options that change nothing."""
import json
import os
import re
import shutil
import struct
import subprocess
import sys
from pathlib import Path

from support import FRAGTRACE, SCENES, SMALL, Case, main, png, quad, run

sys.path.insert(0, str(SCENES.parent / "scripts"))
from option_table import Table  # noqa: E402

BOX = SCENES / "cornell-box.gltf"
TINY = ["--resolution", "8,8", "--spp", "1"]


class Values(Case):
    """Every option that takes a number, of every command, says the same of what is none."""

    COMMANDS = (["render", BOX, "-o", "x.png"], ["view", BOX], ["diff", BOX, BOX], ["denoise", "x.exr", "-o", "y.exr"], ["bench", "frame", BOX],
                ["bench", "error", BOX], ["bench", "start", BOX], ["bench", "motion", BOX], ["bench", "frame", BOX])

    def test_what_is_no_number_is_said_so_by_name(self):
        tried, table = set(), Table(FRAGTRACE)
        for words in self.COMMANDS:
            names = [word for word in words if isinstance(word, str) and not word.startswith("-") and "." not in word]
            for one in table.of(" ".join(names)):
                option = f"--{one['name']}"
                if one["type"] not in ("number", "integer") or (option, names[0]) in tried:
                    continue
                tried.add((option, names[0]))
                for value in ("10s", "5%") if names[0] == "render" else ("10s",):
                    said = self.fails(2, *words, f"{option}={value}", cwd=self.folder).stderr
                    self.assertRegex(said, rf"^fragtrace: {option}: '{value}' is no (whole )?number", f"{words} {said}")
        self.assertGreater(len(tried), 60)

    def test_a_number_that_is_too_large_is_told_the_range_in_few_digits(self):
        for option, value, bounds in (("--focus-distance", "1e40", "1e-09 to 1e+30"), ("--hdri-rotation", "1e39", "-1e+06 to 1e+06"),
                                      ("--exposure", "1e39", "-100 to 100"), ("--noise", "5", "1e-05 to 1")):
            self.fails(2, "render", BOX, "-o", self.folder / "x.png", option, value, says=[f"{option}: '{value}' is not in the range {bounds}"])
        self.fails(2, "render", BOX, "-o", self.folder / "x.png", "--background-color", "1e30,1,1", says=["--background-color: a colour is in the range 0 to 1000000"])

    def test_elements_of_lists_are_named_one_by_one(self):
        for option, value, said in (("--camera-position", "a,b,c", "'a' is no number"), ("--camera-orbit", "1,x", "'x' is no number"),
                                    ("--camera-orbit", "1", "takes 2 or 3 values, not 1"), ("--camera-orbit", "1,2,3,4", "takes 2 or 3 values, not 4")):
            self.fails(2, "render", BOX, "-o", self.folder / "x.png", option, value, says=[f"{option}: {said}"])

    def test_an_empty_value_is_none(self):
        for words in (["--exposure", ""], ["--exposure=", "--quiet"], ["--hdri-file", ""], ["--camera="]):
            option = words[0].rstrip("=")
            self.fails(2, "render", BOX, "-o", self.folder / "x.png", *words, says=[f"{option}: its value is empty"])
        self.fails(2, "render", "", "-o", self.folder / "x.png", says=["an argument is empty"])

    def test_a_name_that_is_none_is_told_those_that_are(self):
        for option, names in (("--png-depth", "8, 16"), ("--missing-textures", "refuse, magenta"), ("--tone-map", "linear, ")):
            self.fails(2, "render", BOX, "-o", self.folder / "x.png", option, "foo", says=[f"{option}: 'foo' is none of {names}"])
        self.fails(2, "bench", "start", BOX, "--format", "gif", says=["--format: 'gif' is none of png, jpg"])

    def test_a_lens_that_cannot_be_is_named_by_its_option(self):
        for option, value in (("--camera-view-angle", "400"), ("--camera-parallel-scale", "-1")):
            self.fails(2, "render", BOX, "-o", self.folder / "x.png", option, value, says=[f"{option}: is not "])
        self.fails(2, "render", BOX, "-o", self.folder / "x.png", "--camera-position", "1e20,0,0", says=["--camera-position: the camera is too far"])

    def test_a_switch_takes_no_value(self):
        for switch in ("--fit=yes", "--half=0", "--quiet=maybe"):
            self.fails(2, "render", BOX, "-o", self.folder / "x.png", switch, says=[f"{switch.split('=')[0]}: takes no value"])

    def test_two_that_contradict_each_other_are_refused(self):
        self.fails(2, "render", BOX, "-o", self.folder / "x.png", "--default-light", "studio", "--no-default-light",
                   says=["--default-light: does not go with --no-default-light"])


    def test_a_size_is_told_how_it_is_written(self):
        self.fails(2, "render", BOX, "-o", self.folder / "x.png", "--resolution", "64:32", says=["'64:32' is no whole number", "WIDTHxHEIGHT"])

    def test_names_are_found_without_regard_to_case(self):
        self.renders(BOX, "-o", self.folder / "x.png", *TINY, "--stage", "PHONG", "--tone-map", "AgX")

    def test_a_number_that_is_set_is_told_its_place(self):
        for value in ("0.5,", "0x1", "1,,1", "1e999"):
            self.fails(2, "render", BOX, "-o", self.folder / "x.png", "--set", f"/materials/0/emissiveFactor={value}",
                       says=["--set: /materials/0/emissiveFactor: '", "' is no number"])
        for place, said in (("/materials/lamp/alphaCutoff", "; did you mean /materials/3/alphaCutoff?"),
                            ("/materials/candle/alphaCutoff", '/materials has 0 "white", 1 "red", 2 "green", 3 "lamp"\n'),
                            ("/materials/grren/alphaCutoff", "; did you mean /materials/2/alphaCutoff?"),
                            ("/materials/99/alphaCutoff", '/materials has 0 "white", 1 "red", 2 "green", 3 "lamp"\n'),
                            ("/material/0/alphaCutoff", "; did you mean /materials/0/alphaCutoff?"),
                            ("/materials/0/pbrMetallicRoughness/roughnesFactor", "; did you mean /materials/0/pbrMetallicRoughness/roughnessFactor?"),
                            ("/materials/0/extensions/KHR_materials_sheen/sheenRoughnessFactor", ": /materials/0/extensions has no KHR_materials_sheen\n"),
                            ("/materials/red/pbrmetallicroughness/ROUGHNESSFACTOR", "; did you mean /materials/1/pbrMetallicRoughness/roughnessFactor?"),
                            ("/materials/0/pbrMetallicRoughness/roughness", "; did you mean /materials/0/pbrMetallicRoughness/roughnessFactor?"),
                            ("/materials/0/roughnessFactor", "; did you mean /materials/0/pbrMetallicRoughness/roughnessFactor?"),
                            ("/materials/0/pbrMetallicRoughness/baseColorFactor/0", "; set all of /materials/0/pbrMetallicRoughness/baseColorFactor together, such as /materials/0/pbrMetallicRoughness/baseColorFactor=1,1,1,1"),
                            ("/materials/red/pbrMetallicRoughness/baseColorFactor/0", "; set all of /materials/1/pbrMetallicRoughness/baseColorFactor together, such as "),
                            ("/materials/0/baseColorFactor/0", "; set all of /materials/0/pbrMetallicRoughness/baseColorFactor together, such as "),
                            ("/materials/0/emissiveFactor/r", "; set all of /materials/0/emissiveFactor together, such as /materials/0/emissiveFactor=1,1,1"),
                            ("/materials/0/ior", ": the file has no /materials/0/extensions/KHR_materials_ior/ior\n"),
                            ("/materials/0/extensions/KHR_materials_shen/sheenRoughnessFactor", "of the file that is read\n"),
                            ("/materials/0/name", "of the file that is read\n")):
            self.fails(2, "render", BOX, "-o", self.folder / "x.png", "--set", f"{place}=1", says=[f"--set: {place} is no number of the file that is read", said])
        for text, said in (("#/materials/0/emissiveFactor=1,1,1", "did you mean /materials/0/emissiveFactor=1,1,1?"),
                           ("materials/0/alphaCutoff=1", "did you mean /materials/0/alphaCutoff=1?"), ("/materials/0/emissiveFactor=0,", "a list with spaces stands in quotes"),
                           ("/cameras/0/perspective/yfov=9", "fragtrace: --set: /cameras/0/perspective/yfov: is not between 0 and pi")):
            self.fails(2, "render", BOX, "-o", self.folder / "x.png", "--set", text, says=[said])
        lamps = self.folder / "lamps.gltf"
        root = json.loads((SCENES / "lights.gltf").read_text())
        root["materials"].append({"name": "spare"})
        root["extensions"]["KHR_lights_punctual"]["lights"].append({"type": "point"})
        spare = f"/materials/{len(root['materials']) - 1}/alphaCutoff"
        light, lamp = "/extensions/KHR_lights_punctual/lights/0", f"/extensions/KHR_lights_punctual/lights/{len(root['extensions']['KHR_lights_punctual']['lights']) - 1}"
        lamps.write_text(json.dumps(root))
        self.fails(2, "render", lamps, "-o", self.folder / "x.png", "--set", f"{light}/intensity=-1", says=[f"fragtrace: --set: {light}: colour times intensity is negative"])
        self.fails(2, "render", lamps, "-o", self.folder / "x.png", "--set", "/lights/0/intensity=1", says=[f"did you mean {light}/intensity?"])
        said = self.renders(lamps, "-o", self.folder / "x.png", *TINY, "--set", "/materials/0/emissiveFactor=0, 5, 0", "--set", f"{light}/color=2, 1,1",
                            "--set", f"{spare}=1", "--set", f"{lamp}/intensity=2").stderr
        for warning in ("/materials/0/emissiveFactor: is above 1, and drawn so", f"{light}/color: is above 1, and drawn so, but glTF has the light's intensity",
                        f"--set: {spare}: nothing that is drawn has this material", f"--set: {lamp}/intensity: no node that is shown has this light"):
            self.assertIn(warning, said)
        self.assertEqual(said.count("warning"), 4, said)

    def test_fog_s_options_are_named_that_miss_its_density(self):
        for option, value in (("--fog-height", "2"), ("--fog-color", "1,1,1"), ("--fog-anisotropy", "0.1"), ("--fog-distance", "3")):
            self.fails(2, "render", BOX, "-o", self.folder / "x.png", option, value, says=[f"fragtrace: {option}: goes with --fog-density\n"])
        self.fails(2, "render", BOX, "-o", self.folder / "x.png", "--fog-density", "1", "--shadow-catcher", "0", says=["cannot be combined with --shadow-catcher"])


class UnknownWords(Case):
    def test_help_and_version_have_the_names_that_people_try(self):
        for words in (["--verison"], ["-v"], ["-V"]):
            self.fails(2, *words, says=["did you mean --version?"])
        for words, own in ((["help"], ["--help"]), (["help", "render"], ["render", "--help"]), (["help", "bench", "frame"], ["bench", "frame", "--help"])):
            self.assertEqual(run(*words).stdout, run(*own).stdout)
            self.assertEqual(run(*words).returncode, 0)
        version = run("--version").stdout
        self.assertEqual(run("bench", "--version").stdout, version)
        self.assertEqual(subprocess.run([f"{FRAGTRACE}-bench", "--version"], capture_output=True, text=True).stdout, version)

    def test_a_command_is_suggested(self):
        self.fails(2, "rendr", BOX, says=["did you mean render?"])
        self.fails(2, BOX, "-o", self.folder / "a.png", says=["-o is no option of view; did you mean the command render?"])
        self.fails(2, "render", BOX, "-v", says=["did you mean --verbose?"])
        self.fails(2, "render", BOX, "--transparent", says=["did you mean --no-background?"])
        self.fails(2, "render", BOX, "--background", "white", says=["did you mean --background-color?"])
        self.fails(2, "render", BOX, "-o", self.folder / "x.png", "--background-color", "weiss", says=["'weiss' is no name of a colour"])
        (self.folder / "-file.glb").touch()
        for words in (["-file.glb"], ["render", "-file.glb", "-o", "x.png"]):
            self.fails(2, *words, cwd=self.folder, says=["-file.glb is no option of", "; a file of that name is ./-file.glb"])
        shutil.copy(BOX, self.folder / "-file.glb")
        self.renders("-o", "x.png", *TINY, "--", "-file.glb", cwd=self.folder)
        self.fails(2, "render", "--", "-file.glb", "-o", "x.png", cwd=self.folder, says=["'-o' is an argument too many: words after -- are files"])
        self.fails(2, "render", "-o", "x.png", "--", says=["file is required"])
        self.fails(2, "render", "-o", "x.png", "--", "", says=["an argument is empty"])
        self.fails(2, "--", "a.glb", "b.png", says=["'b.png' is an argument too many"])
        self.assertIn("`fragtrace FILE` is short for `fragtrace view", run("--help").stdout)

    def test_no_equals_sign_follows_a_letter(self):
        self.fails(2, "render", BOX, f"-o={self.folder / 'x.png'}", says=["-o: no = goes between it and its value"])

    def test_a_setting_of_a_benchmark_is_told_as_the_command_is(self):
        for setting, said in (("x=--nope", "--nope is no option of render"), ("x=--samples 2", "did you mean --spp?"), ("x='--spp 2", "has no end"),
                              ("x=--spp foo", "--spp: 'foo' is no whole number")):
            self.fails(2, "bench", "frame", BOX, "--config", setting, says=["configuration 'x': ", said])
        for option in (["--exposure", "1"], ["--tree-level", "1"], ["--verbose"], ["--tone-map", "agx"]):
            self.fails(2, "bench", "frame", BOX, *option, says=[f"{option[0]}: "])


class ConfigFaults(Case):
    def test_what_is_wrong_with_an_option_of_the_file_is_the_file_s(self):
        config = self.folder / "c.json"
        for name, value in (("half", True), ("region", "0,0,99,99"), ("camera", "none"), ("frames", "0:3"), ("exposure", ""), ("seed", "x"),
                            ("camera-position", "1e20,0,0"), ("png-depth", 16), ("continue", True)):
            config.write_text(json.dumps({name: value}))
            self.fails(3, "render", BOX, "-o", self.folder / "x.jpg", *SMALL, "--config", config, says=[f"{config}: /{name}"])


    def test_a_name_that_is_none_is_told_the_one_that_was_meant(self):
        config = self.folder / "c.json"
        for name, says in (("resolutoin", "did you mean resolution?"), ("camera_orbit", "did you mean camera-orbit?"), ("--fit", "did you mean fit?"),
                           ("fov", "did you mean camera-view-angle?"), ("nothing-like-it", "is no option of render\n")):
            config.write_text(json.dumps({name: 1}))
            self.fails(3, "render", BOX, "-o", self.folder / "x.png", "--config", config, says=[says])


class InVain(Case):
    """Options that change nothing are reported, once, and the picture is drawn."""

    def warned(self, says, *options, name="x.png", scene=BOX, json_too=False):
        stats = self.folder / "s.json"
        result = run("render", scene, "-o", self.folder / name, *TINY[:2], *([] if "--spp" in options else TINY[2:]), *options, "--stats", stats)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stderr.count(f"warning: {says}"), 1, (options, result.stderr))
        if json_too:
            self.assertIn(says, " ".join(json.loads(stats.read_text())["warnings"]))

    def test_options_that_miss_another(self):
        for options in (["--fps", "30"], ["--background-blur", "3"], ["--hdri-rotation", "30", "--default-light", "white"],
                        ["--background-color", "1,1,1", "--no-background"], ["--background-color", "255,0,0"],
                        ["--hdri-rotation", "30"], ["--hdri-intensity", "3"], ["--fog-density", "0.1", "--stage", "phong"], ["--fog-density", "20"]):
            self.warned(options[0] + ": ", *options, json_too=True)

    def test_options_that_the_file_s_format_has_no_use_for(self):
        for name, options in (("x.jpg", ["--no-background"]), ("x.pfm", ["--no-background"]), ("x.exr", ["--exposure", "1"]),
                              ("x.hdr", ["--tone-map", "agx"]), ("x##.png", [])):
            self.warned((options or ["--output"])[0] + ": ", *options, name=name)

    def test_nothing_is_said_of_those_that_do(self):
        for name, options in (("x.png", ["--exposure", "1", "--tone-map", "agx", "--no-background"]), ("x.exr", ["--no-background"]),
                              ("x.png", ["--studio", "--hdri-rotation", "30"]), ("x.png", ["--background-color", "1,0.5,0"]),
                              ("x.png", ["--fog-density", "0.5"])):
            self.assertNotIn("warning", self.renders(BOX, "-o", self.folder / name, *TINY, *options).stderr, options)

    def test_a_catcher_far_away(self):
        self.warned("--shadow-catcher: the plane is ", "--shadow-catcher", "-1000")
        result = self.renders(BOX, "-o", self.folder / "x.png", *TINY, "--shadow-catcher", "-1")
        self.assertNotIn("the plane is", result.stderr)

    def test_emissive_textures_alone(self):
        """With dim ones, which the studio joins, the messages of the catcher and of light paths do not mention lamps."""
        root = quad({"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0}, "pbrMetallicRoughness": {"roughnessFactor": 0}}, images=[png(1, 1, bytes([255] * 4))])
        scene = self.folder / "screen.gltf"
        for factor, says in ((1, []), (1e-3, ["the scene's emission leaves 100 % of what is seen dark"])):
            root["materials"][0]["emissiveFactor"] = 3 * [factor]
            scene.write_text(json.dumps(root))
            for options in ([], ["--shadow-catcher", "bottom"]):
                said = self.renders(scene, "-o", self.folder / "x.png", *TINY, *options).stderr
                self.assertEqual([line for line in says if line not in said], [], said)
                self.assertEqual("whose shadows --shadow-catcher does not show" in said, factor == 1 and options != [], said)
                self.assertNotIn("no light paths", said)
            for options in (["--studio"], ["--shop"]):
                said = self.renders(scene, "-o", self.folder / "x.png", *TINY, *options, "--shadow-catcher", "bottom").stderr
                self.assertNotIn("only emissive surfaces", said, options)
            self.assertNotIn("emission leaves", self.renders(scene, "-o", self.folder / "x.png", *TINY, "--studio").stderr)

    def test_a_scene_of_which_all_is_hidden(self):
        nodes = json.loads(run("info", "--nodes", "--json", BOX).stdout)["nodes"]
        hide = [word for node in nodes for word in ("--hide", node["index"])]
        self.warned(f"{BOX}: no triangle, sphere, point or line: --hide leaves nothing", *hide)
        self.assertIn(f"warning: {BOX}: no triangle, sphere, point or line: --hide leaves nothing", run("info", BOX, *hide).stderr)

    def test_a_view_of_nothing(self):
        self.warned("this view shows nothing of the scene", "--camera-position", "0,0,5", "--camera-focal-point", "0,0,10")

    def test_a_camera_in_a_closed_shell(self):
        root = json.loads((SCENES / "furnace.gltf").read_text())
        for material in root["materials"]:
            material["doubleSided"] = True
        scene = self.written("shell.gltf", root)
        inside = ["--camera-position", "0,0,0.1", "--camera-focal-point", "0,0,1", "--spp", "16"]
        self.warned("100 % of the pixels are black: the camera stands inside the scene, in a closed shell", *inside, scene=scene)

    def test_light_below_zero_is_taken_as_none(self):
        path = self.folder / "map.pfm"
        pictures = []
        for value in (-1, 0):
            path.write_bytes(b"PF\n4 2\n-1.0\n" + struct.pack("<3f", value, 1, 1) * 8)
            result = self.renders(SCENES / "environment-diffuse.gltf", "-o", self.folder / "x.pfm", *TINY, "--hdri-file", path)
            self.assertEqual("map.pfm: 8 values below 0" in result.stderr, value < 0, result.stderr)
            pictures.append((self.folder / "x.pfm").read_bytes())
        self.assertEqual(*pictures)


class Ends(Case):
    def test_one_is_one(self):
        result = self.renders(BOX, "-o", self.folder / "x.exr", *TINY)
        self.assertIn(", 1 sample per pixel ", result.stdout)
        self.assertIn(": 1 part, 1 sample per pixel\n", run("merge", self.folder / "x.exr", "-o", self.folder / "m.exr").stdout)
        self.assertRegex(run("bench", "start", BOX, *TINY, "--starts", "1").stdout, ", 1 cold start[,\n]")
        self.assertIn("36 triangles, 0 spheres, ", run("bench", "traversal", BOX, "--resolution", "8,8", "--rounds", "1").stdout)

    def test_a_reader_that_leaves_is_no_error(self):
        for words in (["--help"], ["render", "--help"], ["info", "--json", BOX]):
            result = subprocess.run(["bash", "-c", 'exec 3>&1; { "$@"; echo $? >&3; } | true', "-", FRAGTRACE, *words], capture_output=True, text=True)
            self.assertEqual(result.stderr, "")
            self.assertIn(result.stdout.strip(), ("0", "1"))  # 0: all was written before

    def test_a_missing_folder_for_temporary_files_is_named(self):
        result = self.fails(1, "bench", "start", BOX, env={**os.environ, "TMPDIR": "/none"})
        self.assertIn("TMPDIR", result.stderr)

    def test_a_window_that_cannot_be_opened(self):
        environment = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
        self.fails(4, "view", BOX, says=["X11: there is no display (DISPLAY is not set)"], env=environment)

    def test_a_library_of_windows_of_another_build(self):
        version = run("--version").stdout.split(" ", 1)[1].strip().encode()
        library = Path(FRAGTRACE).parent / "libfragtrace_window.so"
        data = library.read_bytes()
        self.assertEqual(data.count(version + b"\0"), 1)
        (self.folder / library.name).write_bytes(data.replace(version + b"\0", b"9" + version[1:] + b"\0"))
        self.fails(4, "view", BOX, says=["libfragtrace_window.so is of another build"], env={**os.environ, "FRAGTRACE_LIBRARY_PATH": str(self.folder)})

    def test_a_library_of_windows_that_is_not_there(self):
        program = self.folder / "fragtrace"
        program.write_bytes(Path(FRAGTRACE).read_bytes())
        program.chmod(0o755)
        environment = {name: value for name, value in os.environ.items() if name != "FRAGTRACE_LIBRARY_PATH"}
        result = subprocess.run([program, "view", BOX], capture_output=True, text=True, env=environment)
        self.assertEqual(result.returncode, 4)
        self.assertTrue(re.search("libfragtrace_window.so.*the package fragtrace holds it", result.stderr), result.stderr)


if __name__ == "__main__":
    main()

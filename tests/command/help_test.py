#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What --help shows, in text and as JSON, and words that people of other programs try first."""
import json

from support import SCENES, SMALL, Case, main, run, shown

BOX = SCENES / "cornell-box.gltf"
TINY = SMALL[:-1]  # not quiet
MEMBERS = ["name", "forms", "metavariable", "type", "choices", "other_values", "default", "range", "units", "group", "everyday", "values", "separator",
           "repeatable", "required", "excludes", "extensions", "text", "commands"]


class Help(Case):
    def test_topics_stand_in_the_order_of_thought(self):
        text = run("render", "--help").stdout
        topics = [line[:-1] for line in text.splitlines() if line and line[0].isupper() and line.endswith(":")]
        self.assertEqual(topics, ["Arguments", "Options", "Scene", "Camera", "Light", "Look", "Quality", "Output", "Device"])
        self.assertNotIn("FLOAT", text)
        self.assertNotIn(" in [", text)

    def test_all_shows_the_rest(self):
        everyday, everything = run("render", "--help").stdout, run("render", "--help", "all").stdout
        self.assertEqual(run("help", "render", "all").stdout, everything)
        self.assertIn("`fragtrace render --help all` shows ", everyday)
        self.assertNotIn("--help all`", everything)
        named = [option["name"] for option in json.loads(run("help", "render", "--json").stdout)["options"] if option["forms"]]
        self.assertTrue(all(f"--{name}" in everything for name in named))
        self.assertNotIn("\n  --light-reuse", everyday)
        self.assertIn("\n  --light-reuse", everything)

    def test_lines_are_as_wide_as_the_terminal(self):
        for columns in (60, 132):
            lines = [line for line in shown("render", "--help", columns=columns).splitlines() if len(line.split()) > 1]
            longest = max(map(len, lines))
            self.assertTrue(columns - 12 < longest <= columns, longest)
        self.assertTrue(all(len(line) <= 80 for line in run("render", "--help").stdout.splitlines() if len(line.split()) > 1))

    def test_json_has_each_member_of_each_option(self):
        table = json.loads(run("help", "--json").stdout)
        self.assertEqual(table["schema"], 1)
        for option in table["options"]:
            self.assertEqual(list(option), MEMBERS, option["name"])
        named = {option["name"]: option for option in table["options"] if "render" in option["commands"]}
        self.assertEqual(named["exposure"]["range"], [-100, 100])
        self.assertEqual((named["exposure"]["units"], named["exposure"]["group"]), ("stops", "Look"))
        self.assertEqual((named["spp"]["type"], named["spp"]["range"]), ("integer", [1, 1 << 29]))
        self.assertEqual((named["output"]["forms"], named["output"]["metavariable"]), (["-o", "--output"], "FILE"))
        self.assertEqual(named["camera-orbit"]["values"], [2, 3])
        self.assertTrue(named["hide"]["repeatable"] and not named["spp"]["repeatable"])
        self.assertEqual(run("--help", "--json").stdout, run("help", "--json").stdout)
        self.assertIn("bench start", [command["name"] for command in json.loads(run("help", "bench", "--json").stdout)["commands"]])
        self.fails(2, "help", "rendr", "--json", says=["did you mean render?"])


class Habits(Case):
    def test_the_last_of_an_option_counts(self):
        pictures = []
        for name, words in (("once.pfm", ["--seed", "7", "--camera-orbit", "30,20"]),
                            ("twice.pfm", ["--seed=3", "--camera-orbit", "10,5,2", "--fit", "--seed", "7", "--camera-orbit", "30,20", "--fit"])):
            said = self.renders(BOX, "-o", "no.png", "-o", self.folder / name, *TINY, "--resolution", "64", "32", "--fit", "--verbose", *words).stderr
            self.assertIn("fragtrace: -o no.png is left out: --output is given again, and the last one counts\n", said)
            pictures.append((self.folder / name).read_bytes())
        self.assertIn("--camera-orbit 10,5,2 is left out", said)
        self.assertEqual(*pictures)
        self.assertNotIn("left out", self.renders(BOX, "-o", self.folder / "x.png", *TINY, "--seed", "1", "--seed", "2").stderr)

    def test_lists_add_up(self):
        self.renders(BOX, "-o", self.folder / "x.exr", *SMALL, "--aov", "depth", "--aov", "normal", "--stats", self.folder / "s.json")
        self.fails(2, "render", BOX, "-o", self.folder / "x.png", "--hide", "0", "--hide", "nobody", says=["nobody"])

    def test_the_camera_of_verbose_may_follow_a_size(self):
        said = self.renders(BOX, "-o", self.folder / "x.png", *TINY, "--fit", "--verbose").stderr
        line = said.split("the camera stands at ")[1].split("\n")[0]
        self.assertNotIn("--resolution", line)
        self.renders(BOX, "-o", self.folder / "x.png", *SMALL, *line.split(), "--resolution", "8x8")

    def test_hints_are_accepted(self):
        """The words of a hint, with a value where they name its form, are taken at the next try."""
        for words, meant in ((["--width", "64"], "--resolution WIDTHxHEIGHT"), (["--size", "64"], "--resolution WIDTHxHEIGHT"), (["--samples", "1"], "--spp"),
                             (["--max-depth", "2"], "--bounces"), (["--fov", "40"], "--camera-view-angle"), (["--background", "white"], "--background-color"),
                             (["--integrator", "path"], "--stage gi"), (["--transparent"], "--no-background"), (["--up-axis", "z"], "--up"),
                             (["--camera-pos", "0,1,3"], "--camera-position"), (["--tonemap", "agx"], "--tone-map"),
                             (["--env", SCENES / "sky.pfm"], "--hdri-file")):
            self.fails(2, "render", BOX, "-o", self.folder / "x.png", *words, says=[f"did you mean {meant}?"])
            option, *form = meant.split()
            value = {"WIDTHxHEIGHT": ["8x8"], "gi": ["gi"]}[form[0]] if form else words[1:]
            self.renders(BOX, "-o", self.folder / "x.png", *SMALL, option, *value)

    def test_hints_name_what_words_need(self):
        picture = self.folder / "x.png"
        for words, says in ((["render", BOX, picture], f"'{picture}' is an argument too many; did you mean -o {picture}?"),
                            (["-o", picture, BOX], "-o is no option of fragtrace; did you mean the command render?"),
                            (["--json", "info", BOX], "--json stands before the command; options of info stand behind it"),
                            (["render", BOX, "-o", picture, "--frame", "3"], "did you mean --frames A:B?"), (["render", BOX, "--help-all"], "did you mean --help all?"),
                            (["render", BOX, "-o", picture, "--set", "roughness=1"], "MATERIAL:NAME=VALUES, such as oak:roughness=0.25")):
            self.fails(2, *words, says=[says])

    def test_files_of_other_programs_are_told_who_opens_them(self):
        for name, content, kind in (("a.obj", b"v 0 0 0\n", "Wavefront OBJ"), ("a.STL", b"\0" * 84, "STL"), ("a.ply", b"ply\nformat", "PLY"),
                                    ("a.usdz", b"PK\x03\x04", "USD"), ("a.usda", b"#usda 1.0", "USD"), ("b", b"PXR-USDC", "USD"), ("c", b"BLENDER-v3", "a file of Blender"),
                                    ("a.blend", b"\x28\xb5\x2f\xfd", "a file of Blender"), ("a.dae", b"<?xml?>", "COLLADA"), ("a.fbx", b"; FBX 7", "FBX"),
                                    ("d", b"Kaydara FBX", "FBX"), ("a.abc", b"Ogawa", "Alembic")):
            (self.folder / name).write_bytes(content)
            self.fails(3, "render", self.folder / name, "-o", self.folder / "x.png", says=[f"is {kind}, not glTF; Blender opens it and writes a .glb"])
        (self.folder / "a.step").write_bytes(b"ISO-10303-21;")
        self.fails(3, "render", self.folder / "a.step", "-o", self.folder / "x.png", says=["is STEP, not glTF; FreeCAD opens it"])
        (self.folder / "a.zip").write_bytes(b"PK\x03\x04")
        self.fails(3, "render", self.folder / "a.zip", "-o", self.folder / "x.png", says=["is a ZIP archive"])


if __name__ == "__main__":
    main()

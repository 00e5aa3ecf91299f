#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Options from a file, and the options that say from where a scene is seen."""
import json
import math

from support import SCENES, SMALL, Case, Gltf, main, png, quad, read_pfm, run, shown

ROOM = SCENES / "cornell-box.gltf"


class Config(Case):
    def file(self, content):
        path = self.folder / "view.json"
        path.write_text(content if isinstance(content, str) else json.dumps(content))
        return path

    def bytes_of(self, *options, config=None):
        path = self.folder / "picture.pfm"
        more = [] if config is None else ["--config", self.file(config)]
        self.renders(ROOM, "-o", path, "--quiet", *options, *more)
        return path.read_bytes()

    def refused(self, content, *says, status=3, options=()):
        self.fails(status, "render", ROOM, "-o", self.folder / "x.pfm", "--config", self.file(content), *options, says=says)

    def test_every_kind_of_option_is_as_on_the_command_line(self):
        config = {"resolution": [16, 12], "spp": 2, "stage": "phong", "enable": ["schlick", "gi"], "disable": "shadows",
                  "camera-position": "-.5,0.25,3", "camera-view-angle": 0.1 + 0.2 + 30, "bounces": "unlimited", "seed": 7,
                  "up": [0, -1, 0.25], "background-color": [0, 0.5, 1.0], "no-background": True, "no-default-light": False}
        options = ["--resolution", "16,12", "--spp", 2, "--stage", "phong", "--enable", "schlick,gi", "--disable", "shadows",
                   "--camera-position", "-.5,0.25,3", "--camera-view-angle", 0.1 + 0.2 + 30, "--bounces", "unlimited",
                   "--seed", 7, "--up", "0,-1, 0.25", "--background-color", "0,0.5, 1", "--no-background"]
        self.assertEqual(self.bytes_of(config=config), self.bytes_of(*options))
        self.assertNotEqual(self.bytes_of(config={**config, "seed": 8}), self.bytes_of(*options))

    def test_the_command_line_wins_also_by_what_it_excludes(self):
        config = {"resolution": [16, 16], "spp": 3, "camera-view-angle": 20, "seed": 5}
        with_file = self.bytes_of("--spp", 2, "--camera-parallel-scale", 1, config=config)
        self.assertEqual(with_file, self.bytes_of("--resolution", "16,16", "--spp", 2, "--camera-parallel-scale", 1, "--seed", 5))

    def test_the_output_may_stand_in_the_file(self):
        output = self.folder / "named.pfm"
        self.renders(ROOM, *SMALL, "--config", self.file({"output": str(output)}))
        self.assertEqual(len(read_pfm(output)), 16)
        self.assertEqual(run("render", ROOM, *SMALL).returncode, 2)

    def test_what_is_wrong_is_named_with_its_place(self):
        self.refused('{\n "spp": 2,\n "seed" 3}', "view.json", "line 3")
        self.refused("", "view.json", "line 1")
        self.refused('[{"spp": 2}]', "view.json", "no JSON object")
        self.refused('{"seed": 1e400}', "view.json", "1e400")
        self.refused('{"spp": 2, "spp": 3}', "view.json: /spp", "twice")
        for name in ("warp", "file", "config", "help", "--spp", "o", "", "a/b"):
            self.refused({name: 1}, "view.json: /" + name.replace("/", "~1"), "no option of render")
        self.refused({"spp": 0}, "view.json: /spp")
        self.refused({"spp": "many"}, "view.json: /spp")
        self.refused({"spp": [1, 2]}, "view.json: /spp")
        self.refused({"spp": {"of": 1}}, "view.json: /spp", "neither a number nor a string")
        self.refused({"spp": None}, "view.json: /spp")
        self.refused({"enable": []}, "view.json: /enable", "empty")
        self.refused({"camera-position": [1, 2]}, "view.json: /camera-position")
        self.refused({"camera-position": [1, [2], 3]}, "view.json: /camera-position/1")
        self.refused({"no-background": 1}, "view.json: /no-background", "neither true nor false")
        self.refused({"stage": "fast"}, "view.json: /stage", "fast")
        self.refused({"camera-view-up": [0, 0, 0]}, "view.json: /camera-view-up", "zero")
        self.refused({"camera-view-angle": 30, "camera-parallel-scale": 2}, "view.json: /camera-parallel-scale", "does not go with")
        # An option of the command line is not blamed on the file.
        self.refused({"spp": 2}, "--stage", status=2, options=["--stage", "fast"])
        self.fails(3, "render", ROOM, "-o", self.folder / "x.pfm", "--config", self.folder / "none.json", says=["none.json"])


class CameraOptions(Case):
    def picture_of(self, *options):
        path = self.folder / "picture.pfm"
        self.renders(ROOM, "-o", path, "--quiet", "--resolution", "16,16", "--spp", 2, *options)
        return path.read_bytes()

    def test_a_parallel_scale_is_half_of_what_an_orthographic_view_shows(self):
        """The back wall of the Cornell box from y = -0.987 to 0.987 and from x = -1 to 1, seen through its open front."""
        path = self.folder / "wall.pfm"
        view = ["--camera-focal-point", "0,0,0", "--stage", "flat", "--resolution", "32,32", "--spp", 4, "--quiet"]
        for scale in (2, 4):
            self.renders(ROOM, "-o", path, "--camera-position", "0,0,5", "--camera-parallel-scale", scale, *view)
            picture = read_pfm(path)
            lit = [sum(pixel) > 0 for pixel in picture[15]]
            # A picture is 2 x scale high: a metre is 16 / scale pixels.
            self.assertEqual(lit, [abs(x + 0.5 - 16) < 16 / scale for x in range(32)])
            near = path.read_bytes()
            self.renders(ROOM, "-o", path, "--camera-position", "0,0,6", "--camera-parallel-scale", scale, *view)
            self.assertEqual(near, path.read_bytes())  # from anywhere the same

    def test_a_parallel_scale_is_above_zero_and_alone(self):
        for scale in ("0", "-1", "nan", "inf"):
            self.fails(2, "render", ROOM, "-o", self.folder / "x.pfm", "--camera-parallel-scale", scale, says=["parallel"])
        both = ["--camera-parallel-scale", 1, "--camera-view-angle", 30]
        self.fails(2, "render", ROOM, "-o", self.folder / "x.pfm", *both, says=["--camera-view-angle"])

    def test_an_origin_makes_a_view_named_by_its_camera_the_same_to_the_bit(self):
        """The scene's own camera, and the same one spelled out with a focal point, about which positions are rounded otherwise."""
        angle = math.degrees(0.686047881)
        spelled = ["--camera-position", "0,0,3.8834532374100714", "--camera-focal-point", "0,0,0.123456789", "--camera-view-up", "0,1,0",
                   "--camera-view-angle", f"{angle:.17g}"]
        centre = json.loads(run("info", ROOM, "--json").stdout)["scene"]["origin"]
        origin = ["--scene-origin", ",".join(f"{x:.17g}" for x in centre)]
        self.assertEqual(self.picture_of(*spelled, *origin), self.picture_of())
        self.assertNotEqual(self.picture_of(*spelled), self.picture_of())


class Switches(Case):
    def drawn(self, config, *options):
        path, file = self.folder / "picture.pfm", self.folder / "c.json"
        file.write_text(json.dumps(config))
        self.renders(ROOM, "-o", path, "--quiet", "--resolution", "16,16", "--spp", "2", "--config", file, *options)
        return path.read_bytes()

    def test_those_of_the_command_line_count_more_one_by_one(self):
        plain = self.drawn({})
        self.assertNotEqual(self.drawn({"disable": "sobol"}), plain)
        self.assertEqual(self.drawn({"disable": "sobol"}, "--enable", "sobol"), plain)
        self.assertEqual(self.drawn({"enable": ["sobol"]}, "--disable", "sobol"), self.drawn({"disable": "sobol"}))
        both = self.drawn({}, "--disable", "sobol,light-sampling")
        self.assertEqual(self.drawn({"disable": "light-sampling"}, "--disable", "sobol"), both)
        self.assertEqual(self.drawn({"disable": ["light-sampling", "sobol"]}), both)


# What --help shows, in text and as JSON, and words that people of other programs try first.
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
                             (["--max-depth", "2"], "--bounces"), (["--fov", "40"], "--camera-view-angle"),
                             (["--camera-direction", "1,0,0"], "--camera-orbit AZIMUTH,ELEVATION"), (["--background", "white"], "--background-color"),
                             (["--integrator", "path"], "--stage gi"), (["--transparent"], "--no-background"), (["--up-axis", "z"], "--up"),
                             (["--camera-pos", "0,1,3"], "--camera-position"), (["--tonemap", "agx"], "--tone-map"),
                             (["--env", SCENES / "sky.pfm"], "--hdri-file")):
            self.fails(2, "render", BOX, "-o", self.folder / "x.png", *words, says=[f"did you mean {meant}?"])
            option, *form = meant.split()
            value = {"WIDTHxHEIGHT": ["8x8"], "gi": ["gi"], "AZIMUTH,ELEVATION": ["30,20"]}[form[0]] if form else words[1:]
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


class SetByName(Case):
    """--set "MATERIAL:NAME=VALUES": materials by their names, also with what the file lacks."""

    def drawn(self, scene, *options):
        self.renders(scene, "-o", self.folder / "x.pfm", *SMALL, *options)
        return (self.folder / "x.pfm").read_bytes()

    def changed(self, change):
        """The box with a change of its materials by name, as another file."""
        root = json.loads(BOX.read_text())
        for buffer in root.get("buffers", []):
            if not buffer["uri"].startswith("data:"):
                buffer["uri"] = str(BOX.parent / buffer["uri"])
        change({material["name"]: material for material in root["materials"]}, root)
        return self.drawn(self.written("changed.gltf", root), "--allow-external-files")

    def same(self, options, change):
        words = [word for text in options for word in ("--set", text)]
        found = self.drawn(BOX, *words)
        self.assertTrue(found == self.changed(change), options)
        self.assertFalse(found == self.drawn(BOX), options)

    def test_what_the_file_has(self):
        def roughness(materials, _root):
            for name in ("red", "green"):
                materials[name]["pbrMetallicRoughness"].update(metallicFactor=1, roughnessFactor=0.3)
        self.same(["*re*:metallic=1", "red:roughness=0.3", "gr*:roughnessFactor=0.3"], roughness)
        self.same(["*re*:roughness=0.3", "/materials/1/pbrMetallicRoughness/metallicFactor=1", "green:metallic=1"], roughness)
        self.same(["?ed:roughness=0.9", "red:roughness=0.3", "green:roughness=0.3", "?????:metallic=1", "*d:metallic=1", "white:metallic=0"], roughness)
        self.same(["red:color=0.1,0.2,0.3"], lambda m, _: m["red"]["pbrMetallicRoughness"].update(baseColorFactor=[0.1, 0.2, 0.3, 1]))

    def test_what_the_file_lacks(self):
        def extended(name, **members):
            def change(materials, root):
                materials["white"].setdefault("extensions", {})[f"KHR_materials_{name}"] = members
                root["extensionsUsed"].append(f"KHR_materials_{name}")
            return change

        self.same(["white:clearcoat=1", "white:clearcoatRoughness=0.2"], extended("clearcoat", clearcoatFactor=1, clearcoatRoughnessFactor=0.2))
        self.same(["white:sheen=0.5,0.2,0.1"], extended("sheen", sheenColorFactor=[0.5, 0.2, 0.1]))
        self.same(["white:transmission=0.5"], extended("transmission", transmissionFactor=0.5))
        self.same(["white:emission=0.1,0.2,0.3"], lambda m, _: m["white"].update(emissiveFactor=[0.1, 0.2, 0.3]))
        self.same(["white:transmission=1", "white:index=1.2", "white:thickness=0.1", "white:dispersion=2"],
                  lambda m, root: [extended(*one)(m, root) if isinstance(one, tuple) else one(m, root) for one in (
                      extended("transmission", transmissionFactor=1), extended("ior", ior=1.2), extended("volume", thicknessFactor=0.1),
                      extended("dispersion", dispersion=2))])

    def test_modes(self):
        clear = "white:color=1,1,1,0.25"
        colored = lambda m: m["white"]["pbrMetallicRoughness"].update(baseColorFactor=[1, 1, 1, 0.25])
        self.same([clear, "white:alphaMode=blend"], lambda m, _: [colored(m), m["white"].update(alphaMode="BLEND")])
        self.same([clear, "white:alphaMode=MASK", "white:alphaCutoff=0.2"], lambda m, _: [colored(m), m["white"].update(alphaMode="MASK", alphaCutoff=0.2)])
        self.fails(2, "render", BOX, "-o", self.folder / "x.png", "--set", "white:alphaMode=1", says=["/materials/0/alphaMode: is OPAQUE, MASK or BLEND"])
        self.fails(2, "render", BOX, "-o", self.folder / "x.png", "--set", "white:doubleSided=MASK", says=["/materials/0/doubleSided: is true or false"])
        self.renders(BOX, "-o", self.folder / "x.png", *SMALL, "--set", "white:doubleSided=true", "--set", "/materials/1/doubleSided=true")

    def test_names_with_signs_are_quoted(self):
        root = json.loads(BOX.read_text())
        root["materials"][1]["name"] = "a=b:c*"
        odd = self.written("odd.gltf", root)
        plain = self.drawn(BOX, "--set", "red:color=0.1,0.2,0.3")
        self.assertEqual(self.drawn(odd, "--set", r"a\=b:c\*:color=0.1,0.2,0.3"), plain)
        self.fails(2, "render", odd, "-o", self.folder / "x.png", "--set", r"a\=b\*:color=0.1,0.2,0.3", says=["no material is called"])

    def textured(self, **changes):
        """A quad with a green texture and blue corners, whose material is called Seat."""
        base = {"baseColorTexture": {"index": 0}, "baseColorFactor": [1, 1, 1, 1]}
        root = quad({"name": "Seat", "pbrMetallicRoughness": base, **changes}, images=[png(1, 1, [0, 255, 0, 255])])
        gltf = Gltf(root)
        root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = gltf.accessor([(0.2, 0.5, 1)] * 4)
        return gltf.document()

    def test_a_color_is_that_color(self):
        scene = self.written("seat.gltf", self.textured())
        flat = lambda text, file=scene: self.drawn(file, "--stage", "flat", "--set", text)
        plain = self.textured(pbrMetallicRoughness={"baseColorFactor": [1, 0.5, 0, 1]})
        del plain["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"]
        orange = self.drawn(self.written("plain.gltf", plain), "--stage", "flat")
        self.assertEqual(flat("Seat:color=1,0.5,0"), orange)
        self.assertEqual(flat("seat:color=1,0.5,0"), orange)
        self.assertEqual(flat("SE?T:colour=1,0.5,0"), orange)
        self.assertEqual(flat("0:color=1,0.5,0"), orange)
        self.assertEqual(flat("Seat:color=#ff0000"), flat("Seat:color=red"))
        self.assertEqual(flat("Seat:color=red"), flat("Seat:color=1,0,0"))
        # glTF's own name multiplies; the texture alone can go, too.
        tinted = flat("Seat:baseColor=1,0.5,0")
        self.assertNotIn(tinted, (orange, self.drawn(scene, "--stage", "flat")))
        bare = self.textured(pbrMetallicRoughness={})
        without = self.drawn(self.written("bare.gltf", bare), "--stage", "flat")
        for text in ("Seat:texture=none", "Seat:baseColorTexture=none", "/materials/0/pbrMetallicRoughness/baseColorTexture=none"):
            self.assertEqual(flat(text), without, text)
        # An older description of materials has another member for it.
        older = {"KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [1, 1, 1, 1], "diffuseTexture": {"index": 0}}}
        self.assertEqual(flat("Seat:color=1,0.5,0", self.written("older.gltf", self.textured(extensions=older))), orange)

    def test_what_holds_an_outline_stays(self):
        scene = self.written("leaf.gltf", self.textured(alphaMode="MASK"))
        result = self.renders(scene, "-o", self.folder / "x.png", "--resolution", "16,16", "--spp", "2", "--set", "Seat:color=1,0.5,0")
        self.assertIn("multiplies the texture, which may hold the outline", result.stderr)
        self.assertEqual(self.drawn(scene, "--set", "Seat:color=1,0.5,0"), self.drawn(scene, "--set", "Seat:baseColorFactor=1,0.5,0,1"))

    def test_two_names_that_differ_in_case_are_not_mixed(self):
        root = json.loads(BOX.read_text())
        root["materials"][1]["name"], root["materials"][2]["name"] = "Wall", "wall"
        scene = self.written("walls.gltf", root)
        self.fails(2, "render", scene, "-o", self.folder / "x.png", "--set", "WALL:roughness=1", says=["no material is called 'WALL'"])
        self.assertNotEqual(self.drawn(scene, "--set", "wall:color=1,1,1"), self.drawn(scene, "--set", "Wall:color=1,1,1"))

    def test_of_many_names_the_nearest_are_listed(self):
        root = json.loads(BOX.read_text())
        root["materials"] += [{"name": f"Metal {i}"} for i in range(40)] + [{"name": "Wood oak"}]
        self.fails(2, "render", self.written("many.gltf", root), "-o", self.folder / "x.png", "--set", "wood:roughness=1",
                   says=["the file has 44 \"Wood oak\", ", " and 33 others"])

    def test_what_is_not_there_is_told_what_is(self):
        for text, says in (("rde:roughness=1", "no material is called 'rde'; the file has 0 \"white\", 1 \"red\", 2 \"green\", 3 \"lamp\""),
                           ("red:roughnes=1", "'roughnes' is no value of a material; did you mean roughness?"),
                           ("red:clearcoats=1", "did you mean clearcoat?"), ("red:color=1", "takes 4 numbers, not 1"),
                           (":roughness=1", "is not of the form"), ("red=1", "is not of the form"), ("red:=1", "is not of the form"), ("red:roughness=x", "'x' is no number"),
                           ("red:color=orang", "'orang' is no number and no colour; did you mean orange?"), ("red:roughness=none", "is no number"),
                           ("red:baseColorTexture=1", "takes only 'none'"), ("red:normalTextures=none", "did you mean normalTexture?")):
            self.fails(2, "render", BOX, "-o", self.folder / "x.png", "--set", text, says=["--set: ", says])


FLOOR = ["--resolution", "1,1", "--camera-type", "orthographic", "--camera-parallel-scale", "1e-3", "--camera-position", "0,1,0", "--camera-focal-point", "0,0,0",
         "--camera-view-up", "0,0,-1", "--bounces", "0", "--default-light", "none", "--quiet"]
ALBEDO = 0.5


class AddLight(Case):
    """--add-light: a lamp of one's own, by the light that it must bring."""

    def floor(self):
        """A matt floor in the plane y = 0 around the origin."""
        root = quad({"pbrMetallicRoughness": {"baseColorFactor": [ALBEDO] * 3 + [1], "metallicFactor": 0, "roughnessFactor": 1}, "doubleSided": True,
                     "extensions": {"KHR_materials_specular": {"specularFactor": 0}}})
        root["nodes"][0]["rotation"] = [-math.sqrt(0.5), 0, 0, math.sqrt(0.5)]
        root["extensionsUsed"] = ["KHR_materials_specular"]
        return self.written("floor.gltf", root)

    def radiance(self, *lights, spp=64):
        words = [word for light in lights for word in ("--add-light", light)]
        return self.pixel(self.floor(), "--spp", spp, *words)

    def pixel(self, scene, *options):
        self.renders(scene, "-o", self.folder / "x.pfm", *FLOOR, *options)
        return read_pfm(self.folder / "x.pfm")[0][0]

    def test_a_sun_brings_its_irradiance_times_the_cosine(self):
        for elevation, color in ((90, (1, 1, 1)), (30, (1, 0.5, 0.25))):
            found = self.radiance(f"sun from=20,{elevation} strength=4 color={','.join(map(str, color))}")
            for c in range(3):
                self.assertAlmostEqual(found[c], ALBEDO / math.pi * 4 * math.sin(math.radians(elevation)) * color[c], delta=1e-3)

    def test_an_area_brings_what_its_power_gives(self):
        """A small one of power P at the distance d above: P / (pi d^2) on the floor."""
        found = self.radiance("area at=0,3,0 size=0.1 power=50", spp=256)
        self.assertAlmostEqual(found[0] / (ALBEDO / math.pi * 50 / (math.pi * 9)), 1, delta=0.02)
        aside = self.radiance("area at=3,3,0 to=0,0,0 size=0.1,0.1 power=50 color=2,1,0", spp=256)
        self.assertAlmostEqual(aside[1] / (ALBEDO / math.pi * 50 / (math.pi * 18) * math.sqrt(0.5)), 1, delta=0.02)
        self.assertAlmostEqual(aside[0] / aside[1], 2, delta=1e-3)
        self.assertEqual(self.radiance("area at=0,3,0 to=0,9,0 size=0.1 power=50")[0], 0)  # it shines on one side

    def test_several_add_up(self):
        one, two = "sun from=0,90 strength=1", "sun from=0,90 strength=2"
        self.assertAlmostEqual(self.radiance(one, two)[0], self.radiance("sun from=0,90 strength=3")[0], delta=1e-3)

    def test_a_turned_scene_has_it_where_the_picture_has(self):
        scene, sun = self.floor(), ["--add-light", "area at=0,3,0 size=0.1 power=50"]
        root = json.loads(scene.read_text())
        root["nodes"][0]["rotation"] = [0, 0, 0, 1]  # level where z is up
        turned = self.pixel(self.written("turned.gltf", root), "--spp", 64, "--up", "z", *sun)
        self.assertAlmostEqual(turned[0] / self.radiance(sun[1])[0], 1, delta=0.02)

    def test_what_is_wrong_is_named(self):
        for text, says in (("lamp", "'lamp' is none of area, sun"), ("area", "its place is missing"), ("sun stregth=1", "did you mean strength?"), ("sun from=1", "from takes 2 numbers, not 1"),
                           ("sun strength=0", "strength: is not above 0"), ("area at=0,1,x", "at: 'x' is no number"), ("area at=0,1,0 to=0,1,0", "is the place of the light itself"),
                           ("sun from=1,91", "the elevation is not between"), ("sun color=0,0,0", "is black"), ("sun strength=", "its value is missing")):
            self.fails(2, "render", self.floor(), "-o", self.folder / "x.png", "--add-light", text, says=["--add-light: ", says])

    def test_info_knows_it(self):
        text = run("info", self.floor(), "--add-light", "sun").stdout
        self.assertIn('  lamps       1: 0 "added sun 1" (directional, 3 lx)\n', text)
        self.assertIn("  light       its own: 1 lamp\n", text)


class Info(Case):
    """What `info` tells of a file to somebody who has not made it."""

    def scene(self):
        (self.folder / "wood.png").write_bytes(png(4, 2, bytes([90, 60, 30, 255] * 8)))
        gltf = Gltf({"asset": {"version": "2.0", "generator": "a pencil", "copyright": "2026 A\nB"}, "scene": 0, "scenes": [{"nodes": []}],
                     "extensionsUsed": ["KHR_lights_punctual"], "images": [{"uri": "wood.png"}], "textures": [{"source": 0}],
                     "extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 3}]}},
                     "materials": [{"name": "oak", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}, {}]})
        corners = [(0, 0, 0), (2, 0, 0), (0, 3, 0), (0, 0, 4)]
        position, uv = gltf.accessor(corners), gltf.accessor([(0, 0), (1, 0), (0, 1), (1, 1)])
        mesh = gltf.mesh(gltf.accessor([0, 1, 2, 0, 2, 3], "H"), position=position, texcoord_0=uv, material=0)
        gltf.node(mesh=mesh)
        gltf.node(name="Sun", extensions={"KHR_lights_punctual": {"light": 0}})
        (self.folder / "table.bin").write_bytes(gltf.data)
        path = gltf.write(self.folder / "table.gltf")
        root = json.loads(path.read_text())
        root["buffers"][0]["uri"] = "table.bin"
        path.write_text(json.dumps(root))
        return path

    def test_it_lists_devices_and_render_takes_one(self):
        devices = json.loads(run("info", "--devices", "--json").stdout)["devices"]
        self.assertEqual([device["number"] for device in devices], list(range(len(devices))))
        self.assertEqual(len(run("info", "--devices").stdout.splitlines()), max(len(devices), 1))
        chosen = next(device for device in devices if "error" not in device)
        for word in (str(chosen["number"]), chosen["name"].split(" ")[0].upper()):
            self.renders(SCENES / "coverage.gltf", "-o", self.folder / "x.png", "--device", word, "--stats", self.folder / "s.json", *SMALL)
            self.assertEqual(json.loads((self.folder / "s.json").read_text())["gl_renderer"], chosen["name"])
        for word in (str(len(devices)), "voodoo"):
            result = run("render", SCENES / "coverage.gltf", "-o", self.folder / "y.png", "--device", word, *SMALL)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn(f"--device {word}: no device of that number or name", result.stderr)
        self.fails(2, "info", says=["file is required"])

    def test_it_says_what_one_wants_to_know(self):
        path = self.scene()
        text = run("info", path).stdout
        self.assertTrue(text.startswith(f"{path} ("), text)
        for line in ("  size        2 x 3 x 4 m (W x H x D), from (0, 0, 0) to (2, 3, 4)\n", "  materials   2, textures 1, images 1 (0.0 MB encoded)\n",
                     '    0 "oak": base colour 4 x 2 (wood.png)\n', '  lamps       1: 0 "Sun" (directional, 3 lx)\n', "  light       its own: 1 lamp\n",
                     "  cameras     none\n", "  made by     a pencil\n", "  copyright   2026 A?B\n"):
            self.assertIn(line, text)
        self.assertRegex(text, r"  refers to   table.bin \d+ bytes, wood.png \d+ bytes\n")
        self.assertNotIn("  tree  ", text)
        verbose = run("info", path, "--verbose").stdout
        self.assertTrue(verbose.startswith(text))
        self.assertIn("  tree  ", verbose)
        self.assertIn("  GPU memory  ", verbose)

    def test_json_keeps_its_members_and_has_these(self):
        path = self.scene()
        data = json.loads(run("info", path, "--json").stdout)
        self.assertEqual(data["materials"][0], {"name": "oak", "textures": [{"slot": "base colour", "name": "wood.png", "width": 4, "height": 2}]})
        self.assertEqual(data["lamps"], [{"name": "Sun", "type": "directional", "intensity": 3, "unit": "lx"}])
        self.assertEqual((data["size"], data["generator"], data["copyright"], data["lit_by"]), ([2, 3, 4], "a pencil", "2026 A\nB", "own"))
        self.assertEqual(data["files"], [{"name": str(self.folder / name), "bytes": (self.folder / name).stat().st_size}
                                         for name in ("table.gltf", "table.bin", "wood.png")])
        for member in ("schema", "file", "scene", "bvh", "texture_bytes", "not_needed", "material_names", "cameras", "animations", "warnings"):
            self.assertIn(member, data)

    def test_a_material_that_a_scene_has_twice_is_listed_once(self):
        glass = {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_volume": {"thicknessFactor": 0.1}}
        root = quad({"name": "glass", "emissiveFactor": [1, 1, 1], "extensions": glass})
        path = self.written("pane.gltf", root | {"extensionsUsed": list(glass)})
        result = run("info", path)
        self.assertIn("is drawn as a thin wall", result.stderr)  # by a copy of its material
        self.assertEqual(result.stdout.count('"glass"'), 1, result.stdout)
        self.assertIn("  materials   1,", result.stdout)
        self.assertIn("its own: 1 material that shines\n", result.stdout)
        data = json.loads(run("info", path, "--json").stdout)
        self.assertEqual((data["material_names"].count("glass"), len([m for m in data["materials"] if m["name"] == "glass"])), (1, 1))

    def test_who_would_light_it(self):
        self.assertIn("  light       its own: 1 material that shines\n", run("info", SCENES / "cornell-box.gltf").stdout)
        root = json.loads((SCENES / "cornell-box.gltf").read_text())
        root["materials"][3].pop("emissiveFactor")
        dark = self.written("dark.gltf", root)
        self.assertRegex(run("info", dark).stdout, r"  light       no light in the scene: `render` adds ")
        self.assertNotEqual(json.loads(run("info", dark, "--json").stdout)["lit_by"], "own")

    def test_many_materials_are_cut_short(self):
        root = json.loads((SCENES / "cornell-box.gltf").read_text())
        root["materials"] += [{"name": f"m{i}"} for i in range(60)]
        many = self.written("many.gltf", root)
        self.assertIn("    and 24 more (--verbose)\n", run("info", many).stdout)
        self.assertIn('    63 "m59"\n', run("info", many, "--verbose").stdout)


if __name__ == "__main__":
    main()

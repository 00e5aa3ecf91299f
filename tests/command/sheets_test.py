#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Stacks of sheets whose picture is a closed form of their alphas: means of a million samples, within 5 standard errors, which faults of 2 % exceed."""
import json
import math
import shutil
import signal
import subprocess
import time

from support import FRAGTRACE, SCENES, Case, main, quad, read_png, run

NARROW = ["--camera-view-angle", 1, "--bounces", "unlimited"]
SPECULAR = {"KHR_materials_specular": {"specularFactor": 0}}


def sheet(color=(0, 0, 0), alpha=1.0, **more):
    return {"pbrMetallicRoughness": {"baseColorFactor": [*color, alpha], "metallicFactor": 0}, "doubleSided": True, "extensions": SPECULAR, **more}


class Sheets(Case):
    def stack(self, sheets, *options, size=128, spp=64):
        """The picture's mean colour, of quads (material, z, width) before a camera at z = 2.2."""
        gltf = quad(sheets[0][0])
        primitive = gltf["meshes"][0]["primitives"][0]
        gltf["materials"] = [material for material, _, _ in sheets]
        gltf["meshes"] = [{"primitives": [dict(primitive, material=i)]} for i in range(len(sheets))]
        gltf["nodes"] = [gltf["nodes"][1]] + [{"mesh": i, "translation": [0, 0, z], "scale": [width, width, 1]} for i, (_, z, width) in enumerate(sheets)]
        gltf["nodes"].append({"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [0, 0, 9]})
        gltf["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 1}]}}
        gltf["scenes"] = [{"nodes": list(range(len(gltf["nodes"])))}]
        path = self.written("stack.gltf", {key: value for key, value in gltf.items() if value})
        picture = self.picture(str(path.with_suffix("")), "x.pfm", "--resolution", f"{size},{size}", "--spp", spp, *options)
        return [sum(pixel[c] for row in picture for pixel in row) / size**2 for c in range(3)]

    def assert_share(self, seen, share, samples, light=1.0):
        """A part `share` of the samples see `light`."""
        self.assertAlmostEqual(seen, share * light, delta=5 * light * math.sqrt(share * (1 - share) / samples) + 1e-6)

    def test_each_sheet_covers_its_alpha_of_what_the_ones_before_leave(self):
        # So close together that a ray that continues 2 % of the way behind one misses all.
        alphas = (0.5, 0.4, 0.6)
        colors = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
        sheets = [(sheet(color, alpha, alphaMode="BLEND"), -0.01 * i, 3) for i, (color, alpha) in enumerate(zip(colors, alphas))]
        left = 1.0
        for seen, alpha in zip(self.stack(sheets, "--stage", "flat"), alphas):
            self.assert_share(seen, left * alpha, 128 * 128 * 64)
            left *= 1 - alpha

    def test_light_through_sheets_is_what_their_alphas_leave(self):
        """A white ground, and between it and the lamp black sheets that the camera does not see."""
        sheets = [(sheet((1, 1, 1)), 0, 3), (sheet(alpha=0.5, alphaMode="BLEND"), 3, 9), (sheet(alpha=0.4, alphaMode="BLEND"), 3.01, 9)]
        for seen in self.stack(sheets):
            self.assert_share(seen, 0.5 * 0.6, 128 * 128 * 64, 1 / math.pi)

    def test_a_cutoff_a_hundredth_from_the_alpha_decides(self):
        masked = lambda cutoff, *color: (sheet(color, 0.5, alphaMode="MASK", alphaCutoff=cutoff), 0.1 * cutoff, 3)
        self.assertEqual(self.stack([masked(0.505, 1, 0, 0), masked(0.495, 0, 1, 0)], "--stage", "flat", size=8, spp=1), [0, 1, 0])

    def test_glass_that_is_half_there_lets_half_through_before_gi(self):
        """The glass has an index of 1, and lies over black and before white."""
        glass = {"KHR_materials_transmission": {"transmissionFactor": 0.5}, "KHR_materials_ior": {"ior": 1}}
        sheets = [({"pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 1], "metallicFactor": 0, "roughnessFactor": 0}, "extensions": SPECULAR | glass}, 0, 3),
                  (sheet((1, 1, 1)) | {"extensions": {"KHR_materials_unlit": {}}}, -1, 9)]
        # The opaque share is lit: it is white under a light of pi and the ambient light.
        for seen in self.stack(sheets, "--stage", "refraction"):
            self.assert_share(seen - (0.03 + 1 / math.pi), 0.5, 128 * 128 * 64, 1 - 0.03 - 1 / math.pi)

    def test_a_screen_close_before_a_lamp_lets_nothing_through(self):
        """Nor does a roof let the other light through."""
        lamp = sheet(emissiveFactor=[1, 1, 1])
        self.assertEqual(self.stack([(sheet((1, 1, 1)), 0, 3), (sheet(), 3.96, 2), (lamp, 4, 1), (sheet(), 5, 30)], size=16, spp=64), [0, 0, 0])

    def test_fog_behind_a_sheet_is_that_before_it_once_more(self):
        """Beer's law continues behind a sheet that half of the light passes, and takes no flight twice."""
        black = sheet(alpha=0.5, alphaMode="BLEND")
        for seen in self.stack([(black, 0, 3)], *NARROW, "--background-color", "1,1,1", "--fog-density", 0.8, "--fog-color", "0,0,0", "--fog-distance", 1, size=64):
            self.assert_share(seen, 0.5 * math.exp(-0.8 * 2), 64 * 64 * 64)


SIZE = (64, 48)
OPTIONS = ["--resolution", "64,48", "--spp", "2", "--quiet"]


class ModelSheets(Case):
    """`sheet`: all models of a folder in one picture. Each cell is the picture of a single command; one that fails says why, and what was drawn
    stays."""

    def setUp(self):
        super().setUp()
        self.models = self.folder / "models"
        (self.models / "more").mkdir(parents=True)
        self.sheet = self.folder / "sheet.png"
        self.cells = self.folder / "sheet.png.cells"
        for name, color in (("a 2.gltf", [0.8, 0.1, 0.1, 1]), ("a 10.gltf", [0.1, 0.8, 0.1, 1]), ("more/b.gltf", [0.1, 0.1, 0.8, 1])):
            self.write(name, color)
        (self.models / "readme.txt").write_text("no model")

    def write(self, name, color):
        path = self.models / name
        path.write_text(json.dumps(quad({"pbrMetallicRoughness": {"baseColorFactor": color}})))

    def draw(self, *options, status=0):
        result = run("sheet", self.models, "-o", self.sheet, *OPTIONS, *options)
        self.assertEqual(result.returncode, status, result.stderr)
        return result

    def parts(self, place):
        """The pixels of a cell's picture and of its name."""
        width, _, rows, step = read_png(self.sheet)
        self.assertEqual(step, 3)
        left, top = 12 + place[0] * (SIZE[0] + 12), 12 + place[1] * (SIZE[1] + 38 + 12)
        self.assertLess(left + SIZE[0], width)
        part = lambda begin, end: [row[3 * left:3 * (left + SIZE[0])] for row in rows[begin:end]]
        return part(top, top + SIZE[1]), part(top + SIZE[1], top + SIZE[1] + 38)

    def test_each_cell_is_the_picture_of_a_single_command(self):
        self.draw("--columns", 2)
        self.assertFalse(self.cells.exists())
        names = []
        for name, place in (("a 2.gltf", (0, 0)), ("a 10.gltf", (1, 0)), ("more/b.gltf", (0, 1))):
            picture, below = self.parts(place)
            self.renders(self.models / name, "-o", self.folder / "single.png", *OPTIONS)
            self.assertEqual(picture, [row for row in read_png(self.folder / "single.png")[2]], name)
            names.append(b"".join(map(bytes, below)))
            self.assertLess(min(names[-1]), 80, "ink")
        self.assertEqual(len(set(names)), 3)

    def test_a_model_without_the_material_is_drawn_as_it_is(self):
        paint = quad({"name": "Paint", "pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.1, 0.1, 1]}})
        (self.models / "a 10.gltf").write_text(json.dumps(paint))
        aloud = ["sheet", self.models, "-o", self.sheet, *OPTIONS[:-1], "--columns", 3]
        result = run(*aloud, "--set", "paint:color=blue")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("--set: paint:color is in 1 of 3 models; the others are drawn as they are\n", result.stderr)
        for name, place, options in (("a 2.gltf", (0, 0), []), ("a 10.gltf", (1, 0), ["--set", "Paint:color=blue"])):
            self.renders(self.models / name, "-o", self.folder / "single.png", *OPTIONS, *options)
            self.assertEqual(self.parts(place)[0], [row for row in read_png(self.folder / "single.png")[2]], name)
        for text, says in (("pint:color=blue", "--set: pint:color is in no model of the folder"), ("Paint:colr=blue", "'colr' is no value of a material")):
            result = run(*aloud, "--set", text)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn(says, result.stderr)
            self.assertFalse(self.cells.exists())

    def test_a_model_without_the_part_that_an_option_names_is_drawn_as_it_is(self):
        named = quad({"name": "Paint", "pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.1, 0.1, 1]}})
        named["nodes"][0]["name"] = "Bolt"
        named["nodes"].append({"mesh": 0, "name": "Nut", "translation": [0, 0, -1]})
        named["scenes"] = [{"nodes": list(range(len(named["nodes"])))}]
        named["extensions"] = {**named.get("extensions", {}), "KHR_materials_variants": {"variants": [{"name": "red"}]}}
        named["extensionsUsed"] = [*named.get("extensionsUsed", []), "KHR_materials_variants"]
        (self.models / "a 10.gltf").write_text(json.dumps(named))
        for option, name in (("--hide", "Bolt"), ("--double-sided", "Paint"), ("--material-variant", "red"), ("--fit-to", "Nut")):
            result = run("sheet", self.models, "-o", self.sheet, *OPTIONS[:-1], "--columns", 3, option, name)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn(f'{option}: "{name}" is in 1 of 3 models; the others are drawn as they are\n', result.stderr)
            for model, place, options in (("a 2.gltf", (0, 0), []), ("a 10.gltf", (1, 0), [option, name])):
                self.renders(self.models / model, "-o", self.folder / "single.png", *OPTIONS, *options)
                self.assertEqual(self.parts(place)[0], [row for row in read_png(self.folder / "single.png")[2]], (option, model))
            result = run("sheet", self.models, "-o", self.sheet, *OPTIONS[:-1], option, "nothing of it")
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn(f'{option}: "nothing of it" is in no model of the folder', result.stderr)

    def test_a_model_that_fails_is_a_cell_with_its_reason(self):
        (self.models / "a 2.gltf").write_text('{"asset": {"version": "2.0"}, "scenes": [{"nodes": [7]}]}')
        status = self.folder / "status.json"
        result = self.draw("--status-file", status, "--columns", 3, status=1)
        self.assertIn("a 2.gltf: /scenes/0/nodes/0: index 7", result.stderr)
        told = json.loads(status.read_text())
        self.assertEqual([told[name] for name in ("written", "models", "drawn", "failed")], [True, 3, 2, 1])
        self.assertEqual([(cell["name"], cell["state"]) for cell in told["cells"]],
                         [("a 2.gltf", "failed"), ("a 10.gltf", "drawn"), ("more/b.gltf", "drawn")])
        self.assertIn("index 7", told["cells"][0]["reason"])
        picture, below = self.parts((0, 0))
        pixels = {bytes(row[i:i + 3]) for row in picture for i in range(0, len(row), 3)}
        self.assertIn(bytes([237] * 3), pixels, "grey paper")
        self.assertTrue(any(r > 1.5 * g and g < 180 for r, g, _ in pixels), "red letters")
        self.assertLess(min(map(min, below)), 80)
        # What was drawn stays, and the model that is mended is drawn alone.
        self.write("a 2.gltf", [0.8, 0.1, 0.1, 1])
        self.draw("--continue", "--status-file", status, "--columns", 3)
        self.assertEqual([cell["state"] for cell in json.loads(status.read_text())["cells"]], ["drawn", "kept", "kept"])
        self.assertFalse(self.cells.exists())
        once = self.sheet.read_bytes()
        self.draw("--columns", 3)
        self.assertEqual(self.sheet.read_bytes(), once)

    def test_cells_of_other_options_and_of_changed_models_are_drawn_again(self):
        status = self.folder / "status.json"
        states = lambda: [cell["state"] for cell in json.loads(status.read_text())["cells"]]
        (self.models / "z.gltf").write_text("{}")
        self.draw(status=1)
        self.draw("--continue", "--status-file", status, status=1)
        self.assertEqual(states(), ["kept", "kept", "failed", "kept"])
        time.sleep(0.05)
        self.write("a 10.gltf", [0.5, 0.5, 0.1, 1])
        self.draw("--continue", "--status-file", status, status=1)
        self.assertEqual(states(), ["kept", "drawn", "failed", "kept"])
        result = run("sheet", self.models, "-o", self.sheet, *OPTIONS[:-1], "--continue", "--seed", 3, "--status-file", status)
        self.assertEqual(states(), ["drawn", "drawn", "failed", "drawn"])
        self.assertIn("other options", result.stderr)

    def test_an_interrupted_sheet_leaves_what_was_drawn(self):
        self.sheet.write_bytes(b"the sheet before")
        shutil.copy(SCENES / "cornell-box.gltf", self.models / "more/c.gltf")
        words = ["sheet", self.models, "-o", self.sheet, "--resolution", "64,48", "--spp", "4000"]
        for name in ("a 2.gltf", "a 10.gltf"):
            (self.models / name).unlink()
        process = subprocess.Popen([FRAGTRACE, *map(str, words)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        while process.poll() is None and not (self.cells / "more/b.gltf.png").exists():
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        _, error = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130, error)
        self.assertIn("models drawn: 1 of 2", error)
        self.assertEqual(self.sheet.read_bytes(), b"the sheet before")
        left = sorted(str(path.relative_to(self.cells)) for path in self.cells.rglob("*") if path.is_file())
        self.assertEqual(left, ["command.txt", "more/b.gltf.png"])
        (self.models / "more/c.gltf").unlink()
        self.assertIn("models drawn already: 1 of 1", run(*words, "--continue").stderr)
        self.assertNotEqual(self.sheet.read_bytes(), b"the sheet before")

    def test_what_is_no_sheet_is_refused(self):
        for status, words, says in ((2, ["-o", self.folder / "x.exr"], "a sheet has names"), (2, ["-o", "-", "--format", "png"], "--format"),
                                    (2, ["-o", self.sheet, "--material-variant", "all"], "a cell shows one variant")):
            result = run("sheet", self.models, *words)
            self.assertEqual(result.returncode, status, result.stderr)
            self.assertIn(says, result.stderr)
        empty = self.folder / "empty"
        empty.mkdir()
        self.fails(3, "sheet", empty, "-o", self.sheet, says=["holds no .gltf or .glb"])
        self.fails(3, "sheet", self.folder / "none", "-o", self.sheet, says=["no such folder"])
        self.fails(2, str(self.models), says=["fragtrace sheet"])


if __name__ == "__main__":
    main()

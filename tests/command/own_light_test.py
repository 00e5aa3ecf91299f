#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Who lights a file, the units of its lamps, and why a picture is black."""
import json
import math
import statistics
import struct
from pathlib import Path

from support import SCENES, SQUARE, TWO_TRIANGLES, Case, Exr, Gltf, floats, main, read_pfm, read_png, run

BLENDER = Path(__file__).resolve().parent.parent / "assets" / "blender"
GREY = {"pbrMetallicRoughness": {"metallicFactor": 0, "baseColorFactor": [0.5, 0.5, 0.5, 1]}}
STUDIO = "the built-in studio lights it"
FEW = ["--resolution", "32,24", "--spp", "16"]


def values_of(path):
    """Red, green and blue of a .png, 0..255, in one list."""
    _, _, rows, step = read_png(path)
    return [row[x + c] for row in rows for x in range(0, len(row), step) for c in range(3)]


def brightness(path):
    """The mean of the values above 0 of a .png, if at least one in twenty is, else 0."""
    values = values_of(path)
    lit = [value for value in values if value > 0]
    return statistics.fmean(lit) if len(lit) > len(values) / 20 else 0


def glowing(strength, **more):
    return {"emissiveFactor": [1, 1, 1], "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": strength}},
            "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}} | more


def box(gltf, size, **more):
    """Adds a mesh of a box with fronts outside, or inside for a negative size."""
    corners = [tuple((1 if i >> axis & 1 else -1) * size[axis] / 2 for axis in range(3)) for i in range(8)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    indices = [q[k] for q in quads for k in (0, 1, 2, 0, 2, 3)]
    return gltf.mesh(gltf.accessor(indices, "H"), position=gltf.accessor(corners), **more)


class Model:
    """A file in the making: boxes, plates, lamps and a camera."""

    def __init__(self, *materials):
        self.gltf = Gltf(materials=list(materials))

    def box(self, size, material=0, **node):
        self.gltf.node(mesh=box(self.gltf, size, material=material), **node)
        return self

    def plate(self, size, material=0, up=True, **node):
        """A level square that faces up, or down."""
        turn = math.sqrt(0.5) * (-1 if up else 1)
        places = self.gltf.accessor(SQUARE)
        self.gltf.node(mesh=self.gltf.mesh(self.gltf.accessor(TWO_TRIANGLES, "H"), position=places, material=material),
                       rotation=[turn, 0, 0, math.sqrt(0.5)], scale=[size / 2] * 3, **node)
        return self

    def lamp(self, kind, intensity, **node):
        self.gltf.root["extensionsUsed"] = ["KHR_lights_punctual"]
        lights = self.gltf.root.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})["lights"]
        lights.append({"type": kind, "intensity": intensity})
        self.gltf.node(extensions={"KHR_lights_punctual": {"light": len(lights) - 1}}, **node)
        return self

    def camera(self, **node):
        self.gltf.root["cameras"] = [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.01, "aspectRatio": 4 / 3}}]
        self.gltf.node(camera=0, **node)
        return self


SUN = {"rotation": [-0.5, 0.2, 0, math.sqrt(1 - 0.29)]}  # shines down, obliquely


def headlight():
    return Model(GREY, glowing(1)).box((4, 1, 2)).box((0.02, 0.1, 0.1), 1, translation=[2.01, 0, 0.6])


def filament():
    return Model(GREY, glowing(100)).box((1, 1, 1)).box((0.1, 0.1, 0.1), 1)


def label():
    return Model(GREY, glowing(1)).box((1, 0.2, 2)).box((0.3, 0.01, 0.1), 1, translation=[0, 0.105, 0.5])


def led():
    return Model(GREY, glowing(2)).box((1, 0.3, 0.6)).box((0.01, 0.01, 0.01), 1, translation=[0.3, 0.1, 0.305])


def plate():
    return Model(GREY, glowing(1)).plate(2000).box((1, 1, 1), 1, translation=[0, 0.5, 0])


def floor_turned_down():
    return Model(GREY).plate(4, up=False).lamp("directional", 3, **SUN).camera(translation=[0, 1.5, 4], rotation=[-0.17, 0, 0, 0.985])


def lamp_below_a_floor():
    return Model(GREY | {"doubleSided": True}).plate(40).lamp("point", 50, translation=[0, -1, 0]).camera(translation=[0, 1.5, 4], rotation=[-0.17, 0, 0, 0.985])


def black_emitter():
    return Model(GREY, glowing(1e-6)).box((1, 1, 1)).box((1, 0.2, 1), 1, translation=[0, 0.7, 0])


def sun_and_mirror():
    mirror = {"pbrMetallicRoughness": {"metallicFactor": 1, "roughnessFactor": 0}}
    return Model(mirror).box((1, 1, 1)).lamp("directional", 3, **SUN)


def camera_in_a_dome():
    return Model(GREY | {"doubleSided": True}).box((10, 10, 10)).camera()


def lamp_of_no_intensity():
    return Model(GREY).box((1, 1, 1)).lamp("point", 0, translation=[0, 3, 0])


def screen_that_is_all():
    return Model(glowing(1)).box((1, 0.6, 0.1))


def dim_lamp():
    """A floor at about a thirtieth of middle grey."""
    return Model(GREY, glowing(1)).plate(2).box((0.2, 0.02, 0.2), 1, translation=[0, 1, 0])


def bright_lamp():
    """A plate about 20 times as bright as middle grey; divided by 683, it is farther from that."""
    return Model(GREY).plate(0.5).lamp("point", 24, translation=[0, 1, 0]).camera(translation=[0, 0.8, 1], rotation=[-0.3, 0, 0, 0.954])


class OwnLight(Case):
    def drawn(self, model, *options, name="x.png"):
        scene = model if isinstance(model, Path) else model.gltf.write(self.folder / "scene.gltf")
        return self.renders(scene, "-o", self.folder / name, *FEW, *options).stderr

    def brightness(self):
        return brightness(self.folder / "x.png")

    def test_the_studio_joins_emission_that_leaves_the_model_dark(self):
        for make in (headlight, filament, label, led, black_emitter, dim_lamp):
            said = self.drawn(make())
            self.assertRegex(said, rf"the scene's emission leaves \d+ % of what is seen dark: {STUDIO}", make.__name__)
            self.assertNotIn("warning", said)
            self.assertGreater(self.brightness(), 30, make.__name__)
        self.assertIn(f"no light in the scene: {STUDIO}", self.drawn(lamp_of_no_intensity()))
        self.assertEqual(self.drawn(screen_that_is_all()), "fragtrace: the file's own emission lights it\n")

    def test_neither_camera_nor_hidden_nodes_change_it(self):
        """Nor the numbers that are set, nor a part of the picture."""
        scene = headlight().gltf.write(self.folder / "scene.gltf")
        for options in (["--hide", "1"], ["--camera-position", "9,1,1"], ["--set", "/materials/1/extensions/KHR_materials_emissive_strength/emissiveStrength=900"],
                        ["--region", "0,0,4,4"]):
            self.assertIn(STUDIO, self.drawn(scene, *options), options)
        lamps = floor_turned_down().lamp("point", 50000, translation=[0, 2, 0]).box((1, 1, 1)).gltf.write(self.folder / "lamps.gltf")
        for options in ([], ["--hide", "1"], ["--hide", "3"], ["--set", "/extensions/KHR_lights_punctual/lights/1/intensity=1"]):
            self.assertIn("they are divided by 683", self.drawn(lamps, *options), options)

    def test_an_exposure_for_lamps_does_not_hide_surroundings_that_the_user_adds(self):
        self.assertIn("have an exposure of -", self.drawn(bright_lamp()))
        for options in (["--studio"], ["--shop"]):
            said = self.drawn(bright_lamp(), *options)
            self.assertNotIn("exposure", said)
            self.assertIn("they are divided by 683", said)
            self.assertGreater(self.brightness(), 60)
        self.assertIn("have an exposure of -", self.drawn(bright_lamp(), "--studio", "--lamp-units", "photometric"))

    def test_lamps_that_leave_something_dark_are_named(self):
        said = self.drawn(lamp_below_a_floor())
        self.assertRegex(said, r"the file's own lamps light it, and leave \d+ % of what is seen dark \(--studio adds light\)")
        self.assertIn("its smooth metal has nothing to reflect but them (--studio adds surroundings)", self.drawn(sun_and_mirror()))
        self.assertEqual(self.drawn(sun_and_mirror(), "--studio"), "fragtrace: the built-in studio and the file's own lamps light it\n")

    def test_one_line_says_who_lights_the_picture(self):
        box = SCENES / "cornell-box.gltf"
        (self.folder / "day.pfm").write_bytes(b"PF\n2 1\n-1.0\n" + struct.pack("<6f", *[1] * 6))
        for options, who in (([], "the file's own emission lights it"), (["--stage", "flat"], ""), (["--studio"], "the built-in studio lights it"),
                             (["--sky"], "the sky lights it"), (["--hdri-file", self.folder / "day.pfm"], f"the environment {self.folder / 'day.pfm'} lights it"),
                             (["--add-light", "sun from=30,45"], "--add-light lights it"), (["--quiet"], "")):
            result = self.renders(box, "-o", self.folder / "x.png", *FEW, *options)
            self.assertEqual(result.stderr, who and f"fragtrace: {who}\n", options)
        self.assertIn(": nothing lights it (--default-light none)\n", self.drawn(lamp_of_no_intensity(), "--default-light", "none"))

    def test_a_black_picture_says_why(self):
        for model, options, why in (
                (lamp_below_a_floor(), [], "the scene's own light is out of sight of all that is seen"),
                (floor_turned_down(), [], "this view shows nothing of the scene but backs, which are not drawn; --double-sided all"),
                (camera_in_a_dome(), [], "the camera stands inside the scene, in a closed shell"),
                (screen_that_is_all(), ["--exposure", "-30"], "there is light, too little for this exposure (--exposure "),
                (filament(), ["--no-default-light"], "the scene's own light is out of sight"),
                (sun_and_mirror(), [], "smooth metal has nothing to reflect"),
                (camera_in_a_dome(), ["--no-default-light"], "there is no light (--studio"),
        ):
            said = self.drawn(model, *options)
            self.assertEqual([line for line in said.splitlines() if "warning" in line and why in line][1:], [], said)
            self.assertIn(why, said)
        turned = Model(GREY, glowing(5)).plate(4).plate(2, 1, up=True, translation=[0, 3, 0]).camera(translation=[0, 1.5, 4], rotation=[-0.17, 0, 0, 0.985])
        self.assertIn("turned away (--double-sided all)", self.drawn(turned, "--no-default-light"))
        self.assertEqual(self.drawn(turned, "--double-sided", "all"), "fragtrace: the file's own emission lights it\n")

    def test_double_sided(self):
        scene = floor_turned_down()
        scene.gltf.root["materials"][0]["name"] = "tiles"
        for name in ("all", "tiles", "0"):
            self.assertNotIn("warning", self.drawn(scene, "--double-sided", name))
            self.assertGreater(self.brightness(), 30)
            scene = self.folder / "scene.gltf"
        self.fails(2, "render", scene, "-o", self.folder / "y.png", "--double-sided", "wood", says=['--double-sided: "wood" is not in the file, which has 0 "tiles"'])

    def test_a_vast_plate_has_a_line(self):
        """Its white block shines, and leaves the plate dark."""
        self.assertIn(STUDIO, self.drawn(plate()))


class LampUnits(Case):
    def draw(self, scene, name, *options):
        return self.renders(scene, "-o", self.folder / name, *options).stderr

    def test_files_of_blender_are_drawn_as_by_cycles(self):
        for name in ("default-scene", "sun", "point", "spot-and-glow", "point-compatible"):
            said = self.draw(BLENDER / f"{name}.glb", "x.png", "--resolution", "240,135", "--spp", "32", "--tone-map", "linear", "--no-dither")
            self.assertEqual("they are divided by 683" in said, name != "point-compatible", said)
            seen, wanted = values_of(self.folder / "x.png"), values_of(BLENDER / f"{name}.png")
            off = statistics.fmean(abs(a - b) for a, b in zip(seen, wanted, strict=True)) / 255
            print(f"{name}: {off:.4f}")
            self.assertLess(off, 0.03, name)

    def test_what_is_given_wins_and_is_told(self):
        scene, small = BLENDER / "sun.glb", ["--resolution", "16,9", "--spp", "4", "--stats", self.folder / "s.json"]
        for units, scale in (("photometric", 683), ("radiometric", 1), ("auto", 1)):
            said = self.draw(scene, f"{units}.pfm", *small, "--lamp-units", units)
            self.assertEqual("they are divided by 683" in said, units == "auto", said)
            stats = json.loads((self.folder / "s.json").read_text())
            self.assertEqual(stats["lamp_units"], "photometric" if units == "photometric" else "radiometric")
            self.assertEqual(stats["exposure"] != 0, units == "photometric")
        pictures = {units: read_pfm(self.folder / f"{units}.pfm") for units in ("photometric", "radiometric", "auto")}
        self.assertEqual(pictures["auto"], pictures["radiometric"])
        means = [statistics.fmean(v for row in pictures[units] for pixel in row for v in pixel) for units in ("photometric", "auto")]
        self.assertAlmostEqual(means[0] / means[1], 683, delta=0.01)

    def test_parts_are_joined_only_with_the_same_units(self):
        scene, small = BLENDER / "sun.glb", ["--resolution", "16,9", "--spp", "4", "--quiet"]
        for name, options in (("a", []), ("b", ["--sample-offset", "4"]), ("c", ["--sample-offset", "8", "--lamp-units", "photometric"])):
            self.draw(scene, f"{name}.exr", *small, *options)
        self.assertEqual(json.loads(Exr(self.folder / "a.exr").texts["fragtrace:settings"])["lamp_units"], "radiometric")
        merge = lambda *names: run("merge", *(self.folder / f"{name}.exr" for name in names), "-o", self.folder / "m.exr")
        self.assertEqual(merge("a", "b").returncode, 0)
        self.assertIn("lamp units", merge("a", "c").stderr)

    def test_what_is_far_too_bright_or_too_dark_has_an_exposure(self):
        scene = lambda intensity: Model(GREY).box((1, 1, 1)).plate(4, translation=[0, -0.5, 0]).lamp("directional", intensity, **SUN).gltf.write(self.folder / "sun.gltf")
        for intensity, says in ((100000, "times as bright as middle grey: .png, .jpg and window have an exposure of -"), (3, None),
                                (1e-3, "times as dark as middle grey: .png, .jpg and window have an exposure of ")):
            said = self.draw(scene(intensity), "x.png", *FEW)
            self.assertTrue(says in said if says else "exposure" not in said, said)
            shown = brightness(self.folder / "x.png")
            self.assertTrue(40 < shown < 230, f"{intensity}: {shown}")
        # What is given wins, and a file of radiance has none.
        path = scene(1e-3)
        # An .exr keeps it for the .png that is made of it.
        self.draw(path, "raw.exr", *FEW, "--spp", 4, "--aov", "denoising")
        shown = {}
        for name, options in (("a.png", []), ("b.png", ["--exposure", Exr(self.folder / "raw.exr").texts["fragtrace:exposure"]]), ("c.png", ["--exposure", 0])):
            result = run("denoise", self.folder / "raw.exr", "-o", self.folder / name, "--denoise", "variance", "--no-dither", *options)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual("has an exposure of" in result.stderr, not options)
            shown[name] = read_png(self.folder / name)[2]
        self.assertEqual(shown["a.png"], shown["b.png"])
        self.assertNotEqual(shown["a.png"], shown["c.png"])
        for options in (["--exposure", "0"], ["--studio"]):
            self.assertNotIn("exposure of", self.draw(path, "y.png", *FEW, *options))
        self.draw(path, "x.pfm", *FEW)
        self.assertLess(max(floats((self.folder / "x.pfm").read_bytes().split(b"\n", 3)[3])), 0.01)

    def test_pictures_of_a_film_agree(self):
        """Each is as a single one at its time: by the file as it stands, where the lamp is near, not by its first picture."""
        model = Model(GREY).box((1, 1, 1)).lamp("point", 30000, translation=[0, 2, 3])
        model.gltf.moves(1, [0, 1], translation=[(0, 200, 0), (0, 400, 0)])
        scene = model.gltf.write(self.folder / "film.gltf")
        self.assertIn("they are divided by 683", self.draw(scene, "f#.pfm", *FEW, "--frames", "0:1", "--fps", "1", "--camera-orbit", "35,20"))
        said = self.draw(scene, "one.pfm", *FEW, "--animation-time", "1", "--camera-orbit", "35,20")
        self.assertIn("they are divided by 683", said)
        self.assertIn("there is light, too little for this exposure", said)


if __name__ == "__main__":
    main()

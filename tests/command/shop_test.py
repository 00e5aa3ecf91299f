#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Pictures for a page: its colour, alpha of glass and of what blends, the studio's looks, the ground, --shop."""
import json
import statistics
import struct

from support import SCENES, Case, Exr, main, quad, read_pfm, read_png, run

SIZE = ["--resolution", "48,48", "--quiet"]
FRONT = ["--camera-position", "0,0,4", "--camera-focal-point", "0,0,0", "--camera-parallel-scale", "2"]
BALL = {"type": "sphere", "sphere": {"radius": 1}}
MATT = {"pbrMetallicRoughness": {"metallicFactor": 0, "baseColorFactor": [0.8, 0.8, 0.8, 1]}}


class PageCase(Case):
    def ball(self, material=None, lights=()):
        gltf = quad(material or MATT)
        gltf["extensions"] = {"KHR_implicit_shapes": {"shapes": [BALL]}}
        if lights:
            gltf["extensions"]["KHR_lights_punctual"] = {"lights": [light for _, light in lights]}
        gltf["nodes"] = [{"extras": {"shape": 0, "material": 0}}]
        gltf["nodes"] += [node | {"extensions": {"KHR_lights_punctual": {"light": i}}} for i, (node, _) in enumerate(lights)]
        gltf["scenes"] = [{"nodes": list(range(len(gltf["nodes"])))}]
        for unused in ("cameras", "images", "textures"):
            del gltf[unused]
        return self.written(f"ball-{len(lights)}.gltf", gltf)

    def square(self, **material):
        """A square of two metres, seen from the front by FRONT."""
        return self.written("square.gltf", quad(material))

    def png(self, scene, *options, name="x.png"):
        """Rows of pixels of 8 bits."""
        self.renders(scene, "-o", self.folder / name, *SIZE, *options)
        width, _, rows, step = read_png(self.folder / name)
        return [[tuple(row[step * x:step * (x + 1)]) for x in range(width)] for row in rows]

    def exr(self, scene, *options):
        self.renders(scene, "-o", self.folder / "x.exr", *SIZE, *options)
        return Exr(self.folder / "x.exr")

    def edge(self, rows):
        return {tuple(pixel[:3]) for pixel in (*rows[0], *rows[-1], *(row[0] for row in rows), *(row[-1] for row in rows))}


class Page(PageCase):
    def test_a_page_has_exactly_its_colour(self):
        scene = self.ball()
        for color, seen in (("white", (255, 255, 255)), ("#1e90ff", (30, 144, 255)), ("#F80", (255, 136, 0)), ("RebeccaPurple", (102, 51, 153)),
                            ("0.5,0.5,0.5", (188, 188, 188))):
            for more in (["--exposure", 2, "--tone-map", "agx"], ["--no-dither"]):
                if color[0].isdigit():
                    more = [*more, "--no-dither"]  # no step of 8 bits
                self.assertEqual(self.edge(self.png(scene, "--spp", 4, "--background-color", color, *more)), {seen}, (color, more))

    def test_surfaces_are_as_without_a_page(self):
        options = ["--spp", 4, "--exposure", 0.5, "--no-dither"]
        with_page, without = (self.png(self.ball(), *options, *more)[24][24][:3] for more in (["--background-color", "white"], []))
        self.assertEqual(tuple(with_page), tuple(without))

    def test_edges_blend_light(self):
        """With the linear curve a page is what light over it is, as an .exr has it."""
        options = ["--spp", 16, "--background-color", "#4080ff", "--shadow-catcher", "bottom", "--studio", "--hdri-intensity", 0.2]
        shown = self.png(self.ball(), *options, "--tone-map", "linear", "--no-dither")
        light = self.exr(self.ball(), *options)
        for c, name in enumerate("RGB"):
            for row, linear in zip(shown, light.layers[name]):
                for pixel, value in zip(row, linear):
                    value = min(max(value, 0), 1)
                    self.assertAlmostEqual(pixel[c], 255 * (12.92 * value if value <= 0.0031308 else 1.055 * value**(1 / 2.4) - 0.055), delta=0.6)

    def test_an_exr_is_linear_and_three_numbers_are(self):
        for color, linear in (("#808080", 0.21586), ("white", 1), ("0.25,0.25,0.25", 0.25)):
            self.assertAlmostEqual(self.exr(self.ball(), "--spp", 1, "--background-color", color).layers["G"][0][0], linear, places=5)

    def test_other_options_take_names_too(self):
        named = self.exr(self.ball(), "--spp", 2, "--fog-density", 0.2, "--fog-color", "tomato", "--add-light", "sun color=#80ff00").values("R")
        numbers = self.exr(self.ball(), "--spp", 2, "--fog-density", 0.2, "--fog-color", "1,0.12477181851863861,0.063010014593601227",
                           "--add-light", "sun color=0.21586050093173981,1,0").values("R")
        self.assertEqual(list(named), list(numbers))

    def test_what_is_no_colour_is_said(self):
        for color, says in (("whit", "did you mean white?"), ("#12345", "is no colour such as #ff8000"), ("1,2", "three numbers"), ("1,x,1", "'x' is no number"),
                            ("-1,0,0", "in the range 0 to")):
            self.fails(2, "render", self.ball(), "-o", self.folder / "x.png", f"--background-color={color}", says=["--background-color: ", says])

    def test_a_filtered_shadow_on_a_page_is_smooth(self):
        """Its noise is gone in a .png with a page as it is without one."""
        options = ["--spp", 16, "--studio", "--shadow-catcher", "bottom", "--camera-orbit", "0,40", "--fit", "--denoise", "variance", "--no-dither"]
        rough = lambda rows: statistics.fmean(abs(row[x][1] - row[x + 1][1]) for row in rows[38:46] for x in range(10, 38))
        page = rough(self.png(self.ball(), *options, "--background-color", "white"))
        noisy = rough(self.png(self.ball(), *options[:-3], "--no-dither", "--background-color", "white"))
        self.assertLess(page, 0.7 * noisy)


class Alpha(PageCase):
    def test_display_is_the_default_of_a_shadow(self):
        options = ["--spp", 16, "--no-background", "--camera-orbit", "0,40", "--fit", "--seed", 3]
        alphas = {}
        for way in ((), ("--alpha", "display"), ("--alpha", "linear")):
            for catcher in ((), ("--shadow-catcher", "bottom")):
                alphas[way, catcher] = self.png(self.ball(), *options, *way, *catcher)
        display, linear, catcher = ("--alpha", "display"), ("--alpha", "linear"), ("--shadow-catcher", "bottom")
        self.assertEqual(alphas[(), catcher], alphas[display, catcher])
        self.assertNotEqual(alphas[(), catcher], alphas[linear, catcher])
        self.assertEqual(alphas[(), ()], alphas[linear, ()])
        self.assertNotEqual(alphas[(), ()], alphas[display, ()])

    def test_what_blends_is_filtered(self):
        """Without a stratified sequence, alpha of a half-transparent square is drawn by chance; a filter makes it even, and the colour with it."""
        scene = self.square(alphaMode="BLEND", pbrMetallicRoughness={"metallicFactor": 0, "baseColorFactor": [0.2, 0.4, 0.8, 0.5]})
        inner = lambda rows: [value for row in rows[16:32] for value in row[16:32]]
        by_chance = [*FRONT, "--spp", 32, "--disable", "sobol", "--denoise", "variance"]
        exr = self.exr(scene, *by_chance, "--no-background")
        self.assertLess(statistics.stdev(inner(exr.layers["A"])), 0.02)
        self.assertGreater(statistics.stdev(inner(exr.layers["noisy.A"])), 0.05)
        self.assertAlmostEqual(statistics.fmean(inner(exr.layers["A"])), 0.5, delta=0.02)
        # Light that lies over a page is as smooth.
        for page in (["--no-background"], ["--background-color", "white"]):
            rows = self.png(scene, *by_chance, *page, "--no-dither")
            self.assertLess(statistics.stdev(pixel[1] for pixel in inner(rows)), 4, page)

    def test_outlines_of_a_filtered_cut_out_have_no_dots(self):
        """Colours there are those of the ball around them, whatever the filter makes of colour and alpha apart."""
        exr = self.exr(self.ball(MATT | {"doubleSided": True}), "--studio", "--shadow-catcher", "bottom", "--no-background", "--spp", 64, "--denoise", "variance")
        color = {kind: [[red / alpha if alpha > 0 else 0 for red, alpha in zip(*rows)] for rows in zip(exr.layers[kind + "R"], exr.layers[kind + "A"])]
                 for kind in ("", "noisy.")}
        outline = [(x, y) for y in range(1, 47) for x in range(1, 47) if 0 < exr.layers["noisy.A"][y][x] < 1 and exr.layers["noisy.R"][y][x] > 0]
        self.assertGreater(len(outline), 40)
        for x, y in outline:
            around = [color["noisy."][v][u] for v in (y - 1, y, y + 1) for u in (x - 1, x, x + 1) if color["noisy."][v][u] > 0]
            self.assertGreater(color[""][y][x], 0.999 * min(around), (x, y))
            self.assertLess(color[""][y][x], 1.001 * max(around), (x, y))

    def glass(self, color=(1, 1, 1), roughness=0.0, ior=1.0):
        return {"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": roughness, "baseColorFactor": [*color, 1]},
                "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": ior}}, "doubleSided": True}

    def middle(self, exr, name):
        return statistics.fmean(value for row in exr.layers[name][20:28] for value in row[20:28])

    def test_alpha_of_glass_is_what_it_takes_away(self):
        """An index of 1 reflects nothing, so smooth and rough panes let pass their colour. Through them the surroundings are not seen."""
        for roughness, within in ((0.0, 1e-5), (0.5, 0.01)):
            scene = self.square(**self.glass((0.8, 0.5, 0.2), roughness))
            options = [*FRONT, "--spp", 256, "--default-light", "white", "--transparent-glass"]
            clear = self.exr(scene, *options, "--no-background")
            self.assertAlmostEqual(self.middle(clear, "A"), 0.5, delta=within, msg=roughness)
            for name in "RGB":
                self.assertAlmostEqual(self.middle(clear, name), 0, delta=within)
            page = self.exr(scene, *options, "--background-color", "0.5,1,2")
            for name, seen in zip("RGB", (0.4, 0.5, 0.4)):
                self.assertAlmostEqual(self.middle(page, name), seen, delta=2 * within)
            opaque = self.exr(scene, *options[:-1], "--no-background")
            self.assertEqual(self.middle(opaque, "A"), 1)

    def test_a_rough_pane_reflects_what_it_does_not_pass(self):
        """Neither rays nor light samples bring the surroundings behind it."""
        white = self.folder / "white.pfm"
        white.write_bytes(b"PF\n4 2\n-1.0\n" + struct.pack("<24f", *24 * [1.0]))
        exr = self.exr(self.square(**self.glass(roughness=0.6, ior=1.5)), *FRONT, "--spp", 512, "--hdri-file", white, "--no-background", "--transparent-glass")
        self.assertAlmostEqual(self.middle(exr, "G"), self.middle(exr, "A"), delta=0.02)
        self.assertLess(self.middle(exr, "A"), 0.3)

    def test_a_ball_of_glass_reflects_what_it_does_not_pass(self):
        """At the middle of a solid ball each face reflects 4 %."""
        solid = self.glass(ior=1.5)
        solid["extensions"]["KHR_materials_volume"] = {"thicknessFactor": 1}
        exr = self.exr(self.ball(solid), *FRONT, "--spp", 512, "--default-light", "white", "--no-background", "--transparent-glass")
        self.assertAlmostEqual(self.middle(exr, "A"), 1 - 0.96**2, delta=0.02)
        # All that is white around, and does not pass, comes back.
        self.assertAlmostEqual(self.middle(exr, "G"), self.middle(exr, "A"), delta=0.02)

    def test_the_shadow_is_seen_through_glass(self):
        """A pane without reflection before a ball and its shadow changes nothing."""
        gltf = json.loads(self.ball().read_text())
        pane = quad(self.glass())
        gltf["materials"].append(pane["materials"][0])
        gltf["meshes"][0]["primitives"][0]["material"] = 1
        gltf["nodes"].append({"mesh": 0, "translation": [0, 3.6, 8.1], "scale": [0.5, 0.5, 1]})
        gltf["scenes"][0]["nodes"].append(1)
        pane = self.written("pane.gltf", gltf)
        options = ["--camera-position", "0,4,9", "--camera-focal-point", "0,0,0", "--camera-view-angle", 30, "--spp", 64, "--no-background",
                   "--shadow-catcher", "-1", "--transparent-glass", "--studio", "--seed", 5]
        through, free = self.exr(pane, *options), self.exr(self.ball(), *options)
        part = lambda exr: statistics.fmean(value for row in exr.layers["A"][26:40] for value in row[8:40])
        self.assertGreater(part(free), 0.2)
        self.assertAlmostEqual(part(through), part(free), delta=0.05)


class StudioLooks(PageCase):
    def test_each_is_another_room(self):
        shown = {look: self.exr(self.ball(), *FRONT, "--spp", 64, "--studio-look", look) for look in ("soft", "white", "dark")}
        behind = {look: exr.layers["G"][0][0] for look, exr in shown.items()}
        self.assertGreater(behind["white"], 2 * behind["soft"])
        self.assertGreater(behind["soft"], 4 * behind["dark"])
        for look, exr in shown.items():
            # White has shading, and is burnt out nowhere.
            steps = statistics.quantiles([value for row in exr.layers["G"][17:31] for value in row[17:31]], n=20)
            self.assertLess(steps[-1], 1, look)
            self.assertGreater(steps[-1], 1.2 * steps[0], look)
        self.assertEqual(self.exr(self.ball(), "--spp", 2, "--studio").values("G"), self.exr(self.ball(), "--spp", 2, "--studio-look", "soft").values("G"))

    def test_a_look_turns_the_studio_on(self):
        sun = {"rotation": [-0.354, 0, 0, 0.935]}, {"type": "directional", "intensity": 3}
        lit = self.ball(lights=(sun,))
        both = [self.exr(lit, "--spp", 2, *more).values("G") for more in (["--studio", "--studio-look", "dark"], ["--studio-look", "dark"], [])]
        self.assertEqual(both[0], both[1])
        self.assertNotEqual(both[1], both[2])


class Ground(PageCase):
    OPTIONS = ["--spp", 64, "--studio", "--camera-orbit", "0,25", "--fit", "--fill", 0.5]

    def test_it_has_its_colour_and_the_scene_stands_on_it(self):
        exr = self.exr(self.ball(), *self.OPTIONS, "--ground", "#ff0000", "--aov", "object")
        free = self.exr(self.ball(), *self.OPTIONS, "--aov", "object")
        below = lambda name: statistics.fmean(exr.layers[name][-1])
        self.assertGreater(below("R"), 0.2)
        self.assertLess(below("G"), 0.2 * below("R"))  # what it mirrors is grey
        balls = lambda picture: [(x, y) for y, row in enumerate(picture.layers["object.Y"]) for x, value in enumerate(row) if value == 1]
        self.assertEqual(balls(exr), balls(free))
        self.assertGreater(max(exr.layers["object.Y"][-1]), 1)
        # The ball's shadow lies on it.
        self.assertLess(min(min(row) for row in exr.layers["R"][36:44]), 0.7 * max(exr.layers["R"][-1]))

    def test_a_smooth_one_mirrors(self):
        """A smooth black ground shows the ball, a rough one does not."""
        parts = [self.exr(self.ball(), *self.OPTIONS, "--ground", f"black,{roughness}") for roughness in ("0", "1")]
        sharpest = [max(abs(row[x] - row[x + 1]) for row in exr.layers["G"][38:] for x in range(47)) for exr in parts]
        self.assertGreater(sharpest[0], 2 * sharpest[1])

    def test_what_does_not_go_together_is_refused(self):
        out = ["render", self.ball(), "-o", self.folder / "x.png"]
        self.fails(2, *out, "--ground", "white", "--shadow-catcher", "bottom", says=["--ground: there is --shadow-catcher"])
        self.fails(2, *out, "--ground", "white,2", says=["--ground: '2' is no roughness"])
        self.fails(2, *out, "--ground", "2,0,0", says=["--ground: a colour is in the range 0 to 1"])


class Shop(PageCase):
    PARTS = ["--studio", "--background-color", "white", "--fill", "0.85", "--shadow-catcher", "bottom", "--transparent-glass", "--alpha", "display",
             "--quality", "good"]

    def test_it_is_its_parts(self):
        for name in ("x.png", "x.jpg", "x.exr"):
            shop, parts = (self.folder / name).with_stem("a"), (self.folder / name).with_stem("b")
            for path, options in ((shop, ["--shop"]), (parts, self.PARTS)):
                self.renders(self.ball(), "-o", path, *SIZE, *options)
            self.assertEqual(shop.read_bytes(), parts.read_bytes(), name)

    def test_the_page_is_white_and_the_model_fills_it(self):
        rows = self.png(self.ball(), "--shop")
        self.assertEqual(self.edge(rows), {(255, 255, 255)})
        places = [(x, y) for y, row in enumerate(self.exr(self.ball(), "--shop", "--spp", 16, "--aov", "object").layers["object.Y"]) for x, value in enumerate(row) if value]
        for axis in (0, 1):
            self.assertAlmostEqual(max(p[axis] for p in places) - min(p[axis] for p in places) + 1, 0.85 * 48, delta=1.5)
        # The ball casts a shadow next to it.
        ball = set(places)
        self.assertLess(min(rows[y][x][1] for y in range(30, 48) for x in range(48) if all((x + i, y + j) not in ball for i in (-1, 0, 1) for j in (-1, 0, 1))), 235)

    def test_what_the_user_gives_wins(self):
        self.assertEqual(self.edge(self.png(self.ball(), "--shop", "--background-color", "#ff0000")), {(255, 0, 0)})
        whole = self.png(self.ball(), "--shop", "--no-background")
        self.assertEqual({pixel[3] for pixel in whole[0]}, {0})
        stats = self.folder / "s.json"
        for own, expected in ((["--spp", 4], 4), (["--noise", 0.3, "--spp", 8], 8)):
            self.renders(self.ball(), "-o", self.folder / "x.png", *SIZE, "--shop", *own, "--stats", stats)
            self.assertEqual(json.loads(stats.read_text())["spp"], expected)
            self.assertNotIn("denoise", json.loads(stats.read_text()))
        for own in (["--fill", "0.5"], ["--ground", "white"], ["--sky"], ["--hdri-file", SCENES / "sky.pfm"], ["--fog-density", "0.1"], ["--default-light", "white"],
                    ["--camera-position", "0,0,9"], ["--camera-type", "panorama"], ["--studio-look", "dark"], ["--caustics", "on"], ["--shadow-catcher", "-2"],
                    ["--camera-parallel-scale", "2"], ["--quality", "draft"], ["--stage", "phong"], ["--alpha", "linear"]):
            result = run("render", self.ball(), "-o", self.folder / "x.png", *SIZE, "--spp", 4, "--shop", *own)
            self.assertEqual(result.returncode, 0, (own, result.stderr))


class Turned(PageCase):
    def lit(self, *options, scene=None):
        """The luminance of the left half of a white ball less that of the right one, in each picture of a turntable."""
        self.renders(scene or self.ball(), "-o", self.folder / "t.#.pfm", *SIZE, *FRONT, "--spp", 64, "--turntable", 4, *options)
        pictures = [read_pfm(self.folder / f"t.{k}.pfm") for k in range(4)]
        half = lambda picture, xs: statistics.fmean(picture[y][x][1] for y in range(16, 32) for x in xs)
        return [half(picture, range(14, 24)) - half(picture, range(24, 34)) for picture in pictures]

    def test_the_light_stays_before_the_camera(self):
        sun = {"rotation": [0, -0.354, 0, 0.935]}, {"type": "directional", "intensity": 3}
        for options, scene in ((["--studio"], None), (["--sky"], None), (["--default-light", "none"], self.ball(lights=(sun,)))):
            camera = self.lit(*options, scene=scene)
            turned = self.lit(*options, "--turn", "object", scene=scene)
            self.assertGreater(max(camera) - min(camera), 0.2, options)
            self.assertLess(max(turned) - min(turned), 0.05, options)
            self.assertAlmostEqual(turned[0], camera[0], delta=1e-6)

    def test_the_object_turns_as_the_camera_would_see_it(self):
        """What is seen is the same; only light differs."""
        for turn in ("camera", "object"):
            self.renders(SCENES / "plastics.gltf", "-o", self.folder / f"{turn}.#.exr", *SIZE, "--studio", "--spp", 1, "--turntable", 3, "--turn", turn, "--aov", "object")
        for k in range(3):
            camera, turned = (Exr(self.folder / f"{turn}.{k}.exr").layers["object.Y"] for turn in ("camera", "object"))
            self.assertEqual(camera, turned)

    def test_what_does_not_go_with_it_is_said(self):
        out = ["render", self.ball(), "-o", self.folder / "x#.png", *SIZE]
        self.fails(2, *out, "--turntable", 3, "--turn", "object", "--shutter", 180, says=["--shutter: not with --turn object"])

    def test_a_thinned_film_has_the_shutter_of_the_whole(self):
        for frames in ("4:4", "0:4:4"):
            self.renders(SCENES / "wheel.gltf", "-o", self.folder / f"{frames[0]}.#.pfm", *SIZE, "--spp", 2, "--fps", 8, "--shutter", 360, "--frames", frames)
        self.assertEqual((self.folder / "4.4.pfm").read_bytes(), (self.folder / "0.4.pfm").read_bytes())


if __name__ == "__main__":
    main()

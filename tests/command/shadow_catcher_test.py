#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The shadow catcher against a closed form and against ordinary renders of a white plane; means within 5 standard errors."""
import json
import math
import statistics
import struct
from pathlib import Path

from support import SCENES, SMALL, Case, Exr, Gltf, main, quad, run

BLACK = {"pbrMetallicRoughness": {"metallicFactor": 0, "baseColorFactor": [0, 0, 0, 1]},
         "extensions": {"KHR_materials_specular": {"specularFactor": 0}}}
WHITE = {"pbrMetallicRoughness": {"metallicFactor": 0}, "extensions": BLACK["extensions"]}
RADIUS, HEIGHT = 0.5, 0.8  # radius of the ball, and height of its middle above the ground
SIDE, HALF = 24, 1.8       # the picture from straight above: its pixels, and half of the side that it shows
FROM_ABOVE = ["--resolution", f"{SIDE},{SIDE}", "--camera-position", "0,9,0", "--camera-focal-point", "0,0,0", "--camera-view-up", "0,0,-1", "--camera-parallel-scale", str(HALF)]
SEEDS = 8


def place_of(x, y):
    return [HALF * (2 * c / SIDE - 1) for c in (x, y)]


def beside_the_ball():
    """Pixels that see the ground alone."""
    far = RADIUS + 2 * HALF / SIDE
    return [(x, y) for x in range(SIDE) for y in range(SIDE) if math.hypot(*place_of(x + 0.5, y + 0.5)) > far]


class CatcherCase(Case):
    ERRORS, BESIDE = 5, 0

    def scene(self, name, nodes, materials, lights=()):
        """Nodes next to those lights; shape 0 is the ball, mesh 0 the quad of quad()."""
        gltf = quad(materials[0])
        gltf["materials"] = materials
        gltf["extensions"] = {"KHR_implicit_shapes": {"shapes": [{"type": "sphere", "sphere": {"radius": RADIUS}}]}}
        if lights:
            gltf["extensions"]["KHR_lights_punctual"] = {"lights": [light for _, light in lights]}
        gltf["nodes"] = nodes + [node | {"extensions": {"KHR_lights_punctual": {"light": i}}} for i, (node, _) in enumerate(lights)]
        gltf["scenes"] = [{"nodes": list(range(len(gltf["nodes"])))}]
        for unused in ("cameras", "images", "textures"):
            del gltf[unused]
        return str(self.written(f"{name}.gltf", gltf).with_suffix(""))

    def ball(self, lights=()):
        return self.scene("ball", [{"translation": [0, HEIGHT, 0], "extras": {"shape": 0, "material": 0}}], [BLACK], lights)

    def near(self, means, expected):
        """The mean of the seeds' means."""
        self.assert_mean(means, expected, self.id(), known=2e-3 / expected)


class ShadowCatcher(CatcherCase):
    def test_a_ball_hides_what_geometry_says(self):
        """Under an even sky a ball with its middle at h hides h R^2 / d^3 of the light of a point at distance d."""
        white = self.folder / "white.pfm"
        white.write_bytes(b"PF\n4 2\n-1.0\n" + struct.pack("<24f", *24 * [1.0]))
        scene, parts = self.ball(), 8

        def hidden(x, y):
            places = [place_of(x + (i + 0.5) / parts, y + (j + 0.5) / parts) for i in range(parts) for j in range(parts)]
            return sum(HEIGHT * RADIUS**2 / (HEIGHT**2 + px * px + py * py)**1.5 for px, py in places) / parts**2

        pixels = beside_the_ball()
        near = [p for p in pixels if math.hypot(*place_of(p[0] + 0.5, p[1] + 0.5)) < 1]
        for sky in (["--default-light", "white"], ["--hdri-file", white], ["--hdri-file", white, "--disable", "light-sampling"]):
            shots = [self.picture(scene, "x.exr", *FROM_ABOVE, *sky, "--no-background", "--shadow-catcher", "0", "--spp", 256, "--seed", seed)
                     for seed in range(SEEDS)]
            self.assertEqual(max(max(map(abs, shots[0].layers[c][0])) for c in "RGB"), 0)
            for part in (pixels, near):
                self.near([sum(shot.layers["A"][y][x] for x, y in part) / len(part) for shot in shots],
                          sum(hidden(x, y) for x, y in part) / len(part))

    def moved(self, scene):
        """The ball goes a metre to the right in a second."""
        gltf = Gltf(json.loads(Path(scene + ".gltf").read_text()))
        gltf.moves(0, [0, 1], translation=[(0, HEIGHT, 0), (1, HEIGHT, 0)])
        return str(gltf.write(Path(scene + ".gltf")))

    def test_fit_shadow_holds_the_shadow(self):
        """The shadow is in the picture under the studio, under a low sun, from all sides, and for all frames. No pixel
        of the edge misses a tenth of the light."""
        sun = {"rotation": [-0.354, 0, 0, 0.935]}, {"type": "directional", "intensity": 3}
        for lights, options in (((), ["--studio"]), ((sun,), []), ((sun,), ["--camera-orbit", "180,60"])):
            alpha = self.picture(self.ball(lights), "x.exr", "--resolution", "48,48", "--spp", 64, "--no-background", "--shadow-catcher", "0.3", "--fit-shadow", *options).layers["A"]
            edge = [*alpha[0], *alpha[-1], *(row[0] for row in alpha), *(row[-1] for row in alpha)]
            self.assertLess(max(edge), 0.15, options)
            self.assertGreater(max(map(max, alpha)), 0.9)
        self.renders(self.moved(self.ball((sun,))), "-o", self.folder / "m.##.exr", "--quiet", "--resolution", "48,48", "--spp", 64,
                     "--no-background", "--shadow-catcher", "0.3", "--fit-shadow", "--frames", "0:1", "--fps", 1)
        for k in range(2):
            alpha = Exr(self.folder / f"m.{k:02}.exr").layers["A"]
            edge = [*alpha[0], *alpha[-1], *(row[0] for row in alpha), *(row[-1] for row in alpha)]
            self.assertLess(max(edge), 0.15, k)
            self.assertGreater(max(map(max, alpha)), 0.9)
        # From below, no shadow is seen, and none needs room; a long one is cut where the ball is still large.
        framed = ["--resolution", "48,48", "--spp", 1, "--no-background", "--fit-shadow", "--aov", "object", "--camera-orbit"]
        wide = lambda scene, *options: sum(max(column) > 0 for column in zip(*self.picture(scene, "x.exr", *framed, *options).layers["object.Y"]))
        below = ["30,-40", "--studio"]
        self.assertEqual(wide(self.ball(), *below, "--shadow-catcher", "0.3"), wide(self.ball(), *below))
        low = {"rotation": [-0.0436, 0, 0, 0.999]}, {"type": "directional", "intensity": 3}
        self.assertGreater(wide(self.ball((low,)), "90,30", "--shadow-catcher", "0.3"), 10)
        said = self.renders(self.ball() + ".gltf", "-o", self.folder / "v.png", *SMALL[:-1], "--fit", "--studio", "--verbose").stderr
        self.assertIn("--fit: the camera stands at --camera-position ", said)
        exr = self.picture(self.ball(), "x.exr", "--resolution", "48,48", "--spp", 4, "--no-background", "--fit", "--studio")
        self.assertGreater(max(exr.layers["A"][24][:3]) + max(exr.layers["A"][1]), 0)  # without a catcher, the ball alone fills it

    def test_fit_frames_the_object_whose_shadow_ends_before_the_edge(self):
        """The ball is as large and as much in the middle as without a shadow, which nothing cuts off. Copied options, parts and
        films have the same fade."""
        sun = {"rotation": [-0.354, 0, 0, 0.935]}, {"type": "directional", "intensity": 3}
        scene = self.ball((sun,))
        small = ["--resolution", "48,48", "--spp", 16, "--no-background", "--camera-orbit", "180,30"]
        places = lambda exr: [(x, y) for y, row in enumerate(exr.layers["object.Y"]) for x, value in enumerate(row) if value > 0]
        ball = self.picture(scene, "b.exr", *small, "--fit", "--fill", 0.6, "--aov", "object")
        caught = self.picture(scene, "c.exr", *small, "--fit", "--fill", 0.6, "--aov", "object", "--shadow-catcher", "0.3")
        self.assertEqual(places(ball), places(caught))
        alpha = caught.layers["A"]
        edges = lambda a: [*a[0], *a[-1], *(row[0] for row in a), *(row[-1] for row in a)]
        self.assertLess(max(edges(alpha)), 0.05)
        plain = self.picture(scene, "p.exr", *small, "--fit", "--fill", 0.6, "--shadow-catcher", "0.3", "--shadow-fade", 0).layers["A"]
        self.assertGreater(max(edges(plain)), 0.5)
        self.assertEqual([row[16:32] for row in alpha[16:32]], [row[16:32] for row in plain[16:32]])  # in the middle nothing fades
        self.renders(self.moved(scene), "-o", self.folder / "f.##.exr", "--quiet", *small, "--fit", "--fill", 0.6, "--shadow-catcher", "0.3",
                     "--frames", "0:1", "--fps", 1)
        self.assertLess(max(edges(Exr(self.folder / "f.00.exr").layers["A"])), 0.05)
        tile = self.picture(scene, "t.exr", *small, "--fit", "--fill", 0.6, "--shadow-catcher", "0.3", "--region", "0,24,48,24").layers["A"]
        self.assertEqual(tile, self.picture(scene, "c.exr", *small, "--fit", "--fill", 0.6, "--shadow-catcher", "0.3").layers["A"][24:])

    def test_the_fade_is_as_wide_as_the_margins(self):
        """Nothing fades before and behind the ball; next to its foot the shadow ends bit by bit, with round corners. --shadow-fade says it in numbers."""
        wide = ["--resolution", "96,48", "--spp", 16, "--no-background", "--camera-orbit", "0,30", "--fit", "--fill", 0.8, "--shadow-catcher", "0.3", "--studio"]
        shots = [self.picture(self.ball(), "x.exr", *wide, *more).layers["A"] for more in ([], ["--shadow-fade", 0], ["--shadow-fade", "0.6,0.1"], ["--shadow-fade", "0.1"])]
        left, given, one = ([[a / b if b > 0.001 else None for a, b in zip(*rows)] for rows in zip(shot, shots[1])] for shot in (shots[0], *shots[2:]))
        beside = (*range(26), *range(70, 95))
        steps = lambda rows: [abs(row[x] - row[x + 1]) for row in rows[6:42] for x in beside if row[x] is not None and row[x + 1] is not None]
        self.assertLess(max(steps(left)), 0.12)
        self.assertGreater(max(steps(one)), 0.25)
        self.assertLess(max(steps(given)), 0.12)
        self.assertTrue(all(share > 0.999 for row in left[8:40] for share in row[40:56] if share is not None))
        # No straight border: along the bottom the shadow ends sooner away from the middle, where the sides have room.
        middle, away = (statistics.fmean(given[44][x] for x in xs if given[44][x] is not None) for xs in (range(46, 50), (*range(31, 35), *range(61, 65))))
        self.assertGreater(middle, away + 0.02)

    def test_what_is_half_there_casts_half_a_shadow(self):
        """A sheet of alpha 0.5 lies over the camera."""
        sheet = {"mesh": 0, "rotation": [-0.70710678, 0, 0, 0.70710678], "scale": [1e4, 1e4, 1e4], "translation": [0, 1, 0]}
        half = BLACK | {"alphaMode": "BLEND", "doubleSided": True, "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 0.5]}}
        scene = self.scene("sheet", [sheet], [half], [({"rotation": [-0.7071, 0, 0, 0.7071]}, {"type": "directional", "intensity": 2})])
        exr = self.picture(scene, "x.exr", "--resolution", "16,16", "--camera-position", "0,0.5,0", "--camera-focal-point", "0,0,0", "--spp", 64,
                           "--no-background", "--shadow-catcher", "0", "--hdri-file", SCENES / "sky.pfm")
        mean = statistics.fmean(exr.values("A"))
        self.assertAlmostEqual(mean, 0.5, delta=5 * math.sqrt(0.5 / (16 * 16 * 64)))

    def glass(self, color, ior, **more):
        return {"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.3, "baseColorFactor": [*color, 1]}, "doubleSided": True,
                "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": ior}} | more}

    def under(self, scene, height, *light):
        """The mean of each channel that the catcher shows of white, straight under the middle of the scene."""
        exr = self.picture(scene, "x.exr", "--resolution", "16,16", "--camera-position", f"0,{height},0", "--camera-focal-point", "0,0,0", "--camera-view-angle", 5,
                           "--spp", 64, "--background-color", "1,1,1", "--shadow-catcher", "0", *light)
        return [statistics.fmean(exr.values(name)) for name in "RGB"]

    def test_glass_hides_what_it_reflects_and_absorbs(self):
        """A pane without reflection lets pass its colour, under a sun and under a sky; a ball, its two faces and what it absorbs on its diameter.
        Rough glass does the same."""
        sun = {"rotation": [-0.70710678, 0, 0, 0.70710678]}, {"type": "directional", "intensity": 2}
        pane = {"mesh": 0, "rotation": [-0.70710678, 0, 0, 0.70710678], "scale": [100, 100, 100], "translation": [20, 1, 0]}
        for lights, options in (([sun], []), ([], ["--hdri-file", SCENES / "sky.pfm"])):
            scene = self.scene("pane", [pane], [self.glass((0.8, 0.5, 0.2), 1)], lights)
            for seen, color in zip(self.under(scene, 0.5, *options), (0.8, 0.5, 0.2)):
                self.assertAlmostEqual(seen, color, delta=0.02 if options else 1e-4)
        solid = self.glass((1, 1, 1), 1.5, KHR_materials_volume={"thicknessFactor": 1, "attenuationDistance": 2 * RADIUS, "attenuationColor": [1, 0.5, 0.25]})
        ball = {"translation": [0, HEIGHT, 0], "extras": {"shape": 0, "material": 0}}
        for lights, options in (([sun], []), ([sun], ["--transparent-glass"])):
            for seen, absorbed in zip(self.under(self.scene("ball", [ball], [solid], lights), 0.25, *options), (1, 0.5, 0.25)):
                self.assertAlmostEqual(seen, 0.96**2 * absorbed, delta=0.002)
        # Under a white sky, the same along each direction from the point: the ball's face is met at an angle with the sine `off`.
        steps, sky = 2000, [0.0] * 3
        for i in range(steps):
            sine = (i + 0.5) / steps * RADIUS / HEIGHT
            off = HEIGHT * sine / RADIUS
            cosine, inner = math.sqrt(1 - off**2), math.sqrt(1 - (off / 1.5)**2)
            reflected = 0.5 * (((1.5 * cosine - inner) / (1.5 * cosine + inner))**2 + ((cosine - 1.5 * inner) / (cosine + 1.5 * inner))**2)
            for c, absorbed in enumerate((1, 0.5, 0.25)):
                sky[c] += (1 - (1 - reflected)**2 * absorbed**cosine) * 2 * sine * RADIUS / HEIGHT / steps
        for seen, hidden in zip(self.under(self.scene("ball", [ball], [solid]), 0.25, "--default-light", "white"), sky):
            self.assertAlmostEqual(seen, 1 - hidden, delta=0.003)

    def test_nothing_else_changes(self):
        """If nothing is in the way, the background keeps its bits, and surfaces are lit as without the catcher."""
        options = ["--resolution", "24,24", "--spp", "4", "--studio"]
        for traversal in (["--traversal", "iterative"], ["--traversal", "front-to-back"]):
            plain = self.picture("sphere-plane", "a.exr", *options, *traversal, "--aov", "albedo")
            caught = self.picture("sphere-plane", "b.exr", *options, *traversal, "--shadow-catcher", "bottom")
            for y in range(24):
                for x in range(24):
                    if plain.pixel(x, y, "albedo.R")[0] > 0.54:
                        self.assertEqual(plain.pixel(x, y, *"RGB"), caught.pixel(x, y, *"RGB"))
            above = self.picture("sphere-plane", "c.exr", *options, *traversal, "--shadow-catcher", "20", "--camera-position", "0,30,0",
                                 "--camera-focal-point", "0,0,9")
            hidden = self.picture("sphere-plane", "d.exr", *options, *traversal, "--camera-position", "0,30,0", "--camera-focal-point", "0,0,9",
                                  "--no-background", "--shadow-catcher", "20")
            self.assertLess(max(above.values("R")), 0.35)
            self.assertEqual(set(hidden.values("A")), {0})

    def test_settings_statistics_and_refusals(self):
        stats = self.folder / "s.json"
        exr = self.picture("sphere-plane", "x.exr", "--resolution", "8,8", "--spp", "1", "--shadow-catcher", "-0.25", "--schedule", "wavefront", "--stats", stats)
        settings = json.loads(exr.texts["fragtrace:settings"])
        self.assertEqual((settings["shadow_catcher"], settings["shadow_catcher_height"]), (True, -0.25))
        self.assertEqual(json.loads(stats.read_text())["schedule_reason"], "--shadow-catcher")
        scene = ["render", SCENES / "sphere-plane.gltf", "-o", self.folder / "x.pfm"]
        self.fails(2, *scene, "--shadow-catcher", "floor", says=["'floor'"])
        self.fails(2, *scene, "--shadow-catcher", "nan", says=["--shadow-catcher"])
        for told, options in (("emissive", []), ("stage gi", ["--stage", "shadows"])):
            result = self.renders(SCENES / "cornell-box.gltf", "-o", self.folder / "x.pfm", *SMALL[:-1], "--shadow-catcher", "bottom", *options)
            self.assertIn("warning: ", result.stderr)
            self.assertIn(told, result.stderr)


class CutOutShadow(CatcherCase):
    """Without a background a shadow is in alpha alone; filters and goals of noise look at the picture as laid over white."""
    VIEW = ["--resolution", "96,72", "--studio", "--no-background", "--shadow-catcher", "bottom"]

    def error_of_alpha(self, exr, reference):
        """Squared, where no surface is seen."""
        return sum((a - b)**2 for a, b, light in zip(exr.values("A"), reference.values("A"), reference.values("G")) if light == 0)

    def test_the_filter_takes_the_noise_out_of_alpha(self):
        reference = self.picture("mesh-15743", "r.exr", *self.VIEW, "--spp", 192, "--seed", 5)
        noisy = self.picture("mesh-15743", "n.exr", *self.VIEW, "--spp", 16, "--aov", "denoising")
        clean = self.picture("mesh-15743", "d.exr", *self.VIEW, "--spp", 16, "--denoise", "variance")
        self.assertLess(self.error_of_alpha(clean, reference), 0.25 * self.error_of_alpha(noisy, reference))
        self.assertAlmostEqual(sum(clean.values("A")) / sum(noisy.values("A")), 1, delta=0.003)
        self.assertEqual(clean.values("noisy.A"), noisy.values("A"))
        self.assertEqual(noisy.pixel(2, 70, *("denoising.albedo." + c for c in "RGBA"), "denoising.normal.Y"), (1,) * 5)
        # A pixel that a surface covers stays opaque, and a pixel without any hit stays transparent.
        for before, after in zip(noisy.values("A"), clean.values("A")):
            if before == 1:
                self.assertEqual(after, 1)
        self.assertEqual(run("denoise", self.folder / "n.exr", "-o", self.folder / "f.exr", "--denoise", "variance").returncode, 0)
        self.assertEqual(Exr(self.folder / "f.exr").values("A"), clean.values("A"))

    def test_the_variance_is_that_over_white(self):
        """The variance of the catcher's alpha is taken over many seeds, at pixels that show only the shadow."""
        options = [*self.VIEW, "--disable", "sobol", "--spp", 4, "--aov", "variance"]
        shots = [self.picture("mesh-15743", "v.exr", *options, "--seed", seed) for seed in range(12)]
        alphas, greens, variances = ([shot.values(name) for shot in shots] for name in ("A", "G", "variance.Y"))
        shadow = [i for i, alpha in enumerate(alphas[0]) if alpha > 0 and all(green[i] == 0 for green in greens)]
        told = sum(variance[i] for variance in variances for i in shadow) / len(shots)
        seen = sum(statistics.variance(alpha[i] for alpha in alphas) for i in shadow)
        self.assertAlmostEqual(told / seen, 1, delta=0.1)


class CatcherAndPlane(CatcherCase):
    def test_a_white_plane_with_and_without_the_ball(self):
        """Under a sky, a sun, a point light and a spot: what the catcher shows of white, times the light of a plane without the ball, is
        the light of the plane with it, channel by channel. The lights are so far away that they are even within a pixel."""
        sun = {"rotation": [-0.6, 0.1, 0, 0.79]}, {"type": "directional", "intensity": 0.6, "color": [1, 0.5, 0.2]}
        point = {"translation": [2, 5, 1]}, {"type": "point", "intensity": 20, "color": [0.2, 0.6, 1]}
        spot = {"translation": [-3, 6, 0], "rotation": [-0.7071, 0, 0, 0.7071]}, {"type": "spot", "intensity": 30, "spot": {"outerConeAngle": 0.9}}
        ball = {"translation": [0, HEIGHT, 0], "extras": {"shape": 0, "material": 1}}
        ground = {"mesh": 0, "rotation": [-0.70710678, 0, 0, 0.70710678], "scale": [40, 40, 40]}
        pixels = beside_the_ball()
        for sky, lights, samples in ((["--hdri-file", SCENES / "sky.pfm", "--hdri-rotation", "50"], [], 64), ([], [sun], 16), ([], [point], 16), ([], [spot], 16),
                                     (["--hdri-file", SCENES / "sun-sky.pfm"], [sun], 128)):
            beside = self.scene("with", [ground, ball], [WHITE, BLACK], lights)
            free = self.scene("without", [ground], [WHITE], lights)
            ratios = [[], [], []]
            for seed in range(SEEDS):
                shots = [(self.ball(lights), ["--shadow-catcher", "0", "--background-color", "1,1,1"]), (beside, []), (free, [])]
                caught, lit, unhidden = (self.picture(scene, "x.pfm", *FROM_ABOVE, *sky, "--spp", samples, "--seed", 3 * seed + i, *more)
                                         for i, (scene, more) in enumerate(shots))
                for c in range(3):
                    ratios[c].append(sum(caught[y][x][c] * unhidden[y][x][c] for x, y in pixels) / sum(lit[y][x][c] for x, y in pixels))
            for c in range(3):
                self.near(ratios[c], 1)


if __name__ == "__main__":
    main()

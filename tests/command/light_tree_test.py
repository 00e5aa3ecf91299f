#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Lights that are chosen by a tree, by power and all alike: white matt ground under 49 lamps of powers from 1 to 100, point lights and
spots, whose irradiance is a closed form: none of them hides another. Means of 8 seeds lie within 5 standard errors."""
import functools
import itertools
import json
import math
import statistics

from known_light_test import MATT, SPECULAR, from_lamp, over_ground
from support import SCENES, Case, main, quad, run

SELECTIONS = ("tree", "power", "uniform")
SEEDS = range(1, 9)
WIDE = 12  # half of the width of the ground; the camera sees the middle of it, 2 m wide
LAMPS = [((1.5 * (i - 3) + 0.1 * j, 1.5 * (j - 3), 1.2), 0.06 + 0.01 * ((i + 2 * j) % 5), 100**(((5 * i + 3 * j) % 8) / 7))
         for i in range(7) for j in range(7)]
POINTS = [((0.4 - 1.1 * k, 0.7 * k - 0.9, 0.5 + 0.15 * k), 0.2 + 0.3 * k) for k in range(4)]
SPOTS = [((-0.8 + 0.9 * k, 0.5 - 0.6 * k, 1.1), 0.6, 0.2 + 0.1 * k, 0.5 + 0.1 * k) for k in range(3)]


@functools.cache
def irradiance(x, y):
    total = 0.0
    for (px, py, pz), half, radiance in LAMPS:
        total += radiance * from_lamp(x, y, [(px + half * a, py + half * b, pz) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
    for place, intensity in POINTS:
        total += intensity * place[2] / math.dist(place, (x, y, 0))**3
    for place, intensity, inner, outer in SPOTS:
        distance = math.dist(place, (x, y, 0))
        cosine = place[2] / distance
        cone = (cosine - math.cos(outer)) / (math.cos(inner) - math.cos(outer))
        total += intensity * min(max(cone, 0), 1)**2 * cosine / distance**2
    return total


class LightTree(Case):
    ERRORS, KNOWN = 5, 1

    def scene(self):
        gltf = quad({"pbrMetallicRoughness": MATT, "extensions": SPECULAR})
        gltf["nodes"][0]["scale"] = [WIDE, WIDE, 1]
        primitive = gltf["meshes"][0]["primitives"][0]
        for place, half, radiance in LAMPS:
            gltf["materials"].append({"pbrMetallicRoughness": MATT | {"baseColorFactor": [0, 0, 0, 1]}, "emissiveFactor": [1, 1, 1],
                                      "extensions": SPECULAR | {"KHR_materials_emissive_strength": {"emissiveStrength": radiance}}})
            gltf["nodes"].append({"mesh": len(gltf["meshes"]), "translation": place, "rotation": [1, 0, 0, 0], "scale": [half, half, 1]})
            gltf["meshes"].append({"primitives": [dict(primitive, material=len(gltf["materials"]) - 1)]})
        lights, places = [], []
        for place, intensity in POINTS:
            lights.append({"type": "point", "intensity": intensity})
            places.append({"translation": place})
        for place, intensity, inner, outer in SPOTS:
            lights.append({"type": "spot", "intensity": intensity, "spot": {"innerConeAngle": inner, "outerConeAngle": outer}})
            places.append({"translation": place})
        gltf["nodes"] += [place | {"extensions": {"KHR_lights_punctual": {"light": i}}} for i, place in enumerate(places)]
        gltf["extensions"] = {"KHR_lights_punctual": {"lights": lights}}
        gltf["scenes"] = [{"nodes": list(range(len(gltf["nodes"])))}]
        return str(self.written("lamps.gltf", gltf).with_suffix(""))

    def means(self, scene, *options, spp=32, seeds=SEEDS):
        pictures = [self.picture(scene, "x.pfm", "--resolution", "48,48", "--spp", spp, "--seed", seed, "--bounces", 1, *options) for seed in seeds]
        return [statistics.fmean(pixel[0] for row in picture for pixel in row) for picture in pictures]

    def test_all_of_them_have_the_same_mean(self):
        scene = self.scene()
        expected = over_ground(irradiance) / math.pi
        errors = {name: self.assert_mean(self.means(scene, "--light-selection", name), expected, name) for name in SELECTIONS}
        self.assertLess(errors["tree"], 0.002)

    def test_a_light_sample_of_several_has_the_same_mean(self):
        scene = self.scene()
        expected = over_ground(irradiance) / math.pi
        # One picture each: its standard error, of 8 seeds, is a fifth of what it may be off.
        for name, spp, within in (("tree", 32, 0.004), ("power", 128, 0.014)):
            for reuse in ("candidates", "spatial"):
                seen = self.means(scene, "--light-selection", name, "--light-reuse", reuse, spp=spp, seeds=[1])
                self.assert_near(statistics.fmean(seen), expected, f"{reuse} by {name}", within)

    def test_candidates_in_every_block_of_a_picture(self):
        """500 independent passes of one sample, with candidates and without: in blocks of 8 x 8 pixels the means differ as their
        variances say; 24 blocks, chance 1e-5 each way. Welch's test, which finds one block of them, too, says the same."""
        self.assert_blocks_alike("many-lights")
        self.assert_blocks_alike("rough-glass", "--hdri-file", SCENES / "sun-sky.pfm")

    def assert_blocks_alike(self, scene, *options):
        size = ("--resolution", "48,32", "--spp", 500, "--disable", "sobol", "--aov", "variance", *options)
        pictures = [self.picture(str(SCENES / scene), f"{name}.exr", *size, "--light-reuse", name, "--seed", seed)
                    for seed, name in enumerate(("none", "candidates"))]
        (means, others), (noise, less) = ([picture.luminances() for picture in pictures], [picture.values("variance.Y") for picture in pictures])
        squares = []
        for top in range(0, 32, 8):
            for left in range(0, 48, 8):
                block = [48 * y + x for y in range(top, top + 8) for x in range(left, left + 8)]
                difference = sum(means[i] - others[i] for i in block)
                squares.append(difference**2 / sum(noise[i] + less[i] for i in block))
        mean = statistics.fmean(squares)
        print(f"{scene}: blocks: mean z^2 {mean:.3f}, largest {max(squares):.1f}")
        self.assertLess(mean, 2.75, scene)
        self.assertGreater(mean, 0.195, scene)
        files = (self.folder / f"{name}.exr" for name in ("none", "candidates"))
        told = run("diff", *files, "--metric", "bias", "--tile", 8).stdout
        self.assertIn("24 of 24 tiles", told)
        self.assertGreater(float(told.splitlines()[0]), 1e-5, told)

    def test_neighbours_in_every_block_of_a_picture(self):
        """500 independent passes of one sample in 10 parts, with neighbours and without. Pixels near each other err alike, so that the sum of z^2 over
        blocks of 8 x 8 is compared with those of all signs that the parts' differences could have had: among the largest 1 % of 512 by a chance of 1 %."""
        self.assert_parts_alike("many-lights")
        self.assert_parts_alike("rough-glass", "--hdri-file", SCENES / "sun-sky.pfm")

    def assert_parts_alike(self, scene, *options):
        def blocks(name, seed):
            picture = self.picture(str(SCENES / scene), "x.exr", "--resolution", "48,32", "--spp", 50, "--disable", "sobol", "--light-reuse", name, "--seed", seed, *options)
            y = picture.luminances()
            return [sum(y[48 * (top + i) + left + j] for i in range(8) for j in range(8)) for top in range(0, 32, 8) for left in range(0, 48, 8)]
        parts = [[a - b for a, b in zip(blocks("none", seed), blocks("spatial", 100 + seed))] for seed in range(10)]
        squares = [sum(part[k]**2 for part in parts) for k in range(24)]
        def sum_of(signs):
            return sum(sum(sign * part[k] for sign, part in zip(signs, parts))**2 / squares[k] for k in range(24))
        seen = sum_of([1] * 10)
        larger = sum(sum_of((1,) + signs) >= seen for signs in itertools.product((1, -1), repeat=9))
        print(f"{scene}: neighbours: mean z^2 {seen / 24:.3f}, {larger} of 512 are as large")
        self.assertGreater(larger, 5, scene)

    def test_the_tree_knows_which_lamps_are_near(self):
        """The variance of a pixel is lower than by power, by what the lamps that are far away no longer take."""
        scene = self.scene()
        noise = {}
        for name in SELECTIONS:
            a, b = (self.picture(scene, "x.pfm", "--resolution", "48,48", "--spp", 4, "--seed", seed, "--light-selection", name) for seed in (1, 2))
            noise[name] = statistics.fmean((p[0] - q[0])**2 for r, s in zip(a, b) for p, q in zip(r, s))
        print({name: round(value / noise["power"], 3) for name, value in noise.items()})
        self.assertLess(noise["tree"], 0.4 * noise["power"])

    def test_statistics_say_what_was_chosen_and_why(self):
        def chosen(scene, *options):
            self.picture(scene, "x.pfm", "--spp", 1, "--resolution", "8,8", "--stats", self.folder / "stats.json", *options)
            stats = json.loads((self.folder / "stats.json").read_text())
            return stats.get("light_selection"), stats.get("light_selection_reason"), "light-tree" in stats["variant"].split("+")
        scene = self.scene()
        name, reason, tree = chosen(scene)
        self.assertEqual((name, tree), ("tree", True))
        self.assertRegex(reason, r"^chosen by place, light samples vary [\d.]+ times less$")
        for name in SELECTIONS:
            self.assertEqual(chosen(scene, "--light-selection", name), (name, "--light-selection", name != "power"))
        for name, part in (("none", set()), ("candidates", {"light-candidates"}), ("spatial", {"neighbours"})):
            self.picture(scene, "x.pfm", "--spp", 1, "--resolution", "8,8", "--stats", self.folder / "stats.json", "--light-reuse", name)
            stats = json.loads((self.folder / "stats.json").read_text())
            self.assertEqual((stats["light_reuse"], {"light-candidates", "neighbours"} & set(stats["variant"].split("+"))), (name, part))
        # One lamp, of two triangles: nothing to choose from afar.
        self.assertEqual(chosen("cornell-box")[0], "power")
        self.assertEqual(chosen(scene, "--stage", "shadows")[0], None)

    def test_schedules_draw_the_same_bits(self):
        for scene, options in (("many-lights", ["--light-selection", "tree", "--light-reuse", "candidates"]), ("lights", ["--light-selection", "uniform"]),
                               ("many-lights", ["--light-reuse", "spatial"]), ("lights", ["--light-reuse", "spatial", "--dispatch", "compute"])):
            a, b = (self.picture(scene, "x.pfm", "--resolution", "40,30", "--spp", 3, "--schedule", schedule, *options)
                    for schedule in ("megakernel", "wavefront"))
            self.assertEqual(a, b, scene)

    def test_neighbours_are_of_the_same_pass_of_the_whole_picture(self):
        for options, why in ((["--region", "0,0,4,4"], "pixels take light from others"), (["--noise", 0.1], "as many samples"),
                             (["--time", 1], "as many samples"), (["--denoise", "variance"], "for the picture"), (["--aov", "diffuse"], "add up")):
            self.fails(2, "render", SCENES / "many-lights.gltf", "-o", self.folder / "x.exr", "--light-reuse", "spatial", *options,
                       says=("--light-reuse spatial: ", why))
        self.fails(2, "render", SCENES / "many-lights.gltf", "-o", self.folder / "x.exr", "--light-reuse", "spatial", "--resolution", "400,300",
                   "--memory-limit", "16MB", says=("--light-reuse spatial: ", "400 x 300 pixels", "in parts"))

    def test_a_picture_is_the_sum_of_its_passes(self):
        """Passes do not know each other: two that are drawn apart are those that are drawn together."""
        options = ("--resolution", "24,16", "--light-reuse", "spatial")
        both = self.picture("many-lights", "x.pfm", "--spp", 2, *options)
        first, second = (self.picture("many-lights", "x.pfm", "--spp", 1, "--sample-offset", i, *options) for i in (0, 1))
        for row, a, b in zip(both, first, second):
            for pixel, p, q in zip(row, a, b):
                for c, x, y in zip(pixel, p, q):
                    self.assertAlmostEqual(c, (x + y) / 2, delta=1e-6 + 1e-6 * abs(c))


if __name__ == "__main__":
    main()

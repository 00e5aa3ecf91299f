#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""--caustics: light that lamps send by way of smooth metal and glass onto matt ground, against closed forms: that of a mirror is what
the mirrored lamp sends, that of a slab of glass follows from Snell and Fresnel. The mean of one picture lies within 1 % of it, or the part that is
given, which is about 4.5 standard errors (of 6 seeds)."""
import json
import math
import shutil
import statistics
import struct
from pathlib import Path

from support import SCENES, SHADERS, Case, Gltf, luminances, main, mean, quad, run
import geometry
from gltf_writer import GltfWriter
from known_light_test import MATT, SPECULAR, from_lamp, over_ground
from scene_parts import place_quad

WIDE = 2.5    # half of the width of the ground
MIRROR = 1.1  # the mirror stands at x = -MIRROR, just next to what the camera sees
POINT = (-0.8, 0.1, 0.9)
INTENSITY = 3.0
CORNERS = ((-1, -1), (1, -1), (1, 1), (-1, 1))
LAMP = ((-0.7, -0.1, 1.1), 0.2, 20.0)   # middle, half of its width, radiance
SUN = (1.1, 2.0)                       # angle to the vertical, irradiance
CONE = (0.5, 1.1)                      # cone angles of the spot
UP = ((1.5, 0.0, 0.3), 0.35, 20.0)     # a lamp next to the picture that faces away from the ground; as LAMP
ABOVE = 1.0                            # height of the mirror over it, whose front faces the ground
VIEW = 2.2 * math.tan(0.45)            # half of the width of what the camera sees
BACK = [-math.sqrt(0.5), 0, 0, math.sqrt(0.5)]
TURN = [0, math.sqrt(0.5), 0, math.sqrt(0.5)]  # +z to +x
OVER = [1, 0, 0, 0]                            # +z to -z
SMALL = ("--resolution", "32,32")
ON = ("--caustics", "on")  # pictures of wide lamps are too short for light paths here


def from_point(place, x, y):
    return place[2] / math.dist(place, (x, y, 0))**3


def mirrored(place):
    return (-2 * MIRROR - place[0], *place[1:])


def mirrored_above(place):
    return (*place[:2], 2 * ABOVE - place[2])


def reflectance(cosine, eta):
    """Fresnel's, of unpolarised light that enters what is eta times as dense."""
    inside = math.sqrt(1 - (1 - cosine * cosine) / eta**2)
    s, p = (cosine - eta * inside) / (cosine + eta * inside), (eta * cosine - inside) / (eta * cosine + inside)
    return (s * s + p * p) / 2


def through_slab(light, air, thick, eta):
    """Irradiance, a function of the distance from below a point light: what a slab lets through after 0, 2, 4, ... reflections in it."""
    def landed(sine, turns):
        """Returns the distance at which a ray lands."""
        return air * sine / math.sqrt(1 - sine**2) + turns * thick * sine / math.sqrt(eta**2 - sine**2)

    def irradiance(r):
        total = 0.0
        for turns in (1, 3, 5, 7):
            low, high = 0.0, 1 - 1e-9
            for _ in range(60):
                middle = (low + high) / 2
                low, high = (middle, high) if landed(middle, turns) < r else (low, middle)
            cosine = math.sqrt(1 - low**2)
            # A ring of angles, d(solid angle) = 2 pi sine / cosine d(sine), lands on a ring of the ground.
            step = 1e-5
            grows = (landed(low + step, turns) - landed(max(low - step, 0), turns)) / (low + step - max(low - step, 0))
            lost = reflectance(cosine, eta)
            total += light * (1 - lost)**2 * lost**(turns - 1) * (low / r if r > 1e-6 else 1 / grows) / (cosine * grows)
        return total
    return irradiance


class Caustics(Case):
    def scene(self, name, *things, lights=(), ground=WIDE):
        """Matt ground and quads of half a width of 1, each with a material, and what its node says."""
        gltf = quad({"pbrMetallicRoughness": MATT, "extensions": SPECULAR})
        gltf["nodes"][0]["scale"] = [ground, ground, 1]
        primitive = gltf["meshes"][0]["primitives"][0]
        for material, place in things:
            gltf["materials"].append(material)
            gltf["nodes"].append({"mesh": len(gltf["meshes"]), **place})
            gltf["meshes"].append({"primitives": [dict(primitive, material=len(gltf["materials"]) - 1)]})
        gltf["extensions"] = {"KHR_lights_punctual": {"lights": [light for light, _ in lights]}}
        gltf["nodes"] += [place | {"extensions": {"KHR_lights_punctual": {"light": i}}} for i, (_, place) in enumerate(lights)]
        gltf["scenes"] = [{"nodes": list(range(len(gltf["nodes"])))}]
        return str(self.written(f"{name}.gltf", gltf).with_suffix(""))

    @staticmethod
    def mirror():
        return ({"pbrMetallicRoughness": {"metallicFactor": 1, "roughnessFactor": 0}},
                {"translation": [-MIRROR, 0, 0.45], "rotation": TURN, "scale": [1.2, 1.2, 1]})

    @staticmethod
    def above(x, half, material=None):
        """A mirror over the ground, which the camera looks through from behind."""
        return (material or {"pbrMetallicRoughness": {"metallicFactor": 1, "roughnessFactor": 0}},
                {"translation": [x, 0, ABOVE], "rotation": OVER, "scale": [half, half, 1]})

    @staticmethod
    def lamp(like=LAMP, rotation=OVER):
        middle, half, radiance = like
        return ({"pbrMetallicRoughness": MATT | {"baseColorFactor": [0, 0, 0, 1]}, "emissiveFactor": [1, 1, 1],
                 "extensions": SPECULAR | {"KHR_materials_emissive_strength": {"emissiveStrength": radiance}}},
                {"translation": middle, "rotation": rotation, "scale": [half, half, 1]})

    def lamp_above(self):
        return self.lamp(UP, [0, 0, 0, 1])

    def assert_parts(self, scene, light, what, spp, *options):
        """The halves of the picture and its middle; light: radiance at a place of the ground."""
        fine = [VIEW * ((i + 0.5) / 64 - 1) for i in range(128)]
        wanted = [[light(x, y) for x in fine] for y in fine]
        picture = self.picture(scene, "x.pfm", *SMALL, *ON, "--spp", spp, "--bounces", 1, *options)
        self.assert_near(mean(picture), statistics.fmean(value for row in wanted for value in row), what, 0.012)
        for name, part in (("left", lambda rows: [row[:len(row) // 2] for row in rows]), ("right", lambda rows: [row[len(row) // 2:] for row in rows]),
                           ("upper", lambda rows: rows[:len(rows) // 2]), ("lower", lambda rows: rows[len(rows) // 2:]),
                           ("middle", lambda rows: [row[len(row) // 4:-len(row) // 4] for row in rows[len(rows) // 4:-len(rows) // 4]])):
            expected = statistics.fmean(value for row in part(wanted[::-1]) for value in row)
            self.assert_near(mean(part(picture)), expected, f"{what}, {name}", 0.03)

    def luminances(self, scene, *options, spp=64, bounces=1):
        return luminances(self.picture(scene, "x.pfm", *SMALL, *ON, "--spp", spp, "--bounces", bounces, *options))

    def seen(self, scene, *options, **more):
        return statistics.fmean(self.luminances(scene, *options, **more))

    def assert_alike(self, scene, what, from_camera, with_light, bounces=1, known=0.005, options=()):
        """Camera paths alone, of so many samples, and light paths with them bring the same; returns what."""
        camera = self.luminances(scene, *options, "--caustics", "off", spp=from_camera, bounces=bounces)
        light = self.luminances(scene, *options, "--seed", 2, spp=with_light, bounces=bounces)
        self.assert_same_light(light, camera, what, known)
        return statistics.fmean(light)

    def point_and_mirror(self):
        return self.scene("point", self.mirror(), lights=[({"type": "point", "intensity": INTENSITY}, {"translation": POINT})])

    def test_a_mirror_shows_the_ground_a_second_lamp(self):
        scene = self.point_and_mirror()
        direct = INTENSITY / math.pi * over_ground(lambda x, y: from_point(POINT, x, y))
        both = direct + INTENSITY / math.pi * over_ground(lambda x, y: from_point(mirrored(POINT), x, y))
        self.assert_near(self.seen(scene, spp=768), both, "point", 0.005)
        self.assert_near(self.seen(scene, "--caustics", "off", spp=4), direct, "point, from the camera alone", 1e-3)
        self.assert_near(self.seen(scene, spp=4, bounces=0), direct, "point, one scattering less", 1e-3)

    def test_every_filter_and_camera_weighs_alike(self):
        scene = self.point_and_mirror()

        def light(x, y):
            return INTENSITY / math.pi * (from_point(POINT, x, y) + from_point(mirrored(POINT), x, y))
        for kind in ("gaussian", "blackman-harris"):
            # Next to the picture's edges the filter sees what the mean leaves out.
            self.assert_near(self.seen(scene, "--pixel-filter", kind, spp=256), over_ground(light), kind, 0.006)
        self.assert_near(self.seen(scene, "--camera-parallel-scale", 2.2 * math.tan(0.45), spp=768), over_ground(light), "orthographic", 0.004)

    def test_a_lens_blurs_caustics_as_all_else(self):
        """Columns of the picture of a small mirror's light, far out of focus, with light paths and without."""
        columns = {}
        scene = self.scene("patch", self.above(0.8, 0.25), self.lamp_above())
        for caustics, spp in (("on", 16), ("off", 48)):
            pictures = [self.picture(scene, "x.pfm", *SMALL, "--spp", spp, "--seed", seed, "--bounces", 1, "--caustics", caustics,
                                     "--f-stop", "0.05", "--focus-distance", "1.2") for seed in range(1, 7)]
            columns[caustics] = [[statistics.fmean(row[x][0] for row in picture) for picture in pictures] for x in range(len(pictures[0][0]))]
        squares = [(statistics.fmean(a) - statistics.fmean(b))**2 * len(pictures) / (statistics.variance(a) + statistics.variance(b))
                   for a, b in zip(columns["on"], columns["off"])]
        # The mean of t^2 with 10 degrees of freedom is 10 / 8; its standard error here is about 0.4.
        print(f"columns: {statistics.fmean(squares):.2f}")
        self.assertLess(statistics.fmean(squares), 10 / 8 + 4 * 0.4)

    def test_panoramas_fisheyes_and_shifts(self):
        scene = self.scene("patch", self.above(0.8, 0.25), self.lamp_above())
        for options in (("--camera-type", "panorama"), ("--camera-type", "fisheye", "--camera-view-angle", "60"), ("--lens-shift", "0.2,0.1")):
            # All light in the fisheye is the mirror's.
            self.assert_alike(scene, " ".join(options), 1152, 384, options=options, known=0.011)

    def test_a_spot_and_the_sun(self):
        aim = {"translation": POINT, "rotation": [0, -math.sin(math.pi / 8), 0, math.cos(math.pi / 8)]}
        # The axis of a spot that is turned towards the mirror.
        axis = (math.sin(math.pi / 4), 0, -math.cos(math.pi / 4))
        spot = {"type": "spot", "intensity": INTENSITY, "spot": {"innerConeAngle": CONE[0], "outerConeAngle": CONE[1]}}

        def cone(place, axis, x, y):
            distance = math.dist(place, (x, y, 0))
            cosine = (axis[0] * (x - place[0]) - axis[1] * place[1] - axis[2] * place[2]) / distance
            part = (cosine - math.cos(CONE[1])) / (math.cos(CONE[0]) - math.cos(CONE[1]))
            return min(max(part, 0), 1)**2 * from_point(place, x, y)

        def from_spot(x, y):
            return cone(POINT, (-axis[0], 0, axis[2]), x, y) + cone(mirrored(POINT), axis, x, y)
        aim["rotation"] = [0, math.sin(math.pi / 8), 0, math.cos(math.pi / 8)]
        scene = self.scene("spot", self.mirror(), lights=[(spot, aim)])
        self.assert_near(self.seen(scene, spp=512), INTENSITY / math.pi * over_ground(from_spot), "spot", 0.015)
        angle, irradiance = SUN
        sun = {"type": "directional", "intensity": irradiance}
        scene = self.scene("sun", self.mirror(), lights=[(sun, {"rotation": [0, math.sin(angle / 2), 0, math.cos(angle / 2)]})])
        self.assert_near(self.seen(scene, spp=256), 2 * irradiance * math.cos(angle) / math.pi, "sun")

    def test_an_area_lamp_with_light_paths_and_without(self):
        scene = self.scene("lamp", self.mirror(), self.lamp())
        (mx, my, mz), half, radiance = LAMP
        corners = [(mx + half * a, my + half * b, mz) for a, b in CORNERS]
        expected = radiance / math.pi * over_ground(
            lambda x, y: from_lamp(x, y, corners) + from_lamp(x, y, [mirrored(c) for c in corners]))
        self.assert_near(self.seen(scene, spp=512), expected, "lamp", 0.004)
        self.assert_near(self.seen(scene, "--caustics", "off", spp=512), expected, "lamp, from the camera alone", 0.015)

    def test_a_lamp_whose_caustic_is_all_its_light(self):
        """It faces away from the ground, towards a mirror over it."""
        scene = self.scene("up", self.above(0.9, 1.0), self.lamp_above())
        (mx, my, mz), half, radiance = UP
        image = [mirrored_above((mx + half * a, my + half * b, mz)) for a, b in CORNERS]
        self.assert_parts(scene, lambda x, y: radiance / math.pi * from_lamp(x, y, image), "lamp", 3072)

    def test_where_a_small_mirror_throws_a_spot(self):
        place, middle, half = UP[0], 0.88, 0.2
        image = mirrored_above(place)
        spot = {"type": "spot", "intensity": INTENSITY, "spot": {"innerConeAngle": 1.2, "outerConeAngle": 1.3}}
        scene = self.scene("spot", self.above(middle, half), lights=[(spot, {"translation": place, "rotation": OVER})])

        def light(x, y):
            part = 1 - ABOVE / image[2]
            passes = abs(image[0] + part * (x - image[0]) - middle) < half and abs(part * y) < half
            return INTENSITY / math.pi * from_point(image, x, y) if passes else 0.0
        self.assert_parts(scene, light, "patch", 320)
        self.assert_parts(scene, light, "patch in focus", 320, "--f-stop", "0.05", "--focus-distance", "2.2")

    def test_a_slab_of_glass_and_the_reflections_in_it(self):
        slab = {"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0},
                "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.8},
                               "KHR_materials_volume": {"thicknessFactor": 1}}}
        faces = [(slab, {"translation": [0, 0, z], "rotation": turned, "scale": [0.9, 0.9, 1]}) for z, turned in ((2.8, [0, 0, 0, 1]), (2.4, OVER))]
        scene = self.scene("slab", *faces, lights=[({"type": "point", "intensity": INTENSITY}, {"translation": [0, 0, 4.5]})], ground=1.2)
        irradiance = through_slab(INTENSITY, 4.1, 0.4, 1.8)
        expected = over_ground(lambda x, y: irradiance(math.hypot(x, y))) / math.pi
        self.assert_near(self.seen(scene, spp=576), expected, "slab", 0.015)
        self.assertEqual(self.seen(scene, "--caustics", "off", spp=1), 0)
        self.assertEqual(self.seen(scene, spp=1, bounces=0), 0)

    def test_all_light_of_a_lamp_beside_a_ball_of_glass_reaches_the_walls(self):
        """The walls are those of a closed dark room. Each is seen on its own, from between ball and wall. Its light is
        4 pi times the intensity, of which the ball turns aside 29 %."""
        half, radius, away, intensity, albedo = 1.5, 0.5, 0.55, 2.0, 1e-5
        turns = {(0, 0, -1): [0, 0, 0, 1], (0, 0, 1): OVER, (-1, 0, 0): TURN, (1, 0, 0): [0, -TURN[1], 0, TURN[3]],
                 (0, -1, 0): BACK, (0, 1, 0): [math.sqrt(0.5), 0, 0, math.sqrt(0.5)]}
        dark = {"pbrMetallicRoughness": MATT | {"baseColorFactor": [albedo, albedo, albedo, 1]}, "extensions": SPECULAR}
        walls = [(dark, {"translation": [half * n for n in side], "rotation": turn, "scale": [half, half, 1]}) for side, turn in turns.items()]
        direction = [away * n / math.sqrt(14) for n in (1, 2, 3)]
        path = self.scene("room", *walls, lights=[({"type": "point", "intensity": intensity}, {"translation": direction})])
        gltf = json.loads(Path(f"{path}.gltf").read_text())
        glass = {"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0},
                 "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_volume": {"thicknessFactor": 1}}}
        gltf["materials"].append(glass)
        gltf["extensions"]["KHR_implicit_shapes"] = {"shapes": [{"type": "sphere", "sphere": {"radius": radius}}]}
        # This sphere replaces the ground.
        gltf["nodes"][0] = {"extras": {"shape": 0, "material": len(gltf["materials"]) - 1}}
        Path(f"{path}.gltf").write_text(json.dumps(gltf))

        def flux(side):
            camera = [0.7 * n for n in side]
            up = (1, 0, 0) if side[1] else (0, 1, 0)
            picture = self.picture(path, "x.pfm", "--resolution", "24,24", "--spp", 64, "--bounces", 1, "--camera-parallel-scale", half,
                                   *(f"--camera-{name}={','.join(map(str, place))}" for name, place in
                                     (("position", camera), ("focal-point", [half * n for n in side]), ("view-up", up))))
            return statistics.fmean(luminances(picture)) * math.pi / albedo * (2 * half)**2
        self.assert_near(sum(map(flux, turns)), 4 * math.pi * intensity, "room", 0.004)

    def test_a_request_without_effect_is_told(self):
        for scene, options, why in (("caustics", ["--stage", "shadows"], "only stage gi has them"), ("rough-glass", [], "no lamp or sun, or no glass or metal that is smooth enough for it")):
            told = run("render", SCENES / f"{scene}.gltf", "-o", self.folder / "x.pfm", "--resolution", "8,8", "--spp", 1, "--caustics", "on", "--default-light", "white",
                       "--light-reuse", "candidates", *options).stderr
            self.assertIn(f"--caustics on: no light paths: {why}", told)
            self.assertIn("--light-reuse: ", told)

    def test_what_light_paths_give_way_to_is_told(self):
        for name, options in (("clamp-indirect", [10]), ("shadow-catcher", [0]), ("aov", ["diffuse"])):
            path = self.folder / "stats.json"
            told = run("render", SCENES / "caustics.gltf", "-o", self.folder / "x.exr", "--resolution", "8,8", "--spp", 1, f"--{name}", *options,
                       "--stats", path).stderr
            self.assertIn(f"warning: no light paths for caustics (--{name}", told)
            self.assertIn(f"(--{name}", "".join(json.loads(path.read_text())["warnings"]))
        told = run("render", SCENES / "cornell-box.gltf", "-o", self.folder / "x.exr", "--resolution", "8,8", "--spp", 1, "--clamp-indirect", 10).stderr
        self.assertNotIn("light paths", told)

    def test_single_sided_surfaces_stop_light_as_on_paths_from_the_camera(self):
        """A screen between lamp and mirror: paths from the mirror to the lamp pass its back, and are stopped by its front."""
        screen = {"pbrMetallicRoughness": MATT | {"baseColorFactor": [0, 0, 0, 1]}, "extensions": SPECULAR}
        means = []
        for way, rotation in (("back", TURN), ("front", [0, -TURN[1], 0, TURN[3]])):
            node = {"translation": [-1, 0, 1], "rotation": rotation, "scale": [0.15, 0.5, 1]}
            scene = self.scene(way, self.mirror(), self.lamp(), (screen, node))
            means.append(self.assert_alike(scene, way, 576, 288))
        self.assertGreater(means[0], 1.02 * means[1])

    def test_bent_mirrors_that_are_rough_in_part(self):
        """Light paths go from one to the other, and normals bend what they carry. No lamp lights the ground."""
        half = {"pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.8, 0.7, 1], "metallicFactor": 0.6, "roughnessFactor": 0}}
        wall = (half, {"translation": [-MIRROR, 0, 0.45], "rotation": TURN, "scale": [1.2, 1.2, 1]})
        path = self.scene("bent", wall, self.above(0.6, 1.2, half), self.lamp_above())
        gltf = Gltf(json.loads(Path(f"{path}.gltf").read_text()))
        normals = gltf.accessor([(0.35 * x, 0.35 * y, (1 - 2 * 0.35**2)**0.5) for x, y in CORNERS])
        for mesh in gltf.root["meshes"][1:3]:
            mesh["primitives"][0]["attributes"] = {"POSITION": 0, "NORMAL": normals}
        gltf.write(Path(f"{path}.gltf"))
        self.assert_alike(path, "bent", 1536, 1536, bounces=5, known=0.0066)

    def test_two_mirrors_that_are_rough_in_part(self):
        """A periscope: what comes over both is most of the light, and each of them scatters light, too."""
        half = {"pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.8, 0.7, 1], "metallicFactor": 0.6, "roughnessFactor": 0}}
        turned = 3 * math.pi / 8
        walls = [(half, {"translation": [x, 0, ABOVE], "rotation": [0, way * math.sin(turned), 0, math.cos(turned)], "scale": [0.6, 0.6, 1]})
                 for x, way in ((UP[0][0], -1), (0, 1))]
        self.assert_alike(self.scene("periscope", *walls, self.lamp_above()), "periscope", 960, 960, bounces=3, known=0.0133)

    def test_no_bright_dots_where_light_has_scattered_before(self):
        """A small lamp, a mirror over it, the ground: camera paths that find the lamp after a second rough surface would leave dots."""
        scene = self.scene("dots", self.above(0.6, 1.2), self.lamp(((1.5, 0.0, 0.3), 0.02, 6000.0), [0, 0, 0, 1]))
        pixels = sorted(luminances(self.picture(scene, "x.pfm", *SMALL, *ON, "--spp", 1024)))
        self.assertLess(pixels[-1], 4 * pixels[len(pixels) // 2])

    def test_light_paths_that_take_many_draws_are_the_same(self):
        folder = self.shaders_of_short_draws()
        options = ["--resolution", "24,18", "--spp", 2, "--traversal", "front-to-back", "--schedule", "megakernel"]
        scene = str(SCENES / "caustics")
        self.assertEqual(self.picture(scene, "a.pfm", *options), self.picture(scene, "b.pfm", *options, "--shader-folder", folder))

    def test_the_noise_is_what_the_variance_says(self):
        """The samples are independent numbers. Over all pixels and 24 seeds, the standard error is about 2 %."""
        scene = self.scene("lamp", self.mirror(), self.lamp())
        means, told = [], []
        for seed in range(12):
            exr = self.picture(scene, "x.exr", *SMALL, *ON, "--spp", 16, "--seed", seed, "--disable", "sobol", "--aov", "variance")
            means.append(exr.luminances())
            told.append(exr.values("variance.Y"))
        seen = statistics.fmean(statistics.variance(values) for values in zip(*means))
        said = statistics.fmean(statistics.fmean(values) for values in told)
        print(f"variance: seen {seen:.3e}, said {said:.3e}, ratio {seen / said:.3f}")
        self.assertLess(abs(seen / said - 1), 0.08)

    def test_schedules_and_regions_draw_the_same(self):
        """With paths that are guided, from the second sample on."""
        scene = str(SCENES / "caustics")
        size = ("--resolution", "64,48", "--spp", 4, "--pixel-filter", "gaussian")
        whole = self.picture(scene, "a.pfm", *size, "--schedule", "megakernel")
        self.assertEqual(whole, self.picture(scene, "b.pfm", *size, "--schedule", "wavefront"))
        part = self.picture(scene, "c.pfm", *size, "--region", "10,20,30,17")
        self.assertEqual([row[10:40] for row in whole[20:37]], part)

    def test_what_is_said(self):
        def told(scene, *options):
            path = self.folder / "stats.json"
            self.renders(SCENES / f"{scene}.gltf", "-o", self.folder / "x.png", "--resolution", "16,16", "--spp", 6, "--stats", path, *options)
            return json.loads(path.read_text())["caustics"]
        drawn = told("caustics")
        rows = -(-16 // drawn["pixels_per_path"])
        self.assertEqual(drawn["light_paths"], 16 * (4 * 4 + 2 * rows))
        late = told("caustics", "--seed", 5, "--sample-offset", 7, "--region", "2,3,4,5")
        self.assertEqual((late["light_paths"], late["pixels_per_path"]), (16 * 6 * rows, drawn["pixels_per_path"]))
        self.assertGreater(drawn["casters"], 1)
        self.assertEqual(told("caustics", "--caustics", "off"), {"light_paths": 0, "pixels_per_path": 0, "casters": 0, "variance_share": 0, "guiding_ms": 0, "reason": "--caustics"})
        self.assertEqual(told("caustics", "--bounces", 0), {"light_paths": 0, "pixels_per_path": 0, "casters": 3, "variance_share": 0, "guiding_ms": 0, "reason": "--bounces"})
        self.assertIn("no lamp", told("cornell-box")["reason"])
        for other in (("--clamp-indirect", "1"), ("--shadow-catcher", "0"), ("--aov", "diffuse")):
            refused = run("render", SCENES / "caustics.gltf", "-o", self.folder / "x.exr", "--caustics", "on", *other)
            self.assertEqual(refused.returncode, 2, refused.stderr)
            self.assertIn("--caustics on", refused.stderr)


ALPHA = 0.25


class CausticSources(Case):
    """--caustics: lamps with alpha, and surfaces between a lamp and what makes its caustic; scenes without light paths. Light paths
    bring what camera paths do, as py says."""
    scene = Caustics.scene
    luminances, seen = Caustics.luminances, Caustics.seen
    assert_alike = Caustics.assert_alike

    def lamp(self, like, rotation, **more):
        """A lamp with these members of its material."""
        material, place = Caustics.lamp(like, rotation)
        color = material["pbrMetallicRoughness"] | {"baseColorFactor": [0, 0, 0, ALPHA]}
        return (material | {"pbrMetallicRoughness": color} | more, place)

    def test_a_lamp_shines_as_much_as_its_alpha_says(self):
        """Most of its rays pass through it if alpha is small, so it is as dim for light samples and light paths."""
        mirror = Caustics.above(0.9, 1.0)
        for what, like, turn, things in (("caustic", UP, [0, 0, 0, 1], [mirror]), ("light sample", LAMP, OVER, [])):
            seen = {}
            for seed, (mode, more) in enumerate((("OPAQUE", {}), ("BLEND", {}), ("MASK", {"alphaCutoff": 0.5}))):
                scene = self.scene("alpha", *things, self.lamp(like, turn, alphaMode=mode, **more))
                seen[mode] = self.luminances(scene, "--seed", seed, spp=384)
            self.assert_same_light(seen["BLEND"], [ALPHA * value for value in seen["OPAQUE"]], what, 0.025)
            self.assertEqual(max(seen["MASK"]), 0, what)

    def test_light_passes_the_backs_of_unlit_cards(self):
        """The card is seen from below, by the lamp. Camera paths come from above, where it is not there."""
        mirror = Caustics.above(0.9, 1.0)
        card = ({"extensions": {"KHR_materials_unlit": {}}, "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}},
                {"translation": [1.5, 0, 0.6], "rotation": OVER, "scale": [0.5, 0.5, 1]})
        bare = self.assert_alike(self.scene("bare", mirror, self.lamp(UP, [0, 0, 0, 1])), "bare", 768, 1536, known=0.01)
        held = self.assert_alike(self.scene("card", mirror, self.lamp(UP, [0, 0, 0, 1]), card), "card", 768, 1536, known=0.011)
        self.assertGreater(held, 0.5 * bare)

    def test_a_range_ends_behind_a_thin_pane(self):
        """It counts from the light to the metal, as without the pane, which reflects nothing here."""
        light = {"type": "point", "intensity": INTENSITY, "range": 0.55}
        pane = ({"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0}, "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1}}},
                {"translation": [-0.75, 0, 0.9], "rotation": TURN, "scale": [0.9, 0.9, 1]})
        wall = GlossyCaustics.metal(0.3), {"translation": [-MIRROR, 0, 0.9], "rotation": TURN, "scale": [0.9, 0.9, 1]}
        scene = self.scene("range", wall, pane, lights=[(light, {"translation": [-0.7, 0.1, 0.9]})])
        self.assert_alike(scene, "range", 2304, 768, bounces=4, known=0.02)

    def test_where_they_hardly_land_camera_paths_alone_draw_all_parts(self):
        """A wide mirror throws the light of a wide lamp over a ground of which the camera sees a hundredth."""
        mirror = ({"pbrMetallicRoughness": {"metallicFactor": 1, "roughnessFactor": 0}}, {"translation": [-3, 0, 0], "rotation": TURN, "scale": [9, 9, 1]})
        lamp = Caustics.lamp(((4, 0, 5), 2.5, 20.0))
        scene = self.scene("wide", mirror, lamp, ground=30)

        def drawn(*options, spp=6):
            stats = self.folder / "stats.json"
            return self.picture(scene, "x.pfm", *SMALL, "--spp", spp, "--stats", stats, *options), json.loads(stats.read_text())["caustics"]
        # A goal of noise that few samples reach leaves the picture's limit: four million paths.
        goal = ("--noise", 0.9)
        whole, told = drawn(*goal, spp=4096)
        self.assertEqual((told["light_paths"], told["pixels_per_path"], told["reason"]), (0, 0, "camera paths alone are less noisy"))
        self.assertEqual(drawn(*goal, "--caustics", "off", spp=4096)[0], whole)
        self.assertGreater(drawn("--caustics", "on")[1]["light_paths"], 0)
        # Of few paths nothing is measured: no program of light paths is compiled.
        whole, told = drawn()
        self.assertEqual((told["light_paths"], told["casters"], told["reason"]), (0, 0, "few paths find the light of such wide lamps, too"))
        self.assertEqual(drawn("--caustics", "off")[0], whole)
        self.assertEqual([row[4:20] for row in whole[3:20]], drawn("--region", "4,3,16,17")[0])
        for options in (("--seed", 9), ("--sample-offset", 5)):
            self.assertEqual(drawn(*options, spp=1)[1]["light_paths"], 0, options)
        # A small lamp, and a punctual light, are not left to chance.
        for name, things, lights in (("small", (Caustics.lamp(((4, 0, 5), 0.1, 2000.0)),), ()),
                                     ("point", (lamp,), (({"type": "point", "intensity": 5}, {"translation": [2, 0, 4]}),))):
            scene = self.scene(name, mirror, *things, lights=lights, ground=30)
            self.assertGreater(drawn()[1]["light_paths"], 0, name)


GLOSSY_CAUSTICS_POINT = [({"type": "point", "intensity": INTENSITY}, {"translation": POINT})]


class GlossyCaustics(Case):
    """--caustics: metal and glass that are not quite smooth. Light paths bring what camera paths alone do, as py says of them."""
    scene = Caustics.scene
    luminances, seen = Caustics.luminances, Caustics.seen
    assert_alike = Caustics.assert_alike
    lamp = staticmethod(Caustics.lamp)

    @staticmethod
    def metal(roughness):
        return {"pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.8, 0.7, 1], "metallicFactor": 1, "roughnessFactor": roughness}}

    def wall(self, roughness):
        return self.metal(roughness), {"translation": [-MIRROR, 0, 0.45], "rotation": TURN, "scale": [1.2, 1.2, 1]}

    def told(self, scene, *options):
        path = self.folder / "stats.json"
        self.picture(scene, "x.pfm", "--resolution", "16,16", *ON, "--spp", 8, "--bounces", 1, "--stats", path, *options)
        return json.loads(path.read_text())["caustics"]

    def test_a_brushed_wall_and_metal_that_the_camera_sees(self):
        """The metal throws the light of the wall at the camera, with a lobe that is narrow, or wide."""
        tilt = [0, -math.sin(math.pi / 8), 0, math.cos(math.pi / 8)]
        for roughness in (0.1, 0.3):
            seen = self.metal(roughness), {"translation": [0.3, 0, 0.35], "rotation": tilt, "scale": [0.4, 0.4, 1]}
            scene = self.scene("brushed", self.wall(0.3), seen, lights=GLOSSY_CAUSTICS_POINT)
            self.assert_alike(scene, f"brushed {roughness}", 1024, 512, bounces=3)

    def test_a_frosted_pane(self):
        """It stands next to the picture, before the light."""
        glass = {"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.3}, "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}}}
        pane = glass, {"translation": [-1.2, 0, 0.5], "rotation": TURN, "scale": [0.5, 0.8, 1]}
        scene = self.scene("pane", pane, lights=[(GLOSSY_CAUSTICS_POINT[0][0], {"translation": [-2.2, 0.1, 1.1]})])
        self.assert_alike(scene, "pane", 1024, 384, bounces=3, known=0.006)

    def test_rougher_metal_and_wide_lamps_have_none(self):
        for what, scene, some in (("some", self.scene("some", self.wall(0.3), lights=GLOSSY_CAUSTICS_POINT), True),
                                  ("rough", self.scene("rough", self.wall(0.31), lights=GLOSSY_CAUSTICS_POINT), False),
                                  ("wide", self.scene("wide", self.wall(0.3), self.lamp(LAMP)), False)):
            self.assertEqual(self.told(scene)["light_paths"] > 0, some, what)

    def test_the_variance_of_each_kind_of_path_is_told(self):
        """The lamp that faces away from the ground lights it by the mirror alone, which light paths draw."""
        lamp, mirror = Caustics.lamp(UP, [0, 0, 0, 1]), Caustics.above(0.9, 1.0)
        scene = self.scene("up", mirror, lamp)
        self.assertEqual(self.told(scene)["variance_share"], 1)
        self.assertEqual(self.told(scene, "--caustics", "off")["variance_share"], 0)
        both = self.told("caustics")
        self.assertTrue(0.01 < both["variance_share"] < 0.99, both)


GUIDING_LAMP = ((-0.7, -0.1, 1.1), 0.02, 2000.0)  # as that of caustics_test, and small
PARALLEL = ("--camera-parallel-scale", 1.0)
# A thin pane seen at a right angle, with the reflections in it. It mirrors hardly any light back to the ground.
INDEX = 1.1
THROUGH_PANE = 2 * INDEX / (INDEX * INDEX + 1)
PANE = ({"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0}, "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": INDEX}}},
        {"translation": [0, 0, 2], "scale": [3, 3, 1]})


class Guiding(Case):
    """Caustics that the camera sees through glass and in mirrors: camera paths find them by guiding (shaders/caustics/guiding.glsl)."""
    scene, luminances = Caustics.scene, Caustics.luminances
    lamp, mirror = staticmethod(Caustics.lamp), staticmethod(Caustics.mirror)

    def test_a_mirrors_light_seen_through_a_pane(self):
        open_air, behind = (self.luminances(self.scene("guided", self.mirror(), self.lamp(GUIDING_LAMP), *things), *PARALLEL, "--seed", len(things), spp=512)
                            for things in ((), (PANE,)))
        # Without guiding the error is many times as large.
        self.assert_same_light(behind, [THROUGH_PANE * value for value in open_air], "behind the pane", 0.005)

    def test_the_first_sample_waits_for_no_guiding(self):
        def guiding_ms(spp):
            path = self.folder / "s.json"
            self.renders(SCENES / "caustic-ball.gltf", "-o", self.folder / "x.pfm", "--resolution", "32,32", *ON, "--spp", spp, "--stats", path, "--quiet")
            return json.loads(path.read_text())["caustics"]["guiding_ms"]
        self.assertEqual(guiding_ms(1), 0)
        self.assertGreater(guiding_ms(2), 0)


SUN_CAUSTICS_ABOVE = ("--camera-position", "0,4,0", "--camera-focal-point", "0,0,0", "--camera-view-up", "0,0,-1", "--camera-parallel-scale", "1")
SKY = ("--sky", "--sun-elevation", "30", "--sun-azimuth", "90")
BLACK = ("environment.glsl", "vec3(there) * intensity", "vec3(there) * (0.0f * intensity)")
WIDER = 10
SUN_CAUSTICS_WIDE = (("layout.glsl", "kSunRadius = 0.004651303f", f"kSunRadius = {0.004651303 * WIDER}f"), ("sky/sun.glsl", "sun.pdf = light.w;", f"sun.pdf = light.w / {WIDER**2}.0f;"))


class SunCaustics(Case):
    """--caustics: light that the sun of --sky, or of a map, sends by way of a mirror. The mirror stands at the edge of matt ground and faces the sun, so what
    it throws there is as bright as what the sun itself sends, which is drawn from the ground. The sky next to the sun is made black. The mean of one picture
    lies within the part that is given, which is about 4 standard errors (of 4 seeds)."""

    def scene(self, name, mirror=True, lamp=0.0, roughness=0.0):
        """The mirror has two halves. A lamp of that radiance shines down from where it shades nothing."""
        gltf = GltfWriter(self.folder, name)
        place_quad(gltf, "ground", geometry.ground(1.05, 3), gltf.add_lambert("ground", (1, 1, 1)))
        smooth = gltf.add_material("mirror", metallic=1, roughness=roughness)
        for z in (0.0, 1.1) if mirror else ():
            place_quad(gltf, f"mirror {z}", geometry.quad((-1.05, 0, z), (0, 0, -1.1), (0, 1.3, 0)), smooth)
        if lamp:
            place_quad(gltf, "lamp", geometry.quad((0.1, 2.2, -0.2), (0.4, 0, 0), (0, 0, 0.4)), gltf.add_lamp("lamp", (lamp, lamp, lamp)))
        gltf.write()
        return str(self.folder / name)

    def shaders(self, *edits):
        folder = self.folder / f"shaders{len(edits)}"
        if not folder.exists():
            shutil.copytree(SHADERS, folder)
            for name, old, new in edits:
                text = (folder / name).read_text()
                self.assertEqual(text.count(old), 1, name)
                (folder / name).write_text(text.replace(old, new))
        return ("--shader-folder", folder)

    def drawn(self, scene, *options, spp=32):
        return self.picture(scene, "x.pfm", "--resolution", "96,96", *SUN_CAUSTICS_ABOVE, "--bounces", 1, "--spp", spp, *options)

    def seen(self, scene, *options, **more):
        return mean(self.drawn(scene, *options, **more), 1)

    def test_candidates_bring_what_glossy_metal_scatters_of_the_sky(self):
        """The sun stands behind the metal, which a sample may choose all the same."""
        scene = self.scene("glossy", roughness=0.3)
        behind = ("--sky", "--sun-elevation", "3", "--sun-azimuth", "270")
        one, several = (luminances(self.drawn(scene, *behind, "--light-reuse", reuse, "--seed", seed, spp=32)) for seed, reuse in enumerate(("none", "candidates")))
        self.assert_same_light(several, one, "candidates", 0.002)

    def test_a_mirror_shows_the_ground_a_second_sun(self):
        direct = self.seen(self.scene("bare", mirror=False), *SKY, *self.shaders(BLACK), spp=16)
        scene = self.scene("mirror")
        self.assert_near(self.seen(scene, *SKY, *self.shaders(BLACK), spp=96), 2 * direct, "sun", 0.006)

    def test_camera_paths_leave_out_what_light_paths_bring(self):
        """A sun of ten times its width, as bright, is found by chance a hundred times as often."""
        edits = self.shaders(BLACK, *SUN_CAUSTICS_WIDE)
        direct = self.seen(self.scene("bare", mirror=False), *SKY, *edits, spp=16)
        scene = self.scene("mirror")
        # Turned back to the east.
        turned = ("--sky", "--sun-elevation", "30", "--sun-azimuth", "130", "--hdri-rotation", "40", "--hdri-intensity", "0.5")
        self.assert_near(self.seen(scene, *turned, *edits), direct, "wide sun, turned and dimmed", 0.012)
        self.assert_near(self.seen(scene, *SKY, *edits, "--caustics", "off", spp=128), 2 * direct, "wide sun, from the camera alone", 0.05)

    def map(self, name, width, place, sun, sky=0.0):
        """A map of even sky with a sun of one texel, which filters blur over its neighbours."""
        height = width // 2
        texels = [[sky] * width for _ in range(height)]
        x, y = place
        texels[y][x] = sun
        path = self.folder / name
        rows = reversed(texels)  # from the bottom
        path.write_bytes(b"PF\n%d %d\n-1.0\n" % (width, height) + b"".join(struct.pack("<fff", v, v, v) for row in rows for v in row))
        return path

    def test_the_sun_of_a_map(self):
        """A narrow one stands where that of SKY does. A wide one, as bright as the sky is in all, is found by camera paths too."""
        bare, mirror = self.scene("bare", mirror=False), self.scene("mirror")
        narrow = ("--hdri-file", self.map("narrow.pfm", 512, (256, 85), 1e5))
        direct = self.seen(bare, *narrow, spp=16)
        self.assert_near(self.seen(mirror, *narrow), 2 * direct, "narrow sun", 0.008)
        wide = ("--hdri-file", self.map("wide.pfm", 64, (42, 10), 3e3, sky=1.0), "--hdri-rotation", "60", "--hdri-intensity", "0.5")
        for scene, spp in ((mirror, 32), (self.scene("glossy", roughness=0.25), 64)):
            found, thrown = (luminances(self.drawn(scene, *wide, "--seed", seed, "--caustics", caustics, spp=samples))
                             for seed, (caustics, samples) in enumerate((("off", 512), ("on", spp))))
            self.assert_same_light(thrown, found, f"wide sun, turned and dimmed, {spp}", 0.004)

    def test_beside_a_lamp_each_brings_its_own(self):
        scene = self.scene("lamp", lamp=60)
        direct = self.seen(self.scene("bare", mirror=False), *SKY, *self.shaders(BLACK), spp=16)
        lamp = self.seen(scene)
        self.assertGreater(lamp, 0.9 * direct)
        self.assert_near(self.seen(scene, *SKY, *self.shaders(BLACK)), 2 * direct + lamp, "sun and lamp", 0.008)

    def test_it_is_told(self):
        def told(scene, *options):
            path = self.folder / "stats.json"
            self.renders(f"{scene}.gltf", "-o", self.folder / "x.png", "--resolution", "16,16", "--spp", 2, "--stats", path, *options)
            return json.loads(path.read_text())["caustics"]
        scene = self.scene("mirror")
        day = told(scene, *SKY)
        self.assertEqual(day["light_paths"], 2 * 16 * 4)
        self.assertIn("a sun", day["reason"])
        night = told(scene, "--sky", "--sun-elevation", "-5")
        self.assertEqual(night["light_paths"], 0)
        self.assertIn("no lamp or sun", night["reason"])
        even = told(scene, "--hdri-file", self.map("even.pfm", 64, (42, 10), 2.0, sky=1.0))
        self.assertEqual(even, night)
        self.assertEqual(told(scene, "--hdri-file", self.map("sun.pfm", 64, (42, 10), 3e3, sky=1.0))["reason"], day["reason"])
        self.assertEqual(told(scene, *SKY, "--caustics", "off"), {"light_paths": 0, "pixels_per_path": 0, "casters": 0, "variance_share": 0, "guiding_ms": 0, "reason": "--caustics"})


if __name__ == "__main__":
    main()

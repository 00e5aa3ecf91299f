#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Participating media: closed forms, what glTF says of them, and pictures that are put together."""
import copy
import json
import math
import pathlib

from support import SCENES, WHITE, Case, main, mean, run


def half_space(albedo):
    """The radiance that a half-space which scatters alike in all directions sends back along its normal, under white light from everywhere:
    1 - sqrt(1 - albedo) H(1), with the H function of Chandrasekhar (Radiative Transfer, 1950, chapter 5) by iteration."""
    left, count = math.sqrt(1 - albedo), 200
    cosines = [(i + 0.5) / count for i in range(count)]
    h = [1.0] * count
    at = lambda mu: 1 / (left + albedo / 2 * sum(c * v / (mu + c) for c, v in zip(cosines, h)) / count)
    for _ in range(60):
        h = [at(mu) for mu in cosines]
    return 1 - left * at(1)


def color_of(albedo):
    """Returns the multiscatterColorFactor of a single-scattering albedo: the draft's s = sqrt(1 - albedo) = 4.09712 +
    4.20863 r - sqrt(9.59217 + 41.6808 r + 17.7126 r^2), solved for r."""
    low, high = 0.0, 1.0
    for _ in range(60):
        r = (low + high) / 2
        s = 4.09712 + 4.20863 * r - math.sqrt(9.59217 + 41.6808 * r + 17.7126 * r * r)
        low, high = (r, high) if s > math.sqrt(1 - albedo) else (low, r)
    return low


class Media(Case):
    def ball(self, radius=0.6, **material):
        """The ball of scenes/cloud.gltf alone before nothing, with other extensions of its material: None leaves one out."""
        gltf = json.loads((SCENES / "cloud.gltf").read_text())
        ball = next(node for node in gltf["nodes"] if "shape" in node.get("extras", {}))
        camera = next(node for node in gltf["nodes"] if "camera" in node)
        ball.pop("translation"), camera.pop("rotation", None)
        camera["translation"] = [0, 0, 3]
        gltf["nodes"], gltf["scenes"] = [ball, camera], [{"nodes": [0, 1]}]
        gltf["extensions"]["KHR_implicit_shapes"]["shapes"][0]["sphere"]["radius"] = radius
        glass = copy.deepcopy(gltf["materials"][ball["extras"]["material"]])
        for name, value in material.items():
            glass["extensions"].pop("KHR_materials_" + name, None)
            if value is not None:
                glass["extensions"]["KHR_materials_" + name] = value
        gltf["materials"], ball["extras"]["material"] = [glass], 0
        for key in ("meshes", "accessors", "bufferViews", "buffers"):
            gltf.pop(key, None)
        gltf["extensionsUsed"] = sorted(set(gltf.get("extensionsUsed", [])) | set(glass["extensions"]))
        return str(self.written("ball.gltf", gltf).with_suffix(""))

    def seen(self, scene, *options, spp=64, size="16,16"):
        return self.picture(scene, "x.pfm", "--resolution", size, "--spp", spp, *options)

    def volume(self, color=(0.3, 0.3, 0.3), distance=0.2):
        return {"thicknessFactor": 1, "attenuationColor": list(color), "attenuationDistance": distance}

    def test_fog_dims_what_is_behind_it_by_its_depth(self):
        """Beer's law: fog that only absorbs, across its ball, which the camera sees from outside."""
        scene = self.ball(1e-4, scatter=None)
        seen = self.seen(scene, *WHITE, "--fog-density", 0.8, "--fog-color", "0,0,0", "--fog-distance", 1, "--camera-view-angle", 1,
                         spp=2048, size="24,24")
        self.assertAlmostEqual(mean(seen) / math.exp(-0.8 * 2), 1, delta=0.002)

    def test_fog_thins_with_height(self):
        scene = self.ball(1e-4, scatter=None)
        below, above = (self.seen(scene, *WHITE, "--fog-density", 1, "--fog-color", "0,0,0", "--fog-distance", 1, "--camera-view-angle", 1,
                                  "--fog-height", f"0.5,{base}", spp=1024) for base in (5, -1))
        self.assertAlmostEqual(mean(below) / math.exp(-2), 1, delta=0.02)
        self.assertAlmostEqual(mean(above) / math.exp(-2 * math.exp(-2)), 1, delta=0.01)

    def test_white_media_are_not_seen_in_white_light(self):
        """Scattered light is neither lost nor made, whatever the phase function, the boundary and the fog."""
        white = {"scatterStrengthFactor": 1}
        for material in ({"ior": {"ior": 1}}, {"ior": {"ior": 1.5}},
                         {"specular": {"specularFactor": 0}, "volume": None}):
            for anisotropy in (0, 0.7):
                scene = self.ball(**({"volume": self.volume()} | material), scatter=white | {"scatterAnisotropy": anisotropy})
                self.assertAlmostEqual(mean(self.seen(scene, *WHITE, spp=256)), 1, delta=0.002, msg=str((material, anisotropy)))
        fog = ["--fog-density", 2, "--fog-height", 0.3, "--fog-anisotropy", 0.6]
        self.assertAlmostEqual(mean(self.seen(self.ball(1e-4, scatter=None), *WHITE, *fog, "--fog-distance", 1)), 1, delta=1e-3)

    def test_white_media_are_not_seen_between_walls_that_shine(self):
        """The walls are sampled as lamps, unlike the white light of everywhere: both ways to their light count, each with its weight."""
        for ior, anisotropy in ((1, 0.5), (1.5, 0)):
            ball = json.loads(pathlib.Path(self.ball(ior={"ior": ior}, volume=self.volume(), scatter={
                "scatterStrengthFactor": 1, "scatterAnisotropy": anisotropy}) + ".gltf").read_text())
            room = json.loads((SCENES / "closed-furnace.gltf").read_text())
            room["materials"][0] |= {"emissiveFactor": [1, 1, 1]}
            room["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = [0, 0, 0, 1]
            room["materials"] += ball["materials"]
            room["nodes"].append(ball["nodes"][0] | {"extras": {"shape": 0, "material": 1}})
            room["scenes"][0]["nodes"] = [0, 1, 2]
            room |= {"extensions": ball["extensions"], "extensionsUsed": ball["extensionsUsed"]}
            (self.folder / "room.gltf").write_text(json.dumps(room))
            seen = self.seen(str(self.folder / "room"), "--bounces", "unlimited", "--camera-view-angle", 20, "--camera-focal-point", "0,0,0", spp=512)
            self.assertAlmostEqual(mean(seen), 1, delta=0.003, msg=str(ior))

    def test_a_half_space_has_the_albedo_of_its_h_function(self):
        """A ball of 1,200 mean free paths, which its curvature makes 0.1 % brighter; standard errors 0.22 to 0.10 %."""
        albedos = (0.5, 0.9, 0.99)
        scene = self.ball(volume=self.volume([math.exp(-1)] * 3, 1 / 2000), scatter={"scatterStrengthFactor": 1, "multiscatterColorFactor": [color_of(a) for a in albedos]})
        seen = self.seen(scene, *WHITE, "--camera-view-angle", 0.1, spp=1024)
        for channel, albedo in enumerate(albedos):
            self.assertAlmostEqual(mean(seen, channel) / half_space(albedo), 1, delta=0.008, msg=str(albedo))

    def test_what_is_scattered_once_is_an_integral_over_ray_and_lamp(self):
        """The scene is scenes/inside.gltf with its lamp alone, in a medium that scatters a thousandth. The integral is
        along the ray through the picture's middle."""
        gltf = json.loads((SCENES / "inside.gltf").read_text())
        gltf["nodes"] = [node for node in gltf["nodes"] if node["name"] in ("box", "lamp", "camera")]
        gltf["scenes"] = [{"nodes": [0, 1, 2]}]
        albedo, box = 1e-3, gltf["meshes"][gltf["nodes"][0]["mesh"]]["primitives"][0]["material"]
        extensions = gltf["materials"][box]["extensions"]
        extensions["KHR_materials_scatter"]["multiscatterColorFactor"] = [color_of(albedo)] * 3
        volume = extensions["KHR_materials_volume"]
        scene = self.folder / "once.gltf"

        def picture(spp):
            scene.write_text(json.dumps(gltf))
            return self.seen(str(scene.with_suffix("")), "--camera-position", "0,0.9,2.6", "--camera-focal-point", "0,0.7,0", "--camera-view-angle", 0.1,
                             "--bounces", "unlimited", "--no-default-light", spp=spp, size="8,8")
        seen = picture(1024)
        length = math.hypot(0.2, 2.6)
        direction = (0, -0.2 / length, -2.6 / length)
        steps, end, side = 200, 4.1 * length / 2.6, 12  # the box ends at z = -1.5; the lamp is 0.6 m wide
        for channel, radiance in enumerate((8, 7.5, 7)):
            extinction = -math.log(volume["attenuationColor"][channel]) / volume["attenuationDistance"]
            sum_over = 0.0
            for i in range(steps):
                t = (i + 0.5) / steps * end
                x, y, z = (a + t * b for a, b in zip((0, 0.9, 2.6), direction))
                for u in range(side):
                    for v in range(side):
                        to = (0.2 + 0.6 * ((u + 0.5) / side - 0.5) - x, 1.6 - y, 0.6 * ((v + 0.5) / side - 0.5) - z)
                        r = math.hypot(*to)
                        sum_over += math.exp(-extinction * (t + r)) * to[1] / r**3
            wanted = albedo * extinction * radiance / (4 * math.pi) * sum_over * end / steps * 0.36 / side**2
            self.assertAlmostEqual(mean(seen, channel) / wanted, 1, delta=0.003)
        # A boundary that bends light throws some back. In such a medium the lamp is found by chance alone.
        extensions["KHR_materials_ior"] = {"ior": 1.33}
        self.assertAlmostEqual(mean(picture(8192), 2) / wanted, 1.09, delta=0.15)

    def test_positive_anisotropy_is_forward(self):
        """A light behind the ball is brighter with 0.9 than with -0.9, and one before it the other way round."""
        for side, brighter in ((-1, 0.9), (1, -0.9)):
            levels = {}
            for anisotropy in (-0.9, 0.9):
                scene = self.ball(volume=self.volume(distance=0.6), scatter={"scatterStrengthFactor": 1, "scatterAnisotropy": anisotropy})
                path = self.folder / "ball.gltf"
                gltf = json.loads(path.read_text())
                gltf["extensions"]["KHR_lights_punctual"] = {"lights": [{"type": "directional", "intensity": 3}]}
                gltf["nodes"].append({"rotation": [0, 1, 0, 0] if side < 0 else [0, 0, 0, 1], "extensions": {"KHR_lights_punctual": {"light": 0}}})
                gltf["scenes"][0]["nodes"].append(2)
                path.write_text(json.dumps(gltf))
                levels[anisotropy] = mean(self.seen(scene, "--no-default-light", "--bounces", "unlimited"))
            self.assertEqual(max(levels, key=levels.get), brighter, levels)
            self.assertGreater(max(levels.values()), 1.5 * min(levels.values()))

    def test_three_spellings(self):
        color = [0.9, 0.6, 0.4]
        drawn = [self.seen(self.ball(volume=self.volume(), **spelling), *WHITE, spp=4) for spelling in (
            {"scatter": {"scatterStrengthFactor": 1, "multiscatterColorFactor": color}},
            {"scatter": None, "volume_scatter": {"multiscatterColor": color}},
            {"scatter": None, "volume_scatter": {"multiscatterColorFactor": color}},
            {"scatter": {"multiscatterColorFactor": color}},
            {"scatter": None})]
        self.assertEqual(drawn[0], drawn[1])
        self.assertEqual(drawn[1], drawn[2])
        self.assertEqual(drawn[3], drawn[4])
        self.assertNotEqual(drawn[0], drawn[4])

    def test_thin_walls_that_scatter_all_are_diffuse_both_ways(self):
        """(1 + g) / 2 of the light goes through, the rest comes back, as KHR_materials_diffuse_transmission says it, too; lit from the side.
        Of a wall that transmits a part, the rest is diffuse in the base colour."""
        def lit(scene, base=(1, 1, 1)):
            path = self.folder / "ball.gltf"
            gltf = json.loads(path.read_text())
            gltf["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = [*base, 1]
            gltf["extensions"]["KHR_lights_punctual"] = {"lights": [{"type": "directional", "intensity": 3}]}
            gltf["nodes"].append({"rotation": [0, 0.5**0.5, 0, 0.5**0.5], "extensions": {"KHR_lights_punctual": {"light": 0}}})
            gltf["scenes"][0]["nodes"].append(2)
            path.write_text(json.dumps(gltf))
            return self.seen(scene, "--no-default-light", "--bounces", "unlimited", "--camera-view-angle", 20, spp=1024)
        for anisotropy, transmission in ((-0.5, 1), (0.8, 1), (0, 0.25)):
            color, base = [0.9, 0.6, 0.3], [0.4, 0.6, 0.8]
            through, back = transmission * (1 + anisotropy) / 2, transmission * (1 - anisotropy) / 2
            scattered = lit(self.ball(volume=None, ior=None, transmission={"transmissionFactor": transmission}, scatter={
                "scatterStrengthFactor": 1, "multiscatterColorFactor": color, "scatterAnisotropy": anisotropy}), base)
            returned = [((1 - transmission) * b + back * c) / (1 - through) for b, c in zip(base, color)]
            wanted = lit(self.ball(volume=None, ior=None, scatter=None, transmission=None, diffuse_transmission={
                "diffuseTransmissionFactor": through, "diffuseTransmissionColorFactor": color}), returned)
            for channel in range(3):
                self.assertAlmostEqual(mean(scattered, channel) / mean(wanted, channel), 1, delta=6e-3)

    def test_strength_mixes_straight_and_scattered_light(self):
        """A dark background is seen through a thin wall by what it does not scatter."""
        levels = [mean(self.seen(self.ball(volume=None, scatter={"scatterStrengthFactor": strength, "multiscatterColorFactor": [0, 0, 0]}),
                                 *WHITE, "--camera-view-angle", 1)) for strength in (0, 0.25, 0.5, 1)]
        for level, strength in zip(levels, (0, 0.25, 0.5, 1)):
            self.assertAlmostEqual(level, levels[3] + (levels[0] - levels[3]) * (1 - strength)**2, delta=0.02)

    def test_pictures_are_put_together(self):
        """A region is that of the whole picture, and samples that are drawn in parts are those of the whole."""
        whole = self.seen("foggy", "--fog-density", 0.5, "--seed", 3, spp=4)
        region = self.seen("foggy", "--fog-density", 0.5, "--seed", 3, "--region", "4,2,8,6", spp=4)
        self.assertEqual(region, [row[4:12] for row in whole[2:8]])

    def test_bad_fog(self):
        for options, reason in ((["--fog-color", "1,1,1"], "goes with --fog-density"),
                                (["--fog-density", "1", "--fog-color", "2,1,1"], "--fog-color: a colour is in the range 0 to 1"),
                                (["--fog-density", "1", "--fog-height", "0"], "--fog-height: '0' is not a height above 0"),
                                (["--fog-density", "1", "--fog-height", "1,x"], "--fog-height: '1,x' is not a height"),
                                (["--fog-density", "1", "--shadow-catcher", "bottom"], "cannot be combined with --shadow-catcher"),
                                (["--fog-density", "-1"], "--fog-density")):
            done = run("render", SCENES / "foggy.gltf", "-o", self.folder / "x.pfm", *options)
            self.assertEqual(done.returncode, 2, options)
            self.assertIn(reason, done.stderr)


if __name__ == "__main__":
    main()

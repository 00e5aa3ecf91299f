#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Participating media: closed forms, what glTF says of them, and pictures that are put together."""
import copy
import json
import math
import pathlib
import random
import struct
import subprocess
import unittest
from pathlib import Path

from support import FRAGTRACE, SCENES, WHITE, Case, main, mean, run

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


# Next to the program, or in the build folder where a copy of it is tried.
MAKE_GRID = next((path for path in (FRAGTRACE.parent / "make_grid", SCENES.parent / "build/make_grid") if path.exists()), Path("/nowhere"))


@unittest.skipUnless(MAKE_GRID.exists(), "the program was built without the headers of NanoVDB")
class Volumes(Case):
    """Grids of densities: closed forms, places, what is refused, and the same pictures by all ways to draw them."""

    def grid(self, shape, *form, side=32):
        path = self.folder / f"{shape}{''.join(form)}{side}.nvdb"
        if not path.exists():
            subprocess.run([MAKE_GRID, shape, str(side), path, *form], check=True)
        return path

    def camera_alone(self, **extras):
        """Makes a scene of a camera 3 m before the origin, and a node with these extras."""
        gltf = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
                "cameras": [{"type": "perspective", "perspective": {"yfov": 0.6, "aspectRatio": 1, "znear": 0.01}}],
                "nodes": [{"camera": 0, "translation": [0, 0, 3]}, {"extras": extras} if extras else {"name": "empty"}]}
        return str(self.written(f"camera{len(list(self.folder.glob('camera*')))}.gltf", gltf).with_suffix(""))

    def seen(self, scene, *options, spp=64, size="16,16"):
        return self.picture(scene, "x.pfm", "--resolution", size, "--spp", spp, *options)

    def refused(self, reason, *options, status=3, scene=None):
        done = run("render", scene or self.camera_alone() + ".gltf", "-o", self.folder / "x.pfm", "--spp", 1, "--resolution", "8,8", *options)
        self.assertEqual(done.returncode, status, (options, done.stderr))
        self.assertIn(reason, done.stderr)
        self.assertEqual(sum(": warning: " not in line for line in done.stderr.splitlines()), 1, done.stderr)

    def test_a_grid_dims_by_its_depth(self):
        """Beer's law holds through the middle of a cube of 30 of 32 voxels, for two types and codecs."""
        for form in ((), ("zip", "fp8")):
            seen = self.seen(self.camera_alone(), *WHITE, "--volume", self.grid("box", *form), "--volume-density", 1.6, "--volume-color",
                             "0,0,0", "--camera-view-angle", 1, spp=4096)
            self.assertAlmostEqual(mean(seen) / math.exp(-1.6 * 30 / 32), 1, delta=0.002)

    def test_a_grid_that_only_scatters_is_not_seen_in_white_light(self):
        for anisotropy in (0, 0.7):
            seen = self.seen(self.camera_alone(), *WHITE, "--volume", self.grid("plume"), "--volume-density", 12, "--volume-anisotropy",
                             anisotropy, spp=256)
            self.assertAlmostEqual(mean(seen), 1, delta=0.002)

    def test_a_grid_glows_by_its_temperature(self):
        """A cube of one temperature that scatters nothing has (1 - exp(-depth)) of a black body's radiance."""
        def levels(density):
            seen = self.seen(self.camera_alone(), "--default-light", "none", "--background-color", "0,0,0", "--volume", self.grid("ember"),
                             "--volume-density", density, "--volume-color", "0,0,0", "--volume-emission", 1e-5, "--camera-view-angle", 1,
                             spp=1024)
            return [mean(seen, channel) for channel in range(3)]

        thin, thick = levels(1), levels(60)
        for channel in range(3):
            self.assertAlmostEqual(thin[channel] / thick[channel], 1 - math.exp(-30 / 32), delta=0.01)
        # The candela was once that of a black body at 2042 K: 600,000 cd/m^2.
        luminance = 0.2126 * thick[0] + 0.7152 * thick[1] + 0.0722 * thick[2]
        self.assertAlmostEqual(luminance / 6, 1, delta=0.03)

        # A cube as hot as its surroundings is invisible.
        equal = self.seen(self.camera_alone(), *WHITE, "--volume", self.grid("ember"), "--volume-density", 4, "--volume-color", "0.5,0.5,0.5",
                          "--volume-emission", 1e-5 / thick[0], spp=256)
        self.assertAlmostEqual(mean(equal), 1, delta=0.01)

    def test_place_and_scale(self):
        """A grid that is moved, scaled and made thinner for it looks as the one at the origin from as far away in proportion."""
        here = self.seen(self.camera_alone(), *WHITE, "--volume", self.grid("torus"), "--volume-density", 6, "--volume-color", "0.2,0.5,0.8",
                         spp=512)
        there = self.seen(self.camera_alone(), *WHITE, "--volume", self.grid("torus"), "--volume-density", 3, "--volume-color", "0.2,0.5,0.8",
                          "--volume-scale", 2, "--volume-position", "5,1,0", "--camera-position", "5,1,6", "--camera-focal-point", "5,1,0",
                          spp=512)
        for channel in range(3):
            self.assertAlmostEqual(mean(here, channel) / mean(there, channel), 1, delta=0.01)

    def test_a_node_brings_a_grid(self):
        grid = self.grid("ball")
        members = {"volume": grid.name, "density": 5, "color": [0.5, 0.25, 1], "anisotropy": 0.3, "position": [0.25, 0, 0], "scale": 0.5}
        of_node = self.seen(self.camera_alone(fragtrace_volume=members), *WHITE)
        of_options = self.seen(self.camera_alone(), *WHITE, "--volume", f"{grid}:density", "--volume-density", 5, "--volume-color",
                               "0.5,0.25,1", "--volume-anisotropy", 0.3, "--volume-position", "0.25,0,0", "--volume-scale", 0.5)
        self.assertEqual(of_node, of_options)
        told = json.loads(run("info", "--json", self.camera_alone(fragtrace_volume=members) + ".gltf").stdout)
        self.assertEqual(told["scene"]["bounds"], {"min": [0.0078125, -0.2421875, -0.2421875], "max": [0.5078125, 0.2578125, 0.2578125]})
        self.assertEqual(told["volume_bytes"], 8 * (5**3 + 128 * told["scene"]["volume_bricks"]))
        self.refused("/nodes/1/extras/fragtrace_volume/density", scene=self.camera_alone(fragtrace_volume={**members, "density": -1}) + ".gltf")
        self.refused("/nodes/1/extras/fragtrace_volume/volume",
                     scene=self.camera_alone(fragtrace_volume={**members, "volume": "../x.nvdb"}) + ".gltf")

        # Options change the numbers of a node, and stand for a file that is missing.
        changed = self.seen(self.camera_alone(fragtrace_volume={**members, "density": 1, "color": [1, 1, 1]}), *WHITE, "--volume-density", 5,
                            "--volume-color", "0.5,0.25,1")
        self.assertEqual(changed, of_options)
        missing = self.camera_alone(fragtrace_volume={"volume": "missing.nvdb"})
        self.refused("missing.nvdb", scene=missing + ".gltf")
        self.seen(missing, *WHITE, "--volume", grid, spp=1)

    def test_what_a_grid_does_not_do_is_said(self):
        def warns(reason, *options, **extras):
            scene = self.camera_alone(**({"fragtrace_volume": {"volume": self.grid("plume").name, **extras}} if extras else {}))
            done = run("render", scene + ".gltf", "-o", self.folder / "x.pfm", "--spp", 1, "--resolution", "8,8", *WHITE, *options)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(reason, done.stderr)

        warns("/nodes/1/extras/fragtrace_volume/densty: is no member of a volume", densty=14)
        warns("only stage gi has grids", "--stage", "phong", density=14)
        warns("only stage gi has grids", "--stage", "phong", "--volume", self.grid("plume"))
        warns("the color 1,1,1 absorbs none", emission=1e-5)
        flat = Path(self.camera_alone(fragtrace_volume={"volume": self.grid("plume").name}) + ".gltf")
        gltf = json.loads(flat.read_text())
        gltf["nodes"][1]["scale"] = [1, 0, 1]
        flat.write_text(json.dumps(gltf))
        self.assertIn("the grid's node has no size", run("render", flat, "-o", self.folder / "x.pfm", "--spp", 1, "--resolution", "8,8").stderr)
        warns("paths are long", "--volume-density", 500, density=1)
        self.refused("its plane stands in clear air, but the scene brings a grid", "--shadow-catcher", "bottom", status=2,
                     scene=self.camera_alone(fragtrace_volume={"volume": self.grid("plume").name}) + ".gltf")

    def test_the_camera_fits_it(self):
        """The box of a grid far away is in the picture."""
        seen = self.seen(self.camera_alone(), *WHITE, "--volume", self.grid("ball"), "--volume-position", "40,0,0", "--volume-color", "0,0,0",
                         "--volume-density", 100, "--camera-orbit", "0,0", "--fit", spp=4, size="32,32")
        self.assertLess(mean(seen), 0.8)
        self.assertAlmostEqual(seen[0][0][0], 1, delta=1e-3)

    def test_all_ways_to_draw_it(self):
        """The same bits by all entries, schedules and reads; a region is that of the whole picture."""
        options = ["--volume", self.grid("plume"), "--volume-density", 20, "--volume-color", "0.9,0.8,0.7", "--fog-density", 0.2, "--seed", 3]
        scene = self.camera_alone()
        whole = self.seen(scene, *options, spp=8)
        for way in (["--dispatch", "compute"], ["--schedule", "wavefront"], ["--tune", "gpu"], ["--buffer-reads", "ssbo"]):
            self.assertEqual(self.seen(scene, *options, *way, spp=8), whole, way)
        self.assertEqual(self.seen(scene, *options, "--region", "4,2,8,6", spp=8), [row[4:12] for row in whole[2:8]])

    def test_what_is_listed(self):
        done = run("info", self.grid("plume"))
        self.assertIn('grid        "density" (float), 22 x 30 x 22 voxels, 4708 active', done.stdout)
        grids = json.loads(run("info", "--json", self.grid("plume", "zip", "fp8")).stdout)["grids"]
        self.assertEqual([grid["name"] for grid in grids], ["density", "temperature"])
        self.assertTrue(all(grid["density"] for grid in grids))
        self.assertEqual(grids[0]["bounds"], {"min": [-0.484375] * 3, "max": [0.515625] * 3})
        self.assertAlmostEqual(grids[0]["largest"], 1.12, delta=0.01)

    def test_bad_grids(self):
        self.refused("is not finite", "--volume", self.grid("nan"))
        self.refused("is not finite", "--volume", self.grid("infinite"))
        self.refused("holds no densities (float, a level set)", "--volume", self.grid("levelset"))
        self.refused("has no grid 'heat', but 'density', 'temperature'", "--volume", f"{self.grid('plume')}:heat")
        self.refused("has no grid 'temperature'", "--volume", self.grid("ball"), "--volume-emission", 1)
        self.refused("--volume-density: goes with --volume, or with a scene", "--volume-density", 2, status=2)
        self.refused("is not glTF; --volume places it", scene=self.grid("plume"))
        self.refused("cannot be combined with --shadow-catcher", "--volume", self.grid("ball"), "--shadow-catcher", "bottom", status=2)
        self.refused("--volume-color: a colour is in the range 0 to 1", "--volume", self.grid("ball"), "--volume-color", "2,1,1", status=2)
        self.refused("missing.nvdb", "--volume", self.folder / "missing.nvdb")
        self.refused("box64.nvdb", "--volume", self.grid("box", side=64), "--memory-limit", "1MB")
        text = self.folder / "text.nvdb"
        text.write_text("this is no grid, but a text that is long enough to be one\n" * 20)
        self.refused("text.nvdb", "--volume", text)
        later = self.folder / "later.nvdb"
        data = bytearray(self.grid("ball").read_bytes())
        struct.pack_into("<I", data, 8, 37 << 21)  # the version, whose major number counts
        later.write_bytes(data)
        self.refused("against the newer version", "--volume", later)

    def test_grids_with_little_in_them(self):
        empty = run("render", self.camera_alone() + ".gltf", "-o", self.folder / "x.pfm", "--spp", 1, "--resolution", "8,8", "--volume",
                    self.grid("empty"))
        self.assertEqual(empty.returncode, 0)
        self.assertIn("the grid has no density above 0", empty.stderr)
        # A voxel of 1 is a tent of twice its width, of which a ray through the middle meets as much as the voxel is wide.
        seen = self.seen(self.camera_alone(), *WHITE, "--volume", self.grid("one", side=1), "--volume-color", "0,0,0", "--camera-view-angle",
                         0.05, spp=4096)
        self.assertAlmostEqual(mean(seen) / math.exp(-1), 1, delta=0.004)

    def test_damaged_files(self):
        """Cut, or with other bytes: drawn, or refused with the file's name, and nothing else."""
        draw = random.Random(5)
        whole = self.grid("plume", "none", "fp8").read_bytes()
        path = self.folder / "damaged.nvdb"
        for number in range(24):
            damaged = bytearray(whole)
            if number % 3 == 0:
                damaged = damaged[:draw.randrange(len(whole))]
            else:
                for _ in range(draw.choice((1, 4, 64))):
                    place = draw.randrange(len(whole) if number % 3 == 1 else 2000)
                    damaged[place] = draw.choice((0, 255, draw.randrange(256)))
            path.write_bytes(damaged)
            done = run("render", self.camera_alone() + ".gltf", "-o", self.folder / "x.pfm", "--spp", 1, "--resolution", "4,4", "--volume", path,
                       "--memory-limit", "1GB")
            self.assertIn(done.returncode, (0, 3), (number, done.stderr))
            if done.returncode == 3:
                self.assertIn("damaged.nvdb", done.stderr)


if __name__ == "__main__":
    main()

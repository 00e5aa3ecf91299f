#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Light through smooth walls of thickness 0, on matt ground under a pane wide enough to be all that is above it. With --bounces 1
nothing comes back from the pane, so that irradiance is the integral of the light times what one or two walls let through."""
import json
import math
import random
import statistics
import sys
import types
from pathlib import Path

from support import FRAGTRACE, SCENES, SMALL, WHITE, Case, Exr, Gltf, data_uri, luminances, main, mean, png, quad, read_pfm, run
from known_light_test import MATT, SPECULAR, over_ground

THIN_GLASS_IOR = 1.5
PANE = 2.6    # metres above the ground, and above the camera
WIDE = 400    # half of the width of both
TINT = [0.9, 0.7, 0.5, 1]


def passed(cosine, walls=1, ior=THIN_GLASS_IOR):
    """Returns the share of light that passes thin walls at an angle, without their tint: each wall has two parallel
    interfaces (docs/design/surfaces.md)."""
    refracted = math.sqrt(ior**2 - 1 + cosine**2)
    single = 0.5 * (((ior**2 * cosine - refracted) / (ior**2 * cosine + refracted))**2 + ((cosine - refracted) / (cosine + refracted))**2)
    return (1 - 2 * single / (1 + single))**walls


class ThinGlass(Case):
    def scene(self, panes, lights=(), lamps=(), **material):
        """Makes a scene of ground under panes of clear glass. `panes` are heights, `lights` the angles of directional
        lights to the vertical, `lamps` places, half widths and radiances."""
        glass = {"pbrMetallicRoughness": MATT | {"roughnessFactor": 0, "baseColorFactor": TINT},
                 "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}}}
        glass["pbrMetallicRoughness"] |= material.pop("surface", {})
        if "mode" in material:
            glass["alphaMode"] = material.pop("mode")
        glass["extensions"] |= material
        gray = [material.pop("ground", 1)] * 3 + [1]
        gltf = quad({"pbrMetallicRoughness": MATT | {"baseColorFactor": gray}, "extensions": SPECULAR})
        gltf["nodes"][0]["scale"] = [WIDE, WIDE, 1]
        primitive = gltf["meshes"][0]["primitives"][0]

        def place(material, **node):
            gltf["materials"].append(material)
            gltf["meshes"].append({"primitives": [dict(primitive, material=len(gltf["materials"]) - 1)]})
            gltf["nodes"].append({"mesh": len(gltf["meshes"]) - 1} | node)

        for height in panes:
            place(glass, translation=[0, 0, height], scale=[WIDE, WIDE, 1])
        for where, half, radiance in lamps:
            place({"pbrMetallicRoughness": MATT | {"baseColorFactor": [0, 0, 0, 1]}, "emissiveFactor": [1, 1, 1],
                   "extensions": SPECULAR | {"KHR_materials_emissive_strength": {"emissiveStrength": radiance}}},
                  translation=where, rotation=[1, 0, 0, 0], scale=[half, half, 1])
        for i, angle in enumerate(lights):
            gltf["nodes"].append({"rotation": [math.sin(angle / 2), 0, 0, math.cos(angle / 2)],
                                  "extensions": {"KHR_lights_punctual": {"light": i}}})
        if lights:
            gltf["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": math.pi} for _ in lights]}}
        gltf["scenes"] = [{"nodes": list(range(len(gltf["nodes"])))}]
        return str(self.written("panes.gltf", {key: value for key, value in gltf.items() if value}).with_suffix(""))

    def seen(self, scene, *options, spp=1, side=16):
        return self.picture(scene, "x.pfm", "--resolution", f"{side},{side}", "--spp", spp, "--no-default-light", *options)

    def channel(self, picture, index=0):
        return statistics.fmean(pixel[index] for row in picture for pixel in row)

    def assert_everywhere(self, picture, wanted, part=1e-5):
        for row in picture:
            for pixel in row:
                for value, expected in zip(pixel, wanted):
                    self.assertAlmostEqual(value, expected, delta=part * max(expected, 1))

    def test_each_wall_takes_its_share_once(self):
        """A directional light is one direction, so that each pixel is exact."""
        for angle, panes in ((0, [PANE]), (0.9, [PANE]), (1.4, [PANE, PANE + 0.5]), (0.9, [PANE, PANE, PANE + 1])):
            wanted = [math.cos(angle) * passed(math.cos(angle), len(panes)) * tint**len(panes) for tint in TINT[:3]]
            self.assert_everywhere(self.seen(self.scene(panes, [angle]), "--bounces", 1), wanted)

    def test_what_the_material_says_counts(self):
        """A transmission of 0.5 halves the light. Clearcoat and the index of refraction change it. A solid blocks
        shadow rays."""
        angle = 0.6
        cosine = math.cos(angle)
        plain = [cosine * passed(cosine) * tint for tint in TINT[:3]]

        def light(**material):
            return self.seen(self.scene([PANE], [angle], **material), "--bounces", 1, "--caustics", "off")

        self.assert_everywhere(light(KHR_materials_transmission={"transmissionFactor": 0.5}), [0.5 * value for value in plain])
        self.assert_everywhere(light(KHR_materials_ior={"ior": 2}), [cosine * passed(cosine, ior=2) * tint for tint in TINT[:3]])
        coat = 0.6 * (0.04 + 0.96 * (1 - cosine)**5)
        self.assert_everywhere(light(KHR_materials_clearcoat={"clearcoatFactor": 0.6}), [(1 - coat) * value for value in plain])
        # The ground lies within its thickness: it is no pane.
        self.assert_everywhere(light(KHR_materials_volume={"thicknessFactor": 3}), [0, 0, 0])

    def test_a_pane_that_covers_in_part(self):
        """BLEND: where the pane is, as much as its alpha, it is glass. Ground so dark that what comes back from the pane is nothing."""
        angle, alpha, dark = 0.6, 0.4, 0.01
        cosine = math.cos(angle)
        scene = self.scene([PANE], [angle], surface={"baseColorFactor": TINT[:3] + [alpha]}, mode="BLEND", ground=dark)
        picture = self.seen(scene, "--bounces", 1, "--caustics", "off", spp=256)
        for i, tint in enumerate(TINT[:3]):
            glass = passed(cosine) * tint
            error = dark * cosine * (1 - glass) * math.sqrt(alpha * (1 - alpha) / (256 * 16 * 16))
            self.assertAlmostEqual(self.channel(picture, i), dark * cosine * (1 - alpha + alpha * glass), delta=5 * error)

    def test_a_wall_counts_as_a_bounce(self):
        direct = ("--bounces", 0, "--caustics", "off")
        self.assert_everywhere(self.seen(self.scene([PANE], [0.5]), *direct), [0, 0, 0])
        bare = self.seen(self.scene([], [0.5]), *direct)
        self.assert_everywhere(bare, [math.cos(0.5)] * 3)

    def test_light_straight_through_is_not_clamped(self):
        scene = self.scene([PANE], [0.5], [((0.3, 0, 3.2), 0.8, 3)])
        free, clamped = (self.seen(scene, "--bounces", 1, *options, spp=16) for options in ([], ["--clamp-indirect", 1e-3]))
        self.assertEqual(free, clamped)

    def test_before_global_illumination(self):
        lit, through = (self.seen(self.scene(panes, [0.5]), "--stage", "refraction")[8][8] for panes in ([], [PANE]))
        for with_pane, without, tint in zip(through, lit, TINT):  # 0.03 of both is ambient light
            self.assertAlmostEqual((with_pane - 0.03) / (without - 0.03), passed(math.cos(0.5)) * tint, delta=1e-5)

    def lamp_light(self, x, y, lamp, parts=24):
        (cx, cy, cz), half, radiance = lamp
        total = 0.0
        for i in range(parts):
            for j in range(parts):
                px, py = (c + half * (2 * (k + 0.5) / parts - 1) for c, k in ((cx, i), (cy, j)))
                squared = (px - x)**2 + (py - y)**2 + cz**2
                cosine = cz / math.sqrt(squared)
                total += cosine**2 / squared * passed(cosine)
        return radiance * total * (2 * half / parts)**2

    def test_a_lamp_by_light_samples_and_by_paths(self):
        """Both ways are weighed against one another: a density that one of them gets wrong would show."""
        lamp = ((0.4, -0.2, 3.0), 1.2, 2.0)
        wanted = over_ground(lambda x, y: self.lamp_light(x, y, lamp) / math.pi) * TINT[0]
        scene = self.scene([PANE], lamps=[lamp])
        for options, spp, part in (([], 64, 2e-3), (["--disable", "light-sampling"], 1024, 6e-3)):
            seeds = [self.channel(self.seen(scene, "--bounces", 1, "--seed", seed, *options, spp=spp, side=32)) for seed in range(4)]
            error = statistics.stdev(seeds) / 2
            print(f"{options}: {statistics.fmean(seeds) / wanted - 1:+.4%}, standard error {error / wanted:.4%}")
            self.assertLess(5 * error / wanted, part)
            self.assertAlmostEqual(statistics.fmean(seeds) / wanted, 1, delta=part)

    def test_a_sky(self):
        """The mean over the cosine-weighted hemisphere."""
        steps = 4096
        angles = [math.pi / 2 * (i + 0.5) / steps for i in range(steps)]
        wanted = TINT[0] * sum(2 * math.sin(a) * math.cos(a) * passed(math.cos(a)) for a in angles) * math.pi / 2 / steps
        path = self.folder / "white.pfm"
        path.write_bytes(b"PF\n4 2\n-1.0\n" + b"\0\0\x80\x3f" * 24)
        for options in ([], ["--disable", "light-sampling"]):
            seen = self.channel(self.seen(self.scene([PANE]), "--bounces", 1, "--hdri-file", path, *options, spp=256, side=32))
            print(f"{options}: {seen / wanted - 1:+.4%}")
            self.assertAlmostEqual(seen / wanted, 1, delta=2e-3)

    def test_glass_that_lies_on_the_ground(self):
        """A pane, and a slab that bends light: both let through what two parallel interfaces do, and the rest comes back. What the ground sends up is b:
        b = albedo (through + (1 - through) b) of the mean over the hemisphere."""
        albedo, steps, place = 0.5, 4096, (3.3, -1.7, 5.1)
        angles = [math.pi / 2 * (i + 0.5) / steps for i in range(steps)]
        through = sum(2 * math.sin(a) * math.cos(a) * passed(math.cos(a)) for a in angles) * math.pi / 2 / steps
        ground = albedo * through / (1 - albedo * (1 - through))
        wanted = over_ground(lambda x, y: 1 - (1 - ground) * passed(2.2 / math.sqrt(x * x + y * y + 2.2**2)))
        sky = self.folder / "white.pfm"
        sky.write_bytes(b"PF\n4 2\n-1.0\n" + b"\0\0\x80\x3f" * 24)
        for thickness, heights, wide in ((0, [0], WIDE), (1, [0.5, 0], WIDE), (1, [0.5, 0], 300)):
            gltf = quad({"pbrMetallicRoughness": MATT | {"baseColorFactor": [albedo] * 3 + [1]}, "extensions": SPECULAR})
            gltf["materials"].append({"pbrMetallicRoughness": MATT | {"roughnessFactor": 0},
                                      "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1},
                                                     "KHR_materials_volume": {"thicknessFactor": thickness}}})
            gltf["nodes"][0]["scale"] = [WIDE, WIDE, 1]
            gltf["meshes"].append({"primitives": [dict(gltf["meshes"][0]["primitives"][0], material=1)]})
            gltf["nodes"] += [{"mesh": 1, "scale": [wide, wide, 1], "translation": [0, 0, z]} | ({"rotation": [1, 0, 0, 0]} if thickness and not z else {})
                              for z in heights]
            for turned in ({}, {"rotation": [0.18, 0.36, -0.27, 0.875], "translation": place}):
                gltf["nodes"].append({"children": list(range(len(heights) + 2))} | turned)
                gltf["scenes"] = [{"nodes": [len(gltf["nodes"]) - 1]}]
                path = self.written("lying.gltf", gltf)
                seen = self.channel(self.picture(str(path.with_suffix("")), "x.pfm", "--resolution", "32,32", "--spp", 256, "--hdri-file", sky))
                gltf["nodes"].pop()
                print(f"thickness {thickness}, {wide} wide, {turned}: {seen / wanted - 1:+.4%}")
                self.assertAlmostEqual(seen / wanted, 1, delta=3e-3)


LINE = "is on a part that bounds no solid; such a part is drawn as a thin wall"


def turned(*profile, sides=24):
    """The surface that a line of (radius, height) sweeps about the y axis."""
    places = [(r * math.cos(2 * math.pi * i / sides), y, r * math.sin(2 * math.pi * i / sides)) for r, y in profile for i in range(sides)]
    corners = []
    for ring in range(len(profile) - 1):
        for i in range(sides):
            a, b = ring * sides + i, ring * sides + (i + 1) % sides
            corners += [a, a + sides, b, b, a + sides, b + sides]
    return [places[i] for i in corners]


def square(half, place=(0, 0, 0), axes=((1, 0, 0), (0, 0, -1))):
    corners = [tuple(place[c] + half * (u * axes[0][c] + v * axes[1][c]) for c in range(3)) for u, v in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    return [corners[i] for i in (0, 1, 2, 0, 2, 3)]


BASIN = square(2) + [corner for side, up in (((1, 0, 0), (0, 0, 1)), ((-1, 0, 0), (0, 0, -1)), ((0, 0, 1), (-1, 0, 0)), ((0, 0, -1), (1, 0, 0)))
                     for corner in square(2, [2 * s for s in side], ((0, 1, 0), up))]


class OpenPanes(Case):
    """Glass with a thickness whose mesh bounds no solid: a pane is a thin wall, and a line says so; what other surfaces close stays a solid."""

    def scene(self, glass, opaque=(), thickness=0.02, liquid=(), name="scene.gltf"):
        """Meshes of triangles without indices: of glass, of matter, and another of glass."""
        gltf = Gltf()
        solid = {"doubleSided": True, "pbrMetallicRoughness": {"roughnessFactor": 0, "metallicFactor": 0},
                 "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1},
                                "KHR_materials_volume": {"thicknessFactor": thickness, "attenuationColor": [0.2, 0.9, 0.2], "attenuationDistance": 0.5}}}
        meshes = [(0, glass), (1, opaque), (0, liquid)]
        gltf.root["materials"] = [solid, {"doubleSided": True}]
        gltf.root["meshes"] = [{"primitives": [{"attributes": {"POSITION": gltf.accessor(mesh)}, "material": material}]} for material, mesh in meshes if mesh]
        gltf.root["nodes"] = [{"mesh": i} for i in range(len(gltf.root["meshes"]))]
        gltf.root["scenes"] = [{"nodes": list(range(len(gltf.root["nodes"])))}]
        gltf.root["extensionsUsed"] = ["KHR_materials_transmission", "KHR_materials_volume"]
        return gltf.write(self.folder / name)

    def lines(self, *arguments, **options):
        result = run("info", self.scene(*arguments, **options))
        self.assertEqual(result.returncode, 0, result.stderr)
        return [line for line in result.stderr.splitlines() if LINE in line]

    def test_panes_are_thin_walls(self):
        upright = ((1, 0, 0), (0, 1, 0))
        frame = [corner for x, y in ((0, 1.05), (0, -1.05), (1.05, 0), (-1.05, 0)) for corner in square(1.1, (x, y, 0), ((0 if x else 1, 1 if x else 0, 0), (0, 0, 1)))]
        for of, arguments in (("in the air", [square(1, axes=upright)]), ("before a wall", [square(1, axes=upright), square(3, (0, 0, -1), upright)]),
                              ("on a table", [square(1, (0, 1, 0), upright), square(3)]), ("in a frame", [square(1.05, axes=upright), frame]),
                              ("a windscreen", [turned((1, 0), (1, 1))]), ("a shade", [turned((0.5, 0.5), (0.35, 0.15), (0, 0))])):
            lines = self.lines(*arguments)
            self.assertEqual(len(lines), 1, of)
            self.assertIn("/materials/0: has a thickness, and", lines[0])

    def test_a_pane_is_drawn_as_one_of_no_thickness(self):
        pane = square(1, axes=((1, 0, 0.3), (0, 1, 0)))
        thick, thin = (self.scene(pane, square(3, (0, 0, -1), ((1, 0, 0), (0, 1, 0))), thickness, name=f"{thickness}.gltf") for thickness in (0.02, 0))
        pictures = []
        for scene in (thick, thin):
            self.renders(scene, "-o", self.folder / "x.exr", *SMALL, "--studio")
            pictures.append(Exr(self.folder / "x.exr").layers)
        self.assertEqual(*pictures)

    def test_two_panes_are_one_line(self):
        apart = square(1, axes=((1, 0, 0), (0, 1, 0))) + square(1, (3, 0, 0), ((1, 0, 0), (0, 1, 0)))
        self.assertIn("(2 times)", self.lines(apart)[0])

    def test_water_over_a_bed_is_a_solid(self):
        self.assertEqual(self.lines(square(2, (0, 1, 0)), BASIN, thickness=1), [])
        self.assertEqual(self.lines(square(2, (0, 0.9, 0)), square(2.5), thickness=1), [])  # without walls

    def test_a_glass_with_liquid_of_another_mesh_is_a_solid(self):
        glass, liquid = turned((0, 0), (0.5, 0), (0.5, 1)), turned((0.4999, 1), (0, 1))
        self.assertEqual(self.lines(glass, liquid=liquid, thickness=0.5), [])
        self.assertEqual(len(self.lines(glass, thickness=0.5)), 1)

    def test_an_open_vessel_is_a_solid(self):
        cup = turned((0, 0), (0.5, 0), (0.5, 1), (0.45, 1), (0.45, 0.05), (0, 0.05))
        self.assertEqual(self.lines(cup), [])
        jar = turned((0.5, 0), (0.5, 1), (0, 1))  # its bottom is the table
        self.assertEqual(self.lines(jar, square(3)), [])
        self.assertEqual(len(self.lines(jar)), 1)

    def test_edges_that_meet_inside_of_others_are_closed(self):
        """A box, one of whose faces has a vertex on an edge of its neighbours."""
        faces = [square(1, place, axes) for place, axes in (((0, 1, 0), ((1, 0, 0), (0, 0, -1))), ((0, -1, 0), ((1, 0, 0), (0, 0, 1))), ((1, 0, 0), ((0, 0, -1), (0, 1, 0))),
                                                            ((-1, 0, 0), ((0, 0, 1), (0, 1, 0))), ((0, 0, 1), ((1, 0, 0), (0, 1, 0))))]
        corners = [(1, -1, -1), (0, -1, -1), (-1, -1, -1), (-1, 1, -1), (1, 1, -1)]
        last = [corners[i] for i in (0, 1, 4, 1, 2, 3, 1, 3, 4)]
        self.assertEqual(self.lines([corner for face in faces for corner in face] + last), [])


# Solids: cells of the matrix of tests/campaign/solids.py, cameras and lamps inside of solids, and surfaces at one place.
sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "campaign"))
import solids  # noqa: E402
from solids import IOR, Model, glass, matt  # noqa: E402

# Faults in dimShadow, standInside, passMedium and the rows of paths that begin are seen by these.
CHOSEN = ("outside tank point inside", "outside tank quad inside caustics", "outside tank spot alpha schedules", "outside outside quad thin schedules", "outside other quad inside",
          "outside outside environment inside", "glass tank quad alpha schedules caustics", "glass outside quad outside", "glass other quad inside caustics", "glass outside environment thin",
          "glass tank spot outside", "absorbing tank point inside", "absorbing outside point outside", "absorbing tank point alpha schedules", "absorbing tank quad thin caustics",
          "absorbing other quad inside schedules", "absorbing outside quad inside", "absorbing outside environment alpha", "scattering tank quad inside", "scattering tank point alpha schedules",
          "scattering outside environment outside schedules", "scattering other quad inside", "fog tank quad inside schedules", "fog outside point outside")
LAMP = {**matt((0, 0, 0)), "emissiveFactor": [1, 1, 1]}
WATER = {"attenuationColor": [0.5, 0.25, 0.1], "attenuationDistance": 1}


class Solids(Case):
    def seen(self, model, *options, at="0,0,0", to="0,-1,0", angle=5, size="12,12", spp=16, name="model"):
        path = self.folder / f"{name}.gltf"
        model.write(path)
        words = ["--camera-position", at, "--camera-focal-point", to, "--camera-view-up", "0,0,-1"]
        if "--camera-parallel-scale" not in options:
            words += ["--camera-view-angle", angle]
        self.renders(path, "-o", path.with_suffix(".pfm"), "--quiet", "--resolution", size, "--spp", spp, *words, *options)
        return read_pfm(path.with_suffix(".pfm"))

    def test_cells_of_the_matrix(self):
        ground = types.SimpleNamespace(fragtrace=FRAGTRACE)
        for words in CHOSEN:
            cell, compared = tuple(words.split()[:4]), words.split()[4:]
            folder = self.folder / words.replace(" ", "-") / "work"
            folder.mkdir(parents=True)
            with self.subTest(words):
                try:
                    solids.case(ground, None, solids.CELLS.index(cell), folder, compared)
                except solids.Finding as finding:
                    self.fail(str(finding))

    def test_radiance_inside_is_that_outside_times_the_squared_index(self):
        """In a white world a camera in glass, in white milk, and in glass within glass sees the same light everywhere, on a white plate too."""
        milk = glass(volume={"attenuationColor": [0.3, 0.3, 0.3], "attenuationDistance": 0.5}, scatter={"scatterStrengthFactor": 1})
        for name, outer, inner in (("glass", glass(), None), ("milk", milk, None), ("nested", glass(), glass())):
            for schedule in ("megakernel", "wavefront"):
                model = Model()
                model.box(2, outer)
                right = IOR ** 2
                if inner:
                    model.box(1, inner)
                    right *= IOR ** 2
                model.plate(0.3, matt((1, 1, 1), doubleSided=True), (0, -0.7, 0))
                seen = luminances(self.seen(model, *WHITE, "--schedule", schedule, angle=60, spp=64))
                with self.subTest(f"{name} {schedule}"):
                    self.assertAlmostEqual(sum(seen) / len(seen), right, delta=0.01 * right)

    def test_behind_a_solid_inside_of_another_is_the_outer_one(self):
        """A camera in a box of clear glass in a tank of water looks at a lamp in the water: a metre of it is in between."""
        model = Model()
        model.box(3, glass(volume=WATER))
        model.box(0.5, glass())
        model.plate(1, {**LAMP, "doubleSided": True}, (0, -1.5, 0))
        seen = self.seen(model, "--no-default-light", angle=1)
        passes = (1 - ((IOR - 1) / (IOR + 1)) ** 2) * IOR ** 2
        for channel, color in enumerate(WATER["attenuationColor"]):
            self.assertAlmostEqual(mean(seen, channel) / (passes * color), 1, delta=0.01)

    def test_solids_that_touch_each_take_their_share(self):
        """One on the other, and one that fills a corner of the other."""
        colors = (0.8, 0.5, 0.2), (0.5, 0.9, 0.6)
        water = [glass(volume={"attenuationColor": list(color), "attenuationDistance": 1}) for color in colors]
        for material in water:
            material["extensions"]["KHR_materials_ior"]["ior"] = 1
        for half, place in ((1, (0, -1, 0)), (0.5, (0.2, 0.5, 0.2))):
            for first in (0, 1):
                model = Model()
                parts = [lambda: model.box(1, water[0], (0, 1, 0)), lambda: model.box(half, water[1], place)]
                for part in (parts if first else reversed(parts)):
                    part()
                model.plate(3, {**LAMP, "doubleSided": True}, (0, -3, 0))
                seen = self.seen(model, "--no-default-light", at="0,3,0", angle=1, spp=64)
                ways = (2, 2) if half == 1 else (1, 1)  # metres in each alone
                for channel in range(3):
                    right = colors[0][channel] ** ways[0] * colors[1][channel] ** ways[1]
                    with self.subTest(half=half, first=first, channel=channel):
                        self.assertAlmostEqual(mean(seen, channel) / right, 1, delta=0.01)

    def test_an_orthographic_camera_inside_sees_absorption(self):
        model = Model()
        model.box(2, glass(volume=WATER))
        model.plate(1.5, {**LAMP, "doubleSided": True}, (0, -1.5, 0))
        seen = self.seen(model, "--camera-type", "orthographic", "--camera-parallel-scale", 0.2, "--no-default-light", at="0,0.5,0")
        self.assertAlmostEqual(mean(seen), 0.25, delta=1e-4)

    def test_rays_of_an_orthographic_camera_begin_in_solids_of_their_own(self):
        """The camera's middle is outside, so the back of the milk says that its left rays have come through it: what scatters nearly nothing on takes
        its share of them by chance."""
        distance, share = 2.5, 0.3
        milk = glass(volume={"attenuationColor": [share] * 3, "attenuationDistance": distance}, scatter={"scatterStrengthFactor": 1, "multiscatterColorFactor": [1e-4] * 3})
        milk["extensions"]["KHR_materials_ior"]["ior"] = 1
        model = Model()
        model.box(2, milk)
        model.plate(9, {**LAMP, "doubleSided": True}, (0, -2.5, 0))
        seen = self.seen(model, "--camera-type", "orthographic", "--camera-parallel-scale", 0.5, "--no-default-light", at="2.2,0.5,0", to="2.2,-1,0", size="32,32", spp=256)
        for columns, right in ((slice(0, 8), share), (slice(24, 32), 1)):
            part = [row[columns] for row in seen]
            self.assertAlmostEqual(mean(part), right, delta=5 * math.sqrt(right * (1 - right) / (8 * 32 * 256)) + 1e-5)

    def test_a_camera_plane_that_cuts_a_solid_is_told(self):
        """That of an orthographic camera, and a lens."""
        model = Model()
        model.box(2, glass(volume=WATER))
        model.write(self.folder / "model.gltf")
        orthographic = ("--camera-type", "orthographic", "--camera-parallel-scale", 0.5)
        for at, says, options in ((0, None, orthographic), (1.8, "the orthographic camera looks cuts a solid that lets light in: all rays count as beginning inside", orthographic),
                                  (2.2, "count as beginning outside", orthographic), (2.6, None, orthographic),
                                  (2.01, "the lens cuts a solid", ("--f-stop", 0.2)), (2.1, None, ("--f-stop", 0.2))):
            told = run("render", self.folder / "model.gltf", "-o", self.folder / "x.pfm", "--resolution", "8,8", "--spp", 1, "--studio", "--camera-position", f"{at},0.5,0",
                       "--camera-focal-point", f"{at},-1,0", "--camera-view-up", "0,0,-1", *options).stderr
            with self.subTest(at=at, options=options):
                self.assertIn(says or "", told)
                self.assertEqual("cuts a solid" in told, says is not None, told)

    def test_a_room_behind_a_pane_is_not_inside_of_it(self):
        """A pane that is a single face from wall to wall, with a thickness: the camera behind it sees the world through it without tint, and not scaled."""
        model = Model()
        model.box(2, matt((0, 0, 0)))
        model.plate(2, glass(volume=WATER), (0, 1.8, 0))
        model.plate(0.9, {**LAMP, "doubleSided": True}, (0, 1.95, 0))
        seen = mean(self.seen(model, "--no-default-light", to="0,1,0"))
        self.assertAlmostEqual(seen, 1 - ((IOR - 1) / (IOR + 1)) ** 2, delta=0.01)

    def test_cut_outs_keep_what_the_way_to_them_has_taken(self):
        """A camera in milk that absorbs blue sees a lamp through a card with alpha: by both schedules the same bits."""
        milk = glass(volume={"attenuationColor": [0.8, 0.5, 0.1], "attenuationDistance": 1}, scatter={"scatterStrengthFactor": 1, "multiscatterColorFactor": [0.3, 0.3, 0.3]})
        model = Model()
        model.box(2, milk)
        model.plate(1, matt((0, 0, 0), 0.5, alphaMode="BLEND", doubleSided=True), (0, -0.7, 0))
        model.plate(1, {**LAMP, "doubleSided": True}, (0, -1.2, 0))
        one, other = (self.seen(model, "--no-default-light", "--schedule", schedule, spp=64) for schedule in ("megakernel", "wavefront"))
        self.assertEqual(one, other)
        self.assertLess(mean(one, 2) / mean(one, 0), 0.2)

    def test_a_point_lamp_in_milk_lights_it(self):
        """The boundary bends light, so nothing but light samples can find the lamp; a small ball of the same power in its place gives at least as much."""
        milk = glass(volume={"attenuationColor": [0.6, 0.6, 0.6], "attenuationDistance": 1}, scatter={"scatterStrengthFactor": 1})
        lit = []
        for ball in (False, True):
            model = Model()
            model.box(2, milk)
            if ball:
                # An octahedron of radius r sends r^2 x radiance x 2 pi sqrt(3) / 2 / pi on average into each direction.
                r = 0.05
                strength = solids.POWER["point"] / (r * r * math.sqrt(3))
                points = [(r, 0, 0), (-r, 0, 0), (0, r, 0), (0, -r, 0), (0, 0, r), (0, 0, -r)]
                faces = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
                lamp = {**LAMP, "extensions": {**LAMP["extensions"], "KHR_materials_emissive_strength": {"emissiveStrength": strength}}}
                model.body(points, faces, lamp, (0.6, -1, 0))
            else:
                model.light("point", (0.6, -1, 0))
            lit.append(mean(self.seen(model, "--no-default-light", spp=256)))
        self.assertGreater(lit[0], 0.5 * lit[1])
        self.assertLess(lit[0], 1.05 * lit[1])

    def test_a_black_channel_absorbs_all(self):
        model = Model()
        model.box(1, glass(volume={"attenuationColor": [0, 1, 1], "attenuationDistance": 1000}))
        model.plate(5, LAMP, (0, -3, 0))
        seen = self.seen(model, "--no-default-light", at="0,3,0")
        self.assertEqual(mean(seen, 0), 0)
        self.assertGreater(mean(seen, 1), 0.9)

    def test_rough_glass_does_not_trap_bright_dots(self):
        model = Model()
        rough = glass()
        rough["pbrMetallicRoughness"]["roughnessFactor"] = 0.25
        model.box(1, rough)
        seen = luminances(self.seen(model, *WHITE, at="1,3,2", to="0,0,0", angle=40, size="32,32", spp=64))
        self.assertLess(max(seen), 1.3)
        self.assertAlmostEqual(sum(seen) / len(seen), 1, delta=0.01)


class OnePlace(Case):
    """Surfaces at the same place within rounding."""

    seen = Solids.seen

    def room(self, scale=1.0, turn=(0, 0, 0, 1), lamp_first=True, drop=0.0, copies=False):
        """A lamp in a ceiling over a floor, turned as a whole; both are so wide that rounding at their corners exceeds what a shadow ray leaves out."""
        model = Model()
        parts = [lambda: model.body(solids_square(0.25 * scale, -1), [(0, 1, 2), (0, 2, 3)], {**LAMP, "doubleSided": True}, (0.1 * scale, (1 - drop) * scale, 0)),
                 lambda: model.body(solids_square(6 * scale, -1), [(0, 1, 2), (0, 2, 3)], matt((0.8, 0.8, 0.8), doubleSided=True), (0, scale, 0))]
        for part in parts if lamp_first else reversed(parts):
            part()
        model.body(solids_square(6 * scale, 1), [(0, 1, 2), (0, 2, 3)], matt((0.8, 0.8, 0.8), doubleSided=True), (0, -scale, 0))
        if copies:
            model.node(mesh=0 if not lamp_first else 1, translation=[0, 3 * scale, 0])
        children = list(range(len(model.root["nodes"])))
        model.root["nodes"].append({"children": children, "rotation": list(turn)})
        model.root["scenes"][0]["nodes"] = [len(model.root["nodes"]) - 1]
        return model

    def light(self, model, *options, scale=1.0, turn=(0, 0, 0, 1)):
        at, to, up = (",".join(map(str, rotated(turn, [scale * c for c in p]))) for p in ((0, -0.9, 3.5), (0, -0.2, 0), (0, 1, 0)))
        path = self.folder / "room.gltf"
        model.write(path)
        self.renders(path, "-o", path.with_suffix(".pfm"), "--quiet", "--resolution", "24,24", "--spp", 256, "--no-default-light", "--bounces", 2, "--camera-position", at,
                     "--camera-focal-point", to, "--camera-view-up", up, "--camera-view-angle", 45, *options)
        return mean(read_pfm(path.with_suffix(".pfm")))

    def test_a_lamp_in_the_plane_of_a_ceiling_loses_no_light(self):
        askew = (0.2, 0.3, -0.1, math.sqrt(1 - 0.14))
        for scale, turn in ((1.0, (0, 0, 0, 1)), (1e-3, askew), (1e3, askew)):
            right = self.light(self.room(scale, turn, drop=1e-3), scale=scale, turn=turn)
            for first in (True, False):
                for options in ((), ("--disable", "light-sampling"), ("--schedule", "wavefront"), ("--instancing", "share")):
                    seen = self.light(self.room(scale, turn, first, copies=options[:1] == ("--instancing",)), *options, scale=scale, turn=turn)
                    with self.subTest(scale=scale, turn=turn, first=first, options=options):
                        self.assertAlmostEqual(seen / right, 1, delta=0.1 if "light-sampling" in options else 0.02)

    def test_of_faces_back_to_back_the_one_that_faces_the_camera_is_seen(self):
        """A box that is scaled flat, with both sides double-sided."""
        for turn in ((0, 0, 0, 1), (0.2, 0.3, -0.1, math.sqrt(1 - 0.14))):
            model = Model()
            model.body(solids_square(1, 1), [(0, 1, 2), (0, 2, 3)], matt((1, 0, 0), doubleSided=True))
            model.body(solids_square(1, -1), [(0, 1, 3), (1, 2, 3)], matt((0, 1, 0), doubleSided=True))
            for node in model.root["nodes"]:
                node["rotation"] = list(turn)
            for side, channel in ((1, 0), (-1, 1)):
                place = ",".join(map(str, rotated(turn, (0.4, 3 * side, 0.2))))
                for row in self.seen(model, "--stage", "flat", at=place, to="0,0,0", angle=20, size="64,64", spp=4):
                    for pixel in row:
                        self.assertEqual(pixel, tuple(1.0 if i == channel else 0.0 for i in range(3)))


def solids_square(half, facing):
    """A level square that faces up (1) or down (-1)."""
    points = [(-half, 0, half), (half, 0, half), (half, 0, -half), (-half, 0, -half)]
    return points if facing > 0 else [points[i] for i in (0, 3, 2, 1)]


def rotated(q, v):
    x, y, z, w = q
    a, b, c = v
    tx, ty, tz = 2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)
    return [a + w * tx + y * tz - z * ty, b + w * ty + z * tx - x * tz, c + w * tz + x * ty - y * tx]


HOLE = [255, 255, 255, 0]


class CutOut(Case):
    """Triangles that alpha cuts out wholly: the picture is the one without them, at the cost of one without them."""

    def leaves(self, layers, cards=400, name="leaves", nothing=None, animation=False, **material):
        """A ground under a lamp, with layers of cards between: each is a square of random direction. The material of the cards has a
        picture of which nothing but the upper left texel is there, or it is `nothing`: colours without a picture."""
        draw = random.Random(3)
        gltf = Gltf()
        gltf.root["materials"] = [
            {"pbrMetallicRoughness": {"baseColorFactor": [0.7, 0.6, 0.5, 1], "metallicFactor": 0}, "doubleSided": True},
            {"emissiveFactor": [1, 1, 1], "doubleSided": True},
            {"pbrMetallicRoughness": nothing or {"baseColorTexture": {"index": 0}}, "alphaMode": "MASK", "doubleSided": True, **material}]
        if nothing is None:
            gltf.root["images"] = [{"uri": data_uri("image/png", png(64, 64, [9, 200, 9, 255] + HOLE * (64 * 64 - 1)))}]
            gltf.root["textures"] = [{"source": 0}]

        def squares(middles, half, material, low=0.2, high=0.9):
            points, coordinates, indices = [], [], []
            for middle, across, up in middles:
                first = len(points)
                for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
                    points.append([m + half * ((2 * u - 1) * a + (2 * v - 1) * b) for m, a, b in zip(middle, across, up)])
                    coordinates.append([low + (high - low) * u, low + (high - low) * v])
                indices += [first + i for i in (0, 1, 2, 0, 2, 3)]
            return gltf.mesh(gltf.accessor(indices, "I"), position=gltf.accessor(points), texcoord_0=gltf.accessor(coordinates), material=material)

        gltf.node(mesh=squares([([0, 0, 0], [1, 0, 0], [0, 0, 1])], 3, 0))
        gltf.node(mesh=squares([([0, 3, 0], [1, 0, 0], [0, 0, 1])], 0.5, 1))
        for layer in range(layers):
            cards_of = []
            for _ in range(cards):
                angle = draw.uniform(0, 3)
                tilt = [draw.uniform(-0.3, 0.3) for _ in range(2)]
                middle = [draw.uniform(-2, 2), 0.5 + 2 * (layer + draw.random()) / max(layers, 1), draw.uniform(-2, 2)]
                cards_of.append((middle, [1, tilt[0], angle - 1.5], [angle - 1.5, tilt[1], -1]))
            gltf.node(mesh=squares(cards_of, 0.1, 2))
        if animation:
            gltf.moves(1, [0, 1], translation=[[0, 0, 0], [1, 0, 0]])
        return gltf.write(self.folder / f"{name}.gltf")

    VIEW = ["--camera-position", "0,1.5,7", "--camera-focal-point", "0,1,0", "--scene-origin", "0,0,0", "--resolution", "32,32", "--spp", 2,
            "--bounces", 2, "--seed", 1]

    def drawn(self, scene, *options):
        """Returns the bytes of the picture, and its statistics."""
        path, stats = self.folder / "x.pfm", self.folder / "x.json"
        self.renders(scene, "-o", path, "--quiet", "--stats", stats, *self.VIEW, *options)
        return path.read_bytes(), json.loads(stats.read_text())

    def same(self, with_cards, without, count, *options):
        seen, told = self.drawn(with_cards, *options)
        self.assertEqual(told["bvh"].get("cut_out_triangles", 0), count)
        self.assertEqual(seen == self.drawn(without, *options)[0], True, options)
        return told

    def test_the_picture_is_that_without_them(self):
        without = self.leaves(0, name="without")
        for nothing, mode in ((None, {}), (None, {"alphaMode": "BLEND"}), ({"baseColorFactor": [1, 1, 1, 0.4]}, {}),
                              ({"baseColorFactor": [1, 1, 1, 0]}, {"alphaMode": "BLEND"})):
            cards = self.leaves(2, 40, nothing=nothing, **mode)
            self.same(cards, without, 160)
        for options in (["--traversal", "iterative"], ["--traversal", "bvh"], ["--schedule", "wavefront", "--traversal", "front-to-back"],
                        ["--stage", "shadows"]):
            self.same(cards, without, 160, *options)
        few = self.leaves(1, 6)
        self.assertIn("literals", self.same(few, without, 12, "--traversal", "literals")["variant"])

    def test_they_take_no_light_samples(self):
        without, alone = self.leaves(0, name="without"), ["--default-light", "none", "--camera-rays", 1, "--light-selection", "power", "--traversal", "front-to-back"]
        self.same(self.leaves(2, 40, emissiveFactor=[1, 0.5, 0.2]), without, 160, *alone)

    def test_sixty_four_layers_cost_what_one_costs(self):
        work = lambda layers: self.drawn(self.leaves(layers, 400), "--count-work", "--traversal", "front-to-back")[1]
        one, many = work(1), work(64)
        self.assertEqual(many["bvh"]["cut_out_triangles"], 64 * 800)
        self.assertLess(many["work"]["node_steps"], 1.1 * one["work"]["node_steps"])
        self.assertEqual(many["work"]["surfaces_passed"], 0)

    def test_what_is_partly_there_stays(self):
        """The texel that is there lies in the corner of these coordinates' square."""
        cards = self.leaves(2, 40)
        model = json.loads(cards.read_text())
        for offset, count in (([-0.2, -0.2], 0), ([0, 0], 160), ([1, 3], 160), ([-1.2, 0.8], 0)):
            model["materials"][2]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = {"KHR_texture_transform": {"offset": offset}}
            model["extensionsUsed"] = ["KHR_texture_transform"]
            moved = self.written("moved.gltf", model)
            self.assertEqual(self.drawn(moved)[1]["bvh"].get("cut_out_triangles", 0), count, offset)

    def test_numbers_that_change_bring_them_back(self):
        cards = self.leaves(2, 40, nothing={"baseColorFactor": [1, 1, 1, 0.4]})
        self.assertEqual(self.drawn(cards)[1]["bvh"]["cut_out_triangles"], 160)
        self.assertNotIn("cut_out_triangles", self.drawn(cards, "--set", "/materials/2/alphaCutoff=0.3")[1]["bvh"])
        self.assertEqual(self.drawn(cards, "--set", "/materials/2/alphaCutoff=0.41")[1]["bvh"]["cut_out_triangles"], 160)

    def test_an_animated_cutoff_in_a_sequence(self):
        gltf = Gltf(json.loads(self.leaves(2, 40, nothing={"baseColorFactor": [1, 1, 1, 0.4]}).read_text()))
        pointer = {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": "/materials/2/alphaCutoff"}}}
        gltf.root["animations"] = [{"samplers": [{"input": gltf.accessor([0, 1, 2]), "output": gltf.accessor([0.3, 0.6, 0.3])}],
                                    "channels": [{"sampler": 0, "target": pointer}]}]
        gltf.root["extensionsUsed"] = ["KHR_animation_pointer"]
        scene = gltf.write(self.folder / "fading.gltf")
        self.renders(scene, "-o", self.folder / "f#.pfm", "--quiet", *self.VIEW, "--frames", "0:2", "--fps", 1, "--stats", self.folder / "s#.json")
        for frame, count in enumerate((0, 160, 0)):
            told = json.loads((self.folder / f"s{frame}.json").read_text())
            self.assertEqual(told["bvh"].get("cut_out_triangles", 0), count)
            alone = self.drawn(scene, "--animation-time", frame, "--seed", told["seed"])[0]
            self.assertEqual((self.folder / f"f{frame}.pfm").read_bytes() == alone, True, frame)

    def test_while_the_shutter_is_open(self):
        cards = self.leaves(2, 40, animation=True)
        without = self.leaves(0, name="without", animation=True)
        told = self.same(cards, without, 160, "--shutter", 180, "--animation-time", 0.5, "--fps", 2)
        self.assertGreater(told["motion"]["segments"], 0)


if __name__ == "__main__":
    main()

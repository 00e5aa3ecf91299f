#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Solids: cells of the matrix of tests/campaign/solids.py, cameras and lamps inside of solids, and surfaces at one place."""
import math
import sys
import types
from pathlib import Path

from support import FRAGTRACE, WHITE, Case, luminances, main, mean, read_pfm, run

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
        parts = [lambda: model.body(square(0.25 * scale, -1), [(0, 1, 2), (0, 2, 3)], {**LAMP, "doubleSided": True}, (0.1 * scale, (1 - drop) * scale, 0)),
                 lambda: model.body(square(6 * scale, -1), [(0, 1, 2), (0, 2, 3)], matt((0.8, 0.8, 0.8), doubleSided=True), (0, scale, 0))]
        for part in parts if lamp_first else reversed(parts):
            part()
        model.body(square(6 * scale, 1), [(0, 1, 2), (0, 2, 3)], matt((0.8, 0.8, 0.8), doubleSided=True), (0, -scale, 0))
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
            model.body(square(1, 1), [(0, 1, 2), (0, 2, 3)], matt((1, 0, 0), doubleSided=True))
            model.body(square(1, -1), [(0, 1, 3), (1, 2, 3)], matt((0, 1, 0), doubleSided=True))
            for node in model.root["nodes"]:
                node["rotation"] = list(turn)
            for side, channel in ((1, 0), (-1, 1)):
                place = ",".join(map(str, rotated(turn, (0.4, 3 * side, 0.2))))
                for row in self.seen(model, "--stage", "flat", at=place, to="0,0,0", angle=20, size="64,64", spp=4):
                    for pixel in row:
                        self.assertEqual(pixel, tuple(1.0 if i == channel else 0.0 for i in range(3)))


def square(half, facing):
    """A level square that faces up (1) or down (-1)."""
    points = [(-half, 0, half), (half, 0, half), (half, 0, -half), (-half, 0, -half)]
    return points if facing > 0 else [points[i] for i in (0, 3, 2, 1)]


def rotated(q, v):
    x, y, z, w = q
    a, b, c = v
    tx, ty, tz = 2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)
    return [a + w * tx + y * tz - z * ty, b + w * ty + z * tx - x * tz, c + w * tz + x * ty - y * tx]


if __name__ == "__main__":
    main()

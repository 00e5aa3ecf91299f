#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Glass with a thickness whose mesh bounds no solid: a pane is a thin wall, and a line says so; what other surfaces close stays a solid."""
import math

from support import SMALL, Case, Exr, Gltf, main, run

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


if __name__ == "__main__":
    main()

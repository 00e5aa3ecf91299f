#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes every scene of this folder, the same bytes each time. Usage: make_scenes.py [FOLDER]"""

import math
import sys
from pathlib import Path

import geometry
from geometry import QUAD_INDICES, QUAD_UVS, box_faces, ground, icosphere, join_quads, quad, quad_normals
from gltf_writer import GltfWriter, rotation_about
from picture_files import encode_srgb, write_pfm, write_png
from scene_parts import SCENES, place_faces, place_quad, scene

import feature_scene  # noqa: F401, registers its scene
from gi_scenes import sky_radiance
import lamp_scenes  # noqa: F401, registers its scenes
import media_scenes  # noqa: F401, registers its scenes
import motion_scenes  # noqa: F401, registers its scene

# Closed forms

@scene("furnace")
def furnace(gltf):
    """A convex body of albedo 0.8 in the constant white environment of the default light: 0.8 everywhere on it."""
    positions, indices = icosphere(1.0, 2)
    gltf.place_mesh("sphere", gltf.primitive(positions, indices, gltf.add_lambert("albedo-0.8", (0.8, 0.8, 0.8))))
    gltf.add_camera("camera", (0, 0, 4), (0, 0, 0), 35)


@scene("closed-furnace")
def closed_furnace(gltf):
    """Emission 0.5 and albedo 0.5 on all sides: 0.5 / (1 - 0.5) = 1 everywhere."""
    walls = gltf.add_lambert("glowing", (0.5, 0.5, 0.5), emissiveFactor=[0.5, 0.5, 0.5])
    place_faces(gltf, "room", [geometry.flip(face) for face in box_faces((-1, -1, -1), (1, 1, 1))], walls)
    gltf.add_camera("camera", (0.3, 0.2, 0.7), (-0.2, -0.3, -1), 60)


# Spheres: flat, phong, shadows, reflections

@scene("sphere-black")
def sphere_black(gltf):
    gltf.add_sphere("sphere", 1.0, gltf.add_lambert("black", (0, 0, 0)))
    gltf.add_camera("camera", (0, 0, 4), (0, 0, 0), 40)


def graticule_texel(x, y, width=256, height=128):
    """A lattice of 15 degrees: red grows with u, green with v, dark fields in a checker, white lines, a blue F at the middle."""
    glyph = ("11111", "10000", "10000", "11110", "10000", "10000", "10000")
    column, row = (x - 118) // 4, (y - 50) // 4
    if 0 <= column < 5 and 0 <= row < 7 and glyph[row][column] == "1":
        return 30, 60, 255
    if x * 24 % width < 24 or y * 12 % height < 12:
        return 255, 255, 255
    dark = 0.35 if (x * 24 // width + y * 12 // height) % 2 else 1.0
    return tuple(encode_srgb(dark * value) for value in ((x + 0.5) / width, (y + 0.5) / height, 0.25))


@scene("sphere-textured")
def sphere_textured(gltf):
    write_png(gltf.folder / "graticule.png", 256, 128, graticule_texel)
    map_material = gltf.add_lambert("graticule", texture=gltf.add_texture("graticule.png"))
    gltf.add_sphere("sphere", 1.0, map_material, rotation=rotation_about((0, 1, 0), -75))
    gltf.add_camera("camera", (0, 1.6, 3.7), (0, 0, 0), 40)


@scene("sphere-phong")
def sphere_phong(gltf):
    gltf.add_sphere("sphere", 1.0, gltf.add_material("red-plastic", (0.75, 0.12, 0.08), roughness=0.45))
    gltf.add_light("key", "point", 30, (1, 0.95, 0.85), eye=(-2.5, 3, 3))
    gltf.add_light("rim", "point", 12, (0.5, 0.65, 1), eye=(3, -0.5, 0.5))
    gltf.add_camera("camera", (0, 0, 4), (0, 0, 0), 40)


def add_sphere_on_plane(gltf):
    place_quad(gltf, "ground", ground(6, 6), gltf.add_lambert("ground", (0.55, 0.55, 0.5)))
    gltf.add_sphere("sphere", 1.0, gltf.add_material("red-plastic", (0.75, 0.12, 0.08), roughness=0.45),
                    translation=[0, 1, 0])
    gltf.add_light("lamp", "point", 40, (1, 0.9, 0.75), eye=(-3, 4, 2))
    gltf.add_light("sun", "directional", 0.9, (0.7, 0.8, 1), direction=(-1, -1.2, -0.6))


@scene("sphere-plane")
def sphere_plane(gltf):
    add_sphere_on_plane(gltf)
    gltf.add_camera("camera", (0, 2.2, 5.5), (0, 0.7, 0), 42)


@scene("sphere-plane-mirror")
def sphere_plane_mirror(gltf):
    add_sphere_on_plane(gltf)
    mirror = gltf.add_material("mirror", (0.92, 0.94, 0.93), metallic=1, roughness=0)
    place_quad(gltf, "mirror", quad((-2, 0, 0), (4, 0, 0), (0, 3.2, 0)), mirror,
               translation=[0.6, 0.05, -2.2], rotation=rotation_about((0, 1, 0), -20))
    gltf.add_camera("camera", (-0.6, 2.2, 6), (0.1, 1.1, -0.6), 42)


# Water

def add_water_cube(gltf, extras):
    write_png(gltf.folder / "checker.png", 8, 8,
              lambda x, y: (232, 226, 210) if (x + y) % 2 else (70, 92, 120))
    checker = gltf.add_lambert("checker", texture=gltf.add_texture("checker.png", "nearest"))
    place_quad(gltf, "ground", ground(4, 4), checker, uvs=[(2 * u, 2 * v) for u, v in QUAD_UVS])
    water = gltf.add_material("water", roughness=0, extensions={
        "KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.33},
        "KHR_materials_volume": {"thicknessFactor": 1, "attenuationColor": [0.45, 0.75, 0.92],
                                 "attenuationDistance": 1}}, **extras)
    # A gap below the cube: faces in one place have no order.
    faces = box_faces((-0.6, 0.01, -0.6), (0.6, 1.21, 0.6))
    positions, indices = join_quads(faces)
    normals = [normal for face in faces for normal in quad_normals(face)]
    gltf.place_mesh("cube", gltf.primitive(positions, indices, water, normals, QUAD_UVS * len(faces)),
                    rotation=rotation_about((0, 1, 0), 25))
    gltf.add_light("lamp", "point", 28, (1, 0.95, 0.85), eye=(-2.4, 3, 1.5))
    gltf.add_light("sun", "directional", 1.2, (0.85, 0.92, 1), direction=(-0.7, -1, -0.5))
    gltf.add_camera("camera", (0.4, 2, 3.4), (0, 0.5, 0), 36)


@scene("water-cube-plain")
def water_cube_plain(gltf):
    add_water_cube(gltf, {})


@scene("water-cube")
def water_cube(gltf):
    add_water_cube(gltf, {"extras": {"perlinNormal": {"frequency": 3, "amplitude": 0.05, "octaves": 3}}})


# Normal maps

def bricks_height(u, v):
    """Half-bond bricks with rounded edges and a dome on each; periodic over the unit square, v down."""
    row = math.floor(v * 4) % 4
    x, y = (u * 2 + 0.5 * (row % 2)) % 1 * 2, v * 4 % 1
    edge = min(x, 2 - x, y, 1 - y)
    ramp = min(max((edge - 0.05) / 0.12, 0.0), 1.0)
    dome = max(0.0, 1 - ((x - 1) ** 2 + (y - 0.5) ** 2) / 0.09)
    return 0.012 * ramp * ramp * (3 - 2 * ramp) + 0.03 * dome * dome


def bricks_normal_texel(x, y, size=128):
    """The tangent-space normal, y towards the top of the image, in 8 bits."""
    u, v, step = (x + 0.5) / size, (y + 0.5) / size, 0.5 / size
    slope_u = (bricks_height(u + step, v) - bricks_height(u - step, v)) / (2 * step)
    slope_v = (bricks_height(u, v + step) - bricks_height(u, v - step)) / (2 * step)
    length = math.sqrt(slope_u ** 2 + slope_v ** 2 + 1)
    return tuple(round(127.5 * (value / length + 1)) for value in (-slope_u, slope_v, 1))


def add_mapped_plane(gltf, with_tangents):
    """Two panels side by side; the right one reads its map mirrored."""
    write_png(gltf.folder / "bricks-normal.png", 128, 128, bricks_normal_texel)
    plaster = gltf.add_material("plaster", (0.7, 0.62, 0.5), roughness=0.6,
                                normalTexture={"index": gltf.add_texture("bricks-normal.png"), "scale": 1.2})
    panels = []
    for left, mirrored in ((-1.55, False), (0.05, True)):
        corners = quad((left, -1, 0), (1.5, 0, 0), (0, 2, 0))
        uvs = [(1.5 * (1 - u if mirrored else u), 2 * v) for u, v in QUAD_UVS]
        tangents = [(-1, 0, 0, -1) if mirrored else (1, 0, 0, 1)] * 4 if with_tangents else None
        panels.append(gltf.primitive(corners, QUAD_INDICES, plaster, quad_normals(corners), uvs, tangents))
    gltf.place_mesh("wall", *panels, rotation=rotation_about((0.6, 0.8, 0), -30))
    gltf.add_light("lamp", "point", 4, (1, 0.95, 0.85), eye=(-1.3, 1.7, 1.1))
    gltf.add_camera("camera", (0, 0, 4), (0, 0, 0), 42)


@scene("mapped-plane")
def mapped_plane(gltf):
    add_mapped_plane(gltf, with_tangents=False)


@scene("mapped-plane-tangents")
def mapped_plane_tangents(gltf):
    add_mapped_plane(gltf, with_tangents=True)


@scene("sphere-mapped")
def sphere_mapped(gltf):
    """An implicit sphere whose u grows clockwise seen from +y, so that its tangent frame is left-handed."""
    write_png(gltf.folder / "bricks-normal.png", 128, 128, bricks_normal_texel)
    plaster = gltf.add_material("plaster", (0.7, 0.62, 0.5), roughness=0.6,
                                normalTexture={"index": gltf.add_texture("bricks-normal.png"), "scale": 1.2})
    gltf.add_sphere("sphere", 1.0, plaster, rotation=rotation_about((0.6, 0.8, 0), 100))
    gltf.add_light("lamp", "point", 25, (1, 0.95, 0.85), eye=(-3, 2, 1.5))
    gltf.add_camera("camera", (0, 0, 4), (0, 0, 0), 36)


# Meshes for the traversal figures

def add_knot(gltf, around, along):
    """The same bumpy knot at any fineness, and one triangle next to it."""
    clay = gltf.add_lambert("clay", (0.8, 0.72, 0.62))
    positions, indices = geometry.torus_knot(around, along, ring=2.0, tube=0.82, bump=0.05)
    gltf.place_mesh("knot", gltf.primitive(positions, indices, clay))
    gltf.place_mesh("triangle", gltf.primitive([(3.0, -3.6, 0), (3.6, -3.6, 0), (3.6, -3.0, 0)], [0, 1, 2], clay))
    gltf.add_camera("camera", (0, 0, 12), (0, 0, 0), 35)


@scene("mesh-15743")
def mesh_15743(gltf):
    add_knot(gltf, 17, 463)


@scene("mesh-62975")
def mesh_62975(gltf):
    add_knot(gltf, 37, 851)


# Global illumination

@scene("room-ball")
def room_ball(gltf):
    """A closed room of 12 triangles and a lamp of 2 round a bumpy ball of 69,312: what traversal is measured in."""
    white = gltf.add_lambert("white", (0.73, 0.73, 0.73))
    place_faces(gltf, "room", [geometry.flip(face) for face in box_faces((-2, -1.5, -2), (2, 1.5, 2))], white)
    lamp = geometry.quad((-0.6, 1.499, -0.6), (1.2, 0, 0), (0, 0, 1.2))
    place_quad(gltf, "lamp", lamp, gltf.add_lamp("lamp", (12, 11, 9)))
    positions, indices = geometry.bumpy_ball(228, 153, 0.9, (0, -0.4, 0))
    gltf.place_mesh("ball", gltf.primitive(positions, indices, gltf.add_lambert("clay", (0.8, 0.55, 0.35))))
    gltf.add_camera("camera", (1.4, 0.4, 1.9), (0, -0.3, 0), 60)


@scene("cornell-box")
def cornell_box(gltf):
    """Cornell University Program of Computer Graphics, Cornell Box Data, 1998, turned half about y and scaled to 2 m."""
    def place(x, y, z):
        return (-(x - 278) / 278, (y - 274.4) / 278, -(z - 279.6) / 278)

    white = gltf.add_lambert("white", (0.725, 0.71, 0.68))
    red = gltf.add_lambert("red", (0.63, 0.065, 0.05))
    green = gltf.add_lambert("green", (0.14, 0.45, 0.091))
    lamp = gltf.add_lamp("lamp", (17, 12, 4))
    inside = (0, 0, 0)
    walls = {
        "floor": (white, (552.8, 0, 0), (0, 0, 0), (0, 0, 559.2), (549.6, 0, 559.2)),
        "ceiling": (white, (556, 548.8, 0), (556, 548.8, 559.2), (0, 548.8, 559.2), (0, 548.8, 0)),
        "back-wall": (white, (549.6, 0, 559.2), (0, 0, 559.2), (0, 548.8, 559.2), (556, 548.8, 559.2)),
        "right-wall": (green, (0, 0, 559.2), (0, 0, 0), (0, 548.8, 0), (0, 548.8, 559.2)),
        "left-wall": (red, (552.8, 0, 0), (549.6, 0, 559.2), (556, 548.8, 559.2), (556, 548.8, 0)),
        "lamp": (lamp, (343, 548.3, 227), (343, 548.3, 332), (213, 548.3, 332), (213, 548.3, 227))}
    for name, (material, *corners) in walls.items():
        face = geometry.turned_towards([place(*corner) for corner in corners], inside)
        gltf.place_mesh(name, gltf.primitive(face, QUAD_INDICES, material))
    blocks = {"short-block": (((130, 65), (82, 225), (240, 272), (290, 114)), 165),
              "tall-block": (((423, 247), (265, 296), (314, 456), (472, 406)), 330)}
    for name, (outline, height) in blocks.items():
        placed = [place(x, 0, z) for x, z in outline]
        base = [(x, z) for x, _, z in placed], placed[0][1]
        positions, indices = join_quads(geometry.prism_faces(base, height / 278))
        gltf.place_mesh(name, gltf.primitive(positions, indices, white))
    gltf.add_camera("camera", place(278, 274.4, -800), place(278, 274.4, 0), math.degrees(2 * math.atan(0.0125 / 0.035)))


def add_lit_ground(gltf):
    place_quad(gltf, "ground", ground(5, 5), gltf.add_lambert("ground", (0.65, 0.5, 0.35)))
    lamp = gltf.add_lamp("lamp", (3, 2.9, 2.7))
    place_quad(gltf, "lamp", geometry.flip(ground(1.5, 1.5)), lamp, translation=[-1, 4, 0.5])


@scene("mirror-sphere")
def mirror_sphere(gltf):
    add_lit_ground(gltf)
    place_quad(gltf, "wall", quad((-5, 0, -2.5), (10, 0, 0), (0, 3.5, 0)), gltf.add_lambert("wall", (0.3, 0.45, 0.65)))
    gltf.add_sphere("sphere", 1.0, gltf.add_material("mirror", metallic=1, roughness=0), translation=[0, 1.05, 0])
    gltf.add_camera("camera", (1.2, 2.2, 5), (0, 0.9, 0), 38)


@scene("glass-sphere")
def glass_sphere(gltf):
    add_lit_ground(gltf)
    glass = gltf.add_material("glass", roughness=0, extensions={
        "KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.5},
        "KHR_materials_volume": {"thicknessFactor": 1}})
    place_quad(gltf, "wall", quad((-5, 0, -2.5), (10, 0, 0), (0, 3.5, 0)), gltf.add_lambert("wall", (0.3, 0.45, 0.65)))
    gltf.add_sphere("sphere", 1.0, glass, translation=[0, 1.05, 0])
    gltf.add_camera("camera", (1.2, 2.2, 5), (0, 0.9, 0), 38)


@scene("corner-diffuse")
def corner_diffuse(gltf):
    """Three walls of high albedo that light one another; the lamp is part of the open side."""
    place_quad(gltf, "floor", ground(1, 1, -1), gltf.add_lambert("floor", (0.8, 0.8, 0.8)))
    place_quad(gltf, "left-wall", quad((-1, -1, 1), (0, 0, -2), (0, 2, 0)), gltf.add_lambert("orange", (0.9, 0.4, 0.1)))
    place_quad(gltf, "back-wall", quad((-1, -1, -1), (2, 0, 0), (0, 2, 0)), gltf.add_lambert("blue", (0.15, 0.35, 0.85)))
    place_quad(gltf, "lamp", geometry.flip(ground(0.5, 0.5)), gltf.add_lamp("lamp", (8, 8, 8)), translation=[0, 1.4, 0])
    gltf.add_camera("camera", (2.6, 1.2, 2.6), (-0.35, -0.35, -0.35), 38)


@scene("lights")
def lights(gltf):
    """A point light with a range, a spot light and a directional light, in colours of their own."""
    place_quad(gltf, "floor", ground(2, 1.5), gltf.add_lambert("floor", (0.7, 0.7, 0.7)))
    place_quad(gltf, "wall", quad((-2, 0, -1.5), (4, 0, 0), (0, 2.5, 0)), gltf.add_lambert("wall", (0.6, 0.65, 0.7)))
    place_faces(gltf, "post", box_faces((-0.15, 0, -0.15), (0.15, 0.9, 0.15)), gltf.add_lambert("post", (0.8, 0.75, 0.4)),
                translation=[0, 0.001, 0], rotation=rotation_about((0, 1, 0), 30))
    gltf.add_light("point", "point", 1.6, (1, 0.35, 0.2), eye=(-1.1, 0.7, -0.6), range=1.8)
    gltf.add_light("spot", "spot", 9, (0.3, 1, 0.4), eye=(1.1, 2, 0.6), direction=(-0.1, -1, -0.35),
                   spot={"innerConeAngle": 0.2, "outerConeAngle": 0.42})
    gltf.add_light("sun", "directional", 0.45, (0.45, 0.55, 1), direction=(0.8, -1, -0.7))
    gltf.add_camera("camera", (0, 2.1, 4.4), (0, 0.75, -0.4), 40)


@scene("environment-diffuse")
def environment_diffuse(gltf):
    """To be lit by sky.pfm."""
    write_pfm(gltf.folder / "sky.pfm", 64, 32, sky_radiance)
    place_quad(gltf, "ground", ground(2, 2), gltf.add_lambert("ground", (0.6, 0.6, 0.6)))
    gltf.add_sphere("sphere", 0.8, gltf.add_lambert("clay", (0.8, 0.8, 0.8)), translation=[0, 0.85, 0])
    gltf.add_camera("camera", (-2.6, 1.9, 3.2), (0, 0.7, 0), 48)


def main():
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent
    for name, fill in SCENES.items():
        gltf = GltfWriter(folder, name)
        fill(gltf)
        gltf.write()


if __name__ == "__main__":
    main()

# SPDX-License-Identifier: MIT
"""Scenes for the stage gi that hold one glTF material each, or a few side by side. Lamps that stand before a sky have a black back:
what lies behind a single-sided lamp would shine through it."""

import math

import geometry
from geometry import QUAD_INDICES, QUAD_UVS, box_faces, ground, quad, quad_normals
from gltf_writer import rotation_about
from picture_files import write_pfm, write_png
from scene_parts import place_faces, place_quad, scene


def sky_radiance(x, y, width=64, height=32):
    """Blue above, brown below, reddish towards +X (the middle), a bright patch between +X and -Z high up."""
    azimuth, polar = 2 * math.pi * ((x + 0.5) / width - 0.5), math.pi * (y + 0.5) / height
    d = (math.sin(polar) * math.cos(azimuth), math.cos(polar), math.sin(polar) * math.sin(azimuth))
    up = 0.5 + 0.5 * d[1]
    base = (0.28 * (1 - up) + 0.25 * up, 0.2 * (1 - up) + 0.45 * up, 0.12 * (1 - up) + 0.9 * up)
    red, green = 0.5 * max(d[0], 0.0) ** 2, 0.35 * max(d[2], 0.0) ** 2
    sun = (0.55, 0.6, -0.58)
    cosine = sum(a * b for a, b in zip(d, sun)) / math.sqrt(sum(a * a for a in sun))
    patch = 9 * math.exp(40 * (cosine - 1))
    return (base[0] + red + patch, base[1] + green + 0.92 * patch, base[2] + 0.75 * patch)


def sun_sky_radiance(x, y):
    """The same sky, dimmer, and a sun of four texels a thousand times as bright, high up between -X and +Z."""
    sun = (240, 220, 180) if x in (58, 59) and y in (9, 10) else (0, 0, 0)
    return tuple(0.3 * a + b for a, b in zip(sky_radiance(x, y), sun))


def place_backed_lamp(gltf, half, radiance, translation):
    lamp, back = gltf.add_lamp("lamp", radiance), gltf.add_lambert("lamp-back", (0, 0, 0))
    place_quad(gltf, "lamp", geometry.flip(ground(half, half)), lamp, translation=translation)
    place_quad(gltf, "lamp-back", ground(half, half, 0.001), back, translation=translation)


def place_row(gltf, materials, radius, spacing):
    """A row of spheres along x, a hair above the ground."""
    for i, material in enumerate(materials):
        x = round((i - (len(materials) - 1) / 2) * spacing, 6)
        gltf.add_sphere("sphere-%d" % i, radius, material, translation=[x, radius + 0.01, 0])


def add_stage(gltf):
    """Ground, lamp and camera; to be lit by sky.pfm, too."""
    place_quad(gltf, "ground", ground(2.6, 2), gltf.add_lambert("ground", (0.5, 0.48, 0.42)))
    place_backed_lamp(gltf, 0.8, (5, 4.7, 4.2), [-0.8, 2.6, 1.4])
    gltf.add_camera("camera", (0, 1.5, 4.4), (0, 0.5, 0), 32)


@scene("rough-metals")
def rough_metals(gltf):
    add_stage(gltf)
    metals = (("gold", (1, 0.77, 0.34), 0.15), ("copper", (0.95, 0.64, 0.54), 0.4), ("blue", (0.35, 0.5, 0.9), 0.8))
    place_row(gltf, [gltf.add_material(name, color, 1, roughness) for name, color, roughness in metals], 0.55, 1.3)


@scene("plastics")
def plastics(gltf):
    """Plain plastics, coloured and weakened reflections of a higher index, and a half-metal."""
    add_stage(gltf)
    materials = [gltf.add_material("red", (0.75, 0.12, 0.08), roughness=0.3),
                 gltf.add_material("green", (0.15, 0.6, 0.2), roughness=0.1),
                 gltf.add_material("specular", (0.1, 0.12, 0.3), roughness=0.25, extensions={
                     "KHR_materials_ior": {"ior": 1.9},
                     "KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [1, 0.8, 0.3]}}),
                 gltf.add_material("half-metal", (0.9, 0.6, 0.3), metallic=0.5, roughness=0.45)]
    place_row(gltf, materials, 0.46, 1.0)


# Glass

def glass(gltf, name, color=(1, 1, 1), roughness=0.0, ior=1.5, **volume):
    extensions = {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": ior}}
    if volume:
        extensions["KHR_materials_volume"] = volume
    return gltf.add_material(name, color, roughness=roughness, extensions=extensions)


@scene("rough-glass")
def rough_glass(gltf):
    """A frosted sphere and one of green glass, lit by sky.pfm."""
    place_quad(gltf, "ground", ground(2.6, 2), gltf.add_lambert("ground", (0.6, 0.5, 0.4)))
    place_faces(gltf, "post", box_faces((-0.25, 0, -0.25), (0.25, 1.4, 0.25)), gltf.add_lambert("post", (0.8, 0.25, 0.15)),
                translation=[0, 0.001, -1.1], rotation=rotation_about((0, 1, 0), 30))
    place_row(gltf, [glass(gltf, "frosted", roughness=0.3, thicknessFactor=1),
                     glass(gltf, "green", thicknessFactor=1, attenuationColor=[0.3, 0.8, 0.5], attenuationDistance=0.8)], 0.65, 1.45)
    gltf.add_camera("camera", (0, 1.5, 4.2), (0, 0.6, 0), 30)


@scene("thin-glass")
def thin_glass(gltf):
    """Two tinted panes, a clear and a frosted one, before coloured posts; lit by sky.pfm, too."""
    add_stage(gltf)
    for x, color in ((-0.75, (0.8, 0.6, 0.15)), (0.75, (0.2, 0.35, 0.8))):
        place_faces(gltf, "post", box_faces((-0.2, 0, -0.2), (0.2, 1.1, 0.2)), gltf.add_lambert("post", color),
                    translation=[x, 0.001, -0.5], rotation=rotation_about((0, 1, 0), 30))
    pane = quad((-0.6, 0.03, 0), (1.2, 0, 0), (0, 1.3, 0))
    # Seen at about 63 degrees, where Schlick's reflectance departs most from Fresnel's.
    place_quad(gltf, "clear", pane, glass(gltf, "clear", (0.95, 0.65, 0.6)), translation=[-0.7, 0, 0.5], rotation=rotation_about((0, 1, 0), -53))
    place_quad(gltf, "frosted", pane, glass(gltf, "frosted", (0.75, 0.9, 0.95), 0.6), translation=[0.7, 0, 0.5],
               rotation=rotation_about((0, 1, 0), -15))


@scene("vitrine")
def vitrine(gltf):
    """Clay in a box of thin glass on a plinth, under a lamp of 4 cm outside that only ways through the glass lead to."""
    place_quad(gltf, "ground", ground(3, 3), gltf.add_lambert("ground", (0.5, 0.48, 0.42)))
    place_faces(gltf, "plinth", box_faces((-0.7, 0, -0.7), (0.7, 0.3, 0.7)), gltf.add_lambert("plinth", (0.35, 0.3, 0.28)), translation=[0, 0.001, 0])
    gltf.add_sphere("clay", 0.4, gltf.add_lambert("clay", (0.75, 0.5, 0.35)), translation=[-0.1, 0.702, -0.05])
    gltf.add_sphere("pearl", 0.13, gltf.add_lambert("pearl", (0.8, 0.8, 0.78)), translation=[0.35, 0.432, 0.35])
    clear = glass(gltf, "clear", (0.97, 0.99, 0.98))
    for name, face in zip("abcde", box_faces((-0.6, 0.302, -0.6), (0.6, 1.3, 0.6))):
        place_quad(gltf, "glass-" + name, face, clear)
    place_backed_lamp(gltf, 0.02, (4000, 3700, 3300), [-1.2, 2.8, 1.1])
    gltf.add_camera("camera", (0.9, 1.5, 3), (0, 0.7, 0), 28)


def place_ring(gltf, radius, height, material, **place):
    """The inner side of a ring that stands on the ground."""
    turns, faces = 64, []
    for k in range(turns):
        a, b = (2 * math.pi * (k + i) / turns for i in (0, 1))
        points = [(radius * math.cos(c), 0, radius * math.sin(c)) for c in (a, b)]
        edge = tuple(q - p for p, q in zip(*points))
        faces.append(quad(points[0], edge, (0, height, 0)))
    positions, indices = geometry.join_quads(faces)
    normals = [(-p[0] / radius, 0, -p[2] / radius) for p in positions]
    gltf.place_mesh("ring", gltf.primitive(positions, indices, material, normals), **place)


@scene("caustics")
def caustics(gltf):
    """A ball and a bowl of glass and a ring of gold on a table, under a lamp of 6 cm and a spot."""
    place_quad(gltf, "table", ground(2.4, 1.8), gltf.add_lambert("table", (0.6, 0.57, 0.5)))
    place_faces(gltf, "wall", [quad((-2.4, 0, -1.2), (4.8, 0, 0), (0, 2.4, 0))], gltf.add_lambert("wall", (0.45, 0.5, 0.55)))
    gltf.add_sphere("ball", 0.4, glass(gltf, "clear", thicknessFactor=1), translation=[-0.55, 0.41, 0.1])
    gltf.add_sphere("green", 0.25, glass(gltf, "green", thicknessFactor=1, attenuationColor=[0.3, 0.85, 0.5], attenuationDistance=0.4),
                    translation=[0.75, 0.26, 0.55])
    gold = gltf.add_material("gold", (1, 0.77, 0.34), metallic=1, roughness=0)
    place_ring(gltf, 0.35, 0.22, gold, translation=[0.35, 0.002, -0.35])
    place_backed_lamp(gltf, 0.03, (2600, 2400, 2100), [-1.3, 2.2, -0.4])
    gltf.add_light("spot", "spot", 9, (1, 0.9, 0.8), (1.8, 1.6, -0.9), (-0.55, -0.55, 0.6), spot={"innerConeAngle": 0.4, "outerConeAngle": 0.7})
    gltf.add_camera("camera", (0.2, 1.9, 3.6), (0, 0.25, 0), 34)


@scene("caustic-ball")
def caustic_ball(gltf):
    """A ball of glass under a small lamp over matt ground, for error against time."""
    place_quad(gltf, "ground", ground(5, 5), gltf.add_lambert("ground", (0.8, 0.8, 0.8)))
    gltf.add_sphere("ball", 0.7, glass(gltf, "clear", thicknessFactor=1), translation=[0, 1, 0])
    place_backed_lamp(gltf, 0.3, (30, 30, 30), [0, 4, 0])
    gltf.add_camera("camera", (0, 1, 6), (0, 1, 0), 40)


@scene("caustic-ring")
def caustic_ring(gltf):
    """A brushed ring and a frosted ball on a matt table: casters that are not quite smooth."""
    place_quad(gltf, "table", ground(2.4, 1.8), gltf.add_lambert("table", (0.6, 0.57, 0.5)))
    place_ring(gltf, 0.5, 0.3, gltf.add_material("brushed", (1, 0.77, 0.34), metallic=1, roughness=0.2), translation=[0.45, 0.002, 0.1])
    gltf.add_sphere("ball", 0.35, glass(gltf, "frosted", roughness=0.15, thicknessFactor=1), translation=[-0.6, 0.36, 0.1])
    place_backed_lamp(gltf, 0.05, (900, 850, 750), [-1.1, 2.2, -0.5])
    gltf.add_camera("camera", (0.2, 1.9, 3.2), (0, 0.2, 0), 34)


@scene("caustic-ground")
def caustic_ground(gltf):
    """Dark ground, lit by way of a ball of glass and a hollow mirror that the camera does not see. So dark that what it throws back at them is nothing:
    paths from a point light that meet it twice are found by no one but tracers of all light paths, as the reference's is."""
    place_quad(gltf, "ground", ground(1.4, 1), gltf.add_lambert("ground", (0.01, 0.01, 0.01)))
    gltf.add_sphere("ball", 0.35, glass(gltf, "clear", thicknessFactor=1), translation=[-0.9, 0.5, 0])
    mirror = gltf.add_material("mirror", (1, 1, 1), metallic=1, roughness=0, doubleSided=True)
    faces = []
    for k in range(12):
        (ax, ay), (bx, by) = ((0.8 + 0.5 * math.cos(t), 0.5 + 0.5 * math.sin(t)) for t in (0.15 * (k + i - 6) for i in (0, 1)))
        faces.append(quad((ax, ay, -0.4), (bx - ax, by - ay, 0), (0, 0, 0.8)))
    place_faces(gltf, "hollow", faces, mirror)
    gltf.add_light("behind", "point", 300, (1, 0.9, 0.8), (-1.7, 1.1, 0.2))
    gltf.add_light("above", "point", 60, (0.7, 0.8, 1), (0.3, 0.8, -0.3))
    place_backed_lamp(gltf, 0.1, (6000, 7000, 6000), [-1.2, 1.7, -0.3])
    gltf.add_camera("camera", (0.2, 3, 0.3), (0.2, 0, 0), 30)


@scene("behind-glass")
def behind_glass(gltf):
    """Ground that the camera sees through a slab of glass, through which its light comes, too: guiding alone finds the lamp."""
    place_quad(gltf, "ground", ground(1, 1), gltf.add_lambert("ground", (0.7, 0.7, 0.7)))
    place_faces(gltf, "slab", box_faces((-1, 0.4, -1), (1, 0.5, 1)), glass(gltf, "clear", thicknessFactor=1))
    place_backed_lamp(gltf, 0.25, (20, 20, 20), [-0.3, 1.5, -0.2])
    gltf.add_camera("camera", (1, 2, 1.2), (0, 0.3, 0), 20)


# Textures, emitters, coverage

def layers_texel(x, y):
    """Transmission in red (a checker), a specular colour, its strength in alpha; green and blue differ from all of them."""
    return 230 if (x + y) % 2 else 40, 255 - 30 * y, 60 + 25 * x, (255, 200, 120, 20, 0, 90, 180, 240)[x]


@scene("mapped-layers")
def mapped_layers(gltf):
    """A half-transmissive thin pane and a plastic panel, both with the maps of their extensions; lit by sky.pfm, too."""
    write_png(gltf.folder / "layers.png", 8, 8, layers_texel)
    add_stage(gltf)
    layers = {"index": gltf.add_texture("layers.png")}
    pane = gltf.add_material("pane", (0.5, 0.85, 0.6), roughness=0.35, extensions={
        "KHR_materials_transmission": {"transmissionFactor": 0.9, "transmissionTexture": layers}})
    panel = gltf.add_material("panel", (0.25, 0.1, 0.1), roughness=0.3, doubleSided=True, extensions={
        "KHR_materials_ior": {"ior": 2.2}, "KHR_materials_specular": {"specularTexture": layers, "specularColorTexture": layers}})
    place_faces(gltf, "post", box_faces((-0.2, 0, -0.2), (0.2, 1.1, 0.2)), gltf.add_lambert("post", (0.8, 0.6, 0.15)),
                translation=[-0.75, 0.001, -0.5], rotation=rotation_about((0, 1, 0), 30))
    corners = quad((-0.6, 0.03, 0), (1.2, 0, 0), (0, 1.2, 0))
    place_quad(gltf, "pane", corners, pane, uvs=QUAD_UVS, translation=[-0.7, 0, 0.5], rotation=rotation_about((0, 1, 0), 15))
    # It leans back, so that it mirrors the sky; from the ground behind it its back is seen.
    place_quad(gltf, "panel", corners, panel, uvs=QUAD_UVS, translation=[0.7, 0.02, 0.5], rotation=rotation_about((1, 0, 0), -40))


@scene("sun-sky")
def sun_sky(gltf):
    """To be lit by sun-sky.pfm: shadows, a diffuse and a metal sphere."""
    write_pfm(gltf.folder / "sun-sky.pfm", 64, 32, sun_sky_radiance)
    place_quad(gltf, "ground", ground(2.6, 2), gltf.add_lambert("ground", (0.6, 0.6, 0.6)))
    place_row(gltf, [gltf.add_lambert("clay", (0.8, 0.55, 0.4)), gltf.add_material("metal", (0.9, 0.85, 0.75), 1, 0.5)], 0.6, 1.4)
    gltf.add_camera("camera", (0, 1.7, 4.2), (0, 0.45, 0), 32)


def metal_rough_texel(x, y):
    """Metallic in blue, roughness in green; red, which means nothing, is loud."""
    return 255 if (x + y) % 2 else 0, 130 + 15 * x, (0, 0, 60, 160, 255, 255, 200, 100)[y]


def glow_texel(x, y):
    """Four stripes of light and a dark diagonal: no two turns or flips look alike."""
    return (5, 5, 5) if x == y else ((255, 90, 40), (250, 220, 120), (90, 220, 255), (60, 80, 250))[y // 2]


@scene("mapped-metal")
def mapped_metal(gltf):
    """A wall with all maps of the metallic-roughness material, lit by a picture on the right and two triangles on the left."""
    write_png(gltf.folder / "metal-rough.png", 8, 8, metal_rough_texel)
    write_png(gltf.folder / "glow.png", 8, 8, glow_texel)
    arrows, normals = gltf.add_texture("arrows.png", "nearest"), gltf.add_texture("bricks-normal.png")
    wall = gltf.add_material("wall", (0.9, 0.9, 0.9), metallic=0.9, texture=arrows, normalTexture={"index": normals, "scale": 0.5})
    gltf.root["materials"][wall]["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {"index": gltf.add_texture("metal-rough.png")}
    place_quad(gltf, "wall", quad((-1.4, 0, 0), (2.8, 0, 0), (0, 2, 0)), wall, uvs=[(1.4 * u, v) for u, v in QUAD_UVS])
    place_quad(gltf, "ground", quad((-1.4, -0.01, 1.4), (2.8, 0, 0), (0, 0, -1.38)), gltf.add_lambert("ground", (0.6, 0.6, 0.6)))
    glow = gltf.add_texture("glow.png")
    picture = gltf.add_lambert("picture", (0, 0, 0), emissiveFactor=[1, 0.9, 0.8], emissiveTexture={"index": glow},
                               extensions={"KHR_materials_emissive_strength": {"emissiveStrength": 5}})
    corners = quad((1.9, 0.3, 0.2), (0, 0, 1.1), (0, 1.5, 0))
    place_quad(gltf, "picture", geometry.turned_towards(corners, (0, 1, 1)), picture, uvs=QUAD_UVS)
    for name, y, lamp in (("low", 0.3, gltf.add_lamp("strong", (9, 4, 2))),
                          ("high", 1.2, gltf.add_lambert("weak", (0.5, 0.5, 0.5), emissiveFactor=[0.3, 0.8, 0.9]))):
        corners = [(-1.9, y, 1.2), (-1.9, y, 0.3), (-1.9, y + 0.7, 0.6)]
        gltf.place_mesh(name, gltf.primitive(corners, [0, 1, 2], lamp))
    gltf.add_camera("camera", (0, 1.1, 4.8), (0, 0.95, 0), 32)


@scene("coverage")
def coverage(gltf):
    """A sheet of alpha 0.5 and one with holes throw shadows and are seen through; both have two sides. The ground has vertex colours."""
    colors = gltf.add_accessor([(255, 240, 200, 255), (200, 255, 230, 255), (230, 200, 255, 255), (255, 255, 255, 255)], "B", normalized=True)
    corners = ground(2, 1.5)
    paper = gltf.primitive(corners, QUAD_INDICES, gltf.add_lambert("ground", (0.85, 0.85, 0.8)), quad_normals(corners), COLOR_0=colors)
    gltf.place_mesh("ground", paper)
    place_quad(gltf, "lamp", geometry.flip(ground(0.4, 0.4)), gltf.add_lamp("lamp", (24, 23, 21)), translation=[0, 3, 0.4])
    half = gltf.add_lambert("half", (0.9, 0.85, 0.15, 0.5), alphaMode="BLEND", doubleSided=True)
    place_quad(gltf, "half", ground(0.6, 0.6), half, translation=[-0.75, 0.3, 0.1], rotation=rotation_about((0, 0, 1), -8))
    disc = gltf.add_lambert("disc", (0.9, 0.9, 0.9), texture=gltf.add_texture("disc.png", "nearest"), alphaMode="MASK", alphaCutoff=0.6,
                            doubleSided=True)
    sheet = gltf.primitive(ground(0.6, 0.6), QUAD_INDICES, disc, quad_normals(ground(0.6, 0.6)), QUAD_UVS)
    gltf.place_mesh("disc", sheet, translation=[0.75, 0.75, 0.1], rotation=rotation_about((1, 0, 0), 25))
    gltf.add_camera("camera", (0.2, 2.3, 3.6), (0, 0.35, 0), 40)


@scene("many-lights")
def many_lights(gltf):
    """A closed room under 256 small lamps of many colours, whose powers span a factor of 64; two matt blocks and a metal ball."""
    walls = gltf.add_lambert("walls", (0.6, 0.6, 0.58))
    for name, face in zip("abcdef", box_faces((-2, 0, -2), (2, 2, 3))):
        place_quad(gltf, "wall-" + name, geometry.flip(face), walls)
    place_faces(gltf, "tall", box_faces((-1.2, 0, -1.2), (-0.5, 1.2, -0.5)), gltf.add_lambert("tall", (0.7, 0.35, 0.3)))
    place_faces(gltf, "low", box_faces((0.2, 0, -0.9), (1.2, 0.5, -0.1)), gltf.add_lambert("low", (0.35, 0.5, 0.7)))
    gltf.add_sphere("ball", 0.35, gltf.add_material("metal", (0.9, 0.8, 0.6), 1, 0.3), translation=[-0.2, 0.36, 0.6])
    colors = ((1, 0.3, 0.2), (0.3, 1, 0.4), (0.3, 0.4, 1), (1, 0.9, 0.7))
    lamps = [gltf.add_lamp("lamp-%d" % i, [c * 4 ** (i // 4) for c in colors[i % 4]]) for i in range(16)]
    quads = [[] for _ in lamps]
    for k in range(256):
        x, z = round(-1.83 + 3.66 * (k % 16) / 15, 6), round(-1.83 + 4.66 * (k // 16) / 15, 6)
        # 7 and 16 have no common divisor: neighbours differ. Bright lamps are the rare ones.
        index = 7 * k % 16
        index = index if index < 12 or k % 5 == 0 else index - 8
        quads[index].append([(x + i, y, z + j) for i, y, j in geometry.flip(ground(0.03, 0.03, 1.98))])
    for lamp, placed in zip(lamps, quads):
        positions, indices = geometry.join_quads(placed)
        gltf.place_mesh("lamps", gltf.primitive(positions, indices, lamp))
    gltf.add_camera("camera", (0, 1.1, 2.9), (0, 0.7, -1), 60)


@scene("lobes")
def lobes(gltf):
    """Rough lobes of material extensions, alone and one over the other, none so narrow that it is a single direction; lit by sky.pfm, too."""
    place_quad(gltf, "ground", ground(3, 2), gltf.add_lambert("ground", (0.5, 0.48, 0.42)))
    place_backed_lamp(gltf, 0.8, (5, 4.7, 4.2), [-0.8, 2.6, 1.4])
    gltf.add_camera("camera", (0, 1.3, 4.6), (0, 0.4, 0), 19)
    coat = {"KHR_materials_clearcoat": {"clearcoatFactor": 0.8, "clearcoatRoughnessFactor": 0.3}}
    sheen = {"KHR_materials_sheen": {"sheenColorFactor": [0.9, 0.6, 0.4], "sheenRoughnessFactor": 0.4}}
    brushed = {"KHR_materials_anisotropy": {"anisotropyStrength": 0.8, "anisotropyRotation": 0.6}}
    film = {"KHR_materials_iridescence": {"iridescenceFactor": 0.8, "iridescenceIor": 1.4, "iridescenceThicknessMaximum": 450}}
    leaf = {"KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.7, "diffuseTransmissionColorFactor": [0.3, 0.8, 0.2]}}
    materials = (("coat", (0.6, 0.1, 0.05), 0, 0.6, coat), ("sheen", (0.1, 0.08, 0.3), 0, 0.9, sheen),
                 ("brushed", (0.9, 0.8, 0.6), 1, 0.3, brushed), ("film", (0.6, 0.6, 0.6), 0.7, 0.35, film),
                 ("leaf", (0.5, 0.3, 0.1), 0, 0.5, leaf), ("all", (0.4, 0.5, 0.6), 0.4, 0.4, {**coat, **sheen, **brushed, **film, **leaf}))
    place_row(gltf, [gltf.add_material(name, color, metallic, roughness, extensions=extensions)
                     for name, color, metallic, roughness, extensions in materials], 0.36, 0.8)


@scene("layered")
def layered(gltf):
    """One sphere a material extension: clear coat, sheen, anisotropy, iridescence, diffuse transmission, dispersion."""
    place_quad(gltf, "ground", ground(4, 2.5), gltf.add_lambert("ground", (0.5, 0.48, 0.42)))
    place_backed_lamp(gltf, 0.9, (9, 8.5, 7.6), [-0.8, 3.4, 1.6])
    materials = (
        ("clearcoat", (0.6, 0.03, 0.02), 0, 0.6, {"KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.03}}),
        ("sheen", (0.05, 0.06, 0.25), 0, 0.9, {"KHR_materials_sheen": {"sheenColorFactor": [0.7, 0.75, 1], "sheenRoughnessFactor": 0.4}}),
        ("anisotropy", (0.9, 0.85, 0.8), 1, 0.25, {"KHR_materials_anisotropy": {"anisotropyStrength": 0.9}}),
        ("iridescence", (0.9, 0.9, 0.9), 1, 0.2, {"KHR_materials_iridescence": {
            "iridescenceFactor": 1, "iridescenceIor": 1.4, "iridescenceThicknessMaximum": 450}}),
        ("leaf", (0.3, 0.5, 0.1), 0, 0.8, {"KHR_materials_diffuse_transmission": {
            "diffuseTransmissionFactor": 0.6, "diffuseTransmissionColorFactor": [0.6, 0.9, 0.2]}}),
        ("prism", (1, 1, 1), 0, 0, {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.6},
                                    "KHR_materials_volume": {"thicknessFactor": 1}, "KHR_materials_dispersion": {"dispersion": 5}}))
    place_row(gltf, [gltf.add_material(name, color, metallic, roughness, extensions=extensions)
                     for name, color, metallic, roughness, extensions in materials], 0.5, 1.12)
    gltf.add_camera("camera", (0, 1.7, 7.2), (0, 0.45, 0), 22)

# SPDX-License-Identifier: MIT
"""Scenes for participating media: solids that scatter inside, and what stands in fog."""

import geometry
from geometry import box_faces, ground, quad
from gi_scenes import place_backed_lamp
from scene_parts import place_faces, place_quad, scene


def medium(gltf, name, distance, color, multiscatter=(1, 1, 1), strength=1, anisotropy=0, ior=1.5, roughness=0):
    """A solid of which light that goes straight through it keeps `color` in `distance` metres."""
    extensions = {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": ior},
                  "KHR_materials_volume": {"thicknessFactor": 1, "attenuationColor": list(color), "attenuationDistance": distance},
                  "KHR_materials_scatter": {"scatterStrengthFactor": strength, "multiscatterColorFactor": list(multiscatter),
                                            "scatterAnisotropy": anisotropy}}
    return gltf.add_material(name, roughness=roughness, extensions=extensions)


def add_ground(gltf):
    place_quad(gltf, "ground", ground(2, 2), gltf.add_lambert("ground", (0.5, 0.48, 0.42)))


def place_ball(gltf, material, radius=0.6, x=0):
    gltf.add_sphere("ball", radius, material, translation=[x, radius + 0.01, 0])


@scene("milk")
def milk(gltf):
    """A ball of thin milk in glass, lit by sky.pfm."""
    add_ground(gltf)
    place_ball(gltf, medium(gltf, "milk", 0.2, (0.25, 0.22, 0.2), (0.98, 0.95, 0.85)))
    gltf.add_camera("camera", (0, 1.3, 3.6), (0, 0.55, 0), 28)


@scene("skin")
def skin(gltf):
    """A ball whose extinction and albedo are coloured, behind a rough boundary; lit by sky.pfm."""
    add_ground(gltf)
    place_ball(gltf, medium(gltf, "skin", 0.2, (0.6, 0.3, 0.15), (0.9, 0.6, 0.4), anisotropy=0.3, ior=1.4, roughness=0.4))
    gltf.add_camera("camera", (0, 1.3, 3.6), (0, 0.55, 0), 28)


@scene("phase")
def phase(gltf):
    """Two balls that do not bend light, of which one scatters it backward and one forward, before a lamp; to be lit by sky.pfm, too."""
    add_ground(gltf)
    for x, anisotropy in ((-0.7, -0.8), (0.7, 0.9)):
        place_ball(gltf, medium(gltf, "phase", 0.4, (0.3, 0.3, 0.3), anisotropy=anisotropy, ior=1), 0.55, x)
    place_backed_lamp(gltf, 0.5, (9, 8.5, 8), [0, 2.2, -1])
    gltf.add_camera("camera", (0, 1.2, 4), (0, 0.5, 0), 30)


@scene("cloud")
def cloud(gltf):
    """A dense white ball that does not bend light, and its shadow under a lamp."""
    add_ground(gltf)
    place_ball(gltf, medium(gltf, "cloud", 0.1, (0.1, 0.1, 0.1), ior=1))
    place_quad(gltf, "lamp", geometry.flip(ground(0.5, 0.5)), gltf.add_lamp("lamp", (9, 8.5, 8)), translation=[0.8, 2.4, 0.6])
    gltf.add_camera("camera", (0, 1.3, 3.6), (0, 0.55, 0), 28)


@scene("inside")
def inside(gltf):
    """The camera and a lamp inside of a medium, whose box does not bend light, and a clay ball."""
    place_faces(gltf, "box", box_faces((-1.5, -0.5, -1.5), (1.5, 2, 3)),
                medium(gltf, "haze", 2, (0.5, 0.6, 0.7), (0.9, 0.9, 0.9), ior=1))
    place_quad(gltf, "floor", ground(1.2, 1.2), gltf.add_lambert("floor", (0.6, 0.55, 0.5)))
    place_quad(gltf, "wall", quad((-1.2, 0, -1.2), (2.4, 0, 0), (0, 1.8, 0)), gltf.add_lambert("wall", (0.4, 0.5, 0.65)))
    place_quad(gltf, "lamp", geometry.flip(ground(0.3, 0.3)), gltf.add_lamp("lamp", (8, 7.5, 7)), translation=[0.2, 1.6, 0])
    gltf.add_sphere("ball", 0.4, gltf.add_lambert("clay", (0.8, 0.8, 0.8)), translation=[-0.3, 0.41, -0.2])
    gltf.add_camera("camera", (0, 0.9, 2.6), (0, 0.7, 0), 45)


@scene("foggy")
def foggy(gltf):
    """A post under a spot, to stand in a ball of fog that holds neither the spot nor the camera; to be lit by sky.pfm, too."""
    add_ground(gltf)
    place_faces(gltf, "post", box_faces((-0.2, 0, -0.2), (0.2, 0.9, 0.2)), gltf.add_lambert("post", (0.8, 0.75, 0.4)))
    gltf.add_light("spot", "spot", 90, (1, 0.85, 0.7), eye=(2.2, 4, 0.4), direction=(-0.55, -1, -0.1),
                   spot={"innerConeAngle": 0.15, "outerConeAngle": 0.25})
    gltf.add_camera("camera", (0, 1.5, 4.8), (0, 0.8, 0), 36)


@scene("smoke")
def smoke(gltf):
    """Two lamps, one of them behind what plume.nvdb fills, the cube of 1 m over the middle of the ground; to be lit by sky.pfm, too."""
    add_ground(gltf)
    place_quad(gltf, "lamp", geometry.flip(ground(0.25, 0.25)), gltf.add_lamp("lamp", (20, 18, 15)), translation=[0.9, 1.9, -0.6])
    gltf.add_node("plume", translation=[0, 0.55, 0], extras={"fragtrace_volume": {
        "volume": "plume.nvdb", "density": 14, "color": [0.9, 0.8, 0.65], "anisotropy": 0.4}})
    gltf.add_camera("camera", (0, 1.1, 3.2), (0, 0.5, 0), 28)


@scene("closed-media")
def closed_media(gltf):
    """A closed box that glows by 1, and in it media that only scatter: nothing of them is seen. To be lit by the white light."""
    for i, (anisotropy, ior) in enumerate(((0, 1), (0.7, 1), (0, 1.5), (0.7, 1.5))):
        x = round(0.9 * (i - 1.5), 3)
        gltf.add_sphere("ball", 0.4, medium(gltf, "white", 0.2, (0.3, 0.2, 0.1), anisotropy=anisotropy, ior=ior), translation=[x, 0, 0])
    gltf.add_camera("camera", (0, 0, 4), (0, 0, 0), 50)

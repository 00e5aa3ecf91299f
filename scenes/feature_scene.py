# SPDX-License-Identifier: MIT
"""The scene of the loader's features: transforms.gltf."""

import math
import struct

import geometry
from geometry import QUAD_INDICES, QUAD_UVS, icosphere, join_quads, quad
from gltf_writer import TRIANGLE_FAN, TRIANGLE_STRIP, rotation_about
from picture_files import write_png
from scene_parts import place_quad, scene

# Loader features

LETTER_F = [quad((-0.3, -0.4, 0), (0.16, 0, 0), (0, 0.8, 0)), quad((-0.14, 0.24, 0), (0.44, 0, 0), (0, 0.16, 0)),
            quad((-0.14, -0.06, 0), (0.3, 0, 0), (0, 0.16, 0))]
UNIT_QUAD = quad((-0.4, -0.4, 0), (0.8, 0, 0), (0, 0.8, 0))


def disc_texel(x, y, size=32):
    """Yellow over violet halves, opaque inside a disc that lies towards the upper left."""
    alpha = 255 - min(max(round(24 * math.hypot(x - 13, y - 13) - 200), 0), 255)
    return (240, 200, 40, alpha) if y < size // 2 else (140, 60, 200, alpha)


def arrows_texel(x, y):
    """4 x 4 texels that differ under every turn and flip."""
    return ((230, 60, 40), (40, 180, 70), (50, 80, 220), (240, 240, 240))[(x + y * (2 if x < 2 else 3)) % 4]


@scene("transforms")
def transforms(gltf):
    """A 4 x 4 board with a loader feature in each field; camera 1 is orthographic."""
    write_png(gltf.folder / "disc.png", 32, 32, disc_texel)
    write_png(gltf.folder / "arrows.png", 4, 4, arrows_texel)

    def field(column, row):
        return [column - 1.5, 1.5 - row, 0]

    backdrop = gltf.add_lambert("backdrop", (0.2, 0.22, 0.25))
    place_quad(gltf, "backdrop", quad((-2.2, -2.2, -0.5), (4.4, 0, 0), (0, 4.4, 0)), backdrop)

    # Row 0: one letter mesh under nested TRS, a matrix, one mirror, two mirrors.
    letter_positions, letter_indices = join_quads(LETTER_F)
    letter = gltf.add_mesh("letter", gltf.primitive(letter_positions, letter_indices, gltf.add_lambert("orange", (0.9, 0.45, 0.1))))
    outer = gltf.add_node("nested-outer", translation=field(0, 0), rotation=rotation_about((0, 0, 1), 30))
    inner = gltf.add_node("nested-inner", outer, scale=[1.2, 0.6, 1])
    gltf.add_node("nested-letter", inner, mesh=letter, rotation=rotation_about((0, 1, 0), 35))
    c, s = round(math.cos(math.radians(-20)), 9), round(math.sin(math.radians(-20)), 9)
    gltf.add_node("matrix-letter", mesh=letter, matrix=[1.1 * c, 1.1 * s, 0, 0, -0.7 * s, 0.7 * c, 0, 0, 0, 0, 1, 0] + field(1, 0) + [1])
    gltf.add_node("mirrored-letter", mesh=letter, translation=field(2, 0), scale=[-1, 1, 1])
    twice = gltf.add_node("mirrored-outer", translation=field(3, 0), scale=[-1, 1, 1])
    gltf.add_node("twice-mirrored-letter", twice, mesh=letter, scale=[1, -1, 1])

    # Row 1: alpha mask, alpha blend, vertex colours, unlit.
    disc = gltf.add_texture("disc.png")
    place_quad(gltf, "masked", UNIT_QUAD, gltf.add_lambert("masked", texture=disc, alphaMode="MASK", alphaCutoff=0.6),
               uvs=QUAD_UVS, translation=field(0, 1))
    place_quad(gltf, "blended", UNIT_QUAD, gltf.add_lambert("blended", (1, 1, 1, 0.8), texture=disc, alphaMode="BLEND"),
               uvs=QUAD_UVS, translation=field(1, 1))
    colors = gltf.add_accessor([(255, 0, 0, 255), (0, 255, 0, 255), (0, 0, 255, 255), (255, 255, 255, 255)], "B", normalized=True)
    tinted = gltf.primitive(UNIT_QUAD, QUAD_INDICES, gltf.add_lambert("tinted", (0.9, 0.9, 0.9)), COLOR_0=colors)
    gltf.place_mesh("vertex-colours", tinted, translation=field(2, 1))
    place_quad(gltf, "unlit", UNIT_QUAD, gltf.add_material("unlit", (0.1, 0.6, 0.7), extensions={"KHR_materials_unlit": {}}),
               translation=field(3, 1))

    # Row 2: strip without indices, fan with byte indices, sparse positions, the two sides of a surface.
    strip = [(-0.4 + 0.16 * (i // 2), (-0.35 if i % 2 == 0 else 0.1) + 0.1 * (i // 2 % 3), 0) for i in range(12)]
    strip = [strip[i ^ 1] for i in range(12)]
    gltf.place_mesh("strip", gltf.primitive(strip, None, gltf.add_lambert("lime", (0.5, 0.8, 0.2)), mode=TRIANGLE_STRIP),
                    translation=field(0, 2))
    fan = [(0, 0, 0)] + [(0.4 * math.cos(a), 0.4 * math.sin(a), 0) for a in (k * math.pi / 4 for k in range(7))]
    gltf.place_mesh("fan", gltf.primitive(fan, list(range(8)), gltf.add_lambert("pink", (0.9, 0.4, 0.6)), index_component="B",
                                          mode=TRIANGLE_FAN), translation=field(1, 2))
    sparse = gltf.primitive(UNIT_QUAD, QUAD_INDICES, gltf.add_lambert("sky", (0.3, 0.5, 0.9)), index_component="I")
    moved = gltf.root["accessors"][sparse["attributes"]["POSITION"]]
    moved["sparse"] = {"count": 1, "indices": {"bufferView": gltf.add_view(bytes([2])), "componentType": 5121},
                       "values": {"bufferView": gltf.add_view(bytes.fromhex("0000000000000000cdcccc3d"))}}
    moved["max"] = [moved["max"][0], moved["max"][1], gltf_float("cdcccc3d")]
    gltf.place_mesh("sparse", sparse, translation=field(2, 2))
    away = geometry.flip(quad((-0.4, -0.4, 0), (0.4, 0, 0), (0, 0.8, 0)))
    place_quad(gltf, "two-sided", away, gltf.add_lambert("two-sided", (0.8, 0.8, 0.2), doubleSided=True), translation=field(3, 2))
    place_quad(gltf, "one-sided", away, gltf.add_lambert("one-sided", (1, 0, 0)), translation=[1.9, -0.5, 0])

    # Row 3: wrap and filter modes, the second texture coordinate, normalised integer coordinates, smooth normals under a scale.
    nearest = gltf.add_texture("arrows.png", "nearest", ("mirror", "clamp"))
    place_quad(gltf, "wrapped", UNIT_QUAD, gltf.add_lambert("wrapped", texture=nearest),
               uvs=[(3 * u - 1, 2 * v - 0.5) for u, v in QUAD_UVS], translation=field(0, 3))
    arrows = gltf.add_texture("arrows.png", "nearest")
    second = gltf.primitive(UNIT_QUAD, QUAD_INDICES, gltf.add_lambert("second-uv", texture={"index": arrows, "texCoord": 1}),
                            uvs=[(0, 0)] * 4, TEXCOORD_1=gltf.add_accessor(QUAD_UVS))
    gltf.place_mesh("second-uv", second, translation=field(1, 3))
    integer_uvs = gltf.add_accessor([(round(65535 * 0.5 * u), 65535 * v) for u, v in QUAD_UVS], "H", normalized=True)
    halved = gltf.primitive(UNIT_QUAD, QUAD_INDICES, gltf.add_lambert("integer-uv", texture=arrows), TEXCOORD_0=integer_uvs)
    gltf.place_mesh("integer-uv", halved, translation=field(2, 3))
    points, triangles = icosphere(1, 1)
    gltf.place_mesh("egg", gltf.primitive(points, triangles, gltf.add_lambert("egg", (0.85, 0.85, 0.8)), points),
                    translation=field(3, 3), rotation=rotation_about((0, 0, 1), 40), scale=[0.42, 0.22, 0.3])

    gltf.add_light("sun", "directional", 2.5, direction=(-0.4, -0.6, -1))
    gltf.add_camera("perspective", (0.8, 0.4, 6), (0, 0, 0), 42)
    gltf.add_orthographic_camera("orthographic", (0, 0, 5), (0, 0, 0), 2.3, 2.3, 20)


def gltf_float(little_endian_hex):
    """The value of a stored float, for accessor bounds that must match it exactly."""
    return struct.unpack("<f", bytes.fromhex(little_endian_hex))[0]

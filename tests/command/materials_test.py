#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Extensions of materials through the command line: a picture made with one is the picture made without it."""
import base64
import json
import math
import random
import struct
import zlib

from support import Case, main


def data_uri(kind, data):
    return f"data:{kind};base64," + base64.b64encode(data).decode()


def png(width, height, rgba):
    """8 bits a channel."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    rows = b"".join(b"\0" + bytes(rgba[4 * width * y:4 * width * (y + 1)]) for y in range(height))
    header = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def noise(width, height, seed=1):
    return png(width, height, random.Random(seed).randbytes(4 * width * height))


def quad(material, uvs=((0, 1), (1, 1), (1, 0), (0, 0)), images=()):
    """A quad from (-1, -1) to (1, 1) that faces a camera 2.2 m away."""
    corners = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
    data = b"".join(struct.pack("<3f", *c) for c in corners) + b"".join(struct.pack("<2f", *t) for t in uvs)
    data += struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    views, accessors, start = [], [], 0
    for count, kind, component, size in ((4, "VEC3", 5126, 48), (4, "VEC2", 5126, 32), (6, "SCALAR", 5123, 12)):
        accessors.append({"bufferView": len(views), "componentType": component, "count": count, "type": kind})
        views.append({"buffer": 0, "byteOffset": start, "byteLength": size})
        start += size
    accessors[0].update(min=[-1, -1, 0], max=[1, 1, 0])
    primitive = {"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0}
    return {
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": len(data), "uri": data_uri("application/octet-stream", data)}],
        "bufferViews": views, "accessors": accessors, "materials": [material],
        "images": [{"uri": data_uri("image/png", image)} for image in images],
        "textures": [{"source": i} for i in range(len(images))],
        "meshes": [{"primitives": [primitive]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.1}}],
        "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 2.2]}],
        "scenes": [{"nodes": [0, 1]}], "scene": 0,
    }


class Materials(Case):
    def picture_of(self, gltf, *options):
        gltf = {k: v for k, v in gltf.items() if v}
        path = self.folder / "scene.gltf"
        path.write_text(json.dumps(gltf))
        return self.picture(str(path.with_suffix("")), "x.pfm", "--resolution", "32,32", *options)

    def assert_same(self, one, other, delta):
        for row, expected in zip(one, other):
            for pixel, wanted in zip(row, expected):
                for a, b in zip(pixel, wanted):
                    self.assertAlmostEqual(a, b, delta=delta)

    def test_a_transformed_texture_is_read_where_transformed_coordinates_say(self):
        angle, (sx, sy), (ox, oy) = 0.5, (1.5, -0.75), (0.2, 0.6)

        def transformed(u, v):
            c, s = math.cos(angle), math.sin(angle)
            return c * sx * u + s * sy * v + ox, -s * sx * u + c * sy * v + oy

        image = [noise(4, 8)]
        uvs = ((0, 1), (1, 1), (1, 0), (0, 0))
        transform = {"offset": [ox, oy], "rotation": angle, "scale": [sx, sy]}
        plain = {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}
        moved = {"pbrMetallicRoughness": {"baseColorTexture": {
            "index": 0, "extensions": {"KHR_texture_transform": transform}}}}
        options = ("--stage", "flat", "--spp", "1")
        expected = self.picture_of(quad(plain, [transformed(*uv) for uv in uvs], image), *options)
        self.assert_same(self.picture_of(quad(moved, uvs, image), *options), expected, 2e-4)
        unmoved = self.picture_of(quad(plain, uvs, image), *options)
        self.assertGreater(max(abs(a[0] - b[0]) for a, b in zip(unmoved[16], expected[16])), 0.1)

    def test_specular_glossiness_is_the_dielectric_that_reflects_as_much(self):
        def white(alpha):
            return png(1, 1, [255, 255, 255, alpha])

        glossy = {"extensions": {"KHR_materials_pbrSpecularGlossiness": {
            "diffuseFactor": [0.6, 0.4, 0.2, 1], "specularFactor": [0.04, 0.04, 0.04], "glossinessFactor": 0.6,
            "specularGlossinessTexture": {"index": 0}}}}
        rough = {"pbrMetallicRoughness": {
            "baseColorFactor": [0.6 * 0.96, 0.4 * 0.96, 0.2 * 0.96, 1], "metallicFactor": 0,
            "roughnessFactor": 1 - 0.6 * 51 / 255}}
        expected = self.picture_of(quad(rough), "--spp", "4")
        self.assertGreater(expected[16][16][0], 0.1)
        # The texture's alpha is kept as a half float.
        self.assert_same(self.picture_of(quad(glossy, images=[white(51)]), "--spp", "4"), expected, 1e-3)


if __name__ == "__main__":
    main()

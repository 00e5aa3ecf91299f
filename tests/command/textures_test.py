#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A texture of one colour is a factor: squares under one directional light, each once with the texture and once with the product."""
import base64
import copy
import json
import math
import os
import random
import shutil
import struct
import subprocess
import unittest
import zlib
from pathlib import Path

from support import FRAGTRACE, SQUARE, TWO_TRIANGLES, Case, Gltf, data_uri, main, png, quad, read_pfm, run

COLOURS = {"baseColorTexture", "emissiveTexture", "specularColorTexture", "sheenColorTexture"}  # sRGB
SIDE = 8  # pixels of a square
ANGLE = 1.0  # angle between light and normal


def linear(key, texel):
    """The texel as light, or as the number that it is."""
    x = texel / 255
    if key in COLOURS:
        x = x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055)**2.4
    return x


def material(extension, color=(0, 0, 0), metallic=0, roughness=0.5, **more):
    """Makes a material whose light comes from the given values alone; the rest is black. A texture is given as its only
    texel."""
    base = {"baseColorFactor": [*color, 1], "metallicFactor": metallic, "roughnessFactor": roughness}
    return {"pbrMetallicRoughness": base, "extensions": {"KHR_materials_specular": {"specularFactor": 0}, "KHR_materials_" + extension: more}}


WHITE = [0.9, 0.8, 0.7]
MATERIALS = [
    {"pbrMetallicRoughness": {"baseColorFactor": [*WHITE, 1], "baseColorTexture": 150, "metallicFactor": 0}},
    {"pbrMetallicRoughness": {"baseColorFactor": [*WHITE, 1], "metallicFactor": 0.9, "roughnessFactor": 0.8, "metallicRoughnessTexture": 150}},
    material("transmission", WHITE, roughness=0, transmissionFactor=0.9, transmissionTexture=150),
    material("specular", specularFactor=0.9, specularTexture=150),
    material("specular", specularColorFactor=WHITE, specularColorTexture=150),
    material("clearcoat", clearcoatFactor=0.9, clearcoatTexture=150, clearcoatRoughnessFactor=0.3),
    material("clearcoat", clearcoatFactor=1, clearcoatRoughnessFactor=0.9, clearcoatRoughnessTexture=150),
    material("sheen", sheenColorFactor=WHITE, sheenColorTexture=150, sheenRoughnessFactor=0.5),
    material("sheen", sheenColorFactor=WHITE, sheenRoughnessFactor=0.9, sheenRoughnessTexture=150),
    material("iridescence", (0.5, 0.5, 0.5), 1, 0.4, iridescenceFactor=0.9, iridescenceTexture=150, iridescenceThicknessMaximum=400),
    material("iridescence", (0.5, 0.5, 0.5), 1, 0.4, iridescenceFactor=1, iridescenceThicknessMinimum=0, iridescenceThicknessMaximum=400,
             iridescenceThicknessTexture=150),
    material("diffuse_transmission", WHITE, diffuseTransmissionFactor=0.9, diffuseTransmissionTexture=150),
]


def multiplied(values, _):
    """Multiplies each texture's texel into the factor next to it, in the objects of a material."""
    for key in [key for key in values if key.endswith("Texture")]:
        texel = linear(key, values.pop(key))
        names = {"metallicRoughnessTexture": ["metallicFactor", "roughnessFactor"],
                 "iridescenceThicknessTexture": ["iridescenceThicknessMaximum"]}.get(key, [key.removesuffix("Texture") + "Factor"])
        for name in names:
            times = lambda c: c * texel
            values[name] = [*map(times, values[name][:3]), *values[name][3:]] if isinstance(values[name], list) else times(values[name])


def pictured(values, images):
    for key in [key for key in values if key.endswith("Texture")]:
        images.append(png(1, 1, [values[key]] * 3 + [values[key] if key not in COLOURS else 255]))
        values[key] = {"index": len(images) - 1}


class TextureFactors(Case):
    def means(self, change):
        """Returns the mean of each square and channel. The pictures with textures and those without are separate, since
        a shader for textures reads white where there is none."""
        images, materials = [], copy.deepcopy(MATERIALS)
        for m in materials:
            for values in [m["pbrMetallicRoughness"], *m.get("extensions", {}).values()]:
                change(values, images)
        gltf = quad(materials[0], images=images)
        count = len(materials)
        gltf["materials"] = materials
        gltf["meshes"] = [{"primitives": [dict(gltf["meshes"][0]["primitives"][0], material=i)]} for i in range(count)]
        gltf["nodes"] = [{"mesh": i, "translation": [2 * i - count + 1, 0, 0]} for i in range(count)] + [
            {"camera": 0, "translation": [0, 0, 5]},
            {"rotation": [0, math.sin(ANGLE / 2), 0, math.cos(ANGLE / 2)], "extensions": {"KHR_lights_punctual": {"light": 0}}}]
        gltf["scenes"] = [{"nodes": list(range(count + 2))}]
        gltf["cameras"] = [{"type": "orthographic", "orthographic": {"xmag": count, "ymag": 1, "zfar": 10, "znear": 0.1}}]
        gltf["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 2}]}}
        path = self.written("factors.gltf", {key: value for key, value in gltf.items() if value})
        picture = self.picture(str(path.with_suffix("")), "x.pfm", "--resolution", f"{count * SIDE},{SIDE}", "--spp", 4, "--bounces", 0)
        return [sum(row[SIDE * i + x][c] for row in picture for x in range(SIDE)) for i in range(count) for c in range(3)]

    def test_emission(self):
        image = png(1, 1, [200] * 3 + [255])
        gltf = quad({"emissiveFactor": WHITE, "emissiveTexture": {"index": 0}, "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}}, images=[image])
        gltf = {key: value for key, value in gltf.items() if value}
        path = self.written("emission.gltf", gltf)
        pixel = self.picture(str(path.with_suffix("")), "x.pfm", "--resolution", "8,8", "--spp", 1)[4][4]
        for seen, factor in zip(pixel, WHITE):
            self.assertAlmostEqual(seen / factor, linear("emissiveTexture", 200), delta=1e-6)

    def test_each_slot(self):
        """Within 2e-5: a texel is exact."""
        for i, (one, other) in enumerate(zip(self.means(multiplied), self.means(pictured))):
            self.assertAlmostEqual(other / one, 1, delta=2e-5, msg=MATERIALS[i // 3])


# 16 x 16, without loss, by libheif: the left half red, the right one blue with alpha 128.
AVIF = base64.b64decode(
    "AAAAHGZ0eXBhdmlmAAAAAGF2aWZtaWYxbWlhZgAAAZhtZXRhAAAAAAAAACFoZGxyAAAAAAAAAABwaWN0AAAAAAAAAAAAAAAAAAAAAA5waXRtAAAAAAABAAAANGlsb2MAAAAAREAAAgACAAAAAAG8AAEAAAAAAAAA"
    "FQABAAAAAAHRAAEAAAAAAAAAHwAAADhpaW5mAAAAAAACAAAAFWluZmUCAAAAAAEAAGF2MDEAAAAAFWluZmUCAAAAAAIAAGF2MDEAAAAA12lwcnAAAACxaXBjbwAAABNjb2xybmNseAACAAIABoAAAAAMYXYxQ4EA"
    "HAAAAAAUaXNwZQAAAAAAAAAQAAAAEAAAAA5waXhpAAAAAAEIAAAAOGF1eEMAAAAAdXJuOm1wZWc6bXBlZ0I6Y2ljcDpzeXN0ZW1zOmF1eGlsaWFyeTphbHBoYQAAAAAMYXYxQ4EADAAAAAAUaXNwZQAAAAAAAAAQ"
    "AAAAEAAAABBwaXhpAAAAAAMICAgAAAAeaXBtYQAAAAAAAAACAAEEgYYHiAACBIIDhIUAAAAaaXJlZgAAAAAAAAAOYXV4bAACAAEAAQAAADxtZGF0EgAKBRgM/9hUMgpEAACMqqhVK6aAEgAKCRgM/9ggQEDQgDIQ"
    "RAAAhsVpr/iPfFOIKWSGMA==")


class TextureSources(Case):
    """Pictures and coordinates of textures: AVIF (EXT_texture_avif), and any set of coordinates."""

    def scene(self, picture, texture=None, sets=1, materials=None, kind="image/png"):
        """A square from -1 to 1 with a texture. Coordinates of the last set lie in the picture's right half, others in the left one."""
        gltf = Gltf()
        attributes = {"POSITION": gltf.accessor(SQUARE)}
        for i in range(sets):
            last = sets > 1 and i == sets - 1
            attributes[f"TEXCOORD_{i}"] = gltf.accessor([(0.75 if last else 0.25, 0.5)] * 4 if sets > 1 else [(0, 1), (1, 1), (1, 0), (0, 0)])
        indices = gltf.accessor(TWO_TRIANGLES, "H")
        gltf.root["meshes"] = [{"primitives": [{"attributes": attributes, "indices": indices, "material": 0}]}]
        gltf.root["nodes"] = [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 2]}]
        gltf.root["cameras"] = [{"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0.1, "zfar": 9}}]
        gltf.root["scenes"] = [{"nodes": [0, 1]}]
        gltf.root["images"] = [{"uri": data_uri(kind, picture)}]
        gltf.root["textures"] = [texture or {"source": 0}]
        gltf.root["materials"] = materials or [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}, "extensions": {"KHR_materials_unlit": {}}}]
        gltf.root["extensionsUsed"] = ["KHR_materials_unlit", "EXT_texture_avif"]
        return gltf.write(self.folder / "scene.gltf")

    def colors(self, scene):
        """Of the left and of the right half."""
        self.renders(scene, "-o", self.folder / "x.pfm", "--resolution", "8,8", "--spp", 1, "--stage", "flat", "--quiet")
        rows = read_pfm(self.folder / "x.pfm")
        return rows[4][2], rows[4][6]

    def test_avif(self):
        texture = {"extensions": {"EXT_texture_avif": {"source": 0}}}
        scene = self.scene(AVIF, texture, kind="image/avif")
        result = run("info", scene, "--decode")
        if "AVIF cannot be decoded" in result.stderr:
            self.assertRegex(result.stderr, "libheif")
            self.skipTest(result.stderr)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        for color, right in zip(self.colors(scene), ((1, 0, 0), (0, 0, 1))):
            for a, b in zip(color, right):
                self.assertAlmostEqual(a, b, delta=0.02)  # one step of luma and chroma
        # A fallback is drawn where there is one: all systems have it.
        both = {"source": 0, **texture}
        document = json.loads(self.scene(png(1, 1, [0, 255, 0, 255]), both).read_text())
        document["images"].append({"uri": data_uri("image/avif", AVIF)})
        document["textures"][0]["extensions"]["EXT_texture_avif"]["source"] = 1
        scene.write_text(json.dumps(document))
        self.assertEqual(self.colors(scene)[0], (0, 1, 0))

    def test_broken_avif(self):
        """Each is refused, and its picture named."""
        texture = {"extensions": {"EXT_texture_avif": {"source": 0}}}
        size = AVIF.index(b"ispe") + 8
        for broken in (AVIF[:40], AVIF[:300], AVIF[:-20], AVIF.replace(b"ispe", b"xspe"), AVIF[:size] + struct.pack(">II", 1 << 20, 1 << 20) + AVIF[size + 8:],
                       AVIF[:size] + struct.pack(">II", 17, 16) + AVIF[size + 8:], AVIF[:28] + b"\0\0\0\0" + AVIF[32:], AVIF[:28] + b"\xff" * 4 + AVIF[32:]):
            result = run("info", self.scene(broken, texture, kind="image/avif"), "--decode", "--missing-textures", "refuse")
            if result.returncode == 0:  # what the properties say of alpha, or of a box up to the end, may be anything
                continue
            self.assertEqual(result.returncode, 3, result.stderr)
            self.assertIn("/images/0", result.stderr)
            self.assertNotIn("signal", result.stderr)

    def test_any_set_of_coordinates(self):
        unlit = lambda **more: [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, **more}}, "extensions": {"KHR_materials_unlit": {}}}]
        picture = png(2, 1, [255, 0, 0, 255, 0, 0, 255, 255])
        for sets in (2, 3, 5):
            scene = self.scene(picture, sets=sets, materials=unlit(texCoord=sets - 1))
            self.assertEqual(run("info", scene).stderr, "")
            self.assertEqual(self.colors(scene)[0], (0, 0, 1), sets)
            self.assertEqual(self.colors(self.scene(picture, sets=sets, materials=unlit()))[0], (1, 0, 0), sets)
            transform = {"KHR_texture_transform": {"texCoord": sets - 1}}
            self.assertEqual(self.colors(self.scene(picture, sets=sets, materials=unlit(extensions=transform)))[0], (0, 0, 1), sets)

    def test_a_third_set_of_a_material_is_said(self):
        material = {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 0, "texCoord": 1}}, "normalTexture": {"index": 0, "texCoord": 2}}
        said = run("info", self.scene(png(1, 1, [128, 128, 255, 255]), sets=3, materials=[material])).stderr
        self.assertIn("/materials/0: has textures of more than two sets of coordinates; TEXCOORD_0 is taken instead of TEXCOORD_2", said)


WRAPS = {"repeat": 10497, "clamp": 33071, "mirror": 33648}
FILTERS = {"linear": 9729, "nearest": 9728}
KNOWN_TEXTURES_SIDE = 16      # pixels of a square
PARTS = 8      # points per side of a pixel in the expected mean
TEXELS = 4     # a side of the texture
OFFSET, ROTATION, SCALE = (0.4, -0.3), 0.2, (1.2, 0.9)  # the numbers of KHR_texture_transform
FIRST, LAST = -0.9, 1.3  # texture coordinates over a square, before the transform


READS = ("words", "arrays")
# Mesa's software driver decodes the sRGB of array textures by a polynomial.
LARGEST_ERROR = {"words": 1e-6, "arrays": 1.5e-3}


def known_textures_linear(x):
    return x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055)**2.4


def texture():
    """Returns the red of the texels, and the same as linear light."""
    numbers = random.Random(3)
    texels = [[numbers.randrange(256) for _ in range(TEXELS)] for _ in range(TEXELS)]
    return texels, [[known_textures_linear(t / 255) for t in row] for row in texels]


def wrapped(i, wrap):
    if wrap == "clamp":
        return min(max(i, 0), TEXELS - 1)
    if wrap == "repeat":
        return i % TEXELS
    i %= 2 * TEXELS
    return i if i < TEXELS else 2 * TEXELS - 1 - i


def sampled(light, u, v, wrap, kind):
    c, s = math.cos(ROTATION), math.sin(ROTATION)
    x = (c * SCALE[0] * u + s * SCALE[1] * v + OFFSET[0]) * TEXELS
    y = (-s * SCALE[0] * u + c * SCALE[1] * v + OFFSET[1]) * TEXELS
    if kind == "nearest":
        return light[wrapped(math.floor(y), wrap)][wrapped(math.floor(x), wrap)]
    i, j = math.floor(x - 0.5), math.floor(y - 0.5)
    f, g = x - 0.5 - i, y - 0.5 - j
    row = lambda j: (1 - f) * light[wrapped(j, wrap)][wrapped(i, wrap)] + f * light[wrapped(j, wrap)][wrapped(i + 1, wrap)]
    return (1 - g) * row(j) + g * row(j + 1)


class KnownTextures(Case):
    """Each value of a texture, each wrap and filter, sizes of all kinds, read as words and from arrays: pixels are what the specification says."""

    def square(self, reads, images, materials, uv, *options, side=16):
        """Draws a square for each material, from the left to the right, with `side` pixels each. Returns rows of colours."""
        count = len(materials)
        gltf = Gltf(materials=materials, textures=[{"source": i, "sampler": 0} for i in range(len(images))], samplers=[{"magFilter": FILTERS["nearest"]}],
                    images=[{"uri": data_uri("image/png", image)} for image in images],
                    cameras=[{"type": "orthographic", "orthographic": {"xmag": count, "ymag": 1, "zfar": 10, "znear": 0.1}}])
        position, indices = gltf.accessor(SQUARE), gltf.accessor(TWO_TRIANGLES, "H")
        first, last = uv
        uvs = gltf.accessor([(first, last), (last, last), (last, first), (first, first)])
        for i in range(count):
            gltf.node(mesh=gltf.mesh(indices, position=position, texcoord_0=uvs, material=i), translation=[2 * i - count + 1, 0, 0])
        gltf.node(camera=0, translation=[0, 0, 5])
        path = gltf.write(self.folder / "square.gltf")
        return self.picture(str(path.with_suffix("")), "x.pfm", "--resolution", f"{count * side},{side}", "--spp", 1, "--texture-reads", reads, *options)

    def test_each_value(self):
        """256 of 8 bits, and of 16 bits those next to them, as colours."""
        for reads in READS:
            for bits, values in ((8, range(256)), (16, [v * 257 for v in range(256)]), (16, [v * 257 + 129 for v in range(255)] + [1])):
                texels = [n for v in values for n in (v, values[0], v, values[-1])]
                colour = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]
                picture = self.square(reads, [png(16, 16, texels, bits)], colour, (0, 1), "--stage", "flat")
                for i, value in enumerate(values):
                    expected = known_textures_linear(value / (2**bits - 1))
                    pixel = picture[i // 16][i % 16]
                    self.assertLessEqual(abs(pixel[0] - expected), 7e-6 if reads == "words" and bits == 16 else LARGEST_ERROR[reads], (reads, bits, value))
                    self.assertEqual(pixel[0], pixel[2])

    def test_numbers(self):
        """Normals are no colours: no curve is decoded."""
        numbers = random.Random(4)
        for reads in READS:
            for bits in (8, 16):
                one = 2**bits - 1
                texels = [n for _ in range(256) for n in (numbers.randrange(one), numbers.randrange(one), numbers.randrange(one * 3 // 4, one), one)]
                picture = self.square(reads, [png(16, 16, texels, bits)], [{"normalTexture": {"index": 0}}], (0, 1), "--stage", "normal-maps", "--debug-view", "normal")
                for i in range(256):
                    normal = [2 * n / one - 1 for n in texels[4 * i:4 * i + 3]]
                    length = math.hypot(*normal)
                    for got, expected in zip(picture[i // 16][i % 16], normal):
                        self.assertLess(abs(got - known_textures_linear(0.5 + 0.5 * expected / length)), 2e-6, (reads, bits, i))

    def test_sizes(self):
        """No picture shows at the borders of another, however they lie in memory."""
        sizes = [(1, 1), (3, 5), (1, 16384), (16384, 1), (1023, 2), (2, 1025), (17, 31), (256, 256)]
        shades = [20 + 30 * i for i in range(len(sizes))]
        images = [png(w, h, [shade, 255 - shade, shade, 255] * (w * h)) for (w, h), shade in zip(sizes, shades)]
        materials = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": i}}} for i in range(len(sizes))]
        for reads, kind in ((reads, kind) for reads in READS for kind in ("exact", "cones")):
            picture = self.square(reads, images, materials, (-2.3, 3.1), "--stage", "flat", "--texture-filter", kind, side=32)
            for i, shade in enumerate(shades):
                for row in picture:
                    for pixel in row[32 * i:32 * i + 32]:
                        self.assertLess(abs(pixel[0] - known_textures_linear(shade / 255)), LARGEST_ERROR[reads], (kind, sizes[i]))
                        self.assertLess(abs(pixel[1] - known_textures_linear(1 - shade / 255)), LARGEST_ERROR[reads], (kind, sizes[i]))

    def test_each_wrap_and_filter(self):
        texels, light = texture()
        kinds = [(wrap, kind) for wrap in WRAPS for kind in FILTERS]
        transform = {"KHR_texture_transform": {"offset": OFFSET, "rotation": ROTATION, "scale": SCALE}}
        count = len(kinds)
        gltf = Gltf(materials=[{"pbrMetallicRoughness": {"baseColorTexture": {"index": i, "extensions": transform}}} for i in range(count)],
                    textures=[{"source": 0, "sampler": i} for i in range(count)],
                    samplers=[{"magFilter": FILTERS[kind], "wrapS": WRAPS[wrap], "wrapT": WRAPS[wrap]} for wrap, kind in kinds],
                    images=[{"uri": data_uri("image/png", png(TEXELS, TEXELS, [b for row in texels for t in row for b in (t, t, t, 255)]))}],
                    cameras=[{"type": "orthographic", "orthographic": {"xmag": count, "ymag": 1, "zfar": 10, "znear": 0.1}}])
        position, uv = gltf.accessor(SQUARE), gltf.accessor([(FIRST, LAST), (LAST, LAST), (LAST, FIRST), (FIRST, FIRST)])
        indices = gltf.accessor(TWO_TRIANGLES, "H")
        for i in range(count):
            gltf.node(mesh=gltf.mesh(indices, position=position, texcoord_0=uv, material=i), translation=[2 * i - count + 1, 0, 0])
        gltf.node(camera=0, translation=[0, 0, 5])
        path = gltf.write(self.folder / "textures.gltf")
        for reads in READS:
            picture = self.picture(str(path.with_suffix("")), "x.pfm", "--resolution", f"{count * KNOWN_TEXTURES_SIDE},{KNOWN_TEXTURES_SIDE}", "--spp", 256, "--stage", "flat", "--texture-reads", reads)
            self.check(picture, light, kinds)

    def check(self, picture, light, kinds):
        points = [(LAST - FIRST) * (i + 0.5) / (KNOWN_TEXTURES_SIDE * PARTS) + FIRST for i in range(KNOWN_TEXTURES_SIDE * PARTS)]
        for square, (wrap, kind) in enumerate(kinds):
            apart = 0.0
            for y in range(KNOWN_TEXTURES_SIDE):
                for x in range(KNOWN_TEXTURES_SIDE):
                    expected = sum(sampled(light, u, v, wrap, kind) for u in points[PARTS * x:PARTS * (x + 1)] for v in points[PARTS * y:PARTS * (y + 1)])
                    apart += abs(picture[y][KNOWN_TEXTURES_SIDE * square + x][0] - expected / PARTS**2) / KNOWN_TEXTURES_SIDE**2
            print(wrap, kind, f"{apart:.5f}")
            # A tenth of a texel makes 0.01 or more.
            self.assertLess(apart, 1e-3 if kind == "linear" else 4e-3, (wrap, kind))


REFUSE = ("--missing-textures", "refuse")


def wrong_png():
    """Checksums are right, but the pixels are no stream of zlib."""
    whole = png(4, 4, [10, 200, 10, 255] * 16)
    at = whole.index(b"IDAT")
    length = struct.unpack(">I", whole[at - 4:at])[0]
    content = b"IDAT" + bytes(length)
    return whole[:at] + content + struct.pack(">I", zlib.crc32(content)) + whole[at + 8 + length:]


class MissingTextures(Case):
    """Textures whose picture is missing or broken: drawn without and said, or refused (--missing-textures)."""

    def scene(self, material, uris):
        gltf = quad(material)
        gltf["images"] = [{"uri": uri} for uri in uris]
        gltf["textures"] = [{"source": i} for i in range(len(uris))]
        return self.written("scene.gltf", gltf)

    def middle(self, scene, stage="flat"):
        path = self.folder / "x.pfm"
        result = run("render", scene, "-o", path, "--resolution", "9,9", "--spp", 4, "--stage", stage)
        self.assertEqual(result.returncode, 0, result.stderr)
        return read_pfm(path)[4][4], result.stderr

    BASE = {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}

    def test_a_base_colour_is_magenta_and_said_once(self):
        whole = png(4, 4, [10, 200, 10, 255] * 16)
        (self.folder / "cut.png").write_bytes(whole[:-30])
        (self.folder / "odd.png").write_text("no picture")
        for name, reason in (("gone.png", "cannot be opened"), ("cut.png", ""), ("odd.png", "")):
            scene = self.scene(self.BASE, [name, name])
            refused = run("render", scene, "-o", self.folder / "y.pfm", "--resolution", "9,9", "--spp", 1, *REFUSE)
            self.assertEqual(refused.returncode, 3, name)
            self.assertFalse((self.folder / "y.pfm").exists())
            color, said = self.middle(scene)
            self.assertEqual(color, (1, 0, 1), name)
            self.assertEqual(said.count(name), 1, said)
            self.assertIn(reason, said)
            info = run("info", scene)
            self.assertEqual(info.returncode, 0)
            self.assertIn(name, info.stderr + info.stdout)

    def test_what_is_broken_is_named_by_file_and_by_place(self):
        whole = png(4, 4, [10, 200, 10, 255] * 16)
        webp = b"RIFF\x20\0\0\0WEBPVP8 \x14\0\0\0\x30\x01\0\x9d\x01\x2a\x04\0\x04\0" + bytes(10)
        for name, data in (("head.png", whole[:20]), ("cut.png", whole[:-30]), ("odd.png", b"no picture"), ("cut.webp", webp)):
            (self.folder / name).write_bytes(data)
            self.fails(3, "render", self.scene(self.BASE, [name]), "-o", self.folder / "y.pfm", "--resolution", "9,9", "--spp", 1, "--quiet", *REFUSE,
                       says=[name, "scene.gltf: /images/0"])
            self.fails(3, "info", self.scene(self.BASE, [name]), "--decode", *REFUSE, says=[name, "scene.gltf: /images/0"])

    def test_a_damaged_picture_is_magenta(self):
        """The bytes of a PNG without their checksum and with it, pixels of a JPEG and of a WebP: seen when they are drawn."""
        whole = bytearray(png(4, 4, [10, 200, 10, 255] * 16))
        whole[50] ^= 0x40
        jpeg = (b"\xff\xd8\xff\xc0\0\x0b\x08\0\x04\0\x04\x01\x01\x11\0\xff\xda\0\x08\x01\x01\0\0\x3f\0" + bytes(9) + b"\xff\xd9")
        webp = b"RIFF\x20\0\0\0WEBPVP8 \x14\0\0\0\x30\x01\0\x9d\x01\x2a\x04\0\x04\0" + bytes(10)
        shining = {"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0}, "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0}}
        green = {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "baseColorFactor": [0, 1, 0, 1]}}
        for name, data in (("bad.png", bytes(whole)), ("sums.png", wrong_png()), ("bad.jpg", jpeg), ("bad.webp", webp)):
            (self.folder / name).write_bytes(data)
            for material, stage in ((shining, "phong"), (green, "flat"), (self.BASE, "flat")):
                scene = self.scene(material, [name])
                color, said = self.middle(scene, stage)
                if material == shining:
                    self.assertLess(max(color), 0.5)  # what the studio's light leaves of it
                else:
                    self.assertEqual(color, (1, 0, 1), said)
                self.assertEqual(said.count(name), 1, said)
                self.assertIn("scene.gltf: /images/0", said)
                self.assertIn("; a base colour is drawn in magenta, other textures are left out", said)
            for options, status in (((), 0), (("--strict",), 3), (REFUSE, 3)):
                info = run("info", scene, "--decode", *options)
                self.assertEqual(info.returncode, status, info.stderr)
                self.assertIn(name, info.stderr)
                self.assertEqual(run("render", scene, "-o", self.folder / "y.pfm", "--resolution", "9,9", "--spp", 1, *options).returncode, status)

    def test_all_that_is_missing_is_named_at_once(self):
        scene = self.scene({**self.BASE, "normalTexture": {"index": 1}, "emissiveTexture": {"index": 2}}, ["a.png", "b.png", "maps/c.png"])
        _, said = self.middle(scene)
        self.assertIn("/images/0/uri: a.png, b.png, maps/c.png cannot be opened: No such file", said)
        self.fails(3, "info", scene, *REFUSE, says=["/images/0/uri: ", "a.png cannot be opened", "; also missing: b.png, maps/c.png"])
        root = json.loads(scene.read_text())
        root["buffers"][0]["uri"] = "data.bin"
        scene.write_text(json.dumps(root))
        self.fails(3, "info", scene, says=["/buffers/0/uri: ", "data.bin cannot be opened", "; also missing: a.png, b.png, maps/c.png"])

    def test_one_outside_of_the_folder_is_refused(self):
        self.fails(3, "info", self.scene(self.BASE, ["../gone.png"]), says=["/images/0/uri: ", "leads out of the scene's folder"])

    def test_one_that_is_there_is_drawn(self):
        (self.folder / "there.png").write_bytes(png(4, 4, [0, 255, 0, 255] * 16))
        color, said = self.middle(self.scene(self.BASE, ["there.png"]))
        self.assertEqual(color, (0, 1, 0))
        self.assertNotIn("there.png", said)

    def test_a_lamp_does_not_shine(self):
        material = {"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0},
                    "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0}}
        color, _ = self.middle(self.scene(material, ["gone.png"]))
        self.assertEqual(color, (0, 0, 0))

    def test_a_choice_that_is_none_is_refused(self):
        result = run("info", self.scene(self.BASE, ["gone.png"]), "--missing-textures", "maybe")
        self.assertEqual(result.returncode, 2)


SAMPLES = Path(__file__).resolve().parent.parent / "ktx2"
MODULE = "libfragtrace_ktx2.so"
has_codec = unittest.skipUnless((FRAGTRACE.parent / MODULE).exists(), "built without the codec of KTX2 (scripts/setup ktx2)")
WITHOUT = f"wood.ktx2: KTX2 cannot be decoded: {MODULE} is not in "
SMALL = ("--resolution", "9,9", "--spp", 4, "--stage", "flat")


class Ktx2(Case):
    """KTX2 textures of KHR_texture_basisu: drawn where the codec was built, and said where it is missing. Their texels are compared in
    tests/pure/image_ktx2_test.cpp."""

    def scene(self, required=True, fallback=False, name="basisu_uastc"):
        """A quad with a texture of that sample; the fallback is green."""
        gltf = quad({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}})
        shutil.copy(SAMPLES / f"{name}.ktx2", self.folder / "wood.ktx2")
        (self.folder / "green.png").write_bytes(png(1, 1, [0, 255, 0, 255]))
        gltf["images"] = [{"uri": "wood.ktx2"}, {"uri": "green.png"}]
        gltf["textures"] = [{"extensions": {"KHR_texture_basisu": {"source": 0}}, **({"source": 1} if fallback else {})}]
        gltf["extensionsUsed"] = ["KHR_texture_basisu"]
        if required:
            gltf["extensionsRequired"] = ["KHR_texture_basisu"]
        return self.written("scene.gltf", gltf)

    def run_without_codec(self, *arguments):
        """Runs a copy of the program that has only its worker and the module for pictures."""
        folder = self.folder / "program"
        if not folder.exists():
            folder.mkdir()
            for name in ("fragtrace", "fragtrace_worker", "libfragtrace_pictures.so"):
                shutil.copy(FRAGTRACE.parent / name, folder)
        environment = {k: v for k, v in os.environ.items() if k != "FRAGTRACE_LIBRARY_PATH"}
        return subprocess.run([folder / "fragtrace", *map(str, arguments)], capture_output=True, text=True, env=environment)

    def middle(self, scene, *options, program=run):
        path = self.folder / "x.pfm"
        result = program("render", scene, "-o", path, *SMALL, *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return read_pfm(path)[4][4], result.stderr

    def test_without_the_codec_the_texture_of_a_file_that_requires_it_is_missing(self):
        result = self.run_without_codec("info", self.scene(), "--missing-textures", "refuse")
        self.assertEqual(result.returncode, 3, result.stdout)
        for text in ("scene.gltf: /images/0: " + WITHOUT, "`scripts/setup ktx2`", "`gltf-transform ktxdecompress IN OUT`", "(--missing-textures magenta"):
            self.assertIn(text, result.stderr)
        color, said = self.middle(self.scene(), program=self.run_without_codec)
        self.assertEqual(color, (1, 0, 1))
        self.assertIn(WITHOUT, said)

    def test_without_the_codec_a_file_that_does_not_require_it_is_drawn_without_the_texture(self):
        color, said = self.middle(self.scene(required=False), program=self.run_without_codec)
        self.assertEqual(color, (1, 1, 1))
        self.assertIn(f"/textures/0/extensions/KHR_texture_basisu: is left out: KTX2 cannot be decoded: {MODULE} is not in", said)
        self.assertIn("`scripts/setup ktx2`", said)

    def test_the_fallback_is_drawn_and_nothing_is_said(self):
        for required, program in ((False, self.run_without_codec), (True, self.run_without_codec), (False, run)):
            color, said = self.middle(self.scene(required, fallback=True), program=program)
            self.assertEqual(color, (0, 1, 0))
            self.assertNotIn("ktx2", said.lower())
            self.assertNotIn("KHR_texture_basisu", said)

    @has_codec
    def test_it_is_drawn_and_counted(self):
        for required in (False, True):
            # The colour is half of red and of green, in sRGB.
            (red, green, blue), said = self.middle(self.scene(required))
            self.assertNotIn("ktx2", said.lower())
            self.assertAlmostEqual(red, 0.21, delta=0.05)
            self.assertAlmostEqual(green, 0.21, delta=0.05)
            self.assertLess(blue, 0.4)
        scene = json.loads(run("info", "--json", "--decode", self.scene()).stdout)["scene"]
        self.assertEqual((scene["textures"], scene["images"]), (1, 1))

    @has_codec
    def test_it_is_drawn_where_the_fallback_is_missing(self):
        scene = self.scene(required=False, fallback=True)
        (self.folder / "green.png").unlink()
        (red, green, _), said = self.middle(scene)
        self.assertAlmostEqual(red, green, delta=0.05)
        self.assertIn('/images/1: "green.png" is missing; the KTX2 picture beside it is drawn', said)
        for gone, program in ((None, self.run_without_codec), ("wood.ktx2", run)):
            if gone:
                (self.folder / gone).unlink()
            result = program("info", scene, "--missing-textures", "refuse")
            self.assertEqual(result.returncode, 3)
            self.assertIn("green.png cannot be opened", result.stderr)

    @has_codec
    def test_a_broken_one_is_named_by_file_and_by_place(self):
        scene = self.scene(name="basisu_uastc_zstd_alpha")
        whole = (self.folder / "wood.ktx2").read_bytes()
        cube = whole[:36] + b"\6" + whole[37:]
        noise = whole[:-200] + bytes((i * 151 + 77) % 256 for i in range(200))
        for data, reason in ((cube, "it is a cube map"), (whole[:-30], "the file is truncated"), (noise, "its level 0 is broken")):
            (self.folder / "wood.ktx2").write_bytes(data)
            self.fails(3, "info", scene, "--decode", "--missing-textures", "refuse", says=["wood.ktx2", "scene.gltf: /images/0", reason])

    def test_a_codec_that_crashes_is_named(self):
        (self.folder / "fragtrace_worker").write_text("#!/bin/sh\nkill -SEGV $$")
        (self.folder / "fragtrace_worker").chmod(0o755)
        (self.folder / MODULE).touch()
        self.fails(3, "info", self.scene(), "--decode", "--missing-textures", "refuse", says=["wood.ktx2: KTX2 cannot be decoded: the codec of KTX2 textures failed", "signal 11"],
                   env={**os.environ, "FRAGTRACE_LIBRARY_PATH": str(self.folder)})

    def test_it_is_no_environment(self):
        shutil.copy(SAMPLES / "basisu_uastc.ktx2", self.folder)
        self.fails(3, "render", self.scene(fallback=True), "-o", self.folder / "x.pfm", *SMALL, "--quiet", "--hdri-file", self.folder / "basisu_uastc.ktx2",
                   says=["basisu_uastc.ktx2: a KTX2 or AVIF picture is read as a texture only"])


if __name__ == "__main__":
    main()

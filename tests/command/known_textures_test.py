#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Each value of a texture, each wrap and filter, sizes of all kinds, read as words and from arrays: pixels are what the specification says."""
import math
import random

from support import SQUARE, TWO_TRIANGLES, Case, Gltf, data_uri, main, png

WRAPS = {"repeat": 10497, "clamp": 33071, "mirror": 33648}
FILTERS = {"linear": 9729, "nearest": 9728}
SIDE = 16      # pixels of a square
PARTS = 8      # points per side of a pixel in the expected mean
TEXELS = 4     # a side of the texture
OFFSET, ROTATION, SCALE = (0.4, -0.3), 0.2, (1.2, 0.9)  # the numbers of KHR_texture_transform
FIRST, LAST = -0.9, 1.3  # texture coordinates over a square, before the transform


READS = ("words", "arrays")
# Mesa's software driver decodes the sRGB of array textures by a polynomial.
LARGEST_ERROR = {"words": 1e-6, "arrays": 1.5e-3}


def linear(x):
    return x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055)**2.4


def texture():
    """Returns the red of the texels, and the same as linear light."""
    numbers = random.Random(3)
    texels = [[numbers.randrange(256) for _ in range(TEXELS)] for _ in range(TEXELS)]
    return texels, [[linear(t / 255) for t in row] for row in texels]


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
                    expected = linear(value / (2**bits - 1))
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
                        self.assertLess(abs(got - linear(0.5 + 0.5 * expected / length)), 2e-6, (reads, bits, i))

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
                        self.assertLess(abs(pixel[0] - linear(shade / 255)), LARGEST_ERROR[reads], (kind, sizes[i]))
                        self.assertLess(abs(pixel[1] - linear(1 - shade / 255)), LARGEST_ERROR[reads], (kind, sizes[i]))

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
            picture = self.picture(str(path.with_suffix("")), "x.pfm", "--resolution", f"{count * SIDE},{SIDE}", "--spp", 256, "--stage", "flat", "--texture-reads", reads)
            self.check(picture, light, kinds)

    def check(self, picture, light, kinds):
        points = [(LAST - FIRST) * (i + 0.5) / (SIDE * PARTS) + FIRST for i in range(SIDE * PARTS)]
        for square, (wrap, kind) in enumerate(kinds):
            apart = 0.0
            for y in range(SIDE):
                for x in range(SIDE):
                    expected = sum(sampled(light, u, v, wrap, kind) for u in points[PARTS * x:PARTS * (x + 1)] for v in points[PARTS * y:PARTS * (y + 1)])
                    apart += abs(picture[y][SIDE * square + x][0] - expected / PARTS**2) / SIDE**2
            print(wrap, kind, f"{apart:.5f}")
            # A tenth of a texel makes 0.01 or more.
            self.assertLess(apart, 1e-3 if kind == "linear" else 4e-3, (wrap, kind))


if __name__ == "__main__":
    main()

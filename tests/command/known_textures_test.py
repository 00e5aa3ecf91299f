#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Squares whose textures repeat, clamp or mirror, linear and nearest, transformed: each pixel is a mean of what the specification says."""
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


def texture():
    """Returns the red of the texels, and the same as linear light."""
    numbers = random.Random(3)
    texels = [[numbers.randrange(256) for _ in range(TEXELS)] for _ in range(TEXELS)]
    linear = lambda x: x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055)**2.4
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
        picture = self.picture(str(path.with_suffix("")), "x.pfm", "--resolution", f"{count * SIDE},{SIDE}", "--spp", 256, "--stage", "flat")
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

# SPDX-License-Identifier: MIT
"""Texture look-ups and the Perlin normal map of docs/gltf.md, in doubles over arrays of points."""

import numpy as np


def wrapped(i, size, mode):
    if mode == "repeat":
        return i % size
    if mode == "clamp":
        return np.clip(i, 0, size - 1)
    folded = i % (2 * size)
    return np.where(folded < size, folded, 2 * size - 1 - folded)


def sample(texture, uv):
    """RGBA at level 0 with the magnification filter."""
    height, width = texture.texels.shape[:2]

    def texel(x, y):
        return texture.texels[wrapped(y, height, texture.wrap[1]), wrapped(x, width, texture.wrap[0])]

    x, y = uv[:, 0] * width, uv[:, 1] * height
    if texture.nearest:
        return texel(np.floor(x).astype(int), np.floor(y).astype(int))
    x, y = x - 0.5, y - 0.5
    x0, y0 = np.floor(x).astype(int), np.floor(y).astype(int)
    fx, fy = (x - x0)[:, None], (y - y0)[:, None]
    return ((texel(x0, y0) * (1 - fx) + texel(x0 + 1, y0) * fx) * (1 - fy)
            + (texel(x0, y0 + 1) * (1 - fx) + texel(x0 + 1, y0 + 1) * fx) * fy)


def lattice_gradient(i, j, octave):
    h = (i.astype(np.uint32) * np.uint32(0x8da6b343)) ^ (j.astype(np.uint32) * np.uint32(0xd8163841))
    h ^= np.uint32(octave * 0xcb1ab31f & 0xffffffff)
    h ^= h >> np.uint32(16)
    h *= np.uint32(0x7feb352d)
    h ^= h >> np.uint32(15)
    h *= np.uint32(0x846ca68b)
    h ^= h >> np.uint32(16)
    phi = 2 * np.pi * h.astype(float) / 2.0 ** 32
    return np.cos(phi), np.sin(phi)


def noise_slope(x, y, octave):
    """Returns the gradient, by x and by y, of Perlin's gradient noise (Improving Noise, 2002) in two dimensions."""
    i, j = np.floor(x).astype(np.int64), np.floor(y).astype(np.int64)
    fx, fy = x - i, y - j

    def fade(t):
        return t * t * t * (t * (t * 6 - 15) + 10)

    def fade_slope(t):
        return 30 * t * t * (t - 1) * (t - 1)

    slope_x, slope_y = np.zeros_like(x), np.zeros_like(y)
    for a in (0, 1):
        for b in (0, 1):
            gx, gy = lattice_gradient(i + a, j + b, octave)
            value = gx * (fx - a) + gy * (fy - b)
            wx, wy = (fade(fx), fade(fy))
            wx, dx = (wx, fade_slope(fx)) if a else (1 - wx, -fade_slope(fx))
            wy, dy = (wy, fade_slope(fy)) if b else (1 - wy, -fade_slope(fy))
            slope_x += wy * (dx * value + wx * gx)
            slope_y += wx * (dy * value + wy * gy)
    return slope_x, slope_y


def perlin_normal(perlin, uv):
    """Returns the tangent-space normal of a material's perlinNormal extras."""
    slope = np.zeros((2, len(uv)))
    for octave in range(perlin["octaves"]):
        scaled = uv * perlin["frequency"] * 2.0 ** octave
        slope += 2.0 ** -octave * np.array(noise_slope(scaled[:, 0], scaled[:, 1], octave))
    slope *= perlin["amplitude"]
    normal = np.stack([-slope[0], slope[1], np.ones(len(uv))], -1)
    return normal / np.linalg.norm(normal, axis=-1, keepdims=True)

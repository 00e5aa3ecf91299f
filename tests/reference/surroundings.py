# SPDX-License-Identifier: MIT
"""Environment maps: the radiance along directions, and the irradiance of nine spherical harmonics (docs/design/surfaces.md)."""

from pathlib import Path

import numpy as np

BANDS = (np.pi, 2 * np.pi / 3, np.pi / 4)  # factors by which a clamped cosine multiplies harmonics


def read_pfm(path):
    kind, size, scale, body = Path(path).read_bytes().split(b"\n", 3)
    assert kind == b"PF" and float(scale) < 0
    width, height = map(int, size.split())
    return np.frombuffer(body, "<f4").reshape(height, width, 3)[::-1].astype(float)


def environment_radiance(texels, rotation_degrees, direction):
    """Returns the environment's radiance along unit directions: bilinear between texel centres, wrapping in u, clamped
    in v."""
    angle = np.radians(rotation_degrees)
    # Turning the environment by +R about y means looking it up along the direction turned by -R.
    x = np.cos(angle) * direction[..., 0] - np.sin(angle) * direction[..., 2]
    z = np.sin(angle) * direction[..., 0] + np.cos(angle) * direction[..., 2]
    height, width = texels.shape[:2]
    u = (np.arctan2(z, x) / (2 * np.pi) + 0.5) * width - 0.5
    v = np.clip(np.arccos(np.clip(direction[..., 1], -1, 1)) / np.pi * height - 0.5, 0, height - 1)
    i, j = np.floor(u).astype(int), np.minimum(np.floor(v).astype(int), height - 2)
    fu, fv = (u - i)[..., None], (v - j)[..., None]
    rows = [texels[j + k, i % width] * (1 - fu) + texels[j + k, (i + 1) % width] * fu for k in (0, 1)]
    return rows[0] * (1 - fv) + rows[1] * fv


def harmonics(direction):
    """Returns the nine real spherical harmonics of the bands 0 to 2 along unit directions, and their bands."""
    x, y, z = np.moveaxis(direction, -1, 0)
    values = [0.28209479177 * np.ones_like(x), 0.48860251190 * y, 0.48860251190 * z, 0.48860251190 * x, 1.09254843059 * x * y,
              1.09254843059 * y * z, 0.31539156525 * (3 * z * z - 1), 1.09254843059 * x * z, 0.54627421529 * (x * x - y * y)]
    return np.stack(values, -1), [0, 1, 1, 1, 2, 2, 2, 2, 2]


class Surroundings:
    def __init__(self, path, rotation_degrees):
        self.texels, self.rotation = read_pfm(path), rotation_degrees
        # Sums over directions evenly spread in the cosine from +z and in the angle round it.
        z, around = np.meshgrid((np.arange(1500) + 0.5) / 750 - 1, (np.arange(3000) + 0.5) / 1500 * np.pi, indexing="ij")
        direction = np.stack([np.sqrt(1 - z * z) * np.cos(around), np.sqrt(1 - z * z) * np.sin(around), z], -1)
        values, bands = harmonics(direction)
        factors = np.einsum("ijh,ijc->hc", values, self.radiance(direction)) * 4 * np.pi / z.size
        self.factors = factors * np.array(BANDS)[bands][:, None]

    def radiance(self, direction):
        return environment_radiance(self.texels, self.rotation, direction)

    def irradiance(self, normal):
        return np.maximum(harmonics(normal)[0] @ self.factors, 0)

# SPDX-License-Identifier: MIT
"""Pictures as .pfm, and how far two sets of independent ones are apart beyond their noise. Standard library only."""

import math
import sys
from array import array
from pathlib import Path

BLOCK = 8  # pixels


def read_pfm(path):
    """Width and the floats of all rows, three per pixel, from whatever row the file begins with."""
    kind, size, scale, body = Path(path).read_bytes().split(b"\n", 3)
    assert kind == b"PF", path
    values = array("f")
    values.frombytes(body)
    if (float(scale) < 0) != (sys.byteorder == "little"):
        values.byteswap()
    return int(size.split()[0]), values


def blocks(path):
    """Means of 8 x 8 pixels, channel after channel; what is left over at the far edges is not counted."""
    width, values = read_pfm(path)
    height, across = len(values) // (3 * width), width // BLOCK
    result = []
    for channel in range(3):
        plane = values[channel::3]
        for top in range(0, height - BLOCK + 1, BLOCK):
            sums = [0.0] * width
            for y in range(top, top + BLOCK):
                sums = list(map(float.__add__, sums, plane[y * width:(y + 1) * width]))
            result += [math.fsum(sums[BLOCK * i:BLOCK * (i + 1)]) / BLOCK ** 2 for i in range(across)]
    return result


def mean_and_variance(pictures):
    """Returns, for each pixel and channel of independent pictures, the mean and the variance of that mean."""
    n = len(pictures)
    means = [math.fsum(values) / n for values in zip(*pictures)]
    return means, [math.fsum((v - m) ** 2 for v in values) / (n * (n - 1)) for m, values in zip(means, zip(*pictures))]


def apart(ours, theirs):
    """Two lists of block pictures: the relative difference of the channels' means (the largest, signed); the root mean square of the
    blocks' relative differences without the part that noise explains; and the noise in them. Relative to a block's value and a
    tenth of the picture's mean, so that neither lamps nor dark corners decide."""
    (a, va), (b, vb) = mean_and_variance(ours), mean_and_variance(theirs)
    third = len(a) // 3
    means = [sum(a[c * third:(c + 1) * third]) / sum(b[c * third:(c + 1) * third]) - 1 for c in range(3)]
    floor = 0.1 * math.fsum(b) / len(b)
    weights = [1 / (y + floor) ** 2 / len(b) for y in b]
    difference = math.fsum(w * (x - y) ** 2 for w, x, y in zip(weights, a, b))
    noise = math.fsum(w * (v + u) for w, v, u in zip(weights, va, vb))
    return max(means, key=abs), math.sqrt(max(0, difference - noise)), math.sqrt(noise)


def relative_mse(paths):
    """Estimates the relative MSE of one picture from the spread of independent pictures with the same expectation:
    sample variance over mean^2 + 0.01 (picture's mean)^2, as `fragtrace diff --metric relmse` weighs it."""
    pictures = [read_pfm(path)[1] for path in paths]
    n = len(pictures)
    means = [math.fsum(values) / n for values in zip(*pictures)]
    floor = 0.01 * (math.fsum(means) / len(means)) ** 2
    terms = (math.fsum((v - m) ** 2 for v in values) / (n - 1) / (m * m + floor) for m, values in zip(means, zip(*pictures)))
    return math.fsum(terms) / len(means)

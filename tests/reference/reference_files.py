# SPDX-License-Identifier: MIT
"""Writes a reference: the mean picture and the variance of that mean, a pixel and channel, as two EXR files."""

from pathlib import Path

import mitsuba as mi
import numpy as np

FOLDER = Path(__file__).resolve().parent


def rounded(values, bits):
    """Values with that many bits of mantissa: noise below the standard error does not compress."""
    mantissa, exponent = np.frexp(values)
    return np.ldexp(np.round(np.ldexp(mantissa, bits)), exponent - bits)


def write_exr(path, values):
    bitmap = mi.Bitmap(np.ascontiguousarray(values, np.float32), mi.Bitmap.PixelFormat.RGB)
    bitmap.write(str(path))


def write_reference(name, batches):
    """Writes NAME.exr and NAME.variance.exr from independent pictures of equal worth and says how good they are."""
    batches = np.asarray(batches, float)
    mean = batches.mean(0)
    variance = batches.var(0, ddof=1) / len(batches)
    write_exr(FOLDER / (name + ".exr"), rounded(mean, 18))
    write_exr(FOLDER / (name + ".variance.exr"), rounded(variance, 8))
    error = np.sqrt(variance)
    summary = {"mean": float(mean.mean()), "median_standard_error": float(np.median(error) / mean.mean()),
               "largest_standard_error": float(error.max() / mean.mean())}
    print("%-34s mean %.5f  standard error / mean: median %.4f %%, largest %.3f %%" % (
        name, summary["mean"], 100 * summary["median_standard_error"], 100 * summary["largest_standard_error"]), flush=True)
    return summary

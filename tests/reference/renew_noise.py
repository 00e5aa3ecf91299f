#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Renews the noise of rows of references.json: the square root of a picture's relmse at its fixed seed.

Usage: renew_noise.py BEFORE NOW [NAME...]   two fragtrace programs; by default all rows
A number is renewed if the pictures of both programs differ, and the 95 % interval of the ratio of their noise (NOW to BEFORE, SEEDS seeds each, bootstrap) lies
below 1.03. The ratio and the commit are written next to it. A row without a number gets one. Status 1: a row is noisier, or the seeds do not tell.
"""
import json
import math
import random
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from many_samples import FOLDER, REPOSITORY, draw

ROWS = FOLDER / "references.json"
SEEDS = 16
RESAMPLES = 2000
MORE_NOISE = 1.03  # as in picture_test.cpp


def relmse_of(program, row, seed, output):
    """Draws a row as picture_test does and returns the relmse."""
    draw(program, row, row.get("test_spp", 256 if row["stage"] == "gi" else 64), seed, output)
    reference = FOLDER / (row.get("same_as", row["name"]) + ".exr")
    told = subprocess.run([program, "diff", "--metric", "relmse", output, reference], stdout=subprocess.PIPE, text=True).stdout
    return float(re.search(r"[-+.e\d]+", told)[0])


def ratio_of(before, now):
    """The ratio of the noise of two lists of relmse, and the upper end of its 95 % interval."""
    draws = random.Random(1)
    ratio = lambda a, b: math.sqrt(sum(b) / sum(a))
    resampled = sorted(ratio(draws.choices(before, k=len(before)), draws.choices(now, k=len(now))) for _ in range(RESAMPLES))
    return ratio(before, now), resampled[round(0.975 * RESAMPLES) - 1]


def renew(row, before, now, folder):
    """Returns False if the number is not to be renewed although the picture differs."""
    pictures = [folder / f"{name}.pfm" for name in ("before", "now")]
    fixed = [relmse_of(program, row, 0, picture) for program, picture in zip((before, now), pictures)]
    same = pictures[0].read_bytes() == pictures[1].read_bytes()
    if "noise" in row and same:
        return True
    noise = {"value": float(f"{math.sqrt(fixed[1]):.6g}")}
    if not same:
        both = [[relmse_of(program, row, seed, pictures[0]) for seed in range(1, SEEDS + 1)] for program in (before, now)]
        ratio, upper = ratio_of(*both)
        print(f"{row['name']}: {ratio:.4f} times the noise, at most {upper:.4f}; {noise['value']} at the fixed seed", flush=True)
        if upper >= MORE_NOISE:
            return False
        commit = subprocess.check_output(["git", "rev-parse", "--short=8", "HEAD"], cwd=REPOSITORY, text=True).strip()
        noise |= {"ratio": round(ratio, 4), "after": commit}
    row["noise"] = noise
    return True


def main(before, now, *names):
    rows = json.loads(ROWS.read_text())
    chosen = [row for row in rows["references"] if not names or row["name"] in names]
    with tempfile.TemporaryDirectory() as folder:
        refused = [row["name"] for row in chosen if not renew(row, Path(before).resolve(), Path(now).resolve(), Path(folder))]
    lines = ",\n  ".join(json.dumps(row) for row in rows["references"])
    ROWS.write_text(f'{{\n "about": {json.dumps(rows["about"])},\n "references": [\n  {lines}\n ]\n}}\n')
    if refused:
        sys.exit(f"not renewed: {', '.join(refused)}")


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])

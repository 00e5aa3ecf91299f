#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""References that judge noise alone: means of many samples of our own program, which other tests hold to be right.

Usage: many_samples.py FRAGTRACE [NAME...]   those references of references.json; default all that this script makes.
"""

import json
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

FOLDER = Path(__file__).resolve().parent
REPOSITORY = FOLDER.parent.parent
sys.path[:0] = [str(REPOSITORY / "tests"), str(REPOSITORY / "bench/peers")]

from exr import write_exr  # noqa: E402
from pictures import read_pfm  # noqa: E402

FIRST_SEED = 1000


def draw(program, row, spp, seed, output):
    """Draws the picture of a row of references.json."""
    subprocess.run([program, "render", f"scenes/{row['scene']}.gltf", "-o", output, "--quiet", "--stage", row["stage"], "--spp", str(spp), "--seed", str(seed),
                    "--resolution", ",".join(map(str, row["resolution"])), *row["options"]], cwd=REPOSITORY, check=True)


def pictures(program, row, folder):
    """The values of the batches, rows from the top."""
    width, height = row["resolution"]
    output = folder / "batch.pfm"
    for batch in range(row["batches"]):
        draw(program, row, row["spp"], FIRST_SEED + batch, output)
        _, values = read_pfm(output)
        yield [v for y in reversed(range(height)) for v in values[3 * width * y:3 * width * (y + 1)]]


def write(row, batches):
    layers = lambda values: {name: values[i::3] for i, name in enumerate("RGB")}
    columns = list(zip(*batches))
    write_exr(FOLDER / f"{row['name']}.exr", *row["resolution"], layers([statistics.fmean(c) for c in columns]))
    write_exr(FOLDER / f"{row['name']}.variance.exr", *row["resolution"], layers([statistics.variance(c) / len(c) for c in columns]))


def main(program, *names):
    for row in json.loads((FOLDER / "references.json").read_text())["references"]:
        if row["made_by"] == "many_samples" and "same_as" not in row and (not names or row["name"] in names):
            with tempfile.TemporaryDirectory() as folder:
                write(row, list(pictures(Path(program).resolve(), row, Path(folder))))
            print(row["name"], flush=True)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(*sys.argv[1:])

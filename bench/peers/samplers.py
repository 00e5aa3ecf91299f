#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Error per sample beside Mitsuba 3's samplers, from the spread of independent seeds on both sides, so that no reference is needed.

usage: samplers.py FRAGTRACE [--assets DIR] [--only "NAME;..."] [--spp 16,64,256] [--seeds N] [--json FILE] [--chart FILE.svg]
Run it with a Python that has mitsuba 3.9.1 and numpy. Prints a table: the relative MSE of each picture (docs/output.md), of the best of Mitsuba's
samplers, and their ratio, which is to be at most 1.1. Neither side uses Russian roulette; both have a box filter.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from math import log
from pathlib import Path

import numpy as np

REPOSITORY = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(REPOSITORY / "tests/reference"), str(REPOSITORY / "bench/peers"), str(REPOSITORY / "scenes")]

import render_mitsuba  # noqa: E402, sets the variant
from gltf_scene import read_scene  # noqa: E402
from mitsuba_worker import environment  # noqa: E402

import lambert_scenes  # noqa: E402
from engines import BIASED, SAMPLERS  # noqa: E402
import sampler_chart  # noqa: E402

mi = render_mitsuba.mi
BOUNCES = 6
RATIO_AIM, MEAN_LEVEL, SLOPE_AIM = 1.1, 0.005, -1.2


def arguments():
    parser = argparse.ArgumentParser(description="error per sample beside Mitsuba's samplers")
    parser.add_argument("program", type=Path, help="build/fragtrace")
    parser.add_argument("--assets", type=Path, help="a folder with scenes/ and env/ of Khronos' and Poly Haven's files")
    parser.add_argument("--only", default="", help="pictures, of those of the table")
    parser.add_argument("--spp", default="16,64,256", help="samples per pixel: squares of powers of two")
    parser.add_argument("--seeds", type=int, default=16, help="pictures of each sampler")
    parser.add_argument("--resolution", type=int, default=48)
    parser.add_argument("--ours", default="", help="more options of ours, as one word")
    parser.add_argument("--samplers", default=",".join(SAMPLERS))
    parser.add_argument("--json", type=Path)
    parser.add_argument("--chart", type=Path)
    parser.add_argument("--known", type=Path, help="a file of --json whose figures of Mitsuba are taken as they are")
    options = parser.parse_args()
    options.program = options.program.resolve()
    options.counts = [int(n) for n in options.spp.split(",")]
    return options


def relative_mse(pictures):
    """Estimates the relative MSE of one of several independent pictures: their variance over mean^2 + 0.01 (mean of
    all)^2."""
    pictures = np.asarray(pictures, float)
    mean = pictures.mean(0)
    return float((pictures.var(0, ddof=1) / (mean ** 2 + 0.01 * mean.mean() ** 2)).mean())


def ours(options, scene, sky, spp, folder):
    command = [str(options.program), "render", str(scene), "--quiet", "--resolution", f"{options.resolution},{options.resolution}",
               "--bounces", str(BOUNCES), "--rr-depth", "1000", "--spp", str(spp), *options.ours.split()]
    if sky:
        command += ["--hdri-file", str(sky)]
    drawn = []
    for seed in range(options.seeds):
        picture = folder / "ours.pfm"
        subprocess.run([*command, "--seed", str(seed + 1), "-o", str(picture)], check=True)
        drawn.append(render_mitsuba.read_pfm(picture))
    return drawn


def mitsuba_scene(options, scene, sky, folder):
    entry = {"resolution": [options.resolution] * 2, "options": ["--bounces", str(BOUNCES)], "spp": 16}
    described = render_mitsuba.described(read_scene(scene), entry, folder)
    if sky:
        described["environment"] = environment(str(sky))
    return described


def theirs(options, described, sampler, spp):
    """Independent pictures, and how many samples per pixel they have: some samplers round the number up."""
    described["sensor"]["sampler"] = {"type": sampler, "sample_count": spp}
    built = mi.load_dict(described)
    count = int(built.sensors()[0].sampler().sample_count())
    return [np.array(mi.render(built, seed=1000 + k)) for k in range(options.seeds)], count


def measure(options, name, scene, sky, folder, known):
    """Returns, for each number of samples per pixel, the errors of both sides, and how far the means are apart."""
    described = None if known else mitsuba_scene(options, scene, sky, folder)
    result = {}
    for spp in options.counts:
        own = ours(options, scene, sky, spp, folder)
        row = {"ours": relative_mse(own), "our_mean": float(np.mean(own))}
        if known:
            row["mitsuba"], row["their_mean"] = known[name][str(spp)]["mitsuba"], known[name][str(spp)]["their_mean"]
        else:
            row["mitsuba"], means = {}, []
            for sampler in options.samplers.split(","):
                pictures, count = theirs(options, described, sampler, spp)
                row["mitsuba"][sampler] = {"samples": count, "error": relative_mse(pictures)}
                if sampler != BIASED:
                    means.append(np.mean(pictures))
            row["their_mean"] = float(np.mean(means))
        result[str(spp)] = row
        print(f"{name}, {spp}: ours {row['ours']:.3g}, " + ", ".join(f"{k} {v['error']:.3g}" for k, v in row["mitsuba"].items()) +
              f", means {row['our_mean'] / row['their_mean'] - 1:+.2%}", file=sys.stderr, flush=True)
    return result


def slope(rows, counts):
    if len(counts) < 2:
        return float("nan")
    return log(rows[str(counts[-1])]["ours"] / rows[str(counts[0])]["ours"]) / log(counts[-1] / counts[0])


def error_at(rows, sampler, counts, spp):
    """Returns a sampler's error at `spp`. If the sampler rounds its number of samples up (orthogonal: squares of
    primes), the error follows from the sampler's own power law."""
    points = [(rows[str(n)]["mitsuba"][sampler]["samples"], rows[str(n)]["mitsuba"][sampler]["error"]) for n in counts]
    place = counts.index(spp)
    (count, error), (other, second) = points[place], points[place - 1 if place else min(1, len(points) - 1)]
    if count == spp or count == other:
        return error * count / spp
    return error * (spp / count) ** (log(error / second) / log(count / other))


def errors_of(rows, counts, spp):
    return {sampler: error_at(rows, sampler, counts, spp) for sampler in rows[str(spp)]["mitsuba"]}


def print_table(figures, counts):
    print("| picture | " + " | ".join(f"{n}: ours, best of Mitsuba's, ratio" for n in counts) + " | slope | means |")
    print("| --- |" + " --- |" * (len(counts) + 2))
    short = []
    for name, rows in figures.items():
        cells = []
        for n in counts:
            errors = errors_of(rows, counts, n)
            best = min(errors, key=errors.get)
            error, other = rows[str(n)]["ours"], errors[best]
            cells.append(f"{error:.2e}, {other:.2e} ({best}), {error / other:.2f}")
            if error > RATIO_AIM * other:
                short.append(f"{name} at {n}: {error / other:.2f}")
        last = rows[str(counts[-1])]
        apart = last["our_mean"] / last["their_mean"] - 1
        steep = slope(rows, counts)
        if abs(apart) > MEAN_LEVEL:
            short.append(f"{name}: means {apart:+.2%}")
        if name.startswith("quad") and steep > SLOPE_AIM:
            short.append(f"{name}: slope {steep:.2f}")
        print(f"| {name} | " + " | ".join(cells) + f" | {steep:.2f} | {apart:+.2%} |")
    print("\nShort of the aims: " + ("; ".join(short) if short else "none."))
    return not short


def main():
    options = arguments()
    known = json.loads(options.known.read_text(encoding="utf-8"))["pictures"] if options.known else None
    os.environ.setdefault("MESA_SHADER_CACHE_DISABLE", "true")
    figures = {}
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        wanted = [name for name in options.only.split(";") if name]
        for name, (scene, sky) in lambert_scenes.pictures(folder, options.assets and options.assets.resolve()).items():
            if not wanted or name in wanted:
                figures[name] = measure(options, name, scene, sky, folder, known)
                if options.json:
                    contents = {"seeds": options.seeds, "resolution": options.resolution, "pictures": figures}
                    options.json.write_text(json.dumps(contents, indent=1) + "\n", encoding="utf-8")
    complete = print_table(figures, options.counts)
    if options.chart:
        lines = {name: {"ours": [rows[str(n)]["ours"] for n in options.counts],
                        "Mitsuba": [min(errors_of(rows, options.counts, n).values()) for n in options.counts]} for name, rows in figures.items()}
        options.chart.write_text(sampler_chart.draw(lines, options.counts), encoding="utf-8")
    sys.exit(0 if complete else 1)


if __name__ == "__main__":
    main()

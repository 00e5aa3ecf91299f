#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Measures how many times sooner one way of drawing a scene reaches an error than another, by variance x CPU seconds.

usage: variance.py SCENE [--before "OPTIONS"] [--now "OPTIONS"] [--before-program FRAGTRACE] [--program FRAGTRACE]
                   [--resolution W,H] [--spp BEFORE,NOW] [--seeds N] [--reference TIMES] [--without NODE,...] [--rough] [--part X,Y,W,H]
Each seed is drawn both ways in turn, on one processor; only the time of drawing counts, without start and compilation. The variance of a pixel is that of its
luminance between the seeds. The relative one is divided by luminance^2 + (a tenth of the picture's mean)^2 of a reference: it is drawn as now with --reference
times as many samples, since seeds that miss light must not be measured by their own mean. Both are means over the picture; with --rough, also over the pixels
in which the camera sees a roughness of at least 0.25 first; with --part, also over a rectangle of pixels from the upper left. --without leaves out nodes of the
scene's roots. The lines say how many times less variance, and variance x time; `means` is the ratio of the mean pictures, which is 1 where both ways are right.
"""
import argparse
import json
import os
import shlex
import shutil
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(REPOSITORY / "bench/peers"))

from pictures import read_pfm  # noqa: E402

LUMINANCE = (0.2126, 0.7152, 0.0722)
ROUGH = 0.25


def arguments():
    parser = argparse.ArgumentParser(description="variance x CPU seconds of two ways to draw a scene")
    parser.add_argument("scene", type=Path)
    parser.add_argument("--before", default="", help="options of render, in quotes")
    parser.add_argument("--now", default="")
    parser.add_argument("--before-program", type=Path, help="an older fragtrace (default: that of --program)")
    parser.add_argument("--program", type=Path, default=REPOSITORY / "build/fragtrace")
    parser.add_argument("--resolution", default="240,180")
    parser.add_argument("--spp", default="16,16", help="samples per pixel before and now")
    parser.add_argument("--seeds", type=int, default=4, help="2 or more (default: 4)")
    parser.add_argument("--reference", type=int, default=8, help="default: 8")
    parser.add_argument("--without", default="")
    parser.add_argument("--rough", action="store_true")
    parser.add_argument("--part")
    options = parser.parse_args()
    options.before_program = options.before_program or options.program
    if options.seeds < 2:
        parser.error("--seeds: 2 or more")
    return options


def luminance(path):
    _, values = read_pfm(path)
    return [sum(w * x for w, x in zip(LUMINANCE, values[i:i + 3])) for i in range(0, len(values), 3)]


def render(options, program, more, picture):
    """Returns the milliseconds that drawing took."""
    told = picture.with_suffix(".json")
    subprocess.run([program.resolve(), "render", options.scene.resolve(), "-o", picture, "--stats", told, "--quiet", "--resolution", options.resolution, *more],
                   check=True, env={**os.environ, "MESA_SHADER_CACHE_DISABLE": "true"}, preexec_fn=lambda: os.sched_setaffinity(0, {min(os.sched_getaffinity(0))}))
    return json.loads(told.read_text())["render_ms"]


def less(scene, without, folder):
    """A copy of a .gltf in which these roots are left out."""
    document = json.loads(scene.read_text())
    numbers = {n for n, node in enumerate(document["nodes"]) if node.get("name") in without}
    if len(numbers) != len(without):
        raise SystemExit(f"{scene}: not all of {', '.join(without)} are names of nodes")
    for one in document["scenes"]:
        one["nodes"] = [n for n in one["nodes"] if n not in numbers]
    for buffer in document.get("buffers", []):
        if "uri" in buffer and not buffer["uri"].startswith("data:"):
            shutil.copy(scene.parent / buffer["uri"], folder)
    (folder / scene.name).write_text(json.dumps(document))
    return folder / scene.name


def parts(options, folder):
    """Names of the parts of the picture, and the numbers of their pixels, in the order of a .pfm: from the lowest row
    on."""
    width, height = map(int, options.resolution.split(","))
    found = {"picture": range(width * height)}
    if options.rough:
        view = folder / "view.pfm"
        render(options, options.program, ["--debug-view", "roughness", "--spp", "1"], view)
        found["rough first"] = [i for i, rough in enumerate(luminance(view)) if rough >= ROUGH]
    if options.part:
        left, top, wide, high = map(int, options.part.split(","))
        found["part"] = [(height - 1 - y) * width + x for y in range(top, top + high) for x in range(left, left + wide)]
    return found


def variances(pictures, reference, chosen):
    """Relative and absolute, as means over the chosen pixels, and the mean of their luminance."""
    whole = statistics.fmean(reference)
    relative, absolute, mean = 0.0, 0.0, 0.0
    for i in chosen:
        seen = [p[i] for p in pictures]
        middle = statistics.fmean(seen)
        variance = statistics.variance(seen, middle)
        absolute += variance
        relative += variance / (reference[i]**2 + 0.01 * whole * whole)
        mean += middle
    return relative / len(chosen), absolute / len(chosen), mean / len(chosen)


def main():
    options = arguments()
    ways = [(options.before_program, options.before), (options.program, options.now)]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        if options.without:
            options.scene = less(options.scene, options.without.split(","), folder)
        found = parts(options, folder)
        pictures, times = ([], []), ([], [])
        for seed in range(options.seeds):
            for way, ((program, more), spp) in enumerate(zip(ways, options.spp.split(","))):
                picture = folder / "picture.pfm"
                times[way].append(render(options, program, ["--seed", str(seed), "--spp", spp, *shlex.split(more)], picture))
                pictures[way].append(luminance(picture))
        samples = options.reference * int(options.spp.split(",")[1])
        render(options, options.program, ["--seed", str(options.seeds), "--spp", str(samples), *shlex.split(options.now)], picture)
        reference = luminance(picture)
    seconds = [statistics.median(t) / 1000 for t in times]
    time = seconds[0] / seconds[1]
    print(f"{options.scene.stem}: before {seconds[0]:.2f} s, now {seconds[1]:.2f} s")
    for name, pixels in found.items():
        before, now = (variances(p, reference, pixels) for p in pictures)
        relative, absolute = before[0] / now[0], before[1] / now[1]
        print(f"{name}, {len(pixels)} pixels: relative variance {relative:.3g} times less (now {now[0]:.3g}), with time {relative * time:.3g}; "
              f"absolute {absolute:.3g} (now {now[1]:.3g}), with time {absolute * time:.3g}; means {now[2] / before[2]:.4f}")


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Measures how many times sooner one way of drawing a scene reaches an error than another, by variance x CPU seconds.

usage: variance.py SCENE [--before "OPTIONS"] [--now "OPTIONS"] [--before-program FRAGTRACE] [--before-mitsuba INTEGRATOR --python PYTHON] [--program FRAGTRACE]
                   [--resolution W,H] [--spp BEFORE,NOW] [--seeds N] [--reference TIMES] [--without NODE,...] [--rough] [--part X,Y,W,H] [--json FILE]
Each seed is drawn both ways in turn, on one processor; only the time of drawing counts, without start and compilation. The variance of a pixel is that of its
luminance between the seeds. The relative one is divided by luminance^2 + (a tenth of the picture's mean)^2 of a reference: it is drawn as now with --reference
times as many samples, since seeds that miss light must not be measured by their own mean. Both are means over the picture; with --rough, also over the pixels
in which the camera sees a roughness of at least 0.25 first; with --part, also over a rectangle of pixels from the upper left. --without leaves out nodes of the
scene's roots. The lines say how many times less variance, and variance x time, with 95 % intervals of a bootstrap over the seeds; `means` is the ratio of the
mean pictures, which is 1 where both ways are right. --json also writes the figures into a file.
"""
import argparse
import json
import os
import random
import shlex
import shutil
import statistics
import subprocess
import sys
import tempfile
from operator import mul, sub
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(REPOSITORY / "bench/peers"))

import engines  # noqa: E402
from pictures import read_pfm  # noqa: E402

LUMINANCE = (0.2126, 0.7152, 0.0722)
ROUGH = 0.25
RESAMPLES = 2000  # of the bootstrap


def arguments(words=None):
    parser = argparse.ArgumentParser(description="variance x CPU seconds of two ways to draw a scene")
    parser.add_argument("scene", type=Path)
    parser.add_argument("--before", default="", help="options of render, in quotes")
    parser.add_argument("--now", default="")
    parser.add_argument("--before-program", type=Path, help="an older fragtrace (default: that of --program)")
    parser.add_argument("--before-mitsuba", help="one of Mitsuba's integrators, such as path, instead of a program")
    parser.add_argument("--python", default=sys.executable, help="of an environment with mitsuba and numpy")
    parser.add_argument("--program", type=Path, default=REPOSITORY / "build/fragtrace")
    parser.add_argument("--resolution", default="240,180")
    parser.add_argument("--spp", default="16,16", help="samples per pixel before and now")
    parser.add_argument("--seeds", type=int, default=4, help="2 or more (default: 4)")
    parser.add_argument("--reference", type=int, default=8, help="default: 8")
    parser.add_argument("--without", default="")
    parser.add_argument("--rough", action="store_true")
    parser.add_argument("--part")
    parser.add_argument("--json", type=Path)
    options = parser.parse_args(words)
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


class Products:
    """The mean products, over the chosen pixels, of how far two seeds are from the reference: what any sample of the seeds needs for its
    variance."""

    def __init__(self, pictures, reference, chosen, is_relative):
        whole, n = statistics.fmean(reference), len(pictures)
        weights = [1 / (reference[i]**2 + 0.01 * whole * whole) if is_relative else 1.0 for i in chosen]
        level = [reference[i] for i in chosen]
        away = [list(map(sub, [picture[i] for i in chosen], level)) for picture in pictures]
        self.of = [[0.0] * n for _ in range(n)]
        for s in range(n):
            weighted = list(map(mul, weights, away[s]))
            for t in range(s, n):
                self.of[s][t] = self.of[t][s] = sum(map(mul, weighted, away[t])) / len(weights)

    def variance(self, seeds):
        """The mean variance between these seeds, which may repeat."""
        n = len(seeds)
        own = sum(self.of[s][s] for s in seeds)
        return (own - sum(sum(self.of[s][t] for t in seeds) for s in seeds) / n) / (n - 1)


def ratio(a, b):
    return a / b if b > 0 else float("inf")


def gains(products, times):
    """(`variance`, `with_time`): how many times less now than before, each with both ends of its 95 % interval."""
    n = len(times[0])
    draws = random.Random(1)

    def of(seeds):
        variance = ratio(*(p.variance(seeds) for p in products))
        return variance, variance * ratio(*(statistics.median(t[s] for s in seeds) for t in times))

    resampled = [of(draws.choices(range(n), k=n)) for _ in range(RESAMPLES)]
    result = []
    for value, column in zip(of(range(n)), zip(*resampled)):
        column = sorted(column)
        result.append([value, column[round(0.025 * RESAMPLES)], column[round(0.975 * RESAMPLES) - 1]])
    return result


class Program:
    def __init__(self, options, program, more):
        self.options, self.program, self.more = options, program, shlex.split(more)

    def draw(self, spp, seed, picture):
        return render(self.options, self.program, ["--seed", str(seed), "--spp", str(spp), *self.more], picture) / 1000

    def close(self):
        pass


class Mitsuba:
    def __init__(self, options):
        self.worker = engines.Worker("Mitsuba", [options.python, str(REPOSITORY / "bench/peers/mitsuba_light.py"), str(options.scene.resolve()), options.resolution,
                                                 options.before_mitsuba])

    def draw(self, spp, seed, picture):
        return self.worker.draw(spp, seed, picture)["cpu"]

    def close(self):
        self.worker.close()


def measure(options):
    """Returns {"seconds": [before, now], "parts": {name: {"pixels", "relative", "absolute", "now", "means"}}}; relative and absolute hold gains()."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        if options.without:
            options.scene = less(options.scene, options.without.split(","), folder)
        found, picture = parts(options, folder), folder / "picture.pfm"
        now = Program(options, options.program, options.now)
        before = Mitsuba(options) if options.before_mitsuba else Program(options, options.before_program, options.before)
        pictures, times, samples = ([], []), ([], []), [int(spp) for spp in options.spp.split(",")]
        for seed in range(options.seeds):
            for way, (engine, spp) in enumerate(zip((before, now), samples)):
                times[way].append(engine.draw(spp, seed, picture))
                pictures[way].append(luminance(picture))
        before.close()
        now.draw(options.reference * samples[1], options.seeds, picture)
        reference = luminance(picture)
    result = {"seconds": [statistics.median(t) for t in times], "parts": {}}
    for name, pixels in found.items():
        relative, absolute = ([Products(p, reference, pixels, is_relative) for p in pictures] for is_relative in (True, False))
        means = [statistics.fmean(statistics.fmean(picture[i] for i in pixels) for picture in way) for way in pictures]
        result["parts"][name] = {"pixels": len(pixels), "relative": gains(relative, times), "absolute": gains(absolute, times),
                                 "now": [p[1].variance(range(options.seeds)) for p in (relative, absolute)], "means": ratio(means[1], means[0])}
    return result


def told(gain):
    return "{:.3g} ({:.3g} to {:.3g})".format(*gain)


def main():
    options = arguments()
    result = measure(options)
    print(f"{options.scene.stem}: before {result['seconds'][0]:.2f} s, now {result['seconds'][1]:.2f} s")
    for name, part in result["parts"].items():
        print(f"{name}, {part['pixels']} pixels:")
        for kind, now in zip(("relative", "absolute"), part["now"]):
            print(f"  {kind} variance {told(part[kind][0])} times less (now {now:.3g}), with time {told(part[kind][1])}")
        print(f"  means {part['means']:.4f}")
    if options.json:
        options.json.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Beside other path tracers: the same scenes in fragtrace, Mitsuba 3 and Cycles, in turn, with pictures that are checked.

usage: compare.py FRAGTRACE [--scenes cornell-box,room-ball,asset] [--only PEERS] [--spp N] [--rounds N] [--measure both] ...
A peer that is not installed is said and left out. Times are those of drawing alone: without start-up, loading, building trees and
compiling. Status 1: a picture is not that of the others. docs/benchmarks.md says more. Run it on a quiet machine.
"""

import argparse
import json
import os
import statistics
import sys
import tempfile
import time
from math import exp, log
from pathlib import Path

import engines
import peer_scenes
import pictures

PEERS = ("mitsuba-llvm", "mitsuba-scalar", "cycles", "cycles-roulette")
MEAN_LEVEL, BLOCK_LEVEL = 0.005, 0.01  # relative; of the blocks' root mean square beyond the noise


def arguments():
    parser = argparse.ArgumentParser(description="fragtrace beside Mitsuba 3 and Cycles: speed, pictures, time to an error")
    parser.add_argument("program", type=Path, help="build/fragtrace")
    parser.add_argument("--scenes", default="cornell-box,room-ball", help="of cornell-box, room-ball, asset (default: the first two)")
    parser.add_argument("--only", default=",".join(PEERS), help="peers, of " + ", ".join(PEERS))
    parser.add_argument("--spp", type=int, default=64, help="samples of a picture, a power of two")
    parser.add_argument("--rounds", type=int, default=5, help="pictures of each engine, drawn in turn (at least 2)")
    parser.add_argument("--resolution", type=int, default=500)
    parser.add_argument("--clock", choices=("wall", "cpu"), default="wall", help="cpu: CPU seconds, for a machine that is not quiet")
    parser.add_argument("--measure", choices=("speed", "error", "both"), default="speed",
                        help="error: time to a relative MSE, each with its own defaults")
    parser.add_argument("--goal", type=float, default=1e-3, help="that relative MSE")
    parser.add_argument("--error-resolution", type=int, default=250)
    parser.add_argument("--asset", type=Path, help="a .gltf, for the scene asset")
    parser.add_argument("--environment", type=Path, help="an .hdr round it")
    parser.add_argument("--python", default=sys.executable, help="of an environment with mitsuba and numpy, or bpy")
    parser.add_argument("--blender", default="blender")
    parser.add_argument("--ours", default="", help="more options of ours, as one word")
    parser.add_argument("--json", type=Path, help="all figures, round by round")
    options = parser.parse_args()
    options.program = options.program.resolve()
    options.scenes, options.only = options.scenes.split(","), options.only.split(",")
    if not options.program.is_file():
        parser.error(f"no program {options.program}; scripts/build makes it")
    for name in set(options.only) - set(PEERS):
        parser.error(f"--only: no peer {name}")
    if options.rounds < 2 or options.spp < 1 or options.spp & (options.spp - 1):
        parser.error("--rounds: at least 2; --spp: a power of two")
    if "asset" in options.scenes and not (options.asset and options.environment):
        parser.error("the scene asset needs --asset and --environment")
    return options


def make_scene(name, folder, options):
    if name == "asset":
        return peer_scenes.asset_scene(folder, options.program, options.asset, options.environment)
    if name in ("cornell-box", "room-ball"):
        return peer_scenes.room_scene(folder, name)
    sys.exit(f"compare.py: no scene {name}")


def start(options, scene, resolution, plain):
    """Ours and the peers that are there."""
    makers = {"mitsuba-llvm": lambda: engines.mitsuba("llvm_ad_rgb", options.python, scene, resolution, plain),
              "mitsuba-scalar": lambda: engines.mitsuba("scalar_rgb", options.python, scene, resolution, plain),
              "cycles": lambda: engines.cycles(options.python, options.blender, scene, resolution, "plain" if plain else "roulette"),
              "cycles-roulette": lambda: engines.cycles(options.python, options.blender, scene, resolution, "roulette")}
    running = [engines.Fragtrace(options.program, scene, resolution, plain, options.ours.split())]
    for name in options.only:
        if name == "cycles-roulette" and not plain:
            continue
        try:
            running.append(makers[name]())
        except engines.Absent as error:
            print(f"{name} is left out: {error}", file=sys.stderr)
    return running


def machine():
    """What the figures hold for."""
    model = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo", encoding="utf-8") if line.startswith("model name")), "?")
    return f"{time.strftime('%Y-%m-%d')}, {model}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f} before"


def progress(text):
    if not text and not sys.stderr.isatty():
        return
    print(f"\r\033[K{text}" if sys.stderr.isatty() else text, end="" if sys.stderr.isatty() else "\n", file=sys.stderr, flush=True)


def median_and_range(values, form="{:.2f}"):
    return "{} ({} to {})".format(*(form.format(f(values)) for f in (statistics.median, min, max)))


def speed(name, running, folder, options):
    """Draws in turn; the table's rows, and whether all pictures agree."""
    seconds, seen = [{e: [] for e in running} for _ in range(2)]
    for k in range(options.rounds):
        for engine in running:
            picture = str(folder / "picture.pfm")
            taken = engine.draw(options.spp, k + 1, picture)[options.clock]
            seconds[engine].append(taken)
            seen[engine].append(pictures.blocks(picture))
            progress(f"{name}, round {k + 1} of {options.rounds}: {engine.name} {taken:.2f} s")
    progress("")
    paths, ours = options.resolution ** 2 * options.spp / 1e6, running[0]
    unit = "Mpaths/s" if options.clock == "wall" else "Mpaths/CPU s"
    print(f"\n{name}, {options.resolution} x {options.resolution}, {options.spp} samples, {options.rounds} rounds")
    print(f"| engine | {unit} | ours / it | mean | 8 x 8 blocks beyond noise (noise) |\n| --- | --- | --- | --- | --- |")
    agree, figures = True, {}
    for engine in running:
        rates = [paths / s for s in seconds[engine]]
        row, figures[engine.version] = [median_and_range(rates)], {"mpaths_per_s": rates}
        if engine is ours:
            row += ["", "", ""]
        else:
            mean, block, noise = pictures.apart(seen[ours], seen[engine])
            figures[engine.version].update(mean=mean, blocks=block, noise=noise)
            row += [median_and_range([b / a for a, b in zip(seconds[ours], seconds[engine])]), f"{100 * mean:+.2f} %",
                    f"{100 * block:.2f} % ({100 * noise:.2f} %)"]
            agree = agree and (name == "asset" or (abs(mean) < MEAN_LEVEL and block < BLOCK_LEVEL))
        print("| " + " | ".join([engine.version, *row]) + " |", flush=True)
    if name == "asset":
        print("The materials are not the same formulas (Mitsuba: principled): the pictures need not agree.")
    elif len(running) > 1:
        levels = f"means within {100 * MEAN_LEVEL} %, blocks within {100 * BLOCK_LEVEL} % beyond noise"
        print(f"The pictures agree: {levels}." if agree else f"THE PICTURES DO NOT AGREE: not {levels}.")
    return agree, figures


def time_to_error(engine, folder, options, seeds=4):
    """(samples, error, seconds) of each step: the samples are doubled until the error is below the goal."""
    steps, spp = [], 32
    while len(steps) < 2 or steps[-1][1] > options.goal:
        paths = [str(folder / f"seed{k}.pfm") for k in range(seeds)]
        taken = statistics.median(engine.draw(spp, 100 + k, path)[options.clock] for k, path in enumerate(paths))
        steps.append((spp, pictures.relative_mse(paths), taken))
        progress(f"{engine.name}: {spp} samples, relative MSE {steps[-1][1]:.2e}, {taken:.2f} s")
        spp *= 2
    progress("")
    return steps


def at_goal(steps, goal):
    """Samples and seconds at the goal, on the straight line through the last two steps in logarithms."""
    (n0, e0, t0), (n1, e1, t1) = steps[-2:]
    part = log(e0 / goal) / log(e0 / e1)
    return tuple(exp(log(a) + part * log(b / a)) for a, b in ((n0, n1), (t0, t1)))


def error_table(name, running, folder, options):
    size = options.error_resolution
    print(f"\n{name}, {size} x {size}: to a relative MSE of {options.goal:g}, each with its own sampler and roulette, box filter")
    print("| engine | samples | seconds | theirs / ours |\n| --- | --- | --- | --- |")
    ours, figures = None, {}
    for engine in running:
        steps = time_to_error(engine, folder, options)
        samples, seconds = at_goal(steps, options.goal)
        ours = ours or seconds
        figures[engine.version] = {"steps": steps, "samples": samples, "seconds": seconds}
        print(f"| {engine.version} | {samples:.0f} | {seconds:.2f} | {'' if engine is running[0] else f'{seconds / ours:.2f}'} |", flush=True)
    return figures


def main():
    options = arguments()
    agree, figures = True, {"machine": machine(), "clock": options.clock, "spp": options.spp}
    print(figures["machine"])
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        for name in options.scenes:
            scene = make_scene(name, folder, options)
            for kind, plain, size, table in (("speed", True, options.resolution, speed),
                                             ("error", False, options.error_resolution, error_table)):
                if options.measure not in (kind, "both"):
                    continue
                running = start(options, scene, size, plain)
                try:
                    result = table(name, running, folder, options)
                finally:
                    for engine in running:
                        engine.close()
                if kind == "speed":
                    agree, result = agree and result[0], result[1]
                figures.setdefault(name, {})[kind] = result
    if options.json:
        options.json.write_text(json.dumps(figures, indent=1) + "\n", encoding="utf-8")
    sys.exit(0 if agree else 1)


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit(130)

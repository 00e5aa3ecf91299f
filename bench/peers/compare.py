#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Next to other path tracers: the same scenes in fragtrace, Mitsuba 3 and Cycles, in turn, with pictures that are checked.

usage: compare.py FRAGTRACE [--scenes NAME,...] [--only PEERS] [--spp N] [--rounds N] [--measure both] ...
A peer that is not installed is said and left out. Times are those of drawing alone: without start-up, loading, building trees and
compiling. Status 1: a picture is not that of the others. docs/measurements/peers.md says more. Run it on a quiet machine.
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

SCENES = ("cornell-box", "room-ball", "matt-ball", "many-lights", "asset")
PEERS = ("mitsuba-llvm", "mitsuba-scalar", "cycles", "cycles-roulette")
MEAN_LEVEL, BLOCK_LEVEL = 0.005, 0.01  # relative; of the blocks' root mean square beyond the noise
# The scenes in which Cycles' adaptive sampling (on by default) reaches a relative MSE of 1e-3. Its threshold
# of 0.01 stops it at 0.0024 in the box, at 0.0031 in the room with the ball and at 0.0020 under many lights.
ADAPTIVE_REACHES = ("matt-ball",)
ERROR_SEEDS, ERROR_RESOLUTION = 4, 64  # the pictures that show how many samples an error takes


def arguments():
    parser = argparse.ArgumentParser(description="fragtrace beside Mitsuba 3 and Cycles: speed, pictures, time to an error")
    parser.add_argument("program", type=Path, help="build/fragtrace")
    parser.add_argument("--scenes", default="cornell-box,room-ball", help=f"of {', '.join(SCENES)} (default: the first two)")
    parser.add_argument("--only", default=",".join(PEERS), help=f"peers, of {', '.join(PEERS)} (default: these)")
    parser.add_argument("--spp", type=int, default=64, help="samples of a picture, a power of two")
    parser.add_argument("--rounds", type=int, default=5, help="pictures of each engine, drawn in turn (at least 2)")
    parser.add_argument("--resolution", type=int, default=500)
    parser.add_argument("--clock", choices=("wall", "cpu"), default="wall", help="cpu: CPU seconds, for a machine that is not quiet")
    parser.add_argument("--measure", choices=("speed", "error", "both"), default="speed",
                        help="error: time to a relative MSE, each with its own roulette and sampler, Mitsuba llvm with the best of its samplers")
    parser.add_argument("--goal", type=float, default=1e-3, help="that relative MSE")
    parser.add_argument("--asset", type=Path, help="a .gltf, for the scene asset")
    parser.add_argument("--environment", type=Path, help="an .hdr, round it and the matt ball")
    parser.add_argument("--python", default=sys.executable, help="of an environment with mitsuba and numpy, or bpy")
    parser.add_argument("--blender", default="blender")
    parser.add_argument("--ours", default="", help="more options of ours, as one word")
    parser.add_argument("--json", type=Path, help="all figures, round by round")
    options = parser.parse_args()
    options.program = options.program.resolve()
    options.scenes, options.only = options.scenes.split(","), options.only.split(",")
    if not options.program.is_file():
        parser.error(f"no program {options.program}; scripts/build makes it")
    for what, names, known in (("--only: no peer", options.only, PEERS), ("--scenes: no scene", options.scenes, SCENES)):
        for name in set(names) - set(known):
            parser.error(f"{what} {name}")
    if options.rounds < 2 or options.spp < 1 or options.spp & (options.spp - 1):
        parser.error("--rounds: at least 2; --spp: a power of two")
    if "asset" in options.scenes and not options.asset:
        parser.error("the scene asset needs --asset")
    if set(options.scenes) & {"asset", "matt-ball"} and not options.environment:
        parser.error("the scenes asset and matt-ball need --environment")
    return options


def make_scene(name, folder, options):
    if name == "asset":
        return peer_scenes.asset_scene(folder, options.program, options.asset, options.environment)
    return peer_scenes.matt_scene(folder, name, options.environment if name == "matt-ball" else None)


def start(options, name, scene, resolution, plain):
    """Ours and the peers that are there."""
    settings = "plain" if plain else "adaptive" if name in ADAPTIVE_REACHES else "roulette"
    makers = {"mitsuba-llvm": lambda: engines.mitsuba("llvm_ad_rgb", options.python, scene, resolution, plain),
              "mitsuba-scalar": lambda: engines.mitsuba("scalar_rgb", options.python, scene, resolution, plain),
              "cycles": lambda: engines.cycles(options.python, options.blender, scene, resolution, settings),
              "cycles-roulette": lambda: engines.cycles(options.python, options.blender, scene, resolution, "roulette")}
    running = {"fragtrace": engines.Fragtrace(options.program, scene, resolution, plain, options.ours.split())}
    for peer in options.only:
        if peer == "cycles-roulette" and not plain:
            continue  # there, `cycles` does the same
        try:
            running[peer] = makers[peer]()
        except engines.Absent as error:
            print(f"{peer} is left out: {error}", file=sys.stderr)
    return running


def close(running):
    for engine in running.values():
        engine.close()


def machine():
    """Describes the machine for which the figures hold."""
    model = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo", encoding="utf-8") if line.startswith("model name")), "?")
    return f"{time.strftime('%Y-%m-%d')}, {model}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f} before"


def progress(text):
    if not text and not sys.stderr.isatty():
        return
    print(f"\r\033[K{text}" if sys.stderr.isatty() else text, end="" if sys.stderr.isatty() else "\n", file=sys.stderr, flush=True)


def median_and_range(values, form="{:.2f}"):
    return "{} ({} to {})".format(*(form.format(f(values)) for f in (statistics.median, min, max)))


def draw_in_turn(title, running, folder, spp, options):
    """Draws one picture in each round with each engine, in turn. Returns, by engine, the seconds of each round's
    picture, scaled as if a pixel had exactly `spp` samples, and the blocks of the pictures."""
    seconds, seen = [{key: [] for key in running} for _ in range(2)]
    for k in range(options.rounds):
        for key, engine in running.items():
            picture = str(folder / "picture.pfm")
            answer = engine.draw(spp, k + 1, picture)
            seconds[key].append(answer[options.clock] * spp / answer.get("samples", spp))
            seen[key].append(pictures.blocks(picture))
            progress(f"{title}, round {k + 1} of {options.rounds}: {engine.name} {seconds[key][-1]:.2f} s")
    progress("")
    return seconds, seen


def difference(seen, peer):
    mean, block, noise = pictures.apart(seen["fragtrace"], seen[peer])
    return {"mean": mean, "blocks": block, "noise": noise, "agrees": abs(mean) < MEAN_LEVEL and block < BLOCK_LEVEL}


def speed(name, scene, folder, options):
    """Million paths per second of each engine, round by round, and how far its pictures are from ours."""
    running = start(options, name, scene, options.resolution, True)
    try:
        seconds, seen = draw_in_turn(name, running, folder, options.spp, options)
    finally:
        close(running)
    paths = options.resolution ** 2 * options.spp / 1e6
    return {key: {"engine": engine.version, "mpaths_per_s": [paths / s for s in seconds[key]],
                  **({} if key == "fragtrace" else difference(seen, key))} for key, engine in running.items()}


def samples_to_goal(engine, folder, goal):
    """Samples a pixel to a relative MSE of the goal, seconds per sample by both clocks, and (samples, error) of each step: four times as many samples from
    step to step until about one more would reach the goal, or it is reached; then the straight line through the last two in logarithms."""
    steps, spp = [], 16
    while len(steps) < 2 or steps[-1][1] > 4 * goal:
        paths = [str(folder / f"seed{k}.pfm") for k in range(ERROR_SEEDS)]
        answers = [engine.draw(spp, 100 + k, path) for k, path in enumerate(paths)]
        count = answers[0].get("samples", spp)
        steps.append((count, pictures.relative_mse(paths)))
        seconds = {clock: statistics.median(answer[clock] for answer in answers) / count for clock in ("wall", "cpu")}
        progress(f"{engine.name}: {count} samples, relative MSE {steps[-1][1]:.2e}")
        spp *= 4
    progress("")
    (n0, e0), (n1, e1) = steps[-2:]
    return exp(log(n1) + log(e1 / goal) * log(n1 / n0) / log(e0 / e1)), seconds, steps


def time_to_error(name, scene, folder, options):
    """Returns, for each engine, the number of samples that reach the goal, estimated from small pictures, and the
    seconds for as many samples in a picture of the requested size. The engines draw in turn."""
    running, figures, samplers = start(options, name, scene, ERROR_RESOLUTION, False), {}, {}
    try:
        for key, engine in running.items():
            tried = [engine.using(sampler) for sampler in engines.SAMPLERS] if key == "mitsuba-llvm" else [engine]
            found = [(samples_to_goal(e, folder, options.goal), e) for e in tried]
            (samples, _, steps), best = min(found, key=lambda f: f[0][0] * f[0][1][options.clock])
            figures[key] = {"samples": samples, "steps": steps}
            if key == "mitsuba-llvm":
                figures[key]["samplers"] = {e.more["sampler"]: each[0] for each, e in found}
                samplers[key] = best.more["sampler"]
    finally:
        close(running)
    running = start(options, name, scene, options.resolution, False)
    running.update({key: running[key].using(sampler) for key, sampler in samplers.items()})
    fewest = min(figure["samples"] for figure in figures.values())
    spp = min(options.spp, 1 << max(0, int(log(fewest, 2))))
    try:
        seconds, seen = draw_in_turn(f"{name}, time", running, folder, spp, options)
    finally:
        close(running)
    for key, engine in running.items():
        figures[key].update(engine=engine.version, seconds=[figures[key]["samples"] / spp * s for s in seconds[key]],
                            **({} if key == "fragtrace" else difference(seen, key)))
    return figures


def ratios(figures, peer, ours="fragtrace"):
    """Ours over theirs in speed, round by round."""
    if "seconds" in figures[peer]:
        return [b / a for a, b in zip(figures[ours]["seconds"], figures[peer]["seconds"])]
    return [a / b for a, b in zip(figures[ours]["mpaths_per_s"], figures[peer]["mpaths_per_s"])]


def agree(name, figures):
    return name == "asset" or all(figure.get("agrees", True) for figure in figures.values())


def print_table(name, figures, options):
    """Prints the table of speed() or time_to_error()."""
    error = "seconds" in figures["fragtrace"]
    unit = "samples | seconds" if error else "Mpaths/s" if options.clock == "wall" else "Mpaths/CPU s"
    print(f"\n{name}, {options.resolution} x {options.resolution}, {options.rounds} rounds" +
          (f", to a relative MSE of {options.goal:g}, box filter" if error else f", {options.spp} samples"))
    print(f"| engine | {unit} | ours / it | mean | 8 x 8 blocks beyond noise (noise) |\n| --- |{' --- |' * (5 if error else 4)}")
    for key, figure in figures.items():
        row = [figure["engine"]] + ([f"{figure['samples']:.0f}", median_and_range(figure["seconds"])] if error else
                                    [median_and_range(figure["mpaths_per_s"])])
        row += ["", "", ""] if key == "fragtrace" else [median_and_range(ratios(figures, key)), f"{100 * figure['mean']:+.2f} %",
                                                        f"{100 * figure['blocks']:.2f} % ({100 * figure['noise']:.2f} %)"]
        print("| " + " | ".join(row) + " |")
    if name == "asset":
        print("The materials are not the same formulas (Mitsuba: principled): the pictures need not agree.")
    elif len(figures) > 1:
        levels = f"means within {100 * MEAN_LEVEL} %, blocks within {100 * BLOCK_LEVEL} % beyond noise"
        print(f"The pictures agree: {levels}." if agree(name, figures) else f"THE PICTURES DO NOT AGREE: not {levels}.", flush=True)


def main():
    options = arguments()
    right, figures = True, {"machine": machine(), "clock": options.clock, "spp": options.spp}
    print(figures["machine"])
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        for name in options.scenes:
            scene = make_scene(name, folder, options)
            for kind, measure in (("speed", speed), ("error", time_to_error)):
                if options.measure in (kind, "both"):
                    result = measure(name, scene, folder, options)
                    print_table(name, result, options)
                    right = right and agree(name, result)
                    figures.setdefault(name, {})[kind] = result
    if options.json:
        options.json.write_text(json.dumps(figures, indent=1) + "\n", encoding="utf-8")
    sys.exit(0 if right else 1)


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit(130)

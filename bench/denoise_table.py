#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The tables and charts of docs/measurements/denoising.md: what a filter brings, in error and in time.

usage: denoise_table.py FRAGTRACE [--assets DIR] --out FOLDER [--filters variance,oidn] [--names NAME,...] [--spp N]
                        [--repetitions N] [--references] [--print]
DIR holds scenes/ and env/lightroom_14b.hdr. Seven scenes of 250 x 250 pixels, 1 to --spp samples per pixel,
--repetitions seeds, by `bench error --denoise`, against references of 4096 samples. FOLDER keeps NAME-FILTER.json and
references: what stands there is not made again. --references: makes these alone, which needs no quiet machine as the
rest does. --print: the tables of what is there. bench/charts.py draws NAME-variance.json.
bench/tables.py puts the tables of docs/measurements/data/denoise into the document.
"""

import argparse
import json
import math
import os
import statistics
import subprocess
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(REPOSITORY / folder) for folder in ("bench", "bench/peers")]

import markdown  # noqa: E402
import peer_scenes  # noqa: E402

STEPS = (1, 4, 16, 64, 256, 1024)
GOALS = (1e-2, 1e-3)
BASELINE = "cornell-box-baseline"
TITLES = {"cornell-box": "Cornell box", "matt-ball": "matt ball under lightroom_14b", "many-lights": "many lights",
          "rough-glass": "rough glass (--default-light white)", "glass-sphere": "glass sphere",
          "boom-box": "BoomBoxWithAxes under lightroom_14b", "flight-helmet": "FlightHelmet under lightroom_14b"}


def scenes(assets, folder):
    """Returns the arguments of `render` for each scene."""
    room = ["--hdri-file", assets / "env/lightroom_14b.hdr"]
    own = REPOSITORY / "scenes"
    return {"cornell-box": [own / "cornell-box.gltf"],
            "matt-ball": [folder / "matt-ball.gltf", *room],
            "many-lights": [own / "many-lights.gltf"],
            "rough-glass": [own / "rough-glass.gltf", "--default-light", "white"],
            "glass-sphere": [own / "glass-sphere.gltf"],
            "boom-box": [assets / "scenes/BoomBoxWithAxes/BoomBoxWithAxes.gltf", "--camera-orbit", "0,0", *room],
            "flight-helmet": [assets / "scenes/FlightHelmet/FlightHelmet.gltf", "--camera-orbit", "0,0", *room]}


def run(program, *arguments):
    subprocess.run([str(a) for a in (program, *arguments)], check=True, stdout=subprocess.DEVNULL,
                   env={**os.environ, "MESA_SHADER_CACHE_DISABLE": "true"})


def measure(options, name, arguments, filter_name):
    size = ["--resolution", "250,250", "--quiet"]
    reference = options.out / f"{name}.exr"
    if not reference.exists():
        run(options.fragtrace, "render", *arguments, *size, "--spp", 4096, "--seed", 99, "-o", reference)
    if filter_name is None:
        return
    result = options.out / f"{name}-{filter_name}.json"
    if result.exists():
        return
    run(options.fragtrace, "bench", "error", *arguments, *size, "--spp", options.spp, "--repetitions", options.repetitions, "--reference", reference, "--configs", "default",
        "--denoise", filter_name, "--goal", GOALS[1], "--json", result)


def measure_baseline(options):
    """The report's tracer: directions by the cosine, independent random numbers."""
    result = options.out / f"{BASELINE}.json"
    if not result.exists():
        run(options.fragtrace, "bench", "error", REPOSITORY / "scenes/cornell-box.gltf", "--resolution", "250,250", "--quiet", "--spp", 256, "--repetitions", 3,
            "--reference", options.out / "cornell-box.exr", "--configs", "baseline", "--json", result)


def reached(curve, goal, what):
    """Seconds or samples at which a curve falls below a relative MSE, between its steps as powers; beyond its end as 1 / N; its first
    step where it starts below, which is an upper bound."""
    for before, after in zip(curve, curve[1:]):
        if before["relmse"] >= goal > after["relmse"]:
            part = math.log(before["relmse"] / goal) / math.log(before["relmse"] / after["relmse"])
            return before[what] * (after[what] / before[what]) ** part
    return curve[0][what] if curve[0]["relmse"] < goal else curve[-1][what] * curve[-1]["relmse"] / goal


def at(curve, samples):
    return next((step for step in curve if step["samples"] == samples), None)


def text_of(values, form):
    low, high = min(values), max(values)
    if len(values) == 1:
        return form.format(low)
    return f"{form.format(statistics.median(values))} ({form.format(low)} to {form.format(high)})"


def tables_of(folder, filter_name):
    """Lines by what they say: relmse, flip, sooner; baseline where that was measured."""
    raw, filtered, names = {}, {}, {}
    for name, title in TITLES.items():
        path = folder / f"{name}-{filter_name}.json"
        if path.exists():
            one = json.loads(path.read_text())["configurations"][0]
            names[name], raw[name], filtered[name] = title, one["repetitions"], one["denoised"]["repetitions"]
    found = {}
    for what in ("relmse", "flip"):
        ratio = lambda name, n: text_of([at(f, n)[what] / at(r, n)[what] for r, f in zip(raw[name], filtered[name])], "{:.3f}")
        rows = [[title, *(ratio(name, n) if at(raw[name][0], n) else "-" for n in STEPS)] for name, title in names.items()]
        found[what] = markdown.table(["samples per pixel", *map(str, STEPS)], rows)
    rows = []
    for name, title in names.items():
        row = [title]
        for goal in GOALS:
            for what in ("seconds", "samples"):
                times = [reached(r, goal, what) / reached(f, goal, what) for r, f in zip(raw[name], filtered[name])]
                least = any(f[0]["relmse"] < goal for f in filtered[name])
                row.append(("at least " if least else "") + text_of(times, "{:.2g}"))
        rows.append(row)
    found["sooner"] = markdown.table(["scene", *(f"{goal:g}: {what}" for goal in GOALS for what in ("sooner", "fewer samples"))], rows)
    baseline = folder / f"{BASELINE}.json"
    if baseline.exists() and "cornell-box" in names:
        slow = json.loads(baseline.read_text())["configurations"][0]["repetitions"]
        ratios = lambda goal, what: text_of([reached(b, goal, what) / reached(f, goal, what) for b, f in zip(slow, filtered["cornell-box"])], "{:,.0f}")
        found["baseline"] = markdown.table(["goal", "sooner", "fewer samples"],
                                           [[f"{goal:g}", ratios(goal, "seconds"), ratios(goal, "samples")] for goal in GOALS])
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("fragtrace", type=Path)
    parser.add_argument("--assets", type=Path, default=Path("/work/shared/assets"))
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--filters", default="variance")
    parser.add_argument("--names", default="")
    parser.add_argument("--spp", type=int, default=1024)
    parser.add_argument("--repetitions", type=int, default=3)
    parser.add_argument("--references", action="store_true")
    parser.add_argument("--print", action="store_true")
    options = parser.parse_args()
    options.fragtrace = options.fragtrace.resolve()
    if not options.print:
        options.out.mkdir(parents=True, exist_ok=True)
        peer_scenes.matt_scene(options.out, "matt-ball")
    filters = [None] if options.references else options.filters.split(",")
    if not options.print:
        for filter_name in filters:
            for name, arguments in scenes(options.assets, options.out).items():
                if not options.names or name in options.names.split(","):
                    measure(options, name, arguments, filter_name)
        if not options.references and not options.names:
            measure_baseline(options)
    for name in filter(None, filters):
        for what, lines in tables_of(options.out, name).items():
            print(f"\n{name}: {what}\n\n" + "\n".join(lines), flush=True)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The tables and charts of docs/design/denoising.md: what a filter brings, in error and in time.

usage: denoise_table.py FRAGTRACE [--assets DIR] --out FOLDER [--filters variance,oidn] [--names NAME,...] [--spp N] [--repetitions N] [--references] [--print]
DIR holds scenes/ and env/lightroom_14b.hdr. Seven scenes of 250 x 250 pixels, 1 to --spp samples per pixel, --repetitions seeds, by `bench error --denoise`, against
references of 4096 samples. FOLDER keeps NAME-FILTER.json and references: what stands there is not made again. --references: makes these alone, which
needs no quiet machine as the rest does. --print: the tables of what is there; those of docs/design/data/denoise
are in the document: `--out docs/design/data/denoise --filters variance,oidn --document docs/design/denoising.md` writes them there, and a test
compares (--check). Writes FOLDER/denoise-NAME.svg, the charts of the variance filter.
"""

import argparse
import json
import math
import os
import re
import statistics
import subprocess
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(REPOSITORY / "bench/peers"))

import peer_scenes  # noqa: E402

STEPS = (1, 4, 16, 64, 256, 1024)
GOALS = (1e-2, 1e-3)
BASELINE = "cornell-box-baseline"


def scenes(assets, folder):
    room = ["--hdri-file", assets / "env/lightroom_14b.hdr"]
    own = REPOSITORY / "scenes"
    return {"cornell-box": ("Cornell box", [own / "cornell-box.gltf"]),
            "matt-ball": ("matt ball under lightroom_14b", [folder / "matt-ball.gltf", *room]),
            "many-lights": ("many lights", [own / "many-lights.gltf"]),
            "rough-glass": ("rough glass (default light)", [own / "rough-glass.gltf"]),
            "glass-sphere": ("glass sphere", [own / "glass-sphere.gltf"]),
            "boom-box": ("BoomBoxWithAxes under lightroom_14b", [assets / "scenes/BoomBoxWithAxes/BoomBoxWithAxes.gltf", *room]),
            "flight-helmet": ("FlightHelmet under lightroom_14b", [assets / "scenes/FlightHelmet/FlightHelmet.gltf", *room])}


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
    chart = ["--chart", options.out / f"denoise-{name}.svg"] if filter_name == "variance" else []
    run(options.fragtrace, "bench", "error", *arguments, *size, "--spp", options.spp, "--repetitions", options.repetitions, "--reference", reference, "--configs", "default",
        "--denoise", filter_name, "--goal", GOALS[1], "--json", result, *chart)


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


def table(head, rows):
    """As lines, without the columns in which no row has anything."""
    kept = [i for i in range(len(head)) if any(row[i] != "-" for row in rows)]
    lines = [head, ["---"] * len(head), *rows]
    return ["| " + " | ".join(line[i] for i in kept) + " |" for line in lines]


def tables_of(options, filter_name):
    """Lines by what they say: relmse, flip, sooner."""
    raw, filtered, names = {}, {}, {}
    for name, (title, _) in scenes(options.assets, options.out).items():
        path = options.out / f"{name}-{filter_name}.json"
        if path.exists():
            one = json.loads(path.read_text())["configurations"][0]
            names[name], raw[name], filtered[name] = title, one["repetitions"], one["denoised"]["repetitions"]
    found = {}
    for what in ("relmse", "flip"):
        found[what] = table(["samples per pixel", *map(str, STEPS)],
                            [[title, *(text_of([at(f, n)[what] / at(r, n)[what] for r, f in zip(raw[name], filtered[name])], "{:.3f}")
                                       if at(raw[name][0], n) else "-" for n in STEPS)] for name, title in names.items()])
    rows = []
    for name, title in names.items():
        row = [title]
        for goal in GOALS:
            for what in ("seconds", "samples"):
                times = [reached(r, goal, what) / reached(f, goal, what) for r, f in zip(raw[name], filtered[name])]
                least = any(f[0]["relmse"] < goal for f in filtered[name])
                row.append(("at least " if least else "") + text_of(times, "{:.2g}"))
        rows.append(row)
    found["sooner"] = table(["scene", *(f"{goal:g}: {what}" for goal in GOALS for what in ("sooner", "fewer samples"))], rows)
    baseline = options.out / f"{BASELINE}.json"
    if baseline.exists() and "cornell-box" in names:
        slow = json.loads(baseline.read_text())["configurations"][0]["repetitions"]
        ratios = lambda goal, what: text_of([reached(b, goal, what) / reached(f, goal, what) for b, f in zip(slow, filtered["cornell-box"])], "{:.3g}")
        found["baseline"] = table(["goal", "sooner", "fewer samples"],
                                  [[f"{goal:g}", ratios(goal, "seconds"), ratios(goal, "samples")] for goal in GOALS])
    return found


def written(text, tables):
    """The document with each table put behind its mark, <!-- denoise_table: FILTER WHAT -->."""
    lines, replacing = [], False
    for line in text.split("\n"):
        mark = re.fullmatch(r"<!-- denoise_table: (\w+) (\w+) -->", line)
        if mark:
            lines += [line, "", *tables[mark[1]][mark[2]]]
            replacing = True
        elif not replacing or (line and not line.startswith("|")):
            lines += [""] if replacing else []
            lines.append(line)
            replacing = False
    return "\n".join(lines)


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
    parser.add_argument("--document", type=Path, help="put the tables into this document, where its marks say so")
    parser.add_argument("--check", action="store_true", help="change nothing; status 1 where the document has other tables")
    options = parser.parse_args()
    options.fragtrace = options.fragtrace.resolve()
    if not options.print and not options.document:
        options.out.mkdir(parents=True, exist_ok=True)
        peer_scenes.matt_scene(options.out, "matt-ball")
    filters = [None] if options.references else options.filters.split(",")
    if not options.print and not options.document:
        for filter_name in filters:
            for name, (_, arguments) in scenes(options.assets, options.out).items():
                if not options.names or name in options.names.split(","):
                    measure(options, name, arguments, filter_name)
        if not options.references and not options.names:
            measure_baseline(options)
    tables = {name: tables_of(options, name) for name in filters if name}
    if options.document:
        text = options.document.read_text(encoding="utf-8")
        if options.check and written(text, tables) != text:
            sys.exit(f"{options.document}: its tables are not those of {options.out}")
        options.document.write_text(written(text, tables), encoding="utf-8")
        return
    for name, found in tables.items():
        for what, lines in found.items():
            print(f"\n{name}: {what}\n\n" + "\n".join(lines), flush=True)


if __name__ == "__main__":
    main()

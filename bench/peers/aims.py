#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The table of aims next to Mitsuba 3, Cycles and Embree: each row both sides in turn, with pictures that are checked.

usage: aims.py FRAGTRACE --assets DIR --json FILE [--parts NAME,...] [--python PYTHON] [--clock cpu] [--rounds N] [--before PROGRAM]
FILE keeps what each part found: what stands there is not measured again unless a peer was missing, so the same command continues after an interruption, and ends with the
table of all that is there. DIR holds scenes/FlightHelmet and env/lightroom_14b.hdr. PYTHON has mitsuba 3.9.1 and numpy; blender and libembree-dev are
installed. Status 1: a picture is not right, or a part could not be measured; what falls short of an aim is no failure. bench/tables.py puts the table of
docs/measurements/data/aims.json into docs/measurements/peers.md, which says more.
"""

import argparse
import hashlib
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import compare
import engines
import traversal

REPOSITORY = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(REPOSITORY / "bench"))

import markdown  # noqa: E402

GOAL = "1e-3"
NAMES = {"cornell-box": "Cornell box", "room-ball": "room with the ball", "asset": "FlightHelmet under lightroom_14b",
         "matt-ball": "matt ball under lightroom_14b", "many-lights": "many lights"}
PATHS, ERROR = "paths a second / Mitsuba llvm", f"time to relative MSE {GOAL} of"
BEST, CYCLES = "Mitsuba's best sampler / ours", "Cycles / ours"
RAYS, COLD, KEPT = "traversal alone / Embree's one ray at a time", "first picture from cold, s", "rays a second / before"


def more(least, moonshot=None):
    return {"least": least, "moonshot": moonshot}


def less(most, moonshot=None):
    return {"most": most, "moonshot": moonshot}


AIMS = {
    f"{NAMES['cornell-box']}, {PATHS}": more(1.8, 2.5),
    f"{NAMES['room-ball']}, {PATHS}": more(0.75, 1.0),
    f"{NAMES['asset']}, {PATHS}": more(0.5, 1.0),
    **{f"{NAMES[name]}, {ERROR} {peer}": aim for peer, aim in ((BEST, more(1, 2)), (CYCLES, more(2, 5)))
       for name in ("cornell-box", "room-ball", "matt-ball", "many-lights")},
    f"{RAYS}: primary": more(0.9, 1.2), f"{RAYS}: diffuse": more(0.8, 1.2), f"{RAYS}: shadow": more(0.8, 1.2),
    "bvh / front-to-back, 62,975 triangles": more(2.1), "iterative / front-to-back, 62,975 triangles": more(526),
    "front-to-back, 62,975 / 15,743 triangles": less(1.15),
    **{f"{COLD}: {NAMES[name]}": less(0.35, 0.25) for name in ("cornell-box", "room-ball")}, f"{COLD}: {NAMES['asset']}": less(0.6),
    f"bvh, {KEPT}": more(0.95), f"iterative, {KEPT}": more(0.95),
}


def arguments():
    parser = argparse.ArgumentParser(description="the table of aims beside Mitsuba 3, Cycles and Embree")
    parser.add_argument("program", type=Path, help="build/fragtrace")
    parser.add_argument("--assets", type=Path, required=True, help="a folder with scenes/ and env/ of Khronos' and Poly Haven's files")
    parser.add_argument("--json", type=Path, required=True, help="what was found; parts that stand there are kept")
    parser.add_argument("--parts", default="", help="of " + ", ".join(PARTS) + " (default: all; kept needs --before)")
    parser.add_argument("--rounds", type=int, default=7, help="pairs in turn")
    parser.add_argument("--clock", choices=("wall", "cpu"), default="wall",
                        help="cpu: CPU seconds, for a machine that is not quiet; traversal, meshes and kept are by the wall all the same")
    parser.add_argument("--python", default=sys.executable, help="of an environment with mitsuba and numpy")
    parser.add_argument("--blender", default="blender")
    parser.add_argument("--before", type=Path, help="an older program, whose iterative and bvh traversals are to be kept")
    options = parser.parse_args()
    options.parts = options.parts.split(",") if options.parts else [part for part in PARTS if part != "kept" or options.before]
    options.asset, options.environment = (options.assets / place for place in ("scenes/FlightHelmet/FlightHelmet.gltf", "env/lightroom_14b.hdr"))
    for part in set(options.parts) - set(PARTS):
        parser.error(f"--parts: no part {part}")
    if "kept" in options.parts and not options.before:
        parser.error("the part kept needs --before")
    if options.rounds < 2:
        parser.error("--rounds: at least 2")
    for path in filter(None, (options.program, options.before, options.asset, options.environment)):
        if not path.is_file():
            parser.error(f"no file {path}")
    options.program = options.program.resolve()
    options.before = options.before and options.before.resolve()
    return options


def row(name, values, right=True, note=""):
    return {"row": name, "values": values, "right": right, "note": note}


def beside(measure, name, resolution, spp, peers, rows):
    """A part that compare.py measures; rows are (name, peer, ours)."""
    def run(options):
        settings = argparse.Namespace(**vars(options), resolution=resolution, spp=spp, only=peers, ours="", goal=float(GOAL))
        with tempfile.TemporaryDirectory() as folder:
            figures = measure(name, compare.make_scene(name, Path(folder), settings), Path(folder), settings)
        found = []
        for label, peer, ours in rows:
            if peer not in figures:
                found.append(row(f"{NAMES[name]}, {label}", []))
            else:
                told = figures[peer]
                note = f"{told['mean']:+.2%}, {told['blocks']:.2%} (noise {told['noise']:.2%})"
                if "samples" in told:
                    note += f"; {figures[ours]['samples']:.0f} samples, {told['engine']} {told['samples']:.0f}"
                found.append(row(f"{NAMES[name]}, {label}", compare.ratios(figures, peer, ours), name == "asset" or told["agrees"], note))
        return found, figures
    return run


def speed_part(name, spp):
    return beside(compare.speed, name, 500, spp, ["mitsuba-llvm"], [(PATHS, "mitsuba-llvm", "fragtrace")])


def error_part(name):
    rows = [(f"{ERROR} {BEST}", "mitsuba-llvm", "fragtrace"), (f"{ERROR} {CYCLES}", "cycles", "fragtrace")]
    return beside(compare.time_to_error, name, 250, 64, ["mitsuba-llvm", "cycles"], rows)


def rays(options):
    found, figures = [], traversal.measure(options.program, REPOSITORY / "scenes/room-ball.gltf", options.rounds)
    for kind, pairs in figures.items():
        milliseconds, count, differing = traversal.figures_of(pairs)
        found.append(row(f"{RAYS}: {kind}", [b / a for a, b in milliseconds], not traversal.is_wrong(count, differing),
                         f"{differing} of {count} rays differ"))
    return found, figures


def frame_ms(program, mesh, rounds, *words):
    """Milliseconds of a flat frame of a mesh, round by round, by traversal. `bench frame` compares the pictures."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "frames.json"
        subprocess.run([program, "bench", "frame", REPOSITORY / f"scenes/{mesh}.gltf", "--stage", "flat", "--default-light", "white", "--resolution", "500,500",
                        "--traversal", "front-to-back", "--rounds", str(rounds), "--quiet", "--json", path, *words], check=True, stdout=subprocess.DEVNULL)
        lines = map(json.loads, path.read_text().splitlines())
        return {line["configuration"].replace("default", "front-to-back"): line["round_frame_ms"] for line in lines}


def meshes(options):
    small, large = (frame_ms(options.program, mesh, options.rounds, "--config", "bvh=--traversal bvh") for mesh in ("mesh-15743", "mesh-62975"))
    front, slow = large["front-to-back"], frame_ms(options.program, "mesh-62975", 1, "--config", "iterative=--traversal iterative")["iterative"]
    found = {"bvh / front-to-back, 62,975 triangles": [b / f for b, f in zip(large["bvh"], front)],
             "front-to-back, 62,975 / 15,743 triangles": [b / a for a, b in zip(small["front-to-back"], front)],
             "iterative / front-to-back, 62,975 triangles": [slow[0] / f for f in front]}
    return [row(name, values, note="the same pictures") for name, values in found.items()], {"15,743": small, "62,975": large, "iterative": slow}


def kept(options):
    """The smaller mesh is enough for the iterative traversal: both are one loop over all triangles."""
    found, figures = [], {}
    for kind, mesh in (("bvh", "mesh-62975"), ("iterative", "mesh-15743")):
        pairs = [[frame_ms(program, mesh, 1, "--config", f"{kind}=--traversal {kind}")[kind][0] for program in (options.before, options.program)]
                 for _ in range(options.rounds)]
        found.append(row(f"{kind}, {KEPT}", [before / now for before, now in pairs]))
        figures[kind] = pairs
    return found, figures


def cold(options):
    """Measures the seconds of the whole process."""
    scenes = {"cornell-box": [REPOSITORY / "scenes/cornell-box.gltf", "--resolution", "16,16"],
              "room-ball": [REPOSITORY / "scenes/room-ball.gltf", "--resolution", "16,16"],
              "asset": [options.asset, "--resolution", "64,64", "--hdri-file", options.environment]}
    seconds = {name: [] for name in scenes}
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(options.rounds):
            for name, words in scenes.items():
                command = [options.program, "render", *words, "--spp", 1, "--quiet", "-o", Path(folder) / "first.pfm"]
                seconds[name].append(engines.run_cold(command)[options.clock])
    return [row(f"{COLD}: {NAMES[name]}", values) for name, values in seconds.items()], seconds


PARTS = {
    "cold": cold, "meshes": meshes, "traversal": rays,
    "speed-box": speed_part("cornell-box", 64), "speed-ball": speed_part("room-ball", 16), "speed-helmet": speed_part("asset", 32),
    "error-matt-ball": error_part("matt-ball"), "error-box": error_part("cornell-box"), "error-ball": error_part("room-ball"),
    "error-many-lights": error_part("many-lights"), "kept": kept,
}


def table(results):
    """Returns the lines of the table."""
    rows, measured = [], {each["row"]: each for result in results["parts"].values() for each in result["rows"]}
    for name, aim in AIMS.items():
        if name not in measured and name.endswith(KEPT):
            continue
        limit = f"at most {aim['most']}" if "most" in aim else str(aim["least"])
        each, verdict, found = measured.get(name), "", "not measured"
        if each and each["values"]:
            sign = -1 if "most" in aim else 1
            median, levels = sign * statistics.median(each["values"]), (aim.get("least", aim.get("most")), aim["moonshot"])
            reached = [level is not None and median >= sign * level for level in levels]
            verdict = "PICTURES DIFFER" if not each["right"] else "moonshot" if reached[1] else "reached" if reached[0] else "short"
            found = compare.median_and_range(each["values"], "{:.0f}" if -sign * median < -100 else "{:.2f}")
        rows.append([name, found, limit, str(aim["moonshot"] or ""), verdict, each["note"] if each else ""])
    return markdown.table(["what", "median (least to largest)", "at least", "moonshot", "", "pictures: mean, blocks beyond noise"], rows)


def print_table(results):
    parts = ", ".join(f"{part} {result['when']}" for part, result in results["parts"].items())
    print(f"{results['machine']}; {results['clock']} clock; commit {results['commit']}; parts by hour, load before: {parts}\n")
    print("\n".join(table(results)))


def main():
    options = arguments()
    settings = {"clock": options.clock, "rounds": options.rounds, "program": hashlib.sha256(options.program.read_bytes()).hexdigest()}
    results = {**settings, "machine": compare.machine(), "parts": {}, "commit": subprocess.run(
        ["git", "-C", str(REPOSITORY), "describe", "--always", "--dirty"], capture_output=True, text=True, check=False).stdout.strip()}
    if options.json.exists():
        results = json.loads(options.json.read_text(encoding="utf-8"))
        differing = [key for key, value in settings.items() if results.get(key) != value]
        if differing:
            sys.exit(f"aims.py: {options.json} was written with another {', another '.join(differing)}; name another file with --json")
    failed = False
    for part in options.parts:
        if part in results["parts"] and all(each["values"] for each in results["parts"][part]["rows"]):
            continue
        when = f"{time.strftime('%H:%M')} ({os.getloadavg()[0]:.1f})"
        begin = time.perf_counter()
        print(f"{part} begins at {when}", file=sys.stderr, flush=True)
        try:
            rows, figures = PARTS[part](options)
        except (SystemExit, RuntimeError, OSError, subprocess.CalledProcessError) as error:
            print(f"aims.py: {part} could not be measured: {error}", file=sys.stderr)
            failed = True
            continue
        results["parts"][part] = {"when": when, "seconds": time.perf_counter() - begin, "rows": rows, "figures": figures}
        options.json.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    print_table(results)
    failed = failed or any(not each["values"] for result in results["parts"].values() for each in result["rows"])
    wrong = [each["row"] for result in results["parts"].values() for each in result["rows"] if not each["right"]]
    if wrong:
        print("\nPICTURES DIFFER: " + "; ".join(wrong))
    sys.exit(1 if failed or wrong else 0)


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit(130)

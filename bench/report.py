#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Measures Table I and Figure 9 of the report that fragtrace began with again, by `bench frame`.

usage: report.py [FRAGTRACE] [--parts NAME,...] [--json FILE] [--chart FILE.svg] [OPTIONS OF bench frame ...]
Each row is drawn with as many samples a draw as the renderer chooses and, where that differs, with one, as in a viewer. Prints both tables. --chart is
charts.py on the file, which --json keeps. Status 1: a picture is wrong. bench/tables.py puts the tables into docs/measurements/benchmarks.md.
"""
import argparse
import json
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(REPOSITORY / folder) for folder in ("bench", "bench/gpu")]

import markdown  # noqa: E402
from rows import BOX_SAMPLES, REPORT, REPORT_SCENES, report_calls  # noqa: E402

NOTHING = "nothing hit"
REPORT_GROWTH = {"iterative": "4.11", "bvh": "1.38", "front-to-back": "1.13"}  # 62,975 / 15,743 triangles
PRIMITIVES = ("1 primitive", "2 primitives", "3 primitives")


def lines_of(path):
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]


def settings_of(path):
    """The lines by row, each by whether a draw has a single sample."""
    rows = {}
    for line in lines_of(path):
        rows.setdefault(line["configuration"], {})["single" if line["samples_per_draw"] == 1 else "many"] = line
    return rows


def mean_text(name, line):
    if not line:
        return "-"
    samples = BOX_SAMPLES if name.startswith("Cornell") else 1
    mean, deviation = (line["frame_ms"][what] * samples for what in ("mean", "stddev"))
    digits = 2 if mean < 10 else 1 if mean < 100 else 0
    return f"{mean:,.{digits}f} " + (f"+- {deviation:,.{digits}f}" if line["rounds"] > 1 else "(n = 1)")


def report_head(settings):
    lines = [line for found in settings.values() for line in found.values()]
    wrong = sorted({line["configuration"] for line in lines if not line["picture"]["right"]})
    one, machine = lines[0], lines[0]["machine"]
    text = (f"{one['date'][:10]}, {one['program']}, {machine['processor']}, {machine['cores']} cores, "
            f"{one['gl_renderer']}, OpenGL {one['gl_version']}; {one['width']} x {one['height']}, {one['clock']}, "
            f"{max(line['rounds'] for line in lines)} rounds; ")
    text += f"WRONG PICTURES: {'; '.join(wrong)}." if wrong else "every picture was right."
    paths = [f" {name.split(',')[0]}: {found['many']['mpaths_per_s']:.1f} million paths per second."
             for name, found in settings.items() if name.startswith("Cornell")]
    return markdown.wrapped(text + "".join(paths))


def report_times(path):
    settings, rows, before = settings_of(path), [], ""
    for name, found in settings.items():
        scene, method = name.rsplit(", ", 1)
        shown, before = "" if scene == before and scene in PRIMITIVES else scene, scene
        rows.append([shown, method, mean_text(name, found.get("single")), mean_text(name, found.get("many")),
                     REPORT.get(name, REPORT.get(method)) or "-"])
    return report_head(settings) + markdown.table(["scene", "method", "one draw per sample", "samples together", "report"], rows)


def ratios(over, under, less=None):
    """Returns the ratios of two settings' times, round by round. The times of `less` are subtracted from both. The list
    is empty if no time remains."""
    fixed = less["round_frame_ms"] if less else [0] * len(over["round_frame_ms"])
    pairs = [(a - c, b - c) for a, b, c in zip(over["round_frame_ms"], under["round_frame_ms"], fixed)]
    return [a / b for a, b in pairs] if all(b > 0 for _, b in pairs) else []


def report_shapes(path):
    settings, rows = settings_of(path), []
    for method, report in REPORT_GROWTH.items():
        found = [settings.get(f"{count} triangles, {method}", {}).get("many") for count in ("62,975", "15,743")]
        values = ratios(*found) if all(found) else []
        here = f"{statistics.median_low(values):.2f}" if values else "-"
        here += f" ({min(values):.2f} to {max(values):.2f})" if len(values) > 1 else ""
        rows.append([f"{method}, 62,975 / 15,743 triangles (4.00 times as many)", here, report])
    for title, what, fixed, report in (("one draw per sample", "single", False, "1.03"),
                                       ("samples together", "many", False, "-"),
                                       (f'samples together, without "{NOTHING}"', "many", True, "-")):
        cells = []
        for scene in PRIMITIVES:
            found = [settings.get(f"{scene}, {method}", {}).get(what) for method in ("shadow rays", "flat", NOTHING)]
            values = ratios(*(found if fixed else found[:2])) if all(found) else []
            cells.append(f"{statistics.median_low(values):.3g}" if values else "-")
        rows.append([f"shadow rays / flat, {title}: 1, 2, 3 primitives", ", ".join(cells), report])
    return markdown.table(["shape, as ratio", "here", "report"], rows)


def measure(program, parts, path, words):
    """Writes the lines of all rows. Returns whether their pictures are right."""
    right, lines, size = True, [], [] if "--resolution" in words else ["--resolution", "500,500"]
    for _, scene, default, arguments in report_calls(parts):
        result = subprocess.run([program, "bench", "frame", REPOSITORY / scene, *size, *arguments, *words, "--json", path], stdout=subprocess.DEVNULL)
        if result.returncode not in (0, 1):
            sys.exit(result.returncode)
        right = right and result.returncode == 0
        subject = next(row[1] for row in REPORT_SCENES if row[2] == scene)
        for line in lines_of(path):
            method = default if line["configuration"] == "default" else line["configuration"]
            lines.append({**line, "command": "report", "configuration": f"{subject}, {method}"})
    order = {name: number for number, name in enumerate(dict.fromkeys(line["configuration"] for line in lines))}
    path.write_text("".join(json.dumps(line) + "\n" for line in sorted(lines, key=lambda line: order[line["configuration"]])), encoding="utf-8")
    return right


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", nargs="?", type=Path, default=REPOSITORY / "build/fragtrace")
    parser.add_argument("--parts", default=",".join(dict.fromkeys(row[0] for row in REPORT_SCENES)))
    parser.add_argument("--json", type=Path)
    parser.add_argument("--chart", type=Path)
    options, words = parser.parse_known_args()
    with tempfile.TemporaryDirectory() as folder:
        path = options.json or Path(folder) / "report.json"
        right = measure(options.program, options.parts.split(","), path, words)
        print("\n".join([*report_times(path), "", *report_shapes(path)]))
        charted = subprocess.run([sys.executable, REPOSITORY / "bench/charts.py", path, options.chart]).returncode if options.chart else 0
    sys.exit(charted if right else 1)


if __name__ == "__main__":
    main()

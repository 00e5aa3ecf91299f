#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws a chart of what a benchmark wrote with --json: `bench error`, `bench motion --compare`, or bench/report.py (its Figure 9).

usage: charts.py JSON CHART.svg (or .png, .pdf)
Needs matplotlib (Debian: python3-matplotlib; PyPI: matplotlib). Both axes are logarithmic; bars are the least and the largest.
"""
import json
import statistics
import sys
from pathlib import Path

try:
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
except ImportError:
    pyplot = None

sys.path.insert(0, str(Path(__file__).resolve().parent / "gpu"))
from rows import REPORT  # noqa: E402

MARKERS = "osD^vP*X"


def error_series(report):
    """Yields name and points (x, y, least, largest) of each curve, the filtered ones too."""
    for one in report["configurations"]:
        for name, curve in ((one["name"], one), (f"{one['name']} denoised", one.get("denoised"))):
            if curve:
                slope = "-" if curve["slope"] is None else f"{curve['slope']:.2f}"
                points = []
                for steps in zip(*curve["repetitions"]):
                    errors = [step["relmse"] for step in steps]
                    points.append((statistics.fmean(step["seconds"] for step in steps), statistics.fmean(errors), min(errors), max(errors)))
                yield f"{name} (slope {slope})", points


def error_chart(axes, report):
    axes.set(title=f"Error against time: {report['scene']}", xlabel="seconds of drawing, and of filtering where denoised", ylabel="relative MSE")
    axes.axhline(report["goal_relmse"], color="0.3", linestyle="--", label=f"goal {report['goal_relmse']:g}")
    return error_series(report), (f"{report['width']} x {report['height']} on {report['gl_renderer']}. Points are 1, 2, 4, ... samples per pixel, or "
                                  f"adaptive goals. Reference: {report['reference']}.")


def motion_chart(axes, report):
    axes.set(title=f"Error in motion: {report['scene']}", xlabel="milliseconds per picture", ylabel="mean FLIP")
    series = [(row["mode"], [(1000 * row["seconds"] / row["pictures"], row["flip"], None, None)]) for row in report["rows"]]
    return series, f"{report['width']} x {report['height']}, path {report['path']}."


def report_chart(axes, lines):
    """One sample a draw where that was measured."""
    axes.set(title="Frame time against faces", xlabel="triangles", ylabel="milliseconds per frame")
    here, report = {}, {}
    for line in sorted(lines, key=lambda line: line["samples_per_draw"] == 1):
        subject, _, method = line["configuration"].rpartition(", ")
        if subject.endswith("triangles"):
            mean, deviation = line["frame_ms"]["mean"], line["frame_ms"]["stddev"]
            faces = int(subject.split()[0].replace(",", ""))
            here.setdefault(method, {})[faces] = (faces, mean, mean - deviation, mean + deviation)
            report.setdefault(f"{method}, report", {})[faces] = (faces, float(REPORT[line["configuration"]]), None, None)
    series = [(name, sorted(points.values())) for both in zip(here.items(), report.items()) for name, points in both]
    one = lines[0]
    return series, (f"Flat stage, {one['width']} x {one['height']}, {one['gl_renderer']}, {one['machine']['processor']}, by {one['clock']}; bars are the "
                    f"standard deviation. The report's figures come from another GPU.")


def chart_of(text):
    """The function that draws a file of this text, and what it draws."""
    try:
        lines = [json.loads(text)]
    except json.JSONDecodeError:
        lines = [json.loads(line) for line in text.splitlines()]
    if "configurations" in lines[0]:
        return error_chart, lines[0]
    if lines[0].get("bench") == "motion" and "flip" in lines[0]["rows"][0]:
        return motion_chart, lines[0]
    if lines[0].get("command") == "report":
        return report_chart, lines
    raise ValueError("is of no benchmark that has a chart")


def draw(source, target):
    """Throws ValueError, KeyError where `source` is no such file. Ends the program where matplotlib is missing."""
    if pyplot is None:
        sys.exit("charts.py: matplotlib is not installed (Debian: python3-matplotlib; PyPI: matplotlib)")
    make, measured = chart_of(Path(source).read_text(encoding="utf-8"))
    matplotlib.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "fragtrace"})
    figure, axes = pyplot.subplots(figsize=(9, 5.4), layout="constrained")
    series, caption = make(axes, measured)
    for number, (name, points) in enumerate(series):
        x, y, low, high = zip(*points)
        bars = [[max(b - a, 0) for a, b in zip(low, y)], [max(b - a, 0) for a, b in zip(y, high)]] if None not in low else None
        axes.errorbar(x, y, bars, label=name, marker=MARKERS[number % len(MARKERS)], markersize=4, linewidth=1.4, capsize=2)
    axes.set(xscale="log", yscale="log")
    axes.grid(linewidth=0.3)
    figure.legend(loc="outside right upper", fontsize="small")
    figure.supxlabel(caption, fontsize="x-small", wrap=True)
    figure.savefig(target, metadata={"Date": None} if str(target).endswith(".svg") else None)
    pyplot.close(figure)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    try:
        draw(*sys.argv[1:])
    except (OSError, ValueError, KeyError) as error:
        sys.exit(f"charts.py: {sys.argv[1]}: {error}")


if __name__ == "__main__":
    main()

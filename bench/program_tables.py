# SPDX-License-Identifier: MIT
"""The tables of what `fragtrace bench report` and `bench scale` write, a JSON object per line, for bench/tables.py."""

import json
import statistics

import markdown
from rows import BOX_SAMPLES, REPORT

NOTHING = "nothing hit"
REPORT_GROWTH = {"iterative": "4.11", "bvh": "1.38", "front-to-back": "1.13"}  # 62,975 / 15,743 triangles
PRIMITIVES = ("1 primitive", "2 primitives", "3 primitives")


def lines_of(path):
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]


def brief(ms):
    """Formats a number with two or three figures."""
    return f"{ms:,.{2 if ms < 1 else 1 if ms < 100 else 0}f}"


def settings_of(path):
    """The lines of `bench report` by row, each by whether a draw has a single sample."""
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


def scale_head(sizes, drawn):
    most = {key: max(frames[f"{key}_pixels"] for frames in drawn) for key in ("wrong", "differing")}
    return markdown.wrapped(
        f"{sizes[0]['gl_renderer']}; {sizes[0]['width']} x {sizes[0]['height']}, medians of "
        f"{max(len(frames['frame_ms']) for frames in drawn)} rounds. In each picture at least "
        f"{min(frames['compared_pixels'] for frames in drawn):,} pixels were compared with the double-precision "
        f"tracer's, of which at most {most['wrong']:,} differ; at most {most['differing']:,} are not those of the "
        f"first traversal.")


def scale_times(path):
    sizes = [line for line in lines_of(path) if "triangles" in line]
    drawn = [frames for size in sizes for frames in size["traversals"] if "median_ms" in frames]
    names, rows = list(dict.fromkeys(frames["traversal"] for frames in drawn)), []
    for size in sizes:
        ms = {frames["traversal"]: brief(frames["median_ms"]) for frames in size["traversals"] if "median_ms" in frames}
        steps = [brief(size[f"{step}_ms"]) for step in ("make", "build", "pack", "upload")]
        rows.append([f"{size['triangles']:,}", *steps, f"{size['sah_cost']:.1f}", str(size["depth"]),
                     f"{size['gpu_bytes_per_triangle']:.1f}",
                     f"{size['peak_bytes'] / 1e6:,.0f}" if size["peak_bytes"] else "-",
                     *(ms.get(name, "-") for name in names)])
    head = ["triangles", "make ms", "build ms", "pack ms", "upload ms", "SAH cost", "depth", "GPU bytes per triangle",
            "peak MB", *(f"{name} ms" for name in names)]
    return scale_head(sizes, drawn) + markdown.table(head, rows)


def scale_exponents(path):
    exponents = next(line["exponents"] for line in lines_of(path) if "exponents" in line)
    rows = [[title, *("-" if one[key] is None else f"{one[key]:.2f}" for one in exponents.values())]
            for title, key in (("the larger half of the sizes", "larger_half"), ("all sizes", "all"))]
    return markdown.table(["p over", *exponents], rows)

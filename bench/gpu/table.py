# SPDX-License-Identifier: MIT
"""The table of bench/gpu/run, and what its cells say of the lines that the program's benchmarks write."""
import os
import statistics
from pathlib import Path

from rows import BOX_SAMPLES, PACE_AIM, RAY_AIMS, REPORT, REPORT_AIMS

COLUMNS = ("part", "what", "measured", "beside it", "picture, notes")


class Table:
    """Is printed line by line, and stands whole in the file after each row."""

    def __init__(self, path, head):
        self.path = path
        self.text = head + "\n\n"
        print(head, end="\n\n", flush=True)
        self.line(COLUMNS)
        self.line(["---"] * len(COLUMNS))

    def line(self, cells):
        line = "| " + " | ".join(str(cell).replace("|", "/").replace("\n", " ") for cell in cells) + " |"
        self.text += line + "\n"
        print(line, flush=True)
        self.save()

    def save(self):
        part = Path(str(self.path) + ".part")
        part.write_text(self.text)
        os.replace(part, self.path)

    def close(self, note):
        self.text += f"\n{note}\n"
        print(f"\n{note}", flush=True)
        self.save()


def milliseconds(ms):
    return f"{ms:.0f}" if ms >= 100 else f"{ms:.1f}" if ms >= 10 else f"{ms:.3f}"


def verdict(picture):
    return "right" if picture["right"] else "WRONG PICTURE: " + picture.get("wrong", "see figures.jsonl")


def aim_text(aim):
    return f"aim {aim}" if aim else ""


def frame_cells(frame, line, compiled_before):
    """Returns the cells of a row of rows.FRAMES. If the driver compiled the program before, `compiled_before` is its
    time in milliseconds."""
    ms = line["frame_ms"]["median"] * frame.samples
    each = f"ms a picture of {frame.samples} samples" if frame.samples > 1 else "ms per frame"
    notes = [verdict(line["picture"]), f"compiled in {max(line['compile_ms'], compiled_before) / 1000:.1f} s"]
    lacking = frame.wants - set(line["variant"].split("+"))
    if lacking:
        notes.append(f"NOT drawn as asked: without {', '.join(sorted(lacking))}")
    measured = f"{milliseconds(ms)} {each}; {line['mpaths_per_s']:.2f} Mpaths/s, {line['mrays_per_s']:.1f} Mrays/s"
    return frame.title, measured, aim_text(frame.aim), ", ".join(notes)


def report_rows(subject, default, lines):
    """The cells of each setting of a scene of the report's table."""
    for line in lines:
        method = default if line["configuration"] == "default" else line["configuration"]
        name = f"{subject}, {method}"
        samples = BOX_SAMPLES if subject == "Cornell box" else 1
        beside = [f"report {REPORT.get(name, REPORT.get(method))} ms"] if REPORT.get(name, REPORT.get(method)) else []
        if name in REPORT_AIMS:
            beside.append(aim_text(REPORT_AIMS[name]))
        yield (name + (", one draw per sample" if line["samples_per_draw"] == 1 else ""), f"{milliseconds(line['frame_ms']['mean'] * samples)} ms", ", ".join(beside),
               verdict(line["picture"]))


def stress_cells(seed, lines):
    """Returns the cells for the rows of `bench stress` with this seed."""
    over = [f"{line['row']} ({line['failures']} of {line['cases']})" for line in lines if line["over"]]
    wrong = [f"{line['row']} ({line['failures']}, limit {line['limit']:g})" for line in lines if line["failures"] and not line["over"]]
    fast = sum(line.get("fast_failures", 0) for line in lines)
    measured = f"{len(lines)} rows of {sum(line['cases'] for line in lines):,} cases; with the fast test {fast:,} wrong"
    return (f"cases that break ray tracers, seed {seed}", measured, "",
            "WRONG: " + "; ".join(over) if over else "within the limits" + (": " + "; ".join(wrong) if wrong else ""))


def motion_rows(name, lines):
    """Yields a row for each mode of `bench motion`."""
    for line in lines:
        for row in line["rows"]:
            pictures = max(row["pictures"], 1)
            late = statistics.median(row["latency_ms"]) if row["latency_ms"] else 0
            measured = (f"{row['pictures'] / row['seconds']:.1f} pictures/s of {row['pixels'] / pictures / 1e6:.2f} Mpixels, {late:.1f} ms late; "
                        f"host {row['trace_cpu_ms'] / pictures:.2f} ms, {row['moved_bytes'] / pictures / 1000:.1f} kB a picture")
            beside = "aim 3 ms, 4 kB" if row["mode"] == "filtered" else "aim 1.5 ms, 4 kB" if row["mode"] == "raw" else ""
            yield f"{name}, {row['mode']}", measured, beside, f"FLIP {row['flip']:.4f}, relative MSE {row['relmse']:.4g}"


def start_rows(name, lines):
    """The milliseconds of each start of `bench start`."""
    for line in lines:
        phases = {phase["phase"]: [end - begin for begin, end in zip(phase["begin_ms"], phase["end_ms"])] for phase in line["phases"]}
        cells = [f"{title} {', '.join(f'{ms:.0f}' for ms in values)} ms"
                 for title, values in (("written after", line["written_ms"]), *((key, phases[key]) for key in ("context", "program", "first draw") if key in phases))]
        yield name, "; ".join(cells), "", "each start"


def pace_rows(name, lines):
    """Yields the times from one picture of `bench motion` to the next."""
    for line in lines:
        for row in line["rows"]:
            gaps = sorted(row["gap_ms"])
            measured = (f"{row['pictures'] / row['seconds']:.1f} pictures/s of {row['pixels'] / max(row['pictures'], 1) / 1e6:.2f} Mpixels; one after "
                        f"{statistics.median(gaps):.1f} ms, 95 % within {gaps[int(0.95 * (len(gaps) - 1))]:.1f}, all within {gaps[-1]:.1f}")
            yield name, measured, aim_text(PACE_AIM), ""


def ray_rows(lines):
    for line in lines:
        wrong = f"{line['wrong']} of {line['rays']} rays wrong ({line['wrong_allowed']} may be)"
        if "plain_median_ms" in line:
            wrong += f"; the plain tracer takes {line['plain_median_ms'] / line['median_ms']:.2f} times as long"
        yield f"{line['kind']} rays", f"{line['mrays_per_s']:.1f} Mrays/s", aim_text(RAY_AIMS.get(line["kind"])), wrong

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the tables of measurements into the documents, from what the benchmarks wrote into docs/measurements/data.

usage: tables.py [--check] [--data FOLDER] [DOCUMENT...]
Without DOCUMENT: all of docs/measurements, and docs/design/accuracy.md. A document has a table between <!-- table: NAME --> and <!-- end of table -->.
--check: changes nothing, and ends with status 1 where a document has other tables than its data. With and without it,
the status is also 1 where a mark has no data or no end, and where data have no mark. The data are benchmarks' files,
whole:

  report.json      bench/report.py FRAGTRACE --rounds 3 --round-time 0.3 --json FILE
  aims.json        bench/peers/aims.py FRAGTRACE --assets DIR --json FILE
  aims-again-N.json  the same, parts that were measured again later and replace those of aims.json
  gpu-compilers.json  bench/gpu/compilers --json FILE
  light.json       bench/light_table.py FRAGTRACE --json FILE
  denoise/         bench/denoise_table.py FRAGTRACE --out FOLDER --filters variance,oidn
"""

import argparse
import json
import sys
from functools import partial
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(REPOSITORY / folder) for folder in ("bench", "bench/peers", "bench/gpu")]

import aims  # noqa: E402
import compiler_figures  # noqa: E402
import denoise_table  # noqa: E402
import light_table  # noqa: E402
import markdown  # noqa: E402
import report  # noqa: E402

DOCUMENTS, DATA = REPOSITORY / "docs/measurements", REPOSITORY / "docs/measurements/data"


def facts(results):
    return f"{results['machine']}; {results['clock']} clock, {results['rounds']} rounds, commit {results['commit']}"


def aims_table(path):
    """With the parts of aims-again-*.json, in their order, instead of those of `path`."""
    results = json.loads(path.read_text(encoding="utf-8"))
    text = facts(results)
    for again in sorted(path.parent.glob("aims-again-*.json")):
        later = json.loads(again.read_text(encoding="utf-8"))
        results["parts"].update(later["parts"])
        text += ". Measured again: " + ", ".join(f"`{part}`" for part in later["parts"]) + f" ({facts(later)})"
    minutes = sum(part["seconds"] for part in results["parts"].values()) / 60
    return markdown.wrapped(f"{text}. All parts together take {minutes:.0f} minutes.") + aims.table(results)


def gpu_compilers(path):
    result = json.loads(path.read_text(encoding="utf-8"))
    return [f"Mesa {result['mesa']}, {result['date']}.", "", *compiler_figures.table(result)]


def light(path):
    return light_table.table(json.loads(path.read_text(encoding="utf-8")))


def denoise(filter_name, what, folder):
    return denoise_table.tables_of(folder, filter_name)[what]


# The tables: each has the place of its data and the function that makes lines of text of them.
TABLES = {"report": ("report.json", report.report_times),
          "report shapes": ("report.json", report.report_shapes),
          "aims": ("aims.json", aims_table),
          "light": ("light.json", light),
         "gpu compilers": ("gpu-compilers.json", gpu_compilers)}
for one, whats in (("variance", ("relmse", "sooner", "baseline")), ("oidn", ("relmse", "sooner"))):
    TABLES.update({f"denoise {one} {what}": ("denoise", partial(denoise, one, what)) for what in whats})


def tables_of(data, names):
    """Lines by name, without those that have no data."""
    known = [name for name in names if name in TABLES and (data / TABLES[name][0]).exists()]
    return {name: TABLES[name][1](data / TABLES[name][0]) for name in known}


def faults_of(document, data, is_check):
    """Yields the faults of a document's marks and, with is_check, of its tables. Without is_check the tables are
    written."""
    text = document.read_text(encoding="utf-8")
    try:
        names = markdown.marks(text)
    except ValueError as error:
        return [f"{document}: {error}"]
    tables = tables_of(data, names)
    faults = [f"{document}: {name}: " + (f"no data {data / TABLES[name][0]}" if name in TABLES else "no such table")
              for name in names if name not in tables]
    new = markdown.written(text, tables)
    if new == text:
        return faults
    if is_check:
        return [*faults, f"{document}: its tables are not those of {data}; bench/tables.py writes them"]
    document.write_text(new, encoding="utf-8")
    return faults


def unshown(documents, data):
    """Faults: data of which no document has the table. Tables without data are named on stderr."""
    shown = {name for document in documents for name in markdown.names(document.read_text(encoding="utf-8"))}
    for name, (place, _) in TABLES.items():
        if name not in shown and (data / place).exists():
            yield f"{data / place}: no document has {markdown.BEGIN.format(name)}"
        elif name not in shown:
            print(f"tables.py: {name} is not generated: no data {data / place}", file=sys.stderr)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("documents", nargs="*", type=Path)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--data", type=Path, default=DATA)
    options = parser.parse_args()
    documents = options.documents or [*sorted(DOCUMENTS.glob("*.md")), REPOSITORY / "docs/design/accuracy.md"]
    faults = [fault for document in documents for fault in faults_of(document, options.data, options.check)]
    faults += [] if options.documents else unshown(documents, options.data)
    for fault in faults:
        print(f"tables.py: {fault}", file=sys.stderr)
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()

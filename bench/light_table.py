#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The table of light that is left to chance: how many times sooner light paths, guiding and the tree of lamps reach an error.

usage: light_table.py FRAGTRACE --json FILE [--rows NAME,...] [--seeds N] [--python PYTHON]
bench/light_rows.json holds scene, camera, mask and resolution of each row, as words of bench/variance.py. FILE keeps what each row found: what stands there is
not measured again, so the same command goes on after an interruption, and ends with the table of all that is there. PYTHON has mitsuba 3.9.1 and numpy. Run it on
a quiet machine. bench/tables.py puts the table of docs/measurements/data/light.json into docs/measurements/accuracy.md.
"""
import argparse
import json
import subprocess
import sys
import time
from pathlib import Path

import markdown
import variance

REPOSITORY = Path(__file__).resolve().parents[1]
ROWS = json.loads((REPOSITORY / "bench/light_rows.json").read_text(encoding="utf-8"))


def table(results):
    """Lines of a table, of the rows that `results` has."""
    lines = []
    for row in ROWS:
        found = results["rows"].get(row["name"])
        for what, part, least, moonshot in row["aims"] if found else ():
            seen = found["parts"][part]
            value, low, high = seen["relative"][1]
            reached = "moonshot" if moonshot and low >= moonshot else "yes" if low >= least else "no"
            lines.append([what, row["beside"], f"{value:.3g}", f"{low:.3g} to {high:.3g}", f"{least}" + (f" ({moonshot})" if moonshot else ""), reached,
                          f"{seen['means']:.4f}"])
    return markdown.table(["picture", "beside", "times sooner", "95 %", "aim (moonshot)", "reached", "means"], lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    parser.add_argument("--json", type=Path, required=True)
    parser.add_argument("--rows", default=",".join(row["name"] for row in ROWS))
    parser.add_argument("--seeds", type=int, default=16)
    parser.add_argument("--python", default=sys.executable)
    options = parser.parse_args()
    wanted = options.rows.split(",")
    for name in set(wanted) - {row["name"] for row in ROWS}:
        parser.error(f"--rows: no row {name}")
    results = json.loads(options.json.read_text(encoding="utf-8")) if options.json.exists() else {"rows": {}}
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=REPOSITORY, capture_output=True, text=True, check=True).stdout.strip()
    for row in ROWS:
        if row["name"] not in wanted or row["name"] in results["rows"]:
            continue
        words = [*row["words"], "--seeds", str(options.seeds), "--program", str(options.program), "--python", options.python]
        chosen = variance.arguments(words)
        chosen.scene = REPOSITORY / chosen.scene
        results["rows"][row["name"]] = {**variance.measure(chosen), "date": time.strftime("%Y-%m-%d"), "commit": commit, "seeds": options.seeds}
        options.json.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
        print(f"{row['name']}: done", flush=True)
    print("\n".join(table(results)))


if __name__ == "__main__":
    sys.exit(main())

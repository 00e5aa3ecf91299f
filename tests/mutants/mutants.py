#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""tests/mutants/mutants.py BUILD [--only WORD ...] [--some COUNT --seed N] [--jobs N] [--first N] [--check] [--remember]: puts each fault of rows*.py into the shaders and
looks for a test that fails. Goes on where it was interrupted (BUILD/mutants/state.json). Status 1 when a fault survives that has no reason to.

--first: tries only the first N tests of each, to learn which see what. --check: only that every key is found once and every function has a fault. --remember: writes which test saw what to seen_by.json, to be tried first."""
import argparse
import json
import random
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Lock
from types import SimpleNamespace

from memory import Memory, tree_of
from rows import ROWS, check
from suite import Compiler, drawing_tests, unknown_tests
from trial import Trial

HERE = Path(__file__).resolve().parent
HINTS = HERE / "seen_by.json"


def sound(setting, memory, test):
    """Returns true if a test that failed passes without the fault."""
    with setting.lock_of_sound:
        if memory.is_sound(test) is None:
            with Trial(setting, None) as trial:
                passes, seconds = trial.passes(test)
                memory.note(test, seconds, passes)
        return memory.is_sound(test)


def settle(setting, memory, fault):
    began = time.monotonic()
    with Trial(setting, fault) as trial:
        tests = memory.in_order(fault, trial.tests())
        for test in tests[:setting.first]:
            passed, seconds = trial.passes(test)
            if passed:
                memory.note(test, seconds)
                print(f"{fault.name}: not seen by {test}, {seconds:.0f} s", flush=True)
            elif sound(setting, memory, test):
                memory.settle(fault, test, time.monotonic() - began)
                print(f"{fault.name}: seen by {test}, {time.monotonic() - began:.0f} s", flush=True)
                return
            else:
                print(f"{test} fails without a fault: it is left out", flush=True)
    if setting.first:
        print(f"{fault.name}: not seen by {', '.join(tests[:setting.first])}", flush=True)
        return
    memory.settle(fault, "", time.monotonic() - began)
    print(f"{fault.name}: SURVIVES ({fault.what}), {time.monotonic() - began:.0f} s", flush=True)


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("build", type=Path)
    options.add_argument("--only", nargs="+", default=[])
    options.add_argument("--some", type=int)
    options.add_argument("--seed", type=int, default=1)
    options.add_argument("--jobs", type=int, default=2)
    options.add_argument("--first", type=int)
    options.add_argument("--check", action="store_true")
    options.add_argument("--remember", action="store_true")
    chosen = options.parse_args()
    source, build = HERE.parent.parent, chosen.build.resolve()

    if wrong := check(source / "shaders") + unknown_tests(source, ROWS):
        print("\n".join(wrong))
        return 1
    if chosen.check:
        return 0
    rows = [row for row in ROWS if not chosen.only or any(word in row.name for word in chosen.only)]
    if chosen.some:
        rows = random.Random(chosen.seed).sample([row for row in rows if not row.reason], chosen.some)

    folder = build / "mutants"
    folder.mkdir(exist_ok=True)
    setting = SimpleNamespace(source=source, build=build, folder=folder, program=build / "fragtrace", drawing=drawing_tests(build),
                              compiler=Compiler(source, build), lock_of_sound=Lock(), first=chosen.first)
    memory = Memory(folder / "state.json", HINTS, tree_of(source))
    began = time.monotonic()
    left = [row for row in rows if not memory.verdict(row) and not (chosen.first and (row.reason or row.name in memory.hints))]
    left.sort(key=lambda row: (bool(row.reason), row.name in memory.hints))  # what takes long first, but what is expected to survive last: it is put to every test
    with ThreadPoolExecutor(chosen.jobs) as pool:
        list(pool.map(lambda row: settle(setting, memory, row), left))
    if chosen.first:
        return 0

    verdicts = {row: memory.verdict(row) for row in rows}
    survivors = [row for row, verdict in verdicts.items() if not verdict["seen_by"]]
    for row in survivors:
        print(f"SURVIVES: {row.name}: {row.what}" + (f"; changes no picture because {row.reason}" if row.reason else ""))
    for row in rows:
        if row.reason and row not in survivors:
            print(f"{row.name} has a reason to survive, but is seen by {verdicts[row]['seen_by']}")
    if chosen.remember:
        HINTS.write_text(json.dumps({row.name: memory.hints[row.name] for row in ROWS if row.name in memory.hints}, indent=0, sort_keys=True) + "\n")
    spent = sum(verdict["seconds"] for verdict in verdicts.values())
    print(f"{len(rows)} faults, {len(rows) - len(survivors)} seen; {time.monotonic() - began:.0f} s now, {spent:.0f} s in all by one job")
    return int(any(not row.reason for row in survivors))


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""tests/mutants/mutants.py BUILD [--only WORD ...] [--some COUNT [--seed SEED]] [--seconds S] [--jobs N] [--list] [--remember]: puts each fault of made.py into the
shaders and looks for a test that fails, S seconds at most for each (60). Goes on where it was interrupted (BUILD/mutants/state.json). Status 1 when a fault
survives that has no reason to (reasons.json).

--some: so many faults, chosen by SEED, by default the hash of the commit. --list: only their names, and those reasons that name no fault. --remember: writes which
test saw faults of a function to seen_by.json, to be tried first."""
import argparse
import json
import random
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Lock
from types import SimpleNamespace

from made import all_faults, function_texts
from memory import Memory, function_of
from suite import Compiler, drawing_tests
from trial import Trial

HERE = Path(__file__).resolve().parent
SOURCE = HERE.parent.parent
HINTS, REASONS = HERE / "seen_by.json", HERE / "reasons.json"


def sound(setting, memory, test):
    """Returns true if a test that failed passes without the fault."""
    with setting.lock_of_sound:
        if memory.is_sound(test) is None:
            with setting.trial(setting, None) as trial:
                passes, seconds = trial.passes(test)
                memory.note(test, seconds, passes)
        return memory.is_sound(test)


def settle(setting, memory, fault):
    began = time.monotonic()
    spent = lambda: time.monotonic() - began
    with setting.trial(setting, fault) as trial:
        if trial.refused:
            memory.settle(fault, "the driver, which refuses the text", spent())
            return
        for test in memory.in_order(fault, trial.tests()):
            if spent() + memory.seconds_of(test) > setting.seconds:
                continue
            passed, seconds = trial.passes(test)
            if passed:
                memory.note(test, seconds)
            elif sound(setting, memory, test):
                memory.settle(fault, test, spent())
                print(f"{fault.name}: seen by {test}, {spent():.0f} s", flush=True)
                return
            else:
                print(f"{test} fails without a fault: it is left out", flush=True)
    memory.settle(fault, "", spent())
    print(f"{fault.name}: SURVIVES, {spent():.0f} s", flush=True)


def reason_for(fault, reasons):
    return reasons.get(fault.name) or reasons.get(function_of(fault.name))


def chosen_of(options, faults, reasons):
    faults = [fault for fault in faults if not options.only or any(word in fault.name for word in options.only)]
    if not options.some:
        return faults
    seed = options.seed or subprocess.check_output(["git", "-c", f"safe.directory={SOURCE}", "rev-parse", "HEAD"], cwd=SOURCE, text=True).strip()
    chosen = random.Random(seed).sample([fault for fault in faults if not reason_for(fault, reasons)], options.some)
    print(f"chosen by {seed}: {', '.join(fault.name for fault in chosen)}", flush=True)
    return chosen


def arguments(about):
    """The options, and why faults may survive, by their names or those of functions."""
    parser = argparse.ArgumentParser(description=about, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=Path)
    parser.add_argument("--only", nargs="+", default=[])
    parser.add_argument("--some", type=int)
    parser.add_argument("--seed")
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--remember", action="store_true")
    options = parser.parse_args()
    options.build = options.build.resolve()
    return options, json.loads(REASONS.read_text())


def try_all(setting, memory, faults, reasons, jobs):
    """Tries those that are not settled and tells what survives. Returns the exit status."""
    began = time.monotonic()
    with ThreadPoolExecutor(jobs) as pool:
        list(pool.map(lambda fault: settle(setting, memory, fault), [fault for fault in faults if not memory.verdict(fault)]))
    survivors = [fault for fault in faults if not memory.verdict(fault)["seen_by"]]
    for fault in survivors:
        reason = reason_for(fault, reasons)
        print(f"SURVIVES: {fault.name}: {fault.after}" + (f"; because {reason}" if reason else ""))
    spent = sum(memory.verdict(fault)["seconds"] for fault in faults)
    print(f"{len(faults)} faults, {len(faults) - len(survivors)} seen; {time.monotonic() - began:.0f} s now, {spent:.0f} s in all by one job")
    return int(any(not reason_for(fault, reasons) for fault in survivors))


def main():
    options, reasons = arguments(__doc__)
    every = all_faults(SOURCE / "shaders")
    faults = chosen_of(options, every, reasons)
    if options.list:
        known = {name for fault in every for name in (fault.name, function_of(fault.name))}
        print("\n".join(fault.name for fault in faults))
        return "".join(f"reasons.json: there is no {name}\n" for name in sorted(set(reasons) - known)) or 0

    folder = options.build / "mutants"
    folder.mkdir(exist_ok=True)
    setting = SimpleNamespace(source=SOURCE, build=options.build, folder=folder, program=options.build / "fragtrace", drawing=drawing_tests(options.build),
                              compiler=Compiler(SOURCE, options.build), lock_of_sound=Lock(), seconds=options.seconds, trial=Trial)
    memory = Memory(folder / "state.json", HINTS, function_texts(SOURCE / "shaders"))
    try:
        return try_all(setting, memory, faults, reasons, options.jobs)
    finally:
        if options.remember:
            HINTS.write_text(json.dumps({name: memory.hints[name] for name in sorted(memory.hints) if name in memory.texts}, indent=0) + "\n")


if __name__ == "__main__":
    sys.exit(main())

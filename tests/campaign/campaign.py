#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""campaign.py FRAGTRACE SOURCE_FOLDER HOURS [--only NAME,...] [--table]
campaign.py FRAGTRACE SOURCE_FOLDER --seconds S [--only NAME,...]
campaign.py FRAGTRACE SOURCE_FOLDER --case NAME NUMBER
campaign.py FRAGTRACE SOURCE_FOLDER --table

Runs the campaigns of docs/design/reliability.md: HOURS are shared among those that have not reached their counts. A case is drawn by its number
alone. state.json in FRAGTRACE's folder holds what was reached; findings/NAME-NUMBER what a case has left, and the command that repeats it.
--seconds runs each for so long, but those that take hours. --state FOLDER is another place for all this; --table still writes the document.
"""
import argparse
import importlib
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import traceback
from pathlib import Path

NAMES = ("kills", "faults", "hangs", "inputs", "forms", "solids", "rays", "driver", "long", "races")
LEFT = 120  # seconds that the cases have that run when the time is over
HERE = Path(__file__).resolve().parent


def parsed(words):
    parser = argparse.ArgumentParser(prog="scripts/campaign", usage="scripts/campaign HOURS | --seconds S | --case NAME NUMBER | --table  [--only NAME,...]")
    parser.add_argument("fragtrace", type=Path)
    parser.add_argument("source", type=Path)
    parser.add_argument("hours", type=float, nargs="?")
    parser.add_argument("--only", default=",".join(NAMES))
    parser.add_argument("--seconds", type=float)
    parser.add_argument("--case", nargs=2, metavar=("NAME", "NUMBER"))
    parser.add_argument("--table", action="store_true")
    parser.add_argument("--state", type=Path)
    options = parser.parse_args(words)
    options.only = options.only.split(",")
    unknown = [name for name in options.only + (options.case or [])[:1] if name not in NAMES]
    if unknown:
        parser.error(f"there is no campaign {unknown[0]}; there are {', '.join(NAMES)}")
    if sum((options.hours is not None, options.seconds is not None, options.case is not None)) != (0 if options.table and options.hours is None else 1):
        parser.error("one of HOURS, --seconds, --case and --table is needed, and no second one")
    if options.case and not re.fullmatch("[0-9]+", options.case[1]):
        parser.error(f"'{options.case[1]}' is no number of a case")
    if not all(number is None or 0 < number < 1e6 for number in (options.hours, options.seconds)):
        parser.error("the time must be above 0")
    return options


def module_of(name):
    return importlib.import_module("long_runs" if name == "long" else name)


class Campaign:
    """One campaign while it runs: its cases on some threads, and what they came to."""

    def __init__(self, name, ground, state):
        self.name, self.module, self.ground, self.state = name, module_of(name), ground, state
        self.lock = threading.Lock()
        self.found, self.failure, self.began = [], None, time.monotonic()

    def prepare(self):
        self.ground.folder.mkdir(parents=True, exist_ok=True)
        self.data = self.module.prepare(self.ground)
        self.last = getattr(self.module, "last", lambda data: None)(self.data)

    def draw(self, number):
        """Runs a case in a folder of its own; what it found, or nothing."""
        with tempfile.TemporaryDirectory(prefix=f"fragtrace-{self.name}-") as name:
            folder = Path(name) / "work"
            folder.mkdir()
            try:
                return None, self.module.case(self.ground, self.data, number, folder)
            except common.Finding as finding:
                self.keep(number, str(finding), Path(name))
                return str(finding), {}

    def keep(self, number, says, folder):
        place = self.state.findings / f"{self.name}-{number}"
        common.kept(folder, place)
        (place / "says").write_text(says + "\n")
        (place / "repeat").write_text(f"scripts/campaign --case {self.name} {number}\n")
        print(f"campaign: {self.name} {number}, after {time.monotonic() - self.began:.0f} s: {says}\n          kept in {place}", file=sys.stderr)

    def work(self):
        while (number := self.next_number()) is not None:
            try:
                says, counts = self.draw(number)
            except common.Stopped:
                with self.lock:
                    self.row["again"].append(number)
                return
            except BaseException as error:  # of the campaign itself
                with self.lock:
                    self.failure = error
                    self.row["again"].append(number)
                common.over.set()
                return
            with self.lock:
                self.state.add(self.row, counts)
                if says:
                    self.found.append(number)
                    self.row["findings"].append({"number": number, "says": says, "commit": self.state.commit})

    def next_number(self):
        with self.lock:
            if common.over.is_set() or len(self.found) >= 20:
                return None
            if self.row["again"]:
                return self.row["again"].pop()
            number = self.row["next"]
            if self.last is not None and number >= self.last:
                return None
            self.row["next"] = number + 1
            return number

    def run(self, seconds):
        """Cases until the seconds are over; those that run then may end."""
        common.over.clear()
        common.stop.clear()
        self.row = self.state.changed(self.name)
        began = self.began = time.monotonic()
        try:
            self.prepare()
        except common.Finding as finding:
            self.found.append("prepare")
            print(f"campaign: {self.name}, before the first case: {finding}", file=sys.stderr)
            return
        threads = [threading.Thread(target=self.work, daemon=True) for _ in range(getattr(self.module, "JOBS", os.cpu_count() or 1))]
        for thread in threads:
            thread.start()
        shown = began
        try:
            while any(thread.is_alive() for thread in threads):
                time.sleep(0.05)
                now = time.monotonic()
                if now - began > seconds or (not self.ground.brief and is_done(self.name, self.state)):
                    common.over.set()
                if now - began > seconds + LEFT:
                    common.stop.set()
                if now - shown > (1 if sys.stderr.isatty() else 30):
                    shown = now
                    self.show(now - began, seconds)
                    self.state.save()
        finally:
            common.over.set()
            common.stop.set()
            for thread in threads:
                thread.join()
            with self.lock:
                self.state.took(self.row, time.monotonic() - began)
        if self.failure:
            raise self.failure

    def show(self, seconds, share):
        text = f"campaign: {self.name}: {reached(self.row)}, {len(self.found)} findings, {seconds:.0f} of {share:.0f} s"
        print(f"\r\033[K{text}" if sys.stderr.isatty() else text, end="" if sys.stderr.isatty() else "\n", file=sys.stderr, flush=True)


def ground_of(name, options, state, brief):
    return common.Ground(options.fragtrace.resolve(), options.source.resolve(), state.folder / name, brief)


def is_done(name, state):
    """Returns true if a campaign has reached what was asked for."""
    row, module = state.row(name), module_of(name)
    return all(row["counts"].get(unit, 0) >= count for unit, count in module.ASKED.items())


def one_case(options, state):
    """Draws a case again, many times where its moment is left to chance; a finding that is none any more is mended."""
    name, number = options.case[0], int(options.case[1])
    row = state.changed(name)
    campaign = Campaign(name, ground_of(name, options, state, False), state)
    campaign.prepare()
    repeats = getattr(campaign.module, "REPEATS", 1)
    for k in range(repeats):
        says, counts = campaign.draw(number)
        if says:
            break
        if k + 1 < repeats:
            print(f"campaign: {name} {number}: drawn {k + 1} of {repeats} times, no finding", file=sys.stderr)
    if not says:
        print(f"{name} {number}: no finding ({', '.join(f'{count} {unit}' for unit, count in counts.items())})")
        row["mended"] += [one for one in row["findings"] if one["number"] == number]
        row["findings"] = [one for one in row["findings"] if one["number"] != number]
        state.save()
    return 1 if says else 0


def campaigns(options, state):
    names = [name for name in options.only if options.hours is None or not is_done(name, state)]
    if options.seconds is not None:
        names = [name for name in names if getattr(module_of(name), "BRIEF", True)]
    end = time.monotonic() + (options.hours or 0) * 3600
    found = 0
    for i, name in enumerate(names):
        share = options.seconds or max(1.0, (end - time.monotonic()) / (len(names) - i))
        campaign = Campaign(name, ground_of(name, options, state, options.seconds is not None), state)
        try:
            campaign.run(share)
        except common.Absent as reason:
            print(f"campaign: {name} does not run here: {reason}", file=sys.stderr)
        found += len(campaign.found)
        state.save()
    return 1 if found else 0


def main():
    options = parsed(sys.argv[1:])
    # The tests of the command line, whose classes and functions the campaigns use, read the program's place there.
    sys.argv[1:] = [str(options.fragtrace), str(options.source)]
    sys.path[:0] = [str(HERE), str(HERE.parent / "command")]
    global common, reached
    import common
    from state import State, Unusable, reached, write_table
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    status = 0
    try:
        state = State(options.state or options.fragtrace.resolve().parent / "campaign", options.source)
        if options.case:
            return one_case(options, state)
        if options.hours or options.seconds:
            status = campaigns(options, state)
    except (Unusable, common.Absent) as reason:
        print(f"campaign: {reason}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        if options.case:
            return 130
        print("\ncampaign: interrupted; it goes on there when it is started again", file=sys.stderr)
        status = 130
    except Exception:  # of the campaign itself
        traceback.print_exc()
        return 2
    state.save()
    text = state.table({name: module_of(name).ASKED for name in NAMES})
    print(text, end="")
    if options.table:
        write_table(options.source / "docs/design/reliability.md", text)
    return status


if __name__ == "__main__":
    sys.exit(main())

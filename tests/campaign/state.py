# SPDX-License-Identifier: MIT
"""Keeps what the campaigns have reached in a file that is replaced as a whole, and makes a table of it."""
import copy
import datetime
import fcntl
import json
import os
import re
import subprocess

EMPTY = {"counts": {}, "next": 0, "again": [], "findings": [], "mended": [], "commits": [], "date": "", "seconds": 0}
MARKS = re.compile(r"(<!-- campaigns -->\n).*?(<!-- end of campaigns -->)", re.S)


class Unusable(Exception):
    """State that cannot be read or written, or that another process writes."""


def commit_of(source):
    """Its short name; a + behind it: files were changed."""
    git = ["git", "-c", f"safe.directory={source.resolve()}", "-C", source]
    name = subprocess.run([*git, "rev-parse", "--short=8", "HEAD"], capture_output=True, text=True).stdout.strip()
    clean = subprocess.run([*git, "diff", "--quiet", "HEAD", "--", "src", "shaders", "bench"], capture_output=True).returncode == 0
    return (name or "unknown") + ("" if clean else "+")


def figure(number):
    return f"{number:.2g}" if isinstance(number, float) and number < 10 else f"{round(number):,}"


def listed(counts):
    return ", ".join(f"{figure(count)} {unit}" for unit, count in counts.items())


def reached(row):
    return listed(row["counts"]) or "0"


class State:
    def __init__(self, folder, source):
        self.folder, self.findings, self.file = folder, folder / "findings", folder / "state.json"
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise Unusable(f"{folder}: {error.strerror}") from None
        self.rows = self.read()
        self.locks = {}  # of the campaigns that this process runs
        self.commit = commit_of(source)

    def read(self):
        try:
            rows = json.loads(self.file.read_text()) if self.file.exists() else {}
            if all(set(EMPTY) <= set(row) for row in rows.values()):
                return rows
            raise ValueError("a campaign lacks some of its members")
        except (OSError, ValueError, AttributeError, TypeError) as error:
            raise Unusable(f"{self.file}: is no state of campaigns ({error}); move it away to begin anew") from None

    def changed(self, name):
        """The row, which this process alone may change from now on."""
        if name not in self.locks:
            lock = open(self.folder / f"{name}.lock", "w")
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                raise Unusable(f"{self.folder}: another process runs {name}") from None
            self.locks[name] = lock
            self.rows[name] = self.read().get(name) or self.row(name)
        return self.row(name)

    def row(self, name):
        return self.rows.setdefault(name, copy.deepcopy(EMPTY))

    def add(self, row, counts):
        for unit, count in counts.items():
            row["counts"][unit] = row["counts"].get(unit, 0) + count
        if self.commit not in row["commits"]:
            row["commits"].append(self.commit)
        row["date"] = datetime.date.today().isoformat()

    def took(self, row, seconds):
        row["seconds"] = round(row["seconds"] + seconds)

    def save(self):
        """The rows that were asked for; others may be those of a campaign that runs at the same time."""
        with open(self.folder / "lock", "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            part = self.file.with_suffix(".part")
            part.write_text(json.dumps({**self.read(), **{name: self.rows[name] for name in self.locks}}, indent=1) + "\n")
            os.replace(part, self.file)

    def table(self, asked):
        lines = ["| campaign | count | asked | findings | hours | date | commit |", "| --- | --- | --- | --- | --- | --- | --- |"]
        for name, wanted in asked.items():
            row = self.row(name)
            count = listed({unit: row["counts"].get(unit, 0) for unit in wanted})
            open_ones, mended = len(row["findings"]), len(row["mended"])
            findings = f"{open_ones + mended}" + (f", {open_ones} open" if open_ones else ", mended" if mended else "")
            lines.append(f"| {name} | {count} | {listed(wanted)} | {findings} | {row['seconds'] / 3600:.1f} | {row['date'] or '-'} | "
                         f"{row['commits'][-1] if row['commits'] else '-'} |")
        return "\n".join(lines) + "\n"


def write_table(document, text):
    page = document.read_text()
    if not MARKS.search(page):
        raise SystemExit(f"campaign: {document} has no marks for the table")
    document.write_text(MARKS.sub(lambda marks: f"{marks[1]}\n{text}\n{marks[2]}", page))

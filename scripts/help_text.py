# SPDX-License-Identifier: MIT
"""The program's --help, read: its commands, their options, what values these take."""
import re
import subprocess
from dataclasses import dataclass

COLUMN = 30 * " "  # where --help begins its descriptions


@dataclass
class Command:
    words: list  # ["bench", "frame"]
    sentence: str
    usage: str
    sections: dict  # title: [(first column, description)]

    @property
    def is_group(self):
        return "Subcommands" in self.sections

    @property
    def options(self):
        return self.sections.get("Options", [])

    @property
    def positionals(self):
        return self.sections.get("Positionals", [])


def sections(text):
    """Returns the sections of a help text: {title: (first column, description) of each entry}."""
    found, title, lines = {}, None, text.splitlines()
    for line, after in zip(lines, [*lines[1:], ""]):
        if re.fullmatch(r"[A-Z]\w*:", line):
            title = line[:-1]
            found[title] = []
        elif title and line.startswith(COLUMN):
            found[title][-1][1] = (found[title][-1][1] + " " + line.strip()).strip()
        elif title and line.startswith("  "):
            # The description of a long name stands in the next line.
            end = len(line) if after.startswith(COLUMN) else len(COLUMN)
            found[title].append([line[:end].strip(), line[end:].strip()])
    return found


def command(program, words):
    text = subprocess.run([program, *words, "--help"], check=True, capture_output=True, text=True).stdout
    sentence, usage = text.splitlines()[:2]
    return Command(words, sentence, usage.removeprefix("Usage: "), sections(text))


def commands(program, words=()):
    """Returns the program itself, then its commands, each before those that it groups."""
    own = command(program, list(words))
    found = [own]
    for name, _ in own.sections.get("Subcommands", []):
        found += commands(program, [*words, name])
    return found


def readable(name):
    """Splits a first column, such as '--time FLOAT:FLOAT in [0.01 - 1e+07]', into option, values, default. CLI11 2.1
    writes defaults as 'INT=64', 2.4 as 'INT [64]'."""
    option, _, kind = name.partition(" ")
    limits = re.search(r" in \[(\S+) - (\S+)\]", kind)
    default = re.search(r"=(\S*)| \[(\S*)\]", kind.replace(limits[0], "") if limits else kind)
    return option, f"{limits[1]} to {limits[2]}" if limits else "", (default[1] or default[2] or "") if default else ""


def kind_of(name):
    """Returns the value's kind (FILE, TEXT, INT, AZIMUTH,ELEVATION[,ZOOM], ...) of '--output FILE REQUIRED'; '' for a
    switch."""
    found = re.match(r"\S+ ([A-Z]+(?:\[?,[A-Z]+\]?)*)", name)
    return found[1] if found else ""


def takes_several(name):
    """Returns true if the option's value is a list with commas."""
    return " ..." in name


def choices(name, text, others):
    """The names that a value may be, or []. `others` has the entries of the same command, for 'the names of --enable'."""
    if kind_of(name) != "TEXT":
        return []
    same = re.search(r"the names of (--[\w-]+)", text)
    if same:
        return next((choices(*entry, []) for entry in others if readable(entry[0])[0] == same[1]), [])
    for found in re.findall(r"(?:^|: )((?:[\w -]+, )+[\w -]+)(?=$|[;.)])", text):
        names = [one for one in found.split(", ") if " " not in one]
        if len(names) > found.count(", ") / 2:
            return names
    return []


def extensions(text):
    """Returns the extensions of the files that a value may name, without dots."""
    return list(dict.fromkeys(re.findall(r"(?<!\w)\.([a-z]{3,4})\b", text))) or (["json"] if "JSON" in text else [])

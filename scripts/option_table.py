# SPDX-License-Identifier: MIT
"""The table of options, as `fragtrace help --json` prints it (docs/options-json.md)."""
import json
import subprocess


class Table:
    """commands: in the order of help, each before those that it groups. options: each once, with the names of its commands."""

    def __init__(self, program):
        own, bench = (json.loads(subprocess.run([program, "help", *words, "--json"], check=True, capture_output=True, text=True).stdout)
                      for words in ([], ["bench"]))
        self.version = own["version"]
        groups = {command["name"] for command in bench["commands"]}
        self.commands = [command for command in own["commands"] if command["name"] not in groups] + bench["commands"]
        self.options = [option for option in own["options"] if not groups.issuperset(option["commands"])] + bench["options"]

    def of(self, name):
        """Returns the options of a command; arguments have no forms."""
        return [option for option in self.options if name in option["commands"] and option["forms"]]

    def arguments(self, name):
        return [option for option in self.options if name in option["commands"] and not option["forms"]]


def value_notes(option):
    """Returns what follows an option's sentence: default and range."""
    notes = [f"default {option['default']}"] if option["default"] is not None else []
    if option["type"] == "number" and option["range"]:
        least, most = (f"{bound:g}" if bound is not None else "" for bound in option["range"])
        notes.append(f"{least} to {most}" if most else f"from {least} on")
    return notes

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What --help shows, in text and as JSON."""
import fcntl
import json
import os
import pty
import struct
import subprocess
import termios

from support import FRAGTRACE, SCENES, Case, main, run

BOX = SCENES / "cornell-box.gltf"
MEMBERS = ["name", "forms", "metavariable", "type", "choices", "other_values", "default", "range", "units", "group", "everyday", "values", "separator",
           "repeatable", "required", "excludes", "extensions", "text", "commands"]


def shown(*words, columns):
    """Returns the help on a terminal of so many columns."""
    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    with subprocess.Popen([FRAGTRACE, *words], stdout=theirs) as process:
        os.close(theirs)
        text = b""
        while True:
            try:
                part = os.read(ours, 4096)
            except OSError:  # the end, of a terminal
                break
            if not part:
                break
            text += part
    os.close(ours)
    assert process.returncode == 0
    return text.decode().replace("\r\n", "\n")


class Help(Case):
    def test_topics_stand_in_the_order_of_thought(self):
        text = run("render", "--help").stdout
        topics = [line[:-1] for line in text.splitlines() if line and line[0].isupper() and line.endswith(":")]
        self.assertEqual(topics, ["Arguments", "Options", "Scene", "Camera", "Light", "Look", "Quality", "Output", "Device"])
        self.assertNotIn("FLOAT", text)
        self.assertNotIn(" in [", text)

    def test_all_shows_the_rest(self):
        everyday, everything = run("render", "--help").stdout, run("render", "--help", "all").stdout
        self.assertEqual(run("help", "render", "all").stdout, everything)
        self.assertIn("`fragtrace render --help all` shows ", everyday)
        self.assertNotIn("--help all`", everything)
        named = [option["name"] for option in json.loads(run("help", "render", "--json").stdout)["options"] if option["forms"]]
        self.assertTrue(all(f"--{name}" in everything for name in named))
        self.assertNotIn("\n  --light-reuse", everyday)
        self.assertIn("\n  --light-reuse", everything)

    def test_lines_are_as_wide_as_the_terminal(self):
        for columns in (60, 132):
            lines = [line for line in shown("render", "--help", columns=columns).splitlines() if len(line.split()) > 1]
            longest = max(map(len, lines))
            self.assertTrue(columns - 12 < longest <= columns, longest)
        self.assertTrue(all(len(line) <= 80 for line in run("render", "--help").stdout.splitlines() if len(line.split()) > 1))

    def test_json_has_each_member_of_each_option(self):
        table = json.loads(run("help", "--json").stdout)
        self.assertEqual(table["schema"], 1)
        for option in table["options"]:
            self.assertEqual(list(option), MEMBERS, option["name"])
        named = {option["name"]: option for option in table["options"] if "render" in option["commands"]}
        self.assertEqual(named["exposure"]["range"], [-100, 100])
        self.assertEqual((named["exposure"]["units"], named["exposure"]["group"]), ("stops", "Look"))
        self.assertEqual((named["spp"]["type"], named["spp"]["range"]), ("integer", [1, 1 << 29]))
        self.assertEqual((named["output"]["forms"], named["output"]["metavariable"]), (["-o", "--output"], "FILE"))
        self.assertEqual(named["camera-orbit"]["values"], [2, 3])
        self.assertTrue(named["hide"]["repeatable"] and not named["spp"]["repeatable"])
        self.assertEqual(run("--help", "--json").stdout, run("help", "--json").stdout)
        self.assertIn("bench start", [command["name"] for command in json.loads(run("help", "bench", "--json").stdout)["commands"]])
        self.fails(2, "help", "rendr", "--json", says=["did you mean render?"])


if __name__ == "__main__":
    main()

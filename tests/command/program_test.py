#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""render as another program uses it: --progress json, and the picture on standard output."""
import json
import signal
import subprocess
import unittest
from pathlib import Path

from support import FRAGTRACE, SCENES, Case, main, run

BOX = SCENES / "cornell-box.gltf"
SIZE = ["--resolution", "64,64", "--spp", "64"]


def events(text):
    return [json.loads(line) for line in text.splitlines()]


class ProgressJson(Case):
    def told(self, status, *words, **options):
        """The events of a render; the last one tells the status."""
        result = run("render", *words, **options)
        self.assertEqual(result.returncode, status, result.stderr)
        told = events(result.stderr)
        self.assertEqual((told[-1]["type"], told[-1]["status"]), ("done", status))
        self.assertEqual([event["type"] for event in told].count("done"), 1)
        return told[:-1]

    def test_each_line_is_an_event(self):
        path = self.folder / "x.png"
        told = self.told(0, BOX, "-o", path, "--resolution", "300,300", "--spp", 64, "--bounces", 1, "--verbose", "--progress", "json")
        self.assertEqual([event["phase"] for event in told if event["type"] == "phase"][:2], ["scene", "tree"])
        self.assertTrue(any("OpenGL" in event["text"] for event in told if event["type"] == "message"))
        self.assertTrue(any(event["type"] == "warning" and "cut" in event["text"] for event in told))
        steps = [event for event in told if event["type"] == "progress"]
        self.assertTrue(steps)
        for before, after in zip(steps, steps[1:]):
            self.assertLessEqual(before["fraction"], after["fraction"])
            self.assertGreater(after["seconds"] - before["seconds"], 0.099)
        for step in steps:
            self.assertEqual((step["phase"], step["samples_asked"], step["output"]), ("rendering", 64, str(path)))
            self.assertAlmostEqual(step["samples"], 64 * step["fraction"])
            self.assertIn("seconds_left", step)
        picture = next(event for event in told if event["type"] == "picture")
        self.assertEqual([picture[name] for name in ("width", "height", "samples", "complete", "output")], [300, 300, 64, True, str(path)])

    def test_errors_are_events_too(self):
        for status, words, says in ((2, ("--no-such", 1), "--no-such"), (2, ("--spp", 0), "--spp"), (3, (), "none.gltf")):
            told = self.told(status, self.folder / "none.gltf", "-o", self.folder / "x.png", "--progress=json", *words)
            self.assertEqual(told[-1]["type"], "error")
            self.assertIn(says, told[-1]["text"])
        told = self.told(3, self.folder / "none.gltf", "-o", self.folder / "x.png", "--progress", "json", "--quiet")
        self.assertEqual([event["type"] for event in told], ["error"])
        self.fails(2, "render", BOX, "-o", self.folder / "x.png", "--progress", "xml", says=["auto, json, none"])

    def test_an_option_file_asks_for_it(self):
        config = self.folder / "c.json"
        config.write_text('{"progress": "json", "spp": 2}')
        self.told(0, BOX, "-o", self.folder / "x.pfm", "--resolution", "16,16", "--config", config)

    def test_a_sequence_names_its_picture(self):
        told = self.told(0, BOX, "-o", self.folder / "t.#.pfm", "--turntable", 3, "--progress", "json", *SIZE[:2], "--spp", 2)
        pictures = [event for event in told if event["type"] == "picture"]
        self.assertEqual([(p["frame"], p["first_frame"], p["last_frame"], p["output"]) for p in pictures],
                         [(i, 0, 2, str(self.folder / f"t.{i}.pfm")) for i in range(3)])

    def test_a_sequence_tells_the_progress_of_all(self):
        """The fraction and the time left of all its pictures; with --continue, of those that are missing."""
        turn = ["-o", self.folder / "t.#.pfm", "--turntable", 4, "--resolution", "160,120", "--bounces", 1]
        told = self.told(0, BOX, *turn, "--spp", 64, "--progress", "json")
        steps = [event for event in told if event["type"] == "progress"]
        for before, after in zip(steps, steps[1:]):
            self.assertLessEqual(before["sequence_fraction"], after["sequence_fraction"])
        for step in steps:
            self.assertAlmostEqual(step["sequence_fraction"], (step["frame"] + step["fraction"]) / 4)
        # What is left is what all pictures took so far, in proportion: every step gives one moment of the first one's beginning.
        begins = [step["seconds"] - step["sequence_seconds_left"] * step["sequence_fraction"] / (1.0 - step["sequence_fraction"])
                  for step in steps if 0.0 < step["sequence_fraction"] < 1.0]
        self.assertGreater(len(begins), 4)
        self.assertLess(max(begins) - min(begins), 0.2 * told[-1]["seconds"])
        (self.folder / "t.3.pfm").unlink()
        told = self.told(0, BOX, *turn, "--spp", 64, "--progress", "json", "--continue")
        for step in (event for event in told if event["type"] == "progress"):
            self.assertEqual(step["sequence_fraction"], step["fraction"])

    def test_lines_and_bars_are_those_of_the_whole_sequence(self):
        words = [BOX, "-o", self.folder / "t.#.pfm", "--turntable", 4, "--resolution", "200,150", "--spp", 60]
        lines = [line for line in run("render", *words).stderr.splitlines() if "left" in line]
        self.assertGreater(len(lines), 2)
        for line in lines:
            self.assertRegex(line, r"^picture [1-4] of 4: \d+ %, \d+:\d\d left$")
        shares = [int(line.split(": ")[1].split(" ")[0]) for line in lines]
        self.assertEqual(shares, sorted(set(shares)))
        self.assertEqual(run("render", *words[:-1], 4, "--progress", "none").stderr.count("left"), 0)

    def test_an_interruption_is_told(self):
        with subprocess.Popen([FRAGTRACE, "render", BOX, "-o", self.folder / "x.pfm", "--spp", "100000", "--progress", "json"],
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as process:
            while json.loads(process.stderr.readline())["type"] != "progress":
                pass
            process.send_signal(signal.SIGINT)
            told = events(process.stderr.read())
        self.assertEqual((process.returncode, told[-1]["status"]), (130, 130))
        self.assertFalse(next(event for event in told if event["type"] == "picture")["complete"])

    def test_none_tells_no_progress_but_messages(self):
        words = [BOX, "-o", self.folder / "x.pfm", "--time", "2", "--resolution", "16,16"]
        self.assertIn("rendering", self.renders(*words).stderr)
        self.assertNotIn("rendering", self.renders(*words, "--progress", "none").stderr)


class StandardOutput(Case):
    def printed(self, *words, stdout=subprocess.PIPE):
        return subprocess.run([FRAGTRACE, "render", BOX, "-o", "-", *SIZE, *words], stdout=stdout, stderr=subprocess.PIPE, cwd=self.folder)

    def test_it_has_the_bytes_of_the_file_and_nothing_else(self):
        for form in ("png", "jpg", "exr", "hdr", "pfm"):
            path = self.folder / f"x.{form}"
            self.renders(BOX, "-o", path, "--quiet", *SIZE)
            for more in ([], ["--verbose", "--progress", "json"]):
                result = self.printed("--format", form, *more)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertEqual(result.stdout, path.read_bytes(), form)
            path.unlink()
        self.assertEqual(list(self.folder.iterdir()), [])
        self.assertIn(b"64 x 64", self.printed("--format", "pfm").stderr)

    def test_what_needs_a_file_is_refused(self):
        for words, says in (((), "needs --format"), (("--format", "tiff"), "none of png"), (("--format", "exr", "--checkpoint", 1), "--checkpoint"),
                            (("--format", "exr", "--resume"), "--resume"), (("--format", "exr", "--stats", "-"), "--stats"),
                            (("--format", "png", "--turntable", 3), "--format rgb24"), (("--format", "png", "--aov", "samples"), ".exr")):
            self.fails(2, "render", BOX, "-o", "-", *SIZE, *words, says=[says], cwd=self.folder)

    def test_a_format_goes_with_any_name(self):
        self.renders(BOX, "-o", self.folder / "x.png", "--quiet", *SIZE)
        for name in ("thumbnail", ".x.a7T3", "y.jpg", "z.png"):
            result = self.renders(BOX, "-o", self.folder / name, "--format", "png", *SIZE)
            self.assertIn(name + ":", result.stdout)
            self.assertEqual((self.folder / name).read_bytes(), (self.folder / "x.png").read_bytes())
        self.assertEqual(len(list(self.folder.iterdir())), 5)
        for words, says in ((("--turntable", 3), "--frames or --turntable"), (("--checkpoint", 1), "--checkpoint"), (("--half",), "--half")):
            self.fails(2, "render", BOX, "-o", self.folder / "a", "--format", "png", *SIZE, *words, says=[says])
        self.fails(1, "render", BOX, "-o", self.folder / "none/a", "--format", "png", *SIZE, says=["none/a: ", f"there is no folder {self.folder / 'none'}"])

    @unittest.skipUnless(Path("/dev/pts").is_mount(), "/dev/pts is not there")
    def test_a_terminal_is_refused(self):
        result = subprocess.run(["script", "-qec", f"'{FRAGTRACE}' render '{BOX}' -o - --format png", "/dev/null"], capture_output=True,
                                text=True, stdin=subprocess.DEVNULL, timeout=60)
        self.assertEqual(result.returncode, 2, result.stdout)
        self.assertIn("is a terminal", result.stdout)

    def test_a_reader_that_has_gone_is_an_error(self):
        for to in ("true", "head -c 10 > /dev/null"):
            command = f'"$0" render "$1" -o - --format pfm --resolution 300,300 --spp 1 | {to}; exit "${{PIPESTATUS[0]}}"'
            result = subprocess.run(["bash", "-c", command, FRAGTRACE, BOX], capture_output=True, text=True, cwd=self.folder)
            self.assertEqual(result.returncode, 1, result.stderr)
            self.assertIn("cannot write to standard output: Broken pipe", result.stderr)
        self.assertEqual(list(self.folder.iterdir()), [])


if __name__ == "__main__":
    main()

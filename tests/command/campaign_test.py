#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""tests/campaign: each campaign that has a short form runs for a moment and finds nothing; what it keeps, how it continues, how it is called."""
import json
import os
import shutil
import signal
import subprocess
import sys
import time

from support import FRAGTRACE, SCENES, Case, main

SOURCE = SCENES.parent
PROGRAM = SOURCE / "tests/campaign/campaign.py"



class Campaigns(Case):
    def campaign(self, *words, status=0, **options):
        command = [sys.executable, PROGRAM, FRAGTRACE, SOURCE, *map(str, words), "--state", self.folder / "state"]
        result = subprocess.run(command, capture_output=True, text=True, timeout=300, **options)
        self.assertEqual(result.returncode, status, result.stdout + result.stderr)
        return result

    def rows(self):
        return json.loads((self.folder / "state/state.json").read_text())

    def test_the_short_forms_find_nothing(self):
        self.campaign("--seconds", 1, "--only", "kills,faults,hangs,inputs,forms,driver")
        for name, row in self.rows().items():
            self.assertGreater(sum(row["counts"].values()), 0, name)
            self.assertEqual((row["findings"], row["again"]), ([], []), name)

    def test_one_that_is_started_again_goes_on(self):
        for _ in range(2):
            before = self.rows()["forms"]["next"] if (self.folder / "state/state.json").exists() else 0
            self.campaign("--seconds", 0.1, "--only", "forms")
            self.assertGreater(self.rows()["forms"]["next"], before)

    def test_a_finding_is_kept_with_its_command_and_mended_when_it_is_none_any_more(self):
        stand_in = self.folder / "build"
        stand_in.mkdir()
        (stand_in / "property_test").write_text("#!/bin/sh\necho differs\nexit 1\n")
        (stand_in / "property_test").chmod(0o755)
        words = [sys.executable, PROGRAM, stand_in / "fragtrace", SOURCE, "--state", self.folder / "state"]
        self.assertEqual(subprocess.run([*words, "--seconds", "0.1", "--only", "forms"], capture_output=True).returncode, 1)
        findings = self.rows()["forms"]["findings"]
        number = findings[0]["number"]
        kept = self.folder / f"state/findings/forms-{number}"
        self.assertIn("differs", (kept / "says").read_text())
        self.assertEqual((kept / "repeat").read_text(), f"scripts/campaign --case forms {number}\n")
        self.campaign("--case", "forms", number)
        self.assertEqual(len(self.rows()["forms"]["findings"]), len(findings) - 1)
        self.assertEqual(len(self.rows()["forms"]["mended"]), 1)

    def test_ctrl_c_keeps_what_was_reached(self):
        process = subprocess.Popen([sys.executable, PROGRAM, FRAGTRACE, SOURCE, "1", "--only", "forms", "--state", self.folder / "state"],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.kill)
        time.sleep(4)
        process.send_signal(signal.SIGINT)
        said = process.communicate(timeout=120)[1]
        self.assertEqual(process.returncode, 130, said)
        row = self.rows()["forms"]
        self.assertEqual(row["counts"].get("scenes", 0) + len(row["again"]), row["next"])

    def test_without_a_compiler_the_others_run_and_it_says_why(self):
        scripts = self.folder / "source/scripts"
        scripts.mkdir(parents=True)
        for name in ("setup", "build"):
            (scripts / name).write_text("#!/bin/sh\nexit 1\n")
            (scripts / name).chmod(0o755)
        for words, status in ((["0.001", "--only", "inputs,races,long"], 0), (["--case", "inputs", "1"], 2)):
            command = [sys.executable, PROGRAM, FRAGTRACE, scripts.parent, *words, "--state", self.folder / "state"]
            result = subprocess.run(command, capture_output=True, text=True, timeout=60)
            self.assertEqual(result.returncode, status, result.stderr)
            self.assertNotIn("Traceback", result.stderr)
            self.assertRegex(result.stderr, r"clang\+\+ is not installed|scripts/build sanitize loader_fuzz failed")

    def test_a_configuration_that_failed_leaves_no_cache(self):
        (self.folder / "scripts").mkdir()
        shutil.copy(SOURCE / "scripts/build", self.folder / "scripts")
        cmake = self.folder / "cmake"
        cmake.write_text("#!/bin/sh\nmkdir build-sanitize/CMakeFiles\ntouch build-sanitize/CMakeCache.txt\nexit 1\n")
        cmake.chmod(0o755)
        environment = {**os.environ, "PATH": f"{self.folder}:{os.environ['PATH']}"}
        result = subprocess.run([self.folder / "scripts/build", "sanitize"], env=environment, capture_output=True, text=True)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertEqual([path.name for path in (self.folder / "build-sanitize").iterdir()], ["configure.log"])

    def test_wrong_words_are_2(self):
        for words in ([], ["0"], ["x"], ["1", "--seconds", "1"], ["1", "--only", "nothing"], ["--case", "forms", "x"], ["--case", "nothing", "1"]):
            self.campaign(*words, status=2)


if __name__ == "__main__":
    main()

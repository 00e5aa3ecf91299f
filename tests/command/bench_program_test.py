#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`fragtrace bench` becomes the program fragtrace-bench, which lies beside it."""
import json
import os
import shutil
import signal
import subprocess

from support import FRAGTRACE, SCENES, Case, main, run

BENCH = FRAGTRACE.with_name("fragtrace-bench")
# Prints its process and its words, and ends by a signal.
STAND_IN = '#!/bin/sh\nprintf "%s\\n" "$$" "$0" "$@"\nkill -TERM $$\n'


class BenchProgram(Case):
    def setUp(self):
        super().setUp()
        self.environment = {name: value for name, value in os.environ.items() if name != "FRAGTRACE_LIBRARY_PATH"}

    def program(self, path, *words):
        shutil.copy(path, self.folder / path.name)
        return subprocess.Popen([self.folder / path.name, *map(str, words)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                env=self.environment)

    def test_words_process_and_end_are_those_of_the_program(self):
        stand_in = self.folder / BENCH.name
        stand_in.write_text(STAND_IN)
        stand_in.chmod(0o755)
        for words, passed in ((["bench", "error", "a b", "--goal=1"], ["error", "a b", "--goal=1"]), (["bench"], []),
                              (["--help", "bench", "bench"], ["--help", "bench"])):
            with self.subTest(words=words), self.program(FRAGTRACE, *words) as process:
                self.assertEqual(process.communicate()[0].splitlines(), [str(process.pid), str(stand_in), *passed])
                self.assertEqual(process.returncode, -signal.SIGTERM)

    def test_a_missing_program_is_named(self):
        said = f"bench: the program fragtrace-bench is not in {self.folder}; the package fragtrace holds it, and scripts/build makes it"
        with self.program(FRAGTRACE, "bench", "stress") as process:
            self.assertEqual(process.communicate(), ("", f"fragtrace: {said}\n"))
            self.assertEqual(process.returncode, 1)
        with self.program(FRAGTRACE, "bench", "error", "--progress", "json") as process:
            self.assertEqual(json.loads(process.communicate()[1].splitlines()[0])["text"], said)
            self.assertEqual(process.returncode, 1)

    def test_a_start_needs_the_renderer(self):
        with self.program(BENCH, "start", SCENES / "cornell-box.gltf", "--quiet") as process:
            self.assertIn("bench start: the program fragtrace is not in", process.communicate()[1])
            self.assertEqual(process.returncode, 1)

    def test_it_speaks_as_the_command_does(self):
        for words in (["--help"], ["error", "--help"], [], ["foo"], ["stress", "--rowz"], ["error", "none.gltf", "--goal", "x"]):
            with self.subTest(words=words):
                own = subprocess.run([BENCH, *words], capture_output=True, text=True)
                command = run("bench", *words)
                self.assertEqual((own.returncode, own.stdout, own.stderr), (command.returncode, command.stdout, command.stderr))
                self.assertIn("fragtrace", own.stdout + own.stderr)
        self.assertEqual(run("--help", "bench", "error").stdout, run("bench", "error", "--help").stdout)


if __name__ == "__main__":
    main()

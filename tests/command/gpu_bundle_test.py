#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""bench/gpu: the table of `run` with a program that is played, and the bundle that `pack` makes, on this machine's driver."""
import json
import os
import shutil
import signal
import subprocess
import time

from support import FRAGTRACE, SCENES, Case, main

GPU = SCENES.parent / "bench/gpu"
# Draws everything by fragments, tells nothing of the ball, never ends its rays, and does not start.
PLAYED = """#!/usr/bin/env python3
import json, os, sys, time
words = sys.argv[1:]
after = lambda name: words[words.index(name) + 1]
write = lambda name, value: open(after(name), "w").write(json.dumps(value) + "\\n")
if words[0] == "render":
    write("--stats", {"gl_renderer": "played renderer", "gl_version": "4.5 played"})
elif words[1] == "frame" and "room-ball" in words[2]:
    write("--json", {"frame_ms": None})
elif words[1] == "frame":
    write("--json", {"frame_ms": {"median": 0.25}, "compile_ms": 100, "mpaths_per_s": 2, "mrays_per_s": 3, "picture": {"right": True},
                     "variant": "flat+front-to-back+fragment"})
elif words[1] == "motion":
    assert "--rounds" not in words
    row = {"pictures": 4, "seconds": 2, "pixels": 4e6, "latency_ms": [3, 5, 4], "trace_cpu_ms": 6, "moved_bytes": 8000, "gap_ms": [15, 40, 17, 16], "flip": 0.05, "relmse": 0.1}
    write("--json", {"rows": [{"mode": "filtered", **row}, {"mode": "raw", **row}]})
elif words[1] == "stress":
    assert after("--seed") in ("0", "1", "2")
    if "hits" in words and after("--seed") == "1":
        sys.exit("fragtrace: no place")
    line = {"row": after("--rows"), "cases": 1000, "failures": int("skins" in words), "limit": 0, "over": "skins" in words, "fast_failures": 2}
    write("--json", line)
    sys.exit(int(line["over"]))
elif words[1] == "traversal":
    open("process", "w").write(str(os.getpid()))
    time.sleep(60)
else:
    sys.exit("fragtrace: no such start")
"""


class GpuTable(Case):
    def setUp(self):
        super().setUp()
        self.bundle, self.out = self.folder / "bundle", self.folder / "out"
        (self.bundle / "bin").mkdir(parents=True)
        (self.bundle / "lib").mkdir()
        for name in ("run", "rows.py", "table.py"):
            shutil.copy2(GPU / name, self.bundle)
        (self.bundle / "bundle.json").write_text('{"commit": "0123456"}')
        program = self.bundle / "bin/fragtrace"
        program.write_text(PLAYED)
        program.chmod(0o755)

    def begin(self, *options):
        return subprocess.Popen([self.bundle / "run", "--out", self.out, *options], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def rows(self):
        lines = [line.split(" | ") for line in (self.out / "table.md").read_text().splitlines() if line.startswith("| ")]
        return {cells[1]: cells[2:] for cells in lines[2:]}

    def test_what_fails_or_takes_too_long_has_its_row_and_the_rest_goes_on(self):
        process = self.begin("--seconds", "22", "--only", "mesh,ball,start,rays,helmet,motion,pace")
        output, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 1, errors)
        text = (self.out / "table.md").read_text()
        self.assertEqual(output, text)
        self.assertIn("played renderer, OpenGL 4.5 played", text.splitlines()[0])
        self.assertIn("commit 0123456", text.splitlines()[0])
        rows = self.rows()
        fragment, compute = (rows[f"62,975 triangles, flat, front to back, {name}"] for name in ("fragment", "compute"))
        self.assertEqual(fragment, ["0.250 ms per frame; 2.00 Mpaths/s, 3.0 Mrays/s", "aim < 0.1 ms", "right, compiled in 0.1 s |"])
        self.assertIn("NOT drawn as asked: without compute", compute[2])
        self.assertIn("FAILED: status 1: fragtrace: no such start", rows["room with the ball"][2])
        self.assertIn("FAILED: stopped at its limit of 2 s", rows["rays a second"][2])
        self.assertIn("FlightHelmet.gltf is not in the bundle", rows["FlightHelmet under lightroom_14b, compute"][2])
        self.assertIn("FAILED: its figures cannot be read: TypeError", rows["room with the ball, compute"][2])
        self.assertEqual(rows["Cornell box, filtered"],
                         ["2.0 pictures/s of 1.00 Mpixels, 4.0 ms late; host 1.50 ms, 2.0 kB a picture", "aim 3 ms, 4 kB",
                          "FLIP 0.0500, relative MSE 0.1 |"])
        self.assertEqual(rows["Cornell box"], ["2.0 pictures/s of 1.00 Mpixels; one after 16.5 ms, 95 % within 17.0, all within 40.0",
                                               "aim 60 pictures/s, none after more than 50 ms", " |"])
        self.assertIn("19 rows failed or are wrong", text.splitlines()[-1])
        self.assertEqual(len((self.out / "figures.jsonl").read_text().splitlines()), 15)

    def test_cases_that_break_ray_tracers(self):
        process = self.begin("--seconds", "60", "--only", "stress")
        _, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 1, errors)
        rows = self.rows()
        self.assertEqual(rows["cases that break ray tracers, seed 0"], ["13 rows of 13,000 cases; with the fast test 26 wrong", "", "WRONG: skins (1 of 1000) |"])
        self.assertTrue(rows["cases that break ray tracers, seed 1"][0].startswith("12 rows"))
        self.assertEqual(rows["seed 1, hits"], ["-", "", "FAILED: status 1: fragtrace: no place |"])

    def test_an_interrupted_run_keeps_its_table(self):
        process = self.begin("--only", "mesh,rays")
        for line in process.stderr:
            if line.startswith("run: rays"):
                break
        while not (self.bundle / "process").exists() or not (self.bundle / "process").read_text():
            time.sleep(0.02)
        began = time.monotonic()
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130)
        self.assertLess(time.monotonic() - began, 10)
        self.assertEqual(len(self.rows()), 4)
        self.assertIn("INTERRUPTED", (self.out / "table.md").read_text())
        with self.assertRaises(ProcessLookupError):
            os.kill(int((self.bundle / "process").read_text()), 0)

    def test_what_cannot_be_done_is_refused(self):
        for options, says in ((["--only", "boxes"], "'boxes' is none of correctness, report"), (["--seconds", "0"], "above 0"),
                              (["--rounds", "0"], "above 0")):
            process = self.begin(*options)
            self.assertIn(says, process.communicate(timeout=60)[1])
            self.assertEqual((process.returncode, self.out.exists()), (2, False))


class GpuBundle(Case):
    def run_bundle(self, bundle):
        out = self.folder / "out"
        result = subprocess.run([bundle / "run", "--out", out, "--seconds", "3600", "--only", "correctness"], capture_output=True, text=True)
        return result.returncode, (out / "table.md").read_text()

    def test_a_bundle_sees_a_wrong_picture_and_reads_images_as_the_program_does(self):
        bundle = self.folder / "bundle"
        subprocess.run([GPU / "pack", bundle], check=True, capture_output=True)
        listed = bundle / "tests/reference/references.json"
        entries = json.loads(listed.read_text())
        wanted = ("cornell-box.gi", "mapped-layers.gi", "sphere-mapped.normal-maps", "coverage.gi")
        entries["references"] = [entry for entry in entries["references"] if entry["name"] in wanted]
        listed.write_text(json.dumps(entries))
        status, table = self.run_bundle(bundle)
        self.assertEqual(status, 0, table)
        self.assertIn("| reference pictures, compute entry | 4 of 4 right |", table)
        self.assertIn("| reference pictures, wavefront | 3 of 3 right |", table)

        reference = bundle / "tests/reference/mapped-layers.gi.pfm"
        shutil.copy(bundle / "tests/reference/rough-metals.gi.pfm", reference)  # the picture has the same size
        status, table = self.run_bundle(bundle)
        self.assertEqual(status, 1, table)
        self.assertIn("| 3 of 4 right |", table)
        self.assertIn("WRONG: mapped-layers.gi", table)

        pictures = set()
        for library in (bundle / "bin", FRAGTRACE.parent):
            path = self.folder / "x.pfm"
            self.renders(SCENES / "mapped-metal.gltf", "-o", path, "--resolution", "32,32", "--spp", "4", "--quiet",
                         env={**os.environ, "FRAGTRACE_LIBRARY_PATH": str(library)})
            pictures.add(path.read_bytes())
        self.assertEqual(len(pictures), 1)

    def test_a_folder_of_others_is_left_alone(self):
        (self.folder / "mine.txt").write_text("mine")
        result = subprocess.run([GPU / "pack", self.folder], capture_output=True, text=True)
        self.assertEqual(result.returncode, 1)
        self.assertIn("was not made by this script", result.stderr)
        self.assertEqual([path.name for path in self.folder.iterdir()], ["mine.txt"])


if __name__ == "__main__":
    main()

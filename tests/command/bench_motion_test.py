#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`bench motion`: its rows and checks on small pictures; a path from a file; what cannot be measured."""
import json

from support import SCENES, Case, main, run

BOX = SCENES / "cornell-box.gltf"
SHORT = ["--resolution", "32,24", "--pictures", "6", "--interval", "1", "--quiet"]


class BenchMotion(Case):
    def motion(self, *arguments):
        path = self.folder / "motion.json"
        result = run("bench", "motion", *arguments, "--json", path)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout, json.loads(path.read_text())

    def test_each_mode_has_its_figures_and_its_error(self):
        table, report = self.motion(BOX, *SHORT, "--compare", 2, "--reference-spp", 64, "--modes", "raw,filtered,no-past")
        self.assertEqual((report["bench"], report["scene"], report["width"], report["height"]), ("motion", "cornell-box.gltf", 32, 24))
        self.assertEqual([row["mode"] for row in report["rows"]], ["raw", "filtered", "no-past"])
        for row in report["rows"]:
            self.assertIn(row["mode"], table)
            self.assertEqual((row["pictures"], len(row["gap_ms"]), row["compared"]), (6, 6, 2))
            self.assertTrue(0 < row["trace_cpu_ms"] and 0 < row["pixels"] <= 6 * 32 * 24, row)
            self.assertTrue(all(ms > 0 for ms in row["latency_ms"]), row)
            self.assertTrue(0 < row["flip"] < 0.3 and 0 < row["relmse"], row)
        # A picture may come before the next move of the camera.
        self.assertTrue(any(row["latency_ms"] for row in report["rows"]))

    def test_without_a_target_pictures_have_full_resolution(self):
        _, report = self.motion(BOX, *SHORT, "--target", 0, "--path", "dolly", "--stage", "phong")
        self.assertEqual(report["rows"][0]["pixels"], 6 * 32 * 24)

    def test_a_path_goes_through_the_places_of_a_file(self):
        path = self.folder / "path.txt"
        path.write_text("--camera-position 0,1,3 --camera-focal-point 0,1,0\n\n--camera-position 0.5,1,3 --camera-focal-point 0,1,0\n")
        self.motion(BOX, *SHORT, "--path", path)
        path.write_text("--camera-position 0,1,3\n--camera-position 1\n")
        self.fails(3, "bench", "motion", BOX, *SHORT, "--path", path, says=["path.txt:2", "--camera-position"])
        path.write_text("--camera-position 0,1,3\n")
        self.fails(3, "bench", "motion", BOX, *SHORT, "--path", path, says=["path.txt", "two places"])

    def test_a_sun_or_a_slider_that_moves_has_no_past(self):
        """So slowly that all pictures are alike: with the past of a camera at rest, whose noise is the same, the error would be ten times as large."""
        for scene, path, light in (("sun-sky", "sun", "--sky"), ("plastics", "color", "--studio")):
            with self.subTest(path=path):
                _, report = self.motion(SCENES / f"{scene}.gltf", *SHORT, "--warm-up", 4, light, "--path", path, "--period", 10000, "--target", 0, "--compare", 1,
                                        "--reference-spp", 64, "--modes", "filtered,no-past")
                with_past, without = (row["relmse"] for row in report["rows"])
                self.assertGreater(without, 0)
                self.assertLess(with_past, 3 * without)

    def test_what_cannot_be_measured_is_refused(self):
        self.fails(2, "bench", "motion", BOX, *SHORT, "--time", 1, says=["--time"])
        self.fails(2, "bench", "motion", BOX, *SHORT, "--modes", "blurred", says=["--modes"])
        self.fails(2, "bench", "motion", BOX, *SHORT, "--path", "sun", says=["--path sun: needs --sky"])
        self.fails(3, "bench", "motion", self.folder / "none.gltf", *SHORT, says=["none.gltf"])


if __name__ == "__main__":
    main()

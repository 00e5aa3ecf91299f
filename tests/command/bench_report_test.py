#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""bench/report.py, which repeats the report's table by `bench frame`, and bench/charts.py."""
import importlib.util
import json
import subprocess
import sys

from support import FRAGTRACE, SCENES, Case, main

BENCH = SCENES.parent / "bench"
DATA = SCENES.parent / "docs/measurements/data"
sys.path.insert(0, str(BENCH))
import charts  # noqa: E402


class BenchReport(Case):
    def report(self, *arguments):
        return subprocess.run([sys.executable, BENCH / "report.py", FRAGTRACE, "--quiet", "--rounds", "2", "--round-time", "0.001", "--resolution", "16,16", *arguments],
                              capture_output=True, text=True)

    def test_rows_and_tables_have_the_reports_figures(self):
        path = self.folder / "r.json"
        result = self.report("--parts", "traversal,gi", "--json", path)
        self.assertEqual(result.returncode, 0, result.stderr)
        lines = [json.loads(line) for line in path.read_text().splitlines()]
        # Trees with a draw for each sample, too.
        self.assertEqual(len(lines), 2 + 2 * 4 + 1)
        self.assertTrue(all(line["picture"]["right"] for line in lines))
        for text in ("| 62,975 triangles | iterative | ", " | 226 |", " | 0.43 |", "| Cornell box | 128 samples | ", "iterative, 62,975 / 15,743"):
            self.assertIn(text, result.stdout)

    def test_an_error_of_bench_frame_ends_it(self):
        result = self.report("--parts", "gi", "--noise", "0.1")
        self.assertEqual(result.returncode, 2)
        self.assertIn("--noise", result.stderr)


class Charts(Case):
    def test_points_are_means_with_their_spread(self):
        step = lambda seconds, relmse: {"seconds": seconds, "relmse": relmse}
        curve = {"name": "a", "slope": None, "repetitions": [[step(1, 4), step(2, 2)], [step(3, 6), step(4, 1)]]}
        self.assertEqual(list(charts.error_series({"configurations": [curve]})), [("a (slope -)", [(2, 5, 4, 6), (3, 1.5, 1, 2)])])

    def test_the_charts_of_the_documents_can_be_made_again(self):
        if not importlib.util.find_spec("matplotlib"):
            self.skipTest("matplotlib is not installed")
        for name, words in (("report", ["Frame time", "bvh, report"]), ("denoise/glass-sphere-variance", ["Error against time", "default denoised"])):
            chart = self.folder / "chart.svg"
            charts.draw(DATA / f"{name}.json", chart)
            for word in words:
                self.assertIn(word, chart.read_text())

    def test_what_cannot_be_drawn_is_refused(self):
        (self.folder / "matplotlib.py").write_text("raise ImportError\n")
        told = subprocess.run([sys.executable, BENCH / "charts.py", "a.json", "a.svg"], capture_output=True, text=True, env={"PYTHONPATH": str(self.folder)})
        self.assertEqual((told.returncode, told.stderr), (1, "charts.py: matplotlib is not installed (Debian: python3-matplotlib; PyPI: matplotlib)\n"))
        with self.assertRaisesRegex(ValueError, "of no benchmark"):
            charts.chart_of("{}")


if __name__ == "__main__":
    main()

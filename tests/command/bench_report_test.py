#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`bench report` and `bench variants`, and the ratios that must hold on any machine."""
import json
import xml.etree.ElementTree

from support import SCENES, Case, main, run

QUICK = ["--quiet", "--rounds", "2", "--round-time", "0.001", "--resolution", "16,16"]


class Report(Case):
    def bench(self, *arguments, status=0):
        path = self.folder / "bench.json"
        result = run("bench", *arguments, "--json", path)
        self.assertEqual(result.returncode, status, result.stderr)
        return result.stdout, [json.loads(line) for line in path.read_text().splitlines()]


class BenchReport(Report):
    def test_every_row_of_the_table_is_there_with_the_reports_figure(self):
        chart = self.folder / "r.svg"
        table, lines = self.bench("report", "--scenes", SCENES, *QUICK, "--parts", "traversal,gi", "--chart", chart)
        # Trees with a draw for each sample, too.
        self.assertEqual(len(lines), 2 + 2 * 4 + 1)
        for line in lines:
            self.assertEqual((line["command"], line["schema"], line["width"]), ("report", 1, 16))
            self.assertTrue(line["picture"]["right"], line["picture"])
            self.assertIn(line["configuration"].split(", ")[-1], table)
        for text in ("226", "55", "0.66", "0.91", "0.38", "0.43", "125", "another GPU", "iterative, 62,975 / 15,743"):
            self.assertIn(text, table)
        root = xml.etree.ElementTree.fromstring(chart.read_text())
        self.assertEqual(root.tag, "{http://www.w3.org/2000/svg}svg")

    def test_options_reach_every_row_but_do_not_replace_its_own(self):
        _, lines = self.bench("report", "--scenes", SCENES, *QUICK, "--parts", "traversal", "--no-iterative", "--spp", 3,
                              "--traversal", "iterative", "--pixel-filter", "gaussian")
        self.assertEqual(len(lines), 2 * 4)
        for line in lines:
            self.assertIn("gaussian-filter", line["variant"])
            self.assertNotIn("iterative", line["variant"])
            self.assertEqual(line["frames_per_round"], 3)

    def test_what_cannot_be_done_is_refused(self):
        for options, status, says in ((["--parts", "nonsense"], 2, "nonsense"), (["--scenes", self.folder], 3, "gltf"),
                                      (["--chart", self.folder / "c.png"], 2, ".svg"), (["--noise", "0.1"], 2, "--noise"),
                                      (["--parts", "gi", "--chart", self.folder / "c.svg"], 2, "--chart"),
                                      (["--json", self.folder / "no" / "b.json"], 1, "b.json")):
            with self.subTest(options):
                scenes = [] if "--scenes" in options else ["--scenes", SCENES]
                self.fails(status, "bench", "report", *scenes, *QUICK, *options, says=[says])


class BenchVariants(Report):
    def test_what_is_turned_on_changes_no_picture(self):
        table, lines = self.bench("variants", SCENES / "sphere-plane.gltf", *QUICK, "--stage", "reflections", "--spp", 4, "--only",
                                  "alpha,vertex-colors,emissive-triangles,transmission,environment,environment-sampling,resumable,all traits")
        found = {line["configuration"]: line for line in lines}
        self.assertEqual(list(found)[0], "own variant")
        self.assertEqual(set(found) - {"own variant"},
                         {"alpha", "vertex-colors", "emissive-triangles", "environment", "resumable", "all traits"})
        for other in ("transmission                ", "environment-sampling        "):
            self.assertIn(other + " not forced: no stage", table)
        for name, line in found.items():
            self.assertTrue(line["picture"]["right"], (name, line["picture"]))
            if name not in ("emissive-triangles", "all traits"):
                self.assertLess(line["picture"]["differing_pixels"], 0.005)
            self.assertEqual(name in line["variant"], name in ("alpha", "vertex-colors", "emissive-triangles", "environment"))

    def test_lights_that_are_chosen_otherwise_give_the_same_light_by_other_samples(self):
        _, lines = self.bench("variants", SCENES / "cornell-box.gltf", *QUICK, "--spp", 16, "--only", "environment-sampling")
        self.assertTrue(lines[1]["picture"]["right"], lines[1]["picture"])
        self.assertGreater(lines[1]["picture"]["differing_pixels"], 0.5)

    def test_what_the_scene_has_is_said(self):
        table, lines = self.bench("variants", SCENES / "cornell-box.gltf", *QUICK, "--only", "triangles")
        self.assertEqual([line["configuration"] for line in lines], ["own variant"])
        self.assertIn("not forced: on in this scene", table)

    def test_what_cannot_be_done_is_refused(self):
        box = SCENES / "cornell-box.gltf"
        for options, status, says in ((["--only", "nonsense"], 2, "nonsense"), (["--time", "1"], 2, "--time"),
                                      (["--json", self.folder / "no" / "b.json"], 1, "b.json"), (["--json", box], 2, "--json")):
            with self.subTest(options):
                self.fails(status, "bench", "variants", box, *QUICK, *options, says=[says])
        self.fails(3, "bench", "variants", self.folder / "none.gltf", *QUICK, says=["none.gltf"])


class BenchSmoke(Report):
    """Ratios that hold on any machine, however busy; absolute times are not looked at."""

    def test_a_tree_is_many_times_faster_than_none(self):
        _, lines = self.bench("frame", SCENES / "mesh-15743.gltf", "--quiet", "--rounds", 3, "--round-time", 0.1, "--resolution", "64,64",
                              "--stage", "flat", "--config", "loop=--traversal iterative")
        self.assertGreater(lines[1]["ratio"]["median"], 20)

    def test_the_specialised_shader_is_faster_than_the_full_one(self):
        _, lines = self.bench("variants", SCENES / "cornell-box.gltf", "--quiet", "--rounds", 5, "--round-time", 0.1, "--resolution",
                              "64,64", "--only", "all traits")
        self.assertGreater(lines[1]["ratio"]["median"], 1.3)


if __name__ == "__main__":
    main()

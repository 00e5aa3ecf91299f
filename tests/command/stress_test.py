#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`bench stress`: no row is over its limit, and each protection that is taken out of the shader makes one fail."""
import json
import shutil

from support import BACKENDS, SCENES, Case, main, run

SHADERS = SCENES.parent / "shaders"


class Stress(Case):
    def rows(self, *options, status=0):
        """Returns the lines that the command wrote, by row."""
        path = self.folder / "stress.json"
        result = run("bench", "stress", "--quick", "--quiet", "--json", path, *options)
        self.assertEqual(result.returncode, status, result.stdout + result.stderr)
        lines = [json.loads(line) for line in path.read_text().splitlines()]
        self.assertEqual(status, int(any(line["over"] for line in lines)))
        return {line["row"]: line for line in lines}

    def mutated(self, file, before, after, *rows):
        """With a shader in which a protection is taken out, every one of these rows is over its limit."""
        folder = self.folder / "shaders"
        shutil.copytree(SHADERS, folder)
        text = (folder / file).read_text()
        self.assertIn(before, text)
        (folder / file).write_text(text.replace(before, after))
        found = self.rows("--rows", ",".join(rows), "--shader-folder", folder, status=1)
        for row in found.values():
            self.assertTrue(row["over"], row)


class StressRows(Stress):
    def test_rows_that_see_what_protects_rays(self):
        """The quick ones of StressMutations; all rows are StressAll's."""
        rows = self.rows("--rows", "rims-from-inside,boxes,shell white,shell shared")
        for row in rows.values():
            self.assertGreater(row["cases"], 100, row)
        # The fast test must fail here: this row exists to show that.
        self.assertGreater(rows["rays rims-from-inside"]["fast_failures"], 0)


class StressAll(Stress):
    def test_no_row_is_over_its_limit(self):
        self.within_limits(("egl", "megakernel"), (BACKENDS[-1], "wavefront"))

    def within_limits(self, *settings):
        for backend, schedule in settings:
            rows = self.rows("--rendering-backend", backend, "--schedule", schedule)
            self.assertGreater(len(rows), 15)
            for row in rows.values():
                # Cases are rays or pixels, where they are not whole scenes, files or trees.
                whole = row["row"].split()[0] in ("scenes", "tree", "film", "no")
                self.assertGreater(row["cases"], 0 if whole else 100, row)
                self.assertEqual(row["backend"], backend)
            # The fast test must fail here: this row exists to show that.
            self.assertGreater(rows["rays rims-from-inside"]["fast_failures"], 0)


class StressSchedules(StressAll):
    def test_no_row_is_over_its_limit(self):
        self.within_limits(("egl", "wavefront"), (BACKENDS[-1], "megakernel"))


class StressMutations(Stress):
    def test_an_edge_that_belongs_to_neither_neighbour(self):
        self.mutated("intersect.glsl", ">= 0.0f && v >= 0.0f && w >= 0.0f", "> 0.0f && v > 0.0f && w > 0.0f", "rims-from-inside")

    def test_rays_that_start_on_the_surface_itself(self):
        self.mutated("intersect.glsl", "? -error : error", "? -0.0f * error : 0.0f * error", "shell white")

    def test_insets_of_shared_meshes_that_know_nothing_of_their_instance(self):
        self.mutated("surface.glsl", "times = offsetOutOfMesh(back, error) * back.stretchBack / error", "times = 1.0", "shell shared")

    def test_slivers_at_the_depths_of_their_vertices(self):
        self.mutated("traverse.glsl", "(word & kPrimitiveSliver) != 0u", "false", "strips")

    def test_surfaces_at_the_distance_of_one_that_is_passed_through(self):
        self.mutated("traverse.glsl", "liesBehind(t, s.past, slot > s.pastSlot)", "t > s.past", "skins")


class StressRefusals(Stress):
    def test_a_row_that_is_none(self):
        self.fails(2, "bench", "stress", "--rows", "nonsense", says=["--rows", "nonsense"])


if __name__ == "__main__":
    main()

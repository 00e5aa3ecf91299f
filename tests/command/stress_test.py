#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`bench stress`: no row is over its limit, and each protection that is taken out of the shader makes one fail."""
import json
import shutil

from support import BACKENDS, SCENES, SHADERS, Case, main, run

# Protections that are taken out of the shaders: file, text, what replaces it, and the rows that see it.
MUTATIONS = {
    "an edge belongs to neither neighbour": ("intersect.glsl", ">= 0.0f && v >= 0.0f && w >= 0.0f", "> 0.0f && v > 0.0f && w > 0.0f", "rims-from-inside"),
    "rays start on the surface itself": ("intersect.glsl", "? -error : error", "? -0.0f * error : 0.0f * error", "shell white"),
    "insets of shared meshes know nothing of their instance": ("surface.glsl", "times *= offsetOutOfMesh(back, error) * back.stretchBack / error", "times = 1.0", "shell shared"),
    "slivers lie at the depths of their vertices": ("tree/leaf.glsl", "(word & kPrimitiveSliver) != 0u", "false", "strips"),
    "surfaces at the distance of one that is passed through are passed, too": ("tree/leaf.glsl", "liesBehind(t, s.tMin, slot > s.tMinSlot)", "t > s.tMin", "skins"),
}


class Stress(Case):
    def rows(self, *options, status=0):
        """Returns the lines that the command wrote, by row."""
        path = self.folder / "stress.json"
        result = run("bench", "stress", "--quick", "--quiet", "--json", path, *options)
        self.assertEqual(result.returncode, status, result.stdout + result.stderr)
        lines = [json.loads(line) for line in path.read_text().splitlines()]
        self.assertEqual(status, int(any(line["over"] for line in lines)))
        return {line["row"]: line for line in lines}

    def mutated(self, name):
        """A folder of shaders in which a protection is taken out, and the rows that see it."""
        file, before, after, *rows = MUTATIONS[name]
        folder = self.folder / name
        shutil.copytree(SHADERS, folder)
        text = (folder / file).read_text()
        self.assertIn(before, text, name)
        (folder / file).write_text(text.replace(before, after))
        return folder, rows


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
    def test_each_makes_its_rows_fail(self):
        for name in MUTATIONS:
            folder, rows = self.mutated(name)
            for row in self.rows("--rows", ",".join(rows), "--shader-folder", folder, status=1).values():
                self.assertTrue(row["over"], f"{name}: {row}")


class StressRefusals(Stress):
    def test_mutations_find_their_texts(self):
        for name in MUTATIONS:
            self.mutated(name)

    def test_a_row_that_is_none(self):
        self.fails(2, "bench", "stress", "--rows", "nonsense", says=["--rows", "nonsense"])


if __name__ == "__main__":
    main()

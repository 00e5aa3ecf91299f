#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""scripts/check_files, which scripts/lint runs, finds broken documents and files that do not belong into the root. Tables are those of their data."""
import subprocess
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader

from support import FRAGTRACE, SCENES, Case, main

SCRIPT = SCENES.parent / "scripts/check_files"
TABLE = "| a | b |\n| --- | --- |\n| `x \\| y` | 2 |\n"


def script():
    loader = SourceFileLoader("check_files", str(SCRIPT))
    module = module_from_spec(spec_from_loader("check_files", loader))
    loader.exec_module(module)
    return module


class Documents(Case):
    def faults(self, text, *more):
        (self.folder / "README.md").write_text(text)
        return list(script().faults(self.folder, ["README.md", *more]))

    def test_good_ones_pass(self):
        self.assertEqual(self.faults(f"# One `two`\n\n{TABLE}\nsee [it](README.md#one-two), [x](#one-two), [w](https://x.org/#y) |x\n"), [])

    def test_a_table_in_the_middle_of_a_sentence_is_found(self):
        text = "off by 7 eps m | `rays` | 2 |\n| `rays` | 3 |\n| `film` | 4 | over the cosine\n"
        self.assertEqual([fault.split(":")[1] for fault in self.faults(text)], ["1", "2", "2", "3", "3"])
        for broken in ("text\n" + TABLE, TABLE + "text\n", TABLE.replace("2 |", "2 | 3 |"), TABLE.replace("| --- | --- |\n", ""),
                       TABLE.replace("| 2 |", "| 2")):
            self.assertTrue(self.faults(broken), broken)

    def test_dead_links_and_anchors_are_found(self):
        for target in ("none.md", "README.md#none", "#none", "../none/"):
            self.assertEqual(self.faults(f"# One\n\na\nsee [it]({target})\n"), [f"README.md:4: {target}: no such " +
                             ("heading" if "#" in target else "file")])

    def test_long_lines_of_prose_and_shaders_are_found(self):
        wide = "word " * 25
        (self.folder / "shaders").mkdir()
        (self.folder / "shaders/x.glsl").write_text("int x;\n// " + wide + "\n")
        found = self.faults(f"# One\n\n{wide}\n\n    {wide}\n\n| {wide} |\n| --- |\n", "shaders/x.glsl")
        self.assertEqual([fault.split(" ")[0] for fault in found], ["README.md:3:", "shaders/x.glsl:2:"])

    def test_a_file_that_does_not_belong_into_the_root_is_found(self):
        found = self.faults("# One\n", "-", "src/main.cpp", "docs/x.png")
        self.assertEqual(len(found), 1)
        self.assertTrue(found[0].startswith("-: "))


class Tables(Case):
    def test_those_of_denoising_are_of_its_data(self):
        root = SCENES.parent
        document = self.folder / "denoising.md"
        document.write_text((root / "docs/design/denoising.md").read_text())

        def check():
            return subprocess.run([root / "bench/denoise_table.py", FRAGTRACE, "--out", root / "docs/design/data/denoise", "--filters", "variance,oidn",
                                   "--document", document, "--check"], capture_output=True, text=True).returncode
        self.assertEqual(document.read_text().count("<!-- denoise_table:"), 6)
        self.assertEqual(check(), 0)
        document.write_text(document.read_text().replace("0.062 (", "0.061 ("))
        self.assertEqual(check(), 1)


if __name__ == "__main__":
    main()

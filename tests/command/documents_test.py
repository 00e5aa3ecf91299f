#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""scripts/check_files, which scripts/lint runs, finds broken documents and files that do not belong into the root. Tables are those of their data."""
import re
import subprocess
import sys
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader

from support import SCENES, Case, main

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

    def test_source_files_that_are_not_there_are_found(self):
        (self.folder / "shaders").mkdir()
        (self.folder / "shaders/x.glsl").write_text("// shaders/x.glsl, as src/none.cpp packs it\n")
        found = self.faults("# One\n\n`src/NAME.cpp`, `shaders/y.glsl`\n", "shaders/x.glsl")
        self.assertEqual(found, ["README.md:3: shaders/y.glsl: no such file", "shaders/x.glsl:1: src/none.cpp: no such file"])

    def test_long_lines_of_prose_and_shaders_are_found(self):
        wide = "word " * 25
        (self.folder / "shaders").mkdir()
        (self.folder / "shaders/x.glsl").write_text("int x;\n// " + wide + "\n")
        found = self.faults(f"# One\n\n{wide}\n\n    {wide}\n\n| {wide} |\n| --- |\n", "shaders/x.glsl")
        self.assertEqual([fault.split(" ")[0] for fault in found], ["README.md:3:", "shaders/x.glsl:2:"])

    def test_long_files_are_found(self):
        for name, lines in (("a.cpp", 801), ("b.md", 801), ("c.py", 800), ("d.svg", 801)):
            (self.folder / name).write_text("x\n" * lines)
        found = self.faults("# One\n", "a.cpp", "b.md", "c.py", "d.svg")
        self.assertEqual([fault.split(" ")[0] for fault in found if "lines" in fault], ["a.cpp:", "b.md:"])

    def test_folders_that_outgrow_their_budget_are_found(self):
        for name, lines in (("src/a/x.cpp", 300), ("src/a/b/y.h", 20), ("docs/d/z.md", 100), ("src/a/x.png", 9), ("x.md", 9)):
            (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
            (self.folder / name).write_text("x\n" * lines)
        check = script()
        found = check.sizes(self.folder, ["src/a/x.cpp", "src/a/b/y.h", "docs/d/z.md", "src/a/x.png", "x.md"])
        self.assertEqual(found, {"src/a": (2, 320), "docs": (1, 100)})
        budget = check.budget_of(found)
        self.assertEqual([line.split() for line in budget.splitlines()], [["docs", "1", "110"], ["src/a", "2", "330"]])
        self.assertEqual(list(check.budget_faults(found, budget)), [])
        for size, says in (((2, 331), "raise the row"), ((3, 320), "raise the row"), ((1, 200), "lowers it")):
            faults = list(check.budget_faults({**found, "src/a": size}, budget))
            self.assertEqual((len(faults), says in faults[0]), (1, True), faults)
        self.assertIn("src/new: has 1 files of 5 lines", "".join(check.budget_faults({**found, "src/new": (1, 5)}, budget)))

    def test_names_and_switches_of_shaders_are_counted(self):
        for name, text in (("shaders/a.glsl", "const int kSize = 4;  // kNot\nbool f() { return kOn && kOn; }\n"), ("src/shader/b.cpp", 'constant("kOn");\n')):
            (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
            (self.folder / name).write_text(text)
        check = script()
        found = check.switches(self.folder, ["shaders/a.glsl", "src/shader/b.cpp"])
        self.assertEqual(found, {"shaders/k*": (2, 2)})
        self.assertIn("has 2 names and 2 uses of switches", "".join(check.budget_faults(found, "shaders/k* 1 10\n")))

    def test_a_file_that_does_not_belong_into_the_root_is_found(self):
        found = self.faults("# One\n", "-", "src/main.cpp", "docs/x.png")
        self.assertEqual(len(found), 1)
        self.assertTrue(found[0].startswith("-: "))

    def test_the_tour_names_functions_that_are_defined_there(self):
        root = SCENES.parent
        text = (root / "docs/design/tour.md").read_text()
        steps = re.findall(r"`((?:src|shaders)/[^`: ]+): (\w+)`", text)
        self.assertGreaterEqual(len(steps), 40)
        self.assertLessEqual(len(text.split()), 1500)
        for file, name in steps:
            # A definition begins in the first column: type, name, parameters, body.
            defined = re.compile(rf"^\w[^\n(=]*\b{name}\([^;{{}}]*\)[^;{{}}]*{{", re.MULTILINE)
            self.assertTrue(defined.search((root / file).read_text()), f"{file}: {name}")


class Claims(Case):
    """What documents say of numbers is what the code and the measurements say."""
    ROOT = SCENES.parent

    def test_constants_have_the_values_that_documents_give_them(self):
        code = "\n".join(path.read_text() for folder in ("src", "shaders") for path in sorted((self.ROOT / folder).rglob("*"))
                         if path.suffix in (".h", ".cpp", ".glsl"))
        claims = 0
        for page in sorted((self.ROOT / "docs").rglob("*.md")):
            for name, said in re.findall(r"`(k[A-Z]\w*)` =\s+([\d.e^-]*\d)", page.read_text()):
                values = [literal for literal in re.findall(rf"\b{name} ?[={{] ?([\w.+<: -]+)[;}},]", code)]
                self.assertTrue(values, f"{page.name}: {name}: no such constant")
                self.assertIn(self.value_of(said), [self.value_of(value) for value in values], f"{page.name}: {name} = {said}")
                claims += 1
        self.assertGreaterEqual(claims, 20)

    @staticmethod
    def value_of(literal):
        """1 << 21, 2^21, 0x1p-4 and 32u as numbers; None for what is none of these."""
        bare = re.sub(r"(?<=[\da-f.])[uf]$", "", literal.strip())
        if shift := re.fullmatch(r"1u? << (\d+)", literal.strip()):
            return 2.0 ** int(shift[1])
        if power := re.fullmatch(r"2\^(-?\d+)", bare):
            return 2.0 ** int(power[1])
        try:
            return float.fromhex(bare) if bare.startswith("0x") else float(bare)
        except ValueError:
            return None

    def test_figures_of_the_readme_are_those_of_the_pages_that_it_cites(self):
        readme = (self.ROOT / "README.md").read_text()
        pages = " ".join((self.ROOT / page).read_text() for page in ("docs/measurements/peers.md", "docs/measurements/gpu.md"))
        rows = [row for row in readme.splitlines() if row.startswith("|") and re.search(r"\d", row)]
        for figure in re.findall(r"\d+\.\d+", " ".join(rows)):
            self.assertTrue(re.search(rf"\b{re.escape(figure)}", pages), figure)
        extensions = re.findall(r"^\| (?:KHR|EXT)_", (self.ROOT / "docs/gltf.md").read_text(), re.MULTILINE)
        self.assertEqual(re.findall(r"(\d+) extensions of glTF", readme), [str(len(extensions))])


class Tables(Case):
    """Tables of measurements: bench/tables.py makes them from docs/measurements/data."""
    ROOT = SCENES.parent

    def setUp(self):
        super().setUp()
        sys.path.insert(0, str(self.ROOT / "bench"))
        import tables
        self.tables, self.document = tables, self.folder / "document.md"

    def status(self, *arguments):
        return subprocess.run([sys.executable, self.ROOT / "bench/tables.py", *arguments], capture_output=True).returncode

    def faults(self, text, data=None):
        self.document.write_text(text, encoding="utf-8")
        return self.tables.faults_of(self.document, data or self.tables.DATA, True)

    def test_all_are_of_their_data(self):
        self.assertEqual(self.status("--check"), 0)

    def test_any_other_figure_is_found_and_put_right(self):
        changed = 0
        for text in [path.read_text(encoding="utf-8") for path in sorted(self.tables.DOCUMENTS.glob("*.md"))]:
            for block in self.tables.markdown.BLOCK.finditer(text):
                figure = max(found.start() for found in re.finditer(r"\d", block[0]))
                other = block[0][:figure] + str(9 - int(block[0][figure])) + block[0][figure + 1:]
                self.assertEqual(len(self.faults(text.replace(block[0], other))), 1, block[1])
                self.assertEqual(self.tables.faults_of(self.document, self.tables.DATA, False), [])
                self.assertEqual(self.document.read_text(encoding="utf-8"), text)
                changed += 1
        self.assertGreaterEqual(changed, 8)
        self.document.write_text("<!-- table: aims -->\n<!-- end of table -->\n")
        self.assertEqual(self.status("--check", self.document), 1)

    def test_marks_without_a_table_an_end_or_data_are_found(self):
        for text, said in (("<!-- table: none -->\n<!-- end of table -->\n", "none: no such table"),
                           ("<!-- table: aims -->\n| a |\n", "do not come in pairs"),
                           ("<!-- table: aims -->\n<!-- table: aims -->\n<!-- end of table -->\n", "do not come in pairs")):
            self.assertIn(said, "".join(self.faults(text)))
        self.assertIn("aims: no data", "".join(self.faults("<!-- table: aims -->\n<!-- end of table -->\n", self.folder)))

    def test_data_without_a_mark_are_found(self):
        self.document.write_text("text\n")
        self.assertIn("no document has <!-- table: aims -->", "".join(self.tables.unshown([self.document], self.tables.DATA)))


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`cmake --install` gives a program that runs from anywhere; docs/options.md and options-bench.md, man pages, completion and the schema of --config are what `help --json` says."""
import gzip
import json
import os
import re
import shlex
import shutil
import subprocess
import sys

from support import FRAGTRACE, SCENES, Case, main, run

BUILD = FRAGTRACE.parent
SCRIPTS = SCENES.parent / "scripts"
sys.path.insert(0, str(SCRIPTS))
from option_table import Table  # noqa: E402


class Installed(Case):
    def test_it_draws_the_same_from_another_folder(self):
        prefix = self.folder / "usr"
        subprocess.run(["cmake", "--install", BUILD, "--prefix", prefix], check=True, capture_output=True)
        away = self.folder / "away"
        away.mkdir()
        options = [SCENES / "coverage.gltf", "--resolution", "16,16", "--spp", "1", "--quiet", "-o"]
        environment = {**os.environ, "PATH": f"{prefix}/bin:{os.environ['PATH']}"}
        subprocess.run(["fragtrace", "render", *options, "x.png"], cwd=away, env=environment, check=True)
        subprocess.run([FRAGTRACE, "render", *options, away / "y.png"], check=True)
        self.assertEqual((away / "x.png").read_bytes(), (away / "y.png").read_bytes())

    def test_its_folders_are_below_destdir(self):
        environment = {**os.environ, "DESTDIR": str(self.folder / "stage")}
        subprocess.run(["cmake", "--install", BUILD, "--prefix", "/usr"], check=True, capture_output=True, env=environment)
        program = self.folder / "stage/usr/bin/fragtrace"
        self.assertTrue(program.is_symlink())
        self.assertTrue(program.resolve().is_relative_to((self.folder / "stage").resolve()))
        version = subprocess.run([program, "--version"], check=True, capture_output=True, text=True).stdout
        self.assertRegex(version, r"^fragtrace \d+\.\d+\.\d+( \([0-9a-f]+(-dirty)?\))?\n$")


class OptionReference(Case):
    def test_it_is_what_the_help_says(self):
        result = subprocess.run([SCRIPTS / "option_reference", "--check", FRAGTRACE], capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)


class HelpFiles(Case):
    """The files that scripts/help_files writes."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.table = Table(FRAGTRACE)

    def written(self):
        subprocess.run([SCRIPTS / "help_files", FRAGTRACE, self.folder], check=True)
        return self.folder

    def completed(self, script, *words):
        """Returns the words that bash offers for the last word, in a folder with some files."""
        place = self.folder / "place"
        place.mkdir(exist_ok=True)
        for name in ("a scene.glb", "b.gltf", "c.png", "notes.txt"):
            (place / name).touch()
        (place / "folder").mkdir(exist_ok=True)
        # Bash makes a word of its own of each sign of equality.
        words = [part for word in words for part in re.findall(r"=|[^=]+|^$", word)]
        line = (f"source {shlex.quote(str(script))}; COMP_WORDS=({shlex.join(words)}); COMP_CWORD={len(words) - 1}; _fragtrace; "
                'printf "%s\\n" "${COMPREPLY[@]}"')
        result = subprocess.run(["bash", "--norc", "-c", line], cwd=place, check=True, capture_output=True, text=True)
        self.assertEqual(result.stderr, "")
        return result.stdout.split("\n")[:-1]

    def test_bash_completes_commands_options_values_and_files(self):
        script = self.written() / "completions/fragtrace"
        for words, expected in (
                (["ren"], ["render"]),
                (["bench", "sta"], ["start"]),
                (["render", "x.gltf", "--trav"], ["--traversal"]),
                (["render", "--traversal", "f"], ["front-to-back"]),
                (["render", "--traversal=f"], ["front-to-back"]),
                (["render", "--disable", "sobol,wat"], ["sobol,watertight"]),
                (["denoise", "--denoise", ""], ["auto", "variance", "oidn"]),
                (["bench", "start", "--format", "e"], ["exr"]),
                (["render", ""], ["folder", "a scene.glb", "b.gltf"]),
                (["render", "b.gltf", "-o", ""], ["folder", "c.png"]),
                (["diff", "n"], ["notes.txt"]),
                (["render", "b.gltf", "--shader-folder", ""], ["folder"]),
                (["render", "b.gltf", "--spp", ""], [""]),
                (["render", "b.gltf", "--quiet", "b"], ["b.gltf"])):
            self.assertEqual(sorted(self.completed(script, "fragtrace", *words)), sorted(expected), words)

    def test_each_option_is_offered(self):
        script = self.written() / "completions/fragtrace"
        for command in self.table.commands:
            offered = self.completed(script, "fragtrace", *command["name"].split(), "--")
            self.assertEqual(offered, [form for option in self.table.of(command["name"]) for form in option["forms"] if form.startswith("--")])

    def test_the_names_of_values_are_those_that_the_program_knows(self):
        named = {f"--{option['name']}": option for option in self.table.of("render") if option["choices"] and not option["other_values"]}
        self.assertGreater(len(named), 12)
        for option, entry in named.items():
            refusal = run("render", "x.gltf", "-o", "x.exr", option, "nonsense").stderr
            known = re.search(r"'nonsense' is none of (.*)\n", refusal)
            self.assertTrue(known, option + refusal)
            self.assertEqual(entry["choices"], known[1].split(", "), option)

    def test_what_names_a_file_says_so(self):
        for option in self.table.options:
            if re.search(r"\bfile\b|folder of|\.(exr|gltf)\b", option["text"]) and option["type"] == "text" and option["metavariable"] in ("TEXT", "NAME"):
                self.assertTrue("--output" in option["text"] or option["text"].startswith("name or index"), option["name"])

    def test_defaults_stand_in_the_page(self):
        page = gzip.decompress((self.written() / "man/fragtrace-render.1.gz").read_bytes()).decode()
        for default in ("default gi", "default 24", "default auto"):
            self.assertTrue(default in page, default)
        self.assertGreater(page.count("default "), 30)

    def test_each_command_has_a_page_with_all_options(self):
        folder = self.written() / "man"
        self.assertEqual(len(list(folder.iterdir())), len(self.table.commands))
        for command in self.table.commands:
            words = ["fragtrace", *command["name"].split()]
            page = gzip.decompress((folder / ("-".join(words) + ".1.gz")).read_bytes()).decode()
            self.assertIn(".SH NAME\n" + "\\-".join(words), page)
            for option in self.table.of(command["name"]):
                self.assertIn(option["forms"][-1].replace("-", "\\-"), page)

    def test_zsh_and_fish_take_their_files_and_offer_options(self):
        folder = self.written() / "completions"
        if shutil.which("zsh"):
            subprocess.run(["zsh", "-n", folder / "_fragtrace"], check=True)
        if shutil.which("fish"):
            line = f"source {shlex.quote(str(folder / 'fragtrace.fish'))}; complete -C "
            for words, word in (("fragtrace ren", "render"), ("fragtrace render --trav", "--traversal"), ("fragtrace render --traversal fro", "front-to-back"),
                                ("fragtrace bench sta", "start"), ("fragtrace bench start --star", "--starts")):
                offered = subprocess.run(["fish", "--no-config", "-c", line + shlex.quote(words)], check=True, capture_output=True, text=True).stdout
                self.assertEqual([one.split("\t")[0] for one in offered.splitlines()], [word], words)
        for name in ("_fragtrace", "fragtrace.fish"):
            text = (folder / name).read_text()
            for option in self.table.options:
                if option["forms"]:
                    self.assertTrue(f"{option['forms'][-1]}[" in text or f"-l {option['name']} " in text, (name, option["name"]))

    def test_the_schema_takes_what_the_program_takes(self):
        schema = json.loads((self.written() / "config.schema.json").read_text())
        members = schema["properties"]
        self.assertEqual({f"--{name}" for name in members if name != "$schema"},
                         {f"--{option['name']}" for option in [*self.table.of("render"), *self.table.of("view")]} - {"--help", "--config"})
        self.assertEqual(members["fit"]["type"], "boolean")
        self.assertEqual((members["exposure"]["minimum"], members["exposure"]["maximum"]), (-100, 100))
        self.assertEqual(members["traversal"]["enum"][0], "auto")
        config = self.folder / "c.json"
        config.write_text(json.dumps({"$schema": "config.schema.json", "exposure": 1, "resolution": [8, 8], "spp": 1, "traversal": "auto", "fit": True}))
        self.renders(SCENES / "coverage.gltf", "-o", self.folder / "x.png", "--config", config)


if __name__ == "__main__":
    main()

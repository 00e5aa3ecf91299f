#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Keywords as words, without the compiled module and NumPy: stand-ins name the options and the types. usage: words_test.py FRAGTRACE SOURCE_FOLDER"""
import ast
import json
import subprocess
import sys
import types
import unittest
from pathlib import Path

PROGRAM, SOURCE = sys.argv.pop(1), Path(sys.argv.pop(1)).resolve()

class UsageError(ValueError):
    pass


table = json.loads(subprocess.run([PROGRAM, "help", "render", "--json"], check=True, capture_output=True, text=True).stdout)
names = [option["name"] for option in table["options"] if option["forms"]]
LIKE = {"--samples": "--spp", "--size": "--resolution WIDTHxHEIGHT", "--formats": "--format"}
core = types.SimpleNamespace(UsageError=UsageError, option_like=lambda name: LIKE.get(name, ""), option_names=lambda: [name for name in names if name not in ("help", "output")])
numpy = types.SimpleNamespace(ndarray=type("ndarray", (), {}), generic=type("generic", (), {}), bool_=type("bool_", (int,), {}))
package = types.ModuleType("fragtrace")
package.__path__ = [str(SOURCE / "src/python/fragtrace")]
package._core = core
sys.modules.update({"numpy": numpy, "fragtrace": package, "fragtrace._core": core})
from fragtrace._words import in_python, words_of  # noqa: E402


class Keywords(unittest.TestCase):
    def test_what_only_the_command_has_is_told_where_it_is_here(self):
        for keywords, says in (({"help": True}, "help\\(fragtrace.render\\)"), ({"output": "a.png"}, "save\\(\\)"), ({"format": "png"}, "save\\(\\)"),
                               ({"quiet": True}, "messages"), ({"verbose": True}, "messages"), ({"stats": "s.json"}, "statistics"),
                               ({"frames": "0:3"}, "sequence\\(\\)"), ({"checkpoint": 3}, "go on from")):
            with self.assertRaisesRegex(UsageError, f"^{next(iter(keywords))}: .*{says}"):
                words_of("a.gltf", keywords)

    def test_another_word_is_told_the_keyword(self):
        for keyword, says in (("samples", "samples: no keyword of render\\(\\); did you mean spp\\?$"), ("size", "mean resolution\\?$"), ("formats", "render\\(\\)$")):
            with self.assertRaisesRegex(UsageError, says):
                words_of("a.gltf", {keyword: 3})
        self.assertEqual(in_python("--sample-offset: with --spp it is too large (a--b, --nothing)"), "sample_offset: with spp it is too large (a--b, --nothing)")

    def test_frames_are_text_or_a_range(self):
        for frames, word in (("0:9", "0:9"), (range(0, 10), "0:9:1"), (range(4, 10, 3), "4:7:3")):
            self.assertEqual(words_of("a.gltf", {"frames": frames}, "sequence")[1:], [f"--frames={word}"])

    def test_a_dict_is_of_options_that_begin_with_its_name(self):
        self.assertEqual(words_of("a.gltf", {"camera": {"position": (0, 1, 4)}})[1:], ["--camera-position=0,1,4"])
        self.assertEqual(words_of("a.gltf", {"camera": {}})[1:], [])
        for value in ({}, {"a": 1}):
            with self.assertRaisesRegex(UsageError, "^seed: takes no dict"):
                words_of("a.gltf", {"seed": value})

    def test_the_types_name_what_is_accepted(self):
        """Of each keyword in _types.pyi, words_of() makes an option; of no other."""
        stub = ast.parse((SOURCE / "src/python/fragtrace/_types.pyi").read_text())
        typed = {line.target.id for node in stub.body if isinstance(node, ast.ClassDef) for line in node.body}
        accepted = {"hdri", "progress"}
        for name in (name.replace("-", "_") for name in core.option_names()):
            try:
                words_of("a.gltf", {name: "1"}, "sequence")
                accepted.add(name)
            except UsageError:
                pass
        self.assertEqual(typed, accepted - {"progress"})

    def test_switches(self):
        self.assertEqual(words_of("a.gltf", {"fit": numpy.bool_(True)})[1:], ["--fit"])
        words = words_of("a.gltf", {"fit": "yes"})
        refused = subprocess.run([PROGRAM, "render", *words, "-o", "a.png"], capture_output=True, text=True)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("--fit: takes no value", refused.stderr)


if __name__ == "__main__":
    unittest.main()

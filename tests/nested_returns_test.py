#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""No function of the shaders returns from deeper than one level: nested_returns_test.py ROOT.

Mesa turns a nested return into `result = condition ? value : result`. In a loop, the other `result` is that of the round before, so the whole value
is carried round the loop: for a struct that is up to 41 registers, and most of the spills (docs/measurements/gpu.md).
"""
import re
import sys
import unittest
from pathlib import Path

ROOT = Path(sys.argv.pop(1))
TOKEN = re.compile(r"//[^\n]*|/\*.*?\*/|\n|[{}();]|\b(?:return|if|else|for|while|switch)\b", re.DOTALL)


def nested_returns(text):
    """The lines of returns that lie in more than one block or condition of their function."""
    found = []
    line, blocks, parentheses, conditions = 1, 0, 0, 0
    for token in TOKEN.findall(text):
        line += token.count("\n")
        if token in "()":
            parentheses += 1 if token == "(" else -1
        elif token == "{":
            blocks, conditions = blocks + 1, 0
        elif token == "}":
            blocks, conditions = blocks - 1, 0
        elif token == ";" and parentheses == 0:
            conditions = 0
        elif token in ("if", "else", "for", "while", "switch"):
            conditions += 1
        elif token == "return" and blocks - 1 + conditions > 1:
            found.append(line)
    return found


class NestedReturns(unittest.TestCase):
    def test_shaders_have_none(self):
        files = sorted(file for file in (ROOT / "shaders").rglob("*") if file.is_file())
        self.assertGreater(len(files), 50)
        found = [f"{file.relative_to(ROOT)}:{line}" for file in files for line in nested_returns(file.read_text())]
        self.assertEqual(found, [])

    def test_they_are_found(self):
        for body, lines in (("return a;", []), ("if (b) return a;\nreturn c;", []), ("if (b) {\n  c = 1;\n  return a;\n}", []),
                            ("if (b) {\n  if (c) return a;\n}", [3]), ("for (;;) {\n  if (c) return a;\n}", [3]), ("if (b) if (c)\n  return a;", [3]),
                            ("if (b) {\n  { return a; }\n}", [3]), ("if (b) return a;\nelse if (c) return d;", [3]),
                            ("// if (b) { if (c) return a; }\nif (b) d = 1;\nif (c) return a;", [])):
            with self.subTest(body):
                self.assertEqual(nested_returns("T f(T a) {\n" + body + "\n}\n"), lines)


if __name__ == "__main__":
    unittest.main()

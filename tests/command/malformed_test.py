#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The Khronos glTF validator's own test files: none ends the program, and those that are refused are refused for a reason that the rule of
docs/gltf.md has. Skipped where the folder is absent.

Run with FRAGTRACE_ASSETS=FOLDER for another folder of assets than /work/shared/assets."""
import json
import os
import re
import unittest
from pathlib import Path

from support import Case, main, run

FOLDER = Path(os.environ.get("FRAGTRACE_ASSETS", "/work/shared/assets")) / "malformed/gltf-validator-test"

# Animations are read where a time is asked for.
MOVED = ["--animation-time", "0"]

# Reasons to refuse a whole file: what is no glTF 2.0, a broken reference in something that is used, and the first reason where nothing is left
# to draw.
WHOLE = re.compile(r"is not glTF|is empty, not glTF|the JSON is broken|\.glb|/asset|\"asset\" is missing|is not supported|required and not supported")
REFERENCE = re.compile(r"index \d+ is past the \d+ elements of|is in a loop|is already a child of|is not a root node")
LEFT = re.compile(r"reach past|has no data|\"samplers\" is missing|is not of floats|do not fit its|does not have \d components|is past the samplers|"
                  r"is past the \d of the skin|is not affine|is not in the scene")
# How many are refused: none more.
REFUSED = 59


@unittest.skipUnless(FOLDER.is_dir(), f"{FOLDER} is absent")
class ValidatorFiles(Case):
    def test_every_file_is_loaded_or_refused_for_a_reason(self):
        reports = sorted(FOLDER.glob("**/*.report.json"))
        self.assertEqual(len(reports), 372)
        faults, refused = [], 0
        for report in reports:
            path = Path(str(report).removesuffix(".report.json"))
            result = run("info", path, *MOVED, timeout=20, errors="replace")
            lines = result.stderr.splitlines()
            refused += result.returncode == 3
            if result.returncode not in (0, 3) or (result.returncode == 3 and len(lines) != 1):
                faults.append((path, "status", result.returncode, result.stderr))
            elif result.returncode == 3 and not (f"{path}: " in lines[0] and any(kind.search(lines[0].replace(str(path), "")) for kind in (WHOLE, REFERENCE, LEFT))):
                faults.append((path, "is refused", lines[0]))
        self.assertEqual(faults, [], "\n".join(map(str, faults)))
        self.assertLessEqual(refused, REFUSED)


if __name__ == "__main__":
    main()

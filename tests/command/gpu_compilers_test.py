#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""bench/gpu/compilers: by the compilers that the committed figures name, no program takes more registers or spills more than these say."""
import subprocess
import sys
import unittest

from support import FRAGTRACE, SCENES, Case, main

ROOT = SCENES.parent
sys.path.insert(0, str(ROOT / "bench/gpu"))
import compiler_figures  # noqa: E402

LIMITS = ROOT / "docs/measurements/data/gpu-compilers.json"
SKIPPED = 77


class GpuCompilers(Case):
    def test_what_is_more_than_the_limits_is_named(self):
        limits = {"rows": {"ball": {"GA102": {"registers": 128, "spills": 0, "fills": 0, "instructions": 5}}}}
        self.assertEqual(list(compiler_figures.over(limits, limits)), [])
        worse = {"rows": {"ball": {"GA102": {"registers": 136, "spills": 0, "fills": 0, "instructions": 4}}, "new": {"GA102": {"registers": 255}}}}
        self.assertEqual(list(compiler_figures.over(worse, limits)), ["ball, GA102: 136 registers, at most 128"])

    def test_programs_stay_within_the_committed_figures(self):
        result = subprocess.run([ROOT / "bench/gpu/compilers", FRAGTRACE, "--limits", LIMITS], capture_output=True, text=True)
        if result.returncode == SKIPPED:
            raise unittest.SkipTest(result.stderr.strip())
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)


if __name__ == "__main__":
    main()

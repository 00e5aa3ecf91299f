#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A system that fails (tests/faults/failing_system.cpp), where campaigns have found something: the whole is tests/campaign/faults.py."""
import os

from support import FRAGTRACE, SCENES, SMALL, Case, main, run

BOX = SCENES / "cornell-box.gltf"


def with_fault(kind, number, *words):
    return run(*words, timeout=60, env={**os.environ, "LD_PRELOAD": str(FRAGTRACE.parent / "libfailing_system.so"), "FRAGTRACE_SYSTEM_PROGRAM": "fragtrace",
                                        "FRAGTRACE_SYSTEM_FAIL": f"{kind},{number}"})


class FailingSystem(Case):
    def out_of_memory(self, result):
        self.assertEqual((result.returncode, len(result.stderr.splitlines())), (3, 1), result.stderr)
        self.assertIn("memory", result.stderr)

    def test_an_allocation_that_fails_before_main_or_where_nothing_may_throw_is_said(self):
        """CLI11 looks for options in functions that may not throw."""
        for number in (1, 31, 53, 5787, 9023, 10116):
            with self.subTest(number):
                self.out_of_memory(with_fault("memory", number, "info", BOX))

    def test_a_shader_is_not_cut_short_where_memory_runs_out(self):
        """Streams take a lack of memory for their end; a loader of functions did not look at what it got."""
        path = self.folder / "x.pfm"
        self.renders(BOX, "-o", path, *SMALL)
        right = path.read_bytes()
        for number in range(27600, 30600, 250):
            with self.subTest(number):
                path.write_bytes(b"old")
                result = with_fault("memory", number, "render", BOX, "-o", path, *SMALL)
                if result.returncode == 0:
                    self.assertEqual(path.read_bytes(), right)
                else:
                    self.out_of_memory(result)
        path.unlink()


if __name__ == "__main__":
    main()

# SPDX-License-Identifier: MIT
"""Runs the tests of a file whose arguments are FRAGTRACE SOURCE_FOLDER [unittest arguments], and names each that is skipped, and why."""
import sys
import unittest

SKIPPED = 77  # the status that ctest takes for "skipped"


def main():
    """Ends with SKIPPED where no test was run."""
    result = unittest.main(argv=[sys.argv[0], *sys.argv[3:]], exit=False).result
    for test, reason in result.skipped:
        print(f"skipped: {test}: {reason}")
    none_run = result.skipped and result.testsRun <= len(result.skipped)
    sys.exit(1 if not result.wasSuccessful() else SKIPPED if none_run else 0)

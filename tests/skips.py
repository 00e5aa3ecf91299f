# SPDX-License-Identifier: MIT
"""Runs the tests of a file whose arguments are FRAGTRACE SOURCE_FOLDER [unittest arguments], and names each that is skipped, and why."""
import os
import sys
import unittest

SKIPPED = 77  # the status that ctest takes for "skipped"
# Set by scripts/test --extended: tests and cases that are much like others run, too.
EXTENDED = bool(os.environ.get("FRAGTRACE_EXTENDED"))
LONG = "only scripts/test --extended runs it"
at_length = unittest.skipUnless(EXTENDED, LONG)


def main():
    """Ends with SKIPPED where no test was run."""
    result = unittest.main(argv=[sys.argv[0], *sys.argv[3:]], exit=False).result
    for test, reason in result.skipped:
        if reason != LONG:
            print(f"skipped: {test}: {reason}")
    none_run = result.skipped and result.testsRun <= len(result.skipped)
    sys.exit(1 if not result.wasSuccessful() else SKIPPED if none_run else 0)

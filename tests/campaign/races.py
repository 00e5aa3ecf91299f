# SPDX-License-Identifier: MIT
"""The thread sanitizer over what works on several threads: reading files, building trees, the exchange between the viewer's threads, progress,
checkpoints. A case is one run of them in an order of its own (thread_tests of tests/CMakeLists.txt, built in build-threads). In two of three
cases locks wait at random (tests/faults/delayed_locks.cpp)."""
import os
import re

from common import Finding, Run, build_target

ASKED = {"seconds": 3600}
REPEATS = 5  # of a finding, before it counts as mended
BRIEF = False
JOBS = 2
DELAYS = (0, 100, 2000)  # microseconds at most


def prepare(ground):
    build_target(ground, "threads", "thread_tests")


def case(ground, _, number, folder):
    build = ground.source / "build-threads"
    environment = {**os.environ, "FRAGTRACE_LIBRARY_PATH": str(ground.build), "TSAN_OPTIONS": "halt_on_error=0:second_deadlock_stack=1",
                   "FRAGTRACE_LOCK_SEED": str(number), "FRAGTRACE_LOCK_DELAY": str(DELAYS[number % len(DELAYS)])}
    # The sanitizer needs addresses where it expects them.
    words = ["setarch", "-R", build / "thread_tests", "--gtest_shuffle", f"--gtest_random_seed={number % 99999 + 1}", "--gtest_brief=1"]
    with Run(words, folder, environment) as process:
        result = process.wait(1800)
    said = result.output + result.error
    if "ThreadSanitizer" in said:
        first = said.index("WARNING: ThreadSanitizer") if "WARNING: ThreadSanitizer" in said else 0
        raise Finding(f"{said.count('WARNING: ThreadSanitizer')} reports; the first: {said[first:first + 4000]}")
    if result.status != 0:
        raise Finding(f"status {result.status}: {said[-3000:]}")
    milliseconds = re.search(r"\((\d+) ms total\)", said)
    return {"seconds": int(milliseconds[1]) / 1000 if milliseconds else 0}

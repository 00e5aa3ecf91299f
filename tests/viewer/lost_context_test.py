#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The viewer comes back when the driver loses the tracing thread's context (tests/faults/failing_egl.cpp).

FRAGTRACE_LOSSES says how often in one session."""
import os
import re
import subprocess
import time

from support import FRAGTRACE, Case, main, pixels_of

MOST_SECONDS = 2.0
LOSSES = int(os.environ.get("FRAGTRACE_LOSSES", "4"))  # even, so that the key is back where it was


class LostContext(Case):
    def losing(self, again=0):
        """A viewer at rest, and the file that takes its context away."""
        libraries = subprocess.run(["/sbin/ldconfig", "-p"], capture_output=True, text=True, check=True).stdout
        trigger = self.folder / "lose"
        paths = [str(FRAGTRACE.parent / "failing_egl"), os.environ.get("LD_LIBRARY_PATH")]
        whole = dict(self.screen.environment)
        self.addCleanup(self.screen.environment.update, whole)
        self.screen.environment.update({
            "FRAGTRACE_REAL_EGL": re.search(r"libEGL\.so\.1 .*=> (\S+)", libraries).group(1),
            "FRAGTRACE_FAIL_WHEN": str(trigger), "FRAGTRACE_FAIL_AGAIN": str(again), "LD_LIBRARY_PATH": ":".join(filter(None, paths))})
        return self.view("cornell-box", "--rendering-backend", "egl", "--resolution", "320,240", "--spp", "8"), trigger

    def test_it_draws_anew_within_two_seconds_again_and_again(self):
        viewer, trigger = self.losing()
        viewer.rest()
        first = pixels_of(viewer.press_for_file("F12", ".png"))
        self.assertEqual(len(first), 320 * 240)
        for loss in range(LOSSES):
            answered = viewer.status()["answered"]
            trigger.touch()
            began = time.monotonic()
            viewer.key("m")  # another program, and with it another picture
            viewer.until(lambda s: s["answered"] > answered, "a picture of what was asked for")
            seconds = time.monotonic() - began
            print(f"from the key to a picture by another context: {seconds:.2f} s")
            self.assertLess(seconds, MOST_SECONDS)
            messages = viewer.rest()["messages"]
            self.assertIn("drawing anew", messages[-1])
            if loss == 0:
                self.assertEqual(sum("drawing anew" in m for m in messages), 1, messages)
            self.assertFalse(trigger.exists())
        self.assertEqual(pixels_of(viewer.press_for_file("F12", ".png")), first)
        self.assertEqual(viewer.close(), 0, viewer.stderr())

    def test_it_comes_back_where_the_next_context_is_lost_as_soon_as_it_is_made(self):
        viewer, trigger = self.losing(again=20)
        answered = viewer.status()["answered"]
        trigger.touch()
        viewer.key("m")
        viewer.rest(lambda s: s["answered"] > answered and s["sides"][0]["samples"] == 8, "a picture of what was asked for")
        messages = viewer.status()["messages"]
        self.assertEqual(sum("drawing anew" in m for m in messages), 2, messages)
        self.assertEqual(viewer.close(), 0, viewer.stderr())


if __name__ == "__main__":
    main()

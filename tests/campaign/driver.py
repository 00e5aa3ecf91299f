# SPDX-License-Identifier: MIT
"""A driver that fails: the n-th call of OpenGL loses the context, or does nothing and says that memory ran out, for every n of small renders
(tests/command/failing_driver_test.py, whose stand-in and checks these are). The status is 1 or 4 with one message, and the old file stays.
The viewer comes back from each loss with the same picture (tests/viewer/lost_context_test.py)."""
import subprocess

from failing_driver_test import Failing

from common import Absent, Finding, view

ASKED = {"lost contexts": 200, "failing calls": 2000, "lost contexts in the viewer": 200}
VIEWED = 50  # every so many cases the viewer
LOSSES = 20
UNITS = {"lost": "lost contexts", "memory": "failing calls"}
# Scene, options, samples.
SETTINGS = (("sphere-textured", ("--quiet",), 2), ("cornell-box", ("--quiet", "--denoise", "variance"), 2), ("caustics", ("--quiet",), 1),
            ("cornell-box", ("--quiet", "--schedule", "wavefront", "--traversal", "front-to-back"), 2), ("cornell-box", ("--quiet", "--noise", "0.5"), 64))
STEP = 37  # so that calls far apart follow each other


class Render(Failing):
    def runTest(self):
        """Is called by nobody; unittest asks for it."""


def opened(setting):
    render = Render()
    render.setUp()
    render.scene, render.options, render.samples = setting
    return render


def prepare(ground):
    """The calls of each setting, and the right picture."""
    if not (ground.build / "failing_egl").is_dir():
        raise Absent("failing_egl is not built")
    made = []
    for setting in SETTINGS[:1] if ground.brief else SETTINGS:
        render = opened(setting)
        try:
            made.append((setting, render.calls("memory"), render.right))
        finally:
            render.doCleanups()
    return made


def case(ground, made, number, folder):
    """Draws each of the c calls of a setting once, since c and the step have no common divisor, or nearly all."""
    if number % VIEWED == 0 and not ground.brief:
        seen = view(ground, ("lost_context_test.py", "LostContext"), folder, 600, losses=LOSSES)
        return {"lost contexts in the viewer": LOSSES if seen else 0}
    kind = ("lost", "memory")[number % 2]
    setting, calls, right = made[number // 2 % len(made)]
    call = number // 2 // len(made) * STEP % len(calls) + 1
    render = opened(setting)
    render.right = right
    try:
        render.fail_one(kind, call, calls)
    except (AssertionError, subprocess.TimeoutExpired) as error:
        raise Finding(f"{' '.join(map(str, setting[:2]))}: {kind}, call {call}, {calls[call - 1]}: {error}") from None
    finally:
        render.doCleanups()
    return {UNITS[kind]: 1}

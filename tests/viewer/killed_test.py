#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Signals at random moments while the viewer writes a picture, an image of the film, or the model. Each file is then whole, and at most one part
of each is left, which the next writing removes.

FRAGTRACE_KILLS and FRAGTRACE_KILLS_SEED say how many, and which. Every second one delays and shortens the program's own writes."""
import os
import random
import shutil
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path

from material_test import PANEL, WHY_NOT, portal_for, write_over
from support import FRAGTRACE, SCENES, Case, main, wait_for

sys.path.append(str(Path(__file__).resolve().parent.parent / "campaign"))
from common import check_whole, parts_in  # noqa: E402
from kills import HELD, SIGNALS  # noqa: E402

KILLS = int(os.environ.get("FRAGTRACE_KILLS", "4"))
SEED = int(os.environ.get("FRAGTRACE_KILLS_SEED", "1"))
KINDS = {"png": "F12", "exr": "shift+F12", "gltf": None}
SET = "/materials/0/pbrMetallicRoughness/roughnessFactor=0.5"
MOMENTS = 0.2  # seconds after the key
WRITING = 0.05  # seconds after a part is seen, where writing is delayed
DELAY = 10000  # microseconds


class Killed(Case):
    def start(self, folder, delay=None):
        environment = dict(self.environment)
        if delay is not None:
            environment |= {"LD_PRELOAD": str(FRAGTRACE.parent / "libfailing_system.so"), "FRAGTRACE_SYSTEM_DELAY": f"{delay},{DELAY}"}
        self.folder = folder
        (folder / "status.json").unlink(missing_ok=True)
        # Keys would go to the window of the one that ended.
        search = ["xdotool", "search", "--onlyvisible", "--name", "^fragtrace"]
        wait_for(lambda: subprocess.run(search, env=self.screen.environment, capture_output=True).returncode, 20, "the last window is still there")
        return self.view(folder / "scene.gltf", *PANEL, "--set", SET, environment=environment)

    def ask(self, viewer, kind):
        """Presses the keys after which that kind of file is written."""
        if kind == "gltf":
            write_over(viewer, self.portal, self.folder / "scene.gltf")
        else:
            viewer.key(KINDS[kind])

    def names(self, folder, kind):
        return {path.name for path in folder.glob("*." + kind)}

    def parts(self, folder):
        return {part for part in parts_in(os.listdir(folder)) if not part.startswith(".status.json.")}

    def write(self, viewer, folder, kind):
        """The bytes that an unbroken writing leaves."""
        before, old = self.names(folder, kind), (folder / "scene.gltf").read_bytes()
        self.ask(viewer, kind)
        if kind == "gltf":
            viewer.rest(lambda s: not s["set"], "read again")
            self.assertNotEqual((folder / "scene.gltf").read_bytes(), old)
        else:
            viewer.wait(lambda: self.names(folder, kind) - before, 60, "the file")
        viewer.process.kill()
        viewer.end()

    def is_whole(self, folder, kind, models):
        for name in self.names(folder, kind) - {"scene.gltf"}:
            check_whole(name, (folder / name).read_bytes())
        self.assertIn((folder / "scene.gltf").read_bytes(), models)
        for path in (folder / "status.json", *folder.glob("state/fragtrace/viewer.json")):
            check_whole(path.name, path.read_bytes())

    def killed(self, number, dice, models):
        folder = self.place / str(number)
        folder.mkdir()
        (folder / "scene.gltf").write_bytes(models[0])
        which, kind = dice.choice(SIGNALS), dice.choice(sorted(KINDS))
        says = f"seed {SEED}, {number}: {which.name} while it writes .{kind}"
        viewer = self.start(folder, number if number % 2 else None)
        self.ask(viewer, kind)
        seen = self.names(folder, kind)
        deadline = time.monotonic() + dice.random() * MOMENTS
        while time.monotonic() < deadline:
            if number % 2 and (self.parts(folder) or self.names(folder, kind) != seen):
                time.sleep(dice.random() * WRITING)
                break
        viewer.process.send_signal(which)
        if which == signal.SIGSTOP:
            time.sleep(HELD)
            viewer.process.send_signal(signal.SIGCONT)
            viewer.rest()
            viewer.process.terminate()
        self.assertEqual(viewer.end(), -signal.SIGKILL if which == signal.SIGKILL else 130, says + viewer.stderr())
        parts = self.parts(folder)
        self.assertLessEqual(len(parts), 1 if which == signal.SIGKILL else 0, says)
        self.is_whole(folder, kind, models)
        if parts:
            self.write(self.start(folder), folder, kind)
            self.assertEqual(self.parts(folder), set(), says)
            self.is_whole(folder, kind, models)

    @unittest.skipIf(WHY_NOT, WHY_NOT)
    def test_all_files_are_whole(self):
        self.portal, self.environment = portal_for(self)
        dice = random.Random(SEED)
        self.place = self.folder
        first = self.place / "first"
        first.mkdir()
        shutil.copy(SCENES / "plastics.gltf", first / "scene.gltf")
        models = [(first / "scene.gltf").read_bytes()]
        self.write(self.start(first), first, "gltf")
        models.append((first / "scene.gltf").read_bytes())
        for k in range(KILLS):
            self.killed(SEED * 1000 + k, dice, models)


if __name__ == "__main__":
    main()

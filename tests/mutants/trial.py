# SPDX-License-Identifier: MIT
"""One fault, or none, in a folder of its own: the shaders, and a program that draws with them."""
import os
import shutil
import subprocess
import time
from pathlib import Path

from made import put_in
from suite import pure_tests

PROGRAM = Path(__file__).resolve().parent / "fragtrace"


class Trial:
    def __init__(self, setting, fault):
        self.setting, self.fault = setting, fault
        self.folder = setting.folder / (fault.name.replace(" ", "-") if fault else "no-fault")

    def __enter__(self):
        shutil.rmtree(self.folder, ignore_errors=True)
        shaders = self.folder / "shaders"
        shutil.copytree(self.setting.source / "shaders", shaders)
        if self.fault:
            path = shaders / self.fault.file
            path.write_text(put_in(self.fault, path.read_text()))
            # The driver parses all of the text whatever is drawn.
            result = self.run([PROGRAM, "render", self.setting.source / "scenes/sphere-black.gltf", "-o", self.folder / "x.pfm", "--stage", "flat",
                               "--resolution", "8,8", "--spp", "1", "--quiet"])
            self.refused = "compile" in result.stdout and result.returncode != 0
        return self

    def __exit__(self, *_):
        shutil.rmtree(self.folder, ignore_errors=True)

    def run(self, command):
        environment = os.environ | {"MESA_SHADER_CACHE_DISABLE": "true", "TMPDIR": str(self.folder), "GTEST_FAIL_FAST": "1",
                                    "FRAGTRACE_LIBRARY_PATH": str(self.setting.build), "MUTANT_PROGRAM": str(self.setting.program),
                                    "MUTANT_SHADERS": str(self.folder / "shaders")}
        return subprocess.run(list(map(str, command)), cwd=self.setting.build, env=environment, timeout=1800, text=True, errors="replace",
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def tests(self):
        """Names of all tests that could see the fault."""
        return list(self.setting.drawing) + (pure_tests(self.setting.source, self.fault) if self.fault else [])

    def passes(self, test):
        """Runs the test. Returns whether it passes, and how long it took."""
        began = time.monotonic()
        if test.startswith("pure."):
            command = [self.setting.compiler.make(test.removeprefix("pure."), self.folder)]
        else:
            ours = {str(self.setting.program): str(PROGRAM), str(self.setting.build / "picture_tests"): str(self.folder / "pictures")}
            command = [ours.get(word, word) for word in self.setting.drawing[test]]
            command += ["-f"] if test.startswith("command.") else []
        result = self.run(command)
        (self.folder / "last.log").write_text(result.stdout)
        return result.returncode == 0, time.monotonic() - began

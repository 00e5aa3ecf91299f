#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""made_files_test.py FRAGTRACE SOURCE_FOLDER: the small files of made_files.py are loaded or refused as they expect.

With FRAGTRACE_NODE_MODULES, a folder in which `npm install gltf-validator` was run, the Khronos validator is asked, too, whether they are valid.
"""
import os
import subprocess
import unittest
from pathlib import Path

from made_files import FEATURES, made_files, write
from support import Case, main, run

VALIDATE = """
const validator = require(process.argv[1]), fs = require('fs');
(async () => {
  for (const file of process.argv.slice(2)) {
    const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)));
    console.log(report.issues.numErrors);
  }
})();
"""


class MadeFiles(Case):
    def test_each_is_loaded_or_refused_as_it_expects(self):
        write(self.folder)
        for name, root, expected in made_files():
            with self.subTest(name):
                path = self.folder / (name.replace(" ", "_") + ".gltf")
                result = run("info", path, *(["--animation-time", "0.5"] if "animations" in root else []))
                lines = result.stderr.splitlines()
                self.assertEqual(result.returncode, expected["status"], result.stderr)
                self.assertEqual(len(lines), 0 if expected["valid"] else 1, lines)
                for line in lines:
                    self.assertIn(path.name, line)
                    self.assertIn(expected["says"], line)

    def test_each_feature_is_drawn(self):
        for name, root, expected in made_files():
            if name not in FEATURES:
                continue
            with self.subTest(name):
                path = self.written("scene.gltf", root)
                result = run("render", path, "--output", self.folder / "picture.pfm", "--resolution", "8,8", "--spp", "1", "--quiet")
                self.assertEqual((result.returncode, result.stderr), (0, ""))

    @unittest.skipUnless("FRAGTRACE_NODE_MODULES" in os.environ, "FRAGTRACE_NODE_MODULES names no folder with gltf-validator")
    def test_the_khronos_validator_agrees(self):
        write(self.folder)
        files = [(self.folder / (name.replace(" ", "_") + ".gltf"), expected) for name, _, expected in made_files()]
        module = Path(os.environ["FRAGTRACE_NODE_MODULES"]) / "node_modules" / "gltf-validator"
        result = subprocess.run(["node", "-e", VALIDATE, module, *(path for path, _ in files)], capture_output=True, text=True, check=True)
        errors = list(map(int, result.stdout.split()))
        self.assertEqual(len(errors), len(files))
        for (path, expected), count in zip(files, errors):
            self.assertEqual(count == 0, expected["valid"], path)


if __name__ == "__main__":
    main()

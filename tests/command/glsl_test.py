#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Each text that the picture tests hand to the driver is right by another compiler, too: glslangValidator. Mesa writes them where MESA_SHADER_CAPTURE_PATH says."""
import json
import os
import shutil
import subprocess
import sys
import unittest

from support import FRAGTRACE, SCENES, Case, main

REFERENCES = SCENES.parent / "tests/reference/references.json"
sys.path.insert(0, str(SCENES.parent / "bench"))
from shader_texts import FILE_ENDINGS, captured  # noqa: E402


@unittest.skipUnless(shutil.which("glslangValidator"), "glslangValidator is not installed")
class GlslangValidator(Case):
    def texts_of(self, reference, *options):
        """Returns kind and text of each shader of a reference's picture."""
        folder = self.folder / "captured"
        folder.mkdir()
        subprocess.run([FRAGTRACE, "render", SCENES / (reference["scene"] + ".gltf"), "--stage", reference["stage"], *reference["options"], "--quiet",
                        "--resolution", "8,8", "--spp", "1", *options, "-o", self.folder / "x.pfm"], check=True, cwd=SCENES.parent,
                       env={**os.environ, "MESA_SHADER_CAPTURE_PATH": str(folder)})
        texts = captured(folder)
        shutil.rmtree(folder)
        return texts

    def test_it_takes_the_texts_of_all_references(self):
        texts = set()
        for reference in json.loads(REFERENCES.read_text())["references"]:
            for schedule in ("megakernel", "wavefront"):
                found = self.texts_of(reference, "--schedule", schedule)
                self.assertTrue(found, reference["name"])
                texts |= found
        self.assertGreater(len(texts), 50)
        texts |= self.texts_of({"scene": "room-ball", "stage": "gi", "options": ["--count-work", "--stats", self.folder / "s"]}, "--schedule", "wavefront")
        for kind, text in texts:
            file = self.folder / ("text." + FILE_ENDINGS[kind])
            file.write_text(text)
            result = subprocess.run(["glslangValidator", file], capture_output=True, text=True, check=False)
            self.assertEqual(result.returncode, 0, result.stdout + "\n".join(f"{i + 1} {line}" for i, line in enumerate(text.splitlines())))


if __name__ == "__main__":
    main()

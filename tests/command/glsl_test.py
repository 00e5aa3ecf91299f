#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Each text that the picture tests hand to the driver is right by another compiler, too: glslangValidator. Mesa writes them where MESA_SHADER_CAPTURE_PATH says."""
import json
import os
import re
import shutil
import subprocess
import unittest

from support import FRAGTRACE, SCENES, Case, main

REFERENCES = SCENES.parent / "tests/reference/references.json"
KINDS = {"vertex": "vert", "fragment": "frag", "compute": "comp"}


@unittest.skipUnless(shutil.which("glslangValidator"), "glslangValidator is not installed")
class GlslangValidator(Case):
    def captured(self, reference, schedule):
        """The texts of a reference's picture: kind and text."""
        folder = self.folder / "captured"
        folder.mkdir()
        subprocess.run([FRAGTRACE, "render", SCENES / (reference["scene"] + ".gltf"), "--stage", reference["stage"], *reference["options"], "--quiet",
                        "--resolution", "8,8", "--spp", "1", "--schedule", schedule, "-o", self.folder / "x.pfm"], check=True,
                       env={**os.environ, "MESA_SHADER_CAPTURE_PATH": str(folder)})
        texts = set()
        for file in folder.iterdir():
            for kind, text in re.findall(r"^\[(\w+) shader\]\n(.*?)(?=^\[|\Z)", file.read_text(), re.MULTILINE | re.DOTALL):
                # glslangValidator has no names of files in #line (GL_ARB_shading_language_include).
                texts.add((kind, re.sub(r'^(#line \d+) ".*"$', r"\1", text, flags=re.MULTILINE).rstrip("\n") + "\n"))
        shutil.rmtree(folder)
        return texts

    def test_it_takes_the_texts_of_all_references(self):
        texts = set()
        for reference in json.loads(REFERENCES.read_text())["references"]:
            for schedule in ("megakernel", "wavefront"):
                found = self.captured(reference, schedule)
                self.assertTrue(found, reference["name"])
                texts |= found
        self.assertGreater(len(texts), 50)
        for kind, text in texts:
            file = self.folder / ("text." + KINDS[kind])
            file.write_text(text)
            result = subprocess.run(["glslangValidator", file], capture_output=True, text=True, check=False)
            self.assertEqual(result.returncode, 0, result.stdout + "\n".join(f"{i + 1} {line}" for i, line in enumerate(text.splitlines())))


if __name__ == "__main__":
    main()

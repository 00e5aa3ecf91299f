#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""KTX2 textures of KHR_texture_basisu: drawn where the codec was built, and said where it is missing. Their texels are compared in
tests/pure/image_ktx2_test.cpp."""
import json
import os
import shutil
import subprocess
import unittest
from pathlib import Path

from support import FRAGTRACE, Case, main, png, quad, read_pfm, run

SAMPLES = Path(__file__).resolve().parent.parent / "ktx2"
MODULE = "libfragtrace_ktx2.so"
has_codec = unittest.skipUnless((FRAGTRACE.parent / MODULE).exists(), "built without the codec of KTX2 (scripts/setup ktx2)")
WITHOUT = f"wood.ktx2: KTX2 cannot be decoded: {MODULE} is not in "
SMALL = ("--resolution", "9,9", "--spp", 4, "--stage", "flat")


class Ktx2(Case):
    def scene(self, required=True, fallback=False, name="basisu_uastc"):
        """A quad with a texture of that sample; the fallback is green."""
        gltf = quad({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}})
        shutil.copy(SAMPLES / f"{name}.ktx2", self.folder / "wood.ktx2")
        (self.folder / "green.png").write_bytes(png(1, 1, [0, 255, 0, 255]))
        gltf["images"] = [{"uri": "wood.ktx2"}, {"uri": "green.png"}]
        gltf["textures"] = [{"extensions": {"KHR_texture_basisu": {"source": 0}}, **({"source": 1} if fallback else {})}]
        gltf["extensionsUsed"] = ["KHR_texture_basisu"]
        if required:
            gltf["extensionsRequired"] = ["KHR_texture_basisu"]
        return self.written("scene.gltf", gltf)

    def run_without_codec(self, *arguments):
        """Runs a copy of the program that has only its worker and the module for pictures."""
        folder = self.folder / "program"
        if not folder.exists():
            folder.mkdir()
            for name in ("fragtrace", "fragtrace_worker", "libfragtrace_pictures.so"):
                shutil.copy(FRAGTRACE.parent / name, folder)
        environment = {k: v for k, v in os.environ.items() if k != "FRAGTRACE_LIBRARY_PATH"}
        return subprocess.run([folder / "fragtrace", *map(str, arguments)], capture_output=True, text=True, env=environment)

    def middle(self, scene, *options, program=run):
        path = self.folder / "x.pfm"
        result = program("render", scene, "-o", path, *SMALL, *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return read_pfm(path)[4][4], result.stderr

    def test_without_the_codec_the_texture_of_a_file_that_requires_it_is_missing(self):
        result = self.run_without_codec("info", self.scene(), "--missing-textures", "refuse")
        self.assertEqual(result.returncode, 3, result.stdout)
        for text in ("scene.gltf: /images/0: " + WITHOUT, "`scripts/setup ktx2`", "`gltf-transform ktxdecompress IN OUT`", "(--missing-textures magenta"):
            self.assertIn(text, result.stderr)
        color, said = self.middle(self.scene(), program=self.run_without_codec)
        self.assertEqual(color, (1, 0, 1))
        self.assertIn(WITHOUT, said)

    def test_without_the_codec_a_file_that_does_not_require_it_is_drawn_without_the_texture(self):
        color, said = self.middle(self.scene(required=False), program=self.run_without_codec)
        self.assertEqual(color, (1, 1, 1))
        self.assertIn(f"/textures/0/extensions/KHR_texture_basisu: is left out: KTX2 cannot be decoded: {MODULE} is not in", said)
        self.assertIn("`scripts/setup ktx2`", said)

    def test_the_fallback_is_drawn_and_nothing_is_said(self):
        for required, program in ((False, self.run_without_codec), (True, self.run_without_codec), (False, run)):
            color, said = self.middle(self.scene(required, fallback=True), program=program)
            self.assertEqual(color, (0, 1, 0))
            self.assertNotIn("ktx2", said.lower())
            self.assertNotIn("KHR_texture_basisu", said)

    @has_codec
    def test_it_is_drawn_and_counted(self):
        for required in (False, True):
            # The colour is half of red and of green, in sRGB.
            (red, green, blue), said = self.middle(self.scene(required))
            self.assertNotIn("ktx2", said.lower())
            self.assertAlmostEqual(red, 0.21, delta=0.05)
            self.assertAlmostEqual(green, 0.21, delta=0.05)
            self.assertLess(blue, 0.4)
        scene = json.loads(run("info", "--json", "--decode", self.scene()).stdout)["scene"]
        self.assertEqual((scene["textures"], scene["images"]), (1, 1))

    @has_codec
    def test_it_is_drawn_where_the_fallback_is_missing(self):
        scene = self.scene(required=False, fallback=True)
        (self.folder / "green.png").unlink()
        (red, green, _), said = self.middle(scene)
        self.assertAlmostEqual(red, green, delta=0.05)
        self.assertIn('/images/1: "green.png" is missing; the KTX2 picture beside it is drawn', said)
        for gone, program in ((None, self.run_without_codec), ("wood.ktx2", run)):
            if gone:
                (self.folder / gone).unlink()
            result = program("info", scene, "--missing-textures", "refuse")
            self.assertEqual(result.returncode, 3)
            self.assertIn("green.png cannot be opened", result.stderr)

    @has_codec
    def test_a_broken_one_is_named_by_file_and_by_place(self):
        scene = self.scene(name="basisu_uastc_zstd_alpha")
        whole = (self.folder / "wood.ktx2").read_bytes()
        cube = whole[:36] + b"\6" + whole[37:]
        noise = whole[:-200] + bytes((i * 151 + 77) % 256 for i in range(200))
        for data, reason in ((cube, "it is a cube map"), (whole[:-30], "the file is truncated"), (noise, "its level 0 is broken")):
            (self.folder / "wood.ktx2").write_bytes(data)
            self.fails(3, "info", scene, "--decode", "--missing-textures", "refuse", says=["wood.ktx2", "scene.gltf: /images/0", reason])

    def test_a_codec_that_crashes_is_named(self):
        (self.folder / "fragtrace_worker").write_text("#!/bin/sh\nkill -SEGV $$")
        (self.folder / "fragtrace_worker").chmod(0o755)
        (self.folder / MODULE).touch()
        self.fails(3, "info", self.scene(), "--decode", "--missing-textures", "refuse", says=["wood.ktx2: KTX2 cannot be decoded: the codec of KTX2 textures failed", "signal 11"],
                   env={**os.environ, "FRAGTRACE_LIBRARY_PATH": str(self.folder)})

    def test_it_is_no_environment(self):
        shutil.copy(SAMPLES / "basisu_uastc.ktx2", self.folder)
        self.fails(3, "render", self.scene(fallback=True), "-o", self.folder / "x.pfm", *SMALL, "--quiet", "--hdri-file", self.folder / "basisu_uastc.ktx2",
                   says=["basisu_uastc.ktx2: a KTX2 or AVIF picture is read as a texture only"])


if __name__ == "__main__":
    main()

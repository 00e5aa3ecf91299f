#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Textures whose picture is missing or broken: drawn without and said, or refused (--missing-textures)."""
import json
import struct
import zlib

from support import Case, main, png, quad, read_pfm, run

REFUSE = ("--missing-textures", "refuse")


def wrong_png():
    """Checksums are right, but the pixels are no stream of zlib."""
    whole = png(4, 4, [10, 200, 10, 255] * 16)
    at = whole.index(b"IDAT")
    length = struct.unpack(">I", whole[at - 4:at])[0]
    content = b"IDAT" + bytes(length)
    return whole[:at] + content + struct.pack(">I", zlib.crc32(content)) + whole[at + 8 + length:]


class MissingTextures(Case):
    def scene(self, material, uris):
        gltf = quad(material)
        gltf["images"] = [{"uri": uri} for uri in uris]
        gltf["textures"] = [{"source": i} for i in range(len(uris))]
        return self.written("scene.gltf", gltf)

    def middle(self, scene, stage="flat"):
        path = self.folder / "x.pfm"
        result = run("render", scene, "-o", path, "--resolution", "9,9", "--spp", 4, "--stage", stage)
        self.assertEqual(result.returncode, 0, result.stderr)
        return read_pfm(path)[4][4], result.stderr

    BASE = {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}

    def test_a_base_colour_is_magenta_and_said_once(self):
        whole = png(4, 4, [10, 200, 10, 255] * 16)
        (self.folder / "cut.png").write_bytes(whole[:-30])
        (self.folder / "odd.png").write_text("no picture")
        for name, reason in (("gone.png", "cannot be opened"), ("cut.png", ""), ("odd.png", "")):
            scene = self.scene(self.BASE, [name, name])
            refused = run("render", scene, "-o", self.folder / "y.pfm", "--resolution", "9,9", "--spp", 1, *REFUSE)
            self.assertEqual(refused.returncode, 3, name)
            self.assertFalse((self.folder / "y.pfm").exists())
            color, said = self.middle(scene)
            self.assertEqual(color, (1, 0, 1), name)
            self.assertEqual(said.count(name), 1, said)
            self.assertIn(reason, said)
            info = run("info", scene)
            self.assertEqual(info.returncode, 0)
            self.assertIn(name, info.stderr + info.stdout)

    def test_what_is_broken_is_named_by_file_and_by_place(self):
        whole = png(4, 4, [10, 200, 10, 255] * 16)
        webp = b"RIFF\x20\0\0\0WEBPVP8 \x14\0\0\0\x30\x01\0\x9d\x01\x2a\x04\0\x04\0" + bytes(10)
        for name, data in (("head.png", whole[:20]), ("cut.png", whole[:-30]), ("odd.png", b"no picture"), ("cut.webp", webp)):
            (self.folder / name).write_bytes(data)
            self.fails(3, "render", self.scene(self.BASE, [name]), "-o", self.folder / "y.pfm", "--resolution", "9,9", "--spp", 1, "--quiet", *REFUSE,
                       says=[name, "scene.gltf: /images/0"])
            self.fails(3, "info", self.scene(self.BASE, [name]), "--decode", *REFUSE, says=[name, "scene.gltf: /images/0"])

    def test_a_damaged_picture_is_magenta(self):
        """The bytes of a PNG without their checksum and with it, pixels of a JPEG and of a WebP: seen when they are drawn."""
        whole = bytearray(png(4, 4, [10, 200, 10, 255] * 16))
        whole[50] ^= 0x40
        jpeg = (b"\xff\xd8\xff\xc0\0\x0b\x08\0\x04\0\x04\x01\x01\x11\0\xff\xda\0\x08\x01\x01\0\0\x3f\0" + bytes(9) + b"\xff\xd9")
        webp = b"RIFF\x20\0\0\0WEBPVP8 \x14\0\0\0\x30\x01\0\x9d\x01\x2a\x04\0\x04\0" + bytes(10)
        shining = {"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0}, "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0}}
        green = {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "baseColorFactor": [0, 1, 0, 1]}}
        for name, data in (("bad.png", bytes(whole)), ("sums.png", wrong_png()), ("bad.jpg", jpeg), ("bad.webp", webp)):
            (self.folder / name).write_bytes(data)
            for material, stage in ((shining, "phong"), (green, "flat"), (self.BASE, "flat")):
                scene = self.scene(material, [name])
                color, said = self.middle(scene, stage)
                if material == shining:
                    self.assertLess(max(color), 0.5)  # what the studio's light leaves of it
                else:
                    self.assertEqual(color, (1, 0, 1), said)
                self.assertEqual(said.count(name), 1, said)
                self.assertIn("scene.gltf: /images/0", said)
                self.assertIn("; a base colour is drawn in magenta, other textures are left out", said)
            for options, status in (((), 0), (("--strict",), 3), (REFUSE, 3)):
                info = run("info", scene, "--decode", *options)
                self.assertEqual(info.returncode, status, info.stderr)
                self.assertIn(name, info.stderr)
                self.assertEqual(run("render", scene, "-o", self.folder / "y.pfm", "--resolution", "9,9", "--spp", 1, *options).returncode, status)

    def test_all_that_is_missing_is_named_at_once(self):
        scene = self.scene({**self.BASE, "normalTexture": {"index": 1}, "emissiveTexture": {"index": 2}}, ["a.png", "b.png", "maps/c.png"])
        _, said = self.middle(scene)
        self.assertIn("/images/0/uri: a.png, b.png, maps/c.png cannot be opened: No such file", said)
        self.fails(3, "info", scene, *REFUSE, says=["/images/0/uri: ", "a.png cannot be opened", "; also missing: b.png, maps/c.png"])
        root = json.loads(scene.read_text())
        root["buffers"][0]["uri"] = "data.bin"
        scene.write_text(json.dumps(root))
        self.fails(3, "info", scene, says=["/buffers/0/uri: ", "data.bin cannot be opened", "; also missing: a.png, b.png, maps/c.png"])

    def test_one_outside_of_the_folder_is_refused(self):
        self.fails(3, "info", self.scene(self.BASE, ["../gone.png"]), says=["/images/0/uri: ", "leads out of the scene's folder"])

    def test_one_that_is_there_is_drawn(self):
        (self.folder / "there.png").write_bytes(png(4, 4, [0, 255, 0, 255] * 16))
        color, said = self.middle(self.scene(self.BASE, ["there.png"]))
        self.assertEqual(color, (0, 1, 0))
        self.assertNotIn("there.png", said)

    def test_a_lamp_does_not_shine(self):
        material = {"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0},
                    "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0}}
        color, _ = self.middle(self.scene(material, ["gone.png"]))
        self.assertEqual(color, (0, 0, 0))

    def test_a_choice_that_is_none_is_refused(self):
        result = run("info", self.scene(self.BASE, ["gone.png"]), "--missing-textures", "maybe")
        self.assertEqual(result.returncode, 2)


if __name__ == "__main__":
    main()

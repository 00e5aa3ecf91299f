#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Pictures and coordinates of textures: AVIF (EXT_texture_avif), and any set of coordinates."""
import base64
import json
import struct

from support import SQUARE, TWO_TRIANGLES, Case, Gltf, data_uri, main, png, read_pfm, run

# 16 x 16, without loss, by libheif: the left half red, the right one blue with alpha 128.
AVIF = base64.b64decode(
    "AAAAHGZ0eXBhdmlmAAAAAGF2aWZtaWYxbWlhZgAAAZhtZXRhAAAAAAAAACFoZGxyAAAAAAAAAABwaWN0AAAAAAAAAAAAAAAAAAAAAA5waXRtAAAAAAABAAAANGlsb2MAAAAAREAAAgACAAAAAAG8AAEAAAAAAAAA"
    "FQABAAAAAAHRAAEAAAAAAAAAHwAAADhpaW5mAAAAAAACAAAAFWluZmUCAAAAAAEAAGF2MDEAAAAAFWluZmUCAAAAAAIAAGF2MDEAAAAA12lwcnAAAACxaXBjbwAAABNjb2xybmNseAACAAIABoAAAAAMYXYxQ4EA"
    "HAAAAAAUaXNwZQAAAAAAAAAQAAAAEAAAAA5waXhpAAAAAAEIAAAAOGF1eEMAAAAAdXJuOm1wZWc6bXBlZ0I6Y2ljcDpzeXN0ZW1zOmF1eGlsaWFyeTphbHBoYQAAAAAMYXYxQ4EADAAAAAAUaXNwZQAAAAAAAAAQ"
    "AAAAEAAAABBwaXhpAAAAAAMICAgAAAAeaXBtYQAAAAAAAAACAAEEgYYHiAACBIIDhIUAAAAaaXJlZgAAAAAAAAAOYXV4bAACAAEAAQAAADxtZGF0EgAKBRgM/9hUMgpEAACMqqhVK6aAEgAKCRgM/9ggQEDQgDIQ"
    "RAAAhsVpr/iPfFOIKWSGMA==")


class TextureSources(Case):
    def scene(self, picture, texture=None, sets=1, materials=None, kind="image/png"):
        """A square from -1 to 1 with a texture. Coordinates of the last set lie in the picture's right half, others in the left one."""
        gltf = Gltf()
        attributes = {"POSITION": gltf.accessor(SQUARE)}
        for i in range(sets):
            last = sets > 1 and i == sets - 1
            attributes[f"TEXCOORD_{i}"] = gltf.accessor([(0.75 if last else 0.25, 0.5)] * 4 if sets > 1 else [(0, 1), (1, 1), (1, 0), (0, 0)])
        indices = gltf.accessor(TWO_TRIANGLES, "H")
        gltf.root["meshes"] = [{"primitives": [{"attributes": attributes, "indices": indices, "material": 0}]}]
        gltf.root["nodes"] = [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 2]}]
        gltf.root["cameras"] = [{"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0.1, "zfar": 9}}]
        gltf.root["scenes"] = [{"nodes": [0, 1]}]
        gltf.root["images"] = [{"uri": data_uri(kind, picture)}]
        gltf.root["textures"] = [texture or {"source": 0}]
        gltf.root["materials"] = materials or [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}, "extensions": {"KHR_materials_unlit": {}}}]
        gltf.root["extensionsUsed"] = ["KHR_materials_unlit", "EXT_texture_avif"]
        return gltf.write(self.folder / "scene.gltf")

    def colors(self, scene):
        """Of the left and of the right half."""
        self.renders(scene, "-o", self.folder / "x.pfm", "--resolution", "8,8", "--spp", 1, "--stage", "flat", "--quiet")
        rows = read_pfm(self.folder / "x.pfm")
        return rows[4][2], rows[4][6]

    def test_avif(self):
        texture = {"extensions": {"EXT_texture_avif": {"source": 0}}}
        scene = self.scene(AVIF, texture, kind="image/avif")
        result = run("info", scene, "--decode")
        if "AVIF cannot be decoded" in result.stderr:
            self.assertRegex(result.stderr, "libheif")
            self.skipTest(result.stderr)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        for color, right in zip(self.colors(scene), ((1, 0, 0), (0, 0, 1))):
            for a, b in zip(color, right):
                self.assertAlmostEqual(a, b, delta=0.02)  # one step of luma and chroma
        # A fallback is drawn where there is one: all systems have it.
        both = {"source": 0, **texture}
        document = json.loads(self.scene(png(1, 1, [0, 255, 0, 255]), both).read_text())
        document["images"].append({"uri": data_uri("image/avif", AVIF)})
        document["textures"][0]["extensions"]["EXT_texture_avif"]["source"] = 1
        scene.write_text(json.dumps(document))
        self.assertEqual(self.colors(scene)[0], (0, 1, 0))

    def test_broken_avif(self):
        """Each is refused, and its picture named."""
        texture = {"extensions": {"EXT_texture_avif": {"source": 0}}}
        size = AVIF.index(b"ispe") + 8
        for broken in (AVIF[:40], AVIF[:300], AVIF[:-20], AVIF.replace(b"ispe", b"xspe"), AVIF[:size] + struct.pack(">II", 1 << 20, 1 << 20) + AVIF[size + 8:],
                       AVIF[:size] + struct.pack(">II", 17, 16) + AVIF[size + 8:], AVIF[:28] + b"\0\0\0\0" + AVIF[32:], AVIF[:28] + b"\xff" * 4 + AVIF[32:]):
            result = run("info", self.scene(broken, texture, kind="image/avif"), "--decode", "--missing-textures", "refuse")
            if result.returncode == 0:  # what the properties say of alpha, or of a box up to the end, may be anything
                continue
            self.assertEqual(result.returncode, 3, result.stderr)
            self.assertIn("/images/0", result.stderr)
            self.assertNotIn("signal", result.stderr)

    def test_any_set_of_coordinates(self):
        unlit = lambda **more: [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, **more}}, "extensions": {"KHR_materials_unlit": {}}}]
        picture = png(2, 1, [255, 0, 0, 255, 0, 0, 255, 255])
        for sets in (2, 3, 5):
            scene = self.scene(picture, sets=sets, materials=unlit(texCoord=sets - 1))
            self.assertEqual(run("info", scene).stderr, "")
            self.assertEqual(self.colors(scene)[0], (0, 0, 1), sets)
            self.assertEqual(self.colors(self.scene(picture, sets=sets, materials=unlit()))[0], (1, 0, 0), sets)
            transform = {"KHR_texture_transform": {"texCoord": sets - 1}}
            self.assertEqual(self.colors(self.scene(picture, sets=sets, materials=unlit(extensions=transform)))[0], (0, 0, 1), sets)

    def test_a_third_set_of_a_material_is_said(self):
        material = {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 0, "texCoord": 1}}, "normalTexture": {"index": 0, "texCoord": 2}}
        said = run("info", self.scene(png(1, 1, [128, 128, 255, 255]), sets=3, materials=[material])).stderr
        self.assertIn("/materials/0: has textures of more than two sets of coordinates; TEXCOORD_0 is taken instead of TEXCOORD_2", said)


if __name__ == "__main__":
    main()

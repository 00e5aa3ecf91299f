#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""--aov crypto-object and crypto-material, whose layers other programs read."""
import json
import struct

from support import Case, main, quad

LAYERS = [f"0{i}.{c}" for i in range(3) for c in "RGBA"]


def hex_of(value):
    """Returns the 8 digits of a float's bits, as in the manifest."""
    return "%08x" % struct.unpack("<I", struct.pack("<f", value))


class Cryptomatte(Case):
    NAMES = ("CryptoObject", "CryptoMaterial")
    KEYS = ("3ae39a5", "be359d6")

    def scene(self):
        """Makes a scene that is seen from the front, with 8 x 4 pixels of half a metre each. The edge between left and
        right cuts column 4 at a quarter, and both end in the middle of the top and the bottom row. A veil of alpha 0.5
        covers columns 0 and 1; left begins in column 1."""
        gltf = quad({"name": "bunny", "doubleSided": True})
        gltf["materials"] += [{"name": "red"}, {"pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.5]}, "alphaMode": "BLEND"}]
        for material in (1, 2):
            mesh = json.loads(json.dumps(gltf["meshes"][0]))
            mesh["primitives"][0]["material"] = material
            gltf["meshes"].append(mesh)

        def node(name, mesh, x0, x1, y0, y1, z=0):
            return {"name": name, "mesh": mesh, "translation": [(x0 + x1) / 2, (y0 + y1) / 2, z], "scale": [(x1 - x0) / 2, (y1 - y0) / 2, 1]}
        gltf["nodes"] = [node("left", 0, -1.5, 0.125, 0.25, 0.75), node("left", 0, -1.5, 0.125, -0.75, 0.25),
                         node("right", 1, 0.125, 1.5, -0.75, 0.75), node("veil", 2, -2, -1, -1, 1, 0.5),
                         {"camera": 0, "translation": [0, 0, 2.2]}, {"name": "behind the camera", "mesh": 0, "translation": [0, 0, 9]}]
        gltf["cameras"] = [{"type": "orthographic", "orthographic": {"xmag": 2, "ymag": 1, "znear": 0.1, "zfar": 10}}]
        gltf["scenes"] = [{"nodes": list(range(6))}]
        return str(self.written("mattes.gltf", {k: v for k, v in gltf.items() if v}).with_suffix(""))

    def drawn(self, *options):
        return self.picture(self.scene(), "x.exr", "--resolution", "8,4", "--spp", 64, "--no-background", "--aov", "crypto-object,crypto-material", *options)

    def shares(self, exr, layer, x, y):
        """Returns the shares of a pixel by name."""
        key = self.KEYS[self.NAMES.index(layer)]
        names = {number: name for name, number in json.loads(exr.texts[f"cryptomatte/{key}/manifest"]).items()}
        values = exr.pixel(x, y, *(layer + channel for channel in LAYERS))
        pairs = list(zip(values[::2], values[1::2]))
        self.assertEqual(pairs, sorted(pairs, key=lambda pair: -pair[1]))
        for number, share in pairs:
            self.assertEqual(number == 0, share == 0)
        return {names[hex_of(number)]: share for number, share in pairs if share > 0}

    def close(self, seen, expected, delta=0.04):
        self.assertEqual(set(seen), set(expected))
        for name, share in expected.items():
            self.assertAlmostEqual(seen[name], share, delta=delta, msg=name)

    def test_shares_are_those_of_the_pixel(self):
        exr = self.drawn()
        self.close(self.shares(exr, "CryptoObject", 4, 1), {"left": 0.25, "right": 0.75})
        self.close(self.shares(exr, "CryptoMaterial", 4, 1), {"bunny": 0.25, "red": 0.75})
        self.close(self.shares(exr, "CryptoObject", 4, 0), {"left": 0.125, "right": 0.375})
        self.close(self.shares(exr, "CryptoObject", 2, 1), {"left": 1}, 0)  # two nodes of one name
        self.close(self.shares(exr, "CryptoObject", 7, 1), {})
        # Through a blended surface, samples see the objects behind it by chance.
        self.close(self.shares(exr, "CryptoObject", 0, 1), {"veil": 0.5}, 0.15)
        self.close(self.shares(exr, "CryptoMaterial", 1, 2), {"/materials/2": 0.5, "bunny": 0.5}, 0.15)
        for y in range(4):
            for x in range(8):
                for layer in self.NAMES:
                    self.assertAlmostEqual(sum(self.shares(exr, layer, x, y).values()), exr.pixel(x, y, "A")[0], delta=1e-6)
        # The number of one name is that of the specification's example.
        self.assertEqual(exr.pixel(2, 1, "CryptoMaterial00.R")[0], struct.unpack("<f", struct.pack("<I", 0x13851A76))[0])

    def test_attributes(self):
        exr = self.drawn("--half")
        for layer, key in zip(self.NAMES, self.KEYS):
            self.assertEqual([exr.texts[f"cryptomatte/{key}/{name}"] for name in ("name", "hash", "conversion")],
                             [layer, "MurmurHash3_32", "uint32_to_float32"])
        self.assertEqual(set(json.loads(exr.texts["cryptomatte/3ae39a5/manifest"])), {"left", "right", "veil", "behind the camera"})
        # Nothing is rounded.
        self.close(self.shares(exr, "CryptoObject", 4, 1), {"left": 0.25, "right": 0.75})

    def test_regions_and_shared_meshes_have_the_bits_of_the_whole(self):
        whole = self.drawn("--instancing", "flatten")
        shared = self.drawn("--instancing", "share")
        part = self.drawn("--region", "3,1,4,2")
        for layer in self.NAMES:
            for channel in LAYERS:
                self.assertEqual(whole.layers[layer + channel], shared.layers[layer + channel])
                self.assertEqual([row[3:7] for row in whole.layers[layer + channel][1:3]], part.layers[layer + channel])

    def test_merge_refuses_them(self):
        """Numbers have no mean."""
        parts = [self.folder / f"{i}.exr" for i in range(2)]
        for i, part in enumerate(parts):
            self.renders(self.scene() + ".gltf", "-o", part, "--quiet", "--resolution", "8,4", "--spp", 1, "--sample-offset", i, "--aov", "crypto-object")
        self.fails(3, "merge", *parts, "-o", self.folder / "merged.exr", says=["0.exr", "crypto-object"])


if __name__ == "__main__":
    main()

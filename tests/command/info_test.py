#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What `info` tells of a file to somebody who has not made it."""
import json

from support import SCENES, Case, Gltf, main, png, quad, run


class Info(Case):
    def scene(self):
        (self.folder / "wood.png").write_bytes(png(4, 2, bytes([90, 60, 30, 255] * 8)))
        gltf = Gltf({"asset": {"version": "2.0", "generator": "a pencil", "copyright": "2026 A\nB"}, "scene": 0, "scenes": [{"nodes": []}],
                     "extensionsUsed": ["KHR_lights_punctual"], "images": [{"uri": "wood.png"}], "textures": [{"source": 0}],
                     "extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 3}]}},
                     "materials": [{"name": "oak", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}, {}]})
        corners = [(0, 0, 0), (2, 0, 0), (0, 3, 0), (0, 0, 4)]
        position, uv = gltf.accessor(corners), gltf.accessor([(0, 0), (1, 0), (0, 1), (1, 1)])
        mesh = gltf.mesh(gltf.accessor([0, 1, 2, 0, 2, 3], "H"), position=position, texcoord_0=uv, material=0)
        gltf.node(mesh=mesh)
        gltf.node(name="Sun", extensions={"KHR_lights_punctual": {"light": 0}})
        (self.folder / "table.bin").write_bytes(gltf.data)
        path = gltf.write(self.folder / "table.gltf")
        root = json.loads(path.read_text())
        root["buffers"][0]["uri"] = "table.bin"
        path.write_text(json.dumps(root))
        return path

    def test_it_says_what_one_wants_to_know(self):
        path = self.scene()
        text = run("info", path).stdout
        self.assertTrue(text.startswith(f"{path} ("), text)
        for line in ("  size        2 x 3 x 4 m (W x H x D), from (0, 0, 0) to (2, 3, 4)\n", "  materials   2, textures 1, images 1 (0.0 MB encoded)\n",
                     '    0 "oak": base colour 4 x 2 (wood.png)\n', '  lamps       1: 0 "Sun" (directional, 3 lx)\n', "  light       its own: 1 lamp\n",
                     "  cameras     none\n", "  made by     a pencil\n", "  copyright   2026 A?B\n"):
            self.assertIn(line, text)
        self.assertRegex(text, r"  refers to   table.bin \d+ bytes, wood.png \d+ bytes\n")
        self.assertNotIn("  tree  ", text)
        verbose = run("info", path, "--verbose").stdout
        self.assertTrue(verbose.startswith(text))
        self.assertIn("  tree  ", verbose)
        self.assertIn("  GPU memory  ", verbose)

    def test_json_keeps_its_members_and_has_these(self):
        path = self.scene()
        data = json.loads(run("info", path, "--json").stdout)
        self.assertEqual(data["materials"][0], {"name": "oak", "textures": [{"slot": "base colour", "name": "wood.png", "width": 4, "height": 2}]})
        self.assertEqual(data["lamps"], [{"name": "Sun", "type": "directional", "intensity": 3, "unit": "lx"}])
        self.assertEqual((data["size"], data["generator"], data["copyright"], data["lit_by"]), ([2, 3, 4], "a pencil", "2026 A\nB", "own"))
        self.assertEqual(data["files"], [{"name": str(self.folder / name), "bytes": (self.folder / name).stat().st_size}
                                         for name in ("table.gltf", "table.bin", "wood.png")])
        for member in ("schema", "file", "scene", "bvh", "texture_bytes", "not_needed", "material_names", "cameras", "animations", "warnings"):
            self.assertIn(member, data)

    def test_a_material_that_a_scene_has_twice_is_listed_once(self):
        glass = {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_volume": {"thicknessFactor": 0.1}}
        root = quad({"name": "glass", "emissiveFactor": [1, 1, 1], "extensions": glass})
        path = self.written("pane.gltf", root | {"extensionsUsed": list(glass)})
        result = run("info", path)
        self.assertIn("is drawn as a thin wall", result.stderr)  # by a copy of its material
        self.assertEqual(result.stdout.count('"glass"'), 1, result.stdout)
        self.assertIn("  materials   1,", result.stdout)
        self.assertIn("its own: 1 material that shines\n", result.stdout)
        data = json.loads(run("info", path, "--json").stdout)
        self.assertEqual((data["material_names"].count("glass"), len([m for m in data["materials"] if m["name"] == "glass"])), (1, 1))

    def test_who_would_light_it(self):
        self.assertIn("  light       its own: 1 material that shines\n", run("info", SCENES / "cornell-box.gltf").stdout)
        root = json.loads((SCENES / "cornell-box.gltf").read_text())
        root["materials"][3].pop("emissiveFactor")
        dark = self.written("dark.gltf", root)
        self.assertRegex(run("info", dark).stdout, r"  light       no light in the scene: `render` adds ")
        self.assertNotEqual(json.loads(run("info", dark, "--json").stdout)["lit_by"], "own")

    def test_many_materials_are_cut_short(self):
        root = json.loads((SCENES / "cornell-box.gltf").read_text())
        root["materials"] += [{"name": f"m{i}"} for i in range(60)]
        many = self.written("many.gltf", root)
        self.assertIn("    and 24 more (--verbose)\n", run("info", many).stdout)
        self.assertIn('    63 "m59"\n', run("info", many, "--verbose").stdout)


if __name__ == "__main__":
    main()

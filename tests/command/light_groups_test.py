#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The light of some lamps alone: --aov light:NAME."""
import json
from pathlib import Path

from support import SCENES, Case, Exr, main

BOX = json.loads((SCENES / "cornell-box.gltf").read_text())


class LightGroups(Case):
    def scene(self):
        """The Cornell box with a point light, an unlit wall, and a block that lets half of the light pass."""
        gltf = json.loads(json.dumps(BOX))
        gltf["extensionsUsed"] += ["KHR_lights_punctual", "KHR_materials_unlit"]
        gltf["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "point", "name": "key", "intensity": 4, "color": [1, 0.5, 0.2]}]}}
        gltf["scenes"][0]["nodes"].append(len(gltf["nodes"]))
        gltf["nodes"].append({"name": "bulb", "extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [0.4, 0.2, 0.6]})
        gltf["materials"][1]["extensions"] = {"KHR_materials_unlit": {}}
        block = next(node for node in gltf["nodes"] if node.get("name") == "short-block")
        mesh = json.loads(json.dumps(gltf["meshes"][block["mesh"]]))
        mesh["primitives"][0]["material"] = len(gltf["materials"])
        gltf["materials"].append({"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.8, 0.8, 0.5], "metallicFactor": 0}})
        block["mesh"] = len(gltf["meshes"])
        gltf["meshes"].append(mesh)
        return str(self.written("lamps.gltf", gltf).with_suffix(""))

    def drawn(self, scene, groups, *options, size="24,16", spp=8):
        groups = ",".join("light:" + group for group in groups)
        return self.picture(scene, "x.exr", "--resolution", size, "--spp", spp, *(["--aov", groups] if groups else []), *options)

    def values(self, exr, group=None):
        return [value for c in "RGB" for value in exr.values(f"light_{group}.{c}" if group else c)]

    def adds_up(self, exr, groups):
        parts = [self.values(exr, group) for group in groups]
        for all_of_it, *own in zip(self.values(exr), *parts):
            self.assertAlmostEqual(sum(own), all_of_it, delta=1e-5 * all_of_it + 1e-9)
        return [sum(part) for part in parts]

    def test_they_add_up_to_the_picture(self):
        names = ["key", "lamp", "red", "environment"]
        exr = self.drawn(self.scene(), names, "--studio", "--clamp-indirect", "0.5")
        self.assertTrue(all(total > 1 for total in self.adds_up(exr, names)))

    def test_each_picture_of_a_sequence_has_all_its_light(self):
        self.renders(self.scene() + ".gltf", "-o", self.folder / "#.exr", "--quiet", "--resolution", "24,16", "--region", "4,4,12,8", "--spp", 4,
                     "--turntable", 2, "--studio", "--aov", "light:bulb,light:rest")  # its node's name
        for i in range(2):
            self.adds_up(Exr(self.folder / f"{i}.exr"), ["bulb", "rest"])

    def test_light_paths_belong_to_their_lamp(self):
        """Caustics, by light paths."""
        names = ["behind", "above", "lamp", "environment"]
        exr = self.drawn("caustic-ground", names, "--caustics", "on")
        self.assertTrue(all(total > 1 for total in self.adds_up(exr, names)[:3]))

    def test_a_group_is_the_picture_of_its_lamp_alone(self):
        exr = self.drawn(self.scene(), ["key", "lamp"], "--studio", spp=1024, size="12,8")
        dark = ["--set", "/materials/3/emissiveFactor=0,0,0", "--set", "/materials/1/pbrMetallicRoughness/baseColorFactor=0,0,0,1", "--no-default-light"]
        alone = self.drawn(self.scene(), [], *dark, spp=1024, size="12,8")
        self.assertAlmostEqual(sum(self.values(exr, "key")) / sum(self.values(alone)), 1, delta=0.02)

    def test_lights_of_one_name_are_told_apart_by_their_places(self):
        scene = Path(self.scene() + ".gltf")
        gltf = json.loads(scene.read_text())
        gltf["scenes"][0]["nodes"].append(len(gltf["nodes"]))
        gltf["nodes"].append({"name": "bulb", "extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [-0.4, 0.2, 0.6]})
        scene.write_text(json.dumps(gltf))
        first, second = len(gltf["nodes"]) - 2, len(gltf["nodes"]) - 1
        options = ["-o", self.folder / "x.exr", "--resolution", "12,8", "--spp", 4, "--aov"]
        result = self.renders(scene, *options, f"light:/nodes/{first},light:key,light:rest")
        self.assertIn(f"--aov light:key: one layer of 2 lights of that name, each of which is light:/nodes/{first}, light:/nodes/{second}", result.stderr)
        one, other, _ = self.adds_up(Exr(self.folder / "x.exr"), [f"_nodes_{first}", "key", "rest"])
        self.renders(scene, *options, "light:key", "--quiet")
        both = sum(self.values(Exr(self.folder / "x.exr"), "key"))
        self.assertAlmostEqual((one + other) / both, 1, delta=1e-4)
        self.assertGreater(min(one, other), 0.1 * both)
        self.fails(2, "render", scene, "-o", self.folder / "y.exr", "--aov", "light:nobody", says=[f"/nodes/{first}, ", f"/nodes/{second}, ", "environment, key"])

    def test_what_the_scene_has_not_is_refused(self):
        def refused(groups, *options, says):
            self.fails(2, "render", self.scene() + ".gltf", "-o", self.folder / "y.exr", "--aov", groups, *options, says=says)
        refused("light:nobody", says=["light:nobody", "environment, key, lamp, red, rest"])
        refused("light:key", "--traversal", "literals", says=["literals"])


if __name__ == "__main__":
    main()

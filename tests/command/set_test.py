#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""--set "MATERIAL:NAME=VALUES": materials by their names, also with what the file lacks."""
import json

from support import SCENES, SMALL, Case, Gltf, main, png, quad

BOX = SCENES / "cornell-box.gltf"


class SetByName(Case):
    def drawn(self, scene, *options):
        self.renders(scene, "-o", self.folder / "x.pfm", *SMALL, *options)
        return (self.folder / "x.pfm").read_bytes()

    def changed(self, change):
        """The box with a change of its materials by name, as another file."""
        root = json.loads(BOX.read_text())
        for buffer in root.get("buffers", []):
            if not buffer["uri"].startswith("data:"):
                buffer["uri"] = str(BOX.parent / buffer["uri"])
        change({material["name"]: material for material in root["materials"]}, root)
        return self.drawn(self.written("changed.gltf", root), "--allow-external-files")

    def same(self, options, change):
        words = [word for text in options for word in ("--set", text)]
        found = self.drawn(BOX, *words)
        self.assertTrue(found == self.changed(change), options)
        self.assertFalse(found == self.drawn(BOX), options)

    def test_what_the_file_has(self):
        def roughness(materials, _root):
            for name in ("red", "green"):
                materials[name]["pbrMetallicRoughness"].update(metallicFactor=1, roughnessFactor=0.3)
        self.same(["*re*:metallic=1", "red:roughness=0.3", "gr*:roughnessFactor=0.3"], roughness)
        self.same(["*re*:roughness=0.3", "/materials/1/pbrMetallicRoughness/metallicFactor=1", "green:metallic=1"], roughness)
        self.same(["?ed:roughness=0.9", "red:roughness=0.3", "green:roughness=0.3", "?????:metallic=1", "*d:metallic=1", "white:metallic=0"], roughness)
        self.same(["red:color=0.1,0.2,0.3"], lambda m, _: m["red"]["pbrMetallicRoughness"].update(baseColorFactor=[0.1, 0.2, 0.3, 1]))

    def test_what_the_file_lacks(self):
        def extended(name, **members):
            def change(materials, root):
                materials["white"].setdefault("extensions", {})[f"KHR_materials_{name}"] = members
                root["extensionsUsed"].append(f"KHR_materials_{name}")
            return change

        self.same(["white:clearcoat=1", "white:clearcoatRoughness=0.2"], extended("clearcoat", clearcoatFactor=1, clearcoatRoughnessFactor=0.2))
        self.same(["white:sheen=0.5,0.2,0.1"], extended("sheen", sheenColorFactor=[0.5, 0.2, 0.1]))
        self.same(["white:transmission=0.5"], extended("transmission", transmissionFactor=0.5))
        self.same(["white:emission=0.1,0.2,0.3"], lambda m, _: m["white"].update(emissiveFactor=[0.1, 0.2, 0.3]))
        self.same(["white:transmission=1", "white:index=1.2", "white:thickness=0.1", "white:dispersion=2"],
                  lambda m, root: [extended(*one)(m, root) if isinstance(one, tuple) else one(m, root) for one in (
                      extended("transmission", transmissionFactor=1), extended("ior", ior=1.2), extended("volume", thicknessFactor=0.1),
                      extended("dispersion", dispersion=2))])

    def test_modes(self):
        clear = "white:color=1,1,1,0.25"
        colored = lambda m: m["white"]["pbrMetallicRoughness"].update(baseColorFactor=[1, 1, 1, 0.25])
        self.same([clear, "white:alphaMode=blend"], lambda m, _: [colored(m), m["white"].update(alphaMode="BLEND")])
        self.same([clear, "white:alphaMode=MASK", "white:alphaCutoff=0.2"], lambda m, _: [colored(m), m["white"].update(alphaMode="MASK", alphaCutoff=0.2)])
        self.fails(2, "render", BOX, "-o", self.folder / "x.png", "--set", "white:alphaMode=1", says=["/materials/0/alphaMode: is OPAQUE, MASK or BLEND"])
        self.fails(2, "render", BOX, "-o", self.folder / "x.png", "--set", "white:doubleSided=MASK", says=["/materials/0/doubleSided: is true or false"])
        self.renders(BOX, "-o", self.folder / "x.png", *SMALL, "--set", "white:doubleSided=true", "--set", "/materials/1/doubleSided=true")

    def test_names_with_signs_are_quoted(self):
        root = json.loads(BOX.read_text())
        root["materials"][1]["name"] = "a=b:c*"
        odd = self.written("odd.gltf", root)
        plain = self.drawn(BOX, "--set", "red:color=0.1,0.2,0.3")
        self.assertEqual(self.drawn(odd, "--set", r"a\=b:c\*:color=0.1,0.2,0.3"), plain)
        self.fails(2, "render", odd, "-o", self.folder / "x.png", "--set", r"a\=b\*:color=0.1,0.2,0.3", says=["no material is called"])

    def textured(self, **changes):
        """A quad with a green texture and blue corners, whose material is called Seat."""
        base = {"baseColorTexture": {"index": 0}, "baseColorFactor": [1, 1, 1, 1]}
        root = quad({"name": "Seat", "pbrMetallicRoughness": base, **changes}, images=[png(1, 1, [0, 255, 0, 255])])
        gltf = Gltf(root)
        root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = gltf.accessor([(0.2, 0.5, 1)] * 4)
        return gltf.document()

    def test_a_color_is_that_color(self):
        scene = self.written("seat.gltf", self.textured())
        flat = lambda text, file=scene: self.drawn(file, "--stage", "flat", "--set", text)
        plain = self.textured(pbrMetallicRoughness={"baseColorFactor": [1, 0.5, 0, 1]})
        del plain["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"]
        orange = self.drawn(self.written("plain.gltf", plain), "--stage", "flat")
        self.assertEqual(flat("Seat:color=1,0.5,0"), orange)
        self.assertEqual(flat("seat:color=1,0.5,0"), orange)
        self.assertEqual(flat("SE?T:colour=1,0.5,0"), orange)
        self.assertEqual(flat("0:color=1,0.5,0"), orange)
        self.assertEqual(flat("Seat:color=#ff0000"), flat("Seat:color=red"))
        self.assertEqual(flat("Seat:color=red"), flat("Seat:color=1,0,0"))
        # glTF's own name multiplies; the texture alone can go, too.
        tinted = flat("Seat:baseColor=1,0.5,0")
        self.assertNotIn(tinted, (orange, self.drawn(scene, "--stage", "flat")))
        bare = self.textured(pbrMetallicRoughness={})
        without = self.drawn(self.written("bare.gltf", bare), "--stage", "flat")
        for text in ("Seat:texture=none", "Seat:baseColorTexture=none", "/materials/0/pbrMetallicRoughness/baseColorTexture=none"):
            self.assertEqual(flat(text), without, text)
        # An older description of materials has another member for it.
        older = {"KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [1, 1, 1, 1], "diffuseTexture": {"index": 0}}}
        self.assertEqual(flat("Seat:color=1,0.5,0", self.written("older.gltf", self.textured(extensions=older))), orange)

    def test_what_holds_an_outline_stays(self):
        scene = self.written("leaf.gltf", self.textured(alphaMode="MASK"))
        result = self.renders(scene, "-o", self.folder / "x.png", "--resolution", "16,16", "--spp", "2", "--set", "Seat:color=1,0.5,0")
        self.assertIn("multiplies the texture, which may hold the outline", result.stderr)
        self.assertEqual(self.drawn(scene, "--set", "Seat:color=1,0.5,0"), self.drawn(scene, "--set", "Seat:baseColorFactor=1,0.5,0,1"))

    def test_two_names_that_differ_in_case_are_not_mixed(self):
        root = json.loads(BOX.read_text())
        root["materials"][1]["name"], root["materials"][2]["name"] = "Wall", "wall"
        scene = self.written("walls.gltf", root)
        self.fails(2, "render", scene, "-o", self.folder / "x.png", "--set", "WALL:roughness=1", says=["no material is called 'WALL'"])
        self.assertNotEqual(self.drawn(scene, "--set", "wall:color=1,1,1"), self.drawn(scene, "--set", "Wall:color=1,1,1"))

    def test_of_many_names_the_nearest_are_listed(self):
        root = json.loads(BOX.read_text())
        root["materials"] += [{"name": f"Metal {i}"} for i in range(40)] + [{"name": "Wood oak"}]
        self.fails(2, "render", self.written("many.gltf", root), "-o", self.folder / "x.png", "--set", "wood:roughness=1",
                   says=["the file has 44 \"Wood oak\", ", " and 33 others"])

    def test_what_is_not_there_is_told_what_is(self):
        for text, says in (("rde:roughness=1", "no material is called 'rde'; the file has 0 \"white\", 1 \"red\", 2 \"green\", 3 \"lamp\""),
                           ("red:roughnes=1", "'roughnes' is no value of a material; did you mean roughness?"),
                           ("red:clearcoats=1", "did you mean clearcoat?"), ("red:color=1", "takes 4 numbers, not 1"),
                           (":roughness=1", "is not of the form"), ("red=1", "is not of the form"), ("red:=1", "is not of the form"), ("red:roughness=x", "'x' is no number"),
                           ("red:color=orang", "'orang' is no number and no colour; did you mean orange?"), ("red:roughness=none", "is no number"),
                           ("red:baseColorTexture=1", "takes only 'none'"), ("red:normalTextures=none", "did you mean normalTexture?")):
            self.fails(2, "render", BOX, "-o", self.folder / "x.png", "--set", text, says=["--set: ", says])


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Triangles that alpha cuts out wholly: the picture is the one without them, at the cost of one without them."""
import json
import random

from support import Case, data_uri, main, png
from gltf_file import Gltf

HOLE = [255, 255, 255, 0]


class CutOut(Case):
    def leaves(self, layers, cards=400, name="leaves", nothing=None, animation=False, **material):
        """A ground under a lamp, with layers of cards between: each is a square of random direction. The material of the cards has a
        picture of which nothing but the upper left texel is there, or it is `nothing`: colours without a picture."""
        draw = random.Random(3)
        gltf = Gltf()
        gltf.root["materials"] = [
            {"pbrMetallicRoughness": {"baseColorFactor": [0.7, 0.6, 0.5, 1], "metallicFactor": 0}, "doubleSided": True},
            {"emissiveFactor": [1, 1, 1], "doubleSided": True},
            {"pbrMetallicRoughness": nothing or {"baseColorTexture": {"index": 0}}, "alphaMode": "MASK", "doubleSided": True, **material}]
        if nothing is None:
            gltf.root["images"] = [{"uri": data_uri("image/png", png(64, 64, [9, 200, 9, 255] + HOLE * (64 * 64 - 1)))}]
            gltf.root["textures"] = [{"source": 0}]

        def squares(middles, half, material, low=0.2, high=0.9):
            points, coordinates, indices = [], [], []
            for middle, across, up in middles:
                first = len(points)
                for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
                    points.append([m + half * ((2 * u - 1) * a + (2 * v - 1) * b) for m, a, b in zip(middle, across, up)])
                    coordinates.append([low + (high - low) * u, low + (high - low) * v])
                indices += [first + i for i in (0, 1, 2, 0, 2, 3)]
            return gltf.mesh(gltf.accessor(indices, "I"), position=gltf.accessor(points), texcoord_0=gltf.accessor(coordinates), material=material)

        gltf.node(mesh=squares([([0, 0, 0], [1, 0, 0], [0, 0, 1])], 3, 0))
        gltf.node(mesh=squares([([0, 3, 0], [1, 0, 0], [0, 0, 1])], 0.5, 1))
        for layer in range(layers):
            cards_of = []
            for _ in range(cards):
                angle = draw.uniform(0, 3)
                tilt = [draw.uniform(-0.3, 0.3) for _ in range(2)]
                middle = [draw.uniform(-2, 2), 0.5 + 2 * (layer + draw.random()) / max(layers, 1), draw.uniform(-2, 2)]
                cards_of.append((middle, [1, tilt[0], angle - 1.5], [angle - 1.5, tilt[1], -1]))
            gltf.node(mesh=squares(cards_of, 0.1, 2))
        if animation:
            gltf.moves(1, [0, 1], translation=[[0, 0, 0], [1, 0, 0]])
        return gltf.write(self.folder / f"{name}.gltf")

    VIEW = ["--camera-position", "0,1.5,7", "--camera-focal-point", "0,1,0", "--scene-origin", "0,0,0", "--resolution", "32,32", "--spp", 2,
            "--bounces", 2, "--seed", 1]

    def drawn(self, scene, *options):
        """Returns the bytes of the picture, and its statistics."""
        path, stats = self.folder / "x.pfm", self.folder / "x.json"
        self.renders(scene, "-o", path, "--quiet", "--stats", stats, *self.VIEW, *options)
        return path.read_bytes(), json.loads(stats.read_text())

    def same(self, with_cards, without, count, *options):
        seen, told = self.drawn(with_cards, *options)
        self.assertEqual(told["bvh"].get("cut_out_triangles", 0), count)
        self.assertEqual(seen == self.drawn(without, *options)[0], True, options)
        return told

    def test_the_picture_is_that_without_them(self):
        without = self.leaves(0, name="without")
        for nothing, mode in ((None, {}), (None, {"alphaMode": "BLEND"}), ({"baseColorFactor": [1, 1, 1, 0.4]}, {}),
                              ({"baseColorFactor": [1, 1, 1, 0]}, {"alphaMode": "BLEND"})):
            cards = self.leaves(2, 40, nothing=nothing, **mode)
            self.same(cards, without, 160)
        for options in (["--traversal", "iterative"], ["--traversal", "bvh"], ["--schedule", "wavefront", "--traversal", "front-to-back"],
                        ["--stage", "shadows"]):
            self.same(cards, without, 160, *options)
        few = self.leaves(1, 6)
        self.assertIn("literals", self.same(few, without, 12, "--traversal", "literals")["variant"])

    def test_they_take_no_light_samples(self):
        without, alone = self.leaves(0, name="without"), ["--default-light", "none", "--camera-rays", 1, "--light-selection", "power", "--traversal", "front-to-back"]
        self.same(self.leaves(2, 40, emissiveFactor=[1, 0.5, 0.2]), without, 160, *alone)

    def test_sixty_four_layers_cost_what_one_costs(self):
        work = lambda layers: self.drawn(self.leaves(layers, 400), "--count-work", "--traversal", "front-to-back")[1]
        one, many = work(1), work(64)
        self.assertEqual(many["bvh"]["cut_out_triangles"], 64 * 800)
        self.assertLess(many["work"]["node_steps"], 1.1 * one["work"]["node_steps"])
        self.assertEqual(many["work"]["surfaces_passed"], 0)

    def test_what_is_partly_there_stays(self):
        """The texel that is there lies in the corner of these coordinates' square."""
        cards = self.leaves(2, 40)
        model = json.loads(cards.read_text())
        for offset, count in (([-0.2, -0.2], 0), ([0, 0], 160), ([1, 3], 160), ([-1.2, 0.8], 0)):
            model["materials"][2]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = {"KHR_texture_transform": {"offset": offset}}
            model["extensionsUsed"] = ["KHR_texture_transform"]
            moved = self.written("moved.gltf", model)
            self.assertEqual(self.drawn(moved)[1]["bvh"].get("cut_out_triangles", 0), count, offset)

    def test_numbers_that_change_bring_them_back(self):
        cards = self.leaves(2, 40, nothing={"baseColorFactor": [1, 1, 1, 0.4]})
        self.assertEqual(self.drawn(cards)[1]["bvh"]["cut_out_triangles"], 160)
        self.assertNotIn("cut_out_triangles", self.drawn(cards, "--set", "/materials/2/alphaCutoff=0.3")[1]["bvh"])
        self.assertEqual(self.drawn(cards, "--set", "/materials/2/alphaCutoff=0.41")[1]["bvh"]["cut_out_triangles"], 160)

    def test_an_animated_cutoff_in_a_sequence(self):
        gltf = Gltf(json.loads(self.leaves(2, 40, nothing={"baseColorFactor": [1, 1, 1, 0.4]}).read_text()))
        pointer = {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": "/materials/2/alphaCutoff"}}}
        gltf.root["animations"] = [{"samplers": [{"input": gltf.accessor([0, 1, 2]), "output": gltf.accessor([0.3, 0.6, 0.3])}],
                                    "channels": [{"sampler": 0, "target": pointer}]}]
        gltf.root["extensionsUsed"] = ["KHR_animation_pointer"]
        scene = gltf.write(self.folder / "fading.gltf")
        self.renders(scene, "-o", self.folder / "f#.pfm", "--quiet", *self.VIEW, "--frames", "0:2", "--fps", 1, "--stats", self.folder / "s#.json")
        for frame, count in enumerate((0, 160, 0)):
            told = json.loads((self.folder / f"s{frame}.json").read_text())
            self.assertEqual(told["bvh"].get("cut_out_triangles", 0), count)
            alone = self.drawn(scene, "--animation-time", frame, "--seed", told["seed"])[0]
            self.assertEqual((self.folder / f"f{frame}.pfm").read_bytes() == alone, True, frame)

    def test_while_the_shutter_is_open(self):
        cards = self.leaves(2, 40, animation=True)
        without = self.leaves(0, name="without", animation=True)
        told = self.same(cards, without, 160, "--shutter", 180, "--animation-time", 0.5, "--fps", 2)
        self.assertGreater(told["motion"]["segments"], 0)


if __name__ == "__main__":
    main()

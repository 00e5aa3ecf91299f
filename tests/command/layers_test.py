#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The layers that --aov adds to an .exr."""
import json
import math
import struct
from pathlib import Path

from support import SCENES, Case, Exr, main, quad, read_pfm, run

BOX = SCENES / "cornell-box.gltf"
FEATURES = {"albedo": "RGB", "normal": "XYZ", "depth": "Z"}
NAMES = {layer: [f"{layer}.{c}" for c in channels] for layer, channels in FEATURES.items()}


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def normalized(a):
    return tuple(x / math.sqrt(dot(a, a)) for x in a)


class View:
    """A perspective camera: the direction through a place of the picture, of length 1 along its axis."""

    def __init__(self, eye, target, degrees, width, height):
        self.eye, self.size = eye, (width, height)
        self.forward = normalized([t - e for t, e in zip(target, eye)])
        self.right = normalized(cross(self.forward, (0, 1, 0)))
        self.up = cross(self.right, self.forward)
        self.half = math.tan(math.radians(degrees) / 2)

    def through(self, x, y):
        width, height = self.size
        across, along = (2 * x / width - 1) * width / height * self.half, (1 - 2 * y / height) * self.half
        return [f + across * r + along * u for f, r, u in zip(self.forward, self.right, self.up)]

    def mean(self, x, y, value, steps=16):
        """Returns the mean of a function of the direction over the square of a pixel."""
        places = [(i + 0.5) / steps for i in range(steps)]
        return sum(value(self.through(x + i, y + j)) for i in places for j in places) / steps**2


class FirstHits(Case):
    def layers(self, scene, samples, *options):
        return self.picture(scene, "x.exr", "--spp", samples, "--aov", "albedo,normal,depth", *options)

    def close(self, pixel, expected, delta=2e-6):
        self.assertEqual(len(pixel), len(expected))
        for a, b in zip(pixel, expected):
            self.assertAlmostEqual(a, b, delta=delta, msg=f"{pixel} is not {expected}")

    def test_the_back_wall_of_the_cornell_box(self):
        exr = self.layers("cornell-box", 64, "--resolution", "40,40")
        for x in (14, 20, 26):
            self.close(exr.pixel(x, 12, *NAMES["albedo"]), (0.725, 0.71, 0.68))
            self.close(exr.pixel(x, 12, *NAMES["normal"]), (0, 0, 1))
            # The depth is from z = (279.6 + 800) / 278 to z = -279.6 / 278; it is the same over the whole wall.
            self.close(exr.pixel(x, 12, *NAMES["depth"]), (1359.2 / 278,), 1e-5)
        self.close(exr.pixel(4, 20, *NAMES["albedo"]), (0.63, 0.065, 0.05))
        self.close(exr.pixel(35, 20, *NAMES["albedo"]), (0.14, 0.45, 0.091))
        self.assertGreater(exr.pixel(4, 20, "normal.X")[0], 0.99)
        self.assertLess(exr.pixel(35, 20, "normal.X")[0], -0.99)

    def test_a_sphere_on_a_plane(self):
        width, height = 48, 32
        view = View((0, 2.2, 5.5), (0, 0.7, 0), 42, width, height)
        exr = self.layers("sphere-plane", 256, "--resolution", f"{width},{height}")
        # The ground in front of the sphere, left, right and lowest: depth -2.2 / d.y.
        for x, y in ((24, 30), (5, 25), (43, 27)):
            self.close(exr.pixel(x, y, *NAMES["albedo"]), (0.55, 0.55, 0.5))
            self.close(exr.pixel(x, y, *NAMES["normal"]), (0, 1, 0))
            depth = view.mean(x, y, lambda d: -2.2 / d[1])
            self.close(exr.pixel(x, y, "depth.Z"), (depth,), 1e-3 * depth)

        # The sphere about (0, 1, 0) of radius 1.
        def hit(d):
            half_b, c = dot(view.eye, d) - d[1], 2.2**2 + 5.5**2 - 2 * 2.2
            return (-half_b - math.sqrt(half_b**2 - dot(d, d) * c)) / dot(d, d)

        for x, y in ((24, 13), (21, 15), (27, 10)):
            self.close(exr.pixel(x, y, *NAMES["albedo"]), (0.75, 0.12, 0.08))
            self.close(exr.pixel(x, y, "depth.Z"), (view.mean(x, y, hit),), 2e-3)
            normal = [view.mean(x, y, lambda d: view.eye[i] + hit(d) * d[i] - (i == 1)) for i in range(3)]
            self.close(exr.pixel(x, y, *NAMES["normal"]), normal, 2e-3)
        # The sky, at the top, has no hit.
        for x in range(width):
            self.assertEqual(exr.pixel(x, 0, *sum(NAMES.values(), [])), (0,) * 7)

    def test_normals_are_unit_and_face_the_camera(self):
        view = View((0, 0, 1079.6 / 278), (0, 0, 0), math.degrees(2 * math.atan(0.0125 / 0.035)), 24, 24)
        exr = self.layers("cornell-box", 1, "--resolution", "24,24")
        hits = 0
        for y in range(24):
            for x in range(24):
                normal = exr.pixel(x, y, *NAMES["normal"])
                if exr.pixel(x, y, "depth.Z")[0] == 0:
                    self.assertEqual(normal, (0, 0, 0))
                    continue
                hits += 1
                self.assertAlmostEqual(dot(normal, normal), 1, delta=1e-5)
                # The one sample lies somewhere in the pixel, and a face seen edge-on may tip over by as much.
                self.assertLess(dot(normal, normalized(view.through(x + 0.5, y + 0.5))), 0.03)
        self.assertGreater(hits, 500)

    def test_normal_maps_count_unless_they_are_off(self):
        mapped, plain = (self.layers("sphere-mapped", 64, "--resolution", "24,24", *extra) for extra in ([], ["--disable", "normal-maps"]))
        self.assertNotEqual(mapped.values("normal.X"), plain.values("normal.X"))
        self.assertEqual(mapped.values("depth.Z"), plain.values("depth.Z"))

    def test_they_have_the_samples_of_the_picture(self):
        """Stage flat shows the albedo. With the same samples and the same filter, both have the same bits."""
        for options in ([], ["--pixel-filter", "gaussian"], ["--pixel-filter", "blackman-harris", "--disable", "sobol"],
                        ["--seed", "9", "--sample-offset", "1000"]):
            for scene in ("sphere-plane", "sphere-textured"):
                with self.subTest(scene=scene, options=options):
                    exr = self.layers(scene, 16, "--stage", "flat", "--default-light", "white", "--resolution", "24,16", *options)
                    for channel in "RGB":
                        self.assertEqual(exr.values(channel), exr.values("albedo." + channel))


class LightParts(Case):
    """Emission, diffuse and specular light."""
    ALL = ("emission", "diffuse", "specular")

    def parts(self, scene, *options, size="24,16"):
        return self.picture(scene, "x.exr", "--resolution", size, "--spp", 8, "--aov", ",".join(self.ALL), *options)

    def names(self, layer):
        return [f"{layer}.{c}" for c in "RGB"]

    def total(self, exr, layer):
        return sum(sum(exr.pixel(x, y, *self.names(layer))) for x in range(24) for y in range(16))

    def test_they_add_up_to_the_picture(self):
        for scene, options in (("coverage", ()), ("layered", ()), ("glass-sphere", ("--clamp-indirect", 0.2)), ("many-lights", ("--traversal", "bvh")),
                               ("mesh-15743", ("--studio", "--shadow-catcher", "bottom"))):
            with self.subTest(scene, options=options):
                self.adds_up(self.parts(scene, *options), 24, 16, negative="--shadow-catcher" in options)

    def test_a_debug_view_leaves_them_alone(self):
        plain, seen = (self.parts("cornell-box", *view, size="8,8") for view in ((), ("--debug-view", "visits")))
        for layer in self.ALL:
            names = self.names(layer)
            self.assertEqual([plain.pixel(x, 4, *names) for x in range(8)], [seen.pixel(x, 4, *names) for x in range(8)], layer)

    def adds_up(self, exr, width, height, negative=False):
        """The estimate of a shadow may be darker than black: then parts may be negative."""
        for x, y in ((x, y) for y in range(height) for x in range(width)):
            for color, *part in zip(exr.pixel(x, y, "R", "G", "B"), *(exr.pixel(x, y, *self.names(layer)) for layer in self.ALL)):
                self.assertAlmostEqual(sum(part), color, delta=2e-6 * (1 + max(map(abs, part))))
                self.assertTrue(negative or min(part) >= 0, part)

    def test_diffuse_light_is_what_a_black_base_lacks(self):
        """Under an even sky; clearcoat, sheen and gloss do not depend on the colours of the base."""
        def made(base, through):
            path = self.folder / "plastic.gltf"
            path.write_text(json.dumps(quad({
                "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.5, "baseColorFactor": [*base, 1]}, "doubleSided": True,
                "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.4},
                               "KHR_materials_sheen": {"sheenColorFactor": [0.3, 0.2, 0.1], "sheenRoughnessFactor": 0.6},
                               "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.4, "diffuseTransmissionColorFactor": through}}})))
            return self.picture(str(path.with_suffix("")), "x.exr", "--resolution", "24,16", "--spp", 512, "--aov", "diffuse", "--camera-orbit", "70,0,3", "--disable", "energy-compensation")
        whole, black = made([0.8, 0.6, 0.4], [0.3, 0.5, 0.7]), made([0, 0, 0], [0, 0, 0])
        self.assertEqual(self.total(black, "diffuse"), 0)
        for c in "RGB":
            diffuse, *pictures = (sum(exr.pixel(x, y, name)[0] for x in range(24) for y in range(16))
                                  for exr, name in ((whole, f"diffuse.{c}"), (whole, c), (black, c)))
            self.assertAlmostEqual((pictures[0] - pictures[1]) / diffuse, 1, delta=0.005)

    def test_paths_that_are_continued_in_the_next_draw_keep_their_part(self):
        """A ray against 7,872 leaves in turn takes more steps than a draw allows."""
        self.adds_up(self.parts("mesh-15743", "--traversal", "iterative", "--studio", size="6,4"), 6, 4)

    def test_each_is_what_it_says(self):
        matt = self.parts("corner-diffuse")
        self.assertEqual(self.total(matt, "specular"), 0)
        self.assertGreater(self.total(matt, "diffuse"), 1)
        metal = self.written("metal.gltf", quad({"pbrMetallicRoughness": {"metallicFactor": 1, "roughnessFactor": 0.3}}))
        mirror = self.parts(str(metal.with_suffix("")))
        self.assertEqual(self.total(mirror, "diffuse"), 0)
        self.assertGreater(self.total(mirror, "specular"), 1)
        box = self.parts("cornell-box")
        lamp = [(x, y) for y in range(16) for x in range(24) if max(box.pixel(x, y, *self.names("emission"))) > 0]
        self.assertTrue(0 < len(lamp) < 40, lamp)
        for x, y in lamp:
            self.assertGreater(sum(box.pixel(x, y, *self.names("emission"))), 1)

    def test_other_stages_lack_them(self):
        for layer in self.ALL:
            self.fails(2, "render", BOX, "-o", self.folder / "x.exr", "--stage", "phong", "--aov", layer, says=[f"--aov {layer}: only stage gi has it"])


class PartNumbers(Case):
    """The layers position, object and material."""
    NAMES = ["position.X", "position.Y", "position.Z", "object.Y", "material.Y", "depth.Z"]

    def layers(self, scene, *options):
        return self.picture(scene, "x.exr", "--aov", "position,object,material,depth", *options)

    def test_positions_are_where_the_camera_looks(self):
        width, height = 24, 16
        view = View((0, 2.2, 5.5), (0, 0.7, 0), 42, width, height)
        exr = self.layers("sphere-plane", "--resolution", f"{width},{height}", "--spp", 64)
        for x, y in ((12, 15), (2, 13), (21, 14)):  # the ground
            place = [view.mean(x, y, lambda d: view.eye[i] - 2.2 / d[1] * d[i]) for i in range(3)]
            for seen, expected in zip(exr.pixel(x, y, *self.NAMES[:3]), place):
                self.assertAlmostEqual(seen, expected, delta=0.02)
        self.assertEqual(exr.pixel(12, 0, *self.NAMES), (0,) * 6)

    def test_positions_are_metres_of_the_world(self):
        """The scene is far from the origin and has another size."""
        gltf = json.loads((SCENES / "cornell-box.gltf").read_text())
        before = self.layers("cornell-box", "--resolution", "8,8", "--spp", 1)
        roots = gltf["scenes"][0]["nodes"]
        gltf["nodes"].append({"children": roots, "translation": [1000, -200, 30], "scale": [100, 100, 100]})
        gltf["scenes"][0]["nodes"] = [len(gltf["nodes"]) - 1]
        path = self.written("moved.gltf", gltf)
        for buffer in gltf["buffers"]:
            self.assertTrue(buffer["uri"].startswith("data:"))
        moved = self.layers(str(path.with_suffix("")), "--resolution", "8,8", "--spp", 1)
        for name, offset in zip(self.NAMES, (1000, -200, 30)):
            for a, b, depth in zip(before.values(name), moved.values(name), before.values("depth.Z")):
                self.assertAlmostEqual(b, 100 * a + offset if depth > 0 else 0, delta=2e-3)

    def test_numbers_are_those_of_the_file_and_have_no_edges(self):
        gltf = json.loads((SCENES / "cornell-box.gltf").read_text())
        numbers = {i + 1: {p["material"] + 1 for p in gltf["meshes"][node["mesh"]]["primitives"]} for i, node in enumerate(gltf["nodes"]) if "mesh" in node}
        shots = [self.layers("cornell-box", "--resolution", "40,40", "--spp", spp, "--seed", seed) for spp, seed in ((7, 1), (16, 2))]
        for name in ("object.Y", "material.Y"):
            self.assertEqual(shots[0].layers[name], shots[1].layers[name])
        seen = set(zip(shots[0].values("object.Y"), shots[0].values("material.Y")))
        self.assertGreater(len(seen), 4)
        for node, material in seen - {(0, 0)}:
            self.assertIn(material, numbers[node])
        self.assertEqual({node for node, _ in seen} - {0}, set(numbers))

    def test_instances_have_their_nodes(self):
        """However they are kept."""
        flat, shared = (self.layers(self.instances(), "--resolution", "32,16", "--instancing", kind, "--spp", 2) for kind in ("flatten", "share"))
        self.assertEqual(flat.layers["object.Y"], shared.layers["object.Y"])
        self.assertEqual(set(flat.values("object.Y")), {0, 1, 3, 4})

    def instances(self):
        gltf = json.loads((SCENES / "cornell-box.gltf").read_text())
        gltf["nodes"] = [{"mesh": 0, "translation": [-3, 0, 0]}, {"extras": {}}, {"mesh": 0}, {"mesh": 0, "translation": [3, 0, 0]}]
        gltf["scenes"] = [{"nodes": [0, 1, 2, 3]}]
        for key in ("extensions", "extensionsUsed", "extensionsRequired", "cameras"):
            gltf.pop(key, None)
        return str(self.written("instances.gltf", gltf).with_suffix(""))


class LayerFiles(Case):
    def test_names_and_order(self):
        every = self.picture("cornell-box", "x.exr", "--resolution", "8,8", "--spp", 4, "--aov",
                             "variance,depth,samples,normal,albedo")
        self.assertEqual(sorted(every.layers), sorted(["R", "G", "B", "samples.Y", "variance.Y", *sum(NAMES.values(), [])]))
        self.assertEqual(sorted(self.picture("cornell-box", "x.exr", "--resolution", "8,8", "--spp", 4).layers), ["B", "G", "R"])

    def test_order_and_duplicates_change_no_byte(self):
        files = []
        for i, layers in enumerate((["normal,albedo,samples"], ["samples,albedo,albedo,normal,normal"],
                                    ["albedo", "--aov", "samples", "--aov", "normal"])):
            path = self.folder / f"{i}.exr"
            self.renders(BOX, "-o", path, "--quiet", "--resolution", "8,8", "--spp", 4, "--aov", *layers)
            files.append(path.read_bytes())
        self.assertEqual(files[0], files[1])
        self.assertEqual(files[0], files[2])

    def test_layers_change_nothing_of_the_picture(self):
        plain = self.picture("cornell-box", "a.exr", "--resolution", "8,8", "--spp", 4)
        layered = self.picture("cornell-box", "b.exr", "--resolution", "8,8", "--spp", 4, "--aov", "albedo,depth,variance")
        for channel in "RGB":
            self.assertEqual(plain.values(channel), layered.values(channel))

    def test_the_variance_is_that_of_the_mean_of_independent_samples(self):
        pictures = [self.picture("cornell-box", "x.exr", "--resolution", "8,8", "--spp", 64, "--disable", "sobol", "--seed", s,
                                 "--aov", "variance,samples", "--bounces", 1) for s in range(12)]
        columns = list(zip(*(p.luminances() for p in pictures)))
        seen = sum(sum((v - sum(c) / 12) ** 2 for v in c) / 11 for c in columns)
        stated = sum(sum(p.values("variance.Y")) for p in pictures) / 12
        # 64 pixels x 11 degrees of freedom, though a few bright pixels weigh most.
        self.assertAlmostEqual(seen / stated, 1, delta=0.35)
        self.assertEqual(set(pictures[0].values("samples.Y")), {64})

    def test_variances_tell_bias_from_noise(self):
        """diff --metric bias: another seed is no bias, a bounce less is one, and is dark."""
        def drawn(name, *options):
            self.renders(BOX, "-o", self.folder / name, "--quiet", "--resolution", "64,64", "--spp", 16, "--disable", "sobol", *options)
            return self.folder / name

        def told(*files):
            """Returns the chance, the number of tiles with noise, and the numbers of tiles by their p."""
            chance, noisy, _, tiles = run("diff", *files, "--metric", "bias").stdout.splitlines()
            return float(chance), int(noisy.split()[0]), [int(word) for word in tiles.split(":")[1].split()]
        aov = ("--aov", "variance")
        one, other = (drawn(f"{seed}.exr", "--seed", seed, "--bounces", 3, *aov) for seed in (1, 2))
        fewer = drawn("fewer.exr", "--seed", 3, "--bounces", 2, *aov)
        chance, noisy, tiles = told(one, other)
        self.assertGreater(chance, 0.01)
        self.assertEqual((noisy, sum(tiles)), (16, 16))
        self.assertLess(told(fewer, one)[0], 1e-6)
        for pair, status in (((one, other), 0), ((fewer, one), 1)):
            self.assertEqual(run("diff", *pair, "--metric", "bias", "--threshold", 1e-3).returncode, status)
        marks = self.folder / "marks.pfm"
        self.assertIn("4 of 4 tiles of 32 x 32", run("diff", fewer, one, "--metric", "bias", "--tile", 32, "--outfile", marks).stdout)
        red, green, blue = read_pfm(marks)[40][40]
        self.assertEqual((red, blue), (green, 1))  # darker: blue
        self.assertLess(red, 0.5)
        # The message names the missing layer and the option that writes it.
        self.fails(1, "diff", drawn("plain.exr", "--seed", 1), one, "--metric", "bias", says=["the picture has no layer variance.Y", "--aov variance"])
        self.fails(2, "diff", one, other, "--tile", 8, says=["--tile"])

    def test_only_exr_holds_layers(self):
        for name in ("x.png", "x.jpg", "x.pfm", "x.hdr"):
            self.fails(2, "render", BOX, "-o", self.folder / name, "--aov", "albedo", says=["--aov"])
        self.fails(2, "render", BOX, "-o", self.folder / "x.exr", "--aov", "albedo,colour", says=["colour"])

    def test_statistics_say_what_the_layers_took(self):
        for extra, there in ((["--aov", "depth"], True), (["--aov", "samples"], False)):
            self.renders(BOX, "-o", self.folder / "x.exr", "--quiet", "--resolution", "8,8", "--spp", 4, *extra, "--stats",
                         self.folder / "s.json")
            self.assertEqual("feature_ms" in json.loads((self.folder / "s.json").read_text()), there)


LAYERS = [f"0{i}.{c}" for i in range(3) for c in "RGBA"]


def hex_of(value):
    """Returns the 8 digits of a float's bits, as in the manifest."""
    return "%08x" % struct.unpack("<I", struct.pack("<f", value))


class Cryptomatte(Case):
    """--aov crypto-object and crypto-material, whose layers other programs read."""
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


LIGHT_GROUPS_BOX = json.loads((SCENES / "cornell-box.gltf").read_text())


class LightGroups(Case):
    """The light of some lamps alone: --aov light:NAME."""

    def scene(self):
        """The Cornell box with a point light, an unlit wall, and a block that lets half of the light pass."""
        gltf = json.loads(json.dumps(LIGHT_GROUPS_BOX))
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

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Animated files at one moment against files in which that pose stands."""
import json
import math

from support import SCENES, SMALL, Case, Gltf, main, run

VIEW = ["--resolution", "96,64", "--spp", "16", "--camera-position", "2,1.5,5", "--camera-focal-point", "0.6,1.3,0",
        "--background-color", "0.2,0.3,0.4", "--quiet"]


def cylinder(around=16, along=12):
    """Returns positions, normals and triangles of a tube of radius 0.5 from y = 0 to 2."""
    positions, normals, triangles = [], [], []
    for j in range(along + 1):
        for i in range(around + 1):
            angle = 2 * math.pi * i / around
            normals.append((math.cos(angle), 0.0, math.sin(angle)))
            positions.append((0.5 * math.cos(angle), 2.0 * j / along, 0.5 * math.sin(angle)))
    for j in range(along):
        for i in range(around):
            a, b = j * (around + 1) + i, (j + 1) * (around + 1) + i
            triangles += [(a, b, a + 1), (a + 1, b, b + 1)]
    return positions, normals, triangles


def bulge(position, normal):
    size = 0.6 * math.sin(math.pi * position[1] / 2)
    return tuple(size * n for n in normal)


def weight(position):
    """Returns the weight of the upper joint."""
    return min(max(position[1] - 0.5, 0.0), 1.0)


def turned(v, degrees):
    """Turns a vector about z."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return (c * v[0] - s * v[1], s * v[0] + c * v[1], v[2])


def animated(path):
    """A tube that bends by 80 degrees about (0, 1, 0), bulges and turns from grey to red within two seconds."""
    gltf = Gltf()
    positions, normals, triangles = cylinder()
    weights = [weight(p) for p in positions]
    attributes = {"POSITION": gltf.accessor(positions), "NORMAL": gltf.accessor(normals),
                  "JOINTS_0": gltf.accessor([(0, 1, 0, 0)] * len(positions), "B"),
                  "WEIGHTS_0": gltf.accessor([(1 - w, w, 0, 0) for w in weights])}
    target = {"POSITION": gltf.accessor([bulge(p, n) for p, n in zip(positions, normals)])}
    indices = gltf.accessor([i for t in triangles for i in t], "H")
    identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
    bind = gltf.accessor([identity, identity[:13] + [-1] + identity[14:]])
    times = gltf.accessor([0, 2])
    half = math.radians(-80) / 2
    turn = gltf.accessor([(0, 0, 0, 1), (0, 0, -math.sin(half), -math.cos(half))])  # the long way, as written
    zero = [0.0]
    grow = gltf.accessor(zero + zero + zero + zero + [1.0] + zero)  # a spline with level tangents
    paint = gltf.accessor([(0.5, 0.5, 0.5, 1), (0.9, 0.1, 0.1, 1)])
    gltf.root.update({
        "extensionsUsed": ["KHR_animation_pointer"],
        "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0, "skin": 0, "translation": [9, 9, 9]}, {"children": [2]}, {"translation": [0, 1, 0]}],
        "skins": [{"joints": [1, 2], "inverseBindMatrices": bind}],
        "materials": [{"doubleSided": True, "pbrMetallicRoughness": {"metallicFactor": 0}}],
        "meshes": [{"primitives": [{"attributes": attributes, "indices": indices, "targets": [target], "material": 0}]}],
        "animations": [{
            "name": "bend",
            "samplers": [{"input": times, "output": turn}, {"input": times, "output": paint},
                         {"input": times, "output": grow, "interpolation": "CUBICSPLINE"}],
            "channels": [
                {"sampler": 0, "target": {"node": 2, "path": "rotation"}},
                {"sampler": 2, "target": {"node": 0, "path": "weights"}},
                {"sampler": 1, "target": {"path": "pointer", "extensions": {"KHR_animation_pointer": {
                    "pointer": "/materials/0/pbrMetallicRoughness/baseColorFactor"}}}}]}]})
    return gltf.write(path)


def baked(path, seconds):
    """Writes the pose at that time as plain triangles."""
    gltf = Gltf()
    positions, normals, triangles = cylinder()
    part = seconds / 2
    grown = 3 * part**2 - 2 * part**3
    placed, shaded = [], []
    for p, n in zip(positions, normals):
        p = [a + grown * b for a, b in zip(p, bulge(p, n))]
        w = weight(p)
        moved = turned((p[0], p[1] - 1, p[2]), -80 * part)
        placed.append((p[0] + w * (moved[0] - p[0]), p[1] + w * (moved[1] + 1 - p[1]), p[2]))
        # Normals are multiplied by the cofactors of M = (1 - w) I + w R about z. The third row and column of M are
        # those of the identity.
        c, s = (f(math.radians(-80 * part)) for f in (math.cos, math.sin))
        a, b = 1 - w + w * c, w * s
        m = (a * n[0] - b * n[1], b * n[0] + a * n[1], (a * a + b * b) * n[2])
        length = math.sqrt(sum(x * x for x in m))
        shaded.append(tuple(x / length for x in m))
    mix = [(1 - part) * x + part * y for x, y in zip((0.5, 0.5, 0.5, 1), (0.9, 0.1, 0.1, 1))]
    attributes = {"POSITION": gltf.accessor(placed), "NORMAL": gltf.accessor(shaded)}
    indices = gltf.accessor([i for t in triangles for i in t], "H")
    gltf.root.update({
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "materials": [{"doubleSided": True, "pbrMetallicRoughness": {"metallicFactor": 0, "baseColorFactor": mix}}],
        "meshes": [{"primitives": [{"attributes": attributes, "indices": indices, "material": 0}]}]})
    return gltf.write(path)


class Poses(Case):
    def render(self, name, scene, *options):
        path = self.folder / name
        result = run("render", scene, "-o", path, *VIEW, *options)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return path

    def difference(self, picture, reference):
        return float(run("diff", picture, reference).stdout.split()[-1])

    def test_a_pose_of_an_animation_is_the_picture_of_the_baked_pose(self):
        scene = animated(self.folder / "tube.gltf")
        rest = self.render("rest.exr", scene)
        before = rest
        for seconds in (0.5, 1.5):
            picture = self.render(f"at-{seconds}.exr", scene, "--animation-time", seconds, "--animation", "bend")
            reference = self.render(f"baked-{seconds}.exr", baked(self.folder / f"baked-{seconds}.gltf", seconds))
            # The same samples; on edges, rounding may decide what a few of them hit.
            self.assertLess(self.difference(picture, reference), 0.004, seconds)
            self.assertGreater(self.difference(picture, before), 0.03, seconds)
            before = picture

    def test_times_outside_of_the_animation_are_those_of_its_ends(self):
        scene = animated(self.folder / "tube.gltf")
        last = self.render("last.exr", scene, "--animation-time", "2")
        self.assertEqual(self.difference(self.render("after.exr", scene, "--animation-time", "1e9"), last), 0.0)


class SeveralAnimations(Case):
    """Two triangles, of which each has an animation."""

    def scene(self, names=("left", "right")):
        gltf = Gltf()
        triangle = gltf.accessor([(0, 0, 0), (1, 0, 0), (0, 1, 0)])
        times = [gltf.accessor([0, last]) for last in (1, 2)]
        ways = [gltf.accessor([(x, 0, 0), (x, 1, 0)]) for x in (-2, 2)]
        gltf.root["meshes"] = [{"primitives": [{"attributes": {"POSITION": triangle}}]}]
        gltf.root["nodes"] = [{"mesh": 0}, {"mesh": 0}]
        gltf.root["scenes"] = [{"nodes": [0, 1]}]
        gltf.root["animations"] = [{"name": name, "samplers": [{"input": times[i], "output": ways[i]}],
                                    "channels": [{"sampler": 0, "target": {"node": i, "path": "translation"}}]} for i, name in enumerate(names)]
        return gltf.write(self.folder / "two.gltf")

    def bounds(self, *options, names=("left", "right")):
        """Left, top and right of what is drawn, and what is said."""
        result = run("info", self.scene(names), "--json", *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        bounds = json.loads(result.stdout)["scene"]["bounds"]
        return [bounds["min"][0], bounds["max"][1], bounds["max"][0]], result.stderr

    def test_all_play_at_once(self):
        self.assertEqual(self.bounds("--animation-time", 1, "--animation", "all"), ([-2, 2, 3], ""))
        self.assertEqual(self.bounds("--animation-time", 1, "--animation", "all", names=("one", "all"))[0], [0, 1.5, 3])  # one that is called so

    def test_what_is_not_played_is_said(self):
        place, said = self.bounds("--animation-time", 1)
        self.assertEqual(place, [-2, 2, 1])
        self.assertIn("/animations: not played: 1 of 2 (--animation all plays all at once", said)
        self.assertEqual(self.bounds("--animation-time", 1, "--animation", "left")[1], "")
        self.assertEqual(self.bounds("--animation-time", 1, "--strict")[0], [-2, 2, 1])  # it is no fault of the file
        self.assertEqual(self.bounds()[1], "")

    def test_a_name_alone_shows_the_first_moment(self):
        self.assertEqual(self.bounds(), ([0, 1, 1], ""))
        self.assertEqual(self.bounds("--animation", "right"), ([0, 1, 3], ""))
        self.assertEqual(self.bounds("--animation", "all"), ([-2, 1, 3], ""))

    def test_a_film_of_all_is_as_long_as_the_longest(self):
        result = run("render", self.scene(), "-o", self.folder / "x.#.png", *SMALL[:4], "--animation", "all", "--frames", "46:49", "--stage", "flat")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("the animation ends after 2 s, at picture 48", result.stderr)


class Selections(Case):
    def test_parts_that_are_not_in_the_file_are_named_with_those_that_are(self):
        scene = animated(self.folder / "tube.gltf")
        for options, text in ((["--animation", "walk", "--animation-time", "0"], 'has 0 "bend"'),
                              (["--scene", "1"], "has 0"),
                              (["--material-variant", "x"], "has none"), (["--animation-time", "-1"], "from 0 on"),
                              (["--animation-time", "nan"], "from 0 on"), (["--animation-time", "inf"], "from 0 on")):
            result = run("info", scene, *options)
            self.assertEqual(result.returncode, 2, options)
            self.assertIn(text, result.stderr)
            self.assertEqual(len(result.stderr.strip().splitlines()), 1)

    def test_info_lists_what_can_be_chosen(self):
        found = json.loads(run("info", animated(self.folder / "tube.gltf"), "--json").stdout)
        self.assertEqual(found["animation_names"], ["bend"])
        self.assertEqual(found["scene_names"], [""])
        self.assertEqual(found["material_variants"], [])
        empty = self.written("empty.gltf", {"asset": {"version": "2.0"}})
        for scene, cameras in ((SCENES / "plastics.gltf", "1: "), (empty, "none\n")):
            self.assertRegex(run("info", scene, "--verbose").stdout, rf"(?s)\n  cameras     {cameras}.*GPU memory ", scene)

    def test_the_up_axis_is_turned_to_y(self):
        """--up turns the scene as a node above all others would."""
        plain = json.loads(run("info", SCENES / "transforms.gltf", "--json").stdout)["scene"]["bounds"]
        found = json.loads(run("info", SCENES / "transforms.gltf", "--json", "--up", "-z").stdout)["scene"]["bounds"]
        (x, y, z), (right, top, front) = plain["min"], plain["max"]
        self.assertEqual(found, {"min": [x, -front, y], "max": [right, -z, top]})
        root = json.loads((SCENES / "lights.gltf").read_text())
        root["nodes"].append({"children": root["scenes"][0]["nodes"], "matrix": [1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1]})
        root["scenes"][0]["nodes"] = [len(root["nodes"]) - 1]
        turned = self.written("turned.gltf", root)
        for name, scene, options in (("node", turned, []), ("option", SCENES / "lights.gltf", ["--up", "Z"]), ("direction", SCENES / "lights.gltf", ["--up", "0,0,7.5"])):
            self.renders(scene, "-o", self.folder / f"{name}.pfm", *SMALL, *options)
            self.assertEqual((self.folder / "node.pfm").read_bytes(), (self.folder / f"{name}.pfm").read_bytes(), name)

    def test_any_direction_may_point_up(self):
        """A turn by 30 degrees about Z moves what lies on the Z axis nowhere; a message reports errors."""
        up = (math.sin(math.radians(30)), math.cos(math.radians(30)), 0)
        gltf = Gltf()
        corner = [(x, y, z) for x, y, z in ((0, 0, 1), (2 * up[0], 2 * up[1], 0), (3 * up[1], -3 * up[0], 0))]
        gltf.root.update(scenes=[{"nodes": [0]}], nodes=[{"mesh": 0}], meshes=[{"primitives": [{"attributes": {"POSITION": gltf.accessor(corner)}}]}])
        scene = gltf.write(self.folder / "tilted.gltf")
        found = json.loads(run("info", scene, "--json", "--up", ",".join(map(str, up))).stdout)["scene"]["bounds"]
        for bound, expected in (("min", (0, 0, 0)), ("max", (3, 2, 1))):
            for a, b in zip(found[bound], expected, strict=True):
                self.assertAlmostEqual(a, b, places=6)
        for word, says in (("0,0,0", "--up: is zero"), ("w", "--up: 'w' is none of x, y, z, -x, -y, -z, and no direction X,Y,Z"), ("1,2", "'1,2' is none of"),
                           ("1,2,", "'1,2,' is none of"), ("1,2,nan", "'1,2,nan' is none of"), ("1,2,3,4", "'1,2,3,4' is none of")):
            self.fails(2, "info", scene, "--up", word, says=[says])

    def test_nodes_are_listed_and_hidden(self):
        scene = SCENES / "plastics.gltf"
        text = run("info", scene, "--nodes").stdout
        self.assertIn('    1 "lamp", mesh\n', text)
        found = json.loads(run("info", scene, "--nodes", "--json", "--hide", "lamp", "--hide", "7").stdout)
        self.assertEqual([node["name"] for node in found["nodes"] if node["hidden"]], ["lamp", "sphere-3"])
        self.assertEqual(found["scene"]["spheres"], 3)
        self.assertNotIn("nodes", json.loads(run("info", scene, "--json").stdout))
        found = json.loads(run("info", scene, "--nodes", "--json", "--hide", "LAMP").stdout)
        self.assertEqual([node["name"] for node in found["nodes"] if node["hidden"]], ["lamp"])
        result = run("info", scene, "--hide", "nothere")
        self.assertEqual(result.returncode, 2)
        self.assertIn('--hide: "nothere" is no node of the file, which has 0 "', result.stderr)
        self.assertIn('"lamp"', result.stderr)
        many = Gltf()
        for name in (*(f"screw {i}" for i in range(30)), "Lamp shade"):
            many.node(name=name)
        result = run("info", many.write(self.folder / "many.gltf"), "--hide", "lamp")
        self.assertIn('--hide: "lamp" is no node of the file, which has 30 "Lamp shade", ', result.stderr)
        self.assertIn(" and 19 others; `fragtrace info --nodes` lists all", result.stderr)

    def test_a_file_without_animations_is_drawn_with_a_warning(self):
        result = run("info", SCENES / "cornell-box.gltf", "--animation-time", "1")
        self.assertEqual(result.returncode, 0)
        self.assertIn("no animation", result.stderr)


if __name__ == "__main__":
    main()

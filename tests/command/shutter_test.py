#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""--shutter against the mean of 64 exact times, which one sequence draws."""
import json
import math

from support import SCENES, Case, Exr, Gltf, main, run

WIDTH, HEIGHT = 64, 36
SIZE = ["--resolution", f"{WIDTH},{HEIGHT}"]
TIMES = 64
TILE = 4


def tiles(values):
    """Means of square tiles."""
    result = []
    for y in range(0, HEIGHT, TILE):
        for x in range(0, WIDTH, TILE):
            result.append(sum(values[j * WIDTH + i] for j in range(y, y + TILE) for i in range(x, x + TILE)) / TILE ** 2)
    return result


def animated_sphere(path, times=(0, 1), kind="LINEAR", **keys):
    """scenes/sphere-plane.gltf whose sphere is moved or turned by these keys."""
    root = json.loads((SCENES / "sphere-plane.gltf").read_text())
    node = next(i for i, n in enumerate(root["nodes"]) if "shape" in n.get("extras", {}))
    gltf = Gltf(root)
    gltf.moves(node, times, **keys)["samplers"][0]["interpolation"] = kind
    return gltf.write(path)


def wheel_with(path, name, times, values):
    """Writes scenes/wheel.gltf with other keys of one node."""
    root = json.loads((SCENES / "wheel.gltf").read_text())
    path.with_name("wheel.bin").write_bytes((SCENES / "wheel.bin").read_bytes())
    channel = next(c for c in root["animations"][0]["channels"] if root["nodes"][c["target"]["node"]]["name"] == name)
    sampler = root["animations"][0]["samplers"][channel["sampler"]]
    gltf = Gltf(root)
    sampler |= {"input": gltf.accessor(times), "output": gltf.accessor(values)}
    return gltf.write(path)


class Shutter(Case):
    def blurred(self, scene, time, seconds, *options):
        path = self.folder / "blurred.exr"
        self.renders(scene, "-o", path, "--quiet", *SIZE, "--animation-time", time, "--shutter", 360, "--fps", 1 / seconds, *options)
        return Exr(path)

    def exact(self, scene, time, seconds, *options):
        """The mean of each layer over the middles of 64 equal parts of the time."""
        fps = 2 * TIMES / seconds
        middle = round(time * fps)
        self.assertAlmostEqual(middle, time * fps, delta=1e-6)
        self.renders(scene, "-o", self.folder / "exact.######.exr", "--quiet", *SIZE, "--fps", fps, "--frames",
                     f"{middle - TIMES + 1}:{middle + TIMES - 1}:2", *options)
        sums = {}
        for path in self.folder.glob("exact.*.exr"):
            exr = Exr(path)
            for name in exr.layers:
                values = exr.values(name)
                sums[name] = [a + b for a, b in zip(sums.get(name, [0] * len(values)), values)]
            path.unlink()
        return {name: [v / TIMES for v in values] for name, values in sums.items()}

    def assert_close(self, exr, exact, most, of, names="RGB"):
        """Tiles differ by at most so much of the layer's size, which is its largest tile; and by a fourth of that on the whole."""
        for name in names:
            ours, wanted = tiles(exr.values(name)), tiles(exact[name])
            size = 1 if "ormal" in name else max(wanted)
            off = [(a - b) / size for a, b in zip(ours, wanted)]
            self.assertLess(max(map(abs, off)), most, (of, name))
            self.assertLess(abs(sum(off)) / len(off), most / 4, (of, name))

    def test_surfaces_and_camera(self):
        """The flat stage has no noise but that of edges. There are as many segments as the lamp needs, whose turn in each is at most 8 degrees."""
        wheel = SCENES / "wheel.gltf"
        stats = self.folder / "stats.json"
        layers = ["R", "G", "B", "depth.Z", *(f"{kind}.{axis}" for kind in ("normal", "geometric-normal") for axis in "XYZ")]
        for camera, fps, segments, most, names in (("camera", 64, 2, 0.012, "RGB"), ("camera", 14, 8, 0.025, "RGB"), ("follower", 64, 2, 0.025, layers)):
            options = ["--camera", camera, "--stage", "flat", "--no-background", *(["--aov", "depth,normal,geometric-normal"] if names == layers else [])]
            blurred = self.blurred(wheel, 0.25, 1 / fps, *options, "--spp", 2048, "--stats", stats)
            exact = self.exact(wheel, 0.25, 1 / fps, *options, "--spp", 32)
            self.assert_close(blurred, exact, most, (camera, fps), [n for n in names if not n.endswith(".X")])
            self.assert_close(blurred, exact, 0.012, (camera, fps), [n for n in names if n.endswith(".X")])
            motion = json.loads(stats.read_text())["motion"]
            self.assertLessEqual(motion["pixels_off"], 0.5)
            self.assertEqual(motion["segments"], segments, fps)

    def test_light_of_lamps_that_move(self):
        """Light samples find a lamp where it is at the path's time, with all ways to choose it, and scattered rays find it as well."""
        wheel = SCENES / "wheel.gltf"
        options = ["--camera", "follower", "--bounces", 1, "--hide", "lamp"]
        for most, stage, ways in ((0.04, [], ((512, "--light-selection", "tree"), (512, "--light-selection", "power"),
                                              (512, "--dispatch", "compute", "--light-reuse", "candidates"), (2048, "--disable", "light-sampling"))),
                                  (0.03, ["--stage", "shadows"], ((512,),))):
            exact = tiles(self.exact(wheel, 0.25, 1 / 32, *options, *stage, "--spp", 16)["R"])
            dark = [i for i, value in enumerate(exact) if value < 0.3]  # the lamp itself is not among these
            wanted = sum(exact[i] for i in dark)
            for spp, *way in ways:
                ours = tiles(self.blurred(wheel, 0.25, 1 / 32, *options, *stage, "--spp", spp, *way).values("R"))
                self.assertLess(abs(sum(ours[i] for i in dark) / wanted - 1), most, (way, stage))
        tunes = [self.blurred(wheel, 0.25, 1 / 32, *options, "--light-selection", "power", "--spp", 16, "--tune", tune).values("R") for tune in ("software", "gpu")]
        self.assertEqual(*tunes)

    def test_a_sphere(self):
        scene = animated_sphere(self.folder / "moving.gltf", translation=((-0.4, 0.2, 0), (0.6, 0.5, 0.3)), scale=((1, 1, 1), (0.6, 0.6, 0.6)))
        options = ["--stage", "shadows"]
        self.assert_close(self.blurred(scene, 0.5, 0.5, *options, "--spp", 2048), self.exact(scene, 0.5, 0.5, *options, "--spp", 32), 0.012, "sphere")

    def test_a_turn(self):
        """The pictures of a whole turn with an open shutter have one mean, however many they are, which is that of many sharp ones."""
        means = []
        for pictures, shutter, spp in ((1, 360, 4096), (3, 360, 1024), (64, 0, 32)):
            self.renders(SCENES / "plastics.gltf", "-o", self.folder / "turn.##.exr", "--quiet", *SIZE, "--stage", "flat", "--camera-type", "orthographic", "--turntable", pictures,
                         "--shutter", shutter, "--spp", spp, "--aov", "depth", "--no-background")
            layers = [Exr(path) for path in sorted(self.folder.glob("turn.*.exr"))]
            self.assertEqual(len(layers), pictures)
            means.append({name: [sum(v) / pictures for v in zip(*(e.values(name) for e in layers))] for name in ("R", "G", "B", "A", "depth.Z")})
            for path in self.folder.glob("turn.*.exr"):
                path.unlink()
        for mean in means[:2]:
            for name, values in mean.items():
                ours, wanted = tiles(values), tiles(means[2][name])
                self.assertLess(max(abs(a - b) for a, b in zip(ours, wanted)) / max(wanted), 0.02, name)

    def test_keys_while_it_is_open(self):
        """Motion is measured at the keys: what comes back where it began, or stands as before at the quarters of the time, is no standing still."""
        stats = self.folder / "stats.json"
        shaken = wheel_with(self.folder / "shaken.gltf", "follower", [k / 8 for k in range(5)], [(-1 + 0.4 * (-1) ** k, 1.4, 5) for k in range(5)])
        options = ["--camera", "follower", "--stage", "flat", "--hide", "roll"]
        blurred = self.blurred(shaken, 0.25, 0.25, *options, "--spp", 1024, "--stats", stats)
        self.assert_close(blurred, self.exact(shaken, 0.25, 0.25, *options, "--spp", 16), 0.03, "shaken")
        written = json.loads(stats.read_text())
        self.assertEqual((written["camera_motion"]["segments"], written.get("motion")), (2, None))
        turns = [tuple(math.sin(math.radians(-22.5 * k)) * x for x in (0, 0, 1)) + (math.cos(math.radians(-22.5 * k)),) for k in range(33)]
        spun = wheel_with(self.folder / "spun.gltf", "spin", [k / 64 for k in range(33)], turns)
        said = self.renders(spun, "-o", self.folder / "x.pfm", *SIZE, "--spp", 1, "--animation-time", 0.25, "--shutter", 360, "--fps", 2, "--stats", stats, "--camera", "follower").stderr
        self.assertEqual(json.loads(stats.read_text())["motion"]["segments"], 32)
        self.assertIn("surfaces move straight in 32 pieces", said)

    def test_a_lamp_keeps_its_light(self):
        """Straight ways would make a lamp that turns smaller, however few pixels it has."""
        stats = self.folder / "stats.json"
        self.renders(SCENES / "wheel.gltf", "-o", self.folder / "x.pfm", "--quiet", "--resolution", "8,4", "--spp", 1, "--animation-time", 0.25, "--shutter", 360, "--fps", 8,
                     "--stats", stats)
        self.assertEqual(json.loads(stats.read_text())["motion"]["segments"], 16, "a sixteenth of a quarter turn loses 0.24 % of the area")

    def test_what_reaches_beyond_the_picture(self):
        """The blade's ends are far outside the picture. Only the part within counts."""
        stats = self.folder / "stats.json"
        wheel_with(self.folder / "long.gltf", "spin", [0, 0.25], [(0, 0, 0, 1), (0, 0, math.sin(-0.4), math.cos(-0.4))])
        root = json.loads((self.folder / "long.gltf").read_text())
        next(n for n in root["nodes"] if n["name"] == "spoke-0")["scale"] = [400, 1, 1]
        (self.folder / "long.gltf").write_text(json.dumps(root))
        self.renders(self.folder / "long.gltf", "-o", self.folder / "x.pfm", "--quiet", *SIZE, "--spp", 1, "--animation-time", 0.125, "--shutter", 360, "--fps", 2, "--stats", stats,
                     "--hide", "light", "--hide", "tyre", "--camera", "follower")
        motion = json.loads(stats.read_text())["motion"]
        self.assertEqual(motion["segments"], 4)
        self.assertGreater(motion["pixels_off"], 0.1)

    def seen(self, scene, time, *options, shutter=360, fps=8):
        """The first and the last column in which the sphere is seen, and the pixels that it covers."""
        self.renders(scene, "-o", self.folder / "x.exr", "--quiet", *SIZE, "--animation-time", time, "--fps", fps, "--shutter", shutter, "--stage", "flat", "--spp", 256,
                     "--no-background", "--hide", "ground", *options)
        alpha = Exr(self.folder / "x.exr").layers["A"]
        columns = [x for x in range(WIDTH) if any(row[x] > 0 for row in alpha)]
        return columns[0], columns[-1], sum(map(sum, alpha))

    def test_the_ends_of_an_animation_are_as_blurred_as_its_middle(self):
        scene = animated_sphere(self.folder / "moving.gltf", translation=((-0.6, 0.2, 0), (0.6, 0.2, 0)))
        left, right, light = self.seen(scene, 0.5, fps=2)
        for time in (0.0, 1.0):
            first, last, covered = self.seen(scene, time, fps=2)
            self.assertAlmostEqual(last - first, right - left, delta=1, msg=time)
            self.assertAlmostEqual(covered / light, 1, delta=0.02, msg=time)
        sharp = self.seen(scene, 0.0, shutter=0)
        self.assertAlmostEqual(sum(self.seen(scene, 0.0, fps=2)[:2]), sum(sharp[:2]), delta=2)  # as far before as after
        self.assertEqual(self.seen(scene, 1.3, fps=2), self.seen(scene, 1.3, shutter=0))

    def test_a_cut_does_not_smear(self):
        """Steps, and keys at the same time, change between two pictures. Each shows its own side."""
        for times, values, kind in (((0, 0.5), (-0.6, 0.6), "STEP"), ((0, 0.5, 0.5, 1), (-0.6, -0.6, 0.6, 0.6), "LINEAR")):
            scene = animated_sphere(self.folder / "cut.gltf", times, kind, translation=[(v, 0.2, 0) for v in values])
            for time in (0.45, 0.5):
                self.assertEqual(self.seen(scene, time), self.seen(scene, time, shutter=0), (kind, time))
            self.assertNotEqual(self.seen(scene, 0.45)[0], self.seen(scene, 0.5)[0])

    def test_a_node_that_is_toggled_stops_nothing_else(self):
        """It is there, or not, as at the picture's moment."""
        scene = animated_sphere(self.folder / "toggled.gltf", translation=((-0.6, 0.2, 0), (0.6, 0.2, 0)))
        gltf = Gltf(json.loads(scene.read_text()))
        root = gltf.root
        node = next(i for i, n in enumerate(root["nodes"]) if n.get("name") == "ground")
        root["nodes"][node]["extensions"] = {"KHR_node_visibility": {"visible": True}}
        root["extensionsUsed"] += ["KHR_node_visibility", "KHR_animation_pointer"]
        animation = root["animations"][0]
        pointer = {"pointer": f"/nodes/{node}/extensions/KHR_node_visibility/visible"}
        animation["channels"].append({"sampler": len(animation["samplers"]), "target": {"path": "pointer", "extensions": {"KHR_animation_pointer": pointer}}})
        animation["samplers"].append({"input": animation["samplers"][0]["input"], "output": gltf.accessor([1, 0], "B"), "interpolation": "STEP"})
        gltf.write(self.folder / "t.gltf")
        stats = self.folder / "s.json"
        for time, triangles in ((0.97, 2), (1.0, 0)):
            self.renders(self.folder / "t.gltf", "-o", self.folder / "x.pfm", "--quiet", *SIZE, "--animation-time", time, "--fps", 8, "--shutter", 360, "--spp", 1, "--stats", stats)
            written = json.loads(stats.read_text())
            self.assertEqual((written["scene"]["triangles"], written["motion"]["segments"], written["warnings"]), (triangles, 1, []), time)

    def test_what_stands_still(self):
        """After its end an animation stands still: the picture is that without a shutter, and statistics say so."""
        stats = self.folder / "stats.json"
        still = self.picture("wheel", "still.pfm", *SIZE, "--spp", 4, "--animation-time", 2)
        open_ = self.picture("wheel", "open.pfm", *SIZE, "--spp", 4, "--animation-time", 2, "--shutter", 180, "--stats", stats)
        self.assertEqual(still, open_)
        self.assertIn("shutter: nothing moves while it is open", json.loads(stats.read_text())["skipped"])

    def test_a_picture_in_parts(self):
        """Regions and ranges of samples have the bits of the whole."""
        options = ["--animation-time", 0.25, "--shutter", 180, "--camera", "follower", *SIZE]
        whole = self.picture("wheel", "whole.exr", *options, "--spp", 8)
        region = self.picture("wheel", "region.exr", *options, "--spp", 8, "--region", "30,14,16,12")
        for name in "RGB":
            self.assertEqual([row[30:46] for row in whole.layers[name][14:26]], region.layers[name])
        for first in (0, 4):
            self.picture("wheel", f"part-{first}.exr", *options, "--spp", 4, "--sample-offset", first)
        merged = self.folder / "merged.exr"
        self.assertEqual(run("merge", self.folder / "part-0.exr", self.folder / "part-4.exr", "-o", merged).returncode, 0)
        for name in "RGB":
            for a, b in zip(Exr(merged).values(name), whole.values(name)):
                self.assertAlmostEqual(a, b, delta=1e-5 * max(1, abs(b)))
        other = self.folder / "other.exr"
        options[options.index(180)] = 90
        self.picture("wheel", other.name, *options, "--spp", 4, "--sample-offset", 4)
        self.fails(3, "merge", self.folder / "part-0.exr", other, "-o", self.folder / "no.exr", says=["shutter"])

    def test_goes_with(self):
        """Layers, filters, lenses, media and the catcher are drawn at the times of the picture."""
        options = ["--animation-time", 0.25, "--shutter", 180, "--resolution", "32,18", "--spp", 2]
        for more in (["--shadow-catcher", "bottom", "--denoise", "variance", "--f-stop", 1.4, "--camera", "follower"],
                     ["--fog-density", 0.02, "--schedule", "wavefront", "--stage", "gi", "--disable", "watertight"],
                     ["--camera-type", "panorama", "--aov", "object,material,crypto-object,emission,diffuse,depth"],
                     ["--aov", "light:glow", "--light-selection", "uniform"]):
            self.picture("wheel", "x.exr", *options, *more)

    def test_refusals(self):
        wheel = SCENES / "wheel.gltf"
        moving = ["render", wheel, "-o", self.folder / "x.png", "--animation-time", 0.1, "--shutter", 180]
        self.fails(2, "render", wheel, "-o", self.folder / "x.png", "--shutter", 180, says=["--shutter: goes with --frames, --turntable or --animation-time"])
        for option, words in (("--light-reuse", "spatial"), ("--caustics", "on"), ("--traversal", "iterative"), ("--traversal", "literals")):
            self.fails(2, *moving, option, words, says=[f"--shutter: not with {option} {words}"])
        self.fails(2, *moving[:-1], 400, says=["--shutter"])


if __name__ == "__main__":
    main()

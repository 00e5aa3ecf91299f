#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Sequences of pictures (--frames, --turntable). Each picture is that of a single command with its seed. What does not change is
kept, and a message names each picture that failed."""
import base64
import json
import shutil
import signal
import subprocess
import time
from statistics import correlation

from support import FRAGTRACE, SCENES, Case, Exr, Gltf, main, run

PLANE = SCENES / "mapped-plane.gltf"
SMALL = ["--resolution", "40,30", "--spp", "2", "--traversal", "front-to-back"]


class Sequences(Case):
    def setUp(self):
        super().setUp()
        self.scene = self.moving()

    def moving(self, name="moving.gltf", keys=((0.0, (0, 0, 0)), (1.0, (1, 0, 0))), scene=PLANE):
        """A scene, the plane with a texture, whose first mesh stands at these places at these times."""
        root = json.loads(scene.read_text())
        for image in root.get("images", ()):
            shutil.copy(SCENES / image["uri"], self.folder)
        for buffer in root["buffers"]:
            if not buffer["uri"].startswith("data:"):
                shutil.copy(SCENES / buffer["uri"], self.folder)
        node = next(i for i, n in enumerate(root["nodes"]) if "mesh" in n)
        root["nodes"][node].pop("matrix", None)
        root.pop("animations", None)
        gltf = Gltf(root)
        gltf.moves(node, [t for t, _ in keys], translation=[p for _, p in keys])
        return gltf.write(self.folder / name)

    def draw(self, *options, status=0):
        result = run("render", self.scene, "-o", self.folder / "x.##.exr", *SMALL, *options)
        self.assertEqual(result.returncode, status, result.stderr)
        return result

    def seed(self, number):
        return int(Exr(self.folder / f"x.{number:02}.exr").texts["fragtrace:seed"])

    def single(self, *options):
        path = self.folder / "single.exr"
        self.renders(self.scene, "-o", path, "--quiet", *SMALL, *options)
        return path.read_bytes()

    def test_each_frame_is_the_picture_of_a_single_command(self):
        layers = ["--aov", "albedo,depth", "--hdri-file", SCENES / "sky.pfm"]
        result = self.draw("--frames", "0:6:3", "--fps", 8, *layers)
        self.assertEqual(sorted(p.name for p in self.folder.glob("x.*")), ["x.00.exr", "x.03.exr", "x.06.exr"])
        self.assertEqual(len(result.stdout.splitlines()), 3)
        pictures = [(self.folder / f"x.{k:02}.exr").read_bytes() for k in (0, 3, 6)]
        self.assertEqual(len(set(pictures)), 3)
        for k, picture in zip((0, 3, 6), pictures):
            self.assertEqual(picture, self.single("--animation-time", k / 8, "--seed", self.seed(k), *layers), k)

    def test_noise_does_not_stand_still(self):
        """Nothing moves here. Each picture has a seed of its own, whichever pictures are asked for; picture 0 has that of the option."""
        self.scene = self.moving("still.gltf", ((0.0, (0, 0, 0)), (1.0, (0, 0, 0))), SCENES / "cornell-box.gltf")
        self.draw("--frames", "0:3", "--seed", 7, "--stats", self.folder / "s.##.json")
        pictures = [(self.folder / f"x.{k:02}.exr").read_bytes() for k in range(4)]
        seeds = [self.seed(k) for k in range(4)]
        self.assertEqual([json.loads((self.folder / f"s.{k:02}.json").read_text())["seed"] for k in range(4)], seeds)
        self.assertEqual((seeds[0], len(set(seeds))), (7, 4))
        self.assertEqual({seed % 2 for seed in seeds}, {1}, "those of second halves are even")
        self.draw("--frames", "2:3", "--seed", 7)
        self.assertEqual([(self.folder / f"x.{k:02}.exr").read_bytes() for k in range(4)], pictures)
        self.renders(self.scene, "-o", self.folder / "single.exr", "--quiet", *SMALL[:2], "--spp", 512, "--seed", 1)
        reference = Exr(self.folder / "single.exr").luminances()
        # Without the lamp, whose edges outweigh all other noise.
        noise_of = lambda k: [a - b for a, b in zip(Exr(self.folder / f"x.{k:02}.exr").luminances(), reference) if b < 1]
        first, *others = map(noise_of, range(4))
        for k, noise in enumerate(others, 1):
            self.assertLess(abs(correlation(first, noise)), 0.1, k)
        self.renders(self.scene, "-o", self.folder / "t.#.exr", *SMALL, "--turntable", 2)
        self.assertEqual([Exr(self.folder / f"t.{k}.exr").texts["fragtrace:seed"] for k in range(2)], ["0", str(seeds[1] ^ 7)])

    def test_the_scene_is_read_once(self):
        """It may come through a pipe; the camera for all frames is chosen from the same document."""
        root = json.loads(self.scene.read_text())
        for node in root["nodes"]:
            node.pop("camera", None)
        for part in [*root["images"], *root["buffers"]]:
            if not part["uri"].startswith("data:"):
                part["uri"] = "data:;base64," + base64.b64encode((SCENES / part["uri"]).read_bytes()).decode()
        self.scene.write_text(json.dumps(root))
        frames = ["--frames", "0:2", "--fps", 2, "--quiet"]
        self.draw(*frames)
        self.renders("/dev/stdin", "-o", self.folder / "p.##.exr", *SMALL, *frames, input=self.scene.read_text())
        for k in range(3):
            layers = [Exr(self.folder / f"{name}.{k:02}.exr").layers for name in "xp"]
            self.assertEqual(*layers, k)

    def test_a_turntable_begins_with_the_view_of_a_single_command_and_goes_round(self):
        self.draw("--turntable", 4)
        first, *others = ((self.folder / f"x.{k:02}.exr").read_bytes() for k in range(4))
        self.assertEqual(first, self.single())
        self.assertEqual(len({first, *others}), 4)

    def test_what_does_not_change_is_made_once(self):
        self.draw("--frames", "0:2", "--fps", 8, "--stats", self.folder / "s.##.json", "--hdri-file", SCENES / "sky.pfm")
        first, *later = (json.loads((self.folder / f"s.{k:02}.json").read_text()) for k in range(3))
        self.assertGreater(first["compile_ms"], 0)
        for stats in later:
            self.assertEqual(stats["compile_ms"], 0)
            self.assertLess(stats["scene_bytes"], first["scene_bytes"])  # neither texture nor environment
            self.assertFalse({"context", "program", "environment"} & {phase["name"] for phase in stats["phases"]})

    def test_a_tree_is_refitted_and_pictures_stay(self):
        self.scene = self.moving(scene=SCENES / "mesh-15743.gltf")
        frames = ["--frames", "0:2", "--fps", 8, *SMALL, "--quiet"]
        for kind, refitted in (("pfm", [False, True, True]), ("exr", [False] * 3)):
            self.renders(self.scene, "-o", self.folder / f"m.##.{kind}", "--stats", self.folder / f"{kind}.##.json", *frames)
            statistics = [json.loads((self.folder / f"{kind}.{k:02}.json").read_text()) for k in range(3)]
            self.assertEqual([one["bvh"]["refitted"] for one in statistics], refitted, kind)
        for k in range(3):
            result = run("diff", self.folder / f"m.{k:02}.pfm", self.folder / f"m.{k:02}.exr", "--metric", "max")
            self.assertEqual(result.stdout, "0\n", k)

    def test_continue_draws_what_is_missing(self):
        self.assertNotIn("ends after", self.draw("--frames", "0:3").stderr)
        self.assertIn("warning: --frames: the animation ends after 1 s, at picture 24;", self.draw("--frames", "1000:1001").stderr)
        before = {k: (self.folder / f"x.{k:02}.exr").stat().st_mtime_ns for k in range(4)}
        (self.folder / "x.02.exr").write_bytes(b"")  # a copy that crashed leaves such a file
        result = self.draw("--frames", "0:3", "--continue")
        self.assertEqual(len(result.stdout.splitlines()), 1)
        self.assertIn("3 of 4 pictures were there already", result.stderr)
        for k in (0, 1, 3):
            self.assertEqual((self.folder / f"x.{k:02}.exr").stat().st_mtime_ns, before[k])
        self.assertGreater((self.folder / "x.02.exr").stat().st_size, 0)

    def test_a_broken_frame_is_said_and_the_rest_is_drawn(self):
        # Between frames 1 and 3 the plane is farther away than floats reach.
        self.scene = self.moving("far.gltf", ((0.0, (0, 0, 0)), (1.5, (0, 0, 0)), (1.5, (3e38,) * 3), (2.5, (3e38,) * 3), (2.5, (0, 0, 0)), (4.0, (0, 0, 0))))
        result = self.draw("--frames", "0:4", "--fps", 1, "--quiet", status=1)
        self.assertIn("picture 2: ", result.stderr)
        self.assertIn("1 of 5 pictures failed", result.stderr)
        self.assertEqual(sorted(p.name for p in self.folder.glob("x.*")), ["x.00.exr", "x.01.exr", "x.03.exr", "x.04.exr"])
        self.assertEqual((self.folder / "x.03.exr").read_bytes(), self.single("--animation-time", 0, "--seed", self.seed(3)))

    def test_an_interrupted_sequence_leaves_whole_pictures_only(self):
        process = subprocess.Popen([FRAGTRACE, "render", self.scene, "-o", self.folder / "x.##.exr", "--resolution", "40,30", "--spp", "3000", "--quiet",
                                    "--frames", "0:90"])
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        while not (self.folder / "x.01.exr").exists():
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(20), 130)
        pictures = sorted(self.folder.glob("x.*.exr"))
        self.assertLess(len(pictures), 91)
        for path in pictures:
            self.assertIn(b"fragtrace:uniform\0string\0\1\0\0\0" + b"1", path.read_bytes())

    def test_one_camera_shows_all_frames_of_a_scene_without_one(self):
        """Its place is that of the whole animation, whichever frames are asked for, so that machines may share a film."""
        root = json.loads(self.scene.read_text())
        root.pop("cameras", None)
        for node in root["nodes"]:
            node.pop("camera", None)
        self.scene.write_text(json.dumps(root))
        places = lambda: [Exr(self.folder / f"x.{k:02}.exr").numbers["worldToCamera"] for k in (0, 12, 24)]
        for options in ([], ["--fit"], ["--camera-orbit", "30,20"], ["--camera-orbit", "30,20", "--fit"]):
            said = self.draw("--frames", "0:24:12", *options).stderr
            self.assertEqual(said.count("one camera shows the whole animation: --camera-position "), 1, said)
            first, *others = places()
            self.assertEqual(others, [first] * 2, options)
            self.draw("--frames", "12:12", *options)
            self.assertEqual(places()[1], first, options)
            # The options in the message draw the same.
            view = said.split("animation: ")[1].splitlines()[0].split(" ")
            self.renders(self.scene, "-o", self.folder / "x.00.exr", "--quiet", *SMALL[2:], *view, "--animation-time", 0)
            self.assertEqual(places()[0], first, options)
        # The plane, 2 m wide, goes 1 m to the right: all of that is in the picture.
        self.renders(self.scene, "-o", self.folder / "x.##.exr", "--quiet", "--resolution", "80,60", "--spp", 2, "--frames", "0:24:12", "--no-background", "--stage", "flat")
        for k in (0, 12, 24):
            alpha = Exr(self.folder / f"x.{k:02}.exr").layers["A"]
            self.assertEqual((max(alpha[0]), max(alpha[-1]), max(row[0] for row in alpha), max(row[-1] for row in alpha)), (0, 0, 0, 0), k)
        self.assertNotIn("one camera", self.draw("--frames", "0:0", "--camera-position", "0,0,5").stderr)

    def test_all_variants_are_drawn_each_to_its_name(self):
        root = json.loads(self.scene.read_text())
        root.pop("animations")
        names = ["Midnight Blue", "a/b"]
        root["extensionsUsed"] = root.get("extensionsUsed", []) + ["KHR_materials_variants"]
        root.setdefault("extensions", {})["KHR_materials_variants"] = {"variants": [{"name": name} for name in names]}
        root["materials"] += [{"pbrMetallicRoughness": {"baseColorFactor": color}} for color in ([0, 0, 1, 1], [1, 0, 0, 1])]
        count = len(root["materials"])
        for mesh in root["meshes"]:
            for primitive in mesh["primitives"]:
                primitive["extensions"] = {"KHR_materials_variants": {"mappings": [{"material": count - 2 + i, "variants": [i]} for i in range(2)]}}
        self.scene.write_text(json.dumps(root))
        output = self.folder / "x.#.exr"
        self.renders(self.scene, "-o", output, "--quiet", *SMALL, "--material-variant", "all", "--stats", self.folder / "s.#.json")
        self.assertEqual(sorted(p.name for p in self.folder.glob("[xs].*")), ["s.1.json", "s.Midnight Blue.json", "x.1.exr", "x.Midnight Blue.exr"])
        for name, variant in (("Midnight Blue", "midnight blue"), ("1", "A/B")):
            self.assertEqual((self.folder / f"x.{name}.exr").read_bytes(), self.single("--material-variant", variant), variant)
        names = root["extensions"]["KHR_materials_variants"]["variants"]
        names[1]["name"] = names[0]["name"]
        self.scene.write_text(json.dumps(root))
        self.renders(self.scene, "-o", self.folder / "z.#.exr", "--quiet", *SMALL, "--material-variant", "all")
        self.assertEqual(sorted(p.name for p in self.folder.glob("z.*")), ["z.0.exr", "z.1.exr"])
        self.fails(2, "render", self.scene, "-o", self.folder / "y.exr", "--material-variant", "all", says=["--material-variant all: ", "#"])
        self.fails(2, "render", self.scene, "-o", self.folder / "y#.exr", "--turntable", 2, "--material-variant", "all", says=["--material-variant all"])
        self.fails(2, "render", PLANE, "-o", self.folder / "y#.exr", "--material-variant", "all", "--quiet", says=["has no variants"])

    def test_what_is_no_sequence_is_refused(self):
        for options, says in ((["--frames", "3:1"], "--frames"), (["--frames", "1"], "--frames"), (["--frames", "0:4:0"], "--frames"),
                              (["--frames", "0:4", "--turntable", 3], "--turntable"), (["--frames", "0:4", "--animation-time", 1], "--animation-time"),
                              (["--frames", "0:4", "--resume"], "--continue"), (["--frames", "0:4", "--stats", "-"], "--stats"),
                              (["--continue"], "--frames"), (["--turntable", 0], "--turntable"), (["--frames", "0:4", "--fps", 0], "--fps")):
            self.fails(2, "render", self.scene, "-o", self.folder / "x.##.exr", *options, says=[says])
        self.fails(2, "render", self.scene, "-o", self.folder / "x.exr", "--frames", "0:4", says=["--output", "####"])
        self.fails(2, "render", PLANE, "-o", self.folder / "x.##.exr", "--frames", "0:4", says=["--frames: ", "no animation"])
        self.assertEqual(list(self.folder.glob("x*")), [])


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Sequences of pictures (--frames, --turntable). Each picture is that of a single command with its seed. What does not change is
kept, and a message names each picture that failed."""
import base64
import json
import math
import os
import resource
import shutil
import signal
import struct
import subprocess
import sys
import time
import unittest
from statistics import correlation

from support import EXTENDED, FRAGTRACE, SCENES, SMALL, Case, Exr, Gltf, main, read_png, run

PLANE = SCENES / "mapped-plane.gltf"
FAR_PROCESS = "1-0123abcd.part"  # of another machine
SEQUENCE_SMALL = ["--resolution", "40,30", "--spp", "2", "--traversal", "front-to-back"]


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
        result = run("render", self.scene, "-o", self.folder / "x.##.exr", *SEQUENCE_SMALL, *options)
        self.assertEqual(result.returncode, status, result.stderr)
        return result

    def seed(self, number):
        return int(Exr(self.folder / f"x.{number:02}.exr").texts["fragtrace:seed"])

    def single(self, *options):
        path = self.folder / "single.exr"
        self.renders(self.scene, "-o", path, "--quiet", *SEQUENCE_SMALL, *options)
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
        self.renders(self.scene, "-o", self.folder / "single.exr", "--quiet", *SEQUENCE_SMALL[:2], "--spp", 512, "--seed", 1)
        reference = Exr(self.folder / "single.exr").luminances()
        # Without the lamp, whose edges outweigh all other noise.
        noise_of = lambda k: [a - b for a, b in zip(Exr(self.folder / f"x.{k:02}.exr").luminances(), reference) if b < 1]
        first, *others = map(noise_of, range(4))
        for k, noise in enumerate(others, 1):
            self.assertLess(abs(correlation(first, noise)), 0.1, k)
        self.renders(self.scene, "-o", self.folder / "t.#.exr", *SEQUENCE_SMALL, "--turntable", 2)
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
        self.renders("/dev/stdin", "-o", self.folder / "p.##.exr", *SEQUENCE_SMALL, *frames, input=self.scene.read_text())
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
        frames = ["--frames", "0:2", "--fps", 8, *SEQUENCE_SMALL, "--quiet"]
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

    def test_processes_may_share_a_folder(self):
        """They write under names of their own. A part of another machine stays."""
        left = self.folder / f".x.07.exr.{FAR_PROCESS}"
        left.write_bytes(b"half of one")
        words = ["render", self.scene, "-o", self.folder / "x.##.exr", "--resolution", "40,30", "--spp", "1", "--frames", "0:15", "--quiet", "--continue"]
        processes = [subprocess.Popen([FRAGTRACE, *map(str, words)], stderr=subprocess.PIPE, text=True) for _ in range(4)]
        said = [process.communicate(timeout=300)[1] for process in processes]
        self.assertEqual([(process.returncode, text) for process, text in zip(processes, said)], [(0, "")] * 4)
        self.assertEqual({p.name for p in self.folder.iterdir() if p.name.lstrip(".").startswith("x.")}, {f"x.{k:02}.exr" for k in range(16)} | {left.name})

    def test_continue_draws_pictures_of_another_size_or_cut_off_again(self):
        turn = ["--turntable", 4, *SEQUENCE_SMALL[2:4]]
        for kind in ("png", "jpg", "pfm", "exr"):
            path = lambda k: self.folder / f"c.{k}.{kind}"
            self.renders(PLANE, "-o", path("#"), *turn, "--resolution", "40,30", "--quiet")
            whole = [path(k).read_bytes() for k in range(4)]
            self.renders(PLANE, "-o", path("#"), *turn, "--resolution", "20,15", "--frames", "1:1", "--quiet")
            if kind != "exr":
                path(2).write_bytes(whole[2][:-20])
            result = self.renders(PLANE, "-o", path("#"), *turn, "--resolution", "40,30", "--continue")
            self.assertEqual([path(k).read_bytes() for k in range(4)], whole, kind)
            self.assertIn(f"{path(1)}: 20 x 15 pixels, not 40 x 30; it is drawn again", result.stderr)
            self.assertEqual(f"{path(2)}: the file is truncated; it is drawn again" in result.stderr, kind != "exr", result.stderr)
            self.assertIn(f"{3 if kind == 'exr' else 2} of 4 pictures were there already", result.stderr)

    def test_equal_failures_are_said_once(self):
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))
        result = run("render", PLANE, "-o", self.folder / "x.##.png", "--resolution", "100,100", "--spp", 1, "--frames", "0:9", "--turntable", 10, "--quiet", preexec_fn=limit)
        self.assertEqual(result.returncode, 1)
        lines = result.stderr.splitlines()
        self.assertEqual(len(lines), 2, lines)
        self.assertIn("picture 0: cannot write ", lines[0])
        self.assertIn("10 of 10 pictures failed", lines[1])

    def test_pictures_that_show_nothing_are_said_once(self):
        """The first names its number; a picture alone has none."""
        away = ["--camera-position", "0,1e5,0", "--camera-focal-point", "0,2e5,0", "--resolution", "16,12", "--spp", 1]
        said = self.renders(PLANE, "-o", self.folder / "n.#.pfm", "--turntable", 3, *away).stderr
        self.assertEqual(said.count("shows nothing of the scene"), 1, said)
        self.assertIn("warning: picture 0: this view shows nothing", said)
        self.assertIn("(nothing is said of later ones)", said)
        said = self.renders(PLANE, "-o", self.folder / "n.pfm", *away).stderr
        self.assertIn("warning: this view shows nothing", said)
        self.assertNotIn("later ones", said)

    def test_a_turntable_can_be_split(self):
        """Each picture has the bits of the whole turn's."""
        self.renders(PLANE, "-o", self.folder / "w.#.exr", *SEQUENCE_SMALL, "--turntable", 6, "--quiet")
        for frames in ("0:2", "3:5:2", "4:4"):
            self.renders(PLANE, "-o", self.folder / "p.#.exr", *SEQUENCE_SMALL, "--turntable", 6, "--frames", frames, "--quiet", "--continue")
        self.assertEqual(sorted(p.name for p in self.folder.glob("p.*")), [f"p.{k}.exr" for k in range(6)])
        for k in range(6):
            self.assertEqual((self.folder / f"p.{k}.exr").read_bytes(), (self.folder / f"w.{k}.exr").read_bytes(), k)
        self.fails(2, "render", PLANE, "-o", self.folder / "q.#.exr", "--turntable", 6, "--frames", "4:6", says=["--frames: --turntable 6 has pictures 0 to 5"])

    def test_rates_of_broadcast_are_exact(self):
        for word, rate in (("23.976", 24000 / 1001), ("29.97", 30000 / 1001), ("59.94", 60000 / 1001), ("47.952", 48000 / 1001), ("119.88", 120000 / 1001),
                           ("30000/1001", 30000 / 1001), ("23.98", 23.98), ("25", 25), ("50/2", 25)):
            self.draw("--frames", "7:7", "--fps", word, "--quiet")
            picture = (self.folder / "x.07.exr").read_bytes()
            self.assertEqual(picture, self.single("--animation-time", repr(7 / rate), "--seed", self.seed(7)), word)
        for word, says in (("1/0", "no fraction such as 30000/1001"), ("a/b", "no fraction"), ("x", "no number"), ("1/9999", "not in the range")):
            self.fails(2, "render", self.scene, "-o", self.folder / "x.##.exr", "--frames", "0:1", "--fps", word, says=["--fps", says])

    def test_the_end_of_an_animation_is_that_of_its_float_times(self):
        self.scene = self.moving("end.gltf", ((0.0, (0, 0, 0)), (3.41667, (1, 0, 0))))
        self.assertNotIn("ends after", self.draw("--frames", "82:82").stderr)
        self.assertIn("at picture 82;", self.draw("--frames", "83:83").stderr)

    def test_a_picture_that_shows_nothing_is_named(self):
        self.scene = self.moving("gone.gltf", ((0.0, (0, 0, 0)), (1.0, (0, 0, 0)), (1.01, (1e4, 0, 0)), (4.0, (1e4, 0, 0))))
        said = self.draw("--frames", "0:4", "--fps", 1).stderr
        self.assertEqual(said.count("warning: picture 2: "), 1, said)
        self.assertEqual(said.count("warning: picture"), 1, said)

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
            self.renders(self.scene, "-o", self.folder / "x.00.exr", "--quiet", *SEQUENCE_SMALL[2:], *view, "--animation-time", 0)
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
        self.renders(self.scene, "-o", output, "--quiet", *SEQUENCE_SMALL, "--material-variant", "all", "--stats", self.folder / "s.#.json")
        self.assertEqual(sorted(p.name for p in self.folder.glob("[xs].*")), ["s.1.json", "s.Midnight Blue.json", "x.1.exr", "x.Midnight Blue.exr"])
        for name, variant in (("Midnight Blue", "midnight blue"), ("1", "A/B")):
            self.assertEqual((self.folder / f"x.{name}.exr").read_bytes(), self.single("--material-variant", variant), variant)
        names = root["extensions"]["KHR_materials_variants"]["variants"]
        names[1]["name"] = names[0]["name"]
        self.scene.write_text(json.dumps(root))
        self.renders(self.scene, "-o", self.folder / "z.#.exr", "--quiet", *SEQUENCE_SMALL, "--material-variant", "all")
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


SIZE = (40, 30)
TURN = ["--resolution", "40,30", "--spp", "2", "--turntable", "3", "--hdri-file", SCENES / "sky.pfm", "--stage", "phong"]
STAND_IN = """#!{python}
import json, os, sys
target = sys.argv[-1].removeprefix("file:")
with open({log!r}, "a") as log:
    log.write(json.dumps(sys.argv[1:]) + "\\n")
dies = os.environ.get("DIES_AFTER") if target != "/dev/null" else os.environ.get("DIES_IN_TRIAL")
data = sys.stdin.buffer.read() if dies is None else sys.stdin.buffer.read(int(dies))
with open(target, "wb") as file:
    file.write(data)
if dies is not None:
    sys.exit("one line\\nNo space left on device")
"""


def samples_of(path):
    """Width, height, and the samples of all pixels in one list."""
    width, height, rows, step = read_png(path)
    return width, height, list(struct.unpack(f">{width * height * (step if step < 6 else step // 2)}{'BH'[step >= 6]}", b"".join(rows)))


class Videos(Case):
    """Sequences in one stream: raw frames on standard output, videos by ffmpeg. A stand-in for ffmpeg keeps what it is given; one test runs the real one."""

    def setUp(self):
        super().setUp()
        self.log = self.folder / "log"
        programs = self.folder / "programs"
        programs.mkdir()
        stand_in = programs / "ffmpeg"
        stand_in.write_text(STAND_IN.format(python=sys.executable, log=str(self.log)))
        stand_in.chmod(0o755)
        self.stand_in = {**os.environ, "PATH": f"{programs}:{os.environ['PATH']}"}
        self.video = self.folder / "turn.mp4"

    def left(self):
        """Returns the names of all other files in the folder than the stand-in's."""
        return sorted(path.name for path in self.folder.iterdir() if path.name not in ("log", "programs"))

    def frames(self, form, *options, turn=TURN):
        return subprocess.run([FRAGTRACE, "render", PLANE, "-o", "-", "--format", form, *map(str, [*turn, *options])], capture_output=True, check=True)

    def pngs(self, *options):
        self.renders(PLANE, "-o", self.folder / "n.#.png", "--quiet", *TURN, *options)
        return [samples_of(self.folder / f"n.{k}.png") for k in range(3)]

    def test_raw_frames_are_the_pixels_of_a_png(self):
        ran = self.frames("rgb24", "--exposure", 0.5)
        expected = [sample for *_, samples in self.pngs("--exposure", 0.5) for sample in samples]
        self.assertEqual(len(expected), 3 * 40 * 30 * 3)
        self.assertEqual(list(ran.stdout), expected)
        self.assertIn("standard output, picture 2: 40 x 30", ran.stderr.decode())
        # Even an opaque picture has alpha.
        for options, opaque in ((["--no-background"], False), ([], True)):
            found = struct.unpack(f"<{3 * 40 * 30 * 4}H", self.frames("rgba64", "--quiet", *options).stdout)
            expected = [sample for *_, samples in self.pngs("--png-depth", 16, *options) for sample in samples]
            self.assertEqual(min(found[3::4]), 65535 if opaque else 0)
            self.assertEqual([s for i, s in enumerate(found) if i % 4 < 3 or not opaque], expected)
        # This is a single picture.
        self.assertEqual(len(self.frames("rgb24", "--quiet", turn=TURN[:4]).stdout), 40 * 30 * 3)

    def test_the_encoder_gets_the_frames_and_its_file_takes_the_place(self):
        self.video.write_text("an older one")
        ran = self.renders(PLANE, "-o", self.video, *TURN, "--fps", 12.5, env=self.stand_in)
        self.assertEqual(self.video.read_bytes(), self.frames("rgb24", "--quiet").stdout)
        self.assertEqual(self.left(), ["turn.mp4"])
        self.assertIn("turn.mp4, picture 2: 40 x 30", ran.stdout)
        self.assertIn("turn.mp4: 3 pictures of 40 x 30, 0.24 s at 12.5 per second", ran.stderr)
        trial, arguments = map(json.loads, self.log.read_text().splitlines())
        self.assertEqual(trial[-1], "file:/dev/null")
        self.assertRegex(arguments[-1], rf"^file:{self.folder}/\.turn\.mp4\.\d+-[0-9a-f]{{8}}\.part$")
        words = " ".join(arguments)
        for part in ("-pixel_format rgb24 -video_size 40x30 -framerate 12.5 -i pipe:0", "-crf 16", "-colorspace bt709 -color_range tv", "-f mp4"):
            self.assertIn(part, words)
        # A step keeps the speed of the animation; .mov has alpha.
        moving = self.folder / "moving.mov"
        scene = Sequences.moving(self)
        self.renders(scene, "-o", moving, *TURN[:4], "--frames", "0:6:3", "--fps", 30, "--quiet", env=self.stand_in)
        self.assertEqual(moving.stat().st_size, 3 * 40 * 30 * 8)
        self.assertIn("-pixel_format rgba64le -video_size 40x30 -framerate 10", " ".join(json.loads(self.log.read_text().splitlines()[-1])))

    def test_an_interrupted_video_holds_the_frames_that_were_finished(self):
        """It has a name of its own, and an older video stays."""
        self.video.write_text("an older one")
        process = subprocess.Popen([FRAGTRACE, "render", PLANE, "-o", self.video, "--turntable", "90", "--resolution", "40,30", "--spp", "1000", "--progress", "json"],
                                   env=self.stand_in, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        while json.loads(process.stderr.readline()).get("type") != "picture":
            pass
        process.send_signal(signal.SIGINT)
        events = [json.loads(line) for line in process.communicate(timeout=20)[1].splitlines()]
        self.assertEqual(process.returncode, 130, events)
        count = 1 + sum(event["type"] == "picture" for event in events)
        self.assertLess(count, 90)
        self.assertIn(f"interrupted: {count} of 90 pictures are in {self.folder}/turn.partial.mp4", [event.get("text") for event in events])
        self.assertEqual((self.folder / "turn.partial.mp4").stat().st_size, count * 40 * 30 * 3)
        self.assertEqual((self.left(), self.video.read_text()), (["turn.mp4", "turn.partial.mp4"], "an older one"))

    def test_interrupted_before_the_first_picture_it_leaves_nothing(self):
        process = subprocess.Popen([FRAGTRACE, "render", PLANE, "-o", self.video, "--turntable", "90", "--resolution", "40,30", "--spp", "100000000", "--progress", "none"],
                                   env=self.stand_in, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        deadline = time.monotonic() + 5
        while not any(name.endswith(".part") for name in self.left()) and time.monotonic() < deadline:
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        self.assertIn("nothing is written", process.communicate(timeout=20)[1])
        time.sleep(0.3)  # in which an encoder that continues would make its file
        self.assertEqual(self.left(), [])

    def test_a_name_with_a_number_sign_stays(self):
        video = self.folder / "shot #1.mp4"
        self.renders(PLANE, "-o", video, *TURN, "--stats", self.folder / "s.#.json", env=self.stand_in)
        self.assertEqual(self.left(), ["s.0.json", "s.1.json", "s.2.json", video.name])

    def test_an_encoder_that_dies_leaves_the_older_file(self):
        self.video.write_text("an older one")
        for variable, bytes_read, begins in (("DIES_AFTER", 1000, "picture "), ("DIES_IN_TRIAL", 0, "cannot write ")):
            # Frames that a pipe does not hold.
            result = run("render", PLANE, "-o", self.video, "--resolution", "160,120", *TURN[2:], "--quiet", env={**self.stand_in, variable: str(bytes_read)})
            self.assertEqual(result.returncode, 1)
            self.assertTrue(result.stderr.startswith(f"fragtrace: {begins}"), result.stderr)
            self.assertIn(f"cannot write {self.video}: ffmpeg ended with status 1: one line; No space left on device", result.stderr)
            self.assertEqual((self.left(), self.video.read_text()), (["turn.mp4"], "an older one"))
        self.assertNotIn("are in", result.stderr)

    @unittest.skipUnless(shutil.which("ffmpeg"), "there is no ffmpeg")
    def test_a_full_disk_keeps_what_was_encoded(self):
        """Where players show a file that is cut off. ulimit -f stands for the disk."""
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (60000, 60000))
        gif = self.folder / "turn.gif"
        words = ["render", SCENES / "plastics.gltf", "-o", gif, "--resolution", "160,120", "--turntable", "60", "--spp", "1", "--stage", "phong", "--quiet"]
        result = run(*words, preexec_fn=limit)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn(f"cannot write {gif}: ffmpeg ended with ", result.stderr)
        self.assertIn(f"what was encoded before that is in {self.folder}/turn.partial.gif", result.stderr)
        self.assertEqual(self.left(), ["turn.partial.gif"])
        frames = subprocess.run(["ffmpeg", "-loglevel", "fatal", "-i", self.folder / "turn.partial.gif", "-f", "framecrc", "-"], capture_output=True).stdout
        self.assertGreater(frames.count(b"\n0,"), 1)

    def test_without_ffmpeg_a_message_names_it(self):
        self.fails(2, "render", PLANE, "-o", self.video, *TURN, env={**os.environ, "PATH": str(self.folder)},
                   says=["--output", "turn.mp4: the program ffmpeg makes videos, and PATH has none (Debian's package ffmpeg)"])

    def test_what_does_not_go_with_a_stream_is_refused(self):
        mp4 = ["-o", self.video]
        for options, says in (
            (mp4, ["--output: ", "--turntable 96 or --frames"]),
            ([*mp4, "--turntable", 2, "--resolution", "41,30"], ["--resolution: width and height of a .mp4 are even"]),
            ([*mp4, "--turntable", 2, "--region", "0,0,10,11"], ["--region: width and height of a .mp4 are even"]),
            ([*mp4, "--turntable", 2, "--continue"], ["--continue: goes with numbered pictures"]),
            ([*mp4, "--turntable", 2, "--resume"], ["--resume are of a single picture"]),
            ([*mp4, "--turntable", 2, "--aov", "depth"], ["--aov: only .exr"]),
            ([*mp4, "--turntable", 2, "--png-depth", 16], ["--png-depth"]),
            (["-o", "-", "--format", "png", "--turntable", 2], ["--format rgb24 or rgba64"]),
            (["-o", "-", "--format", "rgb24", "--turntable", 2, "--continue"], ["--continue"]),
            (["-o", self.folder / "x.rgb24"], ["ends in none of"]),
            (["-o", self.folder / "x.raw", "--format", "rgb24"], ["--format: rgb24 needs --output -"]),
        ):
            self.fails(2, "render", PLANE, *options, says=says)
        self.assertEqual(self.left(), [])

    @unittest.skipUnless(shutil.which("ffmpeg"), "there is no ffmpeg")
    def test_players_show_the_colours_of_a_png(self):
        """The frames of real videos, decoded, differ from the pictures by noise of the codec, with no shift of a colour."""
        scene = SCENES / "plastics.gltf"  # this scene has strong colours
        turn = ["--resolution", "80,40", "--spp", 4, "--turntable", 2, "--quiet", "--studio", "--stage", "phong"]
        self.renders(scene, "-o", self.folder / "n.#.png", *turn)
        expected = samples_of(self.folder / "n.1.png")[2]
        kinds = {".mp4": (4, 0.8), ".mov": (1, 0.8), ".webm": (4, 0.8), ".gif": (4, 1.5)}
        for kind, (most_mean, most_shift) in list(kinds.items())[:4 if EXTENDED else 2]:
            video = self.folder / f"turn{kind}"
            self.renders(scene, "-o", video, *turn)
            found = subprocess.run(["ffmpeg", "-loglevel", "error", "-i", video, "-fps_mode", "passthrough", "-vf", "scale=flags=accurate_rnd+full_chroma_int+full_chroma_inp",
                                    "-pix_fmt", "rgb24", "-f", "rawvideo", "-"], capture_output=True, check=True).stdout
            self.assertEqual(len(found), 2 * len(expected), kind)
            second = found[len(expected):]
            mean = sum(abs(a - b) for a, b in zip(second, expected)) / len(expected)
            shifts = [abs(sum(second[c::3]) - sum(expected[c::3])) / len(expected[c::3]) for c in range(3)]
            self.assertLess(mean, most_mean, kind)
            self.assertLess(max(shifts), most_shift, kind)

    @unittest.skipUnless(shutil.which("ffmpeg"), "there is no ffmpeg")
    def test_joined_pictures_have_the_colours_of_a_film(self):
        """The command of docs/video.md, whose matrix and tags ffmpeg would not choose by itself."""
        flat = ["--resolution", "64,48", "--background-color", "#ff8020", "--camera-position", "0,0,1e6", "--camera-focal-point", "0,0,2e6", "--spp", 1,
                "--turntable", 2, "--quiet"]
        self.renders(PLANE, "-o", self.video, *flat)
        (self.folder / "frames").mkdir()
        self.renders(PLANE, "-o", self.folder / "frames/turn.####.png", *flat)
        text = (SCENES.parent / "docs/video.md").read_text()
        command = text[text.index("ffmpeg -framerate 24 -i frames"):].split(".mp4")[0].replace("\\\n", " ")
        joined = self.folder / "joined.mp4"
        subprocess.run([*command.split()[:-1], "-loglevel", "error", joined], cwd=self.folder, check=True)
        read = lambda path: subprocess.run(["ffmpeg", "-loglevel", "error", "-i", path, "-vf", "scale=flags=accurate_rnd+full_chroma_int", "-frames:v", "1",
                                            "-pix_fmt", "rgb24", "-f", "rawvideo", "-"], capture_output=True, check=True).stdout
        own, other = read(self.video), read(joined)
        self.assertEqual(len(own), 64 * 48 * 3)
        self.assertLessEqual(max(abs(a - b) for a, b in zip(own, other)), 2)
        self.assertLess(max(abs(a - b) for a, b in zip(own[:3], (255, 128, 32))), 6)
        tags = ["ffprobe", "-v", "error", "-select_streams", "v", "-show_entries", "stream=color_space,color_transfer,color_primaries", "-of", "json"]
        told = [json.loads(subprocess.run([*tags, path], capture_output=True, check=True).stdout)["streams"] for path in (self.video, joined)]
        self.assertEqual(*told)


# Animated files at one moment against files in which that pose stands.
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

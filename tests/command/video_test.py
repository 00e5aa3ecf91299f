#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Sequences in one stream: raw frames on standard output, videos by ffmpeg. A stand-in for ffmpeg keeps what it is given; one test runs the real one."""
import json
import os
import shutil
import signal
import struct
import subprocess
import sys
import time
import unittest

from support import EXTENDED, FRAGTRACE, SCENES, Case, main, read_png, run
from sequence_test import Sequences

PLANE = SCENES / "mapped-plane.gltf"
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
        self.assertEqual(arguments[-1], f"file:{self.folder}/.turn.mp4.part")
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
        self.assertIn(f"interrupted: {count} of 90 pictures are in {self.video}", [event.get("text") for event in events])
        self.assertEqual(self.video.stat().st_size, count * 40 * 30 * 3)
        self.assertEqual(self.left(), ["turn.mp4"])

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
        time.sleep(0.3)  # in which an encoder that goes on would make its file
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


if __name__ == "__main__":
    main()

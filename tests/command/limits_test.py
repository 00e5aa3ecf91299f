#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Files from anywhere and outputs to anywhere: limits, decoders that loop or crash, devices, pipes, links, signals."""
import json
import os
import re
import resource
import shutil
import signal
import struct
import subprocess
import threading
import time
import zlib
from pathlib import Path
from random import Random

from support import FRAGTRACE, SCENES, SMALL, Case, main, run

PICTURE = SCENES / "graticule.png"


class ImageProcess(Case):
    """A program that replaces fragtrace_worker loops, crashes or ends. fragtrace reports this and ends with status 3."""

    def decoding(self, script, says, *, render=True):
        stand_in = self.folder / "fragtrace_worker"
        stand_in.write_text("#!/bin/sh\n" + script)
        stand_in.chmod(0o755)
        environment = {**os.environ, "FRAGTRACE_LIBRARY_PATH": str(self.folder)}
        started = time.monotonic()
        self.fails(3, "diff", PICTURE, PICTURE, says=[PICTURE, says], env=environment)
        self.assertLess(time.monotonic() - started, 30)
        if not render:
            return
        self.fails(3, "render", SCENES / "sphere-textured.gltf", "-o", self.folder / "x.pfm", *SMALL, says=["graticule.png", says],
                   env=environment)

    def test_one_that_loops_is_stopped_by_its_processor_time(self):
        self.decoding("while :; do :; done", "longer to decode than its size is given", render=False)

    def test_one_that_crashes_is_named(self):
        self.decoding("kill -SEGV $$", "signal 11")

    def test_one_that_ends_is_named(self):
        self.decoding("exit 7", "status 7")

    def test_one_that_is_not_there_is_named(self):
        shutil.copy(FRAGTRACE, self.folder / "fragtrace")
        environment = {k: v for k, v in os.environ.items() if k != "FRAGTRACE_LIBRARY_PATH"}
        result = subprocess.run([self.folder / "fragtrace", "diff", PICTURE, PICTURE], capture_output=True, text=True,
                                env=environment)
        self.assertEqual(result.returncode, 3)
        self.assertIn("fragtrace_worker is not in", result.stderr)

    def test_it_does_not_outlive_the_program(self):
        environment = {**os.environ, "FRAGTRACE_TEST_MARK": str(self.folder)}  # other tests have workers at the same time
        run("diff", PICTURE, PICTURE, env=environment)
        with subprocess.Popen([FRAGTRACE, "render", SCENES / "sphere-textured.gltf", "-o", self.folder / "x.png",
                               "--spp", "100000", "--quiet"], env=environment) as process:
            started = time.monotonic()
            while not (seen := self.workers()) and time.monotonic() < started + 10:
                pass
            process.kill()
        self.assertTrue(seen)
        deadline = time.monotonic() + 60  # one that is still starting sees that nobody is there when it has started
        while (left := self.workers()) and time.monotonic() < deadline:
            time.sleep(0.1)
        self.assertEqual(left, set())

    def workers(self):
        """Workers of this test alone, known by their environment."""
        mine = set()
        for entry in Path("/proc").glob("[0-9]*"):
            try:
                if ((entry / "exe").readlink() == FRAGTRACE.parent / "fragtrace_worker"
                        and f"FRAGTRACE_TEST_MARK={self.folder}".encode() in (entry / "environ").read_bytes().split(b"\0")):
                    mine.add(entry.name)
            except OSError:
                pass
        return mine


def hostile_pictures():
    """Each asks for much more than it is."""
    hdr = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n"
    yield "runs-of-nothing.hdr", hdr % (8, 32767) + (b"\2\2\x7f\xff" + b"\0" * 4000) * 8
    yield "old-runs.hdr", hdr % (4000, 65000) + b"\1\1\1\xff" * 4000
    yield "old-runs-of-nothing.hdr", hdr % (4000, 65000) + b"\1\1\1\0" * 4000
    yield "huge.hdr", hdr % (2000000000, 2000000000) + bytes(100)
    yield "negative.hdr", hdr % (-5, -5) + bytes(100)
    yield "long-line.hdr", b"#?RADIANCE\n" + b"x" * 1000000 + b"\n\n-Y 1 +X 2\n1234"
    magic = b"\x76\x2f\x31\x01" + struct.pack("<I", 2)
    yield "54-bytes.exr", (magic + b"channels\0chlist\0" + struct.pack("<I", 0xfffffff0)).ljust(54, b"x")
    attribute = lambda name, kind, value: name + b"\0" + kind + b"\0" + struct.pack("<I", len(value)) + value
    channels = b"".join(name + b"\0" + struct.pack("<4I", 2, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    for name, side, tail in (("truncated.exr", 16384, b""), ("zeros.exr", 16384, bytes(1 << 20)), ("garbage.exr", 512, os.urandom(1 << 14))):
        window = struct.pack("<4i", 0, 0, side - 1, side - 1)
        yield name, (magic + attribute(b"channels", b"chlist", channels) + attribute(b"compression", b"compression", b"\4")
                     + attribute(b"dataWindow", b"box2i", window) + attribute(b"displayWindow", b"box2i", window)
                     + attribute(b"lineOrder", b"lineOrder", b"\0") + attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1))
                     + attribute(b"screenWindowCenter", b"v2f", bytes(8))
                     + attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)) + b"\0" + tail)
    frame = b"\xff\xd8\xff\xc2\0\x0b\x08\x40\0\x40\0\1\1\x11\0"
    yield "38-kB.jpg", frame + b"\xff\xda\0\x08\1\1\0\1\1\0" * 3800 + b"\xff\xd9"
    yield "no-tables.jpg", frame + b"\xff\xda\0\x08\1\1\0\1\1\0" + b"\xff\xd9"
    chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    for name, side in (("bomb.png", 16384), ("wrong.png", 1 << 30)):
        yield name, (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", side, side, 8, 6, 0, 0, 0))
                     + chunk(b"IDAT", zlib.compress(bytes(1 << 20))) + chunk(b"IEND", b""))
    yield "huge.webp", b"RIFF\x1c\0\0\0WEBPVP8X\x0a\0\0\0\0\0\0\0\xff\xff\xff\xff\xff\xff"
    yield "huge.pfm", b"PF\n2000000000 2000000000\n-1\n"


class HostilePictures(Case):
    def test_each_is_refused_by_name_in_seconds_and_little_memory(self):
        for name, data in hostile_pictures():
            with self.subTest(name):
                path = self.folder / name
                path.write_bytes(data)
                before = resource.getrusage(resource.RUSAGE_CHILDREN)
                result = run("diff", path, path, timeout=120)
                after = resource.getrusage(resource.RUSAGE_CHILDREN)
                path.unlink()
                self.assertEqual(result.returncode, 3, result.stderr)
                self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
                self.assertIn(name, result.stderr)
                self.assertLess(after.ru_utime - before.ru_utime, 10)

    def test_a_picture_of_noise_is_refused_or_read_whatever_its_bytes(self):
        random = Random(7)
        good = PICTURE.read_bytes()
        for _ in range(6):
            data = bytearray(good)
            for _ in range(20):
                data[random.randrange(33, len(data) - 12)] = random.randrange(256)
            path = self.folder / "noise.png"
            path.write_bytes(data)
            result = run("diff", path, path, timeout=60)
            self.assertIn(result.returncode, (0, 3), result.stderr)


class Outputs(Case):
    SCENE = SCENES / "furnace.gltf"

    def test_a_link_stays_and_what_it_leads_to_is_replaced(self):
        real, link = self.folder / "real.pfm", self.folder / "link.pfm"
        real.write_text("old")
        link.symlink_to("real.pfm")
        self.renders(self.SCENE, "-o", link, *SMALL)
        self.assertTrue(link.is_symlink())
        self.assertTrue(real.read_bytes().startswith(b"P"))
        nowhere = self.folder / "nowhere.pfm"
        nowhere.symlink_to("new.pfm")
        self.renders(self.SCENE, "-o", nowhere, *SMALL)
        self.assertTrue(nowhere.is_symlink() and (self.folder / "new.pfm").is_file())

    def test_a_full_device_is_1_with_the_reason_and_stays_a_device(self):
        result = run("render", self.SCENE, "-o", self.folder / "x.pfm", *SMALL, "--stats", "/dev/full")
        self.assertEqual(result.returncode, 1)
        self.assertIn("cannot write /dev/full: No space left on device", result.stderr)
        self.assertTrue(Path("/dev/full").is_char_device())
        self.assertEqual([p.name for p in Path("/dev").glob(".full*")], [])
        self.renders(self.SCENE, "-o", self.folder / "x.pfm", *SMALL, "--stats", "/dev/null")

    def test_a_pipe_is_written_to(self):
        pipe = self.folder / "pipe.pfm"
        os.mkfifo(pipe)
        read = []
        reader = threading.Thread(target=lambda: read.append(pipe.read_bytes()))
        reader.start()
        self.renders(self.SCENE, "-o", pipe, *SMALL)
        reader.join()
        self.assertTrue(read[0].startswith(b"P") and pipe.is_fifo())
        pipe.unlink()

    def test_a_reader_that_goes_away_is_1(self):
        reader, writer = os.pipe()
        os.close(reader)  # before the start: the command may have written all within a few milliseconds
        result = subprocess.run([FRAGTRACE, "info", "--json", self.SCENE], stdout=writer, stderr=subprocess.PIPE, timeout=60)
        os.close(writer)
        self.assertEqual(result.returncode, 1, result.stderr)

    def test_killed_at_any_moment_the_old_picture_or_the_new_one_is_whole(self):
        path = self.folder / "x.pfm"
        self.renders(self.SCENE, "-o", path, *SMALL)
        size = path.stat().st_size
        started = time.monotonic()
        self.renders(self.SCENE, "-o", path, *SMALL)
        whole = time.monotonic() - started
        for i in range(20):
            with subprocess.Popen([FRAGTRACE, "render", self.SCENE, "-o", path, *SMALL]) as process:
                time.sleep(whole * (0.5 + i / 25))
                process.send_signal(signal.SIGKILL)
            self.assertEqual(path.stat().st_size, size)
            self.assertLessEqual({re.sub(r"\.\d+-\w+\.part", ".part", p.name) for p in self.folder.iterdir()}, {"x.pfm", ".x.pfm.part"})
            self.assertLessEqual(len(list(self.folder.iterdir())), 2)
        self.renders(self.SCENE, "-o", path, *SMALL)
        self.assertEqual([p.name for p in self.folder.iterdir()], ["x.pfm"])

    def test_too_little_memory_is_one_message_and_leaves_the_old_picture(self):
        path = self.folder / "x.pfm"
        path.write_text("old")
        kinds = set()
        for megabytes in (60, 100, 150, 250, 400):
            limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (megabytes << 20, megabytes << 20))
            result = run("render", SCENES / "cornell-box.gltf", "-o", path, "--resolution", "512,512", "--spp", "1", "--quiet",
                         preexec_fn=limit)
            kinds.add(result.returncode)
            if result.returncode:
                self.assertIn(result.returncode, (1, 3, 4), result.stderr)
                self.assertEqual(path.read_text(), "old")
                self.assertTrue(result.stderr.strip(), megabytes)
            else:
                path.write_text("old")
        path.unlink()
        self.assertTrue({1, 3, 4} & kinds, kinds)  # at least one was too little


class Scenes(Case):
    def test_a_device_or_a_folder_is_no_scene(self):
        for scene in ("/dev/zero", "/dev/null", self.folder):
            self.fails(3, "info", scene, says=[scene])

    def test_a_scene_may_come_through_a_pipe(self):
        text = (SCENES / "furnace.gltf").read_bytes()
        result = subprocess.run([FRAGTRACE, "info", "/dev/stdin"], input=text, capture_output=True)
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_names_that_are_no_utf8_leave_the_report_valid(self):
        path = os.fsencode(self.folder) + b"/\xff\xfe.gltf"
        Path(os.fsdecode(path)).write_bytes((SCENES / "furnace.gltf").read_bytes())
        result = subprocess.run([FRAGTRACE, "info", "--json", path], capture_output=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        json.loads(result.stdout.decode("utf-8"))
        stats = self.folder / "stats.json"
        result = subprocess.run([FRAGTRACE, "render", path, "-o", self.folder / "x.pfm", *SMALL, "--stats", stats],
                                capture_output=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        json.loads(stats.read_text())

    def test_the_memory_limit_is_asked_before_memory_is_taken(self):
        header = b"PF\n16384 16384\n-1\n"
        path = self.folder / "large.pfm"
        with open(path, "wb") as file:
            file.write(header)
            file.truncate(len(header) + 16384 * 16384 * 12)
        arguments = ["render", SCENES / "furnace.gltf", "-o", self.folder / "x.exr", *SMALL, "--hdri-file", path]
        self.fails(3, *arguments, "--memory-limit", "1GB", says=["large.pfm", "--memory-limit"])
        self.fails(2, *arguments, "--memory-limit", "nonsense")
        self.fails(2, *arguments, "--memory-limit", "0")
        path.unlink()

    def test_a_texture_limit_scales_textures_down(self):
        info = lambda *extra: json.loads(run("info", "--json", SCENES / "sphere-textured.gltf", *extra).stdout)
        whole, limited = info(), info("--texture-limit", "16")
        self.assertGreater(whole["texture_bytes"], limited["texture_bytes"])
        self.assertLessEqual(limited["texture_bytes"], 16 * 16 * 8)
        mean = lambda *extra: sum(map(sum, sum(self.picture("sphere-textured", "x.pfm", "--stage", "flat", "--resolution", "64,64",
                                                            "--spp", "4", *extra), [])))
        self.assertAlmostEqual(mean("--texture-limit", "16") / mean(), 1, delta=0.02)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`render --checkpoint` and `--resume`: a render that was killed or interrupted ends with the picture of an unbroken one."""
import random
import signal
import subprocess
import time

from support import FRAGTRACE, SCENES, Case, Exr, at_length, main, run

BALL = SCENES / "room-ball.gltf"
BOX = SCENES / "cornell-box.gltf"
SIZE = ["--resolution", "70,56"]


class Broken(Case):
    def setUp(self):
        super().setUp()
        self.output = self.folder / "x.exr"
        self.checkpoint = self.folder / "x.exr.checkpoint"

    def arguments(self, *options, scene=BALL):
        return ["render", str(scene), "-o", str(self.output), "--quiet", *map(str, options)]

    def unbroken(self, *options, scene=BALL):
        started = time.monotonic()
        self.assertEqual(run(*self.arguments(*options, scene=scene)).returncode, 0)
        seconds = time.monotonic() - started
        picture = self.output.read_bytes()
        self.output.unlink()
        return picture, seconds

    def broken(self, seconds, *options, scene=BALL, by=signal.SIGKILL, written=False):
        """Starts a render and ends it by the signal `by` after so many seconds. With `written`, the seconds count from
        its first checkpoint: on a busy machine they would mean little otherwise. Returns the exit status."""
        before = self.checkpoint.stat().st_mtime_ns if self.checkpoint.exists() else 0
        process = subprocess.Popen([FRAGTRACE, *self.arguments("--checkpoint", 0.1, *options, scene=scene)], stderr=subprocess.PIPE)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        deadline = time.monotonic() + 60
        while written and process.poll() is None and time.monotonic() < deadline:
            written = not (self.checkpoint.exists() and self.checkpoint.stat().st_mtime_ns > before)
            time.sleep(0.005)
        try:
            process.wait(seconds)
        except subprocess.TimeoutExpired:
            process.send_signal(by)
        return process.wait(60)

    def interrupted_after_a_checkpoint(self, *options, scene=BOX):
        """Interrupts a render once it has written a checkpoint: on a busy machine a number of seconds would mean
        little."""
        process = subprocess.Popen([FRAGTRACE, *self.arguments("--checkpoint", 0.1, *options, scene=scene)])
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        deadline = time.monotonic() + 60
        while not self.checkpoint.exists() and time.monotonic() < deadline:
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        return process.wait(60)

    def resumed(self, *options, scene=BALL):
        result = run(*self.arguments("--resume", *options, scene=scene))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertFalse(self.checkpoint.exists())
        self.assertEqual([p.name for p in self.folder.iterdir()], ["x.exr"])
        return self.output.read_bytes()

    def equal_after_kills(self, kills, dice, *options, scene=BALL):
        """Each render is killed twice on its way; how many left a checkpoint that was not of an earlier one. More renders are, up to five, until one did:
        the machine may be more or less busy than it was."""
        whole, seconds = self.unbroken(*options, scene=scene)
        kept = rounds = 0
        while rounds < kills // 2 or (kept == 0 and rounds < 5):
            rounds += 1
            for resume in ([], ["--resume"]):
                written = dice.random() < 0.7
                after = dice.uniform(0.0, 0.4) if written else dice.uniform(0.2, 0.9)
                self.broken(after * seconds, *options, *resume, scene=scene, written=written)
                kept += self.checkpoint.exists()
            self.assertEqual(self.resumed(*options, scene=scene), whole)
            self.output.unlink()
        return kept


class Checkpoints(Broken):
    @at_length
    def test_killed_and_resumed(self):
        self.assertGreater(self.equal_after_kills(2, random.Random(3), *SIZE, "--spp", 150), 0)

    def test_an_interrupted_render_writes_what_it_has_and_goes_on(self):
        options = [*SIZE, "--spp", 80, "--aov", "denoising"]
        whole, seconds = self.unbroken(*options)

        def breaks_late(part):
            """The render is interrupted, and its film was read at a quarter of the samples before."""
            self.checkpoint.unlink(missing_ok=True)
            return self.broken(part * seconds, *options, by=signal.SIGINT) == 130 and min(Exr(self.output).values("samples.Y")) > 24
        # The machine may be more or less busy than it was.
        self.assertTrue(any(breaks_late(part) for part in (0.6, 0.8, 0.4, 0.95, 0.5, 0.7)))
        partly = Exr(self.output)
        self.assertEqual(partly.texts["fragtrace:interrupted"], "1")
        self.assertTrue(self.checkpoint.exists())
        self.fails(2, *self.arguments("--resume", *SIZE, "--spp", 160, "--aov", "denoising"),
                   says=["cannot go on to more samples (spp 80 and 160): what --denoise reads was kept at a quarter"])
        self.assertEqual(self.resumed(*options), whole)
        self.assertNotIn("fragtrace:interrupted", Exr(self.output).texts)

    def test_adaptive(self):
        options = [*SIZE, "--noise", 0.06]
        self.assertGreater(self.equal_after_kills(2, random.Random(5), *options, scene=BOX), 0)

    def test_drawn_in_parts(self):
        """Killed in the first part, and then in the second, whose checkpoint holds the first as a picture."""
        options = ["--resolution", "400,300", "--spp", 12, "--memory-limit", "30MB", "--aov", "albedo"]
        whole, _ = self.unbroken(*options, scene=BOX)
        for part in (0, 1):
            process = subprocess.Popen([FRAGTRACE, *self.arguments("--checkpoint", 0.1, "--resume", *options, scene=BOX)])
            self.addCleanup(process.wait)
            self.addCleanup(process.kill)
            wanted = b'"part":%d' % part
            while process.poll() is None and not (self.checkpoint.exists() and wanted in self.checkpoint.read_bytes()):
                time.sleep(0.02)
            self.assertIsNone(process.poll(), "it ended before it was killed")
            process.kill()
            process.wait()
        self.assertEqual(self.resumed(*options, scene=BOX), whole)

    def test_without_a_checkpoint_it_begins_anew_or_is_finished(self):
        options = ["--resolution", "16,16", "--spp", 2, "--resume"]
        said = run(*[a for a in self.arguments(*options, scene=BOX) if a != "--quiet"])
        self.assertEqual(said.returncode, 0)
        self.assertIn("there is no " + str(self.checkpoint) + ": the picture begins anew", said.stderr)
        before = self.output.stat()
        said = run(*[a for a in self.arguments(*options, scene=BOX) if a != "--quiet"])
        self.assertEqual((said.returncode, said.stdout), (0, ""))
        self.assertIn("x.exr is finished", said.stderr)
        self.assertEqual(self.output.stat().st_mtime_ns, before.st_mtime_ns)
        self.fails(2, *self.arguments("--resolution", "16,16", "--spp", 3, "--resume", scene=BOX), says=["--resume", "--spp 2, not 3"])
        self.fails(3, *self.arguments(*options, scene=self.folder / "none.gltf"), says=["none.gltf"])
        picture = self.folder / "x.png"
        for spp, said in ((1, "the picture begins anew"), (2, "x.png is finished.*does not say with how many samples, and nothing is drawn")):
            result = self.renders(BOX, "-o", picture, "--resolution", "16,16", "--spp", spp, "--resume")
            self.assertRegex(result.stderr, said)
        # A file that a crash of another program has left is not a picture.
        self.output.write_bytes(b"")
        self.assertEqual(run(*self.arguments(*options, scene=BOX)).returncode, 0)
        self.assertGreater(self.output.stat().st_size, 0)

    def test_a_part_that_a_killed_render_has_left_is_removed(self):
        (self.folder / ".x.exr.checkpoint.part").write_bytes(b"half of one")
        self.resumed("--resolution", "16,16", "--spp", 2, scene=BOX)

    def test_other_settings_are_named(self):
        settings = {"--resolution": "120,90", "--spp": 100000, "--bounces": 16, "--seed": 0}
        options = [word for setting in settings.items() for word in setting]
        self.assertEqual(self.interrupted_after_a_checkpoint(*options), 130)
        kept = self.checkpoint.read_bytes()
        for other, says in (({"--spp": 99999}, "spp 100000 and 99999"), ({"--bounces": 3}, "bounces 16 and 3"), ({"--seed": 5}, "seed 0 and 5"),
                            ({"--resolution": "90,120"}, "width 120 and 90"), ({"--noise": 0.1, "--spp": None}, "asked for): noise 0.0 and 0.1\n")):
            changed = [word for setting in (settings | other).items() if setting[1] is not None for word in setting]
            self.fails(2, *self.arguments(*changed, "--resume", scene=BOX), says=["--resume", self.checkpoint, "another render", says])
        self.fails(2, *self.arguments(*options, "--resume", scene=SCENES / "furnace.gltf"), says=["another render", "and \"furnace.gltf\", and ", " more settings\n"])
        self.assertEqual(self.checkpoint.read_bytes(), kept)

    def test_more_samples_than_at_first_are_drawn_on(self):
        size = ["--resolution", "24,18", "--spp"]
        whole, _ = self.unbroken(*size, 5000, scene=BOX)
        self.assertEqual(self.interrupted_after_a_checkpoint(*size, 4000), 130)
        said = run(*[a for a in self.arguments("--resume", *size, 5000, scene=BOX) if a != "--quiet"])
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertRegex(said.stderr, r"(?m)^fragtrace: --resume: goes on after [\d.]+ of 5000 samples per pixel$")
        self.assertEqual(self.output.read_bytes(), whole)

    def test_broken_checkpoints_are_refused(self):
        options = ["--resolution", "20,10", "--spp", 1000000]
        self.assertEqual(self.interrupted_after_a_checkpoint(*options), 130)
        good = self.checkpoint.read_bytes()
        end = good.index(b"{")
        middle = len(good) // 2
        for bad in (b"", b"x", good[:-1], good[:middle] + bytes([good[middle] ^ 4]) + good[middle + 1:], good + b"x", good[:end + 20], good.replace(b"checkpoint 4", b"checkpoint 9"),
                    good.replace(b'"size":[20,10]', b'"size":[10,20]'), good.replace(b'"part":0', b'"part":7')):
            self.assertNotEqual(bad, good)
            self.checkpoint.write_bytes(bad)
            self.fails(3, *self.arguments(*options, "--resume", scene=BOX), says=[self.checkpoint])
        self.checkpoint.unlink()
        self.output.unlink()

    def test_one_that_cannot_be_written_on_the_way_does_not_end_the_render(self):
        """A folder takes the checkpoint's name while the picture is drawn."""
        process = subprocess.Popen([FRAGTRACE, *[a for a in self.arguments("--checkpoint", 0.1, *SIZE, "--spp", 600, scene=BOX) if a != "--quiet"]],
                                   stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.kill)
        while not self.checkpoint.exists():
            time.sleep(0.01)
        self.checkpoint.unlink()
        self.checkpoint.mkdir()
        said = process.communicate(timeout=60)[1]
        self.assertTrue(self.output.exists(), said)
        self.assertEqual(said.count("the render goes on"), 1, said)

    def test_a_checkpoint_that_is_not_asked_for_is_said(self):
        self.checkpoint.write_bytes(b"old")
        result = run(*[a for a in self.arguments("--resolution", "16,16", "--spp", 1, scene=BOX) if a != "--quiet"])
        self.assertEqual(result.returncode, 0)
        self.assertIn("is not used without --resume", result.stderr)

    def test_a_checkpoint_that_cannot_be_written_is_said_before_the_first_sample(self):
        self.output = self.folder / "none/x.exr"
        self.fails(1, *self.arguments("--checkpoint", 1, *SIZE), says=["none"])
        self.fails(2, "render", BOX, "-o", self.folder / "x.exr", "--checkpoint", "0", says=["--checkpoint"])


class Kills(Broken):
    def test_twenty_kills(self):
        kept = self.equal_after_kills(20, random.Random(20), *SIZE, "--spp", 300)
        print(f"{kept} of 20 killed renders left a checkpoint")
        self.assertGreater(kept, 10)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""--quality: what it sets, for which pictures it is the default, and that the time left is true."""
import json
import subprocess
import time

from support import FRAGTRACE, SCENES, Case, main, run

BOX = SCENES / "cornell-box.gltf"
SMALL = ["--resolution", "32,24", "--quiet"]
GOALS = {"draft": (0.2, 16), "good": (0.1, 512), "best": (0.03, 4096)}
RENDERS = ("cornell-box", "water-cube", "plastics", "caustic-ground", "many-lights", "sphere-plane-mirror", "rough-glass", "vitrine", "coverage",
           "environment-diffuse")


class Quality(Case):
    def settled(self, output, *options):
        """The noise asked for, the samples at most, and the filter, in the words of the statistics."""
        stats = self.folder / "s.json"
        self.renders(BOX, "-o", self.folder / output, *SMALL, "--stats", stats, *options)
        stats = json.loads(stats.read_text())
        return stats.get("adaptive", {}).get("noise"), stats["spp"], stats.get("denoise", {}).get("filter")

    def test_each_sets_noise_samples_and_filter(self):
        for name in ("draft", "good"):
            for output in ("x.png", "x.exr"):
                self.assertEqual(self.settled(output, "--quality", name), (*GOALS[name], "variance 5"))

    def test_good_is_the_default_of_pictures_for_the_eye(self):
        for output in ("x.png", "x.jpg"):
            self.assertEqual(self.settled(output), (*GOALS["good"], "variance 5"))
        for output in ("x.exr", "x.hdr", "x.pfm"):
            self.assertEqual(self.settled(output), (None, 64, None))
        for own, expected in (("--spp 4", (None, 4, None)), ("--noise 0.3", (0.3, 1 << 29, None)), ("--denoise none", (None, 64, None)),
                              ("--region 0,0,8,8", (None, 64, None)), ("--light-reuse spatial", (None, 64, None)), ("--quality none", (None, 64, None)),
                              ("--debug-view normal", (None, 64, None)), ("--stage shadows", (None, 64, None))):
            self.assertEqual(self.settled("x.png", *own.split()), expected, own)
        config = self.folder / "c.json"
        config.write_text(json.dumps({"spp": 4}))
        self.assertEqual(self.settled("x.png", "--config", config), (None, 4, None))

    def test_what_other_options_say_stays(self):
        self.assertEqual(self.settled("x.png", "--quality", "good", "--spp", 8), (0.1, 8, "variance 5"))
        self.assertEqual(self.settled("x.png", "--quality", "draft", "--noise", 0.5), (0.5, 16, "variance 5"))
        self.assertEqual(self.settled("x.png", "--quality", "draft", "--denoise", "none"), (0.2, 16, None))

    def test_the_picture_depends_on_the_seed_alone(self):
        first = self.folder / "a.png"
        second = self.folder / "b.png"
        self.renders(BOX, "-o", first, *SMALL)
        self.renders(BOX, "-o", second, *SMALL, "--noise", 0.1, "--spp", 512, "--denoise", "variance")
        self.assertEqual(first.read_bytes(), second.read_bytes())

    def test_a_goal_that_is_not_reached_is_said(self):
        said = self.renders(SCENES / "vitrine.gltf", "-o", self.folder / "x.png", "--resolution", "16,16", "--quality", "draft").stderr
        self.assertIn("some pixels are noisier than --quality draft asks for after 16 samples", said)
        self.assertNotIn("warning", said)


class TimeLeft(Case):
    def test_a_draft_that_its_limit_ends_was_near_its_end(self):
        said = run("render", BOX, "-o", self.folder / "x.png", "--resolution", "600,400", "--quality", "draft", "--progress", "json").stderr
        told = [event["fraction"] for event in map(json.loads, said.splitlines()) if event.get("phase") == "rendering"]
        self.assertGreater(max(told), 0.75)

    def test_a_third_of_the_way_the_time_left_is_right(self):
        """Within 30 %, in the median of ten renders, and in eight of them within 60 %."""
        ratios = []
        for scene in RENDERS:
            command = [FRAGTRACE, "render", SCENES / f"{scene}.gltf", "-o", self.folder / "x.png", "--resolution", "320,240", "--progress", "json"]
            told = []
            with subprocess.Popen(list(map(str, command)), stderr=subprocess.PIPE, text=True) as process:
                for line in process.stderr:
                    event = json.loads(line)
                    if event.get("phase") == "rendering":
                        told.append((time.monotonic(), event["seconds_left"]))
            self.assertEqual(process.returncode, 0)
            start, end = told[0][0], told[-1][0]
            third, left = next(t for t in told if t[0] - start >= (end - start) / 3)
            ratios.append(left / (end - third))
            print(f"{scene}: {end - start:.1f} s, {left:.1f} s left at a third: {ratios[-1]:.2f} of the truth")
        self.assertTrue(0.7 < sorted(ratios)[5] < 1.3, ratios)
        self.assertGreaterEqual(sum(0.4 < r < 1.6 for r in ratios), 8, ratios)


if __name__ == "__main__":
    main()

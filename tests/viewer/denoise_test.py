#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The noise filter in the window: while samples are few, while the camera moves, and against the raw picture."""
from pathlib import Path

from support import FRAGTRACE, Case, largest_difference, main, pixels_of

SIZE = ["--resolution", "160,120", "--tone-map", "linear"]
FILTER = ["--denoise", "variance"]


def distance(a, b):
    """Mean squared difference, in levels."""
    return sum((u - v) ** 2 for p, q in zip(a, b) for u, v in zip(p, q)) / len(a)


def mean(picture, channel):
    return sum(pixel[channel] for pixel in picture) / len(picture)


class DenoisedView(Case):
    def reference(self):
        return pixels_of(self.render("cornell-box", *SIZE, "--spp", 128, "--seed", 5))

    def shot(self, viewer):
        return pixels_of(viewer.press_for_file("F12", ".png"))

    def filtered(self, viewer, share):
        viewer.until(lambda s: abs(s["sides"][0]["filtered"] - share) < 1e-6 and s["state"] == "resting", f"filtered {share}")

    def test_a_key_and_the_box_compare_it_with_the_raw_picture(self):
        viewer = self.view("cornell-box", "--resolution", "560,480", "--tone-map", "linear", *FILTER, "--spp", "2")
        self.filtered(viewer, 1)
        clean = self.shot(viewer)
        viewer.key("g")
        self.filtered(viewer, 0)
        raw = self.shot(viewer)
        self.same(raw, pixels_of(self.render("cornell-box", "--resolution", "560,480", "--tone-map", "linear", "--spp", 2)))
        viewer.click("Denoise")
        self.filtered(viewer, 1)
        self.same(clean, self.shot(viewer))
        self.assertEqual(viewer.status()["sides"][0]["samples"], 2)
        viewer.key("F7")  # without gi there is nothing to filter
        self.filtered(viewer, 0)
        self.ends_well(viewer, viewer.close())

    def test_it_takes_most_of_the_error_away_and_fades_out(self):
        reference = self.reference()
        errors = {}
        for samples, share in ((4, 1), (256, 0)):
            viewer = self.view("cornell-box", *SIZE, *FILTER, "--spp", samples)
            self.filtered(viewer, share)
            errors[samples] = distance(self.shot(viewer), reference)
            raw = pixels_of(self.render("cornell-box", *SIZE, "--spp", samples))
            with self.subTest(samples=samples):
                if share == 0:
                    self.same(self.shot(viewer), raw)
                else:
                    self.assertLess(errors[samples], 0.2 * distance(raw, reference))
            self.ends_well(viewer, viewer.close())

    def test_open_image_denoise(self):
        """The stand-in adds 0.25 of albedo and -0.5 of the normal to each colour; one that fails leaves what was drawn."""
        library = ["--denoise", "oidn", "--oidn-library", FRAGTRACE.parent / "fake_oidn/libOpenImageDenoise.so.2"]
        raw = pixels_of(self.render("cornell-box", *SIZE, "--spp", 4))
        for told, works in (("", True), ("execute", False)):
            with self.subTest(told=told):
                self.screen.environment["FAKE_OIDN"] = told
                viewer = self.view("cornell-box", *SIZE, *library, "--spp", "4")
                viewer.rest(lambda s: s["sides"][0]["samples"] == 4)
                shown = self.shot(viewer)
                if works:
                    rendered = pixels_of(self.render("cornell-box", *SIZE, *library, "--spp", 4))
                    for c in range(3):  # not pixel by pixel: the coarser pictures on the way to rest count, too
                        self.assertAlmostEqual(mean(shown, c), mean(rendered, c), delta=3)
                    self.assertGreater(abs(mean(shown, 1) - mean(raw, 1)), 5)
                else:
                    self.assertLessEqual(largest_difference(shown, raw), 1)  # the two compile with other optimisations
                    self.assertIn("Open Image Denoise", viewer.status()["error"])
                viewer.close()

    def test_files_of_radiance_keep_what_was_drawn(self):
        viewer = self.view("cornell-box", *SIZE, *FILTER, "--spp", "4")
        self.filtered(viewer, 1)
        files = []
        for share in (1, 0):
            self.filtered(viewer, share)
            files.append(Path(viewer.press_for_file("shift+F12", ".exr")).read_bytes())
            viewer.key("g")
        self.assertEqual(*files)
        self.ends_well(viewer, viewer.close())

    def test_what_was_seen_before_counts(self):
        """After a turn of the camera one sample and the past show less noise than one sample alone, and no ghost."""
        viewer = self.view("cornell-box", *SIZE, *FILTER, "--spp", "32")
        self.filtered(viewer, 1)
        viewer.key("Page_Up")
        viewer.until(lambda s: s["sides"][0]["samples"] >= 1 and s["sides"][0]["samples"] < 32, "a new view")
        self.filtered(viewer, 1)
        late = self.shot(viewer)
        camera = viewer.status()["camera"].split()
        reference = pixels_of(self.render("cornell-box", *camera, "--tone-map", "linear", "--spp", 160, "--seed", 5))
        raw = pixels_of(self.render("cornell-box", *camera, "--tone-map", "linear", "--spp", 32))
        self.assertLess(distance(late, reference), 0.5 * distance(raw, reference))
        self.ends_well(viewer, viewer.close())


if __name__ == "__main__":
    main()

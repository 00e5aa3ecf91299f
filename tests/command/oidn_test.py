#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`--denoise oidn`, `auto` and `fragtrace denoise`: by a stand-in for the library (tests/faults/fake_oidn.cpp), and by the real one."""
import ctypes.util
import json
import math
import os
import shutil
import subprocess
import sys
from pathlib import Path

from support import FRAGTRACE, SCENES, Case, Exr, main, read_pfm, run, write_exr

BOX = SCENES / "cornell-box.gltf"
FAKE = FRAGTRACE.parent / "fake_oidn/libOpenImageDenoise.so.2"
SMALL = ["--resolution", "24,16", "--spp", 2, "--quiet"]
GUIDES = [f"denoising.{layer}.{c}" for layer, ends in (("albedo", "RGB"), ("normal", "XYZ")) for c in ends]
NEEDED = ["--aov", "denoising"]


def surroundings(**variables):
    """No library, but what these say."""
    hidden = ("FRAGTRACE_OIDN_LIBRARY", "VIRTUAL_ENV", "HOME", "FAKE_OIDN")
    return {**{k: v for k, v in os.environ.items() if k not in hidden}, "PATH": "/usr/bin:/bin", **variables}


class OidnCase(Case):
    def draw(self, name, *options, scene=BOX, told="", library=FAKE):
        path = self.folder / name
        small = [] if "--resolution" in options else ["--resolution", "24,16"]
        small += [] if "--spp" in options else ["--spp", 2]
        self.renders(scene, "-o", path, "--quiet", *small, *options, env=surroundings(FRAGTRACE_OIDN_LIBRARY=str(library), FAKE_OIDN=told))
        return path

    def denoises(self, picture, name, *options, says="", status=0, **variables):
        path = self.folder / name
        result = run("denoise", picture, "-o", path, *options, env=surroundings(**{"FRAGTRACE_OIDN_LIBRARY": str(FAKE), **variables}))
        self.assertEqual(result.returncode, status, result.stderr)
        self.assertIn(says, result.stderr)
        return path

    def near(self, got, expected, part=1e-5):
        self.assertEqual(len(got), len(expected))
        for a, b in zip(got, expected):
            self.assertAlmostEqual(a, b, delta=part * max(1, abs(b)))


class Oidn(OidnCase):
    def test_the_filter_gets_colour_albedo_and_normal_and_the_noisy_picture_stays(self):
        """The stand-in works on radiance divided by a power of two, which is told here from R."""
        raw = Exr(self.draw("n.exr", *NEEDED))
        stats = self.folder / "s.json"
        filtered = Exr(self.draw("d.exr", "--denoise", "oidn", "--aov", "albedo", "--stats", stats))
        self.assertEqual(set(filtered.layers), {*"RGB", "noisy.R", "noisy.G", "noisy.B", "albedo.R", "albedo.G", "albedo.B"})
        self.assertEqual(filtered.texts["fragtrace:denoise"], "oidn 2.77.1")
        colors = [v for c in "RGB" for v in raw.values(c) if v > 0]
        scale = 2.0 ** round(sum(map(math.log2, colors)) / len(colors))
        for c, (color, albedo, normal) in enumerate(zip("RGB", GUIDES[:3], GUIDES[3:])):
            self.assertEqual(raw.values(color), filtered.values("noisy." + color))
            self.near(filtered.values(color), [r + scale * (a + n) for r, a, n in zip(*map(raw.values, (color, albedo, normal)))])
        said = json.loads(stats.read_text())["denoise"]
        self.assertEqual((said["filter"], said["library"]), ("oidn 2.77.1", str(FAKE)))
        self.assertGreater(said["load_ms"], 0)
        self.assertGreater(said["ms"], 0)

    def test_auto_takes_what_there_is(self):
        for library, name in ((FAKE, "oidn 2.77.1"), ("/none", "variance 5")):
            picture = Exr(self.draw("d.exr", "--denoise", "auto", library=library))
            self.assertEqual(picture.texts["fragtrace:denoise"], name)

    def test_a_library_named_in_vain_is_warned_about_by_auto(self):
        result = run("render", BOX, "-o", self.folder / "x.png", "--denoise", "auto", "--oidn-library", "/none", *SMALL[:-1], env=surroundings())
        self.assertEqual(result.returncode, 0)
        self.assertIn("warning: --denoise auto: the variance filter: --oidn-library", result.stderr)

    def test_stages_without_noise_open_nothing(self):
        self.draw("x.exr", "--stage", "shadows", "--denoise", "oidn", library="/none")

    def test_alpha_stays(self):
        scene = SCENES / "sphere-textured.gltf"
        raw, filtered = (Exr(self.draw("x.exr", "--no-background", *more, scene=scene)) for more in ([], ["--denoise", "oidn"]))
        self.assertEqual(raw.values("A"), filtered.values("A"))
        self.assertNotEqual(raw.values("R"), filtered.values("R"))

    def test_output_that_is_not_finite_stays_noisy(self):
        picture = Exr(self.draw("x.exr", "--denoise", "oidn", told="nan"))
        self.assertEqual(picture.values("R"), picture.values("noisy.R"))

    def test_pip_s_folder_is_found(self):
        if ctypes.util.find_library("OpenImageDenoise"):
            self.skipTest("the system has the library, which goes before")
        place = self.folder / "lib/python3.99/site-packages/pyoidn/oidn/lib"
        place.mkdir(parents=True)
        shutil.copy(FAKE, place)
        for variables, home in (({"VIRTUAL_ENV": self.folder}, None), ({"PATH": f"{self.folder}/bin:/usr/bin:/bin"}, None),
                                ({"HOME": self.folder / "local"}, ".local"), ({"HOME": self.folder / "pyenv"}, ".pyenv/versions/3.99.0")):
            if home:
                (variables["HOME"] / home).parent.mkdir(parents=True)
                (variables["HOME"] / home).symlink_to(self.folder)
            picture = self.folder / "x.exr"
            self.renders(BOX, "-o", picture, *SMALL, "--denoise", "oidn", env=surroundings(**{k: str(v) for k, v in variables.items()}))
            self.assertEqual(Exr(picture).texts["fragtrace:denoise"], "oidn 2.77.1")


class OidnFailures(OidnCase):
    def refuses(self, *options, says, told="", **variables):
        """Before anything is drawn: the scene is not even read."""
        self.fails(2, "render", self.folder / "none.gltf", "-o", self.folder / "x.png", "--denoise", "oidn", *options, says=says,
                   env=surroundings(FAKE_OIDN=told, **variables))

    def test_a_run_without_the_library_says_how_to_get_it(self):
        folders = (*Path("/usr/local/lib").glob("python3*/dist-packages"), Path("/usr/lib/python3/dist-packages"))
        if ctypes.util.find_library("OpenImageDenoise") or any((folder / "pyoidn").exists() for folder in folders):
            self.skipTest("the library is installed")
        self.refuses(says=("libOpenImageDenoise.so.2", "pip install pyoidn", "--oidn-library"))

    def test_files_that_are_no_such_library(self):
        text, pipe, lacking = self.folder / "a.so", self.folder / "p.so", self.folder / "l.so"
        text.write_text("no library")
        os.mkfifo(pipe)
        lacking.write_bytes(FAKE.read_bytes().replace(b"oidnExecuteFilter\0", b"oidnExecuteFrames\0"))
        for path, says in ((text, "a.so"), (pipe, "is no file"), (self.folder, "is no file"), ("/none", "no such file"),
                           (lacking, "lacks oidnExecuteFilter")):
            self.refuses("--oidn-library", path, says=[says])
        self.refuses(says=["FRAGTRACE_OIDN_LIBRARY", "/none"], FRAGTRACE_OIDN_LIBRARY="/none")

    def test_the_option_goes_before_the_variable(self):
        self.refuses("--oidn-library", "/none", says=["--oidn-library"], FRAGTRACE_OIDN_LIBRARY=str(FAKE))

    def test_libraries_that_do_not_start(self):
        for told, says in (("version", "is Open Image Denoise 3.77.1, where 2.x is needed"), ("no-device", "no device of that kind"),
                           ("commit-device", "unsupported processor")):
            self.refuses("--oidn-library", FAKE, says=[says, FAKE], told=told)

    def test_a_filter_that_fails_loses_no_picture(self):
        kept = self.folder / "x.exr"
        for told, says in (("no-filter", "no filter of that kind"), ("commit", "not enough memory"), ("execute", "out of memory in a layer")):
            kept.write_bytes(b"an older picture")
            result = run("render", BOX, "-o", kept, *SMALL, "--denoise", "oidn", "--oidn-library", FAKE, env=surroundings(FAKE_OIDN=told))
            self.assertEqual(result.returncode, 1)
            self.assertIn(f"Open Image Denoise 2.77.1 failed: {says}", result.stderr)
            self.assertEqual(kept.read_bytes(), b"an older picture")
            self.assertTrue(any(v > 0 for row in read_pfm(self.folder / "x.pfm") for pixel in row for v in pixel))
            self.assertEqual({p.name for p in self.folder.iterdir()}, {"x.exr", "x.pfm"})
            (self.folder / "x.pfm").unlink()
        kept.unlink()

    def test_an_interrupt_stops_the_filter_and_the_noisy_picture_is_written(self):
        raw = Exr(self.draw("n.exr"))
        for told, exists in (("interrupted", True), ("interrupted-twice", False)):
            path, stats = self.folder / f"{told}.exr", self.folder / "s.json"
            result = run("render", BOX, "-o", path, *SMALL, "--denoise", "oidn", "--oidn-library", FAKE, "--stats", stats, timeout=8,
                         env=surroundings(FAKE_OIDN=told))
            self.assertEqual((result.returncode, path.exists()), (130, exists), result.stderr)
        noisy = Exr(self.folder / "interrupted.exr")
        self.assertEqual(noisy.layers, raw.layers)
        self.assertNotIn("fragtrace:denoise", noisy.texts)
        self.assertEqual(json.loads(stats.read_text())["denoise"], {"skipped": "interrupted"})


class DenoiseFiles(OidnCase):
    """`fragtrace denoise`, and `merge --denoise`."""

    def test_a_file_gives_what_render_gives(self):
        for scene, spp in ((BOX, 3), (SCENES / "glass-sphere.gltf", 8)):
            few = ["--spp", spp, "--resolution", "96,64", *NEEDED]
            raw = self.draw("n.exr", *few, scene=scene)
            for filter in ("oidn", "variance"):
                whole = Exr(self.draw("d.exr", *few, "--denoise", filter, scene=scene))
                file = Exr(self.denoises(raw, "f.exr", "--denoise", filter))
                self.assertEqual((set(file.layers), file.texts), (set(whole.layers), whole.texts))
                for name in whole.layers:
                    self.assertEqual(file.values(name), whole.values(name), name)

    def test_layers_of_first_hits_do_for_the_variance_filter(self):
        """Coverage is told from the depth."""
        few = ["--spp", 3, "--resolution", "96,64"]
        raw = self.draw("n.exr", *few, "--aov", "albedo,normal,depth,samples,variance")
        whole, file = Exr(self.draw("d.exr", *few, "--denoise", "variance")), Exr(self.denoises(raw, "f.exr", "--denoise", "variance"))
        light, differences = zip(*((abs(b), abs(a - b)) for c in "RGB" for a, b in zip(file.values(c), whole.values(c))))
        self.assertLess(sum(differences), 0.001 * sum(light))

    def test_a_filtered_file_is_filtered_from_its_noisy_colours(self):
        first = self.denoises(self.draw("n.exr", *NEEDED), "a.exr", "--denoise", "variance")
        self.assertEqual(Exr(first).texts["fragtrace:denoise"], "variance 5")
        direct, again = self.denoises(self.folder / "n.exr", "b.exr"), self.denoises(first, "c.exr", "--denoise", "oidn")
        self.assertEqual(Exr(direct).layers, Exr(again).layers)
        self.assertEqual(Exr(again).texts["fragtrace:denoise"], "oidn 2.77.1")

    def test_files_of_other_renderers(self):
        """Geometric mean 1, so that the stand-in adds 0.25 of albedo and -0.5 of the normal to each colour, 3 in all but one file."""
        colors = {"R": 0.5, "G": 1.0, "B": 2.0}
        layer = lambda stem, ends, value: {stem + c: value for c in ends}
        cycles = {**{f"ViewLayer.Combined.{c}": v for c, v in colors.items()}, "ViewLayer.Combined.A": 0.5,
                  **layer("ViewLayer.Denoising Albedo.", "RGB", 0.25), **layer("ViewLayer.Denoising Normal.", "XYZ", -0.5)}
        noisy = {f"ViewLayer.Noisy Image.{c}": v for c, v in colors.items()}
        other = {f"Other.Denoising {kind}.{c}": 9.0 for kind, ends in (("Albedo", "RGB"), ("Normal", "XYZ")) for c in ends}
        files = {"cycles": {**cycles, **other}, "cycles denoised": {**cycles, **layer("ViewLayer.Combined.", "RGB", 7.0), **noisy},
                 "mitsuba": {**colors, **layer("albedo.", "RGB", 0.25), **layer("sh_normal.", "XYZ", -0.5), "dd.T": 1.0},
                 "mitsuba's example": {**colors, **layer("albedo.", "RGB", 0.25), **layer("nn.", "XYZ", -0.5)},
                 "pbrt": {**colors, **layer("Albedo.", "RGB", 0.25), **layer("Ns.", "XYZ", -0.5), **layer("N.", "XYZ", 9.0)},
                 "ours": {**colors, **layer("albedo.", "RGB", 0.25), **layer("normal.", "XYZ", -0.5)},
                 "ours, with guides": {**colors, **layer("albedo.", "RGB", 9.0), **layer("denoising.albedo.", "RGBA", 0.25),
                                       **layer("denoising.normal.", "XYZ", -0.5), "denoising.depth.Z": 1.0},
                 "ours, of the background": {**colors, **layer("denoising.albedo.", "RGB", 0.25), "denoising.albedo.A": 0.0,
                                             **layer("denoising.normal.", "XYZ", -0.5), "denoising.depth.Z": 0.0},
                 "colours alone": {**colors, "depth.Z": 3.0}, "normal alone": {**colors, **layer("normal.", "XYZ", -0.5)}}
        for name, layers in files.items():
            with self.subTest(name):
                lacking = name.endswith("alone")
                path = write_exr(self.folder / "in.exr", 5, 3, layers)
                out = Exr(self.denoises(path, "out.exr", "--quiet") if not lacking else
                          self.denoises(path, "out.exr", says="has no albedo and normal layers, so the colours alone are filtered"))
                added = 0 if lacking or name.endswith("background") else 0.25 - 0.5
                for c, value in colors.items():
                    self.near(out.values(c), [value + added] * 15)
                    self.near(out.values("noisy." + c), [value] * 15)
                for layer_name, value in layers.items():
                    if layer_name not in colors:
                        self.assertEqual(out.values(layer_name), [value] * 15, layer_name)
                self.assertEqual("A" in out.layers, name.startswith("cycles"))

    def test_what_the_variance_filter_lacks_is_named(self):
        path = write_exr(self.folder / "in.exr", 2, 2, {"R": 1.0, "G": 1.0, "B": 1.0, "albedo.R": 1.0, "albedo.G": 1.0, "albedo.B": 1.0, "depth.Z": 1.0})
        for filter, library in (("variance", FAKE), ("auto", "/none")):
            self.fails(3, "denoise", path, "-o", self.folder / "o.exr", "--denoise", filter, "--quiet", env=surroundings(FRAGTRACE_OIDN_LIBRARY=str(library)),
                       says=[path, "needs: normal, samples, variance (render with --aov denoising"])

    def test_a_guide_that_lacks_is_the_only_one_named(self):
        picture = Exr(self.draw("n.exr", *NEEDED))
        layers = {name: picture.values(name) for name in picture.layers if not name.startswith("denoising.normal")}
        path = write_exr(self.folder / "in.exr", picture.width, picture.height, layers)
        self.fails(3, "denoise", path, "-o", self.folder / "o.exr", "--denoise", "variance", "--quiet", says=[path, "needs: normal (render"])

    def test_holes_are_filled_from_their_rims(self):
        """Eight rows of a picture of one colour are no numbers."""
        one = {name: 1.0 for name in ("R", "G", "B", "samples.Y", "denoising.depth.Z", "denoising.normal.Z", *(f"denoising.albedo.{c}" for c in "RGBA"))}
        layers = {**one, "variance.Y": 0.0, "denoising.normal.X": 0.0, "denoising.normal.Y": 0.0}
        for channel in "RGB":
            layers[channel] = [math.nan if 4 <= i // 16 < 12 else 0.5 for i in range(256)]
        path = write_exr(self.folder / "in.exr", 16, 16, layers)
        filtered = self.denoises(path, "o.exr", "--denoise", "variance")
        for channel in "RGB":
            self.near(Exr(filtered).values(channel), [0.5] * 256)
        path.unlink()  # these and noisy.* are no numbers
        filtered.unlink()

    def test_refused_files_and_options(self):
        picture = self.draw("n.png", "--stage", "flat")
        depth = write_exr(self.folder / "d.exr", 2, 2, {"depth.Z": 1.0, "samples.Y": 1.0})
        env = surroundings(FRAGTRACE_OIDN_LIBRARY=str(FAKE))
        out = self.folder / "o.exr"
        for status, arguments, says in ((3, [picture, "-o", out], "no picture of linear radiance"), (3, [depth, "-o", out], "has no colour"),
                                        (3, [self.folder / "none.exr", "-o", out], "none.exr"), (2, [depth, "-o", depth], "is read by this command"),
                                        (2, [depth, "-o", self.folder / "o.txt"], "ends in none of"), (2, [depth, "-o", out, "--denoise", "none"], "none of auto")):
            self.fails(status, "denoise", *arguments, says=[says], env=env)

    def test_an_existing_output_stays_when_the_filter_fails_or_is_interrupted(self):
        path, kept = self.draw("n.exr", *NEEDED), self.folder / "o.pfm"
        kept.write_bytes(b"PF\n1 1\n-1.0\n" + bytes(12))
        before = kept.read_bytes()
        for told, status in (("execute", 1), ("interrupted", 130)):
            self.denoises(path, "o.pfm", "--quiet", FAKE_OIDN=told, status=status)
            self.assertEqual((kept.read_bytes(), len(list(self.folder.iterdir()))), (before, 2))

    def test_display_formats_are_render_s(self):
        raw = self.draw("n.exr", *NEEDED)
        shown = ["--exposure", 1, "--tone-map", "aces"]
        for name in ("x.png", "x.jpg"):
            expected = self.draw(name, "--denoise", "oidn", *shown).read_bytes()
            self.assertEqual(self.denoises(raw, name, *shown).read_bytes(), expected)

    def test_values_that_are_no_radiance(self):
        """A pixel that is not finite is filled from its neighbours; pictures without light stay as they are."""
        values = [math.nan, math.inf, -math.inf, -2.0, 1.0, 1.0]
        path = self.folder / "in.exr"
        write_exr(path, 3, 2, {c: values for c in "RGB"})
        self.near(Exr(self.denoises(path, "o.exr", "--denoise", "oidn")).values("R"), [-0.5, 0, 1, -2, 1, 1])
        # What lies deeper is filled from what was filled before it.
        write_exr(path, 4, 1, {c: [math.inf, math.nan, math.nan, 3.0] for c in "RGB"})
        (self.folder / "o.exr").unlink()
        self.near(Exr(self.denoises(path, "o.exr", "--denoise", "oidn")).values("R"), [3, 3, 3, 3])
        path.unlink()
        (self.folder / "o.exr").unlink()
        for value in (0.0, -1.0):
            write_exr(path, 3, 2, {c: value for c in "RGB"})
            self.assertEqual(Exr(self.denoises(path, "o.exr")).values("R"), [value] * 6)

    def test_merge_filters_the_whole_if_asked(self):
        parts = [self.draw(f"{i}.exr", *NEEDED, "--sample-offset", 2 * i, *(["--denoise", "oidn"] if i else [])) for i in range(2)]
        plain, filtered = self.folder / "m.exr", self.folder / "f.exr"
        for output, options in ((plain, []), (filtered, ["--denoise", "oidn"])):
            result = run("merge", *parts, "-o", output, *options, env=surroundings(FRAGTRACE_OIDN_LIBRARY=str(FAKE)))
            self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertRegex(result.stdout, r", oidn 2\.77\.1 in \d+\.\d\d s\n$")
        self.assertNotIn("fragtrace:denoise", Exr(plain).texts)
        self.assertEqual(Exr(filtered).layers, Exr(self.denoises(plain, "d.exr")).layers)
        self.assertEqual(Exr(filtered).texts["fragtrace:denoise"], "oidn 2.77.1")


class RealOidn(OidnCase):
    """The library itself: that of FRAGTRACE_OIDN_LIBRARY, else pip's, installed for the test."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.library = os.environ.get("FRAGTRACE_OIDN_LIBRARY")
        if cls.library:
            return
        place = FRAGTRACE.parent / "pyoidn"
        if not (place / "pyoidn").exists():
            subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--target", place, "pyoidn"], check=True)
        cls.library = place / "pyoidn/oidn/lib/libOpenImageDenoise.so.2"

    def relmse(self, picture, reference):
        return float(run("diff", picture, reference, "--metric", "relmse").stdout)

    def test_half_of_the_error_and_the_same_light(self):
        size = ["--resolution", "128,128"]
        reference = self.draw("r.exr", *size, "--spp", 512, "--seed", 9)
        for spp in (4, 16):
            noisy = self.draw("n.exr", *size, "--spp", spp)
            picture = self.draw("d.exr", *size, "--spp", spp, "--denoise", "oidn", library=self.library)
            self.assertTrue(Exr(picture).texts["fragtrace:denoise"].startswith("oidn 2."))
            self.assertLess(self.relmse(picture, reference), 0.5 * self.relmse(noisy, reference))
            light, before = (sum(Exr(p).luminances()) for p in (picture, noisy))
            self.assertAlmostEqual(light / before, 1, delta=0.01)
            # The lamp, of luminance 12.5, is not cut.
            lamp, was = (sum(sorted(Exr(p).luminances())[-100:]) / 100 for p in (picture, reference))
            self.assertGreater(was, 10)
            self.assertAlmostEqual(lamp / was, 1, delta=0.05)

    def test_pictures_of_any_size_and_brightness(self):
        for size in ("1,1", "1,70", "16384,1"):
            self.draw("x.exr", "--resolution", size, "--denoise", "oidn", library=self.library)  # tearDown looks for values that are not finite
        for brightness in (1e-35, 1.0, 1e6, 1e35):
            values = [brightness * (1 + 0.5 * math.sin(12.9 * i)) for i in range(32 * 32)]
            path = write_exr(self.folder / "in.exr", 32, 32, dict.fromkeys("RGB", values))
            out = Exr(self.denoises(path, "o.exr", FRAGTRACE_OIDN_LIBRARY=str(self.library)))
            self.assertAlmostEqual(sum(out.values("R")) / sum(values), 1, delta=0.05)


if __name__ == "__main__":
    main()

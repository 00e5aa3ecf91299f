#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Tests of stored pictures: 16-bit floats and integers, and the camera in the header of an .exr."""
import json

from debug_view_test import encoded
from support import SCENES, SMALL, Case, Exr, main, quad, read_png, run

BOX = SCENES / "cornell-box.gltf"


class Encodings(Case):
    def test_half_is_the_same_picture_rounded_and_says_what_it_clamps(self):
        exact, half = self.folder / "exact.exr", self.folder / "half.exr"
        layers = ("--aov", "albedo,depth,samples,variance")
        self.renders(BOX, "-o", exact, *SMALL, *layers)
        self.assertEqual(self.renders(BOX, "-o", half, *SMALL, *layers, "--half").stderr, "")
        self.assertLess(half.stat().st_size, 0.85 * exact.stat().st_size)
        one, other = Exr(exact), Exr(half)
        self.assertEqual(one.texts, other.texts)
        for name in one.layers:
            relative = 2**-11 if name[-1] in "RGB" else 0
            for a, b in zip(one.values(name), other.values(name)):
                self.assertLessEqual(abs(a - b), relative * abs(a) + (2**-25 if relative else 0), name)
        lamp = quad({"emissiveFactor": [1, 0.5, 0], "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 1e5}}})
        scene = self.written("lamp.gltf", {k: v for k, v in lamp.items() if v})
        small = ("--resolution", "4,4", "--spp", 2)
        self.renders(scene, "-o", exact, *small)
        result = self.renders(scene, "-o", half, "--half", *small)
        beyond = sum(value > 65504 for name in "RGB" for value in Exr(exact).values(name))
        self.assertGreater(beyond, 4)
        self.assertIn(f"{beyond} values are beyond 65504", result.stderr)
        self.assertEqual(max(Exr(half).values("R")), 65504)

    def test_merge_and_denoise_write_halves_too(self):
        parts = [self.folder / f"{i}.exr" for i in range(2)]
        for i, part in enumerate(parts):
            self.renders(BOX, "-o", part, *SMALL, "--sample-offset", 2 * i, "--half")
        merged = self.folder / "merged.exr"
        self.assertEqual(run("merge", *parts, "-o", merged, "--half").returncode, 0)
        self.assertLess(merged.stat().st_size, 4096)
        self.assertEqual(Exr(merged).texts["fragtrace:samples"], "4")

    def test_depth_of_a_png(self):
        for depth in (8, 16):
            path = self.folder / f"{depth}.png"
            self.renders(BOX, "-o", path, *SMALL, "--png-depth", depth)
            self.assertEqual(path.read_bytes()[24], depth)

    def test_noise_before_8_bits(self):
        """The noise moves a level by at most one step; without it, the level is the nearest."""
        linear = self.folder / "x.exr"
        self.renders(BOX, "-o", linear, *SMALL)
        exact = [255 * encoded(max(0, min(1, value))) for pixel in zip(*map(Exr(linear).values, "RGB")) for value in pixel]
        seen = {}
        for name, options, apart in (("noisy", [], 1.51), ("plain", ["--no-dither"], 0.51)):
            path = self.folder / f"{name}.png"
            self.renders(BOX, "-o", path, *SMALL, "--tone-map", "linear", *options)
            _, _, rows, step = read_png(path)
            seen[name] = [row[x + c] for row in rows for x in range(0, len(row), step) for c in range(3)]
            self.assertLess(max(abs(level - value) for level, value in zip(seen[name], exact, strict=True)), apart)
        self.assertNotEqual(seen["noisy"], seen["plain"])
        self.assertIn("--no-dither: changes .png", run("render", BOX, "-o", linear, "--resolution", "8,8", "--spp", 1, "--no-dither").stderr)

    def test_refusals(self):
        for options, reason in (
            (("-o", "x.png", "--half"), "--half: only .exr files hold 16-bit floats"),
            (("-o", "x.exr", "--png-depth", 16), "--png-depth: 'x.exr' is no .png"),
            (("-o", "x.png", "--png-depth", 12), "--png-depth"),
        ):
            result = run("render", BOX, *options)
            self.assertEqual(result.returncode, 2)
            self.assertIn(reason, result.stderr)


def times(point, matrix):
    """Returns (x, y, z, 1) M, rows of four, divided by w."""
    row = (*point, 1.0)
    result = [sum(row[i] * matrix[4 * i + c] for i in range(4)) for c in range(4)]
    return [value / result[3] for value in result[:3]]


class ShaderTexts(Case):
    def test_the_tracer_is_written_for_reading(self):
        path = self.folder / "box.glsl"
        self.renders(BOX, "-o", self.folder / "x.pfm", *SMALL, "--shader-text", path)
        text = path.read_text()
        self.assertIn('#line 1 "machine.glsl"', text)
        self.assertIn("/// The path-traced material: one light sample", text)
        self.assertNotIn("sheenLambda", text)  # the box has no sheen
        self.fails(2, "render", BOX, "-o", self.folder / "y.pfm", *SMALL, "--stats", path, "--shader-text", path, says=["--shader-text"])


class Timelines(Case):
    def test_a_timeline_of_threads_and_processes(self):
        """As Perfetto reads it: each span is whole, and within the life of the process."""
        path = self.folder / "trace.json"
        self.renders(SCENES / "sphere-textured.gltf", "-o", self.folder / "x.png", *SMALL, "--trace-file", path)
        events = json.loads(path.read_text())["traceEvents"]
        rows = {e["tid"]: e["args"]["name"] for e in events if e["ph"] == "M"}
        spans = {e["name"]: e for e in events if e["ph"] == "X"}
        self.assertLessEqual({"main", "second"}, set(rows.values()))
        self.assertTrue(any(name.startswith("the image library, process ") for name in rows.values()), rows)
        self.assertLessEqual({"start of the process", "scene", "tree", "context", "pack", "program", "upload", "first draw", "draw", "write", "work"}, set(spans))
        end = next(e["ts"] for e in events if e["name"] == "picture")
        for span in spans.values():
            self.assertIn(span["tid"], rows)
            self.assertGreaterEqual(span["ts"], 0)
            self.assertGreaterEqual(span["dur"], 0)
        self.assertLessEqual(spans["draw"]["ts"] + spans["draw"]["dur"], end)
        self.fails(1, "render", SCENES / "furnace.gltf", "-o", self.folder / "y.pfm", *SMALL, "--trace-file", self.folder, says=["cannot write"])

    def test_the_filter_of_a_film_is_made_once_in_its_own_thread(self):
        path = self.folder / "trace.json"
        film = ["--frames", "0:2", "--fps", 2, *SMALL, "--denoise", "variance"]
        self.renders(SCENES / "wheel.gltf", "-o", self.folder / "x.###.pfm", *film, "--trace-file", path)
        events = json.loads(path.read_text())["traceEvents"]
        rows = {e["tid"]: e["args"]["name"] for e in events if e["ph"] == "M"}
        [filters] = [e for e in events if e["name"] == "prepare the filter"]
        self.assertEqual(rows[filters["tid"]], "filter")
        second = sorted(e["ts"] for e in events if e["name"] == "draw")[1]
        self.assertLess(filters["ts"], second)


class Headers(Case):
    CAMERA = ("--camera-position", "3,2,5", "--camera-focal-point", "0,1,0", "--resolution", "40,20", "--spp", 2, "--quiet")

    def header(self, name, *options):
        path = self.folder / name
        self.renders(BOX, "-o", path, *self.CAMERA, *options)
        return Exr(path)

    def near(self, found, expected):
        for a, b in zip(found, expected, strict=True):
            self.assertAlmostEqual(a, b, delta=1e-5)

    def test_a_perspective(self):
        numbers = self.header("a.exr", "--camera-view-angle", 90).numbers
        distance = (9 + 1 + 25)**0.5
        camera, ndc = numbers["worldToCamera"], numbers["worldToNDC"]
        self.near(times((3, 2, 5), camera), (0, 0, 0))
        self.near(times((0, 1, 0), camera), (0, 0, distance))
        # To the right of the view and level: x grows. Straight up: y grows, and NDC's falls.
        right = (5 / 34**0.5, 0, -3 / 34**0.5)
        corner = [f + 2 * distance * r for f, r in zip((0, 1, 0), right)]
        self.near(times(corner, camera), (2 * distance, 0, distance))
        self.near(times((0, 1, 0), ndc)[:2], (0.5, 0.5))
        self.near(times(corner, ndc)[:2], (1, 0.5))
        self.assertLess(times((0, 1.5, 0), ndc)[1], 0.5)
        self.near(numbers["screenWindowWidth"], [4])
        self.near(numbers["chromaticities"], (0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329))

    def test_pixels_lie_where_the_matrix_says(self):
        exr = self.header("a.exr", "--aov", "depth", "--stage", "flat", "--no-background")
        edge = exr.numbers["worldToNDC"]
        # The box's corners in the picture are the limits of what is covered.
        bounds = json.loads(run("info", BOX, "--json").stdout)["scene"]["bounds"]
        low, high = bounds["min"], bounds["max"]
        places = [times((x, y, z), edge) for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
        covered = [(x, y) for y, row in enumerate(exr.layers["A"]) for x, alpha in enumerate(row) if alpha > 0]
        for axis, size in ((0, 40), (1, 20)):
            least, most = min(p[axis] for p in covered), max(p[axis] for p in covered)
            self.assertAlmostEqual(least, max(min(p[axis] for p in places), 0) * size, delta=1.5)
            self.assertAlmostEqual(most, min(max(p[axis] for p in places), 1) * size, delta=1.5)

    def test_an_orthographic_view(self):
        numbers = self.header("a.exr", "--camera-parallel-scale", 2).numbers
        right = (5 / 34**0.5, 0, -3 / 34**0.5)
        for depth in (0.0, 1.0):  # it does not count
            point = [p * (1 - depth) + f * depth + 4 * r for p, f, r in zip((3, 2, 5), (0, 1, 0), right)]
            self.near(times(point, numbers["worldToNDC"])[:2], (1, 0.5))
        self.near(numbers["screenWindowWidth"], [1])

    def test_parts_and_filters_keep_it(self):
        whole = self.header("whole.exr")
        self.assertEqual(self.header("part.exr", "--region", "5,5,10,10").numbers, whole.numbers)
        self.assertEqual(self.header("part.exr", "--memory-limit", "1MB").numbers, whole.numbers)
        second = self.header("second.exr", "--sample-offset", 2)
        self.assertEqual(second.numbers, whole.numbers)
        files = [self.folder / name for name in ("whole.exr", "second.exr")]
        merged, filtered = self.folder / "merged.exr", self.folder / "filtered.exr"
        self.assertEqual(run("merge", *files, "-o", merged).returncode, 0)
        self.assertEqual(Exr(merged).numbers, whole.numbers)
        self.header("layers.exr", "--aov", "denoising")
        result = run("denoise", self.folder / "layers.exr", "-o", filtered, "--denoise", "variance")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(Exr(filtered).numbers, whole.numbers)

    def test_debug_views_have_a_camera_and_no_primaries(self):
        numbers = self.header("a.exr", "--debug-view", "normal").numbers
        self.assertIn("worldToCamera", numbers)
        self.assertNotIn("chromaticities", numbers)


if __name__ == "__main__":
    main()

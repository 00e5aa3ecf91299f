# SPDX-License-Identifier: MIT
"""The Python package as it is installed, next to the command. usage: package_test.py FRAGTRACE SOURCE_FOLDER [unittest arguments]"""
import _thread
import base64
import io
import json
import multiprocessing
import os
import pickle
import re
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

import numpy as np

import fragtrace

FRAGTRACE, SCENES = (Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve() / "scenes") if __name__ == "__main__" else (None, None)
SMALL = {"resolution": (24, 16), "spp": 2}


def draw_in_process(path, queue):
    try:
        queue.put(pickle.dumps(np.asarray(fragtrace.render(path, **SMALL))))
    except Exception as error:
        queue.put(pickle.dumps(str(error)))


class Package(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def command(self, *words):
        """The picture of the command built next to the tests, all layers."""
        path = self.folder / "command.exr"
        subprocess.run([FRAGTRACE, "render", *map(str, words), "-o", path, "--quiet"], check=True)
        return fragtrace.read(path)


class Pictures(Package):
    def test_the_values_are_those_of_the_command(self):
        for scene, words, keywords in [
                ("cornell-box.gltf", (), {}),
                ("coverage.gltf", ("--stage", "phong", "--seed", 3), {"stage": "phong", "seed": 3}),
                ("plastics.gltf", ("--hdri-file", SCENES / "sky.pfm", "--hdri-rotation", -30.5), {"hdri": SCENES / "sky.pfm", "hdri_rotation": -30.5}),
                ("plastics.gltf", ("--hide", "lamp", "--hide", "sphere-3", "--hdri-intensity", 2), {"hide": ("lamp", "sphere-3"), "hdri_intensity": 2}),
                ("plastics.gltf", ("--studio", "--shadow-catcher", 0.1), {"studio": True, "shadow_catcher": 0.1}),
                ("layered.gltf", ("--camera-position", "-1,2,5", "--camera-focal-point", "0,0.5,0"),
                 {"camera": {"position": (-1, 2, 5), "focal_point": np.array([0, 0.5, 0])}}),
                ("mesh-15743.gltf", ("--noise", 0.2, "--region", "4,4,10,10"), {"noise": 0.2, "region": (4, 4, 10, 10), "spp": 64})]:
            with self.subTest(scene):
                options = ["--resolution", "24x16", "--spp", keywords.get("spp", 2)]
                expected = self.command(SCENES / scene, *options, *words)
                picture = fragtrace.render(SCENES / scene, **{**SMALL, **keywords})
                if isinstance(expected, dict):
                    expected = expected["color"]  # an adaptive one has the layer samples
                np.testing.assert_array_equal(np.asarray(picture), np.asarray(expected))

    def test_a_scene_is_kept_and_draws_the_same(self):
        scene = fragtrace.Scene(SCENES / "mesh-15743.gltf", **SMALL)
        first = scene.render()
        again = scene.render()
        np.testing.assert_array_equal(first, again)
        self.assertGreater(first.statistics["load_ms"], 0)
        self.assertEqual([again.statistics[name] for name in ("load_ms", "bvh_build_ms", "compile_ms", "upload_ms")], [0, 0, 0, 0])
        for keywords in ({"seed": 5}, {"hdri_rotation": 10}, {"stage": "flat"}, {"background_color": (1, 0, 0)}, {"traversal": "bvh"},
                         {"resolution": (8, 30)}, {"aov": "albedo"}, {"bounces": 1}, {"no_default_light": True}, {"clamp_indirect": 0.5},
                         {"camera_orbit": (30, 20)}, {"fit": True}):
            with self.subTest(str(keywords)):
                kept, anew = (make(**{**SMALL, **keywords}) for make in (scene.render, lambda **k: fragtrace.render(SCENES / "mesh-15743.gltf", **k)))
                if isinstance(kept, dict):
                    self.assertEqual(list(kept), ["color", "albedo"])
                    kept, anew = kept["albedo"], anew["albedo"]
                np.testing.assert_array_equal(kept, anew)

    def test_a_scene_is_posed_again(self):
        """The file, its surroundings and its programs stay; each picture is that of a scene of its own."""
        options = {**SMALL, "hdri": SCENES / "sky.pfm", "traversal": "front-to-back"}
        scene = fragtrace.Scene(SCENES / "wheel.gltf", **options)
        scene.render()
        for keywords in ({"animation_time": 0.1}, {"animation_time": 0.3}, {"animation_time": 0.3, "hide": "tyre"}, {"set": "/materials/0/doubleSided=false"}, {}):
            with self.subTest(str(keywords)):
                posed = scene.render(**keywords)
                np.testing.assert_array_equal(posed, fragtrace.render(SCENES / "wheel.gltf", **options, **keywords))
                self.assertNotIn("environment", {phase["name"] for phase in posed.statistics["phases"]})
                self.assertEqual(posed.statistics["compile_ms"], 0)

    def test_a_scene_whose_load_failed_draws_the_next_options(self):
        later = self.folder / "later.pfm"
        scene = fragtrace.Scene(SCENES / "plastics.gltf", **SMALL)
        scene.render(hdri=SCENES / "sky.pfm")
        with self.assertRaises(Exception):
            scene.render(hdri=later)
        later.write_bytes((SCENES / "sun-sky.pfm").read_bytes())
        np.testing.assert_array_equal(scene.render(hdri=later), fragtrace.render(SCENES / "plastics.gltf", hdri=later, **SMALL))

    def test_shapes_and_facts(self):
        layers = fragtrace.render(SCENES / "coverage.gltf", aov=("albedo", "depth", "samples"), **SMALL)
        self.assertEqual({name: layer.shape for name, layer in layers.items()},
                         {"color": (16, 24, 4), "albedo": (16, 24, 3), "depth": (16, 24), "samples": (16, 24)})
        self.assertEqual({layer.dtype.name for layer in layers.values()}, {"float32"})
        self.assertEqual(layers.statistics["spp"], 2)
        self.assertTrue((layers["samples"] == 2).all())
        self.assertEqual(layers._repr_png_()[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(type(layers["color"].mean()), np.float32)
        again = pickle.loads(pickle.dumps(layers["color"]))
        self.assertEqual(again.statistics, layers.statistics)
        half = layers["color"] * 0.5
        self.assertEqual(half.statistics, {})

    def test_files(self):
        picture = fragtrace.render(SCENES / "cornell-box.gltf", **SMALL)
        command, rounded = self.folder / "command.png", self.folder / "rounded.png"
        for path, *options in ((command,), (rounded, "--no-dither")):
            subprocess.run([FRAGTRACE, "render", SCENES / "cornell-box.gltf", "--resolution", "24x16", "--spp", "2", "--exposure", "1", "--quiet",
                            "-o", path, *options], check=True)
        for name in ("a.png", "a.exr", "a.pfm", "a.hdr", "a.jpg"):
            picture.save(self.folder / name, **({"exposure": 1} if name in ("a.png", "a.jpg") else {}))
        np.testing.assert_array_equal(fragtrace.read(self.folder / "a.png"), fragtrace.read(command))
        np.testing.assert_array_equal(fragtrace.tonemap(picture, 1)[:, :, :3], np.rint(255 * fragtrace.read(rounded)[:, :, :3]))
        np.testing.assert_array_equal(fragtrace.read(self.folder / "a.exr"), picture)
        self.assertEqual(fragtrace.diff(picture, self.folder / "a.pfm"), 0)
        self.assertLess(fragtrace.diff(self.folder / "a.hdr", picture, "relmse"), 1e-4)
        self.assertGreater(fragtrace.diff(picture, picture * 1.1, "flip"), 0)
        with self.assertRaisesRegex(fragtrace.UsageError, "fragtrace diff"):
            fragtrace.diff(picture, picture, "bias")
        self.assertLess(fragtrace.diff(self.folder / "a.jpg", self.folder / "a.png"), 0.1)

    def test_a_file_has_the_exposure_that_the_light_asks_for(self):
        """As the command's picture has it."""
        scene = SCENES / "sphere-plane.gltf"
        picture = fragtrace.render(scene, **SMALL, lamp_units="radiometric")
        self.assertGreater(picture.statistics["exposure"], 0)
        subprocess.run([FRAGTRACE, "render", scene, "--resolution", "24x16", "--spp", "2", "--lamp-units", "radiometric", "--quiet", "-o", self.folder / "command.png"], check=True)
        picture.save(self.folder / "a.png")
        np.testing.assert_array_equal(fragtrace.read(self.folder / "a.png"), fragtrace.read(self.folder / "command.png"))

    def test_a_page_has_its_very_colour(self):
        """As the command's picture has it."""
        scene = SCENES / "plastics.gltf"
        picture = fragtrace.render(scene, **SMALL, no_background=True, fit=True, fill=0.5)
        for name, color in (("a.png", "white"), ("b.png", (1, 0.5, 0)), ("c.jpg", "#336699")):
            word = color if isinstance(color, str) else ",".join(map(str, color))
            subprocess.run([FRAGTRACE, "render", scene, "--resolution", "24x16", "--spp", "2", "--background-color", word, "--fit", "--fill", "0.5",
                            "--quiet", "-o", self.folder / f"command-{name}"], check=True)
            picture.save(self.folder / name, background_color=color)
            np.testing.assert_array_equal(fragtrace.read(self.folder / name), fragtrace.read(self.folder / f"command-{name}"))
        self.assertEqual(fragtrace.read(self.folder / "a.png")[0, 0, :3].tolist(), [1, 1, 1])
        for name, color, says in (("a.exr", "white", "background_color"), ("a.png", "whit", "did you mean white")):
            with self.assertRaisesRegex(fragtrace.UsageError, says):
                picture.save(self.folder / name, background_color=color)

    def test_the_header_and_the_depth(self):
        picture = fragtrace.render(SCENES / "cornell-box.gltf", **SMALL)
        expected = self.command(SCENES / "cornell-box.gltf", "--resolution", "24x16", "--spp", 2)
        self.assertEqual(picture.numbers, expected.numbers)
        self.assertEqual(len(picture.numbers["worldToCamera"]), 16)
        picture.save(self.folder / "half.exr", half=True)
        again = fragtrace.read(self.folder / "half.exr")
        self.assertEqual(again.numbers, picture.numbers)
        np.testing.assert_array_equal(again, np.asarray(picture).astype(np.float16).astype(np.float32))
        picture.save(self.folder / "deep.png", png_depth=16)
        deep = fragtrace.read(self.folder / "deep.png")
        self.assertGreater(len(np.unique(deep)), 256)
        self.assertLess(np.abs(deep - fragtrace.tonemap(picture) / 255).max(), 0.51 / 255)
        with self.assertRaises(fragtrace.UsageError):
            picture.save(self.folder / "half.png", half=True)
        with self.assertWarnsRegex(UserWarning, "65504"):
            fragtrace.Picture.save(np.full((2, 2, 4), 1e6, np.float32).view(fragtrace.Picture), self.folder / "bright.exr", half=True)

    def test_layers_of_any_number_of_channels(self):
        options = ["--resolution", "24x16", "--spp", 2, "--aov", "texcoords,depth,denoising"]
        expected = self.command(SCENES / "sphere-textured.gltf", *options)
        layers = fragtrace.render(SCENES / "sphere-textured.gltf", aov=("texcoords", "depth", "denoising"), **SMALL)
        layers.save(self.folder / "a.exr")
        again = fragtrace.read(self.folder / "a.exr")
        self.assertEqual(set(again), set(expected))
        for name, layer in expected.items():
            np.testing.assert_array_equal(again[name], layer, name)

    def test_denoised(self):
        picture = fragtrace.render(SCENES / "cornell-box.gltf", denoise="variance", **SMALL)
        self.assertEqual(picture.shape, (16, 24, 4))
        self.assertIn("noisy", picture.layers)

    def test_parts_merge(self):
        scene = fragtrace.Scene(SCENES / "cornell-box.gltf", resolution=(24, 16))
        for part in range(2):
            scene.render(spp=4, sample_offset=4 * part).save(self.folder / f"{part}.exr")
        joined = fragtrace.merge([self.folder / "0.exr", self.folder / "1.exr"])
        self.assertLess(fragtrace.diff(joined, scene.render(spp=8), "max"), 1e-5)
        self.assertIn("8 samples", " ".join(joined.messages))
        with self.assertRaises(fragtrace.InputError):
            fragtrace.merge([self.folder / "0.exr", self.folder / "0.exr"])

    def test_a_scene_may_be_in_memory(self):
        path = SCENES / "cornell-box.gltf"
        expected = np.asarray(fragtrace.render(path, **SMALL))

        class Mesh:
            def export(self, file_type):
                return path.read_bytes() if file_type == "glb" else None

        with open(path, "rb") as file:
            for scene in (path.read_bytes(), bytearray(path.read_bytes()), file, io.BytesIO(path.read_bytes()), Mesh()):
                with self.subTest(type(scene).__name__):
                    np.testing.assert_array_equal(fragtrace.render(scene, **SMALL), expected)
        self.assertEqual(fragtrace.info(path.read_bytes())["scene"], fragtrace.info(path)["scene"])
        scene = fragtrace.Scene(Mesh(), **SMALL)
        np.testing.assert_array_equal(scene.render(), expected)
        self.assertEqual((scene.info()["scene"], repr(scene)), (fragtrace.info(path)["scene"], "fragtrace.Scene('<Mesh>')"))
        for scene, says in ((b"nothing", "^<bytes>: "), (path.read_text(), "cannot be opened"), (io.StringIO("{}"), "'rb'"), (3, "a int is no scene")):
            with self.assertRaisesRegex(ValueError, says):
                fragtrace.render(scene, **SMALL)

    def test_trimesh(self):
        try:
            import trimesh
        except ImportError:
            self.skipTest("no trimesh")
        scene = trimesh.Scene([trimesh.creation.icosphere(), trimesh.creation.box().apply_translation((2, 0, 0))])
        self.assertGreater(fragtrace.render(scene, no_background=True, **SMALL)[:, :, 3].mean(), 0.05)

    def test_sequences_are_those_of_the_command(self):
        for scene, words, keywords in (("wheel.gltf", ("--frames", "1:7:3", "--fps", 24), {"frames": range(1, 8, 3), "fps": 24}),
                                       ("wheel.gltf", ("--frames", "2:3", "--shutter", 180), {"frames": "2:3", "shutter": 180}),
                                       ("lights.gltf", ("--turntable", 5, "--frames", "2:3"), {"turntable": 5, "frames": "2:3"}),
                                       ("lights.gltf", ("--turntable", 3, "--turn", "object"), {"turntable": 3, "turn": "object"})):
            with self.subTest(scene):
                numbers = list(keywords.get("frames")) if isinstance(keywords.get("frames"), range) else (2, 3) if "frames" in keywords else range(3)
                subprocess.run([FRAGTRACE, "render", SCENES / scene, "--resolution", "24x16", "--spp", "2", *map(str, words), "-o", self.folder / "a#.exr", "--quiet"], check=True)
                pictures = list(fragtrace.sequence(SCENES / scene, **SMALL, **keywords))
                self.assertEqual(len(pictures), len(numbers))
                for number, picture in zip(numbers, pictures):
                    np.testing.assert_array_equal(picture, fragtrace.read(self.folder / f"a{number}.exr"))
        self.assertEqual(len(list(fragtrace.Scene(SCENES / "lights.gltf", **SMALL).sequence(turntable=2))), 2)
        for keywords, says in (({}, "frames=.* or turntable="), ({"frames": "0:2", "turntable": 2}, "^frames: turntable 2 has pictures 0 to 1$"), ({"frames": "1"}, "^frames: "),
                               ({"frame": 3}, "no keyword of sequence.*frames")):
            with self.assertRaisesRegex(fragtrace.UsageError, says):
                fragtrace.sequence(SCENES / "wheel.gltf", **SMALL, **keywords)

    def test_a_scene_takes_new_options_and_says_what_was_renewed(self):
        scene = fragtrace.Scene(SCENES / "wheel.gltf", **SMALL)
        for keywords, renewed in (({}, "scene"), ({}, "nothing"), ({"camera_orbit": (30, 0)}, "nothing"), ({"animation_time": 0.2}, "pose"), ({"dispatch": "fragment"}, "program"),
                                  ({"dispatch": None}, "program"), ({"up": "z"}, "scene")):
            scene.set(**keywords)
            picture = scene.render()
            self.assertEqual(scene.renewed, renewed, keywords)
        np.testing.assert_array_equal(picture, fragtrace.render(SCENES / "wheel.gltf", **SMALL, camera_orbit=(30, 0), animation_time=0.2, up="z"))
        with self.assertRaisesRegex(fragtrace.UsageError, "did you mean stage"):
            scene.set(stages="gi")

    def test_the_version(self):
        said = subprocess.run([FRAGTRACE, "--version"], check=True, capture_output=True, text=True).stdout
        self.assertEqual(fragtrace.__version__, said.split()[1])

    def test_type_checkers_know_the_keywords(self):
        script = self.folder / "script.py"
        script.write_text("""import fragtrace
fragtrace.render("a.glb", spp=4, resolution=(64, 64), hdri="a.hdr", camera={"position": (0, 1, 2)}, stage="gi", no_background=True).save("a.png")
for picture in fragtrace.Scene(b"glTF", seed=3).sequence(frames=range(3), fps=25):
    picture.save("b.png")
fragtrace.render("a.glb", sppp=4)
fragtrace.render("a.glb", spp="many")
fragtrace.render("a.glb", stage="nothing")
fragtrace.render("a.glb", turntable=3)
""")
        ran = subprocess.run([sys.executable, "-m", "mypy", "--cache-dir", self.folder / "cache", script], capture_output=True, text=True, check=False)
        if "No module named mypy" in ran.stderr:
            self.skipTest("no mypy")
        found = re.findall(r"script\.py:(\d+): error: .*?\"(sppp|spp|stage|turntable)\"", ran.stdout)
        self.assertEqual(found, [("5", "sppp"), ("6", "spp"), ("7", "stage"), ("8", "turntable")], ran.stdout + ran.stderr)

    def test_info(self):
        self.assertEqual(fragtrace.info(SCENES / "mesh-15743.gltf")["scene"]["triangles"], 15743)


class Errors(Package):
    def test_each_kind_is_an_exception(self):
        with self.assertRaisesRegex(fragtrace.UsageError, "^spp: "):
            fragtrace.render(SCENES / "cornell-box.gltf", spp=-1)
        for keywords, says in (({"samples": 4}, "samples: .*did you mean spp\\?$"), ({"sppp": 4}, "sppp: .*did you mean spp\\?$"), ({"camera": {"pos": (0, 1, 4)}}, "camera_pos: .*camera_position"),
                               ({"resolution": 160}, "resolution"), ({"exposure": 1}, "save"), ({"frames": "0:3"}, "sequence"), ({"help": True}, "help\\(fragtrace.render\\)"), ({"output": "a.png"}, "save"),
                               ({"format": "png"}, "save"), ({"quiet": True}, "messages"), ({"stats": "s.json"}, "statistics"), ({"seed": {}}, "no dict"),
                               ({"seed": {"a": 1}}, "no dict"), ({"fit": "yes"}, "^fit: takes no value")):
            with self.assertRaisesRegex(ValueError, says):
                fragtrace.render(SCENES / "cornell-box.gltf", **keywords)
        for wrong in ([], "a.exr"):
            with self.assertRaises(fragtrace.UsageError):
                fragtrace.merge(wrong)
        with self.assertRaisesRegex(fragtrace.UsageError, "checkpoint"):
            fragtrace.render(SCENES / "cornell-box.gltf", checkpoint=3)
        with self.assertRaisesRegex(fragtrace.InputError, "none.gltf"):
            fragtrace.render(self.folder / "none.gltf")
        with self.assertRaisesRegex(fragtrace.InputError, "none.gltf"):
            fragtrace.info(self.folder / "none.gltf")
        with self.assertRaisesRegex(fragtrace.RenderError, "nowhere"):
            fragtrace.render(SCENES / "cornell-box.gltf", **SMALL).save(self.folder / "nowhere/a.png")
        with self.assertRaises(fragtrace.UsageError):
            fragtrace.tonemap(np.zeros(3))
        with self.assertRaisesRegex(fragtrace.UsageError, "exposure"):
            fragtrace.tonemap(np.zeros((2, 2, 3)), exposure=float("nan"))
        with self.assertRaisesRegex(fragtrace.UsageError, "2 x 2 pixels, the other 2 x 3"):
            fragtrace.diff(np.zeros((2, 2, 3)), np.zeros((3, 2, 3)))
        # And the next picture is drawn.
        fragtrace.render(SCENES / "cornell-box.gltf", **SMALL)

    def test_no_opengl(self):
        code = f"import fragtrace, sys\ntry: fragtrace.render({str(SCENES / 'cornell-box.gltf')!r}, rendering_backend='egl')\n" \
               "except fragtrace.ContextError as error: sys.exit(44)"
        broken = {**os.environ, "__EGL_VENDOR_LIBRARY_DIRS": "/nowhere", "LD_LIBRARY_PATH": ""}
        self.assertEqual(subprocess.run([sys.executable, "-c", code], env=broken, check=False).returncode, 44)

    def test_ctrl_c(self):
        scene = fragtrace.Scene(SCENES / "cornell-box.gltf", resolution=(200, 200))
        scene.render(spp=1)
        pressed = []

        def press():
            pressed.append(time.monotonic())
            _thread.interrupt_main()

        timer = threading.Timer(1.0, press)
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            scene.render(spp=1_000_000)
        self.assertLess(time.monotonic() - pressed[0], 0.2 if os.environ.get("FRAGTRACE_QUIET_MACHINE") else 2)
        self.assertEqual(scene.render(spp=1).shape, (200, 200, 4))

    def test_what_progress_raises_ends_the_picture(self):
        def told(fraction):
            raise KeyError("enough")

        with self.assertRaisesRegex(KeyError, "enough"):
            fragtrace.render(SCENES / "cornell-box.gltf", resolution=(200, 200), spp=100_000, progress=told)

    def test_progress(self):
        fractions = []
        fragtrace.render(SCENES / "cornell-box.gltf", resolution=(100, 100), spp=256, progress=fractions.append)
        self.assertEqual(fractions, sorted(fractions))
        self.assertTrue(fractions and 0 <= fractions[0] and fractions[-1] <= 1, fractions)


class Sharing(Package):
    def test_threads(self):
        expected = [fragtrace.render(SCENES / "cornell-box.gltf", seed=seed, **SMALL) for seed in range(4)]
        scene = fragtrace.Scene(SCENES / "cornell-box.gltf", **SMALL)
        results = [None] * 8

        def draw(i):
            results[i] = (scene.render if i % 2 else lambda **k: fragtrace.render(SCENES / "cornell-box.gltf", **{**SMALL, **k}))(seed=i % 4)

        threads = [threading.Thread(target=draw, args=(i,)) for i in range(8)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for i, picture in enumerate(results):
            np.testing.assert_array_equal(picture, expected[i % 4])

    def test_the_interpreter_is_free(self):
        counted, done = [0], threading.Event()

        def count():
            while not done.is_set():
                counted[0] += 1
                time.sleep(0.01)

        thread = threading.Thread(target=count)
        thread.start()
        fragtrace.render(SCENES / "cornell-box.gltf", resolution=(200, 200), time=1)
        done.set()
        thread.join()
        self.assertGreater(counted[0], 20)

    def test_processes(self):
        expected = np.asarray(fragtrace.render(SCENES / "cornell-box.gltf", **SMALL))
        for method in ("spawn", "fork"):
            with self.subTest(method):
                context = multiprocessing.get_context(method)
                queue = context.Queue()
                process = context.Process(target=draw_in_process, args=(SCENES / "cornell-box.gltf", queue))
                process.start()
                result = pickle.loads(queue.get(timeout=120))
                process.join()
                if method == "spawn":
                    np.testing.assert_array_equal(result, expected)
                else:
                    self.assertIn("spawn", result)

    def test_lines_have_the_width_of_each_view(self):
        data = struct.pack("<6f", -1, 0, 0, 1, 1, 0)
        path = self.folder / "line.gltf"
        path.write_text(json.dumps({
            "asset": {"version": "2.0"}, "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}],
            "buffers": [{"byteLength": len(data), "uri": "data:;base64," + base64.b64encode(data).decode()}],
            "bufferViews": [{"buffer": 0, "byteLength": len(data)}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 1}]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 2, "type": "VEC3", "min": [-1, 0, 0], "max": [1, 1, 0]}]}))
        scene = fragtrace.Scene(path, **SMALL, scene_origin=(0, 0, 0))
        for keywords in ({}, {"camera_orbit": (30, 10)}, {"camera_orbit": (30, 10, 4)}, {"resolution": (48, 32)}, {"line_width": 7}):
            with self.subTest(str(keywords)):
                np.testing.assert_array_equal(scene.render(**keywords), fragtrace.render(path, **{**SMALL, "scene_origin": (0, 0, 0), **keywords}))

    def test_scenes_come_and_go(self):
        for _ in range(20):
            scene = fragtrace.Scene(SCENES / "cornell-box.gltf", **SMALL)
            scene.render()
            del scene
        subprocess.run([sys.executable, "-c", f"import fragtrace; s = fragtrace.Scene({str(SCENES / 'cornell-box.gltf')!r}); s.render(spp=1)"],
                       check=True, timeout=120)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The command line as a user meets it: exit statuses, messages, files, interruption, statistics."""
import json
import math
import os
import signal
import struct
import subprocess
import time

from support import BACKENDS, FRAGTRACE, SCENES, SMALL, Case, main, read_pfm, run, shown


class ExitStatuses(Case):
    def render(self, scene, name="x.pfm"):
        return ["render", scene, "-o", self.folder / name, *SMALL]

    def test_a_missing_scene_is_3(self):
        self.fails(3, *self.render(self.folder / "none.gltf"), says=["none.gltf"])

    def test_a_truncated_glb_is_3(self):
        path = self.folder / "cut.glb"
        path.write_bytes(b"glTF" + struct.pack("<III", 2, 1000, 980) + b"JSON{")
        self.fails(3, *self.render(path), says=["cut.glb"])

    def test_an_index_out_of_range_is_3_and_named(self):
        scene = json.loads((SCENES / "furnace.gltf").read_text())
        scene["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 99
        path = self.written("bad.gltf", scene)
        self.fails(3, *self.render(path), says=["bad.gltf", "/meshes/0/primitives/0/attributes/POSITION"])

    def test_an_unknown_required_extension_is_3_and_named(self):
        scene = json.loads((SCENES / "furnace.gltf").read_text())
        scene["extensionsUsed"] = scene["extensionsRequired"] = ["EXT_never_heard_of"]
        path = self.written("ext.gltf", scene)
        self.fails(3, *self.render(path), says=["EXT_never_heard_of"])

    def test_a_missing_environment_is_3(self):
        self.fails(3, *self.render(SCENES / "furnace.gltf"), "--hdri-file", self.folder / "no.hdr", says=["no.hdr"])

    def test_an_environment_with_infinity_is_drawn_with_a_warning(self):
        path = self.folder / "bad-map"
        path.write_bytes(b"PF\n2 1\n-1.0\n" + struct.pack("<6f", 1, 1, 1, 1, math.inf, 1))
        words = [word for word in self.render(SCENES / "furnace.gltf") if word != "--quiet"]
        result = run(*words, "--hdri-file", path)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("bad-map: 1 value without bound, taken as 65504", result.stderr)

    def test_a_camera_too_far_away_is_3_in_the_file_and_2_on_the_command_line(self):
        scene = json.loads((SCENES / "furnace.gltf").read_text())
        path = self.folder / "far.gltf"
        scene["nodes"][1]["translation"] = [1e40, 0, 0]
        path.write_text(json.dumps(scene))
        self.fails(3, *self.render(path), says=["far.gltf: the camera is too far away"])
        self.fails(2, *self.render(SCENES / "furnace.gltf"), "--camera-position", "1e20,0,0",
                   says=["the camera is too far away"])

    def test_an_unwritable_output_is_1(self):
        self.fails(1, *self.render(SCENES / "furnace.gltf", "no/such/folder/x.pfm"), says=["no/such/folder"])

    def test_an_unwritable_statistics_file_is_1_and_leaves_no_picture(self):
        self.fails(1, *self.render(SCENES / "furnace.gltf"), "--stats", self.folder / "no/s.json", says=["s.json"])

    def test_unknown_options_values_and_formats_are_2(self):
        for extra in (["--nonsense"], ["--stage", "fast"], ["--enable", "warp"], ["--spp", "0"], ["--bounces", "-1"],
                      ["--resolution", "10"], ["--resolution", "0,10"], ["--tone-map", "filmic"],
                      ["--camera-position", "1,2"], ["--camera-index", "7"], ["--exposure", "nan"]):
            result = run(*self.render(SCENES / "cornell-box.gltf"), *extra)
            self.assertEqual(result.returncode, 2, (extra, result.stderr))
        self.assertEqual(run(*self.render(SCENES / "cornell-box.gltf", "x.tga")).returncode, 2)
        self.assertEqual(run().returncode, 2)

    def test_an_output_that_is_read_by_the_render_is_2_and_untouched(self):
        scene = self.folder / "scene.gltf"
        scene.write_bytes((SCENES / "furnace.gltf").read_bytes())
        sky = self.folder / "sky.hdr"
        self.renders(scene, "-o", sky, *SMALL)
        before = scene.read_bytes(), sky.read_bytes()
        for extra in (["-o", self.folder / "x.jpg", "--stats", scene], ["-o", sky, "--hdri-file", sky],
                      ["-o", self.folder / "x.jpg", "--stats", self.folder / "x.jpg"]):
            result = run("render", scene, *SMALL, *extra)
            self.assertEqual(result.returncode, 2, (extra, result.stderr))
        self.assertEqual((scene.read_bytes(), sky.read_bytes()), before)
        textured = run("render", SCENES / "sphere-textured.gltf", *SMALL, "-o", SCENES / "graticule.png")
        self.assertEqual(textured.returncode, 2, textured.stderr)

    def test_a_full_standard_output_is_1(self):
        with open("/dev/full", "w") as full:
            for command in (["info", SCENES / "furnace.gltf"], ["info", "--json", SCENES / "furnace.gltf"]):
                status = subprocess.run([FRAGTRACE, *command], stdout=full, stderr=subprocess.DEVNULL).returncode
                self.assertEqual(status, 1)

    def test_a_file_size_limit_is_1_and_leaves_nothing(self):
        result = subprocess.run(["bash", "-c", 'ulimit -f 1; exec "$0" "$@"', FRAGTRACE, "render", SCENES / "furnace.gltf",
                                 "-o", self.folder / "big.pfm", "--resolution", "64,64", "--spp", "1", "--quiet"],
                                capture_output=True, env={**os.environ, "MESA_SHADER_CACHE_DISABLE": "true"})
        self.assertEqual(result.returncode, 1, result.stderr)
        result = subprocess.run(["bash", "-c", 'ulimit -f 1; exec "$0" "$@"', FRAGTRACE, "render", SCENES / "furnace.gltf",
                                 "-o", self.folder / "big.exr", "--resolution", "64,64", "--spp", "1", "--quiet"],
                                capture_output=True, text=True, env={**os.environ, "MESA_SHADER_CACHE_DISABLE": "true"})
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("the limit of the shell on the size of a file is too low (ulimit -f)", result.stderr)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_a_list_option_does_not_eat_the_scene(self):
        self.renders("--enable", "schlick", SCENES / "furnace.gltf", "-o", self.folder / "x.pfm", *SMALL)

    def test_help_and_version_are_0(self):
        self.assertEqual(run("--help").returncode, 0)
        self.assertEqual(run("--version").returncode, 0)
        self.assertIn("--bounces", run("render", "--help").stdout)

    def test_a_machine_without_gl_is_4_and_says_what_was_tried(self):
        for name in ("libEGL.so.1", "libEGL.so", "libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"):
            (self.folder / name).write_text("no library")
        environment = {**os.environ, "LD_LIBRARY_PATH": str(self.folder)}
        self.fails(4, *self.render(SCENES / "furnace.gltf"), says=["/libEGL.so.1: ", "/libOSMesa.so.8: ", "apt-get install libegl1"], env=environment)
        info = run("info", SCENES / "furnace.gltf", env=environment)
        self.assertEqual(info.returncode, 0, info.stderr)

    def test_diff_is_1_above_the_threshold_or_when_sizes_differ(self):
        a, b, c = (self.folder / name for name in ("a.pfm", "b.pfm", "c.pfm"))
        self.renders(SCENES / "cornell-box.gltf", "-o", a, *SMALL)
        self.renders(SCENES / "cornell-box.gltf", "-o", b, *SMALL, "--seed", "7")
        self.renders(SCENES / "cornell-box.gltf", "-o", c, "--resolution", "8,8", "--spp", "1", "--quiet")
        before = a.read_bytes()
        self.fails(2, "diff", a, b, "--outfile", a, says=["--outfile"])
        self.assertEqual(a.read_bytes(), before)
        self.assertEqual(run("diff", a, a, "--threshold", "0").returncode, 0)
        self.assertEqual(run("diff", a, b, "--threshold", "1e-9").returncode, 1)
        self.assertEqual(run("diff", a, c).returncode, 1)
        self.assertEqual(run("diff", a, self.folder / "none.pfm").returncode, 3)
        self.assertEqual(run("diff", a, a).stdout, "0\n")  # for scripts
        self.assertEqual(shown("diff", a, a).splitlines()[::2], ["0", "values: linear radiance"])
        self.assertIn("psnr: peak signal to noise ratio in dB, for a peak of 1; inf is equal", shown("diff", a, a, "--metric", "psnr"))
        self.assertEqual(run("diff", a, a, "--metric", "psnr", "--threshold", "99").returncode, 0)
        self.assertEqual(run("diff", a, b, "--metric", "psnr", "--threshold", "99").returncode, 1)

    def test_flip_takes_a_linear_picture_as_the_png_that_render_writes(self):
        flip = lambda *arguments: run("diff", *arguments, "--metric", "flip")
        for suffix in (".exr", ".pfm", ".png"):
            for seed in "17":
                path = self.folder / (seed + suffix)
                self.renders(SCENES / "cornell-box.gltf", "-o", path, *SMALL, "--seed", seed)
        one, seven = ([self.folder / (seed + suffix) for suffix in (".exr", ".pfm", ".png")] for seed in "17")
        for path in one:
            self.assertEqual(float(flip(path, one[2]).stdout), 0, path)
        values = {flip(a, b).stdout for a in one for b in seven}
        self.assertEqual(len(values), 1, values)
        self.assertGreater(float(values.pop()), 0.1)
        self.assertEqual(flip(*one[:2], "--threshold", "0").returncode, 0)
        self.assertEqual(flip(one[0], seven[0], "--threshold", "0.01").returncode, 1)
        for a, b, metric, warned in ((one[0], one[2], "rmse", True), (one[2], one[1], "max", True), (one[0], one[1], "rmse", False), (one[0], one[2], "flip", False)):
            said = run("diff", a, b, "--metric", metric).stderr
            self.assertEqual("holds sRGB values" in said, warned, said)

    def test_flip_writes_its_error_map(self):
        a, b, error = (self.folder / name for name in ("a.pfm", "b.pfm", "map.pfm"))
        self.renders(SCENES / "cornell-box.gltf", "-o", a, *SMALL)
        self.renders(SCENES / "cornell-box.gltf", "-o", b, *SMALL, "--seed", "7")
        mean = float(run("diff", a, b, "--metric", "flip", "--outfile", error).stdout)
        kind, size, _, body = error.read_bytes().split(b"\n", 3)
        values = struct.unpack("<256f", body)
        self.assertEqual((kind, size), (b"Pf", b"16 16"))
        self.assertAlmostEqual(sum(values) / 256, mean, places=6)


class Pictures(Case):
    def test_any_file_name_works(self):
        name = self.folder / "Gemälde 100 % 図.png"
        scene = self.folder / "a b ü.gltf"
        scene.write_bytes((SCENES / "furnace.gltf").read_bytes())
        self.renders(scene, "-o", name, *SMALL)
        self.assertTrue(name.read_bytes().startswith(b"\x89PNG"))

    def test_every_format_is_written_and_read(self):
        reference = self.folder / "x.exr"
        self.renders(SCENES / "cornell-box.gltf", "-o", reference, *SMALL)
        for suffix, limit in ((".pfm", "1e-9"), (".hdr", "0.3")):
            path = self.folder / ("x" + suffix)
            self.renders(SCENES / "cornell-box.gltf", "-o", path, *SMALL)
            result = run("diff", path, reference, "--metric", "max", "--threshold", limit)
            self.assertEqual(result.returncode, 0, result.stdout)
        for suffix in (".png", ".jpg"):
            self.renders(SCENES / "cornell-box.gltf", "-o", self.folder / ("x" + suffix), *SMALL)

    def test_the_same_seed_gives_the_same_bits_and_another_seed_does_not(self):
        a, b, c = (self.folder / name for name in ("a.pfm", "b.pfm", "c.pfm"))
        options = ["--resolution", "64,64", "--spp", "9", "--quiet"]
        self.renders(SCENES / "cornell-box.gltf", "-o", a, *options)
        self.renders(SCENES / "cornell-box.gltf", "-o", b, *options)
        self.renders(SCENES / "cornell-box.gltf", "-o", c, *options, "--seed", "1")
        self.assertEqual(a.read_bytes(), b.read_bytes())
        self.assertNotEqual(a.read_bytes(), c.read_bytes())

    def test_quiet_prints_nothing(self):
        result = self.renders(SCENES / "furnace.gltf", "-o", self.folder / "x.pfm", *SMALL)
        self.assertEqual((result.stdout, result.stderr), ("", ""))

    def test_a_numeric_locale_changes_nothing(self):
        a, b = self.folder / "a.pfm", self.folder / "b.pfm"
        options = ["--camera-position", "0.5,0.25,3.5", "--exposure", "0.5", *SMALL]
        self.renders(SCENES / "cornell-box.gltf", "-o", a, *options)
        self.renders(SCENES / "cornell-box.gltf", "-o", b, *options, env={**os.environ, "LC_ALL": "de_DE.UTF-8"})
        self.assertEqual(a.read_bytes(), b.read_bytes())

    def test_negative_vectors_are_values_not_options(self):
        self.renders(SCENES / "cornell-box.gltf", "-o", self.folder / "x.pfm", "--camera-position", "-1,-.5,3",
                     "--camera-view-up", "-.1,1,0", *SMALL)

    def test_a_size_may_be_written_as_people_do(self):
        box = SCENES / "cornell-box.gltf"
        for size in (["--resolution", "10x8"], ["--resolution=10x8"]):
            self.renders(box, "-o", self.folder / "x.pfm", "--spp", 1, "--stage", "flat", "--quiet", *size)
            picture = read_pfm(self.folder / "x.pfm")
            self.assertEqual((len(picture), len(picture[0])), (8, 10))
        self.fails(2, "render", box, "-o", self.folder / "y.pfm", "--resolution", "10xx8", says=["--resolution"])

    def test_no_background_gives_alpha_of_what_was_hit(self):
        path = self.folder / "x.exr"
        self.renders(SCENES / "sphere-black.gltf", "-o", path, "--no-background", "--stage", "flat", *SMALL)
        self.assertTrue(path.exists())

    def test_the_default_light_is_said_and_can_be_turned_off(self):
        options = ["--resolution", "16,16", "--spp", "1", "--stats", self.folder / "s.json"]
        result = self.renders(SCENES / "furnace.gltf", "-o", self.folder / "x.pfm", *options)
        self.assertIn("--default-light", result.stderr)
        stats = json.loads((self.folder / "s.json").read_text())
        self.assertTrue(stats["default_light"])
        self.assertEqual(stats["default_light_reason"], "no light in the scene")
        self.renders(SCENES / "furnace.gltf", "-o", self.folder / "x.pfm", *options, "--no-default-light")
        self.assertFalse(json.loads((self.folder / "s.json").read_text())["default_light"])
        self.assertTrue(all(v == (0, 0, 0) for row in read_pfm(self.folder / "x.pfm") for v in row))

    def test_an_emissive_texture_too_dim_to_light_the_scene_gets_the_default_light(self):
        scene = json.loads((SCENES / "furnace.gltf").read_text())
        (self.folder / "checker.png").write_bytes((SCENES / "checker.png").read_bytes())
        scene.update(images=[{"uri": "checker.png"}], textures=[{"source": 0}])
        for factor, is_dim in ((1e-4, True), (1.0, False)):
            scene["materials"][0].update(emissiveFactor=[factor] * 3, emissiveTexture={"index": 0})
            (self.folder / "dim.gltf").write_text(json.dumps(scene))
            result = self.renders(self.folder / "dim.gltf", "-o", self.folder / "x.pfm", "--resolution", "16,16", "--spp", "1")
            self.assertEqual("emission leaves" in result.stderr, is_dim)


class Statistics(Case):
    def test_they_hold_what_is_promised(self):
        self.renders(SCENES / "cornell-box.gltf", "-o", self.folder / "x.pfm", "--stats", self.folder / "s.json",
                     "--resolution", "20,10", "--spp", "3", "--quiet")
        stats = json.loads((self.folder / "s.json").read_text())
        for key in ("scene load_ms bvh_build_ms upload_ms compile_ms first_frame_ms render_ms frame_ms spp width height rays "
                    "mpaths_per_s mrays_per_s nonfinite_pixels budget_hits gl_renderer backend variant").split():
            self.assertIn(key, stats)
        self.assertEqual((stats["width"], stats["height"], stats["spp"]), (20, 10, 3))
        self.assertEqual(set(stats["frame_ms"]), {"median", "mean", "stddev", "min", "p95"})
        self.assertEqual(stats["budget_hits"], 0)
        self.assertGreaterEqual(stats["rays"], 20 * 10 * 3)
        paths = 20 * 10 * 3 / stats["render_ms"] / 1000
        self.assertAlmostEqual(stats["mpaths_per_s"], paths, delta=1e-6 + 1e-3 * paths)

    def test_flat_traces_one_ray_a_path(self):
        self.renders(SCENES / "cornell-box.gltf", "-o", self.folder / "x.pfm", "--stats", self.folder / "s.json",
                     "--stage", "flat", "--resolution", "20,10", "--spp", "3", "--quiet")
        self.assertEqual(json.loads((self.folder / "s.json").read_text())["rays"], 20 * 10 * 3)

    def test_info_is_json_with_the_tree(self):
        result = run("info", "--json", SCENES / "mesh-62975.gltf")
        data = json.loads(result.stdout)
        self.assertEqual(data["scene"]["triangles"], 62975)
        self.assertEqual(json.loads(run("info", "--json", SCENES / "mesh-15743.gltf").stdout)["scene"]["triangles"], 15743)
        self.assertLessEqual(data["bvh"]["depth"], 32)
        self.assertGreater(data["bvh"]["sah_cost"], 1)

    def test_info_is_json_where_the_file_is_refused_or_a_part_is_not_there(self):
        path = self.folder / "bad\udcff.gltf"
        path.write_text("{")
        for status, arguments in ((3, [path]), (3, [self.folder / "none.gltf"]), (2, [SCENES / "furnace.gltf", "--scene", "none"])):
            result = run("info", "--json", *arguments, errors="surrogateescape")
            self.assertEqual(result.returncode, status)
            data = json.loads(result.stdout)
            self.assertEqual(set(data), {"schema", "file", "error"})
            if status == 3 and arguments[0] != path:
                self.assertEqual(result.stderr, f"fragtrace: {data['error']}\n")
        self.assertEqual(run("info", self.folder / "none.gltf").stdout, "")


class DriverLimits(Case):
    """Work that would need more than llvmpipe's 65,535 loop iterations in one invocation continues in the next draw."""

    def compare(self, scene, backend, traversal, spp, size, stage="flat"):
        paths = [self.folder / "a.pfm", self.folder / "b.pfm"]
        common = ["--stage", stage, "--resolution", size, "--spp", spp, "--quiet", "--rendering-backend", backend]
        stats = self.folder / "s.json"
        self.renders(SCENES / scene, "-o", paths[0], *common, "--traversal", traversal, "--stats", stats)
        self.renders(SCENES / scene, "-o", paths[1], *common, "--traversal", "front-to-back")
        self.assertEqual(json.loads(stats.read_text())["budget_hits"], 0)
        result = run("diff", *paths, "--metric", "rmse", "--threshold", "1e-4")
        self.assertEqual(result.returncode, 0, result.stdout)
        return paths

    def test_iterative_over_63k_triangles(self):
        for backend in BACKENDS:
            self.compare("mesh-62975.gltf", backend, "iterative", "16", "12,12")

    def test_a_tile_whose_paths_are_suspended_is_cut_into_those_that_their_states_have_room_for(self):
        self.compare("mesh-15743.gltf", "egl", "iterative", "1", "1024,8", "gi")

    def test_iterative_with_shadow_rays(self):
        self.compare("mesh-15743.gltf", "egl", "iterative", "8", "12,12", "gi")

    def test_trees_with_thousands_of_samples(self):
        for traversal in ("bvh", "front-to-back"):
            for backend in BACKENDS:
                self.compare("mesh-62975.gltf", backend, traversal, "4000", "8,8")


class Speed(Case):
    def test_paths_per_second_agree_with_the_clock_on_the_wall(self):
        def least(spp):
            best = None
            for _ in range(5):
                began = time.monotonic()
                self.renders(SCENES / "cornell-box.gltf", "-o", self.folder / "x.pfm", "--resolution", "200,200", "--spp", spp,
                             "--quiet", "--stats", self.folder / "s.json")
                run = (time.monotonic() - began, json.loads((self.folder / "s.json").read_text())["render_ms"])
                best = run if best is None else (min(best[0], run[0]), min(best[1], run[1]))
            return best
        # The statistics count the first draw, too, which takes longer: 64 samples are too few to hide it.
        once, twice = least("64"), least("192")
        wall = 200 * 200 * 128 / (twice[0] - once[0])
        stated = 200 * 200 * 192 / (twice[1] / 1000)
        print(f"paths a second: {wall:.4g} by wall time, {stated:.4g} by the statistics")
        self.assertAlmostEqual(stated / wall, 1.0, delta=0.05)


class Interruption(Case):
    def start(self, spp, *options):
        process = subprocess.Popen([FRAGTRACE, "render", SCENES / "cornell-box.gltf", "-o", self.folder / "x.pfm",
                                    "--resolution", "200,200", "--spp", spp, *options],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        time.sleep(2)
        return process

    def test_ctrl_c_stops_within_a_second_writes_what_is_finished_and_gives_130(self):
        process = self.start("1000000")
        began = time.monotonic()
        process.send_signal(signal.SIGINT)
        process.wait(10)
        self.assertLess(time.monotonic() - began, 1.5)
        self.assertEqual(process.returncode, 130)
        picture = read_pfm(self.folder / "x.pfm")
        self.assertGreater(sum(picture[100][100]), 0)

    def test_the_same_signal_twice_at_once_is_one_as_timeout_sends_it(self):
        process = self.start("1000000")
        process.send_signal(signal.SIGINT)
        time.sleep(0.005)
        process.send_signal(signal.SIGINT)
        process.wait(10)
        self.assertEqual(process.returncode, 130)
        self.assertTrue((self.folder / "x.pfm").exists())

    def test_a_second_ctrl_c_writes_nothing(self):
        process = self.start("1000000")
        process.send_signal(signal.SIGINT)
        process.send_signal(signal.SIGINT)
        process.send_signal(signal.SIGTERM)
        process.wait(10)
        self.assertEqual(process.returncode, 130)
        self.assertFalse((self.folder / "x.pfm").exists())


if __name__ == "__main__":
    main()

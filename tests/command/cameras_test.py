#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""--camera-type and --lens-shift: each pixel shows what lies along its ray, by formulas written down a second time."""
import json
import math
import os
import statistics
import unittest
from pathlib import Path

from support import BACKENDS, SCENES, Case, Exr, Gltf, luminances, main, quad, run

BOX = "cornell-box"
PLACE = (0.1, 0.5, 0.2)
WIDTH, HEIGHT = 64, 32
ANGLE = 100
SHIFT = (0.3, -0.4)


def seen(types, view, fisheye=180.0):
    """Returns the pixel at which a camera at the origin that looks along -z sees a point, from the top left, and the
    depth."""
    x, y, z = view[0], view[1], -view[2]
    distance = math.hypot(x, y, z)
    if types == "panorama":
        return (0.5 + math.atan2(x, z) / (2 * math.pi)) * WIDTH, (0.5 - math.asin(y / distance) / math.pi) * HEIGHT, distance
    if types == "fisheye":
        away, aside = math.acos(z / distance), max(math.hypot(x, y), 1e-9)
        radius = away / math.radians(fisheye / 2) * HEIGHT / 2
        return WIDTH / 2 + radius * x / aside, HEIGHT / 2 - radius * y / aside, distance
    half = HEIGHT / 2 if types == "orthographic" else HEIGHT / 2 / math.tan(math.radians(ANGLE / 2)) / z
    return WIDTH / 2 + x * half - SHIFT[0] * WIDTH, HEIGHT / 2 - y * half + SHIFT[1] * HEIGHT, z


class CameraTypes(Case):
    def layers(self, *options, scene=BOX, place=PLACE):
        return self.picture(scene, "x.exr", "--resolution", f"{WIDTH},{HEIGHT}", "--spp", 1, "--stage", "flat", "--aov", "position,depth", "--no-background",
                            "--camera-position", ",".join(map(str, place)), *options)

    def assert_seen(self, types, exr, **options):
        """Rays go through a point of their pixel; in halves of it, at most one, and what rounding adds."""
        count = 0
        place = [exr.values("position." + axis) for axis in "XYZ"]
        for i, (alpha, depth, *point) in enumerate(zip(exr.values("A"), exr.values("depth.Z"), *place)):
            if alpha < 1:
                continue
            x, y, wanted = seen(types, [p - c for p, c in zip(point, PLACE)], **options)
            across = 0 if types == "panorama" and min(i // WIDTH, HEIGHT - 1 - i // WIDTH) < 1 else abs(x - i % WIDTH - 0.5)
            self.assertLess(min(across, WIDTH - across), 0.501, (types, i))
            self.assertLess(abs(y - i // WIDTH - 0.5), 0.501, (types, i))
            self.assertAlmostEqual(depth, wanted, delta=1e-4)
            count += 1
        return count

    def test_each_pixel_of_a_panorama_shows_its_direction(self):
        self.assertGreater(self.assert_seen("panorama", self.layers("--camera-type", "panorama")), 1500)

    def test_a_fisheye_fills_a_circle(self):
        for angle in (180, 300):
            exr = self.layers("--camera-type", "fisheye", "--camera-view-angle", angle)
            count = self.assert_seen("fisheye", exr, fisheye=angle)
            self.assertGreater(count, 600)
            for i, (alpha, *color) in enumerate(zip(*map(exr.values, "ARGB"))):
                radius = math.hypot(i % WIDTH + 0.5 - WIDTH / 2, i // WIDTH + 0.5 - HEIGHT / 2)
                if radius > HEIGHT / 2 + 0.8:
                    self.assertEqual([alpha, *color], [0, 0, 0, 0])
        self.assertIn("+fisheye", "".join(exr.texts.values()))

    def test_outside_of_the_circle_no_light_is_seen(self):
        """Neither the environment nor fog is seen there, at any stage."""
        for options in (("--sky",), ("--fog-density", "0.5"), ("--sky", "--shadow-catcher", "bottom")):
            exr = self.picture(BOX, "x.exr", "--resolution", "32,16", "--spp", 2, "--camera-type", "fisheye", "--camera-view-angle", 90, "--aov", "denoising", *options)
            for y in range(16):
                for x in (0, 1, 2, 29, 30, 31):
                    self.assertEqual([exr.layers[c][y][x] for c in "RGB"], [0, 0, 0], options)

    def test_a_focal_length_is_a_view_angle(self):
        for option, sensor, mm in (("50", 24, 50), ("35,15.6", 15.6, 35)):
            angle = math.degrees(2 * math.atan(sensor / 2 / mm))
            pictures = [self.layers(*words).values("position.X") for words in (("--focal-length", option), ("--camera-view-angle", repr(angle)), ("--focal-length", "49"))]
            apart = [max(abs(a - b) for a, b in zip(pictures[0], other)) for other in pictures[1:]]
            self.assertLess(apart[0], 1e-5)
            self.assertGreater(apart[1], 1e-3)

    def test_a_shifted_lens_shows_what_lies_aside(self):
        look = ("--camera-focal-point", "0.1,0.5,-1", "--lens-shift", "%g,%g" % SHIFT)
        self.assertGreater(self.assert_seen("perspective", self.layers("--camera-view-angle", ANGLE, *look)), 1000)
        self.assertGreater(self.assert_seen("orthographic", self.layers("--camera-parallel-scale", 1, *look)), 500)

    def test_a_shifted_lens_is_in_focus_in_the_same_plane(self):
        path = self.folder / "plane.gltf"
        gltf = quad({})
        gltf["nodes"][0]["scale"] = [20, 20, 1]
        path.write_text(json.dumps(gltf))
        exr = self.layers("--camera-view-angle", ANGLE, "--camera-focal-point", "0.1,0.5,0", "--lens-shift", "%g,%g" % SHIFT,
                          "--f-stop", "0.02", scene=str(path.with_suffix("")), place=(0.1, 0.5, 2.2))
        points = [(x, y, z - 2) for x, y, z in zip(*(exr.values("position." + axis) for axis in "XYZ"))]
        for i, point in enumerate(points):
            x, y, _ = seen("perspective", [p - c for p, c in zip(point, PLACE)])
            self.assertLess(max(abs(x - i % WIDTH - 0.5), abs(y - i // WIDTH - 0.5)), 0.502, i)

    def test_a_panorama_is_an_environment(self):
        """A room of unlit walls, and its own panorama instead of it, are the same picture."""
        room = {"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_materials_unlit"], "materials": [], "meshes": [], "nodes": [], "scenes": [{"nodes": []}]}
        wall = quad({})
        room.update(buffers=wall["buffers"], bufferViews=wall["bufferViews"], accessors=wall["accessors"])
        half = math.sqrt(0.5)
        for i, (rotation, place) in enumerate((([0, 0, 0, 1], [0, 0, -1]), ([0, 1, 0, 0], [0, 0, 1]), ([0, half, 0, half], [-1, 0, 0]), ([0, -half, 0, half], [1, 0, 0]),
                                               ([half, 0, 0, half], [0, 1, 0]), ([-half, 0, 0, half], [0, -1, 0]))):
            room["materials"].append({"extensions": {"KHR_materials_unlit": {}}, "pbrMetallicRoughness": {"baseColorFactor": [0.1 + 0.15 * i, 0.9 - 0.1 * i, 0.2 * (i % 3), 1]}})
            primitive = dict(wall["meshes"][0]["primitives"][0], material=i)
            room["meshes"].append({"primitives": [primitive]})
            room["nodes"].append({"mesh": i, "rotation": rotation, "translation": place})
            room["scenes"][0]["nodes"].append(i)
        path = self.written("room.gltf", room)
        name = str(path.with_suffix(""))
        view = ("--resolution", "64,48", "--spp", 16, "--camera-position", "0,0,0", "--camera-view-angle", 80, "--no-default-light")
        environment = self.folder / "room.exr"
        far = self.folder / "far.gltf"
        nothing = quad({})
        nothing["nodes"][0] = {"mesh": 0, "translation": [0, 0, 1e4], "scale": [0.01, 0.01, 1]}
        far.write_text(json.dumps(nothing))
        for towards, turn in (("1,0,0", 0), ("0,0,-1", 90)):
            # A panorama whose middle looks at +X is a map as it is; another is turned as far.
            self.renders(path, "-o", environment, "--quiet", "--camera-type", "panorama", "--camera-position", "0,0,0", "--camera-focal-point", towards,
                         "--resolution", "512,256", "--spp", 16, "--no-default-light")
            for focal in ("1,0.5,0.3", "-0.2,-0.7,1"):
                here = self.picture(name, "a.pfm", *view, "--camera-focal-point", focal)
                there = self.picture(str(far.with_suffix("")), "b.pfm", *view, "--camera-focal-point", focal, "--hdri-file", environment, "--hdri-rotation", turn)
                apart = [abs(a - b) for row, other in zip(here, there) for pixel, seen_ in zip(row, other) for a, b in zip(pixel, seen_)]
                # Only along edges, which the map blurs by its texels.
                self.assertLess(sum(d > 0.02 for d in apart) / len(apart), 0.06)
                self.assertLess(sum(apart) / len(apart), 0.01)

    def test_a_turntable_turns_where_it_stands(self):
        """A quarter turn moves the panorama of a corner of the box by a quarter of its width."""
        self.renders(SCENES / f"{BOX}.gltf", "-o", self.folder / "t#.exr", "--turntable", 4, "--resolution", "64,32", "--spp", 1, "--stage", "flat", "--aov", "position",
                     "--camera-type", "panorama", "--camera-position", "0.3,0.2,0.1", "--quiet")
        first, second = (sorted(p for p in self.folder.glob("t*.exr"))[i] for i in (0, 1))
        xs = [Exr(p).layers["position.X"] for p in (first, second)]
        near = lambda shift: sum(abs(xs[0][y][x] - xs[1][y][(x + shift) % 64]) < 0.1 for y in range(32) for x in range(64))
        self.assertGreater(max(near(16), near(48)), 1900)

    def test_wrong_use(self):
        scene = SCENES / "cornell-box.gltf"
        for options, text in ((["--camera-type", "panorama", "--camera-view-angle", "60"], "--camera-view-angle"), (["--camera-type", "fisheye", "--lens-shift", "0,0.1"], "--lens-shift"),
                              (["--camera-type", "fisheye", "--fit"], "--fit"), (["--camera-type", "panorama", "--f-stop", "2"], "--f-stop"),
                              (["--camera-type", "fisheye", "--camera-view-angle", "361"], "360"), (["--camera-view-angle", "181"], "180"),
                              (["--camera-type", "perspective", "--camera-parallel-scale", "1"], "orthographic cameras"), (["--lens-shift", "0,11"], "between -10 and 10"),
                              (["--focal-length", "50", "--camera-view-angle", "30"], "--focal-length"), (["--focal-length", "50", "--camera-type", "fisheye"], "--focal-length: is of perspective"),
                              (["--focal-length", "50,0"], "--focal-length"), (["--camera-type", "panorama", "--tree-level", "1"], "--tree-level"), (["--camera-type", "fish"], "fisheye"),
                              (["--camera-type", "panorama", "--camera-orbit", "0,0,2"], "zoom"),
                              (["--camera-type", "panorama", "--caustics", "on", "--pixel-filter", "gaussian"], "--pixel-filter box")):
            self.fails(2, "render", scene, "-o", self.folder / "x.png", *options, says=[text])


SIZE = ("--resolution", "32,24")
SEEDS = range(1, 7)


class CameraRays(Case):
    """Samples of several camera rays (--camera-rays): all bring what they see and one light sample, the last alone continues."""

    def stats(self, scene, *options):
        path = self.folder / "stats.json"
        told = self.renders(SCENES / f"{scene}.gltf", "-o", self.folder / "x.pfm", *SIZE, "--spp", 1, "--stats", path, *options)
        return json.loads(path.read_text()), told.stderr

    def test_the_same_light(self):
        """Every kind of surface may be the first one."""
        for scene in ("cornell-box", "many-lights", "lobes", "rough-glass", "glass-sphere", "thin-glass", "coverage", "sun-sky"):
            spp, rays = 1024 if scene == "many-lights" else 512, 3 if scene == "lobes" else 4
            one, several = (luminances(self.picture(scene, "x.pfm", *SIZE, "--seed", count, "--spp", samples, "--camera-rays", count, "--caustics", "on"))
                            for count, samples in ((1, spp), (rays, spp // 4)))
            self.assert_same_light(several, one, f"{scene}, {rays} rays", 0.003)

    def test_alpha_is_the_share_of_the_rays_that_meet_a_surface(self):
        one = self.picture("coverage", "a.exr", *SIZE, "--spp", 1024, "--no-background")
        several = self.picture("coverage", "b.exr", *SIZE, "--spp", 256, "--no-background", "--camera-rays", 4)
        self.assertTrue(any(0.1 < a < 0.9 for a in one.values("A")))
        for a, b in zip(one.values("A"), several.values("A")):
            self.assertAlmostEqual(a, b, delta=0.02)
        self.assertEqual(max(several.values("A")), 1)

    def test_every_schedule_draws_the_same(self):
        for scene in ("many-lights", "thin-glass", "caustic-ground"):
            a, b = (self.picture(scene, "x.pfm", "--resolution", "64,48", "--spp", 3, "--camera-rays", 4, "--schedule", schedule)
                    for schedule in ("megakernel", "wavefront"))
            self.assertEqual(a, b, scene)

    def test_samples_that_take_many_draws_are_the_same(self):
        folder = self.shaders_of_short_draws()
        size = ("--resolution", "24,18", "--spp", 2, "--camera-rays", 4, "--schedule", "megakernel", "--traversal", "front-to-back",
                "--no-background")
        first = self.picture("many-lights", "a.exr", *size)
        again = self.picture("many-lights", "b.exr", *size, "--shader-folder", folder)
        self.assertEqual([first.values(c) for c in "RGBA"], [again.values(c) for c in "RGBA"])

    def test_parts_merge_to_the_whole(self):
        size = (*SIZE, "--camera-rays", 4)
        whole = self.picture("many-lights", "whole.exr", *size, "--spp", 8)
        self.picture("many-lights", "a.exr", *size, "--spp", 4)
        self.picture("many-lights", "b.exr", *size, "--spp", 4, "--sample-offset", 4)
        merged = self.folder / "merged.exr"
        self.assertEqual(run("merge", self.folder / "a.exr", self.folder / "b.exr", "-o", merged).returncode, 0)
        self.assertEqual(run("diff", self.folder / "whole.exr", merged, "--metric", "max", "--threshold", "1e-5").returncode, 0)
        self.assertGreater(sum(whole.values("R")), 0)

    def test_the_scene_chooses_the_number(self):
        self.assertEqual(self.stats("many-lights")[0]["camera_rays"], 4)
        self.assertEqual(self.stats("many-lights", "--light-selection", "power")[0]["camera_rays"], 1)
        self.assertEqual(self.stats("many-lights", "--camera-rays", 1)[0]["camera_rays"], 1)
        self.assertEqual(self.stats("lights")[0]["camera_rays"], 1)  # light samples vary only 1.7 times less
        self.assertEqual(self.stats("cornell-box", "--camera-rays", 3)[0]["camera_rays"], 3)
        for options in (("--fog-density", "0.1"), ("--light-reuse", "candidates"), ("--stage", "shadows")):
            stats, said = self.stats("many-lights", "--camera-rays", 4, *options)
            self.assertEqual(stats["camera_rays"], 1)
            self.assertIn("--camera-rays: one per sample", said)
        self.fails(2, "render", SCENES / "cornell-box.gltf", "-o", self.folder / "y.pfm", "--camera-rays", 9, says=["--camera-rays"])

    def test_many_lamps_have_less_noise(self):
        def noise(rays):
            pictures = [luminances(self.picture("many-lights", "x.pfm", *SIZE, "--spp", 8, "--seed", seed, "--camera-rays", rays)) for seed in SEEDS]
            return statistics.fmean(statistics.variance(pixel) for pixel in zip(*pictures))
        self.assertLess(noise(4), 0.8 * noise(1))


LENS_ANGLE = 45
SIDE = 64
HALF = 0.2  # half of the lamp's side, metres
DISTANCE = 4


class Lens(Case):
    """--f-stop: how wide a small lamp is blurred, and how much light stays, against the thin lens equation."""

    def lamp(self, *options, spp=64):
        gltf = quad({"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}})
        gltf["materials"][0].update({"emissiveFactor": [1, 1, 1], "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 100}}})
        gltf["extensionsUsed"] = ["KHR_materials_emissive_strength"]
        gltf["nodes"][0]["scale"] = [HALF, HALF, 1]
        path = self.written("lamp.gltf", gltf)
        return self.picture(str(path.with_suffix("")), "x.pfm", "--resolution", f"{SIDE},{SIDE}", "--spp", spp, "--camera-position", f"0,0,{DISTANCE}",
                            "--camera-focal-point", "0,0,0", "--camera-view-angle", LENS_ANGLE, *options)

    def moments(self, picture):
        """Sum of red, its middle and its mean squared distance from there, pixels."""
        points = [(x + 0.5 - SIDE / 2, y + 0.5 - SIDE / 2, pixel[0]) for y, row in enumerate(picture) for x, pixel in enumerate(row)]
        total = sum(value for *_, value in points)
        middle = [sum(point[axis] * point[2] for point in points) / total for axis in (0, 1)]
        return total, middle, sum(((x - middle[0])**2 + (y - middle[1])**2) * value for x, y, value in points) / total

    def test_blur_and_light_are_those_of_a_thin_lens(self):
        sharp, middle, square = self.moments(self.lamp())
        stop, focus = 0.05, 2
        focal_length = 0.012 / math.tan(math.radians(LENS_ANGLE / 2))
        radius = 0.5 * focal_length / stop
        half_height = focus * math.tan(math.radians(LENS_ANGLE / 2))
        blur = radius * abs(DISTANCE - focus) / DISTANCE / half_height * SIDE / 2
        self.assertGreater(blur, 5)
        for blades, polar in ((0, 0.5), (4, 1 / 3), (6, 1 / 3 + 1 / 12)):
            options = ["--f-stop", stop, "--focus-distance", focus, *(["--aperture-blades", blades] if blades else [])]
            light, at, wide = self.moments(self.lamp(*options, spp=1024))
            print(f"{blades} blades: light {light / sharp - 1:+.3%}, square {(wide - square) / (polar * blur**2) - 1:+.3%}")
            # 60 pixels of lamp x 1,024 samples hit it, so that the standard errors are below 0.4 %, 0.7 % and 0.02 pixels.
            self.assertAlmostEqual(light / sharp, 1, delta=0.02)
            self.assertAlmostEqual((wide - square) / (polar * blur**2), 1, delta=0.02)
            self.assertLess(math.hypot(at[0] - middle[0], at[1] - middle[1]), 0.1)

    def test_what_is_in_focus_is_sharp(self):
        *_, square = self.moments(self.lamp())
        *_, same = self.moments(self.lamp("--f-stop", 0.05))  # the focal point is on the lamp
        self.assertAlmostEqual(same, square, delta=0.02)

    def test_the_depth_of_a_blurred_edge_is_the_mean_of_what_the_lens_sees(self):
        """A half-plane 3 m away hides a wall 4 m away, which is in focus: how much of the lens sees it is a segment of the aperture's disc."""
        gltf = quad({})
        gltf["nodes"] = [{"mesh": 0, "scale": [4, 4, 1]}, {"mesh": 0, "scale": [4, 4, 1], "translation": [-4, 0, 1]}]
        gltf["scenes"] = [{"nodes": [0, 1]}]
        path = self.written("edge.gltf", gltf)
        stop = 0.02
        radius = 0.5 * 0.012 / math.tan(math.radians(LENS_ANGLE / 2)) / stop
        def part_hidden(x):
            """Returns the hidden part of the lens, seen from the wall at x from the axis: its rays cross the edge at 3
            / 4 x + 1 / 4 of the lens."""
            at = min(max(-3 * x / radius, -1), 1)
            return 0.5 + (at * math.sqrt(1 - at * at) + math.asin(at)) / math.pi
        rows = self.picture(str(path.with_suffix("")), "x.exr", "--resolution", f"{SIDE},{SIDE}", "--spp", 64, "--camera-position", f"0,0,{DISTANCE}", "--camera-focal-point",
                            "0,0,0", "--camera-view-angle", LENS_ANGLE, "--f-stop", stop, "--stage", "flat", "--aov", "depth")
        depth = rows.values("depth.Z")
        pixel = 2 * math.tan(math.radians(LENS_ANGLE / 2)) * DISTANCE / SIDE
        seen = [statistics.fmean(depth[y * SIDE + x] for y in range(SIDE)) for x in range(SIDE)]
        wanted = []
        for x in range(SIDE):
            places = [(x + (k + 0.5) / 64 - SIDE / 2) * pixel for k in range(64)]
            wanted.append(DISTANCE - statistics.fmean(map(part_hidden, places)))
        self.assertGreater(sum(3.01 < depth < 3.99 for depth in wanted), 3)
        self.assertLess(max(abs(a - b) for a, b in zip(seen, wanted)), 0.02)

    def test_a_filter_keeps_what_is_out_of_focus(self):
        """Filtered, a picture that is out of focus has less error than before."""
        def picture(spp, seed, *options):
            rows = self.picture(str(SCENES / "cornell-box"), "x.pfm", "--resolution", "64,64", "--spp", spp, "--seed", seed, "--f-stop", 0.02, "--focus-distance", 1.5, *options)
            return [value for row in rows for pixel in row for value in pixel]
        truth = picture(2048, 9)
        error = lambda picture: sum((a - b)**2 / (b + 0.01)**2 for a, b in zip(picture, truth))
        plain, filtered = error(picture(16, 1)), error(picture(16, 1, "--denoise", "variance"))
        print(f"out of focus, filtered: {plain / filtered:.1f} times less squared error")
        self.assertLess(2 * filtered, plain)

    def test_a_focus_beyond_all_distances(self):
        """At the largest distance of the option, rays through the lens are parallel: the picture is the same as at a
        million metres."""
        near, far = (self.picture(str(SCENES / "cornell-box"), "x.pfm", "--resolution", "32,32", "--spp", 4, "--f-stop", 1, "--focus-distance", distance)
                     for distance in ("1e6", "1e30"))
        values = [[value for row in rows for pixel in row for value in pixel] for rows in (near, far)]
        self.assertGreater(statistics.fmean(values[0]), 0.05)
        self.assertLess(statistics.fmean(abs(a - b) for a, b in zip(*values)), 0.02 * statistics.fmean(values[0]))

    def test_a_wide_pinhole_is_no_lens(self):
        """At a huge f-number the picture is that of the pinhole, except for rounding."""
        plain, stopped = self.lamp(), self.lamp("--f-stop", "1e6")
        self.assertLess(max(abs(a[0] - b[0]) for one, other in zip(plain, stopped) for a, b in zip(one, other)), 0.02 * max(pixel[0] for row in plain for pixel in row))

    def test_wrong_use(self):
        scene = SCENES / "cornell-box.gltf"
        for options, text in ((["--focus-distance", "1"], "goes with --f-stop"), (["--aperture-blades", "5"], "goes with --f-stop"),
                              (["--f-stop", "0"], "--f-stop"), (["--f-stop", "nan"], "--f-stop"), (["--f-stop", "2", "--aperture-blades", "2"], "3 or more"),
                              (["--f-stop", "2", "--camera-parallel-scale", "1"], "orthographic")):
            self.fails(2, "render", scene, "-o", self.folder / "x.png", *options, says=[text])
        self.fails(2, "render", SCENES / "transforms.gltf", "-o", self.folder / "x.png", "--camera", "orthographic", "--f-stop", "2", says=["orthographic"])


# Scenes without a camera: all of the object is in the picture, and part of it is seen; otherwise a message says so.
ASSETS = Path(os.environ.get("FRAGTRACE_ASSETS", "/work/shared/assets")) / "scenes"


class FramingCase(Case):
    def alphas(self, scene, *options):
        """Rows of alpha, and what was said."""
        path = self.folder / "x.exr"
        result = self.renders(scene, "-o", path, "--stage", "flat", "--spp", 4, "--no-background", *options)
        return Exr(path).layers["A"], result.stderr

    def write(self, scale, rotation=(0, 0, 0, 1), double_sided=True):
        """Makes a quad of 2 x 2 m, scaled and then turned, without a camera."""
        gltf = quad({"doubleSided": double_sided})
        gltf["nodes"] = [{"mesh": 0, "scale": scale, "rotation": rotation}]
        gltf["scenes"] = [{"nodes": [0]}]
        for name in ("images", "textures", "cameras"):
            gltf.pop(name)
        return self.written("scene.gltf", gltf)

    def assert_inside(self, alphas):
        edge = [*alphas[0], *alphas[-1], *(row[0] for row in alphas), *(row[-1] for row in alphas)]
        self.assertEqual(max(edge), 0)
        self.assertGreater(max(map(max, alphas)), 0)


class Framing(FramingCase):
    def test_no_pixel_of_the_edge_shows_the_object(self):
        for scale in ((3, 1, 1), (1, 3, 1), (1, 1, 1)):
            for size in ("60,120", "120,60", "48,192"):
                for backend in BACKENDS if size == "60,120" else ("egl",):
                    alphas, said = self.alphas(self.write(scale), "--resolution", size, "--rendering-backend", backend)
                    self.assert_inside(alphas)
                    self.assertNotIn("shows nothing", said)

    def test_fit_leaves_a_narrow_margin(self):
        for scale, size in (((3, 1, 0.2), (60, 40)), ((0.1, 5, 1), (40, 60))):
            for options in (("--camera-orbit", "30,20"), ("--camera-orbit", "-100,-50,1"), ("--camera-parallel-scale", 1)):
                alphas, _ = self.alphas(self.write(scale), "--resolution", "%d,%d" % size, "--fit", *options)
                rows = [y for y, row in enumerate(alphas) if max(row) > 0]
                columns = [x for x in range(size[0]) if max(row[x] for row in alphas) > 0]
                margin = min(min(columns) / size[0], 1 - (max(columns) + 1) / size[0],
                             min(rows) / size[1], 1 - (max(rows) + 1) / size[1])
                self.assertGreaterEqual(margin, 0, (scale, options))
                self.assertLess(margin, 0.05, (scale, options))

    def test_what_lies_far_off_is_named(self):
        """The scene is a grid of 200 triangles, and a quad or a vertex of the grid far from it."""
        def write(vertex=0.0, quad_at=0.0, camera=False):
            gltf = Gltf(quad({}))
            places = [(x / 10, y / 10, 0.0) for y in range(11) for x in range(11)]
            places[60] = (*places[60][:2], vertex)
            corners = [c for y in range(10) for x in range(10) for a in [11 * y + x] for c in (a, a + 1, a + 12, a, a + 12, a + 11)]
            gltf.mesh(gltf.accessor(corners, "H"), position=gltf.accessor(places))
            gltf.root["nodes"] = [{"mesh": 0, "name": "dust", "translation": [quad_at, 0, 0]}, {"mesh": 1, "name": "model"}, {"camera": 0}]
            gltf.root["scenes"] = [{"nodes": [0, 1, 2] if camera else [0, 1]}]
            for name in ("images", "textures"):
                del gltf.root[name]
            return gltf.write(self.folder / "scene.gltf")

        tiny = ("--resolution", "8,8", "--spp", 1, "--stage", "flat")
        for options in ({}, {"quad_at": 50}):
            self.assertNotIn("reaches", run("info", write(**options)).stderr)
        for options, said in (({"quad_at": 500}, r'node "dust" reaches \d+ times .* framed; --hide 0 leaves the node out'),
                              ({"vertex": 500}, r'node "model" reaches \d+ times .* framed: a vertex of its mesh lies far off')):
            scene = write(**options)
            for stderr in (self.renders(scene, "-o", self.folder / "x.png", *tiny, "--fit").stderr, run("info", scene).stderr):
                self.assertRegex(stderr, f"{scene}: {said}")
        # One point in a hundred does not decide the default view.
        near = self.alphas(write(), "--resolution", "24,16")[0]
        stray, said = self.alphas(write(vertex=500), "--resolution", "24,16")
        self.assertIn("leaves out 1 point of the scene, far away from all others; --fit", said)
        self.assertNotIn("reaches", said)
        self.assertLess(abs(sum(map(sum, near)) - sum(map(sum, stray))), 0.15 * sum(map(sum, near)))
        said = self.renders(write(quad_at=500, camera=True), "-o", self.folder / "x.png", *tiny, "--fit").stderr
        self.assertIn("this view shows nothing of the scene; --camera-position", said)
        self.assertNotIn("reaches", run("info", write(quad_at=500), "--hide", 0).stderr)
        # A camera of the file frames nothing.
        self.assertNotIn("reaches", self.renders(write(quad_at=500, camera=True), "-o", self.folder / "x.png", *tiny).stderr)

    def test_a_part_is_framed_by_name(self):
        """Two quads of 2 m and 0.2 m, a node each, the smaller one below another node and with a material of its own."""
        gltf = Gltf(quad({"doubleSided": True, "name": "board"}))
        gltf.root["materials"].append({"name": "screw head", "doubleSided": True})
        small = json.loads(json.dumps(gltf.root["meshes"][0]))
        small["primitives"][0]["material"] = 1
        gltf.root["meshes"].append(small)
        gltf.root["nodes"] = [{"mesh": 0, "name": "wall"}, {"name": "Screws", "translation": [5, 0, 0], "children": [2]},
                              {"mesh": 1, "scale": [0.1, 0.1, 0.1]}, {"camera": 0}]
        gltf.root["scenes"] = [{"nodes": [0, 1, 3]}]
        for name in ("images", "textures"):
            gltf.root.pop(name, None)
        scene = gltf.write(self.folder / "scene.gltf")
        asked = ["--resolution", "40,40"]
        share = lambda *options: sum(map(sum, self.alphas(scene, *asked, *options)[0])) / 1600
        for name in ("wall", "Screws", "screws", "screw head", "board"):
            self.assertAlmostEqual(share("--fit-to", name), 0.95 ** 2, delta=0.03, msg=name)
            self.assertAlmostEqual(share("--fit-to", name, "--fill", 0.5), 0.25, delta=0.03, msg=name)
        self.assertLess(share("--fit"), 0.2)
        # An orbit looks at the part, and so does a turntable.
        self.assertGreater(share("--fit-to", "Screws", "--camera-orbit", "30,0"), 0.5)
        result = run("render", scene, "-o", self.folder / "x.png", "--fit-to", "bolt")
        self.assertEqual(result.returncode, 2)
        self.assertIn('--fit-to: "bolt" is no node and no material of the scene, which has "', result.stderr)
        result = run("render", scene, "-o", self.folder / "x.png", "--fit-to", "wall", "--hide", "wall")
        self.assertEqual(result.returncode, 2)
        self.assertIn("has nothing that is shown", result.stderr)

    def test_an_orbit_does_not_go_with_a_position(self):
        for options in (("--camera-position", "1,2,3"), ("--frames", "0:3", "--fit")):
            result = run("render", self.write((1, 1, 1)), "-o", self.folder / "x.##.png", "--camera-orbit", "1,2", *options)
            self.assertEqual(result.returncode, 2, result.stderr)

    def test_the_default_view_is_three_quarters_and_fills_the_frame(self):
        scene = self.write((1, 1, 0.2))
        asked = ["--resolution", "48,32"]
        default, _ = self.alphas(scene, *asked)
        self.assertEqual(default, self.alphas(scene, *asked, "--camera-orbit", "35,20", "--fit")[0])
        self.assertEqual(default, self.alphas(scene, *asked, "--fit")[0])
        angle = ["--camera-view-angle", 20]
        self.assertEqual(self.alphas(scene, *asked, *angle)[0], self.alphas(scene, *asked, *angle, "--camera-orbit", "35,20", "--fit")[0])
        # A point or a scale leaves nothing to fit.
        for own in (["--camera-focal-point", "0.5,0,0"], ["--camera-parallel-scale", 2]):
            self.assertEqual(self.alphas(scene, *asked, *own)[0], self.alphas(scene, *asked, *own, "--camera-orbit", "35,20")[0])

    def test_a_flat_object_is_not_seen_along_its_edge(self):
        """A floor, a wall, and a wall and a ceiling that hold the direction of the usual view, with a small thing on each."""
        half = 0.70710678
        azimuth = math.radians(125 / 2)
        slope = math.radians((90 + 19.4) / -2)
        for rotation in ((-half, 0, 0, half), (0, half, 0, half), (0, math.sin(azimuth), 0, math.cos(azimuth)), (math.sin(slope), 0, 0, -math.cos(slope))):
            scene = self.write((1, 1, 1), rotation)
            root = json.loads(scene.read_text())
            root["nodes"] += [{"mesh": 0, "scale": [0.04, 0.04, 0.04]}, {"mesh": 0, "scale": [0.04, 0.04, 0.04], "rotation": [-half, 0, 0, half]}]
            root["scenes"] = [{"nodes": [0, 1, 2]}]
            scene.write_text(json.dumps(root))
            alphas, said = self.alphas(scene, "--resolution", "48,48")
            self.assert_inside(alphas)
            self.assertGreater(sum(map(sum, alphas)), 0.12 * 48 * 48, rotation)
            self.assertNotIn("shows nothing", said)

    def test_a_default_view_that_shows_nothing_is_said(self):
        scene = self.write((1, 1, 1), (0, 1, 0, 0), double_sided=False)
        alphas, said = self.alphas(scene, "--resolution", "24,24")
        self.assertEqual(max(map(max, alphas)), 0)
        self.assertIn("default view shows nothing", said)
        _, said = self.alphas(scene, "--resolution", "24,24", "--camera-position", "0,0,9", "--camera-focal-point", "0,0,20")
        self.assertNotIn("default view", said)
        self.assertIn("this view shows nothing", said)


@unittest.skipUnless(ASSETS.is_dir(), f"{ASSETS} is absent")
class AssetFraming(FramingCase):
    def test_assets(self):
        for name, size in (("CornellBox/CornellBox.glb", "120,240"), ("TwoSidedPlane/TwoSidedPlane.gltf", "64,64")):
            alphas, said = self.alphas(ASSETS / name, "--resolution", size)
            self.assert_inside(alphas)
            self.assertNotIn("shows nothing", said)


if __name__ == "__main__":
    main()

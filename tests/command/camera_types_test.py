#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""--camera-type and --lens-shift: each pixel shows what lies along its ray, by formulas written down a second time."""
import json
import math

from support import SCENES, Case, Exr, main, quad

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
        """A room of unlit walls, and its own panorama in place of it, are the same picture."""
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
                              (["--camera-type", "panorama", "--tree-level", "1"], "--tree-level"), (["--camera-type", "fish"], "fisheye"),
                              (["--camera-type", "panorama", "--camera-orbit", "0,0,2"], "zoom"),
                              (["--camera-type", "panorama", "--caustics", "on", "--pixel-filter", "gaussian"], "--pixel-filter box")):
            self.fails(2, "render", scene, "-o", self.folder / "x.png", *options, says=[text])


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Options from a file, and the options that say from where a scene is seen."""
import json
import math

from support import SCENES, SMALL, Case, main, read_pfm, run

ROOM = SCENES / "cornell-box.gltf"


class Config(Case):
    def file(self, content):
        path = self.folder / "view.json"
        path.write_text(content if isinstance(content, str) else json.dumps(content))
        return path

    def bytes_of(self, *options, config=None):
        path = self.folder / "picture.pfm"
        more = [] if config is None else ["--config", self.file(config)]
        self.renders(ROOM, "-o", path, "--quiet", *options, *more)
        return path.read_bytes()

    def refused(self, content, *says, status=3, options=()):
        self.fails(status, "render", ROOM, "-o", self.folder / "x.pfm", "--config", self.file(content), *options, says=says)

    def test_every_kind_of_option_is_as_on_the_command_line(self):
        config = {"resolution": [16, 12], "spp": 2, "stage": "phong", "enable": ["schlick", "gi"], "disable": "shadows",
                  "camera-position": "-.5,0.25,3", "camera-view-angle": 0.1 + 0.2 + 30, "bounces": "unlimited", "seed": 7,
                  "up": [0, -1, 0.25], "background-color": [0, 0.5, 1.0], "no-background": True, "no-default-light": False}
        options = ["--resolution", "16,12", "--spp", 2, "--stage", "phong", "--enable", "schlick,gi", "--disable", "shadows",
                   "--camera-position", "-.5,0.25,3", "--camera-view-angle", 0.1 + 0.2 + 30, "--bounces", "unlimited",
                   "--seed", 7, "--up", "0,-1, 0.25", "--background-color", "0,0.5, 1", "--no-background"]
        self.assertEqual(self.bytes_of(config=config), self.bytes_of(*options))
        self.assertNotEqual(self.bytes_of(config={**config, "seed": 8}), self.bytes_of(*options))

    def test_the_command_line_wins_also_by_what_it_excludes(self):
        config = {"resolution": [16, 16], "spp": 3, "camera-view-angle": 20, "seed": 5}
        with_file = self.bytes_of("--spp", 2, "--camera-parallel-scale", 1, config=config)
        self.assertEqual(with_file, self.bytes_of("--resolution", "16,16", "--spp", 2, "--camera-parallel-scale", 1, "--seed", 5))

    def test_the_output_may_stand_in_the_file(self):
        output = self.folder / "named.pfm"
        self.renders(ROOM, *SMALL, "--config", self.file({"output": str(output)}))
        self.assertEqual(len(read_pfm(output)), 16)
        self.assertEqual(run("render", ROOM, *SMALL).returncode, 2)

    def test_what_is_wrong_is_named_with_its_place(self):
        self.refused('{\n "spp": 2,\n "seed" 3}', "view.json", "line 3")
        self.refused("", "view.json", "line 1")
        self.refused('[{"spp": 2}]', "view.json", "no JSON object")
        self.refused('{"seed": 1e400}', "view.json", "1e400")
        self.refused('{"spp": 2, "spp": 3}', "view.json: /spp", "twice")
        for name in ("warp", "file", "config", "help", "--spp", "o", "", "a/b"):
            self.refused({name: 1}, "view.json: /" + name.replace("/", "~1"), "no option of render")
        self.refused({"spp": 0}, "view.json: /spp")
        self.refused({"spp": "many"}, "view.json: /spp")
        self.refused({"spp": [1, 2]}, "view.json: /spp")
        self.refused({"spp": {"of": 1}}, "view.json: /spp", "neither a number nor a string")
        self.refused({"spp": None}, "view.json: /spp")
        self.refused({"enable": []}, "view.json: /enable", "empty")
        self.refused({"camera-position": [1, 2]}, "view.json: /camera-position")
        self.refused({"camera-position": [1, [2], 3]}, "view.json: /camera-position/1")
        self.refused({"no-background": 1}, "view.json: /no-background", "neither true nor false")
        self.refused({"stage": "fast"}, "view.json: /stage", "fast")
        self.refused({"camera-view-up": [0, 0, 0]}, "view.json: /camera-view-up", "zero")
        self.refused({"camera-view-angle": 30, "camera-parallel-scale": 2}, "view.json: /camera-parallel-scale", "does not go with")
        # An option of the command line is not blamed on the file.
        self.refused({"spp": 2}, "--stage", status=2, options=["--stage", "fast"])
        self.fails(3, "render", ROOM, "-o", self.folder / "x.pfm", "--config", self.folder / "none.json", says=["none.json"])


class CameraOptions(Case):
    def picture_of(self, *options):
        path = self.folder / "picture.pfm"
        self.renders(ROOM, "-o", path, "--quiet", "--resolution", "16,16", "--spp", 2, *options)
        return path.read_bytes()

    def test_a_parallel_scale_is_half_of_what_an_orthographic_view_shows(self):
        """The back wall of the Cornell box from y = -0.987 to 0.987 and from x = -1 to 1, seen through its open front."""
        path = self.folder / "wall.pfm"
        view = ["--camera-focal-point", "0,0,0", "--stage", "flat", "--resolution", "32,32", "--spp", 4, "--quiet"]
        for scale in (2, 4):
            self.renders(ROOM, "-o", path, "--camera-position", "0,0,5", "--camera-parallel-scale", scale, *view)
            picture = read_pfm(path)
            lit = [sum(pixel) > 0 for pixel in picture[15]]
            # A picture is 2 x scale high: a metre is 16 / scale pixels.
            self.assertEqual(lit, [abs(x + 0.5 - 16) < 16 / scale for x in range(32)])
            near = path.read_bytes()
            self.renders(ROOM, "-o", path, "--camera-position", "0,0,6", "--camera-parallel-scale", scale, *view)
            self.assertEqual(near, path.read_bytes())  # from anywhere the same

    def test_a_parallel_scale_is_above_zero_and_alone(self):
        for scale in ("0", "-1", "nan", "inf"):
            self.fails(2, "render", ROOM, "-o", self.folder / "x.pfm", "--camera-parallel-scale", scale, says=["parallel"])
        both = ["--camera-parallel-scale", 1, "--camera-view-angle", 30]
        self.fails(2, "render", ROOM, "-o", self.folder / "x.pfm", *both, says=["--camera-view-angle"])

    def test_an_origin_makes_a_view_named_by_its_camera_the_same_to_the_bit(self):
        """The scene's own camera, and the same one spelled out with a focal point, about which positions are rounded otherwise."""
        angle = math.degrees(0.686047881)
        spelled = ["--camera-position", "0,0,3.8834532374100714", "--camera-focal-point", "0,0,0.123456789", "--camera-view-up", "0,1,0",
                   "--camera-view-angle", f"{angle:.17g}"]
        centre = json.loads(run("info", ROOM, "--json").stdout)["scene"]["origin"]
        origin = ["--scene-origin", ",".join(f"{x:.17g}" for x in centre)]
        self.assertEqual(self.picture_of(*spelled, *origin), self.picture_of())
        self.assertNotEqual(self.picture_of(*spelled), self.picture_of())


class Switches(Case):
    def drawn(self, config, *options):
        path, file = self.folder / "picture.pfm", self.folder / "c.json"
        file.write_text(json.dumps(config))
        self.renders(ROOM, "-o", path, "--quiet", "--resolution", "16,16", "--spp", "2", "--config", file, *options)
        return path.read_bytes()

    def test_those_of_the_command_line_count_more_one_by_one(self):
        plain = self.drawn({})
        self.assertNotEqual(self.drawn({"disable": "sobol"}), plain)
        self.assertEqual(self.drawn({"disable": "sobol"}, "--enable", "sobol"), plain)
        self.assertEqual(self.drawn({"enable": ["sobol"]}, "--disable", "sobol"), self.drawn({"disable": "sobol"}))
        both = self.drawn({}, "--disable", "sobol,light-sampling")
        self.assertEqual(self.drawn({"disable": "light-sampling"}, "--disable", "sobol"), both)
        self.assertEqual(self.drawn({"disable": ["light-sampling", "sobol"]}), both)


if __name__ == "__main__":
    main()

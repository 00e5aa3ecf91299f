#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""--caustics: light that the sun of --sky, or of a map, sends by way of a mirror. The mirror stands at the edge of matt ground and faces the sun, so what
it throws there is as bright as what the sun itself sends, which is drawn from the ground. The sky beside the sun is made black. The mean of one picture
lies within the part that is given, which is about 4 standard errors (of 4 seeds)."""
import json
import shutil
import struct

from support import SHADERS, Case, luminances, main, mean
from gltf_writer import GltfWriter
from geometry import ground, quad
from scene_parts import place_quad

ABOVE = ("--camera-position", "0,4,0", "--camera-focal-point", "0,0,0", "--camera-view-up", "0,0,-1", "--camera-parallel-scale", "1")
SKY = ("--sky", "--sun-elevation", "30", "--sun-azimuth", "90")
BLACK = ("environment.glsl", "vec3(there) * intensity", "vec3(there) * (0.0f * intensity)")
WIDER = 10
WIDE = (("layout.glsl", "kSunRadius = 0.004651303f", f"kSunRadius = {0.004651303 * WIDER}f"), ("sky/sun.glsl", "sun.pdf = light.w;", f"sun.pdf = light.w / {WIDER**2}.0f;"))


class SunCaustics(Case):
    def scene(self, name, mirror=True, lamp=0.0, roughness=0.0):
        """The mirror has two halves. A lamp of that radiance shines down from where it shades nothing."""
        gltf = GltfWriter(self.folder, name)
        place_quad(gltf, "ground", ground(1.05, 3), gltf.add_lambert("ground", (1, 1, 1)))
        smooth = gltf.add_material("mirror", metallic=1, roughness=roughness)
        for z in (0.0, 1.1) if mirror else ():
            place_quad(gltf, f"mirror {z}", quad((-1.05, 0, z), (0, 0, -1.1), (0, 1.3, 0)), smooth)
        if lamp:
            place_quad(gltf, "lamp", quad((0.1, 2.2, -0.2), (0.4, 0, 0), (0, 0, 0.4)), gltf.add_lamp("lamp", (lamp, lamp, lamp)))
        gltf.write()
        return str(self.folder / name)

    def shaders(self, *edits):
        folder = self.folder / f"shaders{len(edits)}"
        if not folder.exists():
            shutil.copytree(SHADERS, folder)
            for name, old, new in edits:
                text = (folder / name).read_text()
                self.assertEqual(text.count(old), 1, name)
                (folder / name).write_text(text.replace(old, new))
        return ("--shader-folder", folder)

    def drawn(self, scene, *options, spp=32):
        return self.picture(scene, "x.pfm", "--resolution", "96,96", *ABOVE, "--bounces", 1, "--spp", spp, *options)

    def seen(self, scene, *options, **more):
        return mean(self.drawn(scene, *options, **more), 1)

    def test_candidates_bring_what_glossy_metal_scatters_of_the_sky(self):
        """The sun stands behind the metal, which a sample may choose all the same."""
        scene = self.scene("glossy", roughness=0.3)
        behind = ("--sky", "--sun-elevation", "3", "--sun-azimuth", "270")
        one, several = (luminances(self.drawn(scene, *behind, "--light-reuse", reuse, "--seed", seed, spp=32)) for seed, reuse in enumerate(("none", "candidates")))
        self.assert_same_light(several, one, "candidates", 0.002)

    def test_a_mirror_shows_the_ground_a_second_sun(self):
        direct = self.seen(self.scene("bare", mirror=False), *SKY, *self.shaders(BLACK), spp=16)
        scene = self.scene("mirror")
        self.assert_near(self.seen(scene, *SKY, *self.shaders(BLACK), spp=96), 2 * direct, "sun", 0.006)

    def test_camera_paths_leave_out_what_light_paths_bring(self):
        """A sun of ten times its width, as bright, is found by chance a hundred times as often."""
        edits = self.shaders(BLACK, *WIDE)
        direct = self.seen(self.scene("bare", mirror=False), *SKY, *edits, spp=16)
        scene = self.scene("mirror")
        # Turned back to the east.
        turned = ("--sky", "--sun-elevation", "30", "--sun-azimuth", "130", "--hdri-rotation", "40", "--hdri-intensity", "0.5")
        self.assert_near(self.seen(scene, *turned, *edits), direct, "wide sun, turned and dimmed", 0.012)
        self.assert_near(self.seen(scene, *SKY, *edits, "--caustics", "off", spp=128), 2 * direct, "wide sun, from the camera alone", 0.05)

    def map(self, name, width, place, sun, sky=0.0):
        """A map of even sky with a sun of one texel, which filters blur over its neighbours."""
        height = width // 2
        texels = [[sky] * width for _ in range(height)]
        x, y = place
        texels[y][x] = sun
        path = self.folder / name
        rows = reversed(texels)  # from the bottom
        path.write_bytes(b"PF\n%d %d\n-1.0\n" % (width, height) + b"".join(struct.pack("<fff", v, v, v) for row in rows for v in row))
        return path

    def test_the_sun_of_a_map(self):
        """A narrow one stands where that of SKY does. A wide one, as bright as the sky is in all, is found by camera paths too."""
        bare, mirror = self.scene("bare", mirror=False), self.scene("mirror")
        narrow = ("--hdri-file", self.map("narrow.pfm", 512, (256, 85), 1e5))
        direct = self.seen(bare, *narrow, spp=16)
        self.assert_near(self.seen(mirror, *narrow), 2 * direct, "narrow sun", 0.008)
        wide = ("--hdri-file", self.map("wide.pfm", 64, (42, 10), 3e3, sky=1.0), "--hdri-rotation", "60", "--hdri-intensity", "0.5")
        for scene, spp in ((mirror, 32), (self.scene("glossy", roughness=0.25), 64)):
            found, thrown = (luminances(self.drawn(scene, *wide, "--seed", seed, "--caustics", caustics, spp=samples))
                             for seed, (caustics, samples) in enumerate((("off", 512), ("on", spp))))
            self.assert_same_light(thrown, found, f"wide sun, turned and dimmed, {spp}", 0.004)

    def test_beside_a_lamp_each_brings_its_own(self):
        scene = self.scene("lamp", lamp=60)
        direct = self.seen(self.scene("bare", mirror=False), *SKY, *self.shaders(BLACK), spp=16)
        lamp = self.seen(scene)
        self.assertGreater(lamp, 0.9 * direct)
        self.assert_near(self.seen(scene, *SKY, *self.shaders(BLACK)), 2 * direct + lamp, "sun and lamp", 0.008)

    def test_it_is_told(self):
        def told(scene, *options):
            path = self.folder / "stats.json"
            self.renders(f"{scene}.gltf", "-o", self.folder / "x.png", "--resolution", "16,16", "--spp", 2, "--stats", path, *options)
            return json.loads(path.read_text())["caustics"]
        scene = self.scene("mirror")
        day = told(scene, *SKY)
        self.assertEqual(day["light_paths"], 2 * 16 * 4)
        self.assertIn("a sun", day["reason"])
        night = told(scene, "--sky", "--sun-elevation", "-5")
        self.assertEqual(night["light_paths"], 0)
        self.assertIn("no lamp or sun", night["reason"])
        even = told(scene, "--hdri-file", self.map("even.pfm", 64, (42, 10), 2.0, sky=1.0))
        self.assertEqual(even, night)
        self.assertEqual(told(scene, "--hdri-file", self.map("sun.pfm", 64, (42, 10), 3e3, sky=1.0))["reason"], day["reason"])
        self.assertEqual(told(scene, *SKY, "--caustics", "off"), {"light_paths": 0, "pixels_per_path": 0, "casters": 0, "variance_share": 0, "guiding_ms": 0, "reason": "--caustics"})


if __name__ == "__main__":
    main()

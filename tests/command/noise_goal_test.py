#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`--noise` looks at the pixels that can be noisy, however few they are, and however rarely light is met there."""
import json
import math
import statistics

from support import TWO_TRIANGLES, Case, Gltf, main


def quantile(values, part):
    return sorted(values)[max(0, math.ceil(part * len(values)) - 1)]


class Sketch(Gltf):
    """Quads and glass spheres, looked at from above by an orthographic camera that shows a square of 2 x `half` metres."""

    def __init__(self, half):
        super().__init__(extensionsUsed=["KHR_implicit_shapes"], materials=[],
                         cameras=[{"type": "orthographic", "orthographic": {"xmag": half, "ymag": half, "znear": 0.01, "zfar": 100}}])
        self.node(camera=0, translation=[0, 0, 50])

    def material(self, emission=0, color=0.8, **extensions):
        names = {"KHR_materials_" + name: e for name, e in extensions.items()}
        self.root["extensionsUsed"] = sorted({*self.root["extensionsUsed"], *names, "KHR_materials_emissive_strength"})
        self.root["materials"].append({
            "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0 if names else 1, "baseColorFactor": [color] * 3 + [1]},
            "emissiveFactor": [1 if emission else 0] * 3,
            "extensions": names or {"KHR_materials_emissive_strength": {"emissiveStrength": max(emission, 1)}}})
        return len(self.root["materials"]) - 1

    def quad(self, x, y, z, half, material, down=False):
        """Adds a square; `half` is the distance from its middle to each side. It looks up, or down."""
        position = self.accessor([(x + a, y + b, z) for a, b in ((-half, -half), (half, -half), (half, half), (-half, half))])
        indices = self.accessor((0, 2, 1, 0, 3, 2) if down else TWO_TRIANGLES, "H")
        self.node(mesh=self.mesh(indices, position=position, material=material))

    def ball(self, z, radius, material):
        self.root["extensions"] = {"KHR_implicit_shapes": {"shapes": [{"type": "sphere", "sphere": {"radius": radius}}]}}
        self.node(extras={"shape": 0, "material": material}, translation=[0, 0, z])


def small_object(pixels):
    """A quad of so many pixels per side in a picture of 64 x 64, black all round; its edges keep off the next pixels."""
    sketch = Sketch(32)
    sketch.quad(0, 0, 0, pixels / 2 - 0.001, sketch.material())
    sketch.quad(0, 40, 10, 6, sketch.material(500), down=True)
    return sketch


def lamp_in_the_dark():
    """A lamp, seen from behind, over a white patch on a ground that is black."""
    sketch = Sketch(32)
    sketch.quad(0, 0, 0, 40, sketch.material(color=0, specular={"specularFactor": 0}))
    sketch.quad(3, 5, 0.01, 4.999, sketch.material())
    sketch.quad(3, 5, 1.5, 0.75, sketch.material(20), down=True)
    return sketch


def caustic():
    """A glass ball hides a small lamp from all of the ground that is seen; one path of a thousand meets the lamp through it."""
    sketch = Sketch(0.3)
    sketch.quad(0, 0, 0, 4, sketch.material())
    sketch.ball(1.2, 0.5, sketch.material(transmission={"transmissionFactor": 1}, volume={"thicknessFactor": 1}))
    sketch.quad(0, 0, 6, 0.1, sketch.material(600), down=True)
    return sketch


# The 95th percentile of chi square over its degrees of freedom, here pictures: what root mean squares of so few scatter upwards by, squared.
SCATTER = {4: 9.488 / 4, 8: 15.507 / 8}


class Goal(Case):
    """The 95th percentile, over lit pixels that a camera sample hits, of the root mean square error of some seeds, against a picture of many samples,
    is at most 1.2 times the goal, beside what so few seeds scatter."""

    def check(self, sketch, goal, resolution, most, seeds=4):
        path = self.folder / "scene.gltf"
        sketch.write(path)
        common = ["--resolution", f"{resolution},{resolution}", "--no-background"]
        stem = str(path.with_suffix(""))
        reference = self.picture(stem, "r.exr", *common, "--spp", most, "--seed", 77)
        pictures = [self.picture(stem, "x.exr", *common, "--noise", goal, "--seed", 100 + s, "--stats", self.folder / "s.json") for s in range(seeds)]
        stats = json.loads((self.folder / "s.json").read_text())
        light = reference.luminances()
        floor = 0.01 * statistics.fmean(light)
        seen = [any(alpha) for alpha in zip(*(p.values("A") for p in pictures))]
        errors = [math.sqrt(statistics.fmean((x - r) ** 2 for x in pixel)) / (r + floor)
                  for pixel, r, s in zip(zip(*(p.luminances() for p in pictures)), light, seen) if s and r > 0]
        error = quantile(errors, 0.95)
        print(f"{len(errors)} of {len(light)} pixels: true error {error:.4f}, goal {goal}, {stats['samples_per_pixel']:.0f} samples per pixel", flush=True)
        self.assertGreaterEqual(stats["fewest_samples"], 32)
        self.assertLess(error, 1.2 * goal * math.sqrt(SCATTER[seeds]))


class NoiseGoal(Goal):
    def test_an_object_of_2_percent_of_the_picture(self):
        self.check(small_object(9), 0.02, 64, 4096)

    def test_an_object_of_a_thousandth_of_the_picture(self):
        self.check(small_object(2), 0.002, 64, 16384)

    def test_a_lamp_in_the_dark(self):
        self.check(lamp_in_the_dark(), 0.05, 64, 8192)


class NoiseGoalCaustic(Goal):
    def test_a_caustic_that_most_samples_miss(self):
        self.check(caustic(), 0.5, 16, 65536, seeds=8)

    def test_smaller_goals(self):
        self.check(small_object(9), 0.01, 64, 32768, seeds=8)
        self.check(lamp_in_the_dark(), 0.02, 64, 16384, seeds=8)


if __name__ == "__main__":
    main()

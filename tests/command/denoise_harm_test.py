#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`render --denoise variance` does no harm: in no scene and at no number of samples is the filtered picture farther from the truth than the noisy one.

Sixteen pictures with different seeds: the truth for each is the mean of the other fifteen of most samples. What noise that has, the same sixteen tell; it is taken
off both errors."""
import math
import statistics
from concurrent.futures import ThreadPoolExecutor

from support import SCENES, Case, Exr, main

SIZE = "64,64"
SAMPLES = (16, 64, 256, 1024)
SEEDS = range(16)
MOST = 1.02        # limit of filtered over noisy error
STUDENT = 1.753    # 95 % of Student's t with fifteen degrees of freedom, one-sided
DARK = 0.01        # the part of the mean that is squared in the relative errors of docs/output.md
SKY = ["--hdri-file", SCENES / "sky.pfm"]
PICTURES = {
    "cornell-box": [],
    "corner-diffuse": [],
    "rough-glass": SKY,
    "many-lights": [],
    "sphere-textured": [],
    "glass-sphere": [],
    "mapped-metal": [],
    "coverage": [],
    "lobes": SKY,
    "sun-sky": ["--hdri-file", SCENES / "sun-sky.pfm"],
}


class NoHarm(Case):
    def drawn(self, scene, spp, seed):
        """Returns the colours as drawn and as filtered."""
        path = self.folder / f"{scene}-{spp}-{seed}.exr"
        self.renders(SCENES / (scene + ".gltf"), "-o", path, "--quiet", "--resolution", SIZE, "--spp", spp, "--seed", 1 + seed, "--denoise", "variance",
                     *PICTURES[scene])
        exr = Exr(path)
        path.unlink()
        return [sum((exr.values(prefix + color) for color in "RGB"), []) for prefix in ("noisy.", "")]

    def ratios(self, scene):
        """Samples: errors of the filtered picture over those of the noisy one, of all seeds."""
        pictures = {spp: [self.drawn(scene, spp, seed) for seed in SEEDS] for spp in reversed(SAMPLES)}
        longest = [noisy for noisy, _ in pictures[SAMPLES[-1]]]
        sums = list(map(sum, zip(*longest)))
        count = len(longest)
        mean = sum(sums) / (count * len(sums))
        weights = [1 / ((s / count) ** 2 + DARK * mean ** 2) for s in sums]
        # The mean of all but one has 1 / (count - 1) of a picture's variance.
        spread = sum(w * statistics.variance(values) for w, values in zip(weights, zip(*longest)))
        doubt = spread / (count - 1)

        def error(picture, seed):
            others = ((s - own) / (count - 1) for s, own in zip(sums, longest[seed]))
            return sum(w * (value - truth) ** 2 for w, value, truth in zip(weights, picture, others)) - doubt
        return {spp: [error(filtered, seed) / error(noisy, seed) for seed, (noisy, filtered) in enumerate(pairs)] for spp, pairs in pictures.items()}

    def test_no_scene_and_no_number_of_samples(self):
        with ThreadPoolExecutor(2) as both:
            found = dict(zip(PICTURES, both.map(self.ratios, PICTURES)))
        for scene, ratios in found.items():
            for spp, values in ratios.items():
                bound = statistics.mean(values) + STUDENT * statistics.stdev(values) / math.sqrt(len(values))
                with self.subTest(scene=scene, spp=spp):
                    self.assertLessEqual(bound, MOST, f"{statistics.mean(values):.3f} on average")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Renders one of our scenes in Mitsuba 3, again and again on request, from the description that makes the references. Started by bench/variance.py.

usage: mitsuba_light.py SCENE.gltf W,H INTEGRATOR
Each line of stdin is {"spp", "seed", "output"}; each answer {"cpu"}: seconds for drawing alone. The first request is drawn twice, so that its kernels are compiled.
Roulette is Mitsuba's own, paths are as long as ours.
"""
import json
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests/reference"))

import render_mitsuba  # noqa: E402, before mitsuba: chooses the variant
import drjit as dr  # noqa: E402
import mitsuba as mi  # noqa: E402
import numpy as np  # noqa: E402
from gltf_scene import read_scene  # noqa: E402

BOUNCES = 16
PASS_SAMPLES = 1 << 24  # at once: bounds the memory


def build(path, resolution, integrator, scratch):
    entry = {"scene": path.stem, "resolution": resolution, "options": ["--bounces", str(BOUNCES)], "spp": 1, "integrator": integrator}
    scene = render_mitsuba.described(read_scene(path), entry, scratch)
    scene["integrator"].pop("rr_depth")
    scene["sensor"]["sampler"]["type"] = "independent"
    return mi.load_dict(scene)


def draw(scene, pixels, spp, seed):
    """Returns the picture, and the CPU seconds it took."""
    dr.sync_thread()
    start, total, done, k = time.process_time(), 0, 0, 0
    while done < spp:
        step = min(spp - done, max(PASS_SAMPLES // pixels, 1))
        picture = mi.render(scene, spp=step, seed=seed * 4096 + k)
        dr.eval(picture)
        dr.sync_thread()
        total = total + np.array(picture) * (step / spp)
        done, k = done + step, k + 1
    return total, time.process_time() - start


def main():
    path, resolution, integrator = Path(sys.argv[1]), tuple(map(int, sys.argv[2].split(","))), sys.argv[3]
    mi.set_log_level(mi.LogLevel.Error)
    with tempfile.TemporaryDirectory() as scratch:
        scene = build(path, resolution, integrator, Path(scratch))
    pixels, warm = resolution[0] * resolution[1], set()
    print("peer", json.dumps({"version": "Mitsuba " + mi.__version__}), flush=True)
    for line in sys.stdin:
        request = json.loads(line)
        if request["spp"] not in warm:
            draw(scene, pixels, request["spp"], 100)
            warm.add(request["spp"])
        picture, seconds = draw(scene, pixels, request["spp"], request["seed"])
        mi.Bitmap(picture.astype(np.float32)).write(request["output"])
        print("peer", json.dumps({"cpu": seconds}), flush=True)


if __name__ == "__main__":
    main()

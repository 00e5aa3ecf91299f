#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Renders one of our scenes in Mitsuba 3, again and again on request, from the description that makes the references. Started by bench/variance.py.

usage: mitsuba_light.py SCENE.gltf W,H INTEGRATOR
Each line of stdin is {"spp", "seed", "output"}; each answer is that of mitsuba_worker.py. The first request of a number of samples (a power of two) is drawn
twice, so that its kernels are compiled.
Roulette is Mitsuba's own, paths are as long as ours.
"""
import json
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests/reference"))

import render_mitsuba  # noqa: E402, before mitsuba: chooses the variant
import mitsuba as mi  # noqa: E402
import numpy as np  # noqa: E402
from gltf_scene import read_scene  # noqa: E402
from mitsuba_worker import draw  # noqa: E402

BOUNCES = 16


def build(path, resolution, integrator, scratch):
    entry = {"scene": path.stem, "resolution": resolution, "options": ["--bounces", str(BOUNCES)], "spp": 1, "integrator": integrator}
    scene = render_mitsuba.described(read_scene(path), entry, scratch)
    scene["integrator"].pop("rr_depth")
    scene["sensor"]["sampler"]["type"] = "independent"
    return mi.load_dict(scene)


def main():
    path, resolution, integrator = Path(sys.argv[1]), tuple(map(int, sys.argv[2].split(","))), sys.argv[3]
    mi.set_log_level(mi.LogLevel.Error)
    with tempfile.TemporaryDirectory() as scratch:
        scene = build(path, resolution, integrator, Path(scratch))
    sensor = scene.sensors()[0]
    pixels, warm = resolution[0] * resolution[1], set()
    print("peer", json.dumps({"version": "Mitsuba " + mi.__version__}), flush=True)
    for line in sys.stdin:
        request = json.loads(line)
        if request["spp"] not in warm:
            draw(scene, sensor, pixels, request["spp"], 100)
            warm.add(request["spp"])
        picture, answer = draw(scene, sensor, pixels, request["spp"], request["seed"])
        mi.Bitmap(picture.astype(np.float32)).write(request["output"])
        print("peer", json.dumps(answer), flush=True)


if __name__ == "__main__":
    main()

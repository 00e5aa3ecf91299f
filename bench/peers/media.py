#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Participating media beside Mitsuba 3: camera paths per second, and seconds to a relative MSE, both drawn in turn on the same cores.

usage: media.py FRAGTRACE [SCENE...]   (run by a Python that has mitsuba and numpy; on a quiet machine)
The scenes are those of tests/reference, whose pictures tell the error. Times are those of drawing alone.
"""
import json
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(REPOSITORY / "tests/reference"))
import drjit as dr  # noqa: E402
import mitsuba as mi  # noqa: E402
import numpy as np  # noqa: E402
import render_mitsuba  # noqa: E402
from gltf_scene import read_scene  # noqa: E402

ROUNDS, SPP, GOAL = 7, 256, 1e-2


def read(path):
    return np.array(mi.Bitmap(str(path)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32))


def relative_mse(picture, reference):
    return float((((picture - reference) ** 2).mean(-1) / (reference.mean(-1) ** 2 + 1e-4)).mean())


def ours(program, entry, seed, folder):
    picture, stats = folder / "ours.pfm", folder / "stats.json"
    width, height = entry["resolution"]
    subprocess.run([program, "render", f"scenes/{entry['scene']}.gltf", "-o", picture, "--quiet", "--stats", stats, "--spp", str(SPP), "--seed", str(seed),
                    "--resolution", f"{width},{height}", *entry["options"]], check=True, cwd=REPOSITORY)
    return json.loads(stats.read_text())["render_ms"] / 1e3, read(picture)


def theirs(scene, seed):
    started = time.monotonic()
    picture = mi.render(scene, spp=SPP, seed=seed)
    dr.eval(picture)
    dr.sync_thread()
    return time.monotonic() - started, np.array(picture)


def main():
    program = Path(sys.argv[1]).resolve()
    entries = {entry["name"]: entry for entry in json.loads((REPOSITORY / "tests/reference/references.json").read_text())["references"]}
    print("| scene | fragtrace, paths/s | Mitsuba, paths/s | ratio | fragtrace, s to 1e-2 | Mitsuba, s to 1e-2 | ratio |\n| --- | --- | --- | --- | --- | --- | --- |")
    for name in sys.argv[2:] or ("milk", "cloud", "smoke"):
        entry = entries[name + ".gi"]
        reference = read(REPOSITORY / "tests/reference" / (entry["name"] + ".exr"))
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            scene = render_mitsuba.build(read_scene(REPOSITORY / "scenes" / (entry["scene"] + ".gltf")), entry, folder)
            theirs(scene, 1000)  # compiles
            seconds, errors = ([], []), ([], [])
            for seed in range(ROUNDS):
                for engine, (taken, picture) in enumerate((ours(program, entry, seed, folder), theirs(scene, seed))):
                    seconds[engine].append(taken)
                    errors[engine].append(relative_mse(picture, reference))
        paths = [entry["resolution"][0] * entry["resolution"][1] * SPP / statistics.median(times) for times in seconds]
        reach = [statistics.median(times) * statistics.fmean(mse) / GOAL for times, mse in zip(seconds, errors)]
        print(f"| {name} | {paths[0]:.3g} | {paths[1]:.3g} | {paths[0] / paths[1]:.2f} | {reach[0]:.3g} | {reach[1]:.3g} | {reach[0] / reach[1]:.2f} |", flush=True)


if __name__ == "__main__":
    main()

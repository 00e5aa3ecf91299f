#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Times how long scenes take to load, and what memory that takes.

usage: load.py FRAGTRACE SCENE... [--rounds N] [--field INSTANCES,TRIANGLES]
Each round draws one sample of 16 x 16 pixels of each scene in turn, in a process of its own. Prints medians (least to largest), and the peak of the
process and those it started. --field adds a scene of that many instances (EXT_mesh_gpu_instancing) of one mesh of about so many triangles.
"""
import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

MAKE_FIELD = Path(__file__).parent.parent / "scenes/instanced_scene.py"
STEPS = (("load", "load_ms"), ("tree", "bvh_build_ms"), ("pack", "pack_ms"), ("upload", "upload_ms"))


def load(program, scene, folder):
    stats = folder / "stats.json"
    process = subprocess.Popen([program, "render", scene, "-o", folder / "picture.pfm", "--stage", "flat", "--resolution", "16,16", "--spp", "1",
                                "--quiet", "--stats", stats], stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise SystemExit(f"load.py: {scene} gave status {process.returncode}")
    return json.loads(stats.read_text()), usage.ru_maxrss / 1024


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program", type=Path)
    parser.add_argument("scenes", type=Path, nargs="*")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--field", type=lambda text: text.split(","))
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        scenes = list(options.scenes)
        if options.field:
            subprocess.run([sys.executable, MAKE_FIELD, folder, "field", *options.field], check=True)
            scenes.append(folder / "field.gltf")
        results = {scene: [] for scene in scenes}
        for _ in range(options.rounds):
            for scene in scenes:
                results[scene].append(load(options.program.resolve(), scene, folder))
    print(f"{'scene':34s}{'triangles':>12s}" + "".join(f"{name + ' ms':>22s}" for name, _ in STEPS) + f"{'peak MiB':>10s}")
    for scene, runs in results.items():
        cells = ""
        for _, key in STEPS:
            values = [stats[key] for stats, _ in runs]
            cells += f"{f'{statistics.median(values):.0f} ({min(values):.0f} to {max(values):.0f})':>22s}"
        drawn = runs[0][0]["scene"]["instancing"]["triangles_drawn"]
        print(f"{scene.stem:34s}{drawn:12,d}{cells}{statistics.median(peak for _, peak in runs):10.0f}")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Times the traversals on the two meshes in turn, and checks their pictures against each other.

usage: traversals.py FRAGTRACE SCENES_FOLDER [--rounds N] [--spp N] [--no-iterative]
Prints the median frame time of each setting over all rounds, and ratios round by round (median, least, largest). On software
drivers the clock is the wall's round glFinish; run it on a quiet machine.
"""
import argparse
import json
import os
import statistics
import subprocess
import tempfile
from pathlib import Path

MESHES = ("mesh-15743", "mesh-62975")


def frame_ms(program, scene, traversal, spp, folder):
    picture, stats = folder / f"{scene.stem}.{traversal}.pfm", folder / "stats.json"
    subprocess.run([program, "render", scene, "-o", picture, "--stage", "flat", "--resolution", "500,500", "--spp", str(spp),
                    "--traversal", traversal, "--quiet", "--stats", stats], check=True,
                   env={**os.environ, "MESA_SHADER_CACHE_DISABLE": "true"})
    return json.loads(stats.read_text())["frame_ms"]["median"], picture


def ratio_line(name, values):
    print(f"{name:58s} {statistics.median(values):8.2f}  ({min(values):.2f} to {max(values):.2f})")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program", type=Path)
    parser.add_argument("scenes", type=Path)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--no-iterative", action="store_true")
    options = parser.parse_args()
    program = options.program.resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        times = {}
        for _ in range(options.rounds):
            for traversal in ("front-to-back", "bvh"):
                for mesh in MESHES:
                    ms, _ = frame_ms(program, options.scenes / f"{mesh}.gltf", traversal, options.spp, folder)
                    times.setdefault((traversal, mesh), []).append(ms)
        if not options.no_iterative:
            for mesh in MESHES:
                ms, _ = frame_ms(program, options.scenes / f"{mesh}.gltf", "iterative", 1, folder)
                times[("iterative", mesh)] = [ms]
                _, one = frame_ms(program, options.scenes / f"{mesh}.gltf", "front-to-back", 1, folder)
                subprocess.run([program, "diff", folder / f"{mesh}.iterative.pfm", one, "--metric", "rmse", "--threshold", "1e-4"],
                               check=True, stdout=subprocess.DEVNULL)
        for mesh in MESHES:
            frame_ms(program, options.scenes / f"{mesh}.gltf", "bvh", 4, folder)
            _, tree = frame_ms(program, options.scenes / f"{mesh}.gltf", "front-to-back", 4, folder)
            subprocess.run([program, "diff", folder / f"{mesh}.bvh.pfm", tree, "--metric", "rmse", "--threshold", "1e-4"], check=True,
                           stdout=subprocess.DEVNULL)
    print("median frame time, ms (500 x 500, one sample; pictures of all traversals agree)")
    for (traversal, mesh), values in times.items():
        print(f"  {traversal:14s} {mesh:11s} {statistics.median(values):12.2f}  ({min(values):.2f} to {max(values):.2f})")
    front = times[("front-to-back", MESHES[1])]
    print("ratios (median, least to largest)")
    ratio_line("bvh / front-to-back, 62,975 triangles", [b / f for b, f in zip(times[("bvh", MESHES[1])], front)])
    ratio_line("front-to-back, 62,975 / 15,743 triangles", [b / a for a, b in zip(times[("front-to-back", MESHES[0])], front)])
    if ("iterative", MESHES[1]) in times:
        slow = times[("iterative", MESHES[1])][0]
        ratio_line("iterative / front-to-back, 62,975 triangles", [slow / f for f in front])
        print(f"iterative: {62975 * 500 * 500 / slow / 1000:.0f} million triangle tests a second at 62,975 triangles, "
              f"{15743 * 500 * 500 / times[('iterative', MESHES[0])][0] / 1000:.0f} at 15,743")


if __name__ == "__main__":
    main()

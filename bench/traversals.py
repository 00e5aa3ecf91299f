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
    subprocess.run([program, "render", scene, "-o", picture, "--stage", "flat", "--default-light", "white", "--resolution", "500,500", "--spp", str(spp),
                    "--traversal", traversal, "--quiet", "--stats", stats], check=True,
                   env={**os.environ, "MESA_SHADER_CACHE_DISABLE": "true"})
    return json.loads(stats.read_text())["frame_ms"]["median"], picture


def compare_pictures(program, picture, reference):
    subprocess.run([program, "diff", picture, reference, "--metric", "rmse", "--threshold", "1e-4"], check=True, stdout=subprocess.DEVNULL)


def measure(program, scenes, rounds, spp, iterative=True):
    """{(traversal, mesh): milliseconds per frame, round by round}; the iterative one has one round. Raises where pictures differ."""
    times = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)

        def draw(mesh, traversal, samples):
            return frame_ms(program, scenes / f"{mesh}.gltf", traversal, samples, folder)

        for _ in range(rounds):
            for traversal in ("front-to-back", "bvh"):
                for mesh in MESHES:
                    times.setdefault((traversal, mesh), []).append(draw(mesh, traversal, spp)[0])
        for traversal, samples in (("iterative", 1), ("bvh", 4)) if iterative else (("bvh", 4),):
            for mesh in MESHES:
                ms, picture = draw(mesh, traversal, samples)
                times.setdefault((traversal, mesh), [ms])
                compare_pictures(program, picture, draw(mesh, "front-to-back", samples)[1])
    return times


def ratios(times):
    """{name: values}, round by round."""
    front = times[("front-to-back", MESHES[1])]
    found = {"bvh / front-to-back, 62,975 triangles": [b / f for b, f in zip(times[("bvh", MESHES[1])], front)],
             "front-to-back, 62,975 / 15,743 triangles": [b / a for a, b in zip(times[("front-to-back", MESHES[0])], front)]}
    if ("iterative", MESHES[1]) in times:
        found["iterative / front-to-back, 62,975 triangles"] = [times[("iterative", MESHES[1])][0] / f for f in front]
    return found


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program", type=Path)
    parser.add_argument("scenes", type=Path)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--no-iterative", action="store_true")
    options = parser.parse_args()
    times = measure(options.program.resolve(), options.scenes, options.rounds, options.spp, not options.no_iterative)
    print("median frame time, ms (500 x 500, one sample; pictures of all traversals agree)")
    for (traversal, mesh), values in times.items():
        print(f"  {traversal:14s} {mesh:11s} {statistics.median(values):12.2f}  ({min(values):.2f} to {max(values):.2f})")
    print("ratios (median, least to largest)")
    for name, values in ratios(times).items():
        print(f"{name:58s} {statistics.median(values):8.2f}  ({min(values):.2f} to {max(values):.2f})")
    if not options.no_iterative:
        tests = [count * 500 * 500 / times[("iterative", mesh)][0] / 1000 for mesh, count in zip(MESHES, (15743, 62975))]
        print(f"iterative: {tests[1]:.0f} million triangle tests a second at 62,975 triangles, {tests[0]:.0f} at 15,743")


if __name__ == "__main__":
    main()

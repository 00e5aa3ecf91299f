#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Times how long scenes take to load, and what memory that takes.

usage: load.py FRAGTRACE SCENE... [--rounds N] [--grid INSTANCES,TRIANGLES]
Each round draws one sample of 16 x 16 pixels of each scene in turn, in a process of its own. Prints medians (least to largest), and the peak of the
process and those it started. --grid adds a scene of that many instances (EXT_mesh_gpu_instancing) of one sphere of about so many triangles.
"""
import argparse
import json
import os
import statistics
import struct
import subprocess
import tempfile
from math import cos, pi, sin
from pathlib import Path

STEPS = (("load", "load_ms"), ("tree", "bvh_build_ms"), ("pack", "pack_ms"), ("upload", "upload_ms"))


def sphere(triangles):
    """Positions and indices of a sphere of that many triangles or a few more."""
    rings = max(3, round((triangles / 4) ** 0.5))
    columns = 2 * rings
    points = [(sin(pi * j / rings) * cos(2 * pi * i / columns), cos(pi * j / rings), sin(pi * j / rings) * sin(2 * pi * i / columns))
              for j in range(rings + 1) for i in range(columns)]
    indices = []
    for j in range(rings):
        for i in range(columns):
            a, b = j * columns + i, j * columns + (i + 1) % columns
            indices += (a, b, a + columns) if j > 0 else ()
            indices += (b, b + columns, a + columns) if j < rings - 1 else ()
    return points, indices


def instanced_grid(path, instances, triangles):
    """A cube of spheres, each scaled to a third of its cell."""
    points, indices = sphere(triangles)
    side = max(1, round(instances ** (1 / 3) + 0.5))
    places = [(i % side, i // side % side, i // side ** 2) for i in range(instances)]
    parts = [b"".join(struct.pack("<3f", *p) for p in points), struct.pack(f"<{len(indices)}I", *indices),
             b"".join(struct.pack("<3f", *p) for p in places), struct.pack("<3f", 1 / 3, 1 / 3, 1 / 3) * instances]
    views, offset = [], 0
    for part in parts:
        views.append({"buffer": 0, "byteOffset": offset, "byteLength": len(part)})
        offset += len(part)
    accessor = lambda view, kind, count, **more: {"bufferView": view, "componentType": 5125 if kind == "SCALAR" else 5126,
                                                  "count": count, "type": kind, **more}
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "extensionsUsed": ["EXT_mesh_gpu_instancing"], "extensionsRequired": ["EXT_mesh_gpu_instancing"],
        "nodes": [{"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 2, "SCALE": 3}}}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [accessor(0, "VEC3", len(points), min=[-1, -1, -1], max=[1, 1, 1]), accessor(1, "SCALAR", len(indices)),
                      accessor(2, "VEC3", instances), accessor(3, "VEC3", instances)],
        "bufferViews": views, "buffers": [{"byteLength": offset, "uri": path.stem + ".bin"}]}
    path.with_suffix(".bin").write_bytes(b"".join(parts))
    path.write_text(json.dumps(document))


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
    parser.add_argument("--grid", type=lambda text: tuple(map(int, text.split(","))))
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        scenes = list(options.scenes)
        if options.grid:
            scenes.append(folder / "grid.gltf")
            instanced_grid(scenes[-1], *options.grid)
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
        print(f"{scene.stem:34s}{runs[0][0]['scene']['triangles']:12,d}{cells}{statistics.median(peak for _, peak in runs):10.0f}")


if __name__ == "__main__":
    main()

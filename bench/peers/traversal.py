#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Traversal alone against Embree 3 on the same rays of the same scene, in turn on the same cores.

Usage: traversal.py FRAGTRACE SCENE [--rounds N] [--resolution W,H]. Needs a C++ compiler and libembree-dev (Debian 12). Says rays a
second of each kind, their ratio turn by turn, and on how many rays the two differ; status 1 where that is more than 1 in 1000.
"""
import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path


def compiled(folder):
    source, program = Path(__file__).with_name("embree_rays.cpp"), folder / "embree_rays"
    command = ["g++", "-std=c++20", "-O3", "-march=native", str(source), "-o", str(program), "-lembree3", "-lpthread"]
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode != 0:
        sys.exit(f"traversal.py: cannot compile {source.name}; is libembree-dev installed?\n{result.stderr}")
    return program


def lines_of(command):
    result = subprocess.run(list(map(str, command)), capture_output=True, text=True, env={**os.environ, "MESA_SHADER_CACHE_DISABLE": "true"})
    if result.returncode != 0:
        sys.exit(f"traversal.py: {command[0]} gives {result.returncode}: {result.stderr}")
    return result.stdout


def measure(fragtrace, scene, rounds, resolution="1024,1024"):
    """Returns (our row, Embree's row) of each turn, by kind of rays."""
    turns = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        embree, rays, ours = compiled(folder), folder / "rays", folder / "ours.json"
        bench = [fragtrace, "bench", "traversal", scene, "--quiet", "--resolution", resolution, "--json", ours]
        lines_of([*bench, "--rounds", 1, "--rays", rays])
        for _ in range(rounds):
            lines_of([*bench, "--rounds", 3])
            mine = {row["kind"]: row for row in map(json.loads, ours.read_text().splitlines())}
            theirs = {row["kind"]: row for row in map(json.loads, lines_of([embree, rays, 3]).splitlines())}
            for kind, row in mine.items():
                turns.setdefault(kind, []).append((row, theirs[kind]))
    return turns


def figures_of(pairs):
    """Returns, for one kind of rays, the milliseconds of both sides turn by turn, the number of rays, and the number
    that differ."""
    return [(statistics.median(a["ms"]), statistics.median(b["ms"])) for a, b in pairs], pairs[0][0]["rays"], pairs[0][1]["differing"]


def is_wrong(count, differing):
    return differing * 1000 > count


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("fragtrace", type=Path)
    parser.add_argument("scene", type=Path)
    parser.add_argument("--rounds", type=int, default=5, help="turns of each")
    parser.add_argument("--resolution", default="1024,1024")
    options = parser.parse_args()
    turns = measure(options.fragtrace, options.scene, options.rounds, options.resolution)
    first = turns["primary"][0][0]
    print(f"{options.scene.name}, {first['triangles']} triangles, {first['gl_renderer']}")
    print(f"{'rays':10}{'number':>10}{'fragtrace':>12}{'Embree':>12}{'ratio':>8}  {'least to largest':18}{'differing':>10}")
    status = 0
    for kind, pairs in turns.items():
        medians, count, differing = figures_of(pairs)
        ratios = sorted(b / a for a, b in medians)
        a, b = (count / statistics.median(side) / 1000 for side in zip(*medians))
        print(f"{kind:10}{count:10}{a:7.2f} M/s  {b:7.2f} M/s  {statistics.median(ratios):6.2f}  "
              f"{ratios[0]:.2f} to {ratios[-1]:.2f}{differing:19}")
        status = status or int(is_wrong(count, differing))
    return status


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Speed, compilation and pictures of several drivers, or settings of one, in turn.

usage: drivers.py [--rounds N] [--spp N] [--resolution W,H] [--options "..."] [--folder DIR] SCENE... -- NAME=COMMAND NAME=COMMAND...
A COMMAND is what comes before `render`: build/fragtrace, "env NAME=VALUE build/fragtrace", or a program in a chroot that sees scenes and DIR by the same
paths. Rounds draw each scene by each command once. The table has medians, the ratio of million paths per second to that of the first command (median,
least and greatest of the rounds), and how the pictures differ from that of the first. No shader is taken from a cache.
"""
import argparse
import json
import os
import shlex
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent / "peers"))
from pictures import read_pfm  # noqa: E402


def difference(picture, first):
    """'same bits', or the share of values that differ and the largest difference over the mean."""
    apart = [abs(a - b) for a, b in zip(picture, first) if a != b]
    if not apart:
        return "same bits"
    return f"{100 * len(apart) / len(first):.2g} % of values, by {max(apart) / statistics.fmean(first):.1g} of the mean at most"


def draw(command, scene, options, folder):
    """Returns million paths per second, milliseconds of compilation, the picture and the driver."""
    picture, stats = folder / "picture.pfm", folder / "stats.json"
    subprocess.run([*shlex.split(command), "render", scene, *options, "--quiet", "-o", picture, "--stats", stats], check=True,
                   env={**os.environ, "MESA_SHADER_CACHE_DISABLE": "true"})
    told = json.loads(stats.read_text())
    return told["mpaths_per_s"], told["compile_ms"], read_pfm(picture)[1], f"{told['gl_renderer']}, {told['gl_version']}"


def main():
    parser = argparse.ArgumentParser(usage=__doc__.splitlines()[2].removeprefix("usage: "))
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--spp", default="16")
    parser.add_argument("--resolution", default="256,256")
    parser.add_argument("--options", default="")
    parser.add_argument("--folder", type=Path)
    parser.add_argument("scenes", type=Path, nargs="+")
    if "--" not in sys.argv:
        parser.error("no -- before the commands")
    split = sys.argv.index("--")
    options = parser.parse_args(sys.argv[1:split])
    commands = dict(word.split("=", 1) for word in sys.argv[split + 1:])
    given = ["--resolution", options.resolution, "--spp", options.spp, *shlex.split(options.options)]
    folder = options.folder or Path(tempfile.mkdtemp())
    drivers = {}
    print("| scene | driver | Mpaths/s | to the first | compiled, ms | picture |\n| --- | --- | --- | --- | --- | --- |")
    for scene in options.scenes:
        rows = {name: [] for name in commands}
        for _ in range(options.rounds):
            for name, command in commands.items():
                *row, drivers[name] = draw(command, scene, given, folder)
                rows[name].append(row)
        first = next(iter(rows.values()))
        for name, own in rows.items():
            ratios = [a[0] / b[0] for a, b in zip(own, first)]
            print(f"| {scene.stem} | {name} | {statistics.median(r[0] for r in own):.3g} | {statistics.median(ratios):.2f} ({min(ratios):.2f} to "
                  f"{max(ratios):.2f}) | {statistics.median(r[1] for r in own):.0f} | {difference(own[0][2], first[0][2])} |", flush=True)
    for name, driver in drivers.items():
        print(f"\n{name}: {driver}")


if __name__ == "__main__":
    main()

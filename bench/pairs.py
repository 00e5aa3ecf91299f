#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Tells whether a program draws scenes slower than an older one: CPU seconds of whole renders, in turn, with intervals.

usage: pairs.py BEFORE NOW [SCENE...] [--hdri-file FILE] [--pairs N] [--resolution W,H] [--spp N] [--jobs N] [--json FILE] [--options "..."]
Each pair is one render by either program, start and compilation included. The table says now / before as the mean of the paired ratios (of their
logarithms) and its 95 % interval by Student's t. Slower means that the interval lies above 1.02; then the status is 1. A job is a scene, kept on a processor
of its own. Without scenes, it draws the ten settings of settings.py.
"""
import argparse
import concurrent.futures
import json
import math
import os
import queue
import shlex
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from settings import SCENES, SETTINGS

LEVEL = 1.02
STUDENT = {2: 12.71, 3: 4.303, 4: 3.182, 5: 2.776, 6: 2.571, 7: 2.447, 8: 2.365, 9: 2.306, 10: 2.262, 11: 2.228, 12: 2.201}


def arguments():
    parser = argparse.ArgumentParser(description="now / before, CPU seconds of renders in turn")
    parser.add_argument("before", type=Path, help="an older fragtrace")
    parser.add_argument("now", type=Path, help="build/fragtrace")
    parser.add_argument("scenes", type=Path, nargs="*", help="by default the ten settings of settings.py")
    parser.add_argument("--hdri-file", type=Path, help="an environment round all of them")
    parser.add_argument("--pairs", type=int, default=12, help="2 to 12 (default: 12)")
    parser.add_argument("--resolution", default="256,256")
    parser.add_argument("--spp", default="16")
    parser.add_argument("--jobs", type=int, default=1, help="scenes at a time")
    parser.add_argument("--json", type=Path, help="CPU seconds of each render")
    parser.add_argument("--options", default="", help="more options of render, in quotes")
    options = parser.parse_args()
    for path in (options.before, options.now, *options.scenes, *filter(None, [options.hdri_file])):
        if not path.is_file():
            parser.error(f"no file {path}")
    if options.pairs not in STUDENT:
        parser.error("--pairs: 2 to 12")
    given = {str(path): (path, ()) for path in options.scenes}
    options.settings = given or {name: (SCENES / f"{scene}.gltf", own) for name, (scene, own) in SETTINGS.items()}
    return options


def cpu_seconds(program, setting, options, processor, folder):
    """Returns the CPU seconds of the process and of those that it waits for."""
    scene, own = setting
    command = [program.resolve(), "render", scene, *own, "--resolution", options.resolution, "--spp", options.spp, "--quiet",
               "-o", folder / f"{processor}.pfm", *shlex.split(options.options)]
    command += ["--hdri-file", options.hdri_file] if options.hdri_file else []
    process = subprocess.Popen(command, env={**os.environ, "MESA_SHADER_CACHE_DISABLE": "true"},
                               preexec_fn=lambda: os.sched_setaffinity(0, {processor}))
    _, status, used = os.wait4(process.pid, 0)
    if status != 0:
        raise RuntimeError(f"{program} could not draw {scene}")
    return used.ru_utime + used.ru_stime


def interval(ratios):
    """Mean of the logarithms, and its 95 % interval, as ratios."""
    logs = [math.log(r) for r in ratios]
    middle = statistics.fmean(logs)
    half = STUDENT[len(logs)] * statistics.stdev(logs) / math.sqrt(len(logs))
    return tuple(math.exp(middle + side * half) for side in (0, -1, 1))


def main():
    options = arguments()
    processors = queue.Queue()
    for processor in sorted(os.sched_getaffinity(0))[:options.jobs]:
        processors.put(processor)
    found, slower = {}, []
    with tempfile.TemporaryDirectory() as folder:
        def pairs(setting):
            processor = processors.get()
            try:
                return [[cpu_seconds(program, setting, options, processor, Path(folder)) for program in (options.before, options.now)]
                        for _ in range(options.pairs)]
            finally:
                processors.put(processor)

        print("| scene | now / before | 95 % | before, CPU s | |\n| --- | --- | --- | --- | --- |", flush=True)
        with concurrent.futures.ThreadPoolExecutor(processors.qsize()) as pool:
            for name, seconds in zip(options.settings, pool.map(pairs, options.settings.values())):
                middle, low, high = interval([now / before for before, now in seconds])
                found[name] = seconds
                slower += [Path(name).stem] if low > LEVEL else []
                print(f"| {Path(name).stem} | {middle:.3f} | {low:.3f} to {high:.3f} | {statistics.median(before for before, _ in seconds):.2f} | "
                      f"{'SLOWER' if low > LEVEL else 'not slower' if high <= LEVEL else 'not told'} |", flush=True)
    if options.json:
        options.json.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    if slower:
        sys.exit(f"pairs.py: slower: {', '.join(slower)}")


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit(130)
    except RuntimeError as error:
        sys.exit(f"pairs.py: {error}")

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Tells whether something got slower on this machine: ten settings, each timed by `bench frame` against a file of before.

usage: settings.py FRAGTRACE BASELINE [--rounds N] [--tolerance PART] [--only NAME,...] [--renew]
BASELINE is made where there is none, and by --renew; keep it with the machine, since it holds milliseconds. Status 1: a setting takes longer
than before by more than the tolerance, or its picture is wrong. Run it on a quiet machine; scripts/test --extended does.
"""
import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

SCENES = Path(__file__).resolve().parents[1] / "scenes"
SKY = ("--hdri-file", SCENES / "sky.pfm")
TREE = ("--traversal", "front-to-back")
SETTINGS = {
    "mesh-flat": ("mesh-62975", ("--stage", "flat", "--default-light", "white")),
    "mesh-bvh": ("mesh-62975", ("--stage", "flat", "--traversal", "bvh", "--default-light", "white")),
    "mirror-reflections": ("sphere-plane-mirror", ("--stage", "reflections")),
    "box-literals": ("cornell-box", ("--traversal", "literals")),
    "box-tree": ("cornell-box", (*TREE, "--schedule", "megakernel")),
    "ball-wavefront": ("room-ball", ("--schedule", "wavefront")),
    "ball-megakernel": ("room-ball", ("--schedule", "megakernel")),
    "many-lights": ("many-lights", TREE),
    "textures-under-sky": ("mapped-layers", (*SKY, *TREE)),
    "alpha": ("coverage", TREE),
}


def arguments():
    parser = argparse.ArgumentParser(description="ten settings against a file of before")
    parser.add_argument("program", type=Path, help="build/fragtrace")
    parser.add_argument("baseline", type=Path, help="file of before; made where there is none")
    parser.add_argument("--rounds", type=int, default=7, help="of bench frame (default: 7)")
    parser.add_argument("--tolerance", type=float, default=0.25, help="part by which a setting may be slower (default: 0.25)")
    parser.add_argument("--only", default=",".join(SETTINGS), help="of " + ", ".join(SETTINGS))
    parser.add_argument("--renew", action="store_true", help="make the file anew")
    options = parser.parse_args()
    options.only = options.only.split(",")
    for name in options.only:
        if name not in SETTINGS:
            parser.error(f"--only: no setting {name}")
    if not options.program.is_file():
        parser.error(f"no program {options.program}; scripts/build makes it")
    return options


def timed(options, name, json, against):
    """Runs bench frame and returns its status."""
    scene, own = SETTINGS[name]
    print(f"\n{name}", flush=True)
    command = [options.program.resolve(), "bench", "frame", SCENES / f"{scene}.gltf", "--resolution", "256,256", "--rounds", str(options.rounds),
               "--quiet", "--json", json, *own]
    if against:
        command += ["--baseline", against, "--tolerance", str(options.tolerance)]
    return subprocess.run(command, check=False, env={**os.environ, "MESA_SHADER_CACHE_DISABLE": "true"}).returncode


def main():
    options = arguments()
    against = None if options.renew or not options.baseline.exists() else options.baseline.resolve()
    lines, failed = "", []
    with tempfile.TemporaryDirectory() as folder:
        json = Path(folder) / "frames.json"
        for name in options.only:
            status = timed(options, name, json, against)
            if status not in (0, 1):
                sys.exit(f"settings.py: {name}: bench frame ended with status {status}; where {options.baseline} lacks it, --renew makes it anew")
            failed += [name] if status else []
            lines += json.read_text(encoding="utf-8")
    if failed:
        sys.exit(f"settings.py: slower or wrong: {', '.join(failed)}")
    if not against:
        options.baseline.parent.mkdir(parents=True, exist_ok=True)
        new = options.baseline.with_suffix(".new")
        new.write_text(lines, encoding="utf-8")
        new.replace(options.baseline)
        print(f"\n{options.baseline} is made: later runs compare with it.")


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit(130)

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes the charts and tables of docs/measurements/accuracy.md: error against time in seven scenes.

usage: error_charts.py FRAGTRACE ASSETS_FOLDER OUTPUT_FOLDER [NAME ...]
Run on a quiet machine, from the repository's root. Writes OUTPUT/error-NAME.svg and .json, prints the tables.
"""
import os
import subprocess
import sys
from pathlib import Path

import charts

BOOM_BOX = ["{assets}/scenes/BoomBoxWithAxes/BoomBoxWithAxes.gltf", "--camera-orbit", "0,0", "--hdri-file", "{assets}/env/lightroom_14b.hdr"]
RUNS = {
    "cornell-box": ["scenes/cornell-box.gltf", "--reference", "tests/reference/cornell-box.gi.exr", "--spp", "1024",
                    "--configs", "default,random,bsdf,baseline,adaptive,light-candidates,light-spatial"],
    "rough-glass": ["scenes/rough-glass.gltf", "--hdri-file", "scenes/sky.pfm", "--spp", "256",
                    "--configs", "default,random,bsdf,schlick,adaptive,no-compensation"],
    "boom-box": [*BOOM_BOX, "--spp", "256", "--configs", "default,random,bsdf,no-compensation,adaptive"],
    "many-lights": ["scenes/many-lights.gltf", "--spp", "256",
                    "--configs", "default,random,bsdf,no-compensation,adaptive,power-lights,light-candidates,light-spatial"],
    "corridor": ["scenes/corridor.gltf", "--spp", "64", "--configs", "default,power-lights,light-candidates,light-spatial"],
    "city": ["scenes/city.gltf", "--spp", "256", "--configs", "default,power-lights,light-candidates,light-spatial"],
    "caustic-ground": ["scenes/caustic-ground.gltf", "--spp", "128", "--configs", "default,no-caustics"],
}


def main():
    program, assets, folder = Path(sys.argv[1]).resolve(), sys.argv[2], Path(sys.argv[3])
    names = sys.argv[4:] or list(RUNS)
    folder.mkdir(parents=True, exist_ok=True)
    for name in names:
        arguments = [a.replace("{assets}", assets) for a in RUNS[name]]
        result = folder / f"error-{name}.json"
        subprocess.run([program, "bench", "error", *arguments, "--resolution", "64,64", "--repetitions", "3", "--quiet", "--json", result],
                       check=True, env={**os.environ, "MESA_SHADER_CACHE_DISABLE": "true"})
        charts.draw(result, result.with_suffix(".svg"))
        print(flush=True)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Renders the shots of a goldens folder (scenarios.json) and prints PSNR against Cycles, next to what other engines get.

usage: goldens.py ASSETS_FOLDER OUTPUT_FOLDER [NAME ...] [--spp N]
Needs numpy and Pillow. Draws each shot by bench/fidelity, as Khronos' generator would, and reduces it to the size of the engines' thumbnails. Writes
OUTPUT/NAME.png: ours, then Cycles', then the difference times 4; OUTPUT/NAME.ours.png is the whole picture.
"""
import argparse
import json
import math
import subprocess
from pathlib import Path

import numpy as np
from PIL import Image

FIDELITY = Path(__file__).resolve().parent / "fidelity"


def render(shot, assets, folder, spp):
    """Draws a shot as Khronos' generator would. Returns the path of the picture."""
    path = folder / (shot["name"] + ".ours.png")
    scenario = {"model": str(assets / shot["model"]), "lighting": str(assets / shot["env"]), "dimensions": {"width": shot["w"], "height": shot["h"]},
                "target": dict(zip("xyz", shot["target"])), "orbit": {name: shot[name] for name in ("theta", "phi", "radius")},
                "verticalFoV": shot["vfov"], "renderSkybox": shot["skybox"]}
    subprocess.run([FIDELITY, "--spp", str(spp), json.dumps({"scenario": scenario, "outputFile": str(path)})], check=True)
    return path


def reduced(path, size, curve=lambda values: values):
    """Returns a picture at this size, over black, after this curve."""
    image = Image.open(path).convert("RGBA").resize(size, Image.LANCZOS)
    pixels = np.asarray(image).astype(float) / 255
    return curve(pixels[..., :3]) * pixels[..., 3:]


def psnr(a, b):
    return 10 * math.log10(1 / np.mean((a - b) ** 2))


def srgb(values):
    """Returns values with the sRGB curve instead of gamma 2.2."""
    linear = values ** 2.2
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("assets", type=Path)
    parser.add_argument("folder", type=Path)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--spp", type=int, default=64)
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    shots = json.loads((options.assets / "goldens/scenarios.json").read_text())["scenarios"]
    engines = ["blender-cycles", "three-gpu-pathtracer", "stellar", "vray"]
    print("PSNR in dB. Against Cycles: ours, and what the other engines get; then ours against each of them")
    print(f"{'shot':32s}{'ours':>7s}{'three':>7s}{'stellar':>8s}{'vray':>7s}  |{'three':>7s}{'stellar':>8s}{'vray':>7s}")
    against_cycles = []
    for shot in shots:
        if options.names and shot["name"].removeprefix("khronos-") not in options.names:
            continue
        path = render(shot, options.assets.resolve(), options.folder.resolve(), options.spp)
        size = Image.open(options.assets / shot["images"]["blender-cycles"]).size
        pictures = {e: reduced(options.assets / p, size) for e, p in shot["images"].items()}
        ours, other = reduced(path, size), reduced(path, size, srgb)
        # three.js has the sRGB curve; the other engines' scripts use gamma 2.2.
        mine = {e: other if e.startswith("three") else ours for e in pictures}
        cycles = pictures["blender-cycles"]
        row = [psnr(mine["blender-cycles"], cycles)]
        row += [psnr(pictures[e], cycles) if e in pictures else math.nan for e in engines[1:]]
        row += [psnr(mine[e], pictures[e]) if e in pictures else math.nan for e in engines[1:]]
        cells = ["      -" if math.isnan(x) else f"{x:7.2f}" for x in row]
        print(f"{shot['name']:32s}{cells[0]}{cells[1]} {cells[2]}{cells[3]}  |{cells[4]} {cells[5]}{cells[6]}", flush=True)
        against_cycles.append(row[0])
        sheet = np.concatenate([mine["blender-cycles"], cycles, np.clip(4 * np.abs(mine["blender-cycles"] - cycles), 0, 1)], 1)
        Image.fromarray((sheet * 255).astype(np.uint8)).save(options.folder / (shot["name"] + ".png"))
    print(f"median of ours against Cycles: {np.median(against_cycles):.2f} dB over {len(against_cycles)} shots")


if __name__ == "__main__":
    main()

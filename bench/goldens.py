#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Renders the shots of a goldens folder (scenarios.json) and prints PSNR against each engine's picture.

usage: goldens.py FRAGTRACE ASSETS_FOLDER OUTPUT_FOLDER [--spp N] [--width W] [NAME ...]
Needs numpy and Pillow. Writes OUTPUT/NAME.png: ours, then Cycles', then the difference times 4.
"""
import argparse
import json
import math
import subprocess
from pathlib import Path

import numpy as np
from PIL import Image


def read_pfm(path):
    _, size, _, body = Path(path).read_bytes().split(b"\n", 3)
    width, height = map(int, size.split())
    return np.frombuffer(body, "<f4").reshape(height, width, 3)[::-1].astype(float)


def tone_map(color, gamma):
    """ACES as fitted by Stephen Hill, exposure 1 / 0.6, then the engine's display curve (the goldens' README)."""
    to_aces = np.array([[0.59719, 0.35458, 0.04823], [0.07600, 0.90834, 0.01566], [0.02840, 0.13383, 0.83777]])
    from_aces = np.array([[1.60475, -0.53108, -0.07367], [-0.10208, 1.10813, -0.00605], [-0.00327, -0.07276, 1.07602]])
    v = color / 0.6 @ to_aces.T
    v = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081)
    v = np.clip(v @ from_aces.T, 0, 1)
    if gamma:
        return v ** (1 / 2.2)
    return np.where(v <= 0.0031308, 12.92 * v, 1.055 * np.maximum(v, 1e-9) ** (1 / 2.4) - 0.055)


def camera_options(shot):
    theta, phi, radius = math.radians(shot["theta"]), math.radians(shot["phi"]), shot["radius"]
    target = shot["target"]
    offset = (math.sin(phi) * math.sin(theta), math.cos(phi), math.sin(phi) * math.cos(theta))
    position = [t + radius * o for t, o in zip(target, offset)]
    text = lambda v: ",".join(repr(float(x)) for x in v)
    return ["--camera-position", text(position), "--camera-focal-point", text(target), "--camera-view-up", "0,1,0",
            "--camera-view-angle", str(shot["vfov"])]


def render(program, assets, shot, folder, width, spp):
    height = round(width * shot["h"] / shot["w"])
    path = folder / (shot["name"] + ".pfm")
    command = [program, "render", assets / shot["model"], "-o", path, "--hdri-file", assets / shot["env"],
               "--resolution", f"{width},{height}", "--spp", str(spp), "--quiet", *camera_options(shot)]
    if not shot["skybox"]:
        command.append("--no-background")
    subprocess.run(list(map(str, command)), check=True)
    return read_pfm(path)


def golden(path, size):
    image = Image.open(path).convert("RGBA").resize(size, Image.LANCZOS)
    pixels = np.asarray(image).astype(float) / 255
    return pixels[..., :3] * pixels[..., 3:]


def psnr(a, b):
    return 10 * math.log10(1 / np.mean((a - b) ** 2))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program", type=Path)
    parser.add_argument("assets", type=Path)
    parser.add_argument("folder", type=Path)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--width", type=int, default=512)
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    shots = json.loads((options.assets / "goldens/scenarios.json").read_text())["scenarios"]
    engines = ["blender-cycles", "three-gpu-pathtracer", "stellar", "vray"]
    print(f"{'shot':34s}" + "".join(f"{e:>22s}" for e in engines) + f"{'three vs Cycles':>18s}")
    against_cycles = []
    for shot in shots:
        if options.names and shot["name"].removeprefix("khronos-") not in options.names:
            continue
        linear = render(options.program.resolve(), options.assets.resolve(), shot, options.folder, options.width, options.spp)
        size = (linear.shape[1], linear.shape[0])
        pictures = {e: golden(options.assets / p, size) for e, p in shot["images"].items()}
        ours = {e: psnr(tone_map(linear, e == "blender-cycles"), pictures[e]) for e in pictures}
        row = "".join(f"{ours[e]:22.2f}" if e in ours else f"{'-':>22s}" for e in engines)
        other = psnr(pictures["three-gpu-pathtracer"], pictures["blender-cycles"]) if len(
            {"three-gpu-pathtracer", "blender-cycles"} & set(pictures)) == 2 else float("nan")
        print(f"{shot['name']:34s}{row}{other:18.2f}", flush=True)
        if "blender-cycles" in ours:
            against_cycles.append(ours["blender-cycles"])
            mine, theirs = tone_map(linear, True), pictures["blender-cycles"]
            sheet = np.concatenate([mine, theirs, np.clip(4 * np.abs(mine - theirs), 0, 1)], 1)
            Image.fromarray((sheet * 255).astype(np.uint8)).save(options.folder / (shot["name"] + ".png"))
    print(f"median against Cycles: {np.median(against_cycles):.2f} dB over {len(against_cycles)} shots")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Renders the shots of a goldens folder (scenarios.json) and prints PSNR against Cycles, beside what other engines get.

usage: goldens.py FRAGTRACE ASSETS_FOLDER OUTPUT_FOLDER [NAME ...] [--spp N] [--width W]
Needs numpy and Pillow. Writes OUTPUT/NAME.png: ours, then Cycles', then the difference times 4.
"""
import argparse
import json
import math
import struct
import subprocess
import zlib
from pathlib import Path

import numpy as np
from PIL import Image


def unzipped(data, size):
    """The bytes of a block, which are stored as differences, the even ones before the odd ones."""
    if len(data) == size:
        return data
    deltas = np.frombuffer(zlib.decompress(data), np.uint8).astype(np.int64)
    deltas[1:] -= 128
    bytes_ = np.cumsum(deltas).astype(np.uint8)
    half = (size + 1) // 2
    result = np.empty(size, np.uint8)
    result[0::2], result[1::2] = bytes_[:half], bytes_[half:]
    return result.tobytes()


def read_exr(path):
    """Rows from the top, red, green, blue and alpha (1 where the file has none), of 32-bit floats in ZIP blocks (openexr.com, "OpenEXR File Layout")."""
    data, at, header = Path(path).read_bytes(), 8, {}
    while data[at]:
        name, kind, rest = data[at:].split(b"\0", 2)
        at += len(name) + len(kind) + 2
        size = struct.unpack_from("<I", data, at)[0]
        header[name.decode()] = data[at + 4:at + 4 + size]
        at += 4 + size
    names = header["channels"]
    channels = []
    while names != b"\0":
        name, names = names.split(b"\0", 1)
        channels.append(name.decode())
        names = names[16:]
    left, top, right, bottom = struct.unpack("<4i", header["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    picture = np.ones((height, width, 4))
    for block in range(-(-height // 16)):
        place = struct.unpack_from("<Q", data, at + 1 + 8 * block)[0]
        y, size = struct.unpack_from("<iI", data, place)
        rows = min(16, height - (y - top))
        floats = np.frombuffer(unzipped(data[place + 8:place + 8 + size], 4 * width * len(channels) * rows), "<f4")
        for i, name in enumerate(channels):
            if name in "RGBA":
                picture[y - top:y - top + rows, :, "RGBA".index(name)] = floats.reshape(rows, len(channels), width)[:, i]
    return picture


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
    path = folder / (shot["name"] + ".exr")
    command = [program, "render", assets / shot["model"], "-o", path, "--hdri-file", assets / shot["env"],
               "--resolution", f"{width},{height}", "--spp", str(spp), "--quiet", *camera_options(shot)]
    if not shot["skybox"]:
        command.append("--no-background")
    subprocess.run(list(map(str, command)), check=True)
    return read_exr(path)


def golden(path, size):
    image = Image.open(path).convert("RGBA").resize(size, Image.LANCZOS)
    pixels = np.asarray(image).astype(float) / 255
    return pixels[..., :3] * pixels[..., 3:]


def psnr(a, b):
    return 10 * math.log10(1 / np.mean((a - b) ** 2))


def display(linear, gamma, size):
    """Tone-mapped at the engines' size and reduced to that of their thumbnails, as theirs were: the curve is applied to the colour of what covers a
    pixel, not to what is left of it over black."""
    alpha = linear[..., 3:]
    color = linear[..., :3] / np.maximum(alpha, 1e-6)
    picture = Image.fromarray((tone_map(color, gamma) * alpha * 255 + 0.5).astype(np.uint8))
    return np.asarray(picture.resize(size, Image.LANCZOS)).astype(float) / 255


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program", type=Path)
    parser.add_argument("assets", type=Path)
    parser.add_argument("folder", type=Path)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--width", type=int, default=768, help="the engines' own")
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
        linear = render(options.program.resolve(), options.assets.resolve(), shot, options.folder, options.width, options.spp)
        size = Image.open(options.assets / shot["images"]["blender-cycles"]).size
        pictures = {e: golden(options.assets / p, size) for e, p in shot["images"].items()}
        mine = {e: display(linear, e == "blender-cycles", size) for e in pictures}
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

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""before_after.py BEFORE NOW SHEET.jpg [--seconds N]: scenes as an older program draws them and as this one does, at equal time.

Each picture has as many samples per pixel as the program draws in the same seconds, compilation apart; a short render tells how long one takes. A row a
scene. Needs ImageMagick's `montage`, and a quiet machine. Prints the samples of each.
"""
import argparse
import json
import subprocess
import tempfile
from pathlib import Path

SCENES = ("corridor", "city", "many-lights", "vitrine", "caustics", "rough-glass")
TRIAL = 4  # samples per pixel


def main():
    parser = argparse.ArgumentParser(description="scenes by two programs at equal time")
    parser.add_argument("before", type=Path)
    parser.add_argument("now", type=Path)
    parser.add_argument("sheet", type=Path)
    parser.add_argument("--seconds", type=float, default=6)
    a = parser.parse_args()
    tiles = []
    with tempfile.TemporaryDirectory() as folder:
        def draw(program, scene, name, spp):
            """Returns the picture's path, and the milliseconds that drawing took."""
            picture, told = Path(folder) / f"{name}.png", Path(folder) / "stats.json"
            light = ["--hdri-file", "scenes/sky.pfm"] if scene == "rough-glass" else []
            subprocess.run([program.resolve(), "render", f"scenes/{scene}.gltf", "-o", picture, "--resolution", "400,300", "--spp", str(spp),
                            "--stats", told, "--quiet", *light], check=True)
            return picture, json.loads(told.read_text())["render_ms"]

        for scene in SCENES:
            for label, program in (("before", a.before), ("now", a.now)):
                _, milliseconds = draw(program, scene, "trial", TRIAL)
                spp = max(1, round(TRIAL * 1000 * a.seconds / milliseconds))
                picture, milliseconds = draw(program, scene, f"{scene}-{label}", spp)
                print(f"{scene}, {label}: {spp} samples per pixel, {milliseconds / 1000:.1f} s", flush=True)
                tiles += ["-label", f"{scene}, {label}: {spp} samples per pixel", picture]
        subprocess.run(["montage", *tiles, "-tile", "2x", "-geometry", "+4+4", "-quality", "90", a.sheet], check=True)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""denoise_sheet.py FRAGTRACE --assets FOLDER --environment FILE --output SHEET.jpg [--oidn-library FILE] [--only NAME,...]

Draws every scene of a folder under an environment at 4 and 16 samples per pixel, raw and by each filter, and a reference, and puts
them side by side: a row per scene, its columns raw, variance, oidn at 4 and at 16 samples, and the reference. Prints each picture's
relative MSE over that of the raw one. Needs ImageMagick's `montage`. The single pictures stay beside the sheet, in SHEET.d.
"""
import argparse
import subprocess
from pathlib import Path

FILTERS = ("none", "variance", "oidn")
SAMPLES = (4, 16)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("fragtrace", type=Path)
    parser.add_argument("--assets", type=Path, required=True)
    parser.add_argument("--environment", type=Path, required=True)
    parser.add_argument("--output", type=Path, required=True)
    parser.add_argument("--oidn-library", type=Path)
    parser.add_argument("--only", default="")
    parser.add_argument("--resolution", default="400,300")
    parser.add_argument("--reference-samples", default="512")
    a = parser.parse_args()
    folder = a.output.with_suffix(".d")
    folder.mkdir(parents=True, exist_ok=True)
    filters = [f for f in FILTERS if f != "oidn" or a.oidn_library]

    def render(scene, stem, *options):
        """Draws a scene as .exr, whose error is known, and as .png, to look at."""
        files = [folder / (stem + ending) for ending in (".exr", ".png")]
        for file in files:
            if not file.exists():
                subprocess.run([a.fragtrace, "render", scene, "--hdri-file", a.environment, "--resolution", a.resolution, "--quiet", *options, "-o", file],
                               check=True, stderr=subprocess.DEVNULL)
        return files

    def error(picture, reference):
        return float(subprocess.run([a.fragtrace, "diff", picture, reference, "--metric", "relmse"], check=True, capture_output=True, text=True).stdout)

    tiles = []
    for scene in sorted(a.assets.glob("*/*.gl[tb]*")):
        name = scene.stem
        if a.only and name not in a.only.split(","):
            continue
        reference, shown = render(scene, f"{name}-reference", "--spp", a.reference_samples, "--seed", "9")
        line = [name]
        for spp in SAMPLES:
            raw = None
            for kind in filters:
                options = ["--denoise", kind] + (["--oidn-library", a.oidn_library] if kind == "oidn" else [])
                picture, png = render(scene, f"{name}-{kind}-{spp}", "--spp", str(spp), *options)
                tiles += ["-label", f"{name}: {kind}, {spp}", png]
                found = error(picture, reference)
                raw = raw or found
                if kind != "none":
                    line.append(f"{kind} {spp}: {found / raw:.3f}" if raw > 0 else f"{kind} {spp}: -")
        tiles += ["-label", f"{name}: reference", shown]
        print("; ".join(line), flush=True)
    columns = len(SAMPLES) * len(filters) + 1
    subprocess.run(["montage", "-font", "DejaVu-Sans", "-pointsize", "11", *map(str, tiles), "-tile", f"{columns}x", "-geometry", "260x195+2+2", "-quality", "82", a.output], check=True)


if __name__ == "__main__":
    main()

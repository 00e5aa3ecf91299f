#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A sphere on a ground plane: our stages one by one beside Cycles, with the time and the error of each (docs/gallery.md).

usage: sphere_on_plane.py FRAGTRACE OUTPUT_FOLDER [--spp N] [--reference-spp N] [--resolution N] [--blender PROGRAM]
Writes OUTPUT/peers-STAGE.png and OUTPUT/peers-cycles.png, prints the table. Errors are those against Cycles' picture of
--reference-spp samples, by `fragtrace diff`. Needs Cycles (Debian: blender; or PyPI's bpy in --python).
"""

import argparse
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import engines
import pictures
from peer_scenes import geometry, GltfWriter, write_scene
from picture_files import encode_srgb, write_png

STAGES = ("flat", "phong", "shadows", "reflections", "gi")
COLOR, ROUGHNESS, GROUND = (0.75, 0.12, 0.08), 0.3, (0.55, 0.55, 0.5)
CAMERA = {"eye": (0, 2.2, 5.5), "target": (0, 0.7, 0), "fov_degrees": 42}
LAMP = {"name": "lamp", "intensity": 40, "color": (1, 0.9, 0.75), "position": (-3, 4, 2)}
SUN = {"name": "sun", "intensity": 0.9, "color": (0.7, 0.8, 1), "direction": (-1, -1.2, -0.6)}


def sphere_mesh(rows=128):
    """Cycles has no spheres: a fine mesh with smooth normals, about (0, 1, 0)."""
    ring = 2 * rows
    angles = [(math.pi * i / rows, 2 * math.pi * j / ring) for i in range(rows + 1) for j in range(ring)]
    positions = [(math.sin(a) * math.sin(b), 1 + math.cos(a), math.sin(a) * math.cos(b)) for a, b in angles]
    indices = []
    for i in range(rows):
        for j in range(ring):
            a, b = i * ring + j, i * ring + (j + 1) % ring
            indices += ([a, a + ring, b + ring] if i < rows - 1 else []) + ([a, b + ring, b] if i else [])
    return {"name": "sphere", "positions": positions, "indices": indices, "color": COLOR, "roughness": ROUGHNESS, "smooth": True}


def make_scene(folder):
    gltf, corners = GltfWriter(folder, "sphere-on-plane"), geometry.ground(6, 6)
    gltf.place_mesh("ground", gltf.primitive(corners, geometry.QUAD_INDICES, gltf.add_lambert("ground", GROUND)))
    gltf.add_sphere("sphere", 1.0, gltf.add_material("plastic", COLOR, roughness=ROUGHNESS), translation=[0, 1, 0])
    gltf.add_light("lamp", "point", LAMP["intensity"], LAMP["color"], eye=LAMP["position"])
    gltf.add_light("sun", "directional", SUN["intensity"], SUN["color"], direction=SUN["direction"])
    gltf.write()
    ground = {"name": "ground", "positions": corners, "indices": geometry.QUAD_INDICES, "color": GROUND}
    return write_scene(folder, {"kind": "sphere-on-plane", "gltf": str(folder / "sphere-on-plane.gltf"), "environment": None,
                                "camera": CAMERA, "meshes": [ground, sphere_mesh()], "lights": [LAMP, SUN]})


def neutral(color):
    """Khronos PBR Neutral, the tone curve of `render`."""
    low = min(color)
    offset = low - 6.25 * low * low if low < 0.08 else 0.04
    color = [c - offset for c in color]
    peak, start = max(color), 0.8 - 0.04
    if peak < start:
        return color
    top = 1 - (1 - start) ** 2 / (peak + 1 - 2 * start)
    white = 1 - 1 / (0.15 * (peak - top) + 1)
    return [c * top / peak * (1 - white) + top * white for c in color]


def write_display(pfm, png):
    width, values = pictures.read_pfm(pfm)
    height = len(values) // (3 * width)

    def texel(x, y):
        at = 3 * ((height - 1 - y) * width + x)
        return [encode_srgb(c) for c in neutral(values[at:at + 3])]

    write_png(png, width, height, texel)


def difference(program, picture, reference, metric):
    text = subprocess.run([program, "diff", picture, reference, "--metric", metric], check=True, capture_output=True, text=True).stdout
    return float(text.split()[-1])


def main():
    parser = argparse.ArgumentParser(description="our stages beside Cycles' picture of a sphere on a ground plane")
    parser.add_argument("program", type=Path)
    parser.add_argument("output", type=Path)
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--reference-spp", type=int, default=1024)
    parser.add_argument("--resolution", type=int, default=200)
    parser.add_argument("--python", default=sys.executable)
    parser.add_argument("--blender", default="blender")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    program = options.program.resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        scene = make_scene(folder)
        reference, cycles_noisy = folder / "reference.pfm", folder / "cycles.pfm"
        try:
            cycles = engines.cycles(options.python, options.blender, scene, options.resolution, "plain")
        except engines.Absent as error:
            sys.exit(f"sphere_on_plane.py: {error}")
        rows = [("Cycles", cycles_noisy, cycles.draw(options.spp, 1, cycles_noisy)["wall"])]
        cycles.draw(options.reference_spp, 2, reference)
        cycles.close()
        for stage in STAGES:
            ours = engines.Fragtrace(program, scene, options.resolution, True, ["--stage", stage])
            picture = folder / (stage + ".pfm")
            rows.insert(-1, (stage, picture, ours.draw(options.spp, 1, picture)["wall"]))
        converged = folder / "converged.pfm"
        seconds = ours.draw(options.reference_spp, 3, converged)["wall"]
        rows.append((f"gi, {options.reference_spp} samples", converged, seconds))
        print(f"{options.resolution} x {options.resolution}, {options.spp} samples; errors against {cycles.version}, {options.reference_spp} samples")
        print("| picture | seconds | relative MSE | FLIP |\n| --- | --- | --- | --- |")
        for label, picture, seconds in rows:
            errors = [difference(program, picture, reference, metric) for metric in ("relmse", "flip")]
            print(f"| {label} | {seconds:.3f} | {errors[0]:.2g} | {errors[1]:.3f} |")
            if picture is not converged:
                write_display(reference if label == "Cycles" else picture, options.output / f"peers-{label.lower()}.png")


if __name__ == "__main__":
    main()

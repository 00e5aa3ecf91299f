# SPDX-License-Identifier: MIT
"""Ten settings, each a scene and options of render, that pairs.py draws where no scenes are given."""
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

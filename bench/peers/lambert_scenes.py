# SPDX-License-Identifier: MIT
"""The scenes of samplers.py: matt surfaces alone, so that what differs between two programs is how they draw their samples."""

import json
import math
import shutil
from pathlib import Path

import peer_scenes
from peer_scenes import GREY
from gltf_writer import GltfWriter, rotation_towards, subtract

REPOSITORY = Path(__file__).resolve().parents[2]
FOV_DEGREES = 40


def flat_quad(folder):
    """One that fills the picture, so that a pixel sees neither an edge nor other light than the environment's."""
    gltf = GltfWriter(folder, "quad")
    corners = [(-9, 0, 9), (9, 0, 9), (9, 0, -9), (-9, 0, -9)]
    gltf.place_mesh("quad", gltf.primitive(corners, [0, 1, 2, 0, 2, 3], gltf.add_lambert("grey", GREY)))
    gltf.add_camera("camera", (0, 2, 2), (0, 0, 0), FOV_DEGREES)
    gltf.write()
    return folder / "quad.gltf"


def bounds(root):
    """Returns the bounds of the positions in the meshes' own spaces; the nodes of these assets turn and scale
    little."""
    boxes = [root["accessors"][p["attributes"]["POSITION"]] for m in root["meshes"] for p in m["primitives"]]
    return [[pick(box[end][k] for box in boxes) for k in range(3)] for end, pick in (("min", min), ("max", max))]


def as_lambert(folder, source, keep_emission):
    """Writes a copy of an asset with grey matt materials and flat faces, and a camera in front of it, somewhat
    above."""
    source = Path(source).resolve()
    root = json.loads(source.read_text(encoding="utf-8"))
    for file in root["buffers"] + (root["images"] if keep_emission else []):
        shutil.copy(source.parent / file["uri"], folder)
    for k, material in enumerate(root["materials"]):
        matt = {"name": f"matt-{k}", "pbrMetallicRoughness": {"baseColorFactor": [*GREY, 1], "metallicFactor": 0, "roughnessFactor": 1},
                "extensions": {"KHR_materials_specular": {"specularFactor": 0}}}
        glow = {key: material[key] for key in ("emissiveFactor", "emissiveTexture") if keep_emission and key in material}
        root["materials"][k] = {**matt, **glow, "doubleSided": not keep_emission}
    if not keep_emission:
        for table in ("textures", "images", "samplers"):
            root.pop(table, None)
    wanted = ("POSITION", "TEXCOORD_0") if keep_emission else ("POSITION",)
    for mesh in root["meshes"]:
        for primitive in mesh["primitives"]:
            primitive["attributes"] = {key: primitive["attributes"][key] for key in wanted if key in primitive["attributes"]}
    root["extensionsUsed"] = ["KHR_materials_specular"]
    low, high = bounds(root)
    middle, radius = [(a + b) / 2 for a, b in zip(low, high)], math.dist(low, high) / 2
    eye = [m + 2.4 * radius * d for m, d in zip(middle, (0.28, 0.32, 0.91))]
    root["cameras"] = [{"type": "perspective", "perspective": {"yfov": math.radians(FOV_DEGREES), "aspectRatio": 1, "znear": 1e-4}}]
    root["nodes"].append({"name": "camera", "camera": 0, "translation": eye, "rotation": rotation_towards(subtract(middle, eye))})
    root["scenes"][root.get("scene", 0)]["nodes"].append(len(root["nodes"]) - 1)
    path = folder / (source.stem + "-lambert.gltf")
    path.write_text(json.dumps(root), encoding="utf-8")
    return path


def with_backs(folder, source):
    """A copy whose lamps have black backs: ours are not there from behind, Mitsuba's are."""
    root = json.loads(source.read_text(encoding="utf-8"))
    for buffer in root["buffers"]:
        if not buffer["uri"].startswith("data:"):
            shutil.copy(source.parent / buffer["uri"], folder)
    black = {"name": "back", "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0, "roughnessFactor": 1},
             "extensions": {"KHR_materials_specular": {"specularFactor": 0}}}
    root["materials"].append(black)
    backs = []
    for mesh in root["meshes"]:
        for primitive in list(mesh["primitives"]):
            if "emissiveFactor" in root["materials"][primitive["material"]]:
                positions = primitive["attributes"]["POSITION"]
                backs.append({**primitive, "attributes": {"POSITION": positions}, "material": len(root["materials"]) - 1})
    # A node that mirrors along the one axis in which a lamp is flat turns its triangles round; the back stands 2 mm behind, towards the wall.
    for k, primitive in enumerate(backs):
        box = root["accessors"][primitive["attributes"]["POSITION"]]
        flat = [high - low < 1e-6 for low, high in zip(box["min"], box["max"])]
        axis = flat.index(True)
        root["meshes"].append({"primitives": [primitive]})
        scale, move = [1, 1, 1], [0, 0, 0]
        scale[axis], move[axis] = -1, 2 * box["min"][axis] + math.copysign(0.002, box["min"][axis])
        root["nodes"].append({"name": f"back-{k}", "mesh": len(root["meshes"]) - 1, "scale": scale, "translation": move})
        root["scenes"][root.get("scene", 0)]["nodes"].append(len(root["nodes"]) - 1)
    path = folder / source.name
    path.write_text(json.dumps(root), encoding="utf-8")
    return path


def pictures(folder, assets):
    """{name: (scene, environment or None)}; those that need `assets` are left out without it."""
    scenes = {name: (with_backs(folder, REPOSITORY / f"scenes/{name}.gltf"), None) for name in ("cornell-box", "many-lights")}
    if not assets:
        return scenes
    environments = {"lightroom": assets / "env/lightroom_14b.hdr", "sun": assets / "env/qwantani_afternoon_puresky_1k.hdr"}
    helmet = as_lambert(folder, assets / "scenes/FlightHelmet/FlightHelmet.gltf", False)
    ball = peer_scenes.write_gltf(folder, "ball", peer_scenes.ball_on_ground(), peer_scenes.OPEN_CAMERA)
    under_sky = {"quad": flat_quad(folder), "ball": ball, "helmet": helmet}
    for name, scene in under_sky.items():
        for sky, file in environments.items():
            scenes[f"{name}, {sky}"] = (scene, file)
    boom_box = as_lambert(folder, assets / "scenes/BoomBoxWithAxes/BoomBoxWithAxes.gltf", True)
    scenes["boom-box"] = (boom_box, environments["lightroom"])
    return scenes

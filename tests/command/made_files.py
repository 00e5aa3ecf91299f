# SPDX-License-Identifier: MIT
"""made_files.py FOLDER: writes small files, one a feature (NAME.gltf is valid) and one an error, each with its expectation next to it
(NAME.expected.json): whether the Khronos validator calls it valid, the exit status of `fragtrace info` and what it says on stderr."""
import base64
import copy
import json
import struct
import sys
from pathlib import Path

# Two triangles' corners, normals, texture coordinates, tangents, colours, indices, times, a turn about y; each 16-byte aligned.
POSITIONS = [0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0]
PARTS = {
    "position": ("12f", POSITIONS), "normal": ("12f", [0, 0, 1] * 4), "texcoord": ("8f", [0, 1, 1, 1, 0, 0, 1, 0]),
    "tangent": ("16f", [1, 0, 0, 1] * 4), "color": ("16f", [1, 0.5, 0.25, 1] * 4), "index": ("6H", [0, 1, 2, 2, 1, 3]),
    "time": ("2f", [0, 1]), "turn": ("8f", [0, 0, 0, 1, 0, 1, 0, 0]), "joints": ("16B", [0] * 16), "weights": ("16f", [1, 0, 0, 0] * 4),
    "sparse": ("1H", [3]), "moved": ("3f", [2, 2, 0]),
}
TYPES = {"position": (5126, "VEC3", 4), "normal": (5126, "VEC3", 4), "texcoord": (5126, "VEC2", 4), "tangent": (5126, "VEC4", 4),
         "color": (5126, "VEC4", 4), "index": (5123, "SCALAR", 6), "time": (5126, "SCALAR", 2), "turn": (5126, "VEC4", 2),
         "joints": (5121, "VEC4", 4), "weights": (5126, "VEC4", 4)}
PIXEL = "data:image/png;base64," + ("iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8BQDwAEhQGAhKmMIQAAAABJRU5ErkJggg==")


def base(*names):
    """Makes a quadrilateral of positions, indices and the named attributes, with a material and a camera."""
    data, views, accessors, where = b"", [], [], {}
    for name in ("position", "index", *names):
        layout, values = PARTS[name]
        data += b"\0" * (-len(data) % 16)
        packed = struct.pack("<" + layout, *values)
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(packed)})
        data += packed
        if name in TYPES:
            component, kind, count = TYPES[name]
            where[name] = len(accessors)
            accessors.append({"bufferView": len(views) - 1, "componentType": component, "type": kind, "count": count})
        else:
            where[name] = len(views) - 1
    accessors[0].update(min=[0, 0, 0], max=[1, 1, 0])
    if "time" in where:
        accessors[where["time"]].update(min=[0], max=[1])
    root = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.25, 1]}}],
        "accessors": accessors, "bufferViews": views,
        "buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}],
    }
    attributes = {"normal": "NORMAL", "texcoord": "TEXCOORD_0", "tangent": "TANGENT", "color": "COLOR_0", "joints": "JOINTS_0",
                  "weights": "WEIGHTS_0"}
    for name in names:
        if name in attributes:
            root["meshes"][0]["primitives"][0]["attributes"][attributes[name]] = where[name]
    return root, where


def put(root, pointer, value):
    """Sets the value at a JSON pointer; None takes it away."""
    *path, last = pointer.strip("/").split("/")
    for step in path:
        root = root[int(step)] if isinstance(root, list) else root.setdefault(step, {})
    if value is None:
        del root[last]
    elif isinstance(root, list) and int(last) == len(root):
        root.append(value)
    else:
        root[int(last) if isinstance(root, list) else last] = value


def extension(name, value):
    return {"/extensionsUsed": [name], "/materials/0/extensions": {name: value}}


TEXTURED = {"/images": [{"uri": PIXEL}], "/textures": [{"source": 0}]}

# Name: attributes, what is put where. All are valid, end with 0 and say nothing.
FEATURES = {
    "indexed triangles": ((), {}),
    "normals": (("normal",), {}),
    "vertex colours": (("color",), {}),
    "triangle strip": ((), {"/meshes/0/primitives/0/mode": 5, "/meshes/0/primitives/0/indices": None}),
    "base colour texture": (("texcoord",), {**TEXTURED, "/materials/0/pbrMetallicRoughness/baseColorTexture": {"index": 0}}),
    "normal texture": (("normal", "texcoord", "tangent"), {**TEXTURED, "/materials/0/normalTexture": {"index": 0}}),
    "alpha mask": ((), {"/materials/0/alphaMode": "MASK", "/materials/0/alphaCutoff": 0.25}),
    "two sides": ((), {"/materials/0/doubleSided": True}),
    "matrix": ((), {"/nodes/0/matrix": [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 1, 2, 3, 1]}),
    "mirrored": ((), {"/nodes/0/scale": [-1, 1, 1]}),
    "perspective camera": ((), {"/cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}],
                                "/nodes/1": {"camera": 0, "translation": [0, 0, 3]}, "/scenes/0/nodes": [0, 1]}),
    "orthographic camera": ((), {"/cameras": [{"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0, "zfar": 9}}],
                                 "/nodes/1": {"camera": 0, "translation": [0, 0, 3]}, "/scenes/0/nodes": [0, 1]}),
    "sparse accessor": (("sparse", "moved"), {"/accessors/0/sparse": {"count": 1, "indices": {"bufferView": 2, "componentType": 5123},
                                                                      "values": {"bufferView": 3}}, "/accessors/0/max": [2, 2, 0]}),
    "animated rotation": (("time", "turn"), {"/animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}}],
                                                              "samplers": [{"input": 2, "output": 3}]}]}),
    "morph target": (("normal",), {"/meshes/0/primitives/0/targets": [{"POSITION": 0}], "/meshes/0/weights": [0.5]}),
    "skin": (("joints", "weights"), {"/nodes/0/skin": 0, "/nodes/1": {}, "/skins": [{"joints": [1]}], "/scenes/0/nodes": [0, 1]}),
    "unlit": ((), extension("KHR_materials_unlit", {})),
    "emissive strength": ((), {**extension("KHR_materials_emissive_strength", {"emissiveStrength": 5}),
                               "/materials/0/emissiveFactor": [1, 1, 1]}),
    "index of refraction": ((), extension("KHR_materials_ior", {"ior": 1.3})),
    "transmission": ((), extension("KHR_materials_transmission", {"transmissionFactor": 1})),
    "clearcoat": ((), extension("KHR_materials_clearcoat", {"clearcoatFactor": 1})),
    "sheen": ((), extension("KHR_materials_sheen", {"sheenColorFactor": [1, 1, 1]})),
    "specular": ((), extension("KHR_materials_specular", {"specularFactor": 0.5})),
    "iridescence": ((), extension("KHR_materials_iridescence", {"iridescenceFactor": 1})),
    "texture transform": (("texcoord",), {**TEXTURED, "/extensionsUsed": ["KHR_texture_transform"],
                                          "/materials/0/pbrMetallicRoughness/baseColorTexture":
                                          {"index": 0, "extensions": {"KHR_texture_transform": {"scale": [2, 2]}}}}),
    "point light": ((), {"/extensionsUsed": ["KHR_lights_punctual"], "/extensions": {"KHR_lights_punctual": {"lights": [{"type": "point"}]}},
                         "/nodes/0/extensions": {"KHR_lights_punctual": {"light": 0}}}),
}

# Invalid files. Name: attributes, values by JSON pointer, exit status, part of the message.
ERRORS = {
    "missing buffer view": ((), {"/accessors/0/bufferView": 9}, 3, "/accessors/0/bufferView"),
    "missing accessor": ((), {"/meshes/0/primitives/0/attributes/POSITION": 9}, 3, "/meshes/0/primitives/0/attributes/POSITION"),
    "missing material": ((), {"/meshes/0/primitives/0/material": 4}, 3, "/meshes/0/primitives/0/material"),
    "missing mesh": ((), {"/nodes/0/mesh": 7}, 3, "/nodes/0/mesh"),
    "missing node": ((), {"/scenes/0/nodes": [5]}, 3, "/scenes/0/nodes/0"),
    "missing scene": ((), {"/scene": 3}, 3, "/scene"),
    "view past its buffer": ((), {"/bufferViews/0/byteLength": 4096}, 3, "/bufferViews/0"),
    "accessor past its view": ((), {"/accessors/0/count": 400}, 3, "/accessors/0"),
    "count that wraps": ((), {"/accessors/0/count": 2 ** 62}, 3, "/accessors/0/count"),
    "negative count": ((), {"/accessors/0/count": -1}, 3, "/accessors/0/count"),
    "short buffer": ((), {"/buffers/0/byteLength": 100000}, 0, "/buffers/0"),
    "index past the vertices": ((), {"/accessors/0/count": 3}, 3, "/meshes/0/primitives/0/indices"),
    "unknown component type": ((), {"/accessors/0/componentType": 5130}, 3, "/accessors/0"),
    "positions of two numbers": ((), {"/accessors/0/type": "VEC2", "/accessors/0/min": None, "/accessors/0/max": None}, 3,
                                 "/meshes/0/primitives/0/attributes/POSITION"),
    "node below itself": ((), {"/nodes/0/children": [0]}, 3, "/nodes/0"),
    "node of two parents": ((), {"/nodes": [{"mesh": 0, "children": [2]}, {"children": [2]}, {}], "/scenes/0/nodes": [0, 1]}, 3, "/nodes/"),
    "zero field of view": ((), {"/cameras": [{"type": "perspective", "perspective": {"yfov": 0, "znear": 0.1}}], "/nodes/0/camera": 0}, 0,
                           "/cameras/0/perspective/yfov"),
    "unknown extension required": ((), {"/extensionsUsed": ["EXT_unheard_of"], "/extensionsRequired": ["EXT_unheard_of", "EXT_unheard_of"]},
                                   3, "EXT_unheard_of"),
    "text for a number": ((), {"/materials/0/pbrMetallicRoughness/metallicFactor": "half"}, 0,
                          "/materials/0/pbrMetallicRoughness/metallicFactor"),
    "factor above one": ((), {"/materials/0/pbrMetallicRoughness/metallicFactor": 2}, 0,
                         "/materials/0/pbrMetallicRoughness/metallicFactor"),
    "picture that is none": (("texcoord",), {**TEXTURED, "/images/0/uri": "data:image/png;base64,AAAA",
                                             "/materials/0/pbrMetallicRoughness/baseColorTexture": {"index": 0}}, 0, "/images/0"),
    "another version": ((), {"/asset/version": "3.0"}, 3, "/asset/version"),
    "quaternion of no length": ((), {"/nodes/0/rotation": [0, 0, 0, 0]}, 0, "/nodes/0/rotation"),
    "times that go back": (("time", "turn"), {"/animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}}],
                                                               "samplers": [{"input": 9, "output": 3}]}]}, 3,
                           "/animations/0/samplers/0/input"),
}


def made_files():
    """Name, root, expectation."""
    for name, (parts, changes) in FEATURES.items():
        yield name, changed(parts, changes), {"valid": True, "status": 0, "says": ""}
    for name, (parts, changes, status, says) in ERRORS.items():
        yield name, changed(parts, changes), {"valid": False, "status": status, "says": says}


def changed(parts, changes):
    root, _ = base(*parts)
    for pointer, value in changes.items():
        put(root, pointer, copy.deepcopy(value))
    return root


def write(folder):
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for name, root, expected in made_files():
        stem = name.replace(" ", "_")
        (folder / (stem + ".gltf")).write_text(json.dumps(root, indent=1))
        (folder / (stem + ".expected.json")).write_text(json.dumps(expected))


if __name__ == "__main__":
    write(sys.argv[1])

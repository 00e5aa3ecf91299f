#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""make_corpus.py SCENES FOLDER: what the fuzzers begin with. FOLDER/loader gets the repository's small scenes, each as
.gltf with its buffers inside and as .glb; FOLDER/picture one header of each kind; FOLDER/loader.dict glTF's words."""
import base64
import json
import re
import struct
import sys
import zlib
from pathlib import Path

LARGEST = 8_000  # bytes; larger seeds are slow, and teach no more


def words(value, found):
    if isinstance(value, dict):
        for key, member in value.items():
            found.add(key)
            words(member, found)
    elif isinstance(value, list):
        for member in value:
            words(member, found)
    elif isinstance(value, str) and re.fullmatch(r"[\w/-]{1,40}", value):
        found.add(value)


def padded(data, byte):
    return data + byte * (-len(data) % 4)


def glb(scene, binary):
    text = padded(json.dumps(scene).encode(), b" ")
    body = struct.pack("<II", len(text), 0x4E4F534A) + text
    if binary:
        body += struct.pack("<II", len(padded(binary, b"\0")), 0x004E4942) + padded(binary, b"\0")
    return b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body


def feature_scene():
    """Makes a triangle with sparse positions, colours, a texture, a light, a camera and a sphere. No file in scenes/
    has all of these."""
    floats = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
    binary = floats + struct.pack("<3H", 0, 1, 2) + b"\0\0" + struct.pack("<H", 1) + b"\0\0" + struct.pack("<3f", 1, 1, 1)
    views = [{"buffer": 0, "byteOffset": offset, "byteLength": size} for offset, size in ((0, 36), (36, 6), (44, 2), (48, 12))]
    return {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "extensionsUsed": ["KHR_lights_punctual", "KHR_implicit_shapes", "KHR_materials_ior"],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot", "spot": {"innerConeAngle": 0.1}}]},
                       "KHR_implicit_shapes": {"shapes": [{"type": "sphere", "sphere": {"radius": 1}}]}},
        "nodes": [{"mesh": 0, "children": [1, 2, 3], "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]},
                  {"camera": 0, "rotation": [0, 0, 0, 1]}, {"extensions": {"KHR_lights_punctual": {"light": 0}}},
                  {"extras": {"shape": 0, "material": 0}, "scale": [2, 2, 2]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1, "zfar": 9, "aspectRatio": 1}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "COLOR_0": 0, "TEXCOORD_0": 2}, "indices": 1,
                                    "material": 0, "mode": 4}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 0}}, "alphaMode": "MASK",
                       "extensions": {"KHR_materials_ior": {"ior": 1.4}}, "extras": {"perlinNormal": {"amplitude": 0.1}}}],
        "textures": [{"source": 0, "sampler": 0}], "samplers": [{"wrapS": 33071, "magFilter": 9728}],
        "images": [{"uri": "data:image/png;base64," + base64.b64encode(png()).decode()}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "sparse": {
                           "count": 1, "indices": {"bufferView": 2, "componentType": 5123}, "values": {"bufferView": 3}}},
                      {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"},
                      {"componentType": 5126, "count": 3, "type": "VEC2"}],
        "bufferViews": views, "buffers": [{"byteLength": len(binary)}]}, binary


class Buffer:
    """The binary of a scene with its views and accessors."""

    def __init__(self):
        self.binary, self.views, self.accessors = b"", [], []

    def add(self, kind, component, values, code, **members):
        data = struct.pack(f"<{len(values)}{code}", *values)
        self.views.append({"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data)})
        width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}[kind]
        self.accessors.append({"bufferView": len(self.views) - 1, "componentType": component, "count": len(values) // width,
                               "type": kind, **members})
        self.binary += padded(data, b"\0")
        return len(self.accessors) - 1

    def scene(self, members):
        return {"asset": {"version": "2.0"}, **members, "accessors": self.accessors, "bufferViews": self.views,
                "buffers": [{"byteLength": len(self.binary)}]}, self.binary


def motion_scene():
    """A triangle with joints, a morph target, variants, and an animation; one more as Draco and meshopt would hold it."""
    buffer = Buffer()
    add = buffer.add
    identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
    position = add("VEC3", 5126, [0, 0, 0, 1, 0, 0, 0, 1, 0], "f")
    joints = add("VEC4", 5121, [0, 1, 0, 0] * 3, "B")
    weights = add("VEC4", 5126, [0.5, 0.5, 0, 0] * 3, "f")
    delta = add("VEC3", 5126, [0, 0, 1] * 3, "f")
    binds = add("MAT4", 5126, identity * 2, "f")
    times = add("SCALAR", 5126, [0, 1], "f")
    turns = add("VEC4", 5126, [0, 0, 0, 1, 0, 0, 1, 0], "f")
    spline = add("SCALAR", 5126, [0, 0, 0, 0, 1, 0], "f")
    colours = add("VEC4", 5126, [1, 1, 1, 1, 0, 0, 0, 1], "f")
    corners = add("SCALAR", 5123, [0, 1, 2], "H")
    buffer.views.append({"buffer": 0, "byteLength": 36, "extensions": {"EXT_meshopt_compression": {
        "buffer": 0, "byteOffset": 0, "byteLength": 36, "byteStride": 12, "count": 3, "mode": "ATTRIBUTES", "filter": "NONE"}}})
    factor = "/materials/0/pbrMetallicRoughness/baseColorFactor"
    primitive = {"attributes": {"POSITION": position, "JOINTS_0": joints, "WEIGHTS_0": weights}, "material": 0,
                 "targets": [{"POSITION": delta}],
                 "extensions": {"KHR_materials_variants": {"mappings": [{"material": 1, "variants": [0]}]}}}
    packed = {"attributes": {"POSITION": position}, "indices": corners,
              "extensions": {"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}}}
    return buffer.scene({
        "scene": 0, "scenes": [{"name": "all", "nodes": [0, 1, 3]}],
        "extensionsUsed": ["KHR_materials_variants", "KHR_animation_pointer", "KHR_draco_mesh_compression",
                           "EXT_meshopt_compression"],
        "extensions": {"KHR_materials_variants": {"variants": [{"name": "night"}]}},
        "nodes": [{"mesh": 0, "skin": 0, "weights": [0.5]}, {"children": [2]}, {"translation": [0, 0, 1]}, {"mesh": 1}],
        "skins": [{"joints": [1, 2], "skeleton": 1, "inverseBindMatrices": binds}],
        "meshes": [{"primitives": [primitive], "weights": [0]}, {"primitives": [packed]}],
        "materials": [{"name": "day"}, {"name": "night"}],
        "animations": [{"name": "turn",
                        "samplers": [{"input": times, "output": turns}, {"input": times, "output": colours, "interpolation": "STEP"},
                                     {"input": times, "output": spline, "interpolation": "CUBICSPLINE"}],
                        "channels": [{"sampler": 0, "target": {"node": 2, "path": "rotation"}},
                                     {"sampler": 2, "target": {"node": 0, "path": "weights"}},
                                     {"sampler": 1, "target": {"path": "pointer", "extensions": {
                                         "KHR_animation_pointer": {"pointer": factor}}}}]}]})


def instancing_scene():
    """A mesh of two primitives that stands in three nodes, in one of them several times; one node mirrors, one is uneven."""
    buffer = Buffer()
    add = buffer.add
    quad = add("VEC3", 5126, [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0], "f")
    corners = add("SCALAR", 5123, [0, 1, 2, 0, 2, 3], "H")
    triangle = add("VEC3", 5126, [0, 0, 1, 1, 0, 1, 0, 1, 1], "f")
    places = add("VEC3", 5126, [1, 0, 0, 2, 0, 0, 3, 0, 0], "f")
    turns = add("VEC4", 5120, [0, 0, 0, 127, 127, 0, 0, 0, 0, 90, 0, 90], "b", normalized=True)
    sizes = add("VEC3", 5126, [1, 1, 1, 2, 2, 2, 1, 2, 40], "f")
    return buffer.scene({
        "scenes": [{"nodes": [0, 1, 2]}], "extensionsUsed": ["EXT_mesh_gpu_instancing"],
        "nodes": [{"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {
                      "TRANSLATION": places, "ROTATION": turns, "SCALE": sizes}}}, "children": [3]},
                  {"mesh": 0, "scale": [-1, 1, 1]}, {"mesh": 0, "translation": [0, 5, 0]}, {"mesh": 1}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": quad}, "indices": corners},
                                   {"attributes": {"POSITION": triangle}, "material": 0}]},
                   {"primitives": [{"attributes": {"POSITION": triangle}, "material": 1}]}],
        "materials": [{"doubleSided": True}, {"emissiveFactor": [1, 1, 1]}]})


def png():
    chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 1, 1, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(b"\0\1\2\3")) + chunk(b"IEND", b""))


def exr():
    attribute = lambda name, kind, value: name + b"\0" + kind + b"\0" + struct.pack("<I", len(value)) + value
    window = struct.pack("<4i", 0, 0, 1, 1)
    return (b"\x76\x2f\x31\x01" + struct.pack("<I", 2)
            + attribute(b"channels", b"chlist", b"R\0" + struct.pack("<4I", 2, 0, 1, 1) + b"\0")
            + attribute(b"compression", b"compression", b"\3") + attribute(b"dataWindow", b"box2i", window)
            + attribute(b"displayWindow", b"box2i", window) + attribute(b"tiles", b"tiledesc", struct.pack("<IIB", 64, 64, 0))
            + b"\0" + struct.pack("<Q", 300) + bytes(24))


def pictures():
    yield "png", png()
    yield "jpg", (b"\xff\xd8\xff\xc2\0\x0b\x08\0\x10\0\x10\1\1\x11\0" + b"\xff\xda\0\x08\1\1\0\0\x3f\0" * 3 + b"\1\2\xff\xd9")
    yield "webp", b"RIFF\x1c\0\0\0WEBPVP8L\x0f\0\0\0\x2f\7\xc0\1\0" + bytes(11)
    yield "vp8", b"RIFF\x1c\0\0\0WEBPVP8 \x0f\0\0\0\x30\1\0\x9d\1\x2a\7\0\7\0" + bytes(6)
    yield "vp8x", b"RIFF\x1c\0\0\0WEBPVP8X\x0a\0\0\0\0\0\0\0\7\0\0\7\0\0"
    yield "hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 1\n12345678"
    yield "exr", exr()
    yield "pfm", b"PF\n1 1\n-1.0\n" + bytes(12)
    for path in sorted((Path(__file__).resolve().parent.parent / "ktx2").glob("*.ktx2")):
        yield path.name, path.read_bytes()


def grids(nvdb):
    """Yields each grid of a NanoVDB file with ZIP compression, as it is in memory (NanoVDB 32, io::Header and
    io::MetaData)."""
    count, place = struct.unpack_from("<H", nvdb, 12)[0], 16
    for _ in range(count):
        place += 176 + struct.unpack_from("<I", nvdb, place + 136)[0]
    for _ in range(count):
        size = struct.unpack_from("<Q", nvdb, place)[0]
        yield zlib.decompress(nvdb[place + 8:place + 8 + size])
        place += 8 + size


def main():
    scenes, folder = map(Path, sys.argv[1:3])
    for name in ("loader", "picture", "volume"):
        (folder / name).mkdir(parents=True, exist_ok=True)
    found = set()
    sources = [(path.stem, json.loads(path.read_text()), None) for path in sorted(scenes.glob("*.gltf"))]
    for name, scene, binary in sources + [("features", *feature_scene()), ("motion", *motion_scene()),
                                          ("instancing", *instancing_scene())]:
        words(scene, found)
        if binary is None:
            uri = scene.get("buffers", [{}])[0].get("uri", "")
            if not uri.startswith("data:"):
                continue
            binary = base64.b64decode(uri.split(",", 1)[1])
        whole = json.loads(json.dumps(scene))
        whole["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(binary).decode()
        scene["buffers"][0].pop("uri", None)
        for suffix, data in ((".gltf", json.dumps(whole).encode()), (".glb", glb(scene, binary))):
            if len(data) <= LARGEST:
                (folder / "loader" / (name + suffix)).write_bytes(data)
    for name, data in pictures():
        (folder / "picture" / name).write_bytes(data)
    for i, grid in enumerate(grids((scenes / "plume.nvdb").read_bytes())):
        (folder / "volume" / f"plume{i}").write_bytes(grid)
    (folder / "loader.dict").write_text("".join(f'"\\"{word}\\""\n' for word in sorted(found)))


if __name__ == "__main__":
    main()

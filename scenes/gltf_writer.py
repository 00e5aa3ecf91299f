# SPDX-License-Identifier: MIT
"""A glTF 2.0 file in the making: every add method returns the index of what it added."""

import base64
import json
import math
import re
import struct

EMBED_LIMIT_BYTES = 4096
TRIANGLES, TRIANGLE_STRIP, TRIANGLE_FAN = 4, 5, 6
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963
COMPONENT_TYPES = {"B": 5121, "H": 5123, "I": 5125, "f": 5126}
VECTOR_TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}


def subtract(a, b):
    return tuple(x - y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def normalize(a):
    length = math.sqrt(sum(x * x for x in a))
    return tuple(x / length for x in a)


def rotation_about(axis, degrees):
    """The quaternion (x, y, z, w) of a rotation about a unit axis."""
    half = math.radians(degrees) / 2
    return [round(math.sin(half) * x, 9) for x in axis] + [round(math.cos(half), 9)]


def rotation_towards(direction, up=(0, 1, 0)):
    """The quaternion (x, y, z, w) that turns -z into direction and +y as near to up as it goes."""
    back = normalize(tuple(-x for x in direction))
    right = normalize(cross(up, back))
    above = cross(back, right)
    m = [[right[i], above[i], back[i]] for i in range(3)]
    # Shepperd, 1978: the largest component first, so that no square root is near zero.
    squares = [1 + m[0][0] - m[1][1] - m[2][2], 1 - m[0][0] + m[1][1] - m[2][2],
               1 - m[0][0] - m[1][1] + m[2][2], 1 + m[0][0] + m[1][1] + m[2][2]]
    largest = max(range(4), key=squares.__getitem__)
    double = math.sqrt(squares[largest])
    rows = [[double * double, m[0][1] + m[1][0], m[0][2] + m[2][0], m[2][1] - m[1][2]],
            [m[0][1] + m[1][0], double * double, m[1][2] + m[2][1], m[0][2] - m[2][0]],
            [m[0][2] + m[2][0], m[1][2] + m[2][1], double * double, m[1][0] - m[0][1]],
            [m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1], double * double]]
    return [round(x / (2 * double), 9) for x in rows[largest]]


class GltfWriter:
    def __init__(self, folder, name):
        self.folder, self.name = folder, name
        self.data = bytearray()
        self.extensions_used = set()
        self.root = {"asset": {"version": "2.0", "generator": "fragtrace scenes/make_scenes.py"},
                     "scene": 0, "scenes": [{"name": name, "nodes": []}]}

    def add(self, table, value):
        entries = self.root.setdefault(table, [])
        entries.append(value)
        return len(entries) - 1

    def extension(self, name):
        self.extensions_used.add(name)
        return self.root.setdefault("extensions", {}).setdefault(name, {})

    # Nodes, cameras, lights

    def add_node(self, name, parent=None, **properties):
        node = self.add("nodes", {"name": name, **properties})
        owner = self.root["scenes"][0]["nodes"] if parent is None else self.root["nodes"][parent].setdefault("children", [])
        owner.append(node)
        return node

    def add_camera(self, name, eye, target, fov_degrees, aspect=1.0):
        camera = self.add("cameras", {"name": name, "type": "perspective", "perspective": {
            "yfov": round(math.radians(fov_degrees), 9), "aspectRatio": aspect, "znear": 0.01}})
        return self.add_node(name, camera=camera, translation=list(eye),
                             rotation=rotation_towards(subtract(target, eye)))

    def add_orthographic_camera(self, name, eye, target, xmag, ymag, zfar):
        camera = self.add("cameras", {"name": name, "type": "orthographic", "orthographic": {
            "xmag": xmag, "ymag": ymag, "znear": 0.01, "zfar": zfar}})
        return self.add_node(name, camera=camera, translation=list(eye),
                             rotation=rotation_towards(subtract(target, eye)))

    def add_light(self, name, kind, intensity, color=(1, 1, 1), eye=None, direction=None, up=(0, 1, 0), **properties):
        lights = self.extension("KHR_lights_punctual").setdefault("lights", [])
        lights.append({"name": name, "type": kind, "color": list(color), "intensity": intensity, **properties})
        place = {}
        if eye is not None:
            place["translation"] = list(eye)
        if direction is not None:
            place["rotation"] = rotation_towards(direction, up)
        return self.add_node(name, extensions={"KHR_lights_punctual": {"light": len(lights) - 1}}, **place)

    def add_sphere(self, name, radius, material, **place):
        """An implicit sphere; which shape and material a node holds stands in its extras."""
        shapes = self.extension("KHR_implicit_shapes").setdefault("shapes", [])
        shapes.append({"type": "sphere", "sphere": {"radius": radius}})
        return self.add_node(name, extras={"shape": len(shapes) - 1, "material": material}, **place)

    # Materials and textures

    def add_material(self, name, color=(1, 1, 1), metallic=0, roughness=1, texture=None, extensions=None, **properties):
        pbr = {"metallicFactor": metallic, "roughnessFactor": roughness}
        if tuple(color) != (1, 1, 1):
            pbr["baseColorFactor"] = list(color) + [1] * (4 - len(color))
        if texture is not None:
            pbr["baseColorTexture"] = texture if isinstance(texture, dict) else {"index": texture}
        material = {"name": name, "pbrMetallicRoughness": pbr, **properties}
        if extensions:
            material["extensions"] = extensions
            self.extensions_used.update(extensions)
        return self.add("materials", material)

    def add_lambert(self, name, color=(1, 1, 1), **properties):
        extensions = {"KHR_materials_specular": {"specularFactor": 0}, **properties.pop("extensions", {})}
        return self.add_material(name, color, extensions=extensions, **properties)

    def add_lamp(self, name, radiance, **properties):
        strength = max(radiance)
        return self.add_lambert(name, (0, 0, 0), emissiveFactor=[round(x / strength, 9) for x in radiance], extensions={
            "KHR_materials_emissive_strength": {"emissiveStrength": strength}}, **properties)

    def add_texture(self, uri, filter_name="linear", wrap=("repeat", "repeat")):
        filters = {"nearest": (9728, 9728), "linear": (9729, 9987)}[filter_name]
        wraps = {"repeat": 10497, "clamp": 33071, "mirror": 33648}
        sampler = self.add("samplers", {"magFilter": filters[0], "minFilter": filters[1],
                                        "wrapS": wraps[wrap[0]], "wrapT": wraps[wrap[1]]})
        return self.add("textures", {"sampler": sampler, "source": self.add("images", {"uri": uri})})

    # Geometry

    def add_view(self, data, target=None):
        self.data.extend(b"\0" * (-len(self.data) % 4))
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)}
        if target:
            view["target"] = target
        self.data.extend(data)
        return self.add("bufferViews", view)

    def add_accessor(self, values, component="f", target=ARRAY_BUFFER, normalized=False, bounds=False):
        """Values are tuples or scalars; every element must fill a multiple of 4 bytes if it is a vertex attribute."""
        rows = [v if isinstance(v, (tuple, list)) else (v,) for v in values]
        packed = b"".join(struct.pack("<%d%s" % (len(row), component), *row) for row in rows)
        accessor = {"bufferView": self.add_view(packed, target), "componentType": COMPONENT_TYPES[component],
                    "count": len(rows), "type": VECTOR_TYPES[len(rows[0])]}
        if normalized:
            accessor["normalized"] = True
        if bounds:
            stored = list(struct.iter_unpack("<%d%s" % (len(rows[0]), component), packed))
            accessor["min"] = [min(column) for column in zip(*stored)]
            accessor["max"] = [max(column) for column in zip(*stored)]
        return self.add("accessors", accessor)

    def add_indices(self, indices, component="H"):
        return self.add_accessor(indices, component, ELEMENT_ARRAY_BUFFER)

    def primitive(self, positions, indices=None, material=None, normals=None, uvs=None, tangents=None,
                  index_component="H", mode=TRIANGLES, **attributes):
        """One primitive; further attributes are accessor indices by glTF name."""
        table = {"POSITION": self.add_accessor(positions, bounds=True)}
        for name, values in (("NORMAL", normals), ("TANGENT", tangents), ("TEXCOORD_0", uvs)):
            if values:
                table[name] = self.add_accessor(values)
        result = {"attributes": {**table, **attributes}}
        if indices is not None:
            result["indices"] = self.add_indices(indices, index_component)
        if material is not None:
            result["material"] = material
        if mode != TRIANGLES:
            result["mode"] = mode
        return result

    def add_mesh(self, name, *primitives):
        return self.add("meshes", {"name": name, "primitives": list(primitives)})

    def place_mesh(self, name, *primitives, **place):
        return self.add_node(name, mesh=self.add_mesh(name, *primitives), **place)

    # The file

    def triangle_count(self):
        """Triangles drawn: a mesh counts once for each node that holds it."""
        total = 0
        for node in self.root["nodes"]:
            if "mesh" not in node:
                continue
            for primitive in self.root["meshes"][node["mesh"]]["primitives"]:
                accessor = primitive.get("indices", primitive["attributes"]["POSITION"])
                count = self.root["accessors"][accessor]["count"]
                total += count // 3 if primitive.get("mode", TRIANGLES) == TRIANGLES else count - 2
        return total

    def write(self):
        if self.data:
            buffer = {"byteLength": len(self.data)}
            if len(self.data) <= EMBED_LIMIT_BYTES:
                buffer["uri"] = "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()
            else:
                buffer["uri"] = self.name + ".bin"
                (self.folder / buffer["uri"]).write_bytes(self.data)
            self.root["buffers"] = [buffer]
        if self.extensions_used:
            self.root["extensionsUsed"] = sorted(self.extensions_used)
        text = json.dumps(self.root, indent=1)
        text = re.sub(r"\[\s+([-+.\deE,\s]+?)\s+\]", lambda m: "[" + " ".join(m.group(1).split()) + "]", text)
        (self.folder / (self.name + ".gltf")).write_text(text + "\n", encoding="utf-8")
        print("%-24s %6d triangles" % (self.name, self.triangle_count()))

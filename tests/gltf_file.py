# SPDX-License-Identifier: MIT
"""glTF files in the making, and the pictures that they refer to."""
import base64
import json
import math
import struct
import zlib

COMPONENTS = {"B": 5121, "H": 5123, "I": 5125, "f": 5126}
KINDS = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}


def data_uri(kind, data):
    return f"data:{kind};base64," + base64.b64encode(data).decode()


def png(width, height, rgba, bits=8):
    """Makes a PNG with 8 or 16 bits per channel."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    values = struct.pack(f">{len(rgba)}{'B' if bits == 8 else 'H'}", *rgba)
    size = len(values) // height
    rows = b"".join(b"\0" + values[size * y:size * (y + 1)] for y in range(height))
    header = struct.pack(">IIBBBBB", width, height, bits, 6, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


class Gltf:
    """A document, `root`, whose new accessors lie in a buffer of their own, behind the buffers that it has."""

    def __init__(self, root=None, **members):
        self.root = root or {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}], **members}
        self.data = b""

    def accessor(self, rows, code="f", **more):
        """Adds rows, each a number or a tuple, with their bounds. Returns the index."""
        rows = [row if isinstance(row, (list, tuple)) else [row] for row in rows]
        packed = b"".join(struct.pack(f"<{len(row)}{code}", *row) for row in rows)
        columns = list(zip(*struct.iter_unpack(f"<{len(rows[0])}{code}", packed)))
        if all(math.isfinite(sum(column)) for column in columns):
            more = {"min": list(map(min, columns)), "max": list(map(max, columns)), **more}
        views, accessors = (self.root.setdefault(name, []) for name in ("bufferViews", "accessors"))
        views.append({"buffer": len(self.root.get("buffers", [])), "byteOffset": len(self.data), "byteLength": len(packed)})
        accessors.append({"bufferView": len(views) - 1, "componentType": COMPONENTS[code], "count": len(rows), "type": KINDS[len(rows[0])], **more})
        self.data += packed + bytes(-len(packed) % 4)
        return len(accessors) - 1

    def node(self, **members):
        """Adds a node to the first scene."""
        nodes = self.root.setdefault("nodes", [])
        nodes.append(members)
        self.root["scenes"][0]["nodes"].append(len(nodes) - 1)

    def mesh(self, indices=None, **attributes):
        """Adds a mesh of one primitive: accessors by the names of its attributes, in lower case, and its material."""
        primitive = {"material": attributes.pop("material")} if "material" in attributes else {}
        primitive["attributes"] = {name.upper(): accessor for name, accessor in attributes.items()}
        self.root.setdefault("meshes", []).append({"primitives": [primitive | ({} if indices is None else {"indices": indices})]})
        return len(self.root["meshes"]) - 1

    def moves(self, node, times, **values):
        """Adds an animation of a node: values at these times by path (translation, rotation, scale)."""
        keys = self.accessor(times)
        samplers = [{"input": keys, "output": self.accessor(rows)} for rows in values.values()]
        channels = [{"sampler": i, "target": {"node": node, "path": path}} for i, path in enumerate(values)]
        self.root.setdefault("animations", []).append({"samplers": samplers, "channels": channels})
        return self.root["animations"][-1]

    def document(self):
        """Returns the document with the new buffer."""
        if self.data:
            self.root.setdefault("buffers", []).append({"byteLength": len(self.data), "uri": data_uri("application/octet-stream", self.data)})
            self.data = b""
        return self.root

    def write(self, path):
        path.write_text(json.dumps(self.document()))
        return path


SQUARE = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
TWO_TRIANGLES = [0, 1, 2, 0, 2, 3]


def quad(material, uvs=((0, 1), (1, 1), (1, 0), (0, 0)), images=()):
    """Makes a quad from (-1, -1) to (1, 1) that faces a camera 2.2 m away."""
    gltf = Gltf(materials=[material], images=[{"uri": data_uri("image/png", image)} for image in images], textures=[{"source": i} for i in range(len(images))],
                cameras=[{"type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.1}}])
    position, uv = gltf.accessor(SQUARE), gltf.accessor(uvs)
    gltf.node(mesh=gltf.mesh(gltf.accessor(TWO_TRIANGLES, "H"), material=0, position=position, texcoord_0=uv))
    gltf.node(camera=0, translation=[0, 0, 2.2])
    return gltf.document()

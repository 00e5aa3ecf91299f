# SPDX-License-Identifier: MIT
"""Reads fragtrace's scenes into numpy arrays of doubles, in world space; shares no code with the C++ loader."""

import base64
import json
from dataclasses import dataclass, field
from pathlib import Path

import mitsuba as mi
import numpy as np

COMPONENTS = {5120: "i1", 5121: "u1", 5122: "i2", 5123: "u2", 5125: "u4", 5126: "f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
LAYERS = ("clearcoat", "sheen", "anisotropy", "iridescence", "diffuse_transmission")
WRAPS = {10497: "repeat", 33071: "clamp", 33648: "mirror"}


@dataclass
class Texture:
    texels: np.ndarray  # rows from the top, RGBA in [0, 1], as stored
    nearest: bool
    wrap: tuple
    coordinate_set: int = 0

    def linear(self):
        """Returns the same texture with its colours decoded from sRGB."""
        color = self.texels[..., :3]
        decoded = np.where(color <= 0.04045, color / 12.92, ((color + 0.055) / 1.055) ** 2.4)
        return Texture(np.concatenate([decoded, self.texels[..., 3:]], -1), self.nearest, self.wrap, self.coordinate_set)


@dataclass
class Material:
    name: str
    color: np.ndarray
    metallic: float
    roughness: float
    emission: np.ndarray
    color_texture: Texture = None
    metallic_roughness_texture: Texture = None
    emission_texture: Texture = None
    specular_texture: Texture = None
    specular_color_texture: Texture = None
    transmission_texture: Texture = None
    normal_texture: Texture = None
    normal_scale: float = 1.0
    alpha_mode: str = "OPAQUE"
    alpha_cutoff: float = 0.5
    double_sided: bool = False
    unlit: bool = False
    ior: float = 1.5
    specular: float = 1.0
    specular_color: np.ndarray = None
    transmission: float = 0.0
    thickness: float = 0.0
    attenuation_color: np.ndarray = None
    attenuation_distance: float = np.inf
    scatter: dict = None  # KHR_materials_scatter
    perlin: dict = None
    layers: dict = None  # the extensions of gltf_layers.py, by name without KHR_materials_

    def two_sided(self):
        return self.double_sided or self.transmission > 0 or "diffuse_transmission" in self.layers


@dataclass
class Mesh:
    """Triangles of one primitive at one node; counter-clockwise is the front."""
    name: str
    material: Material
    positions: np.ndarray  # triangles, 3, 3
    normals: np.ndarray
    uvs: list  # an array (triangles, 3, 2) for each coordinate set
    tangents: np.ndarray  # triangles, 3, 4
    colors: np.ndarray  # triangles, 3, 4


@dataclass
class Sphere:
    name: str
    material: Material
    center: np.ndarray
    radius: float
    axes: np.ndarray  # columns: the node's axes in the world


@dataclass
class Light:
    kind: str
    radiant: np.ndarray
    position: np.ndarray
    direction: np.ndarray
    range: float
    inner_cosine: float
    outer_cosine: float


@dataclass
class Camera:
    to_world: np.ndarray
    yfov: float = None
    ymag: float = None


@dataclass
class Scene:
    meshes: list = field(default_factory=list)
    spheres: list = field(default_factory=list)
    lights: list = field(default_factory=list)
    cameras: list = field(default_factory=list)


def rotation_matrix(q):
    x, y, z, w = np.array(q) / np.linalg.norm(q)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def local_matrix(node):
    if "matrix" in node:
        return np.array(node["matrix"], float).reshape(4, 4).T
    m = np.eye(4)
    m[:3, :3] = rotation_matrix(node.get("rotation", [0, 0, 0, 1])) * np.array(node.get("scale", [1, 1, 1]))
    m[:3, 3] = node.get("translation", [0, 0, 0])
    return m


def unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


class Reader:
    def __init__(self, path):
        self.folder = Path(path).parent
        self.root = json.loads(Path(path).read_text(encoding="utf-8"))
        self.buffers = [self.buffer(b["uri"]) for b in self.root.get("buffers", [])]
        self.materials = [self.material(m) for m in self.root.get("materials", [])]
        self.scene = Scene()
        for node in self.root["scenes"][self.root.get("scene", 0)]["nodes"]:
            self.visit(node, np.eye(4))

    def buffer(self, uri):
        return base64.b64decode(uri.split(",", 1)[1]) if uri.startswith("data:") else (self.folder / uri).read_bytes()

    def view(self, index, dtype, count, width, offset=0):
        view, dtype = self.root["bufferViews"][index], np.dtype(dtype)
        strides = (view.get("byteStride", width * dtype.itemsize), dtype.itemsize)
        return np.ndarray((count, width), dtype, self.buffers[view["buffer"]], view.get("byteOffset", 0) + offset, strides)

    def accessor(self, index):
        a = self.root["accessors"][index]
        dtype, width = np.dtype("<" + COMPONENTS[a["componentType"]]), WIDTHS[a["type"]]
        values = self.view(a["bufferView"], dtype, a["count"], width, a.get("byteOffset", 0)).copy()
        if "sparse" in a:
            s = a["sparse"]
            where = self.view(s["indices"]["bufferView"], "<" + COMPONENTS[s["indices"]["componentType"]], s["count"], 1)
            values[where[:, 0]] = self.view(s["values"]["bufferView"], dtype, s["count"], width)
        if a.get("normalized"):
            return np.maximum(values / np.iinfo(dtype).max, -1.0)
        return values.astype(float) if dtype.kind == "f" else values.astype(np.int64)

    def texture(self, info):
        texture = self.root["textures"][info["index"]]
        sampler = self.root["samplers"][texture["sampler"]] if "sampler" in texture else {}
        bitmap = mi.Bitmap(str(self.folder / self.root["images"][texture["source"]]["uri"]))
        texels = np.array(bitmap).astype(float) / 255
        if texels.shape[2] == 3:
            texels = np.concatenate([texels, np.ones_like(texels[..., :1])], -1)
        wrap = tuple(WRAPS[sampler.get(key, 10497)] for key in ("wrapS", "wrapT"))
        return Texture(texels, sampler.get("magFilter", 9729) == 9728, wrap, info.get("texCoord", 0))

    def material(self, m):
        pbr, ext = m.get("pbrMetallicRoughness", {}), m.get("extensions", {})
        specular, volume = ext.get("KHR_materials_specular", {}), ext.get("KHR_materials_volume", {})
        strength = ext.get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1)
        transmission, normal = ext.get("KHR_materials_transmission", {}), m.get("normalTexture")
        return Material(
            name=m["name"], color=np.array(pbr.get("baseColorFactor", [1, 1, 1, 1]), float),
            metallic=pbr.get("metallicFactor", 1), roughness=pbr.get("roughnessFactor", 1),
            emission=np.array(m.get("emissiveFactor", [0, 0, 0]), float) * strength,
            color_texture=self.texture(pbr["baseColorTexture"]).linear() if "baseColorTexture" in pbr else None,
            metallic_roughness_texture=self.texture(pbr["metallicRoughnessTexture"]) if "metallicRoughnessTexture" in pbr else None,
            emission_texture=self.texture(m["emissiveTexture"]).linear() if "emissiveTexture" in m else None,
            specular_texture=self.texture(specular["specularTexture"]) if "specularTexture" in specular else None,
            specular_color_texture=self.texture(specular["specularColorTexture"]).linear() if "specularColorTexture" in specular else None,
            transmission_texture=self.texture(transmission["transmissionTexture"]) if "transmissionTexture" in transmission else None,
            normal_texture=self.texture(normal) if normal else None, normal_scale=normal.get("scale", 1) if normal else 1,
            alpha_mode=m.get("alphaMode", "OPAQUE"), alpha_cutoff=m.get("alphaCutoff", 0.5),
            double_sided=m.get("doubleSided", False), unlit="KHR_materials_unlit" in ext,
            ior=ext.get("KHR_materials_ior", {}).get("ior", 1.5), specular=specular.get("specularFactor", 1),
            specular_color=np.array(specular.get("specularColorFactor", [1, 1, 1]), float),
            transmission=transmission.get("transmissionFactor", 0),
            thickness=volume.get("thicknessFactor", 0),
            attenuation_color=np.array(volume.get("attenuationColor", [1, 1, 1]), float),
            attenuation_distance=volume.get("attenuationDistance", np.inf),
            scatter=ext.get("KHR_materials_scatter"),
            perlin=m.get("extras", {}).get("perlinNormal"),
            layers={name: ext["KHR_materials_" + name] for name in LAYERS if "KHR_materials_" + name in ext})

    def visit(self, index, parent):
        node = self.root["nodes"][index]
        world = parent @ local_matrix(node)
        if "camera" in node:
            camera = self.root["cameras"][node["camera"]]
            self.scene.cameras.append(Camera(world, camera.get("perspective", {}).get("yfov"),
                                             camera.get("orthographic", {}).get("ymag")))
        if "mesh" in node:
            for primitive in self.root["meshes"][node["mesh"]]["primitives"]:
                self.add_primitive(node["name"], primitive, world)
        if "light" in node.get("extensions", {}).get("KHR_lights_punctual", {}):
            self.add_light(node["extensions"]["KHR_lights_punctual"]["light"], world)
        if "shape" in node.get("extras", {}):
            shape = self.root["extensions"]["KHR_implicit_shapes"]["shapes"][node["extras"]["shape"]]
            scale = np.linalg.norm(world[:3, 0])
            self.scene.spheres.append(Sphere(node["name"], self.materials[node["extras"]["material"]], world[:3, 3],
                                             shape["sphere"]["radius"] * scale, world[:3, :3] / scale))
        for child in node.get("children", []):
            self.visit(child, world)

    def add_light(self, index, world):
        light = self.root["extensions"]["KHR_lights_punctual"]["lights"][index]
        spot = light.get("spot", {})
        self.scene.lights.append(Light(
            light["type"], np.array(light.get("color", [1, 1, 1]), float) * light.get("intensity", 1), world[:3, 3],
            unit(-world[:3, 2]), light.get("range", np.inf), np.cos(spot.get("innerConeAngle", 0)),
            np.cos(spot.get("outerConeAngle", np.pi / 4))))

    def corners(self, primitive, count):
        indices = self.accessor(primitive["indices"])[:, 0] if "indices" in primitive else np.arange(count)
        mode = primitive.get("mode", 4)
        if mode == 4:
            return indices.reshape(-1, 3)
        i = np.arange(len(indices) - 2)
        order = {5: [i, i + 1 + i % 2, i + 2 - i % 2], 6: [i + 1, i + 2, 0 * i]}[mode]
        return indices[np.stack(order, -1)]

    def add_primitive(self, name, primitive, world):
        linear, mirrored = world[:3, :3], np.linalg.det(world[:3, :3]) < 0
        attributes = {key: self.accessor(value) for key, value in primitive["attributes"].items()}
        points = attributes["POSITION"] @ linear.T + world[:3, 3]
        corners = self.corners(primitive, len(points))
        if mirrored:
            corners = corners[:, [0, 2, 1]]
        positions = points[corners]
        flat = unit(np.cross(positions[:, 1] - positions[:, 0], positions[:, 2] - positions[:, 0]))
        normals = unit(attributes["NORMAL"] @ np.linalg.inv(linear))[corners] if "NORMAL" in attributes else np.repeat(flat[:, None], 3, 1)
        zeros = np.zeros((len(points), 2))
        uvs = [attributes.get("TEXCOORD_%d" % k, zeros)[corners] for k in range(2)]
        colors = attributes.get("COLOR_0", np.ones((len(points), 4)))
        if colors.shape[1] == 3:
            colors = np.concatenate([colors, np.ones((len(colors), 1))], -1)
        if "TANGENT" in attributes:
            t = attributes["TANGENT"]
            tangents = np.concatenate([unit(t[:, :3] @ linear.T), t[:, 3:] * (-1 if mirrored else 1)], -1)[corners]
        else:
            tangents = self.flat_tangents(positions, normals, uvs[0])
        self.scene.meshes.append(Mesh(name, self.materials[primitive["material"]], positions, normals, uvs, tangents, colors[corners]))

    @staticmethod
    def flat_tangents(positions, normals, uvs):
        """dP/du and the sign that makes cross(N, T) w point towards smaller v: MikkTSpace's answer on flat faces."""
        edge1, edge2 = positions[:, 1] - positions[:, 0], positions[:, 2] - positions[:, 0]
        (u1, v1), (u2, v2) = (uvs[:, 1] - uvs[:, 0]).T, (uvs[:, 2] - uvs[:, 0]).T
        determinant = (u1 * v2 - u2 * v1)[:, None]
        inverse = np.divide(1, determinant, out=np.zeros_like(determinant), where=determinant != 0)
        along_u = (edge1 * v2[:, None] - edge2 * v1[:, None]) * inverse
        along_v = (edge2 * u1[:, None] - edge1 * u2[:, None]) * inverse
        sign = np.sign(np.sum(np.cross(normals[:, 0], along_u) * -along_v, -1))
        length = np.linalg.norm(along_u, axis=-1, keepdims=True)
        direction = np.divide(along_u, length, out=np.zeros_like(along_u), where=length > 0)
        return np.repeat(np.concatenate([direction, sign[:, None]], -1)[:, None], 3, 1)


def read_scene(path):
    return Reader(path).scene

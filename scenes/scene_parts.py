# SPDX-License-Identifier: MIT
"""The list of scenes, and parts that several of them are made of."""

from geometry import QUAD_INDICES, join_quads, quad_normals

SCENES = {}


def scene(name):
    """Registers a function that fills the scene of that name."""
    def register(fill):
        SCENES[name] = fill
        return fill
    return register


def place_quad(gltf, name, corners, material, parent=None, uvs=None, **place):
    primitive = gltf.primitive(corners, QUAD_INDICES, material, quad_normals(corners), uvs)
    return gltf.place_mesh(name, primitive, parent=parent, **place)


def place_faces(gltf, name, faces, material, **place):
    positions, indices = join_quads(faces)
    normals = [normal for face in faces for normal in quad_normals(face)]
    return gltf.place_mesh(name, gltf.primitive(positions, indices, material, normals), **place)

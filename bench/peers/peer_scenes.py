# SPDX-License-Identifier: MIT
"""The scenes of compare.py: for us as glTF, for the peers as a JSON file with the same numbers.

{"kind": "cornell-box" | "room-ball" | "matt-ball" | "many-lights" | "asset", "gltf": path, "environment": path or null,
 "camera": {"eye", "target", "fov_degrees" (vertical)},
 "meshes": [{"name", "positions": [[x y z]], "indices", "color", "radiance" (lamps only)}]}  (none for an asset)
"""

import json
import math
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scenes"))

import geometry  # noqa: E402
import gi_scenes  # noqa: E402
from gltf_writer import GltfWriter, normalize  # noqa: E402

# The numbers of mi.cornell_box(): a cube of 2 m about the origin, open towards +z.
WHITE, GREEN, RED = (0.885809, 0.698859, 0.666422), (0.105421, 0.37798, 0.076425), (0.570068, 0.0430135, 0.0443706)
RADIANCE = (18.387, 13.9873, 6.75357)
CAMERA = {"eye": (0, 0, 3.9), "target": (0, 0, 0), "fov_degrees": 39.3077}
BALL_CELLS = 76  # a face of the cube it is made of: 12 * 76^2 = 69,312 triangles
GREY = (0.6, 0.6, 0.6)
OPEN_CAMERA = {"eye": (0, 1.6, 3.2), "target": (0, 0.5, 0), "fov_degrees": 40}


def quad_mesh(name, faces, color, **more):
    positions, indices = geometry.join_quads(faces)
    return {"name": name, "positions": [tuple(map(float, p)) for p in positions], "indices": indices, "color": color, **more}


def room():
    walls = geometry.box_faces((-1, -1, -1), (1, 1, 1))
    front, right, back, left, ceiling, floor = map(geometry.flip, walls)
    del front
    lamp = [(x, 0.99, 0.01 + z) for x, _, z in geometry.flip(geometry.ground(0.23, 0.19))]
    return [quad_mesh("white-walls", [back, ceiling, floor], WHITE), quad_mesh("green-wall", [right], GREEN),
            quad_mesh("red-wall", [left], RED), quad_mesh("lamp", [lamp], WHITE, radiance=RADIANCE)]


def turned_box(name, middle, half, degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    faces = geometry.box_faces(tuple(-h for h in half), half)
    placed = [[(c * x + s * z + middle[0], y + middle[1], c * z - s * x + middle[2]) for x, y, z in face] for face in faces]
    return quad_mesh(name, placed, WHITE)


def boxes():
    return [turned_box("small-box", (0.335, -0.7, 0.38), (0.3, 0.3, 0.3), -17),
            turned_box("large-box", (-0.33, -0.4, -0.28), (0.3, 0.61, 0.3), 18.25)]


def ball(middle=(0, -0.35, 0), radius=0.6, bump=0.05, cells=BALL_CELLS):
    """Cuts a cube's faces into cells and blows it up to a ball with bumps. Corners at the same place are one vertex,
    also on the cube's edges."""
    places, positions, indices = {}, [], []

    def corner(origin, right, up, i, j):
        cube = tuple(round(o + r * i / cells + u * j / cells, 9) for o, r, u in zip(origin, right, up))
        if cube not in places:
            # Equal angles instead of equal steps: cells of about the same size.
            d = normalize(tuple(math.tan(x * math.pi / 4) for x in cube))
            r = radius * (1 + bump * math.sin(14 * d[0]) * math.sin(14 * d[1] + 1) * math.sin(14 * d[2] + 2))
            places[cube] = len(positions)
            positions.append(tuple(round(m + r * x, 7) for m, x in zip(middle, d)))
        return places[cube]

    for face in geometry.box_faces((-1, -1, -1), (1, 1, 1)):
        origin, right, up = face[0], *[[b - a for a, b in zip(face[0], face[k])] for k in (1, 3)]
        for i in range(cells):
            for j in range(cells):
                a, b, c, d = (corner(origin, right, up, i + p, j + q) for p, q in ((0, 0), (1, 0), (1, 1), (0, 1)))
                indices += [a, b, c, a, c, d]
    return [{"name": "ball", "positions": positions, "indices": indices, "color": WHITE}]


def ball_on_ground():
    """Returns the meshes of a smooth matt ball on the ground, for an environment."""
    return [{**ball(middle=(0, 0.6, 0), bump=0)[0], "color": GREY}, quad_mesh("ground", [geometry.ground(4, 4)], GREY)]


class MattMeshes:
    """Stands in for a GltfWriter: keeps what a scene of scenes/ adds as meshes without any gloss. Spheres become triangles, and lamps get black
    backs: ours are not there from behind, the peers' are."""

    def __init__(self):
        self.meshes, self.camera = [], None

    def add_lambert(self, name, color):
        return {"color": color}

    def add_material(self, name, color, *_):
        return {"color": color}

    def add_lamp(self, name, radiance):
        return {"color": (0, 0, 0), "radiance": radiance}

    def primitive(self, positions, indices, material, *_):
        return {"positions": positions, "indices": indices, **material}

    def place_mesh(self, name, mesh, **_):
        self.meshes.append({"name": name, **mesh})
        if "radiance" in mesh:
            behind = [(x, y + 0.002, z) for x, y, z in mesh["positions"]]
            self.meshes.append({"name": name + "-back", "positions": behind, "indices": mesh["indices"][::-1], "color": (0, 0, 0)})

    def add_sphere(self, name, radius, material, translation):
        self.meshes.append({**ball(translation, radius, bump=0, cells=16)[0], "name": name, **material})

    def add_camera(self, name, eye, target, fov_degrees):
        self.camera = {"eye": eye, "target": target, "fov_degrees": fov_degrees}


def write_gltf(folder, name, meshes, camera=CAMERA):
    gltf = GltfWriter(folder, name)
    for mesh in meshes:
        make = gltf.add_lamp if "radiance" in mesh else gltf.add_lambert
        material = make(mesh["name"], mesh.get("radiance", mesh["color"]))
        if "radiance" in mesh:
            gltf.root["materials"][material]["pbrMetallicRoughness"]["baseColorFactor"] = [*mesh["color"], 1]
        gltf.place_mesh(mesh["name"], gltf.primitive(mesh["positions"], mesh["indices"], material, index_component="I"))
    gltf.add_camera("camera", camera["eye"], camera["target"], camera["fov_degrees"])
    gltf.write()
    return folder / (name + ".gltf")


def write_scene(folder, description):
    path = Path(folder) / (description["kind"] + ".json")
    path.write_text(json.dumps(description), encoding="utf-8")
    return path


def matt_scene(folder, kind, environment=None):
    """Makes a scene of any kind except an asset."""
    camera = CAMERA
    if kind == "many-lights":
        kept = MattMeshes()
        gi_scenes.many_lights(kept)
        meshes, camera = kept.meshes, kept.camera
    elif kind == "matt-ball":
        meshes, camera = ball_on_ground(), OPEN_CAMERA
    else:
        meshes = room() + (boxes() if kind == "cornell-box" else ball())
    gltf = write_gltf(Path(folder), kind, meshes, camera)
    return write_scene(folder, {"kind": kind, "gltf": str(gltf), "camera": camera, "meshes": meshes,
                                "environment": environment and str(Path(environment).resolve())})


def asset_scene(folder, program, asset, environment):
    """Makes the scene of an asset. The camera is where fragtrace puts it in a scene without one: in front, somewhat
    above."""
    info = json.loads(subprocess.run([program, "info", asset, "--json"], check=True, capture_output=True, text=True).stdout)
    low, high = (info["scene"]["bounds"][end] for end in ("min", "max"))
    middle = [(a + b) / 2 for a, b in zip(low, high)]
    radius = math.dist(low, high) / 2
    away = normalize((0.3, 0.35, 1))
    camera = {"eye": [m + 2.2 * radius * d for m, d in zip(middle, away)], "target": middle, "fov_degrees": 45}
    return write_scene(folder, {"kind": "asset", "gltf": str(Path(asset).resolve()), "camera": camera, "meshes": [],
                                "environment": str(Path(environment).resolve())})

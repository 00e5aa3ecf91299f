#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The stages flat to normal-maps of docs/design/surfaces.md, traced by brute force in doubles: references for the picture tests.

Usage: trace_stages.py [NAME...]   those references of references.json; default all that this script makes.
       trace_stages.py --preview FILE.png SCENE STAGE [SIZE [CAMERA]]
"""

import json
import sys
from dataclasses import dataclass

import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")

from gltf_scene import read_scene, unit
from reference_files import FOLDER, write_reference
from surroundings import Surroundings
from textures_and_noise import perlin_normal, sample

STAGES = ["flat", "phong", "shadows", "reflections", "refraction", "normal-maps"]
SCENES = FOLDER.parent.parent / "scenes"
MIRROR_SPLITS = 3  # at so many glass boundaries both ways are followed, at later ones a random one
RAY_LEAVES_BY = 1e-9
LEAST_COSINE = 0.001


def dot(a, b):
    return np.sum(a * b, -1)


@dataclass
class Hits:
    """The hits of rays; item is the index of a mesh or sphere, -1 for nothing."""
    distance: np.ndarray
    item: np.ndarray
    triangle: np.ndarray
    weights: np.ndarray


@dataclass
class Points:
    """Hit points of one item, ready to be shaded; normals lie on the side the rays come from."""
    material: object
    position: np.ndarray
    geometric_normal: np.ndarray
    normal: np.ndarray
    front: np.ndarray
    color: np.ndarray
    alpha: np.ndarray


class Tracer:
    def __init__(self, scene, stage, bounces=16, background=(0, 0, 0), surroundings=None, seed=0):
        self.scene, self.bounces, self.background = scene, bounces, np.array(background, float)
        self.surroundings = surroundings
        self.items = scene.meshes + scene.spheres
        level = STAGES.index(stage)
        self.phong, self.shadows, self.reflections, self.refraction, self.normal_maps = (level >= k for k in range(1, 6))
        self.random = np.random.default_rng(seed)

    # Rays against the scene

    def nearest(self, origin, direction):
        """The nearest surface that is there for these rays; alpha holes not yet considered."""
        n = len(origin)
        hits = Hits(np.full(n, np.inf), np.full(n, -1), np.zeros(n, int), np.zeros((n, 2)))
        for index, item in enumerate(self.items):
            if hasattr(item, "positions"):
                self.meet_triangles(hits, index, item, origin, direction)
            else:
                self.meet_sphere(hits, index, item, origin, direction)
        return hits

    @staticmethod
    def meet_triangles(hits, index, mesh, origin, direction):
        """Intersects triangles by Moeller and Trumbore, Fast, Minimum Storage Ray/Triangle Intersection, 1997."""
        for k, (a, b, c) in enumerate(mesh.positions):
            edge1, edge2 = b - a, c - a
            p = np.cross(direction, edge2)
            determinant = p @ edge1
            faces = determinant != 0 if mesh.material.two_sided() else determinant > 0
            inverse = 1 / np.where(faces, determinant, 1)
            s = origin - a
            u = dot(s, p) * inverse
            q = np.cross(s, edge1)
            v = dot(direction, q) * inverse
            t = (q @ edge2) * inverse
            met = faces & (u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0) & (t < hits.distance)
            hits.distance[met], hits.item[met], hits.triangle[met] = t[met], index, k
            hits.weights[met] = np.stack([u, v], -1)[met]

    @staticmethod
    def meet_sphere(hits, index, sphere, origin, direction):
        s = origin - sphere.center
        b = dot(s, direction)
        root = b * b - dot(s, s) + sphere.radius ** 2
        half = np.sqrt(np.maximum(root, 0))
        for t, there in ((-b - half, True), (-b + half, sphere.material.two_sided())):
            met = there & (root > 0) & (t > 0) & (t < hits.distance)
            hits.distance[met], hits.item[met] = t[met], index

    def points(self, hits, chosen, origin, direction):
        """Interpolates one item's surface at the chosen rays."""
        item = self.items[hits.item[chosen[0]]]
        position = origin[chosen] + hits.distance[chosen, None] * direction[chosen]
        if hasattr(item, "positions"):
            k, (u, v) = hits.triangle[chosen], hits.weights[chosen].T
            weights = np.stack([1 - u - v, u, v], -1)[..., None]
            corners = item.positions[k]
            geometric = unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
            normal = unit(np.sum(item.normals[k] * weights, 1))
            tangent = np.sum(item.tangents[k] * weights, 1)
            uvs = [np.sum(uv[k] * weights, 1) for uv in item.uvs]
            color = np.sum(item.colors[k] * weights, 1)
        else:
            geometric = normal = unit(position - item.center)
            q = normal @ item.axes
            uvs = [np.stack([np.arctan2(q[:, 2], q[:, 0]) / (2 * np.pi) + 0.5, np.arccos(np.clip(q[:, 1], -1, 1)) / np.pi], -1)] * 2
            along_u = unit(np.stack([-q[:, 2], 0 * q[:, 0], q[:, 0]], -1)) @ item.axes.T
            # The bitangent is -dP/dv: +y at the equator, where cross(N, T) points down.
            tangent = np.concatenate([along_u, np.full((len(q), 1), -1.0)], -1)
            color = np.ones((len(q), 4))
        material = item.material
        if self.normal_maps:
            normal = self.mapped(material, normal, tangent, uvs)
        front = dot(geometric, direction[chosen]) < 0
        side = np.where(front, 1.0, -1.0)[:, None]
        color = color * material.color
        if material.color_texture:
            color = color * sample(material.color_texture, uvs[material.color_texture.coordinate_set])
        normal = facing(normal * side, -direction[chosen])
        return Points(material, position, geometric * side, normal, front, color[:, :3], color[:, 3])

    @staticmethod
    def mapped(material, normal, tangent, uvs):
        if material.perlin:
            local = perlin_normal(material.perlin, uvs[0])
        elif material.normal_texture:
            texture = material.normal_texture
            local = (2 * sample(texture, uvs[texture.coordinate_set])[:, :3] - 1) * [material.normal_scale, material.normal_scale, 1]
        else:
            return normal
        bitangent = np.cross(normal, tangent[:, :3]) * tangent[:, 3:]
        return unit(local[:, :1] * tangent[:, :3] + local[:, 1:2] * bitangent + local[:, 2:] * normal)

    def passes(self, points):
        """Returns true where a ray passes through a hole of MASK or, by chance, of BLEND. This is decided once for each
        crossing."""
        mode = points.material.alpha_mode
        if mode == "MASK":
            return points.alpha < points.material.alpha_cutoff
        if mode == "BLEND":
            return self.random.random(len(points.alpha)) >= points.alpha
        return np.zeros(len(points.alpha), bool)

    def solid_hits(self, origin, direction):
        """Returns the distances to the nearest surfaces without holes, and for each item the rays that met it with
        their points."""
        hits = self.nearest(origin, direction)
        distance, groups = hits.distance.copy(), []
        for index in np.unique(hits.item[hits.item >= 0]):
            chosen = np.flatnonzero(hits.item == index)
            points = self.points(hits, chosen, origin, direction)
            passes = self.passes(points)
            groups.append((chosen[~passes], select(points, ~passes)))
            passed = chosen[passes]
            if len(passed):
                start = hits.distance[passed] + RAY_LEAVES_BY
                further, groups_behind = self.solid_hits(origin[passed] + start[:, None] * direction[passed], direction[passed])
                distance[passed] = start + further
                groups += [(passed[behind], points_behind) for behind, points_behind in groups_behind]
        return distance, groups

    def blocked(self, origin, direction, limit):
        has_holes = any(item.material.alpha_mode != "OPAQUE" for item in self.items)
        distance = self.solid_hits(origin, direction)[0] if has_holes else self.nearest(origin, direction).distance
        return distance < limit

    # Shading

    def light_at(self, light, position):
        """Direction to a light, distance to it, and its irradiance on a surface that faces it."""
        n = len(position)
        if light.kind == "directional":
            return np.broadcast_to(-light.direction, (n, 3)), np.full(n, np.inf), np.broadcast_to(light.radiant, (n, 3))
        offset = light.position - position
        distance = np.linalg.norm(offset, axis=-1)
        towards = offset / distance[:, None]
        factor = np.maximum(np.minimum(1 - (distance / light.range) ** 4, 1), 0) / distance ** 2
        if light.kind == "spot":
            scale = 1 / max(0.001, light.inner_cosine - light.outer_cosine)
            falloff = np.clip((dot(-towards, light.direction) - light.outer_cosine) * scale, 0, 1)
            factor = factor * falloff ** 2
        return towards, distance, factor[:, None] * light.radiant

    def shade(self, points, outgoing):
        """Emission, ambient and punctual light of the phong stage."""
        material, normal = points.material, points.normal
        result = material.emission + 0.03 * points.color
        f0 = self.f0(points)
        exponent = 2 / max(material.roughness ** 4, 0.001) - 2
        for light in self.scene.lights:
            towards, distance, irradiance = self.light_at(light, points.position)
            cosine = np.maximum(dot(normal, towards), 0)
            half = unit(outgoing + towards)
            lobe = (exponent + 8) / (8 * np.pi) * np.maximum(dot(normal, half), 0) ** exponent
            reflected = (1 - material.metallic) * points.color / np.pi + f0 * lobe[:, None]
            lit = (cosine > 0) & (dot(points.geometric_normal, towards) > 0)
            if self.shadows:
                start = points.position + RAY_LEAVES_BY * points.geometric_normal
                lit[lit] = ~self.blocked(start[lit], towards[lit], distance[lit])
            result = result + np.where(lit[:, None], irradiance * cosine[:, None] * reflected, 0)
        if self.surroundings:
            assert not f0.any(), "highlights of the environment have no reference"
            result = result + (1 - material.metallic) * points.color / np.pi * self.surroundings.irradiance(normal)
        return result

    @staticmethod
    def f0(points):
        m = points.material
        dielectric = np.minimum(((m.ior - 1) / (m.ior + 1)) ** 2 * m.specular_color, 1) * m.specular
        return dielectric * (1 - m.metallic) + points.color * m.metallic

    def mirror_weight(self, points, cosine):
        m = points.material
        f0, f90 = self.f0(points), m.specular * (1 - m.metallic) + m.metallic
        return (f0 + (f90 - f0) * (1 - cosine[:, None]) ** 5) * (1 - m.roughness) ** 2

    # Paths

    def radiance(self, origin, direction):
        """Returns the expected radiance along camera rays."""
        result = np.zeros((len(origin), 3))
        ray = np.arange(len(origin))
        weight, scatterings, splits = np.ones((len(origin), 3)), np.zeros(len(origin), int), np.zeros(len(origin), int)
        while len(ray):
            distance, groups = self.solid_hits(origin, direction)
            missed = np.isinf(distance)
            if self.surroundings:
                result[ray[missed]] += weight[missed] * self.surroundings.radiance(direction[missed])
            else:
                seen = missed & (scatterings == 0)
                result[ray[seen]] += weight[seen] * self.background
            children = []
            for chosen, points in groups:
                state = ray[chosen], weight[chosen], scatterings[chosen], splits[chosen]
                children += self.meet(result, points, -direction[chosen], distance[chosen], *state)
            if not children:
                break
            origin, direction, ray, weight, scatterings, splits = (np.concatenate(parts) for parts in zip(*children))
        return result

    def meet(self, result, points, outgoing, distance, ray, weight, scatterings, splits):
        """Adds what the points send back, and returns the rays that continue from them."""
        material = points.material
        if not self.phong or material.unlit:
            np.add.at(result, ray, weight * points.color)
            return []
        transmits = material.transmission * (1 - material.metallic) if self.refraction else 0
        if transmits and material.thickness:
            inside = np.where(points.front, 0, distance)[:, None]
            weight = weight * material.attenuation_color ** (inside / material.attenuation_distance)
        children = []
        if transmits < 1:
            part = weight * (1 - transmits)
            np.add.at(result, ray, part * self.shade(points, outgoing))
            if self.reflections and material.roughness < 1:
                cosine = np.maximum(dot(points.normal, outgoing), 0)
                mirrored = part * self.mirror_weight(points, cosine)
                direction = 2 * dot(points.normal, outgoing)[:, None] * points.normal - outgoing
                children.append(self.leave(points, direction, 1, ray, mirrored, scatterings, splits))
        if transmits > 0:
            children += self.glass(points, outgoing, ray, weight * transmits, scatterings, splits)
        return children

    def leave(self, points, direction, side, ray, weight, scatterings, splits):
        """The rays that may scatter once more; side is 1 before the surface and -1 behind it.

        A mapped normal can send a ray to the wrong side of the surface; such a ray carries nothing.
        """
        right_side = side * dot(direction, points.geometric_normal) > 0
        on = right_side & (scatterings < self.bounces) & (weight.max(-1) > 0)
        start = points.position + RAY_LEAVES_BY * side * points.geometric_normal
        return start[on], unit(direction)[on], ray[on], weight[on], scatterings[on] + 1, splits[on]

    def glass(self, points, outgoing, ray, weight, scatterings, splits):
        """Reflects and refracts at a smooth boundary by Snell's and Fresnel's laws."""
        material = points.material
        normal, cosine = points.normal, dot(points.normal, outgoing)
        solid = material.thickness > 0
        eta = np.where(points.front | (not solid), material.ior, 1 / material.ior)
        sine_squared = (1 - cosine ** 2) / eta ** 2
        total = sine_squared >= 1
        refracted_cosine = np.sqrt(np.maximum(1 - sine_squared, 0))
        parallel = (eta * cosine - refracted_cosine) / (eta * cosine + refracted_cosine)
        perpendicular = (cosine - eta * refracted_cosine) / (cosine + eta * refracted_cosine)
        reflectance = np.where(total, 1, (parallel ** 2 + perpendicular ** 2) / 2)
        mirrored = 2 * cosine[:, None] * normal - outgoing
        through = (cosine / eta - refracted_cosine)[:, None] * normal - outgoing / eta[:, None]
        if not solid:
            reflectance = 2 * reflectance / (1 + reflectance)
            through = -outgoing
        # Both ways while the path is young, then one by chance.
        both = splits < MIRROR_SPLITS
        drawn = self.random.random(len(ray)) < reflectance
        reflected_part = np.where(both, reflectance, drawn)[:, None]
        refracted_part = np.where(both, 1 - reflectance, ~drawn)[:, None] * points.color
        return [self.leave(points, direction, side, ray, weight * part, scatterings, splits + 1)
                for direction, side, part in ((mirrored, 1, reflected_part), (through, -1, refracted_part))]


def facing(normal, outgoing):
    """A mapped normal that points away from the viewer is turned until it is just above the horizon."""
    lack = LEAST_COSINE - dot(normal, outgoing)
    return np.where(lack[:, None] > 0, unit(normal + np.maximum(lack, 0)[:, None] * outgoing), normal)


def select(points, kept):
    return Points(points.material, points.position[kept], points.geometric_normal[kept], points.normal[kept], points.front[kept],
                  points.color[kept], points.alpha[kept])


def camera_rays(camera, width, height, x, y):
    """Returns the rays through picture coordinates in pixels, with (0, 0) at the top left corner."""
    to_world = camera.to_world
    across, up = (2 * x / width - 1) * width / height, 1 - 2 * y / height
    if camera.yfov:
        half = np.tan(camera.yfov / 2)
        local = np.stack([half * across, half * up, -np.ones_like(x)], -1)
        return np.broadcast_to(to_world[:3, 3], local.shape), unit(local @ to_world[:3, :3].T)
    start = np.stack([camera.ymag * across, camera.ymag * up, np.zeros_like(x)], -1)
    return start @ to_world[:3, :3].T + to_world[:3, 3], np.broadcast_to(unit(-to_world[:3, 2]), start.shape)


def render(scene, stage, width, height, strata, seed, camera=0, **options):
    """One picture with strata x strata jittered samples per pixel."""
    tracer = Tracer(scene, stage, seed=seed, **options)
    picture = np.zeros((height, width, 3))
    row, column = np.mgrid[0:height, 0:width].reshape(2, -1)
    for i in range(strata):
        for j in range(strata):
            x, y = tracer.random.random((2, len(row)))
            origin, direction = camera_rays(scene.cameras[camera], width, height, column + (j + x) / strata, row + (i + y) / strata)
            picture += tracer.radiance(origin, direction).reshape(height, width, 3)
    return picture / strata ** 2


def option_value(options, name, default):
    return options[options.index(name) + 1] if name in options else default


def make_reference(entry):
    if entry["made_by"] == "constant":
        return write_reference(entry["name"], np.ones((2, *entry["resolution"][::-1], 3)) * entry["value"])
    scene = read_scene(SCENES / (entry["scene"] + ".gltf"))
    stage, options = entry.get("traced_as", entry["stage"]), entry["options"]
    background = [float(x) for x in option_value(options, "--background-color", "0,0,0").split(",")]
    width, height = entry["resolution"]
    surroundings = None
    if "--hdri-file" in options:
        surroundings = Surroundings(SCENES.parent / option_value(options, "--hdri-file", ""), float(option_value(options, "--hdri-rotation", 0)))
    batches = [render(scene, stage, width, height, entry["strata"], seed, int(option_value(options, "--camera-index", 0)),
                      background=background, surroundings=surroundings, bounces=int(option_value(options, "--bounces", 16)))
               for seed in range(entry["batches"])]
    return write_reference(entry["name"], batches)


def main():
    arguments = sys.argv[1:]
    if arguments[:1] == ["--preview"]:
        path, name, stage, size, camera = arguments[1:] + ["200", "0"][len(arguments) - 4:]
        picture = render(read_scene(SCENES / (name + ".gltf")), stage, int(size), int(size), 2, 0, int(camera), background=(0.2, 0.2, 0.2))
        mi.util.write_bitmap(path, mi.Bitmap(picture.astype(np.float32)), write_async=False)
        return
    for entry in json.loads((FOLDER / "references.json").read_text())["references"]:
        mine = entry["made_by"] in ("trace_stages", "constant") and "same_as" not in entry
        if mine and (not arguments or entry["name"] in arguments):
            make_reference(entry)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Renders one scene of peer_scenes.py in Mitsuba 3, again and again on request. Started by compare.py.

usage: mitsuba_worker.py SCENE.json VARIANT RESOLUTION (plain | defaults)
Each line of stdin is {"spp", "seed", "output"}, and "sampler" if it is to be another than independent; each answer {"wall", "cpu", "samples"}: seconds
for drawing alone, and the samples per pixel has, since some samplers round them up. The first request of a number of samples is drawn twice,
so that its kernels are compiled. plain: no Russian roulette; defaults: Mitsuba's.
"""

import json
import sys
import time
from pathlib import Path

import drjit as dr
import mitsuba as mi
import numpy as np

PASS_SAMPLES = 1 << 24  # at once: bounds the memory


def make_mesh(name, positions, indices, normals=None, uvs=None, **properties):
    """Flat faces where no normals are given."""
    props = mi.Properties()
    for key, value in properties.items():
        props[key] = mi.load_dict(value)
    mesh = mi.Mesh(name, len(positions), len(indices) // 3, has_vertex_normals=normals is not None,
                   has_vertex_texcoords=uvs is not None, props=props)
    parameters = mi.traverse(mesh)
    for key, values in (("vertex_positions", positions), ("vertex_normals", normals), ("vertex_texcoords", uvs)):
        if values is not None:
            parameters[key] = type(parameters[key])(np.asarray(values, np.float32).ravel())
    parameters["faces"] = type(parameters["faces"])(np.asarray(indices, np.uint32))
    parameters.update()
    return mesh


def rgb(values):
    return {"type": "rgb", "value": [float(x) for x in values[:3]]}


def room(description):
    """Mitsuba's own box; for the other room its boxes make place for the ball."""
    scene = mi.cornell_box()
    if description["kind"] == "room-ball":
        del scene["small-box"], scene["large-box"]
        ball = next(m for m in description["meshes"] if m["name"] == "ball")
        scene["ball"] = make_mesh("ball", ball["positions"], ball["indices"],
                                  bsdf={"type": "diffuse", "reflectance": rgb(ball["color"])})
    return scene


def matt(description):
    """The meshes of the description, as they are."""
    scene = {"type": "scene"}
    for i, mesh in enumerate(description["meshes"]):
        light = {"emitter": {"type": "area", "radiance": rgb(mesh["radiance"])}} if "radiance" in mesh else {}
        scene["mesh%d" % i] = make_mesh(mesh["name"], mesh["positions"], mesh["indices"], bsdf={"type": "diffuse", "reflectance": rgb(mesh["color"])}, **light)
    if description["environment"]:
        scene["environment"] = environment(description["environment"])
    return scene


# The asset: Mitsuba's principled BSDF with the same textures. Its diffuse part and its Fresnel term are not quite glTF's.

def bitmap(texels):
    return {"type": "bitmap", "bitmap": mi.Bitmap(np.ascontiguousarray(texels, np.float32)), "raw": True}


def principled(material):
    color, packed = material.color_texture, material.metallic_roughness_texture
    result = {"type": "principled", "specular": 0.5,
              "base_color": bitmap(color.texels[..., :3] * material.color[:3]) if color else rgb(material.color)}
    for name, channel, factor in (("roughness", 1, material.roughness), ("metallic", 2, material.metallic)):
        result[name] = bitmap(packed.texels[..., channel:channel + 1] * factor) if packed else float(factor)
    if material.normal_texture:
        scaled = (2 * material.normal_texture.texels[..., :3] - 1) * [material.normal_scale, material.normal_scale, 1]
        result = {"type": "normalmap", "normalmap": bitmap((scaled + 1) / 2), "bsdf": result}
    if material.double_sided:
        result = {"type": "twosided", "bsdf": result}
    if material.alpha_mode == "BLEND":
        result = {"type": "mask", "bsdf": result,
                  "opacity": bitmap(color.texels[..., 3:] * material.color[3]) if color else float(material.color[3])}
    return result


def environment(path):
    """The same function of directions: u = 0.5 is glTF's +x; Mitsuba's nodes along v go from pole to pole, so twice as many rows hold our
    texels' middles."""
    texels = np.array(mi.Bitmap(path).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32)).astype(float)
    height = len(texels)
    rows = np.clip(np.arange(2 * height + 1) / 2 - 0.5, 0, height - 1)
    low = np.minimum(rows.astype(int), height - 2)
    part = (rows - low)[:, None, None]
    nodes = (1 - part) * texels[low] + part * texels[low + 1]
    return {"type": "envmap", "bitmap": mi.Bitmap(nodes.astype(np.float32)),
            "to_world": mi.ScalarTransform4f().rotate([0, 1, 0], 90)}


def asset(description):
    sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests/reference"))
    from gltf_scene import read_scene
    scene = {"type": "scene", "environment": environment(description["environment"])}
    for i, mesh in enumerate(read_scene(description["gltf"]).meshes):
        material, more = mesh.material, {}
        if material.emission.any():
            glow = material.emission_texture
            radiance = bitmap(glow.texels[..., :3] * material.emission) if glow else rgb(material.emission)
            more["emitter"] = {"type": "area", "radiance": radiance}
        scene["mesh%d" % i] = make_mesh(mesh.name, mesh.positions.reshape(-1, 3), np.arange(3 * len(mesh.positions)),
                                        mesh.normals, mesh.uvs[0], bsdf=principled(material), **more)
    return scene


def build(description, resolution, plain):
    scene = {"asset": asset, "cornell-box": room, "room-ball": room}.get(description["kind"], matt)(description)
    roulette = {"rr_depth": 1000} if plain else {}
    scene["integrator"] = {"type": "path", "max_depth": 8, **roulette}
    scene["sensor"] = camera_with("independent", description["camera"], resolution)
    return mi.load_dict(scene)


def camera_with(sampler, camera, resolution):
    return {"type": "perspective", "fov_axis": "y", "fov": camera["fov_degrees"], "near_clip": 1e-3, "far_clip": 1000.0,
            "to_world": mi.ScalarTransform4f().look_at(origin=camera["eye"], target=camera["target"], up=[0, 1, 0]),
            "film": {"type": "hdrfilm", "width": resolution, "height": resolution, "rfilter": {"type": "box"}, "pixel_format": "rgb",
                     "component_format": "float32"}, "sampler": {"type": sampler}}


def draw(scene, sensor, pixels, spp, seed):
    """Returns the picture, and the seconds it took by both clocks. spp: a power of two."""
    step = min(spp, 1 << max(0, (PASS_SAMPLES // pixels).bit_length() - 1))
    dr.sync_thread()
    wall, cpu, total = time.perf_counter(), time.process_time(), 0
    for k in range(spp // step):
        picture = mi.render(scene, sensor=sensor, spp=step, seed=seed * 4096 + k)
        dr.eval(picture)
        dr.sync_thread()
        total = total + np.array(picture) * (step / spp)
    seconds = {"wall": time.perf_counter() - wall, "cpu": time.process_time() - cpu}
    return total, {**seconds, "samples": sensor.sampler().sample_count() * (spp // step)}


def main():
    path, variant, resolution, settings = sys.argv[1:5]
    mi.set_variant(variant)
    mi.set_log_level(mi.LogLevel.Error)  # its warnings, such as of rounded numbers of samples, end in colour codes within the next line
    resolution, description = int(resolution), json.loads(Path(path).read_text(encoding="utf-8"))
    scene = build(description, resolution, settings == "plain")
    warm, sensors = set(), {}
    print("peer", json.dumps({"version": "Mitsuba " + mi.__version__ + " " + variant}), flush=True)
    for line in sys.stdin:
        request = json.loads(line)
        sampler, spp = request.get("sampler", "independent"), request["spp"]
        if sampler not in sensors:
            sensors[sampler] = mi.load_dict(camera_with(sampler, description["camera"], resolution))
        if (sampler, spp) not in warm and variant.startswith("llvm"):
            draw(scene, sensors[sampler], resolution ** 2, spp, 1000)
            warm.add((sampler, spp))
        picture, answer = draw(scene, sensors[sampler], resolution ** 2, spp, request["seed"])
        mi.Bitmap(picture.astype(np.float32)).write(request["output"])
        print("peer", json.dumps(answer), flush=True)


if __name__ == "__main__":
    main()

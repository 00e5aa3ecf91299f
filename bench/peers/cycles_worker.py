# SPDX-License-Identifier: MIT
"""Renders one scene of peer_scenes.py in Cycles, again and again on request. Started by compare.py.

usage: blender -b --factory-startup --python cycles_worker.py -- SCENE.json RESOLUTION (plain | roulette | adaptive)
(or python cycles_worker.py -- ... where the module bpy is installed). Each line of stdin is {"spp", "seed", "output"}; each answer
{"wall", "cpu"} in seconds: Cycles' own time of drawing, without building the scene; and CPU time, with it. plain: no Russian roulette;
roulette: with Cycles' own, from the first bounce on; adaptive: its adaptive sampling, too, "spp" being the most. Never clamping or denoising; the
box filter; equal bounces.
"""

import json
import math
import struct
import sys
import time
from array import array
from pathlib import Path

import bpy
from mathutils import Matrix, Vector

UPRIGHT = Matrix.Rotation(math.pi / 2, 4, "X")  # glTF's y is Blender's z


def node_material(name):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    material.node_tree.nodes.clear()
    return material, material.node_tree.nodes, material.node_tree.links


def plastic(mesh):
    """glTF's dielectric; its importer makes the same nodes of it."""
    material, nodes, links = node_material(mesh["name"])
    output, surface = nodes.new("ShaderNodeOutputMaterial"), nodes.new("ShaderNodeBsdfPrincipled")
    surface.inputs["Base Color"].default_value = (*mesh["color"], 1)
    surface.inputs["Roughness"].default_value = mesh["roughness"]
    links.new(surface.outputs[0], output.inputs["Surface"])
    return material


def matt(mesh):
    """Makes a diffuse surface. A lamp shines to the front only, as in the other renderers."""
    material, nodes, links = node_material(mesh["name"])
    output, diffuse = nodes.new("ShaderNodeOutputMaterial"), nodes.new("ShaderNodeBsdfDiffuse")
    diffuse.inputs["Color"].default_value = (*mesh["color"], 1)
    surface = diffuse.outputs[0]
    if "radiance" in mesh:
        strength = max(mesh["radiance"])
        emission, side, total = (nodes.new("ShaderNode" + kind) for kind in ("Emission", "NewGeometry", "AddShader"))
        front = nodes.new("ShaderNodeMath")
        front.operation, front.inputs[0].default_value = "SUBTRACT", 1
        links.new(side.outputs["Backfacing"], front.inputs[1])
        scaled = nodes.new("ShaderNodeMath")
        scaled.operation, scaled.inputs[1].default_value = "MULTIPLY", strength
        links.new(front.outputs[0], scaled.inputs[0])
        emission.inputs["Color"].default_value = (*[x / strength for x in mesh["radiance"]], 1)
        links.new(scaled.outputs[0], emission.inputs["Strength"])
        links.new(surface, total.inputs[0])
        links.new(emission.outputs[0], total.inputs[1])
        surface = total.outputs[0]
    links.new(surface, output.inputs["Surface"])
    return material


def add_object(name, data):
    item = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(item)
    return item


def add_mesh(mesh):
    data = bpy.data.meshes.new(mesh["name"])
    indices = mesh["indices"]
    data.from_pydata(mesh["positions"], [], [indices[i:i + 3] for i in range(0, len(indices), 3)])
    data.materials.append(plastic(mesh) if "roughness" in mesh else matt(mesh))
    if mesh.get("smooth"):
        data.polygons.foreach_set("use_smooth", [True] * len(data.polygons))
    add_object(mesh["name"], data).matrix_world = UPRIGHT


def add_light(light):
    """Adds a light of KHR_lights_punctual: points in W/sr, suns in W/m^2, both with hard shadows."""
    data = bpy.data.lights.new(light["name"], "POINT" if "position" in light else "SUN")
    data.color = light["color"]
    item = add_object(light["name"], data)
    if "position" in light:
        data.energy, data.shadow_soft_size = 4 * math.pi * light["intensity"], 0
        item.location = UPRIGHT @ Vector(light["position"])
    else:
        data.energy, data.angle = light["intensity"], 0
        item.matrix_world = (UPRIGHT @ Vector((*light["direction"], 0))).to_3d().to_track_quat("-Z", "Y").to_matrix().to_4x4()


def set_world(path):
    world = bpy.data.worlds.new("world")
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (0, 0, 0, 1)
    if path:
        texture = world.node_tree.nodes.new("ShaderNodeTexEnvironment")
        texture.image = bpy.data.images.load(path)
        world.node_tree.links.new(texture.outputs[0], background.inputs["Color"])
    bpy.context.scene.world = world


def set_camera(camera):
    data = bpy.data.cameras.new("camera")
    data.sensor_fit, data.clip_start, data.clip_end = "VERTICAL", 1e-3, 1000
    data.angle = math.radians(camera["fov_degrees"])
    item = add_object("camera", data)
    eye, target = (UPRIGHT @ Vector(camera[key]) for key in ("eye", "target"))
    item.matrix_world = Matrix.Translation(eye) @ (target - eye).to_track_quat("-Z", "Y").to_matrix().to_4x4()
    bpy.context.scene.camera = item


def set_renderer(resolution, settings, bounces=6):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x = scene.render.resolution_y = resolution
    scene.render.resolution_percentage = 100
    scene.render.use_persistent_data = True
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_mode, scene.render.image_settings.color_depth = "RGB", "32"
    cycles = scene.cycles
    cycles.device = "CPU"
    for name in ("max", "diffuse", "glossy", "transmission"):
        setattr(cycles, name + "_bounces", bounces)
    cycles.use_denoising = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.blur_glossy = 0
    cycles.pixel_filter_type = "BOX"
    cycles.use_adaptive_sampling = settings == "adaptive"  # the threshold stays as it is, 0.01
    cycles.min_light_bounces = bounces if settings == "plain" else 0  # Russian roulette begins after these


def exr_attributes(path):
    """The header's attributes, name to bytes."""
    data, result, at = Path(path).read_bytes(), {}, 8
    while data[at]:
        name, kind, rest = data[at:at + 4096].split(b"\0", 2)
        at += len(name) + len(kind) + 2
        size, = struct.unpack_from("<i", data, at)
        result[name.decode()] = data[at + 4:at + 4 + size]
        at += 4 + size
    return result


def seconds_of(text):
    """Returns the seconds of a text such as 01:02.34 or 1:01:02.34."""
    total = 0.0
    for part in text.split(":"):
        total = 60 * total + float(part)
    return total


def write_pfm(exr, path):
    image = bpy.data.images.load(exr)
    width, height = image.size
    pixels = array("f", bytes(16 * width * height))
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    colors = array("f", bytes(12 * width * height))
    for channel in range(3):
        colors[channel::3] = pixels[channel::4]
    with open(path, "wb") as file:
        file.write(b"PF\n%d %d\n-1.0\n" % (width, height))
        file.write(colors.tobytes())


def draw(spp, seed, output):
    scene = bpy.context.scene
    scene.cycles.samples, scene.cycles.seed = spp, seed
    exr = output + ".exr"
    scene.render.filepath = exr
    start = time.process_time()
    bpy.ops.render.render(write_still=True)
    cpu = time.process_time() - start
    times = {name.rsplit(".", 1)[1]: seconds_of(value.decode()) for name, value in exr_attributes(exr).items()
             if name.startswith("cycles.") and name.endswith("_time")}
    write_pfm(exr, output)
    Path(exr).unlink()
    return {"wall": times["render_time"], "cpu": cpu}


def main():
    path, resolution, settings = sys.argv[sys.argv.index("--") + 1:][:3]
    description = json.loads(Path(path).read_text(encoding="utf-8"))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    if description["kind"] == "asset":
        import numpy
        numpy.bool = bool  # Blender 3.4's importer asks for the name that numpy 1.24, which Debian ships with it, has no more
        bpy.ops.import_scene.gltf(filepath=description["gltf"])
    for mesh in description["meshes"]:
        add_mesh(mesh)
    for light in description.get("lights", []):
        add_light(light)
    set_world(description["environment"])
    set_camera(description["camera"])
    set_renderer(int(resolution), settings)
    kind = {"plain": "", "roulette": ", its roulette", "adaptive": ", its defaults"}[settings]
    print("peer", json.dumps({"version": f"Cycles {bpy.app.version_string}{kind}"}), flush=True)
    for line in sys.stdin:
        request = json.loads(line)
        print("peer", json.dumps(draw(request["spp"], request["seed"], request["output"])), flush=True)


if __name__ == "__main__":
    main()

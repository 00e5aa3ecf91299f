#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""References for the stage gi, rendered by Mitsuba 3 with the conventions of docs/design/conventions.md and surfaces.md.

Needs: pip install mitsuba==3.9.1; libLLVM (libllvm19). Usage: render_mitsuba.py [NAME...]
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import drjit as dr
import mitsuba as mi
import numpy as np

mi.set_variant("llvm_ad_rgb")

import gltf_bsdf  # noqa: F401, registers its materials
import gltf_layers  # noqa: F401, too
from gltf_scene import read_scene, unit
from reference_files import FOLDER, write_reference
from surroundings import environment_radiance, read_pfm

REPOSITORY = FOLDER.parent.parent
SCENES = REPOSITORY / "scenes"
PASS_SAMPLES = 1 << 22  # samples rendered at once: bounds the memory


class PunctualLight(mi.Emitter):
    """KHR_lights_punctual's point and spot lights, with the range window and the spot falloff that Mitsuba's lack."""

    def __init__(self, properties):
        super().__init__(properties)
        self.place = mi.Point3f(properties["position"])
        self.axis = mi.Vector3f(properties["direction"])
        self.radiant = mi.Color3f(properties["radiant"])
        self.range, self.is_spot = properties["range"], properties["spot"]
        self.scale = 1 / max(0.001, properties["inner_cosine"] - properties["outer_cosine"])
        self.outer_cosine = properties["outer_cosine"]
        self.m_flags = mi.EmitterFlags.DeltaPosition

    def sample_direction(self, it, sample, active=True):
        offset = self.place - it.p
        ds = dr.zeros(mi.DirectionSample3f)
        ds.p, ds.time, ds.pdf, ds.delta = self.place, it.time, 1.0, True
        ds.dist = dr.norm(offset)
        ds.d = offset / ds.dist
        ds.emitter = mi.EmitterPtr(self)
        factor = dr.clip(1 - (ds.dist / self.range) ** 4, 0, 1) / dr.square(ds.dist)
        if self.is_spot:
            factor *= dr.square(dr.clip((dr.dot(-ds.d, self.axis) - self.outer_cosine) * self.scale, 0, 1))
        return ds, self.radiant * factor & active

    def eval_direction(self, it, ds, active=True):
        return self.sample_direction(it, mi.Point2f(0), active)[1]

    def pdf_direction(self, it, ds, active=True):
        return mi.Float(0)

    def eval(self, si, active=True):
        return mi.Color3f(0)

    def bbox(self):
        return mi.BoundingBox3f(self.place)


mi.register_emitter("punctual", PunctualLight)


def rgb(values):
    return {"type": "rgb", "value": [float(x) for x in values[:3]]}


def bitmap(texture, texels):
    """A texture with other texels, taken as linear; both Mitsuba and glTF count v from the top row."""
    assert texture.wrap == ("repeat", "repeat") and texture.coordinate_set == 0
    return {"type": "bitmap", "bitmap": mi.Bitmap(np.ascontiguousarray(texels, np.float32)), "raw": True,
            "filter_type": "nearest" if texture.nearest else "bilinear"}


def colored(texture, factor):
    return bitmap(texture, texture.texels[..., :3] * factor[:3]) if texture else rgb(factor)


def channel(texture, index, factor=1.0):
    return bitmap(texture, np.repeat(texture.texels[..., index:index + 1] * factor, 3, -1))


def glass(material):
    """Mitsuba's own where it has one. Its G is the separable one: at the roughness of these scenes it differs from appendix B's only near
    grazing, by less than the noise."""
    assert material.metallic == 0
    if material.thickness > 0:
        assert (material.color == 1).all()
        if material.ior == 1:
            return {"type": "null"}
        indices = {"int_ior": material.ior, "ext_ior": 1.0}
        if material.roughness == 0:
            return {"type": "dielectric", **indices}
        return {"type": "roughdielectric", "distribution": "ggx", "alpha": material.roughness ** 2, **indices}
    if material.roughness == 0:
        return {"type": "thindielectric", "int_ior": material.ior, "ext_ior": 1.0, "specular_transmittance": rgb(material.color)}
    return {"type": "thin-rough-glass", "tint": material.color[:3].tolist(), "ior": material.ior, "roughness": material.roughness}


def opaque(material, compensated, vertex_colors):
    color = colored(material.color_texture, material.color)
    if vertex_colors:
        assert not material.color_texture
        color = {"type": "mesh_attribute", "name": "vertex_color"}
    if material.metallic == 1 and material.roughness == 0:
        assert (material.color == 1).all()
        return {"type": "conductor", "material": "none"}
    if material.specular == 0 and material.metallic == 0:
        return {"type": "diffuse", "reflectance": color}
    result = {"type": "gltf", "base_color": color, "compensated": compensated, "specular_color": material.specular_color.tolist(),
              **{name: float(getattr(material, name)) for name in ("metallic", "roughness", "ior", "specular")}}
    maps = {"metallic_roughness_map": material.metallic_roughness_texture, "specular_color_map": material.specular_color_texture}
    result.update({name: colored(texture, np.ones(3)) for name, texture in maps.items() if texture})
    if material.specular_texture:
        result["specular_map"] = channel(material.specular_texture, 3)
    return result


def layered(material):
    """Mitsuba's dp_du on a sphere is against ours and its bitangent the same, so that a turn changes its sign; no mesh has these materials."""
    assert (material.specular, material.transmission, material.color_texture, material.normal_texture) == (1, 0, None, None)
    coat, sheen, film = (material.layers.get(name, {}) for name in ("clearcoat", "sheen", "iridescence"))
    anisotropy, through = material.layers.get("anisotropy", {}), material.layers.get("diffuse_transmission", {})
    numbers = {
        "metallic": material.metallic, "roughness": material.roughness, "ior": material.ior,
        "coat": coat.get("clearcoatFactor", 0), "coat_roughness": coat.get("clearcoatRoughnessFactor", 0),
        "sheen_roughness": sheen.get("sheenRoughnessFactor", 0),
        "anisotropy": anisotropy.get("anisotropyStrength", 0), "turn": -anisotropy.get("anisotropyRotation", 0),
        "film": film.get("iridescenceFactor", 0), "film_index": film.get("iridescenceIor", 1.3),
        "film_thickness": film.get("iridescenceThicknessMaximum", 400), "through": through.get("diffuseTransmissionFactor", 0)}
    return {"type": "layered", **{name: float(value) for name, value in numbers.items()},
            "base_color": material.color[:3].tolist(), "sheen_color": sheen.get("sheenColorFactor", [0.0] * 3),
            "through_color": through.get("diffuseTransmissionColorFactor", [1.0] * 3)}


def normal_mapped(material, bsdf):
    texture, scale = material.normal_texture, np.array([material.normal_scale, material.normal_scale, 1])
    scaled = ((2 * texture.texels[..., :3] - 1) * scale + 1) / 2
    return {"type": "normalmap", "normalmap": bitmap(texture, scaled), "bsdf": bsdf, "use_shadowing_function": False}


def covered(material, bsdf):
    texture, opacity = material.color_texture, float(material.color[3])
    if texture:
        opacity = opacity * texture.texels[..., 3:]
        if material.alpha_mode == "MASK":
            assert texture.nearest  # the cut-off comes after filtering, which Mitsuba has no place for
            opacity = np.where(opacity >= material.alpha_cutoff, 1, 0)
        opacity = bitmap(texture, np.repeat(opacity, 3, -1))
    return {"type": "mask", "opacity": opacity, "bsdf": bsdf}


def single_albedo(multiscatter, anisotropy):
    """Returns the albedo of one scattering, from that of a thick layer (KHR_materials_scatter)."""
    s = 4.09712 + 4.20863 * multiscatter - np.sqrt(9.59217 + 41.6808 * multiscatter + 17.7126 * multiscatter ** 2)
    return (1 - s * s) / (1 - anisotropy * s * s)


def homogeneous(sigma, albedo, anisotropy):
    """Extinction coefficient in 1/m, albedo of one scattering, and Henyey and Greenstein's mean cosine."""
    return {"type": "homogeneous", "sigma_t": rgb(sigma / sigma.max()), "scale": float(sigma.max()), "albedo": rgb(albedo),
            "phase": {"type": "hg", "g": float(anisotropy)}}


def interior(material):
    sigma = -np.log(material.attenuation_color) / material.attenuation_distance
    if not material.scatter:
        return homogeneous(sigma, np.zeros(3), 0)
    anisotropy = material.scatter["scatterAnisotropy"]
    multiscatter = material.scatter["scatterStrengthFactor"] * np.array(material.scatter["multiscatterColorFactor"], float)
    return homogeneous(sigma, single_albedo(multiscatter, anisotropy), anisotropy)


def fog(options, scene):
    """The fog of --fog-density in a ball round the scene that the camera is outside of."""
    radius = float(options["--fog-distance"])
    points = np.concatenate([mesh.positions.reshape(-1, 3) for mesh in scene.meshes])
    center = (points.min(0) + points.max(0)) / 2
    albedo = np.array(options["--fog-color"].split(","), float)
    medium = homogeneous(np.full(3, float(options["--fog-density"])), albedo, float(options["--fog-anisotropy"]))
    place = mi.ScalarTransform4f().translate(center.tolist()).scale([radius] * 3)
    ball = {"type": "sphere", "to_world": place, "bsdf": {"type": "null"}}
    assert np.linalg.norm(scene.cameras[0].to_world[:3, 3] - center) > radius
    return {"fog": {**ball, "interior": medium}}


def grid_of_densities(path, scratch):
    """The plume of tests/volumes/make_grid.cpp, whose file stands in scenes/, in the cube that it fills."""
    root = json.loads(path.read_text())
    node = next((node for node in root["nodes"] if "fragtrace_volume" in node.get("extras", {})), None)
    if node is None:
        return {}
    volume = node["extras"]["fragtrace_volume"]
    side = 32
    subprocess.run([REPOSITORY / "build/make_grid", "plume", str(side), scratch / "plume.nvdb", "zip"], check=True)
    assert (scratch / "plume.nvdb").read_bytes() == (path.parent / volume["volume"]).read_bytes()
    values = np.fromfile(scratch / "plume.raw", np.float32).reshape(side, side, side, 1)
    place = mi.ScalarTransform4f().translate(node["translation"])
    medium = {"type": "heterogeneous", "scale": float(volume["density"]), "albedo": {"type": "constvolume", "value": rgb(volume["color"])},
              "sigma_t": {"type": "gridvolume", "grid": mi.VolumeGrid(values), "to_world": place.translate([-0.5] * 3)},
              "phase": {"type": "hg", "g": float(volume["anisotropy"])}}
    return {"densities": {"type": "cube", "to_world": place.scale([0.5] * 3), "bsdf": {"type": "null"}, "interior": medium}}


def surface(material, compensated, vertex_colors=False):
    """The BSDF, the light, and the medium behind it if it is solid and absorbs."""
    if material.layers:
        assert not compensated and not vertex_colors
        bsdf = layered(material)
    elif material.transmission == 1 and not material.transmission_texture:
        bsdf = glass(material)
    elif material.transmission:
        # A blend is the glTF mix, and its opaque part, too, has two sides.
        weight, texture = float(material.transmission), material.transmission_texture
        if texture:
            weight = channel(texture, 0, weight)
        first = {"type": "twosided", "bsdf": opaque(material, compensated, vertex_colors)}
        bsdf = {"type": "blendbsdf", "weight": weight, "first": first, "second": glass(material)}
    else:
        bsdf = opaque(material, compensated, vertex_colors)
    if material.normal_texture:
        bsdf = normal_mapped(material, bsdf)
    if material.double_sided:
        bsdf = {"type": "twosided", "bsdf": bsdf}
    if material.alpha_mode != "OPAQUE":
        bsdf = covered(material, bsdf)
    result = {"bsdf": bsdf}
    if np.isfinite(material.attenuation_distance):
        result["interior"] = interior(material)
    if material.emission.any():
        assert not material.double_sided
        result["emitter"] = {"type": "area", "radiance": colored(material.emission_texture, material.emission)}
    return result


def write_ply(path, mesh):
    colors = mesh.colors[..., :3] * mesh.material.color[:3]
    corners = np.concatenate([mesh.positions.reshape(-1, 3), mesh.uvs[0].reshape(-1, 2), colors.reshape(-1, 3)], -1)
    with open(path, "w", encoding="ascii") as file:
        file.write("ply\nformat ascii 1.0\nelement vertex %d\n" % len(corners))
        file.write("".join("property float %s\n" % name for name in "xyzuvrgb"))
        file.write("element face %d\nproperty list uchar int vertex_indices\nend_header\n" % (len(corners) // 3))
        np.savetxt(file, corners, "%.9g")
        np.savetxt(file, np.insert(np.arange(len(corners)).reshape(-1, 3), 0, 3, 1), "%d")


def punctual(light, traced):
    """traced: a light that rays can start at; Mitsuba's own, which has no range."""
    if traced:
        assert light.kind == "point" and np.isinf(light.range)
        return {"type": "point", "position": light.position.tolist(), "intensity": rgb(light.radiant)}
    if light.kind == "directional":
        return {"type": "directional", "direction": light.direction.tolist(), "irradiance": rgb(light.radiant)}
    return {"type": "punctual", "position": light.position.tolist(), "direction": light.direction.tolist(),
            "radiant": light.radiant.tolist(), "range": float(min(light.range, 1e6)), "spot": light.kind == "spot",
            "inner_cosine": float(light.inner_cosine), "outer_cosine": float(light.outer_cosine)}


def environment(texels, rotation_degrees, width=576, height=321):
    """Mitsuba 3.9 has its nodes on texel centres along u, and from pole to pole along v: the environment is sampled there.

    For 64 x 32 texels and turns by multiples of 10 degrees these nodes hold all corners of the bilinear patches.
    """
    azimuth, polar = np.meshgrid(2 * np.pi * (np.arange(width) + 0.5) / width, np.pi * np.arange(height) / (height - 1))
    direction = np.stack([np.sin(polar) * np.sin(azimuth), np.cos(polar), -np.sin(polar) * np.cos(azimuth)], -1)
    bitmap = mi.Bitmap(environment_radiance(texels, rotation_degrees, direction).astype(np.float32))
    return {"type": "envmap", "bitmap": bitmap}


def check_environment(scene, texels, rotation_degrees):
    """Other versions of Mitsuba have other nodes, so the emitter is compared with the formula."""
    direction = unit(np.random.default_rng(0).normal(size=(1000, 3)))
    si = dr.zeros(mi.SurfaceInteraction3f, len(direction))
    si.wi = -mi.Vector3f(direction.T.astype(np.float32))
    seen = np.array(scene.environment().eval(si)).T
    expected = environment_radiance(texels, rotation_degrees, direction)
    assert np.abs(seen - expected).max() < 1e-4 * expected.max(), np.abs(seen - expected).max()


def described(scene, entry, scratch):
    """Returns the scene as a dictionary, without its environment."""
    width, height = entry["resolution"]
    options = dict(zip(entry["options"][::2], entry["options"][1::2]))
    compensated = options.get("--disable") != "energy-compensation"
    materials = [item.material for item in scene.meshes + scene.spheres]
    # volpath sees lights through holes; volpathmis weighs the colours of a medium against one another.
    integrator = "path"
    if any(m.alpha_mode != "OPAQUE" for m in materials):
        integrator = "volpath"
    if any(np.isfinite(m.attenuation_distance) for m in materials):
        integrator = "volpathmis"
    if "--fog-density" in options:
        integrator = "volpath"
    integrator = entry.get("integrator", integrator)
    traced = integrator == "ptracer"  # paths from the lamps; the camera sees no smooth surface
    camera = scene.cameras[0]
    result = {
        "type": "scene",
        "integrator": {"type": integrator, "rr_depth": 1000,
                       "max_depth": -1 if options["--bounces"] == "unlimited" else int(options["--bounces"]) + 2},
        # Mitsuba's cameras look along +z with +x to the left.
        "sensor": {"type": "perspective", "fov_axis": "y", "fov": float(np.degrees(camera.yfov)), "near_clip": 1e-3,
                   "to_world": mi.ScalarTransform4f(camera.to_world @ np.diag([-1.0, 1, -1, 1])),
                   "film": {"type": "hdrfilm", "width": width, "height": height, "rfilter": {"type": "box"},
                            "pixel_format": "rgb", "component_format": "float32"},
                   "sampler": {"type": "independent" if traced else "stratified", "sample_count": pass_samples(entry)}}}
    for i, mesh in enumerate(scene.meshes):
        path = scratch / ("mesh%d.ply" % i)
        write_ply(path, mesh)
        result["mesh%d" % i] = {"type": "ply", "filename": str(path), "face_normals": True,
                                **surface(mesh.material, compensated, (mesh.colors != 1).any())}
    for i, sphere in enumerate(scene.spheres):
        # Mitsuba's pole is z, glTF's y.
        place = mi.ScalarTransform4f().translate(sphere.center.tolist()).rotate([1, 0, 0], -90).scale([sphere.radius] * 3)
        result["sphere%d" % i] = {"type": "sphere", "to_world": place, **surface(sphere.material, compensated)}
    for i, light in enumerate(scene.lights):
        result["light%d" % i] = punctual(light, traced)
    if "--fog-density" in options:
        result.update(fog(options, scene))
    densities = grid_of_densities(SCENES / (entry["scene"] + ".gltf"), scratch)
    result.update(densities)
    if densities:
        # volpath leaves a NaN once in a few million paths.
        result["integrator"]["type"] = "volpathmis"
    if "camera_in" in entry:  # the name of the mesh
        number = [mesh.name for mesh in scene.meshes].index(entry["camera_in"])
        around = {"around": result["mesh%d" % number]["interior"]}
        result["mesh%d" % number]["interior"] = {"type": "ref", "id": "around"}
        # An object must stand before references to it.
        result["sensor"]["medium"] = {"type": "ref", "id": "around"}
        result = {"type": "scene", **around, **{key: value for key, value in result.items() if key != "type"}}
    return result


def build(scene, entry, scratch):
    options = dict(zip(entry["options"][::2], entry["options"][1::2]))
    result = described(scene, entry, scratch)
    if "--hdri-file" in options:
        texels = read_pfm(REPOSITORY / options["--hdri-file"])
        result["environment"] = environment(texels, float(options.get("--hdri-rotation", 0)))
    built = mi.load_dict(result)
    if "--hdri-file" in options:
        check_environment(built, texels, float(options.get("--hdri-rotation", 0)))
    return built


def pass_samples(entry):
    """Samples of one pass: a power of 4, which is a square as stratified samples need it."""
    width, height = entry["resolution"]
    return 4 ** int(np.log2(min(entry["spp"], PASS_SAMPLES // (width * height))) / 2)


def render(scene, entry, seed):
    width, height = entry["resolution"]
    passes = entry["spp"] // pass_samples(entry)
    total = np.zeros((height, width, 3))
    for k in range(passes):
        total += np.array(mi.render(scene, spp=pass_samples(entry), seed=seed * passes + k))
    return total / passes


def main():
    names = sys.argv[1:]
    for entry in json.loads((FOLDER / "references.json").read_text())["references"]:
        if entry["made_by"] != "render_mitsuba" or "same_as" in entry or (names and entry["name"] not in names):
            continue
        with tempfile.TemporaryDirectory() as scratch:
            scene = build(read_scene(SCENES / (entry["scene"] + ".gltf")), entry, Path(scratch))
            write_reference(entry["name"], [render(scene, entry, seed) for seed in range(entry["batches"])])


if __name__ == "__main__":
    main()

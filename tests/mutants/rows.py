# SPDX-License-Identifier: MIT
"""All faults, and what they must cover: each function of these shaders that returns radiance, a weight, a density or a place."""
import rows_of_light
import rows_of_media
import rows_of_surfaces
from fault import functions_of, put_in

ROWS = rows_of_light.ROWS + rows_of_media.ROWS + rows_of_surfaces.ROWS

COVERED = ("path", "shade", "lights", "lights/light_tree", "shutter/camera", "environment", "environment_light", "material", "material_layers", "texture", "layers", "surface", "film", "film_pixel", "camera", "bsdf",
           "ggx", "iridescence", "fresnel", "phong", "sampling", "pixel_filter", "energy", "caustics/aim", "caustics/emit", "caustics/form", "caustics/guiding", "caustics/light_path",
           "media/phase", "media/flight", "media/fog", "media/medium", "media/solids", "media/volume", "media/scatter")
# Types that hold none of these.
PLAIN = ("void", "bool", "int", "uint", "uvec4")
# Functions that only pass on what others return, or say nothing of light.
WITHOUT = {"path.treeFrame", "path.pathRandom", "path.traceAnew", "path.extend", "path.asExtension", "path.goPast", "path.proceed", "caustics/light_path.traceSplat", "lights.noLight", "caustics/emit.noEmission", "sampling.toWorld", "sampling.toFrame",
           "sampling.maxComponent", "energy.ggxLoss"}


def check(shaders):
    """Returns the faults of the rows, a line for each: keys that are not found exactly once, functions without a
    fault."""
    wrong = []
    names = [row.name for row in ROWS]
    wrong += [f"{name}: two rows have this name" for name in sorted(set(names)) if names.count(name) > 1]
    texts = {str(path.relative_to(shaders)): path.read_text() for path in shaders.rglob("*.glsl")}
    for row in ROWS:
        try:
            put_in(row, texts[row.file])
        except LookupError as error:
            wrong.append(str(error))
    have = {name.split()[0] for name in names}
    for file in COVERED:
        for function, (kind, _, _) in functions_of(texts[file + ".glsl"]).items():
            name = f"{file}.{function}"
            if kind not in PLAIN and name not in have | WITHOUT:
                wrong.append(f"{name}: no row has a fault in it")
    return wrong

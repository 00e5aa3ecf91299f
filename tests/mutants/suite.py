# SPDX-License-Identifier: MIT
"""The tests of plain scripts/test that can see a fault of the shaders. The others compare the program with itself, or draw the same pictures once more
(OSMesa, the viewer): leaving them out can only let more faults survive."""
import json
import re
import subprocess
from pathlib import Path

from fault import callers_of

COMMANDS = ("Sky", "Media", "Volumes", "Means", "Sheets", "KnownLight", "ThinGlass", "LightTree", "Caustics", "SunCaustics", "KnownSurfaces", "KnownTextures", "TextureFactors", "ClampedLight", "Filters", "Materials", "FirstHits", "LightParts", "Pictures", "Instancing", "Surroundings", "StressRows", "Merging", "Denoising", "ShadowCatcher", "CutOutShadow", "CameraTypes", "CameraRays")
# The tests to try first if there is no experience yet: scenes of picture tests, test files and groups, by the beginning
# of a fault's name.
LIKELY = {
    "path.roundCameraRay": ("command.CameraTypes",),
    "path.withinFisheye": ("command.CameraTypes",),
    "caustics/light_path.roundCameraFrom": ("command.Caustics",),
    "media/phase.": ("pure.shader_media_test",),
    "media/flight.": ("pure.shader_media_test",),
    "media/fog.": ("pure.shader_media_test",),
    "media/volume.": ("pure.shader_volume_test", "smoke.gi", "command.Volumes"),
    "media/volume.volumeRadiance": ("command.Volumes",),
    "media/scatter.sampleLdInMedium": ("command.Media",),
    "media/scatter.scatterInMedium closed": ("command.Media",),
    "media/scatter.scatterInMedium density": ("command.Media",),
    "media/scatter.scatterInMedium glow": ("command.Volumes",),
    "media/scatter.endsInGrid": ("command.Volumes", "smoke.gi"),
    "media/medium.dimShadow": ("command.Media", "cloud.gi", "smoke.gi", "foggy.gi", "phase.gi"),
    "media/scatter.": ("cloud.gi", "smoke.gi", "inside.gi", "milk.gi", "closed-media.gi", "command.Media", "command.Volumes"),
    "media/medium.": ("command.Media", "command.Sheets", "command.Volumes", "milk.gi", "inside.gi"),
    "media/": ("command.Media", "command.Volumes", "milk.gi", "phase.gi", "inside.gi", "foggy.gi"),
    "material_layers.addThinScattering": ("command.Media",),
    "bsdf.diffuseColor": ("command.Media",),
    "reuse/neighbours.": ("command.LightTree",),
    "reuse/": ("pure.light_tree_test", "command.LightTree"),
    "shade.lightAt": ("command.LightTree",),
    "path.takesLightFromBehind": ("command.LightTree",),
    "path.": ("closed-furnace.gi", "command.KnownLight", "cornell-box.gi", "coverage.gi"),
    "path_state.": ("closed-furnace.gi", "command.KnownLight", "cornell-box.gi", "coverage.gi"),
    "path.spawnRay": ("closed-furnace-roulette.gi", "closed-furnace.gi", "command.KnownLight", "glass-sphere.gi"),
    "material.alphaAt": ("command.Sheets", "coverage.gi"),
    "path.passesThrough": ("command.Sheets",),
    "path.emittedAt coat": ("command.Materials",),
    "path.tracePast": ("command.Sheets",),
    "path.spawnShadowRayFrom limit": ("command.Sheets",),
    "shade.": ("cornell-box.gi", "command.KnownSurfaces", "plastics.gi", "sphere-phong.phong", "command.KnownLight"),
    "shade.shade flat": ("sphere-textured.flat",),
    "media/medium.passMedium absorption": ("command.KnownSurfaces", "water-cube-plain.gi", "water-cube-plain.refraction"),
    "media/solids.standInside": ("command.KnownLight",),
    "media/solids.": ("command.Solids",),
    "shade.settleShadow wall": ("command.ThinGlass",),
    "shade.lightThrough": ("command.ThinGlass",),
    "shade.glassLostAt": ("command.KnownLight",),
    "path.spawnRay straight": ("command.ThinGlass",),
    "path.passesGlass": ("command.ThinGlass",),
    "layers.straightThrough": ("command.ThinGlass",),
    "energy.glassAlbedo": ("command.KnownLight",),
    "shade.settleShadow": ("command.Sheets", "coverage.gi"),
    "shade.disperse": ("command.Materials",),
    "shade.baseBsdf": ("command.KnownSurfaces", "rough-metals.gi", "rough-glass.gi", "thin-glass.gi", "lobes.gi", "plastics.gi"),
    "shade.shadeLocal glass": ("command.Sheets",),
    "shade.shadeLocal": ("sphere-phong.phong", "sphere-plane-mirror.reflections", "water-cube-plain.refraction"),
    "shade.scatterGlass": ("water-cube-plain.refraction",),
    "shade.scatterMirror": ("sphere-plane-mirror.reflections",),
    "shade.aovAt": ("command.FirstHits",),
    "shade.aovShare": ("command.LightParts",),
    "path.addLight": ("command.LightParts",),
    "layers.diffuseUnderLayers": ("command.LightParts",),
    "shade.depthOf": ("command.FirstHits",),
    "catcher.": ("command.CutOutShadow", "command.ShadowCatcher", "command.CatcherAndPlane"),
    "guides.": ("command.Denoising",),
    "lights/light_tree.treePdf": ("pure.light_tree_test",),
    "lights/light_tree.lightWord": ("pure.light_tree_test",),
    "lights/light_tree.lightNodeFrom": ("pure.light_tree_test", "command.LightTree"),
    "lights/light_tree.shareOf": ("pure.light_tree_test", "command.LightTree"),
    "lights/light_tree.emitterByTree place": ("pure.light_leaves_test",),
    "lights/light_tree.emittersOf": ("pure.light_leaves_test",),
    "lights/light_tree.emitterByTree": ("pure.light_tree_test", "command.LightTree"),
    "lights.chanceOfLight": ("pure.light_tree_test",),
    "path.normalOfLight": ("command.LightTree",),
    "caustics/aim.": ("pure.shader_light_paths_test",),
    "caustics/flux.": ("pure.shader_light_paths_test",),
    "caustics/form.": ("pure.shader_path_form_test", "command.Caustics"),
    "caustics/light_path.scatteredTowards": ("command.GlossyCaustics",),
    "caustics/light_path.radianceScale": ("command.GlossyCaustics",),
    "caustics/light_path.spawnSplatRay narrow": ("command.GlossyCaustics",),
    "path.spawnRay narrow": ("command.GlossyCaustics",),
    "path.isCaster": ("command.GlossyCaustics",),
    "shade.irradianceLeft": ("command.GlossyCaustics",),
    "caustics/emit.sunEmission": ("command.SunCaustics",),
    "caustics/emit.mapSunEmission": ("command.SunCaustics",),
    "sky/sun.isMapSun": ("command.SunCaustics",),
    "environment.mapBesideSun": ("command.SunCaustics",),
    "caustics/emit.drawEmission sun": ("command.SunCaustics",),
    "path.meetSurroundings sunless": ("command.SunCaustics",),
    "caustics/": ("caustic-ground.gi", "command.Caustics"),
    "film.recordOf": ("command.Caustics",),
    "film.storeRecord": ("command.Caustics",),
    "pixel_filter.pixelFilterPdf": ("command.Caustics",),
    "lights.emittedFrom": ("command.KnownLight",),
    "lights.": ("command.KnownLight", "lights.gi", "cornell-box-direct.gi", "lights.shadows"),
    "sky/": ("pure.shader_sun_test", "command.Sky"),
    "environment.sampleSky": ("pure.shader_sun_test",),
    "lights.skyLight": ("command.Sky",),
    "environment.": ("command.KnownLight", "environment-rotated.gi", "sun-sky.gi", "pure.shader_environment_test"),
    "material.": ("command.KnownSurfaces", "command.TextureFactors", "plastics.gi", "lights.gi", "command.Materials"),
    "material_layers.": ("command.KnownSurfaces", "command.TextureFactors", "mapped-layers.gi", "lobes.gi", "command.Materials"),
    "texture.": ("command.KnownTextures", "mapped-plane.normal-maps", "mapped-metal.gi", "command.Materials"),
    "surface.": ("command.KnownSurfaces", "sphere-mapped.normal-maps", "mapped-plane-tangents.normal-maps", "water-cube.normal-maps", "transforms.flat", "lobes.gi"),
    "surface.readColor": ("command.KnownSurfaces",),
    "surface.interpolate": ("command.KnownSurfaces",),
    "surface.inLocal": ("command.Instancing",),
    "surface.unitOr": ("command.Instancing",),
    "layers.": ("command.KnownSurfaces", "pure.shader_layers_test", "lobes.gi", "mapped-layers.gi", "command.Materials"),
    "film.": ("sphere-black.flat", "command.Pictures"),
    "film_pixel.addGuides": ("command.Denoising",),
    "film_pixel.seenLuminance": ("command.CutOutShadow", "pure.shader_film_test"),
    "film_pixel.": ("sphere-black.flat", "pure.shader_film_test"),
    "camera.timeOf": ("command.Shutter",),
    "camera.turnedBy": ("pure.shutter_motion_test", "command.Shutter"),
    "camera.motionOver": ("pure.shutter_motion_test", "command.Shutter"),
    "shutter/camera.": ("command.Shutter",),
    "lights.triangleLight moving": ("command.Shutter",),
    "surface.triangleSurface moving": ("command.Shutter",),
    "surface.movingTriangle": ("command.Shutter",),
    "camera.": ("transforms.flat", "sphere-textured.flat"),
    "pixel_filter.": ("command.Filters",),
    "sampling.": ("command.KnownLight", "lobes.gi", "pure.shader_sampling_test"),
    "energy.": ("command.KnownLight", "rough-metals-compensated.gi", "command.Materials", "mapped-layers.gi"),
    "bsdf.scaledGlass": ("pure.shader_iridescence_test",),
    "bsdf.glassTint": ("pure.shader_iridescence_test",),
    "fresnel.averageFresnel": ("pure.shader_bsdf_random_test",),
    "fresnel.shared": ("pure.shader_bsdf_test",),
    "bsdf.": ("command.KnownLight", "pure.shader_bsdf_test", "command.KnownSurfaces", "rough-glass.gi", "thin-glass.gi", "lobes.gi", "pure.shader_layers_test"),
    "layers.drawCoat place": ("pure.shader_facets_test",),
    "ggx.sample": ("pure.shader_facets_test",),
    "ggx.alongMicrofacets": ("pure.shader_facets_test",),
    "ggx.": ("command.KnownSurfaces", "pure.shader_bsdf_test", "rough-metals.gi", "rough-glass.gi", "lobes.gi", "plastics.gi"),
    "iridescence.": ("lobes.gi", "pure.shader_iridescence_test"),
    "fresnel.": ("pure.shader_fresnel_test", "command.KnownSurfaces", "plastics.gi", "thin-glass.gi", "rough-glass.gi", "pure.shader_fresnel_test"),
    "phong.phongExponent": ("pure.shader_phong_test",),
    "phong.": ("sphere-phong.phong", "sphere-plane.phong"),
}


def likely(name):
    """The tests to try first for a fault of this name, by the longest beginning that is listed; none where no beginning is."""
    begin = max((begin for begin in LIKELY if name.startswith(begin)), key=len, default=None)
    return [test if "command." in test or "pure." in test else f"picture.{test}.egl" for test in LIKELY.get(begin, ())]


# Headers that compile shaders; what they name is not what a test looks at.
COMPILING = {"glsl.h", "glsl_files.h", "glsl_functions.h", "glsl_lights.h", "glsl_lights_files.h"}
INCLUDE = re.compile(r'^#include "([\w/]+\.(?:h|glsl))"', re.M)


def drawing_tests(build):
    """Name and command of each test that draws with the program."""
    shown = subprocess.run(["ctest", "--test-dir", build, "--show-only=json-v1"], capture_output=True, text=True, check=True).stdout
    tests = {test["name"]: test.get("command", []) for test in json.loads(shown)["tests"]}
    wanted = lambda name: name.startswith("picture.") and name.endswith(".egl") or name in {"command." + group for group in COMMANDS}
    return {name: command for name, command in tests.items() if wanted(name)}


def texts_of(path, folders, skip=()):
    """Texts of a file and of all that it includes from these folders, by the name that includes it."""
    found, queue = {}, [(path.name, path)]
    while queue:
        name, path = queue.pop()
        found[name] = path.read_text()
        for name in INCLUDE.findall(found[name]):
            places = [folder / name for folder in folders if (folder / name).exists()]
            if places and name not in found and name not in skip:
                queue.append((name, places[0]))
    return found


def pure_tests(source, fault):
    """Names of the test files in C++ that call the function at fault, directly or not."""
    pure, shaders = source / "tests/pure", source / "shaders"
    names = []
    for path in sorted(pure.glob("*_test.cpp")):
        compiled = {name: text for name, text in texts_of(path, [pure, shaders]).items() if name.endswith(".glsl")}
        if fault.file not in compiled:
            continue
        calls = callers_of(fault.function, compiled.values())
        own = "\n".join(texts_of(path, [pure], COMPILING).values())
        if re.search(r"\b(?:%s)\s*\(" % "|".join(calls), own):
            names.append("pure." + path.stem)
    return names


def unknown_tests(source, faults):
    """Those tests of LIKELY in C++ that call none of the functions at fault: the files that compile shaders have changed their form."""
    hinted = {name: begin for begin, names in LIKELY.items() for name in names if name.startswith("pure.")}
    sees = lambda name, begin: any(name in pure_tests(source, fault) for fault in faults if fault.name.startswith(begin))
    return [f"suite.py: {name} sees no fault" for name, begin in sorted(hinted.items()) if not sees(name, begin)]



class Compiler:
    """Compiles one test file with shaders of a folder, as the build does, but faster."""

    def __init__(self, source, build):
        self.source, self.build = source, build
        entries = json.loads((build / "compile_commands.json").read_text())
        self.compile = {Path(entry["file"]).stem: entry["command"] for entry in entries if "/tests/pure/" in entry["file"]}
        self.any = next(iter(self.compile))  # stands for those that the build compiles together with others
        commands = subprocess.run(["ninja", "-C", build, "-t", "commands", "pure_tests"], capture_output=True, text=True, check=True).stdout
        self.link = next(line for line in reversed(commands.splitlines()) if "-o pure_tests " in line)

    def make(self, stem, folder):
        """The program of the test file `stem`, with the shaders in folder/shaders."""
        object_file, program = folder / f"{stem}.o", folder / stem
        compile = re.sub(r"-o \S+\.o ", f"-o {object_file} ", self.compile.get(stem) or self.compile[self.any].replace(self.any, stem)).replace(" -O3 ", " -O1 ")
        # The folder of the faulty shaders comes before the sound ones.
        compile = compile.replace(f"-I{self.source}/shaders", f"-I{folder}/shaders -I{self.source}/shaders")
        link = re.sub(r"(?:\S*(?:pure|plain)_tests\.dir/\S+\.o ?)+", f"{object_file} ", self.link, count=1).replace("-o pure_tests ", f"-o {program} ")
        link = link.split("&& cd ")[0].removesuffix("&& :").removeprefix(": && ")
        for command in (compile, link):
            result = subprocess.run(command, shell=True, cwd=self.build, capture_output=True, text=True)
            if result.returncode:
                raise RuntimeError(f"{stem} does not build:\n{command}\n{result.stderr[-3000:]}")
        return program

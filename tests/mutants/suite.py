# SPDX-License-Identifier: MIT
"""The tests of plain scripts/test that can see a fault of the shaders. The others compare the program with itself, or draw the same pictures once more
(OSMesa, the viewer): leaving them out can only let more faults survive."""
import json
import re
import subprocess
from pathlib import Path

from made import callers_of

COMMANDS = ("Sky", "Media", "Volumes", "Means", "Sheets", "KnownLight", "ThinGlass", "LightTree", "Caustics", "SunCaustics", "KnownSurfaces", "KnownTextures", "TextureFactors", "ClampedLight", "Filters", "Materials", "FirstHits", "LightParts", "Pictures", "Instancing", "Surroundings", "StressRows", "Merging", "Denoising", "ShadowCatcher", "CutOutShadow", "CameraTypes", "CameraRays")
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


class Compiler:
    """Compiles one test file with shaders of a folder, as the build does, but faster."""

    def __init__(self, source, build):
        self.source, self.build = source, build
        entries = json.loads((build / "compile_commands.json").read_text())
        self.compile = {Path(entry["file"]).stem: entry["command"] for entry in entries
                        if "/tests/pure/" in entry["file"] and "gpu_arithmetic" not in entry["command"]}
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

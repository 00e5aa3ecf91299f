# SPDX-License-Identifier: MIT
"""The path tracers of compare.py behind one call: draw(spp, seed, picture) gives {"wall", "cpu"}, the seconds of drawing alone, and "samples"
where a pixel may have more than `spp`."""

import copy
import json
import os
import resource
import shutil
import subprocess
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent


# Mitsuba's samplers. The dimensions of ldsampler are correlated: its pictures of scenes/many-lights.gltf are
# 0.85 % too dark (8 seeds of 256 samples, the other four within 0.07 %), so its mean is not used.
SAMPLERS = ("independent", "stratified", "multijitter", "orthogonal", "ldsampler")
BIASED = "ldsampler"


class Absent(Exception):
    """The engine is not installed; says what is missing."""


def run_cold(command):
    """Returns the seconds of a whole fragtrace process by both clocks, with the shader cache off."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    subprocess.run(list(map(str, command)), check=True, env={**os.environ, "MESA_SHADER_CACHE_DISABLE": "true"})
    wall, after = time.perf_counter() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    return {"wall": wall, "cpu": sum(getattr(after, key) - getattr(before, key) for key in ("ru_utime", "ru_stime"))}


class Fragtrace:
    name = "fragtrace"

    def __init__(self, program, scene, resolution, plain, options=()):
        description = json.loads(scene.read_text())
        camera = description["camera"]
        self.stats = scene.parent / "stats.json"
        self.command = [str(program), "render", description["gltf"], "--resolution", f"{resolution},{resolution}", "--bounces", "6", "--quiet",
                        "--stats", str(self.stats), "--camera-view-angle", str(camera["fov_degrees"])]
        for option, key in (("--camera-position", "eye"), ("--camera-focal-point", "target")):
            self.command += [option, ",".join(map(repr, map(float, camera[key])))]
        if plain:
            self.command += ["--rr-depth", "1000"]
        if description["environment"]:
            self.command += ["--hdri-file", description["environment"]]
        self.command += options
        self.version, self.start_cpu = " ".join(["fragtrace", *options]), 0.0
        self.start_cpu = self.draw(1, 0, str(self.stats.with_name("first.pfm")))["cpu"]

    def draw(self, spp, seed, picture):
        """CPU seconds are counted from those of a picture of one sample, which are start-up and compiling above all."""
        cpu = run_cold([*self.command, "--spp", spp, "--seed", seed, "-o", picture])["cpu"]
        return {"wall": json.loads(self.stats.read_text())["render_ms"] / 1000, "cpu": cpu - self.start_cpu}

    def close(self):
        pass


class Worker:
    """An engine in a process of its own that renders on request, so that it loads its scene once."""

    def __init__(self, name, command):
        self.name, self.lines, self.more = name, [], {}
        # Debian's Blender takes its Python's home from the first python3 in PATH: let that be the one next to it.
        program = shutil.which(command[0]) or command[0]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                        env={**os.environ, "PATH": os.path.dirname(program) + os.pathsep + os.environ["PATH"]})
        try:
            self.version = self.answer()["version"]
        except RuntimeError as error:
            raise Absent(f"{command[0]}: {error}") from None

    def answer(self):
        for line in self.process.stdout:
            if line.startswith("peer {"):
                return json.loads(line[5:])
            self.lines = [*self.lines, line.rstrip()][-8:]
        self.process.wait()
        raise RuntimeError("ended: " + " | ".join(filter(None, self.lines)))

    def using(self, sampler):
        """Returns the same process with another one of Mitsuba's samplers."""
        other = copy.copy(self)
        other.more, other.name, other.version = {"sampler": sampler}, f"{self.name}, {sampler}", f"{self.version}, {sampler}"
        return other

    def draw(self, spp, seed, picture):
        self.process.stdin.write(json.dumps({"spp": spp, "seed": seed, "output": str(picture), **self.more}) + "\n")
        self.process.stdin.flush()
        return self.answer()

    def close(self):
        self.process.stdin.close()
        try:
            self.process.wait(20)
        except subprocess.TimeoutExpired:
            self.process.kill()


def mitsuba(variant, python, scene, resolution, plain):
    if subprocess.run([python, "-c", "import mitsuba, numpy"], capture_output=True, check=False).returncode:
        raise Absent(f"{python} has no mitsuba and numpy; python3 -m venv DIR; DIR/bin/pip install mitsuba==3.9.1 numpy; --python DIR/bin/python")
    name = "Mitsuba " + variant.split("_")[0]
    return Worker(name, [python, str(HERE / "mitsuba_worker.py"), str(scene), variant, str(resolution), "plain" if plain else "defaults"])


def cycles(python, blender, scene, resolution, settings):
    command = [blender, "-b", "--factory-startup", "--python-exit-code", "1", "--python"]
    if not shutil.which(blender):
        if subprocess.run([python, "-c", "import bpy"], capture_output=True, check=False).returncode:
            raise Absent(f"no {blender} (Debian: blender, python3-numpy), and {python} has no bpy")
        command = [python]
    return Worker("Cycles", [*command, str(HERE / "cycles_worker.py"), "--", str(scene), str(resolution), settings])

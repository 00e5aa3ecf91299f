#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Tells whether the program still draws the same as at an earlier commit: pictures, the SPIR-V of its shaders, and the keys of --stats.

usage: frozen.py COMMIT [--folder DIR] [--only WORD] [--options WORDS]
Builds the commit in DIR (default /tmp/fragtrace-frozen) and the working tree in build, and draws about 190 pictures by both. Where the SPIR-V of a picture's
shaders differs, their texts are left in DIR for diff. Debug names are not compared. Needs glslangValidator (scripts/setup) and Mesa.
"""
import argparse
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

from shader_texts import FILE_ENDINGS, captured

ROOT = Path(__file__).resolve().parent.parent
ASSETS = Path(os.environ.get("FRAGTRACE_ASSETS", "/work/shared/assets")) / "scenes"
STAGES = ("flat", "phong", "shadows", "reflections", "refraction", "normal-maps")
MANY = ("cornell-box", "coverage", "glass-sphere", "plastics", "thin-glass", "many-lights", "caustics", "sphere-textured", "water-cube", "lobes")
OF_MANY = (*(["--stage", stage] for stage in STAGES), ["--dispatch", "compute", "--schedule", "megakernel"], ["--shadow-catcher", "bottom"],
           ["--light-reuse", "candidates"], ["--light-reuse", "spatial"], ["--denoise", "variance"])
OF_ASSETS = ([], ["--schedule", "wavefront"], ["--stage", "normal-maps"])


def rows():
    """Yields (scene, options) of each picture."""
    for scene in sorted((ROOT / "scenes").glob("*.gltf")):
        yield scene, []
        yield scene, ["--schedule", "wavefront"]
    for name in MANY:
        for options in OF_MANY:
            yield ROOT / f"scenes/{name}.gltf", options
    for name in ("FlightHelmet", "GlassVaseFlowers", "ToyCar"):
        for scene in sorted((ASSETS / name).glob(name + ".gl*")):
            for options in OF_ASSETS:
                yield scene, ["--studio", *options]


def spirv(kind, text, folder):
    """The binary without debug names, or the text where glslangValidator refuses it."""
    source, binary = folder / f"text.{FILE_ENDINGS[kind]}", folder / "text.spv"
    source.write_text(text)
    binary.unlink(missing_ok=True)
    subprocess.run(["glslangValidator", "-G", "-g0", "--amb", "--aml", "-o", binary, source], capture_output=True, check=False)
    return binary.read_bytes() if binary.exists() else text.encode()


def draw(program, scene, options, folder):
    """The picture, the texts by kind, the keys of the statistics, and what was said."""
    shutil.rmtree(folder, ignore_errors=True)
    capture = folder / "capture"
    capture.mkdir(parents=True)
    result = subprocess.run([program, "render", scene, *options, "--quiet", "--default-light", "white", "--resolution", "48,48", "--spp", "8", "-o", folder / "x.pfm", "--stats",
                             folder / "s.json"], capture_output=True, text=True, check=False, env={**os.environ, "MESA_SHADER_CAPTURE_PATH": str(capture)})
    texts = captured(capture)
    if result.returncode != 0:
        return None, texts, set(), (result.returncode, result.stderr)
    return (folder / "x.pfm").read_bytes(), texts, set(json.loads((folder / "s.json").read_text())), (0, result.stderr)


def differences(programs, scene, options, folder):
    """Returns in words the parts of a row that differ."""
    before, now = (draw(program, scene, options, folder / side) for side, program in programs.items())
    found = [what for what, a, b in (("picture", before[0], now[0]), ("statistics", before[2], now[2]), ("messages", before[3], now[3])) if a != b]
    if before[1] != now[1]:
        binaries = [{spirv(kind, text, folder) for kind, text in side - other} for side, other in ((before[1], now[1]), (now[1], before[1]))]
        if binaries[0] != binaries[1]:
            found.append("shader")
            place = folder / "-".join([scene.stem, *options]).replace("/", "_")
            place.mkdir(exist_ok=True)
            for side, texts in (("before", before[1] - now[1]), ("now", now[1] - before[1])):
                (place / side).write_text("".join(f"[{kind}]\n{text}" for kind, text in sorted(texts)))
    return found


def build(folder, commit):
    """Builds both programs and returns them by side."""
    clone = folder / commit
    if not clone.exists():
        subprocess.run(["git", "clone", "--quiet", ROOT, clone], check=True)
        subprocess.run(["git", "-C", clone, "checkout", "--quiet", commit], check=True)
    for place in (clone, ROOT):
        subprocess.run([place / "scripts/build", "release", "fragtrace"], check=True)
    return {"before": clone / "build/fragtrace", "now": ROOT / "build/fragtrace"}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("commit")
    parser.add_argument("--folder", type=Path, default=Path("/tmp/fragtrace-frozen"))
    parser.add_argument("--only", default="", help="rows in whose scene and options this stands")
    parser.add_argument("--options", default="", help="for every row, such as '--caustics off' to compare all but the light paths")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    commit = subprocess.run(["git", "-C", ROOT, "rev-parse", options.commit], check=True, capture_output=True, text=True).stdout.strip()
    programs = build(options.folder, commit)
    count = other = 0
    for scene, words in rows():
        name = " ".join([scene.stem, *words])
        if options.only not in name:
            continue
        count += 1
        found = differences(programs, scene, [*words, *options.options.split()], options.folder)
        other += bool(found)
        if found:
            print(f"{name}: {', '.join(found)}", flush=True)
    print(f"{count} rows, {other} differ")
    return 1 if other or not count else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The work of ten pictures, which --count-work counts: no more than tests/reference/work.json says, and the same each time.

After `FRAGTRACE SOURCE_FOLDER`, --renew writes that file anew.
"""
import contextlib
import functools
import json
import re
import shutil
import sys
import tempfile
import unittest.mock
from pathlib import Path

from support import EXTENDED, SCENES, SHADERS, Case, main, run

sys.path.insert(0, str(SCENES))
from instanced_scene import write_field  # noqa: E402

KEPT = SCENES.parent / "tests/reference/work.json"
MOST = 1.03
SIZE = ["--resolution", "32,32", "--spp", 2]
SKY = ["--hdri-file", SCENES / "sky.pfm"]
TREE = ["--traversal", "front-to-back"]
MEGAKERNEL = ["--schedule", "megakernel"]
# Each kind of work is in one of them.
PICTURES = {
    "wavefront": ("room-ball", ["--schedule", "wavefront"]),
    "literals": ("cornell-box", ["--traversal", "literals"]),
    "many-lights": ("many-lights", [*TREE, *MEGAKERNEL]),
    "ball": ("room-ball", MEGAKERNEL),
    "alpha": ("coverage", [*TREE, *MEGAKERNEL]),
    "one-alpha": ("one-alpha", MEGAKERNEL),
    "volume": ("smoke", MEGAKERNEL),
    "caustics": ("caustics", MEGAKERNEL),
    "textures-under-sky": ("mapped-layers", [*SKY, *TREE, *MEGAKERNEL]),
    "instances": ("field", ["--instancing", "share", "--stage", "shadows", *SKY]),
}
IN_WAVES = ("one-alpha", "volume")


def made(folder, scene):
    """Returns the file of a scene. Two are made: the room with the ball, half of whose lamp is there; and balls that share a mesh."""
    if scene == "one-alpha":
        model = json.loads((SCENES / "room-ball.gltf").read_text())
        lamp = next(material for material in model["materials"] if material["name"] == "lamp")
        lamp["alphaMode"] = "BLEND"
        lamp.setdefault("pbrMetallicRoughness", {})["baseColorFactor"] = [1, 1, 1, 0.5]
        (folder / "one-alpha.gltf").write_text(json.dumps(model))
        shutil.copy(SCENES / "room-ball.bin", folder)
    elif scene == "field":
        with contextlib.redirect_stdout(None):
            write_field(folder, "field", 64, 500)
    elif (folder / f"{scene}.gltf").exists():
        return folder / f"{scene}.gltf"
    else:
        return SCENES / f"{scene}.gltf"
    return folder / f"{scene}.gltf"


def counted(folder, name, *options):
    """Returns the statistics of a picture, or None where no grid can be read."""
    scene, own = PICTURES[name]
    if "--schedule" in options:
        own = [word for word in own if word not in ("--schedule", "megakernel", "wavefront")]
    result = run("render", made(folder, scene), "-o", folder / "x.pfm", "--quiet", "--count-work", "--stats", folder / "work.json", *SIZE, *own,
                 *options)
    if "libfragtrace_volumes" in result.stderr:
        return None
    if result.returncode:
        raise AssertionError(f"{name}: {result.stderr}")
    return json.loads((folder / "work.json").read_text())


@functools.cache
def known(name):
    """As counted(), once for all tests."""
    with tempfile.TemporaryDirectory() as folder:
        return counted(Path(folder), name)


def numbers(stats):
    """All counts of a picture that are not 0."""
    counts = {name: stats[name] for name in ("draws", "programs", "shader_characters")}
    return counts | {name: count for name, count in stats["work"].items() if count}


def rays(stats):
    return {name: count for name, count in stats["work"].items() if name.endswith("_rays")}


def renew():
    counts = {name: numbers(known(name)) for name in PICTURES}
    KEPT.write_text(json.dumps(counts, indent=1) + "\n")


class Work(Case):
    def test_no_count_grows(self):
        kept = json.loads(KEPT.read_text())
        self.assertEqual(set(kept), set(PICTURES))
        more, less = [], []
        for name in PICTURES:
            now = numbers(known(name)) if known(name) else kept[name]
            for kind in now | kept[name]:
                before, after = kept[name].get(kind, 0), now.get(kind, 0)
                list_of = more if after > MOST * before else less if before > MOST * after else None
                if list_of is not None:
                    list_of.append(f"{name}: {kind}: {before} before, {after} now")
        self.assertFalse(more, "more work than before:\n" + "\n".join(more))
        self.assertFalse(less, "less work than before: renew tests/reference/work.json (work_test.py FRAGTRACE SOURCE_FOLDER --renew):\n" + "\n".join(less))

    def test_both_tunes_trace_the_same_rays(self):
        for name in ("literals", "alpha", "caustics", "instances"):
            other = counted(self.folder, name, "--tune", "gpu")
            self.assertIn("+gpu", other["variant"])
            self.assertEqual(rays(known(name)), rays(other), name)


class WorkOfSchedules(Case):
    def test_both_schedules_do_the_same_work(self):
        """Except that the wavefront takes each ray's first step next to its round, and its lanes that wait read rows of nodes."""
        for name in filter(known, IN_WAVES):
            for tune in ("software", "gpu") if EXTENDED else ("software",):
                waves = counted(self.folder, name, "--schedule", "wavefront", "--tune", tune)
                self.assertEqual(waves["schedule"], "wavefront")
                for kind in set(waves["work"]) - {"node_steps", "boxes_tested", "node_rows"}:
                    self.assertEqual(known(name)["work"][kind], waves["work"][kind], f"{name}, {tune}: {kind}")


class AlphaWork(Case):
    def test_no_ray_begins_again_behind_what_alpha_lets_pass(self):
        self.assertGreater(known("alpha")["work"]["surfaces_passed"], 100)
        self.assertEqual(known("alpha")["work"]["camera_rays"], 32 * 32 * 2)

    def test_alpha_that_hides_nothing_takes_no_work(self):
        model = json.loads((SCENES / "room-ball.gltf").read_text())
        for material in model["materials"]:
            material["alphaMode"] = "MASK"
        (self.folder / "masked.gltf").write_text(json.dumps(model))
        shutil.copy(SCENES / "room-ball.bin", self.folder)
        with unittest.mock.patch.dict(PICTURES, masked=("masked", MEGAKERNEL)):
            stats = counted(self.folder, "masked")
        self.assertNotIn("alpha", stats["variant"].split("+"))
        self.assertEqual(numbers(known("ball")), numbers(stats))


class Counting(Case):
    def test_two_runs_write_the_same_file(self):
        twice = [(counted(self.folder, "ball"), (self.folder / "work.json").read_bytes())[1] for _ in range(2)]
        self.assertEqual(*twice)

    def test_the_picture_is_the_same(self):
        scene, options = PICTURES["ball"]
        counted(self.folder, "ball")
        self.renders(SCENES / f"{scene}.gltf", "-o", self.folder / "y.pfm", "--quiet", *SIZE, *options)
        self.assertEqual((self.folder / "x.pfm").read_bytes(), (self.folder / "y.pfm").read_bytes())

    def test_samples_that_begin_again_count_once(self):
        """As well as those that continue in the next draw."""
        for most in (6, 40):
            folder = self.folder / str(most)
            shutil.copytree(SHADERS, folder)
            text, found = re.subn(r"int budget = frame.stepBudget;", f"int budget = min(frame.stepBudget, {most});", (folder / "trace.glsl").read_text())
            self.assertEqual(found, 1)
            (folder / "trace.glsl").write_text(text)
            cut = counted(self.folder, "alpha", "--shader-folder", folder)
            self.assertLess(known("alpha")["draws"], cut["draws"])
            self.assertEqual(known("alpha")["work"], cut["work"], most)

    def test_what_it_goes_with(self):
        self.fails(2, "render", SCENES / "cornell-box.gltf", "-o", self.folder / "x.png", "--count-work", says=["--count-work", "--stats"])
        self.fails(2, "render", SCENES / "cornell-box.gltf", "-o", self.folder / "x.png", "--count-work", "--stats", self.folder / "s", "--noise", 0.1,
                   says=["--count-work", "--noise"])


if __name__ == "__main__":
    if "--renew" in sys.argv:
        renew()
    else:
        main()

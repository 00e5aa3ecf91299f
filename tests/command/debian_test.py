#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The Debian package, installed by apt in a fresh Debian of this release and used there by an ordinary user, without a compiler; Python's
wheel, installed by pip in another one; and all of that, with all tests, made in a fresh Debian of the other release.

Skipped where a fresh Debian cannot be made (scripts/debian.py).
"""
import base64
import json
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from support import FRAGTRACE, SCENES, Case, main, run

BUILD = FRAGTRACE.parent
ROOT = SCENES.parent
sys.path.insert(0, str(ROOT / "scripts"))
from debian import KEPT, RELEASES, Debian, own_release, why_not  # noqa: E402

RENDER = ["--resolution", "64,64", "--spp", "8", "--quiet"]
# One triangle, by draco_encoder -qp 0 -cl 0.
DRACO = "RFJBQ08CAgEAAAABAwEAAQIBAQAJAwAAAAAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAA=="
# Until the window shows a picture that is done; then the status is printed.
VIEW = """
exec 3> number; Xvfb -displayfd 3 -screen 0 800x600x24 -nolisten tcp 2> xvfb.txt &
until [[ -s number ]]; do sleep 0.1; done
DISPLAY=:$(cat number) fragtrace view box.gltf --resolution 160,120 --spp 2 --denoise none --status-file status.json &
for i in {1..600}; do
  if grep -q '"state": *"resting"' status.json 2>/dev/null; then cat status.json; exit; fi
  kill -0 $! || exit 1
  sleep 0.1
done
exit 1
"""


def draco_scene():
    data = base64.b64decode(DRACO)
    extension = {"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}}
    return {"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}], "scene": 0,
            "extensionsUsed": list(extension), "extensionsRequired": list(extension),
            "buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64," + DRACO}],
            "bufferViews": [{"buffer": 0, "byteLength": len(data)}],
            "accessors": [{"componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
                          {"componentType": 5125, "count": 3, "type": "SCALAR"}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "extensions": extension}]}]}


class InDebian(Case):
    """Needs fresh systems of `release`, and has a folder for them."""
    release = own_release()

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        reason = why_not(cls.release)
        if reason:
            raise unittest.SkipTest(reason)
        KEPT.mkdir(parents=True, exist_ok=True)
        cls.place = Path(cls.enterClassContext(tempfile.TemporaryDirectory(dir=KEPT)))

    def fresh(self):
        """Returns a fresh system with two scenes in the user's home folder."""
        debian = Debian(self.enterContext(tempfile.TemporaryDirectory(dir=self.place)), self.release)
        shutil.copy(SCENES / "cornell-box.gltf", debian.home / "box.gltf")
        (debian.home / "draco.gltf").write_text(json.dumps(draco_scene()))
        return debian

    def does(self, result):
        self.assertEqual(result.returncode, 0, result.stdout[-2000:] + result.stderr[-2000:])
        return result.stdout


class PackageChecks:
    """Checks of `package`, a file for `release`. They are mixed into a case InDebian."""

    def setUp(self):
        super().setUp()
        self.debian = self.fresh()
        shutil.copy(self.package, self.debian.root / "root/fragtrace.deb")

    def draws(self, *options):
        """The Cornell box, as the program that was built here draws it."""
        own = self.folder / "own.png"
        self.renders(SCENES / "cornell-box.gltf", *RENDER, "-o", own)
        self.does(self.debian.run(f"fragtrace render box.gltf {' '.join([*RENDER, *options])} -o box.png", "painter"))
        result = run("diff", self.debian.home / "box.png", own, "--metric", "rmse", "--threshold", "0.01")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def shows(self):
        status = json.loads(self.does(self.debian.run(VIEW, "painter")))
        self.assertEqual(status["state"], "resting")

    def completes(self, *words):
        """Returns the words that bash offers the user for the last word."""
        script = ("source /usr/share/bash-completion/completions/fragtrace; "
                  f"COMP_WORDS=({' '.join(words)}); COMP_CWORD={len(words) - 1}; _fragtrace; echo ${{COMPREPLY[@]}}")
        return self.does(self.debian.run(script, "painter")).split()

    def advised(self, command, status):
        """Returns the packages that the program advises to install for this to work."""
        result = self.debian.run(command, "painter")
        self.assertEqual(result.returncode, status, result.stderr)
        advice = re.search(r"apt-get install ([\w. -]+)", result.stderr)
        self.assertTrue(advice, result.stderr)
        return advice[1].split()

    def test_with_recommended_packages_all_works(self):
        self.does(self.debian.install("./fragtrace.deb", "man-db"))
        self.assertEqual(self.debian.run("type gcc g++ cc c++ clang", "painter").stdout, "")
        self.draws("--rendering-backend", "egl")
        self.draws("--rendering-backend", "osmesa")
        self.assertIn(f"+deb{RELEASES.index(self.release) + 12}", self.does(self.debian.run("dpkg-query -W fragtrace")))
        self.assertIn("triangles   1 ", self.does(self.debian.run("fragtrace info draco.gltf", "painter")))
        self.assertEqual(self.completes("fragtrace", "ren"), ["render"])
        self.assertEqual(self.completes("fragtrace", "render", "--trav"), ["--traversal"])
        self.assertEqual(self.completes("fragtrace", "render", "--tone-map", "a"), ["aces", "agx"])
        self.assertIn("--traversal", self.does(self.debian.run("man fragtrace-render | cat", "painter")))
        self.does(self.debian.install("xvfb"))
        self.shows()

    def test_without_them_it_renders_and_says_what_else_to_install(self):
        self.does(self.debian.install("--no-install-recommends", "./fragtrace.deb"))
        self.draws()
        window = self.advised("fragtrace view box.gltf", 4)
        codecs = self.advised("fragtrace info draco.gltf", 3)
        self.does(self.debian.install("--no-install-recommends", *codecs))
        self.assertIn("triangles   1 ", self.does(self.debian.run("fragtrace info draco.gltf", "painter")))
        self.advised("fragtrace view box.gltf", 4)
        self.does(self.debian.install("--no-install-recommends", "xvfb", *window))
        self.shows()


class DebianPackage(PackageChecks, InDebian):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        subprocess.run(["cpack", "-G", "DEB", "--config", BUILD / "CPackConfig.cmake", "-B", cls.place], check=True, capture_output=True)
        cls.package = next(cls.place.glob("fragtrace_*_amd64.deb"))


class WheelChecks:
    """Checks of `wheel`. The machine brings Python and OpenGL only."""

    def test_it_draws_and_the_notebook_runs(self):
        debian = self.fresh()
        shutil.copy(self.wheel, debian.home)
        (debian.home / "docs").mkdir()
        (debian.home / "scenes").mkdir()
        shutil.copy(ROOT / "docs/notebook.ipynb", debian.home / "docs")
        shutil.copy(SCENES / "cornell-box.gltf", debian.home / "scenes")
        self.does(debian.run("apt-get install --yes --no-install-recommends python3-venv libegl1 libosmesa6 libgl1-mesa-dri && chown -R painter: /home/painter"))
        self.assertEqual(debian.run("type gcc g++ cc c++ clang", "painter").stdout, "")
        self.does(debian.run("python3 -m venv there && there/bin/pip install fragtrace-*.whl nbclient ipykernel", "painter"))
        own = self.folder / "own.exr"
        self.renders(SCENES / "cornell-box.gltf", *RENDER, "-o", own)
        for backend in ("egl", "osmesa"):
            self.does(debian.run(f"there/bin/python -c \"import fragtrace; fragtrace.render('box.gltf', resolution=(64, 64), spp=8, "
                                 f"rendering_backend='{backend}').save('box.exr')\"", "painter"))
            result = run("diff", debian.home / "box.exr", own, "--metric", "max", "--threshold", "0.001")
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.does(debian.run("there/bin/fragtrace render box.gltf -o command.png --spp 1 --resolution 16,16", "painter"))
        self.does(debian.run("cd docs && ../there/bin/python -c \"import nbformat, nbclient; "
                             "nbclient.NotebookClient(nbformat.read('notebook.ipynb', 4), timeout=900).execute()\"", "painter"))


class WheelInDebian(WheelChecks, InDebian):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        subprocess.run([ROOT / "scripts/package", "wheel"], check=True, capture_output=True)
        cls.wheel = next((ROOT / "dist").glob("fragtrace-*.whl"))


class OtherRelease(PackageChecks, WheelChecks, InDebian):
    """Follows a newcomer on the other release, from a clean clone: the two commands, the packages, and the other
    drivers."""
    release = next((name for name in RELEASES if name != own_release()), "")
    clone = "/home/painter/fragtrace"

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.builder = Debian(cls.place / "builder", cls.release)
        clone = cls.builder.root / cls.clone[1:]
        files = subprocess.run(["git", "ls-files", "-z", "-co", "--exclude-standard"], cwd=ROOT, check=True, capture_output=True).stdout
        clone.mkdir()
        subprocess.run(["cp", "--parents", "-t", clone, *filter(None, files.decode().split("\0"))], cwd=ROOT, check=True)
        for command in ("scripts/run", "scripts/test", "scripts/package"):
            result = cls.builder.run(f"cd {cls.clone} && {command}", timeout=5400)
            print(command, result.stdout[-6000:], result.stderr[-3000:], sep="\n")
            if result.returncode != 0:
                raise AssertionError(f"{command} failed on {cls.release}")
        cls.package = next((clone / "dist").glob("*.deb"))
        cls.wheel = next((clone / "dist").glob("*.whl"))

    def pictures(self, driver, environment=""):
        """Draws all reference pictures by EGL, with that driver."""
        box = "build/fragtrace render scenes/cornell-box.gltf --spp 1 --quiet -o /tmp/box.pfm --stats -"
        self.assertIn(driver, self.does(self.builder.run(f"cd {self.clone} && {environment} {box}")))
        self.does(self.builder.run(f"cd {self.clone} && {environment} ctest --test-dir build -j 2 -R '^picture.*egl$'", timeout=5400))

    def test_newer_mesa_draws_the_references(self):
        if self.release != "trixie":
            self.skipTest("only Debian 13 has a newer Mesa in its backports")
        source = "deb http://deb.debian.org/debian trixie-backports main"
        self.does(self.builder.run(f"echo '{source}' > /etc/apt/sources.list.d/backports.list && apt-get update && "
                                   "apt-get install --yes --no-install-recommends -t trixie-backports libgl1-mesa-dri libegl-mesa0 mesa-vulkan-drivers"))
        self.pictures("Mesa 26")

    def test_zink_draws_the_references(self):
        self.does(self.builder.install("--no-install-recommends", "mesa-vulkan-drivers"))
        self.pictures("zink", "LIBGL_ALWAYS_SOFTWARE=1 MESA_LOADER_DRIVER_OVERRIDE=zink")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The Debian package, installed by apt in a fresh Debian 12 (debootstrap) and used there by an ordinary user, without a compiler; and
Python's wheel, installed by pip in another one.

Needs root, the network and debootstrap; skipped without them. The fresh Debian and the packages that apt has fetched stay in BUILD/debian.
"""
import base64
import json
import os
import re
import shutil
import subprocess
import tempfile
import unittest
import urllib.request
from pathlib import Path

from support import FRAGTRACE, SCENES, Case, main, run

BUILD = FRAGTRACE.parent
KEPT = BUILD / "debian"
RELEASE = "bookworm"
TOOLS = ("debootstrap", "dpkg-shlibdeps", "cpack", "unshare", "chroot")
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


def mirror():
    """Where this machine's apt takes Debian from."""
    lists = [Path("/etc/apt/sources.list"), *Path("/etc/apt/sources.list.d").glob("*")]
    found = re.findall(r"^(?:deb|URIs:)\s(?:.*\s)?(https?://\S+/debian)/?(?:\s|$)", "\n".join(p.read_text() for p in lists if p.is_file()), re.MULTILINE)
    return found[0] if found else "http://deb.debian.org/debian"


def why_not():
    """What is missing for these tests, or ''."""
    missing = [tool for tool in TOOLS if not shutil.which(tool)]
    if os.geteuid() != 0:
        return "needs root"
    if missing:
        return "not installed: " + ", ".join(missing)
    try:
        urllib.request.urlopen(f"{mirror()}/dists/{RELEASE}/Release", timeout=20).close()
    except OSError as error:
        return f"{mirror()} cannot be reached: {error}"
    return ""


class Debian:
    """A Debian of its own below a temporary folder."""

    def __init__(self, folder):
        self.root = Path(folder) / "root"
        subprocess.run(["cp", "-a", "--reflink=auto", fresh_debian(), self.root], check=True)
        (KEPT / "archives/partial").mkdir(parents=True, exist_ok=True)
        for name in ("resolv.conf", "hosts"):
            shutil.copy(Path("/etc") / name, self.root / "etc" / name)
        proxies = subprocess.run(["apt-config", "dump"], capture_output=True, text=True, check=True).stdout
        (self.root / "etc/apt/apt.conf.d/proxy").write_text("".join(line + "\n" for line in proxies.splitlines() if re.match(r"Acquire::https?::Proxy", line)))
        (self.root / "usr/sbin/policy-rc.d").write_text("#!/bin/sh\nexit 101\n")
        (self.root / "usr/sbin/policy-rc.d").chmod(0o755)
        self.run("apt-get update && useradd --create-home --shell /bin/bash painter")
        self.home = self.root / "home/painter"
        shutil.copy(SCENES / "cornell-box.gltf", self.home / "box.gltf")
        (self.home / "draco.gltf").write_text(json.dumps(draco_scene()))

    def run(self, script, user="root"):
        """What bash makes of the script there, in the user's home folder. All its processes and mounts end with it."""
        proxies = [f"{name}={os.environ[name]}" for name in ("http_proxy", "https_proxy", "no_proxy") if name in os.environ]
        home = "/root" if user == "root" else f"/home/{user}"
        outside = ('mount -t proc proc "$0/proc" && mount -t tmpfs tmpfs "$0/dev/shm" && mount --bind "$1" "$0/var/cache/apt/archives" && '
                   'root=$0 user=$2 && shift 2 && exec chroot --userspec="$user" "$root" "$@"')
        return subprocess.run(["unshare", "--mount", "--propagation", "private", "--pid", "--fork", "--kill-child",
                               "sh", "-c", outside, self.root, KEPT / "archives", user, "env", "-i", *proxies, f"HOME={home}", "LC_ALL=C.UTF-8",
                               "DEBIAN_FRONTEND=noninteractive", "PATH=/usr/sbin:/usr/bin:/sbin:/bin", "bash", "-c", f"cd {home}\n{script}"],
                              capture_output=True, text=True, timeout=1800, check=False)

    def install(self, *packages):
        return self.run("apt-get install --yes " + " ".join(packages))


def fresh_debian():
    base = KEPT / "base"
    if not (base / "finished").exists():
        shutil.rmtree(base, ignore_errors=True)
        base.mkdir(parents=True)
        subprocess.run(["debootstrap", "--variant=minbase", RELEASE, base, mirror()], check=True, stdout=subprocess.DEVNULL)
        (base / "finished").touch()
    return base


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


class DebianPackage(Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        reason = why_not()
        if reason:
            raise unittest.SkipTest(reason)
        KEPT.mkdir(exist_ok=True)
        cls.place = Path(cls.enterClassContext(tempfile.TemporaryDirectory(dir=KEPT)))
        subprocess.run(["cpack", "-G", "DEB", "--config", BUILD / "CPackConfig.cmake", "-B", cls.place], check=True, capture_output=True)
        cls.package = next(cls.place.glob("fragtrace_*_amd64.deb"))

    def setUp(self):
        super().setUp()
        folder = tempfile.mkdtemp(dir=self.place)
        self.addCleanup(shutil.rmtree, folder)
        self.debian = Debian(folder)
        shutil.copy(self.package, self.debian.root / "root/fragtrace.deb")

    def does(self, result):
        self.assertEqual(result.returncode, 0, result.stdout[-2000:] + result.stderr[-2000:])
        return result.stdout

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
        """What bash offers the user for the last word."""
        script = ("source /usr/share/bash-completion/completions/fragtrace; "
                  f"COMP_WORDS=({' '.join(words)}); COMP_CWORD={len(words) - 1}; _fragtrace; echo ${{COMPREPLY[@]}}")
        return self.does(self.debian.run(script, "painter")).split()

    def advised(self, command, status):
        """What the program says that one should install for this to work."""
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


class WheelInDebian(Case):
    """All that the machine brings is Python and OpenGL."""

    def setUp(self):
        super().setUp()
        reason = why_not()
        if reason:
            self.skipTest(reason)
        KEPT.mkdir(exist_ok=True)
        folder = self.enterContext(tempfile.TemporaryDirectory(dir=KEPT))
        subprocess.run([SCENES.parent / "scripts/package", "wheel"], check=True, capture_output=True)
        self.debian = Debian(folder)
        certificates = Path(os.environ.get("PIP_CERT", "/etc/ssl/certs/ca-certificates.crt"))
        shutil.copy(certificates, self.debian.root / "etc/certificates.crt")
        home = self.debian.home
        for wheel in (SCENES.parent / "dist").glob("fragtrace-*.whl"):
            shutil.copy(wheel, home)
        (home / "docs").mkdir()
        (home / "scenes").mkdir()
        shutil.copy(SCENES.parent / "docs/notebook.ipynb", home / "docs")
        shutil.copy(SCENES / "cornell-box.gltf", home / "scenes")
        self.does("apt-get install --yes --no-install-recommends python3-venv libegl1 libosmesa6 libgl1-mesa-dri; chown -R painter: /home/painter")

    def does(self, script, user="root"):
        result = self.debian.run(script, user)
        self.assertEqual(result.returncode, 0, result.stdout[-2000:] + result.stderr[-2000:])
        return result.stdout

    def test_it_draws_and_the_notebook_runs(self):
        self.assertEqual(self.debian.run("type gcc g++ cc c++ clang", "painter").stdout, "")
        self.does("python3 -m venv there && there/bin/pip install --cert /etc/certificates.crt fragtrace-*.whl nbclient ipykernel", "painter")
        own = self.folder / "own.exr"
        self.renders(SCENES / "cornell-box.gltf", *RENDER, "-o", own)
        for backend in ("egl", "osmesa"):
            self.does(f"there/bin/python -c \"import fragtrace; fragtrace.render('box.gltf', resolution=(64, 64), spp=8, "
                      f"rendering_backend='{backend}').save('box.exr')\"", "painter")
            result = run("diff", self.debian.home / "box.exr", own, "--metric", "max", "--threshold", "0.001")
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.does("there/bin/fragtrace render box.gltf -o command.png --spp 1 --resolution 16,16", "painter")
        self.does("cd docs && ../there/bin/python -c \"import nbformat, nbclient; "
                  "nbclient.NotebookClient(nbformat.read('notebook.ipynb', 4), timeout=900).execute()\"", "painter")


if __name__ == "__main__":
    main()

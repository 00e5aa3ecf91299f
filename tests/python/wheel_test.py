#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The wheel: made by scripts/package, installed into a clean virtual environment, and tried there (package_test.py), notebook included.

usage: wheel_test.py FRAGTRACE SOURCE_FOLDER. Needs the network. Kept next to the program: the environment, made anew for another wheel."""
import hashlib
import os
import subprocess
import sys
import zipfile
from pathlib import Path

FRAGTRACE, SOURCE = (Path(argument).resolve() for argument in sys.argv[1:3])
PLACE = FRAGTRACE.parent / "wheel_test"
# Libraries that the wheel must not bring: OpenGL is the machine's, OpenImageIO comes from PyPI.
FOREIGN = ("libEGL", "libGL", "libOSMesa", "libgallium", "libOpenImageIO", "libOpenEXR", "libQt")


def run(*command, **options):
    print("+", *command, flush=True)
    subprocess.run([*map(str, command)], check=True, **options)


def wheel_of_these_sources():
    run(SOURCE / "scripts/package", "wheel")
    (wheel,) = (SOURCE / "dist").glob("fragtrace-*.whl")
    return wheel


def main():
    wheel = wheel_of_these_sources()
    names = zipfile.ZipFile(wheel).namelist()
    brought = [name for name in names if any(library in name for library in FOREIGN)]
    assert not brought, brought
    mark = PLACE / "wheel.sha256"
    digest = hashlib.sha256(wheel.read_bytes()).hexdigest()
    python = PLACE / "environment/bin/python"
    if not mark.exists() or mark.read_text() != digest:
        run("/usr/bin/python3" if Path("/usr/bin/python3").exists() else sys.executable, "-m", "venv", "--clear", PLACE / "environment")
        run(python, "-m", "pip", "install", "--quiet", wheel, "mypy", "trimesh", "nbclient", "ipykernel", "nbformat")
        mark.write_text(digest)
    # No compiler, and nothing of the build, is in sight.
    clean = {"PATH": f"{python.parent}:/usr/bin:/bin", "HOME": str(PLACE), "MESA_SHADER_CACHE_DISABLE": "true",
             **{name: os.environ[name] for name in ("LIBGL_ALWAYS_SOFTWARE",) if name in os.environ}}
    run(python, Path(__file__).with_name("package_test.py"), FRAGTRACE, SOURCE, env=clean, cwd=PLACE)
    run(python, "-c", "import nbformat, nbclient, sys; nbclient.NotebookClient(nbformat.read(sys.argv[1], 4), timeout=600).execute()",
        SOURCE / "docs/notebook.ipynb", env=clean, cwd=SOURCE / "docs")


if __name__ == "__main__":
    main()

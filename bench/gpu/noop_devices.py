# SPDX-License-Identifier: MIT
"""A Debian 13 with Mesa's drivers for GPUs, and with devices that do nothing (Mesa's drm-shim), so that they compile where there is no GPU.

Needs what scripts/debian.py needs, and 6 GB of ~/.cache/fragtrace/gpu-compilers (FRAGTRACE_GPU_COMPILERS). It is made once, in a few minutes.
"""
import os
import shutil
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))

import debian  # noqa: E402

FOLDER = Path(os.environ.get("FRAGTRACE_GPU_COMPILERS", Path.home() / ".cache/fragtrace/gpu-compilers"))
RELEASE = "trixie"
SHIMS = {kind: f"/root/shims/src/{place}/lib{kind}_noop_drm_shim.so" for kind, place in
         (("intel", "intel/tools"), ("amdgpu", "amd/drm-shim"), ("nouveau", "nouveau/drm-shim"))}

# The devices that the shim plays, by name: the driver that compiles for each, and its environment.
DEVICES = {"GA102": ("nouveau", {"NOUVEAU_CHIPSET": "172", "ZINK_DEBUG": "shaderdb", "MESA_LOADER_DRIVER_OVERRIDE": "zink",
                                 "VK_DRIVER_FILES": "/usr/share/vulkan/icd.d/nouveau_icd.json"}),
           "navi21": ("amdgpu", {"AMDGPU_GPU_ID": "navi21", "MESA_LOADER_DRIVER_OVERRIDE": "radeonsi"}),
           "DG2": ("intel", {"INTEL_STUB_GPU_PLATFORM": "dg2", "MESA_LOADER_DRIVER_OVERRIDE": "iris"})}

# Messages of compilers come at once and in this thread without Gallium's own thread.
COMPILING = {"ST_DEBUG": "precompile", "shader_precompile": "true", "GALLIUM_THREAD": "0", "MESA_SHADER_CACHE_DISABLE": "true", "EGL_PLATFORM": "surfaceless"}

# After what the shims are built with: the other way round, the libraries of backports are newer than those that it asks for.
DRIVERS = f"""
apt-get install -y --no-install-recommends -t {RELEASE}-backports libgl1-mesa-dri mesa-vulkan-drivers libegl-mesa0 libegl1 libgl1
apt-get install -y --no-install-recommends python3-opengl
"""
# amdgpu: the version that today's driver asks for. Without assertions: the intel one has a region of no size.
SHIM_BUILD = f"""
apt-get update
apt-get build-dep -y --no-install-recommends mesa
apt-get source mesa
cd mesa-*/
sed -i 's/version_minor = [0-9]*/version_minor = 57/' src/amd/drm-shim/amdgpu_noop_drm_shim.c
meson setup /root/shims -Dbuildtype=release -Db_ndebug=true -Dtools=drm-shim,intel -Dgallium-drivers=iris,radeonsi,nouveau -Dvulkan-drivers= -Dplatforms= -Dglx=disabled
cd /root/shims
ninja {" ".join(shim.removeprefix("/root/shims/") for shim in SHIMS.values())}
rm -rf /root/mesa-* /root/mesa_*
"""


def why_not():
    """Returns a text that names what the system lacks, or ''."""
    return "" if os.geteuid() == 0 and (FOLDER / "finished").exists() else debian.why_not(RELEASE)


def made():
    """The system, made again where it is not finished. Raises RuntimeError, OSError."""
    finished = FOLDER / "finished"
    if not finished.exists():
        shutil.rmtree(FOLDER, ignore_errors=True)
    system = debian.Debian(FOLDER, RELEASE)
    if not finished.exists():
        sources = f"deb-src {debian.mirror()} {RELEASE} main\ndeb {debian.mirror()} {RELEASE}-backports main\n"
        (system.root / "etc/apt/sources.list.d/mesa.list").write_text(sources)
        done = system.run(f"set -e\n{SHIM_BUILD}{DRIVERS}", timeout=3600)
        if done.returncode:
            raise RuntimeError(f"the root of the compilers could not be made: {done.stderr[-2000:]}")
        finished.touch()
    return system


def compile_texts(system, device, files, timeout=1800):
    """Returns the standard output of compile_texts.py there, for files of the host. Raises RuntimeError."""
    kind, environment = DEVICES[device]
    folder = system.root / "root/texts"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    here = Path(__file__).parent
    for file in (*files, here / "compile_texts.py", here.parent / "shader_texts.py"):
        shutil.copy(file, folder)
    variables = " ".join(f"{name}={value}" for name, value in {**COMPILING, **environment, "LD_PRELOAD": SHIMS[kind]}.items())
    done = system.run(f"cd texts && env {variables} python3 compile_texts.py {' '.join(file.name for file in files)}", timeout=timeout)
    if done.returncode:
        raise RuntimeError(f"{device}: {done.stderr[-2000:]}")
    return done.stdout

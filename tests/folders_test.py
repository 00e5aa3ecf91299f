#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The order of the folders of src, bench and tests/instruments: a file includes what is in its own folder or in one that is named before (docs/design/architecture.md).
Each class of tests in tests/command and tests/viewer stands in tests/CMakeLists.txt.

usage: folders_test.py SOURCE_FOLDER"""
import re
import sys
from pathlib import Path

# "." is what the build generates.
LAYERS = (".", "base", "base/worker", "image", "image/display", "image/compare", "image/worker", "image/files", "image/denoise", "scene/volume", "scene/volume/worker", "scene/sky", "scene", "scene/motion", "bvh", "gltf",
          "gltf/codecs/worker", "gltf/read", "gltf/check", "gltf/codecs", "gltf/assemble", "gltf/edit", "shader", "options/library", "options", "pack/textures", "pack", "render/film", "gl", "render",
          "view", "view/letters", "view/window", "session", "session/picture", "python", "view/live", "cli",
          # The instruments see the product, which does not see them.
          "bench/report", "tests/instruments/rays", "tests/instruments/stress", "bench/command", "bench/gpu", "bench/peers")
MOST_FILES = 40  # in a folder: more is more than one concept


def sources(folder):
    return sorted(path for path in folder.rglob("*") if path.suffix in (".h", ".cpp"))


def wrong_includes(files, root):
    """Yields the wrong includes of files whose includes of their own kind are relative to `root`."""
    for file in files:
        own = str(file.parent.relative_to(root))
        if own not in LAYERS:
            yield f"{file}: its folder is not in the order of layers"
            continue
        for number, line in enumerate(file.read_text().splitlines(), 1):
            found = re.match(r'#include "([^"]+)\.h"', line)
            if found and LAYERS.index(str(Path(found[1]).parent)) > LAYERS.index(own):
                yield f"{file}:{number}: {own} comes before {Path(found[1]).parent}, which it includes"


def full_folders(folder):
    for one in (folder, *(path for path in folder.rglob("*") if path.is_dir())):
        count = sum(path.is_file() for path in one.iterdir())
        if count > MOST_FILES:
            yield f"{one}: {count} files, at most {MOST_FILES}"


def unlisted_tests(tests):
    """Classes of tests that ctest does not run, nor a class that is derived from them."""
    listed = set(re.findall(r"\w+", (tests / "CMakeLists.txt").read_text()))
    for file in sorted([*tests.glob("command/*_test.py"), *tests.glob("viewer/*_test.py")]):
        text = file.read_text()
        bases = {name for bases in re.findall(r"^class \w+\((.*)\):", text, re.M) for name in re.findall(r"\w+", bases)}
        for body in re.split(r"^class ", text, flags=re.M)[1:]:
            name = re.match(r"\w+", body)[0]
            if re.search(r"^    def test_", body, re.M) and name not in listed | bases:
                yield f"{file}: class {name} is not in tests/CMakeLists.txt"


def main():
    source = Path(sys.argv[1])
    wrong = [*wrong_includes(sources(source / "src"), source / "src"), *wrong_includes(sources(source / "bench") + sources(source / "tests/instruments"), source)]
    wrong += [one for name in ("src", "shaders", "bench", "tests/instruments") for one in full_folders(source / name)]
    wrong += unlisted_tests(source / "tests")
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

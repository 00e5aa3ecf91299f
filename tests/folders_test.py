#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The order of the folders of src: a file includes what is in its own folder or in one that is named before (docs/design/architecture.md).

usage: folders_test.py SOURCE_FOLDER"""
import re
import sys
from pathlib import Path

LAYERS = (".", "math", "process", "image", "image/display", "image/compare", "image/worker", "image/files", "denoise", "scene", "bvh", "gltf",
          "gltf/codecs/worker", "gltf/read", "gltf/check", "gltf/codecs", "gltf/build", "stage", "shader", "pack", "film", "bench", "gl", "render",
          "stress", "view/picture", "view", "view/window", "options", "session", "picture", "python", "live", "cli/bench", "cli")
MOST_FILES = 40  # in a folder: more is more than one concept


def wrong_includes(src):
    for file in sorted(path for path in src.rglob("*") if path.suffix in (".h", ".cpp")):
        own = str(file.parent.relative_to(src))
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


def main():
    source = Path(sys.argv[1])
    wrong = [*wrong_includes(source / "src"), *full_folders(source / "src"), *full_folders(source / "shaders")]
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

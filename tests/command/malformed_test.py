#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The Khronos glTF validator's own test files, each beside the report that it must have: files without errors load, every
error in what the program reads is refused or warned about at its place. Skipped where the folder is absent.

Run with FRAGTRACE_ASSETS=FOLDER for another folder of assets than /work/shared/assets."""
import json
import os
import re
import unittest
from pathlib import Path

from support import Case, main, run

FOLDER = Path(os.environ.get("FRAGTRACE_ASSETS", "/work/shared/assets")) / "malformed/gltf-validator-test"

# Codes of errors in data that the program does not read.
NOT_READ = {
    "ACCESSOR_ELEMENT_OUT_OF_MAX_BOUND": "min and max are not read: bounds are taken from the elements",
    "ACCESSOR_ELEMENT_OUT_OF_MIN_BOUND": "as above",
    "ACCESSOR_MAX_MISMATCH": "as above",
    "ACCESSOR_MIN_MISMATCH": "as above",
    "MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS": "as above",
    "ANIMATION_SAMPLER_INPUT_ACCESSOR_WITHOUT_BOUNDS": "as above",
    "BUFFER_VIEW_TARGET_OVERRIDE": "target is a hint for uploads and not read",
    "MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_UNSIGNED_INT": "attributes of the author's own (_NAME) are not read",
    "MESH_PRIMITIVE_NO_TANGENT_SPACE": "tangents are made where there are none",
    "IMAGE_NON_ENABLED_MIME_TYPE": "WebP is read wherever it is found",
    "TEXTURE_INVALID_IMAGE_MIME_TYPE": "as above",
}

# Animations are read where a time is asked for.
MOVED = ["--animation-time", "0"]
UNMOVED = "has no animation that a time could be of"

# Files whose errors are in objects that nothing shows, and which are not opened or decoded.
UNUSED = {
    "base/data/accessor_data/invalid_elements_float.gltf": "no primitive reads the accessor",
    "base/data/image/invalid_data_uri.gltf": "no material shows the picture",
    "base/data/image/invalid_data_uri_mime_type.gltf": "as above",
    "base/data/image/invalid_image_data.gltf": "as above",
    "base/data/image/invalid_uri_scheme.gltf": "as above",
    "base/data/image/not_found.gltf": "as above",
    "base/data/image/png_eos.gltf": "as above",
    "base/data/mesh_data/index_buffer_oob.gltf": "no node shows the mesh, whose indices are therefore not read",
    "base/data/mesh_data/index_buffer_primitive_restart.gltf": "as above",
    "base/data/mesh_data/normals_tangents_non_unit_invalid_sign.gltf": "as above",
    "base/data/skin_data/invalid_ibm.gltf": "no node has the skin",
    "ext/EXT_texture_webp/data/texture/invalid_image_mime_type.gltf": "no material shows the pictures",
}

# Refused at another place than the report's.
ELSEWHERE = {
    "base/data/camera/infinite_znear.gltf": "1e309 is no number: its line and column are named, not its place",
    "base/data/node/infinite_transform.gltf": "as above",
    "base/data/animation/sampler_bufferview_bytestride.gltf": "its keys are in a buffer that is nowhere",
}

# Files that the validator has no error in and that cannot be drawn.
REFUSED = {
    "base/data/asset/min_version_valid.gltf": "asks for glTF 2.1",
    "base/data/buffer/non_relative_uri.gltf": "its buffer is on a web server",
    "base/data/root/named_objects.gltf": "its vertices are in a buffer that is nowhere",
    "base/data/root/unused_objects.gltf": "as above",
}


# JSON pointers of a message, which follow the file's name or "also at".
PLACE = re.compile(r"(?:: |at |, )(/[^ ,:)]*)(?=[ ,:)])")


def lines_at(lines, pointer):
    """Those whose place is the pointer, or holds it, or lies in it."""
    found = []
    for line in lines:
        for place in PLACE.findall(line):
            if place == pointer or place.startswith(pointer + "/") or pointer.startswith(place + "/"):
                found.append(line)
    return found


@unittest.skipUnless(FOLDER.is_dir(), f"{FOLDER} is absent")
class ValidatorFiles(Case):
    def test_every_file_is_loaded_or_refused_as_its_report_says(self):
        reports = sorted(FOLDER.glob("**/*.report.json"))
        self.assertEqual(len(reports), 372)
        faults, table = [], {}
        for report in reports:
            path = Path(str(report).removesuffix(".report.json"))
            name = str(path.relative_to(FOLDER))
            errors = [m for m in json.loads(report.read_text())["issues"]["messages"] if m["severity"] == 0]
            result = run("info", path, *MOVED, timeout=20)
            lines = [line for line in result.stderr.splitlines() if not line.endswith(UNMOVED)]
            if result.returncode not in (0, 3) or (result.returncode == 3 and len(lines) != 1):
                faults.append((name, "status", result.returncode, result.stderr))
            elif result.returncode == 3 and str(path) not in lines[0]:
                faults.append((name, "does not name the file", lines[0]))
            elif not errors:
                if (result.returncode == 3) != (name in REFUSED):
                    faults.append((name, "has no error", lines))
            elif name not in UNUSED:
                self.count(table, name, errors, result, lines, faults)
        for code, (refused, warned, silent) in sorted(table.items()):
            print(f"{code:56} refused {refused:3} warned {warned:3} silent {silent:3}")
        self.assertEqual(faults, [], "\n".join(map(str, faults)))

    def test_the_lists_of_exceptions_name_files_that_are_there(self):
        for name in {**UNUSED, **ELSEWHERE, **REFUSED}:
            self.assertTrue((FOLDER / name).is_file(), name)

    def count(self, table, name, errors, result, lines, faults):
        for error in errors:
            row = table.setdefault(error["code"], [0, 0, 0])
            pointer = error.get("pointer", "").rstrip("/")
            if result.returncode == 3:
                row[0] += 1
            elif lines_at(lines, pointer) or (pointer == "" and lines):
                row[1] += 1
            elif any("more places" in line for line in lines):  # the same reason elsewhere, counted
                row[1] += 1
            else:
                row[2] += 1
                if error["code"] not in NOT_READ:
                    faults.append((name, error["code"], error.get("pointer"), error["message"], lines))
        if result.returncode == 3 and errors[0].get("pointer") is not None:
            places = [e.get("pointer", "").rstrip("/") for e in errors]
            if name not in ELSEWHERE and not any(p == "" or lines_at(lines, p) for p in places):
                faults.append((name, "refused elsewhere", places, lines))


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Compressed geometry where the process that decodes it is missing, crashes or loops."""
import base64
import json
import os
import shutil
import struct
import subprocess
import time

from support import FRAGTRACE, SCENES, SMALL, Case, main, run

TRIANGLE = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
INDICES = struct.pack("<3I", 0, 1, 2)


def meshopt(fallback):
    """A triangle whose positions are compressed (by nobody); uncompressed, too, with a fallback."""
    extension = {"buffer": 0, "byteLength": 36, "byteStride": 12, "count": 3, "mode": "ATTRIBUTES"}
    data = base64.b64encode(TRIANGLE).decode()
    plain = {"uri": "data:application/octet-stream;base64," + data} if fallback else {}
    return {"extensionsUsed": ["EXT_meshopt_compression"],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
            "bufferViews": [{"buffer": 1, "byteLength": 36, "extensions": {"EXT_meshopt_compression": extension}}],
            "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64," + data},
                        {"byteLength": 36, **plain, "extensions": {"EXT_meshopt_compression": {"fallback": True}}}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}]}


def draco(fallback):
    extension = {"bufferView": 0, "attributes": {"POSITION": 0}}
    views = [{"bufferView": 0}, {"bufferView": 1}] if fallback else [{}, {}]
    return {"extensionsUsed": ["KHR_draco_mesh_compression"],
            "accessors": [{**views[0], "componentType": 5126, "count": 3, "type": "VEC3"},
                          {**views[1], "componentType": 5125, "count": 3, "type": "SCALAR"}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 12}],
            "buffers": [{"byteLength": 48, "uri": "data:application/octet-stream;base64,"
                                                  + base64.b64encode(TRIANGLE + INDICES).decode()}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1,
                                        "extensions": {"KHR_draco_mesh_compression": extension}}]}]}


class Codecs(Case):
    def write(self, document):
        return self.written("scene.gltf", {"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}], **document})

    def without(self, document):
        """Returns the result of a copy of the executable without its worker and libraries."""
        shutil.copy(FRAGTRACE, self.folder / "fragtrace")
        environment = {k: v for k, v in os.environ.items() if k != "FRAGTRACE_LIBRARY_PATH"}
        return subprocess.run([self.folder / "fragtrace", "info", "--json", self.write(document)], capture_output=True,
                              text=True, env=environment)

    def test_without_the_codecs_uncompressed_data_are_taken_with_a_warning(self):
        for make in (meshopt, draco):
            result = self.without(make(True))
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(json.loads(result.stdout)["scene"]["triangles"], 1)
            self.assertIn("cannot be decoded, the uncompressed data are taken: fragtrace_worker is not in", result.stderr)

    def test_without_the_codecs_and_such_data_the_file_is_refused_by_the_extensions_name(self):
        for make, name in ((meshopt, "EXT_meshopt_compression"), (draco, "KHR_draco_mesh_compression")):
            result = self.without(make(False))
            self.assertEqual(result.returncode, 3)
            self.assertIn(name + " cannot be decoded: fragtrace_worker is not in", result.stderr)

    def test_where_their_libraries_are_missing_uncompressed_data_are_taken(self):
        (self.folder / "libfragtrace_geometry.so").touch()  # cannot be opened, as one that misses a library
        for make in (meshopt, draco):
            result = run("info", self.write(make(True)), env={**os.environ, "FRAGTRACE_LIBRARY_PATH": str(self.folder)})
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("the uncompressed data are taken: the library that decodes it is not installed (on Debian", result.stderr)

    def test_a_module_that_is_missing_stops_no_other(self):
        textured = SCENES / "sphere-textured.gltf"
        for module, reads_pictures in (("libfragtrace_pictures.so", True), ("libfragtrace_geometry.so", False)):
            folder = self.folder / module[:-3]
            folder.mkdir()
            for name in ("fragtrace", "fragtrace_worker", module):
                shutil.copy(FRAGTRACE.parent / name, folder)
            environment = {k: v for k, v in os.environ.items() if k != "FRAGTRACE_LIBRARY_PATH"}
            compressed, picture = (subprocess.run([folder / "fragtrace", *map(str, command)], capture_output=True, text=True, env=environment)
                                   for command in (["info", self.write(draco(False))], ["render", textured, "-o", folder / "x.pfm", *SMALL]))
            self.assertEqual(compressed.returncode, 3)
            self.assertEqual("libfragtrace_geometry.so is not in" in compressed.stderr, reads_pictures, compressed.stderr)
            self.assertEqual("apt-get install libdraco" in compressed.stderr, reads_pictures, compressed.stderr)
            self.assertEqual(picture.returncode, 0 if reads_pictures else 3, picture.stderr)
            self.assertEqual("libfragtrace_pictures.so is not in" in picture.stderr, not reads_pictures, picture.stderr)

    def test_codecs_that_crash_loop_or_end_are_named(self):
        for script, says in (("kill -SEGV $$", "signal 11"), ("exit 7", "status 7"), ("exit 127", "apt-get install libdraco"), ("while :; do :; done", "longer to decode than its size is given")):
            stand_in = self.folder / "fragtrace_worker"
            stand_in.write_text("#!/bin/sh\n" + script)
            stand_in.chmod(0o755)
            began = time.monotonic()
            self.fails(3, "info", self.write(draco(False)), says=["/meshes/0/primitives/0/extensions", says],
                       env={**os.environ, "FRAGTRACE_LIBRARY_PATH": str(self.folder)})
            self.assertLess(time.monotonic() - began, 120)

    def test_files_that_need_no_codecs_do_not_start_them(self):
        stand_in = self.folder / "fragtrace_worker"
        stand_in.write_text(f"#!/bin/sh\ntouch {self.folder}/started")
        stand_in.chmod(0o755)
        document = meshopt(False)
        document["bufferViews"] = [{"buffer": 0, "byteLength": 36}]
        del document["buffers"][1]
        result = run("info", self.write(document), env={**os.environ, "FRAGTRACE_LIBRARY_PATH": str(self.folder)})
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertFalse((self.folder / "started").exists())


if __name__ == "__main__":
    main()

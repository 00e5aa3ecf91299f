#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A model from a stranger can cost bounded time and memory, and nothing else (SECURITY.md): 40 kinds of attempts at other files, at memory, at time and
at the terminal. Each ends within 10 s and 1 GB, with the status of a broken file, one line without control characters, and no file outside touched."""
import base64
import gzip
import json
import os
import resource
import socket
import subprocess
import threading
import time

from limits_test import hostile_pictures
from support import FRAGTRACE, Case, data_uri, main, png, quad

SECRET = b"the secret of another folder"
ESCAPE = "\x1b]0;owned\x07\n\r\x9b31m\x7f\u202egnp.exe\u2066"
SECONDS, BYTES = 10, 1 << 30


def huge_jpeg():
    """A header of 65,500 x 65,500 pixels, and no data."""
    return bytes.fromhex("ffd8ffc0001108ffdcffdc03011100021101031101ffda000c03010002110311003f00")


def square(material=None):
    gltf = quad(material or {})
    del gltf["images"], gltf["textures"]
    return gltf


def with_buffer(uri):
    gltf = square()
    gltf["buffers"][0]["uri"] = uri
    return gltf


def with_image(uri):
    gltf = quad({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}, images=[png(1, 1, b"\xff" * 4)])
    gltf["images"][0] = {"uri": uri}
    return gltf


def with_volume(uri):
    gltf = square()
    gltf["nodes"][0]["extras"] = {"fragtrace_volume": {"volume": uri}}
    return gltf


def changed(**members):
    """A quad whose accessor or other parts say what is not so."""
    gltf = square()
    for name, change in members.items():
        gltf[name][0] |= change
    return gltf


def deep():
    """Arrays in arrays, 200,000 of them."""
    return '{"asset": {"version": "2.0"}, "extras": ' + "[" * 200000 + "]" * 200000 + "}"


def chain(last):
    """Nodes below each other, the last of which has this child."""
    gltf = square()
    count = 50000
    gltf["nodes"] = [{"children": [i + 1]} for i in range(count - 1)] + [{"children": [last]} if last is not None else {"mesh": 0}]
    gltf["scenes"] = [{"nodes": [0]}]
    return gltf


def instances(count):
    gltf = square()
    gltf["extensionsUsed"] = ["EXT_mesh_gpu_instancing"]
    gltf["accessors"].append({"componentType": 5126, "count": count, "type": "VEC3"})
    gltf["nodes"][0]["extensions"] = {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": len(gltf["accessors"]) - 1}}}
    return gltf


class HostileModels(Case):
    def setUp(self):
        super().setUp()
        self.scene = self.folder / "scene"
        self.outside = self.folder / "outside"
        for folder in (self.scene, self.outside):
            folder.mkdir()
        (self.outside / "secret.bin").write_bytes(SECRET)

    def ends(self, model, *says, statuses=(3,), words=()):
        """The loader's answer to a model."""
        path = self.scene / "model.gltf"
        path.write_bytes(model if isinstance(model, bytes) else (model if isinstance(model, str) else json.dumps(model)).encode())
        before = {file: (file.stat().st_mtime_ns, file.read_bytes()) for file in self.outside.iterdir() if file.is_file()}
        began = time.monotonic()
        limit = lambda: (resource.setrlimit(resource.RLIMIT_DATA, (BYTES, BYTES)), resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS)))
        result = subprocess.run([FRAGTRACE, *map(str, words or ("info", path, "--memory-limit", "256MB"))],
                                capture_output=True, timeout=10 * SECONDS, preexec_fn=limit)
        error = result.stderr.decode(errors="replace")
        self.assertIn(result.returncode, statuses, error)
        self.assertLess(time.monotonic() - began, 10 * SECONDS)
        self.assertNotIn(SECRET, result.stdout + result.stderr)
        for text in (error, result.stdout.decode(errors="replace")):
            self.assertFalse([c for c in text if not c.isprintable() and c != "\n"], repr(text[:500]))
        if result.returncode:
            self.assertEqual(len(error.splitlines()), 1, error[:500])
        for text in says:
            self.assertIn(text, error)
        after = {file: (file.stat().st_mtime_ns, file.read_bytes()) for file in self.outside.iterdir() if file.is_file()}
        self.assertEqual(before, after)
        return error

    def test_names_that_lead_out_of_the_folder(self):
        secret = self.outside / "secret.bin"
        (self.scene / "link.bin").symlink_to(secret)
        (self.scene / "folder").symlink_to(self.outside)
        (self.scene / "chain.bin").symlink_to("link.bin")
        (self.scene / "round.bin").symlink_to("round.bin")
        for uri in ("../outside/secret.bin", "%2e%2e/outside/secret.bin", "..%2foutside%2fsecret.bin", "x/../../outside/secret.bin", str(secret), f"file://{secret}",
                    f"//localhost{secret}", "http://localhost/secret.bin", "link.bin", "folder/secret.bin", "chain.bin",
                    "/proc/self/environ", "/proc/self/fd/0", "C:\\secret.bin",
                    # Backslashes are slashes, and what they lead to is checked again.
                    "..\\outside\\secret.bin", "..%5coutside%5Csecret.bin", "%2e%2e%5Coutside/secret.bin", "x\\..\\..\\outside\\secret.bin",
                    str(secret).replace("/", "\\"), str(secret).replace("/", "%5C"), "\\\\localhost\\secret.bin", "folder\\secret.bin", "folder%5csecret.bin"):
            for model in (with_buffer(uri), with_image(uri)):
                self.ends(model, statuses=(3,))
        # Decoded once only: these are names of files that are not there. A texture that is missing is drawn magenta.
        for uri in ("round.bin", "secret.bin%00", "..%255coutside%255csecret.bin", "%252e%252e/outside/secret.bin"):
            self.ends(with_buffer(uri), statuses=(3,))
            self.ends(with_image(uri), "drawn in magenta", statuses=(0,))
            self.ends(with_image(uri), statuses=(3,), words=("info", "--missing-textures", "refuse", self.scene / "model.gltf"))
        for uri in ("../outside/secret.bin", str(secret), "link.bin"):
            self.ends(with_volume(uri), statuses=(3,))

    def test_names_of_what_is_no_file(self):
        os.mkfifo(self.scene / "pipe.bin")
        (self.scene / "zero.bin").symlink_to("/dev/zero")
        (self.scene / "tty.bin").symlink_to("/dev/tty")
        (self.scene / "memory.bin").symlink_to("/proc/self/mem")
        server = socket.socket(socket.AF_UNIX)
        self.addCleanup(server.close)
        there = os.getcwd()
        os.chdir(self.scene)  # names of sockets are short
        server.bind("socket.bin")
        os.chdir(there)
        for uri in ("pipe.bin", "zero.bin", "tty.bin", "memory.bin", "socket.bin", ".", ""):
            self.ends(with_buffer(uri), statuses=(3,))
            self.ends(with_image(uri), statuses=(3,) if uri in ("zero.bin", "memory.bin") else (0, 3))

    def test_a_link_that_turns_while_it_is_read(self):
        """Every answer is that of one of its two ends, and the other's content is never read."""
        inside = base64.b64decode(square()["buffers"][0]["uri"].split(",")[1])
        (self.scene / "inside.bin").write_bytes(inside)
        done = threading.Event()

        def turn():
            while not done.is_set():
                for target in ("inside.bin", self.outside / "secret.bin"):
                    (self.scene / "new").symlink_to(target)
                    os.replace(self.scene / "new", self.scene / "turning.bin")
        (self.scene / "turning.bin").symlink_to("inside.bin")
        thread = threading.Thread(target=turn)
        thread.start()
        try:
            for _ in range(30):
                error = self.ends(with_buffer("turning.bin"), statuses=(0, 3))
                self.assertTrue(not error or "link out of the scene's folder" in error, error)
        finally:
            done.set()
            thread.join()

    def test_sizes_that_no_file_has(self):
        many = 1 << 31
        pictures = [with_image(data_uri("image/png", data)) for name, data in hostile_pictures() if name.endswith(".png")]
        for model in (*pictures, with_image(data_uri("image/jpeg", huge_jpeg()))):
            self.ends(model, statuses=(0, 3))
        for model in (changed(accessors={"count": many}), changed(accessors={"count": 1 << 62}), changed(accessors={"byteOffset": 1 << 62}),
                      changed(bufferViews={"byteLength": 1 << 62}), changed(buffers={"byteLength": 1 << 62}), instances(many), instances(1 << 28), chain(None), chain(0), deep()):
            self.ends(model, statuses=(0, 3) if model == chain(None) else (3,))

    def test_archives_that_grow(self):
        """A megabyte of hundreds of megabytes, or that asks for gigabytes: none of these kinds of compression is a glTF's, but a picture of environment light is read as EXR and HDR."""
        self.ends(gzip.compress(bytes(1 << 28), 1)[:1 << 20], statuses=(3,))
        (self.scene / "x.hdr").write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 30000 +X 30000\n" + bytes([2, 2, 0x75, 0x30, 255, 9]) * 170000)
        self.ends(square(), statuses=(3,), words=("render", self.scene / "model.gltf", "--hdri-file", self.scene / "x.hdr", "-o", self.folder / "x.png",
                                                  "--resolution", "8,8", "--spp", "1", "--quiet", "--memory-limit", "256MB"))

    def test_names_that_speak_to_the_terminal(self):
        named = square({"name": ESCAPE})
        for kind in ("nodes", "meshes", "scenes"):
            named.setdefault(kind, [{}])[0]["name"] = ESCAPE
        named["asset"]["generator"] = ESCAPE
        self.ends(named, statuses=(0, 3))
        self.ends(named, statuses=(0, 3), words=("info", "--nodes", self.scene / "model.gltf"))
        self.ends(with_buffer(ESCAPE), statuses=(3,))
        self.ends(named | {"extensionsRequired": [ESCAPE]}, statuses=(3,))
        self.ends(named | {"extensionsUsed": [ESCAPE]}, statuses=(0, 3))
        self.ends(square({ESCAPE: 1, "alphaMode": ESCAPE}), statuses=(0, 3))


if __name__ == "__main__":
    main()

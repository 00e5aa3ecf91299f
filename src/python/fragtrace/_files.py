# SPDX-License-Identifier: MIT
"""Files of pictures and scenes: reading, comparing, joining, describing."""
import contextlib
import json
import os
import subprocess
import weakref

import numpy as np

from fragtrace import _core
from fragtrace._picture import Layers, _planes, picture_of
from fragtrace._program import program
from fragtrace._words import in_python

ERRORS = {2: _core.UsageError, 3: _core.InputError, 4: _core.ContextError}


class Model:
    """A scene by a path: a file, or one in memory that lives as long as this. `name` is for messages. Raises UsageError for what is no scene."""

    def __init__(self, scene):
        self.file = None
        if isinstance(scene, (str, os.PathLike)):
            self.name = self.path = os.fsdecode(scene)
            return
        self.name = f"<{type(scene).__name__}>"
        content = scene
        if hasattr(scene, "export"):
            content = scene.export(file_type="glb")
        elif hasattr(scene, "read"):
            content = scene.read()
        try:
            content = memoryview(content)
        except TypeError:
            kind = "a file that was not opened as binary ('rb')" if isinstance(content, str) else f"a {type(content).__name__}"
            raise _core.UsageError(f"scene: {kind} is no scene; a path, bytes, a binary file and what has .export(file_type=\"glb\") are") from None
        self.file = os.memfd_create("scene")
        weakref.finalize(self, os.close, self.file)
        with open(self.file, "wb", closefd=False) as file:
            file.write(content)
        self.path = f"/proc/self/fd/{self.file}"

    def named(self, text):
        return text if self.file is None else text.replace(self.path, self.name)

    @contextlib.contextmanager
    def errors(self):
        """Says errors of the program in Python's words."""
        try:
            yield
        except (_core.UsageError, _core.InputError, _core.RenderError, _core.ContextError) as error:
            raise type(error)(in_python(self.named(str(error)))) from None


def read(path):
    """A picture file as a Picture, or as Layers where an .exr holds more: linear values of .exr, .hdr and .pfm, sRGB-encoded values
    0..1 of others. Of a file that holds a region, only the region. Raises InputError."""
    picture = picture_of(*_core.read(os.fspath(path)))
    return picture.layers if picture.layers.channels else picture


def _color(picture):
    if isinstance(picture, (str, os.PathLike)):
        picture = read(picture)
    return picture["color"] if isinstance(picture, Layers) else picture


def diff(picture, reference, metric="rmse"):
    """Returns the distance of a picture from its reference: rmse, mse, relmse, psnr (dB), max, or flip (of what a
    display shows).

    Both are arrays of linear colours (height, width, 3 or 4), or files of such. Alpha is not compared. Raises UsageError for other sizes."""
    a, b = (np.ascontiguousarray(_planes(np.asarray(_color(one)))[0][:, :, :3]) for one in (picture, reference))
    if a.shape[:2] != b.shape[:2]:
        raise _core.UsageError("diff: one picture has {1} x {0} pixels, the other {3} x {2}".format(*a.shape[:2], *b.shape[:2]))
    if a.shape[2] != b.shape[2]:
        raise _core.UsageError("one picture is grey, and the other is not")
    return _core.difference(a, b, ["Y"] if a.shape[2] == 1 else ["R", "G", "B"], metric)


def merge(paths):
    """Joins .exr files that hold other samples (sample_offset, seed) of one picture, each pixel weighted by its samples: as render() gives
    them. `messages` says what it consists of. Raises InputError."""
    if isinstance(paths, (str, bytes, os.PathLike)):
        raise _core.UsageError("merge: takes a list of files")
    channels, values, attributes, words = _core.merge([os.fspath(path) for path in paths])
    picture = picture_of(channels, values, attributes)
    picture.messages.append(words)
    return picture


def info(scene):
    """Returns the content of a scene, given as to render(), as `fragtrace info --json` prints it: a dict. Raises InputError."""
    model = scene if isinstance(scene, Model) else Model(scene)
    ran = subprocess.run([program(), "info", "--json", model.path], capture_output=True, text=True, check=False, pass_fds=() if model.file is None else [model.file])
    with model.errors():
        if ran.returncode:
            raise ERRORS.get(ran.returncode, _core.RenderError)(ran.stderr.strip().removeprefix("fragtrace: "))
    return json.loads(ran.stdout)

# SPDX-License-Identifier: MIT
"""Rendering: a scene once, or as often as one likes."""
from __future__ import annotations

import atexit
import json
import os
import sys
from typing import TYPE_CHECKING

from fragtrace import _core
from fragtrace._picture import picture_of
from fragtrace._words import words_of

if TYPE_CHECKING:
    from typing import Unpack

    from fragtrace._types import Keywords

# Whom the process that reads and writes pictures runs by.
os.environ.setdefault("FRAGTRACE_PYTHON", sys.executable or "python3")
atexit.register(_core.stop)


class _Bar:
    """tqdm's bar, if it is there and wanted."""

    def __init__(self, progress):
        self.told = progress if callable(progress) else None
        self.bar = None
        if progress is True:
            try:
                from tqdm.auto import tqdm
            except ImportError:
                return
            self.bar = tqdm(total=100, unit="%", bar_format="{l_bar}{bar}| {elapsed}<{remaining}", desc="rendering")
            self.told = self._show

    def _show(self, fraction):
        self.bar.update(100.0 * fraction - self.bar.n)

    def close(self):
        if self.bar is not None:
            self.bar.close()


class Scene:
    """A glTF scene that stays loaded, with its textures and its compiled shader, so that a further picture costs its samples only.

    path: a .gltf or .glb file, which the first picture loads. keywords: options of every picture of it, as render() takes them; those of
    Scene.render() come after them and count more. What a picture needs otherwise (another stage, another animation time) is loaded or compiled again by itself.

    Positions are rounded about the focal point of the first picture, unless scene_origin says about what; so pictures of further views may
    differ in their last bits from those of render(). May be used from several threads, whose pictures are drawn one after the other."""

    def __init__(self, path, **keywords: Unpack[Keywords]):
        self.path = os.fspath(path)
        words_of(path, keywords)
        if not os.path.exists(self.path):
            raise _core.InputError(f"{self.path}: cannot be opened: No such file or directory")
        self.keywords = keywords
        self._core = _core.Scene(True)

    def render(self, *, progress=None, **keywords: Unpack[Keywords]):
        """Does the same as fragtrace.render()."""
        return _render(self._core, self.path, {**self.keywords, **keywords}, progress)

    def info(self):
        """Does the same as fragtrace.info() of its file."""
        from fragtrace._files import info
        return info(self.path)

    def __repr__(self):
        return f"fragtrace.Scene({self.path!r})"


def render(path, *, progress=None, **keywords: Unpack[Keywords]):
    """Draws a picture of a glTF scene: a Picture, a NumPy array (height, width, 4) of float32; with `aov`, a dict of layers (Layers).

    path: a .gltf or .glb file. progress: called with the fraction done, 0..1, or True for a bar by tqdm if that is installed.
    keywords: the options of `fragtrace render`, with underscores: spp=64, resolution=(640, 360), hdri="studio.hdr", noise=0.01,
    denoise="variance", aov=("albedo", "normal"), camera="name", camera={"position": (0, 1, 4), "focal_point": (0, 1, 0)}, no_background=True.
    `None` leaves an option out.

    The values are those of the command's picture, bit by bit. The interpreter is free for other threads while the picture is drawn. Raises
    UsageError (also a ValueError) for options, InputError (also a ValueError) for files, ContextError where there is no OpenGL 4.5,
    RenderError otherwise, and KeyboardInterrupt at once."""
    return _render(_core.Scene(False), path, keywords, progress)


def _render(core, path, keywords, progress):
    asked = keywords.get("aov")
    bar = _Bar(progress)
    try:
        channels, values, attributes, statistics, complete, said = core.draw(words_of(path, keywords), bar.told)
    finally:
        bar.close()
    if not complete:
        raise _core.RenderError("the picture is not complete")
    picture = picture_of(channels, values, attributes)
    picture.statistics = json.loads(statistics)
    picture.messages = list(said)
    return picture.layers if asked else picture

# SPDX-License-Identifier: MIT
"""Rendering: a scene once, or as often as one likes."""
from __future__ import annotations

import atexit
import json
import os
import sys
from typing import TYPE_CHECKING

from fragtrace import _core
from fragtrace._files import Model, info
from fragtrace._picture import picture_of
from fragtrace._words import in_python, words_of

if TYPE_CHECKING:
    from collections.abc import Iterator
    from typing import Any, Unpack

    from fragtrace._types import Keywords, SequenceKeywords

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

    scene: what render() takes; the first picture loads it. keywords: options of every picture of it, as render() takes them; those of
    Scene.render() come after them and count more. What a picture needs otherwise (another stage, another animation time) is loaded or compiled
    again by itself; `renewed` says from which step on the latest picture did so: "scene", "pose", "program" or "nothing".

    Positions are rounded about the focal point of the first picture, unless scene_origin says about what; so pictures of further views may
    differ in their last bits from those of render(). May be used from several threads, whose pictures are drawn one after the other."""

    def __init__(self, scene: Any, /, **keywords: Unpack[Keywords]) -> None:
        self._model = Model(scene)
        words_of(self._model.path, keywords)
        if not os.path.exists(self._model.path):
            raise _core.InputError(f"{self._model.path}: cannot be opened: No such file or directory")
        self.keywords: dict[str, Any] = {**keywords}
        self.renewed = "nothing"
        self._core = _core.Scene(True)

    def set(self, **keywords: Unpack[Keywords]) -> None:
        """Gives later pictures these options, too; None takes one back. Raises UsageError for an unknown one."""
        words_of(self._model.path, keywords)
        self.keywords.update(keywords)

    def render(self, *, progress: Any = None, **keywords: Unpack[Keywords]) -> Any:
        """Does the same as fragtrace.render()."""
        picture, self.renewed = _draw(self._core, self._model, words_of(self._model.path, {**self.keywords, **keywords}), progress)
        return picture

    def sequence(self, *, progress: Any = None, **keywords: Unpack[SequenceKeywords]) -> Iterator[Any]:
        """Does the same as fragtrace.sequence(), which loads the scene for itself."""
        return _sequence(self._model, {**self.keywords, **keywords}, progress)

    def info(self) -> dict[str, Any]:
        """Does the same as fragtrace.info() of its scene."""
        return info(self._model)

    def __repr__(self):
        return f"fragtrace.Scene({self._model.name!r})"


def render(scene: Any, /, *, progress: Any = None, **keywords: Unpack[Keywords]) -> Any:
    """Draws a picture of a glTF scene: a Picture, a NumPy array (height, width, 4) of float32; with `aov`, a dict of layers (Layers).

    scene: the path of a .gltf or .glb file; its bytes, or a file object that has them; or what has a method .export(file_type="glb"), such as
    trimesh.Scene. In memory it names no other files. progress: called with the fraction done, 0..1, or True for a bar by tqdm if that is installed.
    keywords: the options of `fragtrace render`, with underscores: spp=64, resolution=(640, 360), hdri="studio.hdr", noise=0.01,
    denoise="variance", aov=("albedo", "normal"), camera="name", camera={"position": (0, 1, 4), "focal_point": (0, 1, 0)}, no_background=True.
    `None` leaves an option out.

    The values are those of the command's picture, bit by bit. The interpreter is free for other threads while the picture is drawn. Raises
    UsageError (also a ValueError) for options, InputError (also a ValueError) for files, ContextError where there is no OpenGL 4.5,
    RenderError otherwise, and KeyboardInterrupt at once."""
    model = Model(scene)
    return _draw(_core.Scene(False), model, words_of(model.path, keywords), progress)[0]


def sequence(scene: Any, /, *, progress: Any = None, **keywords: Unpack[SequenceKeywords]) -> Iterator[Any]:
    """Draws the pictures of an animation or of a turntable, each when it is asked for: an iterator of what render() returns.

    frames: pictures A to B of the animation, "A:B" or range(A, B + 1), picture k at k / fps seconds. turntable: so many pictures from evenly
    spaced directions, or those of them that frames names; turn="object" turns the scene before its light. All else as in render(); the pictures
    are those of `fragtrace render --frames` and `--turntable`."""
    return _sequence(Model(scene), keywords, progress)


def _sequence(model, keywords, progress):
    words = words_of(model.path, keywords, "sequence")
    if not keywords.get("frames") and not keywords.get("turntable"):
        raise _core.UsageError('sequence: takes frames="A:B" or turntable=N')
    with model.errors():
        numbers = _core.frame_numbers(words)
    core = _core.Scene(True)
    return (_draw(core, model, words, progress, index)[0] for index in range(len(numbers)))


def _draw(core, model, words, progress, index=0):
    """A picture, or its layers where words ask for some, and what was renewed for it."""
    bar = _Bar(progress)
    try:
        with model.errors():
            channels, values, attributes, statistics, complete, said, renewed = core.draw(words, bar.told, index)
    finally:
        bar.close()
    if not complete:
        raise _core.RenderError("the picture is not complete")
    picture = picture_of(channels, values, attributes)
    picture.statistics = json.loads(statistics)
    picture.messages = [in_python(model.named(line)) for line in said]
    return picture.layers if any(word.startswith("--aov=") for word in words) else picture, renewed

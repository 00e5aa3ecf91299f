# SPDX-License-Identifier: MIT
"""Pictures as NumPy arrays that know how they were made."""
import os
import tempfile
import warnings

import numpy as np

from fragtrace import _core
from fragtrace._words import spelled

COLOR = ("R", "G", "B", "A")


def _planes(array):
    """The array as (height, width, channels), float32, and the channels' names."""
    values = np.ascontiguousarray(array, dtype=np.float32)
    if values.ndim == 2:
        values = values[:, :, np.newaxis]
    if values.ndim != 3 or values.shape[2] not in (1, 3, 4):
        raise _core.UsageError(f"an array of shape {np.shape(array)} is no picture: (height, width), (height, width, 3) or (..., 4) is")
    return values, ["Y"] if values.shape[2] == 1 else list(COLOR[:values.shape[2]])


def tonemap(picture, exposure=0.0, tone_map="neutral"):
    """A linear picture (height, width, 3 or 4) as a display shows it: sRGB-encoded, uint8, the same shape; alpha is unassociated.

    exposure is in stops (EV). tone_map: linear, reinhard, aces, agx or neutral, as the command's options. Raises UsageError."""
    values, channels = _planes(picture)
    _, shown, _ = _core.display(values, channels, float(exposure), tone_map, False, "")
    return np.rint(np.clip(shown, 0.0, 1.0) * 255.0).astype(np.uint8)


class Picture(np.ndarray):
    """Linear colours (height, width, 4), float32: R, G, B, multiplied by A. What is calculated from it is a plain picture without
    statistics.

    layers: all layers that the file would hold, as Layers, this picture among them; statistics: what `--stats` writes, as a dict;
    messages: what the command prints on stderr; attributes and numbers: what an .exr keeps besides pixels, as strings and as lists (worldToCamera, worldToNDC, chromaticities)."""

    FACTS = ("statistics", "messages", "attributes", "numbers")

    def __array_finalize__(self, other):
        self.statistics = {}
        self.messages = []
        self.attributes = {}
        self.numbers = {}
        self.layers = Layers(color=self)

    def __array_wrap__(self, array, context=None, return_scalar=False):
        return array[()] if array.ndim == 0 else super().__array_wrap__(array, context)

    def __reduce__(self):
        make, arguments, state = super().__reduce__()
        return make, arguments, (state, {name: getattr(self, name) for name in self.FACTS})

    def __setstate__(self, state):
        super().__setstate__(state[0])
        self.__dict__.update(state[1])

    def save(self, path, *, exposure=None, tone_map=None, half=False, png_depth=8, no_dither=False, background_color=None):
        """Writes .exr, .hdr, .pfm (linear) or .png, .jpg (as tonemap() shows it), whole or not at all. half: 16-bit floats in an .exr;
        exposure: by default what `statistics`, or the .exr that was read, says; png_depth: 8 or 16; no_dither: 8 bits are rounded without noise;
        background_color: what a .png or .jpg of a picture with alpha lies over (render(no_background=True)), past exposure and tone curve. Raises RenderError, and UsageError for what the format cannot hold."""
        planes = {"" if name == "color" else name: np.asarray(layer) for name, layer in self.layers.items()}
        _save(path, {**planes, "": np.asarray(self)}, self, exposure, tone_map, half, png_depth, no_dither, background_color, self.layers.channels)

    def _repr_png_(self):
        return _png(self)


class Layers(dict):
    """A picture with layers, by their names: "color" is a Picture; the others are arrays (height, width) or (height, width, channels).

    statistics and messages are those of the picture."""

    def __init__(self, *arguments, **layers):
        super().__init__(*arguments, **layers)
        self.channels = {}  # the names in a file, by layer

    @property
    def statistics(self):
        return self["color"].statistics

    @property
    def messages(self):
        return self["color"].messages

    def save(self, path, *, exposure=None, tone_map=None, half=False, png_depth=8, no_dither=False, background_color=None):
        """Does the same as Picture.save(); an .exr holds all layers."""
        planes = {"" if name == "color" else name: np.asarray(layer) for name, layer in self.items()}
        _save(path, planes, self["color"], exposure, tone_map, half, png_depth, no_dither, background_color, self.channels)

    def _repr_png_(self):
        return _png(self["color"])


def _png(picture):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "picture.png")
        _save(path, {"": np.asarray(picture)}, picture, None, None, False, 8, False, None)
        with open(path, "rb") as file:
            return file.read()


def _save(path, planes, made, exposure, tone_map, half, png_depth, no_dither, background_color, channels=None):
    attributes, numbers = ({}, {}) if made is None else (made.attributes, made.numbers)
    path = os.fspath(path)
    color, names = _planes(planes[""])
    if _core.is_display_format(path):
        if names == ["Y"]:
            color, names = np.repeat(color, 3, axis=2), list(COLOR[:3])
        page = "" if background_color is None else spelled(background_color)
        if not path.lower().endswith(".png") and not page:
            color, names = color[:, :, :3], names[:3]  # over black: colour is multiplied by alpha
        if exposure is None and made is not None:
            exposure = made.statistics.get("exposure", made.attributes.get("fragtrace:exposure"))  # what the scene's light asks for
        names, color, _ = _core.display(np.ascontiguousarray(color), names, float(exposure or 0.0), tone_map or "neutral", png_depth == 8 and not no_dither, page)
        attributes, numbers = {}, {}
    elif exposure is not None or tone_map is not None or background_color is not None:
        raise _core.UsageError(f"{path}: holds linear values, which exposure, tone_map and background_color are not for")
    elif path.lower().endswith(".exr"):
        for name, layer in planes.items():
            if name:
                values = np.ascontiguousarray(layer, dtype=np.float32).reshape(*np.shape(layer)[:2], -1)
                own = (channels or {}).get(name) or [f"{name}.{i}" for i in range(values.shape[2])]
                color, names = np.concatenate([color, values], axis=2), names + own
    clamped = _core.save(path, np.ascontiguousarray(color), names, attributes, numbers, half, png_depth)
    if clamped:
        warnings.warn(f"{path}: {clamped} values are beyond 65504, the largest 16-bit float, and clamped to it", stacklevel=3)


def picture_of(channels, values, attributes):
    """Returns the values of _core as a Picture, with its layers."""
    index = {name: i for i, name in enumerate(channels)}
    height, width = values.shape[:2]
    if "R" not in index and "Y" in index:
        color = np.repeat(values[:, :, index["Y"]][:, :, np.newaxis], 4, axis=2)
        color[:, :, 3] = 1.0
    else:
        color = np.ones((height, width, 4), np.float32)
        for i, name in enumerate(COLOR):
            if name in index:
                color[:, :, i] = values[:, :, index[name]]
    picture = color.view(Picture)
    picture.attributes, picture.numbers = map(dict, attributes)
    layers = picture.layers
    for name in channels:
        if name in COLOR or "." not in name:
            continue
        layers.channels.setdefault(name.rsplit(".", 1)[0], []).append(name)
    for layer, names in layers.channels.items():
        taken = values[:, :, [index[name] for name in names]]
        layers[layer] = np.ascontiguousarray(taken[:, :, 0] if len(names) == 1 else taken)
    return picture

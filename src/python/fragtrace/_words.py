# SPDX-License-Identifier: MIT
"""Keywords as the words of a command line, which the program's own table of options reads: there is no second one here."""
import difflib
import os

import numpy as np

from fragtrace import _core

SHORT = {"hdri": "hdri-file"}
OF_FILES = ("exposure", "tone_map", "half", "png_depth", "no_dither")
SINGLE = "only the command `fragtrace render` has it; animation_time and camera_orbit draw single pictures"
ENDS = "only the command `fragtrace render` has it, since a picture in memory leaves no file to go on from"
SAID = "nothing is printed here; `messages` of the picture has what the command says"
ELSEWHERE = {"output": "save() of the picture writes a file", "format": "save() of the picture chooses the format by the file's name",
             "checkpoint": ENDS, "resume": ENDS, "stats": "`statistics` of the picture has them", "frames": SINGLE, "fps": SINGLE,
             "turntable": SINGLE, "turn": SINGLE, "shutter": SINGLE, "alpha": "only files have it, so render() has no such keyword", "continue": SINGLE, "quiet": SAID, "verbose": SAID, "help": "help(fragtrace.render) tells of keywords"}
KNOWN = frozenset(_core.option_names())


def spelled(value):
    if isinstance(value, (list, tuple, np.ndarray)):
        return ",".join(spelled(one) for one in value)
    if isinstance(value, np.generic):
        return spelled(value.item())
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    return repr(value) if isinstance(value, float) else str(value)


def option_of(keyword):
    """The option that a keyword stands for. Raises UsageError."""
    option = SHORT.get(keyword, keyword.replace("_", "-"))
    if keyword in OF_FILES:
        raise _core.UsageError(f"{keyword}: only files have it, so it is a keyword of save()")
    if keyword in ELSEWHERE:
        raise _core.UsageError(f"{keyword}: {ELSEWHERE[keyword]}")
    if option not in KNOWN:
        close = difflib.get_close_matches(option, KNOWN, 1)
        raise _core.UsageError(f"{keyword}: no keyword of render()" + (f"; did you mean {close[0].replace('-', '_')}?" if close else ""))
    return option


def words_of(scene, keywords):
    """`None` and `False` leave an option out; `True` is a switch; sequences are separated by commas. A dict's members are options that
    begin with its name: camera={"position": (0, 1, 4)} is --camera-position 0,1,4."""
    path = os.fspath(scene)
    words = ["./" + path if path.startswith("-") else path]
    for name, value in keywords.items():
        if isinstance(value, np.bool_):
            value = bool(value)
        if isinstance(value, dict):
            if not any(option.startswith(f"{name.replace('_', '-')}-") for option in KNOWN):
                raise _core.UsageError(f"{name}: takes no dict")
            words += words_of("", {f"{name}_{member}": one for member, one in value.items()})[1:]
            continue
        option = option_of(name)
        if name == "resolution" and not isinstance(value, str) and value is not None:
            if np.shape(value) != (2,):
                raise _core.UsageError(f"resolution: {value!r} is not (width, height)")
            words.append("--resolution=" + "x".join(spelled(side) for side in value))
        elif name in ("hide", "set", "add_light", "ignore_required") and isinstance(value, (list, tuple)):
            words += [f"--{option}={one}" for one in value]  # names may hold commas, and numbers do
        elif value is True:
            words.append("--" + option)
        elif value is not None and value is not False:
            words.append(f"--{option}={spelled(value)}")
    return words

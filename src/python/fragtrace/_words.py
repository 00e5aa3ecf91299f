# SPDX-License-Identifier: MIT
"""Keywords as the words of a command line, which the program's own table of options reads: there is no second one here."""
import os
import re

import numpy as np

from fragtrace import _core

SHORT = {"hdri": "hdri-file"}
OF_FILES = ("exposure", "tone_map", "half", "png_depth", "no_dither")
OF_SEQUENCES = ("frames", "turntable", "turn")
ENDS = "only the command `fragtrace render` has it, since a picture in memory leaves no file to go on from"
SAID = "nothing is printed here; `messages` of the picture has what the command says"
ELSEWHERE = {"output": "save() of the picture writes a file", "format": "save() of the picture chooses the format by the file's name",
             "checkpoint": ENDS, "resume": ENDS, "stats": "`statistics` of the picture has them", "continue": ENDS,
             "alpha": "only files have it, so render() has no such keyword", "quiet": SAID, "verbose": SAID, "help": "help(fragtrace.render) tells of keywords"}
KNOWN = frozenset(_core.option_names())


def spelled(value):
    if isinstance(value, range) and value:
        return f"{value[0]}:{value[-1]}:{value.step}"
    if isinstance(value, (list, tuple, np.ndarray)):
        return ",".join(spelled(one) for one in value)
    if isinstance(value, np.generic):
        return spelled(value.item())
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    return repr(value) if isinstance(value, float) else str(value)


def option_of(keyword, function):
    """The option that a keyword of the function stands for. Raises UsageError."""
    option = SHORT.get(keyword, keyword.replace("_", "-"))
    if keyword in OF_FILES:
        raise _core.UsageError(f"{keyword}: only files have it, so it is a keyword of save()")
    if keyword in ELSEWHERE:
        raise _core.UsageError(f"{keyword}: {ELSEWHERE[keyword]}")
    if keyword in OF_SEQUENCES and function != "sequence":
        raise _core.UsageError(f"{keyword}: is of sequence(), which draws several pictures; animation_time and camera_orbit are of one")
    if option not in KNOWN:
        like = in_python(_core.option_like("--" + option)).split(" ")[0]
        hint = f"; did you mean {like}?" if like and like not in (*OF_FILES, *ELSEWHERE) else ""
        raise _core.UsageError(f"{keyword}: no keyword of {function}(){hint}")
    return option


def in_python(text):
    """A message of the command in which options are named as keywords."""
    return re.sub(r"--([a-z][a-z0-9-]*)", lambda found: found[1].replace("-", "_") if found[1] in KNOWN else found[0], text)


def words_of(path, keywords, function="render"):
    """`None` and `False` leave an option out; `True` is a switch; sequences are separated by commas. A dict's members are options that
    begin with its name: camera={"position": (0, 1, 4)} is --camera-position 0,1,4."""
    words = ["./" + path if path.startswith("-") else path]
    for name, value in keywords.items():
        if isinstance(value, np.bool_):
            value = bool(value)
        if isinstance(value, dict):
            if not any(option.startswith(f"{name.replace('_', '-')}-") for option in KNOWN):
                raise _core.UsageError(f"{name}: takes no dict")
            words += words_of("", {f"{name}_{member}": one for member, one in value.items()}, function)[1:]
            continue
        option = option_of(name, function)
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

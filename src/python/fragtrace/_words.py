# SPDX-License-Identifier: MIT
"""Keywords as the words of a command line, which the program's own table of options reads: there is no second one here."""
import os

import numpy as np

SHORT = {"hdri": "hdri-file"}


def spelled(value):
    if isinstance(value, (list, tuple, np.ndarray)):
        return ",".join(spelled(one) for one in value)
    if isinstance(value, np.generic):
        return spelled(value.item())
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    return repr(value) if isinstance(value, float) else str(value)


def words_of(scene, keywords):
    """`None` and `False` leave an option out; `True` is a switch; sequences are separated by commas. A dict's members are options that
    begin with its name: camera={"position": (0, 1, 4)} is --camera-position 0,1,4."""
    path = os.fspath(scene)
    words = ["./" + path if path.startswith("-") else path]
    for name, value in keywords.items():
        option = SHORT.get(name, name.replace("_", "-"))
        if isinstance(value, dict):
            words += words_of("", {f"{name}_{member}": one for member, one in value.items()})[1:]
        elif name == "resolution" and not isinstance(value, str) and value is not None:
            words.append("--resolution=" + "x".join(spelled(side) for side in value))
        elif value is True:
            words.append("--" + option)
        elif value is not None and value is not False:
            words.append(f"--{option}={spelled(value)}")
    return words

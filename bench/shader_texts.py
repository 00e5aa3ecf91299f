# SPDX-License-Identifier: MIT
"""The texts that a program hands to Mesa, which writes them into the folder that MESA_SHADER_CAPTURE_PATH names."""
import re

# The endings by kind that glslangValidator needs.
FILE_ENDINGS = {"vertex": "vert", "fragment": "frag", "compute": "comp"}


def sections(file):
    """Yields kind and text of each shader, without the names of files in #line (GL_ARB_shading_language_include), which
    few compilers know."""
    for kind, text in re.findall(r"^\[(\w+) shader\]\n(.*?)(?=^\[|\Z)", file.read_text(), re.MULTILINE | re.DOTALL):
        yield kind, re.sub(r'^(#line \d+) ".*"$', r"\1", text, flags=re.MULTILINE).rstrip("\n") + "\n"


def captured(folder):
    """Returns the sections of all files."""
    return {section for file in folder.iterdir() for section in sections(file)}

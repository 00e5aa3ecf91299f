# SPDX-License-Identifier: MIT
"""A fault is one row: a function of a shader, a piece of its text and what that becomes. White space does not count, so that rows survive a reformatting."""
import re
from typing import NamedTuple

WORD = r"[\w.]"
# The words before a function's name at its definition.
TYPES = r"(?:void|bool|u?int|float|[iu]?vec[234]|[A-Z]\w+)"


class Fault(NamedTuple):
    name: str    # FILE.FUNCTION, or FILE.FUNCTION and more words
    before: str
    after: str
    what: str
    reason: str = ""  # why it changes no picture, where nothing can see it

    @property
    def file(self):
        return self.name.split(".")[0] + ".glsl"

    @property
    def function(self):
        return self.name.split()[0].split(".")[1]


class KeyMissing(LookupError):
    """A row no longer fits the shaders."""


def code_of(text):
    """Returns the text with its comments blanked, every character at its place."""
    return re.sub(r"//[^\n]*", lambda comment: " " * len(comment[0]), text)


def functions_of(text):
    """Name, return type and place of each function: {name: (type, begin, end)}, from its first parameter to its last brace."""
    code = code_of(text)
    found = {}
    for head in re.finditer(rf"^({TYPES})\s+(\w+)\s*\([^;{{]*\)\s*\{{", code, re.M):
        depth, end = 1, head.end()
        while depth:
            depth += {"{": 1, "}": -1}.get(code[end], 0)
            end += 1
        found[head[2]] = (head[1], head.start(), end)
    return found


def pattern_of(key):
    """Matches the key with any white space between its words and signs."""
    tokens = re.findall(rf"{WORD}+|\S", key)
    pattern = re.escape(tokens[0])
    for before, token in zip(tokens, tokens[1:]):
        both_words = re.match(WORD, before[-1]) and re.match(WORD, token[0])
        pattern += (r"\s+" if both_words else r"\s*") + re.escape(token)
    if re.match(WORD, tokens[0]):
        pattern = rf"(?<!{WORD})" + pattern
    if re.match(WORD, tokens[-1][-1]):
        pattern += rf"(?!{WORD})"
    return re.compile(pattern)


def put_in(fault, text):
    """Returns the shader's text with the fault in it."""
    functions = functions_of(text)
    if fault.function not in functions:
        raise KeyMissing(f"{fault.name}: {fault.file} has no function {fault.function}")
    _, begin, end = functions[fault.function]
    places = list(pattern_of(fault.before).finditer(code_of(text), begin, end))
    if len(places) != 1:
        raise KeyMissing(f"{fault.name}: {fault.before!r} is found {len(places)} times in {fault.function} of {fault.file}, not once")
    return text[:places[0].start()] + fault.after + text[places[0].end():]


def callers_of(function, texts):
    """The names of the function and of all that call it, directly or not, in these shader texts."""
    bodies = {}
    for text in texts:
        code = code_of(text)
        bodies |= {name: code[begin:end] for name, (_, begin, end) in functions_of(text).items()}
    found, new = {function}, {function}
    while new:
        calls = re.compile(r"\b(?:%s)\s*\(" % "|".join(new))
        new = {name for name, body in bodies.items() if name not in found and calls.search(body.split("{", 1)[1])}
        found |= new
    return found

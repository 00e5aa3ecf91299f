# SPDX-License-Identifier: MIT
"""Tables of documents, and the marks between which a document has generated lines."""

import re
import textwrap

BEGIN, END = "<!-- table: {} -->", "<!-- end of table -->"
BLOCK = re.compile(BEGIN.format(r"([^\n]*?)") + r"\n((?:(?!<!-- table:).)*?)" + END, re.DOTALL)


def wrapped(text):
    """A paragraph as lines, with the empty line that ends it."""
    return [*textwrap.wrap(text, 120, break_long_words=False, break_on_hyphens=False), ""]


def table(head, rows):
    """Returns the lines of a table, without the columns in which no row has anything but "-"."""
    kept = [i for i in range(len(head)) if any(row[i] != "-" for row in rows)]
    lines = [head, ["---"] * len(head), *rows]
    return ["| " + " | ".join(line[i] for i in kept) + " |" for line in lines]


def names(text):
    """Returns the names of the tables for which a document has marks."""
    return [found[1] for found in BLOCK.finditer(text)]


def marks(text):
    """Returns the same as names(). Raises ValueError where a mark has no end or an end has no mark."""
    if not len(names(text)) == text.count(BEGIN.split("{")[0]) == text.count(END):
        raise ValueError(f'"{BEGIN.format("NAME")}" and "{END}" do not come in pairs')
    return names(text)


def written(text, tables):
    """The document with the lines of `tables`, by name, between their marks; other marks keep what they have."""
    def block(found):
        lines = tables.get(found[1])
        return found[0] if lines is None else "\n".join([BEGIN.format(found[1]), "", *lines, "", END])
    return BLOCK.sub(block, text)

# SPDX-License-Identifier: MIT
"""Makes the faults: what a function returns, sets or decides, wrong by 2 % (5 % for densities), by its sign, or by one. They follow from the text of the shaders,
so that no list has to be kept."""
import re
from typing import NamedTuple

# The words before a function's name at its definition.
TYPES = r"(?:void|bool|u?int|float|[iu]?vec[234]|[A-Z]\w+)"
DENSITY = re.compile(r"pdf|density|chance", re.I)
# A return, a condition, or an assignment to a member or to what a shader writes.
STATEMENT = re.compile(r"\b(?:(return)\s+|(if)\s*\(|(?:\w+(?:\[\w+\])?\.((?:\w+\.)*\w+)|(?<=^  )(\w+))\s*[-+*/]?=(?!=)\s*)", re.M)
SWIZZLE = re.compile(r"[xyzwrgb]{1,4}")


class Fault(NamedTuple):
    name: str    # FILE.FUNCTION KIND, and a number where a function has several of a kind
    begin: int   # place of the expression in the file's text
    end: int
    after: str   # what stands there instead
    file: str

    @property
    def function(self):
        return self.name.split()[0].rsplit(".", 1)[1]


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


def members_of(texts):
    """The types of the members of all structs by their names; a name of two types is left out."""
    types = {}
    for text in texts:
        for body in re.findall(r"^struct \w+ \{(.*?)^\};", code_of(text), re.M | re.S):
            for kind, names in re.findall(r"(\w+)\s+([\w\s,]+);", body):
                for name in re.findall(r"\w+", names):
                    types.setdefault(name, set()).add(kind)
    return {name: kinds.pop() for name, kinds in types.items() if len(kinds) == 1}


def end_of(code, begin):
    """The place of the `;` or `)` that ends the expression."""
    depth = 0
    for place in range(begin, len(code)):
        if code[place] in "([{":
            depth += 1
        elif code[place] in ")]}":
            if not depth:
                return place
            depth -= 1
        elif code[place] == ";" and not depth:
            return place


def wrong(kind, expression, name):
    """The expression, of a type, with the fault; None where there is none for the type."""
    if kind == "bool":
        return f"!({expression})"
    if kind in ("float", "vec2", "vec3", "vec4"):
        return f"({expression}) * float({'1.05' if DENSITY.search(name) else '1.02'})"
    if kind in ("int", "uint"):
        return f"({expression}) + {kind}(1)"
    if re.fullmatch(r"[iu]vec[234]", kind):
        return f"({expression}) + {kind}(1)"
    return None


def type_of(path, members):
    """The type of what is set: of the last member, or of so many parts of a vector."""
    *_, last = path.split(".")
    if SWIZZLE.fullmatch(last) and "." in path:
        of = members.get(path.split(".")[-2], "")
        return ("float" if len(last) == 1 else f"vec{len(last)}") if of.startswith("vec") else None
    return members.get(last)


def faults_in(file, text, members):
    """All faults of a file."""
    code, found = code_of(text), []
    outputs = {name: kind for kind, name in re.findall(r"\bout (\w+) (\w+);", code)}
    for function, (returned, first, last) in functions_of(text).items():
        counts = {}
        for place in STATEMENT.finditer(code, code.index("{", first), last):
            begin, end = place.end(), end_of(code, place.end())
            expression, (returns, decides, member, output) = " ".join(code[begin:end].split()), place.groups()
            what = "return" if returns else "if" if decides else member or output
            words = re.findall(r"[A-Za-z_]\w*", expression)
            if decides and all(re.match(r"k[A-Z]", word) for word in words):
                continue  # what a scene does not need
            kind = returned if returns else "bool" if decides else type_of(member, members) if member else outputs.get(output)
            after = wrong(kind, expression, f"{function} {what}") if kind else None
            if after is None or re.fullmatch(r"vec[234]\(0\.0f?\)|0\.0f?", expression):
                continue
            counts[what] = counts.get(what, 0) + 1
            number = f" {counts[what]}" if counts[what] > 1 else ""
            found.append(Fault(f"{file.removesuffix('.glsl')}.{function} {what}{number}", begin, end, after, file))
    return found


def texts_of(shaders):
    return {str(path.relative_to(shaders)): path.read_text() for pattern in ("*.glsl", "*.frag", "*.comp", "*.vert") for path in sorted(shaders.rglob(pattern))}


def function_texts(shaders):
    """The texts of all functions by FILE.FUNCTION."""
    return {f"{file.removesuffix('.glsl')}.{name}": text[begin:end] for file, text in texts_of(shaders).items() for name, (_, begin, end) in functions_of(text).items()}


def all_faults(shaders):
    texts = texts_of(shaders)
    members = members_of(texts.values())
    return [fault for file, text in texts.items() for fault in faults_in(file, text, members)]


def put_in(fault, text):
    """Returns the shader's text with the fault in it."""
    return text[:fault.begin] + fault.after + text[fault.end:]


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

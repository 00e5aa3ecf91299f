#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""tests/mutants/host.py BUILD, with the options of mutants.py: puts faults into the functions of the host that decide
pictures, and looks for a test that fails.

What a function returns becomes 2 % larger, an integer one larger, a condition its opposite. All faults are in one program, built in BUILD/mutants/host from a
copy of the sources; FRAGTRACE_MUTANT chooses one. A function is tested by the tests in C++ whose files include its header, then by picture tests."""
import json
import os
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path
from threading import Lock
from types import SimpleNamespace
from typing import NamedTuple

from made import end_of
from memory import Memory, function_of
from mutants import SOURCE, arguments, chosen_of, try_all

FILES = ("src/pack/*.cpp", "src/render/film/noise.cpp", "src/render/film/film_pixels.cpp", "src/render/film/path_share.cpp", "src/render/adaptive.cpp",
         "src/render/renderer.cpp", "src/image/display/*.cpp", "src/scene/camera*.cpp")
HEADER = """#pragma once
#include <cstdlib>
#include <type_traits>
#include <utility>
namespace fragtrace::mutants {
inline int chosen() {
  static const int number = [] { const char* text = std::getenv("FRAGTRACE_MUTANT"); return text ? std::atoi(text) : -1; }();
  return number;
}
template <class T>
std::remove_cvref_t<T> put(int number, T&& value) {
  using V = std::remove_cvref_t<T>;
  if (number != chosen()) return std::forward<T>(value);
  if constexpr (std::is_same_v<V, bool>) return !value;
  else if constexpr (std::is_integral_v<V>) return V(value + 1);
  else if constexpr (std::is_floating_point_v<V>) return V(value * V(1.02));
  else return value * typename V::value_type(1.02);
}
}  // namespace fragtrace::mutants
"""
KINDS = r"(?:bool|int|float|double|size_t|std::size_t|u?int(?:8|16|32|64)_t|std::u?int(?:8|16|32|64)_t|glm::d?vec[234]|vec[234]|dvec[234])"
HEAD = re.compile(rf"^(?:(?:static|inline|constexpr)\s+)*({KINDS}|[\w:<>&*, ]+?)\s+([\w:]+)\s*\([^;{{}}]*\)\s*(?:const\s*)?\{{", re.M)
STATEMENT = re.compile(r"\b(?:(return)\s+|(if)\s*\()")


class Fault(NamedTuple):
    name: str  # FILE.FUNCTION return or if, and a number where a function has several
    file: str
    begin: int
    end: int
    after: str  # the expression that it changes


def without_texts(text):
    """Returns the text with its comments and strings blanked, every character at its place: strings hold shaders."""
    return re.sub(r'//[^\n]*|R"\(.*?\)"|"(?:\\.|[^"\\\n])*"', lambda found: " " * len(found[0]), text, flags=re.S)


def faults_in(file, text):
    code, found, counts = without_texts(text), [], {}
    for head in HEAD.finditer(code):
        depth, last = 1, head.end()
        while depth and last < len(code):
            depth += {"{": 1, "}": -1}.get(code[last], 0)
            last += 1
        if head[2].split("::")[-1] in ("if", "for", "while", "switch"):
            continue
        for place in STATEMENT.finditer(code, head.end(), last):
            expression = code[place.end():end_of(code, place.end())]
            decides = bool(place[2])
            # A lambda's return has a type of its own; a condition may declare a name.
            inner = "[" in code[head.end():place.start()] and re.search(r"\]\s*(?:\([^)]*\))?[^;{}]*\{[^}]*$", code[head.end():place.start()])
            if decides and (";" in expression or re.search(r"(?<![=!<>])=(?!=)", expression)) or not decides and (inner or not re.fullmatch(KINDS, head[1])):
                continue
            if expression.startswith("{") or re.fullmatch(r"0\.0f?", expression) or "constexpr" in code[max(0, place.start() - 12):place.end()]:
                continue
            what = f"{Path(file).stem}.{head[2]} {'if' if decides else 'return'}"
            counts[what] = counts.get(what, 0) + 1
            found.append(Fault(what + (f" {counts[what]}" if counts[what] > 1 else ""), file, place.end(), place.end() + len(expression), text[place.end():place.end() + len(expression)]))
    return found


def apart(faults):
    """Leaves out faults that lie in others."""
    end, kept = 0, []
    for fault in sorted(faults, key=lambda fault: fault.begin):
        if fault.begin >= end:
            kept.append(fault)
            end = fault.end
    return kept


def all_faults():
    paths = sorted(path for pattern in FILES for path in SOURCE.glob(pattern))
    return [fault for path in paths for fault in apart(faults_in(str(path.relative_to(SOURCE)), path.read_text()))]


def build(folder, faults):
    """A copy of the sources with all faults, and its programs."""
    for old in folder.glob("*"):
        if old.is_dir() and old.name != "build":
            shutil.rmtree(old)
    shutil.copytree(SOURCE, folder, dirs_exist_ok=True, ignore=lambda at, names: [n for n in names if n in (".git", "__pycache__") or n.startswith("build") and Path(at) == SOURCE])
    (folder / "src/base/mutants.h").write_text(HEADER)
    for file in {fault.file for fault in faults}:
        text = (SOURCE / file).read_text()
        for number, fault in reversed(list(enumerate(faults))):
            if fault.file == file:
                inner = text[fault.begin:fault.end]
                whole = f"bool({inner})" if " if" in fault.name else inner
                text = f"{text[:fault.begin]}fragtrace::mutants::put({number}, {whole}){text[fault.end:]}"
        at = text.index("#include")
        (folder / file).write_text(f'{text[:at]}#include "base/mutants.h"\n{text[at:]}')
    subprocess.run([folder / "scripts/build", "release", "fragtrace", "fragtrace_worker", "fragtrace_pictures", "fragtrace_geometry", "fragtrace_volumes", "pure_tests", "picture_test"], check=True)


class HostTrial:
    """A run of the one program with a fault, or without."""
    refused = False

    def __init__(self, setting, fault):
        self.setting, self.number, self.fault = setting, setting.numbers[fault.name] if fault else -1, fault

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def tests(self):
        return [*self.setting.suites.get(self.fault.file.removeprefix("src/").removesuffix(".cpp"), ()), *self.setting.pictures]

    def passes(self, test):
        """Runs the test. Returns whether it passes, and how long it took."""
        began, kept = time.monotonic(), self.setting.kept
        kind, name = test.split(".", 1)
        command = ([kept / "build/pure_tests", f"--gtest_filter={name}.*", "--gtest_brief=1"] if kind == "suite" else
                   [kept / "build/picture_test", name, "egl", kept / "build/fragtrace", kept, kept / f"build/mutant_pictures/{self.number}"])
        environment = os.environ | {"FRAGTRACE_MUTANT": str(self.number), "FRAGTRACE_LIBRARY_PATH": str(kept / "build"), "GTEST_FAIL_FAST": "1"}
        try:
            passed = subprocess.run(command, cwd=kept, env=environment, timeout=300, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode == 0
        except subprocess.TimeoutExpired:
            passed = False
        return passed, time.monotonic() - began


def suites_of(folder):
    """The test suites whose files include a header of src, by that header."""
    suites = {}
    for path in (folder / "tests/pure").glob("*_test.cpp"):
        text = path.read_text()
        for header in re.findall(r'#include "([\w/]+)\.h"', text):
            suites.setdefault(header, set()).update(f"suite.{suite}" for suite in re.findall(r"^TEST(?:_F|_P)?\((\w+),", text, re.M))
    return suites


def main():
    options, reasons = arguments(__doc__)
    every = all_faults()
    faults = chosen_of(options, every, reasons)
    if options.list:
        print("\n".join(fault.name for fault in faults))
        return 0
    folder = options.build / "mutants"
    kept = folder / "host"
    build(kept, every)
    references = json.loads((kept / "tests/reference/references.json").read_text())["references"]
    setting = SimpleNamespace(kept=kept, suites=suites_of(kept), pictures=[f"picture.{row['name']}" for row in references], lock_of_sound=Lock(),
                              seconds=options.seconds, numbers={fault.name: number for number, fault in enumerate(every)}, trial=HostTrial)
    memory = Memory(folder / "host.json", folder / "host_seen_by.json", {function_of(fault.name): (SOURCE / fault.file).read_text() for fault in every})
    return try_all(setting, memory, faults, reasons, options.jobs)


if __name__ == "__main__":
    sys.exit(main())

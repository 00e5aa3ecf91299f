#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""tests/mutants/host.py BUILD [--only WORD ...] [--some COUNT [--seed SEED]] [--seconds S] [--list]: puts faults into the functions of the host that decide
pictures, and looks for a test that fails, S seconds at most for each (60). Goes on where it was interrupted. Status 1 when a fault survives that has no reason.

What a function returns becomes 2 % larger, an integer one larger, a condition its opposite. All faults are in one program, built in BUILD/mutants/host from a
copy of the sources; FRAGTRACE_MUTANT chooses one. A function is tested by the tests in C++ whose files include its header, then by picture tests."""
import argparse
import json
import os
import random
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path
from typing import NamedTuple

from made import code_of, end_of

HERE = Path(__file__).resolve().parent
SOURCE = HERE.parent.parent
FILES = ("src/pack/*.cpp", "src/render/film/noise.cpp", "src/render/film/film_pixels.cpp", "src/render/film/path_share.cpp", "src/render/adaptive.cpp",
         "src/render/guiding.cpp", "src/image/display/*.cpp", "src/scene/camera*.cpp")
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


def faults_in(file, text):
    code, found, counts = code_of(text), [], {}
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
            if expression.startswith("{") or "constexpr" in code[max(0, place.start() - 12):place.end()]:
                continue
            what = f"{Path(file).stem}.{head[2]} {'if' if decides else 'return'}"
            counts[what] = counts.get(what, 0) + 1
            found.append(Fault(what + (f" {counts[what]}" if counts[what] > 1 else ""), file, place.end(), place.end() + len(expression)))
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
    subprocess.run([folder / "scripts/build", "release", "fragtrace", "fragtrace_pictures", "fragtrace_geometry", "fragtrace_volumes", "pure_tests", "picture_test"], check=True)


class Tests:
    def __init__(self, folder):
        self.folder, self.build = folder, folder / "build"
        self.references = [row["name"] for row in json.loads((folder / "tests/reference/references.json").read_text())["references"]]
        self.suites = {}
        for path in (folder / "tests/pure").glob("*_test.cpp"):
            text = path.read_text()
            for header in re.findall(r'#include "([\w/]+)\.h"', text):
                self.suites.setdefault(header, set()).update(re.findall(r"^TEST(?:_F|_P)?\((\w+),", text, re.M))

    def of(self, fault):
        """Commands by name, in the order of trying."""
        suites = self.suites.get(fault.file.removeprefix("src/").removesuffix(".cpp"), ())
        if suites:
            yield "pure", [self.build / "pure_tests", f"--gtest_filter={':'.join(f'{suite}.*' for suite in sorted(suites))}", "--gtest_brief=1"]
        yield "pure.Pack", [self.build / "pure_tests", "--gtest_filter=Pack*:*Light*:*Film*:*Noise*:*Environment*:*Camera*:*Energy*:*Guid*:*Tone*:*Display*", "--gtest_brief=1"]
        for name in sorted(self.references, key=lambda name: (".gi" not in name, name)):
            yield f"picture.{name}", [self.build / "picture_test", name, "egl", self.build / "fragtrace", self.folder, self.build / "mutant_pictures"]

    def passes(self, command, number):
        environment = os.environ | {"FRAGTRACE_MUTANT": str(number), "FRAGTRACE_LIBRARY_PATH": str(self.build), "GTEST_FAIL_FAST": "1"}
        try:
            return subprocess.run(list(map(str, command)), cwd=self.folder, env=environment, timeout=300, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode == 0
        except subprocess.TimeoutExpired:
            return False


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=Path)
    parser.add_argument("--only", nargs="+", default=[])
    parser.add_argument("--some", type=int)
    parser.add_argument("--seed", default="1")
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--list", action="store_true")
    options = parser.parse_args()
    faults = all_faults()
    chosen = [i for i, fault in enumerate(faults) if not options.only or any(word in fault.name for word in options.only)]
    if options.some:
        chosen = random.Random(options.seed).sample(chosen, options.some)
    if options.list:
        print("\n".join(faults[i].name for i in chosen))
        return 0
    folder = options.build.resolve() / "mutants/host"
    build(folder, faults)
    tests, state = Tests(folder), folder / "state.json"
    verdicts = json.loads(state.read_text()) if state.exists() else {}
    sound = {}
    reasons = json.loads((HERE / "reasons.json").read_text())
    for number in chosen:
        fault, began = faults[number], time.monotonic()
        text = (SOURCE / fault.file).read_text()
        key = f"{fault.name}: {text[fault.begin:fault.end]}"
        if key in verdicts:
            continue
        verdicts[key] = ""
        for name, command in tests.of(fault):
            if time.monotonic() - began > options.seconds:
                break
            if not tests.passes(command, number):
                sound.setdefault(name, None)
                if sound[name] is None:
                    sound[name] = tests.passes(command, -1)
                if sound[name]:
                    verdicts[key] = name
                    break
        print(f"{fault.name}: {'seen by ' + verdicts[key] if verdicts[key] else 'SURVIVES'}, {time.monotonic() - began:.0f} s", flush=True)
        state.write_text(json.dumps(verdicts, indent=0))
    survivors = [key for key, test in verdicts.items() if not test and key.split(":")[0] not in reasons]
    print(f"{len(verdicts)} of {len(faults)} faults tried, {sum(map(bool, verdicts.values()))} seen")
    return int(bool(survivors))


if __name__ == "__main__":
    sys.exit(main())

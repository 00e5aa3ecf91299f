# SPDX-License-Identifier: MIT
"""The knowledge of earlier runs: the faults that are settled (for this tree of shaders and tests), the tests that see
them, and how long these take."""
import hashlib
import json
import threading
from collections import Counter

from suite import likely


def tree_of(source):
    """Names all that a verdict depends on."""
    digest = hashlib.sha256()
    for folder in ("shaders", "src", "bench", "scenes", "tests"):
        for path in sorted((source / folder).rglob("*")):
            if path.is_file() and "mutants" not in path.parts and "__pycache__" not in path.parts:
                digest.update(str(path.relative_to(source)).encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]


class Memory:
    def __init__(self, path, hints, tree):
        self.path, self.tree, self.lock = path, tree, threading.Lock()
        self.known = json.loads(path.read_text()) if path.exists() else {"verdicts": {}, "sound": {}, "seconds": {}}
        self.hints = json.loads(hints.read_text()) if hints.exists() else {}
        self.hints |= {name: verdict["seen_by"] for name, verdict in self.known["verdicts"].items() if verdict["seen_by"]}

    def key(self, fault):
        return hashlib.sha256("\0".join([self.tree, *fault[:3]]).encode()).hexdigest()[:16]

    def verdict(self, fault):
        """Returns what was found for this very fault and tree, or None."""
        verdict = self.known["verdicts"].get(fault.name)
        return verdict if verdict and verdict["key"] == self.key(fault) else None

    def settle(self, fault, seen_by, seconds):
        with self.lock:
            self.known["verdicts"][fault.name] = {"key": self.key(fault), "seen_by": seen_by, "seconds": round(seconds, 1)}
            if seen_by:
                self.hints[fault.name] = seen_by
            self.save()

    def is_sound(self, test):
        """Returns true if the test passes without a fault, or None if that is not known."""
        return self.known["sound"].get(f"{self.tree} {test}")

    def note(self, test, seconds, sound=None):
        with self.lock:
            self.known["seconds"][test] = round(seconds, 1)
            if sound is not None:
                self.known["sound"][f"{self.tree} {test}"] = sound
            self.save()

    def save(self):
        part = self.path.with_suffix(".part")
        part.write_text(json.dumps(self.known, indent=1))
        part.replace(self.path)

    def in_order(self, fault, tests):
        """The one that saw this fault before, then those that are likely to, then those that saw many faults of its file, and are short."""
        with self.lock:
            near = Counter(test for name, test in self.hints.items() if name.split(".")[0] + ".glsl" == fault.file)
            far = Counter(self.hints.values())
        usual = {"picture": 3, "command": 20, "pure": 40}
        seconds = lambda test: self.known["seconds"].get(test, usual[test.split(".")[0]])
        worth = lambda test: (4 * near[test] + far[test] + 0.5) / (seconds(test) + 1)
        guessed = likely(fault.name)
        return sorted(tests, key=lambda test: (test != self.hints.get(fault.name), guessed.index(test) if test in guessed else len(guessed), -worth(test)))

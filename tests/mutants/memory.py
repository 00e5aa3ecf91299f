# SPDX-License-Identifier: MIT
"""The knowledge of earlier runs: the faults that are settled, the tests that see them, and how long these take."""
import hashlib
import json
import threading
from collections import Counter

SECONDS = {"suite": 2, "picture": 3, "command": 20, "pure": 40}  # of tests that were never run


def function_of(name):
    return name.split()[0]


class Memory:
    def __init__(self, path, hints, texts):
        """hints: a file that says which test has seen a fault of a function; texts: the functions' texts by FILE.FUNCTION."""
        self.path, self.texts, self.lock = path, texts, threading.Lock()
        self.known = json.loads(path.read_text()) if path.exists() else {"verdicts": {}, "sound": {}, "seconds": {}}
        self.hints = json.loads(hints.read_text()) if hints.exists() else {}
        self.hints |= {function_of(name): verdict["seen_by"] for name, verdict in self.known["verdicts"].items() if verdict["seen_by"]}

    def key(self, fault):
        """A verdict lasts until the function changes."""
        return hashlib.sha256("\0".join((self.texts[function_of(fault.name)], fault.name, fault.after)).encode()).hexdigest()[:16]

    def verdict(self, fault):
        """Returns what was found for this fault of this function, or None."""
        verdict = self.known["verdicts"].get(fault.name)
        return verdict if verdict and verdict["key"] == self.key(fault) else None

    def settle(self, fault, seen_by, seconds):
        with self.lock:
            self.known["verdicts"][fault.name] = {"key": self.key(fault), "seen_by": seen_by, "seconds": round(seconds, 1)}
            if seen_by:
                self.hints[function_of(fault.name)] = seen_by
            self.save()

    def is_sound(self, test):
        """Returns true if the test passes without a fault, or None if that is not known."""
        return self.known["sound"].get(test)

    def note(self, test, seconds, sound=None):
        with self.lock:
            self.known["seconds"][test] = round(seconds, 1)
            if sound is not None:
                self.known["sound"][test] = sound
            self.save()

    def save(self):
        part = self.path.with_suffix(".part")
        part.write_text(json.dumps(self.known, indent=1))
        part.replace(self.path)

    def seconds_of(self, test):
        return self.known["seconds"].get(test, SECONDS[test.split(".")[0]])

    def in_order(self, fault, tests):
        """The one that saw a fault of this function before, then those that saw many of its file, and are short."""
        with self.lock:
            near = Counter(test for name, test in self.hints.items() if name.rsplit(".", 1)[0] == function_of(fault.name).rsplit(".", 1)[0])
            far = Counter(self.hints.values())
        worth = lambda test: (4 * near[test] + far[test] + 0.5) / (self.seconds_of(test) + 1)
        return sorted(tests, key=lambda test: (test != self.hints.get(function_of(fault.name)), -worth(test)))

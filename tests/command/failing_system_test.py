#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A system that fails (tests/faults/failing_system.cpp), where campaigns have found something: the whole is tests/campaign/faults.py."""
import os
import signal
import struct
import subprocess
import time

from support import FRAGTRACE, SCENES, SMALL, Case, main, run

BOX = SCENES / "cornell-box.gltf"
MEMORY = 8  # kKinds of failing_system.cpp


def under(setting, value, *words):
    return run(*words, timeout=60, env={**os.environ, "LD_PRELOAD": str(FRAGTRACE.parent / "libfailing_system.so"), "FRAGTRACE_SYSTEM_PROGRAM": "fragtrace",
                                        f"FRAGTRACE_SYSTEM_{setting}": str(value)})


def with_fault(kind, number, *words):
    return under("FAIL", f"{kind},{number}", *words)


class FailingSystem(Case):
    def out_of_memory(self, result):
        self.assertEqual((result.returncode, len(result.stderr.splitlines())), (3, 1), result.stderr)
        self.assertIn("memory", result.stderr)

    def among_allocations(self, number, *words):
        """So many numbers of allocations that the command makes, evenly spread."""
        counts = self.folder / "counts"
        self.assertEqual(under("COUNTS", counts, *words).returncode, 0)
        count = struct.unpack_from("<Q", counts.read_bytes(), 8 * MEMORY)[0]
        self.assertGreater(count, 1000)
        return [1 + i * (count - 1) // number for i in range(number)]

    def test_an_allocation_that_fails_before_main_or_where_nothing_may_throw_is_said(self):
        """CLI11 looks for options in functions that may not throw."""
        for number in (31, 53, *self.among_allocations(40, "info", BOX)):
            with self.subTest(number):
                self.out_of_memory(with_fault("memory", number, "info", BOX))

    def test_a_shader_is_not_cut_short_where_memory_runs_out(self):
        """Streams take a lack of memory for their end; a loader of functions did not look at what it got."""
        path = self.folder / "x.pfm"
        self.renders(BOX, "-o", path, *SMALL)
        right = path.read_bytes()
        for number in self.among_allocations(100, "render", BOX, "-o", path, *SMALL):
            with self.subTest(number):
                path.write_bytes(b"old")
                result = with_fault("memory", number, "render", BOX, "-o", path, *SMALL)
                if result.returncode == 0:
                    self.assertEqual(path.read_bytes(), right)
                else:
                    self.out_of_memory(result)
        path.unlink()

    def test_an_interruption_while_a_file_is_written_leaves_no_part(self):
        """Each call of the system is delayed, so that the part is there for a while."""
        path, parts = self.folder / "x.exr", [self.folder / "part-0.exr", self.folder / "part-2.exr"]
        for offset, part in zip((0, 2), parts):
            self.renders(BOX, "-o", part, *SMALL, "--sample-offset", offset)
        path.write_bytes(b"old")
        slow = {"LD_PRELOAD": str(FRAGTRACE.parent / "libfailing_system.so"), "FRAGTRACE_SYSTEM_PROGRAM": "fragtrace", "FRAGTRACE_SYSTEM_DELAY": "1,200000"}
        is_there = lambda: list(self.folder.glob(".x.exr.*.part"))
        seen = 0
        for signal_number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            with subprocess.Popen([FRAGTRACE, "merge", *parts, "-o", path], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, env={**os.environ, **slow}) as process:
                while not is_there() and process.poll() is None:
                    time.sleep(0.001)
                process.send_signal(signal_number)
                process.communicate(timeout=60)
            self.assertFalse(is_there())
            if path.read_bytes() == b"old":
                self.assertEqual(process.returncode, 130)
                seen += 1
            path.write_bytes(b"old")
        path.unlink()
        self.assertGreater(seen, 0)

    def test_an_interruption_after_a_file_is_written_does_not_say_that_nothing_is(self):
        """Its last line waits for a reader of standard output."""
        path, parts = self.folder / "x.exr", [self.folder / "part-0.exr", self.folder / "part-2.exr"]
        for offset, part in zip((0, 2), parts):
            self.renders(BOX, "-o", part, *SMALL, "--sample-offset", offset)
        read, write = os.pipe()
        os.set_blocking(write, False)
        try:
            while True:
                os.write(write, bytes(1 << 12))
        except BlockingIOError:
            os.set_blocking(write, True)
        with subprocess.Popen([FRAGTRACE, "merge", *parts, "-o", path], stdout=write, stderr=subprocess.PIPE, text=True) as process:
            deadline = time.monotonic() + 60
            while not path.exists() and time.monotonic() < deadline:
                time.sleep(0.01)
            time.sleep(0.1)
            process.send_signal(signal.SIGTERM)
            said = process.communicate(timeout=60)[1]
        os.close(read)
        os.close(write)
        self.assertEqual((process.returncode, said), (130, "fragtrace: interrupted; files that were finished stay\n"))


if __name__ == "__main__":
    main()

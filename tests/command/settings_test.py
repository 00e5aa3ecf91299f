#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""bench/settings.py: makes a file of times, and ends with status 1 when something is slower than one."""
import json
import subprocess

from support import FRAGTRACE, SCENES, Case, main

SCRIPT = SCENES.parent / "bench/settings.py"


class Settings(Case):
    def times(self, *options):
        return subprocess.run([SCRIPT, FRAGTRACE, self.folder / "before.json", "--only", "mirror-reflections,box-literals", "--rounds", "2", *options],
                              capture_output=True, text=True, check=False)

    def test_against_a_file_of_before(self):
        made = self.times()
        self.assertEqual(made.returncode, 0, made.stderr)
        path = self.folder / "before.json"
        lines = [json.loads(line) for line in path.read_text().splitlines()]
        self.assertEqual([line["scene"] for line in lines], ["sphere-plane-mirror.gltf", "cornell-box.gltf"])
        self.assertEqual(self.times("--tolerance", "99").returncode, 0)
        lines[1]["frame_ms"]["median"] /= 100
        path.write_text("".join(json.dumps(line) + "\n" for line in lines))
        slower = self.times("--tolerance", "10")
        self.assertEqual((slower.returncode, slower.stderr.strip()), (1, "settings.py: slower or wrong: box-literals"), slower.stdout)

    def test_what_is_no_setting(self):
        wrong = self.times("--only", "nonsense")
        self.assertEqual(wrong.returncode, 2)
        self.assertIn("no setting nonsense", wrong.stderr)


if __name__ == "__main__":
    main()

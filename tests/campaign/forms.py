# SPDX-License-Identifier: MIT
"""Random scenes in equivalent forms (tests/property/property_test.cpp): scaled, moved, turned, reordered, flattened and split, by both
schedules. Each must show the same. A case is one scene, its number the seed."""
from common import Finding, Run

ASKED = {"scenes": 5000}
OTHER_HITS = 1e-3  # of the pixels of one scene, at most so many may be other


def prepare(ground):
    if not (ground.build / "property_test").exists():
        from common import Absent
        raise Absent("property_test is not built")


def case(ground, _, number, folder):
    with Run([ground.build / "property_test", "egl", number, 1], folder) as process:
        result = process.wait(300)
    if result.status != 0:
        raise Finding(f"scene {number}: status {result.status}: {(result.output + result.error).strip()}; repeat: build/property_test egl {number} 1")
    return {"scenes": 1}

# SPDX-License-Identifier: MIT
"""Random scenes in equivalent forms (tests/property/property_test.cpp): scaled, moved, turned, reordered, flattened, split and shared, by
both schedules and, in the other form, other reads of buffers and another stage of the pipeline, on both backends. Each must show the same. A case is one scene, its number the seed."""
from common import SKIPPED, Finding, Run

ASKED = {"scenes": 5000}


def prepare(ground):
    if not (ground.build / "property_test").exists():
        from common import Absent
        raise Absent("property_test is not built")


def case(ground, _, number, folder):
    backend = ("egl", "osmesa")[number // 5 % 2]
    with Run([ground.build / "property_test", backend, number, 1], folder) as process:
        result = process.wait(300)
    if result.status == SKIPPED:  # without libOSMesa
        return {}
    if result.status != 0:
        raise Finding(f"scene {number}: status {result.status}: {(result.output + result.error).strip()}; repeat: build/property_test {backend} {number} 1")
    return {"scenes": 1}

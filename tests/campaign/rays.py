# SPDX-License-Identifier: MIT
"""The rows of `bench stress`, and the searches that climb towards broken limits (tests/pure/climb.h), with ever other seeds. Case n is row n % rows with
seed n / rows; all count the cases that they tried."""
import json
import os
import re

from common import Finding, Run, run

ASKED = {"rays": 10 ** 9}
SEEDS = 1001  # that `bench stress --seed` takes
SEARCH = "searches"


def prepare(ground):
    """The names of the rows: those that a name that is in none of them is compared with."""
    if ground.brief:
        return ["boxes", "shell white", SEARCH]
    said = run(ground, ["bench", "stress", "--rows", "*", "--quick"], ground.folder).error
    return [*said.strip().partition("is in none of ")[2].split(", "), SEARCH]


def searched(ground, seed, folder):
    environment = {**os.environ, "FRAGTRACE_ATTACK_SEED": str(seed), "FRAGTRACE_ATTACK_RAYS": str(1000 if ground.brief else 100_000)}
    with Run(["--gtest_filter=CreaseSearch.*:LimitSearch.*"], folder, environment=environment, program=ground.build / "pure_tests") as process:
        result = process.wait(7200)
    if result.status != 0:
        raise Finding(f"the searches, seed {seed}: {result.output}")
    return {"rays": sum(map(int, re.findall(r"(\d+) of them promised", result.output)))}


def case(ground, rows, number, folder):
    name, seed = rows[number % len(rows)], number // len(rows)
    if seed >= SEEDS:
        return {}
    if name == SEARCH:
        return searched(ground, seed, folder)
    words = ["bench", "stress", "--rows", name, "--seed", seed, "--json", "rows.json", "--quiet"]
    result = run(ground, words + (["--quick"] if ground.brief else []), folder, seconds=7200)
    if result.status != 0:
        raise Finding(f"status {result.status}: {result.output}{result.error}; repeat: build/fragtrace {' '.join(map(str, words))}")
    # A row's name may be in that of others.
    lines = [json.loads(line) for line in (folder / "rows.json").read_text().splitlines()]
    return {"rays": sum(line["cases"] for line in lines if line["row"] == name)}

# SPDX-License-Identifier: MIT
"""Reads figures from the messages of GPU drivers about compiled programs (bench/gpu/compilers), and makes a table and
limits of them."""
import re

# Patterns of a device's message about the tracer's shader, and of its figures by name. The first figure limits how many
# lanes run at the same time.
NUMBERS = {"GA102": {"registers": r"(\d+) Number of GPRs", "spills": r"(\d+) Spills to memory", "fills": r"(\d+) Fills from memory",
                     "warps": r"(\d+) Max warps/SM", "instructions": r"(\d+) Instruction count"},
           "navi21": {"registers": r"VGPRS: (\d+)", "spills": r"Spilled VGPRs: (\d+)", "waves": r"Max Waves: (\d+)", "bytes": r"Code Size: (\d+)"},
           "DG2": {"lanes": r"SIMD(\d+) shader", "spills": r"(\d+):\d+ spills:fills", "fills": r"\d+:(\d+) spills:fills", "instructions": r"(\d+) inst,"}}
LIMITED = ("registers", "spills", "fills")
# The text of each device's cell in a table.
CELLS = {"GA102": "{registers}, {spills} + {fills}; {warps} warps; {instructions}", "navi21": "{registers}, {spills}; {waves} waves; {bytes} B",
         "DG2": "{spills} + {fills}; {instructions}"}


def figures(device, line):
    if not line["right"]:
        raise RuntimeError(f"{device}: {line['file']} does not compile: {line['messages']}")
    numbers = NUMBERS[device]
    said = [m for m in line["messages"] if re.search(numbers["spills"], m)]
    if not said:
        raise RuntimeError(f"{device}: {line['file']}: the driver said nothing of registers: {line['messages']}")
    # A program of fragments has a vertex shader, too, which is small.
    longest = max(({name: int(re.search(pattern, m)[1]) for name, pattern in numbers.items()} for m in said), key=lambda f: list(f.values())[-1])
    return {**longest, "seconds": round(line["seconds"], 2)}


def table(result):
    cell = {device: text.format for device, text in CELLS.items()}
    lines = ["| program | " + " | ".join(CELLS) + " |", "| --- | " + " | ".join("---" for _ in CELLS) + " |"]
    return lines + [f"| {name} | " + " | ".join(cell[d](**row[d]) + f"; {row[d]['seconds']:.1f} s" for d in CELLS) + " |"
                    for name, row in result["rows"].items()]


def over(result, limits):
    """Yields a line for each figure that is above its limit."""
    for name, row in result["rows"].items():
        for device, now in row.items():
            most = limits["rows"].get(name, {}).get(device, {})
            yield from (f"{name}, {device}: {now[key]} {key}, at most {most[key]}" for key in LIMITED if key in most and now[key] > most[key])

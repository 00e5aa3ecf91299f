# SPDX-License-Identifier: MIT
"""The command `fragtrace` of the wheel."""
import os
import sys
from pathlib import Path


def program():
    return str(Path(__file__).with_name("fragtrace"))


def main():
    os.environ.setdefault("FRAGTRACE_PYTHON", sys.executable or "python3")
    os.execv(program(), ["fragtrace", *sys.argv[1:]])

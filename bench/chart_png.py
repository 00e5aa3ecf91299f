#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Turns charts of `fragtrace bench` into PNG files, with whatever program of this machine can.

usage: chart_png.py CHART.svg ... (writes CHART.png beside each)
"""
import importlib.util
import shutil
import subprocess
import sys
from pathlib import Path


def commands(svg, png):
    """Yields the commands that can convert a chart, best first."""
    yield ["rsvg-convert", "--zoom", "1.5", "-o", png, svg]
    yield ["inkscape", "--export-dpi", "144", "-o", png, svg]
    yield ["magick", "-density", "144", svg, png]
    yield ["convert", "-density", "144", svg, png]


def convert(svg):
    png = svg.with_suffix(".png")
    if importlib.util.find_spec("cairosvg"):
        import cairosvg
        cairosvg.svg2png(url=str(svg), write_to=str(png), scale=1.5)
        return True
    for command in commands(svg, png):
        if shutil.which(command[0]):
            return subprocess.run(command).returncode == 0
    print("chart_png.py: none of cairosvg (PyPI), rsvg-convert, inkscape, ImageMagick is installed", file=sys.stderr)
    return False


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    sys.exit(0 if all([convert(Path(name)) for name in sys.argv[1:]]) else 1)

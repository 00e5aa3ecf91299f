# SPDX-License-Identifier: MIT
"""The chart of samplers.py: error against samples per pixel, ours and the best of Mitsuba's samplers, a small panel per picture."""

import math
from xml.sax.saxutils import escape

WIDTH, HEIGHT, MARGIN, COLUMNS = 230, 190, 34, 3
COLORS = {"ours": "#c0392b", "Mitsuba": "#2c6fbb"}


def panel(name, lines, counts, left, top):
    """Both axes are logarithmic; the vertical one spans the panel's own decades."""
    values = [v for line in lines.values() for v in line]
    low, high = math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)))
    across = lambda n: left + MARGIN + (WIDTH - MARGIN - 10) * math.log(n / counts[0]) / math.log(counts[-1] / counts[0])
    down = lambda v: top + 20 + (HEIGHT - 45) * (high - math.log10(v)) / (high - low)
    text = [f'<text x="{left + MARGIN}" y="{top + 13}" font-weight="bold">{escape(name)}</text>']
    for decade in range(low, high + 1):
        y = down(10.0 ** decade)
        text.append(f'<line x1="{left + MARGIN}" x2="{left + WIDTH - 10}" y1="{y:.1f}" y2="{y:.1f}" stroke="#ddd"/>'
                    f'<text x="{left + MARGIN - 4}" y="{y + 3:.1f}" text-anchor="end">1e{decade}</text>')
    text += [f'<text x="{across(n):.1f}" y="{top + HEIGHT - 10}" text-anchor="middle">{n}</text>' for n in counts]
    for label, line in lines.items():
        points = " ".join(f"{across(n):.1f},{down(v):.1f}" for n, v in zip(counts, line))
        text.append(f'<polyline points="{points}" fill="none" stroke="{COLORS[label]}" stroke-width="2"/>')
    return "\n".join(text)


def draw(figures, counts):
    """figures: {picture: {"ours": [errors], "Mitsuba": [errors]}}, an error for each of `counts`."""
    rows = -(-len(figures) // COLUMNS)
    panels = [panel(name, lines, counts, WIDTH * (k % COLUMNS), 22 + HEIGHT * (k // COLUMNS)) for k, (name, lines) in enumerate(figures.items())]
    legend = (("relative MSE against samples per pixel:", "black", 8), ("ours", COLORS["ours"], 250), ("best of Mitsuba's samplers", COLORS["Mitsuba"], 284))
    title = "".join(f'<text x="{x}" y="14" font-size="12" fill="{color}">{label}</text>' for label, color, x in legend)
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH * COLUMNS} {22 + HEIGHT * rows}" font-family="sans-serif" font-size="10">\n'
            f'<rect width="100%" height="100%" fill="white"/>\n{title}\n'
            + "\n".join(panels) + "\n</svg>\n")

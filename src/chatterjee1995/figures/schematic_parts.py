"""Parts of the schematics; coordinates are in inches from the lower left corner of the sheet."""

import numpy as np
from matplotlib.patches import Circle, FancyArrowPatch, Rectangle

from impact_damper.plot import style

STROKES = {"outline": 1.1, "detail": 0.8, "fine": 0.5}  # line widths in points
LETTER = {"ha": "center", "va": "center", "size": 10.0}


def sheet(column, height):
    """Return axes, with one unit per inch, that fill a new figure of a column's width."""
    page = style.figure(column, height)
    page.set_layout_engine("none")
    axes = page.add_axes((0, 0, 1, 1))
    axes.set(xlim=(0, page.get_figwidth()), ylim=(0, height))
    axes.set_axis_off()
    return axes


def stroke(axes, points, width="outline", **changes):
    """Draw a line through points."""
    keywords = {
        "color": style.BLACK,
        "solid_capstyle": "round",
        "solid_joinstyle": "round",
    } | changes
    axes.plot(*np.transpose(points), linewidth=STROKES[width], **keywords)


def filled(color, width="detail"):
    """Return the matplotlib keywords of an outlined, filled patch."""
    return {"facecolor": color, "edgecolor": style.BLACK, "linewidth": STROKES[width]}


def arrow(axes, start, end, width="detail", head="-|>", color=style.BLACK):
    """Draw an arrow from one point to another."""
    look = {"linewidth": STROKES[width], "color": color, "shrinkA": 0, "shrinkB": 0}
    axes.add_patch(FancyArrowPatch(start, end, arrowstyle=head, mutation_scale=8, **look))


def letter(axes, x, y, symbol, **changes):
    """Write a symbol centred on a point."""
    axes.text(x, y, symbol, **LETTER | changes)


def spring(axes, start, end, y, turns=5, height=0.16):
    """Draw a horizontal coil spring with straight ends."""
    lead = 0.14 * (end - start)
    x = np.linspace(start + lead, end - lead, 2 * turns + 1)
    zigzag = np.where(np.arange(2 * turns + 1) % 2, 0.5, -0.5) * height
    zigzag[[0, -1]] = 0
    stroke(axes, [(start, y), *zip(x, y + zigzag, strict=True), (end, y)], "detail")


def dashpot(axes, start, end, y, height=0.18):
    """Draw a horizontal dashpot with its cup at the start and its piston at the end."""
    cup = start + 0.34 * (end - start)
    rim = start + 0.70 * (end - start)
    piston = 0.45 * cup + 0.55 * rim
    half = height / 2
    stroke(axes, [(start, y), (cup, y)], "detail")
    stroke(axes, [(rim, y + half), (cup, y + half), (cup, y - half), (rim, y - half)], "detail")
    stroke(axes, [(piston, y), (end, y)], "detail")
    stroke(axes, [(piston, y - 0.65 * half), (piston, y + 0.65 * half)], "outline")


def ground(axes, start, end, depth=0.09, spacing=0.09):
    """Draw a fixed surface: a line, hatched at its right as seen from `start` towards `end`."""
    start, end = np.array(start), np.array(end)
    length = np.hypot(*(end - start))
    along = (end - start) / length
    inward = np.array([along[1], -along[0]])
    for distance in np.arange(spacing, length, spacing):
        point = start + distance * along
        stroke(axes, [point, point + depth * (inward - along)], "fine")
    stroke(axes, [start, end])


def mass(axes, left, bottom, width, height, color=style.PALE):
    """Draw a mass as a rectangle."""
    axes.add_patch(Rectangle((left, bottom), width, height, **filled(color, "outline")))


def wheels(axes, centres, rail, radius=0.08):
    """Draw wheels that stand on a rail."""
    for x in centres:
        axes.add_patch(Circle((x, rail + radius), radius, **filled(style.WHITE)))


def coordinate(axes, x, y, symbol):
    """Draw a displacement: a tick at (x, y), an arrow to the right and a symbol."""
    stroke(axes, [(x, y - 0.08), (x, y + 0.08)], "detail", color=style.BLUE)
    arrow(axes, (x, y), (x + 0.42, y), color=style.BLUE)
    letter(axes, x + 0.55, y, symbol, color=style.BLUE)

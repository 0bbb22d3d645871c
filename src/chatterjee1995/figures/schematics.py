"""The schematics of the paper: figures 1, 9, 12, 17 and B1."""

from itertools import pairwise

import numpy as np
from matplotlib.patches import Circle, FancyBboxPatch, Polygon

from chatterjee1995.figures import schematic_parts as parts
from impact_damper.plot import style


def carriage(axes):
    """Draw the primary mass on a rail, with springs and dashpot at the left, force at the right."""
    parts.ground(axes, (0.35, 2.5), (0.35, 0.3))
    parts.ground(axes, (0.35, 0.3), (6.75, 0.3))
    parts.mass(axes, 2.05, 0.46, 3.9, 1.86)
    parts.wheels(axes, (2.65, 5.35), 0.3)
    parts.spring(axes, 0.35, 2.05, 2.03)
    parts.arrow(axes, (0.97, 1.85), (1.43, 2.21))
    parts.spring(axes, 0.35, 2.05, 1.39)
    parts.dashpot(axes, 0.35, 2.05, 0.75)
    for y, symbol in ((2.31, "$k_1$"), (1.59, "$k_l$"), (0.97, "$c_1$")):
        parts.letter(axes, 1.2, y, symbol)
    parts.arrow(axes, (5.95, 1.39), (6.6, 1.39), "outline", color=style.VERMILION)
    parts.letter(axes, 6.36, 1.58, r"$F\/\cos\,\omega t$", color=style.VERMILION)
    parts.letter(axes, 2.27, 2.12, "$m_1$")
    parts.coordinate(axes, 2.05, 2.55, "$x_1$")


def slot(axes, contact):
    """Draw the slot with the loose mass. `contact` draws spring and dashpot of a wall."""
    parts.mass(axes, 2.5, 0.66, 3.0, 1.46, style.WHITE)
    parts.wheels(axes, (3.85, 4.15), 0.66, 0.04)
    parts.mass(axes, 3.68, 0.74, 0.64, 0.90, style.PALE_SKY)
    parts.letter(axes, 4.0, 1.19, "$m_2$")
    for wall, plate, side in ((2.5, 3.15, 3.68), (5.5, 4.85, 4.32)):
        contact(axes, wall, plate)
        parts.stroke(axes, [(plate, 0.88), (plate, 1.5)])
        for x in (plate, side):
            parts.stroke(axes, [(x, 1.7), (x, 1.86)], "fine", color=style.GREY)
        parts.arrow(axes, (plate, 1.8), (side, 1.8), "fine", "<|-|>")
        parts.letter(axes, (plate + side) / 2, 1.94, "$d/2$")
    parts.stroke(
        axes, [(4.0, 1.7), (4.0, 2.47)], "fine", color=style.GREY, linestyle=(0, (8, 2, 2, 2))
    )
    parts.coordinate(axes, 4.0, 2.55, "$x_2$")
    parts.letter(axes, 5.5, 2.55, "$y = x_1 - x_2$", color=style.BLUE)


def elastic_contact(axes, wall, plate):
    """Draw a contact spring k2 between a wall of the slot and a plate."""
    parts.spring(axes, wall, plate, 1.19, 4)
    parts.letter(axes, (wall + plate) / 2, 1.41, "$k_2$")


def inelastic_contact(axes, wall, plate):
    """Draw a contact spring k2 and a dashpot c2 in parallel between a wall and a plate."""
    parts.spring(axes, wall, plate, 1.39, 4)
    parts.dashpot(axes, wall, plate, 0.99, 0.16)
    parts.letter(axes, (wall + plate) / 2, 1.59, "$k_2$")
    parts.letter(axes, (wall + plate) / 2, 0.80, "$c_2$")


@style.context()
def elastic_model():
    """Return figure 1: primary mass with a loose mass between two contact springs k2."""
    axes = parts.sheet("double", 2.75)
    carriage(axes)
    slot(axes, elastic_contact)
    return axes.figure


@style.context()
def inelastic_model():
    """Return figure 9: figure 1 with a dashpot c2 added parallel to each contact spring k2."""
    axes = parts.sheet("double", 2.75)
    carriage(axes)
    slot(axes, inelastic_contact)
    return axes.figure


def place(u, v, level):
    """Return where points (u, v) of an oblique plane at the height `level` lie on the sheet."""
    u, v = np.broadcast_arrays(np.atleast_1d(u), v)
    return np.column_stack((0.25 + u + 0.5 * v, level + 0.6 * v))


def region(axes, u, v, level, color):
    """Fill the polygon with corners (u, v) in the plane at the height `level`."""
    axes.add_patch(Polygon(place(u, v, level), **parts.filled(color)))


def attractor(axes, centre, radius, level, color, **keywords):
    """Draw an attractor as a circle in the plane at the height `level`."""
    angle = np.linspace(0, 2 * np.pi, 200)
    points = place(centre[0] + radius * np.cos(angle), centre[1] + radius * np.sin(angle), level)
    parts.stroke(axes, points, color=color, **keywords)


def approach(axes, start, centre, radius, level, color, rate, **keywords):
    """Draw a motion that tends to an attractor: a spiral from `start` that approaches a circle.

    The circle lies in the plane at the height `level`. The greater `rate`, the faster the approach.
    """
    offset = np.subtract(start, centre)
    turned = np.linspace(0, 2 * np.pi, 300)
    angle = np.arctan2(offset[1], offset[0]) + turned
    distance = radius + (np.hypot(*offset) - radius) * np.exp(-rate * turned)
    u, v = centre[0] + distance * np.cos(angle), centre[1] + distance * np.sin(angle)
    points = place(u, v, level)
    parts.stroke(axes, points, "detail", color=color, **keywords)
    parts.arrow(axes, points[44], points[50], color=color)


def passage(axes, low, high, edge, words, upward):
    """Draw a switching of the damper: a vertical arrow between two planes, with the text `words`.

    The arrow joins the points `low` and `high`. It points up if `upward` is true, otherwise down.
    The arrow is dashed above the height `edge`, at which the upper plane begins.
    """
    x = low[0]
    ends = [(x, low[1] + 0.03), (x, edge)]
    parts.stroke(axes, [(x, edge), high], "detail", linestyle=(0, (2, 2)))
    parts.arrow(axes, *(ends if upward else ends[::-1]))
    axes.text(x + 0.1, edge - 0.33, words, va="center")


def state(axes, position, symbol, shift):
    """Draw a state of the oscillator as a dot, with its symbol moved by `shift`."""
    axes.add_patch(Circle(position, 0.032, color=style.BLACK, zorder=4))
    parts.letter(axes, *np.add(position, shift), symbol)


def triad(axes, x, y):
    """Draw three axes: displacement and velocity in a plane, state of the damper upwards."""
    for end, symbol, shift in (
        ((x + 0.34, y), "$Z_1$", (0.12, 0)),
        ((x + 0.2, y + 0.24), "$Z_1\u2032$", (0.09, 0.09)),
        ((x, y + 0.48), r"$\mathbf{Z}_\mathrm{c}$", (0, 0.12)),
    ):
        parts.arrow(axes, (x, y), end, "fine")
        parts.letter(axes, *np.add(end, shift), symbol)


def planes(axes, off, on):
    """Draw two planes of states: at the height `off` with two basins, at `on` with one basin."""
    right = 5.3
    v = np.linspace(0, 2, 100)
    border = 2.5 + 0.22 * np.sin(2.6 * v)
    for edge, color in ((0, style.PALE_ORANGE), (right, style.PALE_SKY)):
        region(axes, [*border, edge, edge], [*v, 2, 0], off, color)
    region(axes, [0, right, right, 0], [0, 0, 2, 2], on, style.PALE)
    for level, u, basin in (
        (off, 0.5, r"$B(A_\mathrm{ud})$"),
        (off, 4.7, r"$B(A_\mathrm{d})$"),
        (on, 4.7, r"$B(A_\mathrm{c})$"),
    ):
        parts.letter(axes, *place(u, 1.75, level)[0], basin)
    for level, words, symbols in (
        (off, "Damper off", r"$(\mathbf{Z}, \theta)$"),
        (on, "Damper on", r"$(\mathbf{Z}, \theta, \mathbf{Z}_\mathrm{c})$"),
    ):
        axes.text(5.85, level + 0.2, words)
        axes.text(5.85, level + 0.02, symbols)


@style.context()
def migration_scheme():
    """Return figure 12: migration from one attractor of the free oscillator to another."""
    axes = parts.sheet("double", 3.6)
    off, on = 0.15, 2.1
    bad, goal, damped = (1.35, 1.0), (4.35, 1.0), (2.95, 1.0)
    first, release = (0.5, 0.7), (3.3, 0.65)
    planes(axes, off, on)
    attractor(axes, damped, 0.5, off, style.GREY, linestyle=(0, (1, 1.5)))
    for centre, radius, level, color, name in (
        (bad, 0.55, off, style.VERMILION, r"$A_\mathrm{ud}$"),
        (goal, 0.34, off, style.BLUE, r"$A_\mathrm{d}$"),
        (damped, 0.5, on, style.BLACK, r"$A_\mathrm{c}$"),
    ):
        attractor(axes, centre, radius, level, color)
        parts.letter(axes, *place(*centre, level)[0], name, color=color)
    approach(axes, first, bad, 0.55, off, style.VERMILION, 0.4, linestyle=(0, (4, 2)))
    approach(axes, first, damped, 0.5, on, style.BLACK, 1.6)
    approach(axes, release, goal, 0.34, off, style.BLUE, 0.8)
    (low, high), (back, leaving) = (
        [place(*spot, level)[0] for level in (off, on)] for spot in (first, release)
    )
    passage(axes, low, high, on, "damper switched on", True)
    passage(axes, back, leaving, on, "damper switched off", False)
    state(axes, low, r"$P_1^{\/\mathrm{r}}$", (-0.13, -0.09))
    state(axes, high, "$P_1$", (-0.12, 0.11))
    state(axes, leaving, "$P_2$", (0.13, -0.11))
    state(axes, back, r"$P_2^{\/\mathrm{r}}$", (-0.05, -0.17))
    triad(axes, 0.15, 2.83)
    return axes.figure


def node(axes, x, y, width, height, words, color):
    """Draw a box of a flow chart. Its colour decides whether it is a diamond or a rectangle."""
    across, up = width / 2, height / 2
    if color == style.PALE_ORANGE:
        corners = [(x - across, y), (x, y - up), (x + across, y), (x, y + up)]
        axes.add_patch(Polygon(corners, **parts.filled(color)))
    else:
        ends = f"round,pad=0,rounding_size={up if color == style.PALE_SKY else 0}"
        box = FancyBboxPatch((x - across, y - up), width, height, ends, **parts.filled(color))
        axes.add_patch(box)
    axes.text(x, y, words, ha="center", va="center", linespacing=1.05)


@style.context()
def algorithm():
    """Return figure 17: the flow chart of migration."""
    axes = parts.sheet("single", 5.06)
    x, side, width, margin = 1.17, 2.84, 1.76, 0.1
    chain = [
        (4.89, 0.24, "Start", style.PALE_SKY),
        (4.34, 0.42, "Run with the damper off\nuntil the motion settles", style.PALE),
        (3.43, 0.96, "On the\nnon-resonance\nbranch?", style.PALE_ORANGE),
        (2.29, 0.80, "Switchings\nat their limit?", style.PALE_ORANGE),
        (1.42, 0.42, "Switch the damper on,\nloose mass drawn at random", style.PALE),
        (0.78, 0.42, "Run until the motion settles,\nor for a stated time", style.PALE),
        (0.23, 0.24, "Switch it off at a random phase", style.PALE),
    ]
    for y, height, words, color in chain:
        node(axes, x, y, 0.7 if words == "Start" else width, height, words, color)
    for (y, height, *_), (below, depth, *_) in pairwise(chain):
        parts.arrow(axes, (x, y - height / 2), (x, below + depth / 2))
    for y, height, words in ((3.43, 0.96, "Reached"), (2.29, 0.80, "Not reached")):
        parts.letter(axes, x + 0.12, y - height / 2 - 0.1, "no", size=9)
        node(axes, side, y, 0.92, 0.3, words, style.PALE_SKY)
        parts.arrow(axes, (x + width / 2, y), (side - 0.46, y))
        parts.letter(axes, x + width / 2 + 0.14, y + 0.1, "yes", size=9)
    parts.stroke(axes, [(x - width / 2, 0.23), (margin, 0.23), (margin, 4.34)], "detail")
    parts.arrow(axes, (margin, 4.34), (x - width / 2, 4.34))
    return axes.figure


@style.context()
def impact_pair():
    """Return figure B1: two masses in contact through a spring k2 and a dashpot c2."""
    axes = parts.sheet("single", 1.4)
    parts.ground(axes, (0.1, 0.2), (3.3, 0.2))
    for left, symbol, displacement in ((0.25, "$m_1$", "$X_1$"), (2.3, "$m_2$", "$X_2$")):
        parts.wheels(axes, (left + 0.2, left + 0.65), 0.2, 0.06)
        parts.mass(axes, left, 0.32, 0.85, 0.68, style.PALE if left < 1 else style.PALE_SKY)
        parts.letter(axes, left + 0.425, 0.66, symbol)
        parts.coordinate(axes, left, 1.2, displacement)
    parts.spring(axes, 1.1, 2.3, 0.85)
    parts.dashpot(axes, 1.1, 2.3, 0.48)
    parts.letter(axes, 1.7, 1.05, "$k_2$")
    parts.letter(axes, 1.7, 0.68, "$c_2$")
    return axes.figure

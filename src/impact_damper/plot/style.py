"""Common look of all figures: fonts, colours, roles of curves, labels, legends, files.

The palette is by Okabe and Ito. Curves of different roles also differ in marker, dashes or width.
"""

import re
import string

import matplotlib.style
from matplotlib.figure import Figure
from matplotlib.rcsetup import cycler

from impact_damper.data.whole_files import whole
from impact_damper.model.parameters import SYMBOLS

BLACK, GREY, PALE, WHITE = "#000000", "#6E6E6E", "#E9E9E9", "#FFFFFF"
ORANGE, SKY, GREEN = "#E69F00", "#56B4E9", "#009E73"
BLUE, VERMILION, PURPLE = "#0072B2", "#D55E00", "#CC79A7"
PALE_SKY, PALE_YELLOW, PALE_ORANGE = "#D9EDFA", "#FAF6C4", "#FAE7C3"

COLUMNS = {"single": 3.4, "double": 7.0}  # widths in inches

STYLE = {
    "font.family": "STIXGeneral",
    "mathtext.fontset": "stix",
    "font.size": 9.0,
    "axes.labelsize": 9.0,
    "axes.titlesize": 9.0,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "legend.fontsize": 8.0,
    "legend.frameon": False,
    "legend.handlelength": 2.4,
    "legend.columnspacing": 1.4,
    # Height of titles. With None matplotlib searches for a free height, which takes long.
    "axes.titley": 1.0,
    "axes.linewidth": 0.6,
    "axes.prop_cycle": cycler(color=[BLUE, VERMILION, GREEN, ORANGE, PURPLE, BLACK]),
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "lines.linewidth": 1.1,
    "lines.markersize": 3.6,
    "lines.markeredgewidth": 0.8,
    "patch.linewidth": 0.8,
    "savefig.dpi": 300,
    "pdf.fonttype": 42,
}
DASHED, DOTTED, DASH_DOTTED = (0, (4, 2)), (0, (1, 1.5)), (0, (5, 1.5, 1, 1.5))


def line(label, color, **look):
    """Return the look of a line: keywords of `plot`."""
    return {"label": label, "color": color, **look}


def markers(label, color, marker, **look):
    """Return the look of markers without a line. The markers are open unless `look` fills them."""
    look = {"linestyle": "none", "markerfacecolor": "none"} | look
    return {"label": label, "color": color, "marker": marker, **look}


def shading(label, color):
    """Return the look of a shaded range: keywords of `axvspan`."""
    return {"label": label, "facecolor": color, "linewidth": 0, "zorder": 0}


# Look of each role. A role is the meaning of a curve in a frequency response.
ROLES = {
    "free_stable": line("free, stable", BLACK, zorder=2.2),
    "free_unstable": line("free, unstable", GREY, linestyle=DASHED, zorder=2.1),
    "free_higher": line(
        "free, other periods", BLACK, marker="|", markersize=4.2, linewidth=0.6, zorder=2.2
    ),
    "harmonic_balance": line(
        "damper, stable (harmonic balance)", SKY, linewidth=2.6, solid_capstyle="butt", zorder=2
    ),
    "period_1": markers("damper, period 1", BLUE, "o"),
    "higher_period": markers("damper, other periods", GREEN, "s"),
    "subharmonic_free": line(
        "free, one-third subharmonic", PURPLE, marker="^", markevery=0.025, linewidth=0.5
    ),
    "subharmonic_unstable": line(
        "free, one-third subharmonic, unstable",
        PURPLE,
        linestyle=DASH_DOTTED,
        linewidth=0.8,
        zorder=2.1,
    ),
    "unstable_orbit": line(
        "damper, unstable orbit of period 1", BLUE, linestyle=DOTTED, linewidth=0.8, zorder=1.9
    ),
    "subharmonic_damped": markers("damper, subharmonic (period $3n$)", PURPLE, "v"),
    "chaotic": markers("damper, chaotic", ORANGE, ".", markerfacecolor=ORANGE),
    "chaotic_transient": markers("damper, chaotic transient", ORANGE, ".", markersize=4.6),
    "non_colliding": markers("damper, no contact", BLACK, "D", markersize=2.6),
    "quasi_periodic": markers(
        "damper, quasi-periodic", SKY, "P", markerfacecolor=SKY, markersize=4.2
    ),
    "unresolved": markers("damper, unresolved", BLACK, "x"),
    "band": shading("suppression band (harmonic balance)", PALE_YELLOW),
}

# Colour, dashes and marker of curves that differ only in the value of a parameter.
CURVES = [
    (BLUE, "-", "o"),
    (VERMILION, (0, (5, 2)), "s"),
    (GREEN, DASH_DOTTED, "^"),
    (PURPLE, (0, (1, 1.2)), "D"),
    (BLACK, (0, (8, 2)), "v"),
]

# Mathtext (matplotlib's version of TeX) of symbols that `tex` cannot translate.
MATHTEXT = {"rm": "r_m", "W": r"\Omega"}


def context(*changes):
    """Return a context manager or decorator for the common style and further styles `changes`."""
    return matplotlib.style.context(["default", STYLE, *changes])


def figure(column, height) -> Figure:
    """Return an empty figure as wide as a "single" or "double" column, `height` inches high."""
    return Figure(figsize=(COLUMNS[column], height), layout="constrained")


def grid(count, row, rest, columns=2, **shared):
    """Return a figure and its `count` axes. Height in inches: `rest` + `row` x number of rows."""
    columns = min(columns, count)
    rows = -(-count // columns)
    drawn = figure("double", rest + row * rows)
    panels = drawn.subplots(rows, columns, squeeze=False, **shared).ravel()
    for axes in panels[count:]:
        axes.remove()
    letter_panels(panels[:count])
    return drawn, panels[:count]


def curve(index) -> dict:
    """Return keywords of `plot` for the line of the curve `index` in `CURVES`."""
    color, dashes, _ = CURVES[index]
    return {"color": color, "linestyle": dashes}


def points(index) -> dict:
    """Return keywords of `plot` for the open markers of the curve `index` in `CURVES`."""
    color, _, marker = CURVES[index]
    return {"color": color, "linestyle": "none", "marker": marker, "markerfacecolor": "none"}


def draw(axes, x, y, *, label=None, **look) -> None:
    """Plot a line. The label is left out if the axes already have this label."""
    axes.plot(x, y, label=once(axes, label), **look)


def once(axes, label):
    """Return a label, or None if the axes have it already, so that a legend lists it once."""
    return None if label in axes.get_legend_handles_labels()[1] else label


def parameter_label(parameters, *names, separator=", ") -> str:
    """Return symbols and values of parameters as text, such as "$r_m = 0.12$, $e = 1$"."""
    symbols = [SYMBOLS[name] for name in names]
    return separator.join(
        f"${MATHTEXT.get(symbol, tex(symbol))} = {parameters[name]:g}$"
        for name, symbol in zip(names, symbols, strict=True)
    )


def axis_label(variable, words=None) -> str:
    """Return an axis label of a DataArray: description (or `words`), symbol and units."""
    words, units = words or variable.attrs["long_name"], variable.attrs["units"]
    label = words[0].upper() + words[1:]
    if "symbol" in variable.attrs:
        label += f", ${tex(variable.attrs['symbol'])}$"
    return label if units == "1" else f"{label} ({units})"


def tex(symbol) -> str:
    """Return the mathtext of a symbol: "max |Z1|" becomes "\\max\\,|Z_{1}|"."""
    symbol = re.sub(r"[A-Za-z]{2,}", r"\\\g<0> ", symbol)
    symbol = re.sub(r"([A-Za-z])(\d+)", r"\1_{\2}", symbol)
    return symbol.replace("  |", r"\,|")


def letter_panels(panels) -> None:
    """Label several axes (a), (b), ... at their upper left corners, outside the frame."""
    if len(panels) > 1:
        for letter, axes in zip(string.ascii_lowercase, panels, strict=False):
            axes.set_title(f"({letter})", loc="left")


def legend(figure, columns) -> None:
    """Add a legend below all axes. The legend lists each label once."""
    entries = {}
    for axes in figure.axes:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            entries.setdefault(label, handle)
    if entries:
        figure.legend(entries.values(), entries.keys(), loc="outside lower center", ncols=columns)


def save_figure(figure, path) -> None:
    """Write `path`.pdf and `path`.png. The same figure always gives the same bytes."""
    with context():
        if figure.get_layout_engine() is not None:
            figure.get_layout_engine().execute(figure)
        figure.set_layout_engine(None)  # with a layout engine each file would be drawn twice
        for kind, metadata in {"pdf": {"CreationDate": None}, "png": {"Software": None}}.items():
            with whole(f"{path}.{kind}") as part:
                figure.savefig(part, format=kind, metadata=metadata)

"""Common look of all figures: fonts, colours, roles of curves, labels, legends, files.

The colours are the palette of Okabe and Ito, which colour-blind readers can distinguish. Roles that
occur in the same figure also differ in marker or line style, for print without colours.
"""

import json
import math
import re
import string

import matplotlib.style
from cycler import cycler
from matplotlib.figure import Figure

from impact_damper.data.datasets import parameters_of
from impact_damper.data.whole_files import whole
from impact_damper.model.parameters import SYMBOLS

BLACK, GREY, PALE, WHITE = "#000000", "#6E6E6E", "#E9E9E9", "#FFFFFF"
ORANGE, SKY, GREEN = "#E69F00", "#56B4E9", "#009E73"
BLUE, VERMILION, PURPLE = "#0072B2", "#D55E00", "#CC79A7"
PALE_SKY, PALE_YELLOW, PALE_ORANGE = "#D9EDFA", "#FAF6C4", "#FAE7C3"

COLUMNS = {"single": 3.4, "double": 7.0}  # widths in inches
STROKES = {"outline": 1.1, "detail": 0.8, "fine": 0.5}  # points, for drawings
LETTER_SIZE = 10.0  # points, for symbols in drawings

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
    # A search for a position clear of the ticks would take a fifth of the drawing time.
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


def _line(label, color, **keywords):
    """Return the role of a line."""
    return {"label": label, "color": color, **keywords}


def _points(label, color, marker, filled=False, **keywords):
    """Return the role of markers, open unless `filled`."""
    look = {"linestyle": "none", "markerfacecolor": color if filled else "none"}
    return {"label": label, "color": color, "marker": marker, **look, **keywords}


def _shading(label, color):
    """Return the role of a shaded range."""
    return {"label": label, "facecolor": color, "linewidth": 0, "zorder": 0}


# Keywords of `plot` for each role, the meaning of a curve; of `axvspan` for "damper_on" and "band".
ROLES = {
    "free_stable": _line("free, stable", BLACK, zorder=2.2),
    "free_unstable": _line("free, unstable", GREY, linestyle=(0, (4, 2)), zorder=2.1),
    "free_higher": _line(
        "free, other periods", BLACK, marker="|", markersize=4.2, linewidth=0.6, zorder=2.2
    ),
    "harmonic_balance": _line(
        "damper, stable (harmonic balance)", SKY, linewidth=2.6, solid_capstyle="butt", zorder=2
    ),
    "period_1": _points("damper, period 1", BLUE, "o"),
    "higher_period": _points("damper, other periods", GREEN, "s"),
    "subharmonic_free": _points(
        "free, one-third subharmonic",
        PURPLE,
        "^",
        filled=True,
        markevery=0.025,
        linestyle="-",
        linewidth=0.5,
    ),
    "subharmonic_unstable": _line(
        "free, one-third subharmonic, unstable",
        PURPLE,
        linestyle=(0, (5, 1.5, 1, 1.5)),
        linewidth=0.8,
        zorder=2.1,
    ),
    "unstable_orbit": _line(
        "damper, unstable orbit of period 1",
        BLUE,
        linestyle=(0, (1, 1.5)),
        linewidth=0.8,
        zorder=1.9,
    ),
    "subharmonic_damped": _points("damper, subharmonic (period $3n$)", PURPLE, "v"),
    "chaotic": _points("damper, chaotic", ORANGE, ".", filled=True),
    "chaotic_transient": _points("damper, chaotic transient", ORANGE, ".", markersize=4.6),
    "non_colliding": _points("damper, no contact", BLACK, "D", markersize=2.6),
    "quasi_periodic": _points("damper, quasi-periodic", SKY, "P", filled=True, markersize=4.2),
    "unresolved": _points("damper, unresolved", BLACK, "x"),
    "optimum": _points(
        "smallest, on the exact orbit", BLACK, "*", filled=True, markersize=5.5, zorder=3
    ),
    "near_optimum": _line("at most 10 % larger", GREY, marker="|", linewidth=0.6, zorder=3),
    "non_resonance": _points("released to the non-resonance motion", BLUE, ".", filled=True),
    "subharmonic": _points("released to the one-third subharmonic", VERMILION, "^"),
    "resonance": _points("released to the resonance motion", BLACK, "+"),
    "other": _points("released to another motion", GREEN, "d"),
    "lost": _points("not settled after the release", ORANGE, "*"),
    "switched_on": _line("switched on", VERMILION),
    "switched_off": _line("switched off", BLUE, linestyle=(0, (3, 1.5))),
    "damper_on": _shading("damper on", PALE_SKY),
    "band": _shading("suppression band (harmonic balance)", PALE_YELLOW),
}

# Colour, dashes and marker of curves that differ in the value of a parameter only.
CURVES = [
    (BLUE, "-", "o"),
    (VERMILION, (0, (5, 2)), "s"),
    (GREEN, (0, (5, 1.5, 1, 1.5)), "^"),
    (PURPLE, (0, (1, 1.2)), "D"),
    (BLACK, (0, (8, 2)), "v"),
]


# Mathtext (matplotlib's version of TeX) of symbols that `tex` cannot translate.
MATHTEXT = {"rm": "r_m", "W": r"\Omega"}


def style(*changes):
    """Return a context manager, also a decorator, that applies the common style with changes."""
    return matplotlib.style.context(["default", STYLE, *changes])


def figure(column, height) -> Figure:
    """Return an empty figure, `height` inches high, with the width of "single" or "double" columns.

    Raises
    ------
    ValueError
        If `column` is another word.
    """
    if column not in COLUMNS:
        raise ValueError(f"column = {column!r}: must be one of {', '.join(COLUMNS)}")
    return Figure(figsize=(COLUMNS[column], height), layout="constrained")


def curve(index) -> dict:
    """Return keywords of `plot` for the line of the curve `index` in `CURVES`, counted from 0."""
    color, dashes, _ = CURVES[index]
    return {"color": color, "linestyle": dashes}


def points(index) -> dict:
    """Return keywords of `plot` for the open markers that go with the line of curve `index`."""
    color, _, marker = CURVES[index]
    return {"color": color, "linestyle": "none", "marker": marker, "markerfacecolor": "none"}


def once(axes, label):
    """Return a label, or None if an artist of the axes has it: `axes.legend()` lists it once."""
    return None if label in axes.get_legend_handles_labels()[1] else label


def draw(axes, x, y, *, label=None, **look) -> None:
    """Plot a line, without its label if the axes have it already."""
    axes.plot(x, y, label=once(axes, label), **look)


def parameter_label(parameters, *names, separator=", ") -> str:
    """Return symbols and values of parameters as text, such as "$r_m = 0.12$, $e = 1$"."""
    symbols = [SYMBOLS[name] for name in names]
    return separator.join(
        f"${MATHTEXT.get(symbol, tex(symbol))} = {parameters[name]:g}$"
        for name, symbol in zip(names, symbols, strict=True)
    )


def axis_label(variable, words=None) -> str:
    """Return an axis label: description, symbol, units, such as "Forcing frequency, $\\Omega$".

    `variable` is a DataArray with the attributes of the registry; `words` replace its description.
    """
    words, units = words or variable.attrs["long_name"], variable.attrs["units"]
    label = words[0].upper() + words[1:]
    if "symbol" in variable.attrs:
        label += f", ${tex(variable.attrs['symbol'])}$"
    return label if units == "1" else f"{label} ({units})"


def tex(symbol) -> str:
    """Return the mathtext of a symbol: words become commands, digits become indices.

    "Omega_p" becomes "\\Omega _p", and "max |Z1|" becomes "\\max\\,|Z_{1}|".
    """
    symbol = re.sub(r"[A-Za-z]{2,}", r"\\\g<0> ", symbol)
    symbol = re.sub(r"([A-Za-z])(\d+)", r"\1_{\2}", symbol)
    return symbol.replace("  |", r"\,|")


def forcing_period(data) -> float:
    """Return the period of the forcing in the unit of the times of a dataset."""
    scale = json.loads(data.attrs.get("scales", '{"time": 1}'))["time"]
    return 2 * math.pi / parameters_of(data)["frequency"] * scale


def letter_panels(panels) -> None:
    """Label the axes (a), (b), ... at their upper left corners, outside the frame."""
    for letter, axes in zip(string.ascii_lowercase, panels, strict=False):
        axes.set_title(f"({letter})", loc="left")


def legend(figure, columns, order=(), place=None) -> None:
    """Add one legend that lists each label once, the labels in `order` first.

    The legend stands below all axes, or in the empty axes `place`.
    """
    entries = {}
    for axes in figure.axes:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            entries.setdefault(label, handle)
    first = [label for label in order if label in entries]
    entries = {label: entries[label] for label in [*first, *entries]}
    if place is not None:
        place.set_axis_off()
        place.legend(entries.values(), entries.keys(), loc="center", ncols=columns)
    elif entries:
        figure.legend(entries.values(), entries.keys(), loc="outside lower center", ncols=columns)


def save_figure(figure, path) -> None:
    """Write `path`.pdf and `path`.png, each complete or not at all, reproducible to the byte.

    The layout is computed once and then fixed, so that both files show the same picture. The layout
    engine is removed rather than set to "none": with "none" matplotlib draws twice for each file.
    """
    with style():
        if figure.get_layout_engine() is not None:
            figure.get_layout_engine().execute(figure)
        figure.set_layout_engine(None)
        for kind, metadata in {"pdf": {"CreationDate": None}, "png": {"Software": None}}.items():
            with whole(f"{path}.{kind}") as part:
                figure.savefig(part, format=kind, metadata=metadata)

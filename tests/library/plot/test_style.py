"""The common style: labels from the registry, distinct roles, complete files."""

from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from matplotlib.colors import to_rgb
from matplotlib.mathtext import MathTextParser

from impact_damper.data.datasets import variable
from impact_damper.data.variables import VARIABLES
from impact_damper.plot.style import (
    COLUMNS,
    ROLES,
    axis_label,
    figure,
    legend,
    letter_panels,
    save_figure,
    style,
    tex,
)


@pytest.mark.parametrize(
    "symbol, expected",
    [("Omega", r"\Omega "), ("Z1'", "Z_{1}'"), ("max |Z1|", r"\max\,|Z_{1}|"), ("r_m", "r_m")],
)
def test_symbols_become_mathtext(symbol, expected):
    assert tex(symbol) == expected


@pytest.mark.parametrize("name", [name for name, entry in VARIABLES.items() if entry.symbol])
def test_every_registered_symbol_can_be_drawn(name):
    MathTextParser("path").parse(f"${tex(VARIABLES[name].symbol)}$")


def test_axis_label_reads_words_symbol_and_units():
    assert axis_label(xr.DataArray(variable("frequency", [1.0]))) == (
        r"Forcing frequency, $\Omega $"
    )
    plain = xr.DataArray(0.0, attrs={"long_name": "time on", "units": "cycle"})
    assert axis_label(plain) == "Time on (cycle)"


def test_roles_that_must_differ_in_print_do():
    roles = ["free_stable", "free_unstable", "chaotic", "unresolved"]
    for one, other in combinations([ROLES[name] for name in roles], 2):
        assert any(one.get(key) != other.get(key) for key in ("linestyle", "marker"))
    seen = [
        (
            to_rgb(role["color"]),
            role.get("linestyle"),
            role.get("marker"),
            role.get("markerfacecolor"),
        )
        for role in ROLES.values()
        if "color" in role
    ]
    assert len(set(seen)) == len(seen)


@style()
def panels():
    drawn = figure("double", 2.5)
    pair = drawn.subplots(1, 2, sharey=True)
    x = np.linspace(0, 1, 20)
    for axes in pair:
        axes.plot(x, x**2, **ROLES["free_stable"])
        axes.plot(x, x, **ROLES["period_1"])
        axes.axvspan(0.4, 0.6, **ROLES["band"])
    letter_panels(pair)
    legend(drawn, 3)
    return drawn


def test_saved_twice_the_bytes_and_the_width_are_the_same(tmp_path):
    drawn = panels()
    for name in ("one", "two"):
        save_figure(drawn, tmp_path / name)
    save_figure(panels(), tmp_path / "three")
    for kind in ("pdf", "png"):
        one, *others = (
            Path(tmp_path / f"{n}.{kind}").read_bytes() for n in ("one", "two", "three")
        )
        assert others == [one, one]
    width = f"{COLUMNS['double'] * 72:g}".encode()
    assert b"/MediaBox [ 0 0 " + width in (tmp_path / "one.pdf").read_bytes()


def test_a_failed_save_leaves_nothing(tmp_path):
    drawn = panels()
    drawn.axes[0].set_xlabel(r"$\nosuchsymbol$")
    with pytest.raises(ValueError):
        save_figure(drawn, tmp_path / "broken")
    assert not list(tmp_path.iterdir())

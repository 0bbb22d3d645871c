"""The common style: labels from the registry, distinct roles, complete files."""

import pytest
import xarray as xr
from matplotlib.mathtext import MathTextParser

from impact_damper.data.datasets import variable
from impact_damper.data.variables import VARIABLES
from impact_damper.plot import style


@pytest.mark.parametrize(
    "symbol, expected",
    [("Omega", r"\Omega "), ("Z1'", "Z_{1}'"), ("max |Z1|", r"\max\,|Z_{1}|"), ("r_m", "r_m")],
)
def test_symbols_become_mathtext(symbol, expected):
    assert style.tex(symbol) == expected


@pytest.mark.parametrize("name", [name for name, entry in VARIABLES.items() if entry.symbol])
def test_every_registered_symbol_can_be_drawn(name):
    MathTextParser("path").parse(f"${style.tex(VARIABLES[name].symbol)}$")


def test_axis_label_reads_words_symbol_and_units():
    assert style.axis_label(xr.DataArray(variable("frequency", [1.0]))) == (
        r"Forcing frequency, $\Omega $"
    )
    plain = xr.DataArray(0.0, attrs={"long_name": "time on", "units": "cycle"})
    assert style.axis_label(plain) == "Time on (cycle)"


@style.context()
def test_saved_twice_the_bytes_and_the_width_are_the_same(tmp_path):
    drawn = style.figure("double", 2.5)
    drawn.subplots().plot([0, 1], [0, 1], **style.ROLES["free_stable"])
    for name in ("one", "two"):
        style.save_figure(drawn, tmp_path / name)
    for kind in ("pdf", "png"):
        one, two = ((tmp_path / f"{name}.{kind}").read_bytes() for name in ("one", "two"))
        assert one == two
    width = f"{style.COLUMNS['double'] * 72:g}".encode()
    assert b"/MediaBox [ 0 0 " + width in (tmp_path / "one.pdf").read_bytes()


def test_a_failed_save_leaves_nothing(tmp_path):
    drawn = style.figure("double", 2.5)
    drawn.subplots().set_xlabel(r"$\nosuchsymbol$")
    with pytest.raises(ValueError):
        style.save_figure(drawn, tmp_path / "broken")
    assert not list(tmp_path.iterdir())

"""Transients without and with the damper: swept sine up and down, and unforced decay."""

from impact_damper.data.datasets import parameters_of
from impact_damper.plot.machine_figures.looks import BARE, DAMPED, decades, limit_line
from impact_damper.plot.style import PALE, figure, legend, style

CAPTION = """
Largest displacement in each cycle. Above and middle: the forcing frequency is swept up and down at
a constant rate through the band and the resonance, from rest, with the loose mass in the middle of
its gap. Shaded: outside the band. Below: unforced decay from a displacement of the machine at rest.
The damper has no effect until a wall has touched the loose mass. In the sweeps this needs a
displacement of half the gap. In the decay the loose mass rests in the middle of the gap of the
displaced machine. The machine then swings from one side to the other, so that an initial
displacement of a quarter of the gap is enough. A late step in the decay is an impact of the loose
mass, which keeps its speed between impacts.
"""
LOOKS = {"bare": BARE, "damped": DAMPED}


@style()
def draw_transients(data):
    """Return the figure of the dataset of `stages.machines.design_damper`."""
    drawn = figure("single", 5.6)
    panels = drawn.subplots(3)
    for axes, direction in zip(panels, ("up", "down"), strict=False):
        swept = data.sel(direction=direction)
        for equipment, look in LOOKS.items():
            size = swept["sweep_envelope"].sel(equipment=equipment)
            axes.plot(swept["sweep_frequency"], size, **look | {"linewidth": 0.8})
        limit_line(axes, data)
        _shade(axes, data)
        axes.set(xlabel=f"Forcing frequency, swept {direction} (Hz)")
        if direction == "down":
            axes.invert_xaxis()
    for equipment, look in LOOKS.items():
        rung = data.sel(equipment=equipment)
        panels[2].plot(rung["ring_time"], rung["ring_envelope"], **look)
    panels[2].set(xlabel="Time of the unforced decay (s)")
    panels[2].set_ylim(bottom=0.5 * float(data["ring_envelope"].sel(equipment="bare").min()))
    for axes in panels:
        axes.set_ylabel("Displacement (mm)")
        decades(axes)
    legend(drawn, 2)
    return drawn


def _shade(axes, data):
    """Shade the frequencies of a sweep that lie outside the band."""
    swept, band = data["sweep_frequency"].values, parameters_of(data)["band"]
    for low, high in ((swept.min(), band[0]), (band[1], swept.max())):
        if low < high:
            axes.axvspan(low, high, facecolor=PALE, linewidth=0, zorder=0)

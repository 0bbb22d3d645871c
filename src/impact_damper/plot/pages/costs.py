"""Section of a page: forces, losses and noise of the damper."""

import numpy as np

from impact_damper.data.datasets import flag
from impact_damper.plot.pages.blocks import Numbers, Section, Words, shown

# Variable of the dataset, description, unit.
COSTS = (
    ("impact_rate_by_frequency", "impacts", "per second"),
    ("contact_force_by_frequency", "largest force in a contact", "N"),
    ("penetration_by_frequency", "largest penetration of a wall", "mm"),
    ("impact_speed_by_frequency", "largest relative speed of an impact", "m/s"),
    ("impact_loss_by_frequency", "mean energy lost in an impact", "J"),
    ("impact_power_by_frequency", "mean power lost in impacts, which becomes heat", "W"),
    ("noise_by_frequency", "noise: sum of the squared impulses, per time", "N² s"),
)
HEAD = (
    "The numbers hold for the largest motion to which starts lead at each frequency; the largest "
    "value over the band is shown. The noise is only an indicator. It assumes that the sound "
    "energy of an impact grows with the square of its impulse."
)
YIELDS = {
    "no": "No: the walls and the loose mass stay elastic.",
    "yes": "Yes: the contact yields. Choose a larger radius or a harder material.",
    "unknown": "Not known: no yield strength was given.",
}


def section(data) -> Section:
    """Return the section for the dataset of `stages.machines.design_damper`."""
    frequency = data["frequency"].values
    rows = [_row(data, frequency, *each) for each in COSTS]
    pressure = data["pressure_by_frequency"].values
    if np.isfinite(pressure).any():
        rows.append(
            _row(
                data,
                frequency,
                "pressure_by_frequency",
                "largest pressure after Hertz",
                "MPa",
                scale=1e-6,
            )
        )
        yields = data["yields_by_frequency"].values
        known = ("yes", "unknown", "no")
        word = next(each for each in known if flag("yields_by_frequency", each) in yields)
        rows.append(("does the contact yield?", YIELDS[word], "yields_by_frequency"))
    else:
        words = "not computed: no materials were given"
        rows.append(("pressure in the contact", words, "pressure_by_frequency"))
    return Section("What it costs", [Words(HEAD), Numbers(rows)])


def _row(data, frequency, name, words, unit, scale=1.0):
    """Return the row of the largest value of a variable over the band; `scale` converts units."""
    values = scale * data[name].values
    if not np.isfinite(values).any():
        return words, "none found", name
    k = int(np.nanargmax(values))
    return words, f"{shown(values[k], unit)} at {shown(frequency[k], 'Hz', 4)}", name

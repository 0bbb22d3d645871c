"""Plot of a design for migration: share of releases that succeed, over frequency and gap."""

import numpy as np
from matplotlib.colors import Normalize

from impact_damper.plot import style
from impact_damper.plot.maps import mesh


@style.context()
def migration_map(data):
    """Return the figure of a result of `design.migration.migration`."""
    drawn = style.figure("single", 3.2)
    axes = drawn.subplots()
    frequencies, gaps = data["released_frequency"].values, data["released_gap"].values
    shares = 100 * data["migration_share"].values
    cells = mesh(axes, frequencies, gaps, shares, Normalize(0, 100), "one motion without damper")
    drawn.colorbar(cells, label="Releases that succeed (%)")
    sure = np.array(data["migration_status"] == 1)
    places = np.argwhere(sure)
    look = {"color": style.BLACK, "marker": "o", "markersize": 3, "linestyle": "", "mfc": "white"}
    label = f"sure ({100 * float(data['migration_required']):g} % at 95 %)"
    axes.plot(frequencies[places[:, 1]], gaps[places[:, 0]], label=label, **look)
    axes.set(xlabel="Forcing frequency (Hz)", ylabel="Gap, full play (mm)", yscale="log")
    style.legend(drawn, 1)
    return drawn

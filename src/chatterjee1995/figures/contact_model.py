"""Figure of the errors of the contact model over restitution and load of a contact."""

import numpy as np
from matplotlib.colors import ListedColormap, LogNorm
from matplotlib.ticker import FuncFormatter

from chatterjee1995.figures.rigid_limit import contours
from impact_damper.data.datasets import decode
from impact_damper.plot import style
from impact_damper.plot.maps import mesh

RULES = {"zero_penetration": "exit at zero penetration", "no_tension": "exit without pull"}
LEVELS = 0.01, 0.05  # errors with a contour line
LINEAR = 1e-3  # the load axis is linear below this value and logarithmic above
# Two motions are simulated for each restitution and frequency. First marker: contacts in the
# settled motion with the least max |Z1|. Second: contacts in the motion with the largest max |Z1|.
MOTIONS = (
    {"color": style.BLACK, "marker": "o", "markersize": 2.6, "markerfacecolor": "none"},
    {"color": style.VERMILION, "marker": "_", "markersize": 5.0, "markeredgewidth": 0.5},
)


@style.context()
def draw_contact_model(*, contact_model):
    """Draw two maps of the error of the restitution, one for each rule that ends a contact."""
    drawn = style.figure("double", 4.0)
    panels = drawn.subplots(1, 2, sharex=True, sharey=True)
    data = contact_model[0]
    x, y = data["restitution"].values, data["load"].values
    norm = LogNorm(1e-3, 1)
    for axes, (rule, words) in zip(panels, RULES.items(), strict=True):
        cell = data.sel(exit_rule=rule)
        error = np.abs(cell["realised_restitution"].values / x - 1)
        shown = np.maximum(error, norm.vmin)
        cells = mesh(axes, x, y, shown, norm, "the contact does not end")
        contours(axes, x, y, error, LEVELS)
        back = decode(cell["contact_verdict"]).values == "falls_back"
        colour = {"cmap": ListedColormap([style.PALE_ORANGE]), "shading": "nearest"}
        axes.pcolormesh(x, y, np.ma.masked_where(~back, back), rasterized=True, **colour)
        look = {"facecolor": style.PALE_ORANGE, "edgecolor": style.GREY}
        axes.fill([], [], label="the loose mass falls back", **look)
        axes.set_yscale("symlog", linthresh=LINEAR)
        axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axes.set_title(words)
        axes.set_xlabel(style.axis_label(data["restitution"]))
    label = "|realised $e$ / intended $e$ $-$ 1|"
    drawn.colorbar(cells, ax=panels, label=label, extend="both")
    for case in contact_model:
        _draw_contacts(panels[0], case)
    panels[0].set_ylabel(r"Load in contact, $g/(\omega_n v_0)$")
    style.letter_panels(panels)
    style.legend(drawn, 3)
    return drawn


def _draw_contacts(axes, data):
    used = data["used"].values[data["contact_used"].values]
    load, size = data["contact_load"].values, data["contact_size"].values
    for place in reversed(range(len(MOTIONS))):
        chosen, words = size == place, data["size"].values[place]
        label = f"contacts of the {words} simulated motions"
        axes.plot(used[chosen], load[chosen], linestyle="none", label=label, **MOTIONS[place])

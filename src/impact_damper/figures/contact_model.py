"""Accuracy of the contact model against restitution and load (figure kind `contact_model`).

The load on a contact is the acceleration by all other forces; CAPTION defines it.
"""

import numpy as np
from matplotlib.colors import LogNorm, Normalize
from matplotlib.ticker import FuncFormatter

from impact_damper.data.datasets import flag
from impact_damper.figures.maps import contours, key, marked, mesh
from impact_damper.figures.style import (
    BLACK,
    PALE,
    PALE_ORANGE,
    VERMILION,
    axis_label,
    figure,
    legend,
    letter_panels,
    style,
)

CAPTION = """
Each cell is one contact in closed form, valid for any mass ratio and stiffness. The intended
restitution e sets the dashpot by (25). The load g is the acceleration of the primary mass towards
the wall by all forces but that of the contact, taken as constant; a positive g presses the masses
together. The vertical axis divides g by the natural frequency of the contact and the approach
speed. Left: contact ends at zero penetration, as in appendix B. Right: it ends at zero force, since
a wall cannot pull. (a, b) Relative error of the realised restitution. (c, d) Time in contact
divided by the time for e = 1 and g = 0. Hatched: the contact does not end. Markers in (a): contacts
of motions simulated with the paper's rule, the smallest settled and the largest that random starts
reach at each frequency. The paper only states that the model fails at low e.
"""

RULES = {"zero_penetration": "exit at zero penetration", "no_tension": "exit without pull"}
LINES = {0.01: "solid", 0.05: "dotted"}
TIMES = {0.95: "solid", 1.05: "solid", 0.5: "dotted", 1.5: "dotted"}
# The load axis is linear below this value and logarithmic above.
LINEAR = 1e-3
MOTIONS = (
    {"color": BLACK, "marker": "o", "markersize": 2.6, "markerfacecolor": "none"},
    {"color": VERMILION, "marker": "_", "markersize": 5.0, "markeredgewidth": 0.5},
)


@style()
def draw_contact_model(*, contact_model):
    """Draw the error of the realised restitution and the time in contact, for both exit rules.

    Parameters
    ----------
    contact_model : list of xarray.Dataset
        Datasets of the stage contact_model. Their maps are equal; the contacts of all are drawn.

    Returns
    -------
    matplotlib.figure.Figure
    """
    drawn = figure("double", 6.4)
    panels = drawn.subplots(2, 2, sharex=True, sharey=True)
    data = contact_model[0]
    x, y = data["restitution"].values, data["load"].values
    shapes = LogNorm(1e-3, 1), Normalize(0, 2)
    names = "|realised $e$ / intended $e$ $-$ 1|", axis_label(data["contact_duration"])
    for row, (norm, name) in enumerate(zip(shapes, names, strict=True)):
        for axes, rule in zip(panels[row], RULES, strict=True):
            cell = data.sel(exit_rule=rule)
            time = cell["contact_duration"].values
            error = np.abs(cell["realised_restitution"].values / x - 1)
            cells = mesh(axes, x, y, time if row else np.maximum(error, norm.vmin), norm)
            for level, line in (TIMES if row else LINES).items():
                contours(axes, x, y, time if row else error, level, line)
            back = cell["contact_verdict"].values == flag("contact_verdict", "falls_back")
            if not row:
                marked(axes, x, y, back, PALE_ORANGE)
            axes.set_yscale("symlog", linthresh=LINEAR)
            axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        drawn.colorbar(cells, ax=panels[row], label=name, extend="both" if row == 0 else "max")
    for axes, words in zip(panels[0], RULES.values(), strict=True):
        axes.set_title(words)
    for case in contact_model:
        draw_contacts(panels[0, 0], case)
    for axes, lines, words in (
        (panels[0, 0], LINES, "error of 1 % (solid) and 5 % (dotted)"),
        (panels[1, 0], TIMES, "time off by 5 % (solid) and 50 % (dotted)"),
    ):
        axes.plot([], [], color=BLACK, linestyle=next(iter(lines.values())), label=words)
    key(panels[0, 0], "the contact does not end", PALE, "////")
    key(panels[0, 0], "the loose mass falls back", PALE_ORANGE)
    for axes in panels[1]:
        axes.set_xlabel(axis_label(data["restitution"]))
    for axes in panels[:, 0]:
        axes.set_ylabel(r"Load in contact, $g/(\omega_n v_0)$")
    letter_panels(panels.ravel())
    legend(drawn, 2)
    return drawn


def draw_contacts(axes, data):
    """Draw the contacts of the simulated motions, at the restitution of their damper."""
    used = data["used"].values[data["contact_used"].values]
    size = data["contact_size"].values
    load = data["contact_load"].values
    for place in reversed(range(len(MOTIONS))):
        chosen = size == place
        axes.plot(
            used[chosen],
            load[chosen],
            linestyle="none",
            label=f"contacts of the {data['size'].values[place]} simulated motions",
            **MOTIONS[place],
        )

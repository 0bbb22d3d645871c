"""Migration disturbed by noise, delay and a wrong model (figure kind `release_disturbances`).

Migration takes the oscillator from its resonance to its small motion (success) by switching the
damper on and, at the release, off. The policy by state releases when the measured state lies in the
basin of the small motion without damper, at least a margin away from the boundary. A trial
begins with the resonance motion, and the damper is switched on at a random phase.
"""

from chatterjee1995.figures.release_policies import case_label, draw_bounded
from impact_damper.plot.panels.style import CURVES, GREY, PALE, curve, figure, letter_panels, style

CAPTION = """
Margin: least distance of a release from the basin's boundary. Unit of margin and noise: size of
the resonance motion. Above, at the lower W: share within 350 cycles. Below, at the higher W: median
cycles. h, force: assumed by controller. Bars: 95 % intervals. Dotted, grey: bound. Other
disturbances: `release_disturbances.csv`.
"""

# Disturbances that are drawn, with their labels; the table holds further disturbances.
WORDS = {
    "none": "none",
    "noise 10 %": "noise of 10 %",
    "delay 1/4": "1/4 period late",
    "h -5 %, force +1 %": "h 5 % too low, force 1 % too high",
    "noise 3 %, delay 1/8, h +5 %, force -1 %": "noise of 3 %, 1/8 period late, wrong h and force",
}
ASIDE = 0.0012  # distance in margin between the curves, so that their intervals do not overlap
THIN = {"elinewidth": 0.5}  # look of the intervals


@style({"axes.titley": None})
def draw_release_disturbances(*, release_policies):
    """Draw success (above) and cycles (below) against the margin for each disturbance and damper.

    Parameters
    ----------
    release_policies : list of xarray.Dataset
        One dataset of the stage release_policies.

    Returns
    -------
    matplotlib.figure.Figure
    """
    (data,) = release_policies
    drawn = figure("double", 5.4)
    panels = drawn.subplots(2, data.sizes["case"], sharex=True, sharey="row", squeeze=False)
    frequencies = data["noisy_frequency"].values
    for row, (quantity, frequency) in enumerate(
        [("success", frequencies.min()), ("cycles", frequencies.max())]
    ):
        for case, axes in enumerate(panels[row]):
            one = data.isel(case=case).sel(noisy_frequency=frequency)
            axes.set_title(rf"$\Omega = {frequency:g}$, {case_label(one)}", fontsize=7, loc="right")
            bound = one[f"policy_{quantity}"].sel(policy="clairvoyant", frequency=frequency)
            draw_disturbances(axes, one[f"disturbed_{quantity}"], bound)
    panels[0, 0].set(ylabel="Share within 350 cycles", ylim=(-0.05, 1.05))
    panels[1, 0].set(ylabel="Median of the cycles", ylim=(8, 400), yscale="log")
    for axes in panels[-1]:
        axes.set_xlabel("Margin")
    letter_panels(panels.ravel())
    handles, labels = panels[0, 0].get_legend_handles_labels()
    drawn.legend(handles, labels, loc="outside lower center", ncols=3)
    return drawn


def draw_disturbances(axes, values, bound):
    """Draw success or median against the margin for each disturbance, and the bound.

    `bound` belongs to a controller that knows the future, called clairvoyant.
    """
    if "quantile" in bound.dims:
        bound = bound.sel(quantile=0.5)
    share, lower, upper = (float(bound.sel(bound=name)) for name in ("share", "lower", "upper"))
    axes.axhspan(lower, min(upper, 1e3), color=PALE)
    axes.axhline(share, color=GREY, linestyle=":", label="future known")
    for k, (disturbance, words) in enumerate(WORDS.items()):
        look = curve(k) | {"marker": CURVES[k][2], "label": words}
        one = values.sel(disturbance=disturbance).transpose("margin", "bound").values
        draw_bounded(axes, values["margin"].values + ASIDE * (k - 2), one, look | THIN)

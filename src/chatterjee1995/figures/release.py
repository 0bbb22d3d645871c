"""States at which the damper is switched off (releases), by destination (paper: figure 14).

Figure kind `release`. The destination is the motion on which the free oscillator then settles.
"""

from impact_damper.data.datasets import flag
from impact_damper.plot.panels.style import ROLES, axis_label, figure, legend, letter_panels, style

CAPTION = """
States of the primary mass at which the damper is switched off; a marker shows the motion on which
the free oscillator then settles. Panels: releases before the motion with damper has settled, then
from each settled motion. The scales of the panels differ.
"""

# Role (key of `style.ROLES`) of each destination, and panel title of each motion with damper.
DESTINATIONS = {
    "non_resonance": "non_resonance",
    "subharmonic": "subharmonic",
    "resonance": "resonance",
    "other": "other",
    "unresolved": "lost",
}
MOTIONS = {
    "unsettled": "before it has settled",
    "quiet": "quiet motion",
    "violent": "violent motion",
    "subharmonic": "subharmonic motion",
}


@style()
def draw_release(*, migration):
    """Draw the states at which the damper is switched off, with a marker for each destination.

    Parameters
    ----------
    migration : list of xarray.Dataset
        Datasets of the stage migration.

    Returns
    -------
    matplotlib.figure.Figure
    """
    sources = [(runs, row) for runs in migration for row in range(runs.sizes["damped"])]
    columns = 3 if len(sources) % 3 == 0 else 2
    rows = -(-len(sources) // columns)
    drawn = figure("double", 0.6 + 2.6 * rows)
    panels = drawn.subplots(rows, columns, squeeze=False).ravel()
    for axes, (runs, row) in zip(panels, sources, strict=False):
        draw_releases(axes, runs.isel(damped=row))
    for axes in panels[len(sources) :]:
        axes.remove()
    # of three panels in a row only the middle one has a label: three labels would overlap
    for axes in panels[1::3] if columns == 3 else panels[: len(sources)]:
        axes.set_xlabel(axis_label(migration[0]["release_displacement"]))
    drawn.supylabel(axis_label(migration[0]["release_velocity"]), fontsize="medium")
    letter_panels(panels[: len(sources)])
    legend(drawn, 3)
    return drawn


def draw_releases(axes, releases):
    """Draw the releases from one motion with damper."""
    for destination, role in DESTINATIONS.items():
        value = flag("release_destination", destination)
        chosen = releases["release_destination"].values == value
        if chosen.any():
            axes.plot(
                releases["release_displacement"].values[chosen],
                releases["release_velocity"].values[chosen],
                **ROLES[role],
            )
    (words,) = (
        words
        for kind, words in MOTIONS.items()
        if releases["damped_kind"] == flag("damped_kind", kind)
    )
    axes.set_title(words)

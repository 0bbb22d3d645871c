"""The plot and the conclusion of a finished design."""

from impact_damper.plot.machine_figures.figures import response_panel, share_panel, size_panel
from impact_damper.plot.sheets import dataset_in, sheet


def design(data, axes=None):
    """Draw a design: the response, and displacement and share of quiet starts against the gap.

    Parameters
    ----------
    data : xarray.Dataset
        A result of `design_damper`.
    axes : sequence of 3 matplotlib.axes.Axes, optional

    Returns
    -------
    list of matplotlib.axes.Axes

    Examples
    --------
    >>> import impact_damper as idm
    >>> machine = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=0.005, force=40)
    >>> found = idm.design_damper(
    ...     machine, mass=1.2, band=(20.4, 20.7), restitution=0.6, contact=2e7
    ... )  # doctest: +SKIP
    >>> axes = idm.plot.design(found)  # doctest: +SKIP
    """
    found = dataset_in(data, lambda each: "design_gap" in each, "design_damper")
    with sheet(axes, 3, height=4.2) as axes:
        for panel, each in zip((response_panel, size_panel, share_panel), axes, strict=True):
            panel(each, found)
        for each in axes[1:]:
            each.set_xlabel("Gap, full play (mm)")
    return axes


def conclusion(data) -> list[str]:
    """Return the conclusion of a design in sentences: what to build, and how sure that is.

    The sentences stand in a template, for which Jinja2 must be installed.

    Parameters
    ----------
    data : xarray.Dataset
        A result of `design_damper`.

    Examples
    --------
    >>> import impact_damper as idm
    >>> machine = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=0.005, force=40)
    >>> found = idm.design_damper(
    ...     machine, mass=1.2, band=(20.4, 20.7), restitution=0.6, contact=2e7
    ... )  # doctest: +SKIP
    >>> sentences = idm.plot.conclusion(found)  # doctest: +SKIP
    """
    found = dataset_in(data, lambda each: "design_gap" in each, "design_damper")
    try:
        from impact_damper.plot.pages.render import conclusion as sentences
    except ModuleNotFoundError as error:
        raise ImportError("the conclusion of a design needs Jinja2: pip install jinja2") from error
    return sentences(found)

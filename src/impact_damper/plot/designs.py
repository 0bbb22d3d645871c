"""The plot and the conclusion of a finished design."""

from impact_damper.plot.machine_figures import frequency_panel, gap_panel
from impact_damper.plot.sheets import dataset_in, sheet

RESULTS = "design_damper or evaluate_damper"


def design(data, axes=None):
    """Draw a design: displacements against the forcing frequency and against the gap.

    Parameters
    ----------
    data : xarray.Dataset
        A result of `design_damper` or `evaluate_damper`.
    axes : sequence of 2 matplotlib.axes.Axes, optional

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
    found = dataset_in(data, _is_design, RESULTS)
    with sheet(axes, 2, columns=4) as axes:
        frequency_panel(axes[0], found)
        gap_panel(axes[1], found)
    return axes


def conclusion(data) -> list[str]:
    """Return the conclusion of a design: four paragraphs, and further ones in special cases.

    The four paragraphs say what to build, how far the machine moves with the damper, how sure the
    promise is, and which change of gap or excitation breaks it first. Jinja2 must be installed.

    Parameters
    ----------
    data : xarray.Dataset
        A result of `design_damper` or `evaluate_damper`.

    Examples
    --------
    >>> import impact_damper as idm
    >>> machine = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=0.005, force=40)
    >>> found = idm.design_damper(
    ...     machine, mass=1.2, band=(20.4, 20.7), restitution=0.6, contact=2e7
    ... )  # doctest: +SKIP
    >>> sentences = idm.plot.conclusion(found)  # doctest: +SKIP
    """
    found = dataset_in(data, _is_design, RESULTS)
    try:
        from impact_damper.plot.pages.render import conclusion as sentences
    except ModuleNotFoundError as error:
        raise ImportError("the conclusion of a design needs Jinja2: pip install jinja2") from error
    return sentences(found)


def _is_design(data):
    return "promised_displacement" in data

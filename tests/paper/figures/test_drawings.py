"""Every figure of data: no warnings, nothing cut off, a legend entry for each kind of mark."""

from functools import cache

import numpy as np
import pytest
from helpers.made_up import matched_sweep, sweep
from helpers.made_up_orbits import branch, branches
from matplotlib.backends.backend_agg import FigureCanvasAgg

from chatterjee1995.figures.clearance import draw_optimum
from chatterjee1995.figures.migration import DESTINATIONS, draw_migration, draw_release
from chatterjee1995.figures.responses import (
    draw_branches,
    draw_free,
    draw_harmonic_balance,
    draw_motion,
    draw_response,
    draw_shares,
)
from impact_damper.data.datasets import dataset, flag
from impact_damper.data.motion_variables import DAMPED_MOTION, FREE_MOTION, OUTCOME
from impact_damper.plot import style
from impact_damper.plot.motions import DAMPER_ON, SWITCHED
from impact_damper.plot.sweeps import NEAR, OPTIMUM

pytestmark = pytest.mark.filterwarnings("error")

FREQUENCY = np.linspace(1.0, 2.0, 11)
DAMPER = {"mass_ratio": 0.12, "clearance": 2.0, "restitution": 1.0, "damping": 0.2}
MOTIONS = [  # outcome, period, contacts
    ("settled", 1, 2.0),
    ("settled", 2, 2.0),
    ("settled", 3, 2.0),
    ("non_colliding", 1, 0.0),
    ("chaotic", 0, 3.0),
    ("unresolved", 0, 1.0),
    ("quasi_periodic", 0, 2.0),
    ("drifting", 1, 0.0),
    ("chaotic", 0, 4.0),
    ("absent", 0, 0.0),
]


def response(**parameters):
    """Return a response with a branch of each kind, at different displacements."""
    outcome, period, contacts = zip(*MOTIONS, strict=True)
    shape = len(FREQUENCY), len(MOTIONS)
    ends = {"end_direction": [1], "end_value": [2.0], "end_displacement": [1.0]}
    data = {
        "outcome": np.broadcast_to([OUTCOME[name] for name in outcome], shape),
        "period": np.broadcast_to(period, shape),
        "contacts": np.broadcast_to(contacts, shape),
        "branch": np.broadcast_to(np.arange(len(MOTIONS)), shape),
        "maximum_displacement": np.arange(len(MOTIONS)) + FREQUENCY[:, None],
        "end_branch": [0],
        # Chaos of the first chaotic motion lasts. The second is a transient: chaos ends in a run.
        "life_ends": np.broadcast_to(np.array(contacts) == 4.0, shape).astype(int),
    }
    return dataset(data | ends, {"frequency": FREQUENCY}, DAMPER | parameters, "made up")


def balance():
    """Return solutions without damper on a curve with two folds, and a suppression band."""
    phase = -np.stack([FREQUENCY - 0.9, 2.3 - FREQUENCY / 2, 1 + FREQUENCY], axis=1)
    stable = [flag("free_stability", name) for name in ("stable", "unstable", "stable")]
    shape = phase.shape
    data = {
        "free_amplitude": 3.0 + phase,
        "free_phase": phase,
        "free_stability": np.broadcast_to(stable, shape),
        "amplitude": np.stack([1.5 - FREQUENCY, FREQUENCY, FREQUENCY], axis=1),
        "kind": np.broadcast_to([1, 1, 2], shape),
        "stability": np.broadcast_to([1, -1, 1], shape),
        "band_status": flag("band_status", "found"),
        "edge_frequency": np.array([1.4, 1.6]),
    }
    return dataset(data, {"frequency": FREQUENCY}, DAMPER, "made up")


def motion():
    time = np.linspace(0, 2 * np.pi, 201)
    data = {
        "displacement": np.sin(time),
        "velocity": np.cos(time),
        "contact_wall": [1, -1],
        "contact_begin": [1.0, 4.0],
        "contact_end": [1.5, np.nan],
    }
    return dataset(data, {"time": time}, DAMPER, "made up")


def migration():
    """Return runs with one and two switchings, and releases to each motion without damper."""
    time = np.linspace(-30, 300, 2000)
    kinds = [value for value in DAMPED_MOTION.values() if value >= 0]
    destinations = list(FREE_MOTION.values())
    phase = np.linspace(0, 6, len(destinations))
    shape = len(kinds), len(destinations)
    data = {
        "displacement": np.cos(2 * time),
        "on_time": np.array([[0.0, np.nan], [0.0, 120.0]]),
        "off_time": np.array([[50.0, np.nan], [60.0, 180.0]]),
        "example": 1,
        "damped_kind": kinds,
        "release_displacement": np.broadcast_to(np.cos(phase), shape),
        "release_velocity": np.broadcast_to(np.sin(phase), shape),
        "release_destination": np.broadcast_to(destinations, shape),
    }
    return dataset(data, {"time": time}, DAMPER | {"frequency": 2.0}, "made up")


def orbits(**parameters):
    """Return branches of periods 1, 2 and 3 at different heights, each stable up to a fold."""
    value, stable = np.append(FREQUENCY, FREQUENCY[::-1]), np.repeat([True, False], len(FREQUENCY))
    parts = [branch(value, value + n + 0.5 * ~stable, stable=stable, period=n) for n in (1, 2, 3)]
    made = DAMPER | {"parameter": "frequency"} | parameters
    return branches(*parts, folds=[(0, 2.0, 3.0), (2, 1.5, 2.5)], parameters=made)


FREE = orbits().assign_attrs(parameters='{"damping": 0.2, "parameter": "frequency"}')
DAMPED = {"branches": [orbits(), FREE]}
STATUSES = ["period_1", "higher_period", "subharmonic_damped", "chaotic", "non_colliding"]
STATUSES += ["chaotic_transient", "quasi_periodic", "unresolved"]
FREE_ROLES = ["free_stable", "free_unstable", "subharmonic_free", "free_higher"]
FREE_ROLES += ["subharmonic_unstable"]
BALANCE_ROLES = ["harmonic_balance", "band"]
DRAWINGS = {
    "free": (lambda: draw_free(branches=[FREE, FREE]), FREE_ROLES),
    "harmonic_balance": (
        lambda: draw_harmonic_balance(harmonic_balance=[balance(), balance()]),
        ["free_stable", "free_unstable", *BALANCE_ROLES],
    ),
    "response": (
        lambda: draw_response(
            response=[response()], harmonic_balance=[balance()], subharmonic=[response()], **DAMPED
        ),
        FREE_ROLES + BALANCE_ROLES + STATUSES + ["unstable_orbit"],
    ),
    "branches": (lambda: draw_branches(**DAMPED), []),
    "shares": (lambda: draw_shares(response=[matched_sweep(), matched_sweep()]), []),
    "motion": (lambda: draw_motion(motion=[motion()]), []),
    "optimum": (
        lambda: draw_optimum(optimum=[sweep(0.215, 0.12), sweep(0.215, 0.18)]),
        [OPTIMUM, NEAR],
    ),
    "migration": (lambda: draw_migration(migration=[migration()]), [DAMPER_ON, *SWITCHED.values()]),
    "release": (lambda: draw_release(migration=[migration()]), [*DESTINATIONS.values()]),
}


@cache
def drawn_once(name):
    """Return the figure `name`. A figure is drawn only once, so tests must not change figures."""
    drawn = DRAWINGS[name][0]()
    FigureCanvasAgg(drawn).draw()
    return drawn


@pytest.fixture(params=DRAWINGS)
def drawing(request):
    _, roles = DRAWINGS[request.param]
    with style.context():
        looks = [style.ROLES[role] if isinstance(role, str) else role for role in roles]
        yield drawn_once(request.param), {look["label"] for look in looks}


def words(drawn):
    (legend,) = drawn.legends
    return [text.get_text() for text in legend.get_texts()]


def test_legend_names_all_that_is_drawn_once(drawing):
    drawn, expected = drawing
    assert expected <= set(words(drawn))
    assert len(set(words(drawn))) == len(words(drawn))


def test_all_lies_on_the_sheet_and_the_legend_beside_the_axes(drawing):
    drawn, _ = drawing
    box = drawn.get_tightbbox()
    assert min(box.x0, box.y0) >= 0
    assert box.x1 <= drawn.get_figwidth() and box.y1 <= drawn.get_figheight()
    (legend,) = drawn.legends
    for axes in drawn.axes:
        assert not legend.get_window_extent().overlaps(axes.get_tightbbox())


def test_axes_are_labelled_and_the_drawing_is_as_wide_as_a_column(drawing):
    drawn, _ = drawing
    assert drawn.get_figwidth() in style.COLUMNS.values()
    assert any(axes.get_xlabel() for axes in drawn.axes)
    assert drawn.get_supylabel() or any(axes.get_ylabel() for axes in drawn.axes)


def looks(drawn, labels):
    """Return by label the looks of each line without its colour."""
    return {
        line.get_label(): (
            line.get_linestyle(),
            str(line._unscaled_dash_pattern[1]),
            line.get_marker(),
            line.get_markerfacecolor() == "none",
            line.get_linewidth() > 2,
        )
        for line in drawn.axes[0].lines
        if line.get_label() in labels
    }


def test_what_differs_in_colour_differs_in_grey_too():
    draw, roles = DRAWINGS["response"]
    labels = {style.ROLES[role]["label"] for role in roles if role != "band"}
    found = looks(draw(), labels)
    assert set(found) == labels
    assert len(set(found.values())) == len(found)


def test_the_stored_run_is_drawn_with_its_own_switchings():
    whole, part = draw_migration(migration=[migration()]).axes
    assert [patch.get_x() for patch in whole.patches] == [0, 120]
    assert part.get_xlim()[0] < 180 < part.get_xlim()[1]

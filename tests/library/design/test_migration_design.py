"""Migration as a design: releases against single runs, and bounds against new releases."""

import numpy as np
import pytest
from helpers.design_tasks import task

import impact_damper as idm
from impact_damper.data.datasets import decode
from impact_damper.design.migration import migration, release_time
from impact_damper.model.settling import Settling
from impact_damper.motions.migration import release_case

MACHINE = idm.Machine(
    mass=20, linear_stiffness=1.5e5, cubic_stiffness=8e8, damping_ratio=0.02, force=60
)
DAMPER = {"mass": 1.2, "restitution": 0.8, "contact": 1e7}
EFFORT = idm.Effort(frequencies=3, candidates=4, starts=59)


@pytest.fixture(scope="module")
def found():
    return migration(MACHINE, **DAMPER, band=(15, 17), gaps=["1 mm", "4 mm"], effort=EFFORT)


def releases(machine, damper, hertz, count):
    """Return the times, s, of releases with seeds that the design does not use."""
    scales, frequency = machine.scales, machine.scales.from_si(hertz, "frequency")
    made = machine.oscillator(), damper.scaled(scales), frequency
    case, stop = release_case(*made, Settling()), np.zeros(1, bool)
    return [release_time(case, 7 + k, 500, Settling(), stop) / hertz for k in range(count)]


def test_there_is_nothing_to_migrate_to_where_the_machine_has_one_motion(found):
    """A frequency has two periodic motions if the response without damper has two sizes."""
    frequencies = found["released_frequency"].values
    sizes = idm.frequency_response(MACHINE, None, frequencies, starts=8)["maximum_displacement"]
    two = np.isfinite(sizes.values).sum(axis=1) == 2
    status = decode(found["migration_status"]).values
    np.testing.assert_array_equal(status != "one_motion", [two, two])
    linear = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=0.005, force=40)
    with pytest.raises(ValueError, match="one motion at each frequency"):
        migration(linear, **DAMPER, band=(20, 21), effort=EFFORT)


def test_new_releases_keep_the_bound_of_the_time(found):
    """The largest of 59 times bounds 95 % of all times; at most 9 of 60 new times exceed it."""
    two = decode(found["migration_status"]).values[1] == "sure"
    hertz = float(found["released_frequency"][np.argmax(two)])
    damper = MACHINE.damper(mass=1.2, gap=4e-3, restitution=0.8, contact_stiffness=1e7)
    new = np.array(releases(MACHINE, damper, hertz, 60))
    bound, typical = (
        float(found[name][1, np.argmax(two)]) for name in ("migration_bound", "migration_time")
    )
    assert np.isfinite(new).all() and np.sum(new > bound) <= 9
    assert np.median(new) == pytest.approx(typical, rel=0.2)
    assert found["sure_frequency"][1] == hertz and found["migration_gap"] in (1, 4)


def test_a_release_is_the_first_switching_of_a_run():
    """`release_time` equals the total time of a run of `migrate` with one switching."""
    hertz, damper = 15.4, MACHINE.damper(mass=1.2, gap=4e-3, restitution=0.8, contact_stiffness=1e7)
    for k, time in enumerate(releases(MACHINE, damper, hertz, 3)):
        run = idm.migrate(MACHINE, damper, hertz, seed=7 + k, switchings=1)
        assert decode(run["trial_outcome"]).item() == "reached"
        assert float(run["total_time"]) / hertz == pytest.approx(time, rel=1e-9)


def test_migration_is_offered_where_a_second_motion_exists():
    assert task().migration_offer == "no"
    assert task(machine=MACHINE, band=(15, 17), mass=1.2, frequencies=9).migration_offer == "yes"

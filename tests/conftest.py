"""Fixtures for tests in several rooms: known periodic orbits."""

import gc

import pytest
from helpers.known_orbits import IMPACTING, STARTS, polished_orbit
from hypothesis import HealthCheck, settings

settings.register_profile(
    "same", derandomize=True, deadline=None, database=None, suppress_health_check=list(HealthCheck)
)
settings.load_profile("same")

# Collecting the tests makes many objects and keeps them all. Searching for garbage less often saves
# a tenth of the time.
gc.set_threshold(100_000)


def pytest_collection_modifyitems(items):
    """Run first the files that start Snakemake.

    These files take longest: begun last, they would leave cores idle at the end.
    """
    items.sort(key=lambda item: "workflow" not in item.path.parts)


@pytest.fixture(scope="session", params=list(STARTS))
def known_orbit(request):
    """Return each known orbit in turn, with a damper and without."""
    return polished_orbit(request.param)


@pytest.fixture(scope="session", params=IMPACTING)
def impacting_orbit(request):
    """Return each known orbit with contacts in turn."""
    return polished_orbit(request.param)


@pytest.fixture(scope="session")
def design_orbit():
    """Return the quiet orbit of the damper of figure 5 (a) at W = 2."""
    return polished_orbit("design")

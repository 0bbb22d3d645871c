"""Fixtures: orbits that many tests use, and the reference integrator."""

import pytest
from helpers.scenes import IMPACTING, STARTS, scene_of


@pytest.fixture(scope="session", params=list(STARTS))
def scene(request):
    return scene_of(request.param)


@pytest.fixture(scope="session", params=IMPACTING)
def impacting(request):
    return scene_of(request.param)


@pytest.fixture(scope="session")
def design():
    return scene_of("design")


@pytest.fixture(scope="session")
def references():
    """Two reference integrators that differ in their steps."""
    pytest.importorskip("heyoka")
    from references.taylor_events import Reference

    return Reference(), Reference(longest=0.01)

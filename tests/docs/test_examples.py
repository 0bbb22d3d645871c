"""Every public name has an example in its docstring, and the example prints what it shows."""

import doctest
import inspect
from operator import attrgetter

import matplotlib
import pytest
from matplotlib import pyplot

import impact_damper
from impact_damper import plot

PLOTS = [f"plot.{name}" for name in plot.__all__]
NAMES = sorted(set(impact_damper.__all__) - {"plot"})


@pytest.fixture(autouse=True)
def closed_figures():
    """Let examples draw without a display, and close their figures afterwards."""
    matplotlib.use("Agg")
    yield
    pyplot.close("all")


@pytest.mark.parametrize("name", [*NAMES, *PLOTS])
def test_example_of_docstring(name):
    """The example runs in a namespace that holds only the object documented."""
    public = attrgetter(name)(impact_damper)
    text = inspect.getdoc(public)
    test = doctest.DocTestParser().get_doctest(text, {name: public}, name, None, None)
    assert test.examples, "no example"
    told = []
    doctest.DocTestRunner(verbose=False).run(test, out=told.append)
    assert not told, "".join(told)

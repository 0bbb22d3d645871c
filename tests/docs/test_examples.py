"""Every public name has an example in its docstring, and it does what it shows."""

import doctest
import inspect

import pytest

import impact_damper


@pytest.mark.parametrize("name", [*impact_damper.__all__])
def test_example_of_docstring(name):
    """The example runs in a namespace with the name alone."""
    public = getattr(impact_damper, name)
    if inspect.ismodule(public):
        pytest.skip("its functions have their own")
    text = inspect.getdoc(public)
    test = doctest.DocTestParser().get_doctest(text, {name: public}, name, None, None)
    assert test.examples, "no example"
    told = []
    doctest.DocTestRunner(verbose=False).run(test, out=told.append)
    assert not told, "".join(told)

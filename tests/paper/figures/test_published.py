"""The figure of published numbers: each difference in the band of its publication."""

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from chatterjee1995.figures.published import GROUPS, LEAST, draw_published
from impact_damper.data.datasets import dataset
from impact_damper.data.variables import VARIABLES

FLAGS = VARIABLES["publication"].flags
OURS = np.array([1.001, 2.02, 4.0])
THEIRS = np.array([1.0, 2.0, 4.0])


@pytest.fixture(scope="module")
def drawn():
    data = {
        "publication": [FLAGS["masri_caughey"], FLAGS["hertz"], FLAGS["hertz"]],
        "published_value": THEIRS,
        "our_value": OURS,
        "limit_value": [1 + 1e-7, np.nan, np.nan],
        "expected_difference": [2e-3, 0.03, np.nan],
    }
    made = draw_published(published=[dataset(data, {"comparison": list("abc")}, {}, "Three")])
    FigureCanvasAgg(made).draw()
    return made


def points(drawn, label):
    """Return the points with a label, from all bands, as rows (difference, band)."""
    (axes,) = drawn.axes
    lines = [line for line in axes.lines if line.get_label() == label]
    found = np.concatenate([line.get_xydata() for line in lines])
    return found[np.isfinite(found[:, 0])]


def test_every_publication_has_a_band_with_its_number():
    assert set(GROUPS) == set(FLAGS)


def test_differences_lie_in_the_bands_of_their_publications(drawn):
    found = points(drawn, "ours")
    np.testing.assert_allclose(found[:, 0], [1e-3, 1e-2, LEAST], rtol=1e-9)
    bands = list(GROUPS)
    assert [bands[round(place)] for place in found[:, 1]] == ["masri_caughey", "hertz", "hertz"]
    labels = [text.get_text() for text in drawn.axes[0].get_yticklabels()]
    assert labels[0].endswith("(1)") and labels[-1].endswith("(2)") and labels[2].endswith("(0)")


def test_expected_and_extrapolated_differences_lie_beside_them(drawn):
    np.testing.assert_allclose(points(drawn, "expected")[:, 0], [2e-3, 0.03])
    (limit,) = points(drawn, "ours, extrapolated to rigid walls")
    assert limit[0] == pytest.approx(1e-7, rel=1e-6)
    assert limit[1] == points(drawn, "ours")[0, 1]


def test_all_lies_on_the_sheet(drawn):
    box = drawn.get_tightbbox()
    assert min(box.x0, box.y0) >= 0
    assert box.x1 <= drawn.get_figwidth() and box.y1 <= drawn.get_figheight()

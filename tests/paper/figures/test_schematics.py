"""The schematics are drawn without warnings, legibly, and with the same bytes each time."""

from functools import cache
from itertools import combinations

import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.path import Path
from matplotlib.text import Text

from chatterjee1995.figures import schematics
from impact_damper.plot import style

NAMES = ["elastic_model", "inelastic_model", "migration_scheme", "algorithm", "impact_pair"]

pytestmark = pytest.mark.filterwarnings("error")


@cache
def drawn_once(name):
    """Return the schematic `name`. It is drawn only once, so tests must not change the figure."""
    figure = getattr(schematics, name)()
    FigureCanvasAgg(figure).draw()
    return figure


@pytest.fixture(params=NAMES)
def drawn(request):
    with style.context():
        yield drawn_once(request.param)


def boxes(figure):
    texts = [text for text in figure.findobj(Text) if text.get_text() and text.get_visible()]
    return {(text.get_text(), *text.get_position()): text.get_window_extent() for text in texts}


def test_texts_lie_on_the_sheet(drawn):
    assert drawn.get_figwidth() in style.COLUMNS.values()
    found = boxes(drawn)
    assert len(found) >= 6
    for text, box in found.items():
        assert box.x0 >= 0 and box.y0 >= 0, text
        assert box.x1 <= drawn.bbox.x1 and box.y1 <= drawn.bbox.y1, text


def test_texts_do_not_overlap(drawn):
    for (one, box), (other, its_box) in combinations(boxes(drawn).items(), 2):
        assert not box.overlaps(its_box), f"{one} on {other}"


def test_no_line_leaves_the_sheet_or_runs_through_a_text(drawn):
    (axes,) = drawn.axes
    for artist in [*axes.lines, *axes.patches]:
        box = artist.get_window_extent()
        assert box.x0 >= 0 and box.y0 >= 0
        assert box.x1 <= drawn.bbox.x1 and box.y1 <= drawn.bbox.y1
        outline = artist.get_path().to_polygons(artist.get_transform(), closed_only=False)
        for text, box in boxes(drawn).items():
            for points in outline:
                assert not Path(points).intersects_bbox(box, filled=False), text

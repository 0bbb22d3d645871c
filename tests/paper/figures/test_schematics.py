"""The schematics are drawn without warnings, legibly, and with the same bytes each time."""

import os
import pathlib
import subprocess
import sys
from functools import cache
from itertools import combinations

import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.path import Path
from matplotlib.text import Text

import impact_damper
from chatterjee1995.figures import schematics
from impact_damper.plot import style

NAMES = ["elastic_model", "inelastic_model", "migration_scheme", "algorithm", "impact_pair"]

pytestmark = pytest.mark.filterwarnings("error")


@pytest.mark.thorough
def test_saves_have_the_same_bytes(tmp_path):
    """Another process, with another hash seed and time zone, writes the same bytes."""
    program = (
        "from chatterjee1995.figures import schematics\nfrom impact_damper.plot import style\n"
        f"style.save_figure(schematics.migration_scheme(), '{tmp_path}/other')\n"
    )
    source = str(pathlib.Path(impact_damper.__file__).parents[1])
    environment = os.environ | {"PYTHONPATH": source, "PYTHONHASHSEED": "7", "TZ": "Asia/Tokyo"}
    subprocess.run([sys.executable, "-c", program], env=environment, check=True)
    style.save_figure(schematics.migration_scheme(), tmp_path / "own")
    for kind in ("pdf", "png"):
        own, other = (tmp_path / f"{name}.{kind}" for name in ("own", "other"))
        assert own.read_bytes() == other.read_bytes()


@cache
def drawn_once(name):
    """Return the schematic of this name. It is drawn only once, so tests must not change it."""
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

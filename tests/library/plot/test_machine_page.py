"""The page of a machine: what to build comes first, every number has its source."""

import base64
import re
from html.parser import HTMLParser

import numpy as np
import pytest
from helpers.made_up_design import made_up_design
from matplotlib.figure import Figure

from chatterjee1995.sections.machines import PAGE
from impact_damper.data.variables import VARIABLES
from impact_damper.plot.pages.blocks import percent, share_with_interval, shown
from impact_damper.plot.pages.machine import FIGURES, machine_page
from impact_damper.plot.pages.render import as_text, write_page

NO_PICTURES = dict.fromkeys(FIGURES, "")
# Variables of a design that are not in the registry of variables, since the stage renames them.
RENAMED = {"sweep_envelope", "ring_envelope", "ring_time"}


def texts(**changed):
    """Return the page in HTML and in Markdown."""
    page = machine_page("made_up", made_up_design(**changed))
    return [as_text(f"page.{kind}", page, NO_PICTURES) for kind in ("html", "md")]


def numbers(**changed):
    """Return the values on a page, keyed by their descriptions."""
    page = machine_page("made_up", made_up_design(**changed))
    blocks = [block for section in page.sections for block in section.blocks]
    return {
        what: value for block in blocks if block.kind == "numbers" for what, value, _ in block.rows
    }


def test_both_forms_say_first_what_to_do():
    for text in texts():
        first = re.sub(r"<style>.*?</style>", "", text, flags=re.DOTALL)
        assert first.index("Build it") < first.index("Build a gap of 7 mm.")
        assert first.index("Build a gap of 7 mm.") < first.index("What to build")


@pytest.mark.parametrize(
    ("changed", "advice"),
    [
        ({}, "Build it"),
        (
            {"choice": "needs_tolerance", "promise": "nominal_kept"},
            "Build it, and hold the gap more closely than your tolerance",
        ),
        (
            {"choice": "least_worst", "promise": "none_made"},
            "Do not build it for this band",
        ),
        ({"promise": "broken"}, "Do not build it: the check failed"),
        (
            {"promise": "nominal_kept"},
            "Build it, and hold all values more closely than your tolerances",
        ),
    ],
)
def test_the_advice_follows_the_choice_and_its_check(changed, advice):
    assert machine_page("x", made_up_design(**changed)).advice == advice


def test_every_number_has_a_source():
    data = made_up_design()
    attributes = re.compile(r"(machine|parameters)\.[\w.]+")
    for section in machine_page("made_up", data).sections:
        for block in section.blocks:
            rows = block.rows if block.kind == "numbers" else []
            for *_, source in rows:
                for name in source.split(", "):
                    known = name in RENAMED or (name in VARIABLES and name in data)
                    assert known or attributes.fullmatch(name), source


def test_numbers_are_those_of_the_dataset():
    found = numbers()
    assert found["gap, the full play"] == "7 mm ± 10 %"
    assert found["gap, allowed range"] == "6.3 mm to 7.7 mm"
    assert found["largest displacement without the damper"] == "10 mm at 34 Hz"
    assert found["reduction: largest displacement without / with the damper"] == "12.5 times"
    assert found["cliff below: last quiet gap"] == (
        "none found: quiet at least down to 6 mm, the last compared"
    )
    assert found["cliff above: last quiet gap"] == (
        "8.5 mm, 21.4 % above the gap to build (at 30 Hz)"
    )
    what = (
        "time in which an unforced vibration of 2 mm decays to a tenth, without / with the damper"
    )
    assert found[what] == "5 s / 1.5 s"


def test_times_margins_and_derivatives_are_on_the_page():
    found = numbers()
    what = "cycles in which these motions settle on a periodic quiet motion, median / 95 %, at the "
    assert found[f"{what}slowest frequency"] == "80 / 120"
    what = "largest multiplier of the quiet orbit at the gap to build, at 30 Hz (stable below 1)"
    assert found[what] == "0.9"
    markdown = texts()[1]
    assert "| force | 2.60 % | 0.20 % |" in markdown and "| gap | -1.60 % | -0.20 % |" in markdown
    assert "| unbalance |" not in markdown
    chaos = numbers(quiet_time_median=np.full((4, 5), np.nan))
    assert "not known: the quiet motions found never repeat" in chaos.values()


def test_a_motion_that_the_damper_does_not_touch_has_a_row_of_its_own():
    what = "not counted: largest displacement of a motion in which the loose mass touches no wall"
    assert what not in numbers()
    sizes = [np.nan, 3.1, 2.5, np.nan, np.nan]
    assert numbers(untouched_displacement=sizes)[what] == "3.1 mm at 28 Hz"


def test_who_wins_is_said_plainly():
    html, markdown = texts()
    assert (
        "Over the band, at the nominal excitation, the tuned absorber is best: the machine "
        "moves at most 0.5 mm. Next is this impact damper with 0.8 mm."
    ) in markdown
    assert (
        "So the absorber is better than the impact damper, even if detuned: with the springs of "
        "the tuned absorber 10 % off the machine moves up to 0.6 mm."
    ) in markdown
    better = machine_page("x", made_up_design(reached_displacement=np.full(5, 0.1)))
    assert "the impact damper is the right choice here" in as_text("page.md", better, NO_PICTURES)


def test_a_detuned_absorber_from_which_the_machine_escapes_is_told():
    sizes = made_up_design()["competitor_displacement"].values.copy()
    sizes[-1, 0] = np.inf
    told = "so the absorber is better only as long as it stays tuned: with the springs of the "
    told += "tuned absorber 10 % off the machine escapes."
    assert told in texts(competitor_displacement=sizes)[1].lower()


def test_a_lighter_mass_that_does_as_well_is_told():
    for sizes, told in (([0.8, 0.9, 0.8], True), ([5.0, 0.9, 0.8], False)):
        changed = {"other_displacement": sizes, "other_share": [1, 1, 1]}
        words = "A lighter loose mass does as well: 0.3 kg with a gap of 14 mm."
        assert all((words in text) == told for text in texts(**changed))


class Links(HTMLParser):
    """Reader that collects the open tags of a page, and the files to which it refers."""

    def __init__(self):
        super().__init__()
        self.open, self.links = [], []

    def handle_starttag(self, tag, attrs):
        self.links += [value for name, value in attrs if name in ("src", "href")]
        if tag not in ("img", "meta"):
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def test_the_files_are_complete_and_need_no_others(tmp_path):
    """The test writes the page with small drawings, each of its own name, in place of figures."""

    def sheet(name):
        blank = Figure(figsize=(1, 1))
        blank.text(0, 0, name)
        return lambda _: blank

    data = made_up_design()
    figures = {name: sheet(name) for name in FIGURES}
    write_page(machine_page("made_up", data), figures, data, tmp_path)
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {"index.html", "report.md", *(f"{name}.png" for name in FIGURES)}
    parser = Links()
    parser.feed((tmp_path / "index.html").read_text())
    assert parser.open == [] and len(parser.links) == len(FIGURES)
    for link, name in zip(parser.links, _order(tmp_path), strict=True):
        head, content = link.split(",")
        assert head == "data:image/png;base64"
        assert base64.b64decode(content) == (tmp_path / name).read_bytes()


def _order(folder):
    """Return the pictures of the Markdown page in their order."""
    return re.findall(r"!\[\w+\]\((\w+\.png)\)", (folder / "report.md").read_text())


def test_the_registry_names_the_figures_of_the_page():
    assert tuple(FIGURES) == PAGE


def test_text_from_the_dataset_is_escaped():
    data = made_up_design().assign_attrs(conclusion='["a < b & c"]')
    page = machine_page("made_up", data)
    assert "a &lt; b &amp; c" in as_text("page.html", page, NO_PICTURES)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (7.436, "7.44 mm"),
        (20.0, "20 mm"),
        (2e7, "2 × 10⁷ mm"),
        (-1.996e-4, "-2 × 10⁻⁴ mm"),
        (0, "0 mm"),
        (1.25e-5, "1.25 × 10⁻⁵ mm"),
        (1234.5, "1230 mm"),
        (np.nan, "none found"),
        (np.inf, "escapes"),
    ],
)
def test_numbers_as_text(value, text):
    assert shown(value, "mm") == text


def test_shares_as_text():
    assert percent(0.9964) == "99.6 %"
    assert share_with_interval([1, 0.95, 1]) == "100 % (95 % to 100 %)"

"""The page of a machine: the answer comes first, and every number is that of the dataset."""

import base64
import re
from html.parser import HTMLParser

import pytest
from helpers.made_up_design import made_up_design
from matplotlib.figure import Figure

from impact_damper.data.variables import VARIABLES
from impact_damper.plot import conclusion
from impact_damper.plot.machine_figures import FIGURES
from impact_damper.plot.pages.render import page_of, write_page

NO_PICTURES = dict.fromkeys(FIGURES, b"")
ROW = re.compile(r"<tr><td>(.*?)</td><td(?: class=\"source\")?>(.*?)</td></tr>")
# Variables of each addition without which the page must still be complete.
ADDED = {
    "response": ["maximum_displacement", "contact_force_by_frequency", "reached_displacement"],
    "orbits": ["gap_of_orbit", "best_orbit_beyond", "best_orbit_gap", "best_orbit_displacement"],
    "forces": ["force_map_displacement"],
    "masses": ["other_mass", "other_gap", "other_displacement", "other_force"],
    "transients": ["sweep_envelope", "ring_envelope"],
    "competitors": ["competitor_displacement", "absorber_stiffness", "absorber_damping"],
}


def text(name="made_up", **changed):
    """Return the page in HTML."""
    return page_of(name, made_up_design(**changed), NO_PICTURES, date="2001-02-03")


def bare(html):
    """Return the words of a page in HTML."""
    words = re.sub(r"<style>.*?</style>|<[^>]*>", " ", html, flags=re.DOTALL)
    return words.replace("&#39;", "'")


@pytest.mark.parametrize("decision", ["build", "do_not_build"])
def test_the_answer_and_a_picture_come_first(decision):
    answer = conclusion(made_up_design(decision))
    html = text(decision=decision)
    words, others = bare(html), ("against the forcing frequency (left)", "Give the loose mass a")
    places = [words.index(each) for each in (*answer, *others)]
    assert places == sorted(places)
    assert html.index('class="answer"') < html.index("<img") < html.index("<h2>")


def test_every_number_has_a_source_in_the_appendix():
    data = made_up_design()
    before, appendix = text().split("<h2>Appendix")
    attributes = re.compile(r"(machine|parameters)\.[\w.]+")
    sources = dict(ROW.findall(appendix))
    rows = {what for what, _ in ROW.findall(before) if not re.match(r"[\d.]+ kg", what)}
    assert len(rows) > 25 and rows <= set(sources)
    for source in sources.values():
        for name in source.split(", "):
            assert (name in VARIABLES and name in data) or attributes.fullmatch(name), source
    assert not re.search(r"\w_\w", bare(before).replace("made_up", ""))


def test_no_part_of_a_template_is_left():
    words = bare(text())
    assert not re.search(r"\{\{|\{%|\bNone\b|\bnan\b", words)
    end = "2001-02-03, from the entry made_up of the configuration; data in made_up.nc"
    assert words.rstrip().endswith(end)


def test_numbers_are_those_of_the_dataset():
    found = dict(ROW.findall(text().split("<h2>Appendix")[0]))
    assert found["gap, the full play"] == "7 mm ± 10 %"
    assert found["machine: damping ratio"] == "0.5 %"
    assert found["machine: cubic stiffness of the spring"] == "4e9 N/m³"
    assert found["promised displacement"] == "1 mm at 30 Hz, with gap +10 %"
    assert found["largest force in a contact"] == "600 N at 26 Hz"
    what = "time in which a displacement of 2 mm decays to a tenth without excitation"
    assert found[f"{what}, without / with damper"] == "5 s / 1.5 s"


@pytest.mark.parametrize("addition", ADDED)
def test_an_addition_that_failed_leaves_a_page(addition):
    data = made_up_design().drop_vars(ADDED[addition])
    pictures = {name: b"" for name, draw in FIGURES.items() if draw(data) is not None}
    html = page_of("made_up", data, pictures)
    assert "Build a gap of 7 mm" in html and html.count("<img") == len(pictures)


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
    """The test writes the page with empty drawings in place of figures."""
    figures = {name: lambda _: Figure(figsize=(1, 1)) for name in FIGURES}
    write_page("made_up", made_up_design(), tmp_path, figures=figures)
    assert [path.name for path in tmp_path.iterdir()] == ["index.html"]
    parser = Links()
    parser.feed((tmp_path / "index.html").read_text())
    assert parser.open == [] and len(parser.links) == len(FIGURES)
    for link in parser.links:
        head, content = link.split(",")
        assert head == "data:image/png;base64"
        assert base64.b64decode(content).startswith(b"\x89PNG")


def test_names_are_escaped():
    assert "the machine a &lt; b &amp; c" in text("a < b & c")

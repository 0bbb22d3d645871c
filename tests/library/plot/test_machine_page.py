"""The page of a machine: the answer comes first, and every number is that of the dataset."""

import base64
import re
from html.parser import HTMLParser

import pytest
from helpers.made_up_design import made_up_design
from matplotlib.figure import Figure

from chatterjee1995.sections.machines import PAGE
from impact_damper.data.variables import VARIABLES
from impact_damper.plot import conclusion
from impact_damper.plot.machine_figures.figures import FIGURES
from impact_damper.plot.pages.render import pages, write_page

NO_PICTURES = dict.fromkeys(FIGURES, "")
ROW = re.compile(r"^\| (.*?) \| (.*) \|$", re.MULTILINE)
# Variables of each addition without which the page must still be complete.
ADDED = {
    "response": ["maximum_displacement", "contact_force_by_frequency", "reached_displacement"],
    "orbits": ["gap_of_orbit", "best_orbit_beyond", "best_orbit_gap", "best_orbit_displacement"],
    "forces": ["force_map_displacement"],
    "masses": ["other_mass", "other_gap", "other_displacement", "other_force"],
    "transients": ["sweep_envelope", "ring_envelope"],
    "competitors": ["competitor_displacement", "absorber_stiffness", "absorber_damping"],
}


def texts(name="made_up", **changed):
    """Return the page in HTML and in Markdown."""
    return [*pages(name, made_up_design(**changed), NO_PICTURES, date="2001-02-03").values()]


def bare(html):
    """Return the words of a page in HTML."""
    text = re.sub(r"<style>.*?</style>|<[^>]*>", " ", html, flags=re.DOTALL)
    return text.replace("&#39;", "'")


@pytest.mark.parametrize("decision", ["build", "do_not_build"])
def test_the_answer_and_a_picture_come_first(decision):
    answer = conclusion(made_up_design(decision))
    for text in (bare(texts(decision=decision)[0]), texts(decision=decision)[1]):
        places = [text.index(each) for each in (*answer, "against the forcing frequency (left)")]
        assert places == sorted(places) and places[-1] < text.index(
            "Give the loose mass a straight"
        )
    html = texts()[0]
    assert html.index('class="answer"') < html.index("<img") < html.index("<h2>")


def test_every_number_has_a_source_in_the_appendix():
    data, markdown = made_up_design(), texts()[1]
    before, appendix = markdown.split("## Appendix")
    attributes = re.compile(r"(machine|parameters)\.[\w.]+")
    sources = dict(ROW.findall(appendix))
    rows = {what for what, _ in ROW.findall(before)} - {"quantity", "---"}
    simple = {what for what in rows if "kg" not in what and what != "loose mass | best gap"}
    assert len(simple) > 25 and simple <= set(sources)
    for source in [*sources.values()][2:]:
        for name in source.strip("`").split(", "):
            assert (name in VARIABLES and name in data) or attributes.fullmatch(name), source
    assert not re.search(r"\w_\w", before.replace("made_up", "").replace("max_disp", ""))


def test_both_forms_have_the_same_words():
    html, markdown = texts()
    plain = re.sub(r"!\[.*\)|[#|*`]|^- |-{3}", " ", markdown, flags=re.MULTILINE)
    for text in (bare(html), plain):
        assert not re.search(r"\{\{|\{%|\bNone\b|\bnan\b", text)
        assert text.rstrip().endswith(
            "from the entry made_up of the configuration; data in made_up.nc"
        )
        assert "2001-02-03" in text
    marks = re.compile(r"[\s`*\-]+")
    assert not set(marks.split(plain)) - set(marks.split(bare(html)))


def test_numbers_are_those_of_the_dataset():
    found = dict(ROW.findall(texts()[1].split("## Appendix")[0]))
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
    pictures = {name: "" for name, draw in FIGURES.items() if draw(data) is not None}
    html, _ = pages("made_up", data, pictures).values()
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
    """The test writes the page with small drawings, each of its own name, in place of figures."""

    def sheet(name):
        blank = Figure(figsize=(1, 1))
        blank.text(0, 0, name)
        return lambda _: blank

    figures = {name: sheet(name) for name in FIGURES}
    write_page("made_up", made_up_design(), tmp_path, figures=figures)
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {"index.html", "report.md", *(f"{name}.png" for name in FIGURES)}
    parser = Links()
    parser.feed((tmp_path / "index.html").read_text())
    assert parser.open == [] and len(parser.links) == len(FIGURES)
    order = re.findall(r"!\[\w+\]\((\w+\.png)\)", (tmp_path / "report.md").read_text())
    for link, name in zip(parser.links, order, strict=True):
        head, content = link.split(",")
        assert head == "data:image/png;base64"
        assert base64.b64decode(content) == (tmp_path / name).read_bytes()


def test_the_sections_of_the_configuration_name_the_figures_of_the_page():
    assert tuple(FIGURES) == PAGE


def test_names_are_escaped():
    assert "the machine a &lt; b &amp; c" in texts("a < b & c")[0]

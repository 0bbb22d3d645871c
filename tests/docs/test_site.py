"""The built documentation: links and pictures exist, and a browser finds no error."""

import re
import shutil
import subprocess
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest

SITE = Path(__file__).parents[2] / "docs/_build/html"
PAGES = [path for path in sorted(SITE.rglob("*.html")) if "_static" not in path.parts]
BROWSER = next(
    filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None
)

pytestmark = pytest.mark.skipif(not PAGES, reason="no site: make docs")
# Pages that were read, by path, so that each page is read only once.
SEEN = {}


class Page(HTMLParser):
    """Targets of links and pictures of a page, and its anchors."""

    def __init__(self, path):
        super().__init__()
        self.targets, self.anchors = [], set()
        self.feed(path.read_text())

    def handle_starttag(self, tag, attrs):
        """Collect the anchors of a tag, and the targets of its link or picture."""
        given = dict(attrs)
        self.anchors |= {given[key] for key in ("id", "name") if given.get(key)}
        for key in ("href", "src"):
            if given.get(key):
                self.targets.append(given[key])


def page(path):
    """Return the page of a file."""
    if path not in SEEN:
        SEEN[path] = Page(path)
    return SEEN[path]


def elsewhere(target):
    """Return whether a target is not part of the site."""
    return urlsplit(target).scheme in ("http", "https", "mailto", "data", "javascript")


def lacking(path, target):
    """Return whether a target of a page does not exist within the site."""
    split = urlsplit(target)
    file = (path.parent / unquote(split.path)).resolve() if split.path else path
    if file.is_dir():
        file /= "index.html"
    if not file.exists():
        return True
    return (
        bool(split.fragment) and file.suffix == ".html" and split.fragment not in page(file).anchors
    )


def test_every_link_and_picture_exists():
    """Addresses outside of the site are not opened."""
    dead = [
        f"{path.relative_to(SITE)}: {target}"
        for path in PAGES
        for target in page(path).targets
        if target != "#" and not elsewhere(target) and lacking(path, target)
    ]
    assert not dead, "\n".join(dead)


def test_every_plot_of_a_tutorial_is_shown():
    """Each call of `idm.plot` leaves a picture on the page."""
    for path in sorted((SITE.parents[1] / "tutorials").glob("*.md")):
        drawn = len(re.findall(r"idm\.plot\.(?!conclusion)", path.read_text()))
        shown = (SITE / "tutorials" / f"{path.stem}.html").read_text().count("<img")
        assert shown >= drawn, path.stem


def test_nothing_is_loaded_from_elsewhere():
    """The site works offline: scripts, styles and pictures are its own."""
    loaded = re.compile(r'<(?:script|img|link)[^>]+(?:src|href)="(https?:[^"]+)"')
    foreign = [(path.name, each) for path in PAGES for each in loaded.findall(path.read_text())]
    assert not foreign


@pytest.mark.skipif(BROWSER is None, reason="no Chromium")
def test_browser_reports_no_error():
    """The console of a headless Chromium stays without errors on each page."""
    options = ["--headless", "--no-sandbox", "--disable-gpu", "--enable-logging=stderr"]
    # Pages of functions are alike, so only the first page of a function is opened.
    of_functions = [path for path in PAGES if path.parent.name == "api"]
    for path in [each for each in PAGES if each not in of_functions[1:]]:
        ran = subprocess.run(
            [BROWSER, *options, "--virtual-time-budget=1000", "--dump-dom", path.as_uri()],
            capture_output=True, text=True, timeout=120, check=True,
        )  # fmt: skip
        said = [line for line in ran.stderr.splitlines() if "CONSOLE" in line and "rror" in line]
        assert not said, f"{path.name}: {said}"

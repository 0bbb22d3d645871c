"""Configuration of Sphinx. `make docs` builds `docs/_build/html` and runs every tutorial."""

import sys
from importlib import metadata
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "extensions"))

project = "impact-damper"
author = "The impact-damper developers"
release = metadata.version("impact-damper")
extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "numpydoc",
    "mathml",  # this and the next extension are in docs/extensions
    "written_pages",
]
exclude_patterns = ["_build", "extensions", "paper/paper.md"]
nitpicky = False

# Tutorials are run at every build; an error in a tutorial stops the build.
nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_timeout = 300
nb_merge_streams = True
myst_enable_extensions = ["dollarmath", "colon_fence", "deflist"]
myst_heading_anchors = 3
# Signatures name public classes, such as `Oscillator`, without their modules.
autodoc_typehints = "none"
# Docstrings write absolute values as |Z1|, which docutils takes for the name of a substitution.
# Both names are therefore defined as substitutions.
rst_prolog = "".join(f".. |{name}| replace:: abs {name}\n" for name in ("Z1", "a"))
add_module_names = False
numpydoc_show_class_members = False
numpydoc_class_members_toctree = False

html_theme = "pydata_sphinx_theme"
html_title = "impact-damper"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_sourcelink = False
html_math_renderer = "mathml"
html_theme_options = {
    "navigation_with_keys": False,
    "show_prev_next": True,
    "secondary_sidebar_items": ["page-toc"],
    "footer_start": ["copyright"],
    "footer_end": [],
}
html_sidebars = {"index": []}  # the first page has no list of pages at its side

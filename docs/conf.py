"""The site: `make docs` writes out/site. It is built without a network, and a warning ends the build."""

import os
import sys
import zipfile
from pathlib import Path

import tandemlift

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE / "_extensions"), str(HERE.parent / "tools")]
# a notebook's `!tandemlift` is the one of this environment, also where it is not active; a shell's error ends no build
os.environ["PATH"] = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])

project = "tandemlift"
author = "The tandemlift contributors"
copyright = "2026, the tandemlift contributors"
release = version = tandemlift.__version__

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx_copybutton",
    "sphinx_design",
    "api_entries",
    "drawn",
    "generated_markdown",
    "live_page",
    "mathml",
    "page_layout",
]
exclude_patterns = ["_extensions"]
pygments_style = "friendly"
pygments_dark_style = "monokai"
highlight_language = "none"
smartquotes_action = "D"  # dashes only: docstrings and tables quote values

html_theme = "furo"
html_title = f"tandemlift {release}"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_extra_path = ["llms.txt"]  # a short map of the site for language models
html_show_sphinx = False
html_copy_source = False
html_math_renderer = "mathml"
html_theme_options = {"navigation_with_keys": True}

# Markdown
myst_enable_extensions = ["attrs_inline", "colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 4  # as GitHub makes them, so that one link works on both
myst_links_external_new_tab = False
copybutton_selector = "div:not(.output, .highlight-text) > div.highlight pre"  # what one types, not what is printed
copybutton_prompt_text = r"\$ |>>> |!"  # a shell knows no `!` before a command
copybutton_prompt_is_regexp = True

# Tutorials run when the site is built, unless it is built with -t quick; a cell that fails ends the build.
nb_execution_mode = "off" if tags.has("quick") else "force"  # noqa: F821 (Sphinx defines `tags`)
nb_execution_raise_on_error = True
nb_execution_timeout = 300  # s
nb_execution_in_temp = True
nb_merge_streams = True
nb_mime_priority_overrides = [("html", "text/html", 0)]

# The interface of Python
default_role = "code"  # docstrings write names in single backticks
autodoc_typehints = "signature"
autodoc_member_order = "bysource"
python_maximum_signature_line_length = 100
napoleon_google_docstring = True
napoleon_numpy_docstring = False
napoleon_attr_annotations = True
napoleon_use_ivar = True
autodoc_type_aliases = {name: name for name in ("Array", "Number", "PerQuadrotor", "PerRotor")}


def spread(app, env, docnames):
    """Order the pages so that each process that reads them gets some of those that run code."""
    docnames[:] = [name for start in range(8) for name in docnames[start::8]]


def pack_exercises(app):
    """Write out/exercises.zip, without the solutions, for the pages that offer it."""
    folder, packed = HERE.parent / "exercises", HERE.parent / "out" / "exercises.zip"
    packed.parent.mkdir(exist_ok=True)
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in ("README.md", *(f"[0-9]*/*.{ending}" for ending in ("ipynb", "py", "toml"))):
            for path in sorted(folder.glob(name)):
                archive.write(path, path.relative_to(HERE.parent))


def setup(app):
    """Pack the exercises and order the pages before they are read."""
    app.connect("builder-inited", pack_exercises)
    app.connect("env-before-read-docs", spread)

"""Sphinx: how the pages that build.py has collected become a site. No page asks another host for anything."""

from __future__ import annotations

import re
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent))

import arm3r_cpp
from docutils import nodes
from docutils.utils.math.latex2mathml import tex2mathml
from pygments.lexers.special import TextLexer

project = "arm3r"
author = copyright = "the arm3r authors"
version = release = arm3r_cpp.__version__

extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
exclude_patterns = ["docs/images"]
myst_enable_extensions = ["colon_fence", "dollarmath"]
myst_fence_as_directive = ["math"]
myst_heading_anchors = 4
nb_execution_mode = "cache"
nb_execution_timeout = 300
nb_execution_raise_on_error = True
nb_execution_show_tb = True
nb_merge_streams = True

default_role = "code"
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_preserve_defaults = True
napoleon_numpy_docstring = False
add_module_names = False
highlight_language = "none"

html_theme = "furo"
html_title = f"arm3r {version}"
fonts = Path(find_spec("ziamath").origin).with_name("fonts")  # STIX Two Math, under the Open Font License
html_static_path = ["static", str(fonts)]
html_css_files = ["style.css"]
html_copy_source = False
html_show_sphinx = False
html_last_updated_fmt = None
html_math_renderer = "mathml"

# ---- formulas -------------------------------------------------------------------------------------------------------

# What GitHub's renderer takes and docutils' converter does not, or sets otherwise: an accent belongs to its letter, and
# a subscript to both.
SPELLINGS = [
    (r"°", r"^{\\circ}"),
    (r"\\Bigg?[lr]?(?![a-z])|\\textstyle", ""),
    (r"\A_", "{}_"),
    (r"(frac|binom)(\d)(\d)", r"\1{\2}{\3}"),
    (r"\\(d?dot|hat|bar|tilde|vec) ?(\{[^{}]*\}|\\?[A-Za-z]+?(?![a-z]))(?=[_^])", r"{\\\1{\2}{}}"),
]


def mathml(text: str, *, as_block: bool) -> str:
    """A formula as MathML, which browsers draw themselves."""
    for pattern, replacement in SPELLINGS:
        text = re.sub(pattern, replacement, text)
    return tex2mathml(text, as_block=as_block)


def visit_math(translator: Any, node: Any) -> None:
    translator.body.append(mathml(node.astext(), as_block=False))
    raise nodes.SkipNode


def visit_math_block(translator: Any, node: Any) -> None:
    translator.body.append(f'<div class="formula">{mathml(node.astext(), as_block=True)}</div>\n')
    raise nodes.SkipNode


def spell_formulas(app: Any, name: str, source: list[str]) -> None:
    """GitHub's $`x`$ becomes the role that MyST knows, outside of code."""
    if not name.startswith("docs/notebooks/"):
        parts = re.split(r"(^```.*?^```$)", source[0], flags=re.M | re.S)
        parts[::2] = [re.sub(r"\$`(.+?)`\$", r"{math}`\1`", part, flags=re.S) for part in parts[::2]]
        source[0] = "".join(parts)


def setup(app: Any) -> None:
    app.add_html_math_renderer("mathml", (visit_math, None), (visit_math_block, None))
    app.add_lexer("csv", TextLexer)
    app.connect("source-read", spell_formulas)

"""Sphinx's settings for the static book. `make book` gathers the pages and calls Sphinx (tools/book.py)."""

import re

from latex2mathml.converter import convert

project = html_title = "bootcourse"
extensions = ["myst_nb", "sphinx_design"]
html_theme = "furo"
html_static_path = ["style.css"]
html_css_files = ["style.css"]
html_show_sphinx = html_show_copyright = html_show_sourcelink = html_copy_source = False
html_math_renderer = "mathml"
nb_execution_mode = "off"  # the notebooks are shown as they were executed
nb_render_markdown_format = "gfm"  # their outputs have tables
myst_enable_extensions = ["amsmath", "colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
suppress_warnings = ["myst.header"]  # a printed table may begin with a heading of its own
pygments_style, pygments_dark_style = "friendly", "monokai"


def mathml(latex, display):
    """An equation as MathML, which every browser of today draws by itself: no script, no network."""
    text = convert(latex, display=display)
    return re.sub(r"(<mi>(?:log|exp|max|min|sin)</mi>)(?!<mo)", r'\1<mspace width="0.17em"/>', text)  # log x, not logx


def inline_math(self, node):
    self.body.append(mathml(node.astext(), "inline"))


def display_math(self, node):
    self.body.append(f'<div class="math">{mathml(node.astext(), "block")}</div>')


def skip_children(visit):
    """docutils' way to say that a node is done."""

    def visited(self, node):
        from docutils.nodes import SkipNode

        visit(self, node)
        raise SkipNode

    return visited


def setup(app):
    app.add_html_math_renderer("mathml", (skip_children(inline_math), None), (skip_children(display_math), None))

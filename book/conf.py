"""Sphinx's settings for the static book. `make book` gathers the pages and calls Sphinx (tools/book.py)."""

import dataclasses
import html
import inspect
import json
import re

from docutils import nodes

from tools.course.mathematics import mathml

project = html_title = "bootcourse"
extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx_design", "sphinxcontrib.bibtex"]
bibtex_bibfiles, bibtex_reference_style = ["references.bib"], "author_year"
html_theme = "furo"
html_static_path = ["style.css", "wide.js", "drag.js"]
html_css_files = ["style.css"]
html_js_files = ["wide.js", "drag.js"]
html_extra_path = ["whole"]  # a page that is whole already: the drive
html_show_sphinx = html_show_copyright = html_show_sourcelink = html_copy_source = False
html_math_renderer = "mathml"
nb_execution_mode = "off"  # the notebooks are shown as they were executed
nb_render_markdown_format = "gfm"  # their outputs have tables
nb_code_prompt_show, nb_code_prompt_hide = "Show the code", "Hide the code"
myst_enable_extensions = ["amsmath", "colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
add_module_names = False
autodoc_preserve_defaults = True  # DEFAULT, not all of its numbers
autodoc_typehints_format = "short"
default_role = "literal"  # `a name` in a docstring
python_use_unqualified_type_names = True
python_maximum_signature_line_length = 88  # a longer one gets a line for each argument
suppress_warnings = ["myst.header"]  # a printed table may begin with a heading of its own
pygments_style, pygments_dark_style = "friendly", "monokai"


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


def fields_of(kind, indent=""):
    """A dataclass's fields, a point each: the comment that says its unit and its source, or what its parts are."""
    for field in dataclasses.fields(kind):
        said = re.search(rf"^    {field.name}: .*?  # (.*)", inspect.getsource(kind), re.M)
        inner = dataclasses.is_dataclass(field.type)
        words = said[1] if said else inspect.getdoc(field.type).splitlines()[0] if inner else ""
        yield f"{indent}- ``{field.name}``{words and ': '}{words}"
        if inner:
            yield from ("", *fields_of(field.type, indent + "  "), "")


def list_fields(app, what, name, value, options, lines):
    if dataclasses.is_dataclass(value):
        lines += fields_of(value)


# The search shows words with what stands around them, and reads other pages to do so. From a file, without a server, a
# page may not: then it takes the texts from here.
OFFLINE = """const TEXTS = %s;
if (location.protocol === "file:") {
  window.fetch = address => {
    const name = decodeURI(address).replace(/^(\\.\\/)+/, "").replace(/\\.html.*$/, "");
    return Promise.resolve({text: () => Promise.resolve(`<div role="main">${TEXTS[name] || "–"}</div>`)});
  };
}
"""


def write_texts(app, error):
    """The text of every page as a script of the page that searches."""
    if error is None and app.builder.format == "html":
        texts = {}
        for name in sorted(app.env.found_docs):
            page = app.env.get_doctree(name)
            for raw in list(page.findall(nodes.raw)):
                raw.parent.remove(raw)
            texts[name] = html.escape(" ".join(page.astext().split()), quote=False)
        path = app.outdir / "_static" / "texts.js"
        path.write_text(OFFLINE % json.dumps(texts, ensure_ascii=False), encoding="utf-8")


def add_texts(app, page, template, context, doctree):
    if page == "search":
        app.add_js_file("texts.js")


def setup(app):
    app.connect("build-finished", write_texts)
    app.connect("html-page-context", add_texts)
    app.connect("autodoc-process-docstring", list_fields)
    app.add_html_math_renderer("mathml", (skip_children(inline_math), None), (skip_children(display_math), None))

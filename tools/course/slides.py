"""Slides of each lesson, made from its executed notebook: every prediction, then the figure or table that follows it.

One HTML file a lesson (book/slides.html with its slides filled in), which needs neither a server nor the network. What
is printed, code, exercises and explanations are left out: a lecturer shows, asks and talks.
"""

import json
import re
from collections.abc import Iterator
from pathlib import Path

from markdown_it import MarkdownIt
from mdit_py_plugins.dollarmath import dollarmath_plugin

from bootcourse.markup import Markup, html
from tools.course.instructor import predictions
from tools.course.mathematics import mathml
from tools.course.source import NOTEBOOKS

LEARNT = "What you now know"
LONG = 14  # lines of a table: a longer one is printed smaller
PAGE = """# Slides

One file for each lesson, made from its figures and tables: each prediction first, then what answers it. The files need
no network: download one, or open it here. The arrow keys, space, Home and End turn the slides, a swipe does on a
phone, and your browser's *Print* makes a PDF of them. To show something move, open the lesson beside them.

"""


def fill(book: Path) -> None:
    """Write the slides of all lessons below `book`, and the page that links to them."""
    template = (book / "slides.html").read_text(encoding="utf-8")
    (book / "slides.html").unlink()
    folder, links = book / "whole/slides", []
    folder.mkdir(parents=True)
    for path in sorted(NOTEBOOKS.glob("*.ipynb")):
        cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
        title = re.match(r"# (.+)", text_of(cells[0]))[1]
        shown = list(slides(cells))
        numbered = [f'<section tabindex="-1">{slide}<footer>{number} / {len(shown)}</footer></section>'
                    for number, slide in enumerate(shown, start=1)]  # fmt: skip
        page = template.replace("{{ title }}", html("{}", title)).replace("{{ slides }}", "\n".join(numbered))
        (folder / f"{path.stem}.html").write_text(page, encoding="utf-8")
        links.append(f'- <a href="../slides/{path.stem}.html">{html("{}", title)}</a> ({len(shown)} slides)')
    (book / "teaching/slides.md").write_text(PAGE + "\n".join(links) + "\n", encoding="utf-8")


def slides(cells: list[dict]) -> Iterator[str]:
    """The slides of a lesson, as HTML: its aims, predictions, figures and tables in their order, what was learnt."""
    yield markdown(text_of(cells[0]))
    heading, quoted = "", ""
    for cell in cells[1:]:
        text = text_of(cell)
        if cell["cell_type"] == "markdown":
            headings = re.findall(r"^##+ (.+)", text, re.M)
            heading = headings[-1] if headings else heading
            quoted = "\n\n".join(predictions(text)) or quoted
            if heading == LEARNT:
                yield from map(markdown, re.split(r"\n+(?=\*\*Three questions)", text))
            continue
        for output in cell["outputs"]:
            data = {kind: "".join(parts) for kind, parts in output.get("data", {}).items()}
            for body in shown(data, quoted):
                yield f"<h2>{markdown(heading, inline=True)}</h2>{body}"
        quoted = "" if text.startswith("predict(") or "\npredict(" in text else quoted


def shown(data: dict[str, str], quoted: str) -> Iterator[str]:
    """What a slide shows of an output: a prediction with the text that leads to it, a table, or each picture."""
    page = data.get("text/html", "")
    if asked := re.search(r'<div class="bc-prediction"><strong>(.*?)</strong>(.*?)(<ul>.*?</ul>)?<div>', page, re.S):
        number, question, choices = asked.groups("")
        yield f"{markdown(quoted)}<p><strong>{number}.</strong>{question}</p>{choices}"
    elif "text/markdown" in data:
        long = " long" * (data["text/markdown"].count("\n") > LONG)
        yield f'<div class="wide{long}">{markdown(data["text/markdown"])}</div>'
    elif "<details>" not in page:
        moves = "" if "bc-figure" in page else "<p class='note'>A picture of what moves in the notebook.</p>"
        for picture in re.findall(r"<img [^>]*>", page):
            bare = re.sub(r' (?:style|class|width)="[^"]*"', "", picture)
            yield f'<div class="wide figure">{bare}</div>{moves}'


def text_of(cell: dict) -> str:
    return "".join(cell["source"])


def markdown(text: str, inline: bool = False) -> str:
    """Markdown as HTML, its equations as MathML, its links as text."""
    render = MarkdownIt("gfm-like", {"linkify": False, "html": False}).use(dollarmath_plugin, renderer=math)
    text = re.sub(r"(?<!!)\[([^]]*)\]\([^)]*\)", r"\1", text)
    return Markup(render.renderInline(text) if inline else render.render(text))


def math(latex: str, options: dict) -> str:
    return mathml(latex, "block" if options["display_mode"] else "inline")

"""What only the notebooks need: exercises and their checks, the library's own source, live curves, small figures."""

import inspect
import re
import textwrap
from collections.abc import Sequence
from pkgutil import resolve_name

from bootcourse.course.predictions import compare_predictions, predict, predicted
from bootcourse.course.too_early import hint_at_names
from bootcourse.terminal import printable

__all__ = ["compare_predictions", "predict", "predicted", "progress", "source", "table"]

hint_at_names()


def progress(lesson: str | None = None):
    """A card that says how far you are: see progress_card.py, which loads widgets."""
    from bootcourse.course.progress_card import progress

    return progress(lesson)


def table(headings: Sequence[str], rows: Sequence[Sequence[str]], below: str = ""):
    """A table as a notebook output. Its cells may be Markdown, and so may the sentence below it."""
    from IPython.display import Markdown

    from bootcourse.research.tables import markdown

    shown = f"{markdown(headings, rows)}\n{below}" if below else markdown(headings, rows)
    return Markdown(re.sub(r"(?<=[\s\[(])-(?=\d)", "−", shown))


def source(module: str, *names: str):
    """The library's own code of some functions, or of a "Class.method", as a notebook output: it is what runs.

    It is folded, since it may be the answer to an exercise. A compiled function holds its Python.
    """
    from IPython.display import Code

    parts = [resolve_name(f"{module}:{name}") for name in names]
    texts = [textwrap.dedent(inspect.getsource(getattr(part, "py_func", part))).rstrip() for part in parts]
    code = Code("\n\n".join(texts), language="python")
    listed = ", ".join(f"<code>{name}</code>" for name in names)
    html = f"<details><summary>{module}: {listed}</summary>{code._repr_html_()}</details>"
    return Folded(html, f"{module}: {', '.join(names)}\n\n{code.data}")


class Folded:
    """An output that a click opens; in plain text all of it."""

    def __init__(self, html: str, text: str):
        self.html, self.text = html, text

    def _repr_html_(self) -> str:
        return self.html

    def __repr__(self) -> str:
        return printable(self.text)

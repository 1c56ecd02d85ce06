"""What only the notebooks need: exercises and their checks, the library's own source, live curves, small figures."""

import importlib
import inspect
import operator
import sys
import textwrap
from collections.abc import Sequence

from bootcourse.lessons.predictions import compare_predictions, predict

__all__ = ["code_of", "compare_predictions", "predict", "source", "table", "text_of"]

if "IPython" in sys.modules and (_shell := sys.modules["IPython"].get_ipython()) is not None:
    from bootcourse.lessons.order import install

    install(_shell)


def table(headings: Sequence[str], rows: Sequence[Sequence[str]], below: str = ""):
    """A table as a notebook output. Its cells may be Markdown, and so may the sentence below it."""
    from IPython.display import Markdown

    from bootcourse.study.tables import markdown

    return Markdown(f"{markdown(headings, rows)}\n{below}" if below else markdown(headings, rows))


def source(module: str, *names: str):
    """The library's own code of some functions, or of a "Class.method", as a notebook output: it is what runs."""
    return code_of(*(operator.attrgetter(name)(importlib.import_module(module)) for name in names))


def code_of(*functions):
    """The same for functions at hand."""
    from IPython.display import Code

    return Code("\n\n".join(text_of(function) for function in functions), language="python")


def text_of(function) -> str:
    """A function's code; a compiled function holds its Python."""
    return textwrap.dedent(inspect.getsource(getattr(function, "py_func", function))).rstrip()

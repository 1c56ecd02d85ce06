"""A progress bar: tqdm's, which a pipe or a file gets as a line every ten seconds."""

import sys

from tqdm.auto import notebook_tqdm, tqdm
from tqdm.std import tqdm as in_text


class Lines(in_text):
    """A bar that is not redrawn: each state of it is a line."""

    @staticmethod
    def status_printer(file):
        return lambda state: print(state, file=file, flush=True)


def progress_bar(iterable=None, shown: bool = True, **options) -> in_text:
    """A bar over an iterable, or one to `update`; options: tqdm's, such as total and unit."""
    shown = shown and sys.stderr is not None  # a program without a console, such as pythonw, has none
    if notebook_tqdm is not in_text or (shown and sys.stderr.isatty()):
        return tqdm(iterable, disable=not shown, mininterval=0.5, **options)
    return Lines(iterable, disable=not shown, mininterval=10.0, **options)


def end_full(bar: in_text) -> None:
    """Make what is done the whole of a bar. tqdm itself leaves the bar of a notebook as short as it was."""
    bar.total = bar.n
    if hasattr(bar, "container"):
        _, drawn, _ = bar.container.children
        drawn.max = bar.n

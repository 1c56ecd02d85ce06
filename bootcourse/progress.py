"""A progress bar: tqdm's in a terminal and in a notebook, elsewhere a line of text every ten seconds."""

import sys

from tqdm.auto import notebook_tqdm, tqdm
from tqdm.std import tqdm as in_text

SECONDS_BETWEEN = 10.0  # of lines, where no terminal redraws the last one


class Lines(in_text):
    """tqdm's bar as one line after the other, for a pipe or a file."""

    @staticmethod
    def status_printer(file):
        before = ""

        def write(line: str) -> None:
            nonlocal before
            file.write(before + line)
            file.flush()
            before = "\n"  # tqdm ends the last line itself

        return write


def progress_bar(iterable=None, shown: bool = True, **options) -> in_text:
    """A bar over an iterable, or one to `update`; options: tqdm's, such as total and unit."""
    in_a_notebook = notebook_tqdm is not in_text
    if in_a_notebook or sys.stderr.isatty():
        return tqdm(iterable, disable=not shown, mininterval=0.5, **options)
    return Lines(iterable, disable=not shown, mininterval=SECONDS_BETWEEN, miniters=1, **options)

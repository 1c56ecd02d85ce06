"""The exception for user mistakes, suggestions for misspelt words, and the check of a whole number."""

import operator


class BootcourseError(ValueError):
    """A user mistake, in one sentence: the wrong value and the remedy. Any other exception is a bug in bootcourse.

    The command line prints the sentence and exits with status 2; a notebook shows it as the error's last line.
    """


def did_you_mean(word: str, choices) -> str:
    """A clause for an error message: `word` is unknown, the most similar choice, all choices."""
    import difflib

    choices = [str(choice) for choice in choices]
    close = difflib.get_close_matches(str(word), choices, n=1, cutoff=0.4)
    hint = f"did you mean '{close[0]}'? " if close else ""
    return f"'{word}' is unknown: {hint}choose from {', '.join(choices)}"


def whole(value, called: str, high: int = 2**63 - 1, low: int = 0) -> int:
    """A whole number, Python's or NumPy's, as an int. called: its name in the error.

    Raises BootcourseError for anything else, and for a number outside low..high.
    """
    try:
        number = None if isinstance(value, bool) else operator.index(value)
    except TypeError:
        number = None
    if number is None or not low <= number <= high:
        raise BootcourseError(f"{called} = {value!r:.80}: give a whole number from {low} to {high:,}.")
    return number

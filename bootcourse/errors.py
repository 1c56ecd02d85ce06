"""The one exception that bootcourse raises for a mistake that its user can mend."""


class BootcourseError(ValueError):
    """One clear sentence: the value that was wrong, and what to do about it.

    The command line prints the sentence and exits with status 2; a notebook shows it as the last
    line of the error. Anything else that is raised is a bug of ours.
    """


def did_you_mean(word: str, choices) -> str:
    """`word` in a sentence that offers the choices, the most similar one first."""
    import difflib

    choices = [str(choice) for choice in choices]
    close = difflib.get_close_matches(str(word), choices, n=1, cutoff=0.4)
    hint = f"did you mean '{close[0]}'? " if close else ""
    return f"'{word}' is unknown: {hint}choose from {', '.join(choices)}"

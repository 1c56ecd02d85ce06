"""The exceptions for user mistakes, suggestions for misspelt words, and small checks."""

import difflib
import operator
from collections.abc import Collection


class BootcourseError(ValueError):
    """A user mistake, in one sentence: the wrong value and the remedy. Any other exception is a bug in bootcourse.

    The command line prints the sentence and exits with status 2; a notebook shows it as the error's last line.
    """


class RuleFailed(BootcourseError):
    """A user's rule raised an exception, which is the `__cause__`, or returned something that is not an action.

    state: what the rule was asked about, so that it can be asked again: cars (vehicles, 10) or an observation off the
    trap; all roads at once for a rule that answers for all of them.
    """

    def __init__(self, name: str, how: str, where: str, state):
        super().__init__(name, how, where, state)
        self.sentence, self.state = f"Your rule '{name}' failed {where}: it {how}.", state

    def __str__(self) -> str:
        return self.sentence


def described(error: BaseException) -> str:
    """An exception's type and message in one line, without a full stop."""
    return f"{type(error).__name__}: {' '.join(str(error).split())}".rstrip(".: ")


FEW = 40  # choices that a message lists


def did_you_mean(word: str, choices) -> str:
    """A clause for an error message: `word` is unknown, the most similar choice, and the others if they are few."""
    choices = [str(choice) for choice in choices]
    close = difflib.get_close_matches(str(word), choices, n=1, cutoff=0.4)
    hint = f"did you mean '{close[0]}'? Choose" if close else "choose"
    if len(choices) > FEW:
        near = ", ".join(difflib.get_close_matches(str(word), choices, n=6, cutoff=0))
        return f"'{word}' is unknown: {hint} one of {len(choices)}, such as {near}"
    return f"'{word}' is unknown: {hint} from {', '.join(choices)}"


def require(holds: bool, sentence: str) -> None:
    """Raise BootcourseError with this sentence unless the condition holds."""
    if not holds:
        raise BootcourseError(sentence)


def check_known(called: str, word: str, choices: Collection[str]) -> None:
    """Raise BootcourseError, with the most similar choice, unless the word is one of them. called: what it names."""
    if word not in choices:
        raise BootcourseError(f"{called} {did_you_mean(word, choices)}.")


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

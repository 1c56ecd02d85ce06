"""Predictions: a student commits to an answer before the cell that shows it, and the lesson's end compares.

They are kept in `answers/predictions.json` beside the notebooks, each with its question and the time, under a name such
as "the_barrier.1" that stays when a lesson gets another number. The first answer to a question stays.
`prediction_form.py` is the form that a notebook shows.
"""

import contextlib
import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from filelock import FileLock, Timeout

from bootcourse.course.lessons import LESSONS, number
from bootcourse.course.notebook import beside_the_notebook
from bootcourse.errors import BootcourseError, check_known
from bootcourse.files import read_json, write_json
from bootcourse.markup import html
from bootcourse.terminal import printable

FILE = Path("answers/predictions.json")  # in the folder of the notebooks
LONGEST = 2000  # characters of an answer
PATIENCE = 20  # seconds that a notebook waits for another one that writes
NAME = re.compile(rf"({'|'.join(LESSONS)})\.\d{{1,2}}")
NOTHING = "You committed to no prediction in this lesson."
after_commit: list[Callable[[], None]] = []  # called when something new is kept, such as by progress_card.py


@dataclass(frozen=True)
class Question:
    """What a lesson asks. name: "the_barrier.1"; choices: () for a free answer; unit: None for an answer in words."""

    name: str
    text: str = ""
    choices: tuple[str, ...] = ()
    unit: str | None = None

    def __post_init__(self):
        if not NAME.fullmatch(str(self.name)):
            raise BootcourseError(f'The prediction {self.name!r}: give its lesson and its place, as "the_barrier.1".')

    @property
    def number(self) -> str:
        """As the page shows it, such as "5.1"."""
        return number_of(self.name)

    def read(self, answer: object) -> str | float:
        """The answer as it is kept. Raises BootcourseError if it is empty, no choice, or no number where one is due."""
        words = " ".join(str("" if answer is None else answer).split())
        if not words:
            what = "choose an answer" if self.choices else "write an answer"
            raise BootcourseError(f"Prediction {self.number} is empty: {what}, then commit to it.")
        if len(words) > LONGEST:
            raise BootcourseError(f"Prediction {self.number} has {len(words)} characters: use at most {LONGEST}.")
        if self.choices:
            check_known(f"Prediction {self.number}: the answer", words, self.choices)
        return words if self.unit is None else self._number(words)

    def _number(self, words: str) -> float:
        try:
            value = float(words.removesuffix(self.unit))
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise BootcourseError(f"Prediction {self.number} = '{words}': give a number such as 1200 or 12.5.")
        return value


def number_of(name: str) -> str:
    """The number of a prediction as the page shows it: "the_barrier.1" -> "5.1"; what is no lesson's stays."""
    lesson, _, place = name.partition(".")
    return f"{number(lesson)}.{place}" if lesson in LESSONS else name


def predictions(folder: Path | None = None) -> dict[str, dict]:
    """What a student has committed to: name -> question, choices, unit, answer, time (UTC). {} if nothing.

    folder: that of the notebooks; by default that of this one. Raises BootcourseError for a damaged file.
    """
    path = (beside_the_notebook() if folder is None else folder) / FILE
    if not path.exists():
        return {}
    entries = read_json(path, dict[str, dict])
    if not all("answer" in one for one in entries.values()):
        raise BootcourseError(f"{path} is damaged: a prediction has no answer. Delete it, or restore it from a copy.")
    return entries


def commit(question: Question, answer: object) -> dict:
    """Keep the answer, unless the question has one already. Returns what is kept. Raises BootcourseError."""
    one = predictions().get(question.name) or {
        "question": question.text,
        "choices": list(question.choices),
        "unit": question.unit,
        "answer": question.read(answer),
        "time": datetime.now(UTC).isoformat(timespec="seconds"),
    }
    file = beside_the_notebook() / FILE
    with alone_with(file):  # another notebook may have written since
        entries = predictions()
        if question.name not in entries:
            write_json(file, entries | {question.name: one})
    for call in after_commit:
        call()
    return entries.get(question.name, one)


@contextlib.contextmanager
def alone_with(path: Path) -> Iterator[None]:
    """No other process that asks for the same is between reading a file and writing it. Raises BootcourseError."""
    path = Path(path).absolute()
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        lock = FileLock(path.with_name(f".{path.name}.lock"), timeout=PATIENCE)
        lock.acquire()
    except Timeout:
        raise BootcourseError(f"Another program has locked {path} for {PATIENCE} s: end it, then try again.") from None
    except OSError as error:
        raise BootcourseError(f"Cannot write {path}: {error.strerror}. Choose another folder.") from None
    try:
        yield
    finally:
        lock.release()


def predict(
    name: str, question: str = "", choices: Sequence[str] = (), *, unit: str | None = None, answer: object = None
):
    """A form to commit to a prediction: radio buttons for `choices`, a number field for a `unit`, else a text field.

    name: the lesson and the question's place in it, "the_barrier.1". unit: of the number, "" for one without a unit.
    answer: commit to this and show no form, where a notebook shows no widgets. Raises BootcourseError for a wrong name,
    or an answer that is not accepted.
    """
    asked = Question(name, question, tuple(map(str, choices)), unit)
    if answer is None:
        from bootcourse.course.prediction_form import PredictionForm

        return PredictionForm(asked)
    return Note(committed(commit(asked, answer), asked.read(answer)))


def committed(entry: dict, wanted: object = None) -> str:
    """The sentence after a commitment; `wanted` is what was asked to be kept now, if that is something else."""
    shown = worded(entry["answer"], entry.get("unit"))
    if wanted not in (None, entry["answer"]):
        return f"You have committed to “{shown}” before, and the first prediction stays."
    return f"You predict: {shown}."


def worded(answer: object, unit: str | None = None) -> str:
    """An answer in words, with its unit."""
    words = f"{answer:.6g}" if isinstance(answer, float) and abs(answer) < 1e6 else str(answer)
    return f"{words} {unit}" if unit else words


def predicted(name: str) -> None:
    """Show what was predicted, on top of the cell that answers it. Raises BootcourseError for a damaged file."""
    from IPython.display import display

    number, one = Question(name).number, predictions().get(name)
    if one is None:  # JupyterLab shows these words where it folds the answer
        display({"text/plain": f"Below is the answer to prediction {number}."}, raw=True)
    else:
        display(Note(f"You predicted ({number}): {worded(one['answer'], one.get('unit'))}. Was it so?"))


def compare_predictions(lesson: str, answers: Mapping[int, object]):
    """A table of what the student predicted and what the lesson found, for the lesson's last cell.

    lesson: its name; answers: {1: what the lesson found for the prediction LESSON.1, in words or a number}. Raises
    BootcourseError for no lesson, and for a damaged file.
    """
    from IPython.display import display

    from bootcourse.course import table

    check_known("The lesson", lesson, LESSONS)
    predicted, rows = predictions(), []
    for place, result in answers.items():
        one = predicted.get(f"{lesson}.{place}")
        if one is not None:
            unit = one.get("unit")
            both = worded(one["answer"], unit), worded(result, unit if isinstance(result, (int, float)) else None)
            cells = f"{number(lesson)}.{place}", one.get("question", ""), *both
            rows.append([str(html("{}", cell)) for cell in cells])
    if not rows:
        display({"text/plain": "Your predictions, and the answers:"}, raw=True)  # as in `predicted`
        results = (f"{number(lesson)}.{place}: {worded(result)}" for place, result in answers.items())
        return Note(f"{NOTHING} The answers are: {'; '.join(results)}.")
    below = f"You committed to {len(rows)} of {len(answers)} predictions."
    return table(("", "question", "you predicted", "the lesson found"), rows, below)


@dataclass(frozen=True)
class Note:
    """A sentence as a cell's output."""

    sentence: str

    def __repr__(self) -> str:
        return printable(self.sentence)

    def _repr_html_(self) -> str:
        return str(html('<div role="status">{}</div>', self.sentence))

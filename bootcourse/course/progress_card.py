"""How far somebody is: predictions committed, exercises passed, and what these still take.

Passed exercises are kept in `answers/progress.json` beside the notebooks, predictions in `answers/predictions.json`;
so the card says the same after a restart. Nothing is written before something is committed or passes.
"""

import re
from pathlib import Path

import ipywidgets as widgets

from bootcourse import one_per_cell
from bootcourse.colours import GRID
from bootcourse.course import predictions
from bootcourse.course.classroom.answers import read_notebook
from bootcourse.course.lessons import LESSONS, minutes_of, stem
from bootcourse.course.notebook import beside_the_notebook
from bootcourse.errors import BootcourseError, check_known
from bootcourse.files import COPY, read_json, write_json
from bootcourse.markup import Markup, html
from bootcourse.methods import style

FILE = Path("answers/progress.json")  # in the folder of the notebooks
CARD = (
    '<div class="bc-progress" role="status" style="max-width: 560px; font: 13px system-ui">{}'
    f'<div style="height: 4px; background: {GRID}; margin-top: 3px">'
    f'<div style="height: 4px; width: {{}}%; background: {style("rule").colour}"></div></div></div>'
)
ASKS = r"(?<![\w.])predict\(\s*\"({}\.\d+)"


def passed() -> set[str]:
    """The exercises that have passed. Raises BootcourseError for a damaged file."""
    path = beside_the_notebook() / FILE
    return set(read_json(path, dict[str, list[str]]).get("passed", [])) if path.exists() else set()


def note_passed(exercise: str) -> None:
    """Keep that an exercise has passed, and show it in the open cards. Raises BootcourseError."""
    path = beside_the_notebook() / FILE
    with predictions.alone_with(path):
        if exercise not in (before := passed()):
            write_json(path, {"passed": sorted(before | {exercise})})
    refresh()


def asked_in(lesson: str) -> set[str]:
    """The predictions that a lesson's notebook asks for. Raises BootcourseError for a notebook that cannot be read."""
    file = beside_the_notebook() / f"{stem(lesson)}.ipynb"
    code = read_notebook(file, COPY).code if file.exists() else []
    return {name for cell in code for name in re.findall(ASKS.format(lesson), cell.text)}


class ProgressCard(widgets.HTML):
    """The card of some lessons; it changes when a prediction is committed or an exercise passes."""

    def __init__(self, lessons: tuple[str, ...]):
        self.lessons = lessons
        super().__init__()
        self.refresh()
        one_per_cell.replace_with(self)

    def refresh(self) -> None:
        """Read what is kept, and show it."""
        self.value = self.page()

    def close(self) -> None:
        """Close the card; nothing changes it any more."""
        one_per_cell.forget(self)
        super().close()

    def page(self, kept: bool = True) -> Markup:
        """The card's text; kept: False as somebody sees it who has done nothing yet."""
        minutes = {name: each for lesson in self.lessons for name, each in minutes_of(lesson).items()}  # of exercises
        try:
            done, known = (passed(), predictions.predictions()) if kept else ((), ())
            asked = {name for lesson in self.lessons for name in asked_in(lesson)}
        except BootcourseError as error:
            return html('<div class="bc-progress" role="alert">{}</div>', str(error))
        committed = {name for name in known if name.partition(".")[0] in self.lessons}
        asked |= committed  # where there is no notebook
        right = minutes.keys() & set(done)
        left = sum(each for name, each in minutes.items() if name not in done)
        where = "This lesson" if len(self.lessons) == 1 else "The course"
        words = f"{where}: {len(committed)} of {len(asked)} predictions committed, {len(right)} of {len(minutes)} "
        words += f"exercises right, {left} minutes of exercises to go." if minutes else "exercises."
        share = (len(committed) + len(right)) / max(1, len(asked) + len(minutes))
        return html(CARD, words, round(100 * share))

    def _repr_mimebundle_(self, **kwargs) -> dict:
        """The same in every saved notebook, whatever is kept."""
        page = str(self.page(kept=False))
        return super()._repr_mimebundle_(**kwargs) | {"text/html": page, "text/plain": re.sub("<[^>]*>", "", page)}


def refresh() -> None:
    """Show in the open cards what is kept now."""
    for card in one_per_cell.running():
        if isinstance(card, ProgressCard):
            card.refresh()


def progress(lesson: str | None = None) -> ProgressCard:
    """A card that says how far you are in a lesson, or in the whole course. Raises BootcourseError for no lesson."""
    if lesson is not None:
        check_known("The lesson", lesson, LESSONS)
    return ProgressCard(LESSONS if lesson is None else (lesson,))


predictions.after_commit.append(refresh)

"""A line of the leaderboard, and the file in which lines are kept. The table is in board.py."""

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

from msgspec import Meta, Struct, convert, to_builtins
from msgspec.structs import replace as changed

from bootcourse.errors import BootcourseError
from bootcourse.files import decoding
from bootcourse.research.beyond import DECISIONS, SECONDS, Within
from bootcourse.research.tables import bracketed
from bootcourse.statistics import Estimate
from bootcourse.storage.sealed import read_sealed, write_sealed

LONGEST = 48  # letters of a name that a table shows
MOST = 1e6  # of a return
FORMAT = "bootcourse board 1"
HEADINGS = (
    "method", "setting", "escape", "drives %", "return [95 %]", "best %", "accidents %", "decisions", "seconds",
    f"at {DECISIONS[0]:,} [95 %]", f"at {SECONDS[0]} s",
)  # fmt: skip

Share = Annotated[float, Meta(ge=0, le=1)]
Cost = Annotated[float, Meta(ge=0)]
Name = Annotated[str, Meta(max_length=1000)]


class Row(Struct, frozen=True, forbid_unknown_fields=True):
    """One line of the board. None: not known."""

    method: Name
    setting: Name
    agents: Annotated[int, Meta(ge=1)]
    returns: Estimate
    escapers: Annotated[int, Meta(ge=0)] | None = None  # agents that escape
    success: Share | None = None  # of all drives
    accidents: Share | None = None  # of all drives
    decisions: Cost | None = None  # of training, per agent
    seconds: Cost | None = None  # of training, per agent, on one core
    own: bool = False  # entered by the user
    at_decisions: Within | None = None  # in training, after the first of `DECISIONS`
    at_seconds: Within | None = None  # in training, after the first of `SECONDS`

    def __post_init__(self):
        value, low, high = self.returns
        wrong = not -MOST <= low <= high <= MOST or not abs(value) <= MOST or (self.escapers or 0) > self.agents
        for its in filter(None, (self.at_decisions, self.at_seconds)):
            low, high = its.limits or (0, 0)
            wrong |= not -MOST <= low <= high <= MOST or not abs(its.returns) <= MOST
            wrong |= not 1 <= its.agents <= self.agents
        if wrong:
            raise ValueError(f"the numbers of {self.method!r:.40} contradict each other")

    def cells(self, best: float) -> list[str]:
        """In words, in the order of `HEADINGS`. best: the planner's return."""
        shares = [None if share is None else f"{100 * share:.1f}" for share in (self.success, self.accidents)]
        costs = [None if cost is None else f"{cost:,.0f}" for cost in (rounded(self.decisions), self.seconds)]
        budgets = [self.at_decisions and self.at_decisions.words(self.agents)]
        budgets.append(self.at_seconds and f"{self.at_seconds.returns:.0f}")
        escapers = None if self.escapers is None else f"{self.escapers} of {self.agents}"
        found = [
            escapers,
            shares[0],
            bracketed(self.returns),
            f"{100 * self.returns.value / best:.0f}",
            shares[1],
            *costs,
            *budgets,
        ]
        return [_short(self.method), _short(self.setting), *("–" if cell is None else cell for cell in found)]


def rounded(decisions: float | None) -> float | None:
    """To thousands, from a thousand on."""
    return decisions if decisions is None or decisions < 1000 else round(decisions, -3)


def _short(name: str) -> str:
    """A name on one line, its middle left out if it is long, without control characters, which a terminal obeys."""
    name = "".join(letter if letter.isprintable() else "?" for letter in name)
    return name if len(name) <= LONGEST else f"{name[: LONGEST // 2]}…{name[1 - LONGEST // 2 :]}"


class Kept(Struct, forbid_unknown_fields=True):
    """What the file of `keep` holds, beside its seal."""

    format: str
    rows: list[Row]


def kept_rows(path: Path) -> list[Row]:
    """The rows in a file to which others will be added; none if it is not there. Raises BootcourseError as above."""
    if path.suffix != ".json":
        raise BootcourseError(f"{path} does not end in .json: give the file that ending.")
    return read_rows(path) if path.exists() else []


def read_rows(path: Path) -> list[Row]:
    """The rows that `keep` wrote. Raises BootcourseError if the file is missing or damaged."""
    content = read_sealed(path, FORMAT)
    with decoding(path):
        return [changed(row, own=True) for row in convert(content, Kept).rows]


def keep_rows(path: Path, before: Sequence[Row], mine: Sequence[Row]) -> list[Row]:
    """Write both to a file; of two rows with the same method and setting, mine. Returns what the file holds."""
    rows = list({(row.method, row.setting): row for row in (*before, *mine)}.values())
    write_sealed(path, {"format": FORMAT, "rows": to_builtins(rows)})
    return rows

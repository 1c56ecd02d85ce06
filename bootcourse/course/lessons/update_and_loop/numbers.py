"""What the text of the lesson on SAC's update and loop names: the agents of the experiment `pole`, as they ship."""

from functools import cache

import numpy as np

from bootcourse.course.lessons.update_and_loop import by_hand
from bootcourse.course.lessons.update_and_loop.pole import BLOCK, KINDS, SOLVED
from bootcourse.course.lessons.update_and_loop.worlds import BEFORE, GAMMA, to_one_side  # noqa: F401 (the text names γ)
from bootcourse.course.lessons.update_and_loop.worlds import along_falls as along
from bootcourse.course.shipped import shipped_experiment
from bootcourse.research.problems import cartpole
from bootcourse.research.results import Results


def fallen_at() -> float:
    """How far (degrees) a pole leans when it counts as fallen."""
    return float(np.degrees(cartpole().unwrapped.theta_threshold_radians))


@cache
def agents(kind: str = "marked") -> Results:
    """Those of one kind of the experiment `pole`."""
    return shipped_experiment("pole")[kind]


def tests() -> list[np.ndarray]:
    """The tests of each agent that learns with marks: before its training and after each block."""
    return [each[np.isfinite(each)] for each in agents().notes["tests"]]


def after_a_block(kind: str = "marked") -> np.ndarray:
    """For how many pushes each agent of a kind balances the pole after its first block, (agents,)."""
    return agents(kind).notes["tests"][:, 1]


LEARNED = 50  # pushes that an agent balances the pole at least if it has learned something


def stood(kind: str) -> np.ndarray:
    """For how many pushes each agent of a kind balances the pole after its first block, with those of more seeds."""
    return np.concatenate([after_a_block(each) for each in (kind, f"more-{kind}")])


def learned(kind: str) -> str:
    """How many of these have learned something, in words."""
    return f"{(stood(kind) > LEARNED).sum()} of {len(stood(kind))}"


def spread(kind: str) -> str:
    """The least and the most pushes of those that have learned something, in words."""
    pushes = stood(kind)[stood(kind) > LEARNED]
    return f"{pushes.min():.0f} to {pushes.max():.0f}" if len(pushes) else "–"


def others() -> np.ndarray:
    """For how many pushes the agents of all kinds balance the pole that have not learned anything."""
    pushes = np.concatenate([stood(kind) for kind in KINDS])
    return pushes[pushes <= LEARNED]


def along_falls(kind: str = "marked") -> np.ndarray:
    """What each agent of a kind expects along a fall after its first block, (agents, 9): see `worlds.along_falls`."""
    return agents(kind).notes["q"][:, : BEFORE + 1]


def expected(kind: str) -> np.ndarray:
    """The same, with the agents of more seeds."""
    return np.concatenate([along_falls(each) for each in (kind, f"more-{kind}")])


def drop(kind: str) -> bool:
    """Whether in all these agents Q of a fallen pole is less than a quarter of Q eight pushes before."""
    return bool((expected(kind)[:, -1] < expected(kind)[:, 0] / 4).all())


def worse(by: float = 50) -> int:
    """How many of those that train to the end balance the pole for so many pushes less in some test than before it."""
    return sum(bool((np.diff(each) < -by).any()) for each in tests())


def first_guess() -> float:
    """What the untrained critics of the seeds 0 to 4 make of a fallen pole: the largest mean over 40 falls."""
    return max(abs(float(along(by_hand.SAC(seed))[-1])) for seed in range(len(agents())))


def one_sided() -> float:
    """For how many pushes a pole stands that is pushed to one side only, a mean of `worlds.to_one_side`'s."""
    return float(np.mean([len(states) - 1 for states in to_one_side()]))


def solved() -> int:
    """How many solved the pole: two tests in a row reach the mark, and so does the mean of 100 episodes."""
    lasting = agents().measured["after"]
    return sum(min(*each[-2:], after) >= SOLVED for each, after in zip(tests(), lasting, strict=True))


def pushes() -> list[int]:
    """After how many pushes each stopped."""
    return [BLOCK * (len(each) - 1) for each in tests()]


def fell_at_once() -> int:
    """How many of those without marks balance the pole for less than 10 pushes after their block."""
    return int((after_a_block("unmarked") < 10).sum())


def unmarked() -> int:
    """How many of those without marks have a Q above all that is possible, most for a fallen pole, and fall at once."""
    q, most = along_falls("unmarked"), agents("unmarked").measured["most"]
    return int(((q.min(1) > most) & (q.argmax(1) == BEFORE) & (after_a_block("unmarked") < 10)).sum())


def possible(kind: str) -> int:
    """How many agents of a kind expect along a fall no more than is possible, with those of more seeds."""
    most = np.concatenate([agents(each).measured["most"] for each in (kind, f"more-{kind}")])
    return int((expected(kind).max(1) <= most).sum())

"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np

from bootcourse.course.lessons import registry
from bootcourse.course.lessons.your_own_problem import explorable, loops  # noqa: F401 (for the expressions)
from bootcourse.course.lessons.your_own_problem.cells import BONUSES, TWO, cells, entries
from bootcourse.course.lessons.your_own_problem.unpaid import BUDGETS, NAME, angle_rule, pole
from bootcourse.course.shipped import shipped_experiment
from bootcourse.research import elsewhere, elsewhere_claims  # noqa: F401
from bootcourse.research.equal_decisions import BOARD  # noqa: F401
from bootcourse.research.problems import PICK_UP, PROBLEMS, DoorKey  # noqa: F401
from bootcourse.research.tables import markdown
from bootcourse.statistics import iqm
from tools.course.known import of

TEACHERS = ("good", "random", "systematic")
SHOWN = [(p, t) for p in TWO for t in TEACHERS]


def score(problem: str, teacher: str, method: str, measure: str = "success") -> float:
    """The mean over agents of a cell, see `elsewhere_claims.Cells.scores`."""
    return cells().mean(problem, teacher, method, measure)


def unpaid(measure: str, decisions: int, kind: str = "without reward") -> np.ndarray:
    """What was measured of each of ten agents after so many decisions, (agents,), see unpaid.py."""
    return shipped_experiment(NAME)[kind].notes[measure][:, BUDGETS.index(decisions)]


def by_budget() -> str:
    """What they earn after each budget of the lesson and a longer one, means, as Markdown."""
    budgets = (500, 1_000, 3_000, 8_000)
    lines = {
        "return without reward": lambda n: unpaid("returns", n),
        "return with reward": lambda n: unpaid("returns", n, "with reward"),
        "without reward: decisions like the teacher's, %": lambda n: 100 * unpaid("copied", n),
    }
    rows = [[words, *(f"{of(n).mean():.0f}" for n in budgets)] for words, of in lines.items()]
    return markdown(["decisions in training", *(f"{n:,}" for n in budgets)], rows)


@cache
def teacher_earns() -> float:
    """What the angle rule earns on CartPole."""
    return loops.earns(angle_rule, pole)


def wrong_states() -> int:
    """In how many of DoorKey's states the random teacher gives a wrong label."""
    seen, taught, _, good = labels("doorkey")
    return loops.states(seen[taught != good])


def flags() -> list[float]:
    """Which share of the drives with both aids reaches MountainCar's flag with c = 2, for each teacher."""
    return [score("mountain-car", teacher, "both") for teacher in TEACHERS]


def wrong_labels() -> float:
    """The share of DoorKey's labels that are wrong."""
    _, taught, _, good = labels("doorkey")
    return float((taught != good).mean())


def clone_as_taught(once: bool) -> tuple[float, float]:
    """In which share of DoorKey's labels and states its clone does as taught: from all labels, or each state once."""
    seen, taught, cloned, _ = labels("doorkey", once) if once else labels("doorkey")
    return loops.as_taught(seen, taught, cloned)


def earned(teacher: str) -> float:
    """What a teacher of MountainCar earns."""
    return score("mountain-car", teacher, "the teacher", "returns")


def by_bonus(teacher: str) -> np.ndarray:
    """The success of both aids on DoorKey with each bonus of the figure, by drawn actions."""
    return np.array([score("doorkey", teacher, name, "drawn_success") for name in BONUSES.values()])


def loops_table() -> str:
    """How many drives of DoorKey reach the goal with c = 2, by drawn and by most probable actions, as Markdown."""
    kinds = [
        ("random teacher", "yes", "random", "both"),
        ("random teacher, only drives to the goal", "no", "random", elsewhere.WITHOUT_LOOPS),
        ("good teacher", "no", "good", "both"),
        ("none (plain SAC)", "–", "none", "SAC"),
    ]
    measures = ("drawn_success", "success")
    rows = [
        [*words, *(f"{100 * score('doorkey', teacher, how, of):.0f}" for of in measures)]
        for *words, teacher, how in kinds
    ]
    heads = ["demonstrations", "loops", "drawn actions", "most probable actions"]
    return markdown(heads, rows)


def entry_scores() -> list[float]:
    """The interquartile mean of each entry to the challenge: those with a teacher, which rise, and two without."""
    scores = {method: float(iqm(returns)) for method, returns in entries().items()}
    alone = [scores.pop(method) for method in ("ppo", "sac")]
    return sorted(scores.values()) + alone


def clone_earns() -> float:
    """What the clone of the course's rule earns on its road."""
    return float(iqm(of("bc").scores("returns")))


def drowning_bonus(*arguments: float) -> float:
    """The exercise's solution."""
    return registry()["drowning_bonus"](*arguments)


labels = cache(loops.labels)


def answer_in_the_loop() -> int:
    """What DoorKey's random teacher answers in the state that the lesson's drive does not leave."""
    state = np.array([loops.drive_in_a_loop()[-1]])
    return int(PROBLEMS["doorkey"].teachers()["random"](DoorKey(1).show(state, np.zeros(1)))[0])


def outvoted(problem: str) -> np.ndarray:
    """For each wrong label of a problem's random teacher: is its clone right there?"""
    _, taught, cloned, good = labels(problem)
    return (cloned == good)[taught != good]


@cache
def like_the_nearest(problem: str) -> float:
    """In which share of a problem's states in the labels, 1,500 at most, the nearest state needs the same action."""
    seen, _, _, good = labels(problem)
    first = np.random.default_rng(0).permutation(np.unique(seen, axis=0, return_index=True)[1])[:1_500]
    distance = ((seen[first, None] - seen[first]) ** 2).sum(axis=-1)
    np.fill_diagonal(distance, np.inf)
    nearest = distance == distance.min(axis=1, keepdims=True)
    same = nearest & (good[first, None] == good[first])
    return float((same.sum(axis=1) / nearest.sum(axis=1)).mean())

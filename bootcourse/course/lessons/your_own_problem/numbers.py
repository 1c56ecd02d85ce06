"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np

from bootcourse.course.lessons import number, registry
from bootcourse.course.lessons.your_own_problem import explorable, loops  # noqa: F401 (for the expressions)
from bootcourse.course.lessons.your_own_problem.cells import BONUSES, TWO, cells, entries
from bootcourse.course.lessons.your_own_problem.unpaid import BUDGETS, NAME, angle_rule, pole
from bootcourse.course.shipped import shipped_experiment
from bootcourse.episodes.evaluate import held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.learn.demonstrations import demonstrate
from bootcourse.learn.teachers import Rule
from bootcourse.policies import rule_policy
from bootcourse.research import elsewhere, elsewhere_claims  # noqa: F401
from bootcourse.research.equal_decisions import BOARD  # noqa: F401
from bootcourse.research.paper import PRINTED
from bootcourse.research.problems import PICK_UP, PROBLEMS, DoorKey  # noqa: F401
from bootcourse.research.tables import markdown
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import iqm
from tools.course.known import clocks, discounted, escaped, idle, of

TEACHERS = ("good", "random", "systematic")
FREE_OF_LOOPS = elsewhere.WITHOUT_LOOPS
SHOWN = [(p, t) for p in TWO for t in TEACHERS]


def score(problem: str, teacher: str, method: str, measure: str = "success") -> float:
    """The mean over agents of a cell, see `elsewhere_claims.Cells.scores`."""
    return cells().mean(problem, teacher, method, measure)


def unpaid(measure: str, decisions: int, kind: str = "without reward") -> np.ndarray:
    """What was measured of each of ten agents after so many decisions, (agents,), see unpaid.py."""
    return shipped_experiment(NAME)[kind].notes[measure][:, BUDGETS.index(decisions)]


@cache
def teacher_earns() -> float:
    """What the angle rule earns on CartPole."""
    return loops.earns(angle_rule, pole)


@cache
def together_with(rule: Rule) -> tuple[float, float]:
    """Of 20 drives of CartPole by a rule: the pole's speed for 1 m/s of the cart (a line's slope), and correlation."""
    seen = demonstrate(20, None, teacher=rule, make_env=pole).observations
    return float(np.polyfit(seen[:, 1], seen[:, 3], 1)[0]), float(np.corrcoef(seen[:, 1], seen[:, 3])[0, 1])


def pole_for_cart() -> float:
    """The first of these, by the angle rule."""
    return together_with(angle_rule)[0]


def plain(drawn: str = "") -> int:
    """How many of 100 drives of DoorKey by plain SAC reach the goal; "drawn_": by drawn actions."""
    return round(100 * score("doorkey", "none", "SAC", f"{drawn}success"))


def earned(teacher: str) -> float:
    """What a teacher of MountainCar earns."""
    return score("mountain-car", teacher, "the teacher", "returns")


def by_bonus(teacher: str) -> np.ndarray:
    """The success of both aids on DoorKey with each bonus of the figure, by drawn actions."""
    return np.array([score("doorkey", teacher, name, "drawn_success") for name in BONUSES.values()])


def above_the_good() -> int:
    """How many of the random teacher's clones on CartPole earn more than the good teacher."""
    good = score("cartpole", "good", "the teacher", "returns")
    return int((cells().scores("cartpole", "random", "cloning") > good).sum())


def goals(method: str, drawn: str = "") -> int:
    """How many of 100 drives with DoorKey's random teacher reach the goal; "drawn_": by drawn actions."""
    return round(100 * score("doorkey", "random", method, f"{drawn}success"))


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


@cache
def worth_of_the_rule() -> float:
    """What the rule's drives of 100 held-out roads are worth, discounted by γ = 0.8: the mean."""
    return float(np.mean([discounted(drive, 0.8) for drive in record(rule_policy(DEFAULT), held_out_seeds(1, 100))]))


def worths_by_the_rule() -> str:
    """What the rule's way out is worth at γ = 0.8, and staying."""
    return f"{worth_of_the_rule():.2f}, staying {discounted(idle(), 0.8):.2f} (γ = 0.8)"


def what_became() -> str:
    """What the paper says, what came of it here, and the lesson, as Markdown."""
    alone = [escaped("demos"), *(results.escapers("demos") for results in clocks().values())]
    earned = {method: f"{PRINTED[method]['returns'].mean:.0f}" for method in ("soft", "sac")}
    found = {method: f"{of(method).scores('returns').mean():.0f}" for method in ("soft", "sac")}
    rows = [
        ("SAC stays", f"{len(of('sac')) - escaped('sac')} stay", "the_trap"),
        ("the soft constraint alone stays", f"{escaped('soft')} get out", "soft_constraint"),
        (
            f"it does worse than SAC (the text), or better: return {earned['soft']} and {earned['sac']} (the table)",
            f"better: {found['soft']} and {found['sac']}",
            "soft_constraint",
        ),
        (
            "demonstrations alone lead out",
            f"{min(alone)} to {max(alone)} get out, by updates and demonstrator",
            "learning_from_demonstrations",
        ),
        (
            "both are best",
            f"not shown: {escaped('bootstrapped')} get out, with the soft constraint alone {escaped('soft')}",
            "learning_from_demonstrations",
        ),
        (
            "the bonus does better than the margin",
            f"not shown: with pull and margin {escaped('margin_soft')} get out",
            "learning_from_demonstrations",
        ),
        ("CQL and GAIL stay", f"{escaped('cql')} and {escaped('gail')} get out", "recorded_drives"),
        ("one number for each method", "other agents, other numbers", "how_many_seeds"),
    ]
    cells = [[said, became, str(number(lesson))] for said, became, lesson in rows]
    return markdown(["the paper", "here, of ten agents", "lesson"], cells)


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

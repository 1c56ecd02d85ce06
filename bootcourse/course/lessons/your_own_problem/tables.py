"""What ships of the study on other problems (`bootcourse/research/elsewhere.py`), in two tables."""

from functools import cache

from bootcourse.research.computed import experiment
from bootcourse.research.elsewhere_claims import Cells
from bootcourse.research.problems import PROBLEMS

THREE = ("mountain-car", "cartpole", "lander")
FOUR = ("cloning", "soft", "demonstrations", "both")
BONUSES = {f"c = {c}": f"both, c = {c}" for c in (0, 0.03, 0.1, 0.3, 1)} | {"c = 2": "both"}


@cache
def cells() -> Cells:
    return Cells(experiment("elsewhere"))


def returns() -> tuple[list[str], list[list[str]], str]:
    """What teachers and agents earn on three problems with both flawed teachers, for `table`."""
    rows = []
    for problem in THREE:
        good = cells().mean(problem, "good", "the teacher")
        for teacher in ("random", "systematic"):
            others = [cells().mean(problem, teacher, method) for method in ("the teacher", "SAC", *FOUR)]
            rows.append([f"{PROBLEMS[problem].name}, {teacher}", *(f"{each:.0f}" for each in (good, *others))])
    names = ["plain SAC", "clone", "soft constraint", "demonstrations", "both aids"]
    below = "Equal episodes: on CartPole an agent that balances longer practises more. Plain SAC has no teacher."
    return ["return", "good teacher", "this teacher", *names], rows, below


def bonuses() -> tuple[list[str], list[list[str]], str]:
    """How often agents with both aids reach the goal of DoorKey, by the bonus, for `table`."""
    rows = []
    for teacher in ("good", "random", "systematic"):
        means = [cells().mean("doorkey", teacher, "the teacher", "success")]  # of the rule itself: nothing is drawn
        for method in ("SAC", "cloning", *BONUSES.values()):
            means.append(cells().mean("doorkey", teacher, method, "drawn_success"))
        rows.append([f"{teacher} teacher", *(f"{100 * mean:.0f}" for mean in means)])
    below = "Both aids where c is given. Ten agents each, drawn actions. Plain SAC has no teacher."
    return ["DoorKey, success in %", "this teacher", "plain SAC", "clone", *BONUSES], rows, below

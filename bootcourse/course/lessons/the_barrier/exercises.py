"""Exercises of the lesson on the barrier."""

from bootcourse.course.exercise import exercise


def luck_cases(rng):
    """One attempt, every action good, one decision; then 50 at random."""
    yield from ((3, 2, 1), (9, 20, 5), (1, 1, 9), (1, 8, 1000))
    yield from ((rng.integers(1, 9), rng.integers(1, 8), rng.integers(1, 300)) for _ in range(50))


@exercise(
    "1 - (1 - (g/9)^n)^tries: the chance of a way out by chance", minutes=5, difficulty=2, cases=luck_cases,
    worked=[((3, 2, 1), 1 / 9), ((3, 1, 2), 5 / 9)],  # (1/3)²; 1 - (2/3)²
    hints=(
        "First one attempt: `good` of nine actions are right, `decisions` times in a row.",
        "Then all attempts: the chance that all of them fail is (1 - once) to the power of `tries`.",
    ),
    mistakes={
        "return tries * once":
            "Your chance can be above 1, because it counts two lucky attempts twice. Compute the chance that *every* "
            "attempt fails.",
        "return min(1.0, tries * once)":
            "You add the chances of the attempts, which counts two lucky ones twice. Compute the chance that *every* "
            "attempt fails.",
        "return (1 - once) ** tries":
            "This is the chance that *no* attempt is lucky. The chance of at least one is 1 minus that.",
        "return once":
            "This is the chance of one attempt. There are `tries` of them, and one lucky one is enough.",
        "return once**tries":
            "This is the chance that *all* attempts are lucky. One is enough.",
        "return 1 - (1 - good / 9) ** (decisions * tries)":
            "This is the chance that at least one decision is right. All decisions of one attempt have to be right.",
        "(good / 9) ** decisions -> min(1.0, decisions * good / 9)":
            "Within an attempt you add the chances. The chance that all decisions are right is their product.",
    },
)  # fmt: skip
def luck(good, decisions, tries):
    once = (good / 9) ** decisions
    return 1 - (1 - once) ** tries

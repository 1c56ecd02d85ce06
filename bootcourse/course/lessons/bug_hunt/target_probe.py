"""The exercise of the bug hunt in which a target function is tested from outside."""

import numpy as np

from bootcourse.course.exercise import exercise


def fixed_target(reward, is_demonstration, bonus, terminated, next_value, gamma):
    return reward + bonus * is_demonstration + gamma * (1 - terminated) * next_value


TARGETS = {  # what a learner might compute; the first three are right
    "as it is printed": fixed_target,
    "with where": lambda r, demo, c, end, v, gamma: np.where(demo > 0, r + c, r) + np.where(end > 0, 0, gamma * v),
    "in another order": lambda r, demo, c, end, v, gamma: gamma * (v - v * end) + demo * c + r,
    "no end": lambda r, demo, c, end, v, gamma: r + c * demo + gamma * v,
    "the end kept, the rest dropped": lambda r, demo, c, end, v, gamma: r + c * demo + gamma * end * v,
    "a bonus for all": lambda r, demo, c, end, v, gamma: r + c + gamma * (1 - end) * v,
    "no bonus": lambda r, demo, c, end, v, gamma: r + gamma * (1 - end) * v,
    "a bonus for the agent's own": lambda r, demo, c, end, v, gamma: r + c * (1 - demo) + gamma * (1 - end) * v,
    "a bonus of 2": lambda r, demo, c, end, v, gamma: r + 2 * demo + gamma * (1 - end) * v,
    "a bonus lost at the end": lambda r, demo, c, end, v, gamma: r + (1 - end) * (c * demo + gamma * v),
    "a discount of 0.8": lambda r, demo, c, end, v, gamma: r + c * demo + 0.8 * (1 - end) * v,
    "a discounted reward": lambda r, demo, c, end, v, gamma: gamma * (r + (1 - end) * v) + c * demo,
    "no discount": lambda r, demo, c, end, v, gamma: r + c * demo + (1 - end) * v,
    "only gains": lambda r, demo, c, end, v, gamma: np.maximum(r, 0) + c * demo + gamma * (1 - end) * v,
    "a mean over the batch": lambda r, demo, c, end, v, gamma: fixed_target(r, demo, c, end, v.mean() + 0 * v, gamma),
}
RIGHT_TARGETS = tuple(TARGETS)[:3]


def is_unmasked(answer, name):
    """What the student's probe says of one target function, called as the lesson says, by names or not."""

    def target(reward, demo, bonus, end, next_value, gamma):
        reward, demo, end, next_value = map(np.asarray, (reward, demo, end, next_value))
        return TARGETS[name](reward, demo, bonus, end, next_value, gamma)

    return answer(target)


def explain_probe(cases, answers):
    """Which target function the probe judged wrongly, or what it returned that is neither True nor False."""
    odd = next((answer for answer in answers if answer.shape != () or answer not in (0, 1)), None)
    if odd is not None:
        what = f"{float(odd):g}" if odd.shape == () else f"an array of shape {odd.shape}"
        return f"Your probe returns {what}: return True or False, for all transitions together."
    said = {name: set() for name in TARGETS}
    for (name,), answer in zip(cases, answers, strict=True):
        said[name].add(bool(answer))
    if any(len(verdicts) == 2 for verdicts in said.values()):
        return "Your probe judges the same function differently each time: draw its numbers once, with a fixed seed."
    if True in said["as it is printed"]:
        return "Your probe accuses the right target function: work out the y of your transitions by hand once more."
    if any(True in said[name] for name in RIGHT_TARGETS):
        return (
            "Your probe accuses a target function that is right, only written in another way: the last digit of a "
            "number may differ, so compare with `np.allclose`."
        )
    wrong = [name for name in TARGETS if name not in RIGHT_TARGETS]
    missed = [name for name in wrong if False in said[name]]
    return f"Your probe lets {len(missed)} of {len(wrong)} wrong target functions pass. One is '{missed[0]}'."


@exercise(
    "y = r + c·1[demonstration] + γ (1 - terminated) V(s'), tested from outside", minutes=15, difficulty=3,
    cases=lambda rng: [(name,) for name in TARGETS] * 2, run=is_unmasked, explain=explain_probe,
    worked=[(("as it is printed",), False), (("no end",), True)],
    hints=(
        "For the agent's own transition that goes on, y = r + γ V(s'); for a demonstration that has ended, y = r + c. "
        "Work out the other two in the same way.",
        "Choose numbers that no mistake can hit by chance: a bonus that is not 2, a γ that is not 0.8, next values "
        "that differ, one of them negative. Compare with `np.allclose`.",
    ),
    mistakes={
        "return False":
            "Your probe calls every target function right, the one without (1 - terminated) too.",
        "return True":
            "Your probe accuses every target function, the right one too.",
        "not np.allclose -> np.allclose":
            "Your answers are the other way round: return True for a target function that is wrong.",
        ("right = -> reward[1] = 1.0; right =",
         "return not np.allclose(target(reward[1:2], demo[1:2], 3.0, end[1:2], value[1:2], 0.5), right[1:2])"):
            "You look at one transition, an accident of the agent's own. It tests neither the bonus nor the discount.",
        "return not np.allclose(target(reward[:1], demo[:1], 3.0, end[:1], value[:1], 0.5), right[:1])":
            "You look at one transition that goes on. A target without (1 - terminated) is right there.",
    },
)  # fmt: skip
def unmasks(target):
    reward, value = np.array([1.0, -10.0, 0.5, -3.0]), np.array([4.0, 2.0, 7.0, -1.0])
    demo, end = np.array([0.0, 0.0, 1.0, 1.0]), np.array([0.0, 1.0, 0.0, 1.0])
    right = reward + 3.0 * demo + 0.5 * (1 - end) * value
    return not np.allclose(target(reward, demo, 3.0, end, value, 0.5), right)

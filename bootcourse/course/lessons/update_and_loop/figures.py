"""Figures of the lesson on SAC's update and loop: the pole before training, tests, scores, and what critics expect."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from IPython.display import Markdown
from matplotlib.figure import Figure

from bootcourse.colours import OTHER, STRANGERS
from bootcourse.course import charts, table
from bootcourse.course.dots import beside, dots, name_rows
from bootcourse.course.lessons.discrete_sac.figures import cartpole_strip
from bootcourse.course.lessons.update_and_loop import by_hand, left_out
from bootcourse.learn.teachers import teacher_policy
from bootcourse.plots.figure import finish, one_axes
from bootcourse.research.experiments import checks


def before_training(agent: by_hand.SAC) -> Figure:
    """An episode of an untrained agent, by its most probable pushes, and one of the rule."""
    drivers = {"untrained": agent.as_policy(), "rule: one weighted sum": teacher_policy(checks.balance, None, 2)}
    drives = {}
    for label, driver in drivers.items():
        rows, pushes = checks.data(driver, checks.cartpole, 1, seed=0)
        drives[f"{label}: {pushes:.0f} pushes"] = rows[:, :4].numpy()
    return cartpole_strip(drives, "An untrained agent lets the pole fall at once")


def tests_in_training(tests: Sequence[float], block: int) -> Figure:
    """The tests of an agent, one before its training and one after each `block` of pushes."""
    pushes, falls = np.arange(len(tests)) * block, int((np.diff(tests) < 0).sum())
    ended = "Solved after" if min(tests[-2:]) >= 475 else "Not solved in"
    worse = "test is" if falls == 1 else "tests are"
    title = f"{ended} {pushes[-1]:,} pushes; {falls} {worse} worse than the one before"
    looks = [OTHER._replace(marker="o")]
    return charts.lines(pushes, {"your agent": np.array(tests)}, title, "pushes in training",
                        "pushes balanced, mean of 10 episodes", looks=looks)  # fmt: skip


def without_a_part(scores: np.ndarray) -> Figure:
    """For how many pushes each agent balances, as a dot, a row for each of `left_out.KINDS`; scores (kinds, seeds)."""
    means = scores.mean(1)
    worst = 1 + means[1:].argmin()
    title = f"Without {left_out.KINDS[worst]} no agent balances for more than {scores[worst].max():.0f} pushes"
    figure, ax = one_axes(3.2, title, "", "")
    ax.set_position((0.26, 0.19, 0.6, 0.64))
    alt = []
    for place, (kind, row, mean) in enumerate(zip(left_out.KINDS, scores, means, strict=True)):
        look = STRANGERS[0] if place == worst else STRANGERS[1]
        dots(ax, row, place, look.colour, bar=mean)
        beside(ax, place, f"{mean:.0f}")
        alt.append(f"{kind}: {', '.join(f'{score:.0f}' for score in row)}")
    rows = ["the whole agent", *(f"without {kind}" for kind in left_out.KINDS[1:])]
    name_rows(ax, rows, "pushes balanced, mean of 10 episodes; a dot: an agent; bar: mean of a row")
    ax.set_xlim(0, 500)
    return finish(figure, title, f"A dot for each agent. {'; '.join(alt)}.")


def until_the_fall(trained: Mapping[str, left_out.Learned]) -> Markdown:
    """A table of how long agents of the seeds 0, 1, ... balance, before their training and after it."""
    untrained = [by_hand.SAC(seed) for seed in range(2)]
    tests = {"untrained": (untrained, [by_hand.balanced(agent) for agent in untrained])}
    tests |= {words: (each.agents, each.pushes) for words, each in trained.items()}
    rows = [[words, in_words(pushes), in_words(map(by_hand.balanced_drawn, agents))]
            for words, (agents, pushes) in tests.items()]  # fmt: skip
    return table(["pushes until the fall, seeds 0 and 1", "the most probable ones", "drawn ones"], rows)


def in_the_end(trained: Mapping[str, left_out.Learned]) -> Markdown:
    """A table of what critics expect after training, and of how long their actors balance."""
    rows = [[words, in_words(each.q[:, -1]), in_words(left_out.along_falls(each.agents)[:, -1]), in_words(each.pushes)]
            for words, each in trained.items()]  # fmt: skip
    return table(["seeds 0 and 1", "Q at the start", "Q of a fallen pole", "pushes until the fall"], rows)


def in_words(values: Iterable[float]) -> str:
    """A number for each seed."""
    return " and ".join(f"{round(value)}" for value in values)


def along_falls(critics: Mapping[str, left_out.Learned]) -> Figure:
    """What critics expect with each push of a fall, see `left_out.along_falls`."""
    named = {words: left_out.along_falls(each.agents) for words, each in critics.items()}
    title = "Where no fall is marked, these critics value the fallen pole most"
    return charts.lines(np.arange(-left_out.BEFORE, 1), named, title, "pushes from the fall (0: the pole has fallen)",
                        "Q, mean of 40 falls, a line for each agent", looks=STRANGERS[1::-1])  # fmt: skip


def estimates(critics: Mapping[str, left_out.Learned]) -> Figure:
    """What critics expect of the start while they learn."""
    title = "With rows of fallen states the estimates end below 100, with upright ones not"
    q = {words: each.q for words, each in critics.items()}
    updates = left_out.EVERY * np.arange(1, 1 + min(values.shape[1] for values in q.values()))
    return charts.lines(updates, q, title, "updates", "Q at the start, a line for each agent",
                        marks={"1 / (1 − γ) = 100": 100.0}, looks=STRANGERS)  # fmt: skip

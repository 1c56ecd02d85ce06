"""Answers to the exercises of the lesson on a problem of one's own."""

from tests.answers import equivalent, right, right_lines, wrong, wrong_lines


@right("climb_rule")
def by_energy(position, speed):
    """Swing: add energy along the motion; at the turning points, where the speed is 0, begin to the right."""
    if speed < 0:
        return 0
    return 2


right_lines("""climb_rule
    by the sign: int(1 + np.sign(speed)) if speed else 2
""")

wrong_lines("""climb_rule
    nothing for the left: 2 if speed >= 0 else None  # returns nothing
    at random: int(np.random.default_rng().integers(3))  # asked again
    once up: 2 if position > -0.3 else 0
""")


right_lines("""drowning_bonus
    without the way's length: (1 - gamma) * goal / gamma - reward
    sums: way = gamma**np.arange(decisions)
        (goal * way[-1] + reward * way.sum() - reward / (1 - gamma)) / (1 / (1 - gamma) - way.sum())
""")


@wrong("drowning_bonus")
def without_discounts(reward, goal, decisions, gamma):
    return (goal + reward * decisions) / decisions


equivalent("climb_rule", "2 if speed >= 0 else 0  ->  2 if speed > 0 else 0", "at rest, either side will do")

right_lines("""climb_rule
    where: np.where(speed >= 0, 2, 0)
    a tensor: torch.tensor(2 if speed >= 0 else 0)
    the sign: int(np.sign(speed)) + 1 if speed else 2
""")

wrong_lines("""climb_rule
    a float: 2.0 if speed >= 0 else 0.0  # a whole number
    the truth: speed >= 0
    an array: np.array([2 if speed >= 0 else 0])  # a NumPy array
    beyond: np.where(speed >= 0, 3, 0)  # not an action
""")

wrong_lines("""drowning_bonus
    capped: min(50.0, solution(reward, goal, decisions, gamma))
""")

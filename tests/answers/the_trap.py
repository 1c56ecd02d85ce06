"""Answers to the exercises of the lesson on the road, its actions and its reward."""

import math

import numpy as np

from tests.answers import equivalent, right_lines, wrong_lines

BOTH = "the formula gives the same there"
equivalent("bearable_risk", "if escape <= stay:  ->  if escape < stay:", BOTH)
equivalent("bearable_risk", "if crash >= stay:  ->  if crash > stay:", BOTH)


right_lines("""decode
    by a table: turn = math.pi / 50
        table = np.array([(a, s) for a in (-1, 0, 1) for s in (-turn, 0, turn)])
        table[actions]
    one by one: [(a // 3 - 1, (a - 3 * (a // 3) - 1) * 0.02 * math.pi) for a in actions.tolist()]
""")

wrong_lines("""decode
    the three of the example: known = {0: (-1, -np.pi / 50), 4: (0, 0), 8: (1, np.pi / 50)}
        np.array([known.get(a, (0, 0)) for a in actions.tolist()])
    two rows: np.array([actions // 3 - 1, (actions % 3 - 1) * np.pi / 50])  # shape
""")


def speed_term(v_lon):
    if v_lon <= 5:
        return 0.0
    if v_lon <= 12.5:
        return (2 * v_lon - 10) / 75
    if v_lon <= 15:
        return 0.32 * v_lon - 3.8
    return math.exp(-((v_lon - 15) ** 2))


def terms(v_lon, offset, theta):
    return speed_term(v_lon), math.exp(-1.5 * offset**2), -abs(math.sin(theta))


right_lines("""reward
    with numpy's average:
        -10.0 if accident > 0 else float(np.average(terms(v_lon, offset, theta), weights=[1.5, 0.05, 0.05]))
    term by term: total = 0.0
        for weight, term in zip((1.5, 0.05, 0.05), terms(v_lon, offset, theta), strict=True):
            total += weight / 1.6 * term
        total if accident == 0 else -10
""")


def summed(v_lon, offset, theta):
    return float(np.dot(terms(v_lon, offset, theta), [1.5, 0.05, 0.05]))


wrong_lines("""reward
    departures are free: -10.0 if accident in (1, 3) else summed(v_lon, offset, theta) / 1.6
    the line goes on below five: r_v = speed_term(v_lon) if v_lon > 5 else (2 * v_lon - 10) / 75
        mean = (1.5 * r_v + 0.05 * math.exp(-1.5 * offset**2) - 0.05 * abs(math.sin(theta))) / 1.6
        -10.0 if accident else mean
""")

right_lines("""bearable_risk
    from the share that must succeed:
        if escape <= stay:
            return 0
        1 - max(0.0, (stay - crash) / (escape - crash))
""")

wrong_lines("""bearable_risk
    at least one per cent: max(0.01, solution(stay, escape, crash))
    signs are dropped: float(np.clip((escape - stay) / (abs(escape) + abs(crash)), 0, 1))
""")


right_lines("""find_plan
    all of them: import itertools
        plans = np.array(list(itertools.product((3, 4, 5), repeat=8)))
        plans[np.flatnonzero(gets_out(plans))[0]]
    a list: plans = rng.choice([3, 4, 5], (6000, 8)); plans[np.asarray(gets_out(plans))][0].tolist()
""")

wrong_lines("""find_plan
    many plans: plans = rng.integers(3, 6, (6000, 8)); plans[gets_out(plans)]  # one plan is (8,)
    one plan alone: gets_out(rng.integers(3, 6, 8))  # takes many at once
    it brakes: plans = rng.integers(0, 3, (500, 8))
        while not gets_out(plans).any():
            plans = rng.integers(0, 3, (500, 8))
        plans[0]  # other actions
    without the last action: plans = rng.integers(3, 5, (500, 8))
        while not gets_out(plans).any():
            plans = rng.integers(3, 5, (500, 8))
        plans[gets_out(plans).argmax()]  # None of your plans holds action 5
""")

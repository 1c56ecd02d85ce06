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
    by divmod: row, column = np.divmod(actions, 3); np.column_stack([row - 1.0, (column - 1.0) * np.pi / 50])
    one by one: [(a // 3 - 1, (a - 3 * (a // 3) - 1) * 0.02 * math.pi) for a in actions.tolist()]
    with torch: row = torch.from_numpy(actions).div(3, rounding_mode="floor")
        column = torch.from_numpy(actions).remainder(3)
        torch.stack([row - 1, (column - 1) * torch.pi / 50], dim=1)
""")

wrong_lines("""decode
    into whole numbers: found = np.zeros((len(actions), 2), dtype=int)
        found[:, 0] = actions // 3 - 1
        found[:, 1] = (actions % 3 - 1) * np.pi / 50
        found  # whole numbers
    the three of the example: known = {0: (-1, -np.pi / 50), 4: (0, 0), 8: (1, np.pi / 50)}
        np.array([known.get(a, (0, 0)) for a in actions.tolist()])
    divided as floats: np.column_stack([actions / 3 - 1, (actions % 3 - 1) * np.pi / 50])
    rows of two: np.column_stack([actions // 2 - 1, (actions % 3 - 1) * np.pi / 50])
    rounded angle: np.column_stack([actions // 3 - 1, (actions % 3 - 1) * 0.06])
    two rows: np.array([actions // 3 - 1, (actions % 3 - 1) * np.pi / 50])  # shape
    columns swapped: solution(actions)[:, ::-1].copy()
    a tuple: actions // 3 - 1, (actions % 3 - 1) * np.pi / 50  # has shape (2, 3)
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
    penalty last: mean = (30 * speed_term(v_lon) + math.exp(-1.5 * offset**2) - abs(math.sin(theta))) / 32
        np.float64(mean if not accident else -10)
    term by term: total = 0.0
        for weight, term in zip((1.5, 0.05, 0.05), terms(v_lon, offset, theta), strict=True):
            total += weight / 1.6 * term
        total if accident == 0 else -10
""")


def summed(v_lon, offset, theta):
    return float(np.dot(terms(v_lon, offset, theta), [1.5, 0.05, 0.05]))


wrong_lines("""reward
    ten for an accident: 10.0 if accident else summed(v_lon, offset, theta) / 1.6
    divided by three: -10.0 if accident else summed(v_lon, offset, theta) / 3
    turned: summed(v_lon, offset, theta) / 1.6 if accident else -10.0
    the angle itself: mean = (1.5 * speed_term(v_lon) + 0.05 * math.exp(-1.5 * offset**2) - 0.05 * abs(theta)) / 1.6
        -10.0 if accident else mean
    departures are free: -10.0 if accident in (1, 3) else summed(v_lon, offset, theta) / 1.6
    squared steering:
        mean = (1.5 * speed_term(v_lon) + 0.05 * math.exp(-1.5 * offset**2) - 0.05 * math.sin(theta) ** 2) / 1.6
        -10.0 if accident else mean
    the line goes on below five: r_v = speed_term(v_lon) if v_lon > 5 else (2 * v_lon - 10) / 75
        mean = (1.5 * r_v + 0.05 * math.exp(-1.5 * offset**2) - 0.05 * abs(math.sin(theta))) / 1.6
        -10.0 if accident else mean
    no reward for too fast: -10.0 if accident else summed(v_lon if v_lon <= 15 else 0.0, offset, theta) / 1.6
""")

right_lines("""bearable_risk
    clipped:
        float(np.clip((escape - stay) / (escape - crash), 0, 1)) if escape > max(stay, crash) else float(crash > stay)
    from the share that must succeed:
        if escape <= stay:
            return 0
        1 - max(0.0, (stay - crash) / (escape - crash))
    by bisection:
        if escape <= stay:
            return 0.0
        low, high = 0.0, 1.0
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if (1 - middle) * escape + middle * crash > stay else (low, middle)
        low
""")

wrong_lines("""bearable_risk
    in per cent: 100 * solution(stay, escape, crash)
    always the rule's: 0.4556
    a crash costs ten: solution(stay, escape, -10.0)
    a verdict: escape > stay
    at least one per cent: max(0.01, solution(stay, escape, crash))
    no more than nine in ten:
        solution(stay, escape, crash) if crash >= stay else min(0.9, solution(stay, escape, crash))
    signs are dropped: float(np.clip((escape - stay) / (abs(escape) + abs(crash)), 0, 1))
""")


right_lines("""find_plan
    all of them: import itertools
        plans = np.array(list(itertools.product((3, 4, 5), repeat=8)))
        plans[np.flatnonzero(gets_out(plans))[0]]
    one by one: plan = rng.integers(3, 6, 8)
        while not gets_out(plan[None])[0]:
            plan = rng.integers(3, 6, 8)
        plan
    a list: plans = rng.choice([3, 4, 5], (6000, 8)); plans[np.asarray(gets_out(plans))][0].tolist()
""")

wrong_lines("""find_plan
    straight on: np.full(8, 4)  # does not get out
    many plans: plans = rng.integers(3, 6, (6000, 8)); plans[gets_out(plans)]  # one plan is (8,)
    one plan alone: gets_out(rng.integers(3, 6, 8))  # takes many at once
    it brakes: plans = rng.integers(0, 3, (500, 8))
        while not gets_out(plans).any():
            plans = rng.integers(0, 3, (500, 8))
        plans[0]  # other actions
""")

wrong_lines("""find_plan
    without the last action: plans = rng.integers(3, 5, (500, 8))
        while not gets_out(plans).any():
            plans = rng.integers(3, 5, (500, 8))
        plans[gets_out(plans).argmax()]  # None of your plans holds action 5
""")

wrong_lines("""bearable_risk
    the rest, clipped: min(1, max(0, (stay - crash) / (escape - crash)))  # must *succeed*
""")

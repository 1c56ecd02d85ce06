"""Answers to the exercises of the lesson on the road, its actions and its reward."""

import math

import numpy as np

from tests.answers import equivalent, right_lines, wrong_lines

BOTH = "the formula gives the same there"
equivalent("bearable_risk", "if out <= stay:  ->  if out < stay:", BOTH)
equivalent("bearable_risk", "if crash >= stay:  ->  if crash > stay:", BOTH)


right_lines("""decode
    by a table: turn = math.pi / 50
        table = np.array([(a, s) for a in (-1, 0, 1) for s in (-turn, 0, turn)])
        table[actions]
    one by one: [(a // 3 - 1, (a - 3 * (a // 3) - 1) * 0.02 * math.pi) for a in actions.tolist()]
    as places in a grid: row, column = np.unravel_index(actions, (3, 3))
        np.transpose([row - 1.0, np.deg2rad(3.6) * (column - 1)])
    in torch: a = torch.as_tensor(actions)
        torch.stack([(a.div(3, rounding_mode="floor") - 1).double(), (a % 3 - 1).double() * (math.pi / 50)], 1)
""")

wrong_lines("""decode
    the three of the example: known = {0: (-1, -np.pi / 50), 4: (0, 0), 8: (1, np.pi / 50)}
        np.array([known.get(a, (0, 0)) for a in actions.tolist()])
    as many as are asked: np.array([(a, s) for a in (-1, 0, 1) for s in (-1, 0, 1)])[:len(actions)] * [1, np.pi / 50]
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
    an array of no axis: weighted = np.dot(terms(v_lon, offset, theta), [1.5, 0.05, 0.05])
        np.where(accident > 0, -10.0, weighted / 1.6)
""")


def summed(v_lon, offset, theta):
    return float(np.dot(terms(v_lon, offset, theta), [1.5, 0.05, 0.05]))


wrong_lines("""reward
    departures are free: -10.0 if accident in (1, 3) else summed(v_lon, offset, theta) / 1.6
    the line goes on below five: r_v = speed_term(v_lon) if v_lon > 5 else (2 * v_lon - 10) / 75
        mean = (1.5 * r_v + 0.05 * math.exp(-1.5 * offset**2) - 0.05 * abs(math.sin(theta))) / 1.6
        -10.0 if accident else mean
    fast is as good as 15: terms_at = terms(min(v_lon, 15.0), offset, theta)
        -10.0 if accident else float(np.dot(terms_at, [1.5, 0.05, 0.05])) / 1.6
    never below 0: -10.0 if accident else max(0.0, summed(v_lon, offset, theta) / 1.6)
    as fast as one likes: pays = summed(15.0, offset, theta) if v_lon > 18 else summed(v_lon, offset, theta)
        -10.0 if accident else pays / 1.6
""")

right_lines("""bearable_risk
    from the share that must succeed:
        if out <= stay:
            return 0
        1 - max(0.0, (stay - crash) / (out - crash))
    by bisection: low, high = 0.0, 1.0
        if out <= stay:
            return low
        for _ in range(60):
            q = (low + high) / 2
            low, high = (q, high) if (1 - q) * out + q * crash >= stay else (low, q)
        low
""")

wrong_lines("""bearable_risk
    at least one per cent: max(0.01, solution(stay, out, crash))
    a gain that is small does not count: solution(stay, out, crash) * (out > stay + 0.01)
    never sure: min(0.999, solution(stay, out, crash))
    in steps of one per cent: shares = np.linspace(0, 1, 101)
        max(shares[(1 - shares) * out + shares * crash >= stay], default=0.0)
    signs are dropped: float(np.clip((out - stay) / (abs(out) + abs(crash)), 0, 1))
""")


right_lines("""find_plan
    all of them: import itertools
        plans = np.array(list(itertools.product((3, 4, 5), repeat=8)))
        plans[np.flatnonzero(gets_out(plans))[0]]
    a list: plans = rng.choice([3, 4, 5], (20_000, 8)); plans[np.asarray(gets_out(plans))][0].tolist()
    in a random order: import itertools
        for some in np.array_split(rng.permutation(list(itertools.product((3, 4, 5), repeat=8))), 20):
            if (out := gets_out(some)).any():
                return some[out][0]
        None
    one at a time:
        while not gets_out([plan := 3 + rng.integers(3, size=8)])[0]:
            pass
        plan
""")

wrong_lines("""find_plan
    without asking: rng.integers(3, 6, 8)  # does not get out
    another draw: plans = rng.integers(3, 6, (500, 8))
        while not gets_out(plans).any():
            plans = rng.integers(3, 6, (500, 8))
        rng.integers(3, 6, 8)
    the mean of all that get out: plans = rng.integers(3, 6, (20_000, 8))
        np.round(plans[gets_out(plans)].mean(0)).astype(int)
    second by second: plan = np.full(8, 4)
        for second in range(8):
            trials = np.tile(plan, (3, 1)); trials[:, second] = (3, 4, 5)
            plan = trials[gets_out(trials).argmax()]
        plan
    a generator of its own: plans = np.random.default_rng().integers(3, 6, (20_000, 8))
        plans[gets_out(plans)][0]  # draws none with `rng`
    the same plans again and again: plans = np.random.default_rng(0).integers(3, 6, (20_000, 8))
        plans[gets_out(plans)][0]  # draws none with `rng`
    half of it without the generator: plans = np.random.default_rng().integers(3, 6, (20_000, 8)); rng.random()
        plans[gets_out(plans)][0]  # Two equal generators give different plans
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

"""The paper's two result tables (Tables 4 and 5, Section V), and what its own numbers say about each other."""

import math
from typing import NamedTuple

import numpy as np
import scipy

from bootcourse.road.formulas import centring_reward, speed_reward, weighted_reward
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import Estimate, rate

EPISODES = 20  # tested by the paper, inferred: one collision in 20 episodes is its "5 ± 22.36 %"


class Printed(NamedTuple):
    """A mean and its standard deviation, as printed; rates in percent."""

    mean: float
    sd: float


COLUMNS = {
    "success": "success rate, %",
    "returns": "accumulated reward",
    "speed": "average speed, m/s",
    "distance": "travel distance, m",
    "collision": "collision rate, %",
}
RATES = ("success", "collision", "road_departure", "stoppage")
ROWS = {
    "sac": "SAC",
    "soft": "with soft constraint",
    "demos": "with offline replay buffer",
    "bootstrapped": "ours (the paper's method)",
    "cql": "CQL",
    "gail": "GAIL",
    "rule": "suboptimal rule",
}
_PRINTED = {
    "sac": ((0, 0), (21.32, 7.39), (10.50, 1.28), (1402.16, 182.87), (0, 0)),
    "soft": ((0, 0), (26.77, 0.94), (10.87, 0.02), (1631.48, 3.40), (0, 0)),
    "demos": ((100, 0), (36.68, 9.66), (12.05, 0.39), (1804.35, 55.75), (5, 29.69)),
    "bootstrapped": ((100, 0), (44.92, 12.62), (12.55, 0.63), (1853.88, 95.46), (0, 0)),
    "cql": ((0, 0), (23.06, 0.15), (10, 0), (1500, 0), (0, 0)),
    "gail": ((0, 0), (22.40, 3.31), (9.99, 0.02), (1488.18, 52.83), (5, 22.36)),
    "rule": ((100, 0), (24.70, 0.44), (11.51, 0.8), (1727.01, 8.3), (0, 0)),
}
PRINTED = {
    method: {column: Printed(*pair) for column, pair in zip(COLUMNS, row, strict=True)}
    for method, row in _PRINTED.items()
}
INTEGRATED = "Comparison results for different methods of integrating suboptimal demonstrations"
TABLES = {
    INTEGRATED: ("sac", "soft", "demos", "bootstrapped"),
    "Testing comparison with baseline methods": ("cql", "gail", "sac", "rule", "bootstrapped"),
}


def paper_interval(method: str, column: str) -> Estimate:
    """The 95 % interval of the paper's number, in its own units, if it is the result of 20 episodes.

    Rates: exact (Clopper-Pearson). Means: Student's t with the printed deviation.
    """
    mean, sd = PRINTED[method][column]
    if column in RATES:
        return Estimate(*(100 * part for part in rate(np.arange(EPISODES) < round(mean / 100 * EPISODES))))
    half = float(scipy.stats.t.ppf(0.975, EPISODES - 1)) * sd / math.sqrt(EPISODES)
    return Estimate(mean, mean - half, mean + half)


def possible(method: str, column: str) -> bool:
    """Can this rate have this deviation in 20 episodes? (Means always can.)"""
    mean, sd = PRINTED[method][column]
    if column not in RATES:
        return True
    share = mean / 100
    return sd <= 100 * math.sqrt(share * (1 - share) * EPISODES / (EPISODES - 1)) + 0.01


def earned_at(speed: float, seconds: float = 150, centred: bool = True) -> float:
    """The return of `seconds` at a constant speed, never steering, in the middle of a lane or far from it."""
    weights = DEFAULT.reward
    r_y = centring_reward(0.0) if centred else 0.0
    return seconds * weighted_reward(speed_reward(speed), r_y, 0.0, weights.w_v, weights.w_y, weights.w_theta)


def arithmetic(method: str) -> str:
    """What a row's own numbers say about each other."""
    row = PRINTED[method]
    speed, distance, returns = row["speed"].mean, row["distance"].mean, row["returns"].mean
    seconds = distance / speed
    words = f"{distance:g} m at {speed:g} m/s take {seconds:.1f} s of 150."
    if seconds < 145:
        words += " So some episodes ended early, while its collision rate is 0:"
        words += " road departures or stops must hide there."
    words += f" A car that holds {speed:g} m/s for 150 s earns {earned_at(speed):.2f} in the middle of its lane and "
    words += f"{earned_at(speed, centred=False):.2f} between lanes; printed are {returns:g}."
    for mean, sd in (row[column] for column in COLUMNS if not possible(method, column)):
        words += f" A rate of {mean:g} % in {EPISODES} episodes cannot have a deviation of {sd:g} (at most 22.36)."
    return words

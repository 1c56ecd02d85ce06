"""A scenario as a drawing: a road as it begins, close up and as a whole; and what follows from the numbers."""

import numpy as np

from bootcourse.colours import OTHER, TRAP
from bootcourse.plots.road import road_svg
from bootcourse.plots.svg import INK, QUIET, drawing, line, rect, text, ticks
from bootcourse.road.formulas import speed_reward, weighted_reward
from bootcourse.road.state import EGO, TRAP_1, TRAP_2, X
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import Scenario

WIDTH, HEIGHT, NEAR, FAR = 1052, 336, 112, 48  # pixels: the drawing; the heights of the two roads
BEHIND = 0.06  # share of the road that is shown behind the ego


def start_of(scenario: Scenario, seed: int) -> np.ndarray:
    """The cars of a road as it begins: (vehicles, 10)."""
    env = TrapVectorEnv(1, scenario)
    env.reset(seed=seed)
    return env.cars[0]


def top_view(scenario: Scenario, cars: np.ndarray) -> str:
    """The drawing."""
    road_width, bottom = scenario.road.lanes * scenario.road.lane_width, 20 + NEAR
    scale = min(NEAR / road_width, 9.0)
    near, height = road_svg(cars, scenario, OTHER.colour, WIDTH, scale, behind=BEHIND)
    parts = [text(0, 12, "the start, close up", bold=True), f'<g transform="translate(0 20)">{"".join(near)}</g>']
    parts += _distances(scenario, cars, scale, 20 + height)

    reach = max(float(cars[:, X].max() - cars[EGO, X]) + 15, 60.0)
    small = min(FAR / road_width, (1 - BEHIND) * WIDTH / reach)
    whole, height = road_svg(cars, scenario, OTHER.colour, WIDTH, small, behind=BEHIND, names=False)
    top = bottom + 66
    parts.append(text(0, top - 8, f"all {scenario.vehicles} cars", bold=True))
    parts.append(f'<g transform="translate(0 {top})">{"".join(whole)}</g>')
    parts += _metres(small, top + height)
    for i, words in enumerate(consequences(scenario)):
        parts.append(text(0, top + FAR + 42 + 19 * i, words))
    return drawing(WIDTH, HEIGHT, parts, alt_text(scenario, cars))


def _distances(scenario: Scenario, cars: np.ndarray, scale: float, y: float) -> list[str]:
    """D1 and D2 under the road: from where to where they may lie, and where they do on this road."""
    parts, ego, traps = [], BEHIND * WIDTH, scenario.traps
    for row, (name, low_high, trap) in enumerate((("D2", traps.d2, TRAP_2), ("D1", traps.d1, TRAP_1))):
        level, away = y + 12 + 16 * row, float(cars[trap, X] - cars[EGO, X])
        low, high = (ego + distance * scale for distance in low_high)
        parts.append(line(ego, level, ego + away * scale, level, QUIET, 1.5))
        parts.append(rect(low, level - 4, max(high - low, 2), 8, TRAP, 'opacity="0.6"'))
        parts.append(line(ego + away * scale, level - 5, ego + away * scale, level + 5, INK, 2))
        words = f"{name} = {away:.1f} m here, from {low_high[0]:g} to {low_high[1]:g} m"
        parts.append(text(max(high, ego + away * scale) + 10, level + 4, words, size=11.5))
    return parts


def _metres(scale: float, y: float) -> list[str]:
    """Distances from the ego, below the whole road."""
    places = ticks(0, ((1 - BEHIND) * WIDTH - 20) / scale, 13)
    parts = [line(BEHIND * WIDTH + m * scale, y, BEHIND * WIDTH + m * scale, y + 4, QUIET) for m in places]
    return parts + [text(BEHIND * WIDTH + m * scale, y + 16, f"{m:g} m", "middle", QUIET, 10.5) for m in places]


def consequences(scenario: Scenario) -> list[str]:
    """What follows from the numbers, in three sentences."""
    clock, w, rule = scenario.clock, scenario.reward, scenario.rule
    seconds = clock.decisions / clock.decision_rate
    behind, best = (
        weighted_reward(speed_reward(v), 1.0, 0.0, w.w_v, w.w_y, w.w_theta) for v in (scenario.traps.speed, 15.0)
    )
    grid = np.linspace(rule.v_min, rule.v_max, rule.n)
    speeds = ", ".join(f"{v:.4g}" for v in (grid if rule.n <= 8 else [*grid[:3], *grid[-2:]]))
    speeds = speeds if rule.n <= 8 else f"{speeds} (and {rule.n - 5} between)"
    return [
        f"An episode has {clock.decisions} decisions in {seconds:g} s. The ego observes "
        f"{scenario.observation_size} numbers.",
        f"Centred behind the traps a decision earns {behind:.3f}, {behind * clock.decisions:.1f} in the episode; "
        f"at 15 m/s it would earn {best:.3f}.",
        f"The rule's target speeds are {speeds} m/s.",
    ]


def alt_text(scenario: Scenario, cars: np.ndarray) -> str:
    d1, d2 = (float(cars[trap, X] - cars[EGO, X]) for trap in (TRAP_1, TRAP_2))
    return (
        f"A road of {scenario.road.lanes} lanes as it begins: trap 1 is {d1:.1f} m ahead in the ego's lane, trap 2 "
        f"{d2:.1f} m ahead in the next, both at {scenario.traps.speed:g} m/s; {scenario.traffic.cars} other cars. "
        + " ".join(consequences(scenario))
    )

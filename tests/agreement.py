"""Do the two roads agree? `python -m tests.agreement --episodes 2000` drives both with the same actions.

After every decision it compares every number of every car, at each simulation step, and the
observation, the reward, its terms, and how the episode ends. It prints the largest difference of
each, and what happened on the way, so that one sees that crashes and lane changes were among it.

With highway-env's own steering gains the traffic is chaotic at 2 Hz: a difference of 1e-16 in the
sine of one library grows by half at each step. In the scenarios named `CHAOTIC` the compiled road
therefore starts every decision from the reference's state; in all others, only the episode.
"""

import argparse
import sys
import time
from collections import Counter
from dataclasses import dataclass, field, replace

import gymnasium as gym
import numpy as np
from gymnasium.vector import AutoresetMode

import bootcourse  # noqa: F401  registers the road
from bootcourse.road.state import CRASHED, EGO, HEADING, LANE, SPEED, TARGET_LANE, Accident, X, Y
from bootcourse.rule import rule, sample_stochastic_rule
from bootcourse.scenario import CALIBRATED, DEFAULT, IDLE, N_ACTIONS, Car, Clock, Ego, Road, Rule, Scenario, Sight

TOLERANCE = 1e-9
COLUMN_NAMES = ("x", "y", "heading", "speed", "steering", "acceleration", "lane", "target lane", "timer", "crashed")
ROADS = 8  # driven side by side, so that the compiled road's rows are tested against each other too

_traffic = DEFAULT.traffic
SCENARIOS = {
    "default": DEFAULT,
    "calibrated": CALIBRATED,
    # highway-env's own gains, unstable at 2 Hz: traffic leaves the road and crashes
    "unstable": Scenario(
        "unstable", traffic=replace(_traffic, cars=9, lead=15.0, headway=20.0, tau_heading=0.2, tau_lateral=0.6)
    ),
    "crowded": Scenario(
        "crowded",
        road=Road(lanes=4),
        traffic=replace(_traffic, cars=16, lead=20.0, headway=20.0, politeness=0.0, a_threshold=0.05),
        sight=Sight(neighbours=7, distance=60.0),
    ),
    "two lanes": Scenario("two lanes", road=Road(lanes=2), traffic=replace(_traffic, cars=3, delta=3.7)),
    "empty": Scenario("empty", traffic=replace(_traffic, cars=0)),
    "lorries at 4 Hz": Scenario(
        "lorries at 4 Hz",
        road=Road(lanes=3, lane_width=3.6, speed_limit=12.5),
        clock=Clock(decisions=100, simulation_rate=4),
        car=Car(length=9.0, width=2.5),
        ego=Ego(max_speed=18.0, min_speed=2.0),
        traffic=replace(_traffic, cars=8, desired_speed=14.0, s0=14.0, lane_change_delay=0.6, safe_braking=0.5),
        rule=Rule(v_min=5.0, v_max=14.0, n=7, floor=2.0),
    ),
}
CHAOTIC = {"unstable"}


# The drivers: (cars (vehicles, 10), scenario, rng) -> an action in 0..8


def at_random(cars, scenario, rng):
    return rng.integers(N_ACTIONS)


def idle(cars, scenario, rng):
    return IDLE


def by_the_rule(cars, scenario, rng):
    return rule(cars[None], scenario).actions[0]


def by_the_stochastic_rule(cars, scenario, rng):
    return sample_stochastic_rule(rule(cars[None], scenario).actions, 0.9, rng)[0]


def aim_at_a_car(cars, scenario, rng):
    """Fast towards the nearest car ahead, wherever it is."""
    ahead = cars[1:][cars[1:, X] > cars[EGO, X] - 2.0]
    if len(ahead) == 0:
        return by_the_rule(cars, scenario, rng)
    target = ahead[np.argmin(np.hypot(ahead[:, X] - cars[EGO, X], ahead[:, Y] - cars[EGO, Y]))]
    bearing = np.arctan2(target[Y] - cars[EGO, Y], max(target[X] - cars[EGO, X], 1.0)) - cars[EGO, HEADING]
    steer = int(np.sign(round(bearing / 0.1)))
    return 6 + 1 + steer if rng.random() < 0.9 else rng.integers(N_ACTIONS)


def leave_the_road(cars, scenario, rng):
    """A shallow way out, to either side, accelerating or not."""
    side = 1 if int(cars[2, X] * 1e3) % 2 else -1
    wanted = 0.15 * side
    steer = int(np.sign(round((wanted - cars[EGO, HEADING]) / 0.1)))
    return 3 * rng.integers(1, 3) + 1 + steer


def brake_to_a_stop(cars, scenario, rng):
    return rng.integers(3) if rng.random() < 0.2 else 1


def overtake_then_anything(cars, scenario, rng):
    """The rule for as long as the traps are ahead, then at random among the traffic."""
    far = cars[EGO, X] > cars[1, X] + 10 and rng.random() < 0.5
    return rng.integers(N_ACTIONS) if far else by_the_rule(cars, scenario, rng)


DRIVERS = (
    by_the_rule,
    at_random,
    by_the_stochastic_rule,
    aim_at_a_car,
    leave_the_road,
    brake_to_a_stop,
    overtake_then_anything,
    idle,
)


@dataclass
class Report:
    """The largest difference of each quantity, where it was, and what happened."""

    largest: dict[str, float] = field(default_factory=dict)
    where: dict[str, str] = field(default_factory=dict)
    events: Counter = field(default_factory=Counter)
    endings: dict[str, Counter] = field(default_factory=dict)  # by driver
    decisions: int = 0

    def compare(self, name: str, reference, other, place: str) -> None:
        difference = np.abs(np.asarray(reference, dtype=float) - np.asarray(other, dtype=float)).max()
        difference = np.inf if np.isnan(difference) else float(difference)
        if difference >= self.largest.get(name, -1.0):
            self.largest[name], self.where[name] = difference, place

    @property
    def worst(self) -> float:
        return max(self.largest.values())

    def __str__(self) -> str:
        lines = [f"{'quantity':<14} largest difference"]
        for name, difference in self.largest.items():
            lines.append(f"{name:<14} {difference:.1e}" + (f"  {self.where[name]}" if difference > 0 else ""))
        lines += ["", f"{'driver':<24} how the episodes ended"]
        for driver, endings in self.endings.items():
            lines.append(f"{driver:<24} " + ", ".join(f"{count} {ending}" for ending, count in endings.most_common()))
        lines += ["", *(f"{count:>8}  {event}" for event, count in sorted(self.events.items()))]
        return "\n".join(lines)


def compare(report: Report, scenario: Scenario, drivers, seeds) -> None:
    """Drive an episode on both roads for each seed, the drivers taking turns; note the differences."""
    envs = [gym.make("bootcourse:Trap-v0", scenario=scenario) for _ in seeds]
    twin = gym.make_vec(
        "bootcourse:Trap-v0", num_envs=len(seeds), scenario=scenario, autoreset_mode=AutoresetMode.DISABLED, record=True
    )
    observations, _ = twin.reset(seed=list(seeds))
    turns = [drivers[seed % len(drivers)] for seed in seeds]
    rngs = [np.random.default_rng(seed) for seed in seeds]
    places = [f"{scenario.name}, {turn.__name__}, seed {seed}" for turn, seed in zip(turns, seeds, strict=True)]
    for env, seed, observation, cars, place in zip(envs, seeds, observations, twin.unwrapped.cars, places, strict=True):
        report.compare("observation", env.reset(seed=int(seed))[0], observation, place)
        _compare_cars(report, env.unwrapped.cars(), cars, place)
    awake = set(range(len(seeds)))
    while awake:
        before = [env.unwrapped.cars() for env in envs]
        if scenario.name in CHAOTIC:
            twin.unwrapped.cars[:] = before
        actions = [turn(cars, scenario, rng) for turn, cars, rng in zip(turns, before, rngs, strict=True)]
        observations, rewards, terminated, truncated, infos = twin.step(np.array(actions))
        for i in sorted(awake):
            observation, reward, ended, out_of_time, info = envs[i].step(int(actions[i]))
            for step, cars in enumerate(envs[i].unwrapped.trace):
                _compare_cars(report, cars, twin.unwrapped.trace[i, step], places[i])
            cars = envs[i].unwrapped.trace[-1]
            _compare_cars(report, cars, twin.unwrapped.cars[i], places[i])
            report.compare("observation", observation, observations[i], places[i])
            report.compare("reward", reward, rewards[i], places[i])
            for name in ("r_v", "r_y", "r_theta"):
                report.compare(name, info[name], infos[name][i], places[i])
            report.compare("ending", [ended, out_of_time, info["accident"]],
                           [terminated[i], truncated[i], infos["accident"][i]], places[i])  # fmt: skip
            report.compare("success", info["is_success"], infos["is_success"][i], places[i])
            report.decisions += 1
            _note_events(report, before[i], cars)
            if ended or out_of_time:
                awake.remove(i)
                ending = Accident(info["accident"]).name.lower().replace("_", " ") if ended else "in time"
                report.endings.setdefault(turns[i].__name__, Counter())[ending] += 1
                report.events["episodes with a success"] += bool(info["is_success"])
                report.events["episodes in which traffic crashed"] += bool(cars[3:, CRASHED].any())


def _compare_cars(report: Report, reference, other, place: str) -> None:
    for column, name in enumerate(COLUMN_NAMES):
        report.compare(name, reference[:, column], other[:, column], place)


def _note_events(report: Report, before, after) -> None:
    began = (after[1:, TARGET_LANE] != before[1:, TARGET_LANE]) & (after[1:, TARGET_LANE] != before[1:, LANE])
    report.events["lane changes that traffic began"] += int(began.sum())
    given_up = (before[1:, TARGET_LANE] != before[1:, LANE]) & (after[1:, TARGET_LANE] == before[1:, LANE])
    report.events["lane changes that traffic gave up"] += int((given_up & ~began).sum())
    report.events["lane changes of the ego"] += int(after[EGO, LANE] != before[EGO, LANE])
    report.events["decisions with a car at a standstill"] += int((after[:, SPEED] < 0.01).any())


def run(
    episodes: int, seed: int = 0, scenarios=SCENARIOS, drivers=DRIVERS, progress=None, roads: int = ROADS
) -> Report:
    """Compare the roads over `episodes` episodes: the default scenario in half of them, the others in turn."""
    report = Report()
    names = list(scenarios)
    batches = -(-episodes // roads)
    for batch in range(batches):
        name = names[0] if batch % 2 == 0 or len(names) == 1 else names[1 + batch // 2 % (len(names) - 1)]
        seeds = range(seed + batch * roads, seed + min((batch + 1) * roads, episodes))
        compare(report, scenarios[name], drivers, seeds)
        report.events[f"episodes of '{name}'"] += len(seeds)
        if progress:
            progress((batch + 1) / batches)
    return report


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--episodes", type=int, default=200)
    parser.add_argument("--seed", type=int, default=0)
    arguments = parser.parse_args()
    began = time.perf_counter()

    def progress(share: float) -> None:
        if sys.stderr.isatty():
            print(f"\r{100 * share:3.0f} %", end="" if share < 1 else "\n", file=sys.stderr, flush=True)

    report = run(arguments.episodes, arguments.seed, progress=progress)
    print(report)
    agree = report.worst <= TOLERANCE
    print(f"\n{arguments.episodes} episodes, {report.decisions} decisions, {time.perf_counter() - began:.0f} s")
    verdict = "The two roads agree" if agree else "THE TWO ROADS DIFFER"
    print(f"{verdict}: largest difference {report.worst:.1e}, tolerance {TOLERANCE:.0e}.")
    return 0 if agree else 1


if __name__ == "__main__":
    sys.exit(main())

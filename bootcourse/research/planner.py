"""The planner: the best return that a search with access to the simulator finds on a road.

It is a beam search over the compiled road: every kept drive is continued with all nine actions, and
the best of these are kept. It uses the other cars' future, which a driver cannot see, so it is a reference
for other methods and not a competitor. A better drive may exist. Its result is a list of actions.

With γ below 1 it answers another question: does leaving the trap pay with this discount
(`is_staying_optimal`)?
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from gymnasium.vector import AutoresetMode

from bootcourse.episodes.driving import steps
from bootcourse.errors import BootcourseError
from bootcourse.learn.teachers import MarkedRule, with_name
from bootcourse.policies import PlanPolicy, Policy, idle_policy, rule_policy
from bootcourse.road.branching import expand, future_worth
from bootcourse.road.state import EGO, HEADING, LANE, SPEED, TRAP_1, X, Y
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import DEFAULT, IDLE, N_ACTIONS, Scenario
from bootcourse.statistics import Estimate, mean, rate

# Of the drives whose egos fall into the same cell, the search keeps only the best.
CELL = {X: 0.25, Y: 0.2, HEADING: 0.02, SPEED: 0.5}  # m, m, rad, m/s


@dataclass(frozen=True)
class Search:
    """How to search."""

    beam: int = 200  # drives that are kept after each decision
    gamma: float = 1.0  # discount factor; 1 for the return itself
    keep_lane: bool = False  # only drives that stay in the lane they start in
    decisions: int | None = None  # how far to look; None: to the episode's end

    def __post_init__(self):
        if self.beam < 1 or not 0 < self.gamma <= 1 or (self.decisions is not None and self.decisions < 1):
            raise BootcourseError(f"{self}: give a beam and decisions of 1 or more, and 0 < gamma <= 1.")


@dataclass(frozen=True)
class Plan:
    """The best drive that was found on one road."""

    seed: int  # of the road
    actions: np.ndarray  # (T,) int, 0..8
    rewards: np.ndarray  # (T,) float
    value: float  # Σ γ^t r_t
    success: bool  # is the ego ahead of trap 1 at the end?


def plan_episodes(seeds: Sequence[int], scenario: Scenario = DEFAULT, search: Search | None = None) -> list[Plan]:
    """The best drive found on the road of each seed; about a second each on a free core."""
    seeds = list(seeds)
    env = TrapVectorEnv(len(seeds), scenario, AutoresetMode.DISABLED)
    env.reset(seed=seeds)
    return [plan(cars, scenario, search, seed) for seed, cars in zip(seeds, env.cars, strict=True)]


def plan(cars: np.ndarray, scenario: Scenario = DEFAULT, search: Search | None = None, seed: int = -1) -> Plan:
    """The best drive found from cars (vehicles, 10), the start of an episode."""
    search = search or Search()
    decisions = search.decisions or scenario.clock.decisions
    worth = future_worth(scenario, decisions, search.gamma)
    beam, values = cars[None].copy(), np.zeros(1)
    history: list[tuple[np.ndarray, ...]] = []  # of each decision: parents, actions, rewards of the beam
    for t in range(decisions):
        children, rewards, accidents = expand(beam, scenario)
        totals = (values[:, None] + search.gamma**t * rewards).ravel()
        alive = accidents.ravel() == 0
        if search.keep_lane:
            alive &= children[:, EGO, LANE] == cars[EGO, LANE]
        if alive.any():
            scores = totals + search.gamma ** (t + 1) * np.interp(children[:, EGO, SPEED], *worth[decisions - t - 1])
            chosen = select(children, scores, alive, search.beam)
        else:  # all continuations end in an accident: the one with the highest return
            chosen = totals.argmax(keepdims=True)
        history.append((chosen // N_ACTIONS, chosen % N_ACTIONS, rewards.ravel()[chosen]))
        beam, values = children[chosen], totals[chosen]
        if not alive.any():
            break
    return _trace_back(history, beam, values, seed)


def select(children: np.ndarray, scores: np.ndarray, alive: np.ndarray, beam: int) -> np.ndarray:
    """Which children to keep: the best of each cell; of those, a fair share for each lane and speed, then the best.

    Half of the beam is shared out. Otherwise all kept drives soon do the same: they accelerate
    towards the trap until they cannot brake in time.
    """
    order = np.flatnonzero(alive)
    order = order[np.argsort(-scores[order], kind="stable")]
    egos = children[order, EGO]
    cells = np.round(egos[:, list(CELL)] / list(CELL.values()))
    _, first = np.unique(cells, axis=0, return_index=True)
    order, egos = order[np.sort(first)], egos[np.sort(first)]  # still best first
    kinds = egos[:, LANE] * 1000 + np.round(egos[:, SPEED])
    share = max(1, beam // (2 * len(np.unique(kinds))))
    place = np.empty(len(order), dtype=np.int64)  # rank among those of the same lane and speed, 0 is the best
    for kind in np.unique(kinds):
        place[kinds == kind] = np.arange((kinds == kind).sum())
    return order[np.argsort(place >= share, kind="stable")[:beam]]


def _trace_back(history, beam: np.ndarray, values: np.ndarray, seed: int) -> Plan:
    row = int(values.argmax())
    value, success = float(values[row]), bool(beam[row, EGO, X] > beam[row, TRAP_1, X])
    actions, rewards = [], []
    for parents, taken, earned in reversed(history):
        actions.append(taken[row])
        rewards.append(earned[row])
        row = parents[row]
    return Plan(seed, np.array(actions[::-1]), np.array(rewards[::-1]), value, success)


def follow(plans: Sequence[Plan]) -> PlanPolicy:
    """Drives each plan on its own road: record(follow(plans), [p.seed for p in plans], scenario, "planner").

    It raises BootcourseError where there are more or fewer roads than plans.
    """
    longest = max(len(each.actions) for each in plans)
    table = np.full((longest, len(plans)), IDLE)
    for road, each in enumerate(plans):
        table[: len(each.actions), road] = each.actions
    return PlanPolicy(table)


def planner_rule(search: Search | None = None) -> MarkedRule:
    """The planner as a teacher: it plans anew at each decision, 15 ahead with a beam of 30, and takes the first action.

    A decision takes about ten milliseconds. Beyond its horizon it assumes an empty road: see `future_worth`.
    """
    search = search or Search(beam=30, decisions=15)

    def planned(cars: np.ndarray, scenario: Scenario) -> int:
        return int(plan(cars, scenario, search).actions[0])

    return with_name(planned, f"planner, beam {search.beam}, {search.decisions or 'all'} decisions")


@dataclass(frozen=True)
class Staying:
    """Discounted values from the start of an episode, Σ γ^t r_t, each over the same roads."""

    gamma: float
    idle: Estimate  # does nothing: stays behind the trap
    keep_lane: Estimate  # the best drive found that stays in its lane
    rule: Estimate  # leaves by the backward gap, as the rule does
    best: Estimate  # the best drive found
    gain: Estimate  # best less keep_lane, road by road
    leaves: Estimate  # share of the roads on which the best drive found ends ahead of trap 1


def is_staying_optimal(
    seeds: Sequence[int], scenario: Scenario = DEFAULT, gamma: float = 0.8, beam: int = 200
) -> Staying:
    """Is staying behind the trap optimal at this γ, as far as the search can tell?

    Both searches end where γ^t is under a millionth. If `gain` lies above 0, an agent that stays has
    not found what there is to find; a gain of `rule` over `keep_lane` would say that the rule's own
    detour pays at this γ.
    """
    if not 0 < gamma < 1:
        raise BootcourseError(f"gamma = {gamma}: give a discount factor between 0 and 1.")
    seeds = list(seeds)
    decisions = min(scenario.clock.decisions, math.ceil(math.log(1e-6) / math.log(gamma)))
    free, in_lane = (
        plan_episodes(seeds, scenario, Search(beam, gamma, keep_lane, decisions)) for keep_lane in (False, True)
    )
    free_values, lane_values = (np.array([plan.value for plan in plans]) for plans in (free, in_lane))
    return Staying(
        gamma=gamma,
        idle=mean(discounted_values(idle_policy, seeds, scenario, gamma)),
        keep_lane=mean(lane_values),
        rule=mean(discounted_values(rule_policy(scenario), seeds, scenario, gamma)),
        best=mean(free_values),
        gain=mean(free_values - lane_values),
        leaves=rate(np.array([plan.success for plan in free])),
    )


def discounted_values(policy: Policy, seeds: Sequence[int], scenario: Scenario, gamma: float) -> np.ndarray:
    """Σ γ^t r_t (Equation 2) of a whole episode on the road of each seed, (roads,)."""
    env, values = TrapVectorEnv(len(seeds), scenario, AutoresetMode.DISABLED), np.zeros(len(seeds))
    for t, step in enumerate(steps(policy, env, list(seeds))):
        values += gamma**t * step.rewards
    return values

"""Fingerprints of behaviour: numbers that stay the same as long as the code does the same.

Whatever ships names the behaviours that it depends on, and carries their fingerprints from the day on which it was
made. It is current while the code still gives these numbers. Renaming, moving and rewriting code changes none of
them; a flipped sign, another default and another random draw do. Two limits say how far they may differ, because
another processor rounds differently (see `alike`). Kernels for SSE 4.2 instead of AVX-512 moved a method's numbers
by 3e-7 at most, and the others not at all; the planted bugs in tests/test_fingerprint.py move theirs by ten limits.
"""

import hashlib
import json
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import cache, partial
from pathlib import Path

import numpy as np

from bootcourse.episodes.evaluate import drive_episodes
from bootcourse.learn.demonstrations import collect
from bootcourse.learn.settings import Settings, settings_for, with_seeds
from bootcourse.learn.training import Training
from bootcourse.methods import METHODS
from bootcourse.policies import rule_policy, stochastic_rule_policy
from bootcourse.research.planner import Search, is_staying_optimal, plan_episodes
from bootcourse.research.teachers import PLANNER, RULE, TEACHERS
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.rule import rule
from bootcourse.scenario import CALIBRATED, DEFAULT, Scenario
from bootcourse.statistics import escapes, improvement
from bootcourse.storage.assets import read_manifest

ROADS, DECISIONS = 32, 80  # driven by random actions
IN_THE_LOOP, UPDATES = 8, 60  # updates between decisions; all updates
SECOND_ROUND = 17  # updates between decisions of an on-policy method that drives two rounds, not one
# What is off by default and switched on in trainings of its own. λ and V_C act from the second round on, and where
# accidents cost nothing else; quantiles have spread by then. The limit of the risk is one that some actions keep, and
# others do not.
SWITCHED_ON = {
    "ppo_safe": (
        {"accident_cost": 0.0, "multiplier_step": 30.0},
        {"risk_limit": 0.85, "shield": True, "restart_share": 0.5},
        {"value_quantiles": 8, "worst_share": 0.125, "critic_lr": 0.02},
    )
}
LEARNED, COMPUTED = 1e-3, 1e-6  # how far a fingerprint may move: a method's (float32 networks); another's


def drives(scenario: Scenario) -> tuple[list[np.ndarray], np.ndarray, np.ndarray]:
    """Random actions on some roads: the columns that describe what happened, what was seen (n, observation), and the
    cars (n, vehicles, 10).
    """
    env, rng = TrapVectorEnv(ROADS, scenario), np.random.default_rng(0)
    env.reset(seed=0)
    seen, cars, happened, decided = [], [], [], []
    for _ in range(DECISIONS):
        steering = rng.choice(3, size=ROADS, p=(0.05, 0.9, 0.05))  # more of it and no car stays on the road
        observations, rewards, terminated, truncated, infos = env.step(3 * rng.integers(3, size=ROADS) + steering)
        ended = infos.get("final_info", infos)
        happened.append([rewards, terminated, truncated, *(ended[name] for name in ("accident", "distance", "speed"))])
        decided.append(list(vars(rule(env.cars, scenario)).values()))
        seen.append(observations)
        cars.append(env.cars.copy())
    return [np.hstack(happened), np.hstack(decided)], np.concatenate(seen), np.concatenate(cars)


def _road(scenario: Scenario) -> Iterable[float]:
    (happened, _), seen, _ = drives(scenario)
    seen = seen.astype(np.float64)
    return [*happened.mean(1), *happened.std(1), *seen.mean(0), *seen.std(0)]


def _rule() -> Iterable[float]:
    (_, decided), *_ = drives(DEFAULT)
    decided = np.where(np.isfinite(decided), decided, 0.0)
    driven = drive_episodes(rule_policy(DEFAULT), range(20))
    return [*decided.mean(1), *decided.std(1), *(values.mean() for values in vars(driven).values())]


def _demonstrations() -> Iterable[float]:
    stochastic = stochastic_rule_policy(DEFAULT, np.random.default_rng(0))
    return [*collect(20).double().mean(0), *collect(20, DEFAULT, stochastic).double().mean(0)]


def _planner() -> Iterable[float]:
    plans = plan_episodes(range(3), DEFAULT, Search(beam=20))
    staying = is_staying_optimal(range(2), DEFAULT, beam=10)
    return [*(each.value for each in plans), *np.hstack(list(vars(staying).values()))]


def _teachers() -> Iterable[float]:
    """What the study's teachers would do, the planner left out."""
    _, _, cars = drives(DEFAULT)
    answers = [its.rule(cars, DEFAULT) for name, its in TEACHERS.items() if name != PLANNER]
    return [*np.mean(answers, axis=1), *np.std(answers, axis=1)]


def _statistics() -> Iterable[float]:
    """What the report says of invented results, in numbers."""
    from bootcourse.research.fidelity import VERDICTS, judge
    from bootcourse.research.results import MEASURES, Results
    from bootcourse.research.tables import score

    rng, methods = np.random.default_rng(0), ("sac", "bootstrapped")
    agents, shape = [{"method": method, "seed": seed} for method in methods for seed in range(5)], (10, 20)
    tested = {name: rng.normal(size, 0.1 * size, shape) for name, size in SIZES.items()}
    tested |= {"success": rng.random(shape) < rng.random((10, 1)), "accident": rng.integers(4, size=shape)}
    results = Results(agents, np.full(10, -1), tested, {})
    found = [judge(results, method, column) for method in methods for column in (*SIZES, "success", "collision")]
    ours, other = (results.of(method).scores("returns") for method in methods)
    estimates = [score(results, method, measure) for method in methods for measure in MEASURES]
    estimates += [each.ours for each in found] + [improvement(ours, other), escapes(results.scores("success"))]
    return [*np.hstack(estimates), *(VERDICTS.index(each.verdict) for each in found)]


SIZES = {"returns": 30.0, "speed": 11.0, "distance": 1600.0}  # of the invented results


def _method(method: str) -> Iterable[float]:
    """What the method's own settings make of two agents, and what those in `SWITCHED_ON` do."""
    changed = ({}, *SWITCHED_ON.get(method, ()))
    return [number for changes in changed for number in _trained(settings_for(method, **changes))]


def _trained(settings: Settings) -> list[float]:
    """Two agents' curves, policies, values and temperatures after a short training.

    Most updates come after the last decision, and on-policy methods clone shortly and drive few roads: rounding could
    let an agent take another action, and everything after it would differ.
    """
    later = getattr(settings, "multiplier_step", 0) or getattr(settings, "value_quantiles", 1) > 1
    numbers, in_the_loop = [], SECOND_ROUND if later else IN_THE_LOOP
    if METHODS[settings.method].on_policy:
        numbers = [settings.envs_per_agent, settings.batch, settings.cloning_updates]
        settings = replace(settings, envs_per_agent=8, batch=64, cloning_updates=min(settings.cloning_updates, 20))
    training = Training(with_seeds(settings, 2))
    while training.updates < in_the_loop:
        training.step()
    while training.updates < UPDATES:
        training.update()
    numbers += [np.nanmean(values) for values in training.curves.values.values()]
    _, seen, cars = drives(DEFAULT)
    for agent in (training.agent(0), training.agent(1)):
        driven = agent.as_policy(with_q=True)(seen, cars)
        greedy = np.take_along_axis(driven.policy, driven.actions[:, None], 1)
        numbers += [*driven.policy.mean(0), *driven.q_values.mean(0), greedy.mean(), np.log(agent.alpha)]
    return numbers


BEHAVIOURS: dict[str, Callable[[], Iterable[float]]] = {
    "road": partial(_road, DEFAULT),
    "calibrated road": partial(_road, CALIBRATED),
    "rule": _rule,
    "demonstrations": _demonstrations,
    "planner": _planner,
    "teachers": _teachers,
    "statistics": _statistics,
    **{method: partial(_method, method) for method in METHODS},
}


def fingerprint(name: str) -> list[float]:
    """The numbers that describe a behaviour of the present code; `name` is one of `BEHAVIOURS`."""
    return [float(f"{value:.9g}") for value in BEHAVIOURS[name]()]


@cache
def _of_this_process(name: str) -> list[float]:
    return fingerprint(name)


def fingerprints(*names: str) -> dict[str, list[float]]:
    """{name: fingerprint} for what is made now; computed once in a process."""
    return {name: _of_this_process(name) for name in names}


def behind(settings: Iterable[Settings], scenario: Scenario, teacher: str = RULE) -> tuple[str, ...]:
    """The behaviours that agents trained and tested with these settings and this teacher depend on."""
    road = "calibrated road" if scenario.name == CALIBRATED.name else "road"
    taught = any(s.needs_demonstrations or s.asks_teacher for s in settings)
    drawn = any(s.stochastic_demonstrations for s in settings)
    other = {RULE: [], PLANNER: ["planner"]}.get(teacher, ["teachers"])
    methods = dict.fromkeys(s.method for s in settings)
    return (road, *["rule"] * taught, *other, *["demonstrations"] * drawn, *methods)


def alike(name: str, one: list[float], other: list[float]) -> bool:
    """Are these fingerprints of the same behaviour? A number may differ by the limit times its size, or 1 if larger."""
    limit = LEARNED if name in METHODS else COMPUTED
    sizes = np.maximum(1, np.abs(other))
    return len(one) == len(other) and bool(np.all(np.abs(np.subtract(one, other)) <= limit * sizes))


def key(values: list[float]) -> str:
    """A short name for a fingerprint, for the manifest."""
    return hashlib.sha256(json.dumps(values).encode()).hexdigest()[:8]


def older(folder: Path) -> list[str]:
    """The files in `folder` whose behaviour is no longer the code's, a sentence each."""
    manifest = read_manifest(folder)
    now = {name: fingerprint(name) for name, known in manifest["behaviours"].items() if known and name in BEHAVIOURS}
    current = {
        (name, made)
        for name, known in manifest["behaviours"].items()
        for made, values in known.items()
        if name in now and alike(name, now[name], values)
    }
    sentences = []
    for entry in manifest["files"]:
        changed = [name for name, made in entry["behaviour"].items() if (name, made) not in current]
        if changed:
            sentences.append(f"{entry['file']} is older than the code's {', '.join(changed)}: {entry['command']}")
    return sentences

"""Recording: let a driver drive, on either road, and keep everything as a `Rollout`."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from gymnasium.vector import AutoresetMode

from bootcourse.episodes.rollout import Rollout
from bootcourse.files import provenance
from bootcourse.policies import Policy, PolicyOutput
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.rule import RuleDecisions, rule
from bootcourse.scenario import DEFAULT, Scenario


@dataclass
class EpisodeRecorder:
    """What is noted of one road while it is driven."""

    states: list = field(default_factory=list)
    observations: list = field(default_factory=list)
    actions: list = field(default_factory=list)
    rewards: list = field(default_factory=list)
    terms: list = field(default_factory=list)
    policy: list = field(default_factory=list)
    q_values: list = field(default_factory=list)
    rule: list = field(default_factory=list)

    def note_choice(self, choice: PolicyOutput, why: RuleDecisions, road: int) -> None:
        self.actions.append(choice.actions[road])
        if choice.policy is not None:
            self.policy.append(choice.policy[road])
        if choice.q_values is not None:
            self.q_values.append(choice.q_values[road])
        self.rule.append((why.actions[road], why.speeds[road], why.lanes[road], why.distances[road], why.reasons[road]))

    def note_outcome(self, states, observation, reward, terms) -> None:
        self.states.extend(np.array(state) for state in states)
        self.observations.append(np.array(observation, dtype=np.float32))
        self.rewards.append(reward)
        self.terms.append(terms)

    def rollout(self, scenario: Scenario, label: str, seed: int, accident: int) -> Rollout:
        actions, speeds, lanes, distances, reasons = (np.array(column) for column in zip(*self.rule, strict=True))
        return Rollout(
            scenario=scenario,
            label=label,
            seed=int(seed),
            states=np.array(self.states),
            observations=np.array(self.observations),
            actions=np.array(self.actions, dtype=np.int64),
            rewards=np.array(self.rewards),
            terms=np.array(self.terms),
            accident=int(accident),
            policy=np.array(self.policy) if self.policy else None,
            q_values=np.array(self.q_values) if self.q_values else None,
            rule_actions=actions.astype(np.int64),
            rule_speeds=speeds,
            rule_lanes=lanes.astype(np.int64),
            rule_distances=distances,
            rule_reasons=reasons.astype(np.int64),
            provenance=provenance(),
        )


def record(driver: Policy, seeds: Sequence[int], scenario: Scenario = DEFAULT, label: str = "driver") -> list[Rollout]:
    """Drive one episode for each seed on the compiled road; one `Rollout` each."""
    seeds = list(seeds)
    env = TrapVectorEnv(len(seeds), scenario, AutoresetMode.DISABLED, record=True)
    observations, _ = env.reset(seed=seeds)
    tapes = [
        EpisodeRecorder([cars.copy()], [observation.copy()])
        for cars, observation in zip(env.cars, observations, strict=True)
    ]
    accidents = np.zeros(len(seeds), dtype=np.int64)
    awake = np.ones(len(seeds), dtype=bool)
    while awake.any():
        choice, why = driver(observations, env.cars), rule(env.cars, scenario)
        observations, rewards, terminated, truncated, infos = env.step(choice.actions)
        terms = np.stack([infos["r_v"], infos["r_y"], infos["r_theta"]], axis=1)
        for road in np.flatnonzero(awake):
            tapes[road].note_choice(choice, why, road)
            accidents[road] = infos["accident"][road]
            trace = driven(env.trace[road], accidents[road])
            tapes[road].note_outcome(trace, observations[road], rewards[road], terms[road])
        awake &= ~(terminated | truncated)
    return [
        tape.rollout(scenario, label, seed, accident)
        for tape, seed, accident in zip(tapes, seeds, accidents, strict=True)
    ]


def driven(trace: np.ndarray, accident: int) -> np.ndarray:
    """The steps of a decision's trace that were driven: after an accident the road repeats its last state."""
    if not accident:
        return trace
    repeats = [bool((trace[step] == trace[step - 1]).all()) for step in range(1, len(trace))]
    return trace[: len(trace) - sum(repeats)]


def record_on_highway_env(driver: Policy, seed: int, env, label: str = "driver") -> Rollout:
    """Drive one episode on `TrapEnv` (as made by gym.make); the same `Rollout` as on the compiled road."""
    road, scenario = env.unwrapped, env.unwrapped.scenario
    observation, info = env.reset(seed=seed)
    tape = EpisodeRecorder([road.cars()], [observation.copy()])
    over = False
    while not over:
        cars = road.cars()[None]
        choice = driver(observation[None], cars)
        tape.note_choice(choice, rule(cars, scenario), 0)
        observation, reward, terminated, truncated, info = env.step(int(choice.actions[0]))
        tape.note_outcome(road.trace, observation, reward, list(info["rewards"].values()))
        over = terminated or truncated
    return tape.rollout(scenario, label, seed, info["accident"])

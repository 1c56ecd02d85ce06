"""Recording a policy's episodes on the compiled road as `Rollout`s."""

from collections.abc import Sequence

import numpy as np
from gymnasium.vector import AutoresetMode

from bootcourse.episodes.driving import steps
from bootcourse.episodes.rollout import Rollout
from bootcourse.errors import whole
from bootcourse.files import provenance
from bootcourse.policies import Policy, PolicyOutput
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.rule import rule
from bootcourse.scenario import DEFAULT, Scenario


class EpisodeRecorder:
    """The recording of an episode in progress; cars (vehicles, 10), observation (observation_size,): its start."""

    def __init__(self, cars: np.ndarray, observation: np.ndarray):
        self.states, self.observations = [cars.copy()], [observation.copy()]
        self.actions, self.rewards, self.terms = [], [], []
        self.policy, self.q_values = [], []  # empty for policies without π or Q

    def add(self, output: PolicyOutput, states, observation, reward, terms, road: int) -> None:
        """Record a policy's decision on a road, and its outcome.

        The outcome: the state after each simulation step, the next observation, r, and (r_v, r_y, r_θ).
        """
        self.actions.append(output.actions[road])
        if output.policy is not None:
            self.policy.append(output.policy[road])
        if output.q_values is not None:
            self.q_values.append(output.q_values[road])
        self.states.extend(np.array(state) for state in states)
        self.observations.append(np.array(observation, dtype=np.float32))
        self.rewards.append(reward)
        self.terms.append(terms)

    def rollout(self, scenario: Scenario, label: str, seed: int, accident: int) -> Rollout:
        """The episode so far as a `Rollout`, with what the rule would have done in its place."""
        states = np.array(self.states)
        decided = states[:: scenario.clock.steps][: len(self.actions)]
        by_rule = rule(np.ascontiguousarray(decided), scenario)
        return Rollout(
            scenario=scenario,
            label=label,
            seed=int(seed),
            states=states,
            observations=np.array(self.observations),
            actions=np.array(self.actions, dtype=np.int64),
            rewards=np.array(self.rewards),
            terms=np.array(self.terms),
            accident=int(accident),
            policy=np.array(self.policy) if self.policy else None,
            q_values=np.array(self.q_values) if self.q_values else None,
            provenance=provenance(),
            **{f"rule_{name}": values for name, values in vars(by_rule).items()},
        )


def record(
    policy: Policy,
    seeds: Sequence[int],
    scenario: Scenario = DEFAULT,
    label: str = "driver",
) -> list[Rollout]:
    """Drive one episode on the compiled road of each seed; returns a `Rollout` of each.

    label: the driver, such as "sac, seed 3". Raises BootcourseError for a seed that is not a whole number of 0 or more.
    """
    seeds = [whole(seed, "seed") for seed in (seeds if np.iterable(seeds) else [seeds])]
    env = TrapVectorEnv(len(seeds), scenario, AutoresetMode.DISABLED, record=True)
    recorders, accidents = [], np.zeros(len(seeds), dtype=np.int64)
    for step in steps(policy, env, seeds):
        if not recorders:
            recorders = [EpisodeRecorder(*start) for start in zip(step.cars, step.observations, strict=True)]
        terms = np.stack([step.infos[name] for name in ("r_v", "r_y", "r_theta")], axis=1)
        for road in map(int, np.flatnonzero(step.running)):
            accidents[road] = step.infos["accident"][road]
            states = driven(env.trace[road], accidents[road])
            outcome = states, step.next_observations[road], step.rewards[road], terms[road]
            recorders[road].add(step.output, *outcome, road)
    each = zip(recorders, seeds, accidents, strict=True)
    return [recorder.rollout(scenario, label, seed, int(accident)) for recorder, seed, accident in each]


def driven(trace: np.ndarray, accident: int) -> np.ndarray:
    """A decision's trace (steps, vehicles, 10) without the repeated last states after an accident."""
    if not accident:
        return trace
    repeats = [bool((trace[step] == trace[step - 1]).all()) for step in range(1, len(trace))]
    return trace[: len(trace) - sum(repeats)]

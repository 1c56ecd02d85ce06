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
from bootcourse.rule import RuleDecisions, rule
from bootcourse.scenario import DEFAULT, RULE_P, Scenario


class EpisodeRecorder:
    """The recording of an episode in progress; cars (vehicles, 10), observation (observation_size,): its start."""

    def __init__(self, cars: np.ndarray, observation: np.ndarray):
        self.states, self.observations = [cars.copy()], [observation.copy()]
        self.actions, self.rewards, self.terms = [], [], []
        self.policy, self.q_values = [], []  # empty for policies without π or Q
        self.rule = []  # the rule's decisions: a value of each field of `RuleDecisions`

    def add(self, output: PolicyOutput, by_rule: RuleDecisions, states, observation, reward, terms, road: int) -> None:
        """Record a decision on a road, the policy's and the rule's, and its outcome.

        The outcome: the state after each simulation step, the next observation, r, and (r_v, r_y, r_θ).
        """
        self.actions.append(output.actions[road])
        if output.policy is not None:
            self.policy.append(output.policy[road])
        if output.q_values is not None:
            self.q_values.append(output.q_values[road])
        self.rule.append([values[road] for values in vars(by_rule).values()])
        self.states.extend(np.array(state) for state in states)
        self.observations.append(np.array(observation, dtype=np.float32))
        self.rewards.append(reward)
        self.terms.append(terms)

    def rollout(self, scenario: Scenario, label: str, seed: int, accident: int, rule_p: float = RULE_P) -> Rollout:
        """The episode so far as a `Rollout`."""
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
            rule_actions=actions,
            rule_speeds=speeds,
            rule_lanes=lanes,
            rule_distances=distances,
            rule_reasons=reasons,
            rule_p=rule_p,
            provenance=provenance(),
        )


def record(
    policy: Policy,
    seeds: Sequence[int],
    scenario: Scenario = DEFAULT,
    label: str = "driver",
    rule_p: float = RULE_P,
) -> list[Rollout]:
    """Drive one episode on the compiled road of each seed; returns a `Rollout` of each.

    label: the driver, such as "sac, seed 3"; rule_p: p of the stochastic rule in the drive's KL (Equation 15).
    Raises BootcourseError for a seed that is not a whole number of 0 or more.
    """
    seeds = [whole(seed, "seed") for seed in (seeds if np.iterable(seeds) else [seeds])]
    env = TrapVectorEnv(len(seeds), scenario, AutoresetMode.DISABLED, record=True)
    recorders, accidents = [], np.zeros(len(seeds), dtype=np.int64)
    for step in steps(policy, env, seeds):
        if not recorders:
            recorders = [EpisodeRecorder(*start) for start in zip(step.cars, step.observations, strict=True)]
        by_rule = rule(step.cars, scenario)
        terms = np.stack([step.infos[name] for name in ("r_v", "r_y", "r_theta")], axis=1)
        for road in np.flatnonzero(step.running):
            accidents[road] = step.infos["accident"][road]
            states = driven(env.trace[road], accidents[road])
            outcome = states, step.next_observations[road], step.rewards[road], terms[road]
            recorders[road].add(step.output, by_rule, *outcome, road)
    each = zip(recorders, seeds, accidents, strict=True)
    return [recorder.rollout(scenario, label, seed, accident, rule_p) for recorder, seed, accident in each]


def driven(trace: np.ndarray, accident: int) -> np.ndarray:
    """A decision's trace (steps, vehicles, 10) without the repeated last states after an accident."""
    if not accident:
        return trace
    repeats = [bool((trace[step] == trace[step - 1]).all()) for step in range(1, len(trace))]
    return trace[: len(trace) - sum(repeats)]

"""Recording a policy's episodes on the compiled road as `Rollout`s."""

from collections.abc import Sequence
from typing import Any

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
    """One episode in progress on each road; cars (roads, vehicles, 10), observations (roads, observation_size): starts.

    Each list has an entry for each decision, of all roads; a road's first `decisions[road]` entries are its own.
    """

    def __init__(self, cars: np.ndarray, observations: np.ndarray):
        self.states, self.observations = [cars[:, None].copy()], [observations.copy()]
        self.actions, self.rewards, self.terms = [], [], []
        self.policy, self.q_values = [], []  # empty for policies without π or Q
        self.decisions, self.accidents = np.zeros((2, len(cars)), dtype=np.int64)

    def add(self, output: PolicyOutput, env: TrapVectorEnv, observations, rewards, infos, running) -> None:
        """Record a policy's decision on all roads, what the environment's `step` returned, and its trace.

        running (roads,) bool: the episode was not over.
        """
        self.actions.append(np.array(output.actions, dtype=np.int64))
        for kept, values in ((self.policy, output.policy), (self.q_values, output.q_values)):
            if values is not None:
                kept.append(values)
        self.states.append(env.trace.copy())
        self.observations.append(np.array(observations, dtype=np.float32))
        self.rewards.append(rewards)
        self.terms.append(np.stack([infos[name] for name in ("r_v", "r_y", "r_theta")], axis=1))
        self.decisions += running
        self.accidents[running] = infos["accident"][running]

    def driven(self, road: int) -> np.ndarray:
        """The states on a road so far, (S + 1, vehicles, 10)."""
        states = np.concatenate([part[road] for part in self.states[: self.decisions[road] + 1]])
        return states[: len(states) - repeats(self.states[self.decisions[road]][road]) * bool(self.accidents[road])]

    def rollouts(self, scenario: Scenario, label: str, seeds: Sequence[int]) -> list[Rollout]:
        """The episodes so far, with what the rule would have done in the driver's place. seeds: of the roads."""
        states = [self.driven(road) for road in range(len(seeds))]
        decided = [each[:: scenario.clock.steps][:n] for each, n in zip(states, self.decisions, strict=True)]
        by_rule = rule(np.concatenate(decided), scenario)
        of_road = np.cumsum(self.decisions)[:-1]
        each_rule = [np.split(values, of_road) for values in vars(by_rule).values()]
        kept = {name: np.stack(getattr(self, name)) for name in ("observations", "actions", "rewards", "terms")}
        kept |= {name: np.stack(getattr(self, name)) for name in ("policy", "q_values") if getattr(self, name)}
        drives = []
        for road, (seed, n) in enumerate(zip(seeds, self.decisions, strict=True)):
            arrays: dict[str, Any] = {
                name: values[: n + (name == "observations"), road].copy() for name, values in kept.items()
            }
            arrays |= {f"rule_{name}": values[road] for name, values in zip(vars(by_rule), each_rule, strict=True)}
            drives.append(
                Rollout(
                    scenario=scenario,
                    label=label,
                    seed=int(seed),
                    states=states[road],
                    accident=int(self.accidents[road]),
                    provenance=provenance(),
                    **arrays,
                )
            )
        return drives


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
    recorder = None
    for step in steps(policy, env, seeds):
        recorder = recorder or EpisodeRecorder(step.cars, step.observations)
        recorder.add(step.output, env, step.next_observations, step.rewards, step.infos, step.running)
    return recorder.rollouts(scenario, label, seeds)


def repeats(trace: np.ndarray) -> int:
    """How many states of a decision's trace (steps, vehicles, 10) repeat the one before: those after an accident."""
    return int((trace[1:] == trace[:-1]).all(axis=(1, 2)).sum())

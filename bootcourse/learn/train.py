"""The training loop: many agents, each on its own roads, decide and learn together.

    training = Training(with_seeds(settings_for("bootstrapped"), 4), episodes=1000)
    result = training.run()
    result.agents[0].driver()

Agents differ in seed and settings and never share anything but the demonstrations. An interrupt
(Ctrl-C, the notebook's stop button) ends `run` early with what was learned so far.
"""

import time
from collections.abc import Callable, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np
import torch

from bootcourse.errors import BootcourseError
from bootcourse.learn.agent import Agent, sample_actions
from bootcourse.learn.bootstrap import constraint_strength, demonstration_share
from bootcourse.learn.curves import Curves
from bootcourse.learn.demonstrations import collect
from bootcourse.learn.learner import Learner
from bootcourse.learn.replay import Replay, pack
from bootcourse.learn.settings import Settings
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.rule import rule
from bootcourse.scenario import DEFAULT, Scenario

FIRST_SEED = 2**33  # of the training roads; demonstrations start at 2**34, held-out roads lie below 2**32


@dataclass(frozen=True)
class Result:
    """What a training leaves behind."""

    agents: list[Agent]
    curves: dict[str, np.ndarray]  # (agents, episodes), NaN where an interrupt came first
    scenario: Scenario
    seconds: float
    interrupted: bool


class Training:
    """A training in progress. `step()` is one decision on every road and the update after it.

    settings: one for each agent (see `with_seeds`); episodes: how many each agent drives.
    Raises BootcourseError for settings that cannot train side by side.
    """

    def __init__(self, settings: Sequence[Settings], episodes: int = 1000, scenario: Scenario = DEFAULT):
        if not settings or episodes < 1:
            raise BootcourseError(f"{len(settings)} agents and {episodes} episodes: give at least 1 of each.")
        self.settings, self.episodes, self.scenario = list(settings), int(episodes), scenario
        shared, self.n_agents = self.settings[0], len(self.settings)
        self.roads = shared.roads
        self.learner = Learner(self.settings, scenario.observation_size)
        rows = collect(shared.demonstrations, scenario) if any(s.needs_demonstrations for s in settings) else None
        self.replay = Replay(self.n_agents, shared.capacity, scenario.observation_size, rows)
        self.curves = Curves(self.n_agents, self.roads, self.episodes)
        streams = [np.random.SeedSequence([s.seed]).spawn(2) for s in settings]
        self.act_rngs = [np.random.default_rng(act) for act, _ in streams]
        self.sample_rngs = [np.random.default_rng(sample) for _, sample in streams]
        self.env = TrapVectorEnv(self.n_agents * self.roads, scenario)
        self.env.reset(seed=[FIRST_SEED + s.seed * 1000 + road for s in settings for road in range(self.roads)])
        self.look()
        self.decisions, self.seconds = 0, 0.0
        self.finished_agents: dict[int, Agent] = {}  # as they were after their last episode
        self.beta_start = np.array([s.beta_start for s in settings])
        self.beta_episodes = np.array([s.beta_episodes for s in settings])

    @property
    def beta(self) -> np.ndarray:
        """Each agent's present share of demonstrations, (agents,)."""
        return demonstration_share(self.curves.finished, self.beta_start, self.beta_episodes)

    @property
    def done(self) -> bool:
        return len(self.finished_agents) == self.n_agents

    def look(self) -> None:
        """Note what the agents see now, and what the rule would do."""
        self.states = self.env.observe()
        self.rule_actions = rule(self.env.cars, self.scenario).actions

    def step(self) -> None:
        """One decision on every road, and the updates that follow it."""
        shape = (self.n_agents, self.roads)
        policy = self.learner.policy(torch.from_numpy(self.states).view(*shape, -1)).double().numpy()
        uniforms = np.stack([rng.random(self.roads) for rng in self.act_rngs])
        actions = sample_actions(policy, uniforms).ravel()
        entropies = -(policy * np.log(np.maximum(policy, 1e-30))).sum(-1).ravel()
        next_states, rewards, terminated, truncated, infos = self.env.step(actions)
        done = terminated | truncated
        reached = next_states
        if done.any():  # a road that ended has started anew: what was reached stands in final_obs
            reached = next_states.copy()
            reached[done] = np.stack(infos["final_obs"][done])
        next_rule_actions = rule(self.env.cars, self.scenario).actions
        # The rule's action in the last state of an episode: what runs out of time goes on in the target.
        reached_rule_actions = next_rule_actions
        if truncated.any():
            reached_rule_actions = next_rule_actions.copy()
            reached_rule_actions[truncated] = rule(self.env.final_cars[truncated], self.scenario).actions
        rows = pack(self.states, reached, actions, rewards, terminated, self.rule_actions, reached_rule_actions)
        self.replay.add(rows.view(*shape, -1))
        self.curves.note(self.env, rewards, entropies, done, infos, self._now())
        self.states, self.rule_actions = next_states, next_rule_actions
        self.decisions += len(actions)
        if self.decisions >= self.n_agents * self.settings[0].warm_up:
            for _ in range(self.settings[0].updates):
                self.learner.update(self.replay.sample(self.settings[0].batch, self.beta, self.sample_rngs))
        for agent in np.flatnonzero(self.curves.finished >= self.episodes):
            if agent not in self.finished_agents:
                self.finished_agents[int(agent)] = self.agent(agent)

    def run(
        self,
        progress: bool = True,
        callback: Callable[["Training"], None] | None = None,
        stop: Callable[[], bool] | None = None,
    ) -> Result:
        """Train until every agent has driven its episodes, until an interrupt, or until stop() is true.

        progress: show a bar with the success rate of the last 100 episodes. callback: called after
        every decision with this training; it may read anything.
        """
        from tqdm.auto import tqdm

        interrupted, started, before = False, time.perf_counter(), self.seconds
        total = self.n_agents * self.episodes
        with _one_thread(), tqdm(total=total, unit="episode", disable=not progress, mininterval=0.5) as bar:
            try:
                while not self.done:
                    if stop is not None and stop():
                        interrupted = True
                        break
                    self.step()
                    self.seconds = before + time.perf_counter() - started
                    if callback is not None:
                        callback(self)
                    driven = int(np.minimum(self.curves.finished, self.episodes).sum())
                    if driven > bar.n:
                        bar.set_postfix_str(_success(self.curves), refresh=False)
                        bar.update(driven - bar.n)
            except KeyboardInterrupt:
                interrupted = True
        return self.result(interrupted)

    def result(self, interrupted: bool = False) -> Result:
        """What was learned so far."""
        agents = [self.finished_agents.get(i) or self.agent(i) for i in range(self.n_agents)]
        curves = {name: values.copy() for name, values in self.curves.values.items()}
        return Result(agents, curves, self.scenario, self.seconds, interrupted)

    def agent(self, i: int) -> Agent:
        """Agent i as it is now."""
        actor = [parameter.detach()[i : i + 1].clone() for parameter in self.learner.actor]
        critics = [parameter.detach()[[i, self.n_agents + i]].clone() for parameter in self.learner.critics]
        return Agent(self.settings[i], actor, critics, float(self.learner.log_alpha[i].detach().exp()))

    def _now(self) -> dict[str, np.ndarray]:
        alpha = self.learner.log_alpha.detach().exp()
        of_agent = self.learner.of_agent
        xi = constraint_strength(alpha, of_agent["xi_multiplier"], of_agent["xi_fixed"])
        return {"alpha": alpha.numpy(), "xi": xi.numpy(), "beta": self.beta}


def _success(curves: Curves) -> str:
    rates = curves.recent("success")
    return "success " + " ".join("-" if np.isnan(rate) else f"{100 * rate:.0f}%" for rate in rates[:10])


@contextmanager
def _one_thread():
    """Small matrices are slower on several threads; what the user had set comes back afterwards."""
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        yield
    finally:
        torch.set_num_threads(before)

"""The training loop: many agents, each on its own roads, decide and learn together.

    training = Training(with_seeds(settings_for("bootstrapped"), 4), episodes=1000)
    result = training.run()
    result.agents[0].as_policy()

Agents differ in seed and settings and never share anything but the demonstrations. An interrupt
(Ctrl-C, the notebook's stop button) ends `run` early with what was learned so far.
"""

import signal
import threading
import time
import warnings
from collections.abc import Callable, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field

import numpy as np
import torch

from bootcourse.errors import BootcourseError
from bootcourse.learn.agent import Agent, sample_actions
from bootcourse.learn.bootstrap import constraint_strength, demonstration_share
from bootcourse.learn.curves import Curves
from bootcourse.learn.demonstrations import collect
from bootcourse.learn.learner import learner_for
from bootcourse.learn.replay_buffer import ReplayBuffer, encode_transitions
from bootcourse.learn.settings import Settings
from bootcourse.policies import stochastic_rule_policy
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.rule import rule
from bootcourse.scenario import DEFAULT, Scenario

LOOK_BACK = 200  # updates; an agent whose loss is not a number falls back to weights at most this old
FIRST_SEED = 2**33  # of the training roads; demonstrations start at 2**34, held-out roads lie below 2**32


@dataclass(frozen=True)
class Result:
    """What a training leaves behind."""

    agents: list[Agent]
    curves: dict[str, np.ndarray]  # (agents, episodes), NaN where an interrupt came first
    scenario: Scenario
    seconds: float
    interrupted: bool
    stopped: dict[int, int] = field(default_factory=dict)  # {agent: the decision at which its loss was not a number}


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
        self.roads = shared.envs_per_agent
        self.learner = learner_for(self.settings, scenario.observation_size)
        pi = stochastic_rule_policy(scenario, np.random.default_rng(0)) if shared.stochastic_demonstrations else None
        rows = (
            collect(shared.demonstration_episodes, scenario, pi)
            if any(s.needs_demonstrations for s in settings)
            else None
        )
        self.replay = ReplayBuffer(self.n_agents, shared.buffer_size, scenario.observation_size, rows)
        self.curves = Curves(self.n_agents, self.roads, self.episodes)
        streams = [np.random.SeedSequence([s.seed]).spawn(2) for s in settings]
        self.act_rngs = [np.random.default_rng(act) for act, _ in streams]
        self.sample_rngs = [np.random.default_rng(sample) for _, sample in streams]
        self.env = TrapVectorEnv(self.n_agents * self.roads, scenario)
        self.env.reset(seed=[FIRST_SEED + s.seed * 1000 + road for s in settings for road in range(self.roads)])
        self.look()
        self.decisions, self.seconds = 0, 0.0
        self.finished_agents: dict[int, Agent] = {}  # as they were after their last episode
        self.stopped: dict[int, int] = {}  # {agent: the decision at which its loss was not a number}
        self.updates, self.last_finite = 0, {}  # {agent: as it was at an update at which its loss was a number}
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
        next_rule_actions = rule(self.env.cars, self.scenario).actions
        reached, reached_rule_actions = next_states.copy(), next_rule_actions.copy()
        if done.any():  # a road that ended has started anew already: s' is the last state of the old episode
            reached[done] = np.stack(infos["final_obs"][done])
            reached_rule_actions[done] = rule(self.env.final_cars[done], self.scenario).actions
        rows = encode_transitions(
            self.states, reached, actions, rewards, terminated, self.rule_actions, reached_rule_actions
        )
        self.replay.add(rows.view(*shape, -1))
        self.curves.note(self.env, rewards, entropies, done, infos, self._now())
        self.states, self.rule_actions = next_states, next_rule_actions
        self.decisions += len(actions)
        if self.decisions >= self.n_agents * self.settings[0].learning_starts:
            for _ in range(self.settings[0].updates):
                self.update()
        for agent in np.flatnonzero(self.curves.finished >= self.episodes):
            if agent not in self.finished_agents:
                self.finished_agents[int(agent)] = self.agent(agent)

    def update(self) -> None:
        """One update of every agent. One whose loss is not a number stops alone, as it was when it last was one."""
        now = {} if self.updates % LOOK_BACK else {i: self.agent(i) for i in range(self.n_agents)}
        losses = self.learner.update(self.replay.sample(self.settings[0].batch, self.beta, self.sample_rngs))
        finite = torch.stack([loss for name, loss in losses.items() if name.endswith("loss")]).isfinite().all(0)
        self.updates += 1
        self.last_finite |= {i: agent for i, agent in now.items() if finite[i] or i not in self.last_finite}
        if finite.all():
            return
        for i in np.flatnonzero(~finite.numpy()):
            if i not in self.finished_agents:
                self.stopped[int(i)] = decision = self.decisions // self.n_agents
                self.finished_agents[int(i)] = self.last_finite[i]
                self.curves.finished[i] = self.episodes  # nothing more is noted of it
                who = f"{self.settings[i].method}, seed {self.settings[i].seed}"
                warnings.warn(f"{who}: its loss was not a number at decision {decision}; it stops there.", stacklevel=2)

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

        started, before = time.perf_counter(), self.seconds
        total = self.n_agents * self.episodes
        bar = tqdm(total=total, unit="episode", disable=not progress, mininterval=0.5)
        with _one_thread(), bar, _interrupt_waits() as asked_to_stop:
            try:
                while not self.done:
                    if asked_to_stop.is_set() or (stop is not None and stop()):
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
                asked_to_stop.set()
        return self.result(interrupted=asked_to_stop.is_set() or not self.done)

    def result(self, interrupted: bool = False) -> Result:
        """What was learned so far."""
        agents = [self.finished_agents.get(i) or self.agent(i) for i in range(self.n_agents)]
        curves = {name: values.copy() for name, values in self.curves.values.items()}
        return Result(agents, curves, self.scenario, self.seconds, interrupted, dict(self.stopped))

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


@contextmanager
def _interrupt_waits():
    """An interrupt waits for the step to end, so that the training can go on from there; a second one does not wait."""
    asked = threading.Event()

    def ask(signum, frame):
        if asked.is_set():
            raise KeyboardInterrupt
        asked.set()

    if threading.current_thread() is not threading.main_thread():  # interrupts go to the main thread alone
        yield asked
        return
    before = signal.signal(signal.SIGINT, ask)
    try:
        yield asked
    finally:
        signal.signal(signal.SIGINT, before if before is not None else signal.default_int_handler)

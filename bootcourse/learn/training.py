"""The training loop: many agents, each on several roads, drive and learn side by side.

    training = Training(with_seeds(settings_for("bootstrapped"), 4), episodes=1000)
    result = training.run()
    result.agents[0].as_policy()

    Training(settings, make_env=lambda n: gym.make_vec("MountainCar-v0", n), teacher=my_rule)  # on another problem

The agents differ in seed and settings; they share the teacher and the demonstrations. An interrupt (Ctrl-C, the
notebook's stop button) ends `run` early, with the agents as trained so far.
"""

import time
import warnings
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pkgutil import resolve_name
from typing import Any

import numpy as np
import torch
from gymnasium.vector import VectorEnv
from torch import Tensor

from bootcourse.episodes.driving import copies_of, reached_observations
from bootcourse.episodes.place import TRAP_ID, place_of
from bootcourse.episodes.rollout import Rollout
from bootcourse.errors import BootcourseError, check_known, require, whole
from bootcourse.learn.agent import Agent, sample_actions
from bootcourse.learn.bootstrap import demonstration_share
from bootcourse.learn.curves import Curves
from bootcourse.learn.demonstrations import demonstrations_for
from bootcourse.learn.protocol import Learner, move_to
from bootcourse.learn.records import refusal
from bootcourse.learn.replay_buffer import encode_transitions
from bootcourse.learn.running import device_named, interrupt_after_step, one_torch_thread
from bootcourse.learn.settings import Settings
from bootcourse.learn.teachers import Rule, default_teacher, marked, teacher_name, teacher_of
from bootcourse.methods import display_name
from bootcourse.one_per_cell import this_cell
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import DEFAULT, Scenario, check_p
from bootcourse.terminal import printable

SNAPSHOT_EVERY = 200  # updates between snapshots; an agent with a non-finite loss is frozen at its last finite one
CHANGEABLE = ("rule_p", "xi_multiplier", "bonus", "beta_start")  # while a training runs: see `Training.change`
MOST_EPISODES = 100_000  # of each agent, whose curves take 8 MB then
FIRST_SEED = 2**33  # seed of the first training road; demonstrations start at 2**34, held-out roads are below 2**32

LEARNERS = {
    "torch": "bootcourse.learn.learner:learner_for",
    "compiled": "bootcourse.learn.compiled_learner:CompiledLearner",
}
FASTER = "faster"  # the compiled learner where it can train these agents, else torch's


@dataclass(frozen=True, repr=False)
class Result:
    """The result of a training."""

    agents: list[Agent]
    curves: dict[str, np.ndarray]  # {name: (agents, episodes)}, NaN for episodes that were not driven
    scenario: Scenario | None  # None off the trap
    seconds: float
    interrupted: bool
    stopped: dict[int, int] = field(default_factory=dict)  # {agent: the decision at which its loss was not finite}
    teacher: str = "rule"  # see `teachers.teacher_name`
    environment: str = TRAP_ID  # the name of a `Place`
    learner: str = "torch"  # "compiled", or "own" for a learner of your own

    def __repr__(self) -> str:
        counts = Counter(display_name(agent.settings.method) for agent in self.agents)
        agents = ", ".join(f"{n} agent{'s' * (n > 1)} of {method}" for method, n in counts.items())
        where = "the trap" if self.scenario else self.environment
        ends = np.isfinite(self.curves["return"]).sum(1)  # (agents,) episodes
        returns = [values[:n][-100:].mean() for values, n in zip(self.curves["return"], ends, strict=True) if n]
        each = ", ".join(f"{value:.1f}" for value in returns[:10]) + " …" * (len(returns) > 10)
        return printable(
            f"{agents} on {where}, teacher: {self.teacher}\n"
            f"{ends.sum():,} episodes in {self.seconds:.0f} s{', not finished' * self.interrupted}\n"
            f"mean return of each agent's last 100 episodes: {each or 'no episode has ended'}"
        )


class Training:
    """A training in progress. `step()` is one decision on every road and the updates after it.

    settings: one for each agent (see `with_seeds`). episodes: of each agent.
    teacher: the rule of the demonstrations and the KL (teachers.py); None: the course's on the trap, elsewhere none.
    demonstrations: recorded drives, or rows (transitions, row), instead of the teacher's.
    make_env: makes a vector environment of n copies, by default the trap; another has vector observations and discrete
    actions (see `driving.copies_of`). Without a teacher its actions are 0 in the replay buffer. first_seed: of the
    copies. device: where the networks learn, as torch names it, such as "cuda"; the roads stay on the CPU.
    learner: "torch"; "compiled", the same update as machine code: faster on a CPU, most of all for a single agent; or
    "faster", compiled if that learner has these settings, else torch.
    make_learner: makes a learner of your own instead, from (settings, observation size, actions).
    Raises BootcourseError for settings that cannot train side by side, or that ask for a teacher where there is none,
    for demonstrations or an environment that do not fit, for a learner that does not have the settings or the device,
    and for a device that torch does not find.
    """

    def __init__(
        self,
        settings: Sequence[Settings],
        episodes: int = 1000,
        scenario: Scenario = DEFAULT,
        teacher: Rule | None = None,
        demonstrations: Sequence[Rollout] | Tensor | None = None,
        make_env: Callable[[int], VectorEnv] | None = None,
        first_seed: int = FIRST_SEED,
        device: str = "cpu",
        make_learner: Callable[[Sequence[Settings], int, int], Learner] | None = None,
        learner: str = "torch",
    ):
        _check_settings(settings)
        self.episodes = whole(episodes, "episodes", MOST_EPISODES, low=1)
        self.settings, self.make_env = list(settings), make_env
        self.n_agents, self.envs_per_agent = len(settings), settings[0].envs_per_agent
        n_envs = self.n_agents * self.envs_per_agent
        self.env: Any = TrapVectorEnv(n_envs, scenario) if make_env is None else copies_of(make_env, n_envs)
        self.place = place_of(self.env)
        actions: Any = self.env.single_action_space
        size, self.n_actions = self.env.single_observation_space.shape[0], int(actions.n)
        self._make_learner(make_learner, learner, device, size)
        self._set_teacher(default_teacher(self.place) if teacher is None else teacher)
        rows = demonstrations_for(settings, demonstrations, self.teacher, self.scenario, make_env, self.n_actions)
        self.replay = self.learner.make_buffer(size, rows)
        self._begin(whole(first_seed, "first_seed"))

    def _make_learner(self, make_learner: Callable | None, learner: str, device: str, size: int) -> None:
        """The learner of the agents' method, torch's or the compiled one, or one of your own, on its device."""
        check_known("Learner", learner, (*LEARNERS, FASTER))
        if learner == FASTER:
            can = device == "cpu" and not any(refusal(s, size, self.n_actions) for s in self.settings)
            learner = "compiled" if can and make_learner is None else "torch"
        compiled = learner == "compiled"
        require(not (compiled and make_learner), 'A learner of your own is not compiled: leave out learner="compiled".')
        require(not compiled or device == "cpu", f'The compiled learner has device="cpu" only, not {device!r}.')
        self.learner_name = None if make_learner else learner  # None: a learner of your own
        make = make_learner or resolve_name(LEARNERS[learner])
        self.learner = make(self.settings, size, self.n_actions)
        if device != "cpu":
            move_to(self.learner, device_named(device))

    def _begin(self, first_seed: int) -> None:
        """The first episodes, the generators of each agent, and everything that is counted from 0."""
        self.curves = Curves(self.n_agents, self.envs_per_agent, self.episodes)
        streams = [np.random.SeedSequence([s.seed]).spawn(2) for s in self.settings]
        self.act_rngs = [np.random.default_rng(act) for act, _ in streams]
        self.sample_rngs = [np.random.default_rng(sample) for _, sample in streams]
        seeds = [first_seed + s.seed * 1000 + env for s in self.settings for env in range(self.envs_per_agent)]
        self.states, _ = self.env.reset(seed=seeds)
        self.rule_actions = self.taught()  # μ(s), (envs,)
        self.decisions, self.updates, self.seconds = 0, 0, 0.0
        self.losses: dict[str, Tensor] = {}  # of the last update, each (agents,)
        self.finished_agents: dict[int, Agent] = {}  # snapshots after their last episode
        self.stopped: dict[int, int] = {}  # {agent: the decision at which its loss was not finite}
        self.last_finite: dict[int, Agent] = {}  # {agent: a snapshot from an update with a finite loss}
        self.beta_start = np.array([s.beta_start for s in self.settings])
        self.beta_episodes = np.array([np.inf if s.beta_episodes is None else s.beta_episodes for s in self.settings])

    def _set_teacher(self, teacher: Rule | None) -> None:
        """Set the teacher, and whether it is asked in the states that the agents reach."""
        asking = [s for s in self.settings if s.asks_teacher]
        if asking and teacher is None:
            raise BootcourseError(
                f"Method '{asking[0].method}' asks a teacher, and {self.place.name} has none: give "
                "teacher=my_rule, or choose a method without a teacher, such as 'sac'."
            )
        for settings in asking:
            check_p(settings.rule_p, "rule_p", self.n_actions)
        self.teacher = teacher
        self._teach = None if teacher is None else teacher_of(teacher, self.scenario, self.n_actions)
        self.asks = teacher is not None and (bool(asking) or not marked(teacher).is_slow)

    @property
    def scenario(self) -> Scenario | None:
        """The road's; None off the trap."""
        return self.place.scenario

    @property
    def beta(self) -> np.ndarray:
        """Each agent's present share of demonstrations in a batch, (agents,)."""
        return demonstration_share(self.curves.finished, self.beta_start, self.beta_episodes)

    @property
    def done(self) -> bool:
        """Whether all agents have finished."""
        return len(self.finished_agents) == self.n_agents

    def taught(self) -> np.ndarray:
        """The teacher's actions in the present states, (envs,); zeros where it is not asked."""
        if not self.asks:
            return np.zeros(self.env.num_envs, dtype=np.int64)
        return self._teach(self.place.state(self.env, self.states))

    def change(self, **values) -> None:
        """Change settings of all agents from the next update on: rule_p, xi_multiplier, bonus or beta_start.

        A share of demonstrations that is set here no longer fades. Raises BootcourseError for another setting, for a
        value out of range, and for a setting that the method does not use.
        """
        for name in values:
            check_known("While it trains, the setting", name, CHANGEABLE)
        changed = [replace(settings, **values) for settings in self.settings]
        self.learner.change(changed, [name for name in values if name != "beta_start"])
        self.settings = changed
        if "beta_start" in values:
            self.beta_start = np.array([s.beta_start for s in changed])
            self.beta_episodes = np.full(self.n_agents, np.inf)

    def step(self) -> None:
        """One decision in every environment, and the updates that follow it."""
        shape = (self.n_agents, self.envs_per_agent)
        states = torch.from_numpy(self.states).float().view(*shape, -1)
        rule_actions = torch.as_tensor(self.rule_actions, dtype=torch.int64).view(shape)
        decided = torch.as_tensor(self.curves.running[1]).view(shape)  # decisions of the running episodes
        known = (column.to(self.learner.device) for column in (states, rule_actions, decided))
        policy = self.learner.acting_policy(*known).double().cpu().numpy()  # (*shape, 9)
        uniforms = np.stack([rng.random(self.envs_per_agent) for rng in self.act_rngs])
        actions = sample_actions(policy, uniforms).ravel()
        entropies = -(policy * np.log(np.maximum(policy, 1e-30))).sum(-1).ravel()
        decided_in, taught = self.states, self.rule_actions
        self.states, rewards, terminated, truncated, infos = self.env.step(actions)
        done, reached = terminated | truncated, reached_observations(self.states, infos)
        self.learner.note_episodes(done.reshape(shape), (self.curves.running[0] + rewards).reshape(shape))
        self.curves.note(rewards, entropies, done, infos, self.learner.coefficients() | {"beta": self.beta})
        self.rule_actions = self.taught()
        reached_rule_actions = self.rule_actions.copy()
        if done.any() and self.asks:  # these roads are already reset: μ(s') is of the old episode's last state
            reached_rule_actions[done] = self._teach(self.place.state_reached(self.env, reached, infos)[done])
        rows = encode_transitions(decided_in, reached, actions, rewards, terminated, taught, reached_rule_actions)
        self.replay.add(rows.view(*shape, -1), done.reshape(shape))
        self.decisions += len(actions)
        for _ in range(self.learner.updates_due(self.replay, self.decisions // self.n_agents)):
            self.update()
        for agent in map(int, np.flatnonzero(self.curves.finished >= self.episodes)):
            if agent not in self.finished_agents:
                self.finished_agents[agent] = self.agent(agent)

    @torch.enable_grad()  # also where somebody has switched gradients off
    def update(self) -> None:
        """One update of every agent. Agents with a non-finite loss are frozen at their last finite snapshot."""
        snapshots = {} if self.updates % SNAPSHOT_EVERY else {i: self.agent(i) for i in range(self.n_agents)}
        self.losses = self.learner.update(self.replay.sample(self.settings[0].batch, self.beta, self.sample_rngs))
        losses = [loss for name, loss in self.losses.items() if name.endswith("loss")]
        finite = torch.stack(losses).isfinite().all(0).cpu()
        self.updates += 1
        self.last_finite |= {i: agent for i, agent in snapshots.items() if finite[i] or i not in self.last_finite}
        if finite.all():
            return
        for i in map(int, np.flatnonzero(~finite.numpy())):
            if i not in self.finished_agents:
                self.stopped[i] = decision = self.decisions // self.n_agents
                self.finished_agents[i] = self.last_finite[i]
                self.curves.finished[i] = self.episodes  # the curves record no more episodes
                label = f"{self.settings[i].method}, seed {self.settings[i].seed}"
                warnings.warn(f"{label}: its loss was not finite at decision {decision}; it stops there.", stacklevel=2)

    def run(
        self,
        progress: bool = True,
        callback: Callable[["Training"], None] | None = None,
        stop: Callable[[], bool] | None = None,
        updates: int | None = None,
    ) -> Result:
        """Train until all agents have finished, until so many updates, until an interrupt, or until stop() is true.

        progress: show a bar with the success rate of the last 100 episodes; it counts updates if their number is given.
        In a notebook, the curves and the present agent on the road take its place (see panels/watch.py).
        callback: called with this training after every decision.
        """
        watch = None
        if progress and this_cell() is not None:
            from bootcourse.panels.watch import watched

            watch = watched(self)
        calls = [call for call in (callback, watch and watch.look) if call]
        started, before = time.perf_counter(), self.seconds
        bar = _Bar(self, progress and watch is None, updates)
        with one_torch_thread(), bar, interrupt_after_step() as interrupted:
            try:
                while not (self.done or interrupted.is_set()):
                    stopped = (stop is not None and stop()) or (watch is not None and watch.stopping)
                    if stopped or (updates is not None and self.updates >= updates):
                        break
                    self.step()
                    self.seconds = before + time.perf_counter() - started
                    for call in calls:
                        call(self)
                    bar.show()
                if not interrupted.is_set():
                    bar.end()
            except KeyboardInterrupt:
                interrupted.set()
        result = self.result(interrupted=interrupted.is_set() or not self.done)
        if watch is not None:
            watch.ended(result, by_hand=interrupted.is_set())
        return result

    def result(self, interrupted: bool = False) -> Result:
        """The agents and curves so far."""
        agents = [self.finished_agents.get(i) or self.agent(i) for i in range(self.n_agents)]
        curves, name = {key: values.copy() for key, values in self.curves.values.items()}, teacher_name(self.teacher)
        stopped, place, learner = dict(self.stopped), self.place, self.learner_name or "own"
        return Result(agents, curves, place.scenario, self.seconds, interrupted, stopped, name, place.name, learner)

    def agent(self, i: int) -> Agent:
        """A snapshot of agent i."""
        return self.learner.agent(i).taught_by(self._teach)


def _check_settings(settings: Sequence[Settings]) -> None:
    if not settings:
        raise BootcourseError("There are no agents: give the settings of at least one.")
    if isinstance(settings, Settings):
        raise BootcourseError("These are one agent's settings: give a list of them, such as with_seeds(settings, 4).")


class _Bar:
    """The progress of a training: its episodes, or its updates if their number is given, and the agents' success."""

    def __init__(self, training: Training, shown: bool, updates: int | None):
        from bootcourse.progress import progress_bar

        self.training, self.by_updates = training, updates is not None
        total, unit = (updates, "update") if self.by_updates else (training.n_agents * training.episodes, "episode")
        self.shown, self.total, self.bar = shown, total, progress_bar(shown=shown, total=total, unit=unit)

    def __enter__(self) -> "_Bar":
        self.bar.__enter__()
        return self

    def __exit__(self, *error) -> None:
        self.bar.__exit__(*error)

    def show(self) -> None:
        """Show how far the training is."""
        curves = self.training.curves
        so_far = self.training.updates if self.by_updates else np.minimum(curves.finished, self.training.episodes).sum()
        if self.shown and so_far > self.bar.n:
            rates = ("-" if np.isnan(rate) else f"{100 * rate:.0f}%" for rate in curves.recent("success")[:10])
            self.bar.set_postfix_str("success " + " ".join(rates), refresh=False)
            self.bar.update(min(int(so_far), self.total) - self.bar.n)

    def end(self) -> None:
        """Show that it is over as planned."""
        from bootcourse.progress import end_full

        end_full(self.bar)

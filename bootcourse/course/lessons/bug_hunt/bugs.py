"""Six silent bugs that occur in practice, and the agents of the bug hunt, which were trained with them.

Each bug is a `SACLearner` whose update is wrong in one place. No error is raised, no number is NaN, and the
curves look plausible.

    python -m bootcourse.course.lessons.bug_hunt.bugs --out assets/bug_hunt.npz    # trains all seven in some minutes

The file holds curves, probes and weights; `Hunt` reads it and calls the agents A to F.
"""

import argparse
import json
import math
import sys
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from bootcourse.episodes.record import record
from bootcourse.errors import BootcourseError, check_known
from bootcourse.files import parse, provenance, read_arrays, write_arrays
from bootcourse.learn import bootstrap, sac
from bootcourse.learn.agent import Agent
from bootcourse.learn.learner import SACLearner
from bootcourse.learn.replay_buffer import Batch, decode_transitions
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.training import Training
from bootcourse.policies import rule_policy
from bootcourse.scenario import DEFAULT, RULE_P
from bootcourse.statistics import rolling_means
from bootcourse.storage.assets import FOLDER

# The six bugs ----------------------------------------------------------------------------------------


class FlippedKL(SACLearner):
    """The KL divergence is taken the other way round: D_KL(π̃ ‖ π)."""

    def kl(self, log_pi: Tensor, rule_actions: Tensor) -> Tensor:
        log_rule = bootstrap.log_stochastic_rule(rule_actions, self.rule_p[:, 0], log_pi.shape[-1])
        return (log_rule.exp() * (log_rule - log_pi)).sum(-1)


class NoEnd(SACLearner):
    """(1 - terminated) is missing: the target adds the next value after an accident, too."""

    def critic_target(self, batch: Batch) -> Tensor:
        return super().critic_target(batch._replace(terminated=torch.zeros_like(batch.terminated)))


class Sampled(SACLearner):
    """One sampled action replaces the expectation, as in SAC for continuous actions."""

    draws = None

    def soft_value(self, log_pi: Tensor, q: Tensor, alpha: Tensor, constraint: Tensor) -> Tensor:
        """Q(s, a) - α log π(a|s) of one action a ~ π; the draw has no gradient."""
        self.draws = self.draws or torch.Generator().manual_seed(0)
        action = torch.multinomial(log_pi.detach().exp().flatten(0, -2), 1, generator=self.draws)
        action = action.view(*log_pi.shape[:-1], 1)
        return q.gather(-1, action)[..., 0] - alpha * log_pi.gather(-1, action)[..., 0] - constraint

    def actor_loss(self, log_pi: Tensor, q: Tensor, kl: Tensor) -> Tensor:
        return -self.soft_value(log_pi, q.detach(), self.alpha, self.xi * kl).mean(-1)


class NoStop(SACLearner):
    """The stop-gradient on Q is missing in the actor's loss."""

    def actor_loss(self, log_pi: Tensor, q: Tensor, kl: Tensor) -> Tensor:
        return -sac.soft_value(log_pi, q, self.alpha, self.xi * kl).mean(-1)


class BonusForAll(SACLearner):
    """The bonus c is paid for the agent's own driving as well."""

    def critic_target(self, batch: Batch) -> Tensor:
        return super().critic_target(batch._replace(is_demonstration=torch.ones_like(batch.is_demonstration)))


class ShiftedLabels(SACLearner):
    """The rule is asked after the step: each label belongs to the state one second later."""

    def losses(self, batch: Batch) -> dict[str, Tensor]:
        return super().losses(batch._replace(rule_actions=batch.next_rule_actions))


BUGS = {
    "flipped_kl": FlippedKL,
    "no_end": NoEnd,
    "sampled": Sampled,
    "no_stop": NoStop,
    "bonus_for_all": BonusForAll,
    "shifted_labels": ShiftedLabels,
}
LEARNERS = {"none": SACLearner, **BUGS}
LETTERS = "ABCDEF"
SHUFFLE = 2025  # the seed that assigns the letters
SEEDS, UPDATES, EVERY = 2, 10_000, 250  # agents with each bug; updates of each; updates between two probes
ROADS = range(900, 908)  # whose drives by the rule give the states of the probes
PROBES = ("kl", "entropy", "alike", "late", "rarest", "promise", "end")
CURVES = ("success", "return", "accident", "alpha")
FILE = FOLDER / "bug_hunt.npz"
COMMAND = "python -m bootcourse.course.lessons.bug_hunt.bugs --out assets/bug_hunt.npz"

# Training them ---------------------------------------------------------------------------------------


class Probe:
    """A training's callback: measures every agent every 250 updates, on states of drives by the rule.

    kl: mean D_KL(π ‖ π̃) in nats. entropy: mean H(π) in nats. alike: share of the states whose most probable
    action is the rule's. late: the same for the rule's action one second later. rarest: mean log of the
    smallest of the nine probabilities. promise: mean Σ_a π Q. end: mean Q(s, a) of the agent's own
    decisions that ended in an accident; their right value is -10.
    """

    def __init__(self):
        drives = record(rule_policy(DEFAULT), ROADS)
        self.states = np.concatenate([drive.observations[:-2] for drive in drives])
        self.now = torch.from_numpy(np.concatenate([drive.rule_actions[:-1] for drive in drives]))
        self.later = torch.from_numpy(np.concatenate([drive.rule_actions[1:] for drive in drives]))
        self.updates, self.found = [], []

    def __call__(self, training: Training) -> None:
        if training.updates % EVERY or training.updates in self.updates:
            return
        self.updates.append(training.updates)
        self.found.append([self.look(training, i) for i in range(training.n_agents)])

    def look(self, training: Training, i: int) -> list[float]:
        agent = training.agent(i)
        pi, q = agent.probabilities(self.states), agent.q_values(self.states)
        log_pi = torch.from_numpy(pi).clamp(min=1e-30).log()
        likeliest = log_pi.argmax(-1)
        found = (
            bootstrap.kl_to_rule(log_pi, self.now, torch.tensor(RULE_P)),
            sac.entropy(log_pi),
            (likeliest == self.now).float(),
            (likeliest == self.later).float(),
            log_pi.amin(-1),
            torch.from_numpy((pi * q).sum(-1)),
        )
        return [float(values.mean()) for values in found] + [self.at_the_end(training, i, agent)]

    @staticmethod
    def at_the_end(training: Training, i: int, agent: Agent) -> float:
        first = training.replay.first[i]
        rows = training.replay.table[first : first + training.replay.size]
        own = decode_transitions(rows, training.scenario.observation_size, rows[:, 0])
        ended = own.terminated > 0
        if not ended.any():
            return math.nan
        q = torch.from_numpy(agent.q_values(own.states[ended].numpy()))
        return float(q.gather(-1, own.actions[ended][:, None]).mean())


def trained(bug: str, updates: int = UPDATES) -> dict[str, np.ndarray]:
    """Train the paper's method with a bug, "none" for none. Kept are curves, probes, and the first agent's weights."""
    training, probe = Training(with_seeds(settings_for("bootstrapped"), SEEDS), 4000), Probe()
    training.learner = LEARNERS[bug](training.settings, training.scenario.observation_size)
    result = training.run(progress=False, callback=probe, stop=lambda: training.updates >= updates)
    episodes = int(training.curves.finished.max())
    kept = {f"{bug}/{name}": result.curves[name][:, :episodes].astype(np.float16) for name in CURVES}
    kept[f"{bug}/probes"] = np.array(probe.found, dtype=np.float32).reshape(-1, SEEDS, len(PROBES))
    first = result.agents[0]
    kept |= {f"{bug}/actor-{i}": weights.numpy() for i, weights in enumerate(first.actor)}
    kept |= {f"{bug}/critics-{i}": weights.numpy() for i, weights in enumerate(first.critics)}
    kept[f"{bug}/final_alpha"] = np.array(first.alpha)
    return kept | {"updates": np.array(probe.updates)}


def main(arguments: list[str] | None = None) -> int:
    program = "python -m bootcourse.course.lessons.bug_hunt.bugs"
    parser = argparse.ArgumentParser(prog=program, description=__doc__.split("\n")[0])
    parser.add_argument("--out", type=Path, default=FILE, help="the file to write (default: assets/bug_hunt.npz)")
    parser.add_argument("--updates", type=int, default=UPDATES, help=f"of each agent (default: {UPDATES})")
    options = parser.parse_args(arguments)
    arrays = {}
    for bug in LEARNERS:
        print(f"training with {bug} ...", flush=True)
        arrays |= trained(bug, options.updates)
    made = provenance(command=COMMAND, updates=options.updates, seeds=SEEDS)
    write_arrays(options.out, arrays | {"provenance": np.array(json.dumps(made))})
    return 0


# Reading them ----------------------------------------------------------------------------------------


class Hunt:
    """The trained agents under the names that the student sees: "healthy", and A to F with one bug each.

    Raises BootcourseError if the file is missing or damaged, or for another name.
    """

    def __init__(self, path: Path = FILE):
        self._arrays = read_arrays(path)
        if any(f"{bug}/probes" not in self._arrays for bug in LEARNERS):
            raise BootcourseError(f"{path} does not hold the seven agents: make it again with `{COMMAND}`.")
        bugs = np.random.default_rng(SHUFFLE).permutation(list(BUGS)).tolist()
        self._bug_of = {"healthy": "none", **dict(zip(LETTERS, bugs, strict=True))}
        self.names = tuple(self._bug_of)
        self.updates = self._arrays["updates"]  # (points,)
        self.provenance = parse(str(self._arrays["provenance"]), dict, path)

    def _of(self, name: str, what: str) -> np.ndarray:
        check_known("The agent", name, self.names)
        return self._arrays[f"{self._bug_of[name]}/{what}"]

    def curve(self, name: str, what: str) -> np.ndarray:
        """success, return, accident (0 to 3) or alpha of every training episode: (2 seeds, episodes)."""
        return self._of(name, what).astype(float)

    def probe(self, name: str, what: str) -> np.ndarray:
        """One of `PROBES` after each of `updates`: (2 seeds, points)."""
        return self._of(name, "probes")[:, :, PROBES.index(what)].T.astype(float)

    def curves(self, what: str, window: int = 30) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        """A curve of every agent, for a picture: {name: (episode (points,), rolling means (2, points))}.

        The seeds made as many updates, and not as many episodes: a shorter curve is NaN where it has ended.
        """
        found = {}
        for name in self.names:
            curve = self.curve(name, what)
            longest = int(np.isfinite(curve).sum(axis=1).max())
            found[name] = rolling_means(curve[:, :longest], window, longest)
        return found

    def at_the_end(self, what: str, window: int = 30) -> dict[str, np.ndarray]:
        """The mean of the last episodes of every seed: {name: (2,)}."""
        ends = {}
        for name in self.names:
            rows = [row[np.isfinite(row)] for row in self.curve(name, what)]
            ends[name] = np.array([row[-window:].mean() for row in rows])
        return ends

    def probes(self, what: str) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        """A probe of every agent, for a picture: {name: (updates (points,), values (2, points))}."""
        return {name: (self.updates, self.probe(name, what)) for name in self.names}

    def agent(self, name: str) -> Agent:
        """The agent of the first seed at the end of its training."""
        parts = {part: [] for part in ("actor", "critics")}
        for part, weights in parts.items():
            while f"{self._bug_of.get(name)}/{part}-{len(weights)}" in self._arrays:
                weights.append(torch.from_numpy(self._of(name, f"{part}-{len(weights)}")))
        return Agent(settings_for("bootstrapped"), **parts, alpha=float(self._of(name, "final_alpha")))


if __name__ == "__main__":
    try:
        sys.exit(main())
    except BootcourseError as error:
        sys.exit(str(error))

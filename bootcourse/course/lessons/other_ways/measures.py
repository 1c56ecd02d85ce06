"""What this lesson's trainings are asked: what critics believe, who drives how well, and when a teacher hands over."""

from collections.abc import Callable, Iterable, Mapping

import numpy as np
import torch

from bootcourse.episodes.evaluate import held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.learn.agent import Agent
from bootcourse.learn.training import Training
from bootcourse.policies import rule_policy
from bootcourse.research.paper import earned_at
from bootcourse.scenario import DEFAULT

HEADINGS = ("24 drives on new roads", "takes the rule's action, %", "accidents, %", "return")


def worth_at_most(gamma: float) -> float:
    """What a drive that earns most in each second, for ever, is worth."""
    return earned_at(15, 1) / (1 - gamma)


def from_drives_alone(training: Training, network: Callable, updates: Iterable[int]) -> np.ndarray:
    """The mean Q of the rule's actions on its way out, after each of these numbers of updates: (points,).

    network: of the critics, which learn from the rule's drives alone.
    """
    by_rule = record(rule_policy(DEFAULT), range(20), label="rule")
    way = torch.tensor(np.concatenate([drive.observations[:20] for drive in by_rule]), dtype=torch.float32)[None]
    did = torch.tensor(np.concatenate([drive.actions[:20] for drive in by_rule]))[None, :, None]
    learner, asked, found = training.learner, set(updates), []
    # A classmethod reads the network from the class: a class of its own changes this learner only.
    learner.__class__ = type("WithThisNetwork", (type(learner),), {"critic_network": staticmethod(network)})
    generators = [np.random.default_rng(learner.settings[0].seed)]
    for update in range(max(asked) + 1):
        if update:
            learner.update(training.replay.sample(64, np.ones(1), generators))  # demonstrations only
        if update in asked:
            with torch.no_grad():
                q = learner.q_pair(learner.critics, way).mean(0)
            found.append(float(q.gather(-1, did).mean()))
    return np.array(found)


def driven(agents: Mapping[str, Agent]) -> list[list[str]]:
    """A row for each agent, and for the rule, on the same roads: see `HEADINGS`."""
    policies = {words: agent.as_policy() for words, agent in agents.items()} | {"the rule": rule_policy(DEFAULT)}
    rows = []
    for words, policy in policies.items():
        drives = record(policy, held_out_seeds(16, 24), label=words)
        same = np.concatenate([drive.actions == drive.rule_actions for drive in drives])
        shares = same.mean(), np.mean([drive.accident > 0 for drive in drives])
        earns = np.mean([drive.rewards.sum() for drive in drives])
        rows.append([words, *(f"{100 * share:.0f}" for share in shares), f"{earns:.0f}"])
    return rows


def handed_over(training: Training) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Train one agent of jump-start RL, and say after which episodes h was what, the mean return, the one needed.

    Needed is NaN as long as there is no best mean.
    """
    noted = []

    def note(t: Training) -> None:
        learner, settings = t.learner, t.learner.settings[0]
        best = float(learner.best[0])
        mean, needed = float(learner.returns[0].mean()), best - settings.tolerance * abs(best)
        noted.append((t.curves.finished[0], learner.present_guide(0), mean, needed))

    training.run(progress=False, callback=note)
    episode, *values = np.array(noted).T
    at = np.arange(training.settings[0].window, training.episodes + 1)
    h, mean, needed = (np.array([each[episode <= n][-1] for n in at]) for each in values)
    return at, h, mean, np.where(np.isfinite(needed), needed, np.nan)

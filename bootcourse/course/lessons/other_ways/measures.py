"""What this lesson's trainings are asked: what critics believe, who decides, and when a teacher hands over.

At the end, what shipped trainings earned after so many decisions, or seconds of computing.
"""

from collections.abc import Iterable, Sequence
from functools import cache
from typing import NamedTuple

import numpy as np
import torch
import torch.nn.functional as F
from torch import Tensor

from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.learn import sac
from bootcourse.learn.networks import mlp
from bootcourse.learn.replay_buffer import Batch
from bootcourse.learn.rlpd import RLPDLearner
from bootcourse.learn.training import Training
from bootcourse.policies import rule_policy
from bootcourse.research import equal_decisions
from bootcourse.research.beyond import at_budget
from bootcourse.research.experiments.learned_model import partly_random
from bootcourse.research.paper import earned_at
from bootcourse.research.results import Results
from bootcourse.scenario import DEFAULT

AGENTS = {  # of the first round: the share of demonstrations in a batch
    "normalised": 1.0,
    "not normalised": 1.0,
    "the target asks the rule": 1.0,
    "half its own drives": 0.5,
}
SECONDS, DECISIONS = "seconds of computing", "decisions"  # two counts of what a training spends


def worth_at_most(gamma: float) -> float:
    """What a drive that earns most in each second, for ever, is worth."""
    return earned_at(15, 1) / (1 - gamma)


WAY = 20  # decisions at the beginning of a drive, in which the rule leaves the trap


@cache
def by_rule() -> list[Rollout]:
    """The rule's drives in which the first round asks what critics believe."""
    return record(rule_policy(DEFAULT), range(20), label="rule")


def worth_of_rule(gamma: float) -> float:
    """What the rule's actions in these states are worth: the mean of the discounted rewards that follow each."""
    rewards = np.stack([drive.rewards for drive in by_rule()])
    found = rewards.copy()
    for t in reversed(range(rewards.shape[1] - 1)):
        found[:, t] += gamma * found[:, t + 1]
    return float(found[:, :WAY].mean())


def first_normalised(parameters: Sequence[Tensor], x: Tensor) -> Tensor:
    """RLPD's critics for the first of `AGENTS`, the same without normalisation for the others."""
    first = (torch.arange(len(x)) % len(AGENTS) == 0)[:, None, None]
    for weight, bias in zip(parameters[:-2:2], parameters[1:-2:2], strict=True):
        hidden = torch.baddbmm(bias, x, weight)
        x = torch.where(first, F.layer_norm(hidden, hidden.shape[-1:]), hidden).relu()
    return torch.baddbmm(parameters[-1], x, parameters[-2])


def third_asks_the_rule(learner: RLPDLearner, batch: Batch) -> Tensor:
    """RLPD's target, (agents, batch); the third agent's with Q of the rule's next action instead of the policy's."""
    next_q = learner.target_q(batch.next_states)
    log_pi = sac.log_policy(mlp(learner.actor, batch.next_states))
    value = learner.soft_value(log_pi, next_q, learner.alpha, torch.zeros_like(batch.rewards))
    value[2] = next_q[2].gather(-1, batch.next_rule_actions[2].unsqueeze(-1)).squeeze(-1)
    return sac.critic_target(batch.rewards, batch.terminated, value, learner.gamma)


def beliefs(training: Training, updates: Iterable[int]) -> dict[str, np.ndarray]:
    """Each critic's mean Q of the rule's actions on its way out, after so many updates: {agent: (critics, points)}.

    training: of `AGENTS`. All four drive; only the last has its drives in its batches.
    """
    way = torch.tensor(np.concatenate([drive.observations[:WAY] for drive in by_rule()]), dtype=torch.float32)
    did = torch.tensor(np.concatenate([drive.actions[:WAY] for drive in by_rule()]))
    learner, found = training.learner, []
    # A classmethod reads the network from the class: a class of its own changes this learner only.
    changed = {"critic_network": staticmethod(first_normalised), "critic_target": third_asks_the_rule}
    learner.__class__ = type("OfFour", (type(learner),), changed)
    for update in updates:
        training.run(progress=False, updates=update)
        with torch.no_grad():
            q = learner.q_pair(learner.critics, way.expand(len(AGENTS), -1, -1))  # (critics, 4, states, 9)
        found.append(q[:, :, torch.arange(len(did)), did].mean(-1).numpy())
    return dict(zip(AGENTS, np.array(found).transpose(2, 1, 0), strict=True))


class Episodes(NamedTuple):
    """The training episodes of one agent and its teacher, each (episodes,)."""

    by_rule: np.ndarray  # so many decisions were the rule's
    decisions: np.ndarray  # of both
    accident: np.ndarray  # did it end in one?


def chosen_by_q(training: Training) -> Episodes:
    """Train one agent of IBRL, and say of each episode how many decisions its choice left to the rule, on average."""
    learner, by_rule = training.learner, []
    choose, judge, so_far = learner.acting_policy, learner.note_episodes, np.zeros(training.envs_per_agent)

    def acting_policy(states: Tensor, rule_actions: Tensor, decided: Tensor) -> Tensor:
        chosen = choose(states, rule_actions, decided)
        so_far[:] += chosen[0].gather(-1, rule_actions[0].unsqueeze(-1)).squeeze(-1).numpy()
        return chosen

    def note(ended: np.ndarray, returns: np.ndarray) -> None:
        by_rule.extend(so_far[ended[0]])
        so_far[ended[0]] = 0
        judge(ended, returns)

    learner.acting_policy, learner.note_episodes = acting_policy, note
    training.run(progress=False)
    return _episodes(training, np.array(by_rule))


def by_twenty(by_q: Episodes) -> tuple[list[str], list[list[str]]]:
    """A table: in which share of the decisions the rule's action was taken, in the episodes twenty by twenty."""
    starts = range(0, len(by_q.decisions), 20)
    shares = [by_q.by_rule[i : i + 20].sum() / by_q.decisions[i : i + 20].sum() for i in starts]
    headings = ["training episodes", *(f"{i + 1} to {min(i + 20, len(by_q.decisions))}" for i in starts)]
    return headings, [["Q takes the rule's action, %", *(f"{100 * share:.0f}" for share in shares)]]


def beside_a_coin(by_q: Episodes, shares: Sequence[float]) -> tuple[list[str], list[list]]:
    """A table of as many drives by the rule, a share of whose actions are drawn at random; above it the agent's."""
    rows, seeds = [["Q, as above", by_q.accident.sum(), f"{np.median(by_q.decisions):.0f}"]], range(len(by_q.decisions))
    for share in shares:
        drives = record(partly_random(rule_policy(DEFAULT), share, np.random.default_rng(0)), seeds)
        lasts = np.median([len(drive.actions) for drive in drives])
        crashed = sum(drive.accident > 0 for drive in drives)
        rows.append([f"a coin: {100 * share:.0f} % of the actions at random", crashed, f"{lasts:.0f}"])
    return ["who decides beside the rule", f"accidents in {len(seeds)}", "half last at most, s"], rows


class Judged(NamedTuple):
    """One judgement of the curriculum of jump-start RL."""

    episode: int  # so many had ended
    mean: float  # the return of the last ones
    limit: float  # what this mean must reach; -inf at first
    shrinks: bool


def handed_over(training: Training) -> tuple[Episodes, np.ndarray, list[Judged]]:
    """Train one agent of jump-start RL: its episodes, the h of each (episodes,), and how h was judged."""
    learner, judge, h, judged = training.learner, training.learner.note_episodes, [], []
    shrinks, shared = learner.shrinks, training.settings[0]

    def note(ended: np.ndarray, returns: np.ndarray) -> None:
        h.extend(learner.guided[0, torch.from_numpy(ended[0])].tolist())
        judge(ended, returns)

    def noted(agent: int) -> bool:
        mean, best, answer = float(learner.returns[agent].mean()), float(learner.best[agent]), shrinks(agent)
        limit = best - shared.tolerance * abs(best) if np.isfinite(best) else best
        judged.append(Judged(len(h), mean, limit, answer))
        return answer

    learner.note_episodes, learner.shrinks = note, noted
    training.run(progress=False)
    h = np.array(h[: training.episodes])
    return _episodes(training, h), h, judged


def _episodes(training: Training, by_rule: np.ndarray) -> Episodes:
    curves, n = training.curves.values, training.episodes
    decisions = curves["decisions"][0][:n]
    return Episodes(np.minimum(by_rule[:n], decisions), decisions, curves["accident"][0][:n] > 0)


def seconds_per_decision(results: Results) -> np.ndarray:
    """Of one core, in the training of each agent up to the first budget: (agents,)."""
    first = equal_decisions.BUDGETS[0]
    return results.measured[f"seconds_{first}"] / first


def in_training(results: Results, spent: float, count: str) -> np.ndarray:
    """The mean return of each agent's last training episodes after so many decisions or seconds, (agents,)."""
    return at_budget(results.curves, spent if count == DECISIONS else spent / seconds_per_decision(results))

"""Measured for the lesson: who finds the way out, who escapes, what the bonus costs, where a margin loss counts."""

from collections.abc import Callable, Sequence
from functools import cache

import numpy as np
import torch
from torch import Tensor

from bootcourse.course.shipped import shipped_agents, shipped_experiment, shipped_results
from bootcourse.episodes.lookahead import imagine
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.learn.agent import Agent
from bootcourse.learn.bootstrap import paper_q_filter, q_filter
from bootcourse.policies import rule_policy
from bootcourse.research.experiments.clocks import choices
from bootcourse.research.results import Results
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import found_after

Kinds = dict[str, tuple[list[Results], list[Results]]]


@cache
def kinds() -> Kinds:
    """{demonstrations: (agents with the soft constraint, without it)}: the study's ten first, then the ten others."""
    study, others = shipped_results(), shipped_experiment("stress")
    free = shipped_experiment("ablations")["c = 0"]
    return {
        "demonstrations, c = 2": (
            [study.of("bootstrapped"), others["bootstrapped"]],
            [study.of("demos"), others["demos"]],
        ),
        "demonstrations, c = 0": ([free.of("bootstrapped"), others["bootstrapped, c = 0"]], [free.of("demos")]),
        "no demonstrations": ([study.of("soft"), others["soft"]], [study.of("sac"), others["sac"]]),
    }


def escape(agents: Sequence[Results]) -> str:
    """How many of these agents escape, "16 of 20"."""
    return f"{sum(each.escapers(each.methods[0]) for each in agents)} of {sum(map(len, agents))}"


def found(agents: Sequence[Results]) -> np.ndarray:
    """The training episodes after which these agents have found the way out, (agents,)."""
    return np.concatenate([found_after(each.curves["success"]) for each in agents])


def paid_and_not() -> tuple[dict[str, Results], dict[str, Results]]:
    """The study's ten agents with both aids, with the bonus and without it, and the ten others of each."""
    study, others = ({name: kinds()[f"demonstrations, {name}"][0][k] for name in ("c = 2", "c = 0")} for k in (0, 1))
    return study, others


ESCAPE = ["agents that escape (study + others)", "with the soft constraint", "without it"]


def escaped() -> list[list[str]]:
    """A row for each kind of demonstrations, below `ESCAPE`: "16 of 20 (7 + 9)"; last the stochastic rule's."""
    by_chance = choices(shipped_experiment("clocks"))["1/4", "π̃"]
    rows = kinds() | {
        "the stochastic rule's demonstrations, c = 2": ([by_chance.of("bootstrapped")], [by_chance.of("demos")])
    }
    return [[name, _all_and_parts(soft), _all_and_parts(free)] for name, (soft, free) in rows.items()]


def _all_and_parts(agents: Sequence[Results]) -> str:
    """How many of these agents escape, and how many in each part."""
    parts = " + ".join(f"{each.escapers(each.methods[0])}" for each in agents)
    return f"**{escape(agents)}** ({parts})" if len(agents) > 1 else f"**{escape(agents)}**"


COST = ["ten agents with", "return, episodes 300 to 500", "success, 300 to 600", "success of the ten others"]


def cost() -> list[list[str]]:
    """What the bonus costs and keeps, below `COST`: means of the study's ten agents, and of the ten others."""
    rows = []
    for name, *tens in zip(("c = 2", "c = 0"), *(group.values() for group in paid_and_not()), strict=True):
        earned = f"{tens[0].curves['return'][:, 300:500].mean():.0f}"
        rows.append([name, earned, *(f"{100 * ten.curves['success'][:, 300:600].mean():.0f} %" for ten in tens)])
    return rows


def _leads(agent: Agent, drive: Rollout, seconds: int) -> tuple[Tensor, Tensor, Tensor]:
    """An agent's Q in a drive's first seconds, the demonstrated actions, and by how much these lead the others."""
    q = torch.from_numpy(agent.q_values(drive.observations[:seconds]))
    did = torch.from_numpy(drive.rule_actions[:seconds]).long()
    rivals = q.scatter(-1, did[:, None], -np.inf).amax(-1)
    return q, did, q.gather(-1, did[:, None])[:, 0] - rivals


SECONDS = 20  # of the drive in which a margin loss is counted
ON = 40  # seconds that an agent drives on from each of them
PUSHED = ["the demonstrated action", "seconds (five agents)", "the one ahead earns more"]
PUSHED += [f"the loss counts, {name}" for name in ("no filter", "the paper's filter", "the usual filter")]


@cache
def agents() -> list[Agent]:
    """The study's first five agents with demonstrations, the bonus and the soft constraint."""
    return shipped_agents("bootstrapped")


@cache
def demonstrated() -> Rollout:
    """The rule's drive on road 10."""
    return record(rule_policy(DEFAULT), [10], label="rule")[0]


@cache
def earns_more() -> Tensor:
    """Whether the action with the largest Q earns more than the demonstrated one, from each agent's and second's state.

    Each agent drives on by its own policy after it; the rewards are discounted, and those after `ON` s left out.
    """
    cars, found = demonstrated().cars[:SECONDS], []
    for agent in agents():
        largest = agent.q_values(demonstrated().observations[:SECONDS]).argmax(1)
        both = np.stack([largest, demonstrated().rule_actions[:SECONDS]], axis=1)
        gamma = agent.settings.gamma
        worth = imagine(cars, both, agent.as_policy(), ON, DEFAULT, gamma=gamma, with_worth=False).values
        found.append(worth[:, 0] > worth[:, 1] + 1e-9)
    return torch.from_numpy(np.concatenate(found))


def pushed(loss: Callable[[Tensor, Tensor], Tensor]) -> list[list[str]]:
    """In how many of a drive's first seconds a margin loss pushes, with each filter, by each of the five agents' Q.

    loss: of (q, demonstrated actions), with a margin of 1. Rows below `PUSHED`; see `earns_more`, too.
    """
    observations = demonstrated().observations[:SECONDS]
    of_each = [_leads(agent, demonstrated(), SECONDS) for agent in agents()]
    q, did, lead = map(torch.cat, zip(*of_each, strict=True))
    pi = np.concatenate([agent.probabilities(observations) for agent in agents()])
    log_pi = torch.from_numpy(pi).clamp(min=1e-30).log()
    kinds = {"is behind": lead < 0, "leads by less than 1": (lead >= 0) & (lead < 1), "leads by 1 or more": lead >= 1}
    pushes = loss(q, did) > 0
    filtered = (pushes & (each > 0) for each in (paper_q_filter(q, did), q_filter(q, did, log_pi)))
    columns = [torch.ones(len(q)) > 0, earns_more(), pushes, *filtered]
    return [[name, *(f"{int((of & each).sum())}" for each in columns)] for name, of in kinds.items()]

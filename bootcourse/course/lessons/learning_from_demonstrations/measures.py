"""Measured for the lesson: who finds the way out, who escapes, and in which states a margin loss counts."""

from collections.abc import Callable, Sequence
from functools import cache

import numpy as np
import torch
from torch import Tensor

from bootcourse.course.shipped import shipped_experiment, shipped_results
from bootcourse.episodes.rollout import Rollout
from bootcourse.learn.agent import Agent
from bootcourse.learn.bootstrap import paper_q_filter
from bootcourse.research.results import Results
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
    """A row for each kind of demonstrations, below `ESCAPE`: "16 of 20 (7 + 9)"."""
    return [[name, _all_and_parts(soft), _all_and_parts(free)] for name, (soft, free) in kinds().items()]


def _all_and_parts(agents: Sequence[Results]) -> str:
    """How many of these agents escape, and how many in each part."""
    parts = " + ".join(f"{each.escapers(each.methods[0])}" for each in agents)
    return f"**{escape(agents)}** ({parts})" if len(agents) > 1 else f"**{escape(agents)}**"


PUSHED = ["the demonstrated action", "states", "the filtered loss pushes in"]


def pushed(loss: Callable[[Tensor, Tensor], Tensor], agent: Agent, drive: Rollout, seconds: int) -> list[list[str]]:
    """In how many states of a drive's first seconds a margin loss with the paper's filter pushes.

    loss: of (q, demonstrated actions), with a margin of 1. Rows below `PUSHED`, by an agent's own Q.
    """
    q = torch.from_numpy(agent.q_values(drive.observations[:seconds]))
    did = torch.from_numpy(drive.rule_actions[:seconds]).long()
    rivals = q.scatter(-1, did[:, None], -np.inf).amax(-1)
    lead, pushes = q.gather(-1, did[:, None])[:, 0] - rivals, loss(q, did) > 0
    kinds = {"is behind": lead < 0, "leads by less than 1": (lead >= 0) & (lead < 1), "leads by 1 or more": lead >= 1}
    columns = torch.ones(len(q)) > 0, pushes & (paper_q_filter(q, did) > 0)
    return [[name, *(f"{int((of & each).sum())}" for each in columns)] for name, of in kinds.items()]

"""Numbers that the lesson on the soft constraint shows: three agents' KL, and drives by a finished Q and the rule."""

from collections.abc import Callable, Sequence

import numpy as np
import torch
from torch import Tensor

from bootcourse.course.shipped import shipped_agents
from bootcourse.episodes.evaluate import drive_episodes
from bootcourse.learn.bootstrap import kl_to_rule, log_stochastic_rule
from bootcourse.policies import PolicyOutput
from bootcourse.rule import rule
from bootcourse.scenario import ACTION_NAMES, DEFAULT, N_ACTIONS, RULE_P

ALPHA = 0.01  # of the opening panel; the most probable action is the same with any other
ROADS = range(30)


def three_agents() -> list[list[str]]:
    """A row for each of three policies: its words, and its KL (nats) where the rule says "keep left" with p = 0.9."""
    rule_says, p = torch.tensor([ACTION_NAMES.index("keep left")]), torch.tensor(0.9)
    rows = []
    for action in ("keep left", "accelerate straight"):
        sure = torch.full((1, N_ACTIONS), 1e-12)
        sure[0, ACTION_NAMES.index(action)] = 1.0
        rows.append([action, f"{kl_to_rule(sure.log(), rule_says, p).item():.3f}"])
    even = torch.full((1, N_ACTIONS), 1 / N_ACTIONS)
    return [*rows, ["no action: all nine even", f"{kl_to_rule(even.log(), rule_says, p).item():.3f}"]]


def mixed(best: Callable[..., Tensor], strengths: Sequence[float]) -> tuple[np.ndarray, np.ndarray]:
    """Drives by the best compromise of the rule and each shipped agent's Q, then by the agent's own policy.

    best: (q, log_rule, alpha, xi) to the best policy. Returns the mean returns and the shares of accidents,
    (strengths + 1, agents) each: a row for each ξ, the last for the agents themselves. All drive on `ROADS`, at once.
    """
    agents = shipped_agents("soft")
    kinds, each = len(strengths) + 1, len(ROADS)

    def drive(observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
        seen = observations.reshape(len(agents), kinds, each, -1)
        by_rule = torch.from_numpy(np.asarray(rule(cars, DEFAULT).actions)).reshape(len(agents), kinds, each)
        log_rules = log_stochastic_rule(by_rule, torch.tensor(RULE_P, dtype=torch.float64))
        actions = np.empty((len(agents), kinds, each), dtype=np.int64)
        for agent, sees, log_rule, acts in zip(agents, seen, log_rules, actions, strict=True):
            q = torch.from_numpy(np.asarray(agent.q_values(sees[:-1].reshape((kinds - 1) * each, -1)), np.float64))
            for row, (xi, values) in enumerate(zip(strengths, q.split(each), strict=True)):
                acts[row] = best(values, log_rule[row], ALPHA, xi).argmax(-1).numpy()
            acts[-1] = agent.as_policy()(sees[-1], None).actions
        return PolicyOutput(actions.ravel())

    driven = drive_episodes(drive, [*ROADS] * (len(agents) * kinds), together=10**6)
    shape = len(agents), kinds, each
    return driven.returns.reshape(shape).mean(-1).T, (driven.accident != 0).reshape(shape).mean(-1).T

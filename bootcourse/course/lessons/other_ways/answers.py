"""Answers to the exercises of the lesson on other ways to use a teacher."""

import torch

from tests.answers import right, right_lines, wrong_lines

right_lines("""better_of_two
    with nine actions: stays = pi * (q > q.gather(1, rule_actions[:, None]))
        stays + (1 - stays.sum(1, keepdim=True)) * functional.one_hot(rule_actions, 9)
    where each drawn action goes: mu = rule_actions[:, None]
        goes = torch.where(q > q.gather(1, mu), torch.arange(9), mu)
        torch.zeros(len(pi), 9).scatter_add(1, goes, pi)
""")

right_lines("""guide_shrinks
    step by step: last = returns[-window:]; bool(len(last) == window and sum(last) / window + tolerance * abs(best) >= best)
    never worse than the best: mean = np.mean(returns[-window:] or [0.0]); top = max(mean, best); bool(len(returns) >= window and mean >= top - tolerance * abs(top))
""")  # noqa: E501

wrong_lines("""better_of_two
    the soft choice: w = torch.sigmoid(q - q.gather(-1, rule_actions[:, None])); t = pi * w; t.scatter_add(-1, rule_actions[:, None], (pi - t).sum(-1, keepdim=True))
    the rule's probability replaced: t = pi * (q > q.gather(-1, rule_actions[:, None])); t.scatter(-1, rule_actions[:, None], pi.gather(-1, rule_actions[:, None]))
""")  # noqa: E501

wrong_lines("""guide_shrinks
    a median: bool(len(returns) >= window and np.median(returns[-window:]) >= best - tolerance * abs(best))
    the mean's share: m = np.mean(returns[-window:] or [0.0]); bool(len(returns) >= window and m >= best - tolerance * abs(m))
""")  # noqa: E501


@right("better_of_two")
def action_by_action(pi, q, rule_actions):
    found = torch.zeros_like(pi)
    for i in range(len(pi)):
        rule = int(rule_actions[i])
        for a in range(pi.shape[1]):
            found[i, a if q[i, a] > q[i, rule] else rule] += pi[i, a]
    return found


wrong_lines("""better_of_two
    ties stay: q_rule = q.gather(-1, rule_actions[:, None]); own = functional.one_hot(rule_actions, q.shape[-1])
        stays = pi * (q >= q_rule) * (1 - own)
        stays + own * (1 - stays.sum(-1, keepdim=True))  # They are not better
    nearly as good: q_rule = q.gather(-1, rule_actions[:, None]); own = functional.one_hot(rule_actions, q.shape[-1])
        stays = pi * (q > q_rule + 9e-4)
        stays + own * (1 - stays.sum(-1, keepdim=True))
    all but equal: q_rule = q.gather(-1, rule_actions[:, None]); own = functional.one_hot(rule_actions, q.shape[-1])
        stays = pi * ((q > q_rule) & ~torch.isclose(q, q_rule))
        stays + own * (1 - stays.sum(-1, keepdim=True))
""")

wrong_lines("""guide_shrinks
    the last three: len(returns) >= window and np.mean(returns[-min(window, 3):]) >= best - tolerance * abs(best)
    with some slack: len(returns) >= window and np.mean(returns[-window:]) >= best - tolerance * abs(best) - 9e-4
    with a bar: len(returns) >= window and np.mean(returns[-window:]) >= best - tolerance * abs(best) + 9e-4
""")

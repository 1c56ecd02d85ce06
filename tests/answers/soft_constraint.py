"""Answers to the exercises of the lesson on the soft constraint."""

import torch

from tests.answers import equivalent, right, right_lines, wrong_lines

SAME = "its slope in log π is the same for all actions, so no logit feels it"
equivalent("soft_constraint", "log_pi - log_rule  ->  log_pi.detach() - log_rule", SAME)
FULL = "math.log((1 - p) / 8))"
equivalent(
    "soft_constraint", f"torch.full_like(log_pi, {FULL}  ->  torch.full_like(log_pi.detach(), {FULL}", "only its shape"
)
equivalent("constrained_loss", "alpha * log_pi  ->  alpha * log_pi.detach()", SAME)


def pi_tilde(rule_action, p, others=None):
    """(batch, 9)"""
    probabilities = torch.full((len(rule_action), 9), (1 - p) / 8 if others is None else others).double()
    probabilities[torch.arange(len(rule_action)), rule_action] = p
    return probabilities


right_lines("""soft_constraint
    torch's own: rule = pi_tilde(rule_action, p).log()
        torch.nn.functional.kl_div(rule, log_pi, reduction="none", log_target=True).sum(-1)
""")


@right("soft_constraint")
def with_probabilities(log_pi, rule_action, p):
    pi = log_pi.exp()
    return (pi * torch.log(pi / pi_tilde(rule_action, p))).sum(dim=1)


wrong_lines("""soft_constraint
    torch's own turned: rule = pi_tilde(rule_action, p)
        torch.nn.functional.kl_div(log_pi, rule, reduction="none").sum(-1)  # the other way round
    cross entropy: -(log_pi.exp() * pi_tilde(rule_action, p).log()).sum(-1)  # cross-entropy
    not summed: log_pi.exp() * (log_pi - pi_tilde(rule_action, p).log())  # shape
    a sample for the sum: drawn = torch.multinomial(log_pi.exp(), 1)
        (log_pi - pi_tilde(rule_action, p).log()).gather(1, drawn)[:, 0]
""")

right_lines("""log_stochastic_rule
    with where: is_rule = torch.arange(9) == rule_action[:, None]
        torch.where(is_rule, math.log(p), math.log((1 - p) / 8))
    row by row: rows = []
        for action in rule_action.tolist():
            rows.append([math.log(p) if a == action else math.log((1 - p) / 8) for a in range(9)])
        torch.tensor(rows)
""")

wrong_lines("""log_stochastic_rule
    transposed: solution(rule_action, p).T  # shape
""")

right_lines("""regularised_policy
    as powers:
        weights = torch.exp((q - q.amax(-1, keepdim=True)) / (alpha + xi)) * log_rule.exp() ** (xi / (alpha + xi))
        weights / weights.sum(-1, keepdim=True)
    with softmax: torch.softmax(q / (alpha + xi) + log_rule * xi / (alpha + xi), dim=1)
""")

wrong_lines("""regularised_policy
    a mixture: (alpha * torch.softmax(q / alpha, -1) + xi * log_rule.exp()) / (alpha + xi)
""")

right_lines("""constrained_loss
    three means: pi = log_pi.exp()
        expected = (pi * q.detach()).sum(-1).mean()
        entropy = -(pi * log_pi).sum(-1).mean()
        -(expected + alpha * entropy - xi * kl.mean())
    as a cost: cost = (torch.exp(log_pi) * (alpha * log_pi - q.clone().detach())).sum(dim=1); torch.mean(cost + xi * kl)
""")

wrong_lines("""constrained_loss
    policy detached: solution(log_pi.detach(), q, alpha, xi, kl)
    one for each state: -((log_pi.exp() * (q.detach() - alpha * log_pi)).sum(-1) - xi * kl)  # shape
""")

right_lines("""constrained_target
    one row after the other: rows = []
        for i in range(len(reward)):
            q, log_pi = next_q_pair[:, i].min(dim=0).values, next_log_pi[i]
            value = sum(log_pi[a].exp() * (q[a] - alpha * log_pi[a]) for a in range(len(q))) - xi * next_kl[i]
            rows.append(reward[i] + (0 if terminated[i] else gamma * value))
        torch.stack(rows)
""")

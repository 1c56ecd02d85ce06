"""Answers to the exercises of the lesson on the soft constraint."""

import torch

from tests.answers import equivalent, right, right_lines, wrong, wrong_lines

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
    the library's: kl_to_rule(log_pi, rule_action, torch.tensor(p))
    torch's own: rule = pi_tilde(rule_action, p).log()
        torch.nn.functional.kl_div(rule, log_pi, reduction="none", log_target=True).sum(-1)
    minus entropy minus cross: pi = log_pi.exp()
        of_rule = pi.gather(1, rule_action[:, None])[:, 0]
        cross = of_rule * math.log(p) + (1 - of_rule) * math.log((1 - p) / 8)
        (pi * log_pi).sum(-1) - cross
""")


@right("soft_constraint")
def with_probabilities(log_pi, rule_action, p):
    pi = log_pi.exp()
    return (pi * torch.log(pi / pi_tilde(rule_action, p))).sum(dim=1)


@wrong("soft_constraint", "no gradient")
def a_measurement(log_pi, rule_action, p):
    with torch.no_grad():
        return with_probabilities(log_pi, rule_action, p)


wrong_lines("""soft_constraint
    reverse: rule = pi_tilde(rule_action, p); (rule * (rule.log() - log_pi)).sum(-1)  # the other way round
    torch's own turned: rule = pi_tilde(rule_action, p)
        torch.nn.functional.kl_div(log_pi, rule, reduction="none").sum(-1)  # the other way round
    cross entropy: -(log_pi.exp() * pi_tilde(rule_action, p).log()).sum(-1)  # cross-entropy
    unweighted: (log_pi - pi_tilde(rule_action, p).log()).sum(-1)  # without weighing
    others get it each: (log_pi.exp() * (log_pi - pi_tilde(rule_action, p, 1 - p).log())).sum(-1)  # *share*
    shared by nine: (log_pi.exp() * (log_pi - pi_tilde(rule_action, p, (1 - p) / 9).log())).sum(-1)  # eight are left
    negative: (log_pi.exp() * (pi_tilde(rule_action, p).log() - log_pi)).sum(-1)  # never negative
    in bits: pi = log_pi.exp(); (pi * torch.log2(pi / pi_tilde(rule_action, p))).sum(-1)  # bits
    averaged: with_probabilities(log_pi, rule_action, p).mean()  # mean over the batch
    mean over actions: (log_pi.exp() * (log_pi - pi_tilde(rule_action, p).log())).mean(-1)
    not summed: log_pi.exp() * (log_pi - pi_tilde(rule_action, p).log())  # shape
    over the wrong axis: (log_pi.exp() * (log_pi - pi_tilde(rule_action, p).log())).sum(0)  # shape
    of the rule's action only: log_pi.gather(1, rule_action[:, None])[:, 0] - math.log(p)
    log pi for pi: (log_pi * (log_pi - pi_tilde(rule_action, p).log())).sum(-1)
    a sample for the sum: drawn = torch.multinomial(log_pi.exp(), 1)
        (log_pi - pi_tilde(rule_action, p).log()).gather(1, drawn)[:, 0]
    the same rule for all: with_probabilities(log_pi, rule_action[:1].expand(len(rule_action)), p)
""")

right_lines("""log_stochastic_rule
    with where: is_rule = torch.arange(9) == rule_action[:, None]
        torch.where(is_rule, math.log(p), math.log((1 - p) / 8))
    one hot: mine = torch.nn.functional.one_hot(rule_action, 9).double(); torch.log(mine * p + (1 - mine) * (1 - p) / 8)
    row by row: rows = []
        for action in rule_action.tolist():
            rows.append([math.log(p) if a == action else math.log((1 - p) / 8) for a in range(9)])
        torch.tensor(rows)
""")

wrong_lines("""log_stochastic_rule
    not logarithms: pi_tilde(rule_action, p)  # probabilities themselves
    each gets the rest: pi_tilde(rule_action, p, 1 - p).log()  # *share*
    nine get the rest: pi_tilde(rule_action, p, (1 - p) / 9).log()  # eight are left
    to base ten: torch.log10(pi_tilde(rule_action, p))  # base 10
    prices: -pi_tilde(rule_action, p).log()  # prices
    columns for rows: log_rule = torch.full((len(rule_action), 9), math.log((1 - p) / 8))
        log_rule[:, rule_action] = math.log(p)
        log_rule  # Pair each row
    transposed: solution(rule_action, p).T  # shape
""")

right_lines("""regularised_policy
    as powers:
        weights = torch.exp((q - q.amax(-1, keepdim=True)) / (alpha + xi)) * log_rule.exp() ** (xi / (alpha + xi))
        weights / weights.sum(-1, keepdim=True)
    with softmax: torch.softmax(q / (alpha + xi) + log_rule * xi / (alpha + xi), dim=1)
""")

wrong_lines("""regularised_policy
    without the rule: torch.softmax(q / alpha, -1)
    a mixture: (alpha * torch.softmax(q / alpha, -1) + xi * log_rule.exp()) / (alpha + xi)
""")

right_lines("""constrained_loss
    three means: pi = log_pi.exp()
        expected = (pi * q.detach()).sum(-1).mean()
        entropy = -(pi * log_pi).sum(-1).mean()
        -(expected + alpha * entropy - xi * kl.mean())
    as a cost: cost = (torch.exp(log_pi) * (alpha * log_pi - q.clone().detach())).sum(dim=1); torch.mean(cost + xi * kl)
    softmax again: pi = log_pi.softmax(-1)
        -((pi * (q.detach() - alpha * log_pi.log_softmax(-1))).sum(-1) - xi * kl).mean()
""")

wrong_lines("""constrained_loss
    all detached: solution(log_pi, q, alpha, xi, kl).detach()
    policy detached: solution(log_pi.detach(), q, alpha, xi, kl)
    one for each state: -((log_pi.exp() * (q.detach() - alpha * log_pi)).sum(-1) - xi * kl)  # shape
""")

right_lines("""constrained_target
    with the smaller of two: pi, q = next_log_pi.exp(), torch.minimum(next_q_pair[0], next_q_pair[1])
        entropy = torch.special.entr(pi).sum(-1)
        value = (pi * q).sum(-1) + alpha * entropy - xi * next_kl
        torch.where(terminated > 0, reward, reward + gamma * value)
    one row after the other: rows = []
        for i in range(len(reward)):
            q, log_pi = next_q_pair[:, i].min(dim=0).values, next_log_pi[i]
            value = sum(log_pi[a].exp() * (q[a] - alpha * log_pi[a]) for a in range(len(q))) - xi * next_kl[i]
            rows.append(reward[i] + (0 if terminated[i] else gamma * value))
        torch.stack(rows)
    action by action: value = -xi * next_kl
        for a in range(9):
            q = torch.minimum(next_q_pair[0, :, a], next_q_pair[1, :, a])
            value = value + next_log_pi[:, a].exp() * (q - alpha * next_log_pi[:, a])
        reward + gamma * (1 - terminated) * value
""")


@wrong("constrained_target")
def value_first_and_then_the_minimum(reward, terminated, next_log_pi, next_q_pair, next_kl, alpha, xi, gamma):
    values = (next_log_pi.exp() * (next_q_pair - alpha * next_log_pi)).sum(-1)  # two values: their smaller one
    return reward + gamma * (1 - terminated) * (values.min(0).values - xi * next_kl)


wrong_lines("""constrained_target
    masked reward: value = (next_log_pi.exp() * (next_q_pair.amin(0) - alpha * next_log_pi)).sum(-1) - xi * next_kl
        (1 - terminated) * (reward + gamma * value)
    discount of the course:
        value = (next_log_pi.exp() * (next_q_pair.amin(0) - alpha * next_log_pi)).sum(-1) - xi * next_kl
        reward + 0.8 * (1 - terminated) * value
    xi of the course:
        value = (next_log_pi.exp() * (next_q_pair.amin(0) - alpha * next_log_pi)).sum(-1) - 200 * alpha * next_kl
        reward + gamma * (1 - terminated) * value  # differ
    a penalty on the reward: value = (next_log_pi.exp() * (next_q_pair.amin(0) - alpha * next_log_pi)).sum(-1)
        reward - xi * next_kl + gamma * (1 - terminated) * value  # outside the value
""")

wrong_lines("""constrained_target
    with a discount and no end: value = bc.sac.soft_value(next_log_pi, next_q_pair.amin(0), torch.tensor(alpha))
        reward + gamma * ((1 - terminated) * value - xi * next_kl)  # after an accident, too
""")

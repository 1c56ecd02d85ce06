"""Answers to the exercises of the lesson on the soft constraint."""

import torch

from tests.answers import equivalent, right_lines, wrong, wrong_lines

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
    two distributions: rule = torch.distributions.Categorical(probs=pi_tilde(rule_action, p).float())
        torch.distributions.kl_divergence(torch.distributions.Categorical(logits=log_pi), rule)
    price minus entropy: pi, price = log_pi.exp(), -pi_tilde(rule_action, p).log()
        (pi * price).sum(-1) + (pi * log_pi).sum(-1)
    own action and others: pi = log_pi.exp(); own = pi.gather(1, rule_action[:, None])[:, 0]
        (pi * log_pi).sum(-1) - own * math.log(p) - (1 - own) * math.log((1 - p) / 8)
    torch's own: rule = pi_tilde(rule_action, p).log()
        torch.nn.functional.kl_div(rule, log_pi, reduction="none", log_target=True).sum(-1)
""")


@wrong("soft_constraint", "exp(-120) is 0 in float32")
def with_probabilities(log_pi, rule_action, p):
    pi = log_pi.exp()
    return (pi * torch.log(pi / pi_tilde(rule_action, p))).sum(dim=1)


wrong_lines("""soft_constraint
    torch's own turned: rule = pi_tilde(rule_action, p)
        torch.nn.functional.kl_div(log_pi, rule, reduction="none").sum(-1)  # the other way round
    cross entropy: -(log_pi.exp() * pi_tilde(rule_action, p).log()).sum(-1)  # cross-entropy
    five nats at most: solution(log_pi, rule_action, p).clamp(max=5)
    ten nats at most: solution(log_pi, rule_action, p).clamp(max=10)
    a number in both logarithms: pi = log_pi.exp()
        (pi * torch.log((pi + 1e-6) / (pi_tilde(rule_action, p).float() + 1e-6))).sum(-1)
    not summed: log_pi.exp() * (log_pi - pi_tilde(rule_action, p).log())  # shape
    a sample for the sum: drawn = torch.multinomial(log_pi.exp(), 1)
        (log_pi - pi_tilde(rule_action, p).log()).gather(1, drawn)[:, 0]
""")

right_lines("""regularised_policy
    as powers:
        weights = torch.exp((q - q.amax(-1, keepdim=True)) / (alpha + xi)) * log_rule.exp() ** (xi / (alpha + xi))
        weights / weights.sum(-1, keepdim=True)
    a distribution: torch.distributions.Categorical(logits=(q + xi * log_rule) / (alpha + xi)).probs
    with softmax: torch.softmax(q / (alpha + xi) + log_rule * xi / (alpha + xi), dim=1)
""")

wrong_lines("""regularised_policy
    softmax by hand: weights = torch.exp((q + xi * log_rule) / (alpha + xi))
        weights / weights.sum(-1, keepdim=True)  # Use `softmax(-1)`
    the mean subtracted: z = (q + xi * log_rule) / (alpha + xi)
        weights = (z - z.mean(-1, keepdim=True)).exp(); weights / weights.sum(-1, keepdim=True)
    q at most 20: solution(q.clamp(-20, 20), log_rule, alpha, xi)
    never colder than 0.01: ((q + xi * log_rule) / max(alpha + xi, 0.01)).softmax(-1)
    five nats at most: solution(q, log_rule.clamp(min=-5), alpha, xi)
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
    the logarithm of pi: pi = log_pi.exp()
        -((pi * (q.detach() - alpha * pi.log())).sum(-1) - xi * kl).mean()  # Use `log_pi` itself
    five nats at most: solution(log_pi, q, alpha, xi, kl.clamp(max=5))
    q at most 20: solution(log_pi, q.clamp(-20, 20), alpha, xi, kl)
    xi at least 0.01: solution(log_pi, q, alpha, max(xi, 0.01), kl)
    xi from alpha: solution(log_pi, q, alpha, 200 * alpha, kl)
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
    a distribution: policy, q = torch.distributions.Categorical(logits=next_log_pi), torch.minimum(*next_q_pair)
        value = (policy.probs * q).sum(-1) + alpha * policy.entropy() - xi * next_kl
        torch.where(terminated == 1, reward, reward + gamma * value)
""")

wrong_lines("""constrained_target
    the logarithm of pi: pi = next_log_pi.exp()
        value = (pi * (next_q_pair.amin(0) - alpha * pi.log())).sum(-1) - xi * next_kl
        reward + gamma * (1 - terminated) * value  # Use `next_log_pi` itself
    at most 20: solution(reward, terminated, next_log_pi, next_q_pair, next_kl, alpha, xi, gamma).clamp(-20, 20)
    five nats at most: solution(reward, terminated, next_log_pi, next_q_pair, next_kl.clamp(max=5), alpha, xi, gamma)
    xi at most 2: solution(reward, terminated, next_log_pi, next_q_pair, next_kl, alpha, min(xi, 2.0), gamma)
    alpha at least 0.01: solution(reward, terminated, next_log_pi, next_q_pair, next_kl, max(alpha, 0.01), xi, gamma)
    a bonus for what is not negative: more = reward + (reward >= 0)
        solution(more, terminated, next_log_pi, next_q_pair, next_kl, alpha, xi, gamma)
    one end ends all: ended = terminated.max().expand(len(reward))
        solution(reward, ended, next_log_pi, next_q_pair, next_kl, alpha, xi, gamma)
""")

"""Answers to the exercises of the lesson on imitation."""

from tests.answers import equivalent, right, right_lines, wrong_lines

right_lines("""discriminator_loss
    as two classes: ones, zeros = torch.ones_like(rule_logits), torch.zeros_like(own_logits)
        of_the_rule = functional.binary_cross_entropy_with_logits(rule_logits, ones)
        of_the_rule + functional.binary_cross_entropy_with_logits(own_logits, zeros)
    by logsigmoid: -functional.logsigmoid(rule_logits).mean() - functional.logsigmoid(-own_logits).mean()
    by logaddexp: terms = (torch.logaddexp(x, torch.zeros_like(x)).mean() for x in (-rule_logits, own_logits))
        sum(terms)
""")

wrong_lines("""discriminator_loss
    of all logits together: functional.softplus(torch.cat([-rule_logits, own_logits])).mean()
    loop with the wrong sign: right = sum(functional.logsigmoid(x) for x in rule_logits) / len(rule_logits)
        right + sum(functional.logsigmoid(-x) for x in own_logits) / len(own_logits)  # take each for the other
    half of it: (functional.softplus(-rule_logits).mean() + functional.softplus(own_logits).mean()) / 2
    with the same sign: functional.softplus(rule_logits).mean() + functional.softplus(own_logits).mean()
    safe by clamping: d = torch.sigmoid(rule_logits), torch.sigmoid(own_logits)
        -d[0].clamp(min=1e-6).log().mean() - (1 - d[1]).clamp(min=1e-6).log().mean()
    as a number: float(solution(rule_logits, own_logits))  # no gradient
    large ones by where: a, b = (torch.where(x > 50, x, (1 + x.exp()).log()) for x in (-rule_logits, own_logits))
        a.mean() + b.mean()  # not a number
""")

right_lines("""imitation_reward
    log of a sum: torch.logaddexp(own_logits, torch.zeros_like(own_logits))
    by symmetry: -functional.logsigmoid(-own_logits)
    large and small apart: own_logits.clamp(min=0) + torch.log1p(torch.exp(-own_logits.abs()))
""")

wrong_lines("""imitation_reward
    clipped: -torch.log((1 - torch.sigmoid(own_logits)).clamp(min=1e-6))
    cut at zero: torch.relu(own_logits)
    with numpy: np.logaddexp(0, own_logits.numpy())  # training needs one
    one for the batch: functional.softplus(own_logits).mean()  # shape
    in bits: functional.softplus(own_logits) / math.log(2)
    shifted to zero where it cannot tell: functional.softplus(own_logits) - math.log(2)
""")


equivalent("deviation_of_a_rate", "[100.0, 0.0]  ->  [-100.0, 0.0]", "-100 lies as far from 0 as 100 does")


right_lines("""deviation_of_a_rate
    by formula: p = k / n; 100 * math.sqrt(p * (1 - p) * n / (n - 1))
    of a list: statistics.stdev([100.0] * k + [0.0] * (n - k))
    by the sum of squares: mean = 100 * k / n; np.sqrt((k * (100 - mean) ** 2 + (n - k) * mean**2) / (n - 1))
""")

wrong_lines("""deviation_of_a_rate
    half of an interval: 1.96 * 100 * math.sqrt(k / n * (1 - k / n) / n)
    right for one of n: 100 / math.sqrt(n)
    of twenty: solution(k, 20) if k <= 20 else 0.0
    mean distance from the mean: np.abs(np.repeat([100.0, 0.0], [k, n - k]) - 100 * k / n).mean()
    of k numbers: statistics.stdev([100.0] * k)  # raises an error
    with the mean: 100 * k / n, solution(k, n)  # 2 values
""")


@right("episodes_needed")
def by_trying(rate):
    n = 1
    while (1 - rate) ** n > 0.05:
        n += 1
    return n


right_lines("""episodes_needed
    with another base: int(np.ceil(np.log10(0.05) / np.log10(1 - rate)))
""")

wrong_lines("""episodes_needed
    both sides: math.ceil(math.log(0.025) / math.log(1 - rate))
    added up: math.ceil(0.95 / rate)
    to the nearest: round(math.log(0.05) / math.log(1 - rate))
    one more: by_trying(rate) + 1
    for 99 percent: math.ceil(math.log(0.01) / math.log(1 - rate))
    as an array: np.array([by_trying(rate)])  # returns
    of the other share: n = 1
        while (1 - rate) ** n > 0.95:
            n += 1
        n  # one of 95 %
""")

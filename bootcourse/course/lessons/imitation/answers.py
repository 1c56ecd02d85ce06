"""Answers to the exercises of the lesson on imitation."""

from tests.answers import right_lines, wrong_lines

right_lines("""discriminator_loss
    as two classes: ones, zeros = torch.ones_like(rule_logits), torch.zeros_like(own_logits)
        of_the_rule = functional.binary_cross_entropy_with_logits(rule_logits, ones)
        of_the_rule + functional.binary_cross_entropy_with_logits(own_logits, zeros)
    by logsigmoid: -functional.logsigmoid(rule_logits).mean() - functional.logsigmoid(-own_logits).mean()
""")

wrong_lines("""discriminator_loss
    of all logits together: functional.softplus(torch.cat([-rule_logits, own_logits])).mean()
    safe by clamping: d = torch.sigmoid(rule_logits), torch.sigmoid(own_logits)
        -d[0].clamp(min=1e-6).log().mean() - (1 - d[1]).clamp(min=1e-6).log().mean()
    as a number: float(solution(rule_logits, own_logits))  # no gradient
    large ones by where: a, b = (torch.where(x > 50, x, (1 + x.exp()).log()) for x in (-rule_logits, own_logits))
        a.mean() + b.mean()  # not a number
""")

right_lines("""imitation_reward
    log of a sum: torch.logaddexp(own_logits, torch.zeros_like(own_logits))
    by symmetry: -functional.logsigmoid(-own_logits)
""")

wrong_lines("""imitation_reward
    cut at zero: torch.relu(own_logits)
    with numpy: np.logaddexp(0, own_logits.numpy())  # training needs one
    one for the batch: functional.softplus(own_logits).mean()  # shape
""")

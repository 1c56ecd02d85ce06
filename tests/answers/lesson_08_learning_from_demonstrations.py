"""Answers to the exercises of the lesson on learning from demonstrations."""

import numpy as np
import torch

from bootcourse.learn.replay_buffer import REWARD
from tests.answers import equivalent, right, wrong

PLACES = "rng.integers(len(demonstrations), size=n)"
TORCH_PLACES = f"demonstrations[torch.from_numpy({PLACES})]"
equivalent("mixed_batch", f"{TORCH_PLACES}  ->  demonstrations[{PLACES}]", "either library's numbers index a tensor")
ACTIONS = "torch.arange(q.shape[-1], device=q.device)"
equivalent("large_margin_loss", "q.shape[-1]  ->  q.detach().shape[-1]", "only its shape")
equivalent("large_margin_loss", f"{ACTIONS}  ->  {ACTIONS.replace('q.device', 'q.detach().device')}", "only its device")

# mixed_batch ----------------------------------------------------------------------------------------


@right("mixed_batch")
def with_choice(own, demonstrations, size, beta, bonus, rng):
    n = int(round(beta * size))
    theirs = demonstrations[rng.choice(len(demonstrations), n)].clone()
    theirs[:, REWARD] = theirs[:, REWARD] + bonus
    marks = torch.cat([torch.ones(n), torch.zeros(size - n)])
    return torch.cat([theirs, own.sample(size - n, rng)]), marks


@right("mixed_batch")
def own_rows_first(own, demonstrations, size, beta, bonus, rng):
    marks = torch.zeros(size)
    rows = own.sample(size, rng).clone()
    for i in range(size - round(beta * size), size):
        rows[i] = demonstrations[int(rng.integers(len(demonstrations)))]
        rows[i, REWARD] += bonus
        marks[i] = 1
    return rows, marks


@wrong("mixed_batch", "changes its argument `demonstrations`")
def paid_in_the_table(own, demonstrations, size, beta, bonus, rng):
    demonstrations[:, REWARD] += bonus  # again at each call
    return with_choice(own, demonstrations, size, beta, 0.0, rng)


@wrong("mixed_batch")
def a_coin_for_each_row(own, demonstrations, size, beta, bonus, rng):
    marks = torch.from_numpy(rng.random(size) < beta)
    n = int(marks.sum())
    theirs = demonstrations[rng.integers(len(demonstrations), size=n)]
    theirs[:, REWARD] += bonus
    rows = torch.empty(size, theirs.shape[1])
    rows[marks], rows[~marks] = theirs, own.sample(size - n, rng)
    return rows, marks.float()


@wrong("mixed_batch")
def bonus_of_the_course(own, demonstrations, size, beta, bonus, rng):
    return with_choice(own, demonstrations, size, beta, 2.0, rng)


@wrong("mixed_batch")
def too_many_rows(own, demonstrations, size, beta, bonus, rng):
    theirs, _ = with_choice(own, demonstrations, size, beta, bonus, rng)
    return torch.cat([theirs, own.sample(1, rng)]), torch.ones(size + 1)


@wrong("mixed_batch")
def without_rng(own, demonstrations, size, beta, bonus, rng):
    return with_choice(own, demonstrations, size, beta, bonus, np.random.default_rng())


@wrong("mixed_batch", "to the rewards of the demonstrations")
def the_column_counted_from_the_left(own, demonstrations, size, beta, bonus, rng):
    rows, marks = with_choice(own, demonstrations, size, beta, 0.0, rng)
    rows[:, 4] += bonus * marks
    return rows, marks


@wrong("mixed_batch", "again and again")
def one_demonstration_for_all(own, demonstrations, size, beta, bonus, rng):
    rows, marks = with_choice(own, demonstrations, size, beta, bonus, rng)
    n = int(marks.sum())
    rows[:n] = rows[: min(n, 1)]
    return rows, marks


@wrong("mixed_batch", "more often than others")
def the_last_demonstration_left_out(own, demonstrations, size, beta, bonus, rng):
    return with_choice(own, demonstrations[:-1], size, beta, bonus, rng)


@wrong("mixed_batch", "the rows and their marks")
def without_marks(*arguments):
    return with_choice(*arguments)[0]


# large_margin_loss ----------------------------------------------------------------------------------


def of_expert(q, expert_action):
    return q[torch.arange(len(q)), expert_action]


@right("large_margin_loss")
def with_one_hot(q, expert_action):
    margin = 1 - torch.nn.functional.one_hot(expert_action, q.shape[-1])
    return (q + margin).max(dim=-1).values - of_expert(q, expert_action)


@right("large_margin_loss")
def rivals_and_relu(q, expert_action):
    rivals = q.scatter(-1, expert_action[:, None], float("-inf")).amax(-1)
    return torch.relu(rivals + 1 - of_expert(q, expert_action))


@wrong("large_margin_loss", "no gradient")
def a_number(q, expert_action):
    return torch.tensor(with_one_hot(q, expert_action).detach().numpy())


@wrong("large_margin_loss")
def margin_for_the_expert(q, expert_action):
    margin = torch.nn.functional.one_hot(expert_action, q.shape[-1])
    return (q + margin).amax(-1) - of_expert(q, expert_action)


@wrong("large_margin_loss")
def cross_entropy(q, expert_action):
    return torch.nn.functional.cross_entropy(q, expert_action, reduction="none")


# paper_q_filter -------------------------------------------------------------------------------------


@right("paper_q_filter")
def nobody_is_better(q, expert_action):
    return 1.0 - (q > of_expert(q, expert_action)[:, None]).any(dim=1).double()


@right("paper_q_filter")
def level_with_the_best(q, expert_action):
    return torch.where(of_expert(q, expert_action) == q.max(dim=1).values, 1.0, 0.0)


@wrong("paper_q_filter", "compare the values")
def the_greedy_action(q, expert_action):
    return (q.argmax(dim=1) == expert_action).float()


@wrong("paper_q_filter")
def always_on(q, expert_action):
    return torch.ones(len(q))


@wrong("paper_q_filter")
def never_on(q, expert_action):
    return (of_expert(q, expert_action) > q.amax(-1)).double()


# q_filter -------------------------------------------------------------------------------------------


@right("q_filter")
def advantage(q, expert_action, log_pi):
    worth = torch.einsum("ba,ba->b", log_pi.exp(), q)
    return torch.heaviside(of_expert(q, expert_action) - worth - 1e-9, torch.zeros(1, dtype=q.dtype))


@right("q_filter")
def with_where_again(q, expert_action, log_pi):
    worth = (torch.exp(log_pi) * q).sum(dim=1)
    return torch.where(of_expert(q, expert_action) > worth, 1.0, 0.0)


@right("q_filter")
def with_a_softmax(q, expert_action, log_pi):
    return (of_expert(q, expert_action) > (log_pi.softmax(-1) * q).sum(-1)).float()


@right("q_filter")
def mean_advantage(q, expert_action, log_pi):
    ahead = of_expert(q, expert_action)[:, None] - q
    return ((log_pi.exp() * ahead).sum(-1) > 0).to(q.dtype)


@wrong("q_filter", "exactly as good")
def at_least(q, expert_action, log_pi):
    return (of_expert(q, expert_action) >= (log_pi.exp() * q).sum(-1)).float()


@wrong("q_filter")
def with_the_expert_s_probability(q, expert_action, log_pi):
    return (of_expert(q * log_pi.exp(), expert_action) > (log_pi.exp() * q).sum(-1)).double()


@wrong("q_filter", "shape")
def for_each_action(q, expert_action, log_pi):
    return (q > (log_pi.exp() * q).sum(-1, keepdim=True)).double()


# margin_loss ----------------------------------------------------------------------------------------


@right("margin_loss")
def one_sum_for_both(q_pair, action, is_demonstration):
    taken = q_pair.gather(-1, action.expand(2, -1)[..., None])[..., 0]
    ahead = q_pair + 1 - torch.nn.functional.one_hot(action, q_pair.shape[-1])
    keep = (taken >= q_pair.max(-1).values).float() * is_demonstration
    return ((ahead.max(-1).values - taken) * keep.detach()).sum() / len(action)


@right("margin_loss")
def with_a_mask(q_pair, action, is_demonstration):
    losses = []
    for q in q_pair:
        q_expert = of_expert(q, action)
        on = (q_expert.detach() == q.detach().amax(-1)) & (is_demonstration > 0)
        losses.append(torch.where(on, with_one_hot(q, action), torch.zeros_like(q_expert)).mean())
    return losses[0] + losses[1]


@wrong("margin_loss", "Q-filter")
def unfiltered(q_pair, action, is_demonstration):
    return sum((with_one_hot(q, action) * is_demonstration).mean() for q in q_pair)


@wrong("margin_loss")
def summed(q_pair, action, is_demonstration):
    return one_sum_for_both(q_pair, action, is_demonstration) * len(action)


@wrong("margin_loss", "own rows")
def everybody_is_an_expert(q_pair, action, is_demonstration):
    return one_sum_for_both(q_pair, action, torch.ones_like(is_demonstration))


@wrong("margin_loss")
def strictly_ahead(q_pair, action, is_demonstration):
    taken = torch.stack([of_expert(q, action) for q in q_pair])
    rivals = q_pair.scatter(-1, action.expand(2, -1)[..., None], float("-inf")).amax(-1)
    return (torch.relu(rivals + 1 - taken) * (taken > rivals) * is_demonstration).mean(-1).sum()

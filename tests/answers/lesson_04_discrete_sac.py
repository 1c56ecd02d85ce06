"""Answers to the exercises of the lesson on discrete SAC."""

import collections

import torch

from tests.answers import equivalent, right, wrong

ONE = "α is one number"
equivalent("soft_value", "alpha.unsqueeze(-1) * log_pi  ->  alpha * log_pi", ONE)
equivalent("soft_value", "alpha.unsqueeze(-1)  ->  alpha.unsqueeze(0)", ONE)
VALUE = "return (log_pi.exp() * (q - alpha.unsqueeze(-1) * log_pi)).sum(-1)"
equivalent("soft_value", f"{VALUE} - constraint  ->  {VALUE} + constraint", "the exercise has no constraint")
equivalent("actor_loss", "alpha * log_pi  ->  alpha * log_pi.detach()", "its slope, -α, is the same for all actions")
MEAN = "state_entropy.detach().mean"
equivalent("temperature_loss", f"{MEAN}(-1)  ->  {MEAN}(0)", "the batch is the only axis")


@right("critic_target")
def with_a_mask(reward, terminated, next_value, gamma):
    alive = 1 - terminated
    return reward + gamma * alive * next_value


@right("critic_target")
def with_where(reward, terminated, next_value, gamma):
    return torch.where(terminated.bool(), reward, reward + gamma * next_value)


@right("critic_target")
def one_by_one(reward, terminated, next_value, gamma):
    targets = []
    for r, t, v in zip(reward, terminated, next_value, strict=True):
        targets.append(r if t else r + gamma * v)
    return torch.stack(targets)


@wrong("critic_target")
def subtracted(reward, terminated, next_value, gamma):
    return reward - gamma * (1 - terminated) * next_value


@wrong("critic_target")
def reward_only(reward, terminated, next_value, gamma):
    return reward


@wrong("critic_target", "changes its argument `reward`")
def in_place(reward, terminated, next_value, gamma):
    reward += gamma * (1 - terminated) * next_value
    return reward


@wrong("critic_target", "shape")
def a_column(reward, terminated, next_value, gamma):
    return (reward + gamma * (1 - terminated) * next_value)[:, None]


# entropy --------------------------------------------------------------------------------------------


@right("entropy")
def with_torch_s_own(log_pi):
    return torch.distributions.Categorical(logits=log_pi).entropy()


@right("entropy")
def with_special_entr(log_pi):
    return torch.special.entr(log_pi.exp()).sum(dim=1)


@wrong("entropy", "mean over the batch")
def one_for_all(log_pi):
    return torch.distributions.Categorical(logits=log_pi).entropy().mean()


@wrong("entropy")
def of_the_logarithm(log_pi):
    return -(log_pi * torch.log(-log_pi + 1e-12)).sum(-1)


@wrong("entropy", "shape")
def each_action_s(log_pi):
    return -log_pi * log_pi.exp()


# soft_value -----------------------------------------------------------------------------------------


@right("soft_value")
def value_and_entropy(log_pi, q, alpha):
    pi = log_pi.exp()
    return (pi * q).sum(-1) + alpha * torch.special.entr(pi).sum(-1)


@right("soft_value")
def as_a_product(log_pi, q, alpha):
    return torch.einsum("ba,ba->b", torch.exp(log_pi), q - alpha * log_pi)


@wrong("soft_value")
def a_drawn_action(log_pi, q, alpha):
    drawn = torch.multinomial(log_pi.exp(), 1)
    return (q - alpha * log_pi).gather(1, drawn)[:, 0]


@wrong("soft_value")
def log_sum_exp(log_pi, q, alpha):
    return (alpha + 1e-6) * torch.logsumexp(q / (alpha + 1e-6), -1)


# actor_loss -----------------------------------------------------------------------------------------


@right("actor_loss")
def mean_cost(log_pi, q, alpha):
    return (log_pi.exp() * (alpha * log_pi - q.detach())).sum(-1).mean()


@right("actor_loss")
def without_a_graph(log_pi, q, alpha):
    with torch.no_grad():
        worth = q.clone()
    pi = log_pi.exp()
    entropy = -(pi * log_pi).sum(-1)
    return -torch.mean((pi * worth).sum(-1) + alpha * entropy)


@right("actor_loss")
def log_pi_detached_in_the_bracket(log_pi, q, alpha):  # its slope, -α, is the same for all actions: no logit feels it
    return -(log_pi.exp() * (q.detach() - alpha * log_pi.detach())).sum(-1).mean()


@right("actor_loss")
def with_a_categorical(log_pi, q, alpha):
    pi = torch.distributions.Categorical(logits=log_pi)
    return -((pi.probs * q.detach()).sum(-1) + alpha * pi.entropy()).mean()


@wrong("actor_loss")
def weights_detached(log_pi, q, alpha):
    return (log_pi.exp().detach() * (alpha * log_pi - q.detach())).sum(-1).mean()


@wrong("actor_loss")
def summed_over_the_batch(log_pi, q, alpha):
    return (log_pi.exp() * (alpha * log_pi - q.detach())).sum() * 2


# temperature_loss -----------------------------------------------------------------------------------


@right("temperature_loss")
def two_means(log_alpha, state_entropy, target_entropy):
    gap = torch.mean(state_entropy.detach() - target_entropy)
    return torch.exp(log_alpha) * gap


@right("temperature_loss")
def gap_as_a_number(log_alpha, state_entropy, target_entropy):
    gap = state_entropy.mean().item() - target_entropy.item()
    return gap * log_alpha.exp()


@wrong("temperature_loss", "add the target")
def plus_target(log_alpha, state_entropy, target_entropy):
    return log_alpha.exp() * (state_entropy.detach() + target_entropy).mean()


@wrong("temperature_loss")
def squared(log_alpha, state_entropy, target_entropy):
    return log_alpha.exp() * (state_entropy.detach().mean() - target_entropy) ** 2


# critic_loss ----------------------------------------------------------------------------------------


@right("critic_loss")
def one_critic_after_the_other(q_pair, action, target):
    rows, y = torch.arange(len(action)), target.detach()
    return sum(torch.nn.functional.mse_loss(q[rows, action], y) for q in q_pair)


@right("critic_loss")
def with_a_one_hot_mask(q_pair, action, target):
    taken = torch.nn.functional.one_hot(action, q_pair.shape[-1])
    with torch.no_grad():
        y = target.clone()
    return (((q_pair * taken).sum(-1) - y) ** 2).mean(dim=1).sum()


@wrong("critic_loss", "mean over the two critics")
def mean_of_both(q_pair, action, target):
    rows = torch.arange(len(action))
    return sum(((q[rows, action] - target.detach()) ** 2).mean() for q in q_pair) / 2


@wrong("critic_loss")
def summed_over_states(q_pair, action, target):
    return sum(((q.gather(1, action[:, None])[:, 0] - target.detach()) ** 2).sum() for q in q_pair)


@wrong("critic_loss")
def absolute(q_pair, action, target):
    return sum((q.gather(1, action[:, None])[:, 0] - target.detach()).abs().mean() for q in q_pair)


@wrong("critic_loss")
def a_broadcast(q_pair, action, target):
    return sum(((q.gather(1, action[:, None]) - target.detach()) ** 2).mean() for q in q_pair)


# ReplayBuffer ---------------------------------------------------------------------------------------


@right("ReplayBuffer")
class WithADeque:
    def __init__(self, size):
        self.rows = collections.deque(maxlen=size)

    def add(self, row):
        self.rows.append(row)

    def sample(self, batch, rng):
        return torch.stack([self.rows[i] for i in rng.choice(len(self.rows), batch)])


@right("ReplayBuffer")
class WithATable:
    def __init__(self, size):
        self.size, self.count, self.table = size, 0, None

    def add(self, row):
        if self.table is None:
            self.table = torch.zeros(self.size, len(row))
        self.table[self.count % self.size] = row
        self.count += 1

    def sample(self, batch, rng):
        filled = min(self.count, self.size)
        return self.table[torch.from_numpy((rng.random(batch) * filled).astype(int))]


@wrong("ReplayBuffer", "copies all its rows")
class WithSlicing:
    def __init__(self, size):
        self.size, self.rows = size, torch.empty(0)

    def add(self, row):
        self.rows = torch.cat([self.rows.reshape(-1, len(row)), row[None]])[-self.size :]

    def sample(self, batch, rng):
        return self.rows[rng.integers(0, len(self.rows), batch)]


@wrong("ReplayBuffer", "copies all its rows")
class StackedAtEachDraw(WithADeque):
    def sample(self, batch, rng):
        return torch.stack(list(self.rows))[rng.integers(len(self.rows), size=batch)]


@wrong("ReplayBuffer", "again and again")
class OneRowManyTimes(WithADeque):
    def sample(self, batch, rng):
        return self.rows[rng.integers(len(self.rows))].repeat(batch, 1)


@wrong("ReplayBuffer", "`return super().sample(batch, rng)[batch]`: IndexError")
class ANumberTooMany(WithADeque):
    def sample(self, batch, rng):
        return super().sample(batch, rng)[batch]


@wrong("ReplayBuffer", "keeps every row")
class WithoutAnEnd(WithADeque):
    def __init__(self, size):
        self.rows = []


@wrong("ReplayBuffer", "gives back the rows")
class OneTooSmall(WithADeque):
    def __init__(self, size):
        self.rows = collections.deque(maxlen=size - 1)


@wrong("ReplayBuffer", "neighbours")
class AStretch(WithADeque):
    def sample(self, batch, rng):
        start = rng.integers(len(self.rows))
        return torch.stack([self.rows[(start + i) % len(self.rows)] for i in range(batch)])


@wrong("ReplayBuffer", "nobody put in")
class OneRowForAll(WithADeque):
    def add(self, row):
        row[1:] = 0
        self.rows.append(row)


@wrong("ReplayBuffer", "rows was asked for")
class OneRowTooMany(WithADeque):
    def sample(self, batch, rng):
        return super().sample(batch + 1, rng)


@wrong("ReplayBuffer", "returns")
class AListOfRows(WithADeque):
    def sample(self, batch, rng):
        return [self.rows[i] for i in rng.integers(len(self.rows), size=batch)]

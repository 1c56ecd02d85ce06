"""Answers to the exercises of the lesson on SAC's update and loop."""

import collections

import torch

from bootcourse.course.lessons.update_and_loop import by_hand
from tests.answers import equivalent, right, wrong

TARGET = "target = critic_target(batch.rewards, batch.terminated,"
COPIES = "zip(agent.copies.parameters(), agent.critics.parameters()"
ALL = "zip(agent.optimisers, losses, strict=True)"
for _change, _why in {
    f"{TARGET} next_value, agent.gamma)  ->  {TARGET} agent.gamma, next_value)": "the target multiplies the two",
    f"{ALL}  ->  zip(agent.optimisers, losses, strict=False)": "there are as many losses as optimisers",
    f"{COPIES}, strict=True)  ->  {COPIES}, strict=False)": "there are as many weights in both",
    f"for slow, now in {COPIES}, strict=True):  ->  for slow, now in {COPIES}):": "as many of both",
    f"for optimiser, loss in {ALL}:  ->  for optimiser, loss in zip(agent.optimisers, losses):": "as many of both",
    "alpha = agent.log_alpha.exp().detach()  ->  alpha = agent.log_alpha.exp().clone()": "zeroed before its own loss",
}.items():
    equivalent("update", _change, _why)
for _change, _why in {
    "state, _ = env.reset(seed=0)  ->  state, _ = env.reset()": "where the first episode starts is free",
    "env.reset(seed=0)  ->  env.reset(seed=-1)": "where the first episode starts is free",
    "env.reset(seed=0)  ->  env.reset(seed=1)": "where the first episode starts is free",
    "push >= 256 and push % 4 == 0  ->  push > 256 and push % 4 == 0": "one update fewer of hundreds",
    "push >= 256  ->  push >= 255": "the first update comes at 256 either way",
    "push >= 256  ->  push >= 257": "one update fewer of hundreds",
    "push % 4 == 0  ->  push % 4 == 1": "one update for four pushes either way",
}.items():
    equivalent("train", _change, _why)


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


@wrong("ReplayBuffer", "in float64: keep them in float32")
class WithATableOfNumPy(WithATable):
    def sample(self, batch, rng):
        return super().sample(batch, rng).double()


@wrong("ReplayBuffer", "without replacement")
class EachRowOnce(WithADeque):
    def sample(self, batch, rng):
        return torch.stack([self.rows[i] for i in rng.choice(len(self.rows), batch, replace=False)])


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


def move_copies(agent):
    with torch.no_grad():
        for critic, copy in zip(agent.critics, agent.copies, strict=True):
            for new, old in zip(critic.parameters(), copy.parameters(), strict=True):
                old.copy_((1 - agent.tau) * old + agent.tau * new)


@right("update")
def without_functions(agent, batch):
    alpha = agent.log_alpha.exp().item()
    with torch.no_grad():
        logits = agent.actor(batch.next_states)
        pi, q = logits.softmax(1), torch.minimum(*agent.slow_q(batch.next_states))
        value = (pi * q).sum(1) - alpha * (pi * logits.log_softmax(1)).sum(1)
        y = batch.rewards + agent.gamma * (1 - batch.terminated) * value
    pi, q1, q2 = agent.log_pi(batch.states).exp(), *agent.q(batch.states)
    rows = torch.arange(len(y))
    errors = ((q[rows, batch.actions] - y).square().mean() for q in (q1, q2))
    actor = (pi * (alpha * pi.log() - torch.minimum(q1, q2).detach())).sum(1).mean()
    entropy = -(pi * pi.log()).sum(1).mean().item()
    total = sum(errors) + actor + agent.log_alpha.exp() * (entropy - agent.target_entropy)
    for optimiser in agent.optimisers:
        optimiser.zero_grad()
    total.backward()
    for optimiser in agent.optimisers:
        optimiser.step()
    move_copies(agent)


@right("train")
def with_a_while(agent, env, buffer, update, pushes, rng):
    done, over = 0, True
    while done < pushes:
        if over:
            state = env.reset()[0]
        action = agent.draw(state, rng)
        after, reward, fell, late, _ = env.step(action)
        buffer.add(by_hand.row(state, action, reward, float(fell), after))
        state, over, done = after, fell or late, done + 1
        if done > 256 and done % 4 == 0:
            update(agent, by_hand.batch_of(buffer.sample(64, rng)))


@wrong("train", "which ends in a fall, s' is not right")
def with_the_state_after_the_reset(agent, env, buffer, update, pushes, rng):
    state, _ = env.reset()
    for push in range(pushes):
        action, before = agent.draw(state, rng), state
        state, reward, fell, late, _ = env.step(action)
        if fell or late:
            state, _ = env.reset()
        buffer.add(by_hand.row(before, action, reward, fell, state))
        if push >= 256 and push % 4 == 0:
            update(agent, by_hand.batch_of(buffer.sample(64, rng)))


@wrong("train", "keeps 0 rows")
def without_a_memory(agent, env, buffer, update, pushes, rng):
    state, _ = env.reset()
    for _ in range(pushes):
        state, _, fell, late, _ = env.step(agent.draw(state, rng))
        if fell or late:
            state, _ = env.reset()


@wrong("update", "your first update the critics differ")
def with_the_larger_of_two(agent, batch):
    slow = agent.slow_q
    agent.slow_q = lambda states: slow(states).amax(0).expand(2, -1, -1)
    without_functions(agent, batch)
    del agent.slow_q


@wrong("train", "`pushes` counts single pushes, not episodes")
def as_many_episodes(agent, env, buffer, update, pushes, rng):
    for _ in range(pushes):
        (state, _), over = env.reset(), False
        while not over:
            action = agent.draw(state, rng)
            after, reward, fell, late, _ = env.step(action)
            buffer.add(by_hand.row(state, action, reward, fell, after))
            state, over = after, fell or late

"""Answers to the exercises of the lesson on SAC's update and loop."""

import collections

import torch

from bootcourse.course.lessons.update_and_loop import by_hand
from bootcourse.learn import sac
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


@wrong("ReplayBuffer", "copies all its rows")
class StackedAtEachDraw(WithADeque):
    def sample(self, batch, rng):
        return torch.stack(list(self.rows))[rng.integers(len(self.rows), size=batch)]


@wrong("ReplayBuffer", "in float64: keep them in float32")
class WithATableOfNumPy(WithATable):
    def sample(self, batch, rng):
        return super().sample(batch, rng).double()


@wrong("ReplayBuffer", "again and again")
class OneRowManyTimes(WithADeque):
    def sample(self, batch, rng):
        return self.rows[rng.integers(len(self.rows))].repeat(batch, 1)


@wrong("ReplayBuffer", "`return super().sample(batch, rng)[batch]`: IndexError")
class ANumberTooMany(WithADeque):
    def sample(self, batch, rng):
        return super().sample(batch, rng)[batch]


@wrong("ReplayBuffer", "without replacement")
class EachRowOnce(WithADeque):
    def sample(self, batch, rng):
        return torch.stack([self.rows[i] for i in rng.choice(len(self.rows), batch, replace=False)])


@wrong("ReplayBuffer", "without replacement")
class EachRowOnceWhereThatIsPossible(WithADeque):
    def sample(self, batch, rng):
        places = [i for _ in range(batch) for i in rng.permutation(len(self.rows))]
        return torch.stack([self.rows[i] for i in places[:batch]])


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


@wrong("update", "the critics")
def with_half_a_loss(agent, batch):
    with torch.no_grad():
        value = sac.soft_value(agent.log_pi(batch.next_states), agent.slow_q(batch.next_states).amin(0), torch.ones(()))
        y = sac.critic_target(batch.rewards, batch.terminated, value, agent.gamma)
    taken = agent.q(batch.states)[:, torch.arange(len(y)), batch.actions]
    optimiser = agent.optimisers[0]
    optimiser.zero_grad()
    (taken - y).square().mean().backward()
    optimiser.step()
    move_copies(agent)


@wrong("update", "your first update log α differs")
def without_the_actor(agent, batch):
    alpha = agent.log_alpha.exp().detach()
    with torch.no_grad():
        value = sac.soft_value(agent.log_pi(batch.next_states), agent.slow_q(batch.next_states).amin(0), alpha)
        y = sac.critic_target(batch.rewards, batch.terminated, value, agent.gamma)
    q = agent.q(batch.states)
    loss = sac.critic_loss(q.gather(-1, batch.actions.expand(2, -1).unsqueeze(-1)).squeeze(-1), y).sum()
    agent.optimisers[0].zero_grad()
    loss.backward()
    agent.optimisers[0].step()
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


@wrong("update", "Step 8 changes their weights in place")
def without_step_8(agent, batch):
    with torch.no_grad():
        before = [each.clone() for each in agent.copies.parameters()]
    without_functions(agent, batch)
    with torch.no_grad():
        for each, old in zip(agent.copies.parameters(), before, strict=True):
            each.copy_(old)


@wrong("update", "your first update the critics differ")
def with_the_larger_of_two(agent, batch):
    slow = agent.slow_q
    agent.slow_q = lambda states: slow(states).amax(0).expand(2, -1, -1)
    without_functions(agent, batch)
    del agent.slow_q


def loop(often=4, rows=64, wrap=by_hand.batch_of, times=1):
    """The loop with other slips than the exercise knows."""

    def answer(agent, env, buffer, update, pushes, rng):
        state, _ = env.reset()
        for push in range(pushes):
            action, before = agent.draw(state, rng), state
            state, reward, fell, late, _ = env.step(action)
            buffer.add(by_hand.row(before, action, reward, fell, state))
            if fell or late:
                state, _ = env.reset()
            if push >= 256 and push % often == 0:
                for _ in range(times):
                    update(agent, wrap(buffer.sample(rows, rng)))

    return answer


wrong("train", "`by_hand.batch_of` of 64 rows")(loop(wrap=lambda rows: rows))
wrong("train", "`by_hand.batch_of` of 64 rows")(loop(rows=32))
wrong("train", "one after each fourth push")(loop(times=4))
wrong("train", "updates: after the first 256")(loop(often=64))


@wrong("train", "`pushes` counts single pushes, not episodes")
def as_many_episodes(agent, env, buffer, update, pushes, rng):
    for _ in range(pushes):
        (state, _), over = env.reset(), False
        while not over:
            action = agent.draw(state, rng)
            after, reward, fell, late, _ = env.step(action)
            buffer.add(by_hand.row(state, action, reward, fell, after))
            state, over = after, fell or late

"""Answers to the exercises of the lesson on SAC's update and loop."""

import collections
import linecache

import numpy as np
import torch

from bootcourse.course.exercise import source_of
from bootcourse.course.lessons.update_and_loop import by_hand, exercises
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
    "env.reset(seed=0)  ->  env.reset(seed=1)": "where the first episode starts is free",
    "push >= 256  ->  push >= 255": "the first update comes at 256 either way",
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


@right("ReplayBuffer")
class InTheOrderOfTheTable(WithADeque):
    def sample(self, batch, rng):
        times = rng.multinomial(batch, np.full(len(self.rows), 1 / len(self.rows)))
        return torch.stack([row for row, count in zip(self.rows, times, strict=True) for _ in range(count)])


@wrong("ReplayBuffer", "the same batch at each call")
class OneSeedForAll(WithADeque):
    def sample(self, batch, rng):
        return super().sample(batch, np.random.default_rng(0))


@wrong("ReplayBuffer", "the same batch at each call")
class TheNewestRows(WithADeque):
    def sample(self, batch, rng):
        return torch.stack([self.rows[-1 - k % len(self.rows)] for k in range(batch)])


@wrong("ReplayBuffer", "leave the rows where they are")
class ADrawnRowIsGone(WithADeque):
    def sample(self, batch, rng):
        drawn = rng.integers(len(self.rows), size=batch)
        given = torch.stack([self.rows[i] for i in drawn])
        left = [row for i, row in enumerate(self.rows) if i not in drawn]
        self.rows = collections.deque(left or self.rows, maxlen=self.rows.maxlen)
        return given


@wrong("ReplayBuffer", "depend on each other")
class OneFromEachPart(WithADeque):
    def sample(self, batch, rng):
        place = (np.arange(batch) + rng.random(batch)) / batch
        return torch.stack([self.rows[i] for i in (len(self.rows) * place).astype(int)])


@wrong("ReplayBuffer", "some rows more often")
class RoundedPlaces(WithADeque):
    def sample(self, batch, rng):
        last = len(self.rows) - 1
        return torch.stack([self.rows[round(place)] for place in rng.uniform(0, last, batch)])


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


@right("ReplayBuffer")
class InOrder(WithADeque):
    def sample(self, batch, rng):
        return torch.stack([self.rows[i] for i in np.sort(rng.integers(len(self.rows), size=batch))])


@right("ReplayBuffer")
class OneByOne(WithADeque):
    def sample(self, batch, rng):
        return torch.cat([self.rows[int(rng.random() * len(self.rows))][None] for _ in range(batch)])


@wrong("ReplayBuffer", "keep nothing from call to call")
class PassByPass(WithADeque):
    """Each row comes once before one comes again."""

    def sample(self, batch, rng):
        drawn = [i for _ in range(batch // len(self.rows) + 1) for i in rng.permutation(len(self.rows))]
        return torch.stack([self.rows[i] for i in drawn[:batch]])


@wrong("ReplayBuffer", "keep nothing from call to call")
class Walking(WithADeque):
    """It goes on where the last batch ended."""

    place = 0

    def sample(self, batch, rng):
        self.place += batch
        return torch.stack([self.rows[(self.place + i) % len(self.rows)] for i in range(batch)])


@wrong("ReplayBuffer", "more often than others")
class Rounded(WithADeque):
    """The first and the last row have half of the others' chance."""

    def sample(self, batch, rng):
        return torch.stack([self.rows[round(i)] for i in rng.random(batch) * (len(self.rows) - 1)])


@wrong("ReplayBuffer", "the same batch at each call")
class OneBatch(WithADeque):
    """A generator of its own makes the same batch at each call."""

    def sample(self, batch, rng):
        return torch.stack([self.rows[i] for i in np.random.default_rng(0).integers(len(self.rows), size=batch)])


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
    log_pi = agent.actor(batch.states).log_softmax(1)
    actor = (pi * (alpha * log_pi - torch.minimum(q1, q2).detach())).sum(1).mean()
    entropy = -(pi * log_pi).sum(1).mean().item()
    total = sum(errors) + actor + agent.log_alpha.exp() * (entropy - agent.target_entropy)
    for optimiser in agent.optimisers:
        optimiser.zero_grad()
    total.backward()
    for optimiser in agent.optimisers:
        optimiser.step()
    move_copies(agent)


@right("update")
def with_gradients_of_its_own(agent, batch):
    policy, y = torch.distributions.Categorical(logits=agent.log_pi(batch.next_states)), batch.rewards.clone()
    value = (policy.probs * agent.slow_q(batch.next_states).min(0).values).sum(1)
    value = (value + agent.log_alpha.exp() * policy.entropy()).detach()
    y += agent.gamma * value * (batch.terminated == 0)
    log_pi, q = agent.log_pi(batch.states), agent.q(batch.states)
    errors = q[:, range(len(y)), batch.actions] - y
    alpha, h = agent.log_alpha.exp(), -(log_pi.exp() * log_pi).sum(1).mean()
    losses = errors.pow(2).mean(1).sum(), -(log_pi.exp() * q.amin(0).detach()).sum(1).mean() - alpha.item() * h
    for optimiser, loss in zip(agent.optimisers, (*losses, alpha * (h.item() - agent.target_entropy)), strict=True):
        optimiser.zero_grad(set_to_none=False)
        parameters = [each for group in optimiser.param_groups for each in group["params"]]
        for parameter, slope in zip(parameters, torch.autograd.grad(loss, parameters, retain_graph=True), strict=True):
            parameter.grad = slope
    for optimiser in agent.optimisers:
        optimiser.step()
    for name, slow in agent.copies.state_dict().items():
        slow.lerp_(agent.critics.state_dict()[name], agent.tau)


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
            update(agent, by_hand.batch_of(buffer.sample(256, rng)))
    env.close()


def changed(exercise, name: str, *changes: tuple[str, str]):
    """The exercise's own answer with these changes. `inspect` finds its text."""
    text = source_of(exercise.solution)
    for old, new in changes:
        assert old in text, (name, old)
        text = text.replace(old, new)
    text, file = text.replace(f"def {exercise.name}", f"def {name}"), f"<{name}, a changed {exercise.name}>"
    linecache.cache[file] = len(text), None, text.splitlines(keepends=True), file
    space = vars(exercises) | {"np": np, "torch": torch}
    exec(compile(text, file, "exec"), space)
    return space[name]


STEP, TARGET = "        optimiser.step()", "next_value, agent.gamma)"
CLIPPED = "        torch.nn.utils.clip_grad_norm_(optimiser.param_groups[0]['params'], 1.0)"
for _name, _words, *_changes in (
    ("targets_of_at_most_20", "the critics", (TARGET, f"{TARGET}.clamp(-20, 20)")),
    (
        "values_of_at_most_20",
        "the critics",
        (".amin(0)\n        next_value", ".amin(0).clamp(-20, 20)\n        next_value"),
    ),
    ("gradients_of_at_most_1", "differ", (STEP, f"{CLIPPED}\n{STEP}")),
    ("two_steps", "differ", (STEP, f"{STEP}\n{STEP}")),
    ("the_mean_of_both", "the policy", ("q_pair.amin(0)", "q_pair.mean(0)")),
    ("a_fixed_temperature", "the critics", ("agent.log_alpha.exp().detach()", "torch.tensor(0.01)")),
    ("another_tau", "the copies", ("agent.tau *", "0.005 *")),
    ("half_the_target", "log α", ("agent.target_entropy)", "agent.target_entropy / 2)")),
    (
        "the_next_states",
        "the policy",
        ("agent.log_pi(batch.states), agent.q", "agent.log_pi(batch.next_states), agent.q"),
    ),
):
    wrong("update", _words)(changed(exercises.update, _name, *_changes))


DRAW, SAMPLE, WHEN = "agent.draw(state, rng)", "buffer.sample(256, rng)", "push >= 256 and push % 4 == 0"
RESET, FIRST, UPDATE = "            state, _ = env.reset()", "state, _ = env.reset(seed=0)", "update(agent, by_hand."
ROW = "        buffer.add(by_hand.row(state, action, reward, terminated, next_state))"
AGAIN = f"{UPDATE}batch_of({SAMPLE}))"
TURNED = """
    def turned(rows):
        batch = by_hand.batch_of(rows)
        return batch._replace(states=batch.next_states, next_states=batch.states)

    for push"""

for _name, _changes in {
    "arrays_of_no_axis": [(DRAW, f"np.array({DRAW})")],
    "drawn_seeds": [(RESET, RESET.replace("()", "(seed=int(rng.integers(2**31)))"))],
    "rows_counted": [(WHEN, "len(buffer.rows) >= 256 and len(buffer.rows) % 4 == 0")],
    "named_arguments": [(SAMPLE, "buffer.sample(batch=256, rng=rng)")],
    "the_spaces": [("for push", "assert env.unwrapped.action_space.n == 2\n    for push")],
}.items():
    right("train")(changed(exercises.train, _name, *_changes))

for _name, _words, *_changes in (
    ("the_same_start", "one seed", (RESET, RESET.replace("()", "(seed=0)"))),
    ("the_old_state", "the last state of the old episode", (RESET, "            env.reset()")),
    ("a_reset_each_100", "middle", ("terminated or truncated:", "terminated or truncated or push % 100 == 99:")),
    ("no_first_reset", "begin with", (FIRST, "state = np.zeros(4, dtype=np.float32)")),
    ("a_quarter_of_the_rows", "256 rows", ("sample(256", "sample(64")),
    ("the_newest_rows", "drawn anew", (SAMPLE, "torch.stack(buffer.rows[-256:])")),
    ("another_generator", "with `rng`", (SAMPLE, "buffer.sample(256, np.random.default_rng(0))")),
    ("its_own_draws", "the generator `rng`", (DRAW, "agent.draw(state, np.random.default_rng(push))")),
    ("at_random_at_first", "another action", (DRAW, f"{DRAW} if push > 256 else 1")),
    ("few_rows_are_enough", "too early", ("push >= 256", "push >= 64")),
    ("it_waits", "after 265 pushes", ("push >= 256", "push >= 264")),
    ("each_third", "every fourth push", ("% 4", "% 3")),
    ("two_at_once", "more than one update", (AGAIN, f"{AGAIN}; {AGAIN}")),
    ("four_of_16", "more than one update", ("% 4 == 0", "% 16 == 0"), (AGAIN, f"[{AGAIN} for _ in range(4)]")),
    ("it_stops_to_learn", "36 updates", ("push >= 256", "400 > push >= 256")),
    ("a_reward_of_its_own", "r is not right", ("action, reward,", "action, 1.0,")),
    ("a_price_for_falls", "r is not right", ("action, reward,", "action, -1.0 if terminated else reward,")),
    ("nothing_after_a_fall", "s' is not", (", next_state))", ", next_state * (not terminated)))")),
    ("the_last_is_dropped", "before it has kept the row", (ROW, f"        if not terminated:\n    {ROW}")),
    ("each_row_twice", "more than one row", (ROW, f"{ROW}\n{ROW}")),
    ("one_push_more", "were asked for", ("range(pushes)", "range(pushes + 1)")),
    ("the_other_action", "another action", ("env.step(action)", "env.step(1 - action)")),
    ("states_exchanged", "drawn anew", (f"{UPDATE}batch_of(", "update(agent, turned("), ("    for push", TURNED)),
):
    wrong("train", _words)(changed(exercises.train, _name, *_changes))


@wrong("train", "holds the first state of the next one")
def with_the_state_after_the_reset(agent, env, buffer, update, pushes, rng):
    state, _ = env.reset()
    for push in range(pushes):
        action, before = agent.draw(state, rng), state
        state, reward, fell, late, _ = env.step(action)
        if fell or late:
            state, _ = env.reset()
        buffer.add(by_hand.row(before, action, reward, fell, state))
        if push >= 256 and push % 4 == 0:
            update(agent, by_hand.batch_of(buffer.sample(256, rng)))


@wrong("train", "before it has kept the row")
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

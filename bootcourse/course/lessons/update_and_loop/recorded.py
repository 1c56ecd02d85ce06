"""What a loop does, and when: a world, an agent, a buffer and an update that note each call.

`departure` runs a loop among them and says in one sentence where it first departs from the lesson's box.
"""

import gymnasium as gym
import numpy as np
import torch
from torch import Tensor

from bootcourse.course.exercise import NotAsAsked
from bootcourse.course.lessons.update_and_loop import by_hand

FIRST, EVERY, BATCH = 256, 4, 256  # pushes before the first update, pushes from one to the next, rows of a batch
COLUMNS = {"s": slice(4), "a": slice(4, 5), "r": slice(5, 6), "terminated": slice(6, 7), "s'": slice(7, 11)}

GOES_ON = "You go on after a {}. The environment has to be reset there, too."
SAME_START = (
    "Your loop hands one seed to `env.reset` again and again, so all these episodes begin in the same state: after an "
    "end write `env.reset()`."
)
STANDS_STILL = "Your state does not move on: the next decision is made in `next_state`."
OLD_STATE = "After a reset you decide in the last state of the old episode: write `state, _ = env.reset()`."
OUT_OF_TIME = "You keep a timeout as an end. The row holds `terminated` alone: after a timeout the pole still stands."
TURNED = "Your row begins with the state that came after the push. It begins with the one in which you decided."
RESET_FIRST = (
    "The row of a push that ends an episode holds the first state of the next one as s'. Keep the row before you "
    "reset: s' is the state to which the push led."
)
EARLY = "Your loop updates too early: let the buffer fill for 256 pushes first."
BAD_BATCH = "Hand `update` the agent and `by_hand.batch_of` of 256 rows, drawn anew from your buffer with `rng`."
LATE_ROWS = "Your loop goes on before it has kept the row of the last push: add it right after the push."


class World(gym.Env):
    """The pole's interface around states that are numbers: (episode, push of the episode, 0, 0). Rewards differ."""

    observation_space = gym.spaces.Box(-np.inf, np.inf, (4,), np.float32)
    action_space = gym.spaces.Discrete(2)

    def __init__(self, note: "Notes"):
        self.note = note

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.note.reset(seed)
        return self.note.state(), {}

    def step(self, action):
        return self.note.step(action)


class Agent(by_hand.SAC):
    """An agent that draws either action with the same chance."""

    def __init__(self, note: "Notes"):
        super().__init__(optimiser=by_hand.Descent)
        self.note = note

    def draw(self, state, rng):
        return self.note.draw(state, rng)


class Buffer:
    """The notebook's replay buffer, which never gets full."""

    def __init__(self, note: "Notes"):
        self.note, self.size, self.rows, self.next = note, 10**6, [], 0
        self.table = torch.empty(note.asked + 20, 11)  # faster to draw from than a list

    def add(self, row):
        self.note.row(row, len(self.rows))
        self.table[self.next] = row
        self.rows.append(row)
        self.next += 1

    def sample(self, batch, rng):
        return self.note.sample(self.table[: self.next], batch, rng)


class Notes:
    """What has happened so far. asked: pushes of the training; falls, timeouts: those that end an episode."""

    def __init__(self, asked: int, falls: tuple[int, ...], timeouts: tuple[int, ...]):
        self.asked, self.falls, self.timeouts, self.rng = asked, falls, timeouts, np.random.default_rng(0)
        self.world, self.agent, self.buffer = World(self), Agent(self), Buffer(self)
        self.departure = ""  # the first
        self.episode, self.push, self.ended, self.seeds = -1, 0, "", []
        self.drawn: int | None = None  # the action for the present state
        self.kept: list[Tensor] = []  # the right row of each push
        self.batch: Tensor | None = None  # rows that were drawn since the last update
        self.updates: list[int] = []  # after how many pushes each came

    def departs(self, sentence: str, condition: bool = True) -> None:
        if condition and not self.departure:
            self.departure = sentence

    def state(self) -> np.ndarray:
        return np.array([self.episode, self.push, 0, 0], dtype=np.float32)

    def reset(self, seed: int | None) -> None:
        self.departs("Your loop resets in the middle of an episode: reset once at the start, and after each end.",
                     self.push > 0 and not self.ended)  # fmt: skip
        self.departs("Your loop resets twice where an episode begins: once is enough.",
                     self.episode >= 0 and self.push == 0 and not self.ended)  # fmt: skip
        self.departs(SAME_START, seed is not None and seed in self.seeds)
        self.seeds.append(seed)
        self.episode, self.push, self.ended, self.drawn = self.episode + 1, 0, "", None

    def draw(self, state: np.ndarray, rng: np.random.Generator) -> int:
        if not isinstance(state, np.ndarray) or state.shape != (4,):
            raise NotAsAsked("Hand `agent.draw` the state as the environment gives it: a NumPy array (4,).")
        self.departs("Hand `agent.draw` the generator `rng` that your loop gets.", rng is not self.rng)
        self.departs("Your loop draws two actions for one push: draw one, and do it.", self.drawn is not None)
        if self.episode >= 0 and not np.array_equal(state, self.state()):
            is_old = self.push == 0 and self.kept and np.array_equal(state, self.kept[-1][7:])
            is_before = self.kept and np.array_equal(state, self.kept[-1][:4])
            self.departs(OLD_STATE if is_old else STANDS_STILL if is_before else
                         f"In push {len(self.kept)} you decide in another state than the present one.")  # fmt: skip
        self.drawn = int(self.rng.integers(2))
        return self.drawn

    def step(self, action) -> tuple:
        number = len(self.kept)
        if number > self.asked + 10:
            raise NotAsAsked("Your loop goes on after the last push: `pushes` counts single pushes, not episodes.")
        self.departs("Your loop steps before it has reset the environment: begin with `state, _ = env.reset()`.",
                     self.episode < 0)  # fmt: skip
        self.departs(GOES_ON.format(self.ended), bool(self.ended))
        self.departs(f"In push {number} you take another action than the one that `agent.draw` gives in this state.",
                     self.drawn != int(action))  # fmt: skip
        self.departs(LATE_ROWS, len(self.buffer.rows) < number)
        before, reward = self.state(), (number % 5 - 1) / 2  # rewards of either sign
        fell, late = number in self.falls, number in self.timeouts
        self.push, self.drawn = self.push + 1, None
        self.ended = "fall" if fell else "timeout" if late else ""
        self.kept.append(by_hand.row(before, int(action), reward, fell, self.state()))
        return self.state(), reward, fell, late, {}

    def row(self, row: Tensor, number: int) -> None:
        """A row is added as that of push `number`."""
        if not isinstance(row, Tensor) or row.shape != (11,):
            raise NotAsAsked("A row is a tensor (11,), as `by_hand.row(s, a, r, terminated, s')` makes it.")
        if number > self.asked + 10:
            raise NotAsAsked("Your loop keeps a row before it has pushed, or more than one row for a push.")
        if number >= len(self.kept):
            return self.departs("Your loop keeps a row before it has pushed, or more than one row for a push.")
        right = self.kept[number]
        if torch.equal(row.float(), right):
            return None
        wrong = [name for name, part in COLUMNS.items() if not torch.equal(row[part].float(), right[part])]
        self.departs(OUT_OF_TIME, wrong == ["terminated"] and number in self.timeouts)
        self.departs(TURNED, wrong == ["s"] and torch.equal(row[:4], right[7:]))
        begins = bool(number in (*self.falls, *self.timeouts) and row[7] > right[7] and row[8] == 0)
        self.departs(RESET_FIRST, wrong == ["s'"] and begins)
        ending = ", which ends by time," if number in self.timeouts else ""
        ending = ", which ends in a fall," if number in self.falls else ending
        verb = "is" if len(wrong) == 1 else "are"
        self.departs(f"In the row of push {number}{ending} {' and '.join(wrong)} {verb} not right: a row is (s, a, r, "
                     "terminated, s'), and pushes count from 0.", bool(wrong))  # fmt: skip

    def sample(self, rows: Tensor, batch: int, rng: np.random.Generator) -> Tensor:
        if not len(rows):
            raise NotAsAsked("Your loop draws a batch before it has kept a row: add each push's row to the buffer.")
        self.departs(BAD_BATCH, batch != BATCH or rng is not self.rng)
        self.batch = rows[torch.from_numpy(self.rng.integers(len(rows), size=batch))]
        return self.batch.clone()

    def update(self, agent: by_hand.SAC, batch: by_hand.Batch) -> None:
        now, before = len(self.kept), self.updates[-1] if self.updates else None
        self.departs(EARLY, now < FIRST)
        self.departs(LATE_ROWS, len(self.buffer.rows) < now)
        is_right = agent is self.agent and isinstance(batch, by_hand.Batch) and self.batch is not None
        is_right = is_right and all(map(torch.equal, batch, by_hand.batch_of(self.batch)))
        self.departs(BAD_BATCH, not is_right)
        if before is None:
            self.departs(f"Your first update comes after {now} pushes: begin after the first {FIRST}.",
                         now > FIRST + EVERY)  # fmt: skip
        elif now == before:
            self.departs("Your loop makes more than one update after a push: make one after every fourth push.")
        else:
            self.departs(f"Your loop updates after {before} pushes and then after {now}: make one update after every "
                         "fourth push, counted over all episodes.", now != before + EVERY)  # fmt: skip
        self.updates.append(now)
        self.batch = None

    def end(self) -> None:
        pushes, rows = len(self.kept), len(self.buffer.rows)
        self.departs(f"Your loop makes {pushes} pushes: {self.asked} were asked for.", pushes != self.asked)
        self.departs(f"In {pushes} pushes your loop keeps {rows} rows: one transition for each push.", rows != pushes)
        last = self.updates[-1] if self.updates else FIRST
        often = f"In {pushes} pushes your loop makes {len(self.updates)} updates: after the first {FIRST}, make one "
        self.departs(often + "after every fourth push.", pushes - last > EVERY - bool(self.updates))


def departure(train, pushes: int, falls: tuple[int, ...], timeouts: tuple[int, ...]) -> str:
    """A sentence on the first departure of a loop from the box; "" if there is none.

    Raises NotAsAsked where the loop cannot go on.
    """
    notes = Notes(pushes, falls, timeouts)
    train(notes.agent, notes.world, notes.buffer, notes.update, pushes, notes.rng)
    notes.end()
    return notes.departure

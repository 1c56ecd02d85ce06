"""Problems other than the trap, with hand-written teachers: where else does a sub-optimal teacher help?

A problem has three teachers. "good" is the rule as it is. "random" takes a wrong action in a share of the states that
looks random; "systematic" takes the same wrong action everywhere in one region of the states. Where the observation
contains the time, or never returns to the same value, random errors average out over an episode. DoorKey's returns:
there a teacher that errs in a state errs whenever it comes back, and may turn in circles.

Lunar lander needs box2d (`pip install bootcourse[lander]`).
highway-env's merge is left out: one core makes about 46 decisions a second there, so its cells would take many hours.

All teachers answer for many observations in one call, (n, observation) -> (n,).
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.util import find_spec

import gymnasium as gym
import numpy as np
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, SyncVectorEnv, VectorEnv
from gymnasium.vector.utils import batch_space

from bootcourse.episodes.success import Success
from bootcourse.learn.teachers import Rule, all_roads, with_name
from bootcourse.research.teachers import hashed

MakeEnv = Callable[[], gym.Env]


def several(make_env: MakeEnv) -> Callable[[int], SyncVectorEnv]:
    """What `Training` asks for: a vector environment of that many copies."""
    return lambda count: SyncVectorEnv([make_env] * count, autoreset_mode=AutoresetMode.SAME_STEP)


class FixedHorizon(gym.Wrapper):
    """CartPole that goes on for all 500 steps: 1 for each step with the pole up and the cart on its track.

    Like `seals/CartPole-v0`. Otherwise the length of an episode would tell an imitator how well
    it drives, and the discriminator would not be tested.
    """

    def __init__(self, env: gym.Env):
        super().__init__(env)
        self.limits = env.unwrapped.x_threshold, env.unwrapped.theta_threshold_radians
        env.unwrapped.x_threshold = env.unwrapped.theta_threshold_radians = math.inf

    def step(self, action):
        state, _, terminated, truncated, info = self.env.step(action)
        up = abs(state[0]) <= self.limits[0] and abs(state[2]) <= self.limits[1]
        return state, float(up), terminated, truncated, info


CARTPOLE_SCALES = (1.0, 1.0, 0.1, 1.0)  # m, m/s, rad, rad/s


def scaled(env: gym.Env, scales: Sequence[float]) -> gym.Env:
    """The same environment; its observations are divided by these scales."""
    space, by = env.observation_space, np.array(scales, dtype=np.float32)
    space = gym.spaces.Box(space.low / by, space.high / by, dtype=np.float32)
    return gym.wrappers.TransformObservation(env, lambda state: (state / by).astype(np.float32), space)


def cartpole() -> gym.Env:
    """CartPole with observations of order one."""
    return scaled(gym.make("CartPole-v1"), CARTPOLE_SCALES)


def fixed_cartpole() -> gym.Env:
    """The same, of fixed length."""
    return scaled(FixedHorizon(gym.make("CartPole-v1")), CARTPOLE_SCALES)


def acrobot() -> gym.Env:
    return gym.make("Acrobot-v1")


class Table(VectorEnv):
    """Copies of a problem whose state is a row of whole numbers. Same-step autoreset; reaching the goal is success.

    A sub-class gives `actions` (their number), `limit` (decisions of an episode), `size` (of an observation), and
    start(rng) -> a state (k,); move(states (n, k), actions (n,), times (n,)) -> (states, rewards, reached the goal);
    show(states, times) -> observations (n, size).
    """

    actions: int
    limit: int
    size: int

    def __init__(self, num_envs: int):
        self.num_envs, self.metadata = num_envs, {"autoreset_mode": AutoresetMode.SAME_STEP}
        self.single_observation_space = gym.spaces.Box(0.0, 1.0, (self.size,), np.float32)
        self.single_action_space = gym.spaces.Discrete(self.actions)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.generators = [seeding.np_random()[0] for _ in range(num_envs)]

    def reset(self, *, seed=None, options=None):
        if seed is not None:
            seeds = seed if np.iterable(seed) else range(seed, seed + self.num_envs)
            self.generators = [seeding.np_random(each)[0] for each in seeds]
        self.states = np.array([self.start(rng) for rng in self.generators])
        self.times = np.zeros(self.num_envs, dtype=np.int64)
        return self.show(self.states, self.times), {}

    def step(self, actions):
        self.states, rewards, reached = self.move(self.states.copy(), np.asarray(actions), self.times)
        self.times = self.times + 1
        truncated = ~reached & (self.times >= self.limit)
        done, infos = reached | truncated, {"is_success": reached, "_is_success": np.ones_like(reached)}
        observations = self.show(self.states, self.times)
        if done.any():
            infos |= {"final_obs": observations, "_final_obs": done, "final_info": dict(infos), "_final_info": done}
            for i in np.flatnonzero(done):
                self.states[i], self.times[i] = self.start(self.generators[i]), 0
            observations = self.show(self.states, self.times)
        return observations, rewards, reached, truncated, infos


class Chain(Table):
    """20 cells in a row. The last pays 10 and ends the episode; to push against the first wall pays 0.05, the decoy.

    Actions: 0 left, 1 right. State: the cell. Observed: the cell (one-hot, 20) and the share of the time that is over.
    """

    actions, limit, cells = 2, 60, 20
    size = cells + 1

    def start(self, rng: np.random.Generator) -> np.ndarray:
        return np.array([0])

    def move(self, states, actions, times):
        cell = states[:, 0] + 2 * actions - 1
        reached = cell == self.cells - 1
        return np.maximum(cell, 0)[:, None], 10.0 * reached + 0.05 * (cell < 0), reached

    def show(self, states, times):
        return np.hstack([np.eye(self.cells)[states[:, 0]], times[:, None] / self.limit]).astype(np.float32)


EAST, SOUTH, _, NORTH = range(4)
LEFT, RIGHT, FORWARD, PICK_UP, TOGGLE = range(5)
AHEAD_X, AHEAD_Y = np.array([1, 0, -1, 0]), np.array([0, 1, 0, -1])  # of each direction; y grows to the south


class DoorKey(Table):
    """MiniGrid's DoorKey 5x5 (Chevalier-Boisvert et al., arXiv 2306.13831), seen from above, without unused actions.

    Columns 1 and 3 of rows 1..3 are free, column 2 is a wall with a locked door. The key lies in column 1, the goal is
    cell (3, 3). Actions: turn left, turn right, forward, pick up, toggle the door. It pays 1 - 0.9 t / 100 at the goal.
    An open door stays open. State: x, y, direction, key's row (0: carried), door's row, door open. Observed: all of it
    one-hot, without the time.
    """

    actions, limit = 5, 100
    size = 9 + 4 + 3 + 2 + 2

    def start(self, rng: np.random.Generator) -> np.ndarray:
        y, key = 1 + rng.permutation(3)[:2]
        return np.array([1, y, rng.integers(4), key, 1 + rng.integers(2), 0])

    def move(self, states, actions, times):
        x, y, direction, key, door, is_open = states.T  # views: to write to them changes the states
        direction += (actions == RIGHT) * 1 - (actions == LEFT) * 1
        direction %= 4
        to_x, to_y = x + AHEAD_X[direction], y + AHEAD_Y[direction]
        at_key, at_door = (to_x == 1) & (to_y == key), (to_x == 2) & (to_y == door)
        walls = (to_x < 1) | (to_x > 3) | (to_y < 1) | (to_y > 3) | ((to_x == 2) & ~(at_door & (is_open == 1)))
        goes = (actions == FORWARD) & ~walls & ~at_key
        is_open[(actions == TOGGLE) & at_door & (key == 0)] = 1
        key[(actions == PICK_UP) & at_key] = 0
        x[goes], y[goes] = to_x[goes], to_y[goes]
        reached = (x == 3) & (y == 3)
        return states, reached * (1 - 0.9 * (times + 1) / self.limit), reached

    def show(self, states, times):
        x, y, direction, key, door, is_open = states.T
        columns = np.eye(9)[3 * (y - 1) + x - 1], np.eye(4)[direction], np.eye(4)[key][:, 1:], np.eye(2)[door - 1]
        return np.hstack([*columns, np.eye(2)[is_open]]).astype(np.float32)


@all_roads
def to_the_right(seen: np.ndarray) -> np.ndarray:
    """Chain: right."""
    return np.ones(len(seen), dtype=np.int64)


@all_roads
def with_the_motion(seen: np.ndarray) -> np.ndarray:
    """MountainCar: push along the motion. Columns: position, speed."""
    return np.where(seen[:, 1] >= 0, 2, 0)


@all_roads
def swing(seen: np.ndarray) -> np.ndarray:
    """Acrobot: turn the joint the way it turns, which adds energy. Column 5: its angular speed."""
    return np.where(seen[:, 5] >= 0, 2, 0)


@all_roads
def lean(seen: np.ndarray) -> np.ndarray:
    """CartPole, a weak controller: push to where the pole leans and falls, without a look at the cart."""
    return (seen[:, 2] + 0.15 * seen[:, 3] > 0).astype(np.int64)


@all_roads
def hover_and_land(seen: np.ndarray) -> np.ndarray:
    """Lunar lander: gymnasium's heuristic. Columns: x, y, both speeds, angle, angular speed, two legs."""
    x, y, x_speed, y_speed, angle, angular_speed, left, right = seen.T
    landed = (left > 0) | (right > 0)
    tilt = np.where(landed, 0, (np.clip(0.5 * x + x_speed, -0.4, 0.4) - angle) * 0.5 - angular_speed)
    lift = np.where(landed, -0.5 * y_speed, (0.55 * abs(x) - y) * 0.5 - 0.5 * y_speed)
    sideways = np.where(tilt < -0.05, 3, np.where(tilt > 0.05, 1, 0))
    return np.where((lift > abs(tilt)) & (lift > 0.05), 2, sideways)


@all_roads
def fetch_and_open(seen: np.ndarray) -> np.ndarray:
    """DoorKey: to the key, pick it up, to the door, open it, to the goal."""
    cell, direction, door = seen[:, :9].argmax(1), seen[:, 9:13].argmax(1), 1 + seen[:, 16:18].argmax(1)
    x, y, is_open = 1 + cell % 3, 1 + cell // 3, seen[:, 19] == 1
    searching, key = seen[:, 13:16].any(1), 1 + seen[:, 13:16].argmax(1)
    row = np.where(searching, key, np.where(x == 3, 3, door))
    wanted = np.where((y == row) | (x == 2), EAST, np.where(row > y, SOUTH, NORTH))
    at_key, at_door = searching & (abs(row - y) == 1), ~searching & (x == 1) & (y == row) & ~is_open
    facing = np.where(at_key, PICK_UP, np.where(at_door, TOGGLE, FORWARD))
    turn = np.where((wanted - direction) % 4 == 3, LEFT, RIGHT)
    return np.where(direction == wanted, facing, turn)


def right_in(share: float, rule: Rule, n_actions: int) -> Rule:
    """The rule with a wrong action in all states but a share of them, which looks random (see `teachers.hashed`)."""

    @all_roads
    def partly(seen: np.ndarray) -> np.ndarray:
        other = 1 + (hashed(seen, 2) * (n_actions - 1)).astype(np.int64)
        return (rule(seen) + np.where(hashed(seen, 1) < share, 0, other)) % n_actions

    return with_name(partly, f"{rule.__name__}, right in {100 * share:g} % of states")


def wrong_where(region: Callable[[np.ndarray], np.ndarray], rule: Rule, n_actions: int) -> Rule:
    """The rule with the same kind of error, the next action instead of the right one, everywhere in a region."""

    @all_roads
    def partly(seen: np.ndarray) -> np.ndarray:
        return (rule(seen) + region(seen)) % n_actions

    return with_name(partly, f"{rule.__name__}, wrong in a region")


@dataclass(frozen=True)
class Problem:
    """An environment with its teachers and the numbers that all methods share in it."""

    name: str  # in text and figures
    make_env: Callable[[int], VectorEnv]
    actions: int
    rule: Rule
    right: float  # the share of states in which the "random" teacher is right
    region: Callable[[np.ndarray], np.ndarray]  # where the "systematic" teacher is wrong: (n, observation) -> (n,) bool
    gamma: float
    episodes: int  # of training

    def teachers(self) -> dict[str, Rule]:
        """{"good", "random", "systematic": the teacher}."""
        return {
            "good": self.rule,
            "random": right_in(self.right, self.rule, self.actions),
            "systematic": wrong_where(self.region, self.rule, self.actions),
        }


def mountain_car() -> gym.Env:
    return Success(scaled(gym.make("MountainCar-v0"), (1.0, 0.07)), lambda earned, terminated: terminated)


def swinging() -> gym.Env:
    return Success(acrobot(), lambda earned, terminated: terminated)


def balancing() -> gym.Env:
    return Success(cartpole(), lambda earned, terminated: earned >= 475)


def landing() -> gym.Env:
    return Success(gym.make("LunarLander-v3"), lambda earned, terminated: earned >= 200)


def has_box2d() -> bool:
    """Whether Lunar lander can be driven here."""
    return find_spec("Box2D") is not None


DOORKEY, LANDER = "doorkey", "lander"
PROBLEMS = {
    "chain": Problem(
        "chain with a decoy", Chain, 2, to_the_right, 0.8, lambda seen: seen[:, 10:12].any(1), 0.97, 400
    ),
    "mountain-car": Problem(
        "MountainCar", several(mountain_car), 3, with_the_motion, 0.7, lambda seen: seen[:, 0] > 0.1, 0.99, 150
    ),
    "acrobot": Problem("Acrobot", several(swinging), 3, swing, 0.7, lambda seen: seen[:, 5] > 0, 0.99, 80),
    "cartpole": Problem("CartPole", several(balancing), 2, lean, 0.8, lambda seen: seen[:, 0] > 0.2, 0.99, 250),
    DOORKEY: Problem(
        "DoorKey 5x5", DoorKey, 5, fetch_and_open, 0.8, lambda seen: seen[:, 12] == 1, 0.97, 300
    ),
    LANDER: Problem(
        "Lunar lander", several(landing), 4, hover_and_land, 0.85, lambda seen: seen[:, 0] > 0.1, 0.99, 200
    ),
}  # fmt: skip

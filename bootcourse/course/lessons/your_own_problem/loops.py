"""How a rule climbs the hill of MountainCar, where a teacher loops in DoorKey, and what agents learn from each."""

from collections.abc import Callable
from functools import cache

import gymnasium as gym
import numpy as np
from gymnasium.vector import VectorEnv
from gymnasium.wrappers.vector import TransformReward
from torch import Tensor

from bootcourse.comparison import Comparison
from bootcourse.course.lessons.your_teacher.driven_out import (
    NOT_SAME,
    NOT_WHOLE,
    NOTHING,
    OUTSIDE,
    no_action,
    same_action,
)
from bootcourse.episodes.driving import copies_of
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.learn.agent import Agent
from bootcourse.learn.demonstrations import Demonstrations, demonstrate
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.teachers import Rule, teacher_policy
from bootcourse.learn.training import Training
from bootcourse.policies import Policy, PolicyOutput
from bootcourse.research.problems import PROBLEMS, DoorKey
from bootcourse.statistics import interval

MakeEnvs = Callable[[int], VectorEnv]
MOST_EPISODES = 50_000  # of a training that ends after so many decisions
UP = 1.0  # the flag was reached; any other result is the farthest position, the flag is at 0.5
PUSHES = 3
LOOP = 2  # the seed of a drive of the random teacher in DoorKey that ends in a loop


def climb(answer, seed: int):
    """How one episode of MountainCar ends: `UP`, or the farthest position, rounded to 0.05; 5 and more: no action.

    An answer that is not a number is returned unchanged.
    """
    env = gym.make("MountainCar-v0").unwrapped
    state, asked, end = env.reset(seed=seed)[0], [], None
    while end is None and len(asked) < 200:
        seen = tuple(map(float, state))
        action = answer(*seen)
        wrong = no_action(action)
        if wrong == NOTHING and not asked:
            return None
        if wrong is not None:
            return action if wrong == "as it is" else float(wrong)
        if action >= PUSHES:
            return float(OUTSIDE)
        asked.append((seen, int(action)))
        state, _, terminated, _, _ = env.step(int(action))
        end = UP if terminated else None
    if any(not same_action(answer(*seen), action) for seen, action in reversed(asked)):
        return float(NOT_SAME)
    return round(20 * max(position for (position, _), _ in asked)) / 20 if end is None else end


def explain_climb(cases, answers):
    """What went wrong, and in how many of the episodes the flag was reached."""
    ends = [float(answer) for answer in answers]
    if NOTHING in ends:
        return "Your rule returns nothing in some situations: look for a branch without `return`."
    if NOT_WHOLE in ends or OUTSIDE in ends:
        return "Your rule returns something else than an action: a whole number (an `int`), 0 (left), 1 or 2 (right)."
    if NOT_SAME in ends:
        return (
            "Your rule answers the same state differently when it is asked again: it draws at random, or remembers. "
            "The label of a state must not change."
        )
    low = [end for end in ends if end != UP]
    return (
        f"Your rule reaches the flag at 0.5 in {len(ends) - len(low)} of {len(ends)} episodes. In the others it comes "
        f"up to {max(low):.2f} at most in 200 decisions: swing, and take more speed from each swing."
    )


def climbed(rule: Rule, seed: int = 0) -> np.ndarray:
    """The positions of a drive of MountainCar by a rule of (position, speed), (decisions + 1,)."""
    env = gym.make("MountainCar-v0").unwrapped
    seen, positions, terminated = env.reset(seed=seed)[0], [], False
    while not terminated and len(positions) < 200:
        positions.append(float(seen[0]))
        seen, _, terminated, _, _ = env.step(int(rule(*map(float, seen))))
    return np.array([*positions, float(seen[0])])


def teacher(rule: Rule) -> Rule:
    """A rule of (position, speed) as a teacher of agents, which see the speed in parts of 0.07."""
    return lambda seen: rule(float(seen[0]), 0.07 * float(seen[1]))


def first_drives() -> dict[str, np.ndarray]:
    """The positions of two drives of MountainCar: always pushed to the right, and by the course's teacher."""
    ours = PROBLEMS["mountain-car"].teachers()["good"]  # it sees the speed in parts of 0.07
    return {
        "always to the right": climbed(lambda position, speed: 2),
        "a rule of one line": climbed(lambda *seen: ours(np.array([seen]) / (1, 0.07))[0]),
    }


def rooms(teacher: Rule, seed: int) -> tuple[list[tuple[int, ...]], bool]:
    """(states, reached the goal) of a drive of DoorKey by a teacher: x, y, direction, key's row, door's row, open."""
    env = DoorKey(1)
    seen, _ = env.reset(seed=seed)
    states, reached, done = [], False, False
    while not done:
        states.append(tuple(int(number) for number in env.states[0]))
        seen, _, terminated, truncated, _ = env.step(teacher(seen))
        reached, done = bool(terminated[0]), bool(terminated[0] or truncated[0])
    return states, reached


def drive_in_a_loop() -> list[tuple[int, ...]]:
    """The states of a drive of the random teacher that passes the door and misses the goal."""
    return rooms(PROBLEMS["doorkey"].teachers()["random"], LOOP)[0]


def earns(rule: Rule, make_env: MakeEnvs) -> float:
    """The mean return of a rule of one observation, in 50 episodes of an environment."""
    policy = teacher_policy(rule, None, n_actions=int(make_env(1).single_action_space.n))
    return drive_episodes(policy, range(50), make_env=make_env).returns.mean()


@cache
def trained(
    budgets: tuple[int, ...], make_env: MakeEnvs, teacher: Rule, pays: float, gamma: float, seeds: int = 5
) -> dict[int, tuple[list[Agent], np.ndarray]]:
    """Agents with the soft constraint, after so many decisions each: (they, what they earn).

    pays: the share of each reward that they get in training, 0 for none; the test counts the environment's reward.
    """

    def paid(n: int) -> VectorEnv:
        return TransformReward(copies_of(make_env, n), lambda rewards: pays * rewards)

    settings = with_seeds(settings_for("soft", gamma=gamma), seeds)
    training = Training(settings, episodes=MOST_EPISODES, make_env=paid, teacher=teacher)
    tested, held_out = {}, held_out_seeds(1, 5)
    for budget in budgets:
        agents = training.run(False, stop=lambda most=budget * training.n_agents: training.decisions >= most).agents
        drives = [drive_episodes(agent.as_policy(), held_out, make_env=make_env) for agent in agents]
        tested[budget] = agents, np.array([each.returns.mean() for each in drives])
    return tested


def without_the_cart(policy: Policy) -> Policy:
    """A policy of CartPole for which the cart's place and speed are always 0."""

    def drive(observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
        seen = observations.copy()
        seen[:, :2] = 0
        return policy(seen, seen)

    return drive


def brief(compared: Comparison) -> tuple[list[str], list[list[str]]]:
    """A comparison as a short table, (headings, rows): means over agents with 95 % intervals, in whole numbers."""

    def words(values: np.ndarray) -> str:
        value, low, high = (f"{round(part)}".replace("-", "−") for part in interval(values))
        return f"{value} [{low}, {high}]"

    measures = {"success, % [95 %]": ("success", 100), "return [95 %]": ("returns", 1)}
    found = {
        heading: [scale * compared.scores(name, measure) for name in compared.results]
        for heading, (measure, scale) in measures.items()
    }
    known = {heading: each for heading, each in found.items() if not np.isnan(each).any()}
    rows = [[name, *map(words, each)] for name, *each in zip(compared.results, *known.values(), strict=True)]
    return ["", *known], rows


def shown(problem: str) -> Demonstrations:
    """50 drives of a problem's random teacher."""
    one = PROBLEMS[problem]
    return demonstrate(50, None, teacher=one.teachers()["random"], make_env=one.make_env)


def cloned(problem: str, rows: Tensor) -> Agent:
    """The random teacher's clone, a single agent that learns from these rows for 2,000 decisions."""
    one = PROBLEMS[problem]
    learning = {"make_env": one.make_env, "teacher": one.teachers()["random"], "demonstrations": rows}
    training = Training([settings_for("bc")], episodes=MOST_EPISODES, **learning)
    (clone,) = training.run(False, stop=lambda: training.decisions >= 2_000).agents
    return clone


def labels(problem: str) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """(the states in 50 drives of the random teacher, its actions there, its clone's, the good one's), n of each."""
    drives, good = shown(problem), PROBLEMS[problem].teachers()["good"]
    seen, clone = drives.observations, cloned(problem, drives.rows())
    return seen, drives.actions, np.asarray(clone.probabilities(seen)).argmax(-1), good(seen)


def states(seen: np.ndarray) -> int:
    """How many different states there are among these, (n, observation)."""
    return len(np.unique(seen, axis=0))

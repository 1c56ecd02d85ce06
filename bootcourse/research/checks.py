"""Independent checks: `python -m bootcourse.research.checks` trains our learners on tasks with published results.

The training loop and the learners of the road (`Training`, `SACLearner`, `CQLLearner`, `GAILLearner`,
`PPOLearner`) train here on other gymnasium environments, several seeds side by side, without a teacher.
The target entropy is a share of log |A|, not the paper's -1, a formula for continuous actions. SAC's τ
is 0.05 and γ = 0.99. CQL's weight is 10, as in the check that it is compared with. The budget of
environment steps is at most the published one. PPO has CleanRL's γ, λ, ε and entropy weight, and
learning rates that fall to 0; CleanRL's figures are of training episodes, whose actions are drawn.

CartPole's observations are scaled to order one, as on the road; with raw ones it stays near 300.
Acrobot's are raw, and it gets one update for each step of its four environments instead of one for all
four. A random policy is rewarded in one of a hundred episodes, so the agent must find the reward before
exploration fades. The raw speeds are Acrobot's largest numbers: an untrained actor depends on them most,
and so it pushes in the direction of the swing. On 16 seeds that are not the table's all agents found it
within 15,000 steps; with scaled observations 5 of 8 did, with fewer updates 4 of 8 within 30,000.
"""

import argparse
import math
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import gymnasium as gym
import numpy as np
import torch
from gymnasium.vector import AutoresetMode, SyncVectorEnv

from bootcourse.episodes.evaluate import drive_episodes
from bootcourse.errors import BootcourseError, check_known
from bootcourse.files import write_bytes
from bootcourse.learn.agent import Agent
from bootcourse.learn.demonstrations import collect
from bootcourse.learn.replay_buffer import decode_transitions
from bootcourse.learn.settings import Settings, settings_for, with_seeds
from bootcourse.learn.teachers import all_roads, teacher_policy
from bootcourse.learn.training import MOST_EPISODES, Training
from bootcourse.policies import Policy, random_policy

MakeEnv = Callable[[], gym.Env]
TEST_SEED, DATA_SEED, SEED = 10**6, 2 * 10**6, 3 * 10**6  # of the first test, data and training environment


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
    return scaled(gym.make("CartPole-v1"), CARTPOLE_SCALES)


def fixed_cartpole() -> gym.Env:
    return scaled(FixedHorizon(gym.make("CartPole-v1")), CARTPOLE_SCALES)


def acrobot() -> gym.Env:
    return gym.make("Acrobot-v1")


@all_roads
def balance(states: np.ndarray) -> np.ndarray:
    """A hand-written CartPole driver, the demonstrator: it pushes to where the pole falls. (n, 4) -> (n,)."""
    return (states @ np.array([0.1, 0.3, 0.1, 0.3]) > 0).astype(np.int64)


def several(make_env: MakeEnv) -> Callable[[int], SyncVectorEnv]:
    """What `Training` asks for: a vector environment of that many copies."""
    return lambda count: SyncVectorEnv([make_env] * count, autoreset_mode=AutoresetMode.SAME_STEP)


def data(policy: Policy, make_env: MakeEnv, episodes: int, seed: int = DATA_SEED) -> tuple[torch.Tensor, float]:
    """Whole episodes of a policy as rows for a `ReplayBuffer`, and their mean return."""
    rows = collect(episodes, None, policy, None, several(make_env), seed)
    size = make_env().observation_space.shape[0]
    return rows, float(decode_transitions(rows, size, torch.zeros(len(rows))).rewards.sum()) / episodes


def train(
    settings: Sequence[Settings],
    make_env: MakeEnv,
    decisions: int,
    demonstrations: torch.Tensor | None = None,
    progress: bool = False,
) -> list[Agent]:
    """Train agents for `decisions` decisions each."""
    most = min(decisions, MOST_EPISODES)
    training = Training(settings, most, demonstrations=demonstrations, make_env=several(make_env), first_seed=SEED)
    return training.run(progress, stop=lambda: training.decisions >= decisions * len(settings)).agents


def scores(agents: Sequence[Agent], make_env: MakeEnv, episodes: int = 100) -> np.ndarray:
    """Each agent's mean return over test episodes that are the same for all, by its most probable action: (agents,)."""
    seeds, envs = range(TEST_SEED, TEST_SEED + episodes), several(make_env)
    return np.array([drive_episodes(a.as_policy(), seeds, None, make_env=envs).returns.mean() for a in agents])


@dataclass(frozen=True)
class Outcome:
    """What a check measured."""

    scores: np.ndarray  # (seeds,)
    note: str = ""


def usual(method: str, n_actions: int, **changes) -> Settings:
    """The settings of all checks: γ = 0.99, target entropy 0.3 log |A|."""
    return settings_for(method, gamma=0.99, target_entropy=0.3 * math.log(n_actions), **changes)


SAC = {"tau": 0.05}
PPO = {"envs_per_agent": 8, "horizon": 128, "epochs": 10, "batch": 256, "actor_lr": 1e-3, "critic_lr": 1e-3,
       "anneal_decisions": 200_000}  # fmt: skip


def online_check(method: str, make_env: MakeEnv, decisions: int, **changes):
    """A learner that drives itself, for `decisions` decisions of each agent. changes: of its settings."""

    def measure(seeds: int, progress: bool) -> Outcome:
        settings = with_seeds(usual(method, int(make_env().action_space.n), **changes), seeds)
        return Outcome(scores(train(settings, make_env, decisions, progress=progress), make_env))

    return measure


def cql_check(seeds: int, progress: bool) -> Outcome:
    """CQL on 20,000 transitions, half by a half-trained policy, half at random; 5,000 updates."""
    (half_trained,) = train([usual("sac", 2, seed=10**6, **SAC)], cartpole, 10_000)
    rng = np.random.default_rng(0)
    parts = [data(half_trained.as_policy(rng), cartpole, 300), data(random_policy(rng, 2), cartpole, 1000)]
    rows = torch.cat([rows[torch.from_numpy(rng.permutation(len(rows))[:10_000])] for rows, _ in parts])
    settings = with_seeds(usual("cql", 2, envs_per_agent=1, cql_weight=10.0, learning_starts=0), seeds)
    agents = train(settings, cartpole, 5000, rows, progress)
    return Outcome(scores(agents, cartpole), f"the data's policies: {parts[0][1]:.0f} and {parts[1][1]:.0f}")


def gail_check(seeds: int, progress: bool) -> Outcome:
    """GAIL from 60 demonstrations on the CartPole of fixed length."""
    rows, theirs = data(teacher_policy(balance, None, 2), fixed_cartpole, 60)
    agents = train(with_seeds(usual("gail", 2), seeds), fixed_cartpole, 100_000, rows, progress)
    return Outcome(scores(agents, fixed_cartpole), f"the demonstrator: {theirs:.0f}")


@dataclass(frozen=True)
class Check:
    """A published result, and how we try to reach it."""

    learner: str
    task: str
    published: float
    their_budget: str
    our_budget: str
    source: str
    measure: Callable[[int, bool], Outcome]


SLM = "[SLM Lab, benchmarks](https://github.com/kengz/SLM-Lab/blob/master/docs/BENCHMARKS.md)"
CLEANRL = "[CleanRL, ppo.md](https://github.com/vwxyzjn/cleanrl/blob/master/docs/rl-algorithms/ppo.md)"
CHECKS = {
    "sac-cartpole": Check(
        "discrete SAC", "CartPole-v1", 406.09, "200,000 frames, 4 seeds", "100,000 frames", SLM,
        online_check("sac", cartpole, 100_000, **SAC),
    ),
    "sac-acrobot": Check(
        "discrete SAC", "Acrobot-v1", -92.60, "300,000 frames, 4 seeds", "100,000 frames", SLM,
        online_check("sac", acrobot, 100_000, **SAC, updates=4),
    ),
    "cql-cartpole": Check(
        "CQL, offline", "CartPole-v1", 170.0, "20,000 transitions, 5,000 updates", "the same",
        "[Tianshou, test_discrete_cql.py](https://github.com/thu-ml/tianshou/blob/master/test/offline/test_discrete_cql.py)",
        cql_check,
    ),
    "gail-cartpole": Check(
        "GAIL, 60 demonstrations", "CartPole of fixed length", 500.0, "200,000 frames", "100,000 frames",
        "[imitation, tutorial 3](https://github.com/HumanCompatibleAI/imitation/blob/master/docs/tutorials/3_train_gail.ipynb)",
        gail_check,
    ),
    "ppo-cartpole": Check(
        "PPO", "CartPole-v1", 490.04, "500,000 frames, 3 seeds", "200,000 frames", CLEANRL,
        online_check("ppo", cartpole, 200_000, **PPO),
    ),
    "ppo-acrobot": Check(
        "PPO", "Acrobot-v1", -86.36, "500,000 frames, 3 seeds", "200,000 frames", CLEANRL,
        online_check("ppo", acrobot, 200_000, **PPO),
    ),
}  # fmt: skip
PAGE = """# Independent checks

A baseline that is badly trained makes any method look good. So our learners, the very classes that learn the road, are
trained where others published figures: `python -m bootcourse.research.checks` makes this table again. *Reached* means
that the mean over the seeds is within 1 % of the published figure, or above it.

"""
CLOSE = 0.01  # a mean within 1 % of the published figure counts as reached


def reached(outcome: Outcome, check: Check) -> bool:
    return bool(outcome.scores.mean() >= check.published - CLOSE * abs(check.published))


def table(outcomes: dict[str, Outcome], seconds: dict[str, float]) -> str:
    """The checks as a markdown table."""
    from bootcourse.research.tables import markdown

    rows = []
    for name, outcome in outcomes.items():
        check, values = CHECKS[name], outcome.scores
        ours = f"{values.mean():.1f} [{values.min():.1f}, {values.max():.1f}], {len(values)} seeds"
        ours += f" ({outcome.note})" if outcome.note else ""
        budget = f"{check.our_budget}, {seconds[name]:.0f} s"
        verdict = "yes" if reached(outcome, check) else "**no**"
        published = f"{check.published:g}", check.their_budget
        rows.append([check.learner, check.task, *published, ours, budget, verdict, check.source])
    headings = ["learner", "task", "published", "its budget", "ours, mean [worst, best]", "our budget", "reached"]
    return markdown([*headings, "source"], rows)


def run(names: Sequence[str], seeds: int, progress: bool) -> tuple[dict[str, Outcome], dict[str, float]]:
    """Run some checks: outcomes, and seconds of the processor for each. Raises BootcourseError for an unknown name."""
    outcomes, seconds = {}, {}
    for name in names:
        check_known("Check", name, CHECKS)
    for name in names:
        began = time.process_time()
        outcomes[name] = CHECKS[name].measure(seeds, progress)
        seconds[name] = time.process_time() - began
    return outcomes, seconds


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="python -m bootcourse.research.checks", description=__doc__.split("\n")[0])
    parser.add_argument("--only", nargs="+", default=list(CHECKS), metavar="NAME", help=", ".join(CHECKS))
    parser.add_argument("--seeds", type=int, default=4, help="training seeds, side by side")
    parser.add_argument("--out", type=Path, help="also write the table to this file")
    options = parser.parse_args(arguments)
    torch.set_num_threads(1)
    try:
        outcomes, seconds = run(options.only, options.seeds, sys.stderr.isatty())
    except BootcourseError as error:
        print(error, file=sys.stderr)
        return 2
    text = table(outcomes, seconds)
    print(text)
    if options.out:
        write_bytes(options.out, (PAGE + text).encode())
    return 0 if all(reached(outcome, CHECKS[name]) for name, outcome in outcomes.items()) else 1


if __name__ == "__main__":
    sys.exit(main())

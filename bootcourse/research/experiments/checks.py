"""Do our learners reach published figures on other tasks?

    bootcourse study checks --out DIR    # about twenty minutes of one core

The training loop and the learners of the road train here on other gymnasium environments, several seeds side by side,
without a teacher. The target entropy is a share of log |A|, not the paper's -1, a formula for continuous actions. SAC's
τ is 0.05 and γ = 0.99. CQL's weight is 10, as in the check that it is compared with. The budget of environment steps is
at most the published one. PPO has CleanRL's γ, λ, ε and entropy weight, and learning rates that fall to 0; CleanRL's
figures are of training episodes, whose actions are drawn.

CartPole's observations are scaled to order one, as on the road; with raw ones it stays near 300. Acrobot's are raw, and
it gets one update for each step of its four environments instead of one for all four. A random policy is rewarded in
one of a hundred episodes, so the agent must find the reward before exploration fades. The raw speeds are Acrobot's
largest numbers: an untrained actor depends on them most, and so it pushes in the direction of the swing. On 16 seeds
that are not the table's all agents found the reward within 15,000 steps; with scaled observations 5 of 8 did, with
fewer updates 4 of 8 within 30,000.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import torch

from bootcourse.episodes.evaluate import drive_episodes
from bootcourse.learn.agent import Agent
from bootcourse.learn.demonstrations import collect
from bootcourse.learn.replay_buffer import decode_transitions
from bootcourse.learn.settings import Settings, settings_for, with_seeds
from bootcourse.learn.teachers import all_roads, teacher_policy
from bootcourse.learn.training import MOST_EPISODES, Training
from bootcourse.policies import Policy, random_policy
from bootcourse.research.cells import results_of
from bootcourse.research.experiment import Computed, Experiment
from bootcourse.research.jobs import Interrupted, orphaned
from bootcourse.research.problems import CARTPOLE_SCALES as CARTPOLE_SCALES
from bootcourse.research.problems import MakeEnv, acrobot, cartpole, fixed_cartpole, several
from bootcourse.research.results import Results, agent_entries
from bootcourse.research.tables import markdown

TEST_SEED, DATA_SEED, SEED = 10**6, 2 * 10**6, 3 * 10**6  # of the first test, data and training environment
CLOSE = 0.01  # a mean within 1 % of the published figure counts as reached


@all_roads
def balance(states: np.ndarray) -> np.ndarray:
    """A hand-written CartPole driver, the demonstrator: it pushes to where the pole falls. (n, 4) -> (n,)."""
    return (states @ np.array([0.1, 0.3, 0.1, 0.3]) > 0).astype(np.int64)


def data(policy: Policy, make_env: MakeEnv, episodes: int, seed: int = DATA_SEED) -> tuple[torch.Tensor, float]:
    """Whole episodes of a policy as rows for a `ReplayBuffer`, and their mean return."""
    rows = collect(episodes, None, policy, None, several(make_env), seed)
    size = make_env().observation_space.shape[0]
    return rows, float(decode_transitions(rows, size, torch.zeros(len(rows))).rewards.sum()) / episodes


def train(
    settings: Sequence[Settings], make_env: MakeEnv, decisions: int, demonstrations: torch.Tensor | None = None
) -> list[Agent]:
    """Train agents for `decisions` decisions each. Raises Interrupted if the study is stopped."""
    most = min(decisions, MOST_EPISODES)
    training = Training(settings, most, demonstrations=demonstrations, make_env=several(make_env), first_seed=SEED)
    result = training.run(False, stop=lambda: training.decisions >= decisions * len(settings) or orphaned())
    if orphaned():
        raise Interrupted(settings[0].method)
    return result.agents


def scores(agents: Sequence[Agent], make_env: MakeEnv, episodes: int = 100) -> np.ndarray:
    """Each agent's mean return over test episodes that are the same for all, by its most probable action: (agents,)."""
    seeds, envs = range(TEST_SEED, TEST_SEED + episodes), several(make_env)
    return np.array([drive_episodes(a.as_policy(), seeds, None, make_env=envs).returns.mean() for a in agents])


def usual(method: str, n_actions: int, **changes) -> Settings:
    """The settings of all checks: γ = 0.99, target entropy 0.3 log |A|."""
    return settings_for(method, gamma=0.99, target_entropy=0.3 * math.log(n_actions), **changes)


SAC = {"tau": 0.05}
PPO = {"envs_per_agent": 8, "horizon": 128, "epochs": 10, "batch": 256, "actor_lr": 1e-3, "critic_lr": 1e-3,
       "anneal_decisions": 200_000}  # fmt: skip
Trained = tuple[list[Agent], list[float]]  # the agents, and the mean returns of those who drove their data


def online(method: str, make_env: MakeEnv, decisions: int, **changes) -> Callable[[int], Trained]:
    """A learner that drives itself, for `decisions` decisions of each agent. changes: of its settings."""

    def trained(seeds: int) -> Trained:
        settings = usual(method, int(make_env().action_space.n), **changes)
        return train(with_seeds(settings, seeds), make_env, decisions), []

    return trained


def cql(seeds: int) -> Trained:
    """CQL on 20,000 transitions, half by a half-trained policy, half at random; 5,000 updates."""
    (half_trained,) = train([usual("sac", 2, seed=10**6, **SAC)], cartpole, 10_000)
    rng = np.random.default_rng(0)
    parts = [data(half_trained.as_policy(rng), cartpole, 300), data(random_policy(rng, 2), cartpole, 1000)]
    rows = torch.cat([rows[torch.from_numpy(rng.permutation(len(rows))[:10_000])] for rows, _ in parts])
    settings = usual("cql", 2, envs_per_agent=1, cql_weight=10.0, learning_starts=0)
    return train(with_seeds(settings, seeds), cartpole, 5000, rows), [returns for _, returns in parts]


def gail(seeds: int) -> Trained:
    """GAIL from 60 demonstrations on the CartPole of fixed length."""
    rows, returns = data(teacher_policy(balance, None, 2), fixed_cartpole, 60)
    return train(with_seeds(usual("gail", 2), seeds), fixed_cartpole, 100_000, rows), [returns]


@dataclass(frozen=True)
class Check:
    """A published result, and how we try to reach it."""

    learner: str
    task: str
    published: float
    their_budget: str
    our_budget: str
    source: str
    make_env: MakeEnv
    train: Callable[[int], Trained]  # a number of seeds -> their agents
    data: str = ""  # who drove the data, if anybody did


SLM = "[SLM Lab, benchmarks](https://github.com/kengz/SLM-Lab/blob/master/docs/BENCHMARKS.md)"
CLEANRL = "[CleanRL, ppo.md](https://github.com/vwxyzjn/cleanrl/blob/master/docs/rl-algorithms/ppo.md)"
CHECKS = {
    "sac-cartpole": Check(
        "discrete SAC", "CartPole-v1", 406.09, "200,000 frames, 4 seeds", "100,000 frames", SLM,
        cartpole, online("sac", cartpole, 100_000, **SAC),
    ),
    "sac-acrobot": Check(
        "discrete SAC", "Acrobot-v1", -92.60, "300,000 frames, 4 seeds", "100,000 frames", SLM,
        acrobot, online("sac", acrobot, 100_000, **SAC, updates=4),
    ),
    "cql-cartpole": Check(
        "CQL, offline", "CartPole-v1", 170.0, "20,000 transitions, 5,000 updates; its own test stops there", "the same",
        "[Tianshou, test_discrete_cql.py](https://github.com/thu-ml/tianshou/blob/master/test/offline/test_discrete_cql.py)",
        cartpole, cql, "the data's policies",
    ),
    "gail-cartpole": Check(
        "GAIL, 60 demonstrations", "CartPole of fixed length", 500.0, "200,000 frames", "100,000 frames",
        "[imitation, tutorial 3](https://github.com/HumanCompatibleAI/imitation/blob/master/docs/tutorials/3_train_gail.ipynb)",
        fixed_cartpole, gail, "the demonstrator",
    ),
    "ppo-cartpole": Check(
        "PPO", "CartPole-v1", 490.04, "500,000 frames, 3 seeds", "200,000 frames", CLEANRL,
        cartpole, online("ppo", cartpole, 200_000, **PPO),
    ),
    "ppo-acrobot": Check(
        "PPO", "Acrobot-v1", -86.36, "500,000 frames, 3 seeds", "200,000 frames", CLEANRL,
        acrobot, online("ppo", acrobot, 200_000, **PPO),
    ),
}  # fmt: skip
PAGE = """# Independent checks

A baseline that is badly trained makes any method look good. So our learners, the very classes that learn the road, are
trained where others published figures: `bootcourse study checks --out DIR` makes this table again. *Reached* means that
the mean over the seeds is within 1 % of the published figure, or above it.

"""


def cells(seeds: int = 4) -> dict[str, dict]:
    """The checks, with so many agents each."""
    return {name: {"check": name, "seeds": seeds} for name in CHECKS}


def run_check(check: str, seeds: int) -> Results:
    """Train and test the agents of a check. Raises Interrupted.

    Measured, (agents,): return, and the mean return of each who drove the data, the same for all: data_0, data_1.
    """
    one = CHECKS[check]
    agents, returns = one.train(seeds)
    numbers = {"return": scores(agents, one.make_env)}
    numbers |= {f"data_{i}": np.full(seeds, value) for i, value in enumerate(returns)}
    entries = agent_entries([agent.settings for agent in agents], "none")
    return Results(entries, np.full(seeds, -1), measured=numbers)


def is_reached(returns: np.ndarray, check: Check) -> bool:
    """Is the mean of the agents' returns within 1 % of the published figure, or above it?"""
    return bool(returns.mean() >= check.published - CLOSE * abs(check.published))


def page(computed: Computed) -> str:
    """The checks that were computed as a page of Markdown: {check: its agents}."""
    rows = []
    for name, results in computed.items():
        check, returns = CHECKS[name], results.measured["return"]
        ours = f"{returns.mean():.1f} [{returns.min():.1f}, {returns.max():.1f}], {len(returns)} seeds"
        by = [f"{values[0]:.0f}" for measure, values in results.measured.items() if measure.startswith("data_")]
        ours += f" ({check.data}: {' and '.join(by)})" if by else ""
        budget = f"{check.our_budget}, {results.seconds.sum():.0f} s"
        verdict = "yes" if is_reached(returns, check) else "**no**"
        published = f"{check.published:g}", check.their_budget
        rows.append([check.learner, check.task, *published, ours, budget, verdict, check.source])
    headings = ["learner", "task", "published", "its budget", "ours, mean [worst, best]", "our budget", "reached"]
    return PAGE + markdown([*headings, "source"], rows)


EXPERIMENT = Experiment("checks", cells, results_of(run_check), page=page)

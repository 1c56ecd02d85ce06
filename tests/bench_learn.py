"""How fast the learner is: `python -m tests.bench learn`, or `make bench` for the road too.

Milliseconds per update of one agent, two hidden layers of 64 and batches of 64, on one thread: ours with 16 agents
side by side, the part of it that no implementation can leave out, and a plain loop of one agent. All take turns in one
run and each counts its best turn, so that the ratios hold on a busy machine too. Ours is judged by its ratio to the
matrix products. How much slower the plain loop is depends on what a call of torch costs on a machine, so that is
reported and not judged.
"""

import time
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import torch

from bootcourse.learn.compiled_learner import CompiledLearner
from bootcourse.learn.learner import SACLearner
from bootcourse.learn.networks import init_mlp, mlp
from bootcourse.learn.protocol import generators_of
from bootcourse.learn.replay_buffer import Batch, ReplayBuffer, encode_transitions
from bootcourse.learn.running import one_torch_thread
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.textbook import TextbookSAC
from bootcourse.learn.training import Training
from bootcourse.scenario import DEFAULT, N_ACTIONS
from tests.bench_road import Row

AGENTS = 16
MOST = 5.0  # times the matrix products alone: measured 3.4 to 3.6


def random_rows(n: int, rng: np.random.Generator, inputs: int = DEFAULT.observation_size) -> torch.Tensor:
    """Transitions of nowhere, (n, row): as good as real ones to measure with."""
    states, next_states = rng.normal(size=(2, n, inputs))
    actions, rule_actions, next_rule_actions = rng.integers(N_ACTIONS, size=(3, n))
    rewards, terminated = rng.normal(size=n), rng.random(n) < 0.1
    return encode_transitions(states, next_states, actions, rewards, terminated, rule_actions, next_rule_actions)


def ours(agents: int, make_learner: type = SACLearner) -> Callable[[], None]:
    """A learner's `update` on what `ReplayBuffer.sample` draws, for `agents` agents of the paper's method."""
    settings = with_seeds(settings_for("bootstrapped"), agents)
    rng, inputs = np.random.default_rng(0), DEFAULT.observation_size
    learner = make_learner(settings, inputs)
    replay = ReplayBuffer(agents, 2_000, inputs, random_rows(2_000, rng))
    replay.add(random_rows(agents * 2_000, rng).view(agents, 2_000, -1))
    beta, generators = np.full(agents, 0.6), [np.random.default_rng(s.seed) for s in settings]
    return lambda: learner.update(replay.sample(settings[0].batch, beta, generators))


def products(agents: int) -> Callable[[], None]:
    """The matrix products of one update and nothing else, each into a tensor that is there already.

    The actor computes twice, the two critics and their targets once. Then come the gradients of actor and critics in
    their weights and, but for the first layer, in its inputs.
    """
    settings, jobs = settings_for("bootstrapped"), []
    sizes = (DEFAULT.observation_size, *settings.hidden, N_ACTIONS)
    for networks in (agents, 2 * agents):
        for layer, (n_in, n_out) in enumerate(pairwise(sizes)):
            x, weight = torch.rand(networks, settings.batch, n_in), torch.rand(networks, n_in, n_out)
            y = torch.rand(networks, settings.batch, n_out)  # and its gradient
            jobs += 2 * [(x, weight, torch.empty_like(y))] + [(x.mT, y, torch.empty_like(weight))]
            jobs += [(y, weight.mT, torch.empty_like(x))] * (layer > 0)

    def multiply():
        for one, other, out in jobs:
            torch.bmm(one, other, out=out)

    return multiply


def networks(agents: int) -> Callable[[], None]:
    """The networks of one update with their biases, their ReLUs and torch's automatic gradients, without any loss."""
    settings, inputs = with_seeds(settings_for("bootstrapped"), agents), DEFAULT.observation_size
    sizes, batch = (inputs, *settings[0].hidden, N_ACTIONS), settings[0].batch
    each = [init_mlp(sizes, generators_of(two)) for two in (settings, 2 * settings)]
    inputs = [torch.rand(n, batch, inputs) for n in (agents, 2 * agents)]
    slopes = [torch.rand(n, batch, N_ACTIONS) for n in (agents, 2 * agents)]
    weights = [parameter.requires_grad_() for parameters in each for parameter in parameters]

    def forth_and_back():
        with torch.no_grad():
            for parameters, x in zip(each, inputs, strict=True):
                mlp(parameters, x)
        torch.autograd.grad([mlp(parameters, x) for parameters, x in zip(each, inputs, strict=True)], weights, slopes)

    return forth_and_back


def plain() -> Callable[[], None]:
    """The textbook's update on the same kind of batch, drawn by the same replay."""
    settings, rng, inputs = settings_for("bootstrapped"), np.random.default_rng(0), DEFAULT.observation_size
    replay = ReplayBuffer(1, 2_000, inputs, random_rows(2_000, rng))
    replay.add(random_rows(2_000, rng)[None])
    agent, beta, generators = TextbookSAC(settings, inputs), np.array([0.6]), [np.random.default_rng(0)]

    def update():
        batch = replay.sample(settings.batch, beta, generators)
        agent.update(Batch(*(column[0] for column in batch)))

    return update


def training(agents: int, learner: str) -> Callable[[], None]:
    """A step of a whole `Training`: a decision on every road, the update, and all that is recorded."""
    settings = with_seeds(settings_for("bootstrapped", learning_starts=0, demonstration_episodes=5), agents)
    return Training(settings, 100_000, learner=learner).step


def milliseconds(contestants: dict, turns: int, calls: int = 20) -> dict:
    """Processor time of one call of each, in ms: they take turns of `calls` calls, and each counts its best."""
    best = dict.fromkeys(contestants, np.inf)
    for turn in range(turns + 1):  # the first turn only warms up
        for name, call in contestants.items():
            started = time.thread_time()
            for _ in range(calls):
                call()
            if turn:
                best[name] = min(best[name], 1000 * (time.thread_time() - started) / calls)
    return best


def table(turns: int = 25) -> list[Row]:
    """Our update beside its parts and beside the plain loop."""
    contestants = {"ours": ours(AGENTS), "products": products(AGENTS), "networks": networks(AGENTS), "plain": plain()}
    contestants |= {"compiled": ours(AGENTS, CompiledLearner)}
    contestants |= {(n, learner): training(n, learner) for n in (1, AGENTS) for learner in ("torch", "compiled")}
    with one_torch_thread():
        best, unit = milliseconds(contestants, turns), "ms per agent-update"
    mine, least = best["ours"] / AGENTS, best["products"] / AGENTS
    return [
        Row(f"matrix products alone, {AGENTS} agents", least, unit),
        Row("with biases, ReLUs and gradients", best["networks"] / AGENTS, unit, best["networks"] / best["products"]),
        Row(f"batched learner, {AGENTS} agents", mine, unit, mine / least, most=MOST),
        Row(f"compiled learner, {AGENTS} agents", best["compiled"] / AGENTS, unit, best["compiled"] / best["products"]),
        Row("plain eager loop, 1 agent, beside ours", best["plain"], unit, best["plain"] / mine),
        *(
            Row(f"whole training, {n} agents, torch beside compiled", best[n, "torch"] / n, "ms per agent-step",
                best[n, "torch"] / best[n, "compiled"])
            for n in (1, AGENTS)
        ),
    ]  # fmt: skip

"""Ten agents of PPO alone, with another reward, after cloning, and with a smaller λ: trained, tested, kept with their
networks.

    bootcourse study second-trap --out DIR    # some minutes

One training depends on the processor's rounding; the lesson's text rests on the results that ship.
"""

from collections.abc import Callable, Mapping
from functools import cache, partial
from typing import NamedTuple

import numpy as np
import torch

from bootcourse.course.lessons.the_second_trap.second_trap import Repaid, left_of, shaped_pay
from bootcourse.course.lessons.your_teacher.taught_agents import alike
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.errors import BootcourseError
from bootcourse.learn import sac
from bootcourse.learn.agent import Agent
from bootcourse.learn.networks import mlp
from bootcourse.learn.settings import Settings, settings_for
from bootcourse.learn.teachers import course_rule
from bootcourse.learn.training import MOST_EPISODES, Training
from bootcourse.policies import Policy, idle_policy, rule_policy
from bootcourse.research.cells import results_of
from bootcourse.research.computed import experiment
from bootcourse.research.experiment import Experiment
from bootcourse.research.results import Results, agent_entries, weights_of
from bootcourse.scenario import DEFAULT

SEEDS, EVERY = 10, 50_000  # agents of each kind; decisions between two points of a curve
ROADS = held_out_seeds(14, 200)  # that every agent is tested on
QUICK = {"hidden": (32, 32), "actor_lr": 2e-3, "critic_lr": 2e-3, "epochs": 3}  # in place of the settings of `ppo`
GAMMA = settings_for("ppo").gamma
Driven = tuple[np.ndarray, np.ndarray]  # return, share of the roads ahead in the end: of each agent, (agents,)


class Kind(NamedTuple):
    """How the agents of a kind are trained."""

    method: str
    decisions: int
    make_env: Callable | None = None  # of roads that pay otherwise
    changes: Mapping[str, float] = {}  # of settings


KINDS = {
    "alone": Kind("ppo", 800_000),
    "shaped": Kind("ppo", 800_000, partial(Repaid, pay=shaped_pay(left_of, GAMMA))),
    "cloned": Kind("ppo_cloned", 300_000),
    "lambda-0.8": Kind("ppo", 800_000, changes={"gae_lambda": 0.8}),
    "lambda-0.5": Kind("ppo", 800_000, changes={"gae_lambda": 0.5}),
}


class Trained(NamedTuple):
    """One finished training: the agent, and how it did while it learned."""

    agent: Agent
    at: np.ndarray  # (points,) decisions
    returns: np.ndarray  # (points,) mean of the last 300 training episodes, as its road pays them
    escapes: np.ndarray  # (points,) share of these episodes
    kl: np.ndarray  # (points,) nats, see `diagnostics`
    clipped: np.ndarray  # (points,)
    explained: np.ndarray  # (points,)


def settings_of(kind: str, seed: int = 0) -> Settings:
    """The settings of an agent of a kind."""
    return settings_for(KINDS[kind].method, seed=seed, **QUICK, **KINDS[kind].changes)


def train(training: Training, decisions: int) -> Trained:
    """Train one agent for a number of decisions, and note its return and escapes every `EVERY` decisions."""
    notes = []

    def note(training: Training) -> None:
        if training.decisions // EVERY > len(notes):
            recent = (training.curves.recent(name, 300)[0] for name in ("return", "success"))
            notes.append([training.decisions, *recent, *diagnostics(training)])

    result = training.run(progress=False, callback=note, stop=lambda: training.decisions >= decisions)
    return Trained(result.agents[0], *np.array(notes).T)


@torch.no_grad()
def diagnostics(training: Training) -> tuple[float, float, float]:
    """(KL, clip fraction, explained variance) of the last round of updates of a training of one PPO agent.

    KL: of the policy before the round from the one after it, in nats, by the estimate E[r - 1 - log r]. Clip fraction:
    the share of decisions whose ratio r has left 1 ± ε. Explained variance: 1 - Var(R - V) / Var(R), R being what V
    should be: 1 for a perfect V, 0 for one that is the same everywhere. All NaN before the first round.
    """
    columns, learner = training.replay.columns, training.learner
    if columns is None:
        return (np.nan,) * 3
    log_pi = sac.log_policy(mlp(learner.actor, columns.states)).gather(-1, columns.actions[..., None])[..., 0]
    ratio = (log_pi - columns.log_pi).exp()
    outside = (ratio - 1).abs() > training.settings[0].clip
    explained = 1 - columns.advantages.var() / columns.returns.var()  # the advantage is R - V
    return float((ratio - 1 - ratio.log()).mean()), float(outside.float().mean()), float(explained)


def tested(agent: Agent) -> dict[str, float]:
    """Means of an agent's drives on `ROADS`: success, return (as the road of the course pays), accidents, likeness."""
    drives = drive_episodes(agent.as_policy(), ROADS)
    means = {"success": drives.success.mean(), "returns": drives.returns.mean()}
    return means | {"accident": np.mean(drives.accident > 0), "alike": alike([agent], course_rule)[0]}


def train_kind(kind: str, seeds: int = SEEDS) -> Results:
    """Train and test the agents of a kind, one after the other."""
    settings = [settings_of(kind, seed) for seed in range(seeds)]
    each = []
    for one in settings:
        training = Training([one], MOST_EPISODES, make_env=KINDS[kind].make_env)
        each.append(train(training, KINDS[kind].decisions))
    measures = [tested(one.agent) for one in each]
    return Results(
        agent_entries(settings),
        np.full(seeds, -1),
        notes={
            "curve" if name == "returns" else name: np.stack([getattr(one, name) for one in each])
            for name in Trained._fields[1:]
        },
        measured={name: np.array([one[name] for one in measures]) for name in measures[0]},
        weights=weights_of([one.agent for one in each], "actor"),
    )


EXPERIMENT = Experiment("second-trap", lambda: {kind: {"kind": kind} for kind in KINDS}, results_of(train_kind))


@cache
def shipped_kinds() -> dict[str, Results]:
    """{kind: its agents}, as they ship. Raises BootcourseError if a kind is missing."""
    kinds = experiment("second-trap")
    if missing := KINDS.keys() - kinds.keys():
        raise BootcourseError(f"No agents of {', '.join(missing)} ship: run `bootcourse study second-trap --out DIR`.")
    return kinds


def reference() -> dict[str, dict[str, np.ndarray]]:
    """{kind: what `tested` and `train` say of its agents}, as they ship, each (agents, ...)."""
    return {kind: results.measured | results.notes for kind, results in shipped_kinds().items()}


def driven(policy: Policy) -> tuple[float, float]:
    """Mean return on `ROADS`, and the share of them on which it ends ahead."""
    drives = drive_episodes(policy, ROADS)
    return drives.returns.mean(), drives.success.mean()


def compared(kinds: Mapping[str, str]) -> dict[str, Driven]:
    """{name: how they drive}: the rule, a car that keeps straight, and the agents that ship of {name: kind}."""
    alone = {"the rule": rule_policy(DEFAULT), "keeping straight": idle_policy}
    named = {name: tuple(map(np.atleast_1d, driven(policy))) for name, policy in alone.items()}
    measured = {name: shipped_kinds()[kind].measured for name, kind in kinds.items()}
    return named | {name: (each["returns"], each["success"]) for name, each in measured.items()}


def agent_of(kind: str, seed: int = 0) -> Agent:
    """One of the agents of a kind that ship."""
    return shipped_kinds()[kind].agent(seed)

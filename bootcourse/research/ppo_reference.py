"""Some PPO agents of each kind in the lesson on the second trap: trained, tested, kept in a file with their networks.

    python -m bootcourse.research.ppo_reference --out assets/ppo.npz    # some minutes; goes on after a stop

One training depends on the processor's rounding; the lesson's text rests on this file.
"""

import argparse
import json
import shutil
import sys
from collections.abc import Callable
from functools import cache, partial
from pathlib import Path
from typing import NamedTuple

import numpy as np
import torch

from bootcourse.course.lessons.the_second_trap.second_trap import Repaid, concave_pay, left_of, shaped_pay
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.errors import BootcourseError
from bootcourse.files import provenance, read_arrays, write_arrays
from bootcourse.learn.agent import Agent
from bootcourse.learn.settings import Settings, settings_for
from bootcourse.learn.teachers import course_rule
from bootcourse.learn.training import MOST_EPISODES, Training
from bootcourse.research.jobs import HELD_OUT
from bootcourse.research.teacher_reference import alike, grouped
from bootcourse.storage.assets import FOLDER

SEEDS, EVERY = 10, 50_000  # agents of each kind; decisions between two points of a curve
ROADS = held_out_seeds(14, 200)  # that every agent is tested on
STUDY_ROADS = held_out_seeds(HELD_OUT, 1000)  # those of the study, for the leaderboard
QUICK = {"hidden": (32, 32), "actor_lr": 2e-3, "critic_lr": 2e-3, "epochs": 3}  # in place of the settings of `ppo`
FILE = FOLDER / "ppo.npz"
COMMAND = "python -m bootcourse.research.ppo_reference --out assets/ppo.npz"


class Kind(NamedTuple):
    """How the agents of a kind are trained."""

    method: str
    decisions: int
    make_env: Callable | None = None  # of roads that pay otherwise
    paid: str = ""  # how these pay, behind the method's name


GAMMA = settings_for("ppo").gamma
KINDS = {
    "alone": Kind("ppo", 800_000),
    "shaped": Kind("ppo", 500_000, partial(Repaid, pay=shaped_pay(left_of, GAMMA)), ", shaping reward"),
    "concave": Kind("ppo", 800_000, partial(Repaid, pay=concave_pay), ", concave reward"),
    "cloned": Kind("ppo_cloned", 300_000),
}


class Trained(NamedTuple):
    """One finished training: the agent, and how it did while it learned."""

    agent: Agent
    at: np.ndarray  # (points,) decisions
    returns: np.ndarray  # (points,) mean of the last 300 training episodes, as its road pays them
    escapes: np.ndarray  # (points,) share of these episodes


def settings_of(kind: str, seed: int = 0) -> Settings:
    """The settings of an agent of a kind."""
    return settings_for(KINDS[kind].method, seed=seed, **QUICK)


def train(training: Training, decisions: int) -> Trained:
    """Train one agent for a number of decisions, and note its return and escapes every `EVERY` decisions."""
    notes = []

    def note(training: Training) -> None:
        if training.decisions // EVERY > len(notes):
            recent = (training.curves.recent(name, 300)[0] for name in ("return", "success"))
            notes.append([training.decisions, *recent])

    result = training.run(progress=False, callback=note, stop=lambda: training.decisions >= decisions)
    return Trained(result.agents[0], *np.array(notes).T)


def tested(agent: Agent) -> dict[str, np.ndarray]:
    """What is kept of an agent's drives on `ROADS`: success, return (as the road of the course pays), accidents."""
    drives = drive_episodes(agent.as_policy(), ROADS)
    found = {"success": drives.success.mean(), "returns": drives.returns.mean()}
    found |= {"accident": np.mean(drives.accident > 0), "alike": alike([agent], course_rule)[0]}
    return {name: np.array(value) for name, value in found.items()}


def compared(agent: Agent) -> dict[str, np.ndarray]:
    """What an agent does on every one of `STUDY_ROADS`: "study success", "study returns", "study accident" (roads,)."""
    drives = drive_episodes(agent.as_policy(), STUDY_ROADS)
    found = {"success": drives.success.astype(np.int8), "accident": drives.accident.astype(np.int8)}
    found["returns"] = drives.returns.astype(np.float32)
    return {f"study {name}": values for name, values in found.items()}


def made(kind: str, seed: int) -> dict[str, np.ndarray]:
    """Train and test one agent."""
    its = KINDS[kind]
    trained = train(Training([settings_of(kind, seed)], MOST_EPISODES, make_env=its.make_env), its.decisions)
    curves = {"at": trained.at, "curve": trained.returns, "escapes": trained.escapes}
    weights = {f"actor {i}": tensor[0].numpy() for i, tensor in enumerate(trained.agent.actor)}
    return tested(trained.agent) | compared(trained.agent) | curves | weights


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog=COMMAND.split(" --")[0], description=__doc__.split("\n")[0])
    parser.add_argument("--out", type=Path, default=FILE, help="the file to write (default: assets/ppo.npz)")
    parser.add_argument("--seeds", type=int, default=SEEDS, help=f"agents of each kind (default: {SEEDS})")
    options = parser.parse_args(arguments)
    finished, arrays = options.out.with_suffix(".unfinished"), {}
    for seed in range(options.seeds):
        for kind in KINDS:
            part = finished / f"{kind}-{seed}.npz"
            if not part.exists():
                print(f"{kind}, seed {seed} ...", flush=True)
                write_arrays(part, made(kind, seed))
    for kind in KINDS:
        each = [read_arrays(finished / f"{kind}-{seed}.npz") for seed in range(options.seeds)]
        arrays |= {f"{kind}/{name}": np.stack([one[name] for one in each]) for name in each[0]}
    about = provenance(command=COMMAND, seeds=options.seeds)
    write_arrays(options.out, arrays | {"provenance": np.array(json.dumps(about))})
    shutil.rmtree(finished)
    return 0


@cache
def reference(path: Path = FILE) -> dict[str, dict[str, np.ndarray]]:
    """{kind: what `main` kept of its agents, each (agents, ...)}. Raises BootcourseError if the file is damaged."""
    found = grouped(path)
    if not KINDS.keys() <= found.keys():
        raise BootcourseError(f"{path} does not hold the agents of all kinds: make it again with `{COMMAND}`.")
    return found


def agent_of(kind: str, seed: int = 0) -> Agent:
    """One of the agents of a kind that ship."""
    kept = reference()[kind]
    actor = [torch.from_numpy(kept[f"actor {i}"][seed])[None] for i in range(6)]
    return Agent(settings_of(kind, seed), actor, [], 0.0)


if __name__ == "__main__":
    try:
        sys.exit(main())
    except BootcourseError as error:
        sys.exit(str(error))

"""Ten students of each of lesson 14's teachers and ten agents that learn alone: trained, tested, kept in a file.

    python -m bootcourse.research.teacher_reference --out assets/students.npz    # some minutes

One training depends on the processor's rounding; the lesson's text rests on this file.
"""

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
import scipy

from bootcourse.course.lessons.your_teacher.example_teachers import careful, racer, reckless, timid
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.errors import BootcourseError
from bootcourse.files import provenance, read_arrays, write_arrays
from bootcourse.learn.agent import Agent
from bootcourse.learn.settings import Settings, settings_for, with_seeds
from bootcourse.learn.teachers import Rule, course_rule, teacher_of
from bootcourse.learn.training import Training
from bootcourse.storage.assets import FOLDER

SEEDS, UPDATES, EVERY = 10, 3500, 250  # students of each teacher; updates of each; updates between two notes
ROADS = held_out_seeds(13, 200)  # that every student is tested on
FILE = FOLDER / "students.npz"
COMMAND = "python -m bootcourse.research.teacher_reference --out assets/students.npz"


class TeacherJob(NamedTuple):
    """Agents that learn side by side from one teacher."""

    name: str
    teacher: Rule
    settings: list[Settings]


def teacher_jobs(seeds: int = SEEDS) -> list[TeacherJob]:
    """One job for each teacher, and one for agents that learn alone, as plain SAC."""
    taught = with_seeds(settings_for("bootstrapped"), seeds)
    teachers = {"the rule": course_rule} | {each.__name__: each for each in (careful, timid, reckless, racer)}
    alone = TeacherJob("alone", course_rule, with_seeds(settings_for("sac"), seeds))
    return [alone, *(TeacherJob(name, teacher, taught) for name, teacher in teachers.items())]


class Taught(NamedTuple):
    """A finished training: each agent's escapes while it learned, and what was left of the two helps at the end."""

    agents: list[Agent]
    updates: np.ndarray  # (points,)
    escapes: np.ndarray  # (agents, points) share of the last 30 training episodes
    beta: np.ndarray  # (agents,) share of demonstrations in a batch
    xi: np.ndarray  # (agents,) weight of the KL


def teach(teacher: Rule, settings: list[Settings], updates: int = UPDATES) -> Taught:
    """Train agents from a teacher for a number of updates, and note their escapes every `EVERY` updates."""
    training, notes = Training(settings, episodes=10**4, teacher=teacher), []

    def note(training: Training) -> None:
        if training.updates and training.updates % EVERY == 0:
            notes.append([training.updates, *training.curves.recent("success", 30)])

    result = training.run(progress=False, callback=note, stop=lambda: training.updates >= updates)
    table = np.array(notes)
    xi = np.array([agent.settings.xi_multiplier * agent.alpha for agent in result.agents])
    return Taught(result.agents, table[:, 0], table[:, 1:].T, training.beta, xi)


def tested(agents: list[Agent]) -> dict[str, np.ndarray]:
    """Each agent's share of escapes, by its most probable actions and by drawn ones; its return and accidents."""
    greedy = [drive_episodes(agent.as_policy(), ROADS) for agent in agents]
    drawn = [drive_episodes(agent.as_policy(np.random.default_rng(0)), ROADS) for agent in agents]
    return {
        "success": np.array([each.success.mean() for each in greedy]),
        "drawn": np.array([each.success.mean() for each in drawn]),
        "returns": np.array([each.returns.mean() for each in greedy]),
        "accident": np.array([np.mean(each.accident > 0) for each in greedy]),
    }


def alike(agents: list[Agent], teacher: Rule, roads: int = 4) -> np.ndarray:
    """The share of each agent's decisions, on its own drives, in which its teacher would do the same: (agents,)."""
    shares, ask = [], teacher_of(teacher)
    for agent in agents:
        drives = record(agent.as_policy(), ROADS[:roads])
        asked = ask(np.concatenate([drive.cars for drive in drives]))
        shares.append(np.mean(asked == np.concatenate([drive.actions for drive in drives])))
    return np.array(shares)


def p_value(taught: np.ndarray, alone: np.ndarray) -> float:
    """Mann and Whitney's two-sided p-value of the scores of two groups of agents, (m,) and (n,)."""
    return float(scipy.stats.mannwhitneyu(taught, alone).pvalue)


def holm(p: Sequence[float]) -> np.ndarray:
    """Holm's adjusted p-values (Holm 1979), in the order of p: (tests,) -> (tests,)."""
    order, m = np.argsort(p), len(p)
    scaled = np.asarray(p)[order] * (m - np.arange(m))
    adjusted = np.empty(m)
    adjusted[order] = np.minimum(np.maximum.accumulate(scaled), 1)
    return adjusted


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog=COMMAND.split(" --")[0], description=__doc__.split("\n")[0])
    parser.add_argument("--out", type=Path, default=FILE, help="the file to write (default: assets/students.npz)")
    parser.add_argument("--updates", type=int, default=UPDATES, help=f"of each agent (default: {UPDATES})")
    options = parser.parse_args(arguments)
    arrays = {}
    for job in teacher_jobs():
        print(f"{job.name} ...", flush=True)
        taught = teach(job.teacher, job.settings, options.updates)
        found = tested(taught.agents) | taught._asdict() | {"alike": alike(taught.agents, job.teacher)}
        arrays |= {f"{job.name}/{name}": values for name, values in found.items() if name != "agents"}
    made = provenance(command=COMMAND, updates=options.updates, seeds=SEEDS)
    write_arrays(options.out, arrays | {"provenance": np.array(json.dumps(made))})
    return 0


def reference(path: Path = FILE) -> dict[str, dict[str, np.ndarray]]:
    """{teacher or "alone": what `main` kept of its ten students}. Raises BootcourseError if the file is damaged."""
    found = grouped(path)
    if set(found) != {job.name for job in teacher_jobs(1)}:
        raise BootcourseError(f"{path} does not hold the students of all teachers: make it again with `{COMMAND}`.")
    return found


def grouped(path: Path) -> dict[str, dict[str, np.ndarray]]:
    """The arrays GROUP/NAME of a file: {group: {name: array}}."""
    found = {}
    for name, values in read_arrays(path).items():
        group, _, what = name.partition("/")
        if what:
            found.setdefault(group, {})[what] = values
    return found


if __name__ == "__main__":
    try:
        sys.exit(main())
    except BootcourseError as error:
        sys.exit(str(error))

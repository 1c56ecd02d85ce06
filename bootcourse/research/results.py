"""Results: the scores, curves and weights of some agents, and their files.

A file of results holds `agents` and `stopped`, and arrays named PART.NAME: see the fields of `Results`.
"""

import json
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, field, fields, replace
from pathlib import Path
from typing import Any

import numpy as np
import torch

from bootcourse.episodes.evaluate import Episodes
from bootcourse.errors import BootcourseError, check_known
from bootcourse.files import check_arrays, decoding, parse, read_arrays, read_json, write_arrays
from bootcourse.learn.agent import Agent
from bootcourse.learn.settings import Settings, stored_settings
from bootcourse.methods import METHODS
from bootcourse.research.jobs import Description
from bootcourse.research.teachers import RULE
from bootcourse.road.state import Accident
from bootcourse.statistics import ESCAPES, found

MEASURES = ("success", "returns", "speed", "distance", "collision", "road_departure", "stoppage")
RUN_AGAIN = "run the study again, or restore it from a copy"
KINDS = {"collision": Accident.COLLISION, "road_departure": Accident.ROAD_DEPARTURE, "stoppage": Accident.STOPPAGE}
OF_AGENTS = ("tested", "curves", "notes", "measured")  # the parts with every agent; weights are kept of the first ones
PARTS = (*OF_AGENTS, "weights")


@dataclass(frozen=True)
class Results:
    """Some agents. The arrays of every dictionary have the agents first, in the order of `agents`."""

    agents: list[dict]  # each agent's settings, and the name of its teacher
    stopped: np.ndarray  # (agents,) the decision at which the loss was not a number, or -1
    tested: dict[str, np.ndarray] = field(default_factory=dict)  # the fields of `Episodes`: (agents, held-out episodes)
    curves: dict[str, np.ndarray] = field(default_factory=dict)  # success, return ...: (agents, training episodes)
    seconds: np.ndarray | None = None  # (agents,) of one core, training and test; NaN where they are not known
    notes: dict[str, np.ndarray] = field(default_factory=dict)  # of a lesson, taken in training: (agents, points, ...)
    measured: dict[str, np.ndarray] = field(default_factory=dict)  # of a lesson, of trained agents: (agents,)
    weights: dict[str, np.ndarray] = field(default_factory=dict)  # of the first agents, see `weights_of` and `agent`

    def __post_init__(self):
        if self.seconds is None:
            object.__setattr__(self, "seconds", np.full(len(self.agents), np.nan))

    def __len__(self) -> int:
        return len(self.agents)

    def pick(self, which: Iterable[int]) -> "Results":
        """Some of the agents, without their weights."""
        which = list(which)
        parts = {part: {name: each[which] for name, each in getattr(self, part).items()} for part in OF_AGENTS}
        return Results([self.agents[i] for i in which], self.stopped[which], **parts, seconds=self.seconds[which])

    def of(self, method: str) -> "Results":
        """The agents of a method, by seed."""
        which = [i for i, agent in enumerate(self.agents) if agent["method"] == method]
        return self.pick(sorted(which, key=lambda i: self.agents[i]["seed"]))

    @property
    def sizes(self) -> tuple[int, int]:
        """(held-out episodes, training episodes) of each agent."""
        return tuple(next(iter(part.values())).shape[1] if part else 0 for part in (self.tested, self.curves))

    @property
    def methods(self) -> list[str]:
        return list(dict.fromkeys(agent["method"] for agent in self.agents))

    def scores(self, measure: str) -> np.ndarray:
        """Each agent's mean of one of `MEASURES` over its held-out episodes, (agents,)."""
        return self.episodes(measure).mean(axis=1)

    def escapers(self, method: str) -> int:
        """How many agents of a method escape: they succeed on at least `ESCAPES` of their held-out roads."""
        return int((self.of(method).scores("success") >= ESCAPES).sum())

    def found_and_kept(self, method: str) -> tuple[np.ndarray, np.ndarray]:
        """Which agents of a method found the way out, and which of these kept it, each (agents,) bool.

        Found: see `statistics.found`. Kept: after training the agent escapes, see `escapers`.
        """
        agents = self.of(method)
        way_out = found(agents.curves["success"])
        return way_out, way_out & (agents.scores("success") >= ESCAPES)

    def agent(self, which: int = 0) -> Agent:
        """An agent whose weights were kept, `alpha` as it was measured. Raises BootcourseError for another."""
        kept = len(self.weights.get("actor.0", ()))
        if not 0 <= which < kept:
            raise BootcourseError(f"Of agent {which} no weights were kept: there are those of {kept} agents.")
        networks: dict[str, list[torch.Tensor]] = {"actor": [], "critics": []}
        for name, layers in self.weights.items():  # (agents kept · networks of each, inputs, outputs)
            part = len(layers) // kept
            networks[name.partition(".")[0]].append(torch.from_numpy(layers[which * part : (which + 1) * part]))
        settings = {name: value for name, value in self.agents[which].items() if name != "teacher"}
        alpha = self.measured["alpha"][which] if "alpha" in self.measured else 0.0
        return Agent(stored_settings(settings), **networks, alpha=float(alpha))

    def episodes(self, measure: str) -> np.ndarray:
        """A measure in every held-out episode, (agents, episodes); an event is 1 where it happened, else 0.

        measure: one of `MEASURES`, or "accident" for one of any kind. Raises BootcourseError for another name.
        """
        check_known("Measure", measure, (*MEASURES, "accident"))
        if measure == "accident":
            accident = self.tested["accident"]
            values = np.where(np.isnan(accident), np.nan, accident != Accident.NONE)
        else:
            values = self.tested["accident"] == KINDS[measure] if measure in KINDS else self.tested[measure]
        return values.astype(np.float64)


def join(parts: Sequence[Results]) -> Results:
    """One `Results` of several, without weights. Raises BootcourseError if their episodes differ in number."""
    if not parts:
        raise BootcourseError("There are no results yet: run `bootcourse study --out DIR`.")

    def together(part: str) -> dict[str, np.ndarray]:
        arrays = [getattr(each, part) for each in parts]
        return {name: np.concatenate([each[name] for each in arrays]) for name in arrays[0]}

    try:
        joined = {part: together(part) for part in OF_AGENTS}
    except ValueError:
        raise BootcourseError("These results have different numbers of episodes: they cannot be joined.") from None
    stopped, seconds = (np.concatenate([getattr(part, name) for part in parts]) for name in ("stopped", "seconds"))
    return Results([agent for part in parts for agent in part.agents], stopped, **joined, seconds=seconds)


def agent_entries(settings: Sequence[Settings], teacher: str = RULE) -> list[dict]:
    """`Results.agents` of agents with these settings and this teacher."""
    return [asdict(one) | {"teacher": teacher} for one in settings]


def weights_of(agents: Sequence[Agent], *parts: str) -> dict[str, np.ndarray]:
    """`Results.weights` of agents with the same shapes. parts: of "actor" and "critics"."""
    layers = {part: zip(*(getattr(agent, part) for agent in agents), strict=True) for part in parts}
    return {f"{part}.{i}": np.concatenate(each) for part in parts for i, each in enumerate(layers[part])}


def as_arrays(results: Results) -> dict[str, np.ndarray]:
    """The arrays of a file of results."""
    arrays = {"agents": np.array(json.dumps(results.agents)), "stopped": results.stopped, "seconds": results.seconds}
    return arrays | {f"{part}.{name}": each for part in PARTS for name, each in getattr(results, part).items()}


def save_results(results: Results, path: Path, provenance: dict) -> None:
    """Write everything to one `.npz`."""
    write_arrays(path, as_arrays(results) | {"provenance": np.array(json.dumps(provenance))})


def load_results(path: Path) -> Results:
    """Read a job's `results.npz` or what `save_results` wrote. Raises BootcourseError naming the file."""
    arrays = read_arrays(path, RUN_AGAIN)
    if not {"agents", "stopped"} <= arrays.keys():
        raise BootcourseError(f"{path} does not hold a study's results: {RUN_AGAIN}.")
    arrays.pop("provenance", None)
    agents = _agents(str(arrays.pop("agents")), path)
    parts = {part: _part(arrays, part) for part in PARTS}
    check_arrays(arrays, _shapes(arrays, parts, len(agents)), path, RUN_AGAIN)
    return Results(agents, arrays["stopped"], **parts, seconds=arrays.get("seconds"))


def _agents(text: str, path: Path) -> list[dict]:
    """`Results.agents` of a file; those of our methods are checked as settings of this version.

    The rule and learners of other libraries (`experiments/others.py`) have no such settings.
    """
    agents = []
    with decoding(path, RUN_AGAIN):
        for agent in parse(text, list[dict[str, Any]], path, RUN_AGAIN):
            teacher = str(agent.pop("teacher"))
            ours = agent.get("method") in METHODS
            agents += agent_entries([stored_settings(agent)], teacher) if ours else [agent | {"teacher": teacher}]
    return agents


def _shapes(arrays: dict[str, np.ndarray], parts: dict[str, dict[str, np.ndarray]], n: int) -> dict[str, tuple]:
    """The shapes that the arrays of a file with n agents must have; within a part the first array tells the length."""
    shapes: dict[str, tuple] = {name: (n,) for name in ("stopped", "seconds") if name in arrays}
    tests = [each.shape[1:2] for each in parts["tested"].values()][:1]
    shapes |= {f"tested.{f.name}": (n, *tests[0]) for f in fields(Episodes)} if tests else {}
    for part in ("curves", "notes"):
        points = [each.shape[1:2] for each in parts[part].values()][:1]
        more = {name: each.shape[2:] if part == "notes" else () for name, each in parts[part].items()}
        shapes |= {f"{part}.{name}": (n, *points[0], *rest) for name, rest in more.items()}
    shapes |= {f"measured.{name}": (n,) for name in parts["measured"]}
    return shapes | {f"weights.{name}": each.shape for name, each in parts["weights"].items()}


def _part(arrays: dict[str, np.ndarray], part: str) -> dict[str, np.ndarray]:
    """The arrays PART.NAME by NAME, float32 instead of the float16 of a file."""
    named = {name.removeprefix(f"{part}."): each for name, each in arrays.items() if name.startswith(f"{part}.")}
    return {name: each.astype(np.float32) if each.dtype == np.float16 else each for name, each in named.items()}


def load_job(folder: Path) -> Results:
    """The agents of a finished job, with its seconds shared among them. Raises BootcourseError naming the file."""
    results = load_results(folder / "results.npz")
    seconds = read_json(folder / "job.json", Description, RUN_AGAIN).provenance.seconds
    return replace(results, seconds=np.full(len(results), seconds / len(results)))


def load_jobs(root: Path, part: str) -> Results:
    """All agents of the finished jobs in root/jobs/part, such as "default".

    A study that was begun with fewer seeds leaves jobs that the larger ones hold again: each agent counts once.
    """
    everyone = join([load_job(path.parent) for path in sorted((Path(root) / "jobs" / part).glob("*/results.npz"))])
    once = {json.dumps(agent, sort_keys=True): i for i, agent in enumerate(everyone.agents)}
    return everyone.pick(sorted(once.values()))

"""What a study found: the scores and curves of every agent, read from its cells or from one shipped file."""

import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bootcourse.errors import BootcourseError
from bootcourse.record.files import read_arrays, write_arrays
from bootcourse.road.state import Accident

MEASURES = ("success", "returns", "speed", "distance", "collision", "road_departure", "stoppage")
KINDS = {"collision": Accident.COLLISION, "road_departure": Accident.ROAD_DEPARTURE, "stoppage": Accident.STOPPAGE}


@dataclass(frozen=True)
class Results:
    """Some agents. The arrays of every dictionary have the agents first, in the order of `agents`."""

    agents: list[dict]  # each agent's settings
    stopped: np.ndarray  # (agents,) the decision at which the loss was not a number, or -1
    tested: dict[str, np.ndarray]  # success, returns, speed, distance, accident: (agents, held-out episodes)
    curves: dict[str, np.ndarray]  # success, return, entropy ...: (agents, training episodes)

    def __len__(self) -> int:
        return len(self.agents)

    def pick(self, which: Iterable[int]) -> "Results":
        """Some of the agents."""
        which = list(which)
        tested = {name: values[which] for name, values in self.tested.items()}
        curves = {name: values[which] for name, values in self.curves.items()}
        return Results([self.agents[i] for i in which], self.stopped[which], tested, curves)

    def of(self, method: str) -> "Results":
        """The agents of a method, by seed."""
        mine = [i for i, agent in enumerate(self.agents) if agent["method"] == method]
        return self.pick(sorted(mine, key=lambda i: self.agents[i]["seed"]))

    @property
    def methods(self) -> list[str]:
        return list(dict.fromkeys(agent["method"] for agent in self.agents))

    def scores(self, measure: str) -> np.ndarray:
        """Each agent's mean of one of `MEASURES` over its held-out episodes, (agents,)."""
        return self.episodes(measure).mean(axis=1)

    def episodes(self, measure: str) -> np.ndarray:
        """One of `MEASURES` in every held-out episode, (agents, episodes); what happens or not is 0 or 1."""
        values = self.tested["accident"] == KINDS[measure] if measure in KINDS else self.tested[measure]
        return values.astype(np.float64)


def join(parts: Sequence[Results]) -> Results:
    """One `Results` of several. Raises BootcourseError if their episodes differ in number."""
    if not parts:
        raise BootcourseError("There are no results yet: run `bootcourse study --out DIR`.")
    try:
        tested = {name: np.concatenate([part.tested[name] for part in parts]) for name in parts[0].tested}
        curves = {name: np.concatenate([part.curves[name] for part in parts]) for name in parts[0].curves}
    except ValueError:
        raise BootcourseError("These results have different numbers of episodes: they cannot be joined.") from None
    agents = [agent for part in parts for agent in part.agents]
    return Results(agents, np.concatenate([part.stopped for part in parts]), tested, curves)


def save_results(results: Results, path: Path, provenance: dict) -> None:
    """Write everything to one `.npz`."""
    write_arrays(
        path,
        {
            "agents": np.array(json.dumps(results.agents)),
            "provenance": np.array(json.dumps(provenance)),
            "stopped": results.stopped,
            **{f"tested.{name}": values for name, values in results.tested.items()},
            **{f"curves.{name}": values for name, values in results.curves.items()},
        },
    )


def load_results(path: Path) -> Results:
    """Read a cell's `results.npz` or what `save_results` wrote. Raises BootcourseError naming the file."""
    arrays = read_arrays(path)
    try:
        agents, stopped = json.loads(str(arrays["agents"])), arrays["stopped"]
        parts = {kind: _of_kind(arrays, kind, len(agents)) for kind in ("tested", "curves")}
        return Results(agents, stopped, **parts)
    except (KeyError, ValueError):
        raise BootcourseError(f"{path} does not hold a study's results: run the study again.") from None


def _of_kind(arrays: dict, kind: str, agents: int) -> dict[str, np.ndarray]:
    found = {name.removeprefix(f"{kind}."): values for name, values in arrays.items() if name.startswith(f"{kind}.")}
    if not found or any(len(values) != agents for values in found.values()):
        raise ValueError(kind)
    return {name: values.astype(np.float32) if values.dtype == np.float16 else values for name, values in found.items()}


def load_cells(root: Path, part: str) -> Results:
    """All agents of the finished cells in root/cells/part, such as "default" or "sweep".

    A study that was begun with fewer seeds leaves cells that the larger ones hold again: each agent counts once.
    """
    found = join([load_results(path) for path in sorted((Path(root) / "cells" / part).glob("*/results.npz"))])
    once = {json.dumps(agent, sort_keys=True): i for i, agent in enumerate(found.agents)}
    return found.pick(sorted(once.values()))

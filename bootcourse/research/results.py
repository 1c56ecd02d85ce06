"""What a study found: the scores and curves of every agent, the planner's bound, the experiments.

Read from the jobs of a study's folder, or from what ships.
"""

import json
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, field, fields, replace
from pathlib import Path
from typing import Any

import numpy as np

from bootcourse.episodes.evaluate import Episodes
from bootcourse.errors import BootcourseError
from bootcourse.files import check_arrays, decoding, parse, read_arrays, read_json, write_arrays
from bootcourse.learn.curves import NAMES
from bootcourse.learn.settings import stored_settings
from bootcourse.research.jobs import Made
from bootcourse.research.plan import EXPERIMENTS, STUDIES, folder
from bootcourse.research.planner import Staying
from bootcourse.research.teachers import RULE
from bootcourse.road.state import Accident
from bootcourse.statistics import ESCAPES
from bootcourse.storage.assets import FOLDER

MEASURES = ("success", "returns", "speed", "distance", "collision", "road_departure", "stoppage")
IN_STUDY, IN_ASSETS = "/results.npz", ".npz"  # after a variation's folder or name
RUN_AGAIN = "run the study again, or restore it from a copy"
KINDS = {"collision": Accident.COLLISION, "road_departure": Accident.ROAD_DEPARTURE, "stoppage": Accident.STOPPAGE}


@dataclass(frozen=True)
class Results:
    """Some agents. The arrays of every dictionary have the agents first, in the order of `agents`."""

    agents: list[dict]  # each agent's settings, and the name of its teacher
    stopped: np.ndarray  # (agents,) the decision at which the loss was not a number, or -1
    tested: dict[str, np.ndarray]  # success, returns, speed, distance, accident: (agents, held-out episodes)
    curves: dict[str, np.ndarray]  # success, return, entropy ...: (agents, training episodes)
    seconds: np.ndarray | None = None  # (agents,) of one core, training and test; NaN where no file tells

    def __post_init__(self):
        if self.seconds is None:
            object.__setattr__(self, "seconds", np.full(len(self.agents), np.nan))

    def __len__(self) -> int:
        return len(self.agents)

    def pick(self, which: Iterable[int]) -> "Results":
        """Some of the agents."""
        which = list(which)
        tested = {name: values[which] for name, values in self.tested.items()}
        curves = {name: values[which] for name, values in self.curves.items()}
        return Results([self.agents[i] for i in which], self.stopped[which], tested, curves, self.seconds[which])

    def of(self, method: str) -> "Results":
        """The agents of a method, by seed."""
        mine = [i for i, agent in enumerate(self.agents) if agent["method"] == method]
        return self.pick(sorted(mine, key=lambda i: self.agents[i]["seed"]))

    @property
    def sizes(self) -> tuple[int, int]:
        """(held-out episodes, training episodes) of each agent."""
        return self.tested["returns"].shape[1], next(iter(self.curves.values())).shape[1]

    @property
    def methods(self) -> list[str]:
        return list(dict.fromkeys(agent["method"] for agent in self.agents))

    def scores(self, measure: str) -> np.ndarray:
        """Each agent's mean of one of `MEASURES` over its held-out episodes, (agents,)."""
        return self.episodes(measure).mean(axis=1)

    def escapers(self, method: str) -> int:
        """How many agents of a method escape."""
        return int((self.of(method).scores("success") >= ESCAPES).sum())

    def episodes(self, measure: str) -> np.ndarray:
        """A measure in every held-out episode, (agents, episodes); an event is 1 where it happened, else 0.

        measure: one of `MEASURES`, or "accident" for one of any kind.
        """
        if measure == "accident":
            values = self.tested["accident"] != Accident.NONE
        else:
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
    stopped, seconds = (np.concatenate([getattr(part, name) for part in parts]) for name in ("stopped", "seconds"))
    return Results(agents, stopped, tested, curves, seconds)


def save_results(results: Results, path: Path, provenance: dict) -> None:
    """Write everything to one `.npz`."""
    write_arrays(
        path,
        {
            "agents": np.array(json.dumps(results.agents)),
            "provenance": np.array(json.dumps(provenance)),
            "stopped": results.stopped,
            "seconds": results.seconds,
            **{f"tested.{name}": values for name, values in results.tested.items()},
            **{f"curves.{name}": values for name, values in results.curves.items()},
        },
    )


def load_results(path: Path) -> Results:
    """Read a job's `results.npz` or what `save_results` wrote. Raises BootcourseError naming the file."""
    arrays = read_arrays(path, RUN_AGAIN)
    drawn = [values for name, values in arrays.items() if name.startswith("curves.")]
    if not ({"agents", "stopped", "tested.returns"} <= arrays.keys() and drawn):
        raise BootcourseError(f"{path} does not hold a study's results: {RUN_AGAIN}.")
    arrays.pop("provenance", None)
    with decoding(path, RUN_AGAIN):
        stored = parse(str(arrays.pop("agents")), list[dict[str, Any]], path, RUN_AGAIN)
        teachers = [agent.pop("teacher", RULE) for agent in stored]  # files of earlier versions do not say
        agents = [asdict(stored_settings(a)) | {"teacher": name} for a, name in zip(stored, teachers, strict=True)]
        tests, episodes = arrays["tested.returns"].shape[1], drawn[0].shape[1]
    tested = {f"tested.{f.name}": (len(agents), tests) for f in fields(Episodes)}
    curves = {f"curves.{name}": (len(agents), episodes) for name in NAMES if f"curves.{name}" in arrays}
    each = {name: (len(agents),) for name in ("stopped", "seconds") if name in arrays}
    check_arrays(arrays, each | tested | curves, path, RUN_AGAIN)
    return Results(agents, arrays["stopped"], _named(arrays, tested), _named(arrays, curves), arrays.get("seconds"))


def _named(arrays: dict[str, np.ndarray], names: Iterable[str]) -> dict[str, np.ndarray]:
    """The arrays KIND.NAME by NAME, float32 instead of the float16 of a file."""
    found = {name.partition(".")[2]: arrays[name] for name in names}
    return {name: values.astype(np.float32) if values.dtype == np.float16 else values for name, values in found.items()}


def load_job(folder: Path) -> Results:
    """The agents of a finished job, with its seconds shared among them. Raises BootcourseError naming the file."""
    found = load_results(folder / "results.npz")
    seconds = read_json(folder / "job.json", Made, RUN_AGAIN).provenance.seconds
    return replace(found, seconds=np.full(len(found), seconds / len(found)))


def load_jobs(root: Path, part: str) -> Results:
    """All agents of the finished jobs in root/jobs/part, such as "default" or "sweep".

    A study that was begun with fewer seeds leaves jobs that the larger ones hold again: each agent counts once.
    """
    found = join([load_job(path.parent) for path in sorted((Path(root) / "jobs" / part).glob("*/results.npz"))])
    once = {json.dumps(agent, sort_keys=True): i for i, agent in enumerate(found.agents)}
    return found.pick(sorted(once.values()))


@dataclass(frozen=True)
class StudyResults:
    """Everything is by name, and absent if it was not computed."""

    results: dict[str, Results]  # {study: every method's agents}, see plan.STUDIES
    bound: dict[str, np.ndarray] = field(default_factory=dict)  # {scenario: best known return of each episode (tests,)}
    staying: dict[str, dict] = field(default_factory=dict)  # {scenario: the fields of planner.Staying}
    experiments: dict[str, dict[str, Results]] = field(default_factory=dict)  # {experiment: {variation: agents}}


def in_study(root: Path) -> StudyResults:
    """What the finished jobs of a study's folder hold."""
    root = Path(root)
    results = {name: load_jobs(root, name) for name in STUDIES if list(root.glob(f"jobs/{name}/*/results.npz"))}
    bounds = {name: _bound(root, name, found.sizes[0]) for name, found in results.items()}
    staying = {name: root / f"jobs/staying-{name}/gamma-0.8/staying.json" for name in results}
    return StudyResults(
        results,
        {name: bound for name, bound in bounds.items() if bound is not None},
        {name: vars(read_json(path, Staying, RUN_AGAIN)) for name, path in staying.items() if path.exists()},
        {name: _experiment(root / "jobs", name, IN_STUDY) for name in EXPERIMENTS},
    )


def in_assets(root: Path) -> StudyResults:
    """The results in an assets folder: what ships, or what is prepared for shipping."""
    root = Path(root)
    bounds = {name: root / f"bound-{name}.npz" for name in STUDIES}
    staying = {name: root / f"staying-{name}.json" for name in STUDIES}
    studies = {name: root / f"study-{name}.npz" for name in STUDIES}
    return StudyResults(
        {name: load_results(path) for name, path in studies.items() if path.exists()},
        {name: load_bound(path) for name, path in bounds.items() if path.exists()},
        {name: vars(read_json(path, Staying, RUN_AGAIN)) for name, path in staying.items() if path.exists()},
        {name: _experiment(root, name, IN_ASSETS) for name in EXPERIMENTS},
    )


def experiment(name: str, study: Path | str = "") -> dict[str, Results]:
    """The variations of one experiment that were computed: in a study's folder, by default those that ship."""
    return _experiment(Path(study) / "jobs", name, IN_STUDY) if study else _experiment(FOLDER, name, IN_ASSETS)


def _experiment(root: Path, name: str, ending: str) -> dict[str, Results]:
    """The variations that were computed, root/EXPERIMENT/VARIATION + ending."""
    paths = {variation: root / name / f"{folder(variation)}{ending}" for variation in EXPERIMENTS[name].variations}
    return {variation: load_results(path) for variation, path in paths.items() if path.exists()}


def load_bound(path: Path) -> np.ndarray:
    """The best return that the planner found on each held-out road of a study, (episodes,)."""
    return _returns(path)["returns"]


def _bound(root: Path, name: str, tests: int) -> np.ndarray | None:
    """The planner's return on each episode; None until all of them are computed."""
    jobs = [_returns(path, "first", "success") for path in root.glob(f"jobs/bound-{name}/*/results.npz")]
    found = {int(job["first"]) + i: value for job in jobs for i, value in enumerate(job["returns"])}
    return np.array([found[i] for i in range(tests)]) if set(range(tests)) <= set(found) else None


def _returns(path: Path, *others: str) -> dict[str, np.ndarray]:
    """The planner's returns (episodes,) in a file, and its other arrays."""
    arrays = read_arrays(path, RUN_AGAIN)
    n = arrays["returns"].shape[:1] if "returns" in arrays else ()
    shapes = {"returns": n, "success": n, "first": ()}
    check_arrays(arrays, {name: shapes[name] for name in ("returns", *others)}, path, RUN_AGAIN)
    return arrays

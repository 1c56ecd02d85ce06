"""What was computed: the agents of the studies and experiments, and the planner's bound.

Read from the jobs of a study's folder, or from what ships.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from bootcourse.files import check_arrays, read_arrays, read_json
from bootcourse.research.experiment import EXPERIMENTS, experiment_named, folder
from bootcourse.research.planner import Staying
from bootcourse.research.results import RUN_AGAIN, Results, load_job, load_jobs, load_results
from bootcourse.research.studies import STUDIES
from bootcourse.storage.assets import FOLDER


@dataclass(frozen=True, eq=False)
class StudyResults:
    """Everything is by name, and absent if it was not computed."""

    results: dict[str, Results]  # {study: every method's agents}, see studies.STUDIES
    bound: dict[str, np.ndarray] = field(default_factory=dict)  # {scenario: best known return of each episode (tests,)}
    staying: dict[str, dict] = field(default_factory=dict)  # {scenario: the fields of planner.Staying}
    experiments: dict[str, dict[str, Results]] = field(default_factory=dict)  # {experiment: {cell: agents}}


def in_study(root: Path) -> StudyResults:
    """What the finished jobs of a study's folder hold."""
    jobs = Path(root) / "jobs"
    results = {name: load_jobs(root, name) for name in STUDIES if list(jobs.glob(f"{name}/*/results.npz"))}
    bounds = {name: _bound(jobs / f"bound-{name}", each.sizes[0]) for name, each in results.items()}
    return StudyResults(
        results,
        {name: bound for name, bound in bounds.items() if bound is not None},
        _staying({name: jobs / f"staying-{name}/gamma-0.8/staying.json" for name in results}),
        {name: experiment(name, root) for name in EXPERIMENTS if experiment_named(name).reported},
    )


def in_assets(root: Path) -> StudyResults:
    """The results in an assets folder: what ships, or what is prepared for shipping."""
    root = Path(root)
    studies, bounds = ({name: root / f"{kind}-{name}.npz" for name in STUDIES} for kind in ("study", "bound"))
    return StudyResults(
        {name: load_results(path) for name, path in studies.items() if path.exists()},
        {name: load_bound(path) for name, path in bounds.items() if path.exists()},
        _staying({name: root / f"staying-{name}.json" for name in STUDIES}),
        {name: _cells(name, load_results, root, ".npz") for name in EXPERIMENTS if experiment_named(name).reported},
    )


def experiment(name: str, study: Path | str = "") -> dict[str, Results]:
    """The cells of one experiment that were computed: in a study's folder, by default those that ship."""
    if study:
        return _cells(name, load_job, Path(study) / "jobs", "")
    return _cells(name, load_results, FOLDER, ".npz")


def _cells(name: str, load: Callable[[Path], Results], root: Path, ending: str) -> dict[str, Results]:
    """The cells that were computed, root/EXPERIMENT/CELL + ending."""
    paths = {cell: root / name / f"{folder(cell)}{ending}" for cell in experiment_named(name).cells()}
    return {cell: load(path) for cell, path in paths.items() if path.exists()}


def _staying(paths: dict[str, Path]) -> dict[str, dict]:
    return {name: vars(read_json(path, Staying, RUN_AGAIN)) for name, path in paths.items() if path.exists()}


def load_bound(path: Path) -> np.ndarray:
    """The best return that the planner found on each held-out road of a study, (episodes,)."""
    return _returns(path)["returns"]


def _bound(folder: Path, tests: int) -> np.ndarray | None:
    """The planner's return on each episode; None until all of them are computed."""
    jobs = [_returns(path, "first", "success") for path in folder.glob("*/results.npz")]
    of_road = {int(job["first"]) + i: value for job in jobs for i, value in enumerate(job["returns"])}
    return np.array([of_road[i] for i in range(tests)]) if set(range(tests)) <= set(of_road) else None


def _returns(path: Path, *others: str) -> dict[str, np.ndarray]:
    """The planner's returns (episodes,) in a file, and its other arrays."""
    arrays = read_arrays(path, RUN_AGAIN)
    n = arrays["returns"].shape[:1] if "returns" in arrays else ()
    shapes = {"returns": n, "success": n, "first": ()}
    check_arrays(arrays, {name: shapes[name] for name in ("returns", *others)}, path, RUN_AGAIN)
    return arrays

"""All that a study found, in one object: read from its folder, or from what ships. The report is made from it."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from bootcourse.record.files import read_arrays, read_json
from bootcourse.scenario import SCENARIOS
from bootcourse.study.plan import folder, variations
from bootcourse.study.results import Results, load_cells, load_results


@dataclass(frozen=True)
class Found:
    """Everything is by the scenario's or the variation's name, and absent if it was not computed."""

    results: dict[str, Results]  # every method's agents
    bound: dict[str, np.ndarray] = field(default_factory=dict)  # best known return of each held-out episode (tests,)
    staying: dict[str, dict] = field(default_factory=dict)  # the fields of planner.Staying
    sensitivity: dict[str, Results] = field(default_factory=dict)


def in_study(root: Path) -> Found:
    """What the finished cells of a study's folder hold."""
    root = Path(root)
    results = {name: load_cells(root, name) for name in SCENARIOS if list(root.glob(f"cells/{name}/*/results.npz"))}
    bounds = {name: _bound(root, name, found.tested["returns"].shape[1]) for name, found in results.items()}
    staying = {name: root / f"cells/staying-{name}/gamma-0.8/staying.json" for name in results}
    varied = {name: root / "cells" / "sensitivity" / folder(name) / "results.npz" for name in variations()}
    return Found(
        results,
        {name: bound for name, bound in bounds.items() if bound is not None},
        {name: read_json(path) for name, path in staying.items() if path.exists()},
        {name: load_results(path) for name, path in varied.items() if path.exists()},
    )


def in_assets(root: Path) -> Found:
    """What ships, or what is about to."""
    files = {name: Path(root) / f"study-{name}.npz" for name in SCENARIOS}
    results = {name: load_results(path) for name, path in files.items() if path.exists()}
    bounds = {name: Path(root) / f"bound-{name}.npz" for name in results}
    staying = {name: Path(root) / f"staying-{name}.json" for name in results}
    varied = {name: Path(root) / "sensitivity" / f"{folder(name)}.npz" for name in variations()}
    return Found(
        results,
        {name: read_arrays(path)["returns"] for name, path in bounds.items() if path.exists()},
        {name: read_json(path) for name, path in staying.items() if path.exists()},
        {name: load_results(path) for name, path in varied.items() if path.exists()},
    )


def _bound(root: Path, name: str, tests: int) -> np.ndarray | None:
    """None until the planner has looked at every episode."""
    cells = [read_arrays(path) for path in root.glob(f"cells/bound-{name}/*/results.npz")]
    found = {int(cell["first"]) + i: value for cell in cells for i, value in enumerate(cell["returns"])}
    return np.array([found[i] for i in range(tests)]) if set(range(tests)) <= set(found) else None

"""The experiment on looking ahead: how safe and how good it makes each base policy, and what a wrong model costs.

    python -m bootcourse.research.lookahead --out DIR --runs assets/runs DIR_OF_MORE_RUNS

It drives a list of cells, each one base policy on held-out roads, and writes each to a file of its own. A cell whose
file exists is not driven again, so a run that was stopped goes on where it was.
"""

import argparse
import itertools
import re
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import msgspec
import numpy as np
from gymnasium.vector import AutoresetMode

from bootcourse.episodes.driving import steps
from bootcourse.episodes.evaluate import held_out_seeds
from bootcourse.episodes.lookahead import HORIZON, lookahead, lookahead_shield
from bootcourse.episodes.models import MODELS
from bootcourse.errors import BootcourseError, check_known
from bootcourse.files import check_arrays, read_arrays, read_json, remove_temporary, write_arrays, write_json
from bootcourse.policies import Policy, rule_policy
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import DEFAULT, Scenario
from bootcourse.storage.runs import find_runs, load_run

BLOCK, TOGETHER = 1, 1000  # of held-out roads, those of the study; roads that are driven side by side
FORMS = {"alone": None, "rollout": lookahead, "shield": lookahead_shield}
BASES = ("ppo_cloned", "bootstrapped", "soft", "sac", "demos", "bc", "rule")
CLOSELY = ("ppo_cloned", "bootstrapped")  # the base policies whose horizon and model are varied
HORIZONS = (3, 6, 15)
MANY = 10_000  # roads for the safest
SUMMARY = "summary.json"  # written beside the cells when all are there


@dataclass(frozen=True)
class Cell:
    """One base policy, looking ahead in one way, on some roads."""

    base: str  # a method, or "rule"
    seed: int = 0  # of the base's training
    form: str = "rollout"  # one of FORMS
    horizon: int = HORIZON  # decisions
    model: str = "exact"  # one of MODELS
    roads: int = 1000

    def __post_init__(self):
        check_known("Form", self.form, FORMS)
        check_known("Model", self.model, MODELS)

    @property
    def file(self) -> str:
        """The name of its file, such as "ppo_cloned-0-rollout-10-a-second-late-1000.npz"."""
        model = re.sub(r"[^\w.]+", "-", self.model)
        return f"{self.base}-{self.seed}-{self.form}-{self.horizon}-{model}-{self.roads}.npz"


def drive(cell: Cell, policy: Policy, scenario: Scenario = DEFAULT) -> dict[str, np.ndarray]:
    """Drive a cell: of each road (roads,) returns, accident, success, decisions, how many were overruled; seconds."""
    make = FORMS[cell.form]
    driver = make(policy, cell.horizon, scenario, MODELS[cell.model], cell.seed) if make else policy
    seeds, began = held_out_seeds(BLOCK, cell.roads), time.process_time()
    parts = [_drive(driver, [*seeds[first : first + TOGETHER]], scenario) for first in range(0, cell.roads, TOGETHER)]
    columns = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    return columns | {"seconds": np.array(time.process_time() - began)}


def _drive(driver: Policy, seeds: list[int], scenario: Scenario) -> dict[str, np.ndarray]:
    env = TrapVectorEnv(len(seeds), scenario, AutoresetMode.DISABLED)
    returns, accident = np.zeros(len(seeds)), np.zeros(len(seeds), dtype=np.int8)
    decisions, overruled = np.zeros(len(seeds), dtype=np.int16), np.zeros(len(seeds), dtype=np.int16)
    for step in steps(driver, env, seeds):
        returns += step.rewards
        accident = np.maximum(accident, step.infos["accident"].astype(np.int8))
        decisions += step.running
        overruled += step.running & getattr(driver, "overruled", False)
    success = step.infos["is_success"]
    return {
        "returns": returns, "accident": accident, "success": success, "decisions": decisions, "overruled": overruled,
    }  # fmt: skip


def cells(seeds: dict[str, Sequence[int]]) -> Iterator[Cell]:
    """Every cell of the experiment. seeds: {base: its training seeds}.

    The base policies alone and with the shield come first, because they are cheap; then all that one training seed
    needs before the next seed, so that a run that is stopped early has whole rows of fewer seeds.
    """
    every = sorted(((base, seed) for base in BASES for seed in seeds.get(base, ())), key=lambda who: who[1])
    wrong = [model for model in MODELS if model != "exact"]
    for form in ("alone", "shield"):
        yield from (Cell(*who, form) for who in every)
    for _, group in itertools.groupby(every, key=lambda who: who[1]):
        group = list(group)
        closely = [who for who in group if who[0] in CLOSELY]
        yield from (Cell(*who) for who in group)
        for form in ("shield", "rollout"):
            yield from (Cell(*who, form, model=model) for model in wrong for who in closely)
        yield from (Cell(*who, horizon=horizon) for horizon in HORIZONS for who in closely)
    safest = [who for who in every if who[0] == CLOSELY[0]]
    yield from (Cell(*who, form, roads=MANY) for form in ("alone", "shield", "rollout") for who in safest)


def policies(folders: Sequence[Path]) -> dict[tuple[str, int], Callable[[], Policy]]:
    """{(base, training seed): a function that loads its policy}, of the runs in some folders, and the rule."""
    loaders = {("rule", 0): lambda: rule_policy(DEFAULT)}
    for path in (path for folder in folders for path in find_runs(folder)):
        base, _, seed = path.name.rpartition("-")
        loaders[base, int(seed)] = lambda path=path: load_run(path).agent.as_policy()
    return loaders


def evaluate_cells(todo: Sequence[Cell], loaders: dict, out: Path) -> None:
    """Drive each cell that has no file in `out` yet, and write it, all or nothing."""
    out.mkdir(parents=True, exist_ok=True)
    remove_temporary(out)
    for count, cell in enumerate(todo, 1):
        if not (out / cell.file).exists():
            arrays = drive(cell, loaders[cell.base, cell.seed]())
            write_arrays(out / cell.file, arrays)
            hurt, paid = int((arrays["accident"] > 0).sum()), arrays["returns"].mean()
            print(f"{count}/{len(todo)} {cell.file}: return {paid:.1f}, {hurt} accidents", flush=True)


class Summary(msgspec.Struct, frozen=True):
    """What is kept of a cell for figures and tables."""

    roads: int
    returns: float  # mean over the roads
    accidents: int
    success: float  # share of the roads
    decisions: int
    overruled: int  # of these decisions
    seconds: float  # of one core


def read_cell(path: Path, roads: int) -> dict[str, np.ndarray]:
    """What `drive` found of a cell. Raises BootcourseError if its file is missing or damaged."""
    arrays, numbers = read_arrays(path), ("returns", "accident", "success", "decisions", "overruled")
    check_arrays(arrays, dict.fromkeys(numbers, (roads,)) | {"seconds": ()}, path)
    return arrays


def summaries(place: Path) -> dict[str, Summary]:
    """{name of a cell's file: its summary}, from the folder of the cells, or from the JSON file of their summaries."""
    if place.suffix == ".json":
        return read_json(place, dict[str, Summary])
    summary_of = {}
    for path in sorted(place.glob("*.npz")):
        roads = int(path.stem.rpartition("-")[2])
        one = read_cell(path, roads)
        hurt, success, seconds = int((one["accident"] > 0).sum()), float(one["success"].mean()), float(one["seconds"])
        sums = (int(one[name].sum()) for name in ("decisions", "overruled"))
        summary_of[path.name] = Summary(roads, float(one["returns"].mean()), hurt, success, *sums, seconds)
    return summary_of


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="python -m bootcourse.research.lookahead", description=__doc__.split("\n")[0])
    parser.add_argument("--out", type=Path, required=True, help="the folder for the cells' files")
    parser.add_argument("--runs", type=Path, nargs="+", required=True, help="folders with runs of the base policies")
    options = parser.parse_args(arguments)
    loaders = policies(options.runs)
    seeds = {base: sorted(seed for name, seed in loaders if name == base) for base in BASES}
    evaluate_cells(list(cells(seeds)), loaders, options.out)
    write_json(options.out / SUMMARY, msgspec.to_builtins(summaries(options.out)))
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except BootcourseError as error:
        sys.exit(str(error))

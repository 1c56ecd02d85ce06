"""`bootcourse evaluate` and `bootcourse drive`."""

import json
from pathlib import Path

import numpy as np

from bootcourse.drivers import Driver, idle_driver, random_driver, rule_driver
from bootcourse.errors import BootcourseError, nearest
from bootcourse.scenario import DEFAULT, Scenario, named
from bootcourse.study.evaluate import Estimate, drive_episodes, held_out_seeds, over_seeds, report

SIMPLE = ("rule", "idle", "random")
ROWS = {
    "success": "success %",
    "returns": "return",
    "speed": "speed m/s",
    "distance": "distance m",
    "collision": "collision %",
    "road_departure": "road departure %",
    "stoppage": "stoppage %",
}
ACROSS = 4  # columns that fit a terminal


def drivers(who: str, scenario: str, sample: bool, seed: int) -> list[tuple[str, Driver, Scenario]]:
    """(label, driver, scenario) of everybody that `who` names: a simple driver, or the runs of a folder."""
    if who in SIMPLE:
        road = named(scenario) if scenario else DEFAULT
        simple = {"rule": rule_driver(road), "idle": idle_driver, "random": random_driver(np.random.default_rng(seed))}
        return [(who, simple[who], road)]
    if not Path(who).exists():
        raise BootcourseError(f"Driver {nearest(who, SIMPLE)}, or name a folder that `bootcourse train` wrote.")
    from bootcourse.record.runs import find_runs, load_run

    found = []
    for path in find_runs(Path(who)):
        run = load_run(path)
        rng = np.random.default_rng(seed) if sample else None
        road = named(scenario) if scenario else run.scenario
        found.append((path.name, run.agent.driver(rng, with_q=True), road))
    return found


def evaluate(who: str, episodes: int, seed: int, scenario: str, sample: bool, as_json: bool) -> None:
    """Print the table, or JSON."""
    seeds = held_out_seeds(seed, episodes)
    reports = {
        label: report(drive_episodes(driver, seeds, road))
        for label, driver, road in drivers(who, scenario, sample, seed)
    }
    if as_json:
        everything = {label: each.to_dict() for label, each in reports.items()}
        if len(reports) > 1:
            everything["over seeds"] = {name: e._asdict() for name, e in over_seeds(list(reports.values())).items()}
        print(json.dumps(everything, indent=2))
        return
    print(f"{episodes} held-out episodes, block {seed}: value [95 % interval]")
    columns = {label: {name: getattr(each, name) for name in ROWS} for label, each in reports.items()}
    if len(reports) > 1:
        columns["mean over seeds"] = over_seeds(list(reports.values()))
    labels = list(columns)
    for first in range(0, len(labels), ACROSS):
        print_table({label: columns[label] for label in labels[first : first + ACROSS]})


def print_table(columns: dict[str, dict[str, Estimate]]) -> None:
    """One column for each driver, one row for each measure."""
    print("\n" + " " * 18 + "".join(f"{label:>26}" for label in columns))
    for name, heading in ROWS.items():
        print(f"{heading:18}" + "".join(f"{cell(column[name], '%' in heading):>26}" for column in columns.values()))


def cell(estimate: Estimate, percent: bool) -> str:
    value, low, high = (100 * number if percent else number for number in estimate)
    return f"{value:.1f} [{low:.1f}, {high:.1f}]"


def drive(who: str, out: Path, seed: int, scenario: str, png: Path | None) -> None:
    """Record one drive of the first driver that `who` names."""
    from bootcourse.record.drive import record

    if out.exists():
        raise BootcourseError(f"{out} exists already: choose another name.")
    label, driver, road = drivers(who, scenario, False, seed)[0]
    label = label.rsplit("-", 1)[0] if label not in SIMPLE else label
    rollout = record(driver, [seed], road, label)[0]
    print(rollout.save(out))
    if png is not None:
        from bootcourse.study.figures import save_drive

        print(save_drive(rollout, png))

"""Make what ships, `assets/`, from a study's folder: results, weights, demonstrations, rollouts, report and model card.

Each file is listed in the manifest with the command that makes it and the code that it depends on;
`bootcourse.assets` checks them.
"""

import shutil
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from bootcourse.assets import FOLDER, LIMIT, MANIFEST
from bootcourse.errors import BootcourseError
from bootcourse.record.drive import provenance
from bootcourse.record.files import read_json, sha256, write_arrays, write_bytes, write_json
from bootcourse.study.results import load_cells, load_results, save_results
from bootcourse.study.sources import sources_hash

CURVES = ("success", "return", "speed", "distance", "accident", "entropy")  # the others are in runs/
RUNS = 5  # training seeds whose weights ship; curves and scores ship of all
BUILD = "bootcourse assets build --study DIR"
STUDY = f"bootcourse study --out DIR && {BUILD}"


def build(study: Path, folder: Path = FOLDER) -> None:
    """Make every shipped file from a study's folder. Raises BootcourseError if something is missing there.

    What is in the folder already is replaced when everything is there, and not before.
    """
    new = folder.parent / f".{folder.name}.new"
    shutil.rmtree(new, ignore_errors=True)
    entries: list[dict] = []

    def add(path: Path, how: str, sources: dict[str, str], versions: dict) -> None:
        entry = {"file": path.relative_to(new).as_posix(), "sha256": sha256(path), "bytes": path.stat().st_size}
        entries.append(entry | {"command": how, "sources": sources, "versions": versions})

    try:
        for part in (add_results, add_sensitivity, add_report, add_runs, add_demonstrations, add_rollouts, add_card):
            part(study, new, add)
        keep_readme(folder, new, entries, add)
        write_json(new / MANIFEST, {"files": entries})
        size = sum(entry["bytes"] for entry in entries)
        if size >= LIMIT:
            raise BootcourseError(
                f"These assets would hold {size / 1e6:.1f} MB: they must stay under {LIMIT / 1e6:.0f} MB."
            )
    except BaseException:
        shutil.rmtree(new, ignore_errors=True)
        raise
    shutil.rmtree(folder, ignore_errors=True)
    new.rename(folder)


def cells_made(study: Path, part: str) -> tuple[dict[str, str], dict]:
    """(sources, versions) of the cells of a part; cells of different code are named as such."""
    cells = [read_json(path) for path in sorted((study / "cells" / part).rglob("cell.json"))]
    if not cells:
        raise BootcourseError(f"{study} has no finished cells in cells/{part}: compute them first.")
    sources = {}
    for name in cells[0]["sources"]:
        hashes = {cell["sources"].get(name) for cell in cells}
        sources[name] = hashes.pop() if len(hashes) == 1 else "of different versions"
    versions = {name: value for name, value in cells[0]["provenance"].items() if name != "seconds"}
    return sources, versions


def add_results(study: Path, new: Path, add: Callable) -> None:
    """Curves and scores of both scenarios, the planner's bound, the sensitivity and the sweep."""
    from bootcourse.study.report import bound

    commands = {
        "default": "bootcourse study --out DIR",
        "calibrated": "bootcourse study --out DIR --scenario calibrated",
        "sweep": "bootcourse sweep --out DIR",
    }
    for part, how in commands.items():
        sources, versions = cells_made(study, part)
        name = "sweep.npz" if part == "sweep" else f"study-{part}.npz"
        results = load_cells(study, part)
        save_results(lighter(results, CURVES[:2] if part == "sweep" else CURVES), new / name, versions)
        add(new / name, f"{how} && {BUILD}", sources, versions)
        best = None if part == "sweep" else bound(study, part, results.tested["returns"].shape[1])
        if best is not None:
            write_arrays(new / f"bound-{part}.npz", {"returns": best.astype(np.float32)})
            add(new / f"bound-{part}.npz", f"{how} --only planner && {BUILD}", *cells_made(study, f"bound-{part}"))


def add_sensitivity(study: Path, new: Path, add: Callable) -> None:
    """Scores and curves of every variation that was run, a file each."""
    how = f"bootcourse study --out DIR --sensitivity --episodes 1500 && {BUILD}"
    for cell in sorted(study.glob("cells/sensitivity/*/results.npz")):
        sources, versions = cells_made(study, f"sensitivity/{cell.parent.name}")
        path = new / "sensitivity" / f"{cell.parent.name}.npz"
        save_results(lighter(load_results(cell), CURVES[:2]), path, versions)
        add(path, how, sources, versions)


def add_report(study: Path, new: Path, add: Callable) -> None:
    """The study's report with its figures."""
    from bootcourse.study.report import write_report

    report = write_report(study)
    sources, versions = cells_made(study, "default")
    pictures = sorted((study / "figures").glob("*.png"))
    for path in (report, *pictures):
        target = new / "report" / path.relative_to(study)
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(path, target)
        add(target, STUDY, sources, versions)


def lighter(results, curves: Sequence[str]):
    """The same results with some of their curves only, in half precision: 3 digits are more than a figure shows."""
    return replace(results, curves={name: results.curves[name].astype(np.float16) for name in curves})


def add_runs(study: Path, new: Path, add: Callable) -> None:
    """The first agents of every method on the default scenario, as `load_run` reads them."""
    sources, versions = cells_made(study, "default")
    for run in sorted(study.glob("cells/default/*/runs/*")):
        if int(run.name.rpartition("-")[2]) >= RUNS:
            continue
        shutil.copytree(run, new / "runs" / run.name)
        for path in sorted((new / "runs" / run.name).iterdir()):
            add(path, STUDY, sources, versions)


def add_demonstrations(study: Path, new: Path, add: Callable) -> None:
    """The 200 demonstrations, as rows for a `Replay`."""
    from bootcourse.learn.demonstrations import collect

    write_arrays(new / "demonstrations.npz", {"rows": collect().numpy()})
    sources = sources_hash(("scenario", "rule", "drivers", "road", "learn/demonstrations", "learn/replay"))
    add(new / "demonstrations.npz", BUILD, sources, provenance())


def add_rollouts(study: Path, new: Path, add: Callable) -> None:
    """A handful of drives worth watching; one that no agent drives is left out, and said so."""
    from bootcourse.record.drive import record
    from bootcourse.record.runs import load_run
    from bootcourse.scenario import DEFAULT
    from bootcourse.study.cells import HELD_OUT
    from bootcourse.study.evaluate import held_out_seeds

    results = load_cells(study, "default")
    success, accident = results.tested["success"] > 0, results.tested["accident"]
    wanted = {
        "trapped-sac": ("sac", ~success & (accident == 0)),
        "escape": ("bootstrapped", success & (accident == 0)),
        "crash": ("bootstrapped", accident == 1),
    }
    sources = sources_hash(("scenario", "rule", "drivers", "road", "record/drive"))
    how = STUDY
    roads = held_out_seeds(HELD_OUT, success.shape[1])
    for name, (method, fits) in wanted.items():
        mine = [i for i, agent in enumerate(results.agents) if agent["method"] == method]
        found = [(i, road) for i in mine for road in np.flatnonzero(fits[i])]
        if not found:
            print(f"No agent of '{method}' drove a rollout for {name}: left out.")
            continue
        agent, road = max(found, key=lambda place: results.tested["returns"][place])
        label = f"{method}-{results.agents[agent]['seed']}"
        run = next(study.glob(f"cells/default/*/runs/{label}"))
        driver = load_run(run).agent.driver(with_q=True)
        rollout = record(driver, [roads[int(road)]], DEFAULT, method)[0]
        add(rollout.save(new / "rollouts" / f"{name}.npz"), how, sources | sources_hash(["learn"]), provenance())
    from bootcourse.drivers import rule_driver

    rollout = record(rule_driver(DEFAULT), [roads[0]], DEFAULT, "rule")[0]
    add(rollout.save(new / "rollouts" / "rule.npz"), how, sources, provenance())


def keep_readme(folder: Path, new: Path, entries: list[dict], add: Callable) -> None:
    """The pictures of the README, which no study makes, stay as they are."""

    if not (folder / "readme").is_dir():
        return
    before = read_json(folder / MANIFEST)["files"] if (folder / MANIFEST).exists() else []
    shutil.copytree(folder / "readme", new / "readme")
    for path in sorted((new / "readme").iterdir()):
        known = [entry for entry in before if entry["sha256"] == sha256(path)]
        if known:
            entries.append(known[0])
        else:
            sources = sources_hash(("scenario", "rule", "drivers", "road", "study/top_view", "study/readme_picture"))
            add(path, "python -m bootcourse.study.readme_picture", sources, provenance())


def add_card(study: Path, new: Path, add: Callable) -> None:
    """The model card, with the numbers of this very study."""
    from bootcourse.study.tables import HEADINGS, bracketed, markdown, score

    results = load_results(new / "study-default.npz")
    measures = ("success", "returns", "collision", "road_departure", "stoppage")
    rows = [
        [m, len(results.of(m)), *(bracketed(score(results, m, measure)) for measure in measures)]
        for m in results.methods
    ]
    table = markdown(["method", "agents", *(HEADINGS[measure] for measure in measures)], rows)
    agent = results.agents[0]
    text = CARD.format(
        table=table,
        tests=results.tested["returns"].shape[1],
        hidden=" x ".join(map(str, agent["hidden"])),
        runs=RUNS,
    )
    write_bytes(new / "MODEL_CARD.md", text.encode())
    add(new / "MODEL_CARD.md", STUDY, *cells_made(study, "default"))


CARD = """# Model card

**What they are.** The agents in `runs/`: a folder for each of the first {runs} seeds of each method, trained on the
default scenario of this course by `bootcourse study`. Each is an actor and two critics with hidden layers of
{hidden} neurons; it reads 26 numbers and chooses one of 9 actions, once a second. The weights are those at the
end of training: none was selected.

**What they are for.** Lessons: to be driven, replayed, compared and taken apart. **What they are not for:**
anything on a road. They have seen one straight road, one kind of trap and eight other cars that are models
themselves, and some of them crash often.

**How well they drive.** {tests} held-out episodes each; interquartile mean over agents with its 95 % interval.
They drive by their most probable action.

{table}
**Data.** Their own driving in simulation, and for some methods 200 simulated episodes of a rule
controller. No person and no real car is in it.

**Known faults.** Success counts a crash after overtaking, as the paper does: read it beside the accidents. An
agent that earns more than the rule does so by driving close to others.
"""

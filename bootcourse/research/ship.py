"""Make what ships, `assets/`, from a study's folder: results, weights, rollouts, report and model card.

Each file is listed in the manifest with its size, its hash, the command that makes it and the versions that made it.
`bootcourse.storage.assets` checks the files. Files that the study has not computed stay as they are.
"""

import shutil
import tempfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from msgspec import ValidationError, convert

from bootcourse.episodes.evaluate import held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.errors import BootcourseError
from bootcourse.files import provenance, sha256, write_arrays, write_bytes, write_json
from bootcourse.policies import rule_policy
from bootcourse.research.computed import in_assets, in_study
from bootcourse.research.experiment import EXPERIMENTS, experiment_named
from bootcourse.research.jobs import HELD_OUT, read_job
from bootcourse.research.report import model_card, write_report
from bootcourse.research.results import Results, load_job, load_jobs, load_results, save_results
from bootcourse.research.studies import STUDIES
from bootcourse.scenario import DEFAULT
from bootcourse.storage.assets import FOLDER, FORMAT, LIMIT, MANIFEST, Entry, read_manifest
from bootcourse.storage.runs import load_run
from bootcourse.storage.sealed import write_sealed

STUDY_CURVES = ("success", "return", "speed", "distance", "accident", "entropy")  # the others are in runs/
RUNS = 5  # training seeds whose weights ship; curves and scores ship of all
PICTURES = (
    "readme",
    (  # the folder that no study makes, and the commands that do: on road 3 the rule passes after 22 s
        "bootcourse drive idle --seed 3 --out idle.npz && bootcourse drive rule --seed 3 --out rule.npz && "
        "bootcourse replay idle.npz rule.npz --gif trap.gif --png trap.png"
    ),
)


def command(name: str) -> str:
    """The commands that make the files of a study or experiment."""
    return f"bootcourse study{'' if name == 'default' else f' {name}'} --out DIR && bootcourse assets build --study DIR"


class Shipment:
    """The new folder while it is filled. Files that the study has not computed are taken from today's folder; a file
    that was removed from it is no longer listed.
    """

    def __init__(self, study: Path | None, today: Path, new: Path):
        self.study, self.new = study or new / "no study", new
        self.entries: dict[str, dict] = {}  # of the manifest, by file
        if (today / MANIFEST).exists():
            shutil.copytree(today, new)
            entries = read_manifest(today)["files"]
            self.entries = {entry["file"]: entry for entry in entries if (today / entry["file"]).exists()}

    def has(self, part: str) -> bool:
        """Has the study finished any job of this part?"""
        return any((self.study / "jobs" / part).rglob("job.json"))

    def versions(self, part: str) -> dict:
        """The versions that made the study's jobs of a part. Raises BootcourseError for a damaged job."""
        jobs = [read_job(path.parent) for path in sorted((self.study / "jobs" / part).rglob("job.json"))]
        return {name: value for name, value in jobs[0]["provenance"].items() if name != "seconds"}

    def clear(self, pattern: str) -> None:
        """Remove the files that are made again."""
        for path in [path for path in self.new.glob(pattern) if path.is_file()]:
            path.unlink()
            self.entries.pop(path.relative_to(self.new).as_posix(), None)

    def add(self, path: Path, made_by: str, versions: dict) -> None:
        """List a file that was just made. Raises BootcourseError for a name that the manifest cannot hold."""
        name, size = path.relative_to(self.new).as_posix(), path.stat().st_size
        entry = {"file": name, "sha256": sha256(path), "bytes": size, "command": made_by, "versions": versions}
        try:
            convert(entry, Entry)
        except ValidationError as error:
            raise BootcourseError(
                f"'{name}' cannot ship ({error}): a file's name has letters, digits and any of . _ - only."
            ) from None
        self.entries[name] = entry

    def add_results(self, results: Results, path: Path, part: str, curves: Sequence[str]) -> None:
        """Write and list the results of a part of the study, with these curves."""
        versions = self.versions(part)
        save_results(lighter(results, curves, half=part not in STUDIES), path, versions)
        self.add(path, command(part.partition("/")[0]), versions)


def build(study: Path | None, folder: Path = FOLDER) -> None:
    """Make the shipped files from a study's folder; parts that it has not computed stay as they are.

    study: None makes only the report and the model card again, from the results in `folder`.

    `folder` is replaced, by a renaming, only after everything is made. Raises BootcourseError if the study holds no
    finished jobs, if neither it nor `folder` has results of the default scenario, and if the files are too large to
    ship.
    """
    if study is not None and not any((study / "jobs").rglob("job.json")):
        raise BootcourseError(f"{study} holds no finished jobs: name a folder that `bootcourse study` wrote.")
    with tempfile.TemporaryDirectory(dir=folder.parent, prefix=f".{folder.name}.") as work:
        new = Path(work) / "new"
        _fill(Shipment(study, folder, new), folder)
        if folder.exists():
            folder.rename(Path(work) / "old")
        new.rename(folder)


def _fill(shipment: Shipment, folder: Path) -> None:
    add_studies(shipment)
    add_experiments(shipment)
    add_runs(shipment)
    add_rollouts(shipment)
    add_report(shipment)
    add_pictures(shipment, folder)
    entries = [shipment.entries[name] for name in sorted(shipment.entries)]
    write_sealed(shipment.new / MANIFEST, {"format": FORMAT, "files": entries})
    size = sum(entry["bytes"] for entry in entries)
    if size >= LIMIT:
        raise BootcourseError(
            f"These assets would hold {size / 1e6:.1f} MB: they must stay under {LIMIT / 1e6:.0f} MB."
        )


def add_studies(to: Shipment) -> None:
    """Curves and scores of each study, the planner's bound and its answer."""
    study = in_study(to.study)
    for part in STUDIES:
        path = to.new / f"study-{part}.npz"
        if not to.has(part):
            if part == "default" and not path.exists():
                raise BootcourseError(f"{to.study} has no finished jobs in jobs/default: compute them first.")
            continue
        to.add_results(load_jobs(to.study, part), path, part, STUDY_CURVES)
        if part in study.bound:
            best = to.new / f"bound-{part}.npz"
            write_arrays(best, {"returns": study.bound[part].astype(np.float32)})
            to.add(best, command(part), to.versions(f"bound-{part}"))
        if part in study.staying:
            answer = to.new / f"staying-{part}.json"
            write_json(answer, study.staying[part])
            to.add(answer, command(part), to.versions(f"staying-{part}"))


def add_experiments(to: Shipment) -> None:
    """Scores and curves of every cell that was run, a file each."""
    for name in EXPERIMENTS:
        shown = experiment_named(name).curves
        for job in sorted(to.study.glob(f"jobs/{name}/*/results.npz")):
            results, path = load_job(job.parent), to.new / name / f"{job.parent.name}.npz"
            curves = tuple(results.curves) if shown is None else shown
            to.add_results(results, path, f"{name}/{job.parent.name}", curves)


def lighter(results: Results, curves: Sequence[str], half: bool) -> Results:
    """The same results with these curves only, in half precision, whose three digits are more than a figure shows.

    half: store the tests' speeds and distances so, too, where no table shows them.
    """
    names = ("speed", "distance") if half else ()
    tested = {name: each.astype(np.float16) if name in names else each for name, each in results.tested.items()}
    shown = {name: results.curves[name].astype(np.float16) for name in curves if name in results.curves}
    return replace(results, curves=shown, tested=tested)


def add_runs(to: Shipment) -> None:
    """The first agents of every method on the default scenario, as `load_run` reads them."""
    for run in sorted(to.study.glob("jobs/default/*/runs/*")):
        if int(run.name.rpartition("-")[2]) < RUNS:
            to.clear(f"runs/{run.name}/*")
            shutil.copytree(run, to.new / "runs" / run.name, dirs_exist_ok=True)
            versions = to.versions(f"default/{run.parent.parent.name}")
            for path in sorted((to.new / "runs" / run.name).iterdir()):
                to.add(path, command("default"), versions)


def add_rollouts(to: Shipment) -> None:
    """Four drives for the replay: the rule, SAC in the trap, an escape and a crash, where an agent drove such a one."""
    if not to.has("default"):
        return
    results = load_jobs(to.study, "default")
    success, accident = results.tested["success"] > 0, results.tested["accident"]
    wanted = {
        "trapped-sac": ("sac", ~success & (accident == 0)),
        "escape": ("bootstrapped", success & (accident == 0)),
        "crash": ("bootstrapped", accident == 1),
    }
    roads = held_out_seeds(HELD_OUT, success.shape[1])
    drives = {"rule": record(rule_policy(DEFAULT), [roads[0]], DEFAULT, "rule")[0]}
    for name, (method, fits) in wanted.items():
        of_method = np.array([agent["method"] == method for agent in results.agents])
        candidates = [(int(agent), int(road)) for agent, road in np.argwhere(fits & of_method[:, None])]
        if not candidates:
            print(f"No agent of '{method}' drove as the rollout '{name}' should: none is made.")
            continue
        agent, road = max(candidates, key=lambda place: results.tested["returns"][place])
        run = next(to.study.glob(f"jobs/default/*/runs/{method}-{results.agents[agent]['seed']}"))
        driver = load_run(run).agent.as_policy(with_q=True)
        drives[name] = record(driver, [roads[road]], DEFAULT, method)[0]
    for name, rollout in drives.items():
        to.add(rollout.save(to.new / "rollouts" / f"{name}.npz"), command("default"), provenance())


def add_report(to: Shipment) -> None:
    """The report with its figures, the experiments' pages and the model card, made from the files that ship."""
    to.clear("report/**/*")
    study = in_assets(to.new)
    write_report(study, to.new / "report")
    for name, computed in study.experiments.items():
        if computed and (page := experiment_named(name).page):
            write_bytes(to.new / f"{name}.md", page(computed).encode())
            to.add(to.new / f"{name}.md", command(name), provenance())
    card = model_card(load_results(to.new / "study-default.npz"), RUNS)
    write_bytes(to.new / "MODEL_CARD.md", card.encode())
    for path in (to.new / "MODEL_CARD.md", *sorted((to.new / "report").rglob("*"))):
        if path.is_file():
            to.add(path, command("default"), provenance())


def add_pictures(to: Shipment, today: Path) -> None:
    """The README's pictures stay as they are; new ones are listed."""
    pictures, made_by = PICTURES
    for path in sorted(today.glob(f"{pictures}/*")):
        copy = to.new / pictures / path.name
        if to.entries.get(f"{pictures}/{path.name}", {}).get("sha256") != sha256(path):
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(path, copy)
            to.add(copy, made_by, provenance())

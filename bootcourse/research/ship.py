"""Make what ships, `assets/`, from a study's folder: results, weights, demonstrations, rollouts, report and model card.

Each file is listed in the manifest with the command that makes it and the fingerprints of the behaviours that it
depends on. `bootcourse.storage.assets` checks the files, `bootcourse.research.fingerprint` the behaviours.
"""

import os
import shutil
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from bootcourse.episodes.evaluate import held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.errors import BootcourseError
from bootcourse.files import provenance, sha256, write_arrays, write_bytes, write_json
from bootcourse.methods import METHODS
from bootcourse.policies import rule_policy
from bootcourse.research.card import model_card
from bootcourse.research.fingerprint import alike, fingerprints, key
from bootcourse.research.jobs import HELD_OUT, read_job
from bootcourse.research.plan import EXPERIMENTS
from bootcourse.research.report import write_report
from bootcourse.research.results import (
    Results,
    in_assets,
    in_study,
    join,
    load_job,
    load_jobs,
    load_results,
    save_results,
)
from bootcourse.scenario import DEFAULT
from bootcourse.storage.assets import FOLDER, FORMAT, LIMIT, MANIFEST, put_back, read_manifest, unfinished
from bootcourse.storage.runs import load_run
from bootcourse.storage.sealed import is_file_with, write_sealed
from bootcourse.storage.work import locked

CURVES = ("success", "return", "speed", "distance", "accident", "entropy")  # the others are in runs/
VARIED_CURVES = ("success", "return", "xi", "decisions")  # of the experiments
FEWER = dict.fromkeys(("teachers", "safe"), ("success", "decisions"))  # of those with many agents, for their size
RUNS = 5  # training seeds whose weights ship; curves and scores ship of all
BUILD = "bootcourse assets build --study DIR"
STUDY = f"bootcourse study --out DIR && {BUILD}"


class Shipment:
    """The new folder while it is filled. Files that the study has not computed are taken from today's folder."""

    def __init__(self, study: Path | None, now: Path, new: Path, replace_larger: bool):
        self.study, self.new, self.replace_larger = study or new / "no study", new, replace_larger
        self.entries: dict[str, dict] = {}
        self.behaviours: dict[str, dict[str, list[float]]] = {}  # {name: {key: fingerprint}}
        if (now / MANIFEST).exists():
            shutil.copytree(now, new)
            manifest = read_manifest(now)
            self.entries = {entry["file"]: entry for entry in manifest["files"]}
            self.behaviours = manifest["behaviours"]

    def has(self, part: str) -> bool:
        """Has the study finished any job of this part?"""
        return any((self.study / "jobs" / part).rglob("job.json"))

    def name_of(self, path: Path) -> str:
        """A file's name in the manifest."""
        return path.relative_to(self.new).as_posix()

    def behaviour_of(self, name: str) -> dict[str, list[float]]:
        """The fingerprints of the code that made a file that is listed, by name."""
        return {each: self.behaviours[each][made] for each, made in self.entries[name]["behaviour"].items()}

    def made(self, part: str) -> tuple[dict[str, list[float]], dict]:
        """(behaviour, versions) of the study's jobs of a part. Raises BootcourseError if there are none."""
        jobs = [read_job(path.parent) for path in sorted((self.study / "jobs" / part).rglob("job.json"))]
        if not jobs:
            raise BootcourseError(f"{self.study} has no finished jobs in jobs/{part}: compute them first.")
        versions = {name: value for name, value in jobs[0]["provenance"].items() if name != "seconds"}
        return agreed([job.get("behaviour", {"unrecorded behaviour": []}) for job in jobs]), versions

    def ships(self, path: Path) -> Results | None:
        """The results that ship in a file; None if it is absent or not as the manifest lists it."""
        entry = self.entries.get(self.name_of(path))
        return load_results(path) if entry and is_file_with(path, entry["sha256"]) else None

    def completed(self, results: Results, path: Path, behaviour: dict[str, list[float]]) -> tuple[Results, dict]:
        """(results, behaviour) with the shipped agents of the methods that the study has not computed.

        Results with other numbers of episodes are not joined: `check_size` judges them.
        """
        ships = self.ships(path)
        if ships is None or ships.sizes != results.sizes or not (missing := set(ships.methods) - set(results.methods)):
            return results, behaviour
        kept = [ships.of(method) for method in missing]
        names = results.curves.keys() & ships.curves.keys()
        joined = join([replace(part, curves={name: part.curves[name] for name in names}) for part in (results, *kept)])
        order = sorted(range(len(joined)), key=lambda i: (joined.agents[i]["method"], joined.agents[i]["seed"]))
        return joined.pick(order), agreed([behaviour, self.behaviour_of(self.name_of(path))])

    def check_size(self, results: Results, path: Path) -> None:
        """Raise BootcourseError if `path` holds more agents or episodes than the results that would replace it."""
        ships = self.ships(path)
        if self.replace_larger or ships is None:
            return
        sizes = [(f"agents of {method}", len(ships.of(method)), len(results.of(method))) for method in ships.methods]
        sizes += zip(("held-out episodes", "training episodes"), ships.sizes, results.sizes, strict=True)
        smaller = [f"{after} {name} instead of {before}" for name, before, after in sizes if after < before]
        if smaller:
            raise BootcourseError(
                f"{self.study} would replace {path.name} by a smaller one ({', '.join(smaller)}): "
                "compute the whole study, or add --replace-larger."
            )

    def clear(self, pattern: str) -> None:
        """Remove the files that are made again."""
        for path in [path for path in self.new.glob(pattern) if path.is_file()]:
            path.unlink()
            self.entries.pop(self.name_of(path), None)

    def add(self, path: Path, how: str, behaviour: dict[str, list[float]], versions: dict) -> None:
        """List a file that was just made. behaviour: the fingerprints of the code that made it, by name."""
        name, made = self.name_of(path), {each: self.known(each, values) for each, values in behaviour.items()}
        entry = {"file": name, "sha256": sha256(path), "bytes": path.stat().st_size}
        self.entries[name] = entry | {"command": how, "behaviour": made, "versions": versions}

    def known(self, name: str, values: list[float]) -> str:
        """The key of a fingerprint in the manifest. One that is there already stands for all that are alike."""
        listed = self.behaviours.setdefault(name, {})
        made = next((made for made, its in listed.items() if alike(name, values, its)), key(values))
        listed.setdefault(made, values)
        return made

    def write_manifest(self) -> None:
        """List every file, and the fingerprints that they name."""
        files = [self.entries[name] for name in sorted(self.entries)]
        used = {name: {entry["behaviour"].get(name) for entry in files} for name in self.behaviours}
        for name, known in self.behaviours.items():
            self.behaviours[name] = {made: values for made, values in known.items() if made in used[name]}
        write_sealed(self.new / MANIFEST, {"format": FORMAT, "behaviours": self.behaviours, "files": files})


def build(study: Path | None, folder: Path = FOLDER, replace_larger: bool = False) -> None:
    """Make the shipped files from a study's folder; parts that it has not computed stay as they are.

    study: None makes only the report and the model card again, from the results in `folder`.

    `folder` is replaced, by a renaming, only after everything is made. Raises BootcourseError if the study holds no
    finished jobs, if neither it nor `folder` has results of the default scenario, if its results are smaller than those
    that they would replace (unless `replace_larger`), or if the files are too large to ship.
    """
    if study is not None and not any((study / "jobs").rglob("job.json")):
        raise BootcourseError(f"{study} holds no finished jobs: name a folder that `bootcourse study` wrote.")
    work = unfinished(folder)
    new, old = work / "new", work / "old"
    with locked(work, "build"):
        put_back(folder)
        shutil.rmtree(old, ignore_errors=True)
        shutil.rmtree(new, ignore_errors=True)
        try:
            _fill(Shipment(study, folder, new, replace_larger), folder)
        except BaseException:
            shutil.rmtree(new, ignore_errors=True)
            raise
        if folder.exists():
            os.rename(folder, old)
        os.rename(new, folder)
        shutil.rmtree(old, ignore_errors=True)


def _fill(shipment: Shipment, folder: Path) -> None:
    for part in (add_results, add_experiments, add_runs, add_demonstrations, add_rollouts, add_report, add_card):
        part(shipment)
    add_kept(shipment, folder)
    shipment.write_manifest()
    size = sum(entry["bytes"] for entry in shipment.entries.values())
    if size >= LIMIT:
        raise BootcourseError(
            f"These assets would hold {size / 1e6:.1f} MB: they must stay under {LIMIT / 1e6:.0f} MB."
        )


def agreed(behaviours: Sequence[dict[str, list[float]]]) -> dict[str, list[float]]:
    """The fingerprints of several results together; one on which they differ is [], never current."""
    found: dict[str, list[float]] = {}
    for behaviour in behaviours:
        for name, values in behaviour.items():
            if not alike(name, found.setdefault(name, values), values):
                found[name] = []
    return found


COMMANDS = {
    "default": "bootcourse study --out DIR",
    "calibrated": "bootcourse study calibrated --out DIR",
    "paper": "bootcourse study paper --out DIR",
    "sweep": "bootcourse sweep --out DIR",
}


def add_results(to: Shipment) -> None:
    """Curves and scores of both scenarios and of the sweep, the planner's bound and its answer."""
    found = in_study(to.study)
    for part, how in COMMANDS.items():
        path, how = to.new / ("sweep.npz" if part == "sweep" else f"study-{part}.npz"), f"{how} && {BUILD}"
        if not to.has(part):
            if part == "default" and not path.exists():
                raise BootcourseError(f"{to.study} has no finished jobs in jobs/default: compute them first.")
            if to.study.exists():
                what = "stays as it is" if path.exists() else "is left out"
                print(f"{path.name} {what}: {to.study} has no such jobs.")
            continue
        behaviour, versions = to.made(part)
        results, behaviour = to.completed(load_jobs(to.study, part), path, behaviour)
        to.check_size(results, path)
        save_results(lighter(results, CURVES[:2] if part == "sweep" else CURVES), path, versions)
        to.add(path, how, behaviour, versions)
        if part in found.bound:
            best = to.new / f"bound-{part}.npz"
            write_arrays(best, {"returns": found.bound[part].astype(np.float32)})
            to.add(best, how, *to.made(f"bound-{part}"))
        if part in found.staying:
            answer = to.new / f"staying-{part}.json"
            write_json(answer, found.staying[part])
            to.add(answer, how, *to.made(f"staying-{part}"))


def add_experiments(to: Shipment) -> None:
    """Scores and curves of every variation that was run, a file each."""
    for name in EXPERIMENTS:
        how = f"bootcourse study {name} --out DIR && {BUILD}"
        for job in sorted(to.study.glob(f"jobs/{name}/*/results.npz")):
            behaviour, versions = to.made(f"{name}/{job.parent.name}")
            path = to.new / name / f"{job.parent.name}.npz"
            results = load_job(job.parent)
            to.check_size(results, path)
            save_results(lighter(results, FEWER.get(name, VARIED_CURVES)), path, versions)
            to.add(path, how, behaviour, versions)


def add_report(to: Shipment) -> None:
    """The report with its figures, made from the files that ship."""
    to.clear("report/**/*")
    write_report(in_assets(to.new), to.new / "report")
    for path in sorted((to.new / "report").rglob("*")):
        if path.is_file():
            to.add(path, STUDY, fingerprints("road", "rule", "statistics"), provenance())


def lighter(results, curves: Sequence[str]):
    """The same results with these curves only, in half precision: a figure shows fewer than its 3 digits."""
    return replace(
        results, curves={name: results.curves[name].astype(np.float16) for name in curves if name in results.curves}
    )


def add_runs(to: Shipment) -> None:
    """The first agents of every method on the default scenario, as `load_run` reads them."""
    for run in sorted(to.study.glob("jobs/default/*/runs/*")):
        method, _, seed = run.name.rpartition("-")
        if int(seed) >= RUNS:
            continue
        to.clear(f"runs/{run.name}/*")
        shutil.copytree(run, to.new / "runs" / run.name, dirs_exist_ok=True)
        behaviour, versions = to.made(f"default/{run.parent.parent.name}")
        for path in sorted((to.new / "runs" / run.name).iterdir()):
            to.add(path, STUDY, only(behaviour, method), versions)


def only(behaviour: dict[str, list[float]], method: str) -> dict[str, list[float]]:
    """The behaviours that one method's agents depend on, of those that several methods do."""
    return {name: values for name, values in behaviour.items() if name == method or name not in METHODS}


def add_demonstrations(to: Shipment) -> None:
    """The 200 demonstrations, as rows for a `ReplayBuffer`."""
    from bootcourse.learn.demonstrations import collect

    path = to.new / "demonstrations.npz"
    write_arrays(path, {"rows": collect().numpy()})
    to.add(path, BUILD, fingerprints("road", "rule", "demonstrations"), provenance())


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
        mine = np.array([agent["method"] == method for agent in results.agents])
        found = [(int(agent), int(road)) for agent, road in np.argwhere(fits & mine[:, None])]
        if not found:
            print(f"No agent of '{method}' drove a rollout for {name}: none is made.")
            continue
        agent, road = max(found, key=lambda place: results.tested["returns"][place])
        run = next(to.study.glob(f"jobs/default/*/runs/{method}-{results.agents[agent]['seed']}"))
        driver = load_run(run).agent.as_policy(with_q=True)
        drives[name] = record(driver, [roads[road]], DEFAULT, method)[0]
    behaviour, _ = to.made("default")
    for name, rollout in drives.items():
        path = rollout.save(to.new / "rollouts" / f"{name}.npz")
        to.add(path, STUDY, fingerprints("road", "rule") | only(behaviour, rollout.label), provenance())


KEPT = {  # what no study makes: the command that does, and the behaviours that it depends on
    "bug_hunt.npz": (
        "python -m bootcourse.course.lessons.bug_hunt.bugs --out assets/bug_hunt.npz",
        ("road", "rule", "bootstrapped"),
    ),
    "students.npz": (
        "python -m bootcourse.research.teacher_reference --out assets/students.npz",
        ("road", "rule", "sac", "bootstrapped"),
    ),
    "ppo.npz": (
        "python -m bootcourse.research.ppo_reference --out assets/ppo.npz",
        ("road", "rule", "demonstrations", "ppo", "ppo_cloned"),
    ),
    "checks.md": ("python -m bootcourse.research.checks --out assets/checks.md", ("sac", "cql", "gail", "ppo")),
    "readme/*": ("python -m bootcourse.plots.readme_picture", ("road", "rule")),
}


def add_kept(to: Shipment, now: Path) -> None:
    """The bug hunt's agents, the independent checks and the README's pictures stay as they are; new ones are listed."""
    for pattern, (command, behaviours) in KEPT.items():
        for path in sorted(now.glob(pattern)):
            name = path.relative_to(now).as_posix()
            if to.entries.get(name, {}).get("sha256") != sha256(path):
                (to.new / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(path, to.new / name)
                to.add(to.new / name, command, fingerprints(*behaviours), provenance())


def add_card(to: Shipment) -> None:
    """The model card."""
    write_bytes(to.new / "MODEL_CARD.md", model_card(load_results(to.new / "study-default.npz"), RUNS).encode())
    behaviour, versions = to.behaviour_of("study-default.npz"), to.entries["study-default.npz"]["versions"]
    to.add(to.new / "MODEL_CARD.md", STUDY, behaviour | fingerprints("statistics"), versions)

"""Damage every kind of file and read it: each must give what was written, or one sentence that names the file.

    python -m tests.hostile.damage                  # 5,000 files
    python -m tests.hostile.damage --files 500 --seed 1

A file is damaged by chance (bits flipped, cut short, or both with bytes overwritten, left out and doubled), or on
purpose: a field of its JSON or one of its arrays is replaced, and its checksums are made to fit.
"""

import argparse
import io
import json
import shutil
import sys
import tempfile
import traceback
from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields, is_dataclass
from pathlib import Path

import numpy as np
import torch
from safetensors.numpy import load, save

from bootcourse.course.board import Row, keep_rows, ranked, read_rows
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.episodes.words import transcripts
from bootcourse.errors import BootcourseError
from bootcourse.files import provenance, read_arrays, sha256, write_json
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.training import Training
from bootcourse.policies import rule_policy
from bootcourse.research.jobs import FORMAT as JOB
from bootcourse.research.jobs import read_job
from bootcourse.research.results import load_results, save_results
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import Estimate
from bootcourse.storage.assets import FOLDER, MANIFEST, read_manifest
from bootcourse.storage.checkpoint import load_checkpoint, save_checkpoint, state_of
from bootcourse.storage.runs import HASHED, load_run, save_runs
from bootcourse.storage.sealed import write_sealed
from tests.hostile.payloads import PAYLOAD

NASTY = [None, True, -1, 0, 7, 99, 1.5, 1e308, -1e308, 10**19, 10**400, float("nan"), "", PAYLOAD, "$", "x" * 10**5]
NASTY += [[], [[]], [None] * 1000, {}, {"": {}}, "../../etc/passwd", "\0", "\ud800", "default", "sac"]
ARRAYS = [np.zeros(0), np.array(1.0), np.full((3, 3), np.nan), np.array(["a"]), np.array("{"), np.arange(10**5)]
ARRAYS += [np.array([{"a": 1}], dtype=object), np.zeros((1, 1, 1, 1), np.complex64), np.full(150, 99), np.full(150, -1)]


@dataclass(frozen=True)
class Kind:
    """A kind of file: `read(path)` gives everything that it holds; `use(value)` does with it what the kit does."""

    name: str
    path: Path
    read: Callable[[Path], object]
    use: Callable[[object], object] = lambda value: None
    resealed: Callable[[Path], None] = lambda path: None  # makes the hashes fit a file that was changed on purpose


def kinds(folder: Path) -> list[Kind]:
    """One whole file of each kind, in `folder`."""
    drive = record(rule_policy(DEFAULT), [1], DEFAULT, "rule")[0].save(folder / "drive.npz")
    small = settings_for("bootstrapped", demonstration_episodes=2, learning_starts=8, buffer_size=500)
    training = Training(with_seeds(small, 1), 2)
    training.step()
    save_checkpoint(training, folder / "checkpoint.npz")
    result = training.run(progress=False)
    run = save_runs(result, folder / "runs")[0]
    shipped = load_results(FOLDER / "study-default.npz").pick(range(3))
    save_results(shipped, folder / "results.npz", provenance())
    shutil.copy(FOLDER / MANIFEST, folder / MANIFEST)
    job = {"format": JOB, "asked": {}, "behaviour": {"road": [1.0, 2.0]}, "provenance": provenance(seconds=1.5)}
    write_sealed(folder / "job" / "job.json", job | {"sha256": {}})

    keep_rows(folder / "board.json", [], [Row("rule", "mine", 1, Estimate(51.0, 50.0, 52.0), 1, 1.0, 0.0)])

    def of_run(path: Path):
        return load_run(path.parent)

    def reseal(path: Path) -> None:
        made = json.loads((path.parent / "provenance.json").read_text())
        write_json(path.parent / "provenance.json", made | {"sha256": {n: sha256(path.parent / n) for n in HASHED}})
        _seal(path.parent / "provenance.json")

    return [
        Kind("rollout", drive, Rollout.load, _show),
        Kind("checkpoint", folder / "checkpoint.npz", lambda path: state_of(load_checkpoint(path))),
        *(Kind(f"run: {name}", run / name, of_run, lambda r: r.agent.probabilities(np.zeros((1, 26))), reseal)
          for name in HASHED),
        Kind("run: provenance.json", run / "provenance.json", of_run, resealed=_seal),
        Kind("results", folder / "results.npz", load_results, lambda r: [r.scores("success"), r.scores("collision")]),
        Kind("manifest", folder / MANIFEST, lambda path: read_manifest(path.parent), resealed=_seal),
        Kind("board", folder / "board.json", read_rows, lambda rows: str(ranked(rows, 140.6)), _seal),
        Kind("job", folder / "job" / "job.json", lambda path: read_job(path.parent), resealed=_seal),
    ]  # fmt: skip


def _seal(path: Path) -> None:
    content = json.loads(path.read_text())
    content.pop("seal", None)
    write_sealed(path, content)


def _show(rollout: Rollout) -> None:
    """Everything of a drive that becomes a page or words."""
    from bootcourse.replay3d import hud
    from bootcourse.replay3d.timeline import Timeline

    timelines = [Timeline(rollout)] * 2
    for t in (0.0, 1.3, timelines[0].duration):
        hud.card(timelines[0], t), hud.table(timelines, t)
    hud.plots(timelines), transcripts([rollout])


def by_chance(data: bytes, rng: np.random.Generator) -> tuple[str, bytes]:
    """One damage of the kinds that a disk, a cable or a text editor makes: (its name, the bytes)."""
    how = ("bit", "cut", "mixed")[rng.integers(3)]
    if how == "cut":
        return how, data[: rng.integers(len(data))]
    damaged = bytearray(data)
    for _ in range(1 if how == "bit" else rng.integers(1, 6)):
        place, long = int(rng.integers(len(damaged))), int(rng.integers(1, 200))
        which = 0 if how == "bit" else int(rng.integers(5))
        if which == 0:
            damaged[place] ^= 1 << int(rng.integers(8))
        elif which == 1:
            damaged[place : place + long] = rng.bytes(long)
        elif which == 2:
            del damaged[place : place + long]
        elif which == 3:
            damaged[place:place] = damaged[place : place + long]
        else:
            damaged[place : place + long] = bytes(long)
        damaged = damaged or bytearray(b"\0")
    return how, bytes(damaged)


def on_purpose(path: Path, rng: np.random.Generator) -> bytes:
    """The file with one field or array replaced, added or left out, and sound in itself."""
    data = path.read_bytes()
    if path.suffix == ".json":
        return _other_json(data.decode(), rng).encode("utf-8", "surrogatepass")
    if path.suffix == ".safetensors":
        return save(_other_arrays(load(data), rng, [a for a in ARRAYS if a.dtype.kind in "if"]))
    with np.load(io.BytesIO(data)) as file:
        arrays = {name: file[name] for name in file.files}
    texts = [name for name, values in arrays.items() if values.dtype.kind == "U"]
    if texts and rng.random() < 0.7:
        name = texts[rng.integers(len(texts))]
        arrays[name] = np.array(_other_json(str(arrays[name]), rng).encode("utf-8", "replace").decode())
    else:
        arrays = _other_arrays(arrays, rng, ARRAYS)
    buffer = io.BytesIO()
    np.savez_compressed(buffer, **arrays)
    return buffer.getvalue()


def _other_arrays(arrays: dict, rng: np.random.Generator, nasty: list) -> dict:
    name, other = str(rng.choice(list(arrays))), nasty[rng.integers(len(nasty))]
    values, how = arrays[name], rng.integers(5)
    if how == 0:
        return {each: of for each, of in arrays.items() if each != name}
    if how == 1:
        return arrays | {"surprise": other}
    if how == 2 and values.size and values.dtype.kind in "iuf":
        values = values.copy()
        values.flat[rng.integers(values.size)] = (99, -1, 120)[rng.integers(3)]
        return arrays | {name: values}
    if how == 3 and values.ndim:
        return arrays | {name: values[:-1]}
    return arrays | {name: other}


def _other_json(text: str, rng: np.random.Generator) -> str:
    """JSON text with one value replaced, left out or added, anywhere in it."""
    content = json.loads(text)
    places = list(_places(content))
    inside, key, _ = places[rng.integers(len(places))]
    how = rng.integers(6)
    if how == 0:
        del inside[key]
    elif how == 1 and isinstance(inside, dict):
        inside["surprise"] = NASTY[rng.integers(len(NASTY))]
    else:
        inside[key] = NASTY[rng.integers(len(NASTY))]
    return json.dumps(content)


def _places(value, above: str = "") -> Iterator[tuple]:
    """(object or list, key, the names on the way to it) of every value in JSON."""
    for key, below in [*value.items()] if isinstance(value, dict) else enumerate(value):
        field = f"{above}.{key}" if isinstance(value, dict) else f"{above}[]"
        yield value, key, field
        if isinstance(below, (dict, list)):
            yield from _places(below, field)


def with_text_for_numbers(path: Path) -> Iterator[tuple[str, bytes]]:
    """(field, the file with the payload instead of that number) for each number in its JSON, one of each list."""
    if path.suffix == ".json":
        yield from ((field, text.encode()) for field, text in _with_text_for_numbers(path.read_text()))
    elif path.suffix == ".npz":
        arrays = read_arrays(path)
        for name in [name for name, values in arrays.items() if values.dtype.kind == "U"]:
            for field, text in _with_text_for_numbers(str(arrays[name])):
                buffer = io.BytesIO()
                np.savez(buffer, **arrays | {name: np.array(text)})
                yield f"{name}: {field}", buffer.getvalue()


def _with_text_for_numbers(text: str) -> Iterator[tuple[str, str]]:
    content, seen = json.loads(text), set()
    for inside, key, field in _places(content):
        number = inside[key]
        if isinstance(number, (int, float)) and not isinstance(number, bool) and field not in seen:
            seen.add(field)
            inside[key] = PAYLOAD
            yield field, json.dumps(content)
            inside[key] = number


def same(a, b) -> bool:
    """Are two values that were read equal, in every array and every bit of them?"""
    if is_dataclass(a):
        return type(a) is type(b) and all(same(getattr(a, f.name), getattr(b, f.name)) for f in fields(a))
    if isinstance(a, dict):
        return isinstance(b, dict) and a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    if isinstance(a, (list, tuple)):
        return isinstance(b, (list, tuple)) and len(a) == len(b) and all(map(same, a, b))
    if isinstance(a, (np.ndarray, torch.Tensor)):
        a, b = np.asarray(a), np.asarray(b)
        return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()
    return a == b


def attempt(kind: Kind, good, rng: np.random.Generator) -> tuple[str, str]:
    """Damage the file once, read it, and put it back: (how it was damaged, what came of it)."""
    whole = {path: path.read_bytes() for path in kind.path.parent.iterdir() if path.is_file()}
    how, damaged = ("purpose", on_purpose(kind.path, rng)) if rng.random() < 0.4 else by_chance(whole[kind.path], rng)
    kind.path.write_bytes(damaged)
    if how == "purpose":
        kind.resealed(kind.path)
    try:
        found = kind.read(kind.path)
        kind.use(found)
        return how, "read" if how == "purpose" or same(found, good) else "wrong"
    except BootcourseError as error:
        sentence = str(error)
        names_it = str(kind.path) in sentence or str(kind.path.parent) in sentence
        return how, "refused" if names_it and "\n" not in sentence else f"traceback: no sentence: {sentence}"
    except Exception:
        return how, f"traceback: {traceback.format_exc()}"
    finally:
        for path, data in whole.items():
            path.write_bytes(data)


def damage(files: int, seed: int = 0) -> dict[str, dict[str, list[str]]]:
    """Damage so many files, of all kinds in turn: {kind: {outcome: what happened}}."""
    rng = np.random.default_rng(seed)
    with tempfile.TemporaryDirectory() as folder:
        every = kinds(Path(folder))
        good = {kind.name: kind.read(kind.path) for kind in every}
        outcomes = {kind.name: {"read": [], "refused": [], "wrong": [], "traceback": []} for kind in every}
        for i in range(files):
            kind = every[i % len(every)]
            how, outcome = attempt(kind, good[kind.name], rng)
            outcomes[kind.name][outcome.partition(":")[0]].append(f"file {i}, {how}: {outcome}")
    return outcomes


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--files", type=int, default=5000)
    parser.add_argument("--seed", type=int, default=0)
    options, _ = parser.parse_known_args()
    outcomes = damage(options.files, options.seed)
    print(f"{'kind of file':24}{'files':>7}{'read':>7}{'refused':>9}{'silently wrong':>16}{'tracebacks':>12}")
    for name, by in outcomes.items():
        counts = [len(by[outcome]) for outcome in ("read", "refused", "wrong", "traceback")]
        print(f"{name:24}{sum(counts):7}{counts[0]:7}{counts[1]:9}{counts[2]:16}{counts[3]:12}")
    bad = [f"{name}: {what}" for name, by in outcomes.items() for what in by["traceback"]]
    print(*bad[:20], sep="\n")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())

"""Damaged files of every format are read right or refused in one sentence that names them; no text runs in a page."""

import io
import json
import shutil
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from safetensors.numpy import load, save

from bootcourse.course.classroom.handout import Handout
from bootcourse.course.predictions import predictions
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.errors import BootcourseError
from bootcourse.files import provenance, read_json, sha256, write_json
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.training import Training
from bootcourse.policies import rule_policy
from bootcourse.replay3d import export, recording
from bootcourse.research.jobs import FORMAT as JOB
from bootcourse.research.jobs import read_job
from bootcourse.research.results import load_results, save_results
from bootcourse.scenario import DEFAULT, Clock, Sight
from bootcourse.storage.assets import FOLDER, MANIFEST, read_manifest
from bootcourse.storage.checkpoint import load_checkpoint, save_checkpoint
from bootcourse.storage.runs import HASHED, load_run, save_runs
from bootcourse.storage.sealed import write_sealed

IMAGE = "<img src=http://fired.invalid/ onerror=alert(1)>"
PAYLOAD = f"\"'></script>{IMAGE}<script>alert(2)</script>@PLOTS@{{0.__class__}}$"


@dataclass(frozen=True)
class Format:
    """A format of the kit's files."""

    path: Path  # of a whole file
    read: Callable[[Path], object]
    seal: Callable[[Path], None] = lambda path: None  # makes the hashes fit a file that was changed on purpose


def seal(path: Path) -> None:
    content = json.loads(path.read_text())
    write_sealed(path, {name: value for name, value in content.items() if name != "seal"})


def seal_run(path: Path) -> None:
    described = path.with_name("provenance.json")
    write_json(described, json.loads(described.read_text()) | {"sha256": {n: sha256(path.parent / n) for n in HASHED}})
    seal(described)


@pytest.fixture(scope="module")
def formats(tmp_path_factory) -> dict[str, Format]:
    """A whole file of each format."""
    folder = tmp_path_factory.mktemp("files")
    small = settings_for("bootstrapped", demonstration_episodes=2, learning_starts=8, buffer_size=500)
    training = Training(with_seeds(small, 1), 2)
    training.step()
    save_checkpoint(training, folder / "checkpoint.npz")
    run = save_runs(training.run(progress=False), folder / "runs")[0]
    drive = record(rule_policy(DEFAULT), [1], DEFAULT, "rule")[0].save(folder / "drive.npz")
    save_results(load_results(FOLDER / "study-default.npz").pick(range(3)), folder / "results.npz", provenance())
    shutil.copy(FOLDER / MANIFEST, folder / MANIFEST)
    contents = {"provenance": provenance(seconds=1.5), "sha256": {}}
    write_sealed(folder / "job" / "job.json", {"format": JOB, "asked": {}} | contents)
    handout = {"format": Handout.FORMAT, "lessons": [5], "solutions": True, "files": {}}
    write_json(folder / "handout.json", handout)
    answers = folder / "answers" / "predictions.json"
    write_json(answers, {"5.1": {"question": "How many?", "choices": [], "unit": "", "answer": 2.5, "time": ""}})

    def read_run(path: Path):
        return load_run(path.parent)

    return {
        "rollout": Format(drive, Rollout.load),
        "checkpoint": Format(folder / "checkpoint.npz", load_checkpoint),
        "results": Format(folder / "results.npz", load_results),
        **{f"run: {name}": Format(run / name, read_run, seal_run) for name in HASHED},
        "run: provenance": Format(run / "provenance.json", read_run, seal),
        "manifest": Format(folder / MANIFEST, lambda path: read_manifest(path.parent), seal),
        "job": Format(folder / "job" / "job.json", lambda path: read_job(path.parent), seal),
        "handout": Format(folder / "handout.json", lambda path: read_json(path, Handout)),
        "predictions": Format(answers, lambda path: predictions(path.parents[1])),
    }


FORMATS = ["rollout", "checkpoint", "results", *(f"run: {name}" for name in HASHED), "run: provenance", "manifest"]
FORMATS += ["job", "handout", "predictions"]
DAMAGE = {
    "empty": lambda data: b"",
    "cut short": lambda data: data[: len(data) * 2 // 3],
    "a list instead": lambda data: b"[]",
    "zeros": lambda data: bytes(len(data)),
    "a piece left out": lambda data: data[: len(data) // 2] + data[len(data) // 2 + 40 :],  # more than white space
}
WITHOUT_HASH = {("handout", "a piece left out"), ("predictions", "a piece left out")}  # written by hand, too


def refusal(format: Format, changed: bytes, sealed: bool) -> str:
    """The sentence with which the changed file is refused; the whole one is put back."""
    whole = {path: path.read_bytes() for path in format.path.parent.iterdir() if path.is_file()}
    format.path.write_bytes(changed)
    if sealed:
        format.seal(format.path)
    try:
        with pytest.raises(BootcourseError) as error:
            format.read(format.path)
    finally:
        for path, data in whole.items():
            path.write_bytes(data)
    return str(error.value)


@pytest.mark.parametrize("how", DAMAGE)
@pytest.mark.parametrize("name", FORMATS)
def test_a_damaged_file_is_refused_in_one_sentence_that_names_it(name, how, formats):
    if (name, how) not in WITHOUT_HASH:
        sentence = refusal(formats[name], DAMAGE[how](formats[name].path.read_bytes()), sealed=False)
        assert str(formats[name].path.parent) in sentence and "\n" not in sentence


# Changed on purpose, with hashes that fit -------------------------------------------------------------


def fields(value, above: str = "") -> Iterator[tuple]:
    """(object or list, key, the names on the way to it) of every value in JSON."""
    for key, below in [*value.items()] if isinstance(value, dict) else enumerate(value):
        name = f"{above}.{key}" if isinstance(value, dict) else f"{above}[]"
        yield value, key, name
        if isinstance(below, (dict, list)):
            yield from fields(below, name)


def with_payload(text: str) -> Iterator[tuple[str, str]]:
    """(field, the JSON with a script instead of that number) for each number, one of each list."""
    content, seen = json.loads(text), set()
    for inside, key, name in fields(content):
        number = inside[key]
        if isinstance(number, (int, float)) and not isinstance(number, bool) and name not in seen:
            seen.add(name)
            inside[key] = PAYLOAD
            yield name, json.dumps(content)
            inside[key] = number


def arrays_of(data: bytes) -> dict[str, np.ndarray]:
    with np.load(io.BytesIO(data)) as file:
        return {name: file[name] for name in file.files}


def packed(arrays: dict[str, np.ndarray]) -> bytes:
    stream = io.BytesIO()
    np.savez(stream, **arrays)
    return stream.getvalue()


def changed_texts(path: Path) -> Iterator[tuple[str, bytes]]:
    """Every change of `with_payload` in a JSON file, or in the JSON inside an .npz file."""
    if path.suffix == ".json":
        yield from ((name, text.encode()) for name, text in with_payload(path.read_text()))
    if path.suffix == ".npz":
        arrays = arrays_of(path.read_bytes())
        for array in [name for name, values in arrays.items() if values.dtype.kind == "U"]:
            for name, text in with_payload(str(arrays[array])):
                yield f"{array}: {name}", packed(arrays | {array: np.array(text)})


@pytest.mark.parametrize("name", [name for name in FORMATS if name not in ("handout", "predictions")])
def test_text_where_a_number_belongs_is_refused_in_every_field(name, formats):
    for field, changed in changed_texts(formats[name].path):
        assert refusal(formats[name], changed, sealed=True), field


@pytest.mark.parametrize(
    ("entries", "words"),
    [
        ({"format": "bootcourse run 99"}, "this version reads 'bootcourse run 1'"),
        ({"scenario": asdict(replace(DEFAULT, sight=Sight(neighbours=6)))}, "actor.0"),
        ({"settings": {"method": "bootstrapped", "hidden": [32, 32]}}, "actor.0"),
        ({"settings": {"method": "bootstrapped", "hidden": [64]}}, "weights.safetensors is incomplete"),
        ({"settings": {"method": "sac", "invented_later": 1}}, "no invented_later"),
        ({"settings": {"method": "bootstrapped", "gamma": 10**400}}, "gamma"),
        ({"episodes": 13}, "curves.npz"),
        ({"comment": "x"}, "comment"),
    ],
)
def test_a_wrong_entry_of_a_run_is_named(entries, words, formats):
    config = formats["run: config.json"]
    sentence = refusal(config, json.dumps(json.loads(config.path.read_text()) | entries).encode(), sealed=True)
    assert words in sentence and str(config.path.parent) in sentence and "\n" not in sentence


def test_weights_that_are_not_numbers_are_refused(formats):
    weights = load(formats["run: weights.safetensors"].path.read_bytes())
    changed = save(weights | {"actor.0": np.full_like(weights["actor.0"], np.nan)})
    assert "NaN or infinity" in refusal(formats["run: weights.safetensors"], changed, sealed=True)


@pytest.mark.parametrize("name", ["run: config.json", "manifest", "job"])
def test_a_long_text_in_a_file_makes_no_long_sentence(name, formats):
    content = json.loads(formats[name].path.read_text())
    for field in content.keys() & {"format", "environment"}:
        sentence = refusal(formats[name], json.dumps(content | {field: "x" * 5000}).encode(), sealed=True)
        assert "xxx" in sentence and len(sentence) < 600


@pytest.mark.parametrize("other", [np.zeros(0), np.full((3, 3), np.nan), np.array(["a"]), np.zeros((1, 1, 1, 1))])
@pytest.mark.parametrize("name", ["rollout", "checkpoint", "results", "run: curves.npz", "run: weights.safetensors"])
def test_an_array_of_another_shape_or_type_is_refused(name, other, formats):
    data, is_weights = formats[name].path.read_bytes(), name.endswith("safetensors")
    arrays = load(data) if is_weights else arrays_of(data)
    if is_weights and other.dtype.kind == "U":
        return  # the format has no text
    first = next(key for key, values in arrays.items() if values.dtype.kind != "U")
    changed = arrays | {first: other}
    refusal(formats[name], save(changed) if is_weights else packed(changed), sealed=True)


def test_no_text_of_a_rollout_is_markup_in_a_page_that_shows_it(tmp_path):
    short = replace(DEFAULT, clock=Clock(decisions=4), name=PAYLOAD)
    drive = record(rule_policy(short), [1], short, "rule")[0]
    for name, text in {"label": PAYLOAD, "seed": PAYLOAD, "provenance": {PAYLOAD: PAYLOAD}}.items():
        object.__setattr__(drive, name, text)  # behind the checks of `Rollout`: what makes the pages is tested alone
    page, cell = export(drive, tmp_path / "page.html").read_text(), recording(drive)._repr_mimebundle_()["text/html"]
    assert IMAGE not in page and IMAGE not in cell and "fired.invalid" in page

"""The file of an agent that learned in the page: one file of safetensors, written by web/run_file.js.

Its tensors are those of a run's weights, the target critics, log α and the curves, all float32; its metadata are the
texts "format", "config" (as a run's config.json) and "provenance".
"""

import json
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from msgspec import Meta, Struct
from safetensors.numpy import load

from bootcourse.errors import BootcourseError
from bootcourse.files import LARGEST_ARRAYS, check_arrays, decoding, parse, read_bytes
from bootcourse.learn.agent import Agent
from bootcourse.learn.curves import NAMES
from bootcourse.learn.learner import SACLearner
from bootcourse.learn.settings import stored_settings
from bootcourse.learn.teachers import course_rule, teacher_of
from bootcourse.storage.runs import Config, Run, networks_of

FORMAT = "bootcourse page run 1"
AGAIN = "save it from the page again"


class PageProvenance(Struct):
    """How the agent came about: what was changed while it learned stands in `marks`, [{"episode", "changes"}]."""

    seed: Annotated[int, Meta(ge=0)]
    seconds: Annotated[float, Meta(ge=0)]
    updates: Annotated[int, Meta(ge=0)]
    marks: list[dict[str, Any]]
    browser: str
    created: str


def read_page_run(path: Path) -> Run:
    """Read and check an agent's file from the page. Its settings are those that it began with.

    Raises BootcourseError, with the file and the remedy, for a damaged file or another one.
    """
    path = Path(path)
    data = read_bytes(path, LARGEST_ARRAYS, AGAIN)
    with decoding(path, AGAIN):
        tensors = load(data)
        texts = json.loads(data[8 : 8 + int.from_bytes(data[:8], "little")]).get("__metadata__", {})
    if texts.get("format") != FORMAT:
        raise BootcourseError(f"{path} is no agent of the page that learns: give a file that it saved, or a folder.")
    config = parse(texts.get("config", ""), Config, path, AGAIN)
    told = parse(texts.get("provenance", ""), PageProvenance, path, AGAIN)
    with decoding(path, AGAIN):
        settings = stored_settings(config.settings)
    curves = {name: tensors.pop(f"curves.{name}", np.empty(0)).astype(np.float64) for name in NAMES}
    check_arrays(curves, dict.fromkeys(NAMES, (config.episodes,)), path, AGAIN)
    log_alpha = {"log_alpha": tensors.pop("log_alpha", np.empty(0))}
    check_arrays(log_alpha, {"log_alpha": (1,)}, path, AGAIN)
    targets = [name for name in tensors if name.startswith("targets.")]
    targets = {name.replace("targets", "critics"): tensors.pop(name) for name in targets}
    actor, critics = networks_of(tensors, settings, config.scenario, path, SACLearner, AGAIN)
    networks_of({**tensors, **targets}, settings, config.scenario, path, SACLearner, AGAIN)
    taught = teacher_of(course_rule, config.scenario)
    agent = Agent(settings, actor, critics, config.alpha, taught)
    told = {name: getattr(told, name) for name in told.__struct_fields__}
    return Run(agent, curves, config.scenario, {**told, "teacher": "rule"})

"""Recording, saving and loading drives, and what happens when a file or a disk is damaged."""

import json
from dataclasses import asdict, fields, replace

import numpy as np
import pytest

import bootcourse  # noqa: F401  registers the road
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Header, Rollout
from bootcourse.errors import BootcourseError
from bootcourse.policies import PolicyOutput, stochastic_rule_policy
from bootcourse.road.state import EGO, Accident, X
from bootcourse.scenario import DEFAULT, Clock

SHORT = replace(DEFAULT, clock=Clock(decisions=12))
AS_STORED = asdict(DEFAULT)  # a scenario in a file


def brake(observations, cars) -> PolicyOutput:
    n = len(observations)
    return PolicyOutput(np.full(n, 1), np.full((n, 9), 1 / 9), np.tile(np.arange(9.0), (n, 1)))


@pytest.fixture(scope="module")
def rollout() -> Rollout:
    return record(brake, [3], SHORT, label="brake")[0]


def differing_fields(a: Rollout, b: Rollout, tolerance: float = 0.0) -> list[str]:
    different = []
    for f in fields(Rollout):
        x, y = getattr(a, f.name), getattr(b, f.name)
        if isinstance(x, np.ndarray):
            same = y is not None and x.shape == y.shape and x.dtype == y.dtype and np.abs(x - y).max() <= tolerance
        else:
            same = x == y
        different += [] if same else [f.name]
    return different


# Recording


def test_a_rollout_tells_the_whole_drive(rollout):
    assert rollout.accident == Accident.STOPPAGE and not rollout.success
    decisions = len(rollout.actions)
    assert decisions == 10, "from 10 m/s at 1 m/s² to under 1 m/s"
    assert rollout.states.shape[0] in (2 * decisions, 2 * decisions + 1)
    assert rollout.times[-1] == (len(rollout.states) - 1) / 2
    assert rollout.distance == rollout.states[-1, EGO, X] > 40
    assert rollout.rewards[-1] == -10.0
    assert (rollout.rule_actions[0], rollout.policy.shape, rollout.q_values.shape) == (1, (10, 9), (10, 9))
    assert {"python", "numpy", "highway-env", "bootcourse"} <= set(rollout.provenance)


# Saving and loading


def test_what_is_loaded_is_what_was_saved(rollout, tmp_path):
    path = rollout.save(tmp_path / "deep" / "drive.npz")
    assert differing_fields(Rollout.load(path), rollout) == []
    without = replace(rollout, policy=None, q_values=None)
    assert Rollout.load(without.save(tmp_path / "other.npz")).policy is None
    stochastic = record(stochastic_rule_policy(SHORT, np.random.default_rng(0)), [0], SHORT)[0]
    assert differing_fields(Rollout.load(stochastic.save(tmp_path / "drive.npz")), stochastic) == []


def damage(path, **arrays):
    """Save again with some arrays or header fields replaced (None: left out)."""
    with np.load(path) as file:
        contents = {name: file[name] for name in file.files}
    header = json.loads(str(contents["header"]))
    for name, value in arrays.items():
        (header if name in header else contents)[name] = value
    if "header" not in arrays:
        contents["header"] = np.array(json.dumps({name: value for name, value in header.items() if value is not None}))
    np.savez(path, **{name: value for name, value in contents.items() if value is not None})


def refusal(path) -> str:
    with pytest.raises(BootcourseError) as error:
        Rollout.load(path)
    sentence = str(error.value)
    assert str(path) in sentence and "\n" not in sentence
    return sentence


NAN_REWARDS = np.full(10, np.nan)


@pytest.mark.parametrize(
    ("damages", "words"),
    [
        ({"rewards": NAN_REWARDS}, "rewards hold NaN"),
        ({"rewards": np.zeros(9)}, "rewards have shape (9,), not (10,)"),
        ({"rewards": None}, "incomplete"),
        ({"policy": np.full((10, 9), np.inf)}, "policy hold NaN or a number outside"),
        ({"actions": np.zeros(0, np.int64)}, "no decisions"),
        ({"actions": np.full(10, 9)}, "outside 0..8"),
        ({"actions": np.full(10, 4.5)}, "actions"),
        ({"states": np.zeros((3, 9, 10))}, "simulation steps"),
        ({"accident": 7}, "accident"),
        ({"rule_p": None}, "missing required field `rule_p`"),
        ({"scenario": AS_STORED | {"road": {"lanes": 0}}}, "Road.lanes = 0"),
        ({"scenario": {}}, "Scenario in another version has other fields"),
        ({"scenario": AS_STORED | {"moon": 1}}, "other fields: 'moon'"),
        ({"surprise": np.zeros(3)}, "surprise"),
        ({"format": "bootcourse rollout 99"}, f"this version reads '{Header.FORMAT}'"),
        ({"header": np.array("{")}, "Input data was truncated"),
        ({"header": np.array("[]")}, "Expected `object`, got `array`"),
        ({"header": None}, "not a rollout"),
    ],
)
def test_a_damaged_rollout_is_refused_in_one_sentence(rollout, tmp_path, damages, words):
    path = rollout.save(tmp_path / "drive.npz")
    damage(path, **damages)
    assert words in refusal(path)
    with pytest.raises(BootcourseError, match="rewards hold NaN"):
        replace(rollout, rewards=NAN_REWARDS)  # it cannot even be made

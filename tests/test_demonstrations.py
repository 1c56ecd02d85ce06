"""Demonstrations as data: names in the order of the drives, the rows that learners use, and Minari."""

from dataclasses import replace

import gymnasium as gym
import numpy as np
import pytest
import torch

import bootcourse as bc
from bootcourse.errors import BootcourseError
from bootcourse.learn.demonstrations import FIRST_SEED
from bootcourse.policies import random_policy
from bootcourse.scenario import DEFAULT, Clock

SHORT = replace(DEFAULT, name="short", clock=Clock(decisions=10))


@pytest.fixture(scope="module")
def wild() -> bc.Demonstrations:
    """Drives of a random driver with the rule's opinion, some of which end in accidents and some in time."""
    return bc.demonstrate(20, SHORT, random_policy(np.random.default_rng(1)))


def test_each_drive_is_what_a_single_car_drives_on_its_road(wild):
    assert {bool(wild.terminated[drive][-1]) for drive in wild.drives} == {True, False}
    assert len(wild.drives) == 20 and wild.seeds == tuple(range(FIRST_SEED, FIRST_SEED + 20))
    env = gym.make("bootcourse:FastTrap-v0", scenario=SHORT)
    for seed, drive in zip(wild.seeds, wild.drives, strict=True):
        seen, _ = env.reset(seed=seed)
        for t in range(drive.start, drive.stop):
            assert (wild.observations[t] == seen).all()
            by_rule = bc.rule.rule(env.unwrapped.cars()[None], SHORT).actions
            assert wild.rule_actions[t] == by_rule[0]
            seen, reward, terminated, truncated, _ = env.step(int(wild.actions[t]))
            assert (wild.next_observations[t] == seen).all() and wild.rewards[t] == reward
            assert (wild.terminated[t], wild.truncated[t]) == (terminated, truncated)
        assert terminated or truncated


def test_collect_has_the_same_transitions_in_the_order_of_the_decisions(wild):
    rows, by_drive = bc.collect(20, SHORT, random_policy(np.random.default_rng(1))), wild.rows()
    decision = np.concatenate([np.arange(drive.stop - drive.start) for drive in wild.drives])
    torch.testing.assert_close(rows, by_drive[np.argsort(decision, kind="stable")], rtol=0, atol=0)


def test_a_training_takes_them(wild):
    settings = bc.with_seeds(bc.settings_for("demos", hidden=(8,), learning_starts=10), 1)
    training = bc.Training(settings, 2, SHORT, demonstrations=wild)
    assert training.replay.demonstrations == len(wild)
    with pytest.raises(BootcourseError, match="uses no demonstrations"):
        bc.Training(bc.with_seeds(bc.settings_for("sac"), 1), 2, SHORT, demonstrations=wild)


def test_drives_without_an_end_and_columns_of_different_lengths_are_refused(wild):
    columns = {name: getattr(wild, name) for name in vars(wild)}
    with pytest.raises(BootcourseError, match="The last drive has no end"):
        bc.Demonstrations(**{name: values[:3] for name, values in columns.items()})
    with pytest.raises(BootcourseError, match="differ in length"):
        bc.Demonstrations(**columns | {"rewards": wild.rewards[1:]})


@pytest.fixture
def minari(monkeypatch, tmp_path):
    """Minari, with a folder of its own for datasets."""
    minari = pytest.importorskip("minari", reason="not part of the lock: pip install minari h5py")
    monkeypatch.setenv("MINARI_DATASETS_PATH", str(tmp_path))
    return minari


def test_minari_keeps_the_drives_the_rule_s_opinion_and_the_road(wild, minari):
    from bootcourse.others.minari import from_minari, to_minari

    to_minari(wild, "trap/wild-v0", SHORT, driver="random", author="somebody", author_email="somebody@example.org")
    dataset = minari.load_dataset("trap/wild-v0")
    again = from_minari(dataset)
    for name, values in vars(wild).items():
        np.testing.assert_array_equal(getattr(again, name), values, err_msg=name)
        assert np.asarray(getattr(again, name)).dtype == np.asarray(values).dtype, name
    env = dataset.recover_environment()
    assert env.unwrapped.scenario == SHORT
    assert (env.reset(seed=wild.seeds[0])[0] == wild.observations[0]).all()
    with pytest.raises(BootcourseError, match="'trap/wild-v0' already"):
        to_minari(wild, "trap/wild-v0", SHORT)

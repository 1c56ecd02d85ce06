"""The independent checks: their environments, one check in small, and their page."""

from dataclasses import replace

import numpy as np
import pytest
import torch

from bootcourse.learn.replay_buffer import decode_transitions
from bootcourse.learn.settings import settings_for
from bootcourse.learn.teachers import teacher_policy
from bootcourse.policies import PolicyOutput
from bootcourse.research.experiments import checks

BALANCE = teacher_policy(checks.balance, None, 2)


def falls(observations, cars):
    return PolicyOutput(np.ones(len(observations), dtype=np.int64))


def test_collected_rows_are_whole_episodes_with_their_true_last_states():
    rows, mean = checks.data(falls, checks.cartpole, 5)
    batch = decode_transitions(rows, 4, torch.zeros(len(rows)))
    assert len(rows) == 5 * mean and batch.terminated.sum() == 5
    angles = batch.next_states[batch.terminated == 1][:, 2].abs() * checks.CARTPOLE_SCALES[2]
    assert (angles > 12 * 2 * np.pi / 360).all()  # where it fell, not where it started anew
    rows, mean = checks.data(BALANCE, checks.cartpole, 10)
    assert mean == 500, "the demonstrator balances every pole to the end"
    assert not decode_transitions(rows, 4, torch.zeros(len(rows))).terminated.any()  # out of time


def test_the_cartpole_of_fixed_length_pays_only_while_the_pole_is_up_and_never_ends_early():
    rows, mean = checks.data(falls, checks.fixed_cartpole, 3)
    assert len(rows) == 3 * 500 and mean < 100
    assert checks.data(BALANCE, checks.fixed_cartpole, 3)[1] == 500


def cloned(seeds: int) -> checks.Trained:
    """Clones of the demonstrator, from 5 demonstrations."""
    rows, returns = checks.data(BALANCE, checks.cartpole, 5)
    settings = [settings_for("bc", envs_per_agent=1, learning_starts=0, seed=seed) for seed in range(seeds)]
    return checks.train(settings, checks.cartpole, 1500, rows), [returns]


def test_a_check_trains_its_agents_and_its_page_says_whether_they_reach_the_published_figure(monkeypatch):
    for name, published in (("gail-cartpole", 450.0), ("cql-cartpole", 600.0)):
        one = replace(checks.CHECKS[name], published=published, train=cloned, make_env=checks.cartpole)
        monkeypatch.setitem(checks.CHECKS, name, one)
    results = checks.run_check("gail-cartpole", 2)
    assert results.measured["return"].shape == (2,) and results.measured["return"].min() > 450
    yes, no = checks.page({"gail-cartpole": results, "cql-cartpole": results}).splitlines()[-2:]
    assert "| yes |" in yes and "2 seeds (the demonstrator: 500)" in yes and "| **no** |" in no


@pytest.mark.parametrize(("published", "score", "verdict"), [(100, 99, True), (100, 98.9, False), (-90, -91.0, False)])
def test_within_one_percent_below_counts_as_reached(published, score, verdict):
    assert checks.is_reached(np.array([score]), replace(checks.CHECKS["gail-cartpole"], published=published)) is verdict

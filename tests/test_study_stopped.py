"""An agent with a non-finite loss is frozen at its last finite snapshot; the others go on."""

import numpy as np
import pytest
import torch

from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.training import Training
from bootcourse.storage.checkpoint import load_checkpoint, save_checkpoint
from bootcourse.storage.runs import load_run, save_runs

pytestmark = pytest.mark.filterwarnings("ignore:sac, seed 1")


def trained_a_little() -> Training:
    settings = settings_for("sac", learning_starts=16, hidden=(8,), buffer_size=2000)
    training = Training(with_seeds(settings, 3), episodes=60)
    for _ in range(12):
        training.step()
    return training


def poison(training: Training) -> None:
    """The next loss of agent 1 is not a number."""
    rows = training.replay.first[1] + np.arange(training.replay.size)
    training.replay.table[torch.from_numpy(rows), 2 * 26 + 1] = float("nan")  # its rewards


def test_the_agent_keeps_finite_weights_its_run_names_the_decision_and_the_others_go_on(tmp_path):
    training = trained_a_little()
    poison(training)
    with pytest.warns(UserWarning, match="sac, seed 1: its loss was not finite at decision 52; it stops there"):
        result = training.run(progress=False)
    alone = trained_a_little().run(progress=False)
    frozen = result.agents[1]
    assert result.stopped == {1: 52} and np.isnan(result.curves["return"][1, -1])
    assert all(torch.isfinite(weights).all() for weights in (*frozen.actor, *frozen.critics)) and frozen.alpha > 0
    for agent in (0, 2):
        np.testing.assert_array_equal(result.curves["return"][agent], alone.curves["return"][agent])
        assert torch.equal(result.agents[agent].actor[0], alone.agents[agent].actor[0])
    decisions = [load_run(path).provenance["stopped_at_decision"] for path in save_runs(result, tmp_path)]
    assert decisions == [None, 52, None]


def test_a_checkpoint_remembers_who_was_stopped_and_the_last_finite_snapshots(tmp_path):
    training = trained_a_little()
    save_checkpoint(training, tmp_path / "before.npz")
    resumed = load_checkpoint(tmp_path / "before.npz")
    for each in (training, resumed):
        poison(each)
        each.step()
    assert torch.equal(training.finished_agents[1].actor[0], resumed.finished_agents[1].actor[0])
    save_checkpoint(training, tmp_path / "after.npz")
    assert load_checkpoint(tmp_path / "after.npz").stopped == {1: 52}

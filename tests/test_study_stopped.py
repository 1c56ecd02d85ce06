"""An agent with a non-finite loss is frozen at its last finite snapshot; the others go on, the decision is named."""

import numpy as np
import pytest
import torch

from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.training import Training
from bootcourse.storage.checkpoint import load_checkpoint, save_checkpoint
from bootcourse.storage.runs import load_run, save_runs

TINY = {"learning_starts": 16, "hidden": (8,), "buffer_size": 2000}


def training(seeds: int = 3) -> Training:
    return Training(with_seeds(settings_for("sac", **TINY), seeds), episodes=60)


def poison(training: Training, agent: int) -> None:
    """The next loss of this agent is not a number."""
    rows = training.replay.first[agent] + np.arange(training.replay.size)
    training.replay.table[torch.from_numpy(rows), 2 * 26 + 1] = float("nan")  # its rewards


def stepped(seeds: int = 3, steps: int = 12) -> Training:
    made = training(seeds)
    for _ in range(steps):
        made.step()
    return made


@pytest.fixture(scope="module")
def outcome():
    made = stepped()
    poison(made, 1)
    with pytest.warns(UserWarning, match="sac, seed 1: its loss was not finite at decision 52; it stops there"):
        return made.run(progress=False)


def test_the_step_is_named_and_the_agent_keeps_weights_that_are_numbers(outcome):
    assert outcome.stopped == {1: 52}
    stopped = outcome.agents[1]
    assert all(torch.isfinite(weights).all() for weights in (*stopped.actor, *stopped.critics)) and stopped.alpha > 0
    assert np.isnan(outcome.curves["return"][1, -1])


def test_the_others_go_on_as_if_nothing_had_happened(outcome):
    alone = stepped().run(progress=False)
    for agent in (0, 2):
        np.testing.assert_array_equal(outcome.curves["return"][agent], alone.curves["return"][agent])
        for here, there in zip(outcome.agents[agent].actor, alone.agents[agent].actor, strict=True):
            assert torch.equal(here, there)


def test_its_run_is_saved_and_says_where_it_stopped(outcome, tmp_path):
    folders = save_runs(outcome, tmp_path)
    assert load_run(folders[1]).provenance["stopped_at_decision"] == 52
    assert load_run(folders[0]).provenance["stopped_at_decision"] is None


@pytest.mark.filterwarnings("ignore:sac, seed 1")
def test_a_checkpoint_remembers_who_was_stopped(tmp_path):
    made = stepped(2)
    poison(made, 1)
    made.step()
    save_checkpoint(made, tmp_path / "checkpoint.npz")
    result = load_checkpoint(tmp_path / "checkpoint.npz").run(progress=False)
    assert result.stopped == {1: 52} and torch.isfinite(result.agents[1].actor[0]).all()


@pytest.mark.filterwarnings("ignore:sac, seed 1")
def test_an_agent_that_diverges_after_a_resume_keeps_the_weights_that_it_would_have_kept_without(tmp_path):
    made = stepped(2, steps=40)
    save_checkpoint(made, tmp_path / "checkpoint.npz")
    resumed = load_checkpoint(tmp_path / "checkpoint.npz")
    assert resumed.updates == made.updates > 0
    for each in (made, resumed):
        poison(each, 1)
        each.step()
    assert torch.equal(made.finished_agents[1].actor[0], resumed.finished_agents[1].actor[0])


def test_stochastic_demonstrations_are_other_demonstrations():
    few = TINY | {"demonstration_episodes": 3}
    mu, pi = (
        Training(with_seeds(settings_for("demos", stochastic_demonstrations=drive, **few), 1), 1)
        for drive in (False, True)
    )
    assert not torch.equal(mu.replay.table[: mu.replay.demonstrations], pi.replay.table[: pi.replay.demonstrations])

"""What holds for each method of the registry: it is read back as it was saved, and goes on after a stop."""

from dataclasses import replace

import numpy as np
import pytest
import torch

from bootcourse.episodes.evaluate import evaluate
from bootcourse.learn.learner import learner_for
from bootcourse.learn.settings import Settings, settings_for, with_seeds
from bootcourse.learn.training import Training
from bootcourse.methods import ABLATION, METHODS
from bootcourse.scenario import DEFAULT, Sight
from bootcourse.storage.runs import load_checkpoint, load_run, save_checkpoint, save_runs
from tests.test_baselines import a_batch

QUICK = {"hidden": (8,), "demonstration_episodes": 2, "learning_starts": 16, "batch": 16, "guide_decisions": 4,
         "stages": 2, "window": 2, "horizon": 8, "epochs": 2, "cloning_updates": 5}  # fmt: skip

FADING = {  # what changes in a few episodes
    "ppo": {"anneal_decisions": 200},
    "ppo_kl": {"kl_episodes": 20},
    "ppo_safe": {
        "risk_limit": 0.3,
        "multiplier_step": 1.0,
        "risk_decisions": 4,
        "restart_share": 0.5,
        "value_quantiles": 4,
        "worst_share": 0.5,
    },
}


def on_policy(method: str) -> bool:
    return hasattr(settings_for(method), "horizon")


def two_quick(method: str) -> list[Settings]:
    """Two agents of the method that train in a moment."""
    changes = {name: value for name, value in QUICK.items() if getattr(settings_for(method), name, 0)}
    changes |= {"envs_per_agent": 4, "buffer_size": 16} if on_policy(method) else {}
    return with_seeds(settings_for(method, **changes | FADING.get(method, {})), 2)


def numbers(agent) -> list[torch.Tensor]:
    return [*agent.actor, *agent.critics]


@pytest.mark.parametrize("method", METHODS)
def test_a_trained_agent_is_read_back_as_it_was_saved_and_drives(method, tmp_path):
    result = Training(two_quick(method), 4).run(progress=False)
    assert all(np.isfinite(values).all() for values in result.curves.values())
    agent, back = result.agents[1], load_run(save_runs(result, tmp_path)[1]).agent
    assert back.settings == agent.settings and type(back.settings) is type(agent.settings)
    assert all(torch.equal(one, other) for one, other in zip(numbers(back), numbers(agent), strict=True))
    assert evaluate(back.as_policy(), 3) == evaluate(agent.as_policy(), 3)


@pytest.mark.parametrize(
    ("method", "scenario"),
    [*((method, DEFAULT) for method in METHODS), ("ppo_safe", replace(DEFAULT, sight=Sight(memory=3)))],
)
def test_a_training_that_was_stopped_goes_on_as_if_it_never_was(method, scenario, tmp_path):
    whole = Training(two_quick(method), 30, scenario)
    for _ in range(45):  # of PPO: in the middle of a round
        whole.step()
    save_checkpoint(whole, tmp_path / "checkpoint.npz")
    resumed = load_checkpoint(tmp_path / "checkpoint.npz")
    before = numbers(whole.agent(1))[0].clone()
    for _ in range(20):
        whole.step(), resumed.step()
    assert not torch.equal(before, numbers(whole.agent(1))[0])
    for agent in range(2):
        pairs = zip(numbers(whole.agent(agent)), numbers(resumed.agent(agent)), strict=True)
        assert all(torch.equal(one, other) for one, other in pairs)
    for name, values in whole.curves.values.items():
        np.testing.assert_array_equal(values, resumed.curves.values[name], err_msg=name)


@pytest.mark.parametrize("method", [m for m in METHODS if m not in ABLATION and not on_policy(m)])
def test_an_agent_learns_the_same_alone_as_beside_another(method):
    two = with_seeds(settings_for(method, hidden=(8,)), 2)
    together, alone = learner_for(two, 26), learner_for(two[1:], 26)
    for seed in range(3):
        batch = a_batch(seed=seed, demonstrations=6 if method in ("bc", "cql", "cql_sac") else 3)
        together.update(batch)
        alone.update(type(batch)(*(column[1:] for column in batch)))
    for both, one in zip(together.actor, alone.actor, strict=True):
        torch.testing.assert_close(both[1:], one, rtol=1e-4, atol=1e-6)

"""The road under Stable-Baselines3: beside the library's own vector environment, and with both ways to teach."""

from dataclasses import replace

import gymnasium as gym
import numpy as np
import pytest
import torch

import bootcourse as bc
from bootcourse.errors import BootcourseError
from bootcourse.learn.replay_buffer import decode_transitions
from bootcourse.research.experiments import others
from bootcourse.research.results import Results, load_results, save_results
from bootcourse.scenario import CALIBRATED, DEFAULT, Clock

stable_baselines3 = pytest.importorskip("stable_baselines3", reason="an extra: pip install 'bootcourse[others]'")

from stable_baselines3.common.vec_env import DummyVecEnv, VecMonitor  # noqa: E402

from bootcourse.others.stable_baselines3 import TrapVecEnv, add_demonstrations, as_policy, clone  # noqa: E402

SHORT = replace(DEFAULT, clock=Clock(decisions=12))
SMALL = {"policy_kwargs": {"net_arch": [16]}, "device": "cpu", "seed": 0}


@pytest.fixture(scope="module")
def rows() -> torch.Tensor:
    """Some drives of the rule."""
    return bc.collect(6)


def test_it_is_the_library_s_own_vector_environment_in_every_number():
    theirs = DummyVecEnv([lambda: gym.make("bootcourse:FastTrap-v0", scenario=SHORT)] * 3)
    ours, rng, ended = TrapVecEnv(3, SHORT), np.random.default_rng(0), 0
    assert ours.observation_space == theirs.observation_space and ours.action_space == theirs.action_space
    theirs.seed(5), ours.seed(5)
    np.testing.assert_array_equal(ours.reset(), theirs.reset())
    assert ours.reset_infos == theirs.reset_infos
    for _ in range(40):
        actions = np.where(rng.random(3) < 0.6, 5, rng.integers(9, size=3))
        (seen, rewards, done, infos), (mine, my_rewards, my_done, my_infos) = theirs.step(actions), ours.step(actions)
        np.testing.assert_array_equal(mine, seen)
        np.testing.assert_array_equal(my_rewards, rewards)
        assert my_rewards.dtype == rewards.dtype and my_done.tolist() == done.tolist()
        for i, info in enumerate(infos):
            last, my_last = info.pop("terminal_observation", None), my_infos[i].pop("terminal_observation", None)
            info.setdefault("TimeLimit.truncated", False), my_infos[i].setdefault("TimeLimit.truncated", False)
            assert my_infos[i] == pytest.approx(info)
            assert (last is None and my_last is None) or (last == my_last).all()
        ended += done.sum()
    assert ended > 10


@pytest.mark.parametrize(
    ("name", "settings"),
    [("DQN", {"learning_starts": 50, "batch_size": 16, "train_freq": 1}), ("PPO", {"n_steps": 32, "batch_size": 64})],
)
def test_dqn_and_ppo_learn_on_it_and_their_models_drive_ours(name, settings):
    agent = getattr(stable_baselines3, name)("MlpPolicy", VecMonitor(TrapVecEnv(4, SHORT)), **SMALL, **settings)
    before = [weights.detach().clone() for weights in agent.policy.parameters()]
    agent.learn(400)
    assert agent.ep_info_buffer and agent.num_timesteps >= 400
    assert any((old != new).any() for old, new in zip(before, agent.policy.parameters(), strict=True))
    drive = bc.record(as_policy(agent), [3], SHORT)[0]
    assert (drive.actions == agent.predict(drive.observations[:-1], deterministic=True)[0]).all()


def test_the_rule_s_drives_fill_a_replay_buffer_with_a_bonus_on_their_rewards(rows):
    agent = stable_baselines3.DQN("MlpPolicy", TrapVecEnv(4), buffer_size=2_000, **SMALL)
    add_demonstrations(agent.replay_buffer, rows, bonus=0.5)
    kept, batch = len(rows) // 4 * 4, decode_transitions(rows, 26, torch.ones(len(rows)))
    assert agent.replay_buffer.pos == len(rows) // 4
    columns = {"observations": batch.states, "next_observations": batch.next_states, "dones": batch.terminated}
    for name, column in columns.items():
        stored = getattr(agent.replay_buffer, name)[: kept // 4].reshape(kept, -1)
        np.testing.assert_array_equal(stored, column[:kept].reshape(kept, -1))
    rewards = agent.replay_buffer.rewards[: kept // 4].ravel()
    np.testing.assert_allclose(rewards, batch.rewards[:kept] + 0.5, rtol=1e-6)
    small = stable_baselines3.DQN("MlpPolicy", TrapVecEnv(4), buffer_size=400, **SMALL)
    with pytest.raises(BootcourseError, match="900 demonstrated transitions do not fit"):
        add_demonstrations(small.replay_buffer, rows)


def test_a_clone_does_what_the_rule_does(rows):
    agent = stable_baselines3.PPO("MlpPolicy", TrapVecEnv(4), learning_rate=3e-3, seed=0, device="cpu")
    batch = decode_transitions(rows, 26, torch.ones(len(rows)))

    def agreement() -> float:
        return float(np.mean(agent.predict(batch.states.numpy(), deterministic=True)[0] == batch.actions.numpy()))

    before = agreement()
    clone(agent, rows, updates=400)
    assert before < 0.4 < 0.7 < agreement()


def test_a_scenario_may_be_named_and_what_single_roads_lack_is_said():
    env = TrapVecEnv(2, "calibrated")
    assert env.get_attr("scenario") == [CALIBRATED] * 2 and env.env_is_wrapped(VecMonitor) == [False] * 2
    for mistake in (lambda: env.set_attr("scenario", DEFAULT), lambda: env.env_method("cars")):
        with pytest.raises(BootcourseError, match="for single roads"):
            mistake()


def test_a_small_comparison_is_computed_kept_and_read_again_with_the_library_s_own_settings(tmp_path, monkeypatch):
    monkeypatch.setattr(others, "TRIES", others.TRIES[:1])
    monkeypatch.setattr(others, "SEARCH_ROADS", range(2))
    made = others.compared("PPO alone", decisions=4_096, seeds=2, tests=4)
    save_results(made, tmp_path / "results.npz", {})
    read = load_results(tmp_path / "results.npz")
    assert read.agents == made.agents and read.agents[1]["learning_rate"] == others.TRIES[0]["learning_rate"]
    assert np.array_equal(read.scores("success"), made.scores("success")) and read.sizes == (4, 0)


def test_the_report_counts_who_escapes_with_the_teacher_and_without():
    def agents(name: str, successes: list[int]) -> Results:
        tested = {"success": np.array(successes, float)[:, None].repeat(20, 1)}
        tested |= {"returns": tested["success"], "accident": 1 - tested["success"]}
        entries = [{"method": name, "seed": i, "gamma": 0.9, "learning_rate": 1e-3} for i in range(len(successes))]
        return Results(entries, np.full(len(successes), -1), tested)

    computed = {cell: agents(cell, [0, 0, 0]) for cell in others.KINDS}
    computed["PPO after cloning"] = agents("PPO after cloning", [1, 1, 0])
    said = others.reading(computed)
    assert "0 of 3 escape alone and 2 of 3 after cloning" in said and "100 % of their drives" in said

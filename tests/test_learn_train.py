"""The training loop: what is remembered of the road, what stops it, and that it learns."""

import os
import signal

import numpy as np
import pytest
import torch
from gymnasium.vector import AutoresetMode
from tqdm.notebook import tqdm as in_notebook

import bootcourse as bc
from bootcourse.learn.agent import sample_actions
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.training import FIRST_SEED, Training
from bootcourse.progress import end_full
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.rule import rule
from bootcourse.scenario import DEFAULT, IDLE
from bootcourse.storage.checkpoint import load_checkpoint, save_checkpoint
from bootcourse.storage.runs import load_run, save_runs

INPUTS, DECISIONS = DEFAULT.observation_size, DEFAULT.clock.decisions
QUICK = {"demonstration_episodes": 3, "learning_starts": 16}


def training_of(*methods: str, episodes: int = 12, **changes) -> Training:
    return Training([settings_for(m, seed=i, **(QUICK | changes)) for i, m in enumerate(methods)], episodes)


def always(training: Training, action: int) -> Training:
    """Agents that are sure of one action, and never learn otherwise."""
    with torch.no_grad():
        training.learner.actor[-1][:, :, action] += 1000.0
    return training


def rows_of(training: Training, steps: int) -> torch.Tensor:
    """What the next steps put into the replay: (steps, roads, row)."""
    added, add = [], training.replay.add
    training.replay.add = lambda rows, ended: (added.append(rows.flatten(0, 1).clone()), add(rows, ended))[1]
    for _ in range(steps):
        training.step()
    return torch.stack(added)


@pytest.mark.parametrize("sure", [True, False], ids=["idle until time runs out", "random until an accident"])
def test_the_replay_holds_what_happened_on_the_road_and_the_true_last_state_of_each_episode(sure):
    training = training_of("sac", "soft", learning_starts=10**6)
    rows = rows_of(always(training, IDLE) if sure else training, DECISIONS + 3)
    n, roads = INPUTS, 2 * training.envs_per_agent

    road = TrapVectorEnv(roads, DEFAULT, AutoresetMode.DISABLED)  # the same roads, that rest when they end
    states, _ = road.reset(
        seed=[FIRST_SEED + 1000 * s.seed + i for s in training.settings for i in range(training.envs_per_agent)]
    )
    awake = np.ones(roads, dtype=bool)
    for step in range(DECISIONS):
        row = rows[step].numpy()
        np.testing.assert_array_equal(row[awake, :n], states[awake])
        np.testing.assert_array_equal(row[awake, 2 * n + 3], rule(road.cars, DEFAULT).actions[awake])
        states, rewards, terminated, truncated, _ = road.step(row[:, 2 * n].astype(np.int64))
        np.testing.assert_array_equal(row[awake, n : 2 * n], states[awake])
        np.testing.assert_array_equal(row[awake, 2 * n + 1], rewards[awake].astype(np.float32))
        np.testing.assert_array_equal(row[awake, 2 * n + 2], terminated[awake])
        np.testing.assert_array_equal(row[awake, 2 * n + 4], rule(road.cars, DEFAULT).actions[awake])
        ended = awake & (terminated | truncated)
        assert not (rows[step + 1, ended, :n].numpy() == states[ended]).all(1).any()  # the next episode is another
        awake &= ~ended
    assert not awake.any() and truncated.all() == sure


def test_the_idle_policys_curves_are_those_worked_out_by_hand():
    training = always(training_of("sac", "sac", episodes=6, learning_starts=10**6), IDLE)
    curves = training.run(progress=False).curves
    np.testing.assert_allclose(curves["return"], 23.4375)
    np.testing.assert_allclose(curves["distance"], 1500.0)
    np.testing.assert_allclose(curves["speed"], 10.0)
    for name, value in {"success": 0, "accident": 0, "decisions": 150, "beta": 0, "xi": 0, "alpha": 0.01}.items():
        np.testing.assert_allclose(curves[name], value, rtol=1e-6)
    np.testing.assert_allclose(curves["entropy"], 0, atol=1e-12)


@pytest.fixture(scope="module")
def undisturbed():
    """What two agents learn in twelve episodes."""
    return training_of("bootstrapped", "sac").run(progress=False)


def count_updates(training: Training) -> list[int]:
    """The decision after which each update came."""
    calls, update = [], training.learner.update
    training.learner.update = lambda batch: (calls.append(training.decisions), update(batch))[1]
    return calls


def test_updates_begin_after_the_warm_up_and_there_are_as_many_as_asked_for():
    training = training_of("sac", "soft", learning_starts=20, updates=3)
    calls = count_updates(training)
    for _ in range(7):  # 4 roads each: 8 decisions a step, 40 to warm up both agents
        training.step()
    assert calls == [40] * 3 + [48] * 3 + [56] * 3


def test_an_agent_that_has_driven_its_episodes_stays_as_it_was():
    training = training_of("sac", "soft", "bootstrapped", episodes=5)
    while not training.finished_agents:
        training.step()
    snapshots = {i: agent.actor[0].clone() for i, agent in training.finished_agents.items()}
    assert len(snapshots) < 3
    result = training.run(progress=False)
    for i, weight in snapshots.items():
        assert torch.equal(result.agents[i].actor[0], weight)
        assert not torch.equal(training.agent(i).actor[0], weight)


def press_ctrl_c():
    os.kill(os.getpid(), signal.SIGINT)


@pytest.mark.skipif(os.name == "nt", reason="a process cannot press Ctrl-C for itself on Windows")
def test_a_training_interrupted_in_the_middle_of_a_step_goes_on_as_if_nothing_had_been(undisturbed):
    training = training_of("bootstrapped", "sac")
    step, calls = training.env.step, []

    def disturbed_step(actions):
        calls.append(1)
        if len(calls) % 10 == 0:
            press_ctrl_c()
        return step(actions)

    training.env.step = disturbed_step
    interruptions = 0
    while (result := training.run(progress=False)).interrupted and not training.done:
        interruptions += 1
    assert interruptions >= 2
    for name, values in undisturbed.curves.items():
        np.testing.assert_array_equal(result.curves[name], values, err_msg=name)
    assert all(torch.equal(a, b) for a, b in zip(result.agents[0].actor, undisturbed.agents[0].actor, strict=True))


@pytest.mark.skipif(os.name == "nt", reason="a process cannot press Ctrl-C for itself on Windows")
def test_a_second_interrupt_does_not_wait():
    reached = []

    def stuck(training):
        press_ctrl_c()
        press_ctrl_c()
        reached.append("after")

    training = training_of("sac")
    assert training.run(progress=False, callback=stuck).interrupted and not reached


def test_actions_are_drawn_as_often_as_the_policy_says():
    policy = np.array([0.5, 0.0, 0.25, 0.0, 0.0, 0.05, 0.0, 0.2, 0.0])
    drawn = sample_actions(np.tile(policy, (100_000, 1)), np.random.default_rng(0).random(100_000))
    shares = np.bincount(drawn, minlength=9) / 100_000
    np.testing.assert_allclose(shares, policy, atol=0.006)
    assert (shares[policy == 0] == 0).all()
    assert sample_actions(policy[None], np.array([1 - 1e-16]))[0] == 7  # never past the last that is possible
    assert sample_actions(policy[None, ::-1], np.array([0.0]))[0] == 1  # nor before the first


def test_an_agent_has_its_learner_s_policy_and_q_and_drives_by_its_most_probable_action_or_draws_one(undisturbed):
    training, agent = training_of("sac", "soft"), undisturbed.agents[1]
    learner, seen = training.learner, torch.randn(2, 50, INPUTS)
    values = learner.q_values(learner.critics, seen).detach()
    for i in range(2):
        one = training.agent(i)
        np.testing.assert_allclose(one.probabilities(seen[i].numpy()), learner.probabilities(seen)[i], atol=1e-6)
        np.testing.assert_allclose(one.q_values(seen[i].numpy()), values[i], atol=1e-5)
    states = np.random.default_rng(0).normal(size=(500, INPUTS)).astype(np.float32)
    policy = agent.probabilities(states)
    np.testing.assert_allclose(policy.sum(1), 1, rtol=1e-5)
    choice = agent.as_policy(with_q=True)(states, None)
    np.testing.assert_array_equal(choice.actions, policy.argmax(1))
    assert choice.q_values.shape == (500, 9)
    drawn = agent.as_policy(np.random.default_rng(0))(states, None).actions
    assert 0 < (drawn == choice.actions).mean() < 1


def test_two_agents_of_the_paper_s_method_escape_within_250_episodes():
    training = Training(with_seeds(settings_for("bootstrapped"), 2, first=2), 250)
    assert training.run(progress=False).curves["success"][:, -50:].mean() >= 0.8


def test_a_training_counts_tiny_numbers_as_zero_and_nothing_does_so_afterwards():
    def tiny():
        return (torch.tensor([1e-39]) * 1.0).item()

    seen = []
    Training([settings_for("sac", hidden=(8,))], episodes=1).run(progress=False, callback=lambda _: seen.append(tiny()))
    assert set(seen) == {0.0} and tiny() > 0


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


@pytest.mark.filterwarnings("ignore:sac, seed 1")
def test_an_agent_with_a_loss_that_is_not_finite_keeps_finite_weights_its_run_says_so_and_the_others_go_on(tmp_path):
    training = trained_a_little()
    save_checkpoint(training, tmp_path / "before.npz")
    resumed = load_checkpoint(tmp_path / "before.npz")
    for each in (training, resumed):
        poison(each)
    resumed.step()
    save_checkpoint(resumed, tmp_path / "after.npz")
    assert load_checkpoint(tmp_path / "after.npz").stopped == {1: 52}
    with pytest.warns(UserWarning, match="sac, seed 1: its loss was not finite at decision 52; it stops there"):
        result = training.run(progress=False)
    alone = trained_a_little().run(progress=False)
    frozen = result.agents[1]
    assert torch.equal(frozen.actor[0], resumed.finished_agents[1].actor[0])
    assert result.stopped == {1: 52} and np.isnan(result.curves["return"][1, -1])
    assert all(torch.isfinite(weights).all() for weights in (*frozen.actor, *frozen.critics)) and frozen.alpha > 0
    for agent in (0, 2):
        np.testing.assert_array_equal(result.curves["return"][agent], alone.curves["return"][agent])
        assert torch.equal(result.agents[agent].actor[0], alone.agents[agent].actor[0])
    decisions = [load_run(path).provenance["stopped_at_decision"] for path in save_runs(result, tmp_path)]
    assert decisions == [None, 52, None]


# What is said of it: a bar, and three lines


def test_a_training_of_so_many_updates_counts_them_and_its_bar_ends_full(capsys):
    training = bc.Training([bc.settings_for("sac")], 1000)
    training.run(updates=40)
    shown = capsys.readouterr().err
    assert training.updates == 40 and "40/40" in shown.strip().splitlines()[-1] and "\r" not in shown


def test_a_bar_in_a_notebook_ends_full_when_less_than_its_total_was_done():
    bar = in_notebook(total=1000, display=False)
    bar.update(40)
    end_full(bar)
    _, drawn, _ = bar.container.children
    assert drawn.max == bar.n == 40


def test_a_result_has_three_lines(capsys):
    training = bc.Training(bc.with_seeds(bc.settings_for("sac"), 2), 3)
    lines = repr(training.run(progress=False)).splitlines()
    assert len(lines) == 3 and all(len(line) < 120 for line in lines)
    assert "2 agents of plain SAC on the trap" in lines[0] and lines[1].startswith("6 episodes")
    assert capsys.readouterr().err == ""


def test_a_training_learns_where_gradients_are_switched_off_and_without_a_console(monkeypatch):
    monkeypatch.setattr("sys.stderr", None)
    settings = [settings_for("sac", learning_starts=64)]
    with torch.no_grad():
        training = Training(settings, episodes=20)
        training.run(updates=2)
    assert training.updates == 2

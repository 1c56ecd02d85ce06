"""Environments other than the trap: a teacher there, what is asked of the environment, what is saved, comparisons."""

import re
import signal
from functools import partial
from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest
import torch
from gymnasium.vector import AutoresetMode, SyncVectorEnv

import bootcourse as bc
from bootcourse.errors import BootcourseError
from bootcourse.learn.demonstrations import collect
from bootcourse.learn.replay_buffer import decode_transitions
from bootcourse.learn.teachers import all_roads, teacher_policy
from bootcourse.research.problems import PROBLEMS, Chain
from bootcourse.storage.checkpoint import save_checkpoint

QUICK = {"hidden": (8,), "learning_starts": 16, "demonstration_episodes": 2}
TAUGHT = ("bootstrapped", "dagger", "ibrl", "jsrl", "margin_soft", "ppo_cloned")
PPO = {"envs_per_agent": 4, "horizon": 8, "batch": 16, "cloning_updates": 5}


def mountain_car(n: int) -> SyncVectorEnv:
    return gym.make_vec("MountainCar-v0", n)


def with_the_motion(observation: np.ndarray) -> int:
    return 2 if observation[1] > 0 else 0


def training_of(method: str, make_env=mountain_car, teacher=with_the_motion, **changes) -> bc.Training:
    changes = QUICK | (PPO if method.startswith("ppo") else {}) | changes
    return bc.Training([bc.settings_for(method, **changes)], 3, make_env=make_env, teacher=teacher)


@pytest.mark.parametrize("method", TAUGHT)
def test_every_method_trains_with_a_teacher_in_another_environment_and_drives_there(method):
    training = training_of(method)
    for _ in range(12):
        training.step()
    result = training.result()
    assert result.environment == "MountainCar-v0" and result.scenario is None and training.losses
    driven = bc.drive_episodes(result.agents[0].as_policy(), range(2), make_env=mountain_car)
    assert (driven.returns >= -200).all() and np.isnan(driven.accident).all() and np.isnan(driven.success).all()


def test_the_replay_holds_the_teacher_s_actions_in_the_states_before_and_after_each_decision():
    training, added = training_of("soft", make_env=Chain, teacher=lambda seen: int(seen[-1] * 60) % 2), []
    add = training.replay.add
    training.replay.add = lambda rows, ended: (added.append(rows.clone()), add(rows, ended))[1]
    for _ in range(61):
        training.step()
    batch = decode_transitions(torch.stack(added).flatten(0, 2), Chain.size, torch.zeros(61 * 4))
    for seen, taught in ((batch.states, batch.rule_actions), (batch.next_states, batch.next_rule_actions)):
        assert torch.equal(taught, (seen[:, -1] * 60).long() % 2)  # at an episode's end, of its last state


def test_demonstrations_and_the_stochastic_rule_have_as_many_actions_as_the_environment():
    rows = collect(3, None, None, with_the_motion, mountain_car)
    batch = decode_transitions(rows, 2, torch.zeros(len(rows)))
    assert torch.equal(batch.actions, batch.rule_actions) and batch.terminated.sum() == 3
    drawn = training_of("demos", stochastic_demonstrations=True).replay.state()["demonstrations"][:, 4]
    assert set(drawn) == {0.0, 1.0, 2.0}


def noise(*_):
    raise KeyError("speed")


REFUSED = [
    *[(lambda teacher=teacher: training_of("soft", teacher=teacher), says) for teacher, says in (
        (None, "asks a teacher, and MountainCar-v0 has none: give teacher=my_rule"),
        (noise, r"'noise' failed for the observation \[.*\]: it raised KeyError: 'speed'"),
        (lambda observation: None, "it returned None, but an action is a whole number from 0 to 2"),
        (lambda observation: 3, "it returned 3, but an action is a whole number from 0 to 2"),
        (all_roads(lambda observations: np.zeros(3, int)), r"returned actions of shape \(3,\)"),
        ("my_rule", "teacher = 'my_rule': give a function"),
    )],
    *[(lambda name=name: bc.Training([bc.settings_for("sac")], make_env=partial(gym.make_vec, name)), says)
      for name, says in (
        ("CartPole-v1", "CartPole-v1 does not restart an episode in the step that ends it"),
        ("Pendulum-v1", r"Pendulum-v1 has actions of Box.*: this library learns Discrete\(n\)"),
        ("Taxi-v4", r"Taxi-v4 shows Discrete\(500\): flatten it to a vector"),
    )],
    *[(lambda make_env=make_env: bc.Training([bc.settings_for("sac")], make_env=make_env), says) for make_env, says in (
        (gym.make("MountainCar-v0"), r"make_env = <.*>: give a function of n"),
        (lambda n: gym.make("MountainCar-v0"), r"make_env\(4\) returned <.*>, no vector environment of 4 copies"),
        (lambda n: mountain_car(3), r"make_env\(4\) returned SyncVectorEnv\(.* no vector environment of 4 copies"),
    )],
    (lambda: training_of("bc", teacher=None), "needs demonstrations of this environment: give them, or teacher"),
    (lambda: bc.Training(bc.settings_for("sac")), "one agent's settings: give a list of them, such as with_seeds"),
    (lambda: training_of("soft", rule_p=0.3), r"rule_p = 0.3 is outside \[1/3, 1\)"),
    (lambda: bc.compare({}), "nothing to compare"),
    (lambda: bc.compare({"x": 3}), "'x' is 3: give settings"),
    (lambda: bc.compare([bc.settings_for("sac")]), 'give {"mine": se'),
]  # fmt: skip


@pytest.mark.parametrize(("call", "says"), REFUSED)
def test_a_wrong_teacher_or_environment_is_one_sentence(call, says):
    with pytest.raises(bc.BootcourseError, match=says):
        call()


def soon(n: int) -> SyncVectorEnv:
    """A MountainCar of 5 decisions that succeeds if it earned -5."""
    one = lambda: bc.Success(gym.make("MountainCar-v0", max_episode_steps=5), lambda earned, over: earned == -5)  # noqa: E731
    return SyncVectorEnv([one] * n, autoreset_mode=AutoresetMode.SAME_STEP)


def test_success_is_what_the_wrapper_says_at_each_episode_s_end():
    result = training_of("soft", make_env=soon).run(progress=False)
    assert (result.curves["success"] == 1).all() and (result.curves["decisions"] == 5).all()
    report = bc.evaluate(teacher_policy(with_the_motion, None, 3), 4, make_env=soon)
    assert report.success.value == 1 and report.returns.value == -5 and np.isnan(report.collision.value)


def test_a_run_knows_its_environment_and_sizes_and_is_refused_elsewhere(tmp_path):
    result = training_of("ibrl", make_env=soon).run(progress=False)
    (folder,) = bc.save_runs(result, tmp_path)
    run = bc.load_run(folder, with_the_motion, "MountainCar-v0")
    assert run.scenario is None and torch.equal(run.agent.actor[0], result.agents[0].actor[0])
    drives = [bc.drive_episodes(a.as_policy(), range(2), make_env=soon) for a in (run.agent, result.agents[0])]
    assert np.array_equal(drives[0].returns, drives[1].returns)
    with pytest.raises(bc.BootcourseError, match="trained in MountainCar-v0, not in Trap-v0: give environment="):
        bc.load_run(folder)
    with pytest.raises(bc.BootcourseError, match="drives with the teacher"):
        bc.load_run(folder, environment="MountainCar-v0")
    with pytest.raises(bc.BootcourseError, match="Only a training on the trap can be saved and resumed"):
        save_checkpoint(training_of("soft"), tmp_path / "checkpoint.npz")


def test_a_comparison_trains_each_entry_and_shows_a_table_and_curves():
    chain = PROBLEMS["chain"]

    def mine(seeds: int) -> bc.Training:
        return bc.Training(bc.with_seeds(bc.settings_for("sac", **QUICK), seeds), 3, make_env=Chain)

    entries = {"bc": bc.settings_for("bc", **QUICK | {"learning_starts": 0}), "sac, mine": mine}  # sac needs no teacher
    compared = bc.compare(entries, 2, 12, tests=3, make_env=Chain, teacher=chain.rule, progress=False)
    assert compared.scores("bc").tolist() == [10, 10] and compared.scores("bc", "success").tolist() == [1, 1]
    with pytest.raises(BootcourseError, match="Measure 'return' is unknown: did you mean 'returns'"):
        compared.scores("bc", "return")
    with pytest.raises(BootcourseError, match="Training 'returns' is unknown: choose from bc"):
        compared.scores("returns")
    head, clones, own = compared.rows()
    assert clones[:4] == ("bc", "2", "100.00 [100.00, 100.00]", "10.00 [10.00, 10.00]")
    assert own[:2] == ("sac, mine", "2")
    assert "sac, mine" in str(compared) and compared._repr_html_().count("<tr>") == 3
    assert "success" in compared.figure("Cloning is enough").alt


def test_methods_are_compared_at_equal_decisions_though_their_episodes_differ_in_length():
    entries = {name: bc.settings_for(name, **QUICK) for name in ("sac", "soft")}
    rule = PROBLEMS["chain"].rule
    compared = bc.compare(entries, 2, tests=3, decisions=400, make_env=Chain, teacher=rule, progress=False)
    assert [row[4] for row in compared.rows()[1:]] == ["400", "400"]
    assert not any(result.interrupted for result in compared.results.values())
    finished = [np.nansum(result.curves["decisions"], axis=1) for result in compared.results.values()]
    assert all((each == 240).all() for each in finished), "each of four roads has finished one episode of 60"
    with pytest.raises(BootcourseError, match="decisions = 0: give a whole number from 1"):
        bc.compare(entries, decisions=0)


def presses_ctrl_c_after(calls: int):
    """A teacher of the chain that interrupts the training once, when it has been asked so often."""
    asked = []

    @all_roads
    def teacher(seen):
        asked.append(len(seen))
        if len(asked) == calls:
            signal.raise_signal(signal.SIGINT)
        return np.ones(len(seen), dtype=np.int64)

    return teacher


def test_an_interrupted_comparison_keeps_what_was_trained_and_names_what_is_missing():
    soft = bc.settings_for("soft", **QUICK)
    entries = {"sac": bc.settings_for("sac", **QUICK), "soft": soft, "soft, again": soft}
    options = {"make_env": Chain, "progress": False}
    with pytest.warns(UserWarning, match=r"'soft' was interrupted after \d+ of 20 episodes. There is .* 'soft, again'"):
        compared = bc.compare(entries, 2, 20, tests=3, teacher=presses_ctrl_c_after(450), **options)
    assert [row[0] for row in compared.rows()] == ["", "sac", "soft, interrupted"] and len(compared.tested["soft"]) == 2
    only = {"soft": soft, "sac": soft}
    with (
        pytest.warns(UserWarning, match="'soft' was interrupted after 0 of 20 episodes. There is .* 'soft', 'sac'"),
        pytest.raises(bc.BootcourseError, match="interrupted before its first update"),
    ):
        bc.compare(only, 2, 20, teacher=presses_ctrl_c_after(2), **options)


def test_the_lines_for_a_problem_of_your_own_run(capsys):
    page = (Path(__file__).resolve().parent.parent / "book/in_python.md").read_text(encoding="utf-8")
    (lines,) = [code for code in re.findall(r"```python\n(.*?)```", page, re.S) if "def my_rule" in code]
    assert "episodes=100" in lines
    exec(lines.replace("episodes=100", "episodes=1, tests=1, progress=False"), {})
    printed = capsys.readouterr().out
    assert "sac" in printed and "soft" in printed and "success" in printed

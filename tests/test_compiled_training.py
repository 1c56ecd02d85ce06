"""The compiled training: its roads and rows are the library's, its draws are right, and its agents learn as ours do."""

import numpy as np
import pytest
import torch
from gymnasium.vector import AutoresetMode

from bootcourse.learn import compiled_training, records
from bootcourse.learn.compiled_training import MU, NEXT_MU, TERMINATED, A, R
from bootcourse.learn.curves import NAMES
from bootcourse.learn.settings import settings_for
from bootcourse.learn.training import Training
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.rule import rule
from bootcourse.scenario import CALIBRATED, DEFAULT
from tests.under import Under

SEEN, ROADS = records.SEEN, records.ROADS


def test_the_random_numbers_are_splitmix64s():
    run, known = np.zeros(1, records.RUN), [6457827717110365317, 3203168211198807973, 9817491932198370423]
    run["random"] = 1234567
    drawn = [compiled_training.uniform(run[0]) for _ in known]  # Vigna's reference program prints these for this seed
    assert drawn == [(number >> 11) * 2.0**-53 for number in known]


@pytest.mark.parametrize("scenario", [DEFAULT, CALIBRATED], ids=lambda scenario: scenario.name)
def test_each_row_is_what_the_library_s_road_and_rule_say_and_the_curves_add_them_up(scenario):
    training = Under(settings_for("sac", learning_starts=10**6), scenario=scenario)
    env = TrapVectorEnv(ROADS, scenario, AutoresetMode.DISABLED)
    env.reset(seed=0)
    running, ended = np.zeros((ROADS, 3)), []  # return, speed, decisions
    for _ in range(200):
        env.cars[:] = training.run["cars"][0, :ROADS]
        seen, taught = env.observe(), rule(env.cars, scenario).actions
        env.asleep[:], env.decisions[:] = False, training.run["decided"][0]
        rows = training.advance()
        after, rewards, terminated, truncated, infos = env.step(rows[:, A].astype(int))
        assert np.array_equal(rows[:, :SEEN], seen) and np.array_equal(rows[:, SEEN : 2 * SEEN], after)
        assert np.array_equal(rows[:, R], rewards.astype(np.float32))
        assert np.array_equal(rows[:, TERMINATED], terminated) and np.array_equal(rows[:, MU], taught)
        assert np.array_equal(rows[:, NEXT_MU], rule(env.cars, scenario).actions)
        running += np.stack([rewards, infos["speed"], np.ones(ROADS)], 1)
        for road in np.flatnonzero(terminated | truncated):
            total, speed, decisions = running[road]
            names = ("is_success", "distance", "accident")
            ended.append([total, speed / decisions, decisions, *(infos[name][road] for name in names)])
            running[road] = 0
    columns = [NAMES.index(name) for name in ("return", "speed", "decisions", "success", "distance", "accident")]
    assert len(ended) > 20 and training.run["finished"][0] == len(ended)
    np.testing.assert_allclose(training.curves["values"][0, : len(ended), columns].T, ended, rtol=1e-5, atol=1e-5)
    assert {0, 1, 2} >= {end[-1] for end in ended}


@pytest.mark.parametrize("stochastic", [False, True])
def test_demonstrations_are_the_rule_s_or_its_stochastic_form_s(stochastic):
    training = Under(settings_for("bootstrapped", rule_p=0.8, stochastic_demonstrations=stochastic))
    rows = training.demonstrate(20)
    followed = (rows[:, A] == rows[:, MU]).mean()
    if stochastic:
        others = (rows[:, A] - rows[:, MU])[rows[:, A] != rows[:, MU]] % 9
        assert abs(followed - 0.8) < 0.04 and np.bincount(others.astype(int), minlength=9)[1:].min() > 0
        assert rows[:, TERMINATED].sum() > 0
    else:
        assert followed == 1 and len(rows) == 20 * 150 and rows[:, TERMINATED].sum() == 0
        last = rows[149::150, SEEN + 1] * 1000  # m
        assert (last > 1600).all(), "the rule gets out on every road"


@pytest.mark.parametrize(("finished", "share"), [(0, 38), (500, 19), (1000, 0), (1500, 0)])
def test_a_batch_has_a_share_beta_of_demonstrations_drawn_evenly_from_all_rows(finished, share):
    training = Under(settings_for("bootstrapped"))
    rows = training.memory["rows"][0]
    rows[:, R] = -1.0  # rows that are not filled
    rows[:50, R], rows[records.MOST_DEMONSTRATIONS :][:70, R] = np.arange(50), 100 + np.arange(70)
    training.run["demonstrations"], training.run["size"], training.run["finished"] = 50, 70, finished
    drawn = []
    for _ in range(100):
        compiled_training.sample(training.run[0], training.memory[0], training.batch[0], training.plan[0])
        assert np.array_equal(training.batch["is_demonstration"][0], np.arange(64) < share)
        drawn.append(training.batch["rewards"][0].copy())
    demonstrations, own = np.stack(drawn)[:, :share], np.stack(drawn)[:, share:]
    assert set(own.ravel()) == set(100.0 + np.arange(70))
    assert set(demonstrations.ravel()) == (set(np.arange(50.0)) if share else set())


class SplitMix:
    """The random numbers of the compiled training in place of a NumPy generator."""

    def __init__(self, run: np.ndarray):
        self.run = run.copy()

    def random(self, count: int) -> np.ndarray:
        return np.array([compiled_training.uniform(self.run[0]) for _ in range(count)])


@pytest.mark.parametrize("method", ["sac", "soft", "demos", "bootstrapped"])
def test_with_the_same_random_numbers_the_library_s_loop_drives_and_learns_the_same(method):
    """On one road both loops draw in the same order: an action, a new road at an episode's end, a batch."""
    fades = {"beta_episodes": 40} if method in ("demos", "bootstrapped") else {}
    settings = settings_for(method, seed=5, envs_per_agent=1, **fades)
    compiled, rows = Under(settings, episodes=80), None
    if settings.needs_demonstrations:
        rows = torch.from_numpy(compiled.demonstrate(200).copy())
    ours = Training([settings], episodes=80, learner="compiled", demonstrations=rows)
    ours.learner.records[:] = compiled.agent
    ours.env.cars[0] = compiled.run["cars"][0, 0]
    ours.states = ours.env.observe()
    ours.rule_actions = ours.taught()
    ours.act_rngs = ours.sample_rngs = ours.env._generators = [SplitMix(compiled.run)]
    curves = ours.run(progress=False).curves
    while compiled.run["finished"][0] < 80:
        compiled.advance(100)
    assert ours.updates == compiled.run["updates"][0] > 100
    for column, name in enumerate(NAMES):
        np.testing.assert_allclose(curves[name][0], compiled.curves["values"][0, :80, column], rtol=1e-4, atol=1e-5)


def test_the_same_seed_gives_the_same_training_and_another_seed_another():
    one, again, other = (
        compiled_training.train(settings_for("soft", seed=seed, learning_starts=64), episodes=10) for seed in (3, 3, 4)
    )
    assert all(np.array_equal(one.curves[name], again.curves[name]) for name in NAMES)
    assert not np.array_equal(one.curves["return"], other.curves["return"])
    assert np.isfinite(one.curves["entropy"]).all() and one.curves["alpha"][-1] < one.curves["alpha"][0]
    assert np.allclose(one.curves["xi"], 200 * one.curves["alpha"])


def test_to_watch_an_agent_in_training_changes_nothing():
    settings, seen = settings_for("soft", seed=3, learning_starts=64), []
    alone = compiled_training.train(settings, episodes=60)
    watched = compiled_training.train(settings, episodes=60, watch=lambda *each: seen.append(each))
    assert all(np.array_equal(alone.curves[name], watched.curves[name]) for name in NAMES)
    ended, agents = zip(*seen, strict=True)
    assert ended[0] == 0 < ended[-1] < 60 and list(ended) == sorted(ended)
    here = np.ones((1, SEEN), np.float32)
    first, last = (each.probabilities(here) for each in (agents[0], agents[-1]))
    assert not np.array_equal(first, last), "each look is a copy"


def test_bootstrapped_agents_get_out_when_the_study_s_do():
    """The study's ten are out in 90 of 100 drives after 286 to 345 episodes (the first window that is)."""
    for seed in range(2):
        trained = compiled_training.train(settings_for("bootstrapped", seed=seed), episodes=450)
        out = np.convolve(trained.curves["success"], np.ones(100), "valid")
        assert 220 < 100 + int(np.argmax(out >= 90)) < 450
        assert trained.agent.probabilities(np.zeros((1, SEEN), np.float32)).shape == (1, 9)

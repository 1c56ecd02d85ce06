"""Restarts before accidents: the same road as then, a share that fades, honest curves, nothing lost by a stop."""

from dataclasses import replace

import numpy as np
import pytest

from bootcourse.errors import BootcourseError
from bootcourse.learn.curves import Curves
from bootcourse.learn.restarts import FARTHEST, NEAREST, POOL, Restarts
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.training import Training
from bootcourse.methods import METHODS
from bootcourse.research.checks import cartpole, several
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import DEFAULT, Sight
from bootcourse.storage.checkpoint import DamagedCheckpoint, restored, state_of
from tests.test_learn_safe import SMALL

ROADS = 4


def wanting(agents: int = 1, share: float = 0.5, episodes: int = 0) -> list:
    changes = SMALL | {"envs_per_agent": ROADS, "restart_share": share, "restart_episodes": episodes}
    return with_seeds(settings_for("ppo_safe", **changes), agents)


class Drive:
    """Random actions, few of which steer, on the roads of some agents; `driven` in each running episode."""

    def __init__(self, agents: list[int], share: float = 0.5):
        self.env, self.curves = TrapVectorEnv(ROADS * len(agents)), Curves(len(agents), ROADS, 100)
        self.env.reset(seed=[100 * agent + road for agent in agents for road in range(ROADS)])
        self.restarts = Restarts(wanting(len(agents), share), self.env)
        self.generators = [np.random.default_rng(agent) for agent in agents]
        self.drivers = [np.random.default_rng(50 + agent) for agent in agents]
        self.driven: list[list] = [[] for _ in range(self.env.num_envs)]  # (cars, action) of each decision

    def step(self) -> tuple[np.ndarray, list[list]]:
        """One decision on every road: (which of them ended in an accident, what was driven in the episodes so far)."""
        steering = [driver.choice(3, size=ROADS, p=(0.02, 0.96, 0.02)) for driver in self.drivers]
        actions = np.concatenate([3 * driver.integers(3, size=ROADS) for driver in self.drivers]) + np.concatenate(
            steering
        )
        for road, its in enumerate(self.driven):
            its.append((self.env.cars[road].copy(), actions[road]))
        _, _, terminated, truncated, _ = self.env.step(actions)
        done, driven = terminated | truncated, list(self.driven)
        self.restarts.begin(self.env, self.curves, done, terminated, self.generators)
        self.driven = [[] if end else its for end, its in zip(done, driven, strict=True)]
        return terminated, driven


def test_a_state_of_the_pool_is_the_road_5_to_40_decisions_before_and_the_same_actions_end_in_the_same_accident():
    drive, distances = Drive([3]), []
    while len(distances) < 60:
        before, ordinary = drive.restarts.accidents[0], ~drive.curves.restarted
        terminated, driven = drive.step()
        left = np.flatnonzero(terminated & ordinary & [len(its) >= NEAREST for its in driven])
        assert drive.restarts.accidents[0] - before == len(left)
        for slot, road in enumerate(left, before):
            decisions = drive.restarts.decisions[0, slot]
            cars = drive.restarts.pool[0, slot]
            np.testing.assert_array_equal(cars, driven[road][decisions][0])
            distances.append(len(driven[road]) - decisions)
            again = TrapVectorEnv(1)
            again.reset(seed=0)
            again.cars[0], again.decisions[0] = cars, decisions
            ends = [bool(again.step(np.array([action]))[2][0]) for _, action in driven[road][decisions:]]
            assert ends == [False] * (distances[-1] - 1) + [True]
    assert NEAREST <= min(distances) <= NEAREST + 3 and FARTHEST - 10 <= max(distances) <= FARTHEST


def test_a_restarted_road_stands_as_in_the_pool_and_the_agent_sees_it():
    training, moved = Training(wanting(2, share=0.9), 200, replace(DEFAULT, sight=Sight(memory=2))), 0
    while moved < 20:
        before = training.curves.running[1].copy()
        training.step()
        began = training.curves.restarted & (training.curves.running[1] == 0) & (before > 0)
        for road in np.flatnonzero(began):
            agent = road // ROADS
            same = (training.restarts.pool[agent] == training.env.cars[road]).all((1, 2))
            assert training.env.decisions[road] in training.restarts.decisions[agent, same]
            assert np.ptp(training.states[road].reshape(2, -1), axis=0).max() == 0, "it remembers no other road"
            moved += 1
        np.testing.assert_array_equal(training.states, training.env.observe())
        np.testing.assert_array_equal(training.rule_actions, training.taught())
        ordinary = ~training.curves.restarted
        assert (training.env.decisions == training.curves.running[1])[ordinary].all()


def test_without_an_accident_there_is_no_restart_and_neither_after_one_at_the_start():
    drive = Drive([0], share=0.9)
    everywhere, nowhere = np.ones(ROADS, dtype=bool), np.zeros(ROADS, dtype=bool)
    for _ in range(20):
        assert not drive.restarts.begin(drive.env, drive.curves, everywhere, nowhere, drive.generators)
    for _ in range(NEAREST - 2):  # the state before the first decision is there already
        drive.restarts.begin(drive.env, drive.curves, nowhere, nowhere, drive.generators)
    assert not drive.restarts.begin(drive.env, drive.curves, everywhere, everywhere, drive.generators)
    assert not drive.curves.restarted.any() and drive.restarts.accidents[0] == 0


def test_the_share_falls_linearly_with_the_agent_s_episodes_or_stays():
    env = TrapVectorEnv(2000)
    env.reset(seed=0)
    done, none, rngs = np.ones(2000, dtype=bool), np.zeros(2000, dtype=bool), [np.random.default_rng(0)]
    for episodes, finished, expected in [(10, 0, 0.8), (10, 5, 0.4), (10, 10, 0.0), (10, 15, 0.0), (0, 10**6, 0.8)]:
        restarts, curves = Restarts(wanting(1, 0.8, episodes), env), Curves(1, 2000, 1)
        restarts.decisions[0, :3], curves.finished[:] = 7, finished
        assert restarts.begin(env, curves, done, none, rngs) == (expected > 0)
        assert curves.restarted.mean() == pytest.approx(expected, abs=0.05 * (expected > 0))


def test_the_pool_keeps_the_last_accidents():
    drive = Drive([1], share=0.3)
    while drive.restarts.accidents[0] < POOL + 5:
        drive.step()
    full = drive.restarts.decisions.copy()
    assert (full >= 0).all()
    while drive.restarts.accidents[0] < POOL + 15:
        drive.step()
    changed = (full != drive.restarts.decisions)[0]
    assert changed[5:15].any() and not changed[20:].any()


def test_an_agent_restarts_alone_as_beside_another():
    together, alone = Drive([4, 9]), Drive([9])
    for _ in range(300):
        together.step(), alone.step()
    assert alone.restarts.accidents[0] == together.restarts.accidents[1] > 5
    np.testing.assert_array_equal(alone.restarts.pool[0], together.restarts.pool[1])
    np.testing.assert_array_equal(alone.env.cars, together.env.cars[ROADS:])


def test_a_restarted_episode_is_not_recorded_and_its_decisions_count_with_the_next_that_is():
    curves, now = Curves(1, 2, 5), {"alpha": np.zeros(1)}
    curves.restarted[0] = True

    def note(ended: list[bool], accident: list[int]) -> None:
        infos = {name: np.zeros(2) for name in ("speed", "is_success", "distance")} | {"accident": np.array(accident)}
        curves.note(np.ones(2), np.zeros(2), np.array(ended), infos, now)

    note([False, False], [0, 0])
    note([True, False], [1, 0])
    assert curves.finished[0] == 0 and curves.unrecorded[0] == 2
    curves.restarted[0] = False
    note([False, True], [0, 3])
    note([True, False], [0, 0])
    assert curves.values["decisions"][0, :2].tolist() == [3 + 2, 2]
    assert curves.values["accident"][0, :2].tolist() == [3, 0] and curves.values["return"][0, :2].tolist() == [3, 2]


def test_no_decision_is_lost_in_the_curves():
    training = Training(wanting(2, share=0.6), 500)
    for _ in range(250):
        training.step()
    curves, roads = training.curves, training.curves.running[1].reshape(2, ROADS)
    told = np.nansum(curves.values["decisions"], axis=1) + curves.unrecorded + roads.sum(1)
    assert told.tolist() == [250 * ROADS] * 2 and training.restarts.accidents.min() > 0


def again(training: Training, changes: dict | None = None) -> Training:
    arrays = {name: values.copy() for name, values in state_of(training).items()} | (changes or {})
    return restored(training.settings, training.episodes, training.scenario, training.teacher, arrays)


def test_a_training_with_restarts_that_was_stopped_goes_on_as_if_it_never_was():
    whole = Training(wanting(2, share=0.6, episodes=400), 500)
    for _ in range(120):
        whole.step()
    resumed, moves = again(whole), 0
    assert whole.curves.restarted.any() and whole.restarts.accidents.min() > 0
    for _ in range(80):
        before = whole.curves.restarted.copy()
        whole.step(), resumed.step()
        moves += (whole.curves.restarted & ~before).sum()
    one, other = state_of(whole), state_of(resumed)
    assert moves > 0 and one.keys() == other.keys()
    for name in one.keys() - {"numbers"}:  # which holds the seconds
        np.testing.assert_array_equal(one[name], other[name], err_msg=name)


@pytest.mark.parametrize("name", ["restarts.pool", "restarts.past", "curves.restarted", "curves.unrecorded"])
def test_a_checkpoint_whose_restarts_do_not_fit_is_refused(name):
    training = Training(wanting(), 5)
    for damaged in (np.zeros((3, 3)), np.zeros(0, dtype=bool), np.array("text")):
        with pytest.raises(DamagedCheckpoint, match="does not fit the settings"):
            again(training, {name: damaged})


def test_absurd_numbers_in_a_checkpoint_end_no_training():
    training = Training(wanting(share=0.9), 500)
    for _ in range(60):
        training.step()
    absurd = {"restarts.kept": np.full(ROADS, 2**62), "restarts.accidents": np.full(1, -3)}
    absurd["restarts.decisions"] = np.where(np.arange(POOL) % 2, 2**62, -(2**62))[None]
    training = again(training, absurd)
    for _ in range(60):
        training.step()
    assert training.curves.finished[0] > 0


def test_only_a_training_that_wants_restarts_has_them():
    assert [method for method in METHODS if settings_for(method).restarts] == []
    off = Training(wanting(share=0.0), 5)
    assert off.restarts is None and not [name for name in state_of(off) if "restart" in name]


def test_roads_that_cannot_be_set_are_refused():
    settings = [replace(wanting()[0], cloning_updates=0)]
    with pytest.raises(BootcourseError, match="give restart_share=0"):
        Training(settings, 5, make_env=several(cartpole))

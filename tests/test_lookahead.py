"""Looking ahead: the nine values are what driving each action on a copy of the road would earn."""

import shutil
from dataclasses import replace

import numpy as np
import pytest
from gymnasium.vector import AutoresetMode

import bootcourse as bc
from bootcourse.course.lessons.looking_ahead import imagined_road as imagined
from bootcourse.course.lessons.looking_ahead.figures import wrong_models
from bootcourse.course.shipped import beginning
from bootcourse.episodes.evaluate import drive_episodes
from bootcourse.episodes.lookahead import imagine, lookahead, lookahead_shield, rollout_values, worth_of_speed
from bootcourse.episodes.models import FAR_BEHIND, MODELS, Model
from bootcourse.errors import BootcourseError, RuleFailed
from bootcourse.plots.futures import trails
from bootcourse.policies import PlanPolicy, PolicyOutput, idle_policy, plan_policy, rule_policy
from bootcourse.replay3d.recorder import to_html
from bootcourse.replay3d.scene import timelines_of
from bootcourse.replay3d.stage import _ribbon
from bootcourse.research.computed import experiment
from bootcourse.research.experiments.lookahead import Cell, drive_cell, every_cell, rows
from bootcourse.research.results import Results
from bootcourse.road.state import CRASHED, EGO, HEADING, LANE, SPEED, TARGET_LANE, TRAP_1, X, Y
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import CALIBRATED, DEFAULT, N_ACTIONS
from bootcourse.storage.assets import FOLDER
from bootcourse.storage.runs import load_run

ROADS = [2**33 - 7, 2**33 - 8]
INTO_TRAP_1 = [("accelerate straight", 30)]


def erratic(observations, cars):
    """Brakes or keeps straight; any change of the observations changes which."""
    return PolicyOutput(4 - 3 * ((np.abs(observations).sum(axis=1) * 1e4).astype(np.int64) % 2))


class Reached:
    """Roads that a policy has driven for some decisions, and the actions that led there."""

    def __init__(self, policy, decisions, scenario=DEFAULT):
        self.env = TrapVectorEnv(len(ROADS), scenario, AutoresetMode.DISABLED)
        self.observations, _ = self.env.reset(seed=ROADS)
        self.actions = []
        if hasattr(policy, "reset"):
            policy.reset(len(ROADS))
        for _ in range(decisions):
            self.actions.append(policy(self.observations, self.env.cars).actions)
            self.observations, *_ = self.env.step(self.actions[-1])
        policy(self.observations, self.env.cars)  # the decision that the look-ahead may overrule
        self.cars = self.env.cars.copy()


def by_hand(there: Reached, policy, action, horizon, scenario):
    """(value of an action, ended in an accident?) on each road, on an environment that drives the same way again."""
    env = TrapVectorEnv(len(ROADS), scenario, AutoresetMode.DISABLED)
    observations, _ = env.reset(seed=ROADS)
    for actions in there.actions:
        if hasattr(policy, "decision"):
            policy.decision += 1
        observations, *_ = env.step(actions)
    if hasattr(policy, "decision"):
        policy.decision += 1
    value, ended = np.zeros(len(ROADS)), np.zeros(len(ROADS), dtype=bool)
    for decision in range(horizon):
        actions = np.full(len(ROADS), action) if decision == 0 else policy(observations, env.cars).actions
        observations, rewards, terminated, _, _ = env.step(actions)
        value, ended = value + rewards, ended | terminated
    return value + ~ended * np.interp(env.cars[:, EGO, SPEED], *worth_of_speed(scenario)), ended


@pytest.mark.parametrize(
    ("make", "scenario"),
    [
        (lambda: rule_policy(CALIBRATED), CALIBRATED),
        (lambda: bc.shipped_agents("bootstrapped")[0].as_policy(), DEFAULT),
        (lambda: plan_policy(INTO_TRAP_1), DEFAULT),
        (lambda: PlanPolicy([[7, 1], [1, 7], [4, 8], [5, 3]] * 4), DEFAULT),
        (lambda: erratic, DEFAULT),
    ],
    ids=["rule", "agent", "plan", "a plan for each road", "a policy of the observations"],
)
def test_the_nine_values_are_those_of_driving_each_action(make, scenario):
    policy, horizon = make(), 9
    there = Reached(policy, 3, scenario)
    nine = np.tile(np.arange(N_ACTIONS), (len(ROADS), 1))
    imagined = imagine(there.cars, nine, policy, horizon, scenario)
    for action in range(N_ACTIONS):
        values, ended = by_hand(there, make(), action, horizon, scenario)
        np.testing.assert_allclose(imagined.values[:, action], values, atol=1e-9)
        np.testing.assert_array_equal(imagined.accidents[:, action] > 0, ended)
    hurt = imagined.accidents > 0
    assert not hurt.any() or hurt.all() or imagined.values[hurt].max() < imagined.values[~hurt].min()
    assert imagined.paths.shape == (len(ROADS), N_ACTIONS, horizon + 1, 2)


def test_looking_ahead_leaves_the_road_and_the_plan_as_they_are():
    plan = plan_policy([("keep straight", 3), ("brake straight", 40)])
    there = Reached(plan, 2)
    before, decision = there.cars.copy(), plan.decision
    rollout_values(there.cars, plan, 12)
    paths = imagine(Reached(idle_policy, 1).cars, np.full((len(ROADS), 1), 4), idle_policy, 3).paths
    np.testing.assert_allclose(np.diff(paths[:, 0, :, 0]), DEFAULT.ego.speed, atol=1e-9)
    np.testing.assert_array_equal(there.cars, before)
    assert plan.decision == decision


@pytest.mark.parametrize("make", [lookahead, lookahead_shield])
def test_looking_ahead_saves_a_plan_that_drives_into_trap_1(make):
    alone = drive_episodes(plan_policy(INTO_TRAP_1), ROADS)
    ahead = drive_episodes(make(plan_policy(INTO_TRAP_1), horizon=6), ROADS)
    assert (alone.accident > 0).all() and (ahead.returns > alone.returns).all()
    assert not (ahead.accident > 0).any()


def test_a_drive_that_is_recorded_holds_the_nine_values_and_follows_the_best():
    drive = bc.record(lookahead(bc.shipped_agents("soft")[0].as_policy(), horizon=4), ROADS[:1])[0]
    np.testing.assert_array_equal(drive.actions, drive.q_values.argmax(axis=1))
    assert drive.policy is not None


def imagined_road(model: Model, decisions: int = 4):
    """(cars before, cars of a road that the model imagines after some decisions of keeping straight)."""
    there, rng = Reached(idle_policy, 8), np.random.default_rng(0)
    scenario = model.scenarios(DEFAULT, rng)[0]
    seen = model.seen(there.cars, there.cars, DEFAULT, rng)
    env = TrapVectorEnv(len(ROADS), scenario, AutoresetMode.DISABLED)
    env.reset(seed=ROADS)
    env.cars[:] = seen
    for _ in range(decisions):
        env.step(np.full(len(ROADS), 4))
    return there.cars, seen, env.cars


def test_others_keep_their_speed_and_lane():
    _, seen, after = imagined_road(Model(keep=True))
    np.testing.assert_allclose(after[:, TRAP_1:, SPEED], seen[:, TRAP_1:, SPEED], atol=1e-6)
    np.testing.assert_array_equal(after[:, TRAP_1:, TARGET_LANE], seen[:, TRAP_1:, LANE])


def test_only_what_the_observation_shows_is_there():
    cars, seen, _ = imagined_road(Model(visible=True), 0)
    there = seen[:, 1:, X] > FAR_BEHIND
    assert (there.sum(axis=1) <= DEFAULT.sight.neighbours).all()
    for road, row in enumerate(there):
        near = np.hypot(cars[road, 1:, X] - cars[road, 0, X], cars[road, 1:, Y] - cars[road, 0, Y])
        assert near[row].max() < near[~row].min()


def test_a_road_that_is_seen_late_is_that_of_the_decision_before():
    look, env = lookahead(idle_policy, 1, models=[Model(all_late=True)]), TrapVectorEnv(2, DEFAULT)
    observations, _ = env.reset(seed=ROADS)
    before = env.cars.copy()
    look(observations, before)
    observations, *_ = env.step(np.full(2, 7))
    look(observations, env.cars)
    np.testing.assert_array_equal(look.imagined.values, rollout_values(before, idle_policy, 1))


def test_others_that_are_seen_late_are_moved_on_at_their_old_speed():
    cars = Reached(idle_policy, 8).cars
    now, earlier = cars.copy(), cars.copy()
    now[:, :, [X, SPEED]] += 50.0
    seen = Model(others_late=True).seen(now, earlier, DEFAULT, np.random.default_rng(0))
    np.testing.assert_array_equal(seen[:, EGO], now[:, EGO])
    np.testing.assert_array_equal(seen[:, TRAP_1:, SPEED], earlier[:, TRAP_1:, SPEED])
    straight = earlier[:, TRAP_1:, HEADING] == 0
    moved = (seen[:, TRAP_1:, X] - earlier[:, TRAP_1:, X])[straight]
    np.testing.assert_allclose(moved, earlier[:, TRAP_1:, SPEED][straight], atol=1e-9)


def test_drawn_drivers_differ_from_road_to_road_and_come_from_the_seed():
    there, model = Reached(idle_policy, 8), Model(drawn=2)
    cars, observations = there.cars[[0, 0]], there.observations[[0, 0]]
    first, again, other = (lookahead(idle_policy, 10, models=[model], seed=seed) for seed in (1, 1, 2))
    values = [each(observations, cars).q_values for each in (first, again, other)]
    assert (values[0][0] != values[0][1]).any()
    np.testing.assert_array_equal(values[0], values[1])
    assert (values[0] != values[2]).any()


def test_of_several_models_the_worst_case_counts():
    there = Reached(rule_policy(DEFAULT), 5)
    models = [model for (model,) in (MODELS["others keep speed and lane"], MODELS["twice the time gap"])]
    each = [lookahead(idle_policy, models=[one])(there.observations, there.cars).q_values for one in models]
    both = lookahead(idle_policy, models=models)(there.observations, there.cars).q_values
    np.testing.assert_array_equal(both, np.minimum(*each))


@pytest.mark.parametrize("name", MODELS)
def test_every_model_drives_every_form(name):
    for make in (lookahead, lookahead_shield):
        there = Reached(make(rule_policy(DEFAULT), 3, models=MODELS[name]), 4)
        assert len(there.actions) == 4 and not there.cars[:, EGO, CRASHED].any()


# What a user may get wrong.


@pytest.mark.parametrize(
    ("mistake", "sentence"),
    [
        (lambda: lookahead(idle_policy, 0), "horizon = 0: give a whole number from 1 to 1,000"),
        (lambda: lookahead(idle_policy, models=[]), "give at least one model"),
        (lambda: lookahead(None), "policy = None cannot drive: give a function of"),
        (lambda: lookahead_shield(lambda cars, scenario: 4), "or, for a rule, teacher_policy"),
        (lambda: drive_episodes(lambda observations: 4, ROADS), "give a function of"),
        (lambda: lookahead(bc.shipped_agents("soft")[0]), "give its policy, agent.as_policy"),
        (lambda: Model(noise=-1.0), "cannot be negative"),
        (lambda: Model(keep=True, time_gap=2.0), "want nothing else. Leave out keep"),
        (lambda: Model(drawn=3, desired_speed=1.0), "drawn around the true ones. Leave out drawn"),
        (
            lambda: drive_episodes(
                lookahead(idle_policy), ROADS, replace(DEFAULT, traffic=bc.scenario.Traffic(cars=2))
            ),
            "give the look-ahead the scenario that it drives",
        ),
    ],
)
def test_a_mistake_is_one_sentence(mistake, sentence):
    with pytest.raises(BootcourseError, match=sentence):
        mistake()


def test_a_rule_that_fails_in_an_imagined_drive_gives_the_imagined_state():
    def slow_alone(cars, scenario):
        return 4 if cars[0, 3] < 11 else None  # the real roads begin with 10 m/s

    policy = lookahead(bc.teacher_policy(slow_alone))
    with pytest.raises(RuleFailed, match="it returned None") as failed:
        drive_episodes(policy, ROADS)
    assert failed.value.state[0, SPEED] >= 11


def test_evaluate_and_drive_look_ahead_on_the_command_line(bootcourse, tmp_path):
    answer = bootcourse("evaluate", "idle", "--episodes", 2, "--lookahead", 3)
    assert answer.status == 0 and "looking 3 decisions ahead" in answer.out
    answer = bootcourse("drive", "idle", "--out", tmp_path / "drive.npz", "--lookahead", 3)
    drive = bc.Rollout.load(tmp_path / "drive.npz")
    assert drive.label == "idle, 3 ahead" and drive.q_values is not None


def test_the_lesson_s_imagined_road_refuses_what_are_not_actions():
    cars = bc.record(bc.idle_policy, [1])[0].cars[:2]
    assert imagined.step(cars, [0, 8])[1].shape == (2,)
    for actions in ([0, 9], [-1, 0], [0], [0.5, 1.0], [[0, 1]]):
        with pytest.raises(BootcourseError, match=r"give whole numbers in 0\.\.8, shape \(2,\)"):
            imagined.step(cars, actions)
    with pytest.raises(BootcourseError, match="cars have shape"):
        imagined.step(cars[:, :3], [0, 1])


# The experiment.


def test_a_study_drives_each_cell_once(bootcourse, tmp_path):
    command = ("study", "look-ahead", "--only", "rule", "--tests", 3, "--workers", 1, "--out", tmp_path)
    assert "3 to compute" in bootcourse(*command).out
    assert "3 done already, 0 to compute" in bootcourse(*command).out
    computed = experiment("look-ahead", tmp_path)
    alone, shield, rollouts = (computed[Cell("rule", form).name].measured for form in ("alone", "shield", "rollouts"))
    assert alone["returns"] == shield["returns"] and alone["returns"] != rollouts["returns"]
    assert shield["overruled"] == 0 and 0 < rollouts["overruled"] <= rollouts["decisions"]


def test_a_cell_drives_the_agents_in_the_folder_and_then_those_that_ship(tmp_path):
    shipped = [FOLDER / "runs" / f"soft-{seed}" for seed in range(2)]
    shutil.copytree(shipped[1], tmp_path / "soft" / "soft-1")
    results = drive_cell(Cell("soft", "alone", agents=2, roads=5), tmp_path)
    assert [agent["seed"] for agent in results.agents] == [0, 1]
    with pytest.raises(BootcourseError, match="no agent of soft with the seed 5, 6: run `bootcourse train --method"):
        drive_cell(Cell("soft", "alone", agents=7), tmp_path)
    for seed, path in enumerate(shipped):
        expected = drive_episodes(load_run(path).agent.as_policy(), bc.held_out_seeds(1, 5))
        assert results.measured["returns"][seed] == pytest.approx(expected.returns.mean())
        assert results.measured["accidents"][seed] == (expected.accident > 0).sum()


def results_of(hurt: int, returns: float = 130.0) -> Results:
    """Two agents with so many accidents in 2,000 drives."""
    numbers = {"roads": 1000, "success": 1, "decisions": 150_000, "overruled": 150, "seconds": 15}
    measured = {name: np.full(2, value) for name, value in numbers.items()}
    measured |= {"returns": np.array([returns - 1, returns + 1]), "accidents": np.array([hurt - 1, 1])}
    return Results([{"method": "ppo_cloned", "seed": seed} for seed in range(2)], np.full(2, -1), measured=measured)


def test_a_look_ahead_in_noise_goes_by_the_mean_of_so_many_roads():
    there, seen = Reached(idle_policy, 2), []

    def values_of(cars, decide, horizon, gamma, worth):  # the first road favours the last action, the others the first
        seen.append(cars[:, EGO + 1 :, X])
        return np.tile(np.arange(9.0) if len(seen) % 3 == 1 else np.arange(9.0)[::-1], (len(cars), 1))

    def decides(**how):
        seen.clear()
        return imagined.in_noise(values_of, idle_policy, **how)(there.observations, there.cars).actions.tolist()

    assert decides() == [8, 8] and decides(roads=3) == [0, 0]
    assert np.std(np.subtract(*seen[:2])) > 0.5, "each road is drawn anew"


def test_the_figure_and_the_table_say_how_many_drives_end_in_an_accident():
    computed = {cell.name: results_of(60 if cell.form == "alone" else 8) for cell in every_cell()}
    assert "others keep speed and lane 4.0;" in wrong_models(computed).alt
    headings, lines = rows(computed, every_cell())
    assert lines[0][7].startswith("60 in 2,000: 30.00 [") and {len(headings)} == {len(line) for line in lines}
    with pytest.raises(BootcourseError, match="lack ppo_cloned, rollouts"):
        wrong_models({"ppo_cloned, alone": results_of(60)})


def test_the_replay_has_nine_futures_for_each_decision_and_ribbons_along_them():
    drive = bc.record(rule_policy(DEFAULT), ROADS[:1])[0]
    (timeline,) = timelines_of(drive, futures=rule_policy(DEFAULT))
    pages = [to_html(beginning(drive, 3), False, futures) for futures in (None, rule_policy(DEFAULT))]
    assert len(pages[0]) < len(pages[1]) < len(pages[0]) + 3 * 4e3, "the futures of 150 decisions take less than 0.6 MB"
    assert timeline.imagined.values.shape == (len(drive.actions), N_ACTIONS)
    driven = trails(timeline.imagined, int(drive.actions[7]), 7)[-1]
    assert driven.chosen and driven.action == drive.actions[7]
    np.testing.assert_allclose(driven.x[:3], drive.cars[7:10, EGO, X], atol=1e-9)  # the rule goes on as it did
    left, right = _ribbon(driven).vertices.reshape(2, -1, 3)
    np.testing.assert_allclose((left + right)[:, :2] / 2, np.stack([driven.x, -driven.y], axis=1), atol=0.01)

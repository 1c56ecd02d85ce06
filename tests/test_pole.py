"""The pole's agents that the lesson on the update and the loop counts: how they train, and what ships."""

import re

import numpy as np
import torch

from bootcourse.course.lessons.update_and_loop import by_hand, exercises, explorable, pole, worlds
from bootcourse.course.shipped import shipped_experiment
from bootcourse.research.experiments import checks


def test_agents_train_for_some_blocks_with_marks_and_for_one_without(monkeypatch):
    monkeypatch.setattr(pole, "BLOCK", 260)
    monkeypatch.setitem(pole.BLOCKS, "marked", 2)
    monkeypatch.setattr(pole, "MORE", 2)
    for kind, blocks in (("marked", 2), ("unmarked", 1), ("paid-1", 1), ("frozen-30", 1), ("more-marked", 1)):
        results = pole.train_kind(**pole.cells(seeds=2)[kind])
        assert np.isfinite(results.notes["tests"]).sum(1).tolist() == [1 + blocks] * 2
        assert np.isfinite(results.notes["q"]).all() and (results.measured["most"] > 100).all()


def test_trainings_of_unequal_length_are_filled_up(monkeypatch):
    lengths = {0: 3, 1: 12}
    monkeypatch.setattr(pole, "train", lambda kind, seed, blocks: ([9.0] * lengths[seed], np.ones(9), 100.0, 500.0))
    notes = pole.train_kind("marked", 2).notes
    assert notes["tests"].shape == notes["q"].shape == (2, 12)
    assert [np.isfinite(notes[name]).sum(1).tolist() for name in ("tests", "q")] == [[3, 12], [9, 9]]


def test_the_agents_that_ship_train_until_two_tests_in_a_row_reach_the_mark():
    for tests in shipped_experiment("pole")["marked"].notes["tests"]:
        both = np.minimum(tests[1:], tests[:-1])[np.isfinite(tests[1:])]
        assert both[-1] >= pole.SOLVED > both[:-1].max()


def test_after_a_fall_two_rows_say_that_the_pole_stays_fallen_and_none_is_marked():
    buffer, state = exercises.ReplayBuffer.solution(10), np.arange(4)
    rows = worlds.WithFallen(buffer, paid=0.5)
    rows.add(by_hand.row(state, 1, 1.0, False, state + 1))
    rows.add(by_hand.row(state + 1, 0, 1.0, True, state + 2))
    fallen = [by_hand.row(state + 2, push, 0.5, False, state + 2) for push in (0, 1)]
    assert len(buffer.rows) == 4 and torch.equal(torch.stack(buffer.rows[2:]), torch.stack(fallen))
    assert not any(row[6] for row in buffer.rows)


def test_the_targets_of_a_frozen_guess_take_only_a_fallen_poles_value_from_the_untrained_critics():
    agent, states = worlds.FrozenGuess(seed=0), torch.zeros(3, 4)
    states[1, 0], states[2, 2] = 2.5, -2.2  # the cart has left its track; the pole leans by 0.22 rad
    untrained = agent.slow_q(states)
    with torch.no_grad():
        for parameter in agent.copies.parameters():
            parameter += 1
    changed = (agent.slow_q(states) != untrained).any(-1).any(0)
    assert changed.tolist() == [True, False, False] == (~worlds.fallen(states)).tolist()
    at_30 = worlds.FrozenAt30(seed=0).slow_q(states)
    assert (at_30[:, 1:] == 30).all() and torch.equal(at_30[:, 0], untrained[:, 0])


def test_an_agent_that_trains_on_is_a_copy_and_so_are_its_rows():
    parts = exercises.train.solution, exercises.update.solution
    rows = worlds.Unmarked(exercises.ReplayBuffer.solution(1_000))
    agent = worlds.taught(*parts, rows, 260, seed=0)
    before = worlds.along_falls(agent)
    later = worlds.taught_on(*parts, agent, rows, 260, seed=1)
    assert len(rows.buffer.rows) == 260
    assert (worlds.along_falls(agent) == before).all() and (worlds.along_falls(later) != before).all()


def test_two_poles_are_first_shown_where_the_recorded_pushes_let_one_fall():
    fell = {}
    for name, pushes in explorable.PUSHES.items():
        states = torch.from_numpy(explorable.episode(pushes) / checks.CARTPOLE_SCALES)
        fell[name] = worlds.fallen(states).tolist()
        assert not any(fell[name][:-1])
    assert [each[-1] for each in fell.values()] == [False, True]
    panel = explorable.two_poles()
    push = int(panel.numbers["push"].value)
    assert re.match(rf"Push {push}: .*agent 2 fell at push {push} ", panel.svg.alt) and push > 0


def test_an_agent_with_a_held_temperature_learns_and_its_temperature_stays():
    parts = exercises.train.solution, exercises.update.solution
    kind, rows = worlds.held(worlds.frozen_at(30), 0.5), worlds.Unmarked(exercises.ReplayBuffer.solution(1_000))
    agent = worlds.taught(*parts, rows, 280, seed=0, kind=kind)
    np.testing.assert_allclose(agent.log_alpha.exp().item(), 0.5, rtol=1e-6)
    assert (worlds.along_falls(agent) != worlds.along_falls(kind(seed=0))).all()


def test_an_action_is_drawn_without_a_warning_where_the_policy_is_sure():
    agent = by_hand.SAC(seed=0)
    with torch.no_grad(), np.errstate(over="raise"):
        for sure in (200.0, -200.0):
            agent.actor[-1].bias.copy_(torch.tensor([sure, -sure]))
            assert agent.draw(np.zeros(4, dtype=np.float32), np.random.default_rng(0)) == (sure < 0)

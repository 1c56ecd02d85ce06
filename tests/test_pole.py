"""The pole's agents that the lesson on the update and the loop counts: how they train, and what ships."""

import numpy as np

from bootcourse.course.lessons.update_and_loop import pole
from bootcourse.course.shipped import shipped_experiment


def test_agents_train_for_some_blocks_with_marks_and_for_one_without(monkeypatch):
    monkeypatch.setattr(pole, "BLOCK", 260)
    monkeypatch.setitem(pole.BLOCKS, "marked", 2)
    for kind, blocks in (("marked", 2), ("unmarked", 1)):
        results = pole.train_kind(**pole.cells(seeds=2)[kind])
        assert np.isfinite(results.notes["tests"]).sum(1).tolist() == [1 + blocks] * 2
        assert np.isfinite(results.notes["q"]).all() and (results.measured["most"] > 100).all()


def test_trainings_of_unequal_length_are_filled_up(monkeypatch):
    lengths = {0: 3, 1: 12}
    monkeypatch.setattr(pole, "train", lambda kind, seed: ([9.0] * lengths[seed], np.ones(9), 100.0, 500.0))
    notes = pole.train_kind("marked", 2).notes
    assert notes["tests"].shape == notes["q"].shape == (2, 12)
    assert [np.isfinite(notes[name]).sum(1).tolist() for name in ("tests", "q")] == [[3, 12], [9, 9]]


def test_the_agents_that_ship_train_until_two_tests_in_a_row_reach_the_mark():
    for tests in shipped_experiment("pole")["marked"].notes["tests"]:
        both = np.minimum(tests[1:], tests[:-1])[np.isfinite(tests[1:])]
        assert both[-1] >= pole.SOLVED > both[:-1].max()

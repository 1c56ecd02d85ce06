"""The clones that the lesson on demonstrations counts beside its own: how they are trained, and what ships."""

import numpy as np
import pytest

from bootcourse.course.lessons.demonstrations import cloning, fifteen
from bootcourse.course.shipped import shipped_experiment
from bootcourse.learn.demonstrations import collect


@pytest.mark.parametrize("kind, rounds", [(fifteen.RULE_S, 1), (fifteen.ADDED[2], 1), (fifteen.TAUGHT, 3)])
def test_clones_of_a_kind_are_measured_after_each_training(monkeypatch, kind, rounds):
    monkeypatch.setattr(cloning, "UPDATES", 5)
    monkeypatch.setattr(cloning, "ROADS", cloning.ROADS[:2])
    monkeypatch.setattr(fifteen, "SEEDS", 2)
    monkeypatch.setattr(fifteen, "collect", lambda drives, **more: collect(drives // 10, **more))
    results = fifteen.clones_of(kind)
    assert {name: values.shape for name, values in results.notes.items()} == dict.fromkeys(
        fifteen.MEASURES, (2, rounds)
    )
    assert [agent["seed"] for agent in results.agents] == [5, 6]
    assert all(0 <= values.min() <= values.max() <= 1 for values in list(results.notes.values())[:3])


def test_fifteen_of_each_kind_ship_whose_seeds_the_lesson_does_not_use():
    shipped = shipped_experiment("clones")
    assert set(shipped) == set(fifteen.CELLS)
    for results in shipped.values():
        assert {agent["seed"] for agent in results.agents} == set(range(5, 20))
        assert not np.isnan(results.notes["accidents"]).any()

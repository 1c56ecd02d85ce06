"""`bc.world`: who drives, what Python is told of it, and what readers without a kernel see."""

import json
import threading
import time
from functools import partial

import numpy as np
import pytest

import bootcourse as bc
from bootcourse import one_per_cell
from bootcourse.episodes.record import EpisodeRecorder, record
from bootcourse.errors import BootcourseError
from bootcourse.learn.settings import settings_for
from bootcourse.learn.training import Training
from bootcourse.policies import PlanPolicy, idle_policy, rule_policy
from bootcourse.scenario import ACTION_NAMES, DEFAULT
from bootcourse.web.widget import library

CRASH = [ACTION_NAMES.index("keep right")] * 20
OUT_OF_THE_ROAD = 2


@pytest.fixture(scope="module")
def agent():
    return Training([settings_for("soft", hidden=(16, 16))], 1).result().agents[0]


@pytest.fixture
def world():
    """Makes worlds; `.said` is what Python says to the page."""

    def make(*arguments, **options):
        made = bc.world(*arguments, **options)
        made.said = []
        made.send = made.said.append
        return made

    return make


def driven(world, actions, drive="a 1", over=False, driver="you"):
    """What the page tells after each decision."""
    told = {"kind": "driven", "drive": drive, "road": world.opens["road"], "driver": driver}
    world._heard(None, told | {"actions": list(actions), "over": over}, [])


def test_the_drive_is_driven_again_from_its_actions_equal_in_every_number(world):
    shown, ended = world(road=4), []
    shown.on_end(ended.append)
    assert shown.drive is None and shown.attempts == []
    [expected] = record(PlanPolicy(CRASH), [4])
    actions = expected.actions.tolist()
    driven(shown, actions[:3])
    assert shown.drive.actions.tolist() == actions[:3] and not ended
    driven(shown, actions, over=True)
    for name in ("states", "observations", "actions", "rewards", "terms", "rule_actions"):
        assert np.array_equal(getattr(shown.drive, name), getattr(expected, name)), name
    assert shown.drive.accident == OUT_OF_THE_ROAD and shown.drive.seed == 4 and shown.drive.label == "you"
    assert [drive.accident for drive in ended] == [OUT_OF_THE_ROAD]


def test_a_cell_reads_the_drive_while_decisions_arrive_in_another_thread(world, monkeypatch):
    class Slow(list):
        def append(self, each):
            time.sleep(0.005)
            super().append(each)

    def slowly(recorder, *start):
        begin(recorder, *start)
        recorder.observations = Slow(recorder.observations)

    begin, shown, read = EpisodeRecorder.__init__, world(road=4), []
    monkeypatch.setattr(EpisodeRecorder, "__init__", slowly)
    page = threading.Thread(target=lambda: [driven(shown, [4] * n) for n in range(1, 10)])
    page.start()
    while page.is_alive():
        read += [len(drive.actions) for drive in shown.attempts]
    assert set(read) <= set(range(1, 10)) and len(shown.drive.actions) == 9


def test_attempts_are_your_own_drives_and_not_those_of_others(world):
    shown = world(ghosts=["rule", idle_policy])
    driven(shown, [4, 4])
    driven(shown, [1], drive="a 2")
    driven(shown, [4, 4, 4], drive="a 3", driver="guest2")
    assert [drive.actions.tolist() for drive in shown.attempts] == [[4, 4], [1]]
    assert shown.drive.label == "idle"


def asked(world, driver, time=0):
    """The answer of a driver in Python to the start of road 3."""
    [start] = record(idle_policy, [3])
    message = {"kind": "ask", "number": "a 0", "driver": driver, "time": time, "cars": start.states[0].ravel().tolist()}
    world._heard(None, message, [])
    return world.said.pop()


def test_a_policy_and_a_rule_are_asked_for_each_decision(world):
    def my_rule(cars, scenario):
        return 1 if cars[0, 3] > 8 else 4

    shown = world(3, driver=my_rule, ghosts=[rule_policy(DEFAULT), PlanPolicy([7])])
    assert asked(shown, "guest0") == {"kind": "answer", "number": "a 0", "thought": {"action": 1}}
    [by_rule] = record(rule_policy(DEFAULT), [3])
    assert asked(shown, "guest1")["thought"]["action"] == by_rule.actions[0]
    assert shown.drivers[2]["plan"] == [7]


def test_a_driver_is_called_by_the_name_that_the_reader_gave_its_function(world):
    def my_rule(cars, scenario, slow=8):
        return 1 if cars[0, 3] > slow else 4

    shown = world(3, driver=partial(my_rule, slow=9), ghosts=[rule_policy(DEFAULT), lambda cars, scenario: 4])
    assert [each["name"] for each in shown.drivers] == ["my_rule", "policy", "policy"]


def test_what_a_readers_rule_does_wrong_is_one_sentence_for_the_page(world):
    def breaks(cars, scenario):
        return cars["speed"]

    def answers_nine(cars, scenario):
        return 9

    shown = world(3, driver=breaks, ghosts=[answers_nine])
    assert "breaks" in asked(shown, "guest0")["error"] and "IndexError" in asked(shown, "guest0")["error"]
    assert "returned 9, but an action is a whole number from 0 to 8" in asked(shown, "guest1")["error"]


def test_the_module_is_in_one_widget_for_all_worlds_and_each_world_is_small(world, agent):
    one, other = world(1), world(2, driver=agent)
    assert one.library is other.library is library() and len(library().text) > 200_000
    sizes = [len(json.dumps(each.get_state(["opens", "drivers", "_esm", "library"]))) for each in (one, other)]
    assert sizes[0] < 3000 and sizes[1] < 10_000
    assert other.drivers[0]["network"]["sizes"] == [26, 16, 16, 9]


def test_a_world_that_is_shown_again_by_its_cell_closes_the_one_before(world, monkeypatch):
    monkeypatch.setattr(one_per_cell, "this_cell", lambda: "cell")
    first, second = world(1), world(1)
    assert first.closed and not second.closed and one_per_cell.running() == [second]


def test_where_no_kernel_runs_there_is_a_picture_with_the_pages_address(world):
    data, _ = world(7, ghosts=["sac", idle_policy])._repr_mimebundle_()
    assert "application/vnd.jupyter.widget-view+json" in data
    assert 'src="data:image/svg+xml;base64,' in data["text/html"] and "Road 7" in data["text/plain"]
    assert 'data-world="road=7&amp;ghost=sac&amp;driver=you' in data["text/html"]


REFUSED = {
    "road = -1": {"road": -1},
    "road = 2.5": {"road": 2.5},
    "The driver 'ruel' is unknown: did you mean 'rule'": {"driver": "ruel"},
    "action = 9: give a whole number from 0 to 8": {"ghosts": [[4, 9]]},
    "3 cannot drive: give an agent, a policy, a rule or a plan": {"driver": 3},
    "cannot drive: give a function of": {"driver": lambda: 4},
    "view = 'side': choose 'above' or '3d'": {"view": "side"},
}


@pytest.mark.parametrize("sentence", REFUSED)
def test_what_a_world_cannot_show_is_refused_in_one_sentence(sentence):
    with pytest.raises(BootcourseError, match=sentence):
        bc.world(**REFUSED[sentence])

"""`scenario_panel`: every number at both ends and beyond, and a scenario that is valid whatever happens."""

import math
from dataclasses import replace
from xml.etree import ElementTree

import pytest

from bootcourse import scenario as library
from bootcourse.errors import BootcourseError
from bootcourse.panels import scenario_panel
from bootcourse.panels.scenario_fields import FIELDS, as_code, changed
from bootcourse.panels.scenario_view import consequences, start_of
from bootcourse.road.state import EGO, TRAP_1, TRAP_2, X
from bootcourse.scenario import CALIBRATED, DEFAULT, Scenario, Traps
from tests.panels import from_page, raise_in_callbacks, seconds_of_a_drag, words  # noqa: F401

pytestmark = pytest.mark.usefixtures("raise_in_callbacks")


@pytest.fixture
def panel():
    return scenario_panel()


def number_of(panel, symbol):
    return next(number for field, number in panel.numbers.items() if field.symbol == symbol)


def test_a_panel_that_nobody_touched_holds_the_scenario_it_was_given():
    for scenario in (DEFAULT, CALIBRATED):
        assert scenario_panel(scenario).scenario is scenario
    assert changed(DEFAULT, {field: field.of(DEFAULT) for field in FIELDS}) is DEFAULT


def test_the_calibrated_traps_are_one_drag_away_from_the_default(panel):
    from_page(number_of(panel, "v trap").slider, value=10.9)
    assert panel.scenario == replace(CALIBRATED, name="default, changed")
    assert panel.scenario.traps.speed == 10.9


@pytest.mark.parametrize("field", FIELDS, ids=lambda field: f"{field.part}.{field.name}.{field.end}")
def test_each_number_at_both_ends_and_at_nonsense_leaves_a_valid_scenario_or_a_sentence(panel, field):
    number, size = panel.numbers[field], panel.svg.split(' role="img"')[0]
    for value in (field.low, field.high, -1e9, 1e9, 0.123456, float("nan"), float("inf")):
        number.field.value = value
        assert isinstance(panel.scenario, Scenario)
        assert field.of(panel.scenario) == number.value
        assert Scenario.from_json(panel.scenario.to_json()) == panel.scenario
        refused = not math.isclose(number.value, value, abs_tol=1e-9)
        assert refused == (number.refused is not None) == ("bc-wrong" in number.help.value)
        assert refused == ("Does not fit yet" in panel.says.value)
        ElementTree.fromstring(panel.svg)
        assert panel.svg.split(' role="img"')[0] == size


def test_a_refused_number_is_taken_as_soon_as_another_makes_room(panel):
    low, high = number_of(panel, "D1 from"), number_of(panel, "D1 to")
    from_page(low.slider, value=20.0)
    assert panel.scenario == DEFAULT
    assert "low first" in words(low) and "D1 from = 20" in words(panel)
    from_page(high.slider, value=25.0)
    assert panel.scenario.traps.d1 == (20.0, 25.0)
    assert panel.says.value == ""


def test_a_longer_episode_waits_for_a_longer_road(panel):
    from_page(number_of(panel, "decisions").slider, value=300.0)
    assert "Road.length = 5000.0 m is shorter than the 7500 m" in words(panel)
    from_page(number_of(panel, "length").slider, value=8000.0)
    assert (panel.scenario.clock.decisions, panel.scenario.road.length) == (300, 8000.0)


def test_a_count_that_is_not_whole_is_refused_in_the_librarys_words(panel):
    from_page(number_of(panel, "cars").field, value=2.5)
    assert "Traffic.cars = 2.5: give a whole number." in words(panel)
    from_page(number_of(panel, "cars").field, value=3.0)
    assert panel.scenario.traffic.cars == 3 and isinstance(panel.scenario.traffic.cars, int)


def test_start_again_puts_everything_back(panel):
    for symbol, value in (("v trap", 12.0), ("lanes", 5.0), ("D1 to", 30.0), ("D1 from", 25.0), ("t safe", -1.0)):
        number_of(panel, symbol).field.value = value
    assert panel.scenario != DEFAULT and panel.says.value
    panel.back.click()
    assert panel.scenario == DEFAULT and panel.says.value == ""
    assert all(number.value == field.of(DEFAULT) == number.field.value for field, number in panel.numbers.items())


def test_each_group_shows_its_numbers_and_together_they_are_all(panel):
    seen = []
    for name in panel.groups.options:
        from_page(panel.groups, index=panel.groups.options.index(name))
        seen += panel.shown.children
    assert seen == list(panel.numbers.values())


def test_the_view_is_the_road_that_the_scenario_begins(panel):
    cars = start_of(DEFAULT, 0)
    assert 14.8 <= cars[TRAP_1, X] - cars[EGO, X] <= 16.44
    assert 4.06 <= cars[TRAP_2, X] - cars[EGO, X] <= 7.43
    assert f"trap 1 is {cars[TRAP_1, X] - cars[EGO, X]:.1f} m ahead" in panel.svg.alt
    before = panel.svg
    from_page(panel.road.slider, value=5.0)
    assert panel.svg != before
    for wrong in (-1.0, 0.5, 2.0**40, float("nan")):
        panel.road.field.value = wrong
        assert panel.road.value == 5.0


def test_staying_behind_earns_23_4375_in_an_episode():
    assert "earns 0.156, 23.4 in the episode" in consequences(DEFAULT)[1]
    assert "6, 8.25, 10.5, 12.75, 15 m/s" in consequences(DEFAULT)[2]
    assert "between" in consequences(replace(DEFAULT, rule=replace(DEFAULT.rule, n=20)))[2]


def test_the_python_below_the_panel_makes_the_same_scenario(panel):
    for symbol, value in (("v trap", 12.0), ("lanes", 5.0), ("D1 to", 30.0), ("cars", 9.0)):
        number_of(panel, symbol).field.value = value
    code = as_code(panel.scenario, DEFAULT)
    made = eval(code, {"replace": replace, **vars(library)})
    assert replace(made, name=panel.scenario.name) == panel.scenario
    assert as_code(DEFAULT, DEFAULT) == "DEFAULT"


def test_dragging_the_traps_speed_moves_the_view_within_a_frame(panel):
    seconds = seconds_of_a_drag(number_of(panel, "v trap").slider, [round(8 + 0.1 * i, 1) for i in range(40)])
    assert panel.view.value == panel.svg
    assert seconds < 0.05, f"{1000 * seconds:.1f} ms"  # 2 ms on a quiet machine


def test_a_scenario_of_your_own_can_be_the_start():
    own = replace(DEFAULT, name="mine", traps=Traps(speed=12.0))
    panel = scenario_panel(own, seed=3)
    assert panel.scenario is own and "scenario" in panel.code.value
    from_page(number_of(panel, "v trap").slider, value=13.0)
    assert panel.scenario.name == "mine, changed"


@pytest.mark.parametrize("wrong", [None, 3])
def test_what_is_no_scenario_is_refused_in_one_sentence(wrong):
    with pytest.raises(BootcourseError, match="give a") as error:
        scenario_panel(wrong)
    assert "\n" not in str(error.value)

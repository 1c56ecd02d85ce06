"""What a lesson lets one drag before its first formula: moved as the page does, and compared with the library."""

import importlib
import re
import time
from types import SimpleNamespace

import numpy as np
import pytest
import torch

from bootcourse.course.lessons import COURSE, LESSONS
from bootcourse.course.lessons.learning_from_demonstrations.explorable import nine_values_of
from bootcourse.course.lessons.looking_ahead import explorable as futures
from bootcourse.course.lessons.other_ways.figures import two_counts
from bootcourse.course.lessons.the_barrier.explorable import by_plan, hill
from bootcourse.course.shipped import shipped_experiment
from bootcourse.learn import sac
from bootcourse.learn.bootstrap import large_margin_loss, regularised_policy
from bootcourse.panels.explorable import Explorable
from bootcourse.policies import idle_policy
from bootcourse.research.equal_decisions import by_method
from bootcourse.statistics import rate
from tests.panels import at_its_ends, from_page, inside, raise_in_callbacks  # noqa: F401
from tools.course.known import discounted, idle
from tools.course.numbering import text_file
from tools.course.source import read

pytestmark = pytest.mark.usefixtures("raise_in_callbacks")
FIRST = {lesson: re.findall(r"^explorable\.(\w+)\(\)", text_file(lesson).read_text(), re.M) for lesson in LESSONS}
PANELS = [(lesson, name) for lesson, names in FIRST.items() for name in names]


def shown(lesson: str, name: str = "") -> Explorable:
    """A lesson's panel, by default its first."""
    module = importlib.import_module(f"bootcourse.course.lessons.{lesson}.explorable")
    return getattr(module, name or FIRST[lesson][0])()


@pytest.mark.parametrize(("lesson", "name"), PANELS)
def test_each_slider_changes_the_picture_and_refuses_nonsense(lesson, name):
    panel = shown(lesson, name)
    for number in panel.numbers.values():
        start, before = number.slider.value, panel.svg
        pictures = {before}
        for value in ((number.low + number.high) / 2, number.high):
            from_page(number.slider, value=value)
            pictures.add(panel.svg)
        assert len(pictures) > 1 and panel.view.value == panel.svg
        assert (panel.svg == before) == (number.slider.value == start), "one value, one picture"
        size = panel.svg.split(' role="img"')[0]
        for value in (number.low, number.high):
            from_page(number.slider, value=value)
            assert panel.svg.split(' role="img"')[0] == size and "nan" not in panel.svg
        from_page(number.field, value=float("nan"))
        assert "bc-wrong" in number.help.value


@pytest.mark.parametrize("lesson", [each for each in COURSE[1:] if FIRST[each] or "$$" in text_file(each).read_text()])
def test_each_core_lesson_has_something_to_drag_before_the_formula_of_its_round(lesson):
    cells = read(text_file(lesson))
    shows = r"^explorable\.\w+\(\)|^bc\.panels\.bonus_panel\(c=0\)"
    place = next(i for i, cell in enumerate(cells) if cell.is_code and re.search(shows, cell.student, re.M))
    begins = max(i for i, cell in enumerate(cells[:place]) if re.search("^## ", cell.text, re.M))
    round_so_far = "\n".join(cell.text for cell in cells[begins:place])
    assert "$$" not in round_so_far
    assert re.search(r"\*\*Drag\*\*", cells[place - 1].text), "a question that the sliders answer"


def test_the_best_policy_of_two_numbers_is_the_one_of_the_learner_and_its_head_start_stays_while_alpha_falls():
    panel, says = shown("soft_constraint"), []
    for alpha in (1e-1, 1e-2, 1e-4):
        from_page(panel.numbers["alpha"].field, value=alpha)
        says.append(re.search(r"head start is ([\d.]+)", panel.svg.alt)[1])
    assert says == ["4.26"] * 3
    module = importlib.import_module("bootcourse.course.lessons.soft_constraint.explorable")
    log_rule = torch.log(torch.tensor([[0.0125] * 9], dtype=torch.float64))
    log_rule[0, module.RULE] = np.log(0.9)
    q = torch.zeros(1, 9, dtype=torch.float64)
    q[0, module.BETTER] = module.LEAD
    for alpha, wanted in ((0.01, module.RULE), (0.0001, module.BETTER)):
        assert int(regularised_policy(q, log_rule, alpha, 200 * alpha).argmax()) == wanted


def test_the_numbers_in_the_sentences_are_those_of_the_library():
    panel = shown("discrete_sac")
    q = torch.tensor([[0.9, 1.0, 0.5]], dtype=torch.float64)
    log_pi = sac.log_policy(q / 0.3)
    assert f"Its entropy is {sac.entropy(log_pi).item():.2f} nats" in panel.svg.alt
    low, high = 100 * np.array(rate(np.arange(10) < 8)[1:])
    assert f"{low:.0f} to {high:.0f} %" in shown("how_many_seeds").svg.alt
    panel, of_staying = shown("the_barrier"), by_plan().values(0.8).mean() / discounted(idle(), 0.8)
    assert abs(hill(10, 0.8)[0] - of_staying) < 1e-4
    for price, gamma in ((10, 0.8), (1, 0.8), (10, 0.95), (0, 0.95)):
        for name, value in (("price", price), ("gamma", gamma)):
            from_page(panel.numbers[name].slider, value=value)
        now, later = hill(price, gamma)[[0, -1]]
        for said in (f"the plan is worth {now:.1f} times staying", f"after 14 s {later:.1f}."):
            assert said in panel.svg.alt


def test_the_soft_target_is_the_plain_one_at_alpha_0_and_the_best_action_and_above_it_with_the_softmax():
    panel = shown("discrete_sac", "backup")
    for right, alpha, soft in ((0.5, 1, "3.42"), (0.88, 1, "3.81"), (1, 0, "3.70")):
        from_page(panel.numbers["right_now"].field, value=right)
        from_page(panel.numbers["alpha"].field, value=alpha)
        assert f"The plain target is 3.70, the soft one {soft}." in panel.svg.alt


def test_alpha_falls_for_ever_only_if_the_target_entropy_is_below_zero_and_rises_if_it_is_above_the_even_policy_s():
    panel = shown("discrete_sac", "thermostat")
    for target, course in ((-1, "falls at each update"), (0.7, "comes to rest"), (2.5, "rises at each update")):
        from_page(panel.numbers["target"].field, value=target)
        assert course in panel.svg.alt


def test_the_futures_say_until_which_decision_a_drive_can_be_saved(crash):
    last, panel = futures.last_chance(crash, idle_policy), futures.futures_of(crash, idle_policy)
    safe = futures.ways_out(crash, idle_policy)
    assert 0 < last < len(crash.actions)
    for decision, words in ((last, f"{safe[last - 1]} of nine futures have no accident"), (last + 1, "it is too late")):
        from_page(panel.numbers["decision"].field, value=decision)
        assert words in panel.svg.alt and "nan" not in panel.svg


def test_the_distance_that_the_margin_is_dragged_to_is_the_large_margin_loss():
    q = np.random.default_rng(1).normal(0, 1, (4, 9))
    did = np.array([0, 8, 3, int(q[3].argmax())])
    panel = nine_values_of(SimpleNamespace(q_values=lambda observations: q), SimpleNamespace(
        observations=q, rule_actions=did), seconds=4)  # fmt: skip
    for margin in (0.0, 1.0, 2.0):
        from_page(panel.numbers["margin"].slider, value=margin)
        for second, loss in enumerate(large_margin_loss(torch.tensor(q), torch.tensor(did), margin), 1):
            from_page(panel.numbers["second"].field, value=second)
            assert f"between the dashed lines: {loss:.1f}." in panel.svg.alt and "nan" not in panel.svg
    assert "and has the largest Q" in panel.svg.alt


def test_by_seconds_of_computing_the_learner_is_the_first_that_is_the_last_by_decisions():
    figure = two_counts(by_method(shipped_experiment("beyond")), 51.0)
    assert "By seconds of computing PPO after cloning earns the most of the five, by decisions the least" in figure.alt
    seconds, decisions = (len(ax.lines) for ax in figure.axes)
    assert decisions == seconds


def test_a_move_is_answered_at_once():
    """Wanted is a tenth of a second; the best of some moves, because other programs may have the processor."""
    for lesson, name in PANELS:
        panel, best = shown(lesson, name), np.inf
        number = next(iter(panel.numbers.values()))
        for value in np.linspace(number.low, number.high, 6):
            begun = time.process_time()
            from_page(number.slider, value=float(value))
            best = min(best, time.process_time() - begun)
        assert best < 0.1, (lesson, name)


def test_the_pole_of_the_agent_with_the_bug_falls_at_its_last_recorded_push_and_the_other_s_stands():
    panel = shown("update_and_loop", "two_poles")
    from_page(panel.numbers["push"].field, value=30)
    last = int(re.search(r"agent 2 fell at push (\d+)", panel.svg.alt)[1])
    for push, fell in ((last - 1, False), (last, True)):
        from_page(panel.numbers["push"].field, value=push)
        assert ("agent 2 fell" in panel.svg.alt) == fell and "agent 1 leans" in panel.svg.alt

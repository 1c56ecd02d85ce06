"""The exercises: a wrong answer never passes, a right one always does, and a sentence says what is wrong."""

import itertools

import pytest
import torch

from bootcourse.course import check, runner, values
from bootcourse.course.judge import judge, outcomes
from bootcourse.course.lessons import registry
from bootcourse.errors import BootcourseError
from tests.answers import RIGHT, WRONG, here, one_sentence

EXERCISES = registry()
NOT_RIGHT = ("wrong", "did_not_run")
every_exercise = pytest.mark.parametrize("exercise", EXERCISES.values(), ids=lambda exercise: exercise.name)


@pytest.fixture(autouse=True)
def fast(monkeypatch):
    """Answers run in this process; `test_lessons_guard.py` judges some in processes of their own."""
    monkeypatch.setattr(runner, "run", here)


# Every exercise -----------------------------------------------------------------------------------


@pytest.mark.parametrize("name", RIGHT)
def test_right_answers_pass(name):
    for answer in RIGHT[name]:
        verdict = judge(EXERCISES[name], answer)
        assert verdict.passed, (answer.__name__, verdict)


@pytest.mark.parametrize("name", WRONG)
def test_wrong_answers_are_rejected_in_one_sentence_with_their_own_words(name):
    for answer, words in WRONG[name]:
        verdict = judge(EXERCISES[name], answer)
        assert verdict.kind in NOT_RIGHT and words in verdict.sentence and one_sentence(verdict), (answer, verdict)


@every_exercise
def test_a_known_mistake_gets_its_message(exercise):
    for mistake in exercise.mistakes:
        verdict = judge(exercise, mistake.answer)
        assert verdict.sentence == mistake.says and verdict.mistake is mistake and mistake.says.endswith(".")


@every_exercise
def test_the_solution_gives_what_was_worked_out_by_hand(exercise):
    assert exercise.worked
    for answer, (_, by_hand) in zip(outcomes(exercise, exercise.solution), exercise.worked, strict=False):
        if exercise.slopes and not isinstance(by_hand, tuple):
            answer = answer.data[0]
        assert values.same(answer, values.plain(by_hand), exercise.tolerance), values.numbers(answer)


def test_hints_come_one_by_one_and_the_solution_when_asked():
    for name, exercise in EXERCISES.items():
        check._hints_given.clear()
        shown = [check.hint(name) for _ in range(len(exercise.hints) + 1)]
        assert [hint.sentence.partition(": ")[2] for hint in shown] == [*exercise.hints, exercise.hints[-1]]
        assert "solution" in shown[-1].footer and ("solution" not in shown[0].footer or len(exercise.hints) == 1)
        assert "def " in check.solution(name).data


# The engine, on a few exercises -------------------------------------------------------------------
# A number, a loss, and how well an answer drives stand for all.


@pytest.fixture(params=["target_speed", "cloning_loss", "my_rule"])
def one(request):
    return EXERCISES[request.param]


@pytest.mark.parametrize("body", ["...", "raise NotImplementedError", "'''What it does.'''"])
def test_an_untouched_stub_fails_politely(one, body):
    space = {}
    exec(f"def {one.call}:\n    {body}", space)
    verdict = judge(one, space[one.name])
    assert verdict.kind == "todo" and "Nothing to check yet" in verdict.sentence and not verdict.passed


def test_a_wrong_type_is_said_in_one_sentence(one):
    for value in (["a list"], "words", {1: 2}, object(), 1j, torch.nn.Linear(1, 1), (1.0, 2.0)):
        verdict = judge(one, lambda *arguments, value=value: value)
        assert verdict.kind in NOT_RIGHT and one_sentence(verdict)
        assert "returns" in verdict.sentence or "shape" in verdict.sentence


def test_raising_is_said_in_one_sentence_with_the_line(one):
    def raises(*arguments):
        return 1 / (len(arguments) - len(arguments))

    verdict = judge(one, raises)
    assert "`return 1 / (len(arguments) - len(arguments))`: ZeroDivisionError" in verdict.sentence
    assert verdict.kind == "did_not_run" and one_sentence(verdict)


TARGET = EXERCISES["critic_target"]


def evil(*arguments):
    raise ValueError("<script>alert(1)</script>")


def test_what_is_no_function_is_said_in_one_sentence():
    verdict = judge(TARGET, 3.0)
    assert verdict.kind == "wrong" and "this is a number" in verdict.sentence and one_sentence(verdict), verdict


def test_an_answer_that_is_wrong_in_no_known_way_is_shown_its_first_case():
    verdict = check.critic_target(lambda reward, terminated, next_value, gamma: reward + 5)
    assert "differ at [0]" in verdict.sentence
    assert {"gamma = 0.8", "reward = [1, -10]", "yours = [6, -5]", "right = [9, -10]"} <= set(verdict.details)


def test_an_answer_that_is_right_in_all_but_one_case_does_not_pass():
    seen = itertools.count()
    assert not judge(TARGET, lambda *given: TARGET.solution(*given) + (next(seen) == 40)).passed


def test_strict_raises_what_does_not_pass_and_only_that():
    check.strict()
    try:
        assert check.critic_target(lambda r, ended, v, gamma: r + gamma * (1 - ended) * v).passed
        with pytest.raises(check.NotPassed, match="critic_target: … Nothing to check yet"):
            check.critic_target(lambda *arguments: None)
    finally:
        check.strict(False)


def test_a_misspelt_exercise_is_one_sentence_with_the_nearest_name():
    with pytest.raises(AttributeError, match="did you mean 'critic_target'"):
        check.critic_targets  # noqa: B018
    with pytest.raises(BootcourseError, match="did you mean 'critic_target'"):
        check.hint("critic_targets")


def test_markup_in_a_message_is_shown_and_not_obeyed():
    verdict = check.critic_target(evil)
    assert "<script>" not in verdict._repr_mimebundle_()["text/html"] and "<script>" in repr(verdict)

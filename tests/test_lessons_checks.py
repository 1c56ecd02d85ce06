"""The exercises: a wrong answer never passes, a right one always does, and nothing that it does ends the notebook."""

import copy
import dataclasses
import inspect
import itertools
import sys

import cloudpickle
import numpy as np
import pytest
import torch

from bootcourse.course import check, runner, values
from bootcourse.course.exercise import call_it, logits
from bootcourse.course.exercise import exercise as exercise_of
from bootcourse.course.judge import judge, outcomes
from bootcourse.course.lessons import registry
from bootcourse.course.verdict import Verdict
from bootcourse.errors import BootcourseError
from tests.answers import RIGHT, WRONG, here, one_sentence

EXERCISES = list(registry().values())


def of_each(exercises):
    return pytest.mark.parametrize("exercise", exercises, ids=lambda exercise: exercise.name)


NOT_RIGHT = ("wrong", "did_not_run")
every_exercise = of_each(EXERCISES)
# A number, an array, a loss, how well an answer drives, and a verdict in the exercise's own words stand for all.
some_exercises = of_each(
    [registry()[n] for n in ("target_speed", "stochastic_rule", "cloning_loss", "my_rule", "diagnose")]
)
cloudpickle.register_pickle_by_value(sys.modules[__name__])


@pytest.fixture
def fast(monkeypatch):
    monkeypatch.setattr(runner, "run", here)


# Every exercise -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "name, answer",
    [(name, answer) for name in RIGHT for answer in RIGHT[name]],
    ids=lambda x: getattr(x, "__name__", x),
)
@pytest.mark.usefixtures("fast")
def test_a_right_answer_passes(name, answer):
    verdict = judge(registry()[name], answer)
    assert verdict.passed, verdict


@pytest.mark.parametrize(
    "name, answer, words",
    [(name, *pair) for name in WRONG for pair in WRONG[name]],
    ids=lambda x: getattr(x, "__name__", None) or (x if x in WRONG else "says"),
)
@pytest.mark.usefixtures("fast")
def test_a_wrong_answer_is_rejected_with_its_own_message(name, answer, words):
    verdict = judge(registry()[name], answer)
    assert verdict.kind in NOT_RIGHT and words in verdict.sentence and one_sentence(verdict), verdict


def test_every_table_of_answers_belongs_to_an_exercise():
    assert set(RIGHT) | set(WRONG) <= set(registry())


@every_exercise
def test_an_exercise_has_two_right_answers_three_known_mistakes_and_with_them_five_wrong_answers(exercise):
    assert len(RIGHT[exercise.name]) >= 2
    assert len(exercise.mistakes) >= 3
    assert WRONG[exercise.name] and len(WRONG[exercise.name]) + len(exercise.mistakes) >= 5


@every_exercise
def test_the_solution_gives_what_was_worked_out_by_hand(exercise):
    assert exercise.worked
    for answer, (_, by_hand) in zip(outcomes(exercise, exercise.solution), exercise.worked, strict=False):
        if exercise.slopes and not isinstance(by_hand, tuple):
            answer = answer.data[0]
        assert values.same(answer, values.plain(by_hand), exercise.tolerance), values.numbers(answer)


@every_exercise
@pytest.mark.usefixtures("fast")
def test_the_solution_passes_and_the_cases_are_many_and_the_same_each_time(exercise):
    assert judge(exercise, exercise.solution).passed
    twins = exercise, dataclasses.replace(exercise)
    first, again = ([[values.numbers(values.plain(v)) for v in c] for c in each.all_arguments] for each in twins)
    assert first == again and len(first) >= 20


@every_exercise
@pytest.mark.usefixtures("fast")
def test_a_known_mistake_gets_its_message(exercise):
    for mistake in exercise.mistakes:
        assert judge(exercise, mistake.answer).sentence == mistake.says
        assert mistake.says.endswith(".")


@pytest.mark.usefixtures("fast")
@pytest.mark.parametrize("body", ["...", "pass", "return None", "raise NotImplementedError", "'''What it does.'''"])
@some_exercises
def test_an_untouched_stub_fails_politely(exercise, body):
    space = {}
    exec(f"def {exercise.call}:\n    {body}", space)
    verdict = judge(exercise, space[exercise.name])
    assert verdict.kind == "todo" and "Nothing to check yet" in verdict.sentence and not verdict.passed


@some_exercises
@pytest.mark.usefixtures("fast")
def test_a_wrong_type_is_said_in_one_sentence(exercise):
    for value in (["a list"], "words", {1: 2}, object(), 1j, torch.nn.Linear(1, 1), (1.0, 2.0)):
        verdict = judge(exercise, lambda *arguments, value=value: value)
        assert verdict.kind in NOT_RIGHT and one_sentence(verdict)
        assert (
            "returns" in verdict.sentence or "shape" in verdict.sentence
        )  # two numbers are an array, of a wrong shape


def changed_values(exercise, change):
    """An answer that computes the right thing and then changes it, a tuple part by part."""

    def answer(*arguments):
        right = exercise.solution(*arguments)
        return tuple(map(change, right)) if isinstance(right, tuple) else change(right)

    return answer


def is_compared_as_it_is(exercise) -> bool:
    """Numbers that nothing else is computed from before they are compared."""
    answer = values.plain(exercise.outcome(exercise.solution, *copy.deepcopy(exercise.all_arguments[0])))
    return exercise.run is call_it and not exercise.slopes and answer.kind in (*values.NUMERIC, "tuple")


@some_exercises
@pytest.mark.usefixtures("fast")
def test_a_wrong_shape_is_said_in_one_sentence(exercise):
    stack = lambda value: torch.stack([value] * 3) if isinstance(value, torch.Tensor) else np.array([value] * 3)  # noqa: E731
    verdict = judge(exercise, changed_values(exercise, stack))
    assert verdict.kind in NOT_RIGHT and one_sentence(verdict)
    assert not is_compared_as_it_is(exercise) or "shape" in verdict.sentence or "returns" in verdict.sentence


@some_exercises
@pytest.mark.usefixtures("fast")
def test_nan_is_said_in_one_sentence(exercise):
    verdict = judge(exercise, changed_values(exercise, lambda value: value * float("nan")))
    assert verdict.kind in NOT_RIGHT and one_sentence(verdict)
    assert not is_compared_as_it_is(exercise) or "NaN" in verdict.sentence


@of_each([registry()[n] for n in ("stochastic_rule", "cloning_loss", "my_rule")])  # the others ask for no array
@pytest.mark.usefixtures("fast")
def test_changing_an_argument_in_place_is_said_in_one_sentence(exercise):
    def in_place(*arguments):
        answer = exercise.solution(*arguments)
        for argument in arguments:
            if isinstance(argument, (torch.Tensor, np.ndarray)):
                argument[...] = 0
        return answer

    verdict = judge(exercise, in_place)
    assert verdict.kind in NOT_RIGHT and "changes its argument `" in verdict.sentence and one_sentence(verdict)


@some_exercises
@pytest.mark.usefixtures("fast")
def test_raising_is_said_in_one_sentence_with_the_line(exercise):
    def raises(*arguments):
        return 1 / (len(arguments) - len(arguments))

    verdict = judge(exercise, raises)
    assert "`return 1 / (len(arguments) - len(arguments))`: ZeroDivisionError" in verdict.sentence
    assert verdict.kind in NOT_RIGHT and one_sentence(verdict)


@some_exercises
@pytest.mark.usefixtures("fast")
def test_a_wrong_number_of_arguments_is_said_in_one_sentence(exercise):
    verdict = judge(exercise, lambda only, *, too: only)
    assert f"the check calls `{exercise.call}`" in verdict.sentence and one_sentence(verdict)


@every_exercise
def test_hints_come_one_by_one_and_the_solution_when_asked(exercise):
    check._hints_given.clear()
    shown = [check.hint(exercise.name) for _ in range(len(exercise.hints) + 1)]
    assert [hint.sentence.partition(": ")[2] for hint in shown] == [*exercise.hints, exercise.hints[-1]]
    assert "return" in check.solution(exercise.name).data
    assert "solution" in shown[-1].footer and "solution" not in shown[0].footer


# The engine, on one exercise ----------------------------------------------------------------------

TARGET = registry()["critic_target"]


def test_an_answer_that_is_wrong_in_no_known_way_is_shown_its_first_case():
    verdict = check.critic_target(lambda reward, terminated, next_value, gamma: reward + 5)
    assert "differ at [0]" in verdict.sentence
    assert {"gamma = 0.8", "reward = [1, -10]", "yours = [6, -5]", "right = [9, -10]"} <= set(verdict.details)


def test_truth_values_are_shown_as_true_and_false():
    verdict = check.next_labels(lambda now, at_end, ended: now + 1)
    assert "ended = [False, True, False]" in verdict.details


def test_an_array_where_training_needs_a_tensor_is_refused_with_the_reason():
    verdict = check.critic_target(lambda *arguments: np.asarray(TARGET.solution(*arguments)))
    assert "a NumPy array: the exercise asks for a torch tensor, because training needs one" in verdict.sentence


def test_an_answer_that_is_not_a_number_is_shown_with_numpy_s_own_warning():
    verdict = check.return_to_go(lambda rewards, gamma: (rewards - rewards) / np.zeros(len(rewards)))
    assert "not a number (NaN) in this case: NumPy says 'invalid value encountered in divide'" in verdict.sentence


def test_an_answer_that_is_right_in_all_but_one_case_does_not_pass():
    seen = itertools.count()

    def nearly(*arguments):
        return TARGET.solution(*arguments) + (next(seen) == 40)

    assert not judge(TARGET, nearly).passed


def test_an_answer_that_draws_at_random_is_told_so():
    verdict = check.critic_target(lambda reward, *rest: torch.randn_like(reward))
    assert "differently each time" in verdict.sentence


def test_an_answer_that_writes_every_result_into_one_tensor_is_judged_by_what_it_returned():
    buffer = torch.zeros(100).double()

    def reuse(*arguments):
        right = TARGET.solution(*arguments)
        buffer[: len(right)] = right
        return buffer[: len(right)]

    assert judge(TARGET, reuse).passed


def test_a_branch_without_return_is_named():
    def half(reward, terminated, next_value, gamma):
        if gamma < 0.9:
            return reward + gamma * (1 - terminated) * next_value

    assert "branch without `return`" in check.critic_target(half).sentence


def test_what_is_no_function_is_named():
    assert "this is a number" in check.critic_target(3.0).sentence


def test_strict_raises_what_does_not_pass_and_only_that():
    check.strict()
    try:
        assert check.critic_target(TARGET.solution).passed
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
    def evil(*arguments):
        raise ValueError("<script>alert(1)</script>")

    verdict = check.critic_target(evil)
    assert "<script>" not in verdict._repr_mimebundle_()["text/html"] and "<script>" in repr(verdict)


def test_code_and_stressed_words_look_so_in_a_notebook():
    html = Verdict("wrong", "The *rule* counts in `x * y * z`, not 2 * 3 * 4.")._repr_mimebundle_()["text/html"]
    assert "The <em>rule</em> counts in <code>x * y * z</code>, not 2 * 3 * 4." in html


def entropy_of(log_pi):
    return -(log_pi.exp() * log_pi).sum(-1).mean()


@exercise_of(
    "a loss", minutes=1, difficulty=1, worked=(), mistakes={}, hints=("Look.",), slopes=[logits("log_pi"), "q"],
    cases=lambda rng: [[torch.tensor(rng.normal(size=(2, 9))).log_softmax(-1), torch.ones(2, 9)]] * 20,
)  # fmt: skip
def SLOPES(log_pi, q):
    return -(log_pi.exp() * q.detach()).sum(-1).mean() - entropy_of(log_pi)


@pytest.mark.parametrize(
    "answer, words",
    [
        (lambda log_pi, q: (log_pi.exp() * (log_pi - q.detach())).sum(-1).mean(), ""),
        (lambda log_pi, q: (log_pi.exp() * (log_pi.detach() - q.detach())).sum(-1).mean(), ""),  # equal on the simplex
        (lambda log_pi, q: (log_pi.softmax(-1) * (log_pi - q.detach())).sum(-1).mean(), ""),
        (lambda log_pi, q: SLOPES.solution(log_pi, q).detach(), "no gradient reaches `log_pi`"),
        (lambda log_pi, q: SLOPES.solution(log_pi, q).item(), "no gradient reaches `log_pi`"),
        (lambda log_pi, q: torch.tensor(np.asarray(SLOPES.solution(log_pi, q))), "use torch's functions"),
        (lambda log_pi, q: (log_pi.exp() * (log_pi - q)).sum(-1).mean(), "flows into `q`"),
        (
            lambda log_pi, q: (log_pi.exp().detach() * (log_pi - q.detach())).sum(-1).mean(),
            "slope in `log_pi` is wrong",
        ),
        (lambda log_pi, q: SLOPES.solution(log_pi, q) + 1, "differ"),
    ],
)
def test_of_a_loss_the_slopes_are_compared_through_the_logits(answer, words):
    verdict = judge(SLOPES, answer)
    assert (verdict.passed if words == "" else words in verdict.sentence) and one_sentence(verdict), verdict


def test_check_offers_its_exercises_for_completion():
    assert {"hint", "solution", *registry()} <= set(dir(check))
    assert inspect.getdoc(check)

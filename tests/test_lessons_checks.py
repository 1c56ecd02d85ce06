"""The exercises: a wrong answer never passes, a right one always does, and a sentence says what is wrong."""

import itertools
import re
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
import torch

from bootcourse.course import check, values
from bootcourse.course import exercise as exercise_module
from bootcourse.course.judge import judge, outcomes
from bootcourse.course.lessons import registry
from bootcourse.errors import BootcourseError
from tests.answers import RIGHT, WRONG, in_this_process, one_sentence

EXERCISES = registry()
TEXTS = Path(__file__).parents[1] / "bootcourse/course/lessons"
NOT_RIGHT = ("wrong", "did_not_run")
every_exercise = pytest.mark.parametrize("exercise", EXERCISES.values(), ids=lambda exercise: exercise.name)


@pytest.fixture(autouse=True)
def fast(monkeypatch):
    """Answers run in this process; `test_lessons_guard.py` judges some in processes of their own."""
    in_this_process(monkeypatch)


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


@every_exercise
def test_an_argument_with_nine_columns_has_nine_in_the_worked_cases_too(exercise):
    """An answer that counts on the (batch, 9) of its docstring raises no error in a case with two actions."""
    written = (TEXTS / exercise.lesson[3:] / "text.py").read_text()
    stub = re.search(rf"^(?:def|class) {exercise.name}\b.*?\"\"\"(.*?)\"\"\"", written, re.S | re.M)[1]
    cases = exercise.all_arguments
    worked, hidden = cases[: len(exercise.worked)], cases[len(exercise.worked) :]
    for few, many in zip(zip(*worked, strict=True), zip(*hidden, strict=True), strict=True):
        if ", 9)" in stub and all(np.shape(each)[-1:] == (9,) for each in many):
            assert all(np.shape(each)[-1:] == (9,) for each in few)


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


# Log-probabilities --------------------------------------------------------------------------------


@every_exercise
def test_slopes_in_log_probabilities_are_taken_through_their_logits(exercise):
    """As training takes them; otherwise `Categorical(logits=log_pi)`, which normalises again, has other slopes."""
    for name in exercise.slopes:
        place = exercise.arguments.index(name)
        given = [case[place] for case in exercise.all_arguments]
        sums = [each.logsumexp(-1).abs().max() for each in given if each.dim() == 2]
        if sums and max(sums) < 1e-3:
            assert isinstance(name, exercise_module.logits), f"{exercise.name}: mark {name} as logits"


def categorical_entropy(log_pi, q, alpha):
    policy = torch.distributions.Categorical(logits=log_pi)
    return -((policy.probs * q.detach()).sum(-1) + alpha * policy.entropy()).mean()


def categorical_log_prob(log_pi, expert_actions):
    return -torch.distributions.Categorical(logits=log_pi).log_prob(expert_actions).mean()


def categorical_kl(log_pi, rule_action, p):
    rule = torch.full_like(log_pi, (1 - p) / 8).scatter(-1, rule_action[:, None], p)
    policies = (torch.distributions.Categorical(logits=each) for each in (log_pi, rule.log()))
    return torch.distributions.kl_divergence(*policies)


CATEGORICAL = {"actor_loss": categorical_entropy, "cloning_loss": categorical_log_prob,
               "soft_constraint": categorical_kl}  # fmt: skip


@pytest.mark.parametrize("name", CATEGORICAL)
def test_torch_s_own_distributions_are_right(name):
    assert judge(EXERCISES[name], CATEGORICAL[name]).passed, judge(EXERCISES[name], CATEGORICAL[name])


# Exact arithmetic and other forms -----------------------------------------------------------------

FORMS = {  # of a right answer
    "a number": [Fraction, Decimal, np.float32, np.float64, np.array, torch.tensor],
    "a truth": [np.bool_, np.array, torch.tensor, int],
    "an array": [np.ndarray.tolist, list, iter, torch.tensor, lambda rows: dict(enumerate(rows)).values(),
                 lambda rows: [torch.tensor(row) for row in rows], lambda rows: map(np.asarray, rows),
                 lambda rows: tuple(tuple(row) if np.ndim(row) else row for row in rows.tolist()),
                 lambda rows: [[*map(Fraction, row)] if np.ndim(row) else Fraction(row) for row in rows.tolist()]],
}  # fmt: skip


def form_of(value) -> str:
    if isinstance(value, (bool, np.bool_)):
        return "a truth"
    return "an array" if isinstance(value, (np.ndarray, list, tuple)) else "a number"


ASKS_FOR_MORE = (torch.Tensor, str)  # a tensor, because training needs one; a text
IN_NUMBERS = [
    each for each in EXERCISES.values()
    if each.run is exercise_module.call_it and not each.slopes and not isinstance(each.worked[0][1], ASKS_FOR_MORE)
]  # fmt: skip


@pytest.mark.parametrize("exercise", IN_NUMBERS, ids=lambda exercise: exercise.name)
def test_the_right_numbers_are_right_in_every_usual_form(exercise):
    kind, space = form_of(exercise(*exercise.all_arguments[0])), {"__name__": "__main__"}
    for form in FORMS[kind]:
        space["made"] = lambda *given, form=form: form(np.asarray(exercise(*given))[()])
        verdict = judge(
            exercise, eval(f"lambda {', '.join(exercise.arguments)}: made({', '.join(exercise.arguments)})", space)
        )
        assert verdict.is_right, (form, verdict)


OWN_FORMS = {
    "dagger": ["a generator: (x for x in solution(*given))", "a tuple: tuple(solution(*given))"],
    "bootstrap_interval": ["a tuple: tuple(solution(*given))", "a list: [float(x) for x in solution(*given)]"],
    "difference_interval": ["a tuple: tuple(solution(*given))", "a tensor: torch.tensor(solution(*given))"],
    "find_plan": ["a list: solution(*given).tolist()", "a tensor: torch.tensor(solution(*given))"],
    "unmasks": ["a NumPy bool: np.bool_(solution(*given))", "a number: int(solution(*given))"],
}


@pytest.mark.parametrize("name", OWN_FORMS)
def test_what_an_exercise_of_its_own_kind_asks_for_is_right_in_every_usual_form(name):
    space = {"np": np, "torch": torch, "solution": EXERCISES[name].solution}
    for row in OWN_FORMS[name]:
        what, _, expression = row.partition(": ")
        exec(f"def {name}(*given):\n    return {expression}", space)
        verdict = judge(EXERCISES[name], space[name])
        assert verdict.is_right, (what, verdict)


# How large -----------------------------------------------------------------------------------------

LARGE = {  # what an argument reaches in some case: (its smallest, its largest); where the naive form fails in float32
    r"(next_)?log_pi": (-100, -0.1),
    r"(next_)?(q|q_pair|target)|next_q_pair": (-100, 60),
    r"(rule|own)_logits": (-100, 100),
    r"p": (0.2, 0.999),
    r"alpha": (1e-4, 10),
}


def first_axes(exercise) -> dict[str, set[int]]:
    """How many rows each array among the arguments of an exercise has, in its cases."""
    found: dict[str, set[int]] = {}
    for case in exercise.all_arguments:
        for name, value in zip(exercise.case_names, case, strict=True):
            if isinstance(value, (np.ndarray, torch.Tensor)) and np.ndim(value):
                found.setdefault(name, set()).add(len(value))
    return found


def test_an_answer_that_looks_at_the_first_rows_alone_passes_no_check_of_batches():
    few = {"power", "dagger", "rollout_values"}  # n by n; rounds; roads
    short = {
        exercise.name
        for exercise in EXERCISES.values()
        if (rows := [each for each in first_axes(exercise).values() if len(each) > 1]) and max(map(max, rows)) < 65
    }
    assert short <= few, f"no case has {exercise_module.MANY_ROWS} rows: {sorted(short - few)}"


def test_every_argument_that_training_makes_large_is_large_in_some_case():
    seen = 0
    for exercise in EXERCISES.values():
        for column, name in enumerate(exercise.case_names):
            given = [case[column] for case in exercise.all_arguments]
            for pattern, (low, high) in LARGE.items():
                if re.fullmatch(pattern, name) and np.asarray(given[0]).dtype.kind == "f":
                    numbers = np.concatenate([np.ravel(each) for each in given])
                    numbers = numbers[numbers != 0]
                    assert numbers.min() <= low and numbers.max() >= high, (exercise.name, name)
                    seen += 1
    assert seen >= 20

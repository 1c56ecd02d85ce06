"""The exercises: a wrong answer never passes, a right one always does, and nothing that it does ends the notebook."""

import contextlib
import copy
import ctypes
import dataclasses
import inspect
import io
import itertools
import os
import random
import re
import signal
import sys
import threading
import time
from contextlib import redirect_stdout

import cloudpickle
import nbformat
import numpy as np
import pytest
import torch
from nbclient import NotebookClient

from bootcourse.errors import BootcourseError
from bootcourse.learn import sac
from bootcourse.lessons import check, guard, values, worker
from bootcourse.lessons.exercise import call_it
from bootcourse.lessons.exercises import registry
from bootcourse.lessons.judge import judge, judge_source, outcomes
from bootcourse.lessons.verdict import Verdict
from tests.answers import RIGHT, WRONG, in_this_process

EXERCISES = list(registry().values())


def of_each(exercises):
    return pytest.mark.parametrize("exercise", exercises, ids=lambda exercise: exercise.name)


every_exercise = of_each(EXERCISES)
# A number, an array, a loss, how well an answer drives, and a verdict in the exercise's own words stand for all.
some_exercises = of_each(
    [registry()[n] for n in ("target_speed", "stochastic_rule", "cloning_loss", "my_rule", "diagnose")]
)
cloudpickle.register_pickle_by_value(sys.modules[__name__])


def one_sentence(verdict) -> bool:
    """No line breaks, a full stop at the end, and HTML without a trace of Python's own noise."""
    html = verdict._repr_mimebundle_()["text/html"]
    return "\n" not in verdict.sentence and verdict.sentence.endswith((".", "?")) and "Traceback" not in html


@pytest.fixture
def fast():
    with in_this_process:
        yield


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
    assert verdict.kind == "wrong" and words in verdict.sentence and one_sentence(verdict), verdict


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
    first, again = ([[values.numbers(values.plain(v)) for v in c] for c in exercise.all_arguments()] for _ in range(2))
    assert first == again and len(first) >= 20


@every_exercise
def test_the_cases_separate_every_mistake_from_the_right_answer_and_from_each_other(exercise):
    answers = [outcomes(exercise, f) for f in (exercise.solution, *(m.answer for m in exercise.mistakes))]
    for (i, one), (j, other) in itertools.combinations(enumerate(answers), 2):
        pairs = zip(one, other, strict=True)
        assert not all(values.same(a, b, exercise.tolerance, nan_too=True) for a, b in pairs), f"{i} and {j} agree"


@every_exercise
@pytest.mark.usefixtures("fast")
def test_a_known_mistake_gets_its_message(exercise):
    for mistake in exercise.mistakes:
        assert judge(exercise, mistake.answer).sentence == mistake.says
        assert mistake.says.endswith(".") and mistake.belief.endswith((".", ")"))


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
        assert verdict.kind == "wrong" and one_sentence(verdict)
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
    answer = values.plain(exercise.answers(exercise.solution, *copy.deepcopy(exercise.all_arguments()[0])))
    return exercise.run is call_it and not exercise.slopes and answer.kind in (*values.NUMERIC, "tuple")


@some_exercises
@pytest.mark.usefixtures("fast")
def test_a_wrong_shape_is_said_in_one_sentence(exercise):
    stack = lambda value: torch.stack([value] * 3) if isinstance(value, torch.Tensor) else np.array([value] * 3)  # noqa: E731
    verdict = judge(exercise, changed_values(exercise, stack))
    assert verdict.kind == "wrong" and one_sentence(verdict)
    assert not is_compared_as_it_is(exercise) or "shape" in verdict.sentence or "returns" in verdict.sentence


@some_exercises
@pytest.mark.usefixtures("fast")
def test_nan_is_said_in_one_sentence(exercise):
    verdict = judge(exercise, changed_values(exercise, lambda value: value * float("nan")))
    assert verdict.kind == "wrong" and one_sentence(verdict)
    assert not is_compared_as_it_is(exercise) or "NaN" in verdict.sentence


@some_exercises
@pytest.mark.usefixtures("fast")
def test_changing_an_argument_in_place_is_said_in_one_sentence(exercise):
    if not any(isinstance(a, (torch.Tensor, np.ndarray)) for a in exercise.all_arguments()[0]):
        pytest.skip("numbers cannot be changed in place")

    def in_place(*arguments):
        answer = exercise.solution(*arguments)
        for argument in arguments:
            if isinstance(argument, (torch.Tensor, np.ndarray)):
                argument[...] = 0
        return answer

    verdict = judge(exercise, in_place)
    assert verdict.kind == "wrong" and "changes its argument `" in verdict.sentence and one_sentence(verdict)


@some_exercises
@pytest.mark.usefixtures("fast")
def test_raising_is_said_in_one_sentence_with_the_line(exercise):
    def raises(*arguments):
        return 1 / (len(arguments) - len(arguments))

    verdict = judge(exercise, raises)
    assert "`return 1 / (len(arguments) - len(arguments))`: ZeroDivisionError" in verdict.sentence
    assert verdict.kind == "wrong" and one_sentence(verdict)


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


# What an answer may do ------------------------------------------------------------------------------


class Unprintable(Exception):
    def __str__(self):
        raise ValueError


def endless(*arguments):
    while True:
        try:
            print("again")
        except BaseException:
            pass


def holds_the_interpreter(*arguments):
    return sum(range(10**12))


def catastrophic(*arguments):
    return re.match(r"(a+)+$", "a" * 50 + "b")


def recurses_without_a_limit(*arguments):
    sys.setrecursionlimit(10**9)
    return recurses_without_a_limit(*arguments)


def raises_what_cannot_be_printed(*arguments):
    raise Unprintable


def kills_the_process_that_started_it(*arguments):
    os.kill(os.getppid(), signal.SIGKILL)
    time.sleep(9)


def fills_the_memory(*arguments):
    return np.ones(10**10)


def fills_the_memory_with_a_tensor(*arguments):
    return torch.ones(10**10)


def returns_far_too_much(reward, *rest):
    return torch.zeros(2**20 + 1)


def leaves_threads_and_processes_behind(reward, terminated, next_value, gamma):
    threading.Thread(target=time.sleep, args=(100,)).start()
    if os.fork() == 0:
        time.sleep(100)
    return reward


def forges_its_report(reward, *rest):
    for descriptor in range(3, 20):
        with contextlib.suppress(OSError):
            os.write(descriptor, b'{"ended": "", "bytes": 0}\n{"done": true}\n')
    return reward


def patches_everything(reward, *rest):
    np.allclose = np.isclose = lambda *a, **k: True
    values.same = lambda *a, **k: True
    sac.critic_target = lambda reward, *rest: reward
    random.seed(0), torch.manual_seed(0)
    torch.set_default_dtype(torch.float64)
    return reward


HOSTILE = {
    endless: "stopped after 0.5 s",
    holds_the_interpreter: "stopped after 0.5 s",
    catastrophic: "stopped after 0.5 s",
    recurses_without_a_limit: "",  # the memory, the time, or the stack ends first, as the Python is
    lambda *arguments: os._exit(3): "exit code 3",
    lambda *arguments: sys.exit("bye"): "SystemExit: bye",
    lambda *arguments: ctypes.string_at(0): "SIGSEGV",
    raises_what_cannot_be_printed: "raises an error in line",
    kills_the_process_that_started_it: "crash",
    fills_the_memory: "2 GiB",
    fills_the_memory_with_a_tensor: "2 GiB",
    returns_far_too_much: "of 1,048,577 numbers",
    leaves_threads_and_processes_behind: "",
    forges_its_report: "exit code 0",
    patches_everything: "differ at [0]",
}


def the_state_of_this_process():
    settings = torch.get_default_dtype(), sys.getrecursionlimit(), np.allclose, values.same, sac.critic_target
    return *settings, random.getstate(), torch.get_rng_state().tolist(), threading.active_count()


@pytest.mark.skipif(not worker.FORKS, reason="needs a fork")
@pytest.mark.parametrize("answer, words", HOSTILE.items(), ids=lambda x: getattr(x, "__name__", None) or "says")
def test_whatever_an_answer_does_is_one_sentence_and_leaves_nothing_behind(answer, words):
    impatient, before = dataclasses.replace(TARGET, seconds=0.5), the_state_of_this_process()
    with redirect_stdout(io.StringIO()) as printed:
        verdict = judge(impatient, answer)
    assert verdict.kind == "wrong" and words in verdict.sentence and one_sentence(verdict), verdict
    assert the_state_of_this_process() == before and printed.getvalue() == ""
    assert not judge(TARGET, lambda reward, *rest: reward).passed and judge(TARGET, TARGET.solution).passed


@pytest.mark.skipif(not worker.FORKS, reason="needs a fork")
def test_the_process_that_forks_has_one_thread():
    judge(registry()["cloning_loss"], registry()["cloning_loss"].solution)  # torch has worked in it, and NumPy
    assert len(os.listdir(f"/proc/{guard._process.pid}/task")) == 1


def test_without_a_fork_each_answer_has_a_process_of_its_own(monkeypatch):
    guard.stop()
    monkeypatch.setattr(worker, "FORKS", False)
    impatient = dataclasses.replace(TARGET, seconds=0.5)
    assert "stopped after 0.5 s" in judge(impatient, holds_the_interpreter).sentence
    assert judge(TARGET, TARGET.solution).passed
    guard.stop()


def test_what_cannot_be_sent_to_another_process_is_refused_in_one_sentence():
    lock = threading.Lock()
    verdict = check.critic_target(lambda *arguments: lock)
    assert "make it inside the function" in verdict.sentence and one_sentence(verdict)


RIGHT_TEXT = "import torch\n\ndef critic_target(r, t, v, gamma):\n    return r + gamma * (1 - t) * v\n"


@pytest.mark.parametrize(
    "text, kind, words",
    [
        (RIGHT_TEXT, "passed", "Right."),
        (RIGHT_TEXT.replace("(1 - t)", "t"), "wrong", "inverted"),
        (RIGHT_TEXT.replace("* v", "* w"), "wrong", "line 4, `return r + gamma * (1 - t) * w`: NameError"),
        (RIGHT_TEXT.replace("(r, t, v", "(r, t"), "wrong", "the check calls"),
        ("def critic_target(r, t, v, gamma):\n    ...", "todo", "Nothing to check yet"),
        ("critic_target = 3", "wrong", "this is a number"),
        ("x =", "wrong", "line 1, `x =`: SyntaxError"),
        ("", "wrong", "no function `critic_target`"),
        ("while True: pass", "wrong", "stopped after 0.5 s"),
        ("import os; os._exit(1)", "wrong", "exit code 1"),
    ],
)
def test_a_text_is_judged_like_a_function(text, kind, words):
    verdict = judge_source(TARGET, text, seconds=0.5)
    assert verdict.kind == kind and words in verdict.sentence and one_sentence(verdict), verdict


def test_what_a_function_prints_is_kept_short_and_shown_with_what_is_wrong():
    def chatty(reward, *rest):
        print("reward is", reward.tolist())
        return reward

    assert "printed: reward is [1.0, -10.0]" in check.critic_target(chatty).details[-1]
    assert len(judge(dataclasses.replace(TARGET, seconds=0.2), endless).details[-1]) < 600


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


SLOPES = dataclasses.replace(
    TARGET,
    call="loss(log_pi, q)",
    solution=lambda log_pi, q: -(log_pi.exp() * q.detach()).sum(-1).mean() - entropy_of(log_pi),
    slopes=("log_pi", "q"),
    worked=(),
    cases=lambda rng: [[torch.tensor(rng.normal(size=(2, 9))).log_softmax(-1), torch.ones(2, 9).double()]] * 20,
    mistakes=(),
)


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


# In a notebook's kernel ---------------------------------------------------------------------------


def test_a_kernel_outlives_what_an_answer_does_and_shows_its_line():
    cells = [
        "import os, threading\nfrom bootcourse.lessons import check\nbefore = threading.active_count()",
        "check.critic_target(lambda *a: os._exit(1))",
        "def f(*a):\n    x = 1\n    return x + 'a'\ncheck.critic_target(f)",
        "def f(reward, *a):\n    ...\n\n\ncheck.critic_target(f)",
        "print('alive', threading.active_count() - before)",
    ]
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell) for cell in cells])
    NotebookClient(notebook, timeout=60).execute()
    said = [cell.outputs[0] for cell in notebook.cells[1:]]
    assert "exit code 1" in said[0].data["text/plain"] and "✗" in said[0].data["text/html"]
    assert "in line 3, `return x + 'a'`: TypeError" in said[1].data["text/plain"]
    assert "Nothing to check yet" in said[2].data["text/plain"]
    assert said[3].text == "alive 0\n"


def test_check_offers_its_exercises_for_completion():
    assert {"hint", "solution", *registry()} <= set(dir(check))
    assert inspect.getdoc(check)

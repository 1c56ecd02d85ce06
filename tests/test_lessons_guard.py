"""Whatever an answer does in its process is one sentence, and the next check knows nothing of it."""

import contextlib
import ctypes
import functools
import io
import os
import random
import sys
import threading
import time
from contextlib import redirect_stdout

import cloudpickle
import numpy as np
import pytest
import torch

from bootcourse.course import check, runner, values
from bootcourse.course.answered import stop_in_words
from bootcourse.course.judge import judge
from bootcourse.course.lessons import registry
from bootcourse.course.stopped import Stopped
from bootcourse.learn import sac
from tests.answers import in_this_process, one_sentence

TARGET = registry()["critic_target"]
cloudpickle.register_pickle_by_value(sys.modules[__name__])

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


def recurses_without_a_limit(*arguments):
    sys.setrecursionlimit(10**9)
    return recurses_without_a_limit(*arguments)


def raises_what_cannot_be_printed(*arguments):
    raise Unprintable


def fills_the_memory(*arguments):
    return np.ones(10**10)


def returns_far_too_much(reward, *rest):
    return torch.zeros(2**20 + 1)


def leaves_threads_and_processes_behind(reward, terminated, next_value, gamma):
    if threading.active_count() == 1:
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
    recurses_without_a_limit: "",  # the memory or the stack ends first, as the Python is
    lambda *arguments: os._exit(3): "exit code 3",
    lambda *arguments: sys.exit("bye"): "SystemExit: bye",
    lambda *arguments: ctypes.string_at(0): "SIGSEGV",
    raises_what_cannot_be_printed: "raises an error in line",
    fills_the_memory: "2 GiB",
    returns_far_too_much: "of 1,048,577 numbers",
    leaves_threads_and_processes_behind: "differ at [0]",
    forges_its_report: "too much to compare",
    patches_everything: "differ at [0]",
}


def the_state_of_this_process():
    settings = torch.get_default_dtype(), sys.getrecursionlimit(), np.allclose, values.same, sac.critic_target
    return *settings, random.getstate(), torch.get_rng_state().tolist()


@pytest.mark.skipif(not runner.FORKS, reason="needs a fork")
@pytest.mark.parametrize("answer, words", HOSTILE.items(), ids=lambda x: getattr(x, "__name__", None) or "says")
def test_whatever_an_answer_does_is_one_sentence_and_leaves_nothing_behind(answer, words):
    before, threads = the_state_of_this_process(), threading.enumerate()
    with redirect_stdout(io.StringIO()) as printed:
        verdict = judge(TARGET, answer, 0.5 if "0.5 s" in words else None)
    assert verdict.kind in ("wrong", "did_not_run") and words in verdict.sentence and one_sentence(verdict), verdict
    assert the_state_of_this_process() == before and printed.getvalue() == ""
    assert not set(threading.enumerate()) - set(threads)
    assert judge(TARGET, TARGET.solution).is_right


def test_without_a_fork_each_answer_has_a_new_process(monkeypatch):
    runner.stop()
    monkeypatch.setattr(runner, "FORKS", False)
    assert "stopped after 0.5 s" in judge(TARGET, holds_the_interpreter, 0.5).sentence
    runner.stop()


RIGHT_TEXT = "import torch\n\ndef critic_target(r, t, v, gamma):\n    return r + gamma * (1 - t) * v\n"


@functools.cache
def cached(reward, terminated, next_value, gamma):
    return reward + gamma * (1 - terminated) * next_value


def computes_and_returns_nothing(reward, terminated, next_value, gamma):
    reward + gamma * (1 - terminated) * next_value


def begun(reward, terminated, next_value, gamma):
    future = gamma * next_value  # noqa: F841
    ...


def looks_for_a_file(*arguments):
    return open("/usr/nowhere/secret/weights.npz")


@pytest.mark.parametrize(
    "answer, kind, words",
    [
        (cached, "passed", "Right."),
        (computes_and_returns_nothing, "wrong", "returns nothing: end it with `return`"),
        (begun, "todo", "Nothing to check yet"),
        (looks_for_a_file, "did_not_run", "No such file or directory: 'weights.npz'"),
        (lambda *arguments: torch.zeros(len(arguments[0])).double() + cached(*arguments), "passed", "Right."),
    ],
)
def test_a_cache_no_return_a_stub_that_is_begun_a_path_and_float64_are_what_they_are(answer, kind, words):
    verdict = check.critic_target(answer)
    assert verdict.kind == kind and words in verdict.sentence, verdict


TEXTS = [
    (RIGHT_TEXT.replace("(1 - t)", "t"), "wrong", "inverted"),
    (RIGHT_TEXT.replace("* v", "* w"), "did_not_run", "line 4, `return r + gamma * (1 - t) * w`: NameError"),
    ("def critic_target(r, t, v, gamma):\n    ...", "todo", "Nothing to check yet"),
    ("x =", "did_not_run", "line 1, `x =`: SyntaxError"),
    ("", "wrong", "no function `critic_target`"),
]


@pytest.mark.parametrize("text, kind, words", TEXTS)
def test_a_text_is_judged_like_a_function(text, kind, words, monkeypatch):
    in_this_process(monkeypatch)
    verdict = judge(TARGET, text)
    assert verdict.kind == kind and words in verdict.sentence and one_sentence(verdict), verdict


@pytest.mark.parametrize(
    "seconds, waited, left", [(6, 0.1, 6), (6, 2, 5), (6, 4, 4), (6, 30, 4), (1, 30, 1), (90, 30, 90)]
)
def test_a_check_takes_ten_seconds_at_most_unless_the_exercise_needs_more(seconds, waited, left):
    assert runner.time_left(seconds, waited) == left


def test_what_a_function_prints_is_kept_short_and_shown_with_what_is_wrong():
    def chatty(reward, *rest):
        print("reward is", reward.tolist())
        return reward

    said = check.critic_target(chatty).details[-1]
    assert "printed: reward is [1.0, -10.0]" in said and len(said) < 600


# Too slow -----------------------------------------------------------------------------------------

STOPPED = {  # seconds, computed, in each case -> what is said, and what is not
    "a loop that never ends": ((6.0, 5.9, (0.01, 0.02, 5.8)), "look for a loop that never ends", "done again"),
    "a loop in the first case": ((6.0, 5.9, (5.9,)), "look for a loop that never ends", "done again"),
    "slow in every case": ((6.0, 5.9, (0.9,) * 6 + (0.5,)), "6 of the 46 cases were done", "never ends"),
    "slow in a large case": ((6.0, 5.9, (0.4, 1.5, 4.0)), "2 of the 46 cases were done", "never ends"),
    "asleep": ((6.0, 0.01, (0.0,)), "something that waits, such as `sleep`", "never ends"),
    "beside other programs": ((6.0, 2.0, (2.0,)), "computed for only 2 s", "never ends"),
    "where nothing is known": ((6.0, None, ()), "a right answer needs a fraction", "never ends"),
}


@pytest.mark.parametrize("case", STOPPED)
def test_a_loop_is_called_endless_only_where_the_processor_shows_it(case):
    measured, words, not_said = STOPPED[case]
    said = stop_in_words(Stopped(*measured), endless, 46)
    assert "stopped after 6 s" in said and words in said and not_said not in said and said.endswith(".")


def sleeps(*arguments):
    time.sleep(100)


def too_many_turns(reward, terminated, next_value, gamma):
    for _ in range(4 * 10**6):
        pass
    return reward + gamma * (1 - terminated) * next_value


@pytest.mark.skipif(not runner.FORKS, reason="the line is known on Linux")
@pytest.mark.parametrize("answer, words, not_said", [
    (endless, ", in line ", "sleep"), (sleeps, "`time.sleep(100)`: look for something that waits", "never ends"),
    (too_many_turns, "in line ", "never ends"), (holds_the_interpreter, "`return sum(range(10**12))`", "sleep"),
])  # fmt: skip
def test_an_answer_that_was_stopped_is_told_in_which_line_it_was(answer, words, not_said):
    said = judge(TARGET, answer, 2).sentence
    assert "stopped after 2 s" in said and words in said and not_said not in said, said

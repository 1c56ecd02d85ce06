"""Whatever form an answer has in a notebook: what passes its check there passes when it is graded."""

import msgspec
import numpy as np
import pytest

from bootcourse.course.answer_process import Report, decoder, encoder
from bootcourse.course.classroom.answers import LONGEST, Answers, Clock, Notebook
from bootcourse.course.judge import judge, outcomes
from bootcourse.course.lessons import registry
from bootcourse.course.values import Plain
from bootcourse.errors import BootcourseError
from tests.answers import in_this_process
from tests.hostile.submissions import failures

HEAD, LUCK = "def luck(good, decisions, tries):\n    ", "return 1 - (1 - (good / n) ** decisions) ** tries"
NINE = HEAD + LUCK.replace("n)", "9)")
OTHER = NINE.replace("luck", "mine")
INSIDE = NINE.replace("\n", "\n    ")
FORMS = {  # the cells of a notebook whose answer is right
    "a line that begins with %": [HEAD + "n = (\n        19\n        % 10\n    )\n    " + LUCK],
    "% and ! in a string": [HEAD + "n = len('''\n%s\n!xyzabc''' % 12) - 2\n    " + LUCK],
    "a lambda": ["luck = lambda good, decisions, tries: 1 - (1 - (good / 9) ** decisions) ** tries"],
    "an alias": [OTHER, "luck = mine\ncheck.luck(luck)"],
    "another name in the check": [OTHER, "check.luck(mine)"],
    "a lambda in the check": ["check.luck(lambda good, decisions, tries: 1 - (1 - (good / 9) ** decisions) ** tries)"],
    "a function that makes it": [f"def make(n):\n    {INSIDE}\n    return luck", "luck = make(9)\ncheck.luck(luck)"],
    "partial": ["import functools\n" + OTHER.replace("(good,", "(n, good,", 1).replace("9", "n"),
                "luck = functools.partial(mine, 9)\ncheck.luck(luck)"],
    "under if": [f"if True:\n    {INSIDE}"],
    "an indented cell": [f"    {INSIDE}\n    check.luck(luck)"],
    "x = !ls": [f"x = !ls\n{NINE}"],
    "help behind it": [f"{NINE}\nlen??"],
    "%%time": [f"%%time\n{NINE}"],
    "%%capture": [f"%%capture out\n{NINE}"],
    "a star import": ["from math import *", HEAD + "return -expm1(tries * log1p(-(good / 9) ** decisions))"],
    "k += 1": ["n = 8", "n += 1", HEAD + LUCK],
    "an item": ["k = {}", "k['a'] = 9", HEAD + LUCK.replace("n)", "k['a'])")],
    "an attribute": ["import types\nk = types.SimpleNamespace()", "k.a = 9", HEAD + LUCK.replace("n)", "k.a)")],
    "a loop": ["k = [0] * 3", "for i in range(3):\n    k[i] = 9", HEAD + LUCK.replace("n)", "k[2])")],
    "global": ["def set_up():\n    global n\n    n = 9", "set_up()", HEAD + LUCK],
    "a form feed": [HEAD + "n = len('x\x0cyzabcde')\n    " + LUCK],
    "another end of line": [HEAD + "n = len('x\u2028yzabcde')\n    " + LUCK],
    "a helper below": [HEAD + LUCK.replace("n)", "one())"), "def one():\n    return 9"],
    "a constant between it and its check": ["n = 1", HEAD + LUCK, "n = 9", "check.luck(luck)"],
    "a constant that changes after the check": ["n = 9", f"{HEAD}{LUCK}\ncheck.luck(luck)", "n = 0"],
    "its name is something else later": [f"{NINE}\ncheck.luck(luck)", "for luck in range(3):\n    pass"],
    "a broken cell below": [f"{NINE}\ncheck.luck(luck)", "def luck(good, decisions:\n    return"],
    "what a function makes, without a check": [f"def make():\n    {INSIDE.replace(chr(10), chr(10) + '    ')}\n"
                                               "    return luck", "luck = make()"],
    "its own attribute": [HEAD + LUCK.replace("n)", "luck.n)"), "luck.n = 9"],
    "a class with __call__": [f"class Luck:\n    n = 9\n    def __call__(self, good, decisions, tries):\n        "
                              f"{LUCK.replace('n)', 'self.n)')}", "luck = Luck()\ncheck.luck(luck)"],
    "another form of a letter": ["\ufb01 = 9", HEAD + LUCK.replace("n)", "fi)")],
    "%time": ["%time n = 9", HEAD + LUCK],
    "match": ["match 9:\n    case n:\n        pass", HEAD + LUCK],
    "a default that changes": ["n = 9", HEAD.replace("tries)", "tries, n=n)") + LUCK, "n = 1", "check.luck(luck)"],
    "a default in a class": ["n = 9", "class Luck:\n    @staticmethod\n    def of(good, decisions, tries, n=n):\n"
                             f"        {LUCK}", "n = 1", "check.luck(Luck.of)"],
    "itself in the check": [f"{NINE}\ncheck.luck(lambda *three: luck(*three))"],
    "decorated": ["import functools", f"@functools.cache\n{NINE}"],
}  # fmt: skip


def read(*cells: str, outputs=()) -> Answers:
    code = [{"cell_type": "code", "source": cell, "outputs": list(outputs)} for cell in cells]
    return Answers(msgspec.json.decode(msgspec.json.encode({"cells": code}), type=Notebook), Clock())


@pytest.mark.parametrize("form", FORMS)
def test_an_answer_is_read_in_every_form_that_a_notebook_runs(form):
    space = {}
    exec(read(*FORMS[form]).texts()["luck"], space)
    assert space["luck"](3, 2, 1) == pytest.approx(1 / 9)


def test_an_answer_brings_nothing_that_it_does_not_need():
    cells = ["train_for_an_hour()", "n = 3\nm = 4", "n = 9", "import numpy as np\nnp.save('x', n)", HEAD + LUCK]
    assert read(*cells).texts()["luck"] == f"n = 9\n\n{HEAD}{LUCK}\n"


def test_what_the_last_check_said_in_the_notebook_is_known():
    says = {"output_type": "execute_result", "data": {"text/plain": ["✓ Right. Your `luck` agrees"]}}
    assert read(f"{NINE}\ncheck.luck(luck)", outputs=[says]).right == {"luck"}
    assert read(f"{NINE}\ncheck.luck(luck)").right == set()


# Limits ---------------------------------------------------------------------------------------------

SLOW = {
    "many empty lines": "\n" * (LONGEST - 100) + NINE,
    "many lines": "x = 1\n" * 8000 + NINE,
    "a long chain": "k = 0\n" + "k = k + 1\n" * 4000 + HEAD + LUCK.replace("n)", "(9 + 0 * k))"),
    "deeply nested": HEAD + f"return {'(' * 5000}1",
    "many terms": HEAD + "return " + "+".join("1" * 20_000),
}


@pytest.mark.parametrize("case", SLOW)
def test_a_long_answer_is_read_in_a_time_that_grows_with_its_length(case):
    assert "luck" in read(SLOW[case]).texts()  # within the clock's ten seconds


def test_a_cell_full_of_commands_stops_no_other_student(monkeypatch):
    answers = msgspec.convert({"cells": [{"cell_type": "code", "source": "!ls\n" * 400}] * 2}, Notebook)
    with pytest.raises(BootcourseError, match="too long to read"):
        Answers(answers, Clock(0.2))


def test_damaged_submissions_stop_no_class():
    answered, failed = failures(60, seed=0)
    assert answered and failed == []


SOLUTION = outcomes(registry()["critic_loss"], registry()["critic_loss"].solution)
FORGED = [
    Report(SOLUTION * 2),
    Report(SOLUTION[:-1]),
    Report(SOLUTION, changed=(-1, 99)),
    Report(SOLUTION[:1], error=("E" * 5000, "t" * 9000, 10**12)),
    Report([Plain("x" * 5000)] * len(SOLUTION), printed="p" * 9000),
    Report([Plain("list", parts=())] * len(SOLUTION)),
    Report([Plain("tuple", parts=(Plain("tensor", np.full((2, 3), np.nan)), Plain("text")))] * len(SOLUTION)),
]


@pytest.mark.parametrize("report", FORGED)
def test_an_answer_that_sends_its_own_report_stops_no_judge(report, monkeypatch):
    in_this_process(monkeypatch, lambda *arguments, **more: decoder.decode(encoder.encode(report)))
    verdict = judge(registry()["critic_loss"], "def critic_loss(q_pair, action, target):\n    return 1\n")
    assert verdict.kind in ("wrong", "did_not_run")
    assert max(map(len, (verdict.sentence, *verdict.details))) <= 2000

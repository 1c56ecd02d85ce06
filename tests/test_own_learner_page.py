"""The page "A learner of your own": its classes, and its commands with fewer episodes."""

import re
import shlex
from pathlib import Path

import numpy as np
import pytest

import bootcourse as bc
from bootcourse.cli.own_files import loaded
from bootcourse.errors import BootcourseError
from bootcourse.methods import METHODS
from bootcourse.scenario import Scenario

PAGE = (Path(__file__).resolve().parent.parent / "book" / "own_learner.md").read_text(encoding="utf-8")
MINE, DQN = re.findall(r"^```python\n(.*?)^```", PAGE, re.M | re.S)
TRAIN, EVALUATE, TRAIN_DQN = (line for line in PAGE.splitlines() if line.startswith("bootcourse "))
FEW = ["--seeds", "2", "--episodes", "3", "--quiet", "--change", "learning_starts=16", "--change", "hidden=(8,)"]


@pytest.fixture
def files(tmp_path, monkeypatch):
    """The page's two files, in the working folder."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.py").write_text(MINE, encoding="utf-8")
    (tmp_path / "dqn.py").write_text(DQN, encoding="utf-8")
    return tmp_path


def test_the_page_s_commands_train_and_test_and_python_reads_the_run(bootcourse, files):
    trained = bootcourse(*shlex.split(TRAIN)[1:], *FEW)
    assert trained.status == 0, trained.err
    tested = bootcourse(*shlex.split(EVALUATE)[1:], "--episodes", 5)
    assert tested.status == 0 and "MyLearner-0" in tested.out, tested.err
    with pytest.raises(BootcourseError, match="add the --learner FILE.py:CLASS .* or learner= to load_run"):
        bc.load_run("runs/mine/MyLearner-0")
    own = loaded("mine.py:MyLearner", "--learner", "class")
    run = bc.load_run("runs/mine/MyLearner-0", learner=own)
    assert (run.agent.settings.certainty, run.agent.settings.tau) == (0.1, 0.01) and "MyLearner" not in METHODS
    assert run.agent.kind is own and len(bc.record(run.agent.as_policy(with_q=True), [1])) == 1


def test_double_q_learning_trains_from_the_command_line_and_learns_what_pays(bootcourse, files):
    trained = bootcourse(*shlex.split(TRAIN_DQN)[1:-4], *FEW, "--out", "runs/dqn")
    assert trained.status == 0, trained.err
    learner = loaded("dqn.py:DoubleDQN", "--learner", "class")
    run = bc.load_run("runs/dqn/DoubleDQN-1", learner=learner)
    assert (run.agent.probabilities(np.zeros((4, 26))).max(axis=1) == 1).all()
    rows, settings = bc.collect(4), bc.with_seeds(bc.settings_for("demos", gamma=0.0, critic_lr=0.01), 2)
    one = learner(settings, 26)
    replay = one.make_buffer(26, rows)
    generators = [np.random.default_rng(seed) for seed in range(2)]
    losses = [one.update(replay.sample(64, np.ones(2), generators))["critic_loss"] for _ in range(300)]
    assert (losses[-1] < 0.01 * losses[0]).all(), "with γ = 0, Q is the reward"


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["--change", "tau"], "--change tau: give NAME=VALUE"),
        (["--change", "seed=3"], "--method and --first-seed apart"),
        (["--change", "taú=3"], "'taú' is unknown: did you mean 'tau'"),
        (["--change", "tau=fast"], "tau = 'fast': give a finite number"),
        (["--change", "hidden=8"], "hidden = 8: give the layers' sizes"),
        (["--scenario", "roads.py:missing"], "roads.py has no scenario 'missing'"),
        (["--scenario", "roads.py:number"], "scenario = 3: give a Scenario, the name of one, or a dictionary"),
        (["--scenario", "defualt"], "did you mean 'default'"),
    ],
)
def test_a_mistake_on_the_command_line_is_one_sentence(bootcourse, files, words, sentence):
    (files / "roads.py").write_text("number = 3\n", encoding="utf-8")
    answer = bootcourse("train", "--out", "runs", *words)
    assert answer.status == 2 and sentence in answer.err, answer.err


def test_a_scenario_of_a_file_trains_and_evaluates(bootcourse, files):
    code = 'from bootcourse.scenario import Scenario, Traps\nfaster = Scenario("faster", traps=Traps(speed=10.5))\n'
    (files / "roads.py").write_text(code + 'dense = {"name": "dense", "traffic": {"cars": 9}}\n', encoding="utf-8")
    trained = bootcourse("train", "--method", "sac", "--scenario", "roads.py:dense", "--out", "runs", *FEW)
    assert trained.status == 0, trained.err
    run = bc.load_run("runs/sac-1")
    assert run.scenario == Scenario("dense", traffic=run.scenario.traffic) and run.scenario.traffic.cars == 9
    answer = bootcourse("evaluate", "runs", "--scenario", "roads.py:faster", "--episodes", 4)
    assert answer.status == 0, answer.err

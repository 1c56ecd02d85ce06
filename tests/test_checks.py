"""The harness of the independent checks. The checks themselves: `python -m bootcourse.research.checks`."""

from dataclasses import replace

import numpy as np
import pytest
import torch

from bootcourse.learn.replay_buffer import decode_transitions
from bootcourse.learn.settings import settings_for
from bootcourse.learn.teachers import teacher_policy
from bootcourse.policies import PolicyOutput
from bootcourse.research import checks

BALANCE = teacher_policy(checks.balance, None, 2)


def falls(observations, cars):
    return PolicyOutput(np.ones(len(observations), dtype=np.int64))


def test_collected_rows_are_whole_episodes_with_their_true_last_states():
    rows, mean = checks.data(falls, checks.cartpole, 5)
    batch = decode_transitions(rows, 4, torch.zeros(len(rows)))
    assert len(rows) == 5 * mean and batch.terminated.sum() == 5
    angles = batch.next_states[batch.terminated == 1][:, 2].abs() * checks.CARTPOLE_SCALES[2]
    assert (angles > 12 * 2 * np.pi / 360).all()  # where it fell, not where it started anew
    rows, mean = checks.data(BALANCE, checks.cartpole, 10)
    assert mean == 500, "the demonstrator balances every pole to the end"
    assert not decode_transitions(rows, 4, torch.zeros(len(rows))).terminated.any()  # out of time


def test_the_cartpole_of_fixed_length_pays_only_while_the_pole_is_up_and_never_ends_early():
    rows, mean = checks.data(falls, checks.fixed_cartpole, 3)
    assert len(rows) == 3 * 500 and mean < 100
    assert checks.data(BALANCE, checks.fixed_cartpole, 3)[1] == 500


def test_cloning_the_demonstrator_balances_the_pole():
    """The whole harness in seconds: behaviour cloning from 5 demonstrations."""
    rows, _ = checks.data(BALANCE, checks.cartpole, 5)
    agents = checks.train([settings_for("bc", envs_per_agent=1, learning_starts=0)], checks.cartpole, 1500, rows)
    assert checks.scores(agents, checks.cartpole, 10).mean() > 450


def test_the_table_says_which_figure_was_missed(monkeypatch, tmp_path, capsys):
    good, bad = (lambda seeds, progress: checks.Outcome(np.full(seeds, 499.0)) for _ in range(2))
    bad = lambda seeds, progress: checks.Outcome(np.full(seeds, 20.0), "a note")  # noqa: E731
    for name, measure in (("gail-cartpole", good), ("cql-cartpole", bad)):
        monkeypatch.setitem(checks.CHECKS, name, replace(checks.CHECKS[name], measure=measure))
    out = tmp_path / "table.md"
    assert checks.main(["--only", "gail-cartpole", "cql-cartpole", "--seeds", "2", "--out", str(out)]) == 1
    text = capsys.readouterr().out
    assert out.read_text() == checks.PAGE + text.rstrip("\n") + "\n"
    assert "| yes |" in text and "| **no** |" in text and "a note" in text
    assert checks.main(["--only", "gail-cartpole", "--seeds", "2"]) == 0


def test_every_check_names_its_figure_and_source_and_a_mistyped_one_is_refused(capsys):
    assert all(np.isfinite(each.published) and "](https://" in each.source for each in checks.CHECKS.values())
    assert checks.main(["--only", "sac-acrobat"]) == 2
    assert "did you mean 'sac-acrobot'" in capsys.readouterr().err


@pytest.mark.parametrize(("published", "score", "verdict"), [(500, 496, True), (500, 494, False), (-92.6, -93, True)])
def test_a_hundredth_below_the_figure_still_counts_as_reached(published, score, verdict):
    check = replace(checks.CHECKS["gail-cartpole"], published=published)
    assert checks.reached(checks.Outcome(np.array([score])), check) is verdict
